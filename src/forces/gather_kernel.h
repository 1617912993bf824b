/// \file gather_kernel.h
/// Force and torque of particle i: the sum over its row of contacts in ascending order, so without atomics and the same
/// for any number of threads. The forces on the two bodies of a contact are exact opposites.
#ifndef SCREE_GATHER_KERNEL_H
#define SCREE_GATHER_KERNEL_H

#include "contact/contact_list.h"

typedef struct scree_gather_args
{
    scree_contact_list contacts;
    const int64_t *row_begin; ///< (num_bodies + 1) rows of candidate pairs
    const int32_t *row_pairs; ///< (2 num_pairs)
    const scree_pose *pose;   ///< (num_bodies)
    const scree_real *mass;   ///< [kg] (num_particles)
    scree_vec3 gravity;       ///< [m/s^2]
    scree_vec3 *force;        ///< [N] (num_particles) out
    scree_vec3 *torque;       ///< [N m] (num_particles) out, world axes
} scree_gather_args;

/// Adds contact c to the sums of particle i. Which of its two bodies i is cannot be foreseen: no branch.
SCREE_FN void scree_gather_contact(const scree_gather_args *a, int64_t c, int64_t i, scree_vec3 *force,
                                   scree_vec3 *torque)
{
    const int32_t first = a->contacts.bodies[c].i;
    const bool is_second = first != (int32_t)i;
    const scree_vec3 own_arm = a->contacts.arm[c];
    const scree_vec3 point = scree_vec3_add(a->pose[first].position, own_arm);
    const scree_vec3 arm = scree_vec3_select(is_second, scree_vec3_sub(point, a->pose[i].position), own_arm);
    const scree_vec3 on_first = scree_vec3_add(a->contacts.normal_force[c], a->contacts.tangential_force[c]);
    const scree_vec3 f = scree_vec3_select(is_second, scree_vec3_negate(on_first), on_first);
    scree_vec3 t = scree_vec3_cross(arm, f);
    if (!a->contacts.acts_in_points)
    {
        const scree_vec3 moment = a->contacts.moment[c];
        t = scree_vec3_add(t, scree_vec3_select(is_second, scree_vec3_negate(moment), moment));
    }
    *force = scree_vec3_add(*force, f);
    *torque = scree_vec3_add(*torque, t);
}

SCREE_FN void scree_gather_at(scree_gather_args a, int64_t i)
{
    scree_vec3 force = scree_vec3_scale(a.gravity, a.mass[i]);
    scree_vec3 torque = scree_vec3_zero();
    for (int64_t k = a.row_begin[i]; k < a.row_begin[i + 1]; ++k)
    {
        const int32_t p = a.row_pairs[k];
        for (int64_t c = a.contacts.first_of_pair[p]; c < a.contacts.first_of_pair[p + 1]; ++c)
            scree_gather_contact(&a, c, i, &force, &torque);
    }
    a.force[i] = force;
    a.torque[i] = torque;
}

#endif
