/// \file overlap_crossings_kernel.h
/// First pass of an overlap: which edges pass through which triangles of the other body, and which vertices lie
/// inside it.
#ifndef SCREE_OVERLAP_CROSSINGS_KERNEL_H
#define SCREE_OVERLAP_CROSSINGS_KERNEL_H

#include "contact/overlap_hierarchy_kernel.h"
#include "contact/overlap_parts.h"
#include "contact/overlap_signs_kernel.h"
#include "contact/triangle_filter_kernel.h"

/// Place of the neighbour across side k of a kept triangle, or -1 if the neighbour is not kept.
SCREE_FN int32_t scree_kept_neighbour(const scree_overlap_body *body, const scree_shape_view *shape, int32_t t,
                                      int32_t k)
{
    const int32_t id = shape->neighbours[3 * body->triangles[t].id + k];
    const int32_t slot = body->triangle_slot[id];
    return slot < body->num_triangles && body->triangles[slot].id == id ? slot : -1;
}

/// The edge between triangle t, along its side k, and its neighbour.
SCREE_FN void scree_overlap_make_edge(scree_overlap_body *body, int32_t t, int32_t k, int32_t neighbour)
{
    const scree_overlap_triangle *triangle = body->triangles + t;
    const int32_t next = k == 2 ? 0 : k + 1;
    const bool is_reversed = ((triangle->face.reversed >> k) & 1) != 0;
    scree_overlap_edge *edge = body->edges + body->num_edges;
    edge->v[0] = triangle->v[is_reversed ? next : k];
    edge->v[1] = triangle->v[is_reversed ? k : next];
    edge->left = is_reversed ? neighbour : t;
    edge->right = is_reversed ? t : neighbour;
    edge->has_foot = false;
    const scree_vec3 p = body->points[edge->v[0]];
    const scree_vec3 q = body->points[edge->v[1]];
    edge->line.p[0] = p;
    edge->line.p[1] = q;
    scree_box *box = body->edge_boxes + body->num_edges;
    box->lower = scree_vec3_min(p, q);
    box->upper = scree_vec3_max(p, q);
    edge->size = box->upper.x - box->lower.x + (box->upper.y - box->lower.y) + (box->upper.z - box->lower.z);
    ++body->num_edges;
}

/// Makes the edges between kept triangles, those between two near ones first. False if there are too many.
SCREE_FN bool scree_overlap_make_edges(scree_overlap_body *body, const scree_shape_view *shape)
{
    body->num_edges = 0;
    for (int32_t is_far = 0; is_far < 2; ++is_far)
    {
        for (int32_t t = 0; t < body->num_triangles; ++t)
        {
            if (is_far == 0 && t == body->num_near_triangles) break;
            for (int32_t k = 0; k < 3; ++k)
            {
                // each edge once, from the triangle of lower place
                const int32_t neighbour = scree_kept_neighbour(body, shape, t, k);
                if (neighbour < t || (neighbour >= body->num_near_triangles) != (is_far == 1)) continue;
                if (body->num_edges == body->max_edges) return false;
                scree_overlap_make_edge(body, t, k, neighbour);
            }
        }
        if (is_far == 0) body->num_near_edges = body->num_edges;
        if (body->num_near_triangles == body->num_triangles) break;
    }
    return true;
}

/// Does edge e of body `side` cross triangle t of the other? The sign is x12 for A and x21 for B.
SCREE_FN int32_t scree_overlap_decide(const scree_overlap_slice *slice, int32_t side, int32_t e, int32_t t,
                                      scree_vec3 *point)
{
    const scree_overlap_edge *edge = slice->body[side].edges + e;
    const scree_face *g = &slice->body[1 - side].triangles[t].face;
    if (slice->sign_tolerance > 0)
    {
        const scree_sign_verdict verdict = scree_edge_sign(&edge->line, edge->size, g, slice->sign_tolerance, point);
        if (verdict != SCREE_SIGN_UNSURE) return side == 0 ? (int32_t)verdict : -(int32_t)verdict;
    }
    return side == 0 ? scree_edge_a_crosses(&edge->line, g, point) : scree_edge_b_crosses(g, &edge->line, point);
}

/// All crossings of edges of body `side` with triangles of the other. False if there are too many.
SCREE_FN bool scree_overlap_find_crossings(scree_overlap_slice *slice, int32_t side)
{
    const scree_overlap_body *own = slice->body + side;
    const scree_overlap_body *other = slice->body + 1 - side;
    for (int32_t e = 0; e < own->num_near_edges; ++e)
    {
        const scree_box box = own->edge_boxes[e];
        for (int32_t t = 0; t < other->num_near_triangles; ++t)
        {
            if (!scree_box_overlaps(box, other->triangle_boxes[t])) continue;
            scree_vec3 point;
            const int32_t sign = scree_overlap_decide(slice, side, e, t, &point);
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
        const scree_face *g = &other->triangles[t].face;
        int32_t own = SCREE_SIGN_UNSURE;
        if (slice->sign_tolerance > 0) own = scree_vertex_sign(p, g, side == 0, slice->sign_tolerance);
        if (own == SCREE_SIGN_UNSURE) own = side == 0 ? scree_vertex_a_above(p, g) : -scree_vertex_b_below(p, g);
        count += own;
    }
    return count;
}

/// Counts of all vertices of body `side`. Those outside the region of the filter are outside the other body.
SCREE_FN void scree_overlap_find_inside(scree_overlap_slice *slice, int32_t side)
{
    scree_overlap_body *body = slice->body + side;
    const int32_t dropping = side == 0 ? SCREE_OUTSIDE_A : SCREE_OUTSIDE_B;
    body->num_inside = 0;
    for (int32_t v = 0; v < body->num_vertices; ++v)
    {
        body->inside[v] = (body->outcode[v] & dropping) == 0 ? scree_overlap_count_inside(slice, side, v) : 0;
        body->num_inside += body->inside[v] != 0;
    }
}

#endif
