/// \file bvh_launch.h
/// The kernels of this folder as loops over their index, defined in lbvh_cpu.c and broad_phase_cpu.c.
#ifndef SCREE_BVH_LAUNCH_H
#define SCREE_BVH_LAUNCH_H

#include "bvh/broad_phase_kernel.h"
#include "bvh/lbvh_build_kernel.h"
#include "core/launch_cpu.h"

SCREE_DECLARE_LAUNCH(scree_lbvh_bounds)     ///< over chunks of boxes
SCREE_DECLARE_LAUNCH(scree_lbvh_codes)      ///< over boxes
SCREE_DECLARE_LAUNCH(scree_lbvh_hierarchy)  ///< over inner nodes
SCREE_DECLARE_LAUNCH(scree_lbvh_left_turns) ///< over blocks of leaves
SCREE_DECLARE_LAUNCH(scree_lbvh_nodes)      ///< over blocks of leaves

SCREE_DECLARE_LAUNCH(scree_particle_pairs)   ///< over nodes
SCREE_DECLARE_LAUNCH(scree_wall_pairs)       ///< over blocks of particles
SCREE_DECLARE_LAUNCH(scree_pair_unpack)      ///< over pairs
SCREE_DECLARE_LAUNCH(scree_pair_own)         ///< over ids
SCREE_DECLARE_LAUNCH(scree_pair_second_keys) ///< over pairs
SCREE_DECLARE_LAUNCH(scree_pair_rows)        ///< over pairs

/// The pairs of scree_particle_pairs_launch() over all nodes, found faster.
void scree_particle_pairs_find(scree_particle_pairs_args args);

#endif
