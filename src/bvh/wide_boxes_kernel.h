/// \file wide_boxes_kernel.h
/// Eight boxes side by side in single precision, rounded outwards, held against one query together: with the vector
/// instructions that every x86-64 has, elsewhere one after the other. Only compared and multiplied, so that both give
/// the same.
#ifndef SCREE_WIDE_BOXES_KERNEL_H
#define SCREE_WIDE_BOXES_KERNEL_H

#include "core/vec.h"

#if defined(__SSE__) && !defined(__CUDACC__)
#include <xmmintrin.h>
#define SCREE_WIDE_SSE 1
#endif

#define SCREE_WIDE 8

typedef struct scree_wide_boxes
{
    float bounds[6][SCREE_WIDE]; ///< lower x, y, z, upper x, y, z
} scree_wide_boxes;

/// Largest float not above x and smallest not below, or one step beyond these.
SCREE_FN float scree_float_below(scree_real x)
{
    const float near = (float)x;
    return near - (near < 0 ? -near : near) * FLT_EPSILON - FLT_MIN;
}
SCREE_FN float scree_float_above(scree_real x) { return -scree_float_below(-x); }

/// A box, bound by bound.
typedef struct scree_wide_range
{
    float lower[3], upper[3];
} scree_wide_range;

/// Box i of eight.
SCREE_FN scree_wide_range scree_wide_boxes_get(const scree_wide_boxes *boxes, int32_t i)
{
    scree_wide_range range;
    for (int32_t k = 0; k < 3; ++k)
    {
        range.lower[k] = boxes->bounds[k][i];
        range.upper[k] = boxes->bounds[k + 3][i];
    }
    return range;
}
SCREE_FN void scree_wide_boxes_set(scree_wide_boxes *boxes, int32_t i, scree_wide_range range)
{
    for (int32_t k = 0; k < 3; ++k)
    {
        boxes->bounds[k][i] = range.lower[k];
        boxes->bounds[k + 3][i] = range.upper[k];
    }
}

/// Bits of the boxes that overlap the range; empty ones never do.
SCREE_FN uint32_t scree_wide_boxes_meet(const scree_wide_boxes *boxes, const scree_wide_range *range)
{
    uint32_t found = 0;
#ifdef SCREE_WIDE_SSE
    for (int32_t half = 0; half < SCREE_WIDE; half += 4)
    {
        __m128 meets = _mm_cmple_ps(_mm_loadu_ps(boxes->bounds[0] + half), _mm_set1_ps(range->upper[0]));
        meets = _mm_and_ps(meets, _mm_cmpge_ps(_mm_loadu_ps(boxes->bounds[3] + half), _mm_set1_ps(range->lower[0])));
        meets = _mm_and_ps(meets, _mm_cmple_ps(_mm_loadu_ps(boxes->bounds[1] + half), _mm_set1_ps(range->upper[1])));
        meets = _mm_and_ps(meets, _mm_cmpge_ps(_mm_loadu_ps(boxes->bounds[4] + half), _mm_set1_ps(range->lower[1])));
        meets = _mm_and_ps(meets, _mm_cmple_ps(_mm_loadu_ps(boxes->bounds[2] + half), _mm_set1_ps(range->upper[2])));
        meets = _mm_and_ps(meets, _mm_cmpge_ps(_mm_loadu_ps(boxes->bounds[5] + half), _mm_set1_ps(range->lower[2])));
        found |= (uint32_t)_mm_movemask_ps(meets) << half;
    }
#else
    for (int32_t i = 0; i < SCREE_WIDE; ++i)
    {
        const int32_t meets =
            (int32_t)(boxes->bounds[0][i] <= range->upper[0]) & (int32_t)(boxes->bounds[3][i] >= range->lower[0]) &
            (int32_t)(boxes->bounds[1][i] <= range->upper[1]) & (int32_t)(boxes->bounds[4][i] >= range->lower[1]) &
            (int32_t)(boxes->bounds[2][i] <= range->upper[2]) & (int32_t)(boxes->bounds[5][i] >= range->lower[2]);
        found |= (uint32_t)meets << i;
    }
#endif
    return found;
}

/// Bits of the points (x[i], y[i], z[i]) with direction . point <= reach.
SCREE_FN uint32_t scree_wide_points_within(const float *x, const float *y, const float *z, const float *direction,
                                           float reach)
{
    uint32_t found = 0;
#ifdef SCREE_WIDE_SSE
    for (int32_t half = 0; half < SCREE_WIDE; half += 4)
    {
        const __m128 along_x = _mm_mul_ps(_mm_loadu_ps(x + half), _mm_set1_ps(direction[0]));
        const __m128 along_y = _mm_mul_ps(_mm_loadu_ps(y + half), _mm_set1_ps(direction[1]));
        const __m128 along_z = _mm_mul_ps(_mm_loadu_ps(z + half), _mm_set1_ps(direction[2]));
        const __m128 along = _mm_add_ps(_mm_add_ps(along_x, along_y), along_z);
        found |= (uint32_t)_mm_movemask_ps(_mm_cmple_ps(along, _mm_set1_ps(reach))) << half;
    }
#else
    for (int32_t i = 0; i < SCREE_WIDE; ++i)
        found |= (uint32_t)(direction[0] * x[i] + direction[1] * y[i] + direction[2] * z[i] <= reach) << i;
#endif
    return found;
}

#endif
