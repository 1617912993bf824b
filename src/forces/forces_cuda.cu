#include "core/launch_cuda.cuh"
#include "forces/collision_kernel.h"
#include "forces/contact_force_kernel.h"
#include "forces/gather_kernel.h"
#include "forces/step_sums_kernel.h"
#include "forces/wall_load_kernel.h"
#include "forces/work_kernel.h"

/// Sums of groups, one at least.
static __device__ int64_t count_sums(int64_t num_parts)
{
    const int64_t num_sums = scree_count_blocks(num_parts, SCREE_SUM_FAN_IN);
    return num_sums > 0 ? num_sums : 1;
}

// What was recorded for as many contacts as there is room for, when it is played.

static __device__ void scree_contact_force_look_up(scree_contact_force_args *, const scree_live *live, int64_t *num)
{
    *num = live->num_contacts;
}

/// Sums of old contacts that there is room for, but that there are not: the others stand behind them, right before
/// those of the present contacts.
static __device__ int64_t count_unused(const scree_live *live)
{
    return scree_count_blocks(live->max_old_contacts, SCREE_WORK_BLOCK) -
           scree_count_blocks(live->num_old_contacts, SCREE_WORK_BLOCK);
}

static __device__ void scree_ended_look_up(scree_ended_args *a, const scree_live *live, int64_t *num)
{
    a->num_old = live->num_old_contacts;
    a->sums += count_unused(live);
    *num = scree_count_blocks(a->num_old, SCREE_WORK_BLOCK);
}

static __device__ void scree_indentations_look_up(scree_indentations_args *a, const scree_live *live, int64_t *num)
{
    a->num_contacts = live->num_contacts;
    *num = scree_count_blocks(a->num_contacts, SCREE_WORK_BLOCK);
}

static __device__ void scree_work_look_up(scree_work_args *a, const scree_live *live, int64_t *num)
{
    a->contacts.num_contacts = live->num_contacts;
    *num = scree_count_blocks(live->num_contacts, SCREE_WORK_BLOCK);
}

static __device__ void scree_work_reduce_look_up(scree_work_reduce_args *a, const scree_live *live, int64_t *num)
{
    const int64_t num_blocks = scree_count_blocks(live->num_old_contacts, SCREE_WORK_BLOCK) +
                               scree_count_blocks(live->num_contacts, SCREE_WORK_BLOCK);
    a->num_parts = scree_count_blocks(num_blocks, a->per_part);
    if (a->per_part == 1) a->parts += count_unused(live);
    *num = count_sums(a->num_parts);
}

static __device__ void scree_wall_load_look_up(scree_wall_load_args *a, const scree_live *live, int64_t *num)
{
    a->contacts.num_contacts = live->num_contacts;
    *num = scree_count_blocks(live->num_contacts, SCREE_WALL_LOAD_BLOCK);
}

static __device__ void scree_wall_load_reduce_look_up(scree_wall_load_reduce_args *a, const scree_live *live,
                                                      int64_t *num)
{
    a->num_parts = scree_count_blocks(scree_count_blocks(live->num_contacts, SCREE_WALL_LOAD_BLOCK), a->per_part);
    *num = count_sums(a->num_parts) * a->num_moving;
}

SCREE_DEFINE_LAUNCH_LIVE(scree_contact_force)
SCREE_DEFINE_LAUNCH(scree_gather)
SCREE_DEFINE_LAUNCH(scree_collision)
SCREE_DEFINE_SUM_LAUNCH_LIVE(scree_wall_load)
// four blocks at a time: with five, the number that is looked up would need a stack on 12.0
SCREE_DEFINE_LAUNCH_OF_TEAMS(scree_work, scree_work_look_up, SCREE_SUM_LANES, SCREE_CUDA_BLOCK, 4)
SCREE_DEFINE_SUM_LAUNCH_LIVE(scree_work_reduce)
SCREE_DEFINE_SUM_LAUNCH_LIVE(scree_ended)
SCREE_DEFINE_SUM_LAUNCH_LIVE(scree_wall_load_reduce)
SCREE_DEFINE_SUM_LAUNCH_LIVE(scree_indentations)
SCREE_DEFINE_LAUNCH(scree_ended_flag)
SCREE_DEFINE_LAUNCH(scree_ended_collisions)
