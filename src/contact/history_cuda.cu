#include "contact/history_kernel.h"
#include "core/launch_cuda.cuh"

SCREE_DEFINE_LAUNCH(scree_group_bounds)
SCREE_DEFINE_LAUNCH(scree_history_match)
