/// \file simulation.c
/// The step, from above.
#include "dynamics/dynamics.h"
#include "dynamics/on_device.h"
#include "dynamics/step_buffers.h"

void scree_predict_motion(scree_simulation *simulation)
{
    scree_device_branch(simulation->device, 1);
    scree_place_walls(simulation);
    scree_device_branch(simulation->device, 0);
    scree_predict_args args;
    args.particles = simulation->particles;
    args.time_step = (scree_real)simulation->time_step;
    args.ways = scree_step_ways(simulation);
    args.pose = simulation->buffers->pose;
    args.moving = simulation->buffers->moving;
    scree_predict_launch_on(simulation->device, args, simulation->particles.num_particles);
    scree_device_join(simulation->device);
}

void scree_correct_motion(scree_simulation *simulation)
{
    scree_correct_args args;
    args.particles = simulation->particles;
    args.time_step = (scree_real)simulation->time_step;
    args.moving = simulation->buffers->moving;
    args.ids = scree_ids(simulation);
    args.tally = simulation->buffers->tally;
    scree_correct_launch_on(simulation->device, args, simulation->particles.num_particles);
}

/// In checked builds the contacts of every step are walked over; elsewhere nothing.
static scree_status check_contacts(const scree_simulation *s, scree_report *report)
{
#ifdef SCREE_CHECKED
    if (s->device != NULL) return SCREE_OK;
    return scree_contact_list_validate(&s->contacts, scree_ids(s), report) ? SCREE_OK : SCREE_UNSTABLE;
#else
    (void)s;
    (void)report;
    return SCREE_OK;
#endif
}

/// The step from where its recording halted, call by call.
static scree_status advance_from(scree_simulation *s, scree_halt halt, scree_report *report)
{
    // room is made at searches
    bool is_search_due = halt == SCREE_HALT_SEARCH || halt == SCREE_HALT_ROOM;
    if (halt == SCREE_HALT_START)
    {
        scree_predict_motion(s);
        scree_stage_end(&s->clock, SCREE_STAGE_PREDICT);
        is_search_due = scree_is_search_due(s);
        scree_stage_end(&s->clock, SCREE_STAGE_TRAVEL);
    }
    if (is_search_due) scree_change_places(s);
    scree_status status = is_search_due ? scree_search_neighbours(s) : SCREE_OK;
    if (status == SCREE_OK) status = scree_update_contacts(s);
    if (status == SCREE_OK) status = check_contacts(s, report);
    scree_stage_end(&s->clock, SCREE_STAGE_OTHER);
    if (status != SCREE_OK) return status;
    scree_update_forces(s);
    scree_gather_forces(s);
    scree_correct_motion(s);
    scree_stage_end(&s->clock, SCREE_STAGE_CORRECT);
    scree_sum_work(s);
    scree_fetch_board(s);
    scree_device_wait(s->device);
    scree_stage_end(&s->clock, SCREE_STAGE_WORK);
    return SCREE_OK;
}

/// One step where the arrays are, but for averages. On the CPU nothing is recorded, and it starts at its start.
static scree_status advance(scree_simulation *s, scree_report *report)
{
    ++s->step;
    scree_stage_begin(&s->clock);
    // the walls follow their prescribed motion
    scree_move_walls(s, (double)s->step * s->time_step);
    const scree_halt halt = scree_play_step(s);
    const scree_status status = halt != SCREE_HALT_NONE ? advance_from(s, halt, report) : SCREE_OK;
    if (status != SCREE_OK) return status;
    scree_take_board(s);
    scree_account_wall_loads(s);
    return SCREE_OK;
}

/// What went wrong in the step of `s`, to the report. A failed device comes first: nothing it said counts.
static scree_status tell_fault(const scree_simulation *s, scree_status status, scree_report *report)
{
    const scree_status state_of_device = scree_device_status(s->device, report);
    if (state_of_device != SCREE_OK) return state_of_device;
    const int64_t unstable = status == SCREE_OK ? s->buffers->first_unstable : -1;
    if (unstable >= 0)
    {
        scree_report_add(report,
                         "particle %lld has left the range of numbers at t = %g s; the time step of %g s is too long "
                         "for its contacts (critical: %g s): choose a smaller time.step",
                         (long long)unstable, (double)s->step * s->time_step, s->time_step,
                         s->counters.smallest_critical_step);
        return SCREE_UNSTABLE;
    }
    if (status == SCREE_OUT_OF_MEMORY && s->device != NULL)
        scree_report_add(report,
                         "step %lld: GPU \"%s\" has no memory for %lld candidate pairs and %lld contacts (%.0f MB are "
                         "free, in pieces): go on from the last checkpoint on another GPU or on the CPU",
                         (long long)s->step, scree_device_name(s->device), (long long)s->counters.num_pairs,
                         (long long)s->counters.num_contacts, (double)scree_device_free_memory(s->device) / 1e6);
    else if (status != SCREE_OK)
        scree_report_add(report, "step %lld: %s", (long long)s->step, scree_status_text(status));
    // after a failure inside a step the state is half done: it can only be destroyed
    return status == SCREE_OK || status == SCREE_OUT_OF_MEMORY ? status : SCREE_UNSTABLE;
}

scree_status scree_simulation_step(scree_simulation *simulation, scree_report *report)
{
    scree_simulation *there = scree_simulation_there(simulation);
    scree_status status = advance(there, report);
    if (there != simulation) scree_take_from_device(simulation);
    if (status == SCREE_OK) status = scree_update_averages(simulation, report);
    status = tell_fault(there, status, report);
    scree_stage_end(&there->clock, SCREE_STAGE_OTHER);
    return status;
}
