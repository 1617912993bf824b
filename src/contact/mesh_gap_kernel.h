/// \file mesh_gap_kernel.h
/// How far the surfaces of two posed meshes are apart that do not overlap, convex or not. What no plane separates,
/// interlocked bodies and a body in a drum, is then left alone until it may have travelled so far.
///
/// Two triangles that do not meet are nearest at two of their edges, or at a corner of one and a point inside the
/// other: the least of nine distances of segments (Ericson 2005, Real-Time Collision Detection, 5.1.9) and six heights.
/// The triangles of the smaller mesh that its tree does not show to be far from the larger one are taken one by one
/// through the tree of that.
#ifndef SCREE_MESH_GAP_KERNEL_H
#define SCREE_MESH_GAP_KERNEL_H

#include "contact/overlap_frame_kernel.h"
#include "polyhedra/shape.h"

/// Farther than this share of the smaller body's bounding radius is not looked: what is apart by more makes no
/// candidate pair, or not for long.
#define SCREE_GAP_REACH ((scree_real)0.0625)

typedef struct scree_gap_triangle
{
    scree_vec3 a, b, c;
} scree_gap_triangle;

SCREE_FN scree_real scree_to_unit_interval(scree_real share) { return scree_min(scree_max(share, 0), 1); }

/// Squared distance of the segments p to p + d and q to q + e, neither a point.
SCREE_FN scree_real scree_segments_squared(scree_vec3 p, scree_vec3 d, scree_vec3 q, scree_vec3 e)
{
    const scree_vec3 between = scree_vec3_sub(p, q);
    const scree_real dd = scree_vec3_dot(d, d), ee = scree_vec3_dot(e, e), de = scree_vec3_dot(d, e);
    const scree_real db = scree_vec3_dot(d, between), eb = scree_vec3_dot(e, between);
    const scree_real determinant = dd * ee - de * de;
    scree_real s = determinant > 0 ? scree_to_unit_interval((de * eb - db * ee) / determinant) : 0;
    scree_real t = (de * s + eb) / ee;
    if (t < 0 || t > 1)
    {
        t = t < 0 ? 0 : 1;
        s = scree_to_unit_interval((de * t - db) / dd);
    }
    const scree_vec3 way = scree_vec3_add_scaled(scree_vec3_add_scaled(between, d, s), e, -t);
    return scree_vec3_dot(way, way);
}

/// Squared height of a point over a triangle, if it stands over its inside; otherwise `most`.
SCREE_FN scree_real scree_height_squared(scree_vec3 p, const scree_gap_triangle *t, scree_real most)
{
    const scree_vec3 ab = scree_vec3_sub(t->b, t->a), bc = scree_vec3_sub(t->c, t->b), ca = scree_vec3_sub(t->a, t->c);
    const scree_vec3 normal = scree_vec3_cross(ab, bc), from_a = scree_vec3_sub(p, t->a);
    const bool is_over = scree_vec3_dot(scree_vec3_cross(ab, from_a), normal) > 0 &&
                         scree_vec3_dot(scree_vec3_cross(bc, scree_vec3_sub(p, t->b)), normal) > 0 &&
                         scree_vec3_dot(scree_vec3_cross(ca, scree_vec3_sub(p, t->c)), normal) > 0;
    const scree_real height = scree_vec3_dot(normal, from_a);
    return is_over ? height * height / scree_vec3_dot(normal, normal) : most;
}

/// The least of `least` and the squared distances of a segment to the sides of a triangle.
SCREE_FN scree_real scree_sides_squared(scree_vec3 p, scree_vec3 d, const scree_gap_triangle *t, scree_real least)
{
    least = scree_min(least, scree_segments_squared(p, d, t->a, scree_vec3_sub(t->b, t->a)));
    least = scree_min(least, scree_segments_squared(p, d, t->b, scree_vec3_sub(t->c, t->b)));
    return scree_min(least, scree_segments_squared(p, d, t->c, scree_vec3_sub(t->a, t->c)));
}

/// Are all corners of u on one side of the plane of t, and farther from it than the root of `least`?
SCREE_FN bool scree_is_beyond_plane(const scree_gap_triangle *t, const scree_gap_triangle *u, scree_real least)
{
    const scree_vec3 normal = scree_vec3_cross(scree_vec3_sub(t->b, t->a), scree_vec3_sub(t->c, t->a));
    const scree_real a = scree_vec3_dot(normal, scree_vec3_sub(u->a, t->a));
    const scree_real b = scree_vec3_dot(normal, scree_vec3_sub(u->b, t->a));
    const scree_real c = scree_vec3_dot(normal, scree_vec3_sub(u->c, t->a));
    const scree_real nearest = scree_max(scree_min(a, scree_min(b, c)), -scree_max(a, scree_max(b, c)));
    return nearest > 0 && nearest * nearest > least * scree_vec3_dot(normal, normal);
}

/// The least of `least` and the squared distance of two triangles that do not meet.
SCREE_FN scree_real scree_triangles_squared(const scree_gap_triangle *t, const scree_gap_triangle *u, scree_real least)
{
    if (scree_is_beyond_plane(t, u, least) || scree_is_beyond_plane(u, t, least)) return least;
    least = scree_sides_squared(t->a, scree_vec3_sub(t->b, t->a), u, least);
    least = scree_sides_squared(t->b, scree_vec3_sub(t->c, t->b), u, least);
    least = scree_sides_squared(t->c, scree_vec3_sub(t->a, t->c), u, least);
    least = scree_min(least, scree_height_squared(t->a, u, least));
    least = scree_min(least, scree_height_squared(t->b, u, least));
    least = scree_min(least, scree_height_squared(t->c, u, least));
    least = scree_min(least, scree_height_squared(u->a, t, least));
    least = scree_min(least, scree_height_squared(u->b, t, least));
    return scree_min(least, scree_height_squared(u->c, t, least));
}

/// Squared distance of two boxes; 0 where they overlap.
SCREE_FN scree_real scree_boxes_squared(scree_box a, scree_box b)
{
    const scree_real x = scree_max(0, scree_max(a.lower.x - b.upper.x, b.lower.x - a.upper.x));
    const scree_real y = scree_max(0, scree_max(a.lower.y - b.upper.y, b.lower.y - a.upper.y));
    const scree_real z = scree_max(0, scree_max(a.lower.z - b.upper.z, b.lower.z - a.upper.z));
    return x * x + y * y + z * z;
}

/// Is a box farther from a plane through `point` across `normal`, of any length, than the root of `least`?
SCREE_FN bool scree_is_box_beyond_plane(scree_box box, scree_vec3 point, scree_vec3 normal, scree_real least)
{
    const scree_vec3 half = scree_box_half(box);
    const scree_real middle = scree_vec3_dot(normal, scree_vec3_sub(scree_box_middle(box), point));
    const scree_real extent =
        scree_abs(normal.x) * half.x + scree_abs(normal.y) * half.y + scree_abs(normal.z) * half.z;
    const scree_real away = scree_abs(middle) - extent;
    return away > 0 && away * away > least * scree_vec3_dot(normal, normal);
}

SCREE_FN scree_gap_triangle scree_gap_triangle_of(const scree_shape_view *mesh, int32_t t)
{
    const int32_t *v = mesh->triangles[t].v;
    scree_gap_triangle triangle;
    triangle.a = mesh->vertices[v[0]];
    triangle.b = mesh->vertices[v[1]];
    triangle.c = mesh->vertices[v[2]];
    return triangle;
}

/// The least of `least` and the squared distance of a triangle to the mesh, all in the mesh's own frame.
SCREE_FN scree_real scree_triangle_to_mesh_squared(const scree_shape_view *mesh, const scree_gap_triangle *u,
                                                   scree_real least)
{
    scree_box box;
    box.lower = scree_vec3_min(scree_vec3_min(u->a, u->b), u->c);
    box.upper = scree_vec3_max(scree_vec3_max(u->a, u->b), u->c);
    // the box of a triangle of a large wall holds all, its plane does not
    const scree_vec3 normal = scree_vec3_cross(scree_vec3_sub(u->b, u->a), scree_vec3_sub(u->c, u->a));
    for (int32_t k = mesh->tree.root; k != SCREE_LBVH_END;)
    {
        const scree_lbvh_node *node = mesh->tree.nodes + k;
        const bool is_entered =
            scree_boxes_squared(node->box, box) < least && !scree_is_box_beyond_plane(node->box, u->a, normal, least);
        if (is_entered && node->first_child < 0)
        {
            const scree_gap_triangle t = scree_gap_triangle_of(mesh, -1 - node->first_child);
            least = scree_triangles_squared(&t, u, least);
        }
        k = is_entered && node->first_child >= 0 ? k + 1 : node->escape;
    }
    return least;
}

/// Box around a posed one; what rounding may lack of it the gap has room for.
SCREE_FN scree_box scree_box_turned(const scree_relative_pose *pose, scree_box box)
{
    const scree_vec3 middle = scree_affine(&pose->rotation, scree_box_middle(box), pose->translation);
    const scree_vec3 half = scree_turned_extents(&pose->rotation, scree_box_half(box));
    scree_box turned;
    turned.lower = scree_vec3_sub(middle, half);
    turned.upper = scree_vec3_add(middle, half);
    return turned;
}

/// Gap [m] of two posed meshes without a common point: no more than their distance, rounding included, and no more than
/// SCREE_GAP_REACH lets it see; 0 or less if it is below `useful` [m] or they are too near to tell. `large` has the
/// tree that is walked.
SCREE_FN scree_real scree_mesh_gap(const scree_shape_view *large, const scree_pose *large_pose,
                                   const scree_shape_view *small, const scree_pose *small_pose, scree_real useful)
{
    const scree_relative_pose pose = scree_relative_pose_make(large_pose, small_pose);
    const scree_real ratio = small_pose->scale / large_pose->scale;
    const scree_real reach = scree_min(large->bounding_radius, small->bounding_radius * ratio) * SCREE_GAP_REACH;
    scree_real least = reach * reach;
    const scree_real too_near = useful / large_pose->scale * (useful / large_pose->scale);
    for (int32_t k = small->tree.root; k != SCREE_LBVH_END;)
    {
        if (least < too_near) return 0;
        const scree_lbvh_node *node = small->tree.nodes + k;
        const bool is_entered = scree_boxes_squared(large->box, scree_box_turned(&pose, node->box)) < least;
        if (is_entered && node->first_child < 0)
        {
            scree_gap_triangle u = scree_gap_triangle_of(small, -1 - node->first_child);
            u.a = scree_affine(&pose.rotation, u.a, pose.translation);
            u.b = scree_affine(&pose.rotation, u.b, pose.translation);
            u.c = scree_affine(&pose.rotation, u.c, pose.translation);
            least = scree_triangle_to_mesh_squared(large, &u, least);
        }
        k = is_entered && node->first_child >= 0 ? k + 1 : node->escape;
    }
    if (least < too_near) return 0;
    const scree_real size =
        scree_vec3_length(pose.translation) + large->bounding_radius + small->bounding_radius * ratio;
    return (scree_sqrt(least) - 256 * SCREE_REAL_EPSILON * size) * large_pose->scale;
}

#endif
