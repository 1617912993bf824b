/// \file separating_direction_kernel.h
/// Search for a plane between two posed shapes (Chung & Wang 1996): reflect the direction at the line between the two
/// support points until it separates. Non-convex shapes are taken as their hulls, so "not found" proves nothing.
#ifndef SCREE_SEPARATING_DIRECTION_KERNEL_H
#define SCREE_SEPARATING_DIRECTION_KERNEL_H

#include "contact/separation_kernel.h"

/// Most of the separable pairs of a dense bed need two to five.
#define SCREE_SEPARATION_MAX_ROUNDS 8

/// Vertex of a shape that lies farthest along a direction of its own frame, the first of several. Which vertex is
/// farther than those before it cannot be foreseen: no branch.
SCREE_FN scree_vec3 scree_support_point(const scree_shape_view *shape, scree_vec3 direction)
{
    const scree_vec3 *vertices = shape->vertices;
    const int32_t num_vertices = shape->num_vertices;
    int32_t best = 0;
    scree_real most = scree_vec3_dot(direction, vertices[0]);
    for (int32_t v = 1; v < num_vertices; ++v)
    {
        const scree_real along = scree_vec3_dot(direction, vertices[v]);
        best = along > most ? v : best;
        most = scree_max(most, along);
    }
    return vertices[best];
}

/// Support point in world axes, relative to the position of the body.
SCREE_FN scree_vec3 scree_posed_support_point(const scree_shape_view *shape, const scree_mat3 *rotation,
                                              scree_real scale, scree_vec3 direction)
{
    const scree_vec3 own = scree_support_point(shape, scree_mat3_apply_transposed(*rotation, direction));
    return scree_vec3_scale(scree_mat3_apply(*rotation, own), scale);
}

/// Gap [m] between the two along *direction, a unit vector out of A into B, which is improved until the gap is positive
/// beyond rounding; 0 if none was found. Start from the direction of the last time, or from zero.
SCREE_FN scree_real scree_separation_search(const scree_shape_view *a, const scree_pose *pose_a,
                                            const scree_shape_view *b, const scree_pose *pose_b, scree_vec3 *direction)
{
    const scree_mat3 rotation_a = scree_mat3_from_quat(pose_a->orientation);
    const scree_mat3 rotation_b = scree_mat3_from_quat(pose_b->orientation);
    const scree_vec3 between = scree_vec3_sub(pose_b->position, pose_a->position);
    const scree_real size =
        scree_vec3_length(between) + a->bounding_radius * pose_a->scale + b->bounding_radius * pose_b->scale;
    scree_vec3 d = *direction;
    if (!(scree_vec3_dot(d, d) > 0)) d = between;
    for (int32_t round = 0; round < SCREE_SEPARATION_MAX_ROUNDS; ++round)
    {
        const scree_real length = scree_vec3_length(d);
        if (!(length > 0)) return 0;
        d = scree_vec3_scale(d, 1 / length);
        const scree_vec3 p = scree_posed_support_point(a, &rotation_a, pose_a->scale, d);
        const scree_vec3 q = scree_posed_support_point(b, &rotation_b, pose_b->scale, scree_vec3_negate(d));
        const scree_vec3 from_p_to_q = scree_vec3_sub(scree_vec3_add(between, q), p);
        const scree_real gap = scree_vec3_dot(d, from_p_to_q) - 64 * SCREE_REAL_EPSILON * size;
        if (gap > 0)
        {
            *direction = d;
            return gap;
        }
        const scree_real squared = scree_vec3_dot(from_p_to_q, from_p_to_q);
        if (!(squared > 0)) return 0;
        d = scree_vec3_add_scaled(d, from_p_to_q, -2 * scree_vec3_dot(d, from_p_to_q) / squared);
    }
    return 0;
}

#endif
