/// \file lbvh_build_kernel.h
/// Build of the hierarchy, one leaf or inner node per call.
/// Karras (2012), "Maximizing parallelism in the construction of BVHs, octrees, and k-d trees": every inner node finds
/// its range of sorted leaves and its split by itself. Departures: codes of 63 bits; a node is known by its split
/// (the last leaf of its left child), as in Apetrei (2014); nodes are stored depth first, see
/// scree_lbvh_left_turns_at().
#ifndef SCREE_LBVH_BUILD_KERNEL_H
#define SCREE_LBVH_BUILD_KERNEL_H

#include "bvh/lbvh_kernel.h"
#include "bvh/morton_kernel.h"
#include "core/atomic_kernel.h"
#include "core/team.h"

/// The boxes are bounded in this many shares.
#define SCREE_LBVH_BOUNDS_CHUNKS 256

/// Leaves between asking for a box and reading it.
#define SCREE_LBVH_LOOK_AHEAD 16
#ifdef __CUDA_ARCH__
#define SCREE_LBVH_PREFETCH(address) ((void)(address))
#else
#define SCREE_LBVH_PREFETCH(address) __builtin_prefetch(address)
#endif

/// Arrays of a build. Sorted leaf r is item items[r] with code codes[r].
typedef struct scree_lbvh_build_args
{
    const scree_box *boxes;  ///< (num_leaves) by item
    uint64_t *codes;         ///< (num_leaves)
    int32_t *items;          ///< (num_leaves)
    int32_t *first_leaf;     ///< (num_leaves - 1) of the node with this split
    int32_t *last_leaf;      ///< (num_leaves - 1) of the node with this split
    uint8_t *num_left_turns; ///< (num_leaves) on the way from the root to leaf r
    int32_t *arrivals;       ///< (num_leaves - 1) children that have arrived at this split; 0 between launches
    scree_lbvh_node *nodes;  ///< (2 num_leaves - 1)
    scree_box *chunk_bounds; ///< (SCREE_LBVH_BOUNDS_CHUNKS)
    int64_t num_leaves;
    int64_t block_leaves; ///< sorted leaves per call of the last two passes
    scree_morton_frame frame;
} scree_lbvh_build_args;

typedef scree_lbvh_build_args scree_lbvh_bounds_args;
typedef scree_lbvh_build_args scree_lbvh_codes_args;
typedef scree_lbvh_build_args scree_lbvh_hierarchy_args;
typedef scree_lbvh_build_args scree_lbvh_left_turns_args;
typedef scree_lbvh_build_args scree_lbvh_nodes_args;

/// Bounds of the middles of share c of the boxes.
SCREE_FN void scree_lbvh_bounds_team_at(scree_lbvh_bounds_args a, const scree_team *team, int64_t c)
{
    const int64_t begin = a.num_leaves * c / SCREE_LBVH_BOUNDS_CHUNKS;
    const int64_t end = a.num_leaves * (c + 1) / SCREE_LBVH_BOUNDS_CHUNKS;
    scree_box bounds = scree_box_empty();
    for (int64_t i = begin + scree_team_lane(team); i < end; i += scree_team_size(team))
        bounds = scree_box_with_point(bounds, scree_morton_middle(a.boxes[i]));
    bounds.upper = scree_team_max3(team, bounds.upper);
    bounds.lower = scree_vec3_negate(scree_team_max3(team, scree_vec3_negate(bounds.lower)));
    if (scree_team_leads(team)) a.chunk_bounds[c] = bounds;
}

SCREE_FN void scree_lbvh_bounds_at(scree_lbvh_bounds_args a, int64_t c)
{
    const scree_team team = scree_team_alone();
    scree_lbvh_bounds_team_at(a, &team, c);
}

/// Code of box i, before the sort.
SCREE_FN void scree_lbvh_codes_at(scree_lbvh_codes_args a, int64_t i)
{
    a.codes[i] = scree_morton_code(scree_morton_middle(a.boxes[i]), a.frame);
    a.items[i] = (int32_t)i;
}

/// Length of the common prefix of the codes of sorted leaves i and j, longer for equal codes: these are told apart by
/// their index; -1 if j is not a leaf. Karras (2012), section 4.
SCREE_FN int32_t scree_lbvh_common_prefix(scree_lbvh_build_args a, int64_t i, int64_t j)
{
    if (j < 0 || j >= a.num_leaves) return -1;
    const uint64_t difference = a.codes[i] ^ a.codes[j];
    if (difference != 0) return scree_count_leading_zeros(difference);
    return 64 + scree_count_leading_zeros((uint64_t)(i ^ j));
}

/// Inner node i in Karras' numbering, i < num_leaves - 1: its range of leaves, stored under its split.
/// Karras (2012), fig. 4.
SCREE_FN void scree_lbvh_hierarchy_at(scree_lbvh_hierarchy_args a, int64_t i)
{
    // the range goes to the side with the longer common prefix
    const int64_t direction = scree_lbvh_common_prefix(a, i, i + 1) > scree_lbvh_common_prefix(a, i, i - 1) ? 1 : -1;
    const int32_t shortest = scree_lbvh_common_prefix(a, i, i - direction);

    // its other end: an upper bound by doubling, then by bisection
    int64_t max_length = 2;
    while (scree_lbvh_common_prefix(a, i, i + max_length * direction) > shortest) max_length *= 2;
    int64_t length = 0;
    for (int64_t step = max_length / 2; step > 0; step /= 2)
        if (scree_lbvh_common_prefix(a, i, i + (length + step) * direction) > shortest) length += step;
    const int64_t other = i + length * direction;

    // the split: the last leaf that shares more with this end than the two ends share
    const int32_t prefix = scree_lbvh_common_prefix(a, i, other);
    int64_t offset = 0;
    for (int64_t step = max_length / 2; step > 0; step /= 2)
        if (scree_lbvh_common_prefix(a, i, i + (offset + step) * direction) > prefix) offset += step;
    const int64_t split = direction > 0 ? i + offset : i - offset - 1;
    a.first_leaf[split] = (int32_t)(direction > 0 ? i : other);
    a.last_leaf[split] = (int32_t)(direction > 0 ? other : i);
}

/// How often the way from the root to each leaf of a block turns left. In the depth-first order of a binary tree the
/// nodes before the one over leaves l .. r are l leaves, l inner nodes with splits below l, and those ancestors in
/// whose left half it lies, one for each left turn: it is node 2 l + left turns. All nodes that end with leaf r make
/// the same left turns, one more than those that end with the last leaf of the node with split r.
SCREE_FN void scree_lbvh_left_turns_at(scree_lbvh_left_turns_args a, int64_t block)
{
    const int64_t begin = block * a.block_leaves;
    const int64_t end = begin + a.block_leaves < a.num_leaves ? begin + a.block_leaves : a.num_leaves;
    for (int64_t r = end - 1; r >= begin; --r)
    {
        // leaf by leaf to one of this block, whose number is known, or to the last one of all, which makes none
        int32_t num = 0;
        int64_t leaf = r;
        while (leaf + 1 < a.num_leaves && (leaf == r || leaf >= end))
        {
            leaf = a.last_leaf[leaf];
            ++num;
        }
        a.num_left_turns[r] = (uint8_t)(leaf > r && leaf < end ? num + a.num_left_turns[leaf] : num);
    }
}

/// Place of the node over sorted leaves first .. last.
SCREE_FN int32_t scree_lbvh_place(scree_lbvh_build_args a, int64_t first, int64_t last)
{
    return (int32_t)(2 * first + a.num_left_turns[last]);
}

/// Node of sorted leaf r.
SCREE_FN scree_lbvh_node scree_lbvh_leaf(scree_lbvh_build_args a, int64_t r, int32_t place)
{
    scree_lbvh_node node;
    node.box = a.boxes[a.items[r]];
    node.first_child = -1 - a.items[r];
    node.escape = r + 1 < a.num_leaves ? place + 1 : SCREE_LBVH_END;
    return node;
}

/// Block of sorted leaves, and every ancestor at which this call is the second to arrive: links and boxes. A box is
/// the union of the left and the right child's box in this order, whoever comes first. The arrivals are left at 0
/// again, so the same call with other boxes refits the tree. Nodes over leaves of this block alone are met by no other
/// call, so only the others need an atomic counter.
SCREE_FN void scree_lbvh_nodes_at(scree_lbvh_nodes_args a, int64_t block)
{
    const int64_t begin = block * a.block_leaves;
    const int64_t end = begin + a.block_leaves < a.num_leaves ? begin + a.block_leaves : a.num_leaves;
    for (int64_t r = begin; r < end; ++r)
    {
        // items lie anywhere in memory: asking for their boxes early takes most of the time out of this pass
        if (r + SCREE_LBVH_LOOK_AHEAD < a.num_leaves) SCREE_LBVH_PREFETCH(a.boxes + a.items[r + SCREE_LBVH_LOOK_AHEAD]);
        int64_t first = r, last = r;
        int32_t k = scree_lbvh_place(a, r, r);
        scree_lbvh_node node = scree_lbvh_leaf(a, r, k);
        a.nodes[k] = node;
        while (last - first + 1 < a.num_leaves)
        {
            // the parent splits after this node's last leaf or before its first one
            const bool is_left = last + 1 < a.num_leaves && a.first_leaf[last] == first;
            const int64_t split = is_left ? last : first - 1;
            first = a.first_leaf[split];
            last = a.last_leaf[split];
            if (first >= begin && last < end)
            {
                a.arrivals[split] ^= 1;
                if (a.arrivals[split] == 1) break;
            }
            else
            {
                if (scree_atomic_add_int32(a.arrivals + split, 1) == 0) break;
                a.arrivals[split] = 0;
            }
            k = scree_lbvh_place(a, first, last);
            if (is_left) node.box = scree_box_union(node.box, a.nodes[scree_lbvh_place(a, split + 1, last)].box);
            else node.box = scree_box_union(a.nodes[k + 1].box, node.box);
            node.first_child = k + 1;
            node.escape = last + 1 < a.num_leaves ? (int32_t)(k + 2 * (last - first) + 1) : SCREE_LBVH_END;
            a.nodes[k] = node;
        }
    }
}

#endif
