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

/// Support point in world axes, relative to the position of the body. `is_mapped`: from the table of the shape, if it
/// has one, which is somewhat outside.
SCREE_FN scree_vec3 scree_posed_support_point(const scree_shape_view *shape, const scree_mat3 *rotation,
                                              scree_real scale, scree_vec3 direction, bool is_mapped)
{
    const scree_vec3 own_direction = scree_mat3_apply_transposed(*rotation, direction);
    const scree_vec3 own = is_mapped && shape->support_map ? scree_support_map_point(shape->support_map, own_direction)
                                                           : scree_support_point(shape, own_direction);
    return scree_vec3_scale(scree_mat3_apply(*rotation, own), scale);
}

/// Two bodies between which a plane is looked for.
typedef struct scree_separation_bodies
{
    const scree_shape_view *shape[2];
    scree_mat3 rotation[2];
    scree_real scale[2];
    scree_vec3 between; ///< position of the second minus that of the first
    scree_real size;    ///< of both together
} scree_separation_bodies;

/// Gap [m] along a unit direction, beyond rounding, and the way between the points that lie farthest along it.
SCREE_FN scree_real scree_gap_along(const scree_separation_bodies *bodies, scree_vec3 d, bool is_mapped,
                                    scree_vec3 *way)
{
    const scree_vec3 p =
        scree_posed_support_point(bodies->shape[0], &bodies->rotation[0], bodies->scale[0], d, is_mapped);
    const scree_vec3 q = scree_posed_support_point(bodies->shape[1], &bodies->rotation[1], bodies->scale[1],
                                                   scree_vec3_negate(d), is_mapped);
    *way = scree_vec3_sub(scree_vec3_add(bodies->between, q), p);
    // points of a table are its slopes, which lose 264 units
    return scree_vec3_dot(d, *way) - (is_mapped ? 384 : 64) * SCREE_REAL_EPSILON * bodies->size;
}

/// A gap by table that falls short of 0 by less than this share of the sizes asks all vertices; a larger share finds
/// few planes more.
#define SCREE_SUPPORT_DOUBT ((scree_real)5e-4)

/// Gap [m] between the two along *direction, a unit vector out of A into B, which is improved until the gap is positive
/// beyond rounding; 0 if none was found. Start from the direction of the last time, or from zero.
SCREE_FN scree_real scree_separation_search(const scree_shape_view *a, const scree_pose *pose_a,
                                            const scree_shape_view *b, const scree_pose *pose_b, scree_vec3 *direction)
{
    scree_separation_bodies bodies;
    bodies.shape[0] = a;
    bodies.shape[1] = b;
    bodies.rotation[0] = scree_mat3_from_quat(pose_a->orientation);
    bodies.rotation[1] = scree_mat3_from_quat(pose_b->orientation);
    bodies.scale[0] = pose_a->scale;
    bodies.scale[1] = pose_b->scale;
    bodies.between = scree_vec3_sub(pose_b->position, pose_a->position);
    bodies.size =
        scree_vec3_length(bodies.between) + a->bounding_radius * pose_a->scale + b->bounding_radius * pose_b->scale;
    const scree_real doubt = SCREE_SUPPORT_DOUBT * (bodies.size - scree_vec3_length(bodies.between));
    const bool is_mapped = a->support_map || b->support_map;
    scree_vec3 d = *direction;
    if (!(scree_vec3_dot(d, d) > 0)) d = bodies.between;
    for (int32_t round = 0; round < SCREE_SEPARATION_MAX_ROUNDS; ++round)
    {
        const scree_real length = scree_vec3_length(d);
        if (!(length > 0)) return 0;
        d = scree_vec3_scale(d, 1 / length);
        scree_vec3 from_p_to_q;
        scree_real gap = 0;
        // all vertices are asked only where the table leaves it open
        for (bool is_tried = is_mapped, is_open = true; is_open; is_tried = false)
        {
            gap = scree_gap_along(&bodies, d, is_tried, &from_p_to_q);
            is_open = is_tried && gap <= 0 && gap > -doubt;
        }
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
