/// \file work_cpu.c
/// Work of the contacts on the CPU. Those that act in points are worked on in groups of lanes (lanes.h), whatever their
/// first bodies are, and then added to the sums of these one by one.
#include "forces/forces.h"
#include "forces/motion_lanes.h"

#include <string.h>

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

/// The sums of following bodies, whose contacts follow each other too.
typedef struct scree_work_range
{
    int64_t begin, end; ///< bodies, at most SCREE_WORK_BLOCK
    scree_real hysteresis[SCREE_WORK_BLOCK], damping[SCREE_WORK_BLOCK];
    scree_real friction[SCREE_WORK_BLOCK], input[SCREE_WORK_BLOCK];
    scree_real largest[SCREE_LANES]; ///< [1/s^2] largest inverse of a step's square so far
    scree_real smallest_step_squared;
} scree_work_range;

static void add_to_range(scree_work_range *r, int64_t i, scree_work_sums one)
{
    r->hysteresis[i - r->begin] += one.hysteresis;
    r->damping[i - r->begin] += one.damping;
    r->friction[i - r->begin] += one.friction;
    r->input[i - r->begin] += one.input;
    r->smallest_step_squared = scree_min(r->smallest_step_squared, one.smallest_step_squared);
}

/// Moving walls among the second bodies of a group work on the first ones.
static void add_work_of_walls(const scree_work_group *g, const scree_work_args *a, int64_t first, scree_work_range *r)
{
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        if (g->j.body[l] < a->num_particles) continue;
        const scree_vec3 point = scree_vec3_add(scree_lanes_get(&g->i.position, l), scree_lanes_get(&g->arm, l));
        const scree_vec3 arm_j = scree_vec3_sub(point, scree_lanes_get(&g->j.position, l));
        r->input[g->i.body[l] - r->begin] += scree_work_of_wall(a, first + l, g->j.body[l], arm_j);
    }
}

/// Contacts first .. first + SCREE_LANES - 1 to the sums of their first bodies.
SCREE_LANES_FUNCTION static void add_group(const scree_work_args *restrict a, int64_t first,
                                           scree_work_range *restrict r)
{
    scree_work_group g;
    work_of_lanes(&g, a, first);
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        g.damping[l] += g.viscous[l];
        r->largest[l] = scree_max(r->largest[l], g.inverse_step_squared[l]);
    }
    int32_t num_walls = 0;
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const int64_t k = g.i.body[l] - r->begin;
        r->hysteresis[k] += g.hysteresis[l];
        r->damping[k] += g.damping[l];
        r->friction[k] += g.friction[l];
        num_walls += g.j.body[l] >= a->num_particles;
    }
    if (num_walls > 0) add_work_of_walls(&g, a, first, r);
}

/// What contacts of the range left that ended: in most ranges and steps none does.
static void add_ended(const scree_work_args *a, scree_work_range *r)
{
    const scree_old_contacts *old = &a->old;
    if (old->first_of_pair != NULL)
    {
        const int32_t first = old->first_of_pair[a->own_begin[r->begin]];
        const int32_t num = old->first_of_pair[a->own_begin[r->end]] - first;
        if (memchr(old->is_continued + first, 0, (size_t)num) == NULL) return;
    }
    for (int64_t i = r->begin; i < r->end; ++i)
    {
        scree_work_sums ended = scree_work_nothing();
        ended.hysteresis = r->hysteresis[i - r->begin];
        ended.friction = r->friction[i - r->begin];
        scree_work_add_ended(&ended, a, i);
        r->hysteresis[i - r->begin] = ended.hysteresis;
        r->friction[i - r->begin] = ended.friction;
    }
}

/// Bodies begin .. end - 1.
static void sum_range(const scree_work_args *a, scree_work_range *r, int64_t begin, int64_t end)
{
    memset(r, 0, sizeof *r);
    r->begin = begin;
    r->end = end;
    r->smallest_step_squared = SCREE_REAL_MAX;
    int64_t c = a->contacts.first_of_pair[a->own_begin[begin]];
    const int64_t end_contact = a->contacts.first_of_pair[a->own_begin[end]];
    if (a->contacts.acts_in_points && c + SCREE_LANES <= end_contact)
    {
        for (; c + SCREE_LANES <= end_contact; c += SCREE_LANES) add_group(a, c, r);
        // the smallest of the quotients is the quotient of the largest: rounding keeps their order
        for (int l = 0; l < SCREE_LANES; ++l)
            r->smallest_step_squared = scree_min(r->smallest_step_squared, 1 / r->largest[l]);
    }
    for (; c < end_contact; ++c) add_to_range(r, a->contacts.bodies[c].i, scree_work_of_contact(a, c));
    add_ended(a, r);
}

/// Sums of the range in lanes, as scree_work_at() has them.
static scree_work_sums total_of_range(const scree_work_range *restrict r)
{
    scree_work_block block;
    scree_work_begin(&block);
    const int64_t num = r->end - r->begin;
    int64_t n = 0;
    for (; n + SCREE_SUM_LANES <= num; n += SCREE_SUM_LANES)
        for (int l = 0; l < SCREE_SUM_LANES; ++l)
        {
            block.hysteresis.lane[l] += r->hysteresis[n + l];
            block.damping.lane[l] += r->damping[n + l];
            block.friction.lane[l] += r->friction[n + l];
            block.input.lane[l] += r->input[n + l];
        }
    for (; n < num; ++n)
    {
        scree_team_sum_add(&block.hysteresis, n, r->hysteresis[n]);
        scree_team_sum_add(&block.damping, n, r->damping[n]);
        scree_team_sum_add(&block.friction, n, r->friction[n]);
        scree_team_sum_add(&block.input, n, r->input[n]);
    }
    block.smallest_step_squared = r->smallest_step_squared;
    const scree_team team = scree_team_alone();
    return scree_work_total(&team, &block);
}

static int64_t end_of_block(const scree_work_args *a, int64_t b)
{
    const int64_t end = (b + 1) * SCREE_WORK_BLOCK;
    return end < a->num_particles ? end : a->num_particles;
}

/// What is kept of a body until its id comes.
enum
{
    DAMPING,
    FRICTION,
    HYSTERESIS,
    INPUT,
    NUM_KEPT
};

/// Sums of each body of block b of places. Returns the smallest step.
static scree_real keep_block(const scree_work_args *a, int64_t b)
{
    scree_work_range r;
    sum_range(a, &r, b * SCREE_WORK_BLOCK, end_of_block(a, b));
    for (int64_t i = r.begin; i < r.end; ++i)
    {
        scree_real *kept = a->of_bodies + i * NUM_KEPT;
        kept[DAMPING] = r.damping[i - r.begin];
        kept[FRICTION] = r.friction[i - r.begin];
        kept[HYSTERESIS] = r.hysteresis[i - r.begin];
        kept[INPUT] = r.input[i - r.begin];
    }
    return r.smallest_step_squared;
}

/// Block b of ids from what was kept.
static scree_work_sums total_of_ids(const scree_work_args *a, int64_t b)
{
    scree_work_range r;
    r.begin = b * SCREE_WORK_BLOCK;
    r.end = end_of_block(a, b);
    r.smallest_step_squared = SCREE_REAL_MAX;
    for (int64_t id = r.begin; id < r.end; ++id)
    {
        const scree_real *kept = a->of_bodies + (int64_t)a->places[id] * NUM_KEPT;
        r.damping[id - r.begin] = kept[DAMPING];
        r.friction[id - r.begin] = kept[FRICTION];
        r.hysteresis[id - r.begin] = kept[HYSTERESIS];
        r.input[id - r.begin] = kept[INPUT];
    }
    return total_of_range(&r);
}

void scree_work_launch(scree_work_args args, int64_t num)
{
    if (args.ids == NULL)
    {
#pragma omp parallel for schedule(static) if (num > 1)
        for (int64_t b = 0; b < num; ++b)
        {
            scree_work_range r;
            sum_range(&args, &r, b * SCREE_WORK_BLOCK, end_of_block(&args, b));
            args.sums[b] = total_of_range(&r);
        }
        return;
    }
    scree_real smallest = SCREE_REAL_MAX;
#pragma omp parallel for schedule(static) reduction(min : smallest) if (num > 1)
    for (int64_t b = 0; b < num; ++b) smallest = scree_min(smallest, keep_block(&args, b));
#pragma omp parallel for schedule(static) if (num > 1)
    for (int64_t b = 0; b < num; ++b) args.sums[b] = total_of_ids(&args, b);
    if (num > 0) args.sums->smallest_step_squared = smallest;
}
