/// \file collision_kernel.h
/// What each contact has cost since it began: the work against its normal forces, and against its tangential forces and
/// moments. Springs give back what they stored, so over a whole contact this is the energy that the collision lost.
#ifndef SCREE_COLLISION_KERNEL_H
#define SCREE_COLLISION_KERNEL_H

#include "forces/contact_force_kernel.h"

typedef struct scree_collision_args
{
    scree_contact_list contacts;
    scree_body_motion bodies;      ///< with the velocities of the end of the step
    const int64_t *old_of_contact; ///< (num_contacts) or -1
    const double *old_normal;      ///< [J] (num_old)
    const double *old_tangential;  ///< [J] (num_old)
    double time_step;              ///< [s]
    double *normal;                ///< [J] (num_contacts) out: so far, this step included
    double *tangential;            ///< [J] (num_contacts) out
} scree_collision_args;

/// Contact c.
SCREE_FN void scree_collision_at(scree_collision_args a, int64_t c)
{
    const scree_candidate_pair pair = a.contacts.bodies[c];
    const scree_vec3 v = scree_relative_velocity(&a.bodies, pair.i, pair.j, a.contacts.arm[c]);
    const scree_vec3 w = scree_vec3_sub(a.bodies.angular_velocity[pair.i], a.bodies.angular_velocity[pair.j]);
    const scree_vec3 moment = a.contacts.acts_in_points ? scree_vec3_zero() : a.contacts.moment[c];
    const double normal = (double)scree_vec3_dot(a.contacts.normal_force[c], v);
    const double tangential = (double)(scree_vec3_dot(a.contacts.tangential_force[c], v) + scree_vec3_dot(moment, w));
    const int64_t old = a.old_of_contact[c];
    a.normal[c] = (old >= 0 ? a.old_normal[old] : 0) - normal * a.time_step;
    a.tangential[c] = (old >= 0 ? a.old_tangential[old] : 0) - tangential * a.time_step;
}

#endif
