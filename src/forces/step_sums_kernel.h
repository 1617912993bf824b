/// \file step_sums_kernel.h
/// Sums over contacts beyond their blocks: always the same ones in the same order, wherever they are made.
#ifndef SCREE_STEP_SUMS_KERNEL_H
#define SCREE_STEP_SUMS_KERNEL_H

#include "core/atomic_kernel.h"
#include "forces/work_kernel.h"

/// Sums that are added up by one index.
#define SCREE_SUM_FAN_IN 256

SCREE_FN scree_work_sums scree_work_sums_zero(void)
{
    scree_work_sums sums;
    sums.damping = 0;
    sums.friction = 0;
    sums.hysteresis = 0;
    sums.input = 0;
    sums.smallest_step_squared = SCREE_REAL_MAX;
    return sums;
}

typedef struct scree_work_reduce_args
{
    const scree_work_sums *parts; ///< (num_parts)
    int64_t num_parts;
    scree_work_sums *sums; ///< (one for SCREE_SUM_FAN_IN parts each) out
} scree_work_reduce_args;

/// Parts k SCREE_SUM_FAN_IN and on.
SCREE_FN void scree_work_reduce_at(scree_work_reduce_args a, int64_t k)
{
    scree_work_sums sums = scree_work_sums_zero();
    const int64_t begin = k * SCREE_SUM_FAN_IN;
    int64_t end = begin + SCREE_SUM_FAN_IN;
    if (end > a.num_parts) end = a.num_parts;
    for (int64_t i = begin; i < end; ++i)
    {
        const scree_work_sums part = a.parts[i];
        sums.damping += part.damping;
        sums.friction += part.friction;
        sums.hysteresis += part.hysteresis;
        sums.input += part.input;
        sums.smallest_step_squared = scree_min(sums.smallest_step_squared, part.smallest_step_squared);
    }
    a.sums[k] = sums;
}

typedef struct scree_ended_args
{
    const scree_real *elastic_energy; ///< [J] (num_old)
    const scree_real *spring_energy;  ///< [J] (num_old)
    const uint8_t *is_continued;      ///< (num_old)
    int64_t num_old;
    scree_work_sums *sums; ///< (num_blocks) out
} scree_ended_args;

/// Energy that ended contacts had stored: lost by the normal springs (hysteresis) and the tangential ones (friction).
/// Block b of SCREE_WORK_BLOCK old contacts.
SCREE_FN void scree_ended_at(scree_ended_args a, int64_t b)
{
    scree_work_sums sums = scree_work_sums_zero();
    const int64_t begin = b * SCREE_WORK_BLOCK;
    int64_t end = begin + SCREE_WORK_BLOCK;
    if (end > a.num_old) end = a.num_old;
    for (int64_t o = begin; o < end; ++o)
    {
        if (a.is_continued[o]) continue;
        sums.hysteresis += a.elastic_energy[o];
        sums.friction += a.spring_energy[o];
    }
    a.sums[b] = sums;
}

typedef struct scree_wall_load_reduce_args
{
    const scree_real *parts; ///< (num_parts, num_moving)
    int64_t num_parts;
    int64_t num_moving;
    scree_real *sums; ///< (one for SCREE_SUM_FAN_IN parts each, num_moving) out
} scree_wall_load_reduce_args;

/// Moving wall k % num_moving of sum k / num_moving.
SCREE_FN void scree_wall_load_reduce_at(scree_wall_load_reduce_args a, int64_t k)
{
    const int64_t wall = k % a.num_moving, begin = k / a.num_moving * SCREE_SUM_FAN_IN;
    int64_t end = begin + SCREE_SUM_FAN_IN;
    if (end > a.num_parts) end = a.num_parts;
    scree_real sum = 0;
    for (int64_t i = begin; i < end; ++i) sum += a.parts[i * a.num_moving + wall];
    a.sums[k] = sum;
}

typedef struct scree_indentations_args
{
    const scree_real *indentation; ///< [m] (num_contacts)
    int64_t num_contacts;
    scree_maximum *largest; ///< [m]
} scree_indentations_args;

/// Block b of SCREE_WORK_BLOCK contacts.
SCREE_FN void scree_indentations_at(scree_indentations_args a, int64_t b)
{
    const int64_t begin = b * SCREE_WORK_BLOCK;
    int64_t end = begin + SCREE_WORK_BLOCK;
    if (end > a.num_contacts) end = a.num_contacts;
    scree_real largest = 0;
    for (int64_t c = begin; c < end; ++c) largest = scree_max(largest, a.indentation[c]);
    scree_atomic_max(a.largest, largest);
}

#endif
