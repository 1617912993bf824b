#include "contact/overlap_pairs_kernel.h"
#include "core/launch_cuda.cuh"

SCREE_DEFINE_TEAM_LAUNCH(scree_overlap_pairs)
SCREE_DEFINE_TEAM_LAUNCH(scree_overlap_patches)
