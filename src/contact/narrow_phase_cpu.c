#include "contact/narrow_phase_launch.h"

#include <string.h>

SCREE_DEFINE_LAUNCH(scree_pair_flag)
SCREE_DEFINE_LAUNCH(scree_pair_scatter)
SCREE_DEFINE_LAUNCH(scree_pair_keep)
SCREE_DEFINE_LAUNCH(scree_pair_carry)
SCREE_DEFINE_LAUNCH_DYNAMIC(scree_mesh_gap)
SCREE_DEFINE_LAUNCH(scree_mesh_write)
SCREE_DEFINE_LAUNCH(scree_room)

enum
{
    BLOCK_PAIRS = 64, ///< candidates that are looked at together
    TAKEN_PAIRS = 8   ///< active ones that are taken together
};

/// Entries begin .. end - 1, at most a block: those that may touch to the lists of their classes, together, so that
/// threads meet seldom.
static void find_active(const scree_mesh_apart_args *a, scree_pair_share *share, int64_t begin, int64_t end)
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
        int32_t *list = scree_active_of_class(a, c) + share->begin + scree_atomic_count(share->num_active + c, num[c]);
        memcpy(list, active[c], (size_t)num[c] * sizeof *list);
    }
}

/// Looks at blocks of a share until none is left.
static void look_at_share(const scree_mesh_apart_args *a, scree_pair_share *share)
{
    for (;;)
    {
        const int64_t begin = share->begin + scree_atomic_count(&share->num_looked, BLOCK_PAIRS);
        if (begin >= share->end) return;
        find_active(a, share, begin, scree_min_count(begin + BLOCK_PAIRS, share->end));
    }
}

void scree_mesh_apart_launch(scree_mesh_apart_args args, int64_t num)
{
    const int32_t num_shares = args.num_shares;
    for (int32_t k = 0; k < num_shares; ++k)
        args.shares[k] = (scree_pair_share){.begin = num * k / num_shares, .end = num * (k + 1) / num_shares};
#pragma omp parallel for schedule(static, 1) if (num >= SCREE_LAUNCH_MIN)
    for (int32_t i = 0; i < num_shares; ++i)
        for (int32_t k = 0; k < num_shares; ++k) look_at_share(&args, args.shares + (i + k) % num_shares);
    for (int32_t k = 0; k < num_shares; ++k)
        for (int32_t c = args.classes.first; c <= args.classes.last; ++c)
            args.tally->num_active[c] += args.shares[k].num_active[c];
}

SCREE_DEFINE_LAUNCH_ON(scree_mesh_apart)

/// Index i takes active pairs of a share until none is left.
static void take_share(const scree_overlap_pairs_args *a, int32_t i, scree_pair_share *share, bool may_separate)
{
    const scree_team team = scree_team_alone();
    const int64_t num_active = share->num_active[a->work_class];
    for (;;)
    {
        const int64_t begin = scree_atomic_count(share->num_taken + a->work_class, TAKEN_PAIRS);
        if (begin >= num_active) return;
        const int64_t end = scree_min_count(begin + TAKEN_PAIRS, num_active);
        for (int64_t k = begin; k < end; ++k)
            scree_overlap_of_pair(a, &team, i, (int32_t)(share->begin + k), may_separate);
    }
}

static void take_pairs(const scree_overlap_pairs_args *a, int64_t num, bool may_separate)
{
    const int32_t num_shares = a->meshes.num_shares, num_takers = (int32_t)num;
#pragma omp parallel for schedule(static, 1) if (num_takers > 1)
    for (int32_t i = 0; i < num_takers; ++i)
        for (int32_t k = 0; k < num_shares; ++k)
            take_share(a, i, a->meshes.shares + (i + k) % num_shares, may_separate);
}

void scree_overlap_pairs_launch(scree_overlap_pairs_args args, int64_t num) { take_pairs(&args, num, false); }

SCREE_DEFINE_LAUNCH_ON(scree_overlap_pairs)

void scree_overlap_patches_launch(scree_overlap_patches_args args, int64_t num) { take_pairs(&args, num, true); }

SCREE_DEFINE_LAUNCH_ON(scree_overlap_patches)
