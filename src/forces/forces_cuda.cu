#include "core/launch_cuda.cuh"
#include "forces/collision_kernel.h"
#include "forces/contact_force_kernel.h"
#include "forces/gather_kernel.h"
#include "forces/step_sums_kernel.h"
#include "forces/wall_load_kernel.h"
#include "forces/work_kernel.h"

// What was recorded for as many contacts as there is room for, when it is played.

static __device__ void scree_contact_force_look_up(scree_contact_force_args *, const scree_live *live, int64_t *num)
{
    *num = live->num_contacts;
}

static __device__ void scree_indentations_look_up(scree_indentations_args *a, const scree_live *live, int64_t *num)
{
    a->num_contacts = live->num_contacts;
    *num = scree_count_blocks(a->num_contacts, SCREE_CONTACT_BLOCK);
}

SCREE_DEFINE_LAUNCH_LIVE(scree_contact_force)
SCREE_DEFINE_LAUNCH(scree_gather)
SCREE_DEFINE_LAUNCH(scree_collision)
SCREE_DEFINE_LAUNCH(scree_wall_load)
// three blocks at a time: with four it would need a stack on 12.0
SCREE_DEFINE_LAUNCH_OF_TEAMS(scree_work, SCREE_AS_RECORDED, SCREE_SUM_LANES, SCREE_CUDA_BLOCK, 3)
SCREE_DEFINE_SUM_LAUNCH(scree_work_reduce)
SCREE_DEFINE_SUM_LAUNCH(scree_wall_load_reduce)
SCREE_DEFINE_SUM_LAUNCH_LIVE(scree_indentations)
SCREE_DEFINE_LAUNCH(scree_ended_flag)
SCREE_DEFINE_LAUNCH(scree_ended_collisions)
