/// \file integrator_cpu.c
/// Motion of particles on the CPU. Those that turn alike about all axes, spheres among them, are worked on in groups of
/// lanes (lanes.h); all others one by one.
#include "core/lanes.h"
#include "dynamics/dynamics.h"

SCREE_DEFINE_LAUNCH_ON(scree_predict)
SCREE_DEFINE_LAUNCH_ON(scree_correct)

typedef struct scree_particle_group
{
    scree_lanes_vec3 position, velocity, angular_momentum, force, torque, inertia;
    scree_lanes_vec3 turn_wxy, turn_xyz; ///< parts of the orientation, as they lie in memory before and after
    scree_real turn_z[SCREE_LANES], turn_w[SCREE_LANES];
    scree_real mass[SCREE_LANES];
    scree_lanes_vec3 end_velocity, end_angular_velocity;
} scree_particle_group;

static void load_group(scree_particle_group *restrict g, const scree_particles *restrict particles, int64_t first)
{
    scree_lanes_load(&g->position, particles->position + first);
    scree_lanes_load(&g->velocity, particles->velocity + first);
    scree_lanes_load(&g->angular_momentum, particles->angular_momentum + first);
    scree_lanes_load(&g->force, particles->force + first);
    scree_lanes_load(&g->torque, particles->torque + first);
    scree_lanes_copy(g->mass, particles->mass + first);
}

static bool load_isotropic(scree_particle_group *g, const scree_particles *particles, int64_t first)
{
    scree_lanes_load(&g->inertia, particles->inertia + first);
    scree_real is_other[SCREE_LANES];
    for (int l = 0; l < SCREE_LANES; ++l) is_other[l] = scree_is_isotropic(scree_lanes_get(&g->inertia, l)) ? 0 : 1;
    return scree_lanes_is_none(is_other);
}

static void store_velocities(const scree_particle_group *g, scree_moving_body *moving)
{
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        moving[l].velocity = scree_lanes_get(&g->end_velocity, l);
        moving[l].angular_velocity = scree_lanes_get(&g->end_angular_velocity, l);
    }
}

/// What scree_add_way() does.
static void add_ways(const scree_predict_args *a, const scree_particle_group *g, int64_t first)
{
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_vec3 turn = scree_lanes_get(&g->turn_xyz, l);
        const scree_pose pose = {scree_lanes_get(&g->position, l),
                                 scree_quat_make(g->turn_w[l], turn.x, turn.y, turn.z), a->particles.scale[first + l]};
        scree_add_way(&a->ways, first + l, a->pose + first + l, &pose);
    }
}

/// False: not all of them are isotropic, and nothing was done.
SCREE_LANES_FUNCTION static bool predict_group(const scree_predict_args *a, int64_t first)
{
    const scree_particles particles = a->particles;
    scree_particle_group g;
    if (!load_isotropic(&g, &particles, first)) return false;
    load_group(&g, &particles, first);
    const int64_t size = sizeof *particles.orientation;
    scree_lanes_gather(&g.turn_wxy, g.turn_z, particles.orientation + first, size, scree_lanes_in_order);
    const scree_real time_step = a->time_step;
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_quat orientation = {g.turn_wxy.x[l], g.turn_wxy.y[l], g.turn_wxy.z[l], g.turn_z[l]};
        scree_moving_state state = {scree_lanes_get(&g.position, l), orientation, scree_lanes_get(&g.velocity, l),
                                    scree_lanes_get(&g.angular_momentum, l)};
        const scree_load load = {scree_lanes_get(&g.force, l), scree_lanes_get(&g.torque, l), g.mass[l],
                                 scree_lanes_get(&g.inertia, l)};
        const scree_velocities end = scree_half_kick_and_drift(&state, &load, true, time_step);
        scree_lanes_set(&g.position, l, state.position);
        scree_lanes_set(&g.velocity, l, state.velocity);
        scree_lanes_set(&g.angular_momentum, l, state.angular_momentum);
        const scree_quat q = state.orientation;
        scree_lanes_set(&g.turn_wxy, l, scree_vec3_make(q.w, q.x, q.y));
        scree_lanes_set(&g.turn_xyz, l, scree_vec3_make(q.x, q.y, q.z));
        g.turn_z[l] = q.z;
        g.turn_w[l] = q.w;
        scree_lanes_set(&g.end_velocity, l, end.velocity);
        scree_lanes_set(&g.end_angular_velocity, l, end.angular_velocity);
    }
    scree_lanes_store(particles.position + first, &g.position);
    scree_lanes_store(particles.velocity + first, &g.velocity);
    scree_lanes_store(particles.angular_momentum + first, &g.angular_momentum);
    scree_lanes_scatter(particles.orientation + first, size, &g.turn_wxy, g.turn_z);
    if (a->ways.travel != NULL) add_ways(a, &g, first);
    scree_pose *pose = a->pose + first;
    scree_lanes_scatter(&pose->position, sizeof *pose, &g.position, g.turn_w);
    scree_lanes_scatter(&pose->orientation.x, sizeof *pose, &g.turn_xyz, particles.scale + first);
    store_velocities(&g, a->moving + first);
    return true;
}

/// False: not all of them are isotropic and finite, and nothing was done.
SCREE_LANES_FUNCTION static bool correct_group(const scree_correct_args *a, int64_t first)
{
    const scree_particles particles = a->particles;
    scree_particle_group g;
    if (!load_isotropic(&g, &particles, first)) return false;
    load_group(&g, &particles, first);
    const scree_real time_step = a->time_step;
    scree_real sums[SCREE_LANES];
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        scree_moving_state state;
        state.position = scree_lanes_get(&g.position, l);
        state.velocity = scree_lanes_get(&g.velocity, l);
        state.angular_momentum = scree_lanes_get(&g.angular_momentum, l);
        const scree_load load = {scree_lanes_get(&g.force, l), scree_lanes_get(&g.torque, l), g.mass[l],
                                 scree_lanes_get(&g.inertia, l)};
        scree_second_half_kick(&state, &load, time_step);
        scree_lanes_set(&g.end_velocity, l, state.velocity);
        scree_lanes_set(&g.angular_momentum, l, state.angular_momentum);
        scree_lanes_set(&g.end_angular_velocity, l, scree_vec3_scale(state.angular_momentum, 1 / load.inertia.x));
        sums[l] = scree_sum_of_state(&state);
    }
    scree_real is_other[SCREE_LANES];
    for (int l = 0; l < SCREE_LANES; ++l) is_other[l] = sums[l] - sums[l] == 0 ? 0 : 1;
    if (!scree_lanes_is_none(is_other)) return false;
    scree_lanes_store(particles.velocity + first, &g.end_velocity);
    scree_lanes_store(particles.angular_momentum + first, &g.angular_momentum);
    store_velocities(&g, a->moving + first);
    return true;
}

void scree_predict_launch(scree_predict_args args, int64_t num)
{
    const int64_t num_groups = (num + SCREE_LANES - 1) / SCREE_LANES;
#pragma omp parallel for schedule(static) if (num >= SCREE_LAUNCH_MIN)
    for (int64_t k = 0; k < num_groups; ++k)
    {
        const int64_t first = k * SCREE_LANES, end = first + SCREE_LANES < num ? first + SCREE_LANES : num;
        if (end - first == SCREE_LANES && predict_group(&args, first)) continue;
        for (int64_t i = first; i < end; ++i) scree_predict_at(args, i);
    }
}

void scree_correct_launch(scree_correct_args args, int64_t num)
{
    const int64_t num_groups = (num + SCREE_LANES - 1) / SCREE_LANES;
#pragma omp parallel for schedule(static) if (num >= SCREE_LAUNCH_MIN)
    for (int64_t k = 0; k < num_groups; ++k)
    {
        const int64_t first = k * SCREE_LANES, end = first + SCREE_LANES < num ? first + SCREE_LANES : num;
        if (end - first == SCREE_LANES && correct_group(&args, first)) continue;
        for (int64_t i = first; i < end; ++i) scree_correct_at(args, i);
    }
}
