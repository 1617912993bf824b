#include "contact/narrow_phase_launch.h"

#include <string.h>

SCREE_DEFINE_LAUNCH(scree_pair_flag)
SCREE_DEFINE_LAUNCH(scree_pair_scatter)
SCREE_DEFINE_LAUNCH(scree_pair_keep)
SCREE_DEFINE_LAUNCH(scree_pair_carry)
SCREE_DEFINE_LAUNCH_FEW(scree_overlap_pairs)
SCREE_DEFINE_LAUNCH_FEW(scree_overlap_patches)
SCREE_DEFINE_LAUNCH_DYNAMIC(scree_mesh_gap)
SCREE_DEFINE_LAUNCH(scree_mesh_write)
SCREE_DEFINE_LAUNCH(scree_room)

enum
{
    BLOCK_PAIRS = 64
};

/// Entries begin .. end - 1, at most a block: those that may touch to the lists of their classes, together, so that
/// threads meet seldom.
static void find_active(const scree_mesh_apart_args *a, int64_t begin, int64_t end)
{
    int32_t active[SCREE_NUM_WORK_CLASSES][BLOCK_PAIRS];
    int64_t num[SCREE_NUM_WORK_CLASSES] = {0};
    for (int64_t m = begin; m < end; ++m)
    {
        const int32_t work_class = scree_class_if_active(a, m);
        if (work_class >= 0) active[work_class][num[work_class]++] = (int32_t)m;
    }
    for (int32_t c = a->classes.first; c <= a->classes.last; ++c)
    {
        if (num[c] == 0) continue;
        int32_t *list = scree_active_of_class(a, c) + scree_atomic_count(a->tally->num_active + c, num[c]);
        memcpy(list, active[c], (size_t)num[c] * sizeof *list);
    }
}

void scree_mesh_apart_launch(scree_mesh_apart_args args, int64_t num)
{
    const int64_t num_blocks = (num + BLOCK_PAIRS - 1) / BLOCK_PAIRS;
#pragma omp parallel for schedule(dynamic, 1) if (num >= SCREE_LAUNCH_MIN)
    for (int64_t block = 0; block < num_blocks; ++block)
        find_active(&args, block * BLOCK_PAIRS, scree_min_count((block + 1) * BLOCK_PAIRS, num));
}

SCREE_DEFINE_LAUNCH_ON(scree_mesh_apart)
