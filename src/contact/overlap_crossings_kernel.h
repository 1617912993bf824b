/// \file overlap_crossings_kernel.h
/// First pass of an overlap: which edges pass through which triangles of the other body, and which vertices lie
/// inside it.
#ifndef SCREE_OVERLAP_CROSSINGS_KERNEL_H
#define SCREE_OVERLAP_CROSSINGS_KERNEL_H

#include "contact/overlap_hierarchy_kernel.h"
#include "contact/overlap_parts.h"
#include "contact/overlap_signs_kernel.h"

/// Count of a vertex that nothing has asked about yet.
#define SCREE_INSIDE_UNKNOWN INT32_MIN

/// Place of the neighbour across side k of a kept triangle, or -1 if the neighbour is not kept.
SCREE_FN int32_t scree_kept_neighbour(const scree_overlap_body *body, const scree_shape_view *shape, int32_t t,
                                      int32_t k)
{
    const int32_t id = shape->neighbours[3 * body->triangles[t].id + k];
    const int32_t slot = body->triangle_slot[id];
    return slot < body->num_triangles && body->triangles[slot].id == id ? slot : -1;
}

/// Makes the edges between kept triangles. False if there are too many.
SCREE_FN bool scree_overlap_make_edges(scree_overlap_body *body, const scree_shape_view *shape)
{
    body->num_edges = 0;
    for (int32_t t = 0; t < body->num_triangles; ++t)
    {
        const scree_overlap_triangle *triangle = body->triangles + t;
        for (int32_t k = 0; k < 3; ++k)
        {
            const int32_t other = scree_kept_neighbour(body, shape, t, k);
            if (other < t) continue;
            if (body->num_edges == body->max_edges) return false;
            const bool is_reversed = ((triangle->reversed >> k) & 1) != 0;
            const int32_t start = triangle->v[k];
            const int32_t end = triangle->v[k == 2 ? 0 : k + 1];
            scree_overlap_edge *edge = body->edges + body->num_edges;
            edge->v[0] = is_reversed ? end : start;
            edge->v[1] = is_reversed ? start : end;
            edge->left = is_reversed ? other : t;
            edge->right = is_reversed ? t : other;
            edge->has_foot = false;
            const scree_vec3 p = body->points[start];
            const scree_vec3 q = body->points[end];
            scree_box *box = body->edge_boxes + body->num_edges;
            box->lower = scree_vec3_min(p, q);
            box->upper = scree_vec3_max(p, q);
            edge->size = box->upper.x - box->lower.x + (box->upper.y - box->lower.y) + (box->upper.z - box->lower.z);
            body->inside[start] = SCREE_INSIDE_UNKNOWN;
            body->inside[end] = SCREE_INSIDE_UNKNOWN;
            ++body->num_edges;
        }
    }
    return true;
}

SCREE_FN scree_line scree_overlap_line(const scree_overlap_body *body, int32_t e)
{
    scree_line line;
    line.p[0] = body->points[body->edges[e].v[0]];
    line.p[1] = body->points[body->edges[e].v[1]];
    return line;
}

SCREE_FN scree_signed_face scree_overlap_face(const scree_overlap_body *body, int32_t t)
{
    const scree_overlap_triangle *triangle = body->triangles + t;
    scree_signed_face g;
    for (int32_t k = 0; k < 3; ++k) g.face.p[k] = body->points[triangle->v[k]];
    g.face.reversed = triangle->reversed;
    g.normal = triangle->normal;
    g.size = triangle->size;
    return g;
}

/// Does edge e of body `side` cross triangle t of the other? The sign is x12 for A and x21 for B.
SCREE_FN int32_t scree_overlap_decide(const scree_overlap_slice *slice, int32_t side, int32_t e, int32_t t,
                                      scree_overlap_scheme scheme, scree_vec3 *point)
{
    const scree_line line = scree_overlap_line(slice->body + side, e);
    const scree_signed_face g = scree_overlap_face(slice->body + 1 - side, t);
    if (scheme == SCREE_OVERLAP_FILTERED)
    {
        const scree_real tolerance = SCREE_SIGN_MARGIN * SCREE_REAL_EPSILON * slice->extent;
        const scree_sign_verdict verdict =
            scree_edge_sign(&line, slice->body[side].edges[e].size, &g, tolerance, point);
        if (verdict != SCREE_SIGN_UNSURE) return side == 0 ? (int32_t)verdict : -(int32_t)verdict;
    }
    return side == 0 ? scree_edge_a_crosses(&line, &g.face, point) : scree_edge_b_crosses(&g.face, &line, point);
}

/// All crossings of edges of body `side` with triangles of the other. False if there are too many.
SCREE_FN bool scree_overlap_find_crossings(scree_overlap_slice *slice, int32_t side, scree_overlap_scheme scheme)
{
    const scree_overlap_body *own = slice->body + side;
    const scree_overlap_body *other = slice->body + 1 - side;
    for (int32_t e = 0; e < own->num_edges; ++e)
    {
        const scree_box box = own->edge_boxes[e];
        for (int32_t t = 0; t < other->num_triangles; ++t)
        {
            if (!scree_box_overlaps(box, other->triangle_boxes[t])) continue;
            scree_vec3 point;
            const int32_t sign = scree_overlap_decide(slice, side, e, t, scheme, &point);
            if (sign == 0) continue;
            if (slice->num_crossings == slice->max_crossings) return false;
            scree_overlap_crossing *crossing = slice->crossings + slice->num_crossings++;
            crossing->point = point;
            crossing->edge = e;
            crossing->triangle = t;
            crossing->sign = sign;
            crossing->is_of_b = side;
        }
    }
    return true;
}

/// How often vertex v of body `side` lies inside the other: by the ray along -z from A, along +z from B.
SCREE_FN int32_t scree_overlap_count_inside(const scree_overlap_slice *slice, int32_t side, int32_t v)
{
    const scree_overlap_body *other = slice->body + 1 - side;
    const scree_vec3 p = slice->body[side].points[v];
    int32_t count = 0;
    for (int32_t t = 0; t < other->num_triangles; ++t)
    {
        const scree_box *box = other->triangle_boxes + t;
        if (p.x < box->lower.x || p.x > box->upper.x || p.y < box->lower.y || p.y > box->upper.y) continue;
        if (side == 0 ? p.z < box->lower.z : p.z > box->upper.z) continue;
        const scree_signed_face g = scree_overlap_face(other, t);
        count += side == 0 ? scree_vertex_a_above(p, &g.face) : -scree_vertex_b_below(p, &g.face);
    }
    return count;
}

/// Counts of the ends of all edges of body `side`; those that are on no edge stay unknown and are never asked for.
SCREE_FN void scree_overlap_find_inside(scree_overlap_slice *slice, int32_t side)
{
    scree_overlap_body *body = slice->body + side;
    for (int32_t e = 0; e < body->num_edges; ++e)
    {
        for (int32_t end = 0; end < 2; ++end)
        {
            const int32_t v = body->edges[e].v[end];
            if (body->inside[v] == SCREE_INSIDE_UNKNOWN) body->inside[v] = scree_overlap_count_inside(slice, side, v);
        }
    }
}

#endif
