/// \file simulation.c
/// The step, from above.
#include "dynamics/dynamics.h"
#include "dynamics/step_buffers.h"

#include <math.h>

/// First half kick and drift of the particles; the walls follow their prescribed motion.
static void predict(scree_simulation *s)
{
    scree_predict_args args;
    args.particles = s->particles;
    args.time_step = (scree_real)s->time_step;
    args.pose = s->buffers->pose;
    args.velocity = s->buffers->velocity;
    args.angular_velocity = s->buffers->angular_velocity;
    scree_predict_launch(args, s->particles.num_particles);
    scree_place_walls(s, (double)s->step * s->time_step);
}

/// Second half kick.
static void correct(scree_simulation *s)
{
    scree_correct_args args;
    args.particles = s->particles;
    args.time_step = (scree_real)s->time_step;
    args.velocity = s->buffers->velocity;
    args.angular_velocity = s->buffers->angular_velocity;
    scree_correct_launch(args, s->particles.num_particles);
}

/// The first particle whose position or momentum is not a finite number, or -1.
static int64_t find_unstable(const scree_particles *particles)
{
    int64_t first = INT64_MAX;
#pragma omp parallel for schedule(static) reduction(min : first) if (particles->num_particles >= 4096)
    for (int64_t i = 0; i < particles->num_particles; ++i)
    {
        const scree_vec3 x = particles->position[i], l = particles->angular_momentum[i];
        const double sum = (double)(x.x + x.y + x.z + l.x + l.y + l.z);
        if (!isfinite(sum) && i < first) first = i;
    }
    return first == INT64_MAX ? -1 : first;
}

/// In checked builds the contacts of every step are walked over; elsewhere nothing.
static scree_status check_contacts(const scree_simulation *s, scree_report *report)
{
#ifdef SCREE_CHECKED
    return scree_contact_list_validate(&s->contacts, report) ? SCREE_OK : SCREE_UNSTABLE;
#else
    (void)s;
    (void)report;
    return SCREE_OK;
#endif
}

scree_status scree_simulation_step(scree_simulation *simulation, scree_report *report)
{
    ++simulation->step;
    scree_stage_begin(&simulation->clock);
    predict(simulation);
    scree_stage_end(&simulation->clock, SCREE_STAGE_PREDICT);
    scree_status status = scree_update_neighbours(simulation);
    if (status == SCREE_OK) status = scree_update_contacts(simulation);
    if (status == SCREE_OK) status = check_contacts(simulation, report);
    scree_stage_end(&simulation->clock, SCREE_STAGE_OTHER);
    if (status == SCREE_OK) status = scree_update_forces(simulation);
    if (status == SCREE_OK)
    {
        correct(simulation);
        scree_stage_end(&simulation->clock, SCREE_STAGE_CORRECT);
        status = scree_account_work(simulation);
        scree_stage_end(&simulation->clock, SCREE_STAGE_WORK);
        if (status == SCREE_OK) status = scree_account_wall_loads(simulation);
        if (status == SCREE_OK) status = scree_update_averages(simulation);
    }
    const int64_t unstable = status == SCREE_OK ? find_unstable(&simulation->particles) : -1;
    scree_stage_end(&simulation->clock, SCREE_STAGE_OTHER);
    if (unstable >= 0)
    {
        scree_report_add(report,
                         "particle %lld has left the range of numbers at t = %g s; the time step of %g s is too long "
                         "for its contacts (critical: %g s): choose a smaller time.step",
                         (long long)unstable, (double)simulation->step * simulation->time_step, simulation->time_step,
                         simulation->counters.smallest_critical_step);
        status = SCREE_UNSTABLE;
    }
    else if (status != SCREE_OK)
        scree_report_add(report, "step %lld: %s", (long long)simulation->step, scree_status_text(status));
    // after a failure inside a step the state is half done: it can only be destroyed
    return status == SCREE_OK ? SCREE_OK : SCREE_UNSTABLE;
}
