/// \file recorded_step.c
/// Steps between two searches on a GPU. Their calls are the same each time but for numbers that the host would wait
/// for: how far bodies have moved, how many contacts there are. So the calls are recorded (device.h) with room for some
/// more contacts, while both lists count as full; when they are played, launches look the numbers up on the device, and
/// the host waits once, at the end. If a search is due, or room is lacking and it is due for that, the rest of the
/// recording does nothing, and the step goes on from there call by call, as on the CPU.
#include "contact/narrow_phase.h"
#include "dynamics/dynamics.h"
#include "dynamics/step_buffers.h"

#include <string.h>

static void set_numbers(scree_simulation *s, int64_t num_contacts, int64_t num_old)
{
    s->contacts.num_contacts = num_contacts;
    s->old_contacts.num_contacts = num_old;
}

/// Is the step one that can be recorded, as far as is known beforehand?
static bool is_steady(const scree_simulation *s)
{
    const scree_step_buffers *b = s->buffers;
    // stages are only told apart call by call
    return scree_device_records(s->device) && s->clock.times == NULL && s->scene->solver.reuse_pairs && b->has_pairs &&
           !b->is_search_asked && b->is_old_list_of_same_pairs && !scree_have_walls_changed(s);
}

/// All calls of a step, with lists that count as full.
static bool record(scree_simulation *s, scree_recording **recording)
{
    scree_step_buffers *b = s->buffers;
    const int64_t num_old = s->old_contacts.num_contacts;
    set_numbers(s, b->max_recorded, b->max_recorded);
    scree_device_record(s->device, &b->board->live);
    scree_device_send(s->device, &b->board->live, b->live_here, sizeof *b->live_here);
    scree_predict_motion(s);
    scree_follow_bodies(s);
    const scree_skin_args skin = {&b->tally->particles_moved, &b->tally->walls_moved, b->skin, &b->board->live};
    scree_skin_launch_on(s->device, skin, 1);
    scree_update_contacts_again(s);
    scree_update_forces(s);
    scree_gather_forces(s);
    scree_correct_motion(s);
    scree_sum_work(s);
    scree_fetch_board(s);
    set_numbers(s, 0, num_old);
    return scree_device_end_record(s->device, recording);
}

/// Plays a recording and waits for what it leaves on the board. Returns where it halted.
static scree_halt play(const scree_simulation *s, const scree_recording *recording)
{
    const scree_step_buffers *b = s->buffers;
    memset(b->live_here, 0, sizeof *b->live_here);
    b->live_here->num_steps = s->step - b->searched_step;
    // if the device fails the board never comes
    b->board_here->live.halt = SCREE_HALT_START;
    scree_device_play(s->device, recording);
    scree_device_wait(s->device);
    return (scree_halt)b->board_here->live.halt;
}

/// What was found in a step that was played to its end.
static void take_contacts(scree_simulation *s)
{
    const scree_step_board *board = s->buffers->board_here;
    s->contacts.num_contacts = board->live.num_contacts;
    scree_narrow_phase_take_counts(&s->narrow_phase, &board->pairs);
    scree_count_contacts(s);
}

scree_halt scree_play_step(scree_simulation *simulation)
{
    scree_simulation *s = simulation;
    scree_step_buffers *b = s->buffers;
    scree_halt halt = SCREE_HALT_START;
    if (is_steady(s))
    {
        b->max_recorded =
            scree_min_count(scree_contact_list_room(&s->contacts), scree_contact_list_room(&s->old_contacts));
        const int64_t num_old = s->contacts.num_contacts;
        const int parity = (int)(s->step & 1);
        scree_contact_list_pass_on(&s->contacts, &s->old_contacts);
        if (!b->is_recorded[parity]) b->is_recorded[parity] = record(s, b->recordings + parity);
        if (b->is_recorded[parity]) halt = play(s, b->recordings[parity]);
        const scree_step_tally *tally = &b->board_here->tally;
        if (halt != SCREE_HALT_START) b->moved = scree_moved_apart(tally->particles_moved, tally->walls_moved);
        ++b->num_halts[halt];
        if (halt == SCREE_HALT_NONE)
        {
            take_contacts(s);
            return halt;
        }
        // back to the lists as they were: those of the step before have not been touched
        scree_contact_list_pass_on(&s->contacts, &s->old_contacts);
        set_numbers(s, num_old, 0);
    }
    // what comes now may change sizes and places
    b->is_recorded[0] = b->is_recorded[1] = false;
    return halt;
}

void scree_forget_recordings(scree_step_buffers *buffers)
{
    for (int k = 0; k < 2; ++k)
    {
        scree_device_forget(buffers->device, buffers->recordings[k]);
        buffers->recordings[k] = NULL;
        buffers->is_recorded[k] = false;
    }
}
