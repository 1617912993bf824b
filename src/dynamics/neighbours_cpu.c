/// \file neighbours_cpu.c
/// How far bodies have moved, on the CPU. Particles of one shape that is a sphere are worked on in groups of lanes
/// (lanes.h); all others one by one.
#include "core/lanes.h"
#include "dynamics/dynamics.h"

SCREE_DEFINE_LAUNCH_ON(scree_travel)

/// False: not such a group, and nothing was done.
SCREE_LANES_FUNCTION static bool travel_group(const scree_travel_args *a, int64_t first)
{
    const int32_t *shape = a->shape + first;
    int32_t other = 0;
    for (int l = 1; l < SCREE_LANES; ++l) other |= shape[l] ^ shape[0];
    if (other != 0 || a->shapes[shape[0]].kind != SCREE_KIND_SPHERE) return false;

    const int64_t size = sizeof *a->pose;
    scree_lanes_vec3 from, to;
    scree_real unused[SCREE_LANES], moved[SCREE_LANES], is_other[SCREE_LANES];
    scree_lanes_gather(&from, unused, a->searched_pose + first, size, scree_lanes_in_order);
    scree_lanes_gather(&to, unused, a->pose + first, size, scree_lanes_in_order);
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        moved[l] = scree_shift(scree_lanes_get(&from, l), scree_lanes_get(&to, l));
        is_other[l] = moved[l] - moved[l] == 0 ? 0 : 1;
    }
    if (!scree_lanes_is_none(is_other)) return false;
    scree_real largest = 0;
    for (int l = 0; l < SCREE_LANES; ++l) largest = scree_max(largest, moved[l]);
    scree_atomic_max(a->particles_moved, largest);
    return true;
}

void scree_travel_launch(scree_travel_args args, int64_t num)
{
    const int64_t num_groups = (num + SCREE_LANES - 1) / SCREE_LANES;
#pragma omp parallel for schedule(static) if (num >= SCREE_LAUNCH_MIN)
    for (int64_t k = 0; k < num_groups; ++k)
    {
        const int64_t first = k * SCREE_LANES, end = first + SCREE_LANES < num ? first + SCREE_LANES : num;
        if (first + SCREE_LANES <= args.num_particles && travel_group(&args, first)) continue;
        for (int64_t i = first; i < end; ++i) scree_travel_at(args, i);
    }
}
