/// \file work_kernel.h
/// Where the work of the contacts goes in one step, and the smallest critical time step over them. Contacts are summed
/// up for each first body by itself, and bodies in blocks of following ids, so that no sum depends on the order of the
/// contacts.
/// The work of a step is force times velocity at the same moment: in velocity Verlet that is exactly the change of
/// kinetic energy between the half steps, so the balance of a run shows errors of the rotation and of the bookkeeping
/// only.
#ifndef SCREE_WORK_KERNEL_H
#define SCREE_WORK_KERNEL_H

#include "core/team_sum.h"
#include "forces/contact_force_kernel.h"

/// Particles whose sum is made by one index.
#define SCREE_WORK_BLOCK 256

/// Blocks of so many items that hold `num`.
SCREE_FN int64_t scree_count_blocks(int64_t num, int64_t size) { return (num + size - 1) / size; }

/// Sums over contacts.
typedef struct scree_work_sums
{
    scree_real damping;               ///< [J] dissipated by damping
    scree_real friction;              ///< [J] dissipated by slip
    scree_real hysteresis;            ///< [J] work against the elastic normal force that its energy did not take up
    scree_real input;                 ///< [J] put in by walls
    scree_real smallest_step_squared; ///< [s^2] smallest m_eff/k_eff
} scree_work_sums;

/// Where the contacts of the step before stand, by their first body.
typedef struct scree_old_contacts
{
    const scree_real *elastic_energy; ///< [J] (num_old)
    const scree_real *spring_energy;  ///< [J] (num_old)
    const uint8_t *is_continued;      ///< (num_old)
    const int32_t *first_of_pair;     ///< (num_pairs + 1) if the candidate pairs are the same, else NULL: then
    const int32_t *group_begin;       ///< (num_bodies) first one of a body
    const int32_t *group_end;         ///< (num_bodies) the one behind its last one
} scree_old_contacts;

typedef struct scree_work_args
{
    scree_contact_list contacts;
    const int32_t *own_begin; ///< (num_bodies + 1) first candidate pair in which a body is the first one
    scree_old_contacts old;
    scree_body_motion bodies;  ///< with the velocities of the end of the step
    const int32_t *ids;        ///< (num_bodies) of the bodies, or NULL: each is its own
    const int32_t *places;     ///< (num_bodies) the body of each id, or NULL
    const scree_vec3 *inertia; ///< [kg m^2] (num_particles) principal moments
    const scree_force_law *laws;
    int32_t num_materials;
    int32_t num_particles;
    scree_real time_step;
    scree_work_sums *sums; ///< (num_blocks) out
    scree_real *of_bodies; ///< (num_particles, 4) scratch of the CPU if there are ids
} scree_work_args;

/// What body b adds to 1/m_eff at `arm` along n: 1/m + (r x n)^T I^-1 (r x n).
SCREE_FN scree_real scree_inverse_mass_at(const scree_work_args *a, int32_t b, scree_vec3 arm, scree_vec3 n)
{
    if (b >= a->num_particles) return 0;
    // the normal of a sphere goes through its centre
    if (a->contacts.acts_in_points) return a->bodies.moving[b].inverse_mass;
    const scree_vec3 inertia = a->inertia[b];
    const scree_mat3 rotation = scree_mat3_from_quat(a->bodies.pose[b].orientation);
    const scree_vec3 lever = scree_mat3_apply_transposed(rotation, scree_vec3_cross(arm, n));
    return a->bodies.moving[b].inverse_mass + lever.x * lever.x / inertia.x + lever.y * lever.y / inertia.y +
           lever.z * lever.z / inertia.z;
}

/// What the work of one contact is made of; velocities are those of the end of the step.
typedef struct scree_work_terms
{
    scree_real hysteresis; ///< [J] of the elastic normal force
    scree_real damping;    ///< [J] of the rest of the normal force
    scree_real lost;       ///< [J] of the tangential force and the moment, to friction or to damping
} scree_work_terms;

/// `turning` is the speed of approach that turning adds where the normal force has a lever.
SCREE_FN scree_work_terms scree_work_terms_make(scree_vec3 n, scree_vec3 v, scree_real turning, scree_vec3 normal_force,
                                                scree_vec3 tangential_force, scree_real elastic,
                                                scree_real moment_power, scree_real time_step)
{
    const scree_real approach = turning - scree_vec3_dot(n, v);
    const scree_real normal = scree_vec3_dot(normal_force, n);
    scree_work_terms terms;
    terms.hysteresis = elastic * approach * time_step;
    terms.damping = (normal - elastic) * approach * time_step;
    const scree_real power = scree_vec3_dot(tangential_force, v) + (moment_power + normal * turning);
    terms.lost = -power * time_step;
    return terms;
}

/// The sums of a group while they are made.
typedef struct scree_work_block
{
    scree_team_real_sum damping, friction, hysteresis, input;
    scree_real smallest_step_squared; ///< over all lanes of the thread
} scree_work_block;

SCREE_FN void scree_work_begin(scree_work_block *block)
{
    scree_team_sum_zero(&block->damping);
    scree_team_sum_zero(&block->friction);
    scree_team_sum_zero(&block->hysteresis);
    scree_team_sum_zero(&block->input);
    block->smallest_step_squared = SCREE_REAL_MAX;
}

/// Item n of the group.
SCREE_FN void scree_work_add_item(scree_work_block *block, int64_t n, scree_work_sums one)
{
    scree_team_sum_add(&block->damping, n, one.damping);
    scree_team_sum_add(&block->friction, n, one.friction);
    scree_team_sum_add(&block->hysteresis, n, one.hysteresis);
    scree_team_sum_add(&block->input, n, one.input);
    block->smallest_step_squared = scree_min(block->smallest_step_squared, one.smallest_step_squared);
}

/// The whole group, to all threads of the team.
SCREE_FN scree_work_sums scree_work_total(const scree_team *team, scree_work_block *block)
{
    scree_work_sums sums;
    sums.damping = scree_team_sum_total(team, &block->damping);
    sums.friction = scree_team_sum_total(team, &block->friction);
    sums.hysteresis = scree_team_sum_total(team, &block->hysteresis);
    sums.input = scree_team_sum_total(team, &block->input);
    sums.smallest_step_squared = -scree_team_max(team, -block->smallest_step_squared);
    return sums;
}

/// Where these terms go: what the springs of the contact do not take up is lost.
typedef struct scree_work_losses
{
    scree_real hysteresis, damping; ///< [J] of the normal force
    scree_real friction, viscous;   ///< [J] of the tangential force and the moment; one of them is 0
} scree_work_losses;

SCREE_FN scree_work_losses scree_work_losses_make(scree_work_terms terms, scree_real elastic_work,
                                                  scree_real spring_work, bool is_friction)
{
    const scree_real lost = terms.lost - spring_work;
    scree_work_losses losses;
    losses.hysteresis = terms.hysteresis - elastic_work;
    losses.damping = terms.damping;
    // no branch: which contacts slip cannot be foreseen, and adding 0 changes nothing
    losses.friction = is_friction ? lost : 0;
    losses.viscous = is_friction ? 0 : lost;
    return losses;
}

/// A moving wall works on the particle: contact c with wall j.
SCREE_FN scree_real scree_work_of_wall(const scree_work_args *a, int64_t c, int32_t j, scree_vec3 arm_j)
{
    const scree_moving_body *wall = a->bodies.moving + j;
    const scree_vec3 moment = a->contacts.acts_in_points ? scree_vec3_zero() : a->contacts.moment[c];
    const scree_vec3 v_wall = scree_vec3_add(wall->velocity, scree_vec3_cross(wall->angular_velocity, arm_j));
    const scree_vec3 f = scree_vec3_add(a->contacts.normal_force[c], a->contacts.tangential_force[c]);
    return (scree_vec3_dot(f, v_wall) + scree_vec3_dot(moment, wall->angular_velocity)) * a->time_step;
}

/// Contact c alone.
SCREE_FN scree_work_sums scree_work_of_contact(const scree_work_args *a, int64_t c)
{
    const scree_candidate_pair pair = a->contacts.bodies[c];
    const scree_vec3 arm = a->contacts.arm[c], n = a->contacts.normal[c];
    const scree_vec3 v = scree_relative_velocity(&a->bodies, pair.i, pair.j, arm);
    const scree_vec3 rotation =
        scree_vec3_sub(a->bodies.moving[pair.i].angular_velocity, a->bodies.moving[pair.j].angular_velocity);
    const scree_force_law *law =
        a->laws + (int64_t)a->bodies.moving[pair.i].material * a->num_materials + a->bodies.moving[pair.j].material;
    scree_real turning = 0;
    if (law->model == SCREE_MODEL_ENERGY_CONSERVING)
        turning =
            scree_vec3_dot(scree_normal_lever(a->contacts.area_vector[c], a->contacts.torque_vector[c]), rotation);
    const scree_real moment_power = a->contacts.acts_in_points ? 0 : scree_vec3_dot(a->contacts.moment[c], rotation);
    const scree_work_terms terms =
        scree_work_terms_make(n, v, turning, a->contacts.normal_force[c], a->contacts.tangential_force[c],
                              a->contacts.elastic_force[c], moment_power, a->time_step);
    const bool is_turning = !a->contacts.acts_in_points && a->contacts.is_turning[c];
    const bool is_friction = a->contacts.is_slipping[c] || is_turning;
    const scree_work_losses losses =
        scree_work_losses_make(terms, a->contacts.elastic_work[c], a->contacts.spring_work[c], is_friction);

    const scree_vec3 point = scree_vec3_add(a->bodies.pose[pair.i].position, arm);
    const scree_vec3 arm_j = scree_vec3_sub(point, a->bodies.pose[pair.j].position);
    scree_work_sums one;
    one.hysteresis = losses.hysteresis;
    one.damping = losses.damping + losses.viscous;
    one.friction = losses.friction;
    one.input = pair.j >= a->num_particles ? scree_work_of_wall(a, c, pair.j, arm_j) : 0;

    // the stiffer of the two counts
    const scree_real k_t = a->contacts.tangential_stiffness[c];
    const scree_real k_n = k_t / law->tangential_over_normal;
    const scree_real inverse_mass =
        scree_inverse_mass_at(a, pair.i, arm, n) + scree_inverse_mass_at(a, pair.j, arm_j, n);
    one.smallest_step_squared = 1 / (inverse_mass * scree_max(k_n, k_t));
    return one;
}

SCREE_FN scree_work_sums scree_work_nothing(void)
{
    const scree_work_sums nothing = {0, 0, 0, 0, SCREE_REAL_MAX};
    return nothing;
}

SCREE_FN void scree_work_add(scree_work_sums *sums, scree_work_sums one)
{
    sums->damping += one.damping;
    sums->friction += one.friction;
    sums->hysteresis += one.hysteresis;
    sums->input += one.input;
    sums->smallest_step_squared = scree_min(sums->smallest_step_squared, one.smallest_step_squared);
}

/// Adds the energy that old contacts of body i had stored which ended: lost by the normal springs (hysteresis) and the
/// tangential ones (friction).
SCREE_FN void scree_work_add_ended(scree_work_sums *sums, const scree_work_args *a, int64_t i)
{
    const scree_old_contacts *old = &a->old;
    const bool has_same_pairs = old->first_of_pair;
    const int32_t begin = has_same_pairs ? old->first_of_pair[a->own_begin[i]] : old->group_begin[i];
    const int32_t end = has_same_pairs ? old->first_of_pair[a->own_begin[i + 1]] : old->group_end[i];
    for (int32_t o = begin; o < end; ++o)
    {
        if (old->is_continued[o]) continue;
        sums->hysteresis += old->elastic_energy[o];
        sums->friction += old->spring_energy[o];
    }
}

/// The contacts in which body i is the first one.
SCREE_FN scree_work_sums scree_work_of_body(const scree_work_args *a, int64_t i)
{
    scree_work_sums sums = scree_work_nothing();
    const int32_t end = a->contacts.first_of_pair[a->own_begin[i + 1]];
    for (int32_t c = a->contacts.first_of_pair[a->own_begin[i]]; c < end; ++c)
        scree_work_add(&sums, scree_work_of_contact(a, c));
    scree_work_add_ended(&sums, a, i);
    return sums;
}

/// Block b of SCREE_WORK_BLOCK particles.
SCREE_FN void scree_work_team_at(scree_work_args a, const scree_team *team, int64_t b)
{
    scree_work_block block;
    scree_work_begin(&block);
    const int64_t begin = b * SCREE_WORK_BLOCK;
    int64_t num = a.num_particles - begin;
    if (num > SCREE_WORK_BLOCK) num = SCREE_WORK_BLOCK;
    SCREE_TURN_BY_TURN
    for (int64_t n = scree_team_lane(team); n < num; n += scree_team_size(team))
        scree_work_add_item(&block, n, scree_work_of_body(&a, a.places ? a.places[begin + n] : begin + n));
    const scree_work_sums sums = scree_work_total(team, &block);
    if (scree_team_leads(team)) a.sums[b] = sums;
}

SCREE_FN void scree_work_at(scree_work_args a, int64_t b)
{
    const scree_team team = scree_team_alone();
    scree_work_team_at(a, &team, b);
}

#endif
