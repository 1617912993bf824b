/// \file overlap_hierarchy_kernel.h
/// Crossings and inside counts decided dimension by dimension: Smith (2009), "Towards robust inexact geometric
/// computation", with A imagined moved by +(e1 >> e2 >> e3), so that ties are fixed < and <=.
///
/// A point of the lower level decides a count, and the point of the next level is interpolated between the places where
/// that count changes: vertex against edge along x, edge against edge and vertex against triangle in the plane, edge
/// against triangle in space. Crossings are boundaries of lower counts, so they form closed loops whatever the
/// rounding; each point is interpolated from the very coordinates that were compared, so it lies within rounding of its
/// edge and its triangle. Brackets [ ] below are 0 or 1; edges run from the lower to the higher vertex id.
#ifndef SCREE_OVERLAP_HIERARCHY_KERNEL_H
#define SCREE_OVERLAP_HIERARCHY_KERNEL_H

#include "core/vec.h"

/// Corners of a triangle, by number: the next one and the one before.
SCREE_FN int32_t scree_next_corner(int32_t k) { return 0x09 >> (2 * k) & 3; }
SCREE_FN int32_t scree_corner_before(int32_t k) { return 0x12 >> (2 * k) & 3; }
/// The corner that is alone on its side; bit k of `sides` tells on which side corner k is, not all on the same.
SCREE_FN int32_t scree_lone_corner(int32_t sides) { return 0x690 >> (2 * sides) & 3; }

/// An edge, lower vertex id first.
typedef struct scree_line
{
    scree_vec3 p[2];
} scree_line;

/// A triangle with the sense of its sides: bit k of `reversed` is set if p[k] has a higher id than p[k + 1].
typedef struct scree_face
{
    scree_vec3 p[3];
    scree_vec3 normal; ///< outward, length twice the area; for the signs
    scree_real offset; ///< normal . p of the plane
    scree_real size;   ///< bound from above on the length of the sides; for the signs
    int32_t reversed;
} scree_face;

/// Where something of A and something of B lie above each other: one x and y, two heights.
typedef struct scree_place
{
    scree_real x, y;
    scree_real z_a, z_b;
} scree_place;

/// The two places between which a crossing is interpolated: B not below A, and B below A.
typedef struct scree_place_pair
{
    scree_place place[2];
    bool has[2];
} scree_place_pair;

/// Side k of a face as a line, and +1 or -1 for its sense in the face.
SCREE_FN scree_line scree_face_side(const scree_face *face, int32_t k)
{
    const int32_t next = k == 2 ? 0 : k + 1;
    const int32_t is_reversed = (face->reversed >> k) & 1;
    scree_line side;
    side.p[0] = face->p[is_reversed ? next : k];
    side.p[1] = face->p[is_reversed ? k : next];
    return side;
}
SCREE_FN int32_t scree_face_sense(const scree_face *face, int32_t k) { return 1 - 2 * ((face->reversed >> k) & 1); }

/// Value at distances d0 and d1 from two ends: from the nearer end, clamped to the range of the ends. d0 + d1 > 0.
SCREE_FN scree_real scree_between(scree_real value0, scree_real value1, scree_real d0, scree_real d1)
{
    const scree_real value =
        d0 <= d1 ? value0 + (value1 - value0) * (d0 / (d0 + d1)) : value1 + (value0 - value1) * (d1 / (d0 + d1));
    const scree_real lower = scree_min(value0, value1);
    const scree_real upper = scree_max(value0, value1);
    return value < lower ? lower : value > upper ? upper : value;
}

/// y and z of an edge at x within its range.
SCREE_FN void scree_line_at(const scree_line *line, scree_real x, scree_real *y, scree_real *z)
{
    const scree_real d0 = scree_abs(x - line->p[0].x);
    const scree_real d1 = scree_abs(line->p[1].x - x);
    *y = scree_between(line->p[0].y, line->p[1].y, d0, d1);
    *z = scree_between(line->p[0].z, line->p[1].z, d0, d1);
}

/// [a.x < end.x] - [a.x < start.x] for a vertex a of A and an edge of B: nonzero where the edge spans a.
SCREE_FN int32_t scree_span_of_a(scree_vec3 a, const scree_line *edge_b)
{
    return (int32_t)(a.x < edge_b->p[1].x) - (int32_t)(a.x < edge_b->p[0].x);
}
/// [end.x < b.x] - [start.x < b.x] for a vertex b of B and an edge of A.
SCREE_FN int32_t scree_span_of_b(const scree_line *edge_a, scree_vec3 b)
{
    return (int32_t)(edge_a->p[1].x < b.x) - (int32_t)(edge_a->p[0].x < b.x);
}

/// Ends of the common x-range of two edges as they are found: places and distances in y, and whether A is below there.
typedef struct scree_range_ends
{
    scree_place place[2];
    scree_real distance[2];
    bool is_below[2];
    int32_t num;
    int32_t count; ///< (s01(end) - s01(start)) - (s10(end') - s10(start')): +-1 if they cross in the plane
} scree_range_ends;

/// What the counts of all levels are found in: memory that is handed down, for what is indexed is kept in no register.
typedef struct scree_levels
{
    scree_line edge;       ///< that is held against a face
    scree_real y[2], z[2]; ///< of a face at a vertex: its side that does not count, its side that does
    scree_real height;     ///< between them
    scree_range_ends ends;
    scree_place place; ///< where two edges cross in the plane
    scree_place_pair pair;
} scree_levels;

/// Height of a face at a vertex of the other body, between the side below it in y and the one that is not, and the
/// count of the vertex in the face's projection. `is_a` tells whether the vertex is of A. Returns that count, the sum
/// of s01 or s10 over the sides; levels->height is set if it is not zero.
SCREE_FN int32_t scree_vertex_over_face(scree_levels *levels, scree_vec3 vertex, const scree_face *face, bool is_a)
{
    scree_real *y = levels->y;
    scree_real *z = levels->z;
    int32_t count = 0;
    y[0] = y[1] = z[0] = z[1] = 0;
    for (int32_t k = 0; k < 3; ++k)
    {
        const scree_line side = scree_face_side(face, k);
        const int32_t span = is_a ? scree_span_of_a(vertex, &side) : scree_span_of_b(&side, vertex);
        if (span == 0) continue;
        scree_real side_y, side_z;
        scree_line_at(&side, vertex.x, &side_y, &side_z);
        // s01: the side is above a vertex of A; s10: the side is below a vertex of B
        const int32_t is_counted = is_a ? vertex.y < side_y : side_y < vertex.y;
        y[is_counted] = side_y;
        z[is_counted] = side_z;
        count += is_counted * span * scree_face_sense(face, k);
    }
    if (count != 0) levels->height = scree_between(z[0], z[1], scree_abs(vertex.y - y[0]), scree_abs(y[1] - vertex.y));
    return count;
}

/// s02: a vertex of A over a triangle of B, [z of g <= a.z].
SCREE_FN int32_t scree_vertex_a_above(scree_levels *levels, scree_vec3 a, const scree_face *face_b)
{
    const int32_t count = scree_vertex_over_face(levels, a, face_b, true);
    return count != 0 && levels->height <= a.z ? count : 0;
}
/// s20: a vertex of B under a triangle of A, [b.z <= z of f].
SCREE_FN int32_t scree_vertex_b_below(scree_levels *levels, scree_vec3 b, const scree_face *face_a)
{
    const int32_t count = scree_vertex_over_face(levels, b, face_a, false);
    return count != 0 && b.z <= levels->height ? count : 0;
}

SCREE_FN void scree_range_end_of_a(scree_range_ends *ends, scree_vec3 a, const scree_line *edge_b, int32_t sign)
{
    const int32_t span = scree_span_of_a(a, edge_b);
    if (span == 0 || ends->num == 2) return;
    scree_real y, z;
    scree_line_at(edge_b, a.x, &y, &z);
    scree_place *place = ends->place + ends->num;
    place->x = a.x;
    place->y = a.y;
    place->z_a = a.z;
    place->z_b = z;
    ends->distance[ends->num] = scree_abs(y - a.y);
    ends->is_below[ends->num] = a.y < y;
    ends->count += a.y < y ? sign * span : 0;
    ++ends->num;
}

SCREE_FN void scree_range_end_of_b(scree_range_ends *ends, const scree_line *edge_a, scree_vec3 b, int32_t sign)
{
    const int32_t span = scree_span_of_b(edge_a, b);
    if (span == 0 || ends->num == 2) return;
    scree_real y, z;
    scree_line_at(edge_a, b.x, &y, &z);
    scree_place *place = ends->place + ends->num;
    place->x = b.x;
    place->y = y;
    place->z_a = z;
    place->z_b = b.z;
    ends->distance[ends->num] = scree_abs(b.y - y);
    ends->is_below[ends->num] = y < b.y;
    ends->count += y < b.y ? sign * span : 0;
    ++ends->num;
}

/// Where an edge of A and an edge of B cross in the plane: levels->place. Returns the count, +-1, or 0 if they do not.
SCREE_FN int32_t scree_lines_cross(scree_levels *levels, const scree_line *edge_a, const scree_line *edge_b)
{
    scree_range_ends *ends = &levels->ends;
    ends->num = 0;
    ends->count = 0;
    scree_range_end_of_a(ends, edge_a->p[1], edge_b, 1);
    scree_range_end_of_a(ends, edge_a->p[0], edge_b, -1);
    scree_range_end_of_b(ends, edge_a, edge_b->p[1], -1);
    scree_range_end_of_b(ends, edge_a, edge_b->p[0], 1);
    if (ends->num != 2 || ends->is_below[0] == ends->is_below[1]) return 0;

    const scree_real d0 = ends->distance[0];
    const scree_real d1 = ends->distance[1];
    scree_place *place = &levels->place;
    place->x = scree_between(ends->place[0].x, ends->place[1].x, d0, d1);
    place->y = scree_between(ends->place[0].y, ends->place[1].y, d0, d1);
    place->z_a = scree_between(ends->place[0].z_a, ends->place[1].z_a, d0, d1);
    place->z_b = scree_between(ends->place[0].z_b, ends->place[1].z_b, d0, d1);
    return ends->count;
}

/// Keeps the first place of each kind and returns [z of B <= z of A].
SCREE_FN int32_t scree_place_pair_add(scree_place_pair *pair, scree_place place)
{
    const int32_t is_b_below = place.z_b <= place.z_a;
    if (!pair->has[is_b_below])
    {
        pair->has[is_b_below] = true;
        pair->place[is_b_below] = place;
    }
    return is_b_below;
}

/// Point where A and B have the same height between the two places; on the edge of A, or on that of B.
SCREE_FN scree_vec3 scree_place_pair_point(const scree_place_pair *pair, bool is_on_a)
{
    const scree_place *p0 = pair->place;
    const scree_place *p1 = pair->place + 1;
    const scree_real d0 = scree_abs(p0->z_b - p0->z_a);
    const scree_real d1 = scree_abs(p1->z_a - p1->z_b);
    scree_vec3 point;
    point.x = scree_between(p0->x, p1->x, d0, d1);
    point.y = scree_between(p0->y, p1->y, d0, d1);
    point.z = is_on_a ? scree_between(p0->z_a, p1->z_a, d0, d1) : scree_between(p0->z_b, p1->z_b, d0, d1);
    return point;
}

/// x12: +1 where an edge of A, running up its vertex ids, enters B through a triangle of B, -1 where it leaves, else 0;
/// with the point of it.
SCREE_FN int32_t scree_edge_a_crosses(scree_levels *levels, const scree_line *edge_a, const scree_face *face_b,
                                      scree_vec3 *point)
{
    scree_place_pair *pair = &levels->pair;
    pair->has[0] = false;
    pair->has[1] = false;
    int32_t count = 0;
    for (int32_t end = 0; end < 2; ++end)
    {
        const scree_vec3 *a = edge_a->p + end;
        const int32_t over = scree_vertex_over_face(levels, *a, face_b, true);
        if (over == 0) continue;
        scree_place place;
        place.x = a->x;
        place.y = a->y;
        place.z_a = a->z;
        place.z_b = levels->height;
        count += (end == 1 ? over : -over) * scree_place_pair_add(pair, place);
    }
    for (int32_t k = 0; k < 3; ++k)
    {
        const scree_line side = scree_face_side(face_b, k);
        const int32_t crosses = scree_lines_cross(levels, edge_a, &side);
        if (crosses == 0) continue;
        count -= crosses * scree_face_sense(face_b, k) * scree_place_pair_add(pair, levels->place);
    }
    if (count != 0) *point = scree_place_pair_point(pair, true);
    return count;
}

/// x21: -1 where an edge of B, running up its vertex ids, enters A through a triangle of A, +1 where it leaves, else 0.
SCREE_FN int32_t scree_edge_b_crosses(scree_levels *levels, const scree_face *face_a, const scree_line *edge_b,
                                      scree_vec3 *point)
{
    scree_place_pair *pair = &levels->pair;
    pair->has[0] = false;
    pair->has[1] = false;
    int32_t count = 0;
    for (int32_t end = 0; end < 2; ++end)
    {
        const scree_vec3 *b = edge_b->p + end;
        const int32_t over = scree_vertex_over_face(levels, *b, face_a, false);
        if (over == 0) continue;
        scree_place place;
        place.x = b->x;
        place.y = b->y;
        place.z_a = levels->height;
        place.z_b = b->z;
        count += (end == 1 ? over : -over) * scree_place_pair_add(pair, place);
    }
    for (int32_t k = 0; k < 3; ++k)
    {
        const scree_line side = scree_face_side(face_a, k);
        const int32_t crosses = scree_lines_cross(levels, &side, edge_b);
        if (crosses == 0) continue;
        count += crosses * scree_face_sense(face_a, k) * scree_place_pair_add(pair, levels->place);
    }
    if (count != 0) *point = scree_place_pair_point(pair, false);
    return count;
}

#endif
