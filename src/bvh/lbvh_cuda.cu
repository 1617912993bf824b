#include "bvh/lbvh_build_kernel.h"
#include "core/launch_cuda.cuh"

SCREE_DEFINE_SUM_LAUNCH(scree_lbvh_bounds)
SCREE_DEFINE_LAUNCH(scree_lbvh_codes)
SCREE_DEFINE_LAUNCH(scree_lbvh_hierarchy)
SCREE_DEFINE_LAUNCH(scree_lbvh_left_turns)
SCREE_DEFINE_LAUNCH(scree_lbvh_nodes)
