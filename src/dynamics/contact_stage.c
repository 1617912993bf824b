/// \file contact_stage.c
/// Contacts, history, forces and work of one step, as launches over the arrays of the simulation.
#include "contact/history.h"
#include "dynamics/step_buffers.h"

#include <math.h>
#include <string.h>

/// Room in all arrays over contacts for those of the steps until the next search, some more than now.
static scree_status make_room(scree_simulation *s)
{
    scree_step_buffers *b = s->buffers;
    scree_device *device = s->device;
    // the two lists change places, and the present one has that room
    scree_status status =
        scree_contact_list_reserve(&s->old_contacts, s->contacts.max_contacts, s->broad_phase.num_pairs);
    if (status != SCREE_OK) return status;
    // none of them ever has more contacts than that
    const int64_t most = s->contacts.max_contacts;
    status = scree_device_reserve_only(device, &b->old_of_contact, &b->max_contacts, most, sizeof *b->old_of_contact);
    if (status == SCREE_OK)
        status = scree_device_reserve_only(device, &b->is_continued, &b->max_old, most, sizeof *b->is_continued);
    if (status == SCREE_OK && device != NULL)
        status = scree_device_reserve_only(device, &b->sides, &b->max_sides, most, 2 * sizeof *b->sides);
    return status;
}

/// The largest indentation; beside forces and motion.
static void find_largest_indentation(const scree_simulation *s)
{
    scree_device_branch(s->device, 1);
    const int64_t num = s->contacts.num_contacts;
    const scree_indentations_args args = {s->contacts.indentation, num, &s->buffers->tally->largest_indentation};
    scree_indentations_launch_on(s->device, args, scree_count_blocks(num, SCREE_CONTACT_BLOCK));
    scree_device_branch(s->device, 0);
}

scree_bodies scree_step_bodies(const scree_simulation *simulation)
{
    const scree_simulation *s = simulation;
    const scree_step_buffers *b = s->buffers;
    scree_bodies bodies;
    memset(&bodies, 0, sizeof bodies); // the gaps between its members too
    bodies.shapes = s->shape_views;
    bodies.shape = b->shape;
    bodies.pose = b->pose;
    bodies.travel = b->travel;
    bodies.ids = scree_ids(s);
    bodies.num_bodies = s->particles.num_particles + s->num_walls;
    bodies.num_steps = s->step - b->searched_step;
    // each particle stays within its skin, together with the walls
    bodies.reach = s->scene->solver.reuse_pairs ? (b->has_travel ? 2 : 1) * b->skin : 0;
    return bodies;
}

/// Where the old contacts of each first body stand; only found if they cannot be found by their pair.
static scree_pair_groups find_old_groups(const scree_simulation *s)
{
    const scree_step_buffers *b = s->buffers;
    const scree_contact_list *old = &s->old_contacts;
    const int64_t num_bodies = s->particles.num_particles + s->num_walls;
    const bool has_old = old->num_contacts > 0;
    const scree_pair_groups groups = {has_old ? &old->bodies->i : NULL,
                                      has_old ? &old->bodies->j : NULL,
                                      scree_ids(s),
                                      2,
                                      old->num_contacts,
                                      b->old_groups,
                                      b->old_groups + num_bodies};
    if (b->is_old_list_of_same_pairs) return groups;
    scree_device_zero(s->device, b->old_groups, (size_t)num_bodies * 2 * sizeof *b->old_groups);
    scree_group_bounds_launch_on(s->device, groups, groups.num);
    return groups;
}

/// Which old contacts the present ones continue.
static void match_contacts(const scree_simulation *s)
{
    scree_step_buffers *b = s->buffers;
    const scree_contact_list *contacts = &s->contacts, *old = &s->old_contacts;
    scree_history_match_args match;
    match.pairs = s->broad_phase.pairs;
    match.first_of_pair = contacts->first_of_pair;
    match.old_first_of_pair = b->is_old_list_of_same_pairs ? old->first_of_pair : NULL;
    match.patch = contacts->patch;
    match.old_patch = old->patch;
    match.arm = contacts->arm;
    match.old_arm = old->arm;
    match.old_of_contact = b->old_of_contact;
    match.is_continued = b->is_continued;
    match.old_groups = find_old_groups(s);
    b->has_old_groups = !b->is_old_list_of_same_pairs;
    scree_device_zero(s->device, b->is_continued, (size_t)old->num_contacts);
    scree_history_match_launch_on(s->device, match, s->broad_phase.num_pairs);
}

void scree_count_contacts(scree_simulation *simulation)
{
    const scree_narrow_phase_counts *counts = &simulation->narrow_phase.counts;
    scree_counters *counters = &simulation->counters;
    counters->num_contacts = simulation->contacts.num_contacts;
    counters->num_without_normal += counts->num_without_normal;
    counters->num_inside += counts->num_inside;
    counters->num_fallbacks += counts->num_fallbacks;
    counters->worst_residual = fmax(counters->worst_residual, (double)counts->worst_residual);
}

static scree_status find_contacts(scree_simulation *s)
{
    const scree_bodies bodies = scree_step_bodies(s);
    const scree_status status = scree_narrow_phase_find(&s->narrow_phase, &bodies, s->broad_phase.pairs,
                                                        s->broad_phase.num_pairs, &s->contacts);
    scree_stage_end(&s->clock, SCREE_STAGE_CONTACTS);
    return status;
}

scree_status scree_update_contacts(scree_simulation *simulation)
{
    scree_contact_list_pass_on(&simulation->contacts, &simulation->old_contacts);
    scree_status status = find_contacts(simulation);
    if (status == SCREE_OK && simulation->narrow_phase.lacks_room)
    {
        // memory is taken after searches only, for what is found then
        status = scree_search_neighbours(simulation);
        if (status == SCREE_OK) status = find_contacts(simulation);
    }
    // the old list keeps its order by pair as long as no search comes between
    if (status == SCREE_OK && !simulation->buffers->is_old_list_of_same_pairs) status = make_room(simulation);
    if (status != SCREE_OK) return status;
    match_contacts(simulation);
    simulation->buffers->is_old_list_of_same_pairs = true;
    find_largest_indentation(simulation);
    scree_count_contacts(simulation);
    scree_stage_end(&simulation->clock, SCREE_STAGE_HISTORY);
    return SCREE_OK;
}

void scree_update_contacts_again(scree_simulation *simulation)
{
    const scree_broad_phase *broad_phase = &simulation->broad_phase;
    const scree_bodies bodies = scree_step_bodies(simulation);
    scree_narrow_phase_again(&simulation->narrow_phase, &bodies, broad_phase->pairs, broad_phase->num_pairs,
                             &simulation->contacts, &simulation->buffers->board->live);
    match_contacts(simulation);
    find_largest_indentation(simulation);
}

scree_body_motion scree_step_body_motion(const scree_step_buffers *buffers)
{
    scree_body_motion motion;
    motion.pose = buffers->pose;
    motion.moving = buffers->moving;
    motion.inverse_radius = buffers->inverse_radius;
    return motion;
}

void scree_update_forces(scree_simulation *simulation)
{
    const scree_step_buffers *b = simulation->buffers;
    scree_contact_force_args force;
    force.contacts = scree_contact_list_view(&simulation->contacts);
    force.old_contacts = scree_contact_list_view(&simulation->old_contacts);
    force.old_of_contact = b->old_of_contact;
    force.bodies = scree_step_body_motion(b);
    force.laws = simulation->laws;
    force.num_materials = simulation->num_materials;
    force.time_step = (scree_real)simulation->time_step;
    force.sides = b->sides;
    force.max_sides = b->max_sides;
    scree_contact_force_launch_on(simulation->device, force, simulation->contacts.num_contacts);
    scree_stage_end(&simulation->clock, SCREE_STAGE_FORCES);
    // beside what follows
    scree_device_branch(simulation->device, 2);
    scree_sum_wall_loads(simulation);
    scree_device_branch(simulation->device, 0);
    scree_stage_end(&simulation->clock, SCREE_STAGE_WORK);
}

void scree_gather_forces(scree_simulation *simulation)
{
    const scree_step_buffers *b = simulation->buffers;
    const double *gravity = simulation->scene->gravity;
    scree_gather_args gather;
    gather.contacts = scree_contact_list_view(&simulation->contacts);
    gather.sides = b->sides;
    gather.max_sides = b->max_sides;
    gather.own_begin = simulation->broad_phase.own_begin;
    gather.row_begin = simulation->broad_phase.row_begin;
    gather.row_pairs = simulation->broad_phase.row_pairs;
    gather.pose = b->pose;
    gather.mass = simulation->particles.mass;
    gather.are_ids = scree_ids(simulation) == NULL;
    gather.gravity = scree_vec3_make((scree_real)gravity[0], (scree_real)gravity[1], (scree_real)gravity[2]);
    gather.force = simulation->particles.force;
    gather.torque = simulation->particles.torque;
    scree_gather_launch_on(simulation->device, gather, simulation->particles.num_particles);
    scree_stage_end(&simulation->clock, SCREE_STAGE_GATHER);
}

/// Adds the sums up, in groups of always the same ones, until one is left, which goes to the tally.
static void reduce_work(const scree_simulation *s, int64_t num_parts)
{
    scree_work_reduce_args args = {s->buffers->work_sums, num_parts, NULL};
    for (int64_t num_sums = 0; num_sums != 1;)
    {
        num_sums = args.num_parts > 1 ? scree_count_blocks(args.num_parts, SCREE_SUM_FAN_IN) : 1;
        args.sums = num_sums > 1 ? s->buffers->work_sums + num_parts : &s->buffers->tally->work;
        scree_work_reduce_launch_on(s->device, args, num_sums);
        args.parts = args.sums;
        args.num_parts = num_sums;
        num_parts += num_sums;
    }
}

/// Where the contacts of the step before stand.
static scree_old_contacts old_contacts_of(const scree_simulation *s)
{
    const scree_step_buffers *b = s->buffers;
    const int64_t num_bodies = s->particles.num_particles + s->num_walls;
    scree_old_contacts old;
    old.elastic_energy = s->old_contacts.elastic_energy;
    old.spring_energy = s->old_contacts.spring_energy;
    old.is_continued = b->is_continued;
    old.first_of_pair = b->has_old_groups ? NULL : s->old_contacts.first_of_pair;
    old.group_begin = b->old_groups;
    old.group_end = b->old_groups + num_bodies;
    return old;
}

void scree_sum_work(scree_simulation *simulation)
{
    const scree_step_buffers *b = simulation->buffers;
    scree_work_args work;
    work.contacts = scree_contact_list_view(&simulation->contacts);
    work.own_begin = simulation->broad_phase.own_begin;
    work.old = old_contacts_of(simulation);
    work.bodies = scree_step_body_motion(b);
    work.ids = scree_ids(simulation);
    work.places = scree_places_of_ids(simulation);
    work.inertia = simulation->particles.inertia;
    work.laws = simulation->laws;
    work.num_materials = simulation->num_materials;
    work.num_particles = (int32_t)simulation->particles.num_particles;
    work.time_step = (scree_real)simulation->time_step;
    work.sums = b->work_sums;
    work.of_bodies = b->places.scratch;
    const int64_t num_blocks = scree_count_blocks(work.num_particles, SCREE_WORK_BLOCK);
    scree_work_launch_on(simulation->device, work, num_blocks);
    scree_device_join(simulation->device);
    reduce_work(simulation, num_blocks);
}

void scree_fetch_board(scree_simulation *simulation)
{
    const scree_step_buffers *b = simulation->buffers;
    scree_device_fetch(simulation->device, b->board_here, b->board, scree_board_bytes(simulation->num_walls));
    scree_device_zero(simulation->device, b->tally, sizeof *b->tally);
}

void scree_take_board(scree_simulation *simulation)
{
    scree_step_buffers *b = simulation->buffers;
    const scree_step_tally tally = b->board_here->tally;
    scree_energies *energies = &simulation->energies;
    energies->damping += (double)tally.work.damping;
    energies->friction += (double)tally.work.friction;
    energies->hysteresis += (double)tally.work.hysteresis;
    energies->input += (double)tally.work.input;
    scree_counters *counters = &simulation->counters;
    // without contacts nothing was written there, or the largest number
    if (tally.work.smallest_step_squared > 0 && tally.work.smallest_step_squared < SCREE_REAL_MAX)
        counters->smallest_critical_step =
            fmin(counters->smallest_critical_step, sqrt((double)tally.work.smallest_step_squared));
    counters->largest_indentation = fmax(counters->largest_indentation, scree_maximum_value(tally.largest_indentation));
    const int64_t num_from_unstable = (int64_t)scree_maximum_value(tally.num_from_unstable);
    b->first_unstable = num_from_unstable > 0 ? simulation->particles.num_particles - num_from_unstable : -1;
    const scree_real *loads = scree_board_loads(b->board_here);
    for (int32_t w = 0; w < simulation->num_walls; ++w)
        if (b->moving_wall_here[w] >= 0) simulation->wall_loads.load[w] = (double)loads[b->moving_wall_here[w]];
}
