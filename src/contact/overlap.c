#include "contact/overlap_kernel.h"

#include <stdlib.h>

struct scree_overlap_workspace
{
    scree_overlap_slice slice;
};

/// Replaces *array by `num` zeroed items; contents are not kept. *array is NULL on failure.
static bool renew(void *array, int64_t num, size_t size)
{
    void **items = array;
    free(*items);
    *items = calloc((size_t)num, size);
    return *items != NULL;
}

static bool reserve_pieces(scree_overlap_body *body, int32_t max)
{
    body->max_vertices = 0;
    body->max_triangles = 0;
    bool is_done = renew(&body->vertices, max, sizeof *body->vertices);
    is_done = renew(&body->kept, max, sizeof *body->kept) && is_done;
    is_done = renew(&body->triangles, max, sizeof *body->triangles) && is_done;
    is_done = renew(&body->triangle_boxes, max, sizeof *body->triangle_boxes) && is_done;
    is_done = renew(&body->links, 2 * (int64_t)max, sizeof *body->links) && is_done;
    if (!is_done) return false;
    body->max_vertices = max;
    body->max_triangles = max;
    return true;
}

static bool reserve_shape(scree_overlap_body *body, int32_t max)
{
    body->max_shape_vertices = 0;
    body->max_shape_triangles = 0;
    bool is_done = renew(&body->vertex_slot, max, sizeof *body->vertex_slot);
    is_done = renew(&body->triangle_slot, max, sizeof *body->triangle_slot) && is_done;
    if (!is_done) return false;
    body->max_shape_vertices = max;
    body->max_shape_triangles = max;
    return true;
}

/// Room for `max` crossings, and for the corners that they and the vertices may make.
static bool reserve_crossings(scree_overlap_slice *slice, int32_t max)
{
    const int64_t max_corners = (int64_t)max + slice->body[0].max_vertices + slice->body[1].max_vertices;
    slice->max_crossings = 0;
    slice->max_corners = 0;
    bool is_done = renew(&slice->crossings, max, sizeof *slice->crossings);
    is_done = renew(&slice->segments, max, sizeof *slice->segments) && is_done;
    is_done = renew(&slice->corners, max_corners, sizeof *slice->corners) && is_done;
    if (!is_done) return false;
    slice->max_crossings = max;
    slice->max_corners = (int32_t)max_corners;
    return true;
}

scree_overlap_workspace *scree_overlap_workspace_create(void)
{
    scree_overlap_workspace *workspace = calloc(1, sizeof *workspace);
    if (workspace == NULL) return NULL;
    bool is_done = true;
    for (int side = 0; side < 2; ++side)
    {
        is_done = reserve_pieces(workspace->slice.body + side, 512) && is_done;
        is_done = reserve_shape(workspace->slice.body + side, 1024) && is_done;
    }
    is_done = is_done && reserve_crossings(&workspace->slice, 128);
    if (is_done) return workspace;
    scree_overlap_workspace_destroy(workspace);
    return NULL;
}

scree_status scree_overlap_workspace_grow(scree_overlap_workspace *workspace)
{
    scree_overlap_slice *slice = &workspace->slice;
    const int32_t limit = INT32_MAX / 16;
    bool is_done = true;
    if (slice->lack == SCREE_LACK_CROSSINGS)
    {
        if (slice->max_crossings > limit) return SCREE_TOO_MANY;
        return reserve_crossings(slice, 2 * slice->max_crossings) ? SCREE_OK : SCREE_OUT_OF_MEMORY;
    }
    for (int side = 0; side < 2; ++side)
    {
        scree_overlap_body *body = slice->body + side;
        if (body->max_triangles > limit || body->max_shape_triangles > limit) return SCREE_TOO_MANY;
        if (slice->lack == SCREE_LACK_PIECES) is_done = reserve_pieces(body, 2 * body->max_triangles) && is_done;
        if (slice->lack == SCREE_LACK_SHAPE) is_done = reserve_shape(body, 2 * body->max_shape_triangles) && is_done;
    }
    if (slice->lack == SCREE_LACK_PIECES) is_done = is_done && reserve_crossings(slice, slice->max_crossings);
    return is_done ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

void scree_overlap_workspace_destroy(scree_overlap_workspace *workspace)
{
    if (workspace == NULL) return;
    scree_overlap_slice *slice = &workspace->slice;
    for (int side = 0; side < 2; ++side)
    {
        scree_overlap_body *body = slice->body + side;
        free(body->vertices);
        free(body->kept);
        free(body->triangles);
        free(body->triangle_boxes);
        free(body->links);
        free(body->vertex_slot);
        free(body->triangle_slot);
    }
    free(slice->crossings);
    free(slice->segments);
    free(slice->corners);
    free(workspace);
}

int32_t scree_overlap_compute(const scree_shape_view *a, const scree_pose *pose_a, const scree_shape_view *b,
                              const scree_pose *pose_b, const scree_overlap_options *options,
                              scree_overlap_workspace *workspace, scree_overlap_result *results, int32_t max_results)
{
    if (max_results < 1) return 0;
    scree_overlap_pair pair;
    pair.shape[0] = a;
    pair.shape[1] = b;
    pair.pose[0] = pose_a;
    pair.pose[1] = pose_b;
    workspace->slice.setup.known = scree_vec3_zero();
    return scree_overlap_pair_compute(&pair, options, &workspace->slice, results, max_results);
}
