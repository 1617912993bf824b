#include "core/launch_cuda.cuh"
#include "core/permute_kernel.h"

SCREE_DEFINE_LAUNCH(scree_permute)
