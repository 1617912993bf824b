#include "dynamics/wall_loads.h"
#include "dynamics/step_buffers.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

scree_status scree_wall_loads_create(scree_wall_loads *loads, int64_t num_walls)
{
    const size_t num = (size_t)num_walls + 1;
    *loads = (scree_wall_loads){.num_walls = num_walls};
    loads->load = calloc(num, sizeof *loads->load);
    loads->work = calloc(num, sizeof *loads->work);
    loads->marked_work = calloc(num, sizeof *loads->marked_work);
    loads->marked_step = calloc(num, sizeof *loads->marked_step);
    loads->revolution_power = calloc(num, sizeof *loads->revolution_power);
    const bool is_complete = loads->load != NULL && loads->work != NULL && loads->marked_work != NULL &&
                             loads->marked_step != NULL && loads->revolution_power != NULL;
    if (!is_complete) scree_wall_loads_destroy(loads);
    return is_complete ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

void scree_wall_loads_destroy(scree_wall_loads *loads)
{
    free(loads->load);
    free(loads->work);
    free(loads->marked_work);
    free(loads->marked_step);
    free(loads->revolution_power);
    *loads = (scree_wall_loads){0};
}

int64_t scree_wall_revolutions(const scree_wall_def *def, double time)
{
    const scree_motion_def *motion = &def->motion;
    if (motion->kind != SCREE_MOTION_ROTATE || time <= motion->start) return 0;
    const double seconds = fmin(time, motion->end) - motion->start;
    // the step that ends a revolution up to rounding counts
    return (int64_t)floor(fabs(motion->angular_velocity) * seconds / (2 * PI) * (1 + 1e-12));
}

static scree_vec3 unit_from(const double v[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return scree_vec3_make((scree_real)(v[0] / length), (scree_real)(v[1] / length), (scree_real)(v[2] / length));
}

/// Of the wall that is number `body` among all bodies.
static scree_wall_axis axis_of(const scree_wall_def *def, int64_t body)
{
    const scree_motion_def *motion = &def->motion;
    scree_wall_axis axis;
    axis.body = (int32_t)body;
    axis.is_rotating = motion->kind == SCREE_MOTION_ROTATE;
    axis.direction = unit_from(axis.is_rotating ? motion->axis : motion->velocity);
    axis.centre =
        scree_vec3_make((scree_real)motion->centre[0], (scree_real)motion->centre[1], (scree_real)motion->centre[2]);
    return axis;
}

/// How fast the wall moves along its motion now: [rad/s] or [m/s].
static double rate_of(const scree_simulation *s, int32_t wall, const scree_wall_axis *axis)
{
    const scree_wall_state *state = s->walls + wall;
    return (double)scree_vec3_dot(axis->is_rotating ? state->angular_velocity : state->velocity, axis->direction);
}

static int64_t count_parts(const scree_simulation *s)
{
    return scree_count_blocks(s->particles.num_particles, SCREE_WALL_LOAD_BLOCK);
}

void scree_sum_wall_loads(scree_simulation *simulation)
{
    const scree_simulation *s = simulation;
    const scree_step_buffers *b = s->buffers;
    const int64_t num_moving = b->num_moving_walls;
    if (num_moving == 0) return;
    int64_t num_parts = count_parts(s);
    scree_wall_load_args args;
    args.contacts = scree_contact_list_view(&s->contacts);
    args.pairs = s->broad_phase.pairs;
    args.row_begin = s->broad_phase.row_begin;
    args.row_pairs = s->broad_phase.row_pairs;
    args.ids = scree_ids(s);
    args.pose = b->pose;
    args.axes = b->wall_axes;
    args.num_moving = num_moving;
    args.sums = b->load_sums;
    scree_wall_load_launch_on(s->device, args, num_parts * num_moving);

    // in groups of always the same ones, until one is left
    scree_wall_load_reduce_args reduce = {b->load_sums, num_parts, num_moving, NULL};
    for (int64_t num_sums = 0; num_sums != 1;)
    {
        num_sums = reduce.num_parts > 1 ? scree_count_blocks(reduce.num_parts, SCREE_SUM_FAN_IN) : 1;
        reduce.sums = num_sums > 1 ? b->load_sums + num_parts * num_moving : scree_board_loads(b->board);
        scree_wall_load_reduce_launch_on(s->device, reduce, num_sums * num_moving);
        reduce.parts = reduce.sums;
        reduce.num_parts = num_sums;
        num_parts += num_sums;
    }
}

/// Closes a revolution that this step has completed.
static void mark_revolution(scree_simulation *s, int32_t w)
{
    const scree_wall_def *def = s->scene->walls + w;
    scree_wall_loads *loads = &s->wall_loads;
    const double time = (double)s->step * s->time_step;
    const bool is_done = scree_wall_revolutions(def, time) > scree_wall_revolutions(def, time - s->time_step);
    if (!is_done && time > def->motion.start) return;
    if (is_done)
        loads->revolution_power[w] =
            (loads->work[w] - loads->marked_work[w]) / ((double)(s->step - loads->marked_step[w]) * s->time_step);
    loads->marked_work[w] = loads->work[w];
    loads->marked_step[w] = s->step;
}

void scree_account_wall_loads(scree_simulation *simulation)
{
    const scree_step_buffers *b = simulation->buffers;
    for (int32_t w = 0; w < simulation->num_walls; ++w)
    {
        if (b->moving_wall_here[w] < 0) continue;
        const double rate = rate_of(simulation, w, b->wall_axes_here + b->moving_wall_here[w]);
        simulation->wall_loads.work[w] += simulation->wall_loads.load[w] * rate * simulation->time_step;
        mark_revolution(simulation, w);
    }
}

scree_status scree_wall_axes_create(scree_simulation *simulation)
{
    scree_step_buffers *b = simulation->buffers;
    const int64_t num = simulation->num_walls;
    b->moving_wall_here = calloc((size_t)num + 1, sizeof *b->moving_wall_here);
    b->wall_axes_here = calloc((size_t)num + 1, sizeof *b->wall_axes_here);
    b->wall_axes = scree_device_alloc(simulation->device, num + 1, sizeof *b->wall_axes);
    if (b->moving_wall_here == NULL || b->wall_axes_here == NULL || b->wall_axes == NULL) return SCREE_OUT_OF_MEMORY;
    for (int32_t w = 0; w < simulation->num_walls; ++w)
    {
        const scree_wall_def *def = simulation->scene->walls + w;
        b->moving_wall_here[w] = -1;
        if (def->motion.kind == SCREE_MOTION_FIXED) continue;
        b->wall_axes_here[b->num_moving_walls] = axis_of(def, simulation->particles.num_particles + w);
        b->moving_wall_here[w] = b->num_moving_walls++;
    }
    scree_device_write(simulation->device, b->wall_axes, b->wall_axes_here, (size_t)num * sizeof *b->wall_axes);
    // sums of sums, down to one, take less than a 255th of them
    const int64_t num_parts = count_parts(simulation);
    const int64_t num_sums = (num_parts + num_parts / (SCREE_SUM_FAN_IN - 1) + 8) * b->num_moving_walls;
    b->load_sums = scree_device_alloc(simulation->device, num_sums + 1, sizeof *b->load_sums);
    return b->load_sums != NULL ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

scree_wall_load scree_simulation_wall_load(const scree_simulation *simulation, int32_t wall)
{
    scree_wall_load load = {0};
    if (wall < 0 || wall >= simulation->wall_loads.num_walls) return load;
    load.load = simulation->wall_loads.load[wall];
    load.work = simulation->wall_loads.work[wall];
    load.num_revolutions = scree_wall_revolutions(simulation->scene->walls + wall, scree_simulation_time(simulation));
    load.revolution_power = simulation->wall_loads.revolution_power[wall];
    return load;
}
