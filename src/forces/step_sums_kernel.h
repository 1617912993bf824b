/// \file step_sums_kernel.h
/// Sums over bodies: always the same ones in the same order, wherever they are made.
#ifndef SCREE_STEP_SUMS_KERNEL_H
#define SCREE_STEP_SUMS_KERNEL_H

#include "core/atomic_kernel.h"
#include "forces/work_kernel.h"

/// Sums that are added up by one index.
#define SCREE_SUM_FAN_IN 256
/// Contacts of which one index finds the largest.
#define SCREE_CONTACT_BLOCK 256

typedef struct scree_work_reduce_args
{
    const scree_work_sums *parts; ///< (num_parts)
    int64_t num_parts;
    scree_work_sums *sums; ///< (one for SCREE_SUM_FAN_IN parts each, at least one) out
} scree_work_reduce_args;

/// Parts k SCREE_SUM_FAN_IN and on.
SCREE_FN void scree_work_reduce_team_at(scree_work_reduce_args a, const scree_team *team, int64_t k)
{
    scree_work_block block;
    scree_work_begin(&block);
    const int64_t begin = k * SCREE_SUM_FAN_IN;
    int64_t num = a.num_parts - begin;
    if (num > SCREE_SUM_FAN_IN) num = SCREE_SUM_FAN_IN;
    for (int64_t n = scree_team_lane(team); n < num; n += scree_team_size(team))
        scree_work_add_item(&block, n, a.parts[begin + n]);
    const scree_work_sums sums = scree_work_total(team, &block);
    if (scree_team_leads(team)) a.sums[k] = sums;
}

SCREE_FN void scree_work_reduce_at(scree_work_reduce_args a, int64_t k)
{
    const scree_team team = scree_team_alone();
    scree_work_reduce_team_at(a, &team, k);
}

typedef struct scree_wall_load_reduce_args
{
    const scree_real *parts; ///< (num_parts, num_moving)
    int64_t num_parts;
    int64_t num_moving;
    scree_real *sums; ///< (one for SCREE_SUM_FAN_IN parts each, at least one, num_moving) out
} scree_wall_load_reduce_args;

/// Moving wall k % num_moving of sum k / num_moving.
SCREE_FN void scree_wall_load_reduce_team_at(scree_wall_load_reduce_args a, const scree_team *team, int64_t k)
{
    const int64_t wall = k % a.num_moving, begin = k / a.num_moving * SCREE_SUM_FAN_IN;
    int64_t num = a.num_parts - begin;
    if (num > SCREE_SUM_FAN_IN) num = SCREE_SUM_FAN_IN;
    scree_team_real_sum sum;
    scree_team_sum_zero(&sum);
    for (int64_t n = scree_team_lane(team); n < num; n += scree_team_size(team))
        scree_team_sum_add(&sum, n, a.parts[(begin + n) * a.num_moving + wall]);
    const scree_real total = scree_team_sum_total(team, &sum);
    if (scree_team_leads(team)) a.sums[k] = total;
}

SCREE_FN void scree_wall_load_reduce_at(scree_wall_load_reduce_args a, int64_t k)
{
    const scree_team team = scree_team_alone();
    scree_wall_load_reduce_team_at(a, &team, k);
}

typedef struct scree_indentations_args
{
    const scree_real *indentation; ///< [m] (num_contacts)
    int64_t num_contacts;
    scree_maximum *largest; ///< [m]
} scree_indentations_args;

/// Block b of SCREE_CONTACT_BLOCK contacts.
SCREE_FN void scree_indentations_team_at(scree_indentations_args a, const scree_team *team, int64_t b)
{
    const int64_t begin = b * SCREE_CONTACT_BLOCK;
    int64_t num = a.num_contacts - begin;
    if (num > SCREE_CONTACT_BLOCK) num = SCREE_CONTACT_BLOCK;
    scree_real largest = 0;
    for (int64_t n = scree_team_lane(team); n < num; n += scree_team_size(team))
        largest = scree_max(largest, a.indentation[begin + n]);
    largest = scree_team_max(team, largest);
    if (scree_team_leads(team)) scree_atomic_max(a.largest, largest);
}

SCREE_FN void scree_indentations_at(scree_indentations_args a, int64_t b)
{
    const scree_team team = scree_team_alone();
    scree_indentations_team_at(a, &team, b);
}

#endif
