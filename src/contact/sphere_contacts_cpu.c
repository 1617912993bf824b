/// \file sphere_contacts_cpu.c
/// Pairs of spheres on the CPU, in groups of lanes (lanes.h): which of them touch, and the contacts of those that do,
/// picked from a block of pairs without a branch, for it cannot be foreseen.
#include "contact/sphere_pairs.h"
#include "contact/touching_pairs.h"
#include "core/lanes.h"

SCREE_DEFINE_LAUNCH_ON(scree_sphere_sphere_count)
SCREE_DEFINE_LAUNCH_ON(scree_sphere_sphere_write)

/// The spheres of a group of pairs.
typedef struct scree_sphere_group
{
    int32_t i[SCREE_LANES], j[SCREE_LANES];
    scree_lanes_vec3 centre_i, centre_j;
    scree_real radius_i[SCREE_LANES], radius_j[SCREE_LANES];
} scree_sphere_group;

static void load_group(scree_sphere_group *restrict g, const scree_sphere_pairs_args *restrict a, const int32_t *p)
{
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        g->i[l] = a->pairs[p[l]].i;
        g->j[l] = a->pairs[p[l]].j;
    }
    scree_lanes_gather(&g->centre_i, g->radius_i, a->spheres, sizeof *a->spheres, g->i);
    scree_lanes_gather(&g->centre_j, g->radius_j, a->spheres, sizeof *a->spheres, g->j);
}

/// Which of a group of pairs touch: entries of the batch from b on.
SCREE_LANES_FUNCTION static void count_group(const scree_sphere_pairs_args *a, int64_t b)
{
    scree_sphere_group g;
    int32_t p[SCREE_LANES];
    for (int l = 0; l < SCREE_LANES; ++l) p[l] = scree_pair_of_batch(a->batch, b + l);
    load_group(&g, a, p);
    int32_t num[SCREE_LANES];
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_vec3 between = scree_vec3_sub(scree_lanes_get(&g.centre_i, l), scree_lanes_get(&g.centre_j, l));
        num[l] = scree_spheres_touch(between, g.radius_i[l] + g.radius_j[l]) ? 1 : 0;
    }
    for (int l = 0; l < SCREE_LANES; ++l) a->list.first_of_pair[p[l]] = num[l];
}

void scree_sphere_sphere_count_launch(scree_sphere_sphere_count_args args, int64_t num)
{
    const int64_t num_groups = num / SCREE_LANES;
#pragma omp parallel for schedule(static) if (num >= SCREE_LAUNCH_MIN)
    for (int64_t k = 0; k < num_groups; ++k) count_group(&args, k * SCREE_LANES);
    for (int64_t b = num_groups * SCREE_LANES; b < num; ++b) scree_sphere_sphere_count_at(args, b);
}

/// Contacts of a group of touching pairs.
SCREE_LANES_FUNCTION static void write_group(const scree_sphere_pairs_args *a, const int32_t *touching)
{
    scree_sphere_group g;
    load_group(&g, a, touching);
    scree_lanes_vec3 normal, arm;
    scree_real volume[SCREE_LANES], indentation[SCREE_LANES];
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_sphere i = {scree_lanes_get(&g.centre_i, l), g.radius_i[l]};
        const scree_sphere j = {scree_lanes_get(&g.centre_j, l), g.radius_j[l]};
        const scree_sphere_pair_geometry geometry = scree_touching_pair(i, j);
        scree_lanes_set(&normal, l, geometry.normal);
        scree_lanes_set(&arm, l, geometry.arm);
        volume[l] = geometry.volume;
        indentation[l] = geometry.indentation;
    }
    const scree_contact_list list = a->list;
    const int64_t c = list.first_of_pair[touching[0]];
    if (list.acts_in_points && list.first_of_pair[touching[SCREE_LANES - 1]] == c + SCREE_LANES - 1)
    {
        // no contacts of other kinds between them
        for (int l = 0; l < SCREE_LANES; ++l) list.bodies[c + l] = a->pairs[touching[l]];
        for (int l = 0; l < SCREE_LANES; ++l) list.patch[c + l] = 0;
        scree_lanes_copy(list.volume + c, volume);
        scree_lanes_copy(list.indentation + c, indentation);
        scree_lanes_store(list.normal + c, &normal);
        scree_lanes_store(list.arm + c, &arm);
        return;
    }
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_sphere_pair_geometry geometry = {scree_lanes_get(&normal, l), scree_lanes_get(&arm, l), volume[l],
                                                     indentation[l]};
        scree_write_sphere_pair(list, touching[l], a->pairs[touching[l]], geometry);
    }
}

/// Pairs begin .. end - 1 of the batch.
static void write_block(const scree_sphere_pairs_args *a, int64_t begin, int64_t end)
{
    int32_t touching[SCREE_BLOCK_PAIRS + 1], n = 0;
    const int32_t num = scree_pick_touching(a->list.first_of_pair, a->batch, begin, end, touching);
    for (; n + SCREE_LANES <= num; n += SCREE_LANES) write_group(a, touching + n);
    for (; n < num; ++n)
    {
        const scree_candidate_pair pair = a->pairs[touching[n]];
        scree_write_sphere_pair(a->list, touching[n], pair,
                                scree_touching_pair(a->spheres[pair.i], a->spheres[pair.j]));
    }
}

void scree_sphere_sphere_write_launch(scree_sphere_sphere_write_args args, int64_t num)
{
    const int64_t num_blocks = (num + SCREE_BLOCK_PAIRS - 1) / SCREE_BLOCK_PAIRS;
#pragma omp parallel for schedule(static) if (num >= SCREE_LAUNCH_MIN)
    for (int64_t k = 0; k < num_blocks; ++k)
    {
        const int64_t begin = k * SCREE_BLOCK_PAIRS, end = begin + SCREE_BLOCK_PAIRS;
        write_block(&args, begin, end < num ? end : num);
    }
}
