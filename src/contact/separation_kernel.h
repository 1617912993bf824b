/// \file separation_kernel.h
/// Are two posed shapes apart along a direction? One support query each; cheap enough to come before anything else.
#ifndef SCREE_SEPARATION_KERNEL_H
#define SCREE_SEPARATION_KERNEL_H

#include "bvh/lbvh_kernel.h"
#include "contact/overlap_frame_kernel.h"
#include "polyhedra/shape.h"

/// Shapes up to this many vertices are asked one vertex after the other, larger ones through their tree.
#define SCREE_SUPPORT_TREE_FROM 48

/// Largest direction . v over a box.
SCREE_FN scree_real scree_support_of_box(const scree_box *box, scree_vec3 direction)
{
    return scree_max(direction.x * box->lower.x, direction.x * box->upper.x) +
           scree_max(direction.y * box->lower.y, direction.y * box->upper.y) +
           scree_max(direction.z * box->lower.z, direction.z * box->upper.z);
}

SCREE_FN scree_real scree_support_of_triangle(const scree_shape_view *shape, int32_t t, scree_vec3 direction)
{
    const int32_t *v = shape->triangles[t].v;
    return scree_max(
        scree_max(scree_vec3_dot(direction, shape->vertices[v[0]]), scree_vec3_dot(direction, shape->vertices[v[1]])),
        scree_vec3_dot(direction, shape->vertices[v[2]]));
}

/// Largest direction . v over the vertices of a shape, in the shape's own frame, unscaled.
SCREE_FN scree_real scree_support(const scree_shape_view *shape, scree_vec3 direction)
{
    scree_real most = -SCREE_REAL_MAX;
    if (shape->num_vertices < SCREE_SUPPORT_TREE_FROM || shape->tree.nodes == NULL)
    {
        for (int32_t v = 0; v < shape->num_vertices; ++v)
            most = scree_max(most, scree_vec3_dot(direction, shape->vertices[v]));
        return most;
    }
    // straight down to a far leaf, so that the walk over the tree can skip nearly everything else
    int32_t k = shape->tree.root;
    while (shape->tree.nodes[k].first_child >= 0)
    {
        const int32_t left = shape->tree.nodes[k].first_child;
        const int32_t right = shape->tree.nodes[left].escape;
        k = scree_support_of_box(&shape->tree.nodes[left].box, direction) >
                    scree_support_of_box(&shape->tree.nodes[right].box, direction)
                ? left
                : right;
    }
    most = scree_support_of_triangle(shape, -1 - shape->tree.nodes[k].first_child, direction);
    k = shape->tree.root;
    while (k != SCREE_LBVH_END)
    {
        const scree_lbvh_node *node = shape->tree.nodes + k;
        // products and sums are monotone under rounding: a box is never short of its vertices
        const bool is_entered = scree_support_of_box(&node->box, direction) > most;
        if (is_entered && node->first_child < 0)
            most = scree_max(most, scree_support_of_triangle(shape, -1 - node->first_child, direction));
        k = is_entered && node->first_child >= 0 ? node->first_child : node->escape;
    }
    return most;
}

/// Gap of two posed shapes along a world direction of any length that points from A to B, times its length: > 0 if a
/// plane across it separates them by more than rounding.
SCREE_FN scree_real scree_separation_gap(const scree_shape_view *a, const scree_pose *pose_a, const scree_shape_view *b,
                                         const scree_pose *pose_b, scree_vec3 direction)
{
    const scree_vec3 d_a = scree_mat3_apply_transposed(scree_mat3_from_quat(pose_a->orientation), direction);
    const scree_vec3 d_b = scree_mat3_apply_transposed(scree_mat3_from_quat(pose_b->orientation), direction);
    const scree_real reach_a = pose_a->scale * scree_support(a, d_a);
    const scree_real reach_b = pose_b->scale * scree_support(b, scree_vec3_negate(d_b));
    const scree_vec3 between = scree_vec3_sub(pose_b->position, pose_a->position);
    const scree_real apart = scree_vec3_dot(between, direction);
    const scree_real size = scree_abs(between.x * direction.x) + scree_abs(between.y * direction.y) +
                            scree_abs(between.z * direction.z) + scree_abs(reach_a) + scree_abs(reach_b);
    return apart - reach_b - reach_a - 32 * SCREE_REAL_EPSILON * size;
}

/// Is there a gap along `direction` (world, any length, from A to B)? Never true where the two touch.
SCREE_FN bool scree_separation_holds(const scree_shape_view *a, const scree_pose *pose_a, const scree_shape_view *b,
                                     const scree_pose *pose_b, scree_vec3 direction)
{
    return scree_separation_gap(a, pose_a, b, pose_b, direction) > 0;
}

#endif
