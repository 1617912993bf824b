/// \file overlap_patches_kernel.h
/// Tells the connected pieces of an overlap solid apart. Corners that an edge of the solid joins belong together; so do
/// a hole in a face and the loop around it, and a hollow and the piece it is in. Labels are made by joining trees of
/// corners, the smaller number first, so that they do not depend on anything but the overlap.
#ifndef SCREE_OVERLAP_PATCHES_KERNEL_H
#define SCREE_OVERLAP_PATCHES_KERNEL_H

#include "contact/overlap_sums_kernel.h"

/// Corners by one number: crossings, then the vertices of A, then those of B.
SCREE_FN int32_t scree_patch_number(const scree_overlap_slice *slice, scree_overlap_corner corner)
{
    if (corner.kind == 2) return corner.index;
    return slice->num_crossings + corner.index + (corner.kind == 1 ? slice->body[0].num_vertices : 0);
}

/// Parent of a corner in its tree.
SCREE_FN int32_t *scree_patch_parent(scree_overlap_slice *slice, int32_t number)
{
    if (number < slice->num_crossings) return &slice->crossings[number].patch;
    number -= slice->num_crossings;
    if (number < slice->body[0].num_vertices) return &slice->body[0].vertices[number].patch;
    return &slice->body[1].vertices[number - slice->body[0].num_vertices].patch;
}

SCREE_FN int32_t scree_patch_root(scree_overlap_slice *slice, int32_t number)
{
    int32_t *parent = scree_patch_parent(slice, number);
    while (*parent != number)
    {
        // half of the way is cut short for the next one
        *parent = *scree_patch_parent(slice, *parent);
        number = *parent;
        parent = scree_patch_parent(slice, number);
    }
    return number;
}

SCREE_FN void scree_patch_join(scree_overlap_slice *slice, int32_t a, int32_t b)
{
    const int32_t root_a = scree_patch_root(slice, a);
    const int32_t root_b = scree_patch_root(slice, b);
    if (root_a < root_b) *scree_patch_parent(slice, root_b) = root_a;
    else *scree_patch_parent(slice, root_a) = root_b;
}

/// Number of corners that may be there.
SCREE_FN int32_t scree_patch_num_corners(const scree_overlap_slice *slice)
{
    return slice->num_crossings + slice->body[0].num_vertices + slice->body[1].num_vertices;
}

SCREE_FN bool scree_patch_is_corner(const scree_overlap_slice *slice, int32_t number)
{
    if (number < slice->num_crossings) return true;
    number -= slice->num_crossings;
    const int32_t num_a = slice->body[0].num_vertices;
    if (number < num_a) return slice->body[0].num_inside > 0 && slice->body[0].vertices[number].inside != 0;
    return slice->body[1].num_inside > 0 && slice->body[1].vertices[number - num_a].inside != 0;
}

SCREE_FN bool scree_next_segment(const scree_overlap_slice *slice, scree_edge_walk *walk, scree_solid_edge *edge)
{
    while (walk->next < slice->num_segments)
    {
        const scree_overlap_segment *segment = slice->segments + walk->next++;
        if (segment->end[0] < 0 || segment->end[1] < 0) continue;
        for (int32_t end = 0; end < 2; ++end)
        {
            edge->corner[end] = segment->end[end];
            edge->point[end] = slice->crossings[segment->end[end]].point;
        }
        edge->body_left = 0;
        edge->face_left = segment->triangle_a;
        edge->body_right = 1;
        edge->face_right = segment->triangle_b;
        return true;
    }
    return false;
}

/// Walk `number` of the slice, of which one may go on while the other does, to the next edge of the solid. False at the
/// end.
SCREE_FN_APART bool scree_next_solid_edge(scree_overlap_slice *slice, int32_t number)
{
    scree_edge_walk *walk = slice->edge_walk + number;
    scree_solid_edge *edge = slice->solid_edge + number;
    const scree_shape_view *const *shape = slice->shape;
    if (walk->part == 0)
    {
        if (scree_next_segment(slice, walk, edge)) return true;
        walk->part = 1;
        walk->next = 0;
        walk->side = 0;
    }
    for (; walk->part < 3; ++walk->part, walk->next = 0)
    {
        scree_overlap_body *body = slice->body + walk->part - 1;
        for (; walk->next < body->num_triangles; ++walk->next, walk->side = 0)
        {
            if (!body->kept[walk->next].is_finished) continue;
            for (; walk->side < 3; ++walk->side)
            {
                if (!walk->is_on_edge)
                {
                    if ((scree_overlap_inside_sides(body, walk->next) >> walk->side & 1) == 0) continue;
                    if (scree_kept_neighbour(body, shape[walk->part - 1], walk->next, walk->side) < 0) continue;
                    scree_interval_walk_start(body, walk->next, walk->side, &walk->intervals);
                    walk->is_on_edge = true;
                }
                scree_overlap_interval interval;
                if (scree_overlap_next_interval(slice, body, &walk->intervals, &interval))
                {
                    for (int32_t end = 0; end < 2; ++end)
                    {
                        edge->corner[end] = scree_patch_number(slice, interval.corner[end]);
                        edge->point[end] = interval.point[end];
                    }
                    edge->body_left = walk->part - 1;
                    edge->face_left = walk->next;
                    edge->body_right = walk->part - 1;
                    edge->face_right = scree_kept_neighbour(body, shape[walk->part - 1], walk->next, walk->side);
                    return true;
                }
                walk->is_on_edge = false;
            }
        }
    }
    return false;
}

/// Starts walk `number`. Returns where its edges will be.
SCREE_FN const scree_solid_edge *scree_walk_edges(scree_overlap_slice *slice, int32_t number)
{
    scree_edge_walk *walk = slice->edge_walk + number;
    walk->part = 0;
    walk->next = 0;
    walk->side = 0;
    walk->is_on_edge = false;
    return slice->solid_edge + number;
}

/// A point without the coordinate along which the face's normal is largest.
SCREE_FN void scree_in_plane(const scree_face *face, scree_vec3 p, scree_real *x, scree_real *y)
{
    const scree_real nx = scree_abs(face->normal.x);
    const scree_real ny = scree_abs(face->normal.y);
    const scree_real nz = scree_abs(face->normal.z);
    const bool drops_x = nx >= ny && nx >= nz;
    const bool drops_z = !drops_x && nz > ny;
    *x = drops_x ? p.y : p.x;
    *y = drops_z ? p.y : p.z;
}

/// Does the loop of tree `root` on a face run around a point? By the parity of its edges along a ray in the plane.
SCREE_FN bool scree_patch_surrounds(scree_overlap_slice *slice, int32_t body, int32_t triangle, int32_t root,
                                    scree_vec3 point)
{
    const scree_face *face = &slice->body[body].triangles[triangle].face;
    scree_real px, py;
    scree_in_plane(face, point, &px, &py);
    bool is_around = false;
    const scree_solid_edge *edge = scree_walk_edges(slice, 1);
    while (scree_next_solid_edge(slice, 1))
    {
        const bool is_on_face = (edge->body_left == body && edge->face_left == triangle) ||
                                (edge->body_right == body && edge->face_right == triangle);
        if (!is_on_face || scree_patch_root(slice, edge->corner[0]) != root) continue;
        scree_real x0, y0, x1, y1;
        scree_in_plane(face, edge->point[0], &x0, &y0);
        scree_in_plane(face, edge->point[1], &x1, &y1);
        if ((y0 > py) != (y1 > py) && px < x0 + (x1 - x0) * ((py - y0) / (y1 - y0))) is_around = !is_around;
    }
    return is_around;
}

/// Joins holes of tree `root` to the loops around them, by the sums over this tree: on a face with a hole its boundary
/// runs the wrong way round. True if something was joined.
SCREE_FN bool scree_patch_join_holes(scree_overlap_slice *slice, int32_t root)
{
    const scree_solid_edge *edge = scree_walk_edges(slice, 0);
    while (scree_next_solid_edge(slice, 0))
    {
        if (scree_patch_root(slice, edge->corner[0]) != root) continue;
        for (int32_t turn = 0; turn < 2; ++turn)
        {
            const int32_t body = turn == 0 ? edge->body_left : edge->body_right;
            const int32_t triangle = turn == 0 ? edge->face_left : edge->face_right;
            const scree_overlap_triangle *t = slice->body[body].triangles + triangle;
            const scree_real along = scree_vec3_dot(t->face.normal, t->boundary);
            if (!t->has_foot || !(along < 0)) continue;
            for (int32_t other = 0; other < scree_patch_num_corners(slice); ++other)
            {
                if (other == root || !scree_patch_is_corner(slice, other)) continue;
                if (*scree_patch_parent(slice, other) != other) continue;
                if (!scree_patch_surrounds(slice, body, triangle, other, edge->point[0])) continue;
                scree_patch_join(slice, root, other);
                return true;
            }
        }
    }
    return false;
}

/// First root from `number` on, or -1.
SCREE_FN int32_t scree_patch_next_root(scree_overlap_slice *slice, int32_t number)
{
    const int32_t num_corners = scree_patch_num_corners(slice);
    for (; number < num_corners; ++number)
        if (scree_patch_is_corner(slice, number) && *scree_patch_parent(slice, number) == number) return number;
    return -1;
}

/// Sums over one tree, while trees are still being joined: every label is a root then.
SCREE_FN_APART scree_real scree_patch_sum(scree_overlap_slice *slice, int32_t root)
{
    for (int32_t number = 0; number < scree_patch_num_corners(slice); ++number)
        if (scree_patch_is_corner(slice, number)) *scree_patch_parent(slice, number) = scree_patch_root(slice, number);
    slice->num_patches = 2;
    const scree_team team = scree_team_alone();
    scree_overlap_sum(&team, slice, slice->shape, root, &slice->patch_sums);
    return slice->patch_sums.six_volume;
}

/// Is a point, in the plane of x and y, on the left of the way from a to b? On the way itself it is imagined moved by
/// +(e1 >> e2), so that the two triangles at an edge agree.
SCREE_FN bool scree_patch_is_left(scree_vec3 p, scree_vec3 a, scree_vec3 b)
{
    const scree_real turn = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    if (turn != 0) return turn > 0;
    return b.y != a.y ? b.y < a.y : b.x > a.x;
}

/// How often the ray along +z from a point leaves through triangle a x y: 1, or -1 where it enters. `height` is that of
/// the point over the plane, whose normal has the given z.
SCREE_FN int32_t scree_patch_ray_leaves(scree_vec3 p, scree_vec3 a, scree_vec3 x, scree_vec3 y, scree_real height,
                                        scree_real normal_z)
{
    const bool is_below = normal_z > 0 ? height < 0 : height > 0;
    const bool is_left_of_a = scree_patch_is_left(p, a, x);
    const bool is_left_of_x = scree_patch_is_left(p, x, y);
    const bool is_left_of_y = scree_patch_is_left(p, y, a);
    if (!is_below || is_left_of_a != is_left_of_x || is_left_of_x != is_left_of_y) return 0;
    return is_left_of_a ? 1 : -1;
}

/// Does the piece of tree `root` go around a point? Each face is a fan of triangles from a corner of the body's face.
SCREE_FN bool scree_patch_contains(scree_overlap_slice *slice, int32_t root, scree_vec3 point)
{
    int32_t num_left = 0;
    const scree_solid_edge *edge = scree_walk_edges(slice, 1);
    while (scree_next_solid_edge(slice, 1))
    {
        if (scree_patch_root(slice, edge->corner[0]) != root) continue;
        const scree_face *left = &slice->body[edge->body_left].triangles[edge->face_left].face;
        const scree_face *right = &slice->body[edge->body_right].triangles[edge->face_right].face;
        num_left += scree_patch_ray_leaves(point, left->p[0], edge->point[0], edge->point[1],
                                           scree_face_height(left, point), left->normal.z);
        num_left += scree_patch_ray_leaves(point, right->p[0], edge->point[1], edge->point[0],
                                           scree_face_height(right, point), right->normal.z);
    }
    return num_left != 0;
}

/// Joins shells that are turned inside out to the pieces that they are hollows of. `most`: the largest volume, times 6.
SCREE_FN void scree_patch_join_hollows(scree_overlap_slice *slice, scree_real most)
{
    for (int32_t root = scree_patch_next_root(slice, 0); root >= 0; root = scree_patch_next_root(slice, root + 1))
    {
        if (!(scree_patch_sum(slice, root) < -1000 * SCREE_REAL_EPSILON * most)) continue;
        const scree_solid_edge *edge = scree_walk_edges(slice, 0);
        bool has_edge = scree_next_solid_edge(slice, 0);
        while (has_edge && scree_patch_root(slice, edge->corner[0]) != root) has_edge = scree_next_solid_edge(slice, 0);
        int32_t other = has_edge ? scree_patch_next_root(slice, 0) : -1;
        while (other >= 0 && (other == root || !scree_patch_contains(slice, other, edge->point[0])))
            other = scree_patch_next_root(slice, other + 1);
        if (other >= 0) scree_patch_join(slice, root, other);
    }
}

/// Labels the corners of the solid by patch, from 0; returns the number of patches. With several, slice->num_patches
/// is set and sums can be asked of each.
SCREE_FN_APART int32_t scree_overlap_find_patches(scree_overlap_slice *slice)
{
    const int32_t num_corners = scree_patch_num_corners(slice);
    for (int32_t number = 0; number < num_corners; ++number)
        if (scree_patch_is_corner(slice, number)) *scree_patch_parent(slice, number) = number;
    const scree_solid_edge *edge = scree_walk_edges(slice, 0);
    while (scree_next_solid_edge(slice, 0)) scree_patch_join(slice, edge->corner[0], edge->corner[1]);

    scree_real most = 0;
    for (int32_t root = scree_patch_next_root(slice, 0); root >= 0;)
    {
        const bool is_only = root == scree_patch_next_root(slice, 0) && scree_patch_next_root(slice, root + 1) < 0;
        if (is_only) break;
        most = scree_max(most, scree_patch_sum(slice, root));
        if (scree_patch_join_holes(slice, root))
        {
            root = scree_patch_next_root(slice, 0);
            most = 0;
        }
        else root = scree_patch_next_root(slice, root + 1);
    }
    if (most > 0) scree_patch_join_hollows(slice, most);

    // roots become labels in their order; a root is never after what hangs on it
    int32_t num = 0;
    for (int32_t number = 0; number < num_corners; ++number)
    {
        if (!scree_patch_is_corner(slice, number)) continue;
        int32_t *label = scree_patch_parent(slice, number);
        *label = *label == number ? -1 - num++ : *label;
    }
    for (int32_t number = 0; number < num_corners; ++number)
    {
        if (!scree_patch_is_corner(slice, number)) continue;
        int32_t *label = scree_patch_parent(slice, number);
        if (*label >= 0) *label = *scree_patch_parent(slice, *label);
    }
    for (int32_t number = 0; number < num_corners; ++number)
        if (scree_patch_is_corner(slice, number))
            *scree_patch_parent(slice, number) = -1 - *scree_patch_parent(slice, number);
    slice->num_patches = num > 1 ? num : 1;
    return num;
}

#endif
