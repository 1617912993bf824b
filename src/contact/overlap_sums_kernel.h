/// \file overlap_sums_kernel.h
/// Second pass of an overlap: segments where triangles meet, and the sums over crossings, segments and inside vertices
/// about the middle C of the contact. Everything is relative to C. Franklin & Kankanhalli (1993), "Volumes from
/// overlaying 3-D triangulations in parallel": each term is the signed tetrahedron (C, foot on the plane, foot on the
/// edge, point). Departure: where two triangles meet the two ends are taken together, as the segment p to q, which
/// stays accurate when the triangles are nearly parallel.
///     6 V = sum over edges (q_left - q_right) . (r x sum of +-x)  +  sum over segments (q_f - q_g) . (p x q)
///     2 S = sum over segments p x q
///     24 M = sum over the same terms, each times (q + r + x) or (q + p + q')
/// x: crossings and inside vertices, + where the edge's part inside the other body ends there, - where it starts.
#ifndef SCREE_OVERLAP_SUMS_KERNEL_H
#define SCREE_OVERLAP_SUMS_KERNEL_H

#include "contact/overlap_crossings_kernel.h"

/// A triangle is thin, and a sliver, below these heights over its longest side.
#define SCREE_THIN_HEIGHT ((scree_real)0.03)
#define SCREE_SLIVER_HEIGHT ((scree_real)1e-3)

typedef struct scree_overlap_sums
{
    scree_vec3 middle; ///< C
    scree_box box;     ///< of all collected points
    scree_real six_volume;
    scree_real lost;        ///< what rounding has taken from six_volume so far, until it is added at the end
    scree_vec3 moment;      ///< 24 times the first moment about C
    scree_vec3 area_vector; ///< twice S
    scree_real residual;
    scree_real area; ///< of the overlap's surface
} scree_overlap_sums;

/// Point of the segment p0 p1 nearest to the origin, from its nearer end.
SCREE_FN scree_vec3 scree_segment_foot(scree_vec3 p0, scree_vec3 p1)
{
    const scree_vec3 u = scree_vec3_sub(p1, p0);
    const scree_real length2 = scree_vec3_dot(u, u);
    const scree_real along0 = -scree_vec3_dot(p0, u);
    const scree_real along1 = scree_vec3_dot(p1, u);
    if (!(along0 > 0)) return p0;
    if (!(along1 > 0)) return p1;
    if (along0 <= along1) return scree_vec3_add_scaled(p0, u, along0 / length2);
    return scree_vec3_add_scaled(p1, u, -(along1 / length2));
}

/// Foot of C on an edge, computed once.
SCREE_FN scree_vec3 scree_overlap_edge_foot(scree_overlap_edge *edge, scree_vec3 middle)
{
    if (!edge->has_foot)
    {
        edge->foot =
            scree_segment_foot(scree_vec3_sub(edge->line.p[0], middle), scree_vec3_sub(edge->line.p[1], middle));
        edge->has_foot = true;
    }
    return edge->foot;
}

/// Point of the triangle's sides nearest to C.
SCREE_FN scree_vec3 scree_nearest_on_sides(const scree_face *face, scree_vec3 middle)
{
    scree_vec3 nearest = scree_vec3_zero();
    scree_real least = SCREE_REAL_MAX;
    for (int32_t k = 0; k < 3; ++k)
    {
        const scree_vec3 foot =
            scree_segment_foot(scree_vec3_sub(face->p[k], middle), scree_vec3_sub(face->p[k == 2 ? 0 : k + 1], middle));
        const scree_real distance = scree_vec3_dot(foot, foot);
        if (distance >= least) continue;
        least = distance;
        nearest = foot;
    }
    return nearest;
}

/// Foot of C on a triangle's plane, computed once. A thin triangle's normal is poor, so its plane is taken through the
/// point of its sides nearest to C; the foot on a sliver is that point itself.
SCREE_FN scree_vec3 scree_overlap_plane_foot(scree_overlap_triangle *triangle, scree_vec3 middle)
{
    if (triangle->has_foot) return triangle->foot;
    triangle->has_foot = true;
    triangle->boundary = scree_vec3_zero();
    const scree_vec3 n = triangle->face.normal;
    const scree_real n2 = scree_vec3_dot(n, n);
    const scree_real size2 = triangle->face.size * triangle->face.size;
    scree_vec3 on_plane = scree_vec3_sub(triangle->face.p[0], middle);
    if (n2 < SCREE_THIN_HEIGHT * size2 * (SCREE_THIN_HEIGHT * size2))
        on_plane = scree_nearest_on_sides(&triangle->face, middle);
    triangle->foot = on_plane;
    if (n2 > SCREE_SLIVER_HEIGHT * size2 * (SCREE_SLIVER_HEIGHT * size2))
        triangle->foot = scree_vec3_scale(n, scree_vec3_dot(n, on_plane) / n2);
    return triangle->foot;
}

/// Box of all crossings and inside vertices.
SCREE_FN scree_box scree_overlap_points_box(const scree_overlap_slice *slice)
{
    scree_box box = scree_box_empty();
    for (int32_t c = 0; c < slice->num_crossings; ++c) box = scree_box_with_point(box, slice->crossings[c].point);
    for (int32_t side = 0; side < 2; ++side)
    {
        const scree_overlap_body *body = slice->body + side;
        if (body->num_inside == 0) continue;
        for (int32_t v = 0; v < body->num_vertices; ++v)
            if (body->inside[v] != 0) box = scree_box_with_point(box, body->points[v]);
    }
    return box;
}

/// Adds a term to six_volume and keeps what is rounded off (Knuth): a large overlap is the sum of thousands of terms.
SCREE_FN void scree_overlap_add_volume(scree_overlap_sums *sums, scree_real term)
{
    const scree_real sum = sums->six_volume + term;
    const scree_real added = sum - sums->six_volume;
    sums->lost += (sums->six_volume - (sum - added)) + (term - added);
    sums->six_volume = sum;
}

/// One point of an edge: the end (sign > 0) or the start of a part inside the other body. x is relative to C.
SCREE_FN void scree_overlap_add_point(scree_overlap_body *body, int32_t e, scree_vec3 x, scree_real sign,
                                      scree_overlap_sums *sums)
{
    scree_overlap_edge *edge = body->edges + e;
    scree_overlap_triangle *left = body->triangles + edge->left;
    scree_overlap_triangle *right = body->triangles + edge->right;
    const scree_vec3 r = scree_overlap_edge_foot(edge, sums->middle);
    const scree_vec3 q_left = scree_overlap_plane_foot(left, sums->middle);
    const scree_vec3 q_right = scree_overlap_plane_foot(right, sums->middle);
    const scree_vec3 twice_area = scree_vec3_scale(scree_vec3_cross(r, x), sign);
    const scree_real term = scree_vec3_dot(scree_vec3_sub(q_left, q_right), twice_area);
    scree_overlap_add_volume(sums, term);
    sums->moment = scree_vec3_add_scaled(sums->moment, scree_vec3_add(r, x), term);
    left->boundary = scree_vec3_add(left->boundary, twice_area);
    right->boundary = scree_vec3_sub(right->boundary, twice_area);
}

/// All points of all edges.
SCREE_FN void scree_overlap_sum_edges(scree_overlap_slice *slice, scree_overlap_sums *sums)
{
    for (int32_t c = 0; c < slice->num_crossings; ++c)
    {
        const scree_overlap_crossing *crossing = slice->crossings + c;
        const scree_real sign = (scree_real)(crossing->is_of_b ? crossing->sign : -crossing->sign);
        scree_overlap_add_point(slice->body + crossing->is_of_b, crossing->edge,
                                scree_vec3_sub(crossing->point, sums->middle), sign, sums);
    }
    for (int32_t side = 0; side < 2; ++side)
    {
        scree_overlap_body *body = slice->body + side;
        if (body->num_inside == 0) continue;
        for (int32_t e = 0; e < body->num_edges; ++e)
        {
            for (int32_t end = 0; end < 2; ++end)
            {
                const int32_t v = body->edges[e].v[end];
                const int32_t inside = end == 0 ? -body->inside[v] : body->inside[v];
                if (inside == 0) continue;
                scree_overlap_add_point(body, e, scree_vec3_sub(body->points[v], sums->middle), (scree_real)inside,
                                        sums);
            }
        }
    }
}

/// Size of the table for the crossings there are: a power of two at least four times their number.
SCREE_FN int32_t scree_overlap_table_size(int32_t num_crossings)
{
    int32_t size = 16;
    while (size < 4 * num_crossings) size *= 2;
    return size;
}

/// First segment of a pair of triangles, or where to enter it: the place in the table.
SCREE_FN int32_t scree_overlap_find_slot(const scree_overlap_slice *slice, int32_t size, int32_t triangle_a,
                                         int32_t triangle_b)
{
    const uint32_t hash = (uint32_t)triangle_a * 0x9e3779b1u ^ (uint32_t)triangle_b * 0x85ebca77u;
    int32_t slot = (int32_t)((hash >> 8) & (uint32_t)(size - 1));
    for (;;)
    {
        const int32_t s = slice->table[slot];
        if (s < 0) return slot;
        if (slice->segments[s].triangle_a == triangle_a && slice->segments[s].triangle_b == triangle_b) return slot;
        slot = (slot + 1) & (size - 1);
    }
}

/// Enters crossing c as an end (is_end) or a start of a segment of the pair of triangles in `slot`.
SCREE_FN void scree_overlap_join(scree_overlap_slice *slice, int32_t slot, int32_t c, bool is_end)
{
    int32_t s = slice->table[slot];
    while (s >= 0)
    {
        scree_overlap_segment *segment = slice->segments + s;
        int32_t *open = is_end ? &segment->q : &segment->p;
        if (*open < 0)
        {
            *open = c;
            return;
        }
        s = segment->next;
    }
    scree_overlap_segment *added = slice->segments + slice->num_segments;
    added->p = is_end ? -1 : c;
    added->q = is_end ? c : -1;
    added->next = slice->table[slot];
    slice->table[slot] = slice->num_segments++;
}

/// Pairs the crossings of each two triangles into segments: counted +1 in the triangle of A is an end, -1 a start.
/// False if one stays alone, which cannot be unless two decisions disagreed.
SCREE_FN bool scree_overlap_make_segments(scree_overlap_slice *slice)
{
    const int32_t size = scree_overlap_table_size(slice->num_crossings);
    for (int32_t i = 0; i < size; ++i) slice->table[i] = -1;
    slice->num_segments = 0;
    for (int32_t c = 0; c < slice->num_crossings; ++c)
    {
        const scree_overlap_crossing *crossing = slice->crossings + c;
        const scree_overlap_edge *edge = slice->body[crossing->is_of_b].edges + crossing->edge;
        for (int32_t turn = 0; turn < 2; ++turn)
        {
            const int32_t own = turn == 0 ? edge->left : edge->right;
            const int32_t triangle_a = crossing->is_of_b ? crossing->triangle : own;
            const int32_t triangle_b = crossing->is_of_b ? own : crossing->triangle;
            const int32_t slot = scree_overlap_find_slot(slice, size, triangle_a, triangle_b);
            const int32_t num_before = slice->num_segments;
            scree_overlap_join(slice, slot, c, (turn == 0) == (crossing->sign > 0));
            if (slice->num_segments == num_before) continue;
            slice->segments[num_before].triangle_a = triangle_a;
            slice->segments[num_before].triangle_b = triangle_b;
        }
    }
    for (int32_t s = 0; s < slice->num_segments; ++s)
        if (slice->segments[s].p < 0 || slice->segments[s].q < 0) return false;
    return true;
}

SCREE_FN void scree_overlap_sum_segments(scree_overlap_slice *slice, scree_overlap_sums *sums)
{
    for (int32_t s = 0; s < slice->num_segments; ++s)
    {
        const scree_overlap_segment *segment = slice->segments + s;
        if (segment->p < 0 || segment->q < 0) continue;
        const scree_vec3 p = scree_vec3_sub(slice->crossings[segment->p].point, sums->middle);
        const scree_vec3 q = scree_vec3_sub(slice->crossings[segment->q].point, sums->middle);
        scree_overlap_triangle *f = slice->body[0].triangles + segment->triangle_a;
        scree_overlap_triangle *g = slice->body[1].triangles + segment->triangle_b;
        const scree_vec3 foot_f = scree_overlap_plane_foot(f, sums->middle);
        const scree_vec3 foot_g = scree_overlap_plane_foot(g, sums->middle);
        const scree_vec3 twice_area = scree_vec3_cross(p, q);
        const scree_real term = scree_vec3_dot(scree_vec3_sub(foot_f, foot_g), twice_area);
        scree_overlap_add_volume(sums, term);
        sums->moment = scree_vec3_add_scaled(sums->moment, scree_vec3_add(p, q), term);
        sums->area_vector = scree_vec3_add(sums->area_vector, twice_area);
        f->boundary = scree_vec3_add(f->boundary, twice_area);
        g->boundary = scree_vec3_sub(g->boundary, twice_area);
    }
}

/// The part of each term's moment that belongs to the foot on the plane, and the certificate: the area vectors of
/// the two parts of the surface, each from the faces' own normals, must cancel.
SCREE_FN void scree_overlap_sum_faces(scree_overlap_slice *slice, scree_overlap_sums *sums)
{
    scree_vec3 twice_sum = scree_vec3_zero();
    scree_real twice_area = 0;
    for (int32_t side = 0; side < 2; ++side)
    {
        const scree_overlap_body *body = slice->body + side;
        for (int32_t t = 0; t < body->num_triangles; ++t)
        {
            const scree_overlap_triangle *triangle = body->triangles + t;
            if (!triangle->has_foot) continue;
            const scree_real six_volume = scree_vec3_dot(triangle->foot, triangle->boundary);
            sums->moment = scree_vec3_add_scaled(sums->moment, triangle->foot, six_volume);
            const scree_real n2 = scree_vec3_dot(triangle->face.normal, triangle->face.normal);
            if (!(n2 > 0)) continue;
            const scree_real along = scree_vec3_dot(triangle->face.normal, triangle->boundary);
            twice_sum = scree_vec3_add_scaled(twice_sum, triangle->face.normal, along / n2);
            twice_area += scree_abs(along) / scree_sqrt(n2);
        }
    }
    sums->area = twice_area / 2;
    sums->residual = twice_area > 0 ? scree_vec3_length(twice_sum) / twice_area : 0;
}

/// All sums. False if the crossings do not close.
SCREE_FN bool scree_overlap_sum(scree_overlap_slice *slice, scree_overlap_sums *sums)
{
    sums->box = scree_overlap_points_box(slice);
    sums->six_volume = 0;
    sums->lost = 0;
    sums->moment = scree_vec3_zero();
    sums->area_vector = scree_vec3_zero();
    sums->residual = 0;
    sums->area = 0;
    sums->middle = scree_vec3_zero();
    if (sums->box.lower.x > sums->box.upper.x) return true;
    sums->middle = scree_vec3_scale(scree_vec3_add(sums->box.lower, sums->box.upper), (scree_real)0.5);
    const bool is_closed = scree_overlap_make_segments(slice);
    scree_overlap_sum_edges(slice, sums);
    scree_overlap_sum_segments(slice, sums);
    scree_overlap_sum_faces(slice, sums);
    sums->six_volume += sums->lost;
    return is_closed;
}

/// Extent of the collected points along n.
SCREE_FN scree_real scree_overlap_extent_along(const scree_overlap_slice *slice, scree_vec3 middle, scree_vec3 n)
{
    scree_real least = SCREE_REAL_MAX;
    scree_real most = -SCREE_REAL_MAX;
    for (int32_t c = 0; c < slice->num_crossings; ++c)
    {
        const scree_real along = scree_vec3_dot(n, scree_vec3_sub(slice->crossings[c].point, middle));
        least = scree_min(least, along);
        most = scree_max(most, along);
    }
    for (int32_t side = 0; side < 2; ++side)
    {
        const scree_overlap_body *body = slice->body + side;
        if (body->num_inside == 0) continue;
        for (int32_t v = 0; v < body->num_vertices; ++v)
        {
            if (body->inside[v] == 0) continue;
            const scree_real along = scree_vec3_dot(n, scree_vec3_sub(body->points[v], middle));
            least = scree_min(least, along);
            most = scree_max(most, along);
        }
    }
    return most > least ? most - least : 0;
}

/// Largest distance of a point of the overlap from `centre`, measured across n.
SCREE_FN scree_real scree_overlap_radius_about(const scree_overlap_slice *slice, scree_vec3 centre, scree_vec3 n)
{
    scree_real largest = 0;
    for (int32_t c = 0; c < slice->num_crossings; ++c)
    {
        const scree_vec3 across = scree_vec3_cross(n, scree_vec3_sub(slice->crossings[c].point, centre));
        largest = scree_max(largest, scree_vec3_dot(across, across));
    }
    for (int32_t side = 0; side < 2; ++side)
    {
        const scree_overlap_body *body = slice->body + side;
        if (body->num_inside == 0) continue;
        for (int32_t v = 0; v < body->num_vertices; ++v)
        {
            if (body->inside[v] == 0) continue;
            const scree_vec3 across = scree_vec3_cross(n, scree_vec3_sub(body->points[v], centre));
            largest = scree_max(largest, scree_vec3_dot(across, across));
        }
    }
    return scree_sqrt(largest);
}

#endif
