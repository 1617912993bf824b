/// \file overlap_pool.h
/// Buffers of many overlaps at once, where they are computed: one slice for each that is under way, all alike.
#ifndef SCREE_OVERLAP_POOL_H
#define SCREE_OVERLAP_POOL_H

#include "contact/overlap_parts.h"
#include "core/device.h"

/// Room of a slice.
typedef struct scree_overlap_room
{
    int32_t max_pieces;    ///< kept vertices, triangles; half as many links
    int32_t max_shape;     ///< vertices or triangles of a shape
    int32_t max_crossings; ///< and segments
} scree_overlap_room;

/// Owns the slices. Start from {0}, or from {.device = ...} for a GPU.
typedef struct scree_overlap_pool
{
    scree_device *device;
    scree_overlap_slice *slices; ///< (num_slices) where the device is
    void *memory;                ///< (num_slices) of what the slices point at
    int64_t num_slices;
    int64_t num_wanted; ///< as many as were asked for
    scree_overlap_room room;
} scree_overlap_pool;

/// Bytes of one slice with so much room.
int64_t scree_overlap_slice_bytes(scree_overlap_room room);
/// At least so much room in each of num_slices; fewer slices if memory has no room for all, but one at least.
/// SCREE_OUT_OF_MEMORY, SCREE_TOO_MANY.
scree_status scree_overlap_pool_reserve(scree_overlap_pool *pool, int64_t num_slices, scree_overlap_room room);
/// Bytes of a pool.
int64_t scree_overlap_pool_bytes(scree_device *device, int64_t num_slices, scree_overlap_room room);
void scree_overlap_pool_destroy(scree_overlap_pool *pool);

#endif
