#include "bvh/broad_phase_kernel.h"
#include "core/launch_cuda.cuh"

#ifdef __CUDA_ARCH__
static_assert(SCREE_PAIR_STRIDE == SCREE_CUDA_BLOCK, "a place in shared memory for every thread");
#endif

SCREE_DEFINE_LAUNCH(scree_particle_pairs)
SCREE_DEFINE_LAUNCH(scree_wall_pairs)
SCREE_DEFINE_LAUNCH(scree_pair_unpack)
SCREE_DEFINE_LAUNCH(scree_pair_own)
SCREE_DEFINE_LAUNCH(scree_pair_second_keys)
SCREE_DEFINE_LAUNCH(scree_pair_rows)
