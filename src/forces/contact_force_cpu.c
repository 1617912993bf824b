/// \file contact_force_cpu.c
/// Forces of contacts on the CPU. Contacts that act in points and share a law without rolling resistance, the usual
/// ones of spheres, are worked on in groups of lanes (lanes.h); all others one by one.
#include "forces/forces.h"
#include "forces/motion_lanes.h"

SCREE_DEFINE_LAUNCH_ON(scree_contact_force)

/// What the law reads and gives of a group.
typedef struct scree_force_group
{
    scree_motion_lanes i, j;
    scree_lanes_vec3 arm, normal, spring_force;
    scree_real volume[SCREE_LANES], indentation[SCREE_LANES], tangential_stiffness[SCREE_LANES];
    scree_real old_elastic_energy[SCREE_LANES], old_spring_energy[SCREE_LANES];
    scree_lanes_vec3 normal_force, tangential_force;
    scree_real elastic_force[SCREE_LANES], elastic_energy[SCREE_LANES], spring_energy[SCREE_LANES];
    scree_real limit[SCREE_LANES]; ///< [N] of friction
    scree_real slip[SCREE_LANES];  ///< 1 or 0
} scree_force_group;

static void load_history(scree_force_group *restrict g, const scree_contact_list *restrict old_list,
                         const int64_t *restrict old_of_contact)
{
    // contacts mostly last, and then follow each other in both lists
    const int64_t first = old_of_contact[0];
    bool is_run = first >= 0;
    for (int l = 1; l < SCREE_LANES; ++l) is_run &= old_of_contact[l] == first + l;
    if (is_run)
    {
        scree_lanes_load(&g->spring_force, old_list->spring_force + first);
        scree_lanes_copy(g->tangential_stiffness, old_list->tangential_stiffness + first);
        scree_lanes_copy(g->old_elastic_energy, old_list->elastic_energy + first);
        scree_lanes_copy(g->old_spring_energy, old_list->spring_energy + first);
        return;
    }
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const int64_t old = old_of_contact[l];
        const bool is_old = old >= 0;
        scree_lanes_set(&g->spring_force, l, is_old ? old_list->spring_force[old] : scree_vec3_zero());
        g->tangential_stiffness[l] = is_old ? old_list->tangential_stiffness[old] : 0;
        g->old_elastic_energy[l] = is_old ? old_list->elastic_energy[old] : 0;
        g->old_spring_energy[l] = is_old ? old_list->spring_energy[old] : 0;
    }
}

static void load_group(scree_force_group *restrict g, const scree_contact_force_args *restrict a, int64_t first)
{
    const scree_contact_list *list = &a->contacts;
    scree_load_motions(&g->i, &g->j, &a->bodies, list->bodies + first);
    scree_lanes_load(&g->arm, list->arm + first);
    scree_lanes_load(&g->normal, list->normal + first);
    scree_lanes_copy(g->volume, list->volume + first);
    scree_lanes_copy(g->indentation, list->indentation + first);
    load_history(g, &a->old_contacts, a->old_of_contact + first);
}

/// The Coulomb limit. In a bed at rest few contacts reach it, and roots and quotients take most of the time of a law.
static void limit_of_lanes(scree_force_group *restrict g)
{
    scree_real is_reached[SCREE_LANES];
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const bool is_slipping = scree_is_longer(scree_lanes_get(&g->tangential_force, l), g->limit[l]);
        const bool is_cut = scree_is_longer(scree_lanes_get(&g->spring_force, l), g->limit[l]);
        is_reached[l] = (is_slipping | is_cut) ? 1 : 0;
        g->slip[l] = is_slipping ? 1 : 0;
    }
    if (scree_lanes_is_none(is_reached)) return;
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        scree_contact_force f;
        f.tangential_force = scree_lanes_get(&g->tangential_force, l);
        f.spring_force = scree_lanes_get(&g->spring_force, l);
        scree_friction_limit(g->limit[l], &f);
        scree_lanes_set(&g->tangential_force, l, f.tangential_force);
        scree_lanes_set(&g->spring_force, l, f.spring_force);
    }
}

/// The lane loop, with a law whose choices are known here.
static void law_of_lanes(scree_force_group *restrict g, const scree_force_law *law, int32_t model, scree_real time_step)
{
    scree_force_law known = *law;
    known.model = model;
    known.rolling = SCREE_ROLLING_NONE;
    known.has_tangential_spring = true;
    known.has_moments = false;
    known.has_attraction = false;
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        scree_contact_kinematics k = {0};
        k.volume = g->volume[l];
        k.indentation = g->indentation[l];
        k.normal = scree_lanes_get(&g->normal, l);
        k.relative_velocity = scree_velocity_of_lane(&g->i, &g->j, scree_lanes_get(&g->arm, l), l);
        k.effective_mass = 1 / (g->i.inverse_mass[l] + g->j.inverse_mass[l]);
        k.time_step = time_step;
        k.spring_force = scree_lanes_get(&g->spring_force, l);
        k.tangential_stiffness = g->tangential_stiffness[l];
        scree_contact_force f;
        const scree_real normal_force = scree_contact_law_without_limit(&known, &k, &f);
        scree_lanes_set(&g->normal_force, l, f.normal_force);
        scree_lanes_set(&g->tangential_force, l, f.tangential_force);
        scree_lanes_set(&g->spring_force, l, f.spring_force);
        g->elastic_force[l] = f.elastic_force;
        g->elastic_energy[l] = f.elastic_energy;
        g->tangential_stiffness[l] = f.tangential_stiffness;
        g->limit[l] = scree_coulomb_limit(&known, normal_force);
    }
    limit_of_lanes(g);
    for (int l = 0; l < SCREE_LANES; ++l)
        g->spring_energy[l] = scree_spring_energy(scree_lanes_get(&g->spring_force, l), g->tangential_stiffness[l]);
}

static void store_group(const scree_force_group *restrict g, const scree_contact_list *restrict list, int64_t first)
{
    scree_lanes_store(list->normal_force + first, &g->normal_force);
    scree_lanes_store(list->tangential_force + first, &g->tangential_force);
    scree_lanes_store(list->spring_force + first, &g->spring_force);
    scree_lanes_copy(list->elastic_force + first, g->elastic_force);
    scree_lanes_copy(list->tangential_stiffness + first, g->tangential_stiffness);
    scree_lanes_copy(list->elastic_energy + first, g->elastic_energy);
    scree_lanes_copy(list->spring_energy + first, g->spring_energy);
    scree_real *elastic_work = list->elastic_work + first, *spring_work = list->spring_work + first;
    for (int l = 0; l < SCREE_LANES; ++l) elastic_work[l] = g->elastic_energy[l] - g->old_elastic_energy[l];
    for (int l = 0; l < SCREE_LANES; ++l) spring_work[l] = g->spring_energy[l] - g->old_spring_energy[l];
    for (int l = 0; l < SCREE_LANES; ++l) list->is_slipping[first + l] = g->slip[l] > 0;
}

SCREE_LANES_FUNCTION static void hertz_mindlin_of_group(const scree_contact_force_args *a, const scree_force_law *law,
                                                        int64_t first)
{
    scree_force_group g;
    load_group(&g, a, first);
    law_of_lanes(&g, law, SCREE_MODEL_HERTZ_MINDLIN, a->time_step);
    store_group(&g, &a->contacts, first);
}

SCREE_LANES_FUNCTION static void linear_spring_of_group(const scree_contact_force_args *a, const scree_force_law *law,
                                                        int64_t first)
{
    scree_force_group g;
    load_group(&g, a, first);
    law_of_lanes(&g, law, SCREE_MODEL_LINEAR_SPRING, a->time_step);
    store_group(&g, &a->contacts, first);
}

static const scree_force_law *law_of(const scree_contact_force_args *a, int64_t c)
{
    const scree_candidate_pair pair = a->contacts.bodies[c];
    return a->laws + (int64_t)a->bodies.moving[pair.i].material * a->num_materials + a->bodies.moving[pair.j].material;
}

/// The law of all contacts of a group, if it is one that lanes know; otherwise NULL.
static const scree_force_law *law_of_group(const scree_contact_force_args *a, int64_t first)
{
    const scree_force_law *law = law_of(a, first);
    bool is_one = law->model != SCREE_MODEL_ENERGY_CONSERVING && law->rolling == SCREE_ROLLING_NONE &&
                  law->has_tangential_spring && !law->has_attraction;
    for (int l = 1; l < SCREE_LANES && a->num_materials > 1; ++l) is_one &= law_of(a, first + l) == law;
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
    if (law->model == SCREE_MODEL_LINEAR_SPRING) linear_spring_of_group(a, law, first);
    else hertz_mindlin_of_group(a, law, first);
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
