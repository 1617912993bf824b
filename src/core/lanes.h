/// \file lanes.h
/// Contacts side by side: on the CPU the contacts of true spheres are worked on in groups, component by component, so
/// that compilers make vectors of the same kernel bodies that a GPU runs one by one. A lane knows nothing of the
/// others, so the results are those of the bodies to the last bit.
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

static inline scree_vec3 scree_lanes_get(const scree_lanes_vec3 *lanes, int lane)
{
    return scree_vec3_make(lanes->x[lane], lanes->y[lane], lanes->z[lane]);
}

#endif
