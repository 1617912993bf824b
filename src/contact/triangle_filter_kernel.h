/// \file triangle_filter_kernel.h
/// Triangles of two bodies that can take part in their overlap. A lies below B along z of the working frame.
///
/// A triangle of B is kept if its columns meet A's box in x and y, it reaches below A's top, and it reaches into A's
/// half-space along a direction at most 55 degrees from z; for A the same with below and above exchanged. The bounds in
/// z have one side only: rays along -z from the vertices of A and along +z from those of B decide what is inside, and
/// along them the half-spaces are only entered deeper. The tests use the very coordinates that the overlap uses, so
/// what they drop would have counted zero; only the half-spaces are rounded, and they are wider by more than that.
#ifndef SCREE_TRIANGLE_FILTER_KERNEL_H
#define SCREE_TRIANGLE_FILTER_KERNEL_H

#include "contact/overlap_frame_kernel.h"
#include "contact/overlap_parts.h"

/// What a triangle must reach into: a box, and the half-space direction . v <= reach.
typedef struct scree_filter_region
{
    scree_box box;
    scree_vec3 direction;
    scree_real reach;
} scree_filter_region;

/// A shape seen from the working frame.
typedef struct scree_posed_shape
{
    const scree_shape_view *shape;
    scree_mat3 rows;
    scree_vec3 offset;
} scree_posed_shape;

/// Shapes up to this many triangles are filtered one triangle after the other, larger ones through their tree.
#define SCREE_FILTER_TREE_FROM 48

SCREE_FN bool scree_filter_uses_tree(const scree_shape_view *shape)
{
    return shape->num_triangles >= SCREE_FILTER_TREE_FROM && shape->tree.nodes != NULL;
}

SCREE_FN scree_vec3 scree_posed_vertex(const scree_posed_shape *posed, int32_t v)
{
    return scree_affine(&posed->rows, posed->shape->vertices[v], posed->offset);
}

/// Smallest value of `direction` over the corners of a triangle at least `reach`'s side of the region, and box overlap.
SCREE_FN bool scree_filter_keeps(const scree_filter_region *region, scree_box box, const scree_vec3 *points,
                                 const int32_t *v)
{
    if (!scree_box_overlaps(region->box, box)) return false;
    return scree_vec3_dot(region->direction, points[v[0]]) <= region->reach ||
           scree_vec3_dot(region->direction, points[v[1]]) <= region->reach ||
           scree_vec3_dot(region->direction, points[v[2]]) <= region->reach;
}

/// All vertices into the working frame, in the order of the shape.
SCREE_FN void scree_filter_load_all(scree_overlap_body *body, const scree_posed_shape *posed)
{
    const int32_t num = posed->shape->num_vertices;
    for (int32_t v = 0; v < num; ++v)
    {
        body->points[v] = scree_posed_vertex(posed, v);
        body->vertex_id[v] = v;
    }
    body->num_vertices = num;
}

/// Place of vertex v of the shape among the kept ones, where it is put if it is new.
SCREE_FN int32_t scree_filter_vertex(scree_overlap_body *body, const scree_posed_shape *posed, int32_t v)
{
    // a slot is true only if the vertex it leads to says so too, so slots need no clearing
    const int32_t slot = body->vertex_slot[v];
    if (slot < body->num_vertices && body->vertex_id[slot] == v) return slot;
    const int32_t added = body->num_vertices++;
    body->points[added] = scree_posed_vertex(posed, v);
    body->vertex_id[added] = v;
    body->vertex_slot[v] = added;
    return added;
}

/// Keeps triangle `id` with the local corners v if the region asks for it.
SCREE_FN void scree_filter_triangle(scree_overlap_body *body, const scree_filter_region *region, int32_t id,
                                    const int32_t *v)
{
    scree_box box;
    box.lower = scree_vec3_min(scree_vec3_min(body->points[v[0]], body->points[v[1]]), body->points[v[2]]);
    box.upper = scree_vec3_max(scree_vec3_max(body->points[v[0]], body->points[v[1]]), body->points[v[2]]);
    if (!scree_filter_keeps(region, box, body->points, v)) return;
    scree_overlap_triangle *triangle = body->triangles + body->num_triangles;
    triangle->id = id;
    for (int32_t k = 0; k < 3; ++k) triangle->v[k] = v[k];
    body->triangle_boxes[body->num_triangles] = box;
    ++body->num_triangles;
}

/// Can anything in a box of the shape's tree reach into the region? Never says no where a triangle would be kept.
SCREE_FN bool scree_filter_enters_node(const scree_posed_shape *posed, const scree_filter_region *region,
                                       const scree_box *node_box)
{
    const scree_vec3 middle = scree_affine(&posed->rows, scree_box_middle(*node_box), posed->offset);
    scree_vec3 half = scree_turned_extents(&posed->rows, scree_box_half(*node_box));
    const scree_real rounding =
        16 * SCREE_REAL_EPSILON *
        (scree_abs(middle.x) + scree_abs(middle.y) + scree_abs(middle.z) + scree_abs(posed->offset.x) +
         scree_abs(posed->offset.y) + scree_abs(posed->offset.z) + half.x + half.y + half.z);
    half = scree_vec3_add(half, scree_vec3_make(rounding, rounding, rounding));
    scree_box box;
    box.lower = scree_vec3_sub(middle, half);
    box.upper = scree_vec3_add(middle, half);
    if (!scree_box_overlaps(region->box, box)) return false;
    const scree_vec3 d = region->direction;
    const scree_real least =
        scree_vec3_dot(d, middle) - scree_abs(d.x) * half.x - scree_abs(d.y) * half.y - scree_abs(d.z) * half.z;
    return least <= region->reach + rounding;
}

/// Kept triangles through the tree. False if the buffers are too small.
SCREE_FN bool scree_filter_tree(scree_overlap_body *body, const scree_posed_shape *posed,
                                const scree_filter_region *region)
{
    const scree_lbvh_view *tree = &posed->shape->tree;
    int32_t k = tree->root;
    while (k != SCREE_LBVH_END)
    {
        const scree_lbvh_node *node = tree->nodes + k;
        if (!scree_filter_enters_node(posed, region, &node->box))
        {
            k = node->escape;
            continue;
        }
        if (node->first_child >= 0)
        {
            k = node->first_child;
            continue;
        }
        if (body->num_triangles == body->max_triangles || body->num_vertices + 3 > body->max_vertices) return false;
        const int32_t id = -1 - node->first_child;
        int32_t v[3];
        for (int32_t c = 0; c < 3; ++c) v[c] = scree_filter_vertex(body, posed, posed->shape->triangles[id].v[c]);
        scree_filter_triangle(body, region, id, v);
        k = node->escape;
    }
    return true;
}

/// Room for this shape? Sets slice->lack if not.
SCREE_FN bool scree_filter_has_room(scree_overlap_slice *slice, int32_t side, const scree_shape_view *shape)
{
    const scree_overlap_body *body = slice->body + side;
    if (scree_filter_uses_tree(shape))
    {
        if (shape->num_vertices <= body->max_shape_vertices && shape->num_triangles <= body->max_shape_triangles)
            return true;
        slice->lack = SCREE_LACK_SHAPE;
        return false;
    }
    if (shape->num_triangles > body->max_shape_triangles)
    {
        slice->lack = SCREE_LACK_SHAPE;
        return false;
    }
    if (shape->num_vertices <= body->max_vertices && shape->num_triangles <= body->max_triangles) return true;
    slice->lack = SCREE_LACK_PIECES;
    return false;
}

/// Keeps the triangles of one body that reach into the region; its vertices are loaded already unless it uses its tree.
SCREE_FN bool scree_filter_run(scree_overlap_slice *slice, int32_t side, const scree_posed_shape *posed,
                               const scree_filter_region *region)
{
    scree_overlap_body *body = slice->body + side;
    body->num_triangles = 0;
    if (scree_filter_uses_tree(posed->shape))
    {
        body->num_vertices = 0;
        if (scree_filter_tree(body, posed, region)) return true;
        slice->lack = SCREE_LACK_PIECES;
        return false;
    }
    for (int32_t id = 0; id < posed->shape->num_triangles; ++id)
        scree_filter_triangle(body, region, id, posed->shape->triangles[id].v);
    return true;
}

/// Box of all kept triangles.
SCREE_FN scree_box scree_filter_kept_box(const scree_overlap_body *body)
{
    scree_box box = scree_box_empty();
    for (int32_t t = 0; t < body->num_triangles; ++t) box = scree_box_union(box, body->triangle_boxes[t]);
    return box;
}

/// Drops the kept triangles that do not meet the box.
SCREE_FN void scree_filter_shrink(scree_overlap_body *body, scree_box box)
{
    int32_t num = 0;
    for (int32_t t = 0; t < body->num_triangles; ++t)
    {
        if (!scree_box_overlaps(body->triangle_boxes[t], box)) continue;
        if (num < t)
        {
            body->triangles[num] = body->triangles[t];
            body->triangle_boxes[num] = body->triangle_boxes[t];
        }
        ++num;
    }
    body->num_triangles = num;
}

/// Enters what is derived from the corners of each kept triangle, and marks its slot.
SCREE_FN void scree_filter_finish_triangles(scree_overlap_body *body)
{
    for (int32_t t = 0; t < body->num_triangles; ++t)
    {
        scree_overlap_triangle *triangle = body->triangles + t;
        const scree_vec3 p = body->points[triangle->v[0]];
        triangle->normal = scree_vec3_cross(scree_vec3_sub(body->points[triangle->v[1]], p),
                                            scree_vec3_sub(body->points[triangle->v[2]], p));
        const scree_vec3 extent = scree_vec3_sub(body->triangle_boxes[t].upper, body->triangle_boxes[t].lower);
        triangle->size = extent.x + extent.y + extent.z;
        triangle->reversed = 0;
        triangle->has_foot = false;
        for (int32_t k = 0; k < 3; ++k)
        {
            const int32_t next = k == 2 ? 0 : k + 1;
            if (body->vertex_id[triangle->v[k]] > body->vertex_id[triangle->v[next]]) triangle->reversed |= 1 << k;
        }
        body->triangle_slot[triangle->id] = t;
    }
}

#endif
