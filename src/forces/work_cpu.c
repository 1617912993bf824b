/// \file work_cpu.c
/// Work of the contacts on the CPU. Those that act in points are worked on in groups of lanes (lanes.h), and added
/// to the lanes of their sums.
#include "forces/forces.h"
#include "forces/motion_lanes.h"

SCREE_DEFINE_LAUNCH_ON(scree_work)

typedef struct scree_work_group
{
    scree_motion_lanes i, j;
    scree_lanes_vec3 arm, normal, normal_force, tangential_force;
    scree_real tangential_over_normal[SCREE_LANES], slip[SCREE_LANES];
    scree_real hysteresis[SCREE_LANES], damping[SCREE_LANES], friction[SCREE_LANES], viscous[SCREE_LANES];
    scree_real inverse_step_squared[SCREE_LANES]; ///< [1/s^2] k_eff/m_eff
} scree_work_group;

static void load_group(scree_work_group *restrict g, const scree_work_args *restrict a, int64_t first)
{
    const scree_contact_list *list = &a->contacts;
    scree_load_motions(&g->i, &g->j, &a->bodies, list->bodies + first);
    scree_lanes_load(&g->arm, list->arm + first);
    scree_lanes_load(&g->normal, list->normal + first);
    scree_lanes_load(&g->normal_force, list->normal_force + first);
    scree_lanes_load(&g->tangential_force, list->tangential_force + first);
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const int64_t material_i = a->bodies.moving[g->i.body[l]].material;
        const int32_t material_j = a->bodies.moving[g->j.body[l]].material;
        g->tangential_over_normal[l] = a->laws[material_i * a->num_materials + material_j].tangential_over_normal;
        g->slip[l] = list->is_slipping[first + l];
    }
}

static void work_of_lanes(scree_work_group *restrict g, const scree_work_args *restrict a, int64_t first)
{
    load_group(g, a, first);
    const scree_real *elastic_force = a->contacts.elastic_force + first;
    const scree_real *elastic_work = a->contacts.elastic_work + first, *spring_work = a->contacts.spring_work + first;
    const scree_real *tangential_stiffness = a->contacts.tangential_stiffness + first;
    const scree_real time_step = a->time_step;
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_vec3 v = scree_velocity_of_lane(&g->i, &g->j, scree_lanes_get(&g->arm, l), l);
        const scree_work_terms terms =
            scree_work_terms_make(scree_lanes_get(&g->normal, l), v, 0, scree_lanes_get(&g->normal_force, l),
                                  scree_lanes_get(&g->tangential_force, l), elastic_force[l], 0, time_step);
        const scree_work_losses losses = scree_work_losses_make(terms, elastic_work[l], spring_work[l], g->slip[l] > 0);
        g->hysteresis[l] = losses.hysteresis;
        g->damping[l] = losses.damping;
        g->friction[l] = losses.friction;
        g->viscous[l] = losses.viscous;
        const scree_real k_t = tangential_stiffness[l], k_n = k_t / g->tangential_over_normal[l];
        // walls have no inverse mass
        g->inverse_step_squared[l] = (g->i.inverse_mass[l] + g->j.inverse_mass[l]) * scree_max(k_n, k_t);
    }
}

/// Moving walls among the second bodies of a group work on the first ones.
static void add_work_of_walls(const scree_work_group *g, const scree_work_args *a, int64_t begin, int64_t n,
                              scree_work_block *block)
{
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        if (g->j.body[l] < a->num_particles) continue;
        const scree_vec3 point = scree_vec3_add(scree_lanes_get(&g->i.position, l), scree_lanes_get(&g->arm, l));
        const scree_vec3 arm_j = scree_vec3_sub(point, scree_lanes_get(&g->j.position, l));
        scree_team_sum_add(&block->input, n + l, scree_work_of_wall(a, begin + n + l, g->j.body[l], arm_j));
    }
}

/// Contacts n .. n + SCREE_LANES - 1 of the block that starts at contact `begin`. `largest` holds the largest inverse
/// of a step's square so far.
SCREE_LANES_FUNCTION static void add_group(const scree_work_args *restrict a, int64_t begin, int64_t n,
                                           scree_work_block *restrict block, scree_real *restrict largest)
{
    scree_work_group g;
    work_of_lanes(&g, a, begin + n);
    scree_real *restrict hysteresis = block->hysteresis.lane + n % SCREE_SUM_LANES;
    scree_real *restrict damping = block->damping.lane + n % SCREE_SUM_LANES;
    scree_real *restrict friction = block->friction.lane + n % SCREE_SUM_LANES;
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        hysteresis[l] += g.hysteresis[l];
        damping[l] += g.damping[l] + g.viscous[l];
        friction[l] += g.friction[l];
        largest[l] = scree_max(largest[l], g.inverse_step_squared[l]);
    }
    int32_t num_walls = 0;
    for (int l = 0; l < SCREE_LANES; ++l) num_walls += g.j.body[l] >= a->num_particles;
    if (num_walls > 0) add_work_of_walls(&g, a, begin, n, block);
}

/// Block b as scree_work_at() has it.
static void work_of_block(const scree_work_args *a, int64_t b)
{
    scree_work_block block;
    scree_work_begin(&block);
    const int64_t begin = b * SCREE_WORK_BLOCK, rest = a->contacts.num_contacts - begin;
    const int64_t num = rest < SCREE_WORK_BLOCK ? rest : SCREE_WORK_BLOCK;
    int64_t n = 0;
    scree_real largest[SCREE_LANES] = {0};
    for (; n + SCREE_LANES <= num; n += SCREE_LANES) add_group(a, begin, n, &block, largest);
    // the smallest of the quotients is the quotient of the largest: rounding keeps their order
    for (int l = 0; l < SCREE_LANES && n > 0; ++l)
        block.smallest_step_squared = scree_min(block.smallest_step_squared, 1 / largest[l]);
    for (; n < num; ++n) scree_work_add(&block, n, scree_work_of_contact(a, begin + n));
    const scree_team team = scree_team_alone();
    a->sums[b] = scree_work_total(&team, &block);
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
