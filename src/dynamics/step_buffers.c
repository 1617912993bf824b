#define _DEFAULT_SOURCE /* M_PI */
#include "dynamics/step_buffers.h"

#include <math.h>
#include <stdlib.h>

/// Radius of the sphere of the particle's volume.
static double equal_volume_radius(const scree_simulation *simulation, size_t i)
{
    const scree_particles *particles = &simulation->particles;
    const scree_shape *shape = simulation->particle_shapes + particles->shape[i];
    return cbrt(3 * shape->properties.volume / (4 * M_PI)) * (double)particles->scale[i];
}

static double particle_bounding_radius(const scree_simulation *simulation, size_t i)
{
    const scree_particles *particles = &simulation->particles;
    return simulation->particle_shapes[particles->shape[i]].properties.bounding_radius * (double)particles->scale[i];
}

scree_status scree_step_buffers_create(scree_simulation *simulation)
{
    const size_t num_particles = (size_t)simulation->particles.num_particles;
    const size_t num_walls = (size_t)simulation->num_walls, num_bodies = num_particles + num_walls;
    scree_step_buffers *b = calloc(1, sizeof *b);
    if (b == NULL) return SCREE_OUT_OF_MEMORY;
    simulation->buffers = b;
    bool is_complete = true;
#define SCREE_ALLOCATE(array, num)                  \
    b->array = calloc((num) + 1, sizeof *b->array); \
    is_complete = is_complete && b->array != NULL;
    SCREE_ALLOCATE(pose, num_bodies)
    SCREE_ALLOCATE(velocity, num_bodies)
    SCREE_ALLOCATE(angular_velocity, num_bodies)
    SCREE_ALLOCATE(inverse_mass, num_bodies)
    SCREE_ALLOCATE(inverse_radius, num_bodies)
    SCREE_ALLOCATE(shape, num_bodies)
    SCREE_ALLOCATE(material, num_bodies)
    SCREE_ALLOCATE(searched_pose, num_bodies)
    SCREE_ALLOCATE(last_pose, num_bodies)
    SCREE_ALLOCATE(travel, num_bodies)
    SCREE_ALLOCATE(boxes, num_particles)
    SCREE_ALLOCATE(centres, num_particles)
    SCREE_ALLOCATE(radii, num_particles)
    SCREE_ALLOCATE(broad_phase_walls, num_walls)
#undef SCREE_ALLOCATE
    if (!is_complete) return SCREE_OUT_OF_MEMORY; // the simulation's destroy frees what there is

    for (size_t i = 0; i < num_particles; ++i)
    {
        b->inverse_mass[i] = 1 / simulation->particles.mass[i];
        b->inverse_radius[i] = (scree_real)(1 / equal_volume_radius(simulation, i));
        b->shape[i] = simulation->particles.shape[i];
        b->material[i] = simulation->particles.material[i];
        b->mean_radius += particle_bounding_radius(simulation, i) / (double)num_particles;
        b->has_travel |= simulation->shape_views[b->shape[i]].kind == SCREE_KIND_MESH;
    }
    for (size_t w = 0; w < num_walls; ++w)
    {
        b->shape[num_particles + w] = simulation->num_shapes + simulation->walls[w].shape;
        b->material[num_particles + w] = simulation->walls[w].material;
    }
    return SCREE_OK;
}

void scree_step_buffers_destroy(scree_simulation *simulation)
{
    scree_step_buffers *b = simulation->buffers;
    if (b == NULL) return;
    free(b->pose);
    free(b->velocity);
    free(b->angular_velocity);
    free(b->inverse_mass);
    free(b->inverse_radius);
    free(b->shape);
    free(b->material);
    free(b->searched_pose);
    free(b->last_pose);
    free(b->travel);
    free(b->boxes);
    free(b->centres);
    free(b->radii);
    free(b->broad_phase_walls);
    free(b->moving_wall);
    free(b->wall_axes);
    free(b->old_of_contact);
    free(b->is_continued);
    free(b->work_sums);
    free(b);
    simulation->buffers = NULL;
}

void scree_place_walls(scree_simulation *simulation, double time)
{
    scree_step_buffers *b = simulation->buffers;
    const int64_t num_particles = simulation->particles.num_particles;
    for (int32_t w = 0; w < simulation->num_walls; ++w)
    {
        scree_wall_state *wall = simulation->walls + w;
        scree_wall_state_at(simulation->scene->walls + w, time, wall);
        const scree_vec3 offset = scree_vec3_sub(wall->pose.position, wall->centre);
        b->pose[num_particles + w] = wall->pose;
        b->velocity[num_particles + w] =
            scree_vec3_add(wall->velocity, scree_vec3_cross(wall->angular_velocity, offset));
        b->angular_velocity[num_particles + w] = wall->angular_velocity;
    }
}

void scree_place_particles(scree_simulation *simulation)
{
    scree_step_buffers *b = simulation->buffers;
    const scree_particles *particles = &simulation->particles;
    for (int64_t i = 0; i < particles->num_particles; ++i)
    {
        b->pose[i].position = particles->position[i];
        b->pose[i].orientation = particles->orientation[i];
        b->pose[i].scale = particles->scale[i];
        b->velocity[i] = particles->velocity[i];
        b->angular_velocity[i] =
            scree_angular_velocity(particles->angular_momentum[i], particles->inertia[i], particles->orientation[i]);
    }
}
