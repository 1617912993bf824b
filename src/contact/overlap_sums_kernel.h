/// \file overlap_sums_kernel.h
/// Second pass of an overlap: sums over the edges of the overlap solid about the middle C of the contact. Its edges are
/// the segments in which triangles of A and B meet, and the intervals of edges of one body inside the other. Each edge,
/// from x to y, has a face of the solid on its left and one on its right, whose planes have the feet q of C:
///     6 V = sum over edges (q_left - q_right) . (x cross y)
///     2 S = sum over segments x cross y
///     -6 M = sum over segments (y - x) (x . x + x . y + y . y)              M: torque vector, by Stokes
///     24 F = sum over edges and both of their faces q . (x cross y) (q + x + y)   F: first moment
/// Each term is a tetrahedron (C, q, x, y), signed; everything is relative to C. The cusps of Franklin & Kankanhalli
/// (1993), "Volumes from overlaying 3-D triangulations in parallel", are these terms split at the foot of C on the
/// edge; taken whole they stay accurate where the two faces are nearly parallel, and need no foot on edges.
#ifndef SCREE_OVERLAP_SUMS_KERNEL_H
#define SCREE_OVERLAP_SUMS_KERNEL_H

#include "contact/overlap_crossings_kernel.h"

/// A triangle is thin, and a sliver, below these heights over its longest side.
#define SCREE_THIN_HEIGHT ((scree_real)0.03)
#define SCREE_SLIVER_HEIGHT ((scree_real)1e-3)

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

/// Point of the triangle's sides nearest to C.
SCREE_FN_APART scree_vec3 scree_nearest_on_sides(const scree_face *face, scree_vec3 middle)
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
SCREE_FN_APART scree_vec3 scree_overlap_plane_foot(scree_overlap_triangle *triangle, scree_vec3 middle)
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

/// Gathers the corners of the overlap solid, or of one patch of it: crossings and inside vertices. Returns their box.
SCREE_FN_APART scree_box scree_overlap_gather_corners(scree_overlap_slice *slice, int32_t patch)
{
    const bool is_one = slice->num_patches == 1;
    scree_box box = scree_box_empty();
    int32_t num = 0;
    for (int32_t c = 0; c < slice->num_crossings; ++c)
    {
        if (!is_one && slice->crossings[c].patch != patch) continue;
        slice->corners[num++] = slice->crossings[c].point;
        box = scree_box_with_point(box, slice->crossings[c].point);
    }
    for (int32_t side = 0; side < 2; ++side)
    {
        const scree_overlap_body *body = slice->body + side;
        if (body->num_inside == 0) continue;
        for (int32_t v = 0; v < body->num_vertices; ++v)
        {
            if (body->vertices[v].inside == 0 || (!is_one && body->vertices[v].patch != patch)) continue;
            slice->corners[num++] = body->vertices[v].point;
            box = scree_box_with_point(box, body->vertices[v].point);
        }
    }
    slice->num_corners = num;
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

/// What one edge of the solid, x to y relative to C, adds: found by any lane, added in turn.
typedef struct scree_edge_term
{
    scree_vec3 twice_area; ///< x cross y
    scree_vec3 sum;        ///< x + y
    scree_real six_volume;
    scree_overlap_triangle *left, *right; ///< faces on its two sides
} scree_edge_term;

SCREE_FN scree_edge_term scree_overlap_edge_term(scree_vec3 middle, scree_vec3 x, scree_vec3 y,
                                                 scree_overlap_triangle *left, scree_overlap_triangle *right)
{
    scree_edge_term term;
    term.twice_area = scree_vec3_cross(x, y);
    term.sum = scree_vec3_add(x, y);
    term.left = left;
    term.right = right;
    const scree_vec3 q_left = scree_overlap_plane_foot(left, middle);
    const scree_vec3 q_right = scree_overlap_plane_foot(right, middle);
    term.six_volume = scree_vec3_dot(scree_vec3_sub(q_left, q_right), term.twice_area);
    return term;
}

SCREE_FN void scree_overlap_add_edge(scree_overlap_sums *sums, const scree_edge_term *term)
{
    scree_overlap_add_volume(sums, term->six_volume);
    sums->moment = scree_vec3_add_scaled(sums->moment, term->sum, term->six_volume);
    term->left->boundary = scree_vec3_add(term->left->boundary, term->twice_area);
    term->right->boundary = scree_vec3_sub(term->right->boundary, term->twice_area);
}

/// Where sums are added up: in a copy, which a lane that is always alone has in its registers, or in their place.
SCREE_FN scree_overlap_sums *scree_overlap_sums_open(scree_overlap_sums *sums, scree_overlap_sums *copy)
{
#ifdef SCREE_TEAM_OF_MANY
    (void)copy;
    return sums;
#else
    *copy = *sums;
    return copy;
#endif
}
SCREE_FN void scree_overlap_sums_close(scree_overlap_sums *sums, const scree_overlap_sums *copy)
{
#ifdef SCREE_TEAM_OF_MANY
    (void)sums;
    (void)copy;
#else
    *sums = *copy;
#endif
}

/// Segments: edges of the solid between a face of A and a face of B.
SCREE_FN_APART void scree_overlap_sum_segments(scree_team lanes, scree_overlap_slice *slice, int32_t patch,
                                               scree_overlap_sums *sums)
{
    const scree_team *team = &lanes;
    scree_overlap_sums copy;
    scree_overlap_sums *own = scree_overlap_sums_open(sums, &copy);
    for (int32_t begin = 0; begin < slice->num_segments; begin += scree_team_size(team))
    {
        const int32_t s = begin + scree_team_lane(team);
        const scree_overlap_segment *segment = slice->segments + (s < slice->num_segments ? s : begin);
        const bool is_tied = s < slice->num_segments && segment->end[0] >= 0 && segment->end[1] >= 0;
        const bool counts = is_tied && (slice->num_patches == 1 || slice->crossings[segment->end[0]].patch == patch);
        scree_edge_term term;
        scree_vec3 along;
        scree_real squares = 0;
        if (counts)
        {
            const scree_vec3 p = scree_vec3_sub(slice->crossings[segment->end[0]].point, own->middle);
            const scree_vec3 q = scree_vec3_sub(slice->crossings[segment->end[1]].point, own->middle);
            squares = scree_vec3_dot(p, p) + scree_vec3_dot(p, q) + scree_vec3_dot(q, q);
            along = scree_vec3_sub(q, p);
            term = scree_overlap_edge_term(own->middle, p, q, slice->body[0].triangles + segment->triangle_a,
                                           slice->body[1].triangles + segment->triangle_b);
        }
        for (uint64_t turns = scree_team_ballot(team, counts); turns != 0; turns &= turns - 1)
        {
            if (scree_lowest_bit(turns) == scree_team_lane(team))
            {
                own->area_vector = scree_vec3_add(own->area_vector, term.twice_area);
                own->torque = scree_vec3_add_scaled(own->torque, along, squares);
                scree_overlap_add_edge(own, &term);
            }
            scree_team_sync(team);
        }
    }
    scree_overlap_sums_close(sums, &copy);
}

/// Intervals: edges of the solid between two faces of the same body.
SCREE_FN_APART void scree_overlap_sum_intervals(scree_overlap_slice *slice, int32_t side, const scree_shape_view *shape,
                                                int32_t patch, scree_overlap_sums *sums)
{
    scree_overlap_sums copy;
    scree_overlap_sums *own = scree_overlap_sums_open(sums, &copy);
    scree_overlap_body *body = slice->body + side;
    for (int32_t t = 0; t < body->num_triangles; ++t)
    {
        if (!body->kept[t].is_finished) continue;
        for (uint64_t sides = scree_overlap_inside_sides(body, t); sides != 0; sides &= sides - 1)
        {
            const int32_t k = scree_lowest_bit(sides);
            scree_interval_walk walk;
            const int32_t right = scree_kept_neighbour(body, shape, t, k);
            if (right < 0)
            {
                slice->is_closed = false;
                continue;
            }
            const int32_t left_face = body->kept[t].face;
            const int32_t right_face = body->kept[right].face;
            if (left_face == right_face) continue;
            scree_interval_walk_start(body, t, k, &walk);
            scree_overlap_interval interval;
            while (scree_overlap_next_interval(slice, body, &walk, &interval))
            {
                if (slice->num_patches > 1 && *scree_overlap_patch_of(slice, interval.corner[0]) != patch) continue;
                const scree_vec3 x = scree_vec3_sub(interval.point[0], own->middle);
                const scree_vec3 y = scree_vec3_sub(interval.point[1], own->middle);
                const scree_edge_term term = scree_overlap_edge_term(
                    own->middle, x, y, scree_overlap_finish(body, left_face), scree_overlap_finish(body, right_face));
                scree_overlap_add_edge(own, &term);
            }
        }
    }
    scree_overlap_sums_close(sums, &copy);
}

/// The part of each term's moment that belongs to the foot on the plane, and the certificate: the area vectors of
/// the two parts of the surface, each from the faces' own normals, must cancel.
SCREE_FN_APART void scree_overlap_sum_faces(scree_overlap_slice *slice, scree_overlap_sums *sums)
{
    scree_vec3 twice_sum = scree_vec3_zero();
    scree_real twice_area = 0;
    scree_vec3 moment = sums->moment;
    for (int32_t side = 0; side < 2; ++side)
    {
        const scree_overlap_body *body = slice->body + side;
        for (int32_t t = 0; t < body->num_triangles; ++t)
        {
            const scree_overlap_triangle *triangle = body->triangles + t;
            if (!body->kept[t].is_finished || !triangle->has_foot) continue;
            const scree_real six_volume = scree_vec3_dot(triangle->foot, triangle->boundary);
            moment = scree_vec3_add_scaled(moment, triangle->foot, six_volume);
            const scree_real n2 = scree_vec3_dot(triangle->face.normal, triangle->face.normal);
            if (!(n2 > 0)) continue;
            const scree_real along = scree_vec3_dot(triangle->face.normal, triangle->boundary);
            twice_sum = scree_vec3_add_scaled(twice_sum, triangle->face.normal, along / n2);
            twice_area += scree_abs(along) / scree_sqrt(n2);
        }
    }
    sums->moment = moment;
    sums->area = twice_area / 2;
    sums->residual = twice_area > 0 ? scree_vec3_length(twice_sum) / twice_area : 0;
}

SCREE_FN void scree_overlap_sums_clear(scree_overlap_sums *sums)
{
    sums->six_volume = 0;
    sums->lost = 0;
    sums->moment = scree_vec3_zero();
    sums->area_vector = scree_vec3_zero();
    sums->torque = scree_vec3_zero();
    sums->residual = 0;
    sums->area = 0;
    sums->middle = scree_vec3_zero();
}

/// All sums of a patch; slice->is_closed is cleared if edges of the solid are missing.
SCREE_FN void scree_overlap_sum(const scree_team *team, scree_overlap_slice *slice,
                                const scree_shape_view *const *shape, int32_t patch, scree_overlap_sums *sums)
{
    if (scree_team_leads(team))
    {
        sums->box = scree_overlap_gather_corners(slice, patch);
        scree_overlap_sums_clear(sums);
        if (sums->box.lower.x <= sums->box.upper.x)
            sums->middle = scree_vec3_scale(scree_vec3_add(sums->box.lower, sums->box.upper), (scree_real)0.5);
    }
    scree_team_sync(team);
    if (sums->box.lower.x > sums->box.upper.x) return;
    for (int32_t side = 0; slice->num_patches > 1 && side < 2; ++side)
        for (int32_t t = 0; t < slice->body[side].num_triangles; ++t) slice->body[side].triangles[t].has_foot = false;
    // the feet that several lanes would come to find at once; of faces that have no edge they change no sum
    for (int32_t side = 0; scree_team_size(team) > 1 && side < 2; ++side)
        for (int32_t t = scree_team_lane(team); t < slice->body[side].num_triangles; t += scree_team_size(team))
            if (slice->body[side].kept[t].is_finished)
                scree_overlap_plane_foot(slice->body[side].triangles + t, sums->middle);
    scree_team_sync(team);
    scree_overlap_sum_segments(*team, slice, patch, sums);
    if (scree_team_leads(team))
    {
        for (int32_t side = 0; side < 2; ++side) scree_overlap_sum_intervals(slice, side, shape[side], patch, sums);
        scree_overlap_sum_faces(slice, sums);
        sums->six_volume += sums->lost;
    }
    scree_team_sync(team);
}

/// Extent of the gathered corners along n.
SCREE_FN scree_real scree_overlap_extent_along(const scree_overlap_slice *slice, scree_vec3 middle, scree_vec3 n)
{
    scree_real least = SCREE_REAL_MAX;
    scree_real most = -SCREE_REAL_MAX;
    for (int32_t c = 0; c < slice->num_corners; ++c)
    {
        const scree_real along = scree_vec3_dot(n, scree_vec3_sub(slice->corners[c], middle));
        least = scree_min(least, along);
        most = scree_max(most, along);
    }
    return most > least ? most - least : 0;
}

/// Largest distance of a gathered corner from `centre`, measured across n.
SCREE_FN scree_real scree_overlap_radius_about(const scree_overlap_slice *slice, scree_vec3 centre, scree_vec3 n)
{
    scree_real largest = 0;
    for (int32_t c = 0; c < slice->num_corners; ++c)
    {
        const scree_vec3 across = scree_vec3_cross(n, scree_vec3_sub(slice->corners[c], centre));
        largest = scree_max(largest, scree_vec3_dot(across, across));
    }
    return scree_sqrt(largest);
}

#endif
