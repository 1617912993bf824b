/// \file overlap_crossings_kernel.h
/// First pass of an overlap: segments in which triangles of the two bodies meet, crossings of edges with triangles at
/// the ends of the segments, and which vertices lie inside the other body.
#ifndef SCREE_OVERLAP_CROSSINGS_KERNEL_H
#define SCREE_OVERLAP_CROSSINGS_KERNEL_H

#include "contact/box_index_kernel.h"
#include "contact/overlap_hierarchy_kernel.h"
#include "contact/overlap_intervals_kernel.h"
#include "contact/overlap_meet_kernel.h"
#include "contact/overlap_signs_kernel.h"
#include "contact/triangle_filter_kernel.h"

/// Records the end of a segment as a crossing if the edge runs up its vertex ids in this triangle; else the crossing is
/// recorded from the other triangle of the edge. Returns what the segment keeps of it.
SCREE_FN int32_t scree_overlap_add_end(scree_overlap_slice *slice, const scree_segment_end *end, bool is_first,
                                       int32_t triangle_a, int32_t triangle_b)
{
    const int32_t own = end->is_of_b ? triangle_b : triangle_a;
    scree_overlap_triangle *triangle = slice->body[end->is_of_b].triangles + own;
    if ((triangle->face.reversed >> end->side & 1) != 0) return ~(end->side + 4 * end->is_of_b);
    scree_overlap_crossing *crossing = slice->crossings + slice->num_crossings;
    crossing->point = scree_segment_end_point(end, &triangle->face);
    crossing->triangle = own;
    crossing->side = end->side;
    crossing->through = end->is_of_b ? triangle_a : triangle_b;
    // around the part of a triangle inside the other body: a segment of A runs from a leaving side to an entering one
    crossing->sign = is_first == (end->is_of_b != 0) ? 1 : -1;
    crossing->is_of_b = end->is_of_b;
    crossing->patch = 0;

    // in their order along the edge
    const scree_vec3 start = triangle->face.p[end->side];
    const scree_vec3 along = scree_vec3_sub(triangle->face.p[scree_next_corner(end->side)], start);
    int32_t *link = triangle->crossing + end->side;
    while (*link >= 0 && scree_vec3_dot(along, slice->crossings[*link].point) < scree_vec3_dot(along, crossing->point))
        link = &slice->crossings[*link].next;
    crossing->next = *link;
    *link = slice->num_crossings;
    return slice->num_crossings++;
}

/// Records a segment with both of its ends. False if there are too many.
SCREE_FN bool scree_overlap_add_segment(scree_overlap_slice *slice, int32_t triangle_a, int32_t triangle_b,
                                        const scree_segment_end *p, const scree_segment_end *q)
{
    if (slice->num_segments == slice->max_crossings || slice->num_crossings + 2 > slice->max_crossings) return false;
    scree_overlap_segment *segment = slice->segments + slice->num_segments++;
    segment->triangle_a = triangle_a;
    segment->triangle_b = triangle_b;
    segment->end[0] = scree_overlap_add_end(slice, p, true, triangle_a, triangle_b);
    segment->end[1] = scree_overlap_add_end(slice, q, false, triangle_a, triangle_b);
    return true;
}

/// The crossing that was recorded from the other triangle of the edge, or -1.
SCREE_FN int32_t scree_overlap_find_crossing(const scree_overlap_slice *slice, const scree_shape_view *const *shape,
                                             const scree_overlap_segment *segment, int32_t code)
{
    const int32_t is_of_b = code >> 2;
    const int32_t side = code & 3;
    const scree_overlap_body *body = slice->body + is_of_b;
    const int32_t own = is_of_b ? segment->triangle_b : segment->triangle_a;
    const int32_t through = is_of_b ? segment->triangle_a : segment->triangle_b;
    const int32_t neighbour = scree_kept_neighbour(body, shape[is_of_b], own, side);
    if (neighbour < 0 || !body->kept[neighbour].is_finished) return -1;
    // there the side starts at the vertex where it ends here
    const int32_t start = body->triangles[own].v[scree_next_corner(side)];
    const scree_overlap_triangle *triangle = body->triangles + neighbour;
    const int32_t k = triangle->v[0] == start ? 0 : triangle->v[1] == start ? 1 : 2;
    int32_t c = triangle->crossing[k];
    while (c >= 0 && slice->crossings[c].through != through) c = slice->crossings[c].next;
    return c;
}

/// Ties each segment to the crossings at its ends. Every crossing ends two segments, one in each triangle of its edge.
SCREE_FN_APART void scree_overlap_tie_segments(scree_team lanes, scree_overlap_slice *slice,
                                               const scree_shape_view *const *shape)
{
    const scree_team *team = &lanes;
    int32_t num_tied = 0;
    bool is_tied = true;
    for (int32_t s = scree_team_lane(team); s < slice->num_segments; s += scree_team_size(team))
    {
        scree_overlap_segment *segment = slice->segments + s;
        for (int32_t end = 0; end < 2; ++end)
        {
            if (segment->end[end] >= 0) continue;
            segment->end[end] = scree_overlap_find_crossing(slice, shape, segment, ~segment->end[end]);
            num_tied += segment->end[end] >= 0;
        }
        if (segment->end[0] < 0 || segment->end[1] < 0) is_tied = false;
    }
    is_tied = !scree_team_any(team, !is_tied) && scree_team_sum(team, num_tied) == slice->num_crossings;
    if (scree_team_leads(team)) slice->is_closed = slice->is_closed && is_tied;
    scree_team_sync(team);
}

/// A side that passes through a face, or not.
typedef struct scree_side_crossing
{
    scree_vec3 point;
    int32_t sign; ///< +1 where the side, running up its vertex ids, enters the other body, -1 where it leaves, 0 if not
} scree_side_crossing;

/// Side k of face `own`, of body `is_of_b`, and face `other` by the hierarchy.
SCREE_FN_APART scree_side_crossing scree_overlap_decide_by_levels(const scree_face *own, int32_t k,
                                                                  const scree_face *other, int32_t is_of_b,
                                                                  scree_levels *levels)
{
    const scree_line *edge = &levels->edge;
    levels->edge = scree_face_side(own, k);
    scree_side_crossing crossing;
    crossing.point = scree_vec3_zero();
    crossing.sign = is_of_b ? -scree_edge_b_crosses(levels, other, edge, &crossing.point)
                            : scree_edge_a_crosses(levels, edge, other, &crossing.point);
    return crossing;
}

/// Does side k of face `own`, of body `is_of_b`, pass through face `other`? +1 where the side, running up its vertex
/// ids, enters the other body, -1 where it leaves.
SCREE_FN int32_t scree_overlap_decide(const scree_face *own, int32_t k, const scree_face *other, int32_t is_of_b,
                                      scree_real tolerance, scree_levels *levels, scree_vec3 *point)
{
    const scree_line edge = scree_face_side(own, k);
    const scree_box box = scree_box_of_points(other->p[0], other->p[1], other->p[2]);
    if (!scree_box_overlaps(scree_box_of_points(edge.p[0], edge.p[1], edge.p[1]), box)) return 0;
    const scree_vec3 along = scree_vec3_sub(edge.p[1], edge.p[0]);
    if (tolerance > 0)
    {
        const scree_real size = scree_abs(along.x) + scree_abs(along.y) + scree_abs(along.z);
        const scree_sign_verdict verdict = scree_edge_sign(&edge, size, other, tolerance, point);
        if (verdict != SCREE_SIGN_UNSURE) return (int32_t)verdict;
    }
    const scree_side_crossing crossing = scree_overlap_decide_by_levels(own, k, other, is_of_b, levels);
    *point = crossing.point;
    return crossing.sign;
}

/// Two triangles decided side by side: the ends that are found pair up into segments. False if there are too many.
SCREE_FN_APART bool scree_overlap_meet_by_sides(scree_overlap_slice *slice, int32_t triangle_a, int32_t triangle_b)
{
    const scree_face *face_a = &slice->body[0].triangles[triangle_a].face;
    const scree_face *face_b = &slice->body[1].triangles[triangle_b].face;
    scree_segment_end(*ends)[6] = slice->ends;
    int32_t num_first = 0, num_last = 0;
    for (int32_t is_of_b = 0; is_of_b < 2; ++is_of_b)
    {
        const scree_face *own = is_of_b ? face_b : face_a;
        const scree_face *other = is_of_b ? face_a : face_b;
        for (int32_t k = 0; k < 3; ++k)
        {
            scree_vec3 point;
            const int32_t sign =
                scree_overlap_decide(own, k, other, is_of_b, slice->sign_tolerance, &slice->levels, &point);
            if (sign == 0) continue;
            const bool is_entering = sign * scree_face_sense(own, k) > 0;
            const bool is_first = is_entering == (is_of_b != 0);
            scree_segment_end *end = is_first ? ends[0] + num_first : ends[1] + num_last;
            num_first += is_first;
            num_last += !is_first;
            end->is_of_b = is_of_b;
            end->side = k;
            end->point = point;
            end->has_point = true;
        }
    }
    const int32_t num_pairs = num_first < num_last ? num_first : num_last;
    if (num_first != num_last) slice->is_closed = false;
    for (int32_t i = 0; i < num_pairs; ++i)
        if (!scree_overlap_add_segment(slice, triangle_a, triangle_b, ends[0] + i, ends[1] + i)) return false;
    return true;
}

/// What is said of two triangles, both finished, whose boxes overlap.
SCREE_FN scree_meet_verdict scree_overlap_judge(const scree_overlap_slice *slice, int32_t triangle_a,
                                                int32_t triangle_b, scree_segment_end *p, scree_segment_end *q)
{
    if (!(slice->sign_tolerance > 0)) return SCREE_MEET_UNSURE;
    return scree_faces_meet(&slice->body[0].triangles[triangle_a].face, &slice->body[1].triangles[triangle_b].face,
                            slice->sign_tolerance, p, q);
}

/// And what follows from it. False if there are too many crossings.
SCREE_FN bool scree_overlap_act_on(scree_overlap_slice *slice, scree_meet_verdict verdict, int32_t triangle_a,
                                   int32_t triangle_b, const scree_segment_end *p, const scree_segment_end *q)
{
    if (verdict == SCREE_MEET_APART) return true;
    if (verdict == SCREE_MEET_SEGMENT) return scree_overlap_add_segment(slice, triangle_a, triangle_b, p, q);
    return scree_overlap_meet_by_sides(slice, triangle_a, triangle_b);
}

/// Segments of listed pairs of triangles: all are judged at once, and what follows is done in turns, in their order.
SCREE_FN bool scree_overlap_meet_listed(const scree_team *team, scree_overlap_slice *slice,
                                        const scree_overlap_link *pairs, int32_t num)
{
    for (int32_t begin = 0; begin < num; begin += scree_team_size(team))
    {
        const int32_t i = begin + scree_team_lane(team);
        const int32_t f = pairs[i < num ? i : begin].v[0];
        const int32_t g = pairs[i < num ? i : begin].v[1];
        scree_segment_end p, q;
        const scree_meet_verdict verdict = i < num ? scree_overlap_judge(slice, f, g, &p, &q) : SCREE_MEET_APART;
        bool has_room = true;
        for (uint64_t turns = scree_team_ballot(team, verdict != SCREE_MEET_APART); turns != 0; turns &= turns - 1)
        {
            if (scree_lowest_bit(turns) == scree_team_lane(team))
                has_room = scree_overlap_act_on(slice, verdict, f, g, &p, &q);
            scree_team_sync(team);
        }
        if (scree_team_any(team, !has_room)) return false;
    }
    return true;
}

/// All segments, by a team of several lanes: pairs whose boxes overlap are listed in their order, where the links will
/// be, and judged whenever the list is full. False if there are too many.
SCREE_FN_APART bool scree_overlap_find_segments_together(scree_team lanes, scree_overlap_slice *slice)
{
    const scree_team *team = &lanes;
    const scree_overlap_body *a = slice->body;
    const scree_overlap_body *b = slice->body + 1;
    scree_overlap_link *pairs = slice->body[0].links;
    const int32_t num_a = a->num_triangles;
    int32_t num_listed = 0;
    for (int32_t first = 0; first < b->num_triangles; first += SCREE_INDEX_MAX)
    {
        const int32_t rest = b->num_triangles - first;
        const int32_t num_b = rest < SCREE_INDEX_MAX ? rest : SCREE_INDEX_MAX;
        for (int32_t begin = 0; begin < num_a * num_b; begin += scree_team_size(team))
        {
            const int32_t i = begin + scree_team_lane(team);
            const int32_t f = i < num_a * num_b ? i / num_b : 0;
            const int32_t g = first + (i < num_a * num_b ? i % num_b : 0);
            const bool is_listed = i < num_a * num_b && scree_box_meets(a->triangle_boxes + f, b->triangle_boxes + g);
            const int32_t place = scree_team_place(team, is_listed, &num_listed);
            if (is_listed)
            {
                pairs[place].v[0] = f;
                pairs[place].v[1] = g;
            }
            if (num_listed + scree_team_size(team) <= 2 * a->max_triangles) continue;
            scree_team_sync(team);
            if (!scree_overlap_meet_listed(team, slice, pairs, num_listed)) return false;
            num_listed = 0;
        }
    }
    scree_team_sync(team);
    return scree_overlap_meet_listed(team, slice, pairs, num_listed);
}

/// All segments, by one lane. False if there are too many.
SCREE_FN bool scree_overlap_find_segments(scree_overlap_slice *slice)
{
    const scree_overlap_body *a = slice->body;
    const scree_overlap_body *b = slice->body + 1;
    for (int32_t begin = 0; begin < b->num_triangles; begin += SCREE_INDEX_MAX)
    {
        const int32_t rest = b->num_triangles - begin;
        const int32_t num = rest < SCREE_INDEX_MAX ? rest : SCREE_INDEX_MAX;
        scree_box_index index;
        scree_index_build(&index, b->triangle_boxes + begin, num, slice->common);
        for (int32_t f = 0; f < a->num_triangles; ++f)
        {
            uint64_t candidates = scree_index_query(&index, a->triangle_boxes[f]);
            for (; candidates != 0; candidates &= candidates - 1)
            {
                const int32_t g = begin + scree_lowest_bit(candidates);
                if (num > SCREE_INDEX_DIRECT && !scree_box_meets(a->triangle_boxes + f, b->triangle_boxes + g))
                    continue;
                scree_segment_end p, q;
                const scree_meet_verdict verdict = scree_overlap_judge(slice, f, g, &p, &q);
                if (!scree_overlap_act_on(slice, verdict, f, g, &p, &q)) return false;
            }
        }
    }
    return true;
}

/// How often a vertex of body `side` lies inside the other: by the ray along -z from A, along +z from B.
SCREE_FN int32_t scree_overlap_count_inside(scree_overlap_slice *slice, int32_t side, scree_vec3 p)
{
    scree_overlap_body *other = slice->body + 1 - side;
    int32_t count = 0;
    for (int32_t t = 0; t < other->num_triangles; ++t)
    {
        const scree_box box = other->triangle_boxes[t];
        if (p.x < box.lower.x || p.x > box.upper.x || p.y < box.lower.y || p.y > box.upper.y) continue;
        const scree_face *g = &scree_overlap_finish(other, t)->face;
        int32_t own = SCREE_SIGN_UNSURE;
        if (slice->sign_tolerance > 0) own = scree_vertex_sign(p, g, side == 0, slice->sign_tolerance);
        if (own == SCREE_SIGN_UNSURE)
            own = side == 0 ? scree_vertex_a_above(&slice->levels, p, g) : -scree_vertex_b_below(&slice->levels, p, g);
        count += own;
    }
    return count;
}

/// Stands for an inside count that is not known yet.
#define SCREE_INSIDE_UNKNOWN INT32_MIN

/// Gathers the edges with an end that is not known yet; returns their number.
SCREE_FN int32_t scree_overlap_find_links(const scree_overlap_slice *slice, scree_overlap_body *body)
{
    const scree_overlap_vertex *vertices = body->vertices;
    int32_t num = 0;
    for (int32_t t = 0; t < body->num_triangles; ++t)
    {
        const int32_t *v = body->kept[t].v;
        const int32_t unknown = (int32_t)(vertices[v[0]].inside == SCREE_INSIDE_UNKNOWN) |
                                (int32_t)(vertices[v[1]].inside == SCREE_INSIDE_UNKNOWN) << 1 |
                                (int32_t)(vertices[v[2]].inside == SCREE_INSIDE_UNKNOWN) << 2;
        if (unknown == 0) continue;
        const scree_overlap_triangle *triangle = scree_overlap_finish(body, t);
        // side k joins corner k to the next one
        const int32_t touched = unknown | unknown >> 1 | unknown << 2;
        for (uint64_t sides = (uint64_t)(touched & ~triangle->face.reversed & 7); sides != 0; sides &= sides - 1)
        {
            const int32_t k = scree_lowest_bit(sides);
            scree_overlap_link *link = body->links + num++;
            link->v[0] = v[k];
            link->v[1] = v[scree_next_corner(k)];
            link->change = 0;
            for (int32_t c = triangle->crossing[k]; c >= 0; c = slice->crossings[c].next)
                link->change += slice->crossings[c].sign;
        }
    }
    return num;
}

/// Goes over the links until each has told what it can; returns how many are left that join unknown ends only.
SCREE_FN int32_t scree_overlap_follow_links(scree_overlap_slice *slice, scree_overlap_body *body, int32_t num)
{
    for (int32_t before = num + 1; num > 0 && num < before;)
    {
        before = num;
        num = 0;
        for (int32_t i = 0; i < before; ++i)
        {
            const scree_overlap_link link = body->links[i];
            int32_t *inside0 = &body->vertices[link.v[0]].inside;
            int32_t *inside1 = &body->vertices[link.v[1]].inside;
            if (*inside0 != SCREE_INSIDE_UNKNOWN && *inside1 != SCREE_INSIDE_UNKNOWN)
                slice->is_closed = slice->is_closed && *inside1 - *inside0 == link.change;
            else if (*inside0 != SCREE_INSIDE_UNKNOWN) *inside1 = *inside0 + link.change;
            else if (*inside1 != SCREE_INSIDE_UNKNOWN) *inside0 = *inside1 - link.change;
            else body->links[num++] = link;
        }
    }
    return num;
}

/// Inside counts of all vertices of body `side`. Those outside the region of the filter are outside the other body;
/// from there the counts go along the edges, changed by their crossings. A piece of the body that has neither outside
/// vertices nor crossings asks once, by a ray.
SCREE_FN_APART void scree_overlap_find_inside(scree_overlap_slice *slice, int32_t side)
{
    scree_overlap_body *body = slice->body + side;
    body->num_inside = 0;
    int32_t num_unknown = 0;
    for (int32_t v = 0; v < body->num_vertices; ++v)
    {
        const bool is_outside = scree_filter_is_outside(body, side == 0, body->vertices + v);
        body->vertices[v].inside = is_outside ? 0 : SCREE_INSIDE_UNKNOWN;
        num_unknown += !is_outside;
    }
    if (num_unknown == 0) return;
    int32_t num_links = scree_overlap_follow_links(slice, body, scree_overlap_find_links(slice, body));
    while (num_links > 0)
    {
        scree_overlap_vertex *vertex = body->vertices + body->links[0].v[0];
        vertex->inside = scree_overlap_count_inside(slice, side, vertex->point);
        num_links = scree_overlap_follow_links(slice, body, num_links);
    }
    for (int32_t v = 0; v < body->num_vertices; ++v)
    {
        scree_overlap_vertex *vertex = body->vertices + v;
        if (vertex->inside == SCREE_INSIDE_UNKNOWN) vertex->inside = 0;
        body->num_inside += vertex->inside != 0;
        if (vertex->inside < 0) slice->is_closed = false;
    }
}

SCREE_FN_APART void scree_overlap_finish_all(scree_team lanes, scree_overlap_body *body)
{
    const scree_team *team = &lanes;
    for (int32_t t = scree_team_lane(team); t < body->num_triangles; t += scree_team_size(team))
        scree_overlap_finish(body, t);
}

/// Segments, crossings and inside counts of both bodies. False if there are too many crossings.
SCREE_FN bool scree_overlap_collect(const scree_team *team, scree_overlap_slice *slice,
                                    const scree_shape_view *const *shape)
{
    if (scree_team_leads(team))
    {
        slice->num_crossings = 0;
        slice->num_segments = 0;
        slice->is_closed = true;
    }
    for (int32_t side = 0; side < 2; ++side) scree_overlap_finish_all(*team, slice->body + side);
    scree_team_sync(team);
#ifdef SCREE_TEAM_OF_MANY
    const bool has_room = scree_overlap_find_segments_together(*team, slice);
#else
    const bool has_room = scree_overlap_find_segments(slice);
#endif
    scree_team_sync(team);
    if (!has_room)
    {
        if (scree_team_leads(team)) slice->lack = SCREE_LACK_CROSSINGS;
        scree_team_sync(team);
        return false;
    }
    scree_overlap_tie_segments(*team, slice, shape);
    if (scree_team_leads(team))
        for (int32_t side = 0; side < 2; ++side) scree_overlap_find_inside(slice, side);
    scree_team_sync(team);
    return true;
}

#endif
