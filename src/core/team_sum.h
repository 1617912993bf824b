/// \file team_sum.h
/// Sums of reals over the items of a block, of the same terms in the same order on every device: lane l of
/// SCREE_SUM_LANES adds up items l, l + SCREE_SUM_LANES, ..., then the upper half of the lanes is added to the lower
/// one, until one is left. On a GPU a warp makes the sum, whose threads read neighbouring items; elsewhere one thread
/// has all lanes, and compilers make vectors of them.
#ifndef SCREE_TEAM_SUM_H
#define SCREE_TEAM_SUM_H

#include "core/team.h"

#define SCREE_SUM_LANES 32

#ifdef SCREE_TEAM_OF_MANY
#define SCREE_SUM_LANES_OF_THREAD 1
#else
#define SCREE_SUM_LANES_OF_THREAD SCREE_SUM_LANES
#endif

/// Before a loop with long turns: unrolled for a GPU it would need twice the registers. The compiler of the host does
/// not know it.
#if defined(__CUDA_ARCH__) && !defined(CUDA_ON_CPU_CUDA_RUNTIME_H)
#define SCREE_TURN_BY_TURN _Pragma("unroll 1")
#else
#define SCREE_TURN_BY_TURN
#endif

/// The lanes of this thread. Start from scree_team_sum_zero().
typedef struct scree_team_real_sum
{
    scree_real lane[SCREE_SUM_LANES_OF_THREAD];
} scree_team_real_sum;

SCREE_FN void scree_team_sum_zero(scree_team_real_sum *sum)
{
    for (int32_t l = 0; l < SCREE_SUM_LANES_OF_THREAD; ++l) sum->lane[l] = 0;
}

/// Adds the value of item n of the block, which is one of this thread.
SCREE_FN void scree_team_sum_add(scree_team_real_sum *sum, int64_t n, scree_real value)
{
    sum->lane[n % SCREE_SUM_LANES_OF_THREAD] += value;
}

/// The sum of all lanes of a team of SCREE_SUM_LANES threads, or of the one thread that there is.
SCREE_FN scree_real scree_team_sum_total(const scree_team *team, scree_team_real_sum *sum)
{
#ifdef SCREE_TEAM_OF_MANY
    for (int32_t half = SCREE_SUM_LANES / 2; half > 0; half /= 2)
        sum->lane[0] += __shfl_xor_sync(team->mask, sum->lane[0], half, SCREE_SUM_LANES);
#else
    (void)team;
    for (int32_t half = SCREE_SUM_LANES / 2; half > 0; half /= 2)
        for (int32_t l = 0; l < half; ++l) sum->lane[l] += sum->lane[l + half];
#endif
    return sum->lane[0];
}

#endif
