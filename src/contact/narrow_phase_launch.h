/// \file narrow_phase_launch.h
/// The kernels of the narrow phase as loops over their index.
#ifndef SCREE_NARROW_PHASE_LAUNCH_H
#define SCREE_NARROW_PHASE_LAUNCH_H

#include "contact/overlap_pairs_kernel.h"
#include "contact/pair_kinds_kernel.h"
#include "contact/room_kernel.h"
#include "core/launch_cpu.h"

SCREE_DECLARE_LAUNCH(scree_pair_flag)       ///< over candidate pairs
SCREE_DECLARE_LAUNCH(scree_pair_scatter)    ///< over candidate pairs
SCREE_DECLARE_LAUNCH(scree_pair_keep)       ///< over pairs of meshes
SCREE_DECLARE_LAUNCH(scree_pair_carry)      ///< over pairs of meshes
SCREE_DECLARE_LAUNCH(scree_mesh_apart)      ///< over pairs of meshes
SCREE_DECLARE_LAUNCH(scree_overlap_pairs)   ///< over slices
SCREE_DECLARE_LAUNCH(scree_overlap_patches) ///< over slices
SCREE_DECLARE_LAUNCH(scree_mesh_gap)        ///< over pairs of meshes
SCREE_DECLARE_LAUNCH(scree_mesh_write)      ///< over pairs of meshes
SCREE_DECLARE_LAUNCH(scree_room)            ///< over one index

#endif
