/// \file sphere_contacts_cpu.c
/// Contacts of touching spheres to the list on the CPU: of a block of candidate pairs those that touch are picked
/// without a branch, for it cannot be foreseen, and then worked on in groups of lanes (lanes.h).
#include "contact/sphere_pairs.h"
#include "contact/touching_pairs.h"
#include "core/lanes.h"

SCREE_DEFINE_LAUNCH_ON(scree_sphere_sphere_write)

typedef struct scree_sphere_group
{
    scree_lanes_vec3 centre_i, centre_j, normal, arm;
    scree_real radius_i[SCREE_LANES], radius_j[SCREE_LANES], volume[SCREE_LANES], indentation[SCREE_LANES];
} scree_sphere_group;

SCREE_LANES_FUNCTION static void geometry_of_lanes(scree_sphere_group *restrict g)
{
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_sphere i = {scree_lanes_get(&g->centre_i, l), g->radius_i[l]};
        const scree_sphere j = {scree_lanes_get(&g->centre_j, l), g->radius_j[l]};
        const scree_sphere_pair_geometry geometry = scree_touching_pair(i, j);
        scree_lanes_set(&g->normal, l, geometry.normal);
        scree_lanes_set(&g->arm, l, geometry.arm);
        g->volume[l] = geometry.volume;
        g->indentation[l] = geometry.indentation;
    }
}

/// Group of touching pairs.
static void write_group(const scree_sphere_pairs_args *a, const int32_t *touching)
{
    scree_sphere_group g;
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_candidate_pair pair = a->pairs[touching[l]];
        scree_lanes_set(&g.centre_i, l, a->spheres[pair.i].centre);
        scree_lanes_set(&g.centre_j, l, a->spheres[pair.j].centre);
        g.radius_i[l] = a->spheres[pair.i].radius;
        g.radius_j[l] = a->spheres[pair.j].radius;
    }
    geometry_of_lanes(&g);
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_sphere_pair_geometry geometry = {scree_lanes_get(&g.normal, l), scree_lanes_get(&g.arm, l),
                                                     g.volume[l], g.indentation[l]};
        scree_write_sphere_pair(a->list, touching[l], a->pairs[touching[l]], geometry);
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
