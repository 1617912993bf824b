/// \file work_cpu.c
/// Work of the contacts on the CPU. Those that act in points are worked on in groups of lanes (lanes.h), and then added
/// up one by one, in their order.
#include "core/lanes.h"
#include "forces/forces.h"

SCREE_DEFINE_LAUNCH_ON(scree_work)

typedef struct scree_work_group
{
    scree_lanes_vec3 position_i, velocity_i, angular_velocity_i, position_j, velocity_j, angular_velocity_j;
    scree_lanes_vec3 arm, normal, normal_force, tangential_force;
    scree_real elastic_force[SCREE_LANES], inverse_mass[SCREE_LANES];
    scree_real tangential_stiffness[SCREE_LANES], tangential_over_normal[SCREE_LANES];
    scree_real hysteresis[SCREE_LANES], damping[SCREE_LANES], lost[SCREE_LANES];
    scree_real inverse_step_squared[SCREE_LANES]; ///< [1/s^2] k_eff/m_eff
} scree_work_group;

SCREE_LANES_FUNCTION static void work_of_lanes(scree_work_group *restrict g, scree_real time_step)
{
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_motion i = {scree_lanes_get(&g->position_i, l), scree_lanes_get(&g->velocity_i, l),
                                scree_lanes_get(&g->angular_velocity_i, l)};
        const scree_motion j = {scree_lanes_get(&g->position_j, l), scree_lanes_get(&g->velocity_j, l),
                                scree_lanes_get(&g->angular_velocity_j, l)};
        const scree_vec3 v = scree_velocity_between(&i, &j, scree_lanes_get(&g->arm, l));
        const scree_work_terms terms =
            scree_work_terms_make(scree_lanes_get(&g->normal, l), v, 0, scree_lanes_get(&g->normal_force, l),
                                  scree_lanes_get(&g->tangential_force, l), g->elastic_force[l], 0, time_step);
        g->hysteresis[l] = terms.hysteresis;
        g->damping[l] = terms.damping;
        g->lost[l] = terms.lost;
        const scree_real k_t = g->tangential_stiffness[l], k_n = k_t / g->tangential_over_normal[l];
        g->inverse_step_squared[l] = g->inverse_mass[l] * scree_max(k_n, k_t);
    }
}

static void load_group(scree_work_group *restrict g, const scree_work_args *restrict a, int64_t first)
{
    const scree_contact_list *list = &a->contacts;
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const int64_t c = first + l;
        const scree_candidate_pair pair = list->bodies[c];
        scree_lanes_set(&g->position_i, l, a->bodies.pose[pair.i].position);
        scree_lanes_set(&g->velocity_i, l, a->bodies.velocity[pair.i]);
        scree_lanes_set(&g->angular_velocity_i, l, a->bodies.angular_velocity[pair.i]);
        scree_lanes_set(&g->position_j, l, a->bodies.pose[pair.j].position);
        scree_lanes_set(&g->velocity_j, l, a->bodies.velocity[pair.j]);
        scree_lanes_set(&g->angular_velocity_j, l, a->bodies.angular_velocity[pair.j]);
        scree_lanes_set(&g->arm, l, list->arm[c]);
        scree_lanes_set(&g->normal, l, list->normal[c]);
        scree_lanes_set(&g->normal_force, l, list->normal_force[c]);
        scree_lanes_set(&g->tangential_force, l, list->tangential_force[c]);
        g->elastic_force[l] = list->elastic_force[c];
        g->tangential_stiffness[l] = list->tangential_stiffness[c];
        // walls have no inverse mass
        g->inverse_mass[l] = a->bodies.inverse_mass[pair.i] + a->bodies.inverse_mass[pair.j];
        const int64_t materials = (int64_t)a->bodies.material[pair.i] * a->num_materials + a->bodies.material[pair.j];
        g->tangential_over_normal[l] = a->laws[materials].tangential_over_normal;
    }
}

static void add_group(const scree_work_group *g, const scree_work_args *a, int64_t first, scree_work_sums *sums)
{
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const int64_t c = first + l;
        const scree_work_terms terms = {g->hysteresis[l], g->damping[l], g->lost[l]};
        scree_work_add(&a->contacts, c, terms, sums);
        const int32_t i = a->contacts.bodies[c].i, j = a->contacts.bodies[c].j;
        if (j < a->num_particles) continue;
        const scree_vec3 point = scree_vec3_add(a->bodies.pose[i].position, a->contacts.arm[c]);
        sums->input += scree_work_of_wall(a, c, j, scree_vec3_sub(point, a->bodies.pose[j].position));
    }
    // the smallest of the quotients is the quotient of the largest: rounding keeps their order
    scree_real largest = 0;
    for (int l = 0; l < SCREE_LANES; ++l) largest = scree_max(largest, g->inverse_step_squared[l]);
    sums->smallest_step_squared = scree_min(sums->smallest_step_squared, 1 / largest);
}

/// Block b as scree_work_at() has it.
static void work_of_block(const scree_work_args *a, int64_t b)
{
    scree_work_sums sums;
    scree_work_begin(&sums);
    int64_t c = b * SCREE_WORK_BLOCK;
    const int64_t end =
        c + SCREE_WORK_BLOCK < a->contacts.num_contacts ? c + SCREE_WORK_BLOCK : a->contacts.num_contacts;
    scree_work_group g;
    for (; c + SCREE_LANES <= end; c += SCREE_LANES)
    {
        load_group(&g, a, c);
        work_of_lanes(&g, a->time_step);
        add_group(&g, a, c, &sums);
    }
    for (; c < end; ++c) scree_work_of_contact(a, c, &sums);
    a->sums[b] = sums;
}

void scree_work_launch(scree_work_args args, int64_t num)
{
    const bool has_lanes = args.contacts.acts_in_points;
#pragma omp parallel for schedule(static) if (num * SCREE_WORK_BLOCK >= SCREE_LAUNCH_MIN)
    for (int64_t b = 0; b < num; ++b)
    {
        if (has_lanes) work_of_block(&args, b);
        else scree_work_at(args, b);
    }
}
