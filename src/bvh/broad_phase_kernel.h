/// \file broad_phase_kernel.h
/// Search for candidate pairs: box against tree, sphere against the trees of walls, sorted keys to pairs and rows.
/// Found pairs are appended to one list of keys in no particular order; sorting the keys, which are unique, gives the
/// same list however the work was shared.
#ifndef SCREE_BROAD_PHASE_KERNEL_H
#define SCREE_BROAD_PHASE_KERNEL_H

#include "bvh/broad_phase.h"
#include "core/atomic_kernel.h"

/// Keys that a call collects before it takes a place in the list for all of them: a local array, on a GPU shared memory
/// of its own, because a local array lies in the memory of the device there. A block has SCREE_PAIR_STRIDE threads at
/// most.
#ifdef __CUDA_ARCH__
#define SCREE_PAIR_BATCH 16
#define SCREE_PAIR_STRIDE 128
#define SCREE_PAIR_KEYS(keys)                                                  \
    __shared__ uint64_t keys##_of_block[SCREE_PAIR_BATCH * SCREE_PAIR_STRIDE]; \
    uint64_t *const keys = keys##_of_block + threadIdx.x
#else
#define SCREE_PAIR_BATCH 32
#define SCREE_PAIR_STRIDE 1
#define SCREE_PAIR_KEYS(keys) uint64_t keys[SCREE_PAIR_BATCH]
#endif

/// Where found pairs go. Key of (i, j): place of i << id_bits | id of j, where the id of i is the smaller one.
typedef struct scree_pair_list
{
    uint64_t *keys;    ///< (max_keys)
    int64_t *num_keys; ///< counts on beyond max_keys, so that the next try has room
    int64_t max_keys;
    const int32_t *ids; ///< (num_bodies) of the body in each place, or NULL: places are ids
    int32_t id_bits;    ///< bits that hold every id, at most 31
} scree_pair_list;

/// Keys on their way to the list.
typedef struct scree_pair_batch
{
    uint64_t *keys; ///< (SCREE_PAIR_BATCH), SCREE_PAIR_STRIDE from one to the next
    int32_t num_keys;
} scree_pair_batch;

/// Of the bodies in places a and b.
SCREE_FN uint64_t scree_pair_key(scree_pair_list list, int32_t a, int32_t b)
{
    const int32_t id_a = list.ids ? list.ids[a] : a, id_b = list.ids ? list.ids[b] : b;
    return id_a < id_b ? (uint64_t)a << list.id_bits | (uint64_t)id_b : (uint64_t)b << list.id_bits | (uint64_t)id_a;
}

/// Appends keys; those beyond the end of the list are only counted.
SCREE_FN void scree_pair_list_append(scree_pair_list list, const uint64_t *keys, int32_t num_keys)
{
    if (num_keys == 0) return;
    const int64_t begin = scree_atomic_add_int64(list.num_keys, num_keys);
    for (int32_t k = 0; k < num_keys && begin + k < list.max_keys; ++k) list.keys[begin + k] = keys[k];
}

SCREE_FN void scree_pair_batch_append(const scree_pair_batch *batch, scree_pair_list list)
{
    if (batch->num_keys == 0) return;
    const int64_t begin = scree_atomic_count(list.num_keys, batch->num_keys);
    for (int32_t k = 0; k < batch->num_keys && begin + k < list.max_keys; ++k)
        list.keys[begin + k] = batch->keys[k * SCREE_PAIR_STRIDE];
}

SCREE_FN void scree_pair_batch_add(scree_pair_batch *batch, scree_pair_list list, int32_t a, int32_t b)
{
    if (batch->num_keys == SCREE_PAIR_BATCH)
    {
        scree_pair_batch_append(batch, list);
        batch->num_keys = 0;
    }
    batch->keys[batch->num_keys++ * SCREE_PAIR_STRIDE] = scree_pair_key(list, a, b);
}

/// Pairs of particles.
typedef struct scree_particle_pairs_args
{
    scree_lbvh_view tree;
    scree_pair_list list;
    const scree_vec3 *centres; ///< (num_particles) of bounding spheres; NULL: not compared
    const scree_real *radii;   ///< (num_particles)
} scree_particle_pairs_args;

/// Do the bounding spheres of two particles overlap, or are they not asked for?
SCREE_FN bool scree_spheres_overlap(const scree_vec3 *centres, const scree_real *radii, int32_t a, int32_t b)
{
    if (!centres) return true;
    const scree_vec3 between = scree_vec3_sub(centres[a], centres[b]);
    const scree_real sum = radii[a] + radii[b];
    return scree_vec3_dot(between, between) <= sum * sum;
}

/// Half traversal for node k: a leaf looks for overlaps among the leaves after it, so each pair is met once.
/// Prokopenko & Lebrun-Grandie (2024). Plain version; on the CPU a faster one stands in for it, see
/// broad_phase_cpu.c.
SCREE_FN void scree_particle_pairs_at(scree_particle_pairs_args a, int64_t k)
{
    const scree_lbvh_node node = a.tree.nodes[k];
    if (node.first_child >= 0) return;
    SCREE_PAIR_KEYS(keys);
    scree_pair_batch batch = {keys, 0};
    int32_t next = node.escape;
    for (;;)
    {
        const int32_t other = scree_lbvh_next_overlap(a.tree, node.box, next, &next);
        if (other < 0) break;
        if (scree_spheres_overlap(a.centres, a.radii, -1 - node.first_child, other))
            scree_pair_batch_add(&batch, a.list, -1 - node.first_child, other);
    }
    scree_pair_batch_append(&batch, a.list);
}

/// Pairs of a particle and a wall.
typedef struct scree_wall_pairs_args
{
    const scree_vec3 *centres;           ///< (num_particles)
    const scree_real *radii;             ///< (num_particles)
    const scree_broad_phase_wall *walls; ///< (num_walls)
    int64_t num_particles;
    int64_t num_walls;
    int64_t block_particles; ///< particles per call
    scree_pair_list list;
} scree_wall_pairs_args;

/// A sphere in the frame of a wall, with room for all rounding on the way. With t = centre - position, the rotation
/// matrix is wrong by at most 8 eps per entry for a quaternion that is a unit to 2 eps, its product with t by another
/// 3 eps |t|_1, the difference t and the quotient by eps each: 16 eps |t|_1 bounds each coordinate's error, and so
/// 32 eps |t|_1 the error of the distance. Another 16 eps of the radius cover its quotient and the squares and sums
/// of the comparison of distances.
SCREE_FN scree_real scree_sphere_to_wall(scree_vec3 *centre, scree_real radius, scree_pose pose)
{
    const scree_vec3 t = scree_vec3_sub(*centre, pose.position);
    const scree_real length = scree_abs(t.x) + scree_abs(t.y) + scree_abs(t.z);
    const scree_vec3 local = scree_mat3_apply_transposed(scree_mat3_from_quat(pose.orientation), t);
    *centre = scree_vec3_make(local.x / pose.scale, local.y / pose.scale, local.z / pose.scale);
    return (radius * (1 + 16 * SCREE_REAL_EPSILON) + 32 * SCREE_REAL_EPSILON * length) / pose.scale;
}

/// Walls met by the spheres of one block of particles.
SCREE_FN void scree_wall_pairs_at(scree_wall_pairs_args a, int64_t block)
{
    const int64_t begin = block * a.block_particles;
    const int64_t end = begin + a.block_particles < a.num_particles ? begin + a.block_particles : a.num_particles;
    SCREE_PAIR_KEYS(keys);
    scree_pair_batch batch = {keys, 0};
    for (int64_t w = 0; w < a.num_walls; ++w)
    {
        if (!a.walls[w].is_present) continue;
        for (int64_t i = begin; i < end; ++i)
        {
            scree_vec3 centre = a.centres[i];
            const scree_real radius = scree_sphere_to_wall(&centre, a.radii[i], a.walls[w].pose);
            if (scree_lbvh_meets_sphere(a.walls[w].tree, centre, radius))
                scree_pair_batch_add(&batch, a.list, (int32_t)i, (int32_t)(a.num_particles + w));
        }
    }
    scree_pair_batch_append(&batch, a.list);
}

/// Sorted keys to pairs and rows. The pairs in which a body is the first one stand next to each other, by the ids of
/// the second ones; a body's row holds those in which it is the second, by the ids of the first ones.
typedef struct scree_pair_rows_args
{
    const uint64_t *keys;        ///< (num_pairs) sorted
    uint64_t *second_keys;       ///< (num_pairs) place of j << 32 | pair; first by the ids of i, then sorted by j
    scree_candidate_pair *pairs; ///< (num_pairs)
    int32_t *own_begin;          ///< (num_bodies + 1) pairs before the first one with i >= body
    int32_t *own_before;         ///< (num_bodies + 1) own pairs of all bodies of smaller ids; only if there are ids
    int32_t *row_begin;          ///< (num_bodies + 1) second keys before the first one with j >= body
    int32_t *row_pairs;          ///< (num_pairs)
    const int32_t *ids;          ///< (num_bodies) of the body in each place, or NULL: places are ids
    const int32_t *places;       ///< (num_bodies) of the body of each id, or NULL
    int64_t num_pairs;
    int64_t num_bodies;
    int32_t id_bits;
} scree_pair_rows_args;

typedef scree_pair_rows_args scree_pair_unpack_args;
typedef scree_pair_rows_args scree_pair_own_args;
typedef scree_pair_rows_args scree_pair_second_keys_args;

/// Entry p of a sorted list has body `place`, the entry before it `previous` (-1 for the first one): p is the beginning
/// of all bodies above `previous` up to `place`. The last entry also begins what follows.
SCREE_FN void scree_pair_mark_begins(scree_pair_rows_args a, int32_t *first, int64_t p, int64_t previous, int64_t place)
{
    for (int64_t body = previous + 1; body <= place; ++body) first[body] = (int32_t)p;
    if (p + 1 < a.num_pairs) return;
    for (int64_t body = place + 1; body <= a.num_bodies; ++body) first[body] = (int32_t)a.num_pairs;
}

/// Pair p from its key.
SCREE_FN void scree_pair_unpack_at(scree_pair_unpack_args a, int64_t p)
{
    const uint64_t key = a.keys[p], mask = ((uint64_t)1 << a.id_bits) - 1;
    const int32_t id = (int32_t)(key & mask);
    a.pairs[p].i = (int32_t)(key >> a.id_bits);
    a.pairs[p].j = a.places ? a.places[id] : id;
    const int64_t previous = p > 0 ? (int64_t)(a.keys[p - 1] >> a.id_bits) : -1;
    scree_pair_mark_begins(a, a.own_begin, p, previous, (int64_t)(key >> a.id_bits));
}

/// How many pairs the body of an id is the first one of; then these are added up.
SCREE_FN void scree_pair_own_at(scree_pair_own_args a, int64_t id)
{
    const int32_t place = a.places[id];
    a.own_before[id] = a.own_begin[place + 1] - a.own_begin[place];
}

/// Pair p to the second keys.
SCREE_FN void scree_pair_second_keys_at(scree_pair_second_keys_args a, int64_t p)
{
    const scree_candidate_pair pair = a.pairs[p];
    const int64_t k = a.ids ? a.own_before[a.ids[pair.i]] + (p - a.own_begin[pair.i]) : p;
    a.second_keys[k] = (uint64_t)pair.j << 32 | (uint64_t)p;
}

/// Entry q of the sorted second keys is that of the rows.
SCREE_FN void scree_pair_rows_at(scree_pair_rows_args a, int64_t q)
{
    const int64_t previous = q > 0 ? (int64_t)(a.second_keys[q - 1] >> 32) : -1;
    scree_pair_mark_begins(a, a.row_begin, q, previous, (int64_t)(a.second_keys[q] >> 32));
    a.row_pairs[q] = (int32_t)(a.second_keys[q] & 0xffffffffu);
}

#endif
