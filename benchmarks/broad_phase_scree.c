#include "broad_phase_scree.h"

#include "bvh/broad_phase.h"
#include "bvh/bvh_launch.h"
#include "core/sort.h"

/// Kept from search to search, as in a run.
static scree_broad_phase broad_phase;
static scree_sort_buffers keys;

_Static_assert(sizeof(scree_box) == 6 * sizeof(double), "boxes are passed as six numbers");

int64_t scree_bench_search_unsorted(const double (*boxes)[6], int64_t num)
{
    for (;;)
    {
        int64_t num_keys = 0;
        if (scree_lbvh_build(&broad_phase.tree, (const scree_box *)boxes, num) != SCREE_OK) return -1;
        const scree_particle_pairs_args args = {
            .tree = broad_phase.tree.view,
            .list = {.keys = keys.keys, .num_keys = &num_keys, .max_keys = keys.max_items, .id_bits = 31}};
        scree_particle_pairs_find(args);
        // a list that was too short has counted all pairs
        if (num_keys <= keys.max_items) return num_keys;
        if (scree_sort_reserve(&keys, num_keys, false) != SCREE_OK) return -1;
    }
}

int64_t scree_bench_search_sorted(const double (*boxes)[6], int64_t num)
{
    const scree_broad_phase_input input = {.boxes = (const scree_box *)boxes, .num_particles = num};
    return scree_broad_phase_find(&broad_phase, &input) == SCREE_OK ? broad_phase.num_pairs : -1;
}
