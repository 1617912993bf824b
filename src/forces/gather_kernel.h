/// \file gather_kernel.h
/// Force and torque of particle i: the sum over the contacts in which it is the second body, along its row, then over
/// those in which it is the first one, which stand next to each other. No atomics, the same for any number of threads.
#ifndef SCREE_GATHER_KERNEL_H
#define SCREE_GATHER_KERNEL_H

#include "contact/contact_list.h"
#include "forces/contact_side.h"

typedef struct scree_gather_args
{
    scree_contact_list contacts;
    const scree_contact_side *sides; ///< (2, max_sides) of all i, of all j, or NULL: made here
    int64_t max_sides;
    const int32_t *own_begin; ///< (num_bodies + 1) first pair in which a body is the first one
    const int32_t *row_begin; ///< (num_bodies + 1) rows of candidate pairs
    const int32_t *row_pairs; ///< (num_pairs) in which a body is the second one
    bool are_ids; ///< are the contacts sorted by (i, j), because places are ids? Then the CPU needs no rows either
    const scree_pose *pose; ///< (num_bodies)
    const scree_real *mass; ///< [kg] (num_particles)
    scree_vec3 gravity;     ///< [m/s^2]
    scree_vec3 *force;      ///< [N] (num_particles) out
    scree_vec3 *torque;     ///< [N m] (num_particles) out, world axes
} scree_gather_args;

/// Adds contact c to the sums of particle i.
SCREE_FN void scree_gather_contact(const scree_gather_args *a, int64_t c, int64_t i, scree_vec3 *force,
                                   scree_vec3 *torque)
{
    const int32_t first = a->contacts.bodies[c].i;
    scree_contact_place place;
    place.own_arm = a->contacts.arm[c];
    place.first = a->pose[first].position;
    place.body = a->pose[i].position;
    place.is_second = first != (int32_t)i;
    const scree_vec3 on_first = scree_vec3_add(a->contacts.normal_force[c], a->contacts.tangential_force[c]);
    scree_contact_side side = scree_contact_side_make(place, on_first);
    if (!a->contacts.acts_in_points) scree_contact_side_turn(&side, place.is_second, a->contacts.moment[c]);
    *force = scree_vec3_add(*force, side.force);
    *torque = scree_vec3_add(*torque, side.torque);
}

/// The same, from its sides if they are there.
SCREE_FN void scree_gather_one(const scree_gather_args *a, int64_t c, int64_t i, bool is_second, scree_vec3 *force,
                               scree_vec3 *torque)
{
    if (!a->sides)
    {
        scree_gather_contact(a, c, i, force, torque);
        return;
    }
    const scree_contact_side *side = a->sides + (is_second ? a->max_sides : 0) + c;
    *force = scree_vec3_add(*force, side->force);
    *torque = scree_vec3_add(*torque, side->torque);
}

SCREE_FN void scree_gather_at(scree_gather_args a, int64_t i)
{
    scree_vec3 force = scree_vec3_scale(a.gravity, a.mass[i]);
    scree_vec3 torque = scree_vec3_zero();
    const int32_t *first_of_pair = a.contacts.first_of_pair;
    for (int64_t k = a.row_begin[i]; k < a.row_begin[i + 1]; ++k)
    {
        const int32_t p = a.row_pairs[k];
        for (int32_t c = first_of_pair[p]; c < first_of_pair[p + 1]; ++c)
            scree_gather_one(&a, c, i, true, &force, &torque);
    }
    const int32_t end = first_of_pair[a.own_begin[i + 1]];
    for (int32_t c = first_of_pair[a.own_begin[i]]; c < end; ++c) scree_gather_one(&a, c, i, false, &force, &torque);
    a.force[i] = force;
    a.torque[i] = torque;
}

#endif
