/// \file history_kernel.h
/// Which contact of the step before a contact continues: same pair and part of it, see SCREE_PATCH_BITS. The old one is
/// found by the index of its pair while the candidate pairs stay, and in the group of its first body after they have
/// changed, whatever the order of both lists.
#ifndef SCREE_HISTORY_KERNEL_H
#define SCREE_HISTORY_KERNEL_H

#include "contact/contact_list.h"
#include "contact/pair_groups_kernel.h"

typedef struct scree_history_match_args
{
    const scree_candidate_pair *pairs; ///< (num_pairs) present candidate pairs
    const int32_t *first_of_pair;      ///< (num_pairs + 1) present contacts of each
    const int32_t *old_first_of_pair;  ///< (num_pairs + 1) old contacts of each, or NULL if the pairs have changed
    scree_pair_groups old_groups;      ///< of the old contacts; only then
    const int32_t *patch;              ///< (num_contacts)
    const int32_t *old_patch;          ///< (num_old) NULL: no pair has several contacts, now or then
    const scree_vec3 *arm;             ///< (num_contacts)
    const scree_vec3 *old_arm;         ///< (num_old)
    int32_t *old_of_contact;           ///< (num_contacts) out: old contact or -1
    uint8_t *is_continued;             ///< (num_old) out: 1 where an old contact goes on; zeroed before
} scree_history_match_args;

/// Squared distance of two contact points, both measured from the same body.
SCREE_FN scree_real scree_history_distance(scree_vec3 a, scree_vec3 b)
{
    const scree_vec3 d = scree_vec3_sub(a, b);
    return scree_vec3_dot(d, d);
}

/// Do two contacts of one pair belong to the same part of it?
SCREE_FN bool scree_history_same_part(int32_t patch, int32_t old_patch)
{
    return patch >> SCREE_PATCH_BITS == old_patch >> SCREE_PATCH_BITS;
}

/// All contacts of candidate pair p, with old ones old_begin .. old_end - 1. Several patches of one part take their
/// nearest old patch that is still free, in ascending order of patch.
SCREE_FN void scree_history_match_pair(scree_history_match_args a, int64_t p, int32_t old_begin, int32_t old_end)
{
    const int32_t begin = a.first_of_pair[p], end = a.first_of_pair[p + 1];
    if (!a.old_patch)
    {
        a.old_of_contact[begin] = old_begin < old_end ? old_begin : -1;
        if (old_begin < old_end) a.is_continued[old_begin] = 1;
        return;
    }
    if (end - begin == 1 && old_end - old_begin == 1 && scree_history_same_part(a.patch[begin], a.old_patch[old_begin]))
    {
        a.old_of_contact[begin] = old_begin;
        a.is_continued[old_begin] = 1;
        return;
    }
    for (int32_t c = begin; c < end; ++c)
    {
        int32_t best = -1;
        scree_real best_distance = SCREE_REAL_MAX;
        for (int32_t o = old_begin; o < old_end; ++o)
        {
            if (!scree_history_same_part(a.patch[c], a.old_patch[o])) continue;
            const scree_real distance = scree_history_distance(a.arm[c], a.old_arm[o]);
            if (!a.is_continued[o] && distance < best_distance)
            {
                best = o;
                best_distance = distance;
            }
        }
        a.old_of_contact[c] = best;
        if (best >= 0) a.is_continued[best] = 1;
    }
}

/// All contacts of candidate pair p.
SCREE_FN void scree_history_match_at(scree_history_match_args a, int64_t p)
{
    if (a.first_of_pair[p] == a.first_of_pair[p + 1]) return;
    const scree_candidate_pair pair = a.pairs[p];
    const bool has_same_pairs = a.old_first_of_pair;
    const int32_t id = has_same_pairs ? -1 : scree_group_id(&a.old_groups, pair.j);
    const int32_t begin = has_same_pairs ? a.old_first_of_pair[p] : scree_group_find(&a.old_groups, pair.i, id);
    const int32_t end = has_same_pairs ? a.old_first_of_pair[p + 1] : scree_group_find(&a.old_groups, pair.i, id + 1);
    scree_history_match_pair(a, p, begin, end);
}

#endif
