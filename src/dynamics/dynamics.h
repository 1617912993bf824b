/// \file dynamics.h
/// Host side of the kernels of this folder, over particles unless stated.
#ifndef SCREE_DYNAMICS_H
#define SCREE_DYNAMICS_H

#include "core/launch_cpu.h"
#include "dynamics/body_kernel.h"
#include "dynamics/integrator_kernel.h"
#include "dynamics/neighbour_kernel.h"

SCREE_DECLARE_LAUNCH(scree_predict)
SCREE_DECLARE_LAUNCH(scree_correct)
SCREE_DECLARE_LAUNCH(scree_boxes)
SCREE_DECLARE_LAUNCH(scree_travel)      ///< over bodies
SCREE_DECLARE_LAUNCH(scree_skin)        ///< over one index
SCREE_DECLARE_LAUNCH(scree_place_walls) ///< over walls
SCREE_DECLARE_LAUNCH(scree_place_particles)

#endif
