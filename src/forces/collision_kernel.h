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
    const int32_t *old_of_contact; ///< (num_contacts) or -1
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
    const scree_vec3 w =
        scree_vec3_sub(a.bodies.moving[pair.i].angular_velocity, a.bodies.moving[pair.j].angular_velocity);
    const scree_vec3 moment = a.contacts.acts_in_points ? scree_vec3_zero() : a.contacts.moment[c];
    const double normal = (double)scree_vec3_dot(a.contacts.normal_force[c], v);
    const double tangential = (double)(scree_vec3_dot(a.contacts.tangential_force[c], v) + scree_vec3_dot(moment, w));
    const int32_t old = a.old_of_contact[c];
    a.normal[c] = (old >= 0 ? a.old_normal[old] : 0) - normal * a.time_step;
    a.tangential[c] = (old >= 0 ? a.old_tangential[old] : 0) - tangential * a.time_step;
}

/// What a collision has cost from its start to its end.
typedef struct scree_ended_collision
{
    double normal, tangential; ///< [J]
    int32_t first, second;     ///< ids of the bodies
    int32_t patch;
    int32_t is_with_wall;
} scree_ended_collision;

typedef struct scree_ended_collisions_args
{
    const scree_candidate_pair *bodies; ///< (num_old)
    const int32_t *patch;               ///< (num_old), or NULL: 0
    const int32_t *ids;                 ///< (num_bodies) of the bodies, or NULL: each is its own
    const uint8_t *is_continued;        ///< (num_old)
    const double *normal;               ///< [J] (num_old)
    const double *tangential;           ///< [J] (num_old)
    int32_t num_particles;
    int32_t *places;              ///< (num_old + 1) first 1 for each that has ended, then the sums before
    scree_ended_collision *ended; ///< out: those that have ended, in order
} scree_ended_collisions_args;

typedef scree_ended_collisions_args scree_ended_flag_args;

SCREE_FN void scree_ended_flag_at(scree_ended_flag_args a, int64_t o) { a.places[o] = a.is_continued[o] ? 0 : 1; }

SCREE_FN void scree_ended_collisions_at(scree_ended_collisions_args a, int64_t o)
{
    if (a.places[o + 1] == a.places[o]) return;
    const scree_candidate_pair pair = a.bodies[o];
    scree_ended_collision collision;
    collision.normal = a.normal[o];
    collision.tangential = a.tangential[o];
    collision.first = a.ids ? a.ids[pair.i] : pair.i;
    collision.second = a.ids ? a.ids[pair.j] : pair.j;
    collision.patch = a.patch ? a.patch[o] : 0;
    collision.is_with_wall = pair.j >= a.num_particles ? 1 : 0;
    a.ended[a.places[o]] = collision;
}

#endif
