/// \file body_kernel.h
/// Where bodies are and how they move, to the arrays over all bodies: particles from their state, walls from the host.
#ifndef SCREE_BODY_KERNEL_H
#define SCREE_BODY_KERNEL_H

#include "dynamics/neighbour_kernel.h"
#include "dynamics/particles.h"
#include "forces/moving_body.h"

typedef struct scree_wall_motion
{
    scree_pose pose;
    scree_vec3 velocity;         ///< [m/s] at the position of the pose
    scree_vec3 angular_velocity; ///< [rad/s]
} scree_wall_motion;

typedef struct scree_body_arrays
{
    scree_pose *pose;          ///< (num_bodies)
    scree_moving_body *moving; ///< (num_bodies) but for what does not change
} scree_body_arrays;

typedef struct scree_place_walls_args
{
    scree_body_arrays bodies;
    scree_ways ways;
    int64_t first; ///< body that the first wall is
    const scree_wall_motion *walls;
} scree_place_walls_args;

/// Wall k.
SCREE_FN void scree_place_walls_at(scree_place_walls_args a, int64_t k)
{
    scree_add_way(&a.ways, a.first + k, a.bodies.pose + a.first + k, &a.walls[k].pose);
    a.bodies.pose[a.first + k] = a.walls[k].pose;
    a.bodies.moving[a.first + k].velocity = a.walls[k].velocity;
    a.bodies.moving[a.first + k].angular_velocity = a.walls[k].angular_velocity;
}

typedef struct scree_place_particles_args
{
    scree_body_arrays bodies;
    scree_particles particles;
} scree_place_particles_args;

/// Particle i as it is.
SCREE_FN void scree_place_particles_at(scree_place_particles_args a, int64_t i)
{
    a.bodies.pose[i].position = a.particles.position[i];
    a.bodies.pose[i].orientation = a.particles.orientation[i];
    a.bodies.pose[i].scale = a.particles.scale[i];
    a.bodies.moving[i].velocity = a.particles.velocity[i];
    a.bodies.moving[i].angular_velocity =
        scree_angular_velocity(a.particles.angular_momentum[i], a.particles.inertia[i], a.particles.orientation[i]);
}

#endif
