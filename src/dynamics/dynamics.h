/// \file dynamics.h
/// Host side of the kernels of this folder, over particles unless stated.
#ifndef SCREE_DYNAMICS_H
#define SCREE_DYNAMICS_H

#include "core/launch_cpu.h"
#include "dynamics/body_kernel.h"
#include "dynamics/integrator_kernel.h"
#include "dynamics/neighbour_kernel.h"
#include "dynamics/places_kernel.h"

SCREE_DECLARE_LAUNCH(scree_predict)
SCREE_DECLARE_LAUNCH(scree_correct)
SCREE_DECLARE_LAUNCH(scree_boxes)
SCREE_DECLARE_LAUNCH(scree_travel)      ///< over bodies
SCREE_DECLARE_LAUNCH(scree_skin)        ///< over one index
SCREE_DECLARE_LAUNCH(scree_place_walls) ///< over walls
SCREE_DECLARE_LAUNCH(scree_place_particles)
SCREE_DECLARE_LAUNCH(scree_far_followers) ///< over blocks of SCREE_FAR_BLOCK particles
SCREE_DECLARE_LAUNCH(scree_home_order)    ///< over bodies
SCREE_DECLARE_LAUNCH(scree_new_places)    ///< over bodies
SCREE_DECLARE_LAUNCH(scree_move_pairs)    ///< over pairs
SCREE_DECLARE_LAUNCH(scree_group_sizes)   ///< over bodies
SCREE_DECLARE_LAUNCH(scree_sort_groups)   ///< over bodies

#endif
