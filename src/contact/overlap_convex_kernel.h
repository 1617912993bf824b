/// \file overlap_convex_kernel.h
/// First pass of an overlap of two convex bodies, where every sign is certain: each edge of one body is clipped by the
/// planes of the other (Cyrus & Beck 1978), which gives its crossings and the inside vertices at once; a pair of faces
/// has one segment at most. Triangles in one plane are one face, so that the diagonals of flat faces are no edges.
/// What is found is what the general path finds. Where a sign or an order is not certain, the general path is taken.
#ifndef SCREE_OVERLAP_CONVEX_KERNEL_H
#define SCREE_OVERLAP_CONVEX_KERNEL_H

#include "contact/overlap_crossings_kernel.h"

/// Joins kept triangles to flat faces and lists their planes. False if there are too many.
SCREE_FN bool scree_convex_join_faces(scree_overlap_body *body, const scree_shape_view *shape, scree_real tolerance,
                                      scree_convex_planes *planes)
{
    planes->num = 0;
    for (int32_t t = 0; t < body->num_triangles; ++t)
    {
        scree_kept_triangle *kept = body->kept + t;
        kept->face = t;
        for (int32_t p = 0; shape->flat_faces && p < planes->num && kept->face == t; ++p)
        {
            const int32_t other = planes->triangle[p];
            if (shape->flat_faces[body->kept[other].id] == shape->flat_faces[kept->id]) kept->face = other;
        }
        if (kept->face != t) continue;
        if (planes->num == SCREE_MAX_PLANES) return false;
        const scree_face *face = &scree_overlap_finish(body, t)->face;
        planes->normal[planes->num] = face->normal;
        planes->offset[planes->num] = face->offset;
        planes->margin[planes->num] = tolerance * (face->size * face->size);
        planes->triangle[planes->num++] = t;
    }
    return true;
}

/// For each corner of the kept triangles of a body the planes of the other that it is above of; none: it is inside.
/// False if one is too near to tell.
SCREE_FN bool scree_convex_find_inside(scree_overlap_body *body, const scree_convex_planes *planes)
{
    for (int32_t v = 0; v < body->num_vertices; ++v) body->vertices[v].inside = SCREE_INSIDE_UNKNOWN;
    body->num_inside = 0;
    for (int32_t t = 0; t < body->num_triangles; ++t)
    {
        for (int32_t k = 0; k < 3; ++k)
        {
            scree_overlap_vertex *vertex = body->vertices + body->kept[t].v[k];
            if (vertex->inside != SCREE_INSIDE_UNKNOWN) continue;
            const scree_vec3 point = vertex->point;
            uint64_t above = 0;
            int32_t is_unsure = 0;
            for (int32_t p = 0; p < planes->num; ++p)
            {
                const scree_real height = scree_vec3_dot(planes->normal[p], point) - planes->offset[p];
                is_unsure |= (int32_t)(scree_abs(height) <= planes->margin[p]);
                above |= (uint64_t)(height > 0) << p;
            }
            if (is_unsure) return false;
            vertex->above = above;
            vertex->inside = above == 0;
            body->num_inside += above == 0;
        }
    }
    return true;
}

/// Where a line is cut by the planes of one set: the last of those it enters by, or the first of those it leaves by.
typedef struct scree_convex_cut
{
    scree_real part;   ///< of the way along the line
    scree_real margin; ///< of its certainty
    scree_real height[2];
    int32_t plane; ///< -1: none
} scree_convex_cut;

/// The cut of `line` by the planes in `above`, the last one if is_entering, else the first. False if two are too close.
SCREE_FN bool scree_convex_cut_line(const scree_convex_planes *planes, uint64_t above, const scree_line *line,
                                    bool is_entering, scree_convex_cut *cut)
{
    cut->plane = -1;
    cut->part = 0;
    cut->margin = 0;
    bool is_certain = true;
    for (; above != 0; above &= above - 1)
    {
        const int32_t p = scree_lowest_bit(above);
        const scree_real h0 = scree_vec3_dot(planes->normal[p], line->p[0]) - planes->offset[p];
        const scree_real h1 = scree_vec3_dot(planes->normal[p], line->p[1]) - planes->offset[p];
        const scree_real part = h0 / (h0 - h1);
        const scree_real margin = planes->margin[p] / scree_abs(h0 - h1);
        const scree_real later = is_entering ? part - cut->part : cut->part - part;
        if (cut->plane >= 0)
        {
            is_certain = is_certain && scree_abs(later) > margin + cut->margin;
            if (later < 0) continue;
        }
        cut->part = part;
        cut->margin = margin;
        cut->height[0] = h0;
        cut->height[1] = h1;
        cut->plane = p;
    }
    return is_certain;
}

/// Enters a crossing as an end of the segment of two faces. False if that end is taken.
SCREE_FN bool scree_convex_add_end(scree_overlap_slice *slice, int32_t face_a, int32_t face_b, int32_t end,
                                   int32_t crossing)
{
    for (int32_t s = 0; s < slice->num_segments; ++s)
    {
        scree_overlap_segment *segment = slice->segments + s;
        if (segment->triangle_a != face_a || segment->triangle_b != face_b) continue;
        if (segment->end[end] >= 0) return false;
        segment->end[end] = crossing;
        return true;
    }
    if (slice->num_segments == slice->max_crossings) return false;
    scree_overlap_segment *segment = slice->segments + slice->num_segments++;
    segment->triangle_a = face_a;
    segment->triangle_b = face_b;
    segment->end[end] = crossing;
    segment->end[1 - end] = -1;
    return true;
}

/// An edge between two faces of a body.
typedef struct scree_convex_edge
{
    scree_line line;
    int32_t is_of_b;
    int32_t triangle, side; ///< kept triangle in which it runs up its vertex ids, and the side of it
    int32_t right;          ///< its other triangle
} scree_convex_edge;

/// Records the crossing of an edge with the plane of triangle `through`. False if it is too many or does not fit to the
/// others.
SCREE_FN bool scree_convex_add_crossing(scree_overlap_slice *slice, const scree_convex_edge *edge, int32_t through,
                                        const scree_convex_cut *cut, int32_t sign)
{
    if (slice->num_crossings == slice->max_crossings) return false;
    const int32_t c = slice->num_crossings++;
    scree_overlap_body *body = slice->body + edge->is_of_b;
    scree_overlap_crossing *crossing = slice->crossings + c;
    const int32_t nearer = scree_abs(cut->height[0]) <= scree_abs(cut->height[1]) ? 0 : 1;
    const scree_vec3 start = SCREE_PICK2(edge->line.p, nearer);
    const scree_vec3 along = scree_vec3_sub(SCREE_PICK2(edge->line.p, 1 - nearer), start);
    const scree_real height = SCREE_PICK2(cut->height, nearer);
    const scree_real part = height / (height - SCREE_PICK2(cut->height, 1 - nearer));
    crossing->point = scree_vec3_add_scaled(start, along, part);
    crossing->triangle = edge->triangle;
    crossing->side = edge->side;
    crossing->through = through;
    crossing->sign = sign;
    crossing->is_of_b = edge->is_of_b;
    crossing->patch = 0;
    crossing->next = -1;
    int32_t *link = body->triangles[edge->triangle].crossing + edge->side;
    while (*link >= 0) link = &slice->crossings[*link].next;
    *link = c;

    // around the part of a face inside the other body: a segment of A runs from a leaving side to an entering one
    const int32_t end_left = (sign > 0) == (edge->is_of_b != 0) ? 0 : 1;
    const int32_t left_face = body->kept[edge->triangle].face;
    const int32_t right_face = body->kept[edge->right].face;
    if (edge->is_of_b)
        return scree_convex_add_end(slice, through, left_face, end_left, c) &&
               scree_convex_add_end(slice, through, right_face, 1 - end_left, c);
    return scree_convex_add_end(slice, left_face, through, end_left, c) &&
           scree_convex_add_end(slice, right_face, through, 1 - end_left, c);
}

/// One edge, along side k of triangle t, clipped by the planes of the other body. False if something is not certain.
SCREE_FN bool scree_convex_clip_edge(scree_overlap_slice *slice, int32_t is_of_b, const scree_shape_view *shape,
                                     const scree_convex_planes *planes, int32_t t, int32_t k)
{
    scree_overlap_body *body = slice->body + is_of_b;
    const scree_kept_triangle *kept = body->kept + t;
    const scree_overlap_vertex *v0 = body->vertices + kept->v[k];
    const scree_overlap_vertex *v1 = body->vertices + kept->v[scree_next_corner(k)];
    if (v0->id > v1->id || (v0->above & v1->above) != 0 || (v0->above | v1->above) == 0) return true;
    scree_convex_edge edge;
    edge.right = scree_kept_neighbour(body, shape, t, k);
    if (edge.right < 0 || body->kept[edge.right].face == kept->face) return true;
    scree_overlap_finish(body, t);
    edge.line.p[0] = v0->point;
    edge.line.p[1] = v1->point;
    edge.is_of_b = is_of_b;
    edge.triangle = t;
    edge.side = k;
    scree_convex_cut enter, leave;
    const bool is_certain = scree_convex_cut_line(planes, v0->above, &edge.line, true, &enter) &&
                            scree_convex_cut_line(planes, v1->above, &edge.line, false, &leave);
    if (!is_certain) return false;
    if (enter.plane >= 0 && leave.plane >= 0)
    {
        const scree_real margin = enter.margin + leave.margin;
        if (enter.part - leave.part > margin) return true;
        if (leave.part - enter.part <= margin) return false;
    }
    if (enter.plane >= 0 && !scree_convex_add_crossing(slice, &edge, planes->triangle[enter.plane], &enter, 1))
        return false;
    return leave.plane < 0 || scree_convex_add_crossing(slice, &edge, planes->triangle[leave.plane], &leave, -1);
}

/// Segments, crossings and inside counts of two convex bodies. False if the general path has to find them.
SCREE_FN_APART bool scree_convex_collect(scree_overlap_slice *slice, const scree_shape_view *const *shape)
{
    scree_convex_planes *planes = slice->planes;
    slice->num_crossings = 0;
    slice->num_segments = 0;
    slice->is_closed = true;
    for (int32_t side = 0; side < 2; ++side)
        if (!scree_convex_join_faces(slice->body + side, shape[side], slice->tolerance, planes + side)) return false;
    for (int32_t side = 0; side < 2; ++side)
    {
        scree_overlap_body *body = slice->body + side;
        if (!scree_convex_find_inside(body, planes + 1 - side)) return false;
    }
    for (int32_t side = 0; side < 2; ++side)
        for (int32_t t = 0; t < slice->body[side].num_triangles; ++t)
            for (int32_t k = 0; k < 3; ++k)
                if (!scree_convex_clip_edge(slice, side, shape[side], planes + 1 - side, t, k)) return false;
    for (int32_t s = 0; s < slice->num_segments; ++s)
        if (slice->segments[s].end[0] < 0 || slice->segments[s].end[1] < 0) return false;
    for (int32_t side = 0; side < 2; ++side)
    {
        scree_overlap_body *body = slice->body + side;
        for (int32_t v = 0; v < body->num_vertices; ++v)
            if (body->vertices[v].inside == SCREE_INSIDE_UNKNOWN) body->vertices[v].inside = 0;
        // the edges at inside vertices are asked of finished triangles
        for (int32_t t = 0; body->num_inside > 0 && t < body->num_triangles; ++t) scree_overlap_finish(body, t);
    }
    return true;
}

#endif
