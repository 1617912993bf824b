/// \file bvh_launch.h
/// The kernels of this folder as loops over their index, defined in lbvh_cpu.c and broad_phase_cpu.c.
#ifndef SCREE_BVH_LAUNCH_H
#define SCREE_BVH_LAUNCH_H

#include "bvh/lbvh_build_kernel.h"
#include "core/launch_cpu.h"

SCREE_DECLARE_LAUNCH(scree_lbvh_bounds)      ///< over chunks of boxes
SCREE_DECLARE_LAUNCH(scree_lbvh_codes)       ///< over boxes
SCREE_DECLARE_LAUNCH(scree_lbvh_hierarchy)   ///< over inner nodes
SCREE_DECLARE_LAUNCH(scree_lbvh_left_turns)  ///< over leaves
SCREE_DECLARE_LAUNCH(scree_lbvh_leaves)      ///< over leaves
SCREE_DECLARE_LAUNCH(scree_lbvh_inner_nodes) ///< over inner nodes
SCREE_DECLARE_LAUNCH(scree_lbvh_refit)       ///< over leaves

#endif
