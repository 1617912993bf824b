/// \file contact_force_kernel.h
/// Force of contact c: relative velocity and history in, force law, force and history out.
#ifndef SCREE_CONTACT_FORCE_KERNEL_H
#define SCREE_CONTACT_FORCE_KERNEL_H

#include "contact/contact_list.h"
#include "forces/contact_law_kernel.h"
#include "forces/contact_side.h"
#include "forces/moving_body.h"

/// Bodies as the forces see them: particles first, then walls; all (num_bodies).
typedef struct scree_body_motion
{
    const scree_pose *pose;
    const scree_moving_body *moving;
    const scree_real *inverse_radius; ///< [1/m] of the sphere of the same volume; 0 for walls
} scree_body_motion;

/// How a body moves.
typedef struct scree_motion
{
    scree_vec3 position;         ///< [m]
    scree_vec3 velocity;         ///< [m/s] at the position
    scree_vec3 angular_velocity; ///< [rad/s]
} scree_motion;

SCREE_FN scree_motion scree_motion_of(const scree_body_motion *bodies, int32_t i)
{
    scree_motion motion;
    motion.position = bodies->pose[i].position;
    motion.velocity = bodies->moving[i].velocity;
    motion.angular_velocity = bodies->moving[i].angular_velocity;
    return motion;
}

/// Velocity of i against j at the point position_i + arm.
SCREE_FN scree_vec3 scree_velocity_between(const scree_motion *i, const scree_motion *j, scree_vec3 arm)
{
    const scree_vec3 point = scree_vec3_add(i->position, arm);
    const scree_vec3 arm_j = scree_vec3_sub(point, j->position);
    const scree_vec3 v_i = scree_vec3_add(i->velocity, scree_vec3_cross(i->angular_velocity, arm));
    const scree_vec3 v_j = scree_vec3_add(j->velocity, scree_vec3_cross(j->angular_velocity, arm_j));
    return scree_vec3_sub(v_i, v_j);
}

SCREE_FN scree_vec3 scree_relative_velocity(const scree_body_motion *bodies, int32_t i, int32_t j, scree_vec3 arm)
{
    const scree_motion motion_i = scree_motion_of(bodies, i), motion_j = scree_motion_of(bodies, j);
    return scree_velocity_between(&motion_i, &motion_j, arm);
}

typedef struct scree_contact_force_args
{
    scree_contact_list contacts;     ///< present: geometry read, forces and history written
    scree_contact_list old_contacts; ///< of the step before: history read
    const int32_t *old_of_contact;   ///< (num_contacts) or -1
    scree_body_motion bodies;
    const scree_force_law *laws; ///< (num_materials, num_materials)
    int32_t num_materials;
    scree_real time_step; ///< [s]
    /// (2, max_sides) out, on all i, on all j, for the gathering; NULL on the CPU. There it makes them itself; a GPU
    /// waits for memory, and one record is less than all that it is made of.
    scree_contact_side *sides;
    int64_t max_sides;
} scree_contact_force_args;

/// Radius R* and inertia of rolling of a contact, those of the spheres of equal volume.
SCREE_FN void scree_rolling_pair(const scree_body_motion *bodies, int32_t i, int32_t j, scree_contact_kinematics *k)
{
    const scree_real i_over_r = bodies->inverse_radius[i], j_over_r = bodies->inverse_radius[j];
    k->effective_radius = 1 / (i_over_r + j_over_r);
    // 1/(7/5 m R^2) of each
    k->rolling_inertia = (scree_real)1.4 / (bodies->moving[i].inverse_mass * i_over_r * i_over_r +
                                            bodies->moving[j].inverse_mass * j_over_r * j_over_r);
}

/// What contact c exerts on its two bodies.
SCREE_FN void scree_write_sides(const scree_contact_force_args *a, int64_t c, scree_candidate_pair pair,
                                const scree_contact_force *f)
{
    scree_contact_place place;
    place.own_arm = a->contacts.arm[c];
    place.first = a->bodies.pose[pair.i].position;
    const scree_vec3 on_first = scree_vec3_add(f->normal_force, f->tangential_force);
    for (int32_t k = 0; k < 2; ++k)
    {
        place.body = a->bodies.pose[k == 0 ? pair.i : pair.j].position;
        place.is_second = k == 1;
        scree_contact_side side = scree_contact_side_make(place, on_first);
        if (!a->contacts.acts_in_points) scree_contact_side_turn(&side, place.is_second, f->moment);
        a->sides[k * a->max_sides + c] = side;
    }
}

SCREE_FN void scree_contact_force_at(scree_contact_force_args a, int64_t c)
{
    const scree_candidate_pair pair = a.contacts.bodies[c];
    const scree_body_motion bodies =
        a.bodies; // with the address of a part, compilers would copy all arguments each time
    const scree_force_law *law =
        a.laws + (int64_t)bodies.moving[pair.i].material * a.num_materials + bodies.moving[pair.j].material;

    // what is known of the contact, its history included
    scree_contact_kinematics k;
    k.volume = a.contacts.volume[c];
    k.indentation = a.contacts.indentation[c];
    const bool has_extent = !a.contacts.acts_in_points, has_rolling = has_extent && !a.contacts.has_no_rolling;
    k.radius = has_extent ? a.contacts.radius[c] : 0;
    k.normal = a.contacts.normal[c];
    k.relative_velocity = scree_relative_velocity(&bodies, pair.i, pair.j, a.contacts.arm[c]);
    k.relative_rotation =
        scree_vec3_sub(bodies.moving[pair.i].angular_velocity, bodies.moving[pair.j].angular_velocity);
    k.effective_mass = 1 / (bodies.moving[pair.i].inverse_mass + bodies.moving[pair.j].inverse_mass);
    k.time_step = a.time_step;
    k.effective_radius = 0;
    k.rolling_inertia = 0;
    k.area = 0;
    k.lever = scree_vec3_zero();
    if (law->rolling != SCREE_ROLLING_NONE || law->model == SCREE_MODEL_ENERGY_CONSERVING)
        scree_rolling_pair(&bodies, pair.i, pair.j, &k);
    if (law->model == SCREE_MODEL_ENERGY_CONSERVING)
    {
        // a sphere's contact, V = pi R* d^2, has |S| = dV/dd and no lever
        const scree_real area = scree_vec3_length(a.contacts.area_vector[c]);
        k.area = area > 0 ? area : 2 * k.volume / k.indentation;
        k.lever = scree_normal_lever(a.contacts.area_vector[c], a.contacts.torque_vector[c]);
    }
    k.spring_force = scree_vec3_zero();
    k.torsion = 0;
    k.radius_before = 0;
    k.rolling_moment = scree_vec3_zero();
    k.tangential_stiffness = 0;
    scree_real elastic_energy = 0, spring_energy = 0;
    const int32_t old = a.old_of_contact[c];
    if (old >= 0)
    {
        k.spring_force = a.old_contacts.spring_force[old];
        k.tangential_stiffness = a.old_contacts.tangential_stiffness[old];
        if (has_extent) k.torsion = a.old_contacts.torsion[old];
        if (has_extent) k.radius_before = a.old_contacts.radius[old];
        if (has_rolling) k.rolling_moment = a.old_contacts.rolling_moment[old];
        spring_energy = a.old_contacts.spring_energy[old];
        elastic_energy = a.old_contacts.elastic_energy[old];
    }

    scree_contact_force f;
    scree_contact_law(law, &k, &f);

    a.contacts.normal_force[c] = f.normal_force;
    a.contacts.tangential_force[c] = f.tangential_force;
    a.contacts.elastic_force[c] = f.elastic_force;
    a.contacts.is_slipping[c] = f.is_slipping ? 1 : 0;
    a.contacts.spring_force[c] = f.spring_force;
    a.contacts.tangential_stiffness[c] = f.tangential_stiffness;
    a.contacts.elastic_energy[c] = f.elastic_energy;
    a.contacts.elastic_work[c] = f.elastic_energy - elastic_energy;
    a.contacts.spring_energy[c] = f.spring_energy;
    a.contacts.spring_work[c] = f.spring_energy - spring_energy;
    if (a.sides) scree_write_sides(&a, c, pair, &f);
    if (!has_extent) return;
    a.contacts.moment[c] = f.moment;
    a.contacts.is_turning[c] = f.is_turning ? 1 : 0;
    a.contacts.torsion[c] = f.torsion;
    if (has_rolling) a.contacts.rolling_moment[c] = f.rolling_moment;
}

#endif
