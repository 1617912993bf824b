/// \file triangle_filter_kernel.h
/// Triangles of two bodies that can take part in their overlap. A lies below B along z of the working frame.
///
/// A triangle of B is kept if its columns meet A's box in x and y, it reaches below A's top, and it reaches into A's
/// half-space along a direction at most 55 degrees from z; for A the same with below and above exchanged. The bounds in
/// z have one side only: rays along -z from the vertices of A and along +z from those of B decide what is inside, and
/// along them the half-spaces are only entered deeper. The tests use the very coordinates that the overlap uses, so
/// what they drop would have counted zero; only the half-spaces are rounded, and they are wider by more than that.
///
/// Each vertex gets a code of the sides of the region on which it is outside (Cohen & Sutherland). A triangle misses
/// the region exactly if its corners have a side in common.
#ifndef SCREE_TRIANGLE_FILTER_KERNEL_H
#define SCREE_TRIANGLE_FILTER_KERNEL_H

#include "contact/overlap_frame_kernel.h"
#include "contact/overlap_parts.h"

/// Sides of a region.
enum
{
    SCREE_OUTSIDE_X = 1 | 2,   ///< lower, upper
    SCREE_OUTSIDE_Y = 4 | 8,   ///< lower, upper
    SCREE_OUTSIDE_BELOW = 16,  ///< drops triangles of A only
    SCREE_OUTSIDE_ABOVE = 32,  ///< drops triangles of B only
    SCREE_OUTSIDE_BEYOND = 64, ///< of the half-space
    SCREE_OUTSIDE_A = SCREE_OUTSIDE_X | SCREE_OUTSIDE_Y | SCREE_OUTSIDE_BELOW | SCREE_OUTSIDE_BEYOND,
    SCREE_OUTSIDE_B = SCREE_OUTSIDE_X | SCREE_OUTSIDE_Y | SCREE_OUTSIDE_ABOVE | SCREE_OUTSIDE_BEYOND
};

/// What a triangle must reach into: a box, and the half-space direction . v <= reach.
typedef struct scree_filter_region
{
    scree_box box;
    scree_vec3 direction;
    scree_real reach;
    int32_t dropping; ///< sides that drop a triangle: SCREE_OUTSIDE_A or SCREE_OUTSIDE_B
} scree_filter_region;

/// A shape seen from the working frame.
typedef struct scree_posed_shape
{
    const scree_shape_view *shape;
    scree_mat3 rows;
    scree_vec3 offset;
} scree_posed_shape;

SCREE_FN bool scree_filter_uses_tree(const scree_shape_view *shape) { return shape->wide_tree.nodes != NULL; }

SCREE_FN scree_vec3 scree_posed_vertex(const scree_posed_shape *posed, int32_t v)
{
    return scree_affine(&posed->rows, posed->shape->vertices[v], posed->offset);
}

/// Sides of the region on which a vertex is outside, and its depth in the half-space.
SCREE_FN int32_t scree_filter_outcode(const scree_filter_region *region, scree_vec3 p, scree_real *depth)
{
    const scree_vec3 lower = region->box.lower;
    const scree_vec3 upper = region->box.upper;
    *depth = region->reach - scree_vec3_dot(region->direction, p);
    return (int32_t)(p.x < lower.x) | (int32_t)(p.x > upper.x) << 1 | (int32_t)(p.y < lower.y) << 2 |
           (int32_t)(p.y > upper.y) << 3 | (int32_t)(p.z < lower.z) << 4 | (int32_t)(p.z > upper.z) << 5 |
           (int32_t)(*depth < 0) << 6;
}

/// All vertices into the working frame, in the order of the shape. Returns the largest direction . v.
SCREE_FN scree_real scree_filter_load_all(scree_overlap_body *body, const scree_posed_shape *posed,
                                          scree_vec3 direction)
{
    const int32_t num = posed->shape->num_vertices;
    scree_real most = -SCREE_REAL_MAX;
    for (int32_t v = 0; v < num; ++v)
    {
        const scree_vec3 p = scree_posed_vertex(posed, v);
        body->points[v] = p;
        body->vertex_id[v] = v;
        most = scree_max(most, scree_vec3_dot(direction, p));
    }
    body->num_vertices = num;
    return most;
}

/// Does a box miss the region? Asked of the sides that drop.
SCREE_FN bool scree_filter_box_is_outside(const scree_filter_region *region, const scree_box *box)
{
    const scree_vec3 lower = region->box.lower;
    const scree_vec3 upper = region->box.upper;
    const int32_t outside = (int32_t)(box->upper.x < lower.x) | (int32_t)(box->lower.x > upper.x) << 1 |
                            (int32_t)(box->upper.y < lower.y) << 2 | (int32_t)(box->lower.y > upper.y) << 3 |
                            (int32_t)(box->upper.z < lower.z) << 4 | (int32_t)(box->lower.z > upper.z) << 5;
    return (outside & region->dropping) != 0;
}

/// Sides on which all three corners are outside.
SCREE_FN int32_t scree_filter_common_sides(const scree_overlap_body *body, const int32_t *v)
{
    return body->outcode[v[0]] & body->outcode[v[1]] & body->outcode[v[2]];
}

/// Keeps triangles of a loaded body.
SCREE_FN void scree_filter_all(scree_overlap_body *body, const scree_shape_view *shape,
                               const scree_filter_region *region)
{
    for (int32_t v = 0; v < body->num_vertices; ++v)
        body->outcode[v] = scree_filter_outcode(region, body->points[v], body->depth + v);
    int32_t num = 0;
    for (int32_t id = 0; id < shape->num_triangles; ++id)
    {
        // written first and kept or not: no branch that cannot be foreseen
        const int32_t *v = shape->triangles[id].v;
        scree_kept_triangle *kept = body->kept + num;
        kept->v[0] = v[0];
        kept->v[1] = v[1];
        kept->v[2] = v[2];
        kept->id = id;
        num += (scree_filter_common_sides(body, v) & region->dropping) == 0;
    }
    body->num_triangles = num;
}

/// Place of vertex v of the shape among the kept ones, where it is put if it is new.
SCREE_FN int32_t scree_filter_vertex(scree_overlap_body *body, const scree_posed_shape *posed,
                                     const scree_filter_region *region, int32_t v)
{
    // a slot is true only if the vertex it leads to says so too, so slots need no clearing
    const int32_t slot = body->vertex_slot[v];
    if (slot < body->num_vertices && body->vertex_id[slot] == v) return slot;
    const int32_t added = body->num_vertices++;
    body->points[added] = scree_posed_vertex(posed, v);
    body->outcode[added] = scree_filter_outcode(region, body->points[added], body->depth + added);
    body->vertex_id[added] = v;
    body->vertex_slot[v] = added;
    return added;
}

/// A region in the body frame of a shape, from outside: what the nodes of its tree are held against.
SCREE_FN scree_filter_region scree_filter_in_body(const scree_posed_shape *posed, const scree_filter_region *region,
                                                  scree_box body_box)
{
    // the one-sided bound in z goes as far as the body itself
    scree_box box = region->box;
    if ((region->dropping & SCREE_OUTSIDE_BELOW) == 0) box.lower.z = body_box.lower.z;
    if ((region->dropping & SCREE_OUTSIDE_ABOVE) == 0) box.upper.z = body_box.upper.z;
    const scree_mat3 *m = &posed->rows;
    const scree_real scale2 = scree_vec3_dot(m->row[0], m->row[0]);
    const scree_vec3 middle = scree_vec3_sub(scree_box_middle(box), posed->offset);
    const scree_vec3 half = scree_box_half(box);
    const scree_real rounding =
        32 * SCREE_REAL_EPSILON *
        (scree_abs(middle.x) + scree_abs(middle.y) + scree_abs(middle.z) + scree_abs(posed->offset.x) +
         scree_abs(posed->offset.y) + scree_abs(posed->offset.z) + half.x + half.y + half.z);

    scree_mat3 back;
    back.row[0] = scree_vec3_make(m->row[0].x, m->row[1].x, m->row[2].x);
    back.row[1] = scree_vec3_make(m->row[0].y, m->row[1].y, m->row[2].y);
    back.row[2] = scree_vec3_make(m->row[0].z, m->row[1].z, m->row[2].z);
    const scree_vec3 wide = scree_vec3_add(half, scree_vec3_make(rounding, rounding, rounding));
    const scree_vec3 turned_middle = scree_vec3_scale(scree_mat3_apply(back, middle), 1 / scale2);
    const scree_vec3 turned_half = scree_vec3_scale(scree_turned_extents(&back, wide), 1 / scale2);
    scree_filter_region turned;
    turned.box.lower = scree_vec3_sub(turned_middle, turned_half);
    turned.box.upper = scree_vec3_add(turned_middle, turned_half);
    turned.direction = scree_mat3_apply_transposed(*m, region->direction);
    const scree_vec3 d = region->direction;
    turned.reach = region->reach - scree_vec3_dot(d, posed->offset) +
                   rounding * (scree_abs(d.x) + scree_abs(d.y) + scree_abs(d.z));
    turned.dropping = region->dropping;
    return turned;
}

/// Keeps triangles through the tree; `body_box` is the box of the whole body. False if the buffers are too small.
SCREE_FN bool scree_filter_tree(scree_overlap_body *body, const scree_posed_shape *posed,
                                const scree_filter_region *region, scree_box body_box)
{
    const scree_filter_region turned = scree_filter_in_body(posed, region, body_box);
    const scree_shape_view *shape = posed->shape;
    const scree_wide_query query =
        scree_wide_query_make(turned.box, turned.direction, turned.reach, scree_box_reach(shape->box));
    scree_wide_walk walk;
    scree_wide_walk_start(&shape->wide_tree, &query, &walk);
    body->num_vertices = 0;
    body->num_triangles = 0;
    uint32_t found;
    for (;;)
    {
        const int32_t node = scree_wide_walk_next(&shape->wide_tree, &query, &walk, &found);
        if (node < 0) return true;
        if (body->num_triangles + SCREE_WIDE_CHILDREN > body->max_triangles ||
            body->num_vertices + 3 * SCREE_WIDE_CHILDREN > body->max_vertices)
            return false;
        for (; found != 0; found &= found - 1)
        {
            scree_kept_triangle *kept = body->kept + body->num_triangles;
            kept->id = shape->wide_tree.items[SCREE_WIDE_CHILDREN * node + scree_lowest_bit(found)];
            for (int32_t c = 0; c < 3; ++c)
                kept->v[c] = scree_filter_vertex(body, posed, region, shape->triangles[kept->id].v[c]);
            body->num_triangles += (scree_filter_common_sides(body, kept->v) & region->dropping) == 0;
        }
    }
}

/// Box of the part of a triangle within the half-space, which at least one of its corners reaches.
SCREE_FN scree_box scree_filter_clipped_box(const scree_overlap_body *body, const int32_t *v)
{
    const int32_t outs = (int32_t)(body->depth[v[0]] < 0) | (int32_t)(body->depth[v[1]] < 0) << 1 |
                         (int32_t)(body->depth[v[2]] < 0) << 2;
    scree_box box = scree_box_empty();
    for (int32_t k = 0; k < 3; ++k)
        if ((outs >> k & 1) == 0) box = scree_box_with_point(box, body->points[v[k]]);
    if (outs == 0) return box;
    // the corner alone on its side, and the two places where the sides from there leave the half-space
    const int32_t lone = 0x690 >> (2 * outs) & 3;
    for (int32_t turn = 1; turn < 3; ++turn)
    {
        const int32_t other = lone + turn < 3 ? lone + turn : lone + turn - 3;
        const scree_real depth = body->depth[v[lone]];
        const scree_real part = depth / (depth - body->depth[v[other]]);
        const scree_vec3 start = body->points[v[lone]];
        box = scree_box_with_point(box,
                                   scree_vec3_add_scaled(start, scree_vec3_sub(body->points[v[other]], start), part));
    }
    return box;
}

/// Boxes of the kept triangles, clipped to the half-space; drops those that do not reach into the region with it.
SCREE_FN void scree_filter_clip(scree_overlap_body *body, const scree_filter_region *region, scree_real margin)
{
    scree_box all = scree_box_empty();
    int32_t num = 0;
    for (int32_t t = 0; t < body->num_triangles; ++t)
    {
        const scree_kept_triangle kept = body->kept[t];
        scree_box box = scree_filter_clipped_box(body, kept.v);
        box.lower = scree_vec3_make(box.lower.x - margin, box.lower.y - margin, box.lower.z - margin);
        box.upper = scree_vec3_make(box.upper.x + margin, box.upper.y + margin, box.upper.z + margin);
        if (scree_filter_box_is_outside(region, &box)) continue;
        body->kept[num] = kept;
        body->triangle_boxes[num++] = box;
        all = scree_box_union(all, box);
    }
    body->num_triangles = num;
    body->box = all;
}

/// Codes the vertices for a smaller region, with the same half-space, and drops triangles that do not reach into it.
SCREE_FN void scree_filter_again(scree_overlap_body *body, const scree_filter_region *region)
{
    for (int32_t v = 0; v < body->num_vertices; ++v)
        body->outcode[v] = scree_filter_outcode(region, body->points[v], body->depth + v);
    scree_box all = scree_box_empty();
    int32_t num = 0;
    for (int32_t t = 0; t < body->num_triangles; ++t)
    {
        const scree_box box = body->triangle_boxes[t];
        if (scree_filter_box_is_outside(region, &box)) continue;
        body->kept[num] = body->kept[t];
        body->triangle_boxes[num++] = box;
        all = scree_box_union(all, box);
    }
    body->num_triangles = num;
    body->box = all;
}

/// Room for this shape? Sets slice->lack if not.
SCREE_FN bool scree_filter_has_room(scree_overlap_slice *slice, int32_t side, const scree_shape_view *shape)
{
    const scree_overlap_body *body = slice->body + side;
    const bool uses_tree = scree_filter_uses_tree(shape);
    if (shape->num_triangles > body->max_shape_triangles ||
        (uses_tree && shape->num_vertices > body->max_shape_vertices))
        slice->lack = SCREE_LACK_SHAPE;
    else if (!uses_tree && (shape->num_vertices > body->max_vertices || shape->num_triangles >= body->max_triangles))
        slice->lack = SCREE_LACK_PIECES;
    return slice->lack == SCREE_LACK_NOTHING;
}

/// All kept triangles with what is derived from their corners.
SCREE_FN void scree_filter_finish(scree_overlap_body *body)
{
    for (int32_t t = 0; t < body->num_triangles; ++t)
    {
        const scree_kept_triangle kept = body->kept[t];
        scree_overlap_triangle *triangle = body->triangles + t;
        const scree_vec3 p0 = body->points[kept.v[0]];
        const scree_vec3 p1 = body->points[kept.v[1]];
        const scree_vec3 p2 = body->points[kept.v[2]];
        triangle->id = kept.id;
        triangle->has_foot = false;
        for (int32_t k = 0; k < 3; ++k)
        {
            triangle->v[k] = kept.v[k];
            triangle->crossing[k] = -1;
        }
        triangle->face.p[0] = p0;
        triangle->face.p[1] = p1;
        triangle->face.p[2] = p2;
        triangle->face.normal = scree_vec3_cross(scree_vec3_sub(p1, p0), scree_vec3_sub(p2, p0));
        triangle->face.offset = scree_vec3_dot(triangle->face.normal, p0);
        const int32_t id0 = body->vertex_id[kept.v[0]];
        const int32_t id1 = body->vertex_id[kept.v[1]];
        const int32_t id2 = body->vertex_id[kept.v[2]];
        triangle->face.reversed = (int32_t)(id0 > id1) | (int32_t)(id1 > id2) << 1 | (int32_t)(id2 > id0) << 2;
        const scree_vec3 lower = scree_vec3_min(scree_vec3_min(p0, p1), p2);
        const scree_vec3 upper = scree_vec3_max(scree_vec3_max(p0, p1), p2);
        triangle->face.size = upper.x - lower.x + (upper.y - lower.y) + (upper.z - lower.z);
        body->triangle_slot[kept.id] = t;
    }
}

#endif
