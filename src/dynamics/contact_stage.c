/// \file contact_stage.c
/// Contacts, history, forces and work of one step, as launches over the arrays of the simulation.
#include "contact/history.h"
#include "dynamics/step_buffers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Room for `num` items of `size` bytes behind *array, growing by half at least; contents are not kept.
static scree_status reserve(void *array, int64_t *max, int64_t num, size_t size)
{
    void **items = array;
    if (num <= *max && *items != NULL) return SCREE_OK;
    const int64_t grown = num + num / 2 + 16;
    free(*items);
    *items = malloc((size_t)grown * size);
    *max = *items != NULL ? grown : 0;
    return *items != NULL ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

/// Energy that ended contacts had stored: lost by the normal springs (hysteresis) and the tangential ones (friction).
static void account_ended(scree_simulation *s)
{
    const scree_contact_list *old = &s->old_contacts;
    double normal = 0, tangential = 0;
    for (int64_t o = 0; o < old->num_contacts; ++o)
    {
        if (s->buffers->is_continued[o]) continue;
        normal += (double)old->elastic_energy[o];
        tangential += (double)old->spring_energy[o];
    }
    s->energies.hysteresis += normal;
    s->energies.friction += tangential;
}

scree_status scree_update_contacts(scree_simulation *simulation)
{
    scree_step_buffers *b = simulation->buffers;
    scree_broad_phase *broad_phase = &simulation->broad_phase;

    // the present list becomes the old one; it keeps its order by pair as long as no search comes between
    const scree_contact_list old = simulation->contacts;
    simulation->contacts = simulation->old_contacts;
    simulation->old_contacts = old;

    scree_bodies bodies;
    bodies.shapes = simulation->shape_views;
    bodies.shape = b->shape;
    bodies.pose = b->pose;
    bodies.travel = b->travel;
    bodies.num_bodies = simulation->particles.num_particles + simulation->num_walls;
    scree_status status = scree_narrow_phase_find(&simulation->narrow_phase, &bodies, broad_phase->pairs,
                                                  broad_phase->num_pairs, &simulation->contacts);
    scree_stage_end(&simulation->clock, SCREE_STAGE_CONTACTS);
    const int64_t num = simulation->contacts.num_contacts;
    if (status == SCREE_OK) status = reserve(&b->old_of_contact, &b->max_contacts, num, sizeof *b->old_of_contact);
    if (status == SCREE_OK) status = reserve(&b->is_continued, &b->max_old, old.num_contacts, sizeof *b->is_continued);
    if (status != SCREE_OK) return status;

    scree_history_match_args match;
    match.pairs = broad_phase->pairs;
    match.first_of_pair = simulation->contacts.first_of_pair;
    match.old_first_of_pair = b->is_old_list_of_same_pairs ? old.first_of_pair : NULL;
    match.old_bodies = old.bodies;
    match.patch = simulation->contacts.patch;
    match.old_patch = old.patch;
    match.arm = simulation->contacts.arm;
    match.old_arm = old.arm;
    match.num_old = old.num_contacts;
    match.old_of_contact = b->old_of_contact;
    match.is_continued = b->is_continued;
    memset(b->is_continued, 0, (size_t)old.num_contacts);
    scree_history_match_launch(match, broad_phase->num_pairs);
    b->is_old_list_of_same_pairs = true;
    account_ended(simulation);

    const scree_narrow_phase_counts *counts = &simulation->narrow_phase.counts;
    scree_counters *counters = &simulation->counters;
    counters->num_contacts = num;
    counters->num_without_normal += counts->num_without_normal;
    counters->num_inside += counts->num_inside;
    counters->num_fallbacks += counts->num_fallbacks;
    counters->worst_residual = fmax(counters->worst_residual, (double)counts->worst_residual);
    counters->largest_indentation = fmax(counters->largest_indentation, (double)counts->largest_indentation);
    scree_stage_end(&simulation->clock, SCREE_STAGE_HISTORY);
    return SCREE_OK;
}

scree_body_motion scree_step_body_motion(const scree_step_buffers *buffers)
{
    scree_body_motion motion;
    motion.pose = buffers->pose;
    motion.velocity = buffers->velocity;
    motion.angular_velocity = buffers->angular_velocity;
    motion.inverse_mass = buffers->inverse_mass;
    motion.inverse_radius = buffers->inverse_radius;
    motion.material = buffers->material;
    return motion;
}

scree_status scree_update_forces(scree_simulation *simulation)
{
    const scree_step_buffers *b = simulation->buffers;
    scree_contact_force_args force;
    force.contacts = simulation->contacts;
    force.old_contacts = simulation->old_contacts;
    force.old_of_contact = b->old_of_contact;
    force.bodies = scree_step_body_motion(b);
    force.laws = simulation->laws;
    force.num_materials = simulation->num_materials;
    force.time_step = (scree_real)simulation->time_step;
    scree_contact_force_launch(force, simulation->contacts.num_contacts);
    scree_stage_end(&simulation->clock, SCREE_STAGE_FORCES);

    const double *gravity = simulation->scene->gravity;
    scree_gather_args gather;
    gather.contacts = simulation->contacts;
    gather.row_begin = simulation->broad_phase.row_begin;
    gather.row_pairs = simulation->broad_phase.row_pairs;
    gather.pose = b->pose;
    gather.mass = simulation->particles.mass;
    gather.gravity = scree_vec3_make((scree_real)gravity[0], (scree_real)gravity[1], (scree_real)gravity[2]);
    gather.force = simulation->particles.force;
    gather.torque = simulation->particles.torque;
    scree_gather_launch(gather, simulation->particles.num_particles);
    scree_stage_end(&simulation->clock, SCREE_STAGE_GATHER);
    return SCREE_OK;
}

scree_status scree_account_work(scree_simulation *simulation)
{
    scree_step_buffers *b = simulation->buffers;
    const int64_t num_blocks = (simulation->contacts.num_contacts + SCREE_WORK_BLOCK - 1) / SCREE_WORK_BLOCK;
    const scree_status status = reserve(&b->work_sums, &b->max_work_blocks, num_blocks, sizeof *b->work_sums);
    if (status != SCREE_OK) return status;

    scree_work_args work;
    work.contacts = simulation->contacts;
    work.bodies = scree_step_body_motion(b);
    work.inertia = simulation->particles.inertia;
    work.laws = simulation->laws;
    work.num_materials = simulation->num_materials;
    work.num_particles = (int32_t)simulation->particles.num_particles;
    work.time_step = (scree_real)simulation->time_step;
    work.sums = b->work_sums;
    scree_work_launch(work, num_blocks);

    double smallest_squared = simulation->counters.smallest_critical_step;
    smallest_squared *= smallest_squared;
    for (int64_t k = 0; k < num_blocks; ++k)
    {
        simulation->energies.damping += (double)b->work_sums[k].damping;
        simulation->energies.friction += (double)b->work_sums[k].friction;
        simulation->energies.hysteresis += (double)b->work_sums[k].hysteresis;
        simulation->energies.input += (double)b->work_sums[k].input;
        if (!((double)b->work_sums[k].smallest_step_squared >= smallest_squared))
            smallest_squared = (double)b->work_sums[k].smallest_step_squared;
    }
    simulation->counters.smallest_critical_step = sqrt(smallest_squared);
    return SCREE_OK;
}
