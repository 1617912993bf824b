#include "contact/mesh_pairs_kernel.h"
#include "contact/pair_kinds_kernel.h"
#include "core/launch_cuda.cuh"

SCREE_DEFINE_LAUNCH(scree_pair_flag)
SCREE_DEFINE_LAUNCH(scree_pair_scatter)
SCREE_DEFINE_LAUNCH(scree_pair_keep)
SCREE_DEFINE_LAUNCH(scree_pair_carry)
SCREE_DEFINE_LAUNCH(scree_mesh_apart)
SCREE_DEFINE_LAUNCH_WIDE(scree_mesh_gap)
SCREE_DEFINE_LAUNCH(scree_mesh_write)
