/// \file lanes.h
/// Contacts side by side: on the CPU the contacts of true spheres are worked on in groups, component by component, so
/// that compilers make vectors of the same kernel bodies that a GPU runs one by one. A lane knows nothing of the
/// others, so the results are those of the bodies to the last bit.
///
/// Half of the work is to bring what lies in memory item by item into lanes and back: four numbers of four items are
/// turned in registers, by the vector extensions of GCC and Clang.
#ifndef SCREE_LANES_H
#define SCREE_LANES_H

#include "core/vec.h"

/// A function that holds a lane loop: all that it calls becomes part of it, and where the processor has longer vectors
/// they are used. AVX2 brings no multiply-add with it, so the bits stay the same.
#if defined(__x86_64__) && !defined(__clang__) && !defined(SCREE_CHECKED)
#define SCREE_LANES_FUNCTION __attribute__((flatten, target_clones("avx2", "default")))
#else
#define SCREE_LANES_FUNCTION __attribute__((flatten))
#endif

/// Items of a group.
enum
{
    SCREE_LANES = 8
};

typedef struct scree_lanes_vec3
{
    scree_real x[SCREE_LANES], y[SCREE_LANES], z[SCREE_LANES];
} scree_lanes_vec3;

static inline void scree_lanes_set(scree_lanes_vec3 *lanes, int lane, scree_vec3 v)
{
    lanes->x[lane] = v.x;
    lanes->y[lane] = v.y;
    lanes->z[lane] = v.z;
}

static inline void scree_lanes_copy(scree_real *to, const scree_real *from)
{
    for (int l = 0; l < SCREE_LANES; ++l) to[l] = from[l];
}

/// Is a truth, 1 or 0, nowhere 1?
static inline bool scree_lanes_is_none(const scree_real *truth)
{
    scree_real num = 0;
    for (int l = 0; l < SCREE_LANES; ++l) num += truth[l];
    return !(num > 0);
}

static inline scree_vec3 scree_lanes_get(const scree_lanes_vec3 *lanes, int lane)
{
    return scree_vec3_make(lanes->x[lane], lanes->y[lane], lanes->z[lane]);
}

/// Four numbers at once, and the same where they need not be aligned or belong to some structure.
typedef scree_real scree_quad __attribute__((vector_size(4 * sizeof(scree_real))));
typedef scree_real scree_loose_quad
    __attribute__((vector_size(4 * sizeof(scree_real)), aligned(sizeof(scree_real)), may_alias));

/// Items first .. first + SCREE_LANES - 1 of an array of vectors.
static inline void scree_lanes_load(scree_lanes_vec3 *lanes, const scree_vec3 *first)
{
    for (int l = 0; l < SCREE_LANES; l += 4)
    {
        // x0 y0 z0 x1, y1 z1 x2 y2, z2 x3 y3 z3
        const scree_loose_quad *q = (const scree_loose_quad *)(first + l);
        const scree_quad q0 = q[0], q1 = q[1], q2 = q[2];
        const scree_quad a = __builtin_shufflevector(q0, q1, 0, 1, 6, 7);
        const scree_quad b = __builtin_shufflevector(q0, q2, 2, 3, 4, 5);
        const scree_quad c = __builtin_shufflevector(q1, q2, 0, 1, 6, 7);
        *(scree_loose_quad *)(lanes->x + l) = __builtin_shufflevector(a, b, 0, 5, 2, 7);
        *(scree_loose_quad *)(lanes->y + l) = __builtin_shufflevector(a, c, 1, 4, 3, 6);
        *(scree_loose_quad *)(lanes->z + l) = __builtin_shufflevector(b, c, 0, 5, 2, 7);
    }
}

/// The way back.
static inline void scree_lanes_store(scree_vec3 *first, const scree_lanes_vec3 *lanes)
{
    for (int l = 0; l < SCREE_LANES; l += 4)
    {
        const scree_quad x = *(const scree_loose_quad *)(lanes->x + l), y = *(const scree_loose_quad *)(lanes->y + l),
                         z = *(const scree_loose_quad *)(lanes->z + l);
        const scree_quad a = __builtin_shufflevector(x, y, 0, 4, 2, 6);
        const scree_quad b = __builtin_shufflevector(z, x, 0, 5, 2, 7);
        const scree_quad c = __builtin_shufflevector(y, z, 1, 5, 3, 7);
        scree_loose_quad *q = (scree_loose_quad *)(first + l);
        q[0] = __builtin_shufflevector(a, b, 0, 1, 4, 5);
        q[1] = __builtin_shufflevector(c, a, 0, 1, 6, 7);
        q[2] = __builtin_shufflevector(b, c, 2, 3, 6, 7);
    }
}

/// Items 0, 1, ... of an array, for scree_lanes_gather().
static const int32_t scree_lanes_in_order[SCREE_LANES] = {0, 1, 2, 3, 4, 5, 6, 7};

/// The first four numbers, a vector and a fourth one, of the items `index` of an array of items of `size` bytes.
static inline void scree_lanes_gather(scree_lanes_vec3 *lanes, scree_real *fourth, const void *items, int64_t size,
                                      const int32_t *index)
{
    const char *bytes = items;
    for (int l = 0; l < SCREE_LANES; l += 4)
    {
        const scree_quad q0 = *(const scree_loose_quad *)(bytes + index[l] * size);
        const scree_quad q1 = *(const scree_loose_quad *)(bytes + index[l + 1] * size);
        const scree_quad q2 = *(const scree_loose_quad *)(bytes + index[l + 2] * size);
        const scree_quad q3 = *(const scree_loose_quad *)(bytes + index[l + 3] * size);
        const scree_quad a = __builtin_shufflevector(q0, q1, 0, 4, 2, 6);
        const scree_quad b = __builtin_shufflevector(q0, q1, 1, 5, 3, 7);
        const scree_quad c = __builtin_shufflevector(q2, q3, 0, 4, 2, 6);
        const scree_quad d = __builtin_shufflevector(q2, q3, 1, 5, 3, 7);
        *(scree_loose_quad *)(lanes->x + l) = __builtin_shufflevector(a, c, 0, 1, 4, 5);
        *(scree_loose_quad *)(lanes->y + l) = __builtin_shufflevector(b, d, 0, 1, 4, 5);
        *(scree_loose_quad *)(lanes->z + l) = __builtin_shufflevector(a, c, 2, 3, 6, 7);
        *(scree_loose_quad *)(fourth + l) = __builtin_shufflevector(b, d, 2, 3, 6, 7);
    }
}

/// The way back, to SCREE_LANES items of `size` bytes from `items` on.
static inline void scree_lanes_scatter(void *items, int64_t size, const scree_lanes_vec3 *lanes,
                                       const scree_real *fourth)
{
    char *bytes = items;
    for (int l = 0; l < SCREE_LANES; l += 4)
    {
        const scree_quad x = *(const scree_loose_quad *)(lanes->x + l), y = *(const scree_loose_quad *)(lanes->y + l),
                         z = *(const scree_loose_quad *)(lanes->z + l), w = *(const scree_loose_quad *)(fourth + l);
        const scree_quad a = __builtin_shufflevector(x, y, 0, 4, 2, 6);
        const scree_quad b = __builtin_shufflevector(x, y, 1, 5, 3, 7);
        const scree_quad c = __builtin_shufflevector(z, w, 0, 4, 2, 6);
        const scree_quad d = __builtin_shufflevector(z, w, 1, 5, 3, 7);
        *(scree_loose_quad *)(bytes + l * size) = __builtin_shufflevector(a, c, 0, 1, 4, 5);
        *(scree_loose_quad *)(bytes + (l + 1) * size) = __builtin_shufflevector(b, d, 0, 1, 4, 5);
        *(scree_loose_quad *)(bytes + (l + 2) * size) = __builtin_shufflevector(a, c, 2, 3, 6, 7);
        *(scree_loose_quad *)(bytes + (l + 3) * size) = __builtin_shufflevector(b, d, 2, 3, 6, 7);
    }
}

#endif
