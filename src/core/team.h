/// \file team.h
/// A team of lanes that work on one item together: 8, 16 or 32 neighbouring threads of a warp on a GPU, one everywhere
/// else. Lane l takes items l, l + size, ... of a loop. What the team agrees on is the same for any size: items that
/// are kept stay in their order, and sums are taken in turns, item by item. All lanes call each of these functions
/// together; for a team of one they are nothing.
#ifndef SCREE_TEAM_H
#define SCREE_TEAM_H

#include "core/bits.h"

/// A function with registers and stack of its own on a GPU: what one lane does, or what is seldom done.
#if defined(__CUDACC__) && !defined(CUDA_ON_CPU_CUDA_RUNTIME_H)
#define SCREE_FN_APART static __host__ __device__ __noinline__ __attribute__((unused))
#else
#define SCREE_FN_APART SCREE_FN
#endif

typedef struct scree_team
{
    int32_t lane; ///< of this thread, in [0, size)
    int32_t size;
    uint32_t mask; ///< of the lanes in their warp
} scree_team;

// where lanes can meet: in kernels, and in those that the stand-in for a GPU runs
#if defined(__CUDA_ARCH__) || defined(CUDA_ON_CPU_CUDA_RUNTIME_H)
#define SCREE_TEAM_OF_MANY 1
#endif

SCREE_FN scree_team scree_team_alone(void)
{
    scree_team team;
    team.lane = 0;
    team.size = 1;
    team.mask = 1;
    return team;
}

/// The team of a thread of a block, `size` lanes, a power of two up to 32.
SCREE_FN scree_team scree_team_of_thread(int32_t thread, int32_t size)
{
    scree_team team;
    team.lane = thread % size;
    team.size = size;
    team.mask = (0xffffffffu >> (32 - size)) << (thread % 32 - team.lane);
    return team;
}

/// Where only one lane can be, the compiler knows.
#ifdef SCREE_TEAM_OF_MANY
SCREE_FN int32_t scree_team_size(const scree_team *team) { return team->size; }
SCREE_FN int32_t scree_team_lane(const scree_team *team) { return team->lane; }
#else
SCREE_FN int32_t scree_team_size(const scree_team *team)
{
    (void)team;
    return 1;
}
SCREE_FN int32_t scree_team_lane(const scree_team *team)
{
    (void)team;
    return 0;
}
#endif
SCREE_FN bool scree_team_leads(const scree_team *team) { return scree_team_lane(team) == 0; }

/// What any lane wrote before, all read after.
SCREE_FN void scree_team_sync(const scree_team *team)
{
#ifdef SCREE_TEAM_OF_MANY
    if (team->size > 1) __syncwarp(team->mask);
#else
    (void)team;
#endif
}

/// Bit l: what lane l says.
SCREE_FN uint32_t scree_team_ballot(const scree_team *team, bool says)
{
#ifdef SCREE_TEAM_OF_MANY
    if (team->size > 1) return __ballot_sync(team->mask, says) >> scree_lowest_bit(team->mask);
#endif
    (void)team;
    return (uint32_t)says;
}
SCREE_FN bool scree_team_any(const scree_team *team, bool says) { return scree_team_ballot(team, says) != 0; }

SCREE_FN int32_t scree_team_num_bits(uint32_t word)
{
#ifdef __CUDA_ARCH__
    return __popc(word);
#else
    return __builtin_popcount(word);
#endif
}

/// Place of this lane's item behind *num others, if it is kept; *num grows by all that are. What the lanes have read
/// before may be written over after.
SCREE_FN int32_t scree_team_place(const scree_team *team, bool is_kept, int32_t *num)
{
    if (scree_team_size(team) == 1)
    {
        const int32_t place = *num;
        *num += (int32_t)is_kept;
        return place;
    }
    const uint32_t kept = scree_team_ballot(team, is_kept);
    const int32_t place = *num + scree_team_num_bits(kept & ((1u << scree_team_lane(team)) - 1));
    *num += scree_team_num_bits(kept);
    scree_team_sync(team);
    return place;
}
/// May this lane write to its place? A lane alone may always, so that it needs no branch.
SCREE_FN bool scree_team_writes(const scree_team *team, bool is_kept) { return scree_team_size(team) == 1 || is_kept; }

/// Sum and largest of what the lanes have, for numbers where the order does not matter.
SCREE_FN int32_t scree_team_sum(const scree_team *team, int32_t value)
{
#ifdef SCREE_TEAM_OF_MANY
    for (int32_t step = 1; step < team->size; step *= 2) value += __shfl_xor_sync(team->mask, value, step, team->size);
#endif
    (void)team;
    return value;
}
SCREE_FN scree_real scree_team_max(const scree_team *team, scree_real value)
{
#ifdef SCREE_TEAM_OF_MANY
    for (int32_t step = 1; step < team->size; step *= 2)
        value = scree_max(value, __shfl_xor_sync(team->mask, value, step, team->size));
#endif
    (void)team;
    return value;
}

SCREE_FN scree_vec3 scree_team_max3(const scree_team *team, scree_vec3 v)
{
    return scree_vec3_make(scree_team_max(team, v.x), scree_team_max(team, v.y), scree_team_max(team, v.z));
}

#endif
