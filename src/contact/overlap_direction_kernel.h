/// \file overlap_direction_kernel.h
/// A direction out of A into B along which the two touch, as far as can be told cheaply: the line of centres for bodies
/// of like size, turned, if both have many triangles, to where their extents overlap less; for a wall, or anything much
/// larger or longer than the other body, the way from the centre of the smaller body to the nearest point of the larger
/// one. Only the speed of the overlap depends on it, no result.
#ifndef SCREE_OVERLAP_DIRECTION_KERNEL_H
#define SCREE_OVERLAP_DIRECTION_KERNEL_H

#include "contact/overlap_frame_kernel.h"
#include "core/team.h"
#include "polyhedra/shape.h"

/// The larger body counts as a wall beyond this ratio of its longest side to the other's.
#define SCREE_WALL_RATIO 2

/// Point of the triangle p0 p1 p2 nearest to the origin (Ericson 2005, section 5.1.5).
SCREE_FN scree_vec3 scree_triangle_nearest(scree_vec3 p0, scree_vec3 p1, scree_vec3 p2)
{
    const scree_vec3 u = scree_vec3_sub(p1, p0);
    const scree_vec3 v = scree_vec3_sub(p2, p0);
    const scree_real u0 = -scree_vec3_dot(u, p0);
    const scree_real v0 = -scree_vec3_dot(v, p0);
    if (u0 <= 0 && v0 <= 0) return p0;
    const scree_real u1 = -scree_vec3_dot(u, p1);
    const scree_real v1 = -scree_vec3_dot(v, p1);
    if (u1 >= 0 && v1 <= u1) return p1;
    const scree_real area2 = u0 * v1 - u1 * v0;
    if (area2 <= 0 && u0 >= 0 && u1 <= 0) return scree_vec3_add_scaled(p0, u, u0 > u1 ? u0 / (u0 - u1) : 0);
    const scree_real u2 = -scree_vec3_dot(u, p2);
    const scree_real v2 = -scree_vec3_dot(v, p2);
    if (v2 >= 0 && u2 <= v2) return p2;
    const scree_real area1 = u2 * v0 - u0 * v2;
    if (area1 <= 0 && v0 >= 0 && v2 <= 0) return scree_vec3_add_scaled(p0, v, v0 > v2 ? v0 / (v0 - v2) : 0);
    const scree_real area0 = u1 * v2 - u2 * v1;
    const scree_real along = v1 - u1;
    const scree_real back = u2 - v2;
    if (area0 <= 0 && along >= 0 && back >= 0)
        return scree_vec3_add_scaled(p1, scree_vec3_sub(p2, p1), along + back > 0 ? along / (along + back) : 0);
    const scree_real total = area0 + area1 + area2;
    if (!(total > 0)) return p0;
    return scree_vec3_add_scaled(scree_vec3_add_scaled(p0, u, area1 / total), v, area2 / total);
}

/// From a point within the box of a shape to the nearest of its triangles near the point, out of the body's inside:
/// where the point lies behind the nearest triangle, against its normal. Zero if there is none within `reach`.
SCREE_FN scree_vec3 scree_nearest_triangle_way(const scree_shape_view *shape, scree_vec3 centre, scree_real reach)
{
    scree_vec3 way = scree_vec3_zero();
    scree_real least = reach * reach;
    int32_t k = shape->tree.nodes == NULL ? SCREE_LBVH_END : shape->tree.root;
    while (k != SCREE_LBVH_END)
    {
        const scree_lbvh_node *node = shape->tree.nodes + k;
        const scree_vec3 clamped = scree_vec3_max(node->box.lower, scree_vec3_min(node->box.upper, centre));
        const scree_vec3 to_box = scree_vec3_sub(clamped, centre);
        const bool is_entered = scree_vec3_dot(to_box, to_box) < least;
        if (is_entered && node->first_child < 0)
        {
            const int32_t *v = shape->triangles[-1 - node->first_child].v;
            const scree_vec3 p0 = scree_vec3_sub(shape->vertices[v[0]], centre);
            const scree_vec3 p1 = scree_vec3_sub(shape->vertices[v[1]], centre);
            const scree_vec3 p2 = scree_vec3_sub(shape->vertices[v[2]], centre);
            const scree_vec3 nearest = scree_triangle_nearest(p0, p1, p2);
            const scree_real distance = scree_vec3_dot(nearest, nearest);
            if (distance < least)
            {
                least = distance;
                const scree_vec3 normal = scree_vec3_cross(scree_vec3_sub(p1, p0), scree_vec3_sub(p2, p0));
                way = scree_vec3_dot(nearest, normal) < 0 ? nearest : scree_vec3_negate(normal);
            }
        }
        k = is_entered && node->first_child >= 0 ? node->first_child : node->escape;
    }
    return way;
}

/// From a point to the nearest point of a shape, in the frame of the shape; `reach` is how far the other body extends
/// about the point.
SCREE_FN scree_vec3 scree_way_to_shape(const scree_shape_view *shape, scree_vec3 centre, scree_real reach)
{
    const scree_vec3 nearest = scree_vec3_max(shape->box.lower, scree_vec3_min(shape->box.upper, centre));
    const scree_vec3 way = scree_vec3_sub(nearest, centre);
    const bool is_within = way.x == 0 && way.y == 0 && way.z == 0;
    return is_within ? scree_nearest_triangle_way(shape, centre, reach) : way;
}

SCREE_FN scree_real scree_box_extent(scree_box box)
{
    return scree_max(box.upper.x - box.lower.x, scree_max(box.upper.y - box.lower.y, box.upper.z - box.lower.z));
}

/// The search for a shallower direction ends after so many steps,
#define SCREE_SHALLOW_STEPS 4
/// or where a step gains less than this part of the depth; a step is this part of the one that would be right for two
/// spheres. Both from trying: fewer kept triangles against the time of the search.
#define SCREE_SHALLOW_GAIN ((scree_real)0.15)
#define SCREE_SHALLOW_DAMPING ((scree_real)0.6)

/// A direction near `start` along which the extents of the two overlap less, in the body frame of A. The way between
/// the two points that lie deepest in each other is what the depth grows by as the direction turns.
SCREE_FN scree_vec3 scree_shallow_direction(const scree_shape_view *a, const scree_shape_view *b,
                                            const scree_relative_pose *pose, scree_vec3 start)
{
    scree_vec3 d = scree_vec3_scale(start, 1 / scree_vec3_length(start));
    scree_vec3 best = d;
    scree_real least = SCREE_REAL_MAX;
    for (int32_t step = 0;; ++step)
    {
        const scree_vec3 back = scree_mat3_apply_transposed(pose->rotation, scree_vec3_negate(d));
        const scree_vec3 p = scree_support_map_point(a->support_map, d);
        const scree_vec3 q =
            scree_affine(&pose->rotation, scree_support_map_point(b->support_map, back), pose->translation);
        const scree_vec3 way = scree_vec3_sub(p, q);
        const scree_real depth = scree_vec3_dot(d, way);
        if (depth < least)
        {
            least = depth;
            best = d;
        }
        // two spheres with these centres and this depth have the sum of radii
        const scree_real radii = scree_vec3_dot(d, pose->translation) + depth;
        const scree_vec3 sideways = scree_vec3_add_scaled(way, d, -depth);
        const scree_real gain = scree_vec3_dot(sideways, sideways) / 2;
        if (step == SCREE_SHALLOW_STEPS || !(gain > SCREE_SHALLOW_GAIN * radii * scree_abs(depth))) return best;
        d = scree_vec3_add_scaled(d, sideways, -SCREE_SHALLOW_DAMPING / radii);
        d = scree_vec3_scale(d, 1 / scree_vec3_length(d));
    }
}

/// Direction out of A into B in the body frame of A, of any length; `pose` is that of B in this frame.
SCREE_FN_APART scree_vec3 scree_overlap_direction(const scree_shape_view *a, const scree_shape_view *b,
                                                  const scree_relative_pose *pose)
{
    const scree_vec3 centre_a = scree_box_middle(a->box);
    const scree_vec3 centre_b = scree_affine(&pose->rotation, scree_box_middle(b->box), pose->translation);
    const scree_real scale2 = scree_vec3_dot(pose->rotation.row[0], pose->rotation.row[0]);
    const scree_real ratio = scree_sqrt(scale2);
    const scree_real extent_a = scree_box_extent(a->box);
    const scree_real extent_b = scree_box_extent(b->box) * ratio;
    scree_vec3 way = scree_vec3_zero();
    if (extent_b > SCREE_WALL_RATIO * extent_a)
    {
        const scree_vec3 from_b = scree_vec3_sub(centre_a, pose->translation);
        const scree_vec3 centre = scree_vec3_scale(scree_mat3_apply_transposed(pose->rotation, from_b), 1 / scale2);
        way = scree_mat3_apply(pose->rotation, scree_way_to_shape(b, centre, extent_a / ratio));
    }
    else if (extent_a > SCREE_WALL_RATIO * extent_b)
    {
        way = scree_vec3_negate(scree_way_to_shape(a, centre_b, extent_b));
    }
    if (way.x != 0 || way.y != 0 || way.z != 0) return way;
    way = scree_vec3_sub(centre_b, centre_a);
    const bool is_mapped = a->support_map != NULL && b->support_map != NULL;
    return is_mapped && scree_vec3_dot(way, way) > 0 ? scree_shallow_direction(a, b, pose, way) : way;
}

#endif
