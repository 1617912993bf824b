#define _DEFAULT_SOURCE /* M_PI */
#include "dynamics/step_buffers.h"
#include "core/buffer.h"
#include "dynamics/dynamics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/// Zeroed memory in whole cache lines.
static void *zeros(size_t num_bytes)
{
    void *memory = scree_buffer_alloc(1, num_bytes);
    if (memory != NULL) memset(memory, 0, num_bytes);
    return memory;
}

scree_status scree_step_board_create(scree_step_buffers *buffers, int64_t num_particles, int64_t num_walls)
{
    scree_step_buffers *b = buffers;
    const size_t num_bytes = scree_board_bytes(num_walls), num = (size_t)num_walls + 1;
    b->board = scree_device_alloc(b->device, 1, num_bytes);
    b->board_here = scree_device_alloc_host(b->device, num_bytes);
    b->wall_motion = scree_device_alloc(b->device, (int64_t)num, sizeof *b->wall_motion);
    b->wall_motion_here = scree_device_alloc_host(b->device, num * sizeof *b->wall_motion_here);
    b->live_here = scree_device_alloc_host(b->device, sizeof *b->live_here);
    // sums of sums, down to one, take less than a 255th of them
    const int64_t num_blocks = scree_count_blocks(num_particles, SCREE_WORK_BLOCK);
    const int64_t num_sums = num_blocks + num_blocks / (SCREE_SUM_FAN_IN - 1) + 8;
    b->work_sums = scree_device_alloc(b->device, num_sums, sizeof *b->work_sums);
    if (b->board == NULL || b->board_here == NULL || b->wall_motion == NULL || b->wall_motion_here == NULL ||
        b->live_here == NULL || b->work_sums == NULL)
        return SCREE_OUT_OF_MEMORY;
    scree_device_zero(b->device, b->board, num_bytes);
    b->tally = &b->board->tally;
    return SCREE_OK;
}

scree_status scree_step_buffers_create(scree_simulation *simulation)
{
    const size_t num_particles = (size_t)simulation->particles.num_particles;
    const size_t num_walls = (size_t)simulation->num_walls, num_bodies = num_particles + num_walls;
    scree_step_buffers *b = calloc(1, sizeof *b);
    if (b == NULL) return SCREE_OUT_OF_MEMORY;
    simulation->buffers = b;
    bool is_complete = true;
#define SCREE_ALLOCATE(array, num)                    \
    b->array = zeros(((num) + 1) * sizeof *b->array); \
    is_complete = is_complete && b->array != NULL;
    SCREE_ALLOCATE(pose, num_bodies)
    SCREE_ALLOCATE(moving, num_bodies)
    SCREE_ALLOCATE(inverse_radius, num_bodies)
    SCREE_ALLOCATE(shape, num_bodies)
    SCREE_ALLOCATE(searched_pose, num_bodies)
    SCREE_ALLOCATE(travel, num_bodies)
    SCREE_ALLOCATE(old_groups, 2 * num_bodies)
    SCREE_ALLOCATE(broad_phase_walls, num_walls)
    SCREE_ALLOCATE(wall_input, num_walls)
#undef SCREE_ALLOCATE
    // the simulation's destroy frees what there is
    if (!is_complete ||
        scree_step_board_create(b, simulation->particles.num_particles, simulation->num_walls) != SCREE_OK)
        return SCREE_OUT_OF_MEMORY;

    for (size_t i = 0; i < num_particles; ++i)
    {
        b->moving[i].inverse_mass = 1 / simulation->particles.mass[i];
        b->inverse_radius[i] = (scree_real)(1 / equal_volume_radius(simulation, i));
        b->shape[i] = simulation->particles.shape[i];
        b->moving[i].material = simulation->particles.material[i];
        b->mean_radius += particle_bounding_radius(simulation, i) / (double)num_particles;
        b->has_travel |= simulation->shape_views[b->shape[i]].kind == SCREE_KIND_MESH;
    }
    for (size_t w = 0; w < num_walls; ++w)
    {
        b->shape[num_particles + w] = simulation->num_shapes + simulation->walls[w].shape;
        b->moving[num_particles + w].material = simulation->walls[w].material;
        b->wall_input[w].tree = simulation->shape_views[b->shape[num_particles + w]].tree;
    }
    scree_places_start(simulation);
    return SCREE_OK;
}

void scree_step_buffers_destroy(scree_simulation *simulation)
{
    scree_step_buffers *b = simulation->buffers;
    if (b == NULL) return;
    scree_device *device = b->device;
    void *const arrays[] = {b->pose,          b->moving,    b->shape,       b->inverse_radius,
                            b->searched_pose, b->travel,    b->wall_axes,   b->broad_phase_walls,
                            b->work_sums,     b->load_sums, b->old_groups,  b->old_of_contact,
                            b->is_continued,  b->sides,     b->wall_motion, b->board};
    for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; ++k) scree_device_free(device, arrays[k]);
    scree_places_destroy(&b->places, device);
    scree_forget_recordings(b);
    scree_device_free_host(device, b->board_here);
    scree_device_free_host(device, b->wall_motion_here);
    scree_device_free_host(device, b->live_here);
    free(b->wall_input);
    free(b->moving_wall_here);
    free(b->wall_axes_here);
    free(b);
    simulation->buffers = NULL;
}

static scree_body_arrays body_arrays(const scree_step_buffers *b)
{
    const scree_body_arrays arrays = {b->pose, b->moving};
    return arrays;
}

void scree_move_walls(scree_simulation *simulation, double time)
{
    for (int32_t w = 0; w < simulation->num_walls; ++w)
    {
        scree_wall_state *wall = simulation->walls + w;
        scree_wall_motion *motion = simulation->buffers->wall_motion_here + w;
        scree_wall_state_at(simulation->scene->walls + w, time, wall);
        const scree_vec3 offset = scree_vec3_sub(wall->pose.position, wall->centre);
        motion->pose = wall->pose;
        motion->velocity = scree_vec3_add(wall->velocity, scree_vec3_cross(wall->angular_velocity, offset));
        motion->angular_velocity = wall->angular_velocity;
    }
}

scree_ways scree_step_ways(const scree_simulation *simulation)
{
    const scree_step_buffers *b = simulation->buffers;
    const scree_ways ways = {simulation->shape_views, b->shape, b->has_travel ? b->travel : NULL};
    return ways;
}

void scree_place_walls(scree_simulation *simulation)
{
    const scree_step_buffers *b = simulation->buffers;
    const size_t num = (size_t)simulation->num_walls;
    scree_device_send(simulation->device, b->wall_motion, b->wall_motion_here, num * sizeof *b->wall_motion);
    const scree_place_walls_args args = {body_arrays(b), scree_step_ways(simulation),
                                         simulation->particles.num_particles, b->wall_motion};
    scree_place_walls_launch_on(simulation->device, args, simulation->num_walls);
}

void scree_place_particles(scree_simulation *simulation)
{
    const scree_place_particles_args args = {body_arrays(simulation->buffers), simulation->particles};
    scree_place_particles_launch_on(simulation->device, args, simulation->particles.num_particles);
}
