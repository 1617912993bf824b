/// \file history_cpu.c
/// History on the CPU, by blocks of candidate pairs. In most of them as many contacts belong to each pair as in the
/// step before, and at most one: then contact follows contact.
#include "contact/history.h"
#include "contact/touching_pairs.h"
#include "core/lanes.h"

#include <string.h>

SCREE_DEFINE_LAUNCH_ON(scree_history_match)
SCREE_DEFINE_LAUNCH(scree_group_bounds)

enum
{
    BLOCK_PAIRS = 64 ///< so few that all of them often last
};

/// Do pairs begin .. end - 1 have one contact or none, and the same ones in both lists?
SCREE_LANES_FUNCTION static bool is_unchanged(const scree_history_match_args *a, int64_t begin, int64_t end)
{
    const int32_t *first = a->first_of_pair + begin, *old_first = a->old_first_of_pair + begin;
    const int64_t num = end - begin;
    const int32_t shift = first[0] - old_first[0];
    int32_t wrong[SCREE_LANES] = {0};
    int64_t p = 0;
    for (; p + SCREE_LANES <= num; p += SCREE_LANES)
        for (int l = 0; l < SCREE_LANES; ++l)
        {
            wrong[l] |= first[p + l + 1] - old_first[p + l + 1] - shift;
            wrong[l] |= (first[p + l + 1] - first[p + l]) >> 1;
        }
    for (; p < num; ++p)
    {
        wrong[0] |= first[p + 1] - old_first[p + 1] - shift;
        wrong[0] |= (first[p + 1] - first[p]) >> 1;
    }
    for (int l = 1; l < SCREE_LANES; ++l) wrong[0] |= wrong[l];
    if (wrong[0] != 0 || a->old_patch == NULL) return wrong[0] == 0;

    const int32_t *patch = a->patch + first[0], *old_patch = a->old_patch + old_first[0];
    const int64_t num_contacts = first[num] - first[0];
    int32_t other[SCREE_LANES] = {0}; // bits in which parts differ
    int64_t c = 0;
    for (; c + SCREE_LANES <= num_contacts; c += SCREE_LANES)
        for (int l = 0; l < SCREE_LANES; ++l) other[l] |= (patch[c + l] ^ old_patch[c + l]) >> SCREE_PATCH_BITS;
    for (; c < num_contacts; ++c) other[0] |= (patch[c] ^ old_patch[c]) >> SCREE_PATCH_BITS;
    for (int l = 1; l < SCREE_LANES; ++l) other[0] |= other[l];
    return other[0] == 0;
}

static void match_block(const scree_history_match_args *a, int64_t begin, int64_t end)
{
    if (a->old_first_of_pair != NULL && is_unchanged(a, begin, end))
    {
        const int64_t first = a->first_of_pair[begin], num = a->first_of_pair[end] - first;
        const int64_t old = a->old_first_of_pair[begin];
        for (int64_t c = 0; c < num; ++c) a->old_of_contact[first + c] = (int32_t)(old + c);
        memset(a->is_continued + old, 1, (size_t)num);
        return;
    }
    int32_t touching[BLOCK_PAIRS + 1];
    const int32_t num_touching = scree_pick_touching(a->first_of_pair, NULL, begin, end, touching);
    for (int32_t n = 0; n < num_touching; ++n) scree_history_match_at(*a, touching[n]);
}

void scree_history_match_launch(scree_history_match_args args, int64_t num)
{
    const int64_t num_blocks = (num + BLOCK_PAIRS - 1) / BLOCK_PAIRS;
#pragma omp parallel for schedule(static) if (num >= SCREE_LAUNCH_MIN)
    for (int64_t k = 0; k < num_blocks; ++k)
    {
        const int64_t begin = k * BLOCK_PAIRS, end = begin + BLOCK_PAIRS;
        match_block(&args, begin, end < num ? end : num);
    }
}
