#include "contact/mesh_pairs_kernel.h"
#include "contact/pair_kinds_kernel.h"
#include "contact/room_kernel.h"
#include "core/launch_cuda.cuh"

/// Blocks on a multiprocessor that leave scree_mesh_apart the registers it needs. In single precision ptxas would take
/// fewer of itself, and spill; 0: as ptxas has it.
#ifdef SCREE_SINGLE
#define SCREE_APART_BLOCKS 5
#else
#define SCREE_APART_BLOCKS 0
#endif

static __device__ void scree_mesh_gap_look_up(scree_mesh_gap_args *a, const scree_live *live, int64_t *)
{
    a->bodies.num_steps = live->num_steps;
}

SCREE_DEFINE_LAUNCH(scree_pair_flag)
SCREE_DEFINE_LAUNCH(scree_pair_scatter)
SCREE_DEFINE_LAUNCH(scree_pair_keep)
SCREE_DEFINE_LAUNCH(scree_pair_carry)
SCREE_DEFINE_LAUNCH_AS(scree_mesh_apart, SCREE_AS_RECORDED, SCREE_CUDA_BLOCK, SCREE_APART_BLOCKS)
SCREE_DEFINE_LAUNCH_AS(scree_mesh_gap, scree_mesh_gap_look_up, SCREE_CUDA_BLOCK, 1)
SCREE_DEFINE_LAUNCH(scree_mesh_write)
SCREE_DEFINE_LAUNCH(scree_room)
