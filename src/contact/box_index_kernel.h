/// \file box_index_kernel.h
/// Which of up to 64 boxes may meet a query box: one word of bits from six look-ups. Each axis of a region is cut into
/// bins; for each bin edge two words hold the boxes that start before it and those that reach beyond it. Bins are
/// monotone in the coordinate, so no box that meets the query is missed. Few boxes are compared one by one.
#ifndef SCREE_BOX_INDEX_KERNEL_H
#define SCREE_BOX_INDEX_KERNEL_H

#include "core/bits.h"

#define SCREE_INDEX_BINS 16
#define SCREE_INDEX_MAX 64
/// Up to so many boxes are compared one by one.
#define SCREE_INDEX_DIRECT 12

/// Do two boxes overlap? 0 or 1, found without branches, which could not be foreseen.
SCREE_FN int32_t scree_box_meets(const scree_box *a, const scree_box *b)
{
    return (int32_t)(a->lower.x <= b->upper.x) & (int32_t)(b->lower.x <= a->upper.x) &
           (int32_t)(a->lower.y <= b->upper.y) & (int32_t)(b->lower.y <= a->upper.y) &
           (int32_t)(a->lower.z <= b->upper.z) & (int32_t)(b->lower.z <= a->upper.z);
}

typedef struct scree_box_index
{
    const scree_box *boxes;
    int32_t num;
    scree_box region;
    scree_vec3 scale;
    uint64_t starts[3][SCREE_INDEX_BINS];  ///< boxes whose lower bound lies in this bin or before
    uint64_t reaches[3][SCREE_INDEX_BINS]; ///< boxes whose upper bound lies in this bin or beyond
} scree_box_index;

/// Bins per length such that a coordinate within the bounds, less the lower one, lands in a bin.
SCREE_FN scree_real scree_index_scale(scree_real lower, scree_real upper)
{
    const scree_real scale = (SCREE_INDEX_BINS - (scree_real)0.5) / (upper - lower);
    return upper > lower && scale < SCREE_REAL_MAX ? scale : 0;
}

/// Bin of a coordinate along one axis; those outside the region count to its first or last bin.
SCREE_FN int32_t scree_index_bin(scree_real x, scree_real lower, scree_real upper, scree_real scale)
{
    return (int32_t)((scree_max(lower, scree_min(upper, x)) - lower) * scale);
}

/// Enters box i along one axis, from its first bin to its last.
SCREE_FN void scree_index_enter(scree_box_index *index, int32_t axis, int32_t i, int32_t first, int32_t last)
{
    index->starts[axis][first] |= (uint64_t)1 << i;
    index->reaches[axis][last] |= (uint64_t)1 << i;
}

/// Index of `num` boxes, at most SCREE_INDEX_MAX, best told apart within `region`. The boxes are borrowed.
SCREE_FN void scree_index_build(scree_box_index *index, const scree_box *boxes, int32_t num, scree_box region)
{
    index->boxes = boxes;
    index->num = num;
    index->region = region;
    index->scale = scree_vec3_zero();
    if (num <= SCREE_INDEX_DIRECT) return;
    const scree_vec3 l = region.lower;
    const scree_vec3 u = region.upper;
    const scree_vec3 s =
        scree_vec3_make(scree_index_scale(l.x, u.x), scree_index_scale(l.y, u.y), scree_index_scale(l.z, u.z));
    index->scale = s;
    for (int32_t axis = 0; axis < 3; ++axis)
    {
        for (int32_t k = 0; k < SCREE_INDEX_BINS; ++k)
        {
            index->starts[axis][k] = 0;
            index->reaches[axis][k] = 0;
        }
    }
    for (int32_t i = 0; i < num; ++i)
    {
        const scree_box box = boxes[i];
        scree_index_enter(index, 0, i, scree_index_bin(box.lower.x, l.x, u.x, s.x),
                          scree_index_bin(box.upper.x, l.x, u.x, s.x));
        scree_index_enter(index, 1, i, scree_index_bin(box.lower.y, l.y, u.y, s.y),
                          scree_index_bin(box.upper.y, l.y, u.y, s.y));
        scree_index_enter(index, 2, i, scree_index_bin(box.lower.z, l.z, u.z, s.z),
                          scree_index_bin(box.upper.z, l.z, u.z, s.z));
    }
    for (int32_t axis = 0; axis < 3; ++axis)
    {
        for (int32_t k = 1; k < SCREE_INDEX_BINS; ++k)
        {
            const int32_t back = SCREE_INDEX_BINS - 1 - k;
            index->starts[axis][k] |= index->starts[axis][k - 1];
            index->reaches[axis][back] |= index->reaches[axis][back + 1];
        }
    }
}

/// Bits of the boxes that may meet the query; all that do are among them.
SCREE_FN uint64_t scree_index_query(const scree_box_index *index, scree_box query)
{
    uint64_t found = 0;
    if (index->num <= SCREE_INDEX_DIRECT)
    {
        for (int32_t i = 0; i < index->num; ++i)
        {
            found |= (uint64_t)scree_box_meets(index->boxes + i, &query) << i;
        }
        return found;
    }
    const scree_vec3 l = index->region.lower;
    const scree_vec3 u = index->region.upper;
    const scree_vec3 s = index->scale;
    return index->starts[0][scree_index_bin(query.upper.x, l.x, u.x, s.x)] &
           index->reaches[0][scree_index_bin(query.lower.x, l.x, u.x, s.x)] &
           index->starts[1][scree_index_bin(query.upper.y, l.y, u.y, s.y)] &
           index->reaches[1][scree_index_bin(query.lower.y, l.y, u.y, s.y)] &
           index->starts[2][scree_index_bin(query.upper.z, l.z, u.z, s.z)] &
           index->reaches[2][scree_index_bin(query.lower.z, l.z, u.z, s.z)];
}

#endif
