/// \file pair_groups_kernel.h
/// Where a pair stands in a list of pairs that is made of groups: all entries of one first body stand together, sorted
/// by the ids of their second bodies. In which order the groups follow each other does not matter.
#ifndef SCREE_PAIR_GROUPS_KERNEL_H
#define SCREE_PAIR_GROUPS_KERNEL_H

#include "core/vec.h"

typedef struct scree_pair_groups
{
    const int32_t *first;  ///< (num) first body of entry k at k * stride
    const int32_t *second; ///< (num) second body, the same way
    const int32_t *ids;    ///< (num_bodies) of the bodies, or NULL: each is its own
    int64_t stride;
    int64_t num;    ///< of entries, at most INT32_MAX
    int32_t *begin; ///< (num_bodies) first entry of the body's group; zeroed before scree_group_bounds
    int32_t *end;   ///< (num_bodies) the entry behind its last one; zeroed before
} scree_pair_groups;

typedef scree_pair_groups scree_group_bounds_args;

/// Entry k: it notes where its group begins or ends, if it is the one to know.
SCREE_FN void scree_group_bounds_at(scree_group_bounds_args a, int64_t k)
{
    const int32_t body = a.first[k * a.stride];
    if (k == 0 || a.first[(k - 1) * a.stride] != body) a.begin[body] = (int32_t)k;
    if (k + 1 == a.num || a.first[(k + 1) * a.stride] != body) a.end[body] = (int32_t)(k + 1);
}

SCREE_FN int32_t scree_group_id(const scree_pair_groups *a, int32_t body) { return a->ids ? a->ids[body] : body; }

/// First entry of the group of `first` whose second body has no smaller id than this one; the end of the group if there
/// is none.
SCREE_FN int32_t scree_group_find(const scree_pair_groups *a, int32_t first, int32_t id)
{
    int32_t low = a->begin[first], high = a->end[first];
    while (low < high)
    {
        const int32_t middle = low + (high - low) / 2;
        if (scree_group_id(a, a->second[middle * a->stride]) < id) low = middle + 1;
        else high = middle;
    }
    return low;
}

#endif
