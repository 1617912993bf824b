/// \file pair_memory_kernel.h
/// What is known of a candidate pair of two meshes from step to step, and how it outlasts a search of candidates: each
/// new pair finds its old place in the group of its first body.
#ifndef SCREE_PAIR_MEMORY_KERNEL_H
#define SCREE_PAIR_MEMORY_KERNEL_H

#include "contact/narrow_phase.h"
#include "contact/pair_groups_kernel.h"

#include <float.h>

/// Most pairs of a bed do not touch, so this is what a pair costs in memory. Two numbers of 16 bits are enough for a
/// direction that is only tried first, single precision for a bound that is rounded down.
typedef struct scree_pair_memory
{
    uint16_t direction[2]; ///< out of i into j that separated it last time, or the normal of its contact, see
                           ///< scree_pack_direction(); zeros: none
    float apart_until;     ///< [m] sum of the travels of both bodies up to which it cannot touch; < 0: it touched
} scree_pair_memory;

#define SCREE_PAIR_TOUCHED (-1.0F)

/// Largest packed coordinate; the range -1 .. 1 starts at 1.
#define SCREE_PACKED_HALF ((scree_real)32767)

SCREE_FN uint16_t scree_pack_coordinate(scree_real x)
{
    return (uint16_t)((x + 1) * SCREE_PACKED_HALF + (scree_real)1.5);
}

SCREE_FN scree_real scree_unpack_coordinate(uint16_t packed)
{
    return (scree_real)(packed - 1) / SCREE_PACKED_HALF - 1;
}

/// The lower half of the octahedron |x| + |y| + |z| = 1 to the corners of the square around its upper half, and back.
SCREE_FN void scree_fold_octahedron(scree_real *x, scree_real *y)
{
    const scree_real u = 1 - scree_abs(*y), v = 1 - scree_abs(*x);
    *x = *x < 0 ? -u : u;
    *y = *y < 0 ? -v : v;
}

/// A direction of any length but 0 as its place on the octahedron, unfolded to a square (Meyer et al. 2010, On
/// floating-point normal vectors): right to 1e-4.
SCREE_FN void scree_pack_direction(scree_vec3 direction, uint16_t packed[2])
{
    const scree_real sum = scree_abs(direction.x) + scree_abs(direction.y) + scree_abs(direction.z);
    scree_real x = direction.x / sum, y = direction.y / sum;
    if (direction.z < 0) scree_fold_octahedron(&x, &y);
    packed[0] = scree_pack_coordinate(x);
    packed[1] = scree_pack_coordinate(y);
}

/// The direction, not of unit length; zero if there is none.
SCREE_FN scree_vec3 scree_unpack_direction(const uint16_t packed[2])
{
    if (packed[0] == 0) return scree_vec3_zero();
    scree_real x = scree_unpack_coordinate(packed[0]), y = scree_unpack_coordinate(packed[1]);
    const scree_real z = 1 - scree_abs(x) - scree_abs(y);
    if (z < 0) scree_fold_octahedron(&x, &y);
    return scree_vec3_make(x, y, z);
}

/// Bound of the travels for a pair with a gap: a hair less, for the rounding of the travels and of this number.
SCREE_FN float scree_apart_until(scree_real travelled, scree_real gap)
{
    return (float)(travelled + gap * (scree_real)0.999) * (1 - 4 * FLT_EPSILON);
}

/// Before a search: the bodies of each pair, and bounds that count from now on.
typedef struct scree_pair_keep_args
{
    scree_bodies bodies;               ///< as they are now, with their travels since the search before
    const scree_candidate_pair *pairs; ///< all candidate pairs
    const int32_t *batch;              ///< (num) indices of those of two meshes; NULL: all
    scree_pair_memory *memory;         ///< (num)
    int32_t *kept_i, *kept_j;          ///< (num) out
} scree_pair_keep_args;

/// Way that the travel of a body may lack for rounding: of the difference of two poses in each step, a few units of
/// its size, and of the sum over the steps.
SCREE_FN scree_real scree_travel_error(const scree_bodies *bodies, int32_t i)
{
    const scree_real size = bodies->shapes[bodies->shape[i]].bounding_radius * bodies->pose[i].scale;
    return 16 * SCREE_REAL_EPSILON * (scree_real)bodies->num_steps * (size + bodies->travel[i]);
}

SCREE_FN void scree_pair_keep_at(scree_pair_keep_args a, int64_t m)
{
    const scree_candidate_pair pair = a.pairs[scree_pair_of_batch(a.batch, m)];
    a.kept_i[m] = pair.i;
    a.kept_j[m] = pair.j;
    if (!(a.memory[m].apart_until > 0)) return;
    const scree_real travelled = a.bodies.travel[pair.i] + a.bodies.travel[pair.j];
    const scree_real error = scree_travel_error(&a.bodies, pair.i) + scree_travel_error(&a.bodies, pair.j);
    const scree_real left = (scree_real)a.memory[m].apart_until - travelled - error;
    a.memory[m].apart_until = left > 0 ? (float)left * (1 - 4 * FLT_EPSILON) : 0;
}

/// After it: what is known to the present pairs.
typedef struct scree_pair_carry_args
{
    const scree_candidate_pair *pairs;   ///< all candidate pairs
    const int32_t *batch;                ///< (num) indices of those of two meshes; NULL: all
    scree_pair_memory *memory;           ///< (num) out
    scree_pair_groups kept;              ///< (num_kept) the pairs before
    const scree_pair_memory *old_memory; ///< (num_kept)
} scree_pair_carry_args;

SCREE_FN void scree_pair_carry_at(scree_pair_carry_args a, int64_t m)
{
    const scree_candidate_pair pair = a.pairs[scree_pair_of_batch(a.batch, m)];
    const int32_t old = scree_group_find(&a.kept, pair.i, scree_group_id(&a.kept, pair.j));
    scree_pair_memory memory;
    memory.direction[0] = memory.direction[1] = 0;
    memory.apart_until = 0;
    if (old < a.kept.end[pair.i] && a.kept.second[old * a.kept.stride] == pair.j) memory = a.old_memory[old];
    a.memory[m] = memory;
}

#endif
