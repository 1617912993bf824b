/// \file overlap_crossings_kernel.h
/// First pass of an overlap: which edges pass through which triangles of the other body, and which vertices lie
/// inside it.
#ifndef SCREE_OVERLAP_CROSSINGS_KERNEL_H
#define SCREE_OVERLAP_CROSSINGS_KERNEL_H

#include "contact/box_index_kernel.h"
#include "contact/overlap_hierarchy_kernel.h"
#include "contact/overlap_parts.h"
#include "contact/overlap_signs_kernel.h"
#include "contact/triangle_filter_kernel.h"

/// Are all corners of face g beyond doubt on one side of the plane of face f?
SCREE_FN bool scree_face_misses_plane(const scree_face *g, const scree_face *f, scree_real tolerance)
{
    const scree_real margin = tolerance * f->size * f->size;
    const scree_real h0 = scree_face_height(f, g->p[0]);
    const scree_real h1 = scree_face_height(f, g->p[1]);
    const scree_real h2 = scree_face_height(f, g->p[2]);
    return (int32_t)(scree_min(scree_min(h0, h1), h2) > margin) | (int32_t)(scree_max(scree_max(h0, h1), h2) < -margin);
}

/// Rows of body `side` against one block of the other's near triangles: boxes that overlap, unless one triangle is
/// beyond doubt on one side of the other's plane. Then neither can cross the other, in the hierarchy neither.
SCREE_FN void scree_overlap_find_rows(scree_overlap_slice *slice, int32_t side, int32_t block)
{
    scree_overlap_body *own = slice->body + side;
    const scree_overlap_body *other = slice->body + 1 - side;
    const int32_t begin = SCREE_INDEX_MAX * block;
    const int32_t rest = other->num_near_triangles - begin;
    const int32_t num = rest < SCREE_INDEX_MAX ? rest : SCREE_INDEX_MAX;
    scree_box_index index;
    scree_index_build(&index, other->triangle_boxes + begin, num, slice->common);
    for (int32_t f = 0; f < own->num_near_triangles; ++f)
    {
        const scree_face *face = &own->triangles[f].face;
        uint64_t candidates = scree_index_query(&index, own->triangle_boxes[f]);
        uint64_t row = 0;
        for (; candidates != 0; candidates &= candidates - 1)
        {
            const int32_t g = scree_lowest_bit(candidates);
            const scree_face *other_face = &other->triangles[begin + g].face;
            if (num > SCREE_INDEX_DIRECT &&
                !scree_box_overlaps(own->triangle_boxes[f], other->triangle_boxes[begin + g]))
                continue;
            if (slice->sign_tolerance > 0 && (scree_face_misses_plane(other_face, face, slice->sign_tolerance) ||
                                              scree_face_misses_plane(face, other_face, slice->sign_tolerance)))
                continue;
            row |= (uint64_t)1 << g;
        }
        own->rows[f] = row;
    }
}

/// Rows of B from those of A, where one block holds all.
SCREE_FN void scree_overlap_transpose_rows(scree_overlap_slice *slice)
{
    const scree_overlap_body *a = slice->body;
    scree_overlap_body *b = slice->body + 1;
    for (int32_t g = 0; g < b->num_near_triangles; ++g) b->rows[g] = 0;
    for (int32_t f = 0; f < a->num_near_triangles; ++f)
        for (uint64_t row = a->rows[f]; row != 0; row &= row - 1) b->rows[scree_lowest_bit(row)] |= (uint64_t)1 << f;
}

/// Do the near triangles of both bodies fit into one block, so that all rows are known at once?
SCREE_FN bool scree_overlap_is_one_block(const scree_overlap_slice *slice)
{
    return slice->body[0].num_near_triangles <= SCREE_INDEX_MAX && slice->body[1].num_near_triangles <= SCREE_INDEX_MAX;
}

/// How often vertex v of body `side` lies inside the other: by the ray along -z from A, along +z from B.
SCREE_FN int32_t scree_overlap_count_inside(const scree_overlap_slice *slice, int32_t side,
                                            const scree_box_index *index, int32_t begin, scree_vec3 p)
{
    const scree_overlap_body *other = slice->body + 1 - side;
    scree_box ray;
    ray.lower = p;
    ray.upper = p;
    if (side == 0) ray.lower.z = -SCREE_REAL_MAX;
    else ray.upper.z = SCREE_REAL_MAX;
    int32_t count = 0;
    for (uint64_t candidates = scree_index_query(index, ray); candidates != 0; candidates &= candidates - 1)
    {
        const scree_face *g = &other->triangles[begin + scree_lowest_bit(candidates)].face;
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
    const scree_overlap_body *other = slice->body + 1 - side;
    const int32_t dropping = side == 0 ? SCREE_OUTSIDE_A : SCREE_OUTSIDE_B;
    for (int32_t v = 0; v < body->num_vertices; ++v) body->inside[v] = 0;
    for (int32_t begin = 0; begin < other->num_triangles; begin += SCREE_INDEX_MAX)
    {
        const int32_t rest = other->num_triangles - begin;
        scree_box_index index;
        scree_index_build(&index, other->triangle_boxes + begin, rest < SCREE_INDEX_MAX ? rest : SCREE_INDEX_MAX,
                          slice->common);
        for (int32_t v = 0; v < body->num_vertices; ++v)
            if ((body->outcode[v] & dropping) == 0)
                body->inside[v] += scree_overlap_count_inside(slice, side, &index, begin, body->points[v]);
    }
    body->num_inside = 0;
    for (int32_t v = 0; v < body->num_vertices; ++v) body->num_inside += body->inside[v] != 0;
}

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
    edge->size = scree_abs(q.x - p.x) + scree_abs(q.y - p.y) + scree_abs(q.z - p.z);
    ++body->num_edges;
}

/// Makes the edges between kept triangles that may cross something or end inside; all of them if the rows do not tell.
/// False if there are too many.
SCREE_FN bool scree_overlap_make_edges(scree_overlap_slice *slice, int32_t side, const scree_shape_view *shape)
{
    scree_overlap_body *body = slice->body + side;
    const bool has_rows = scree_overlap_is_one_block(slice);
    body->num_edges = 0;
    for (int32_t t = 0; t < body->num_triangles; ++t)
    {
        const uint64_t row = !has_rows ? 1 : t < body->num_near_triangles ? body->rows[t] : 0;
        if (row == 0 && body->num_inside == 0) continue;
        for (int32_t k = 0; k < 3; ++k)
        {
            // each edge once, from the triangle of lower place
            const int32_t neighbour = scree_kept_neighbour(body, shape, t, k);
            if (neighbour < t) continue;
            const scree_overlap_triangle *triangle = body->triangles + t;
            const int32_t inside = body->inside[triangle->v[k]] | body->inside[triangle->v[k == 2 ? 0 : k + 1]];
            const bool may_cross =
                !has_rows || (neighbour < body->num_near_triangles && (row & body->rows[neighbour]) != 0);
            if (inside == 0 && !may_cross) continue;
            if (body->num_edges == body->max_edges) return false;
            scree_overlap_make_edge(body, t, k, neighbour);
        }
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

/// Crossings of edges of body `side` with triangles of one block of the other. False if there are too many.
SCREE_FN bool scree_overlap_cross_block(scree_overlap_slice *slice, int32_t side, int32_t block)
{
    const scree_overlap_body *own = slice->body + side;
    for (int32_t e = 0; e < own->num_edges; ++e)
    {
        const scree_overlap_edge *edge = own->edges + e;
        if (edge->left >= own->num_near_triangles || edge->right >= own->num_near_triangles) continue;
        uint64_t candidates = own->rows[edge->left] & own->rows[edge->right];
        for (; candidates != 0; candidates &= candidates - 1)
        {
            const int32_t t = SCREE_INDEX_MAX * block + scree_lowest_bit(candidates);
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

/// All crossings of edges of body `side`. False if there are too many.
SCREE_FN bool scree_overlap_find_crossings(scree_overlap_slice *slice, int32_t side)
{
    if (scree_overlap_is_one_block(slice)) return scree_overlap_cross_block(slice, side, 0);
    const int32_t num_near = slice->body[1 - side].num_near_triangles;
    for (int32_t block = 0; SCREE_INDEX_MAX * block < num_near; ++block)
    {
        scree_overlap_find_rows(slice, side, block);
        if (!scree_overlap_cross_block(slice, side, block)) return false;
    }
    return true;
}

/// Crossings and inside counts of both bodies. False if there are too many; slice->lack tells of what.
SCREE_FN bool scree_overlap_collect(scree_overlap_slice *slice, const scree_shape_view *const *shape)
{
    slice->num_crossings = 0;
    if (scree_overlap_is_one_block(slice))
    {
        scree_overlap_find_rows(slice, 0, 0);
        scree_overlap_transpose_rows(slice);
    }
    for (int32_t side = 0; side < 2; ++side)
    {
        scree_overlap_find_inside(slice, side);
        if (!scree_overlap_make_edges(slice, side, shape[side]))
        {
            slice->lack = SCREE_LACK_PIECES;
            return false;
        }
        if (!scree_overlap_find_crossings(slice, side))
        {
            slice->lack = SCREE_LACK_CROSSINGS;
            return false;
        }
    }
    return true;
}

#endif
