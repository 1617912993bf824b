/// \file morton_kernel.h
/// Morton codes: 21 bits of each coordinate interleaved, x highest, so that codes that are near are near in space.
/// All axes share one unit of length, that of the longest side of the bounds: cells are cubes, and a tree cut at the
/// bits of the code cuts a long heap across its length first.
#ifndef SCREE_MORTON_KERNEL_H
#define SCREE_MORTON_KERNEL_H

#include "core/vec.h"

/// Bits of the code per axis.
#define SCREE_MORTON_BITS 21

/// Number of leading zero bits; x > 0.
SCREE_FN int32_t scree_count_leading_zeros(uint64_t x)
{
#ifdef __CUDA_ARCH__
    return (int32_t)__clzll((long long)x);
#else
    return (int32_t)__builtin_clzll(x);
#endif
}

/// The lowest 21 bits of x moved to every third bit: bit k to bit 3 k.
SCREE_FN uint64_t scree_morton_spread(uint64_t x)
{
    x &= 0x1fffff;
    x = (x | x << 32) & 0x001f00000000ffffu;
    x = (x | x << 16) & 0x001f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    x = (x | x << 2) & 0x1249249249249249u;
    return x;
}

/// 63-bit code of a cell; each coordinate below 2^21.
SCREE_FN uint64_t scree_morton_encode(uint64_t x, uint64_t y, uint64_t z)
{
    return scree_morton_spread(x) << 2 | scree_morton_spread(y) << 1 | scree_morton_spread(z);
}

/// Middle of a box. Halved first, so that it cannot overflow.
SCREE_FN scree_vec3 scree_morton_middle(scree_box box)
{
    const scree_real half = (scree_real)0.5;
    return scree_vec3_add(scree_vec3_scale(box.lower, half), scree_vec3_scale(box.upper, half));
}

/// Cells of the codes: cubes, 2^21 to the longest side of the bounds.
typedef struct scree_morton_frame
{
    scree_vec3 half_lower; ///< half of the lowest coordinates
    scree_real scale;      ///< cells per half unit of length; may be infinite for bounds without extent
} scree_morton_frame;

SCREE_FN scree_morton_frame scree_morton_frame_make(scree_box bounds)
{
    const scree_real half = (scree_real)0.5;
    const scree_vec3 lower = scree_vec3_scale(bounds.lower, half);
    const scree_vec3 extent = scree_vec3_sub(scree_vec3_scale(bounds.upper, half), lower);
    scree_morton_frame frame;
    frame.half_lower = lower;
    frame.scale = (scree_real)(1 << SCREE_MORTON_BITS) / scree_max(scree_max(extent.x, extent.y), extent.z);
    return frame;
}

/// Cell of one coordinate. What is outside goes to the nearest cell, what is not a number to cell 0.
SCREE_FN uint64_t scree_morton_cell(scree_real x, scree_real half_lower, scree_real scale)
{
    const scree_real last = (scree_real)((1 << SCREE_MORTON_BITS) - 1);
    const scree_real cell = ((scree_real)0.5 * x - half_lower) * scale;
    if (!(cell > 0)) return 0;
    return (uint64_t)(cell < last ? cell : last);
}

SCREE_FN uint64_t scree_morton_code(scree_vec3 point, scree_morton_frame frame)
{
    return scree_morton_encode(scree_morton_cell(point.x, frame.half_lower.x, frame.scale),
                               scree_morton_cell(point.y, frame.half_lower.y, frame.scale),
                               scree_morton_cell(point.z, frame.half_lower.z, frame.scale));
}

#endif
