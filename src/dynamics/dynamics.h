/// \file dynamics.h
/// Host side of the kernels of this folder, all over particles.
#ifndef SCREE_DYNAMICS_H
#define SCREE_DYNAMICS_H

#include "core/launch_cpu.h"
#include "dynamics/integrator_kernel.h"
#include "dynamics/neighbour_kernel.h"

SCREE_DECLARE_LAUNCH(scree_predict)
SCREE_DECLARE_LAUNCH(scree_correct)
SCREE_DECLARE_LAUNCH(scree_boxes)

#endif
