/// \file work_kernel.h
/// Where the work of the contacts goes in one step, and the smallest critical time step over them.
/// The work of a step is force times velocity at the same moment: in velocity Verlet that is exactly the change of
/// kinetic energy between the half steps, so the balance of a run shows errors of the rotation and of the bookkeeping
/// only.
#ifndef SCREE_WORK_KERNEL_H
#define SCREE_WORK_KERNEL_H

#include "forces/contact_force_kernel.h"

/// Contacts summed by one index; fixed, so that the sum does not depend on the number of threads.
#define SCREE_WORK_BLOCK 256

/// Sums over one block of contacts.
typedef struct scree_work_sums
{
    scree_real damping;               ///< [J] dissipated by damping
    scree_real friction;              ///< [J] dissipated by slip
    scree_real hysteresis;            ///< [J] work against the elastic normal force that its energy did not take up
    scree_real input;                 ///< [J] put in by walls
    scree_real smallest_step_squared; ///< [s^2] smallest m_eff/k_eff
} scree_work_sums;

typedef struct scree_work_args
{
    scree_contact_list contacts;
    scree_body_motion bodies;  ///< with the velocities of the end of the step
    const scree_vec3 *inertia; ///< [kg m^2] (num_particles) principal moments
    const scree_force_law *laws;
    int32_t num_materials;
    int32_t num_particles;
    scree_real time_step;
    scree_work_sums *sums; ///< (num_blocks) out
} scree_work_args;

/// What body b adds to 1/m_eff at `arm` along n: 1/m + (r x n)^T I^-1 (r x n).
SCREE_FN scree_real scree_inverse_mass_at(const scree_work_args *a, int32_t b, scree_vec3 arm, scree_vec3 n)
{
    if (b >= a->num_particles) return 0;
    // the normal of a sphere goes through its centre
    if (a->contacts.acts_in_points) return a->bodies.inverse_mass[b];
    const scree_vec3 inertia = a->inertia[b];
    const scree_mat3 rotation = scree_mat3_from_quat(a->bodies.pose[b].orientation);
    const scree_vec3 lever = scree_mat3_apply_transposed(rotation, scree_vec3_cross(arm, n));
    return a->bodies.inverse_mass[b] + lever.x * lever.x / inertia.x + lever.y * lever.y / inertia.y +
           lever.z * lever.z / inertia.z;
}

/// Adds contact c to the sums.
SCREE_FN void scree_work_of_contact(const scree_work_args *a, int64_t c, scree_work_sums *sums)
{
    const scree_candidate_pair pair = a->contacts.bodies[c];
    const scree_vec3 arm = a->contacts.arm[c], n = a->contacts.normal[c];
    const scree_vec3 v = scree_relative_velocity(&a->bodies, pair.i, pair.j, arm);
    const scree_vec3 rotation = scree_vec3_sub(a->bodies.angular_velocity[pair.i], a->bodies.angular_velocity[pair.j]);
    const scree_force_law *law =
        a->laws + (int64_t)a->bodies.material[pair.i] * a->num_materials + a->bodies.material[pair.j];
    // speed of approach, with what turning adds where the normal force has a lever
    scree_real turning = 0;
    if (law->model == SCREE_MODEL_ENERGY_CONSERVING)
        turning =
            scree_vec3_dot(scree_normal_lever(a->contacts.area_vector[c], a->contacts.torque_vector[c]), rotation);
    const scree_real approach = turning - scree_vec3_dot(n, v);

    // normal: what the spring takes up and what is damped
    const scree_real elastic = a->contacts.elastic_force[c];
    const scree_real normal = scree_vec3_dot(a->contacts.normal_force[c], n);
    sums->hysteresis += elastic * approach * a->time_step - a->contacts.elastic_work[c];
    sums->damping += (normal - elastic) * approach * a->time_step;

    // tangential and moments: what the springs do not take up is lost
    const bool has_extent = !a->contacts.acts_in_points;
    const scree_vec3 moment = has_extent ? a->contacts.moment[c] : scree_vec3_zero();
    const scree_real power =
        scree_vec3_dot(a->contacts.tangential_force[c], v) + (scree_vec3_dot(moment, rotation) + normal * turning);
    const scree_real lost = -power * a->time_step - a->contacts.spring_work[c];
    if (a->contacts.is_slipping[c] || (has_extent && a->contacts.is_turning[c])) sums->friction += lost;
    else sums->damping += lost;

    // a moving wall works on the particle
    const scree_vec3 point = scree_vec3_add(a->bodies.pose[pair.i].position, arm);
    const scree_vec3 arm_j = scree_vec3_sub(point, a->bodies.pose[pair.j].position);
    if (pair.j >= a->num_particles)
    {
        const scree_vec3 v_wall =
            scree_vec3_add(a->bodies.velocity[pair.j], scree_vec3_cross(a->bodies.angular_velocity[pair.j], arm_j));
        const scree_vec3 f = scree_vec3_add(a->contacts.normal_force[c], a->contacts.tangential_force[c]);
        sums->input +=
            (scree_vec3_dot(f, v_wall) + scree_vec3_dot(moment, a->bodies.angular_velocity[pair.j])) * a->time_step;
    }

    // the stiffer of the two counts
    const scree_real k_t = a->contacts.tangential_stiffness[c];
    const scree_real k_n = k_t / law->tangential_over_normal;
    const scree_real inverse_mass =
        scree_inverse_mass_at(a, pair.i, arm, n) + scree_inverse_mass_at(a, pair.j, arm_j, n);
    sums->smallest_step_squared = scree_min(sums->smallest_step_squared, 1 / (inverse_mass * scree_max(k_n, k_t)));
}

/// Block b of SCREE_WORK_BLOCK contacts.
SCREE_FN void scree_work_at(scree_work_args a, int64_t b)
{
    scree_work_sums sums;
    sums.damping = 0;
    sums.friction = 0;
    sums.hysteresis = 0;
    sums.input = 0;
    sums.smallest_step_squared = SCREE_REAL_MAX;
    const int64_t begin = b * SCREE_WORK_BLOCK;
    int64_t end = begin + SCREE_WORK_BLOCK;
    if (end > a.contacts.num_contacts) end = a.contacts.num_contacts;
    for (int64_t c = begin; c < end; ++c) scree_work_of_contact(&a, c, &sums);
    a.sums[b] = sums;
}

#endif
