/// \file sphere_pairs.h
/// Host side of sphere_pairs_kernel.h, over the pairs of a batch unless stated.
#ifndef SCREE_SPHERE_PAIRS_H
#define SCREE_SPHERE_PAIRS_H

#include "contact/sphere_pairs_kernel.h"
#include "core/launch_cpu.h"

SCREE_DECLARE_LAUNCH(scree_place_spheres) ///< over bodies
SCREE_DECLARE_LAUNCH(scree_sphere_sphere_count)
SCREE_DECLARE_LAUNCH(scree_sphere_sphere_write)
SCREE_DECLARE_LAUNCH(scree_sphere_mesh_near)
SCREE_DECLARE_LAUNCH(scree_sphere_mesh_count)
SCREE_DECLARE_LAUNCH(scree_sphere_mesh_write)
SCREE_DECLARE_LAUNCH(scree_clump_clump_count)
SCREE_DECLARE_LAUNCH(scree_clump_clump_write)

#endif
