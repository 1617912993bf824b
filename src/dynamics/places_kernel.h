/// \file places_kernel.h
/// Have neighbours come apart in memory, and new places for all bodies.
#ifndef SCREE_PLACES_KERNEL_H
#define SCREE_PLACES_KERNEL_H

#include "bvh/broad_phase.h"
#include "core/atomic_kernel.h"

/// Particles that one index looks at.
#define SCREE_FAR_BLOCK 1024
/// Diameters within which particles are near each other: some thousand of them fit there, and into a core's cache.
#define SCREE_NEAR_DIAMETERS 8

typedef struct scree_far_followers_args
{
    const scree_vec3 *centres; ///< [m] (num_particles)
    const scree_real *radii;   ///< [m] (num_particles)
    const int32_t *order;      ///< (num_particles) in which they follow each other, or NULL: as they lie in memory
    int64_t num_particles;
    int64_t *num_far; ///< counts
} scree_far_followers_args;

/// Of block b of particles, those which the next one is far from in space.
SCREE_FN void scree_far_followers_at(scree_far_followers_args a, int64_t b)
{
    const int64_t begin = b * SCREE_FAR_BLOCK, last = a.num_particles - 1;
    const int64_t end = begin + SCREE_FAR_BLOCK < last ? begin + SCREE_FAR_BLOCK : last;
    int64_t num = 0;
    for (int64_t k = begin; k < end; ++k)
    {
        const int64_t i = a.order ? a.order[k] : k, next = a.order ? a.order[k + 1] : k + 1;
        const scree_vec3 between = scree_vec3_sub(a.centres[next], a.centres[i]);
        const scree_real near = SCREE_NEAR_DIAMETERS * (a.radii[i] + a.radii[next]);
        num += scree_vec3_dot(between, between) > near * near ? 1 : 0;
    }
    if (num > 0) scree_atomic_count(a.num_far, num);
}

typedef struct scree_home_order_args
{
    int32_t *ids, *places, *order; ///< (num_bodies) out
} scree_home_order_args;

/// Body k is home and stays there.
SCREE_FN void scree_home_order_at(scree_home_order_args a, int64_t k)
{
    a.ids[k] = a.places[k] = a.order[k] = (int32_t)k;
}

typedef struct scree_new_places_args
{
    const int32_t *order;   ///< (num_bodies) old place of the body that each place gets
    const int32_t *old_ids; ///< (num_bodies) ids of the bodies in the old places
    int32_t *ids;           ///< (num_bodies) out: in the new ones
    int32_t *places;        ///< (num_bodies) out: new place of each id
    int32_t *moved_to;      ///< (num_bodies) out: new place of what was in each old one
} scree_new_places_args;

/// Place k.
SCREE_FN void scree_new_places_at(scree_new_places_args a, int64_t k)
{
    const int32_t old = a.order[k], id = a.old_ids[old];
    a.ids[k] = id;
    a.places[id] = (int32_t)k;
    a.moved_to[old] = (int32_t)k;
}

typedef struct scree_move_pairs_args
{
    scree_candidate_pair *pairs; ///< (num_pairs)
    const int32_t *moved_to;     ///< (num_bodies)
} scree_move_pairs_args;

/// Pair p follows its bodies.
SCREE_FN void scree_move_pairs_at(scree_move_pairs_args a, int64_t p)
{
    const scree_candidate_pair pair = a.pairs[p];
    a.pairs[p].i = a.moved_to[pair.i];
    a.pairs[p].j = a.moved_to[pair.j];
}

typedef struct scree_sort_groups_args
{
    const int32_t *begin; ///< (num_bodies) first contact of each first body
    const int32_t *end;   ///< (num_bodies) the contact behind its last one
    int32_t *first;       ///< (num_bodies) how many there are, then their sums: where they come to stand
    int32_t *order;       ///< (num_contacts) out: which contact comes to each place
} scree_sort_groups_args;

typedef scree_sort_groups_args scree_group_sizes_args;

SCREE_FN void scree_group_sizes_at(scree_group_sizes_args a, int64_t i) { a.first[i] = a.end[i] - a.begin[i]; }

/// The contacts of body i.
SCREE_FN void scree_sort_groups_at(scree_sort_groups_args a, int64_t i)
{
    for (int32_t c = a.begin[i]; c < a.end[i]; ++c) a.order[a.first[i] + (c - a.begin[i])] = c;
}

#endif
