#include "core/launch_cuda.cuh"
#include "dynamics/integrator_kernel.h"
#include "dynamics/neighbour_kernel.h"

SCREE_DEFINE_LAUNCH(scree_predict)
SCREE_DEFINE_LAUNCH(scree_correct)
SCREE_DEFINE_LAUNCH(scree_boxes)
