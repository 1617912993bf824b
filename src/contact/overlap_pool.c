#include "contact/overlap_pool.h"

#include <stdlib.h>

enum
{
    ALIGNMENT = 64,           ///< of each array
    MAX_ROOM = INT32_MAX / 16 ///< so that indices cannot overflow
};

/// Slices of a GPU take no more than this share of its free memory.
#define SHARE_OF_MEMORY 8

/// Takes num items of a size from the memory at *at; NULL is counted through all the same.
static void *take(char **at, int64_t num, size_t size)
{
    void *taken = *at;
    *at += ((size_t)num * size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    return taken;
}

/// A slice whose arrays begin at `memory`; *end: where they end.
static scree_overlap_slice lay_out(scree_overlap_room room, char *memory, char **end)
{
    scree_overlap_slice slice = {0};
    char *at = memory;
    const int64_t max_pieces = room.max_pieces, max_corners = room.max_crossings + 2 * max_pieces;
    for (int side = 0; side < 2; ++side)
    {
        scree_overlap_body *body = slice.body + side;
        body->vertices = take(&at, max_pieces, sizeof *body->vertices);
        body->kept = take(&at, max_pieces, sizeof *body->kept);
        body->triangles = take(&at, max_pieces, sizeof *body->triangles);
        body->triangle_boxes = take(&at, max_pieces, sizeof *body->triangle_boxes);
        body->links = take(&at, 2 * max_pieces, sizeof *body->links);
        body->vertex_slot = take(&at, room.max_shape, sizeof *body->vertex_slot);
        body->triangle_slot = take(&at, room.max_shape, sizeof *body->triangle_slot);
        body->max_vertices = body->max_triangles = room.max_pieces;
        body->max_shape_vertices = body->max_shape_triangles = room.max_shape;
    }
    slice.crossings = take(&at, room.max_crossings, sizeof *slice.crossings);
    slice.segments = take(&at, room.max_crossings, sizeof *slice.segments);
    slice.corners = take(&at, max_corners, sizeof *slice.corners);
    slice.max_crossings = room.max_crossings;
    slice.max_corners = (int32_t)max_corners;
    *end = at;
    return slice;
}

int64_t scree_overlap_slice_bytes(scree_overlap_room room)
{
    char *end, *const begin = (char *)(uintptr_t)ALIGNMENT;
    lay_out(room, begin, &end);
    return (int64_t)(end - begin);
}

static scree_status fill(scree_overlap_pool *pool, int64_t num_slices, scree_overlap_room room, int64_t num_bytes)
{
    scree_overlap_slice *slices = malloc((size_t)num_slices * sizeof *slices);
    pool->memory = scree_device_alloc(pool->device, num_slices, (size_t)num_bytes);
    pool->slices = scree_device_alloc(pool->device, num_slices, sizeof *slices);
    const bool is_complete = slices != NULL && pool->memory != NULL && pool->slices != NULL;
    if (is_complete)
    {
        char *end = pool->memory;
        for (int64_t k = 0; k < num_slices; ++k) slices[k] = lay_out(room, end, &end);
        scree_device_zero(pool->device, pool->memory, (size_t)(num_slices * num_bytes));
        scree_device_write(pool->device, pool->slices, slices, (size_t)num_slices * sizeof *slices);
        pool->num_slices = num_slices;
        pool->room = room;
    }
    free(slices);
    if (is_complete) return SCREE_OK;
    scree_overlap_pool_destroy(pool);
    return SCREE_OUT_OF_MEMORY;
}

/// Slices of so many bytes that there is memory for.
static int64_t limit_slices(scree_device *device, int64_t num_slices, int64_t num_bytes)
{
    if (device == NULL) return num_slices;
    const int64_t most = scree_device_free_memory(device) / SHARE_OF_MEMORY / num_bytes;
    return num_slices < most ? num_slices : most > 1 ? most : 1;
}

int64_t scree_overlap_pool_bytes(scree_device *device, int64_t num_slices, scree_overlap_room room)
{
    const int64_t num_bytes = scree_overlap_slice_bytes(room);
    return limit_slices(device, num_slices, num_bytes) * (num_bytes + (int64_t)sizeof(scree_overlap_slice));
}

static int32_t larger(int32_t a, int32_t b) { return a > b ? a : b; }

scree_status scree_overlap_pool_reserve(scree_overlap_pool *pool, int64_t num_slices, scree_overlap_room room)
{
    room.max_pieces = larger(room.max_pieces, pool->room.max_pieces);
    room.max_shape = larger(room.max_shape, pool->room.max_shape);
    room.max_crossings = larger(room.max_crossings, pool->room.max_crossings);
    if (room.max_pieces > MAX_ROOM || room.max_shape > MAX_ROOM || room.max_crossings > MAX_ROOM) return SCREE_TOO_MANY;
    const bool is_same = room.max_pieces == pool->room.max_pieces && room.max_shape == pool->room.max_shape &&
                         room.max_crossings == pool->room.max_crossings;
    if (is_same && pool->slices != NULL && num_slices <= pool->num_wanted) return SCREE_OK;
    const int64_t num_wanted = num_slices > pool->num_wanted ? num_slices : pool->num_wanted;
    num_slices = num_wanted;
    const int64_t num_bytes = scree_overlap_slice_bytes(room);
    scree_overlap_pool_destroy(pool);
    num_slices = limit_slices(pool->device, num_slices, num_bytes);
    pool->num_wanted = num_wanted;
    return fill(pool, num_slices, room, num_bytes);
}

void scree_overlap_pool_destroy(scree_overlap_pool *pool)
{
    scree_device_free(pool->device, pool->slices);
    scree_device_free(pool->device, pool->memory);
    *pool = (scree_overlap_pool){.device = pool->device};
}
