/// \file neighbour_kernel.h
/// Boxes with skin, and how far a body has moved since they were made.
#ifndef SCREE_NEIGHBOUR_KERNEL_H
#define SCREE_NEIGHBOUR_KERNEL_H

#include "core/atomic_kernel.h"
#include "core/live.h"
#include "polyhedra/shape.h"

typedef struct scree_boxes_args
{
    const scree_shape_view *shapes; ///< all shapes
    const int32_t *shape;           ///< (num_particles)
    const scree_pose *pose;         ///< (num_particles)
    scree_real skin;                ///< [m]
    scree_box *boxes;               ///< (num_particles) out
    scree_vec3 *centres;            ///< (num_particles) out
    scree_real *radii;              ///< (num_particles) out, with skin
} scree_boxes_args;

/// Box of the vertices of particle i, or of the spheres that it is made of, and its bounding sphere, both with skin.
SCREE_FN void scree_boxes_at(scree_boxes_args a, int64_t i)
{
    const scree_shape_view *shape = a.shapes + a.shape[i];
    const scree_pose pose = a.pose[i];
    scree_box box = shape->box;
    if (shape->kind == SCREE_KIND_MESH)
    {
        const scree_mat3 rotation = scree_mat3_from_quat(pose.orientation);
        box = scree_box_empty();
        for (int32_t v = 0; v < shape->num_vertices; ++v)
            box = scree_box_with_point(box, scree_mat3_apply(rotation, shape->vertices[v]));
    }
    if (shape->kind == SCREE_KIND_CLUMP)
    {
        const scree_mat3 rotation = scree_mat3_from_quat(pose.orientation);
        box = scree_box_empty();
        for (int32_t k = 0; k < shape->num_spheres; ++k)
        {
            const scree_vec3 centre = scree_mat3_apply(rotation, shape->spheres[k].centre);
            const scree_real r = shape->spheres[k].radius;
            const scree_vec3 corner = scree_vec3_make(r, r, r);
            box = scree_box_with_point(box, scree_vec3_sub(centre, corner));
            box = scree_box_with_point(box, scree_vec3_add(centre, corner));
        }
    }

    // a few roundings of the rotation, the scaling and the sums
    const scree_real radius = shape->bounding_radius * pose.scale;
    const scree_real margin =
        a.skin + 16 * SCREE_REAL_EPSILON *
                     (radius + scree_abs(pose.position.x) + scree_abs(pose.position.y) + scree_abs(pose.position.z));
    const scree_vec3 around = scree_vec3_make(margin, margin, margin);
    a.boxes[i].lower = scree_vec3_sub(scree_vec3_add_scaled(pose.position, box.lower, pose.scale), around);
    a.boxes[i].upper = scree_vec3_add(scree_vec3_add_scaled(pose.position, box.upper, pose.scale), around);
    a.centres[i] = pose.position;
    a.radii[i] = radius + margin;
}

SCREE_FN scree_real scree_shift(scree_vec3 from, scree_vec3 to) { return scree_vec3_length(scree_vec3_sub(to, from)); }

/// Upper bound of how far the surface of a body has moved from one pose to the other. With R the bounding radius:
/// |x1 - x0| + 2 sin(angle/2) R; a sphere that turns stays where it is.
SCREE_FN scree_real scree_displacement(const scree_shape_view *shape, const scree_pose *from, const scree_pose *to)
{
    const scree_real shift = scree_shift(from->position, to->position);
    if (shape->kind == SCREE_KIND_SPHERE) return shift;
    const scree_quat turn = scree_quat_multiply(to->orientation, scree_quat_conjugate(from->orientation));
    const scree_real sine = scree_sqrt(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z);
    return shift + 2 * sine * (shape->bounding_radius * to->scale);
}

/// What is known of the ways of bodies from one search to the next.
typedef struct scree_ways
{
    const scree_shape_view *shapes; ///< all shapes
    const int32_t *shape;           ///< (num_bodies)
    scree_real *travel;             ///< [m] (num_bodies) since the last search; NULL: not kept
} scree_ways;

/// Body i goes from the pose of the step before to that of this one.
SCREE_FN void scree_add_way(const scree_ways *ways, int64_t i, const scree_pose *from, const scree_pose *to)
{
    if (!ways->travel) return;
    ways->travel[i] += scree_displacement(ways->shapes + ways->shape[i], from, to);
}

typedef struct scree_travel_args
{
    const scree_shape_view *shapes;  ///< all shapes
    const int32_t *shape;            ///< (num_bodies)
    const scree_pose *pose;          ///< (num_bodies)
    const scree_pose *searched_pose; ///< (num_bodies) of the last search
    int64_t num_particles;
    scree_maximum *particles_moved; ///< [m] largest displacement since the last search
    scree_maximum *walls_moved;     ///< [m] the same of the walls
} scree_travel_args;

/// How far body i has moved.
SCREE_FN void scree_travel_at(scree_travel_args a, int64_t i)
{
    const scree_shape_view *shape = a.shapes + a.shape[i];
    const scree_real moved = scree_displacement(shape, a.searched_pose + i, a.pose + i);
    if (i < a.num_particles) scree_atomic_max(a.particles_moved, moved);
    else scree_atomic_max(a.walls_moved, moved);
}

/// [m] how far two bodies can have come closer to each other.
SCREE_FN scree_real scree_moved_apart(scree_maximum particles_moved, scree_maximum walls_moved)
{
    return (scree_real)(scree_maximum_value(particles_moved) + scree_maximum_value(walls_moved));
}

/// Not a number asks for a search.
SCREE_FN bool scree_leaves_skin(scree_real moved, scree_real skin) { return !(moved <= skin); }

typedef struct scree_skin_args
{
    const scree_maximum *particles_moved; ///< [m]
    const scree_maximum *walls_moved;     ///< [m]
    scree_real skin;                      ///< [m]
    scree_live *live;                     ///< out
} scree_skin_args;

/// Halts a recorded step that candidate pairs must be searched for. By the one index of the launch.
SCREE_FN void scree_skin_at(scree_skin_args a, int64_t i)
{
    (void)i;
    if (scree_leaves_skin(scree_moved_apart(*a.particles_moved, *a.walls_moved), a.skin))
        a.live->halt = SCREE_HALT_SEARCH;
}

#endif
