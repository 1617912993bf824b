/// \file contact_force_cpu.c
/// Forces of contacts on the CPU. Contacts that act in points and whose laws are of one model and have no rolling
/// resistance, the usual ones of spheres, are worked on in groups of lanes (lanes.h); all others one by one.
#include "forces/forces.h"
#include "forces/motion_lanes.h"

SCREE_DEFINE_LAUNCH_ON(scree_contact_force)

/// What the law reads and gives of a group.
typedef struct scree_force_group
{
    scree_lanes_vec3 stiffness; ///< effective_modulus, stiffness_factor and normal_stiffness of the laws
    scree_lanes_vec3 losses;    ///< damping_ratio, tangential_damping_ratio and friction_coefficient
    scree_real tangential_over_normal[SCREE_LANES], unused[SCREE_LANES];
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
                         const int32_t *restrict old_of_contact)
{
    // contacts mostly last, and then follow each other in both lists
    const int32_t first = old_of_contact[0];
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
        const int32_t old = old_of_contact[l];
        const bool is_old = old >= 0;
        scree_lanes_set(&g->spring_force, l, is_old ? old_list->spring_force[old] : scree_vec3_zero());
        g->tangential_stiffness[l] = is_old ? old_list->tangential_stiffness[old] : 0;
        g->old_elastic_energy[l] = is_old ? old_list->elastic_energy[old] : 0;
        g->old_spring_energy[l] = is_old ? old_list->spring_energy[old] : 0;
    }
}

static void load_group(scree_force_group *restrict g, const scree_contact_force_args *restrict a,
                       const int32_t *restrict laws, int64_t first)
{
    // two times four numbers of each law
    const int64_t size = sizeof *a->laws;
    scree_lanes_gather(&g->stiffness, g->tangential_over_normal, &a->laws->effective_modulus, size, laws);
    scree_lanes_gather(&g->losses, g->unused, &a->laws->damping_ratio, size, laws);
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

/// The law of a lane; its choices are known here.
static scree_force_law law_of_lane(const scree_force_group *g, int32_t model, int lane)
{
    scree_force_law law = {0};
    law.effective_modulus = g->stiffness.x[lane];
    law.stiffness_factor = g->stiffness.y[lane];
    law.normal_stiffness = g->stiffness.z[lane];
    law.tangential_over_normal = g->tangential_over_normal[lane];
    law.damping_ratio = g->losses.x[lane];
    law.tangential_damping_ratio = g->losses.y[lane];
    law.friction_coefficient = g->losses.z[lane];
    law.model = model;
    law.rolling = SCREE_ROLLING_NONE;
    law.has_tangential_spring = true;
    return law;
}

/// The lane loop.
static void law_of_lanes(scree_force_group *restrict g, int32_t model, scree_real time_step)
{
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_force_law law = law_of_lane(g, model, l);
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
        const scree_real normal_force = scree_contact_law_without_limit(&law, &k, &f);
        scree_lanes_set(&g->normal_force, l, f.normal_force);
        scree_lanes_set(&g->tangential_force, l, f.tangential_force);
        scree_lanes_set(&g->spring_force, l, f.spring_force);
        g->elastic_force[l] = f.elastic_force;
        g->elastic_energy[l] = f.elastic_energy;
        g->tangential_stiffness[l] = f.tangential_stiffness;
        g->limit[l] = scree_coulomb_limit(&law, normal_force);
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

SCREE_LANES_FUNCTION static void hertz_mindlin_of_group(const scree_contact_force_args *a, const int32_t *laws,
                                                        int64_t first)
{
    scree_force_group g;
    load_group(&g, a, laws, first);
    law_of_lanes(&g, SCREE_MODEL_HERTZ_MINDLIN, a->time_step);
    store_group(&g, &a->contacts, first);
}

SCREE_LANES_FUNCTION static void linear_spring_of_group(const scree_contact_force_args *a, const int32_t *laws,
                                                        int64_t first)
{
    scree_force_group g;
    load_group(&g, a, laws, first);
    law_of_lanes(&g, SCREE_MODEL_LINEAR_SPRING, a->time_step);
    store_group(&g, &a->contacts, first);
}

static bool suits_lanes(const scree_force_law *law, int32_t model)
{
    return law->model == model && law->rolling == SCREE_ROLLING_NONE && law->has_tangential_spring &&
           !law->has_attraction;
}

/// The model of all laws, if it is one that lanes know and they suit; otherwise -1. Bodies whose materials have no law
/// do not meet.
static int32_t model_of_all(const scree_contact_force_args *a)
{
    int32_t model = -1;
    for (int32_t k = 0; k < a->num_materials * a->num_materials; ++k)
    {
        const scree_force_law *law = a->laws + k;
        if (!(law->effective_modulus > 0)) continue;
        if (model < 0) model = law->model;
        if (!suits_lanes(law, model)) return -1;
    }
    return model != SCREE_MODEL_ENERGY_CONSERVING ? model : -1;
}

/// The same of the contacts of a group.
static int32_t model_of_group(const scree_contact_force_args *a, const int32_t *laws)
{
    const int32_t model = a->laws[laws[0]].model;
    bool is_known = model != SCREE_MODEL_ENERGY_CONSERVING;
    for (int l = 0; l < SCREE_LANES; ++l) is_known &= suits_lanes(a->laws + laws[l], model);
    return is_known ? model : -1;
}

/// Contacts first .. first + SCREE_LANES - 1, which act in points; `model` is that of all laws or -1.
static void force_of_group(const scree_contact_force_args *a, int64_t first, int32_t model)
{
    int32_t laws[SCREE_LANES];
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_candidate_pair pair = a->contacts.bodies[first + l];
        laws[l] = a->bodies.moving[pair.i].material * a->num_materials + a->bodies.moving[pair.j].material;
    }
    if (model < 0) model = model_of_group(a, laws);
    if (model == SCREE_MODEL_HERTZ_MINDLIN) hertz_mindlin_of_group(a, laws, first);
    else if (model == SCREE_MODEL_LINEAR_SPRING) linear_spring_of_group(a, laws, first);
    else
        for (int l = 0; l < SCREE_LANES; ++l) scree_contact_force_at(*a, first + l);
}

void scree_contact_force_launch(scree_contact_force_args args, int64_t num)
{
    const int64_t num_groups = args.contacts.acts_in_points ? num / SCREE_LANES : 0;
    const int32_t model = model_of_all(&args);
#pragma omp parallel if (num >= SCREE_LAUNCH_MIN)
    {
#pragma omp for schedule(static) nowait
        for (int64_t k = 0; k < num_groups; ++k) force_of_group(&args, k * SCREE_LANES, model);
#pragma omp for schedule(static)
        for (int64_t c = num_groups * SCREE_LANES; c < num; ++c) scree_contact_force_at(args, c);
    }
}
