/// \file overlap_intervals_kernel.h
/// Intervals of an edge of one body that lie inside the other: from an entering crossing or an inside vertex to the
/// next leaving crossing or inside vertex.
#ifndef SCREE_OVERLAP_INTERVALS_KERNEL_H
#define SCREE_OVERLAP_INTERVALS_KERNEL_H

#include "contact/overlap_parts.h"
#include "core/bits.h"

/// Place of the neighbour across side k of kept triangle t, or -1 if the neighbour is not kept.
SCREE_FN int32_t scree_kept_neighbour(const scree_overlap_body *body, const scree_shape_view *shape, int32_t t,
                                      int32_t k)
{
    const int32_t id = shape->neighbours[3 * body->kept[t].id + k];
    const int32_t slot = body->triangle_slot[id];
    return slot < body->num_triangles && body->kept[slot].id == id ? slot : -1;
}

/// A corner of the overlap solid: a crossing, or an inside vertex of one of the bodies.
typedef struct scree_overlap_corner
{
    int32_t kind; ///< 0: a vertex of A, 1: a vertex of B, 2: a crossing
    int32_t index;
} scree_overlap_corner;

typedef struct scree_overlap_interval
{
    scree_vec3 point[2];
    scree_overlap_corner corner[2];
} scree_overlap_interval;

/// Patch of a corner, or its parent while patches are being told apart.
SCREE_FN int32_t *scree_overlap_patch_of(scree_overlap_slice *slice, scree_overlap_corner corner)
{
    return corner.kind == 2 ? &slice->crossings[corner.index].patch
                            : &slice->body[corner.kind].vertices[corner.index].patch;
}

/// Bits of the sides of kept triangle t, finished, that have intervals, among those that run up their vertex ids here.
SCREE_FN uint64_t scree_overlap_inside_sides(const scree_overlap_body *body, int32_t t)
{
    const scree_overlap_triangle *triangle = body->triangles + t;
    const int32_t *v = triangle->v;
    const int32_t *crossing = triangle->crossing;
    // without a crossing both ends are inside or none
    const int32_t sides = (int32_t)(crossing[0] >= 0) | (int32_t)(body->vertices[v[0]].inside > 0) |
                          ((int32_t)(crossing[1] >= 0) | (int32_t)(body->vertices[v[1]].inside > 0)) << 1 |
                          ((int32_t)(crossing[2] >= 0) | (int32_t)(body->vertices[v[2]].inside > 0)) << 2;
    return (uint64_t)(sides & ~triangle->face.reversed);
}

SCREE_FN void scree_interval_walk_start(const scree_overlap_body *body, int32_t t, int32_t k, scree_interval_walk *walk)
{
    const scree_overlap_triangle *triangle = body->triangles + t;
    walk->v[0] = triangle->v[k];
    walk->v[1] = triangle->v[scree_next_corner(k)];
    for (int32_t end = 0; end < 2; ++end)
    {
        walk->num_left[end] = body->vertices[walk->v[end]].inside;
        walk->crossing[end] = triangle->crossing[k];
    }
}

/// Next interval along the edge. False at the end; slice->is_closed is cleared if one of its ends is missing.
SCREE_FN bool scree_overlap_next_interval(scree_overlap_slice *slice, const scree_overlap_body *body,
                                          scree_interval_walk *walk, scree_overlap_interval *interval)
{
    bool has[2];
    for (int32_t end = 0; end < 2; ++end)
    {
        // an inside vertex comes first among the starts and last among the ends
        const int32_t wanted = end == 0 ? 1 : -1;
        int32_t c = walk->crossing[end];
        while (c >= 0 && slice->crossings[c].sign != wanted) c = slice->crossings[c].next;
        const bool takes_vertex = walk->num_left[end] > 0 && (end == 0 || c < 0);
        has[end] = takes_vertex || c >= 0;
        if (takes_vertex)
        {
            --walk->num_left[end];
            interval->point[end] = body->vertices[walk->v[end]].point;
            interval->corner[end].kind = (int32_t)(body - slice->body);
            interval->corner[end].index = walk->v[end];
        }
        else if (c >= 0)
        {
            interval->point[end] = slice->crossings[c].point;
            interval->corner[end].kind = 2;
            interval->corner[end].index = c;
            walk->crossing[end] = slice->crossings[c].next;
        }
        if (takes_vertex) walk->crossing[end] = c;
    }
    if (has[0] != has[1]) slice->is_closed = false;
    return has[0] && has[1];
}

#endif
