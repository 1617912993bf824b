/// \file gather_cpu.c
/// Forces on particles on the CPU: the sums of gather_kernel.h without its rows. While places are ids the contacts are
/// sorted by (i, j), so whoever takes one after the other and adds its force to both bodies adds to each in the order
/// of its row. What a contact adds is computed in groups of lanes (lanes.h).
///
/// A thread has a range of particles and takes the contacts whose first body is one of them. The contacts of a particle
/// with particles of lower ranges come first in its row; the few that have such are summed along their rows.
#include "core/lanes.h"
#include "forces/forces.h"

#include <omp.h>

SCREE_DEFINE_LAUNCH_ON(scree_gather)

/// What a group of contacts adds to the sums of its first and its second bodies.
typedef struct scree_gather_group
{
    int32_t i[SCREE_LANES], j[SCREE_LANES];
    scree_lanes_vec3 position_i, position_j, arm, normal_force, tangential_force;
    scree_lanes_vec3 moment; ///< zero where all contacts act in points
    scree_lanes_vec3 force, torque_i, torque_j;
    scree_real unused[SCREE_LANES];
} scree_gather_group;

SCREE_LANES_FUNCTION static void forces_of_lanes(scree_gather_group *restrict g, const scree_gather_args *restrict a,
                                                 int64_t first)
{
    const scree_contact_list *list = &a->contacts;
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        g->i[l] = list->bodies[first + l].i;
        g->j[l] = list->bodies[first + l].j;
    }
    scree_lanes_gather(&g->position_i, g->unused, a->pose, sizeof *a->pose, g->i);
    scree_lanes_gather(&g->position_j, g->unused, a->pose, sizeof *a->pose, g->j);
    scree_lanes_load(&g->arm, list->arm + first);
    scree_lanes_load(&g->normal_force, list->normal_force + first);
    scree_lanes_load(&g->tangential_force, list->tangential_force + first);
    if (!list->acts_in_points) scree_lanes_load(&g->moment, list->moment + first);
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_vec3 arm = scree_lanes_get(&g->arm, l), moment = scree_lanes_get(&g->moment, l);
        const scree_vec3 point = scree_vec3_add(scree_lanes_get(&g->position_i, l), arm);
        const scree_vec3 arm_j = scree_vec3_sub(point, scree_lanes_get(&g->position_j, l));
        const scree_vec3 force =
            scree_vec3_add(scree_lanes_get(&g->normal_force, l), scree_lanes_get(&g->tangential_force, l));
        scree_lanes_set(&g->force, l, force);
        scree_lanes_set(&g->torque_i, l, scree_vec3_add(scree_vec3_cross(arm, force), moment));
        scree_lanes_set(&g->torque_j, l, scree_vec3_sub(scree_vec3_cross(arm_j, scree_vec3_negate(force)), moment));
    }
}

/// The particles of a thread, and the first of their contacts with higher bodies.
typedef struct scree_gather_range
{
    int64_t first, end;
    int64_t first_contact, end_contact;
} scree_gather_range;

static void add_to(const scree_gather_args *a, int64_t k, scree_vec3 force, scree_vec3 torque)
{
    a->force[k] = scree_vec3_add(a->force[k], force);
    a->torque[k] = scree_vec3_add(a->torque[k], torque);
}

static void add_group(const scree_gather_group *g, const scree_gather_args *a, const scree_gather_range *range)
{
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_vec3 force = scree_lanes_get(&g->force, l);
        add_to(a, g->i[l], force, scree_lanes_get(&g->torque_i, l));
        // not walls, nor the particles of others
        if (g->j[l] < range->end) add_to(a, g->j[l], scree_vec3_negate(force), scree_lanes_get(&g->torque_j, l));
    }
}

/// Adds contact c to both of its bodies.
static void add_contact(const scree_gather_args *a, const scree_gather_range *range, int64_t c)
{
    const scree_candidate_pair pair = a->contacts.bodies[c];
    scree_gather_contact(a, c, pair.i, a->force + pair.i, a->torque + pair.i);
    if (pair.j < range->end) scree_gather_contact(a, c, pair.j, a->force + pair.j, a->torque + pair.j);
}

/// First contact whose first body is i or a higher one.
static int64_t find_contact(const scree_contact_list *list, int64_t i)
{
    int64_t low = 0, high = list->num_contacts;
    while (low < high)
    {
        const int64_t middle = low + (high - low) / 2;
        if (list->bodies[middle].i < i) low = middle + 1;
        else high = middle;
    }
    return low;
}

static void gather_range(const scree_gather_args *a, int64_t first, int64_t end)
{
    const scree_gather_range range = {first, end, find_contact(&a->contacts, first), find_contact(&a->contacts, end)};
    for (int64_t i = first; i < end; ++i)
    {
        a->force[i] = scree_vec3_scale(a->gravity, a->mass[i]);
        a->torque[i] = scree_vec3_zero();
    }
    scree_gather_group g = {0};
    int64_t c = range.first_contact;
    for (; c + SCREE_LANES <= range.end_contact; c += SCREE_LANES)
    {
        forces_of_lanes(&g, a, c);
        add_group(&g, a, &range);
    }
    for (; c < range.end_contact; ++c) add_contact(a, &range, c);
    for (int64_t i = first; i < end && range.first_contact > 0; ++i)
    {
        const bool has_pairs = a->row_begin[i + 1] > a->row_begin[i];
        if (has_pairs && a->contacts.first_of_pair[a->row_pairs[a->row_begin[i]]] < range.first_contact)
            scree_gather_at(*a, i);
    }
}

// ---- bodies that are not home

enum
{
    BLOCK_PARTICLES = 64,
    MAX_SECOND = 256 ///< contacts that are worked on at a time
};

/// Contacts of some particles in which they are the second bodies, in the order of their rows.
typedef struct scree_gather_list
{
    int32_t contact[MAX_SECOND], body[MAX_SECOND];
    int32_t num;
} scree_gather_list;

/// A group of contacts, and what they add to one of their bodies each.
typedef struct scree_side_group
{
    int32_t first[SCREE_LANES];
    scree_lanes_vec3 position_i, position_j, arm, normal_force, tangential_force;
    scree_lanes_vec3 moment; ///< zero where all contacts act in points
    scree_lanes_vec3 force, torque;
    scree_real unused[SCREE_LANES];
} scree_side_group;

/// On the second bodies of contacts in any places.
SCREE_LANES_FUNCTION static void second_sides(scree_side_group *restrict g, const scree_gather_args *restrict a,
                                              const int32_t *contact, const int32_t *body)
{
    const scree_contact_list *list = &a->contacts;
    const int64_t size = sizeof(scree_vec3);
    for (int l = 0; l < SCREE_LANES; ++l) g->first[l] = list->bodies[contact[l]].i;
    scree_lanes_gather(&g->position_i, g->unused, a->pose, sizeof *a->pose, g->first);
    scree_lanes_gather(&g->position_j, g->unused, a->pose, sizeof *a->pose, body);
    scree_lanes_gather(&g->arm, g->unused, list->arm, size, contact);
    scree_lanes_gather(&g->normal_force, g->unused, list->normal_force, size, contact);
    scree_lanes_gather(&g->tangential_force, g->unused, list->tangential_force, size, contact);
    if (!list->acts_in_points) scree_lanes_gather(&g->moment, g->unused, list->moment, size, contact);
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_vec3 point = scree_vec3_add(scree_lanes_get(&g->position_i, l), scree_lanes_get(&g->arm, l));
        const scree_vec3 arm_j = scree_vec3_sub(point, scree_lanes_get(&g->position_j, l));
        const scree_vec3 on_first =
            scree_vec3_add(scree_lanes_get(&g->normal_force, l), scree_lanes_get(&g->tangential_force, l));
        const scree_vec3 force = scree_vec3_negate(on_first), moment = scree_lanes_get(&g->moment, l);
        scree_lanes_set(&g->force, l, force);
        scree_lanes_set(&g->torque, l, scree_vec3_sub(scree_vec3_cross(arm_j, force), moment));
    }
}

/// On the first bodies of contacts that follow each other.
SCREE_LANES_FUNCTION static void first_sides(scree_side_group *restrict g, const scree_gather_args *restrict a,
                                             int64_t first)
{
    const scree_contact_list *list = &a->contacts;
    scree_lanes_load(&g->arm, list->arm + first);
    scree_lanes_load(&g->normal_force, list->normal_force + first);
    scree_lanes_load(&g->tangential_force, list->tangential_force + first);
    if (!list->acts_in_points) scree_lanes_load(&g->moment, list->moment + first);
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_vec3 force =
            scree_vec3_add(scree_lanes_get(&g->normal_force, l), scree_lanes_get(&g->tangential_force, l));
        const scree_vec3 arm = scree_lanes_get(&g->arm, l), moment = scree_lanes_get(&g->moment, l);
        scree_lanes_set(&g->force, l, force);
        scree_lanes_set(&g->torque, l, scree_vec3_add(scree_vec3_cross(arm, force), moment));
    }
}

static void add_second(const scree_gather_args *a, scree_gather_list *list)
{
    scree_side_group g = {0};
    int32_t n = 0, num_in_lanes = list->num;
    // what is gathered reaches beyond each vector, and nothing stands behind the last one
    for (int32_t k = 0; k < list->num; ++k)
        if (list->contact[k] + 1 == a->contacts.num_contacts && k < num_in_lanes) num_in_lanes = k;
    for (; n + SCREE_LANES <= num_in_lanes; n += SCREE_LANES)
    {
        second_sides(&g, a, list->contact + n, list->body + n);
        for (int l = 0; l < SCREE_LANES; ++l)
            add_to(a, list->body[n + l], scree_lanes_get(&g.force, l), scree_lanes_get(&g.torque, l));
    }
    for (; n < list->num; ++n)
    {
        const int32_t j = list->body[n];
        scree_gather_contact(a, list->contact[n], j, a->force + j, a->torque + j);
    }
    list->num = 0;
}

static void add_first(const scree_gather_args *a, int64_t begin, int64_t end)
{
    scree_side_group g = {0};
    int64_t c = begin;
    for (; c + SCREE_LANES <= end; c += SCREE_LANES)
    {
        first_sides(&g, a, c);
        for (int l = 0; l < SCREE_LANES; ++l)
            add_to(a, a->contacts.bodies[c + l].i, scree_lanes_get(&g.force, l), scree_lanes_get(&g.torque, l));
    }
    for (; c < end; ++c)
    {
        const int32_t i = a->contacts.bodies[c].i;
        scree_gather_contact(a, c, i, a->force + i, a->torque + i);
    }
}

/// Particles begin .. end - 1 along their rows: first those in which they are the second bodies, then the others, which
/// follow each other.
static void gather_block(const scree_gather_args *a, int64_t begin, int64_t end)
{
    scree_gather_list list = {.num = 0};
    const int32_t *first_of_pair = a->contacts.first_of_pair;
    for (int64_t i = begin; i < end; ++i)
    {
        a->force[i] = scree_vec3_scale(a->gravity, a->mass[i]);
        a->torque[i] = scree_vec3_zero();
        for (int64_t k = a->row_begin[i]; k < a->row_begin[i + 1]; ++k)
        {
            // no branch on whether there is one: it cannot be foreseen
            const int32_t first = first_of_pair[a->row_pairs[k]], num = first_of_pair[a->row_pairs[k] + 1] - first;
            if (list.num == MAX_SECOND) add_second(a, &list);
            list.contact[list.num] = first;
            list.body[list.num] = (int32_t)i;
            list.num += num > 0;
            for (int32_t c = 1; c < num; ++c)
            {
                if (list.num == MAX_SECOND) add_second(a, &list);
                list.contact[list.num] = first + c;
                list.body[list.num++] = (int32_t)i;
            }
        }
    }
    add_second(a, &list);
    add_first(a, first_of_pair[a->own_begin[begin]], first_of_pair[a->own_begin[end]]);
}

void scree_gather_launch(scree_gather_args args, int64_t num)
{
    if (!args.are_ids)
    {
        const int64_t num_blocks = (num + BLOCK_PARTICLES - 1) / BLOCK_PARTICLES;
#pragma omp parallel for schedule(static) if (num >= SCREE_LAUNCH_MIN)
        for (int64_t b = 0; b < num_blocks; ++b)
        {
            const int64_t begin = b * BLOCK_PARTICLES, end = begin + BLOCK_PARTICLES;
            gather_block(&args, begin, end < num ? end : num);
        }
        return;
    }
    const int64_t num_ranges = num < SCREE_LAUNCH_MIN ? 1 : omp_get_max_threads();
#pragma omp parallel for schedule(static, 1) if (num_ranges > 1)
    for (int64_t r = 0; r < num_ranges; ++r) gather_range(&args, num * r / num_ranges, num * (r + 1) / num_ranges);
}
