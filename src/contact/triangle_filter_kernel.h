/// \file triangle_filter_kernel.h
/// Triangles of two bodies that can take part in their overlap. A lies below B along z of the working frame.
///
/// Each body has a half-space that the other cannot leave: how far the other reaches along a direction at most 70
/// degrees from z. A triangle counts with the part of it within the half-space, by the box of that part. It is kept if
/// this box meets the region: the box of what was kept of the other body in x and y, and in z one-sided, since a point
/// of A inside B has, straight below it, a triangle of B, and along that ray the half-space is only entered deeper.
/// So a vertex that is outside of the region is outside of the other body, and one within has all its triangles kept.
/// Boxes are wider by 64 eps L, so that what they drop counts zero in every scheme.
#ifndef SCREE_TRIANGLE_FILTER_KERNEL_H
#define SCREE_TRIANGLE_FILTER_KERNEL_H

#include "contact/overlap_frame_kernel.h"
#include "contact/overlap_parts.h"
#include "core/team.h"

SCREE_FN bool scree_filter_uses_tree(const scree_shape_view *shape) { return shape->wide_tree.nodes != NULL; }

SCREE_FN scree_vec3 scree_posed_vertex(const scree_posed_shape *posed, int32_t v)
{
    return scree_affine(&posed->rows, posed->shape->vertices[v], posed->offset);
}

/// All vertices into the working frame, in the order of the shape. Returns the largest direction . v; the depths are
/// -direction . v until the reach of the half-space is known.
SCREE_FN_APART scree_real scree_filter_load_all(scree_team lanes, scree_overlap_body *body,
                                                const scree_posed_shape *posed, scree_vec3 direction)
{
    const scree_team *team = &lanes;
    const int32_t num = posed->shape->num_vertices;
    scree_real most = -SCREE_REAL_MAX;
    for (int32_t v = scree_team_lane(team); v < num; v += scree_team_size(team))
    {
        scree_overlap_vertex *vertex = body->vertices + v;
        vertex->point = scree_posed_vertex(posed, v);
        vertex->id = v;
        vertex->depth = scree_vec3_dot(direction, vertex->point);
        most = scree_max(most, vertex->depth);
    }
    if (scree_team_leads(team)) body->num_vertices = num;
    scree_team_sync(team);
    return scree_team_max(team, most);
}

/// Does a box miss the region?
SCREE_FN bool scree_filter_misses(const scree_filter_region *region, const scree_box *box)
{
    const int32_t misses_sideways =
        (int32_t)(box->upper.x < region->box.lower.x) | (int32_t)(box->lower.x > region->box.upper.x) |
        (int32_t)(box->upper.y < region->box.lower.y) | (int32_t)(box->lower.y > region->box.upper.y);
    const int32_t misses =
        region->is_of_a ? (int32_t)(box->upper.z < region->box.lower.z) : (int32_t)(box->lower.z > region->box.upper.z);
    return (misses_sideways | misses) != 0;
}

/// Keeps triangles of a loaded body that reach into the half-space, of which the reach is known now.
SCREE_FN_APART void scree_filter_all(scree_team lanes, scree_overlap_body *body, const scree_shape_view *shape,
                                     scree_real reach)
{
    const scree_team *team = &lanes;
    // what was loaded is the distance along the direction of the other's half-space, which is opposite
    scree_overlap_vertex *vertices = body->vertices;
    for (int32_t v = scree_team_lane(team); v < body->num_vertices; v += scree_team_size(team))
        vertices[v].depth += reach;
    scree_team_sync(team);
    int32_t num = 0;
    for (int32_t begin = 0; begin < shape->num_triangles; begin += scree_team_size(team))
    {
        // written first and kept or not: no branch that cannot be foreseen
        const int32_t id = begin + scree_team_lane(team);
        const int32_t *v = shape->triangles[id < shape->num_triangles ? id : 0].v;
        const bool reaches = ((int32_t)(vertices[v[0]].depth >= 0) | (int32_t)(vertices[v[1]].depth >= 0) |
                              (int32_t)(vertices[v[2]].depth >= 0)) != 0;
        const bool is_kept = reaches && id < shape->num_triangles;
        scree_kept_triangle *kept = body->kept + scree_team_place(team, is_kept, &num);
        if (!scree_team_writes(team, is_kept)) continue;
        kept->v[0] = v[0];
        kept->v[1] = v[1];
        kept->v[2] = v[2];
        kept->id = id;
    }
    if (scree_team_leads(team)) body->num_triangles = num;
    scree_team_sync(team);
}

/// Place of vertex v of the shape among the kept ones, where it is put if it is new.
SCREE_FN int32_t scree_filter_vertex(scree_overlap_body *body, const scree_posed_shape *posed,
                                     const scree_filter_region *region, int32_t v)
{
    // a slot is true only if the vertex it leads to says so too, so slots need no clearing
    const int32_t slot = body->vertex_slot[v];
    if (slot < body->num_vertices && body->vertices[slot].id == v) return slot;
    const int32_t added = body->num_vertices++;
    scree_overlap_vertex *vertex = body->vertices + added;
    vertex->point = scree_posed_vertex(posed, v);
    vertex->depth = region->reach - scree_vec3_dot(region->direction, vertex->point);
    vertex->id = v;
    body->vertex_slot[v] = added;
    return added;
}

/// From a column on that is so many times narrower than the body, its sides are worth being looked at.
#define SCREE_NARROW_COLUMN 6

/// A region from outside, for the nodes of the tree of a shape, in its body frame: the box of its column, the
/// half-space, and if the column is narrow its four sides: long and oblique, it fills little of its box.
SCREE_FN_APART void scree_filter_query(const scree_posed_shape *posed, const scree_filter_region *region,
                                       scree_box body_box, scree_wide_query *query)
{
    // the one-sided bound in z goes as far as the body itself
    scree_box box = region->box;
    if (region->is_of_a) box.upper.z = body_box.upper.z;
    else box.lower.z = body_box.lower.z;
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
    const scree_box turned = {scree_vec3_sub(turned_middle, turned_half), scree_vec3_add(turned_middle, turned_half)};
    const scree_vec3 d = region->direction;
    const scree_real reach = region->reach - scree_vec3_dot(d, posed->offset) +
                             rounding * (scree_abs(d.x) + scree_abs(d.y) + scree_abs(d.z));
    const scree_real size = scree_box_reach(posed->shape->box);
    scree_wide_query_set(query, turned, scree_wide_half_space_make(scree_mat3_apply_transposed(*m, d), reach, size));
    const scree_vec3 body_half = scree_box_half(body_box);
    if (scree_max(body_half.x, body_half.y) < SCREE_NARROW_COLUMN * scree_max(half.x, half.y)) return;
    const scree_vec3 x = m->row[0], y = m->row[1];
    scree_wide_query_add_side(query, scree_wide_half_space_make(x, middle.x + wide.x, size));
    scree_wide_query_add_side(query, scree_wide_half_space_make(scree_vec3_negate(x), wide.x - middle.x, size));
    scree_wide_query_add_side(query, scree_wide_half_space_make(y, middle.y + wide.y, size));
    scree_wide_query_add_side(query, scree_wide_half_space_make(scree_vec3_negate(y), wide.y - middle.y, size));
}

/// Keeps triangles through the tree that reach into the half-space and may meet the box; `body_box` is the box of the
/// whole body, `walk` is used. False if the buffers are too small.
SCREE_FN_APART bool scree_filter_tree(scree_overlap_body *body, const scree_posed_shape *posed,
                                      const scree_filter_region *region, scree_box body_box, scree_wide_walk *walk)
{
    const scree_shape_view *shape = posed->shape;
    scree_filter_query(posed, region, body_box, &walk->query);
    scree_wide_walk_start(&shape->wide_tree, walk);
    body->num_vertices = 0;
    int32_t num = 0;
    for (;;)
    {
        uint32_t found;
        const int32_t node = scree_wide_walk_next(&shape->wide_tree, walk, &found);
        body->num_triangles = num;
        if (node < 0) return true;
        if (num + SCREE_WIDE_CHILDREN > body->max_triangles ||
            body->num_vertices + 3 * SCREE_WIDE_CHILDREN > body->max_vertices)
            return false;
        for (; found != 0; found &= found - 1)
        {
            scree_kept_triangle *kept = body->kept + num;
            kept->id = shape->wide_tree.items[SCREE_WIDE_CHILDREN * node + scree_lowest_bit(found)];
            const int32_t *v = shape->triangles[kept->id].v;
            int32_t reaches = 0;
            for (int32_t c = 0; c < 3; ++c)
            {
                kept->v[c] = scree_filter_vertex(body, posed, region, v[c]);
                reaches |= (int32_t)(body->vertices[kept->v[c]].depth >= 0);
            }
            num += reaches;
        }
    }
}

SCREE_FN scree_box scree_box_of_points(scree_vec3 a, scree_vec3 b, scree_vec3 c)
{
    scree_box box;
    box.lower = scree_vec3_min(scree_vec3_min(a, b), c);
    box.upper = scree_vec3_max(scree_vec3_max(a, b), c);
    return box;
}

/// Box of the part of a triangle within the half-space, which at least one of its corners reaches.
SCREE_FN scree_box scree_filter_clipped_box(const scree_overlap_vertex *vertices, const int32_t *v)
{
    const int32_t outs = (int32_t)(vertices[v[0]].depth < 0) | (int32_t)(vertices[v[1]].depth < 0) << 1 |
                         (int32_t)(vertices[v[2]].depth < 0) << 2;
    // the corner alone on its side, and the two places where the sides from there leave the half-space: the other
    // corners, up to rounding, if all are within; points are chosen, not branches, which could not be foreseen
    const int32_t lone = scree_lone_corner(outs);
    const scree_overlap_vertex *from = vertices + SCREE_PICK3(v, lone);
    const scree_overlap_vertex *next = vertices + SCREE_PICK3(v, scree_next_corner(lone));
    const scree_overlap_vertex *last = vertices + SCREE_PICK3(v, scree_corner_before(lone));
    const scree_real to_next = from->depth / (from->depth - next->depth);
    const scree_real to_last = from->depth / (from->depth - last->depth);
    const scree_vec3 at_next =
        scree_vec3_add_scaled(from->point, scree_vec3_sub(next->point, from->point), outs == 0 ? 1 : to_next);
    const scree_vec3 at_last =
        scree_vec3_add_scaled(from->point, scree_vec3_sub(last->point, from->point), outs == 0 ? 1 : to_last);
    const bool is_from_within = from->depth >= 0;
    const scree_box box = scree_box_of_points(at_next, at_last, (is_from_within ? from : next)->point);
    return scree_box_with_point(box, (is_from_within ? from : last)->point);
}

/// The first `num` triangles are what is kept for a region. `region` may be of any lane's own.
SCREE_FN void scree_filter_end(const scree_team *team, scree_overlap_body *body, const scree_filter_region *region,
                               int32_t num)
{
    scree_team_sync(team);
    scree_box all = scree_box_empty();
    for (int32_t t = scree_team_lane(team); t < num; t += scree_team_size(team))
        all = scree_box_union(all, body->triangle_boxes[t]);
    all.lower = scree_vec3_negate(scree_team_max3(team, scree_vec3_negate(all.lower)));
    all.upper = scree_team_max3(team, all.upper);
    if (scree_team_leads(team))
    {
        body->num_triangles = num;
        body->box = all;
        body->region = region->box;
    }
    scree_team_sync(team);
}

/// Boxes of the kept triangles, clipped to the half-space; drops those that do not reach into the region with it.
SCREE_FN_APART void scree_filter_clip(scree_team lanes, scree_overlap_body *body, const scree_filter_region *region,
                                      scree_real margin)
{
    const scree_team *team = &lanes;
    const scree_vec3 margins = scree_vec3_make(margin, margin, margin);
    const int32_t num_before = body->num_triangles;
    int32_t num = 0;
    for (int32_t begin = 0; begin < num_before; begin += scree_team_size(team))
    {
        // written first and kept or not
        const int32_t t = begin + scree_team_lane(team);
        const scree_kept_triangle kept = body->kept[t < num_before ? t : begin];
        scree_box box = scree_filter_clipped_box(body->vertices, kept.v);
        box.lower = scree_vec3_sub(box.lower, margins);
        box.upper = scree_vec3_add(box.upper, margins);
        const bool is_kept = !scree_filter_misses(region, &box) && t < num_before;
        const int32_t place = scree_team_place(team, is_kept, &num);
        if (!scree_team_writes(team, is_kept)) continue;
        body->kept[place] = kept;
        body->triangle_boxes[place] = box;
    }
    scree_filter_end(team, body, region, num);
}

/// Drops triangles that do not reach into a smaller region with the same half-space.
SCREE_FN_APART void scree_filter_again(scree_team lanes, scree_overlap_body *body, const scree_filter_region *region)
{
    const scree_team *team = &lanes;
    const int32_t num_before = body->num_triangles;
    int32_t num = 0;
    for (int32_t begin = 0; begin < num_before; begin += scree_team_size(team))
    {
        const int32_t t = begin + scree_team_lane(team);
        const scree_kept_triangle kept = body->kept[t < num_before ? t : begin];
        const scree_box box = body->triangle_boxes[t < num_before ? t : begin];
        const bool is_kept = !scree_filter_misses(region, &box) && t < num_before;
        const int32_t place = scree_team_place(team, is_kept, &num);
        if (!scree_team_writes(team, is_kept)) continue;
        body->kept[place] = kept;
        body->triangle_boxes[place] = box;
    }
    scree_filter_end(team, body, region, num);
}

/// Is a vertex of the body beyond doubt outside the other?
SCREE_FN bool scree_filter_is_outside(const scree_overlap_body *body, bool is_of_a, const scree_overlap_vertex *vertex)
{
    const scree_vec3 p = vertex->point;
    const scree_box *region = &body->region;
    const int32_t beyond = is_of_a ? (int32_t)(p.z < region->lower.z) : (int32_t)(p.z > region->upper.z);
    return ((int32_t)(vertex->depth < 0) | (int32_t)(p.x < region->lower.x) | (int32_t)(p.x > region->upper.x) |
            (int32_t)(p.y < region->lower.y) | (int32_t)(p.y > region->upper.y) | beyond) != 0;
}

/// Sets slice->lack if there is no room for this shape.
SCREE_FN void scree_filter_check_room(scree_overlap_slice *slice, int32_t side, const scree_shape_view *shape)
{
    const scree_overlap_body *body = slice->body + side;
    const bool uses_tree = scree_filter_uses_tree(shape);
    if (shape->num_triangles > body->max_shape_triangles ||
        (uses_tree && shape->num_vertices > body->max_shape_vertices))
        slice->lack = SCREE_LACK_SHAPE;
    else if (!uses_tree && (shape->num_vertices > body->max_vertices || shape->num_triangles >= body->max_triangles))
        slice->lack = SCREE_LACK_PIECES;
}

/// No triangle is finished, all can be found by their id.
SCREE_FN void scree_filter_enter(const scree_team *team, scree_overlap_body *body)
{
    for (int32_t t = scree_team_lane(team); t < body->num_triangles; t += scree_team_size(team))
    {
        body->kept[t].is_finished = false;
        body->kept[t].face = t;
        body->triangle_slot[body->kept[t].id] = t;
    }
    scree_team_sync(team);
}

/// A kept triangle with what is derived from its corners, made when it is asked for first.
SCREE_FN scree_overlap_triangle *scree_overlap_finish(scree_overlap_body *body, int32_t t)
{
    scree_kept_triangle *kept = body->kept + t;
    scree_overlap_triangle *triangle = body->triangles + t;
    if (kept->is_finished) return triangle;
    kept->is_finished = true;
    const scree_overlap_vertex *v0 = body->vertices + kept->v[0];
    const scree_overlap_vertex *v1 = body->vertices + kept->v[1];
    const scree_overlap_vertex *v2 = body->vertices + kept->v[2];
    triangle->id = kept->id;
    triangle->has_foot = false;
    triangle->v[0] = kept->v[0];
    triangle->v[1] = kept->v[1];
    triangle->v[2] = kept->v[2];
    triangle->crossing[0] = -1;
    triangle->crossing[1] = -1;
    triangle->crossing[2] = -1;
    scree_face *face = &triangle->face;
    face->p[0] = v0->point;
    face->p[1] = v1->point;
    face->p[2] = v2->point;
    face->normal = scree_vec3_cross(scree_vec3_sub(v1->point, v0->point), scree_vec3_sub(v2->point, v0->point));
    face->offset = scree_vec3_dot(face->normal, v0->point);
    face->reversed = (int32_t)(v0->id > v1->id) | (int32_t)(v1->id > v2->id) << 1 | (int32_t)(v2->id > v0->id) << 2;
    const scree_box box = scree_box_of_points(v0->point, v1->point, v2->point);
    face->size = box.upper.x - box.lower.x + (box.upper.y - box.lower.y) + (box.upper.z - box.lower.z);
    return triangle;
}

#endif
