/// \file contact_force_cpu.c
/// Forces of contacts on the CPU. Contacts that act in points and share a law without rolling resistance, the usual
/// ones of spheres, are worked on in groups of lanes (lanes.h); all others one by one.
#include "core/lanes.h"
#include "forces/forces.h"

SCREE_DEFINE_LAUNCH_ON(scree_contact_force)

/// What the law reads and gives of a group.
typedef struct scree_force_group
{
    scree_lanes_vec3 position_i, velocity_i, angular_velocity_i, position_j, velocity_j, angular_velocity_j;
    scree_lanes_vec3 arm, normal, spring_force;
    scree_real volume[SCREE_LANES], indentation[SCREE_LANES], inverse_mass[SCREE_LANES];
    scree_real tangential_stiffness[SCREE_LANES];
    scree_lanes_vec3 normal_force, tangential_force;
    scree_real elastic_force[SCREE_LANES], elastic_energy[SCREE_LANES], spring_energy[SCREE_LANES];
    scree_real slip[SCREE_LANES]; ///< 1 or 0
} scree_force_group;

/// The lane loop, with a law whose choices are known here.
static inline void force_of_lanes(scree_force_group *restrict g, const scree_force_law *law, int32_t model,
                                  scree_real time_step)
{
    scree_force_law known = *law;
    known.model = model;
    known.rolling = SCREE_ROLLING_NONE;
    known.has_tangential_spring = true;
    known.has_moments = false;
    known.has_attraction = false;
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_motion i = {scree_lanes_get(&g->position_i, l), scree_lanes_get(&g->velocity_i, l),
                                scree_lanes_get(&g->angular_velocity_i, l)};
        const scree_motion j = {scree_lanes_get(&g->position_j, l), scree_lanes_get(&g->velocity_j, l),
                                scree_lanes_get(&g->angular_velocity_j, l)};
        scree_contact_kinematics k = {0};
        k.volume = g->volume[l];
        k.indentation = g->indentation[l];
        k.normal = scree_lanes_get(&g->normal, l);
        k.relative_velocity = scree_velocity_between(&i, &j, scree_lanes_get(&g->arm, l));
        k.effective_mass = 1 / g->inverse_mass[l];
        k.time_step = time_step;
        k.spring_force = scree_lanes_get(&g->spring_force, l);
        k.tangential_stiffness = g->tangential_stiffness[l];
        scree_contact_force f;
        scree_contact_law(&known, &k, &f);
        scree_lanes_set(&g->normal_force, l, f.normal_force);
        scree_lanes_set(&g->tangential_force, l, f.tangential_force);
        scree_lanes_set(&g->spring_force, l, f.spring_force);
        g->elastic_force[l] = f.elastic_force;
        g->elastic_energy[l] = f.elastic_energy;
        g->spring_energy[l] = f.spring_energy;
        g->tangential_stiffness[l] = f.tangential_stiffness;
        g->slip[l] = f.is_slipping ? 1 : 0;
    }
}

SCREE_LANES_FUNCTION static void hertz_mindlin_of_lanes(scree_force_group *restrict g, const scree_force_law *law,
                                                        scree_real time_step)
{
    force_of_lanes(g, law, SCREE_MODEL_HERTZ_MINDLIN, time_step);
}

SCREE_LANES_FUNCTION static void linear_spring_of_lanes(scree_force_group *restrict g, const scree_force_law *law,
                                                        scree_real time_step)
{
    force_of_lanes(g, law, SCREE_MODEL_LINEAR_SPRING, time_step);
}

static void load_group(scree_force_group *restrict g, const scree_contact_force_args *restrict a, int64_t first)
{
    const scree_contact_list *list = &a->contacts, *old_list = &a->old_contacts;
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const int64_t c = first + l, old = a->old_of_contact[c];
        const scree_candidate_pair pair = list->bodies[c];
        scree_lanes_set(&g->position_i, l, a->bodies.pose[pair.i].position);
        scree_lanes_set(&g->velocity_i, l, a->bodies.velocity[pair.i]);
        scree_lanes_set(&g->angular_velocity_i, l, a->bodies.angular_velocity[pair.i]);
        scree_lanes_set(&g->position_j, l, a->bodies.pose[pair.j].position);
        scree_lanes_set(&g->velocity_j, l, a->bodies.velocity[pair.j]);
        scree_lanes_set(&g->angular_velocity_j, l, a->bodies.angular_velocity[pair.j]);
        g->inverse_mass[l] = a->bodies.inverse_mass[pair.i] + a->bodies.inverse_mass[pair.j];
        scree_lanes_set(&g->arm, l, list->arm[c]);
        scree_lanes_set(&g->normal, l, list->normal[c]);
        g->volume[l] = list->volume[c];
        g->indentation[l] = list->indentation[c];
        const bool is_old = old >= 0;
        scree_lanes_set(&g->spring_force, l, is_old ? old_list->spring_force[old] : scree_vec3_zero());
        g->tangential_stiffness[l] = is_old ? old_list->tangential_stiffness[old] : 0;
        list->elastic_work[c] = is_old ? old_list->elastic_energy[old] : 0;
        list->spring_work[c] = is_old ? old_list->spring_energy[old] : 0;
    }
}

static void store_group(const scree_force_group *restrict g, const scree_contact_list *restrict list, int64_t first)
{
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const int64_t c = first + l;
        list->normal_force[c] = scree_lanes_get(&g->normal_force, l);
        list->tangential_force[c] = scree_lanes_get(&g->tangential_force, l);
        list->spring_force[c] = scree_lanes_get(&g->spring_force, l);
        list->elastic_force[c] = g->elastic_force[l];
        list->is_slipping[c] = g->slip[l] > 0;
        list->tangential_stiffness[c] = g->tangential_stiffness[l];
        list->elastic_energy[c] = g->elastic_energy[l];
        list->elastic_work[c] = g->elastic_energy[l] - list->elastic_work[c];
        list->spring_energy[c] = g->spring_energy[l];
        list->spring_work[c] = g->spring_energy[l] - list->spring_work[c];
    }
}

static const scree_force_law *law_of(const scree_contact_force_args *a, int64_t c)
{
    const scree_candidate_pair pair = a->contacts.bodies[c];
    return a->laws + (int64_t)a->bodies.material[pair.i] * a->num_materials + a->bodies.material[pair.j];
}

/// The law of all contacts of a group, if it is one that lanes know; otherwise NULL.
static const scree_force_law *law_of_group(const scree_contact_force_args *a, int64_t first)
{
    const scree_force_law *law = law_of(a, first);
    bool is_one = law->model != SCREE_MODEL_ENERGY_CONSERVING && law->rolling == SCREE_ROLLING_NONE &&
                  law->has_tangential_spring && !law->has_attraction;
    for (int l = 1; l < SCREE_LANES; ++l) is_one &= law_of(a, first + l) == law;
    return is_one ? law : NULL;
}

static void force_of_group(const scree_contact_force_args *a, int64_t first, int64_t num)
{
    const scree_force_law *law = num == SCREE_LANES && a->contacts.acts_in_points ? law_of_group(a, first) : NULL;
    if (law == NULL)
    {
        for (int64_t c = first; c < first + num; ++c) scree_contact_force_at(*a, c);
        return;
    }
    scree_force_group g;
    load_group(&g, a, first);
    if (law->model == SCREE_MODEL_LINEAR_SPRING) linear_spring_of_lanes(&g, law, a->time_step);
    else hertz_mindlin_of_lanes(&g, law, a->time_step);
    store_group(&g, &a->contacts, first);
}

void scree_contact_force_launch(scree_contact_force_args args, int64_t num)
{
    const int64_t num_groups = (num + SCREE_LANES - 1) / SCREE_LANES;
#pragma omp parallel for schedule(static) if (num >= SCREE_LAUNCH_MIN)
    for (int64_t k = 0; k < num_groups; ++k)
    {
        const int64_t first = k * SCREE_LANES, left = num - first;
        force_of_group(&args, first, left < SCREE_LANES ? left : SCREE_LANES);
    }
}
