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

/// The boxes are bounded in this many shares.
#define SCREE_LBVH_BOUNDS_CHUNKS 256

/// Arrays of a build. Sorted leaf r is item items[r] with code codes[r].
typedef struct scree_lbvh_build_args
{
    const scree_box *boxes;  ///< (num_leaves) by item
    uint64_t *codes;         ///< (num_leaves)
    int32_t *items;          ///< (num_leaves)
    int32_t *first_leaf;     ///< (num_leaves - 1) of the node with this split
    int32_t *last_leaf;      ///< (num_leaves - 1) of the node with this split
    uint8_t *num_left_turns; ///< (num_leaves) on the way from the root to leaf r
    scree_lbvh_node *nodes;  ///< (2 num_leaves - 1)
    int32_t *parents;        ///< (2 num_leaves - 1) index of the parent node
    int32_t *arrivals;       ///< (2 num_leaves - 1) children that have arrived at the node; 0 between launches
    scree_box *chunk_bounds; ///< (SCREE_LBVH_BOUNDS_CHUNKS)
    int64_t num_leaves;
    scree_box bounds; ///< of the middles of the boxes
} scree_lbvh_build_args;

typedef scree_lbvh_build_args scree_lbvh_bounds_args;
typedef scree_lbvh_build_args scree_lbvh_codes_args;
typedef scree_lbvh_build_args scree_lbvh_hierarchy_args;
typedef scree_lbvh_build_args scree_lbvh_left_turns_args;
typedef scree_lbvh_build_args scree_lbvh_leaves_args;
typedef scree_lbvh_build_args scree_lbvh_inner_nodes_args;
typedef scree_lbvh_build_args scree_lbvh_refit_args;

/// Bounds of the middles of share c of the boxes.
SCREE_FN void scree_lbvh_bounds_at(scree_lbvh_bounds_args a, int64_t c)
{
    const int64_t begin = a.num_leaves * c / SCREE_LBVH_BOUNDS_CHUNKS;
    const int64_t end = a.num_leaves * (c + 1) / SCREE_LBVH_BOUNDS_CHUNKS;
    scree_box bounds = scree_box_empty();
    for (int64_t i = begin; i < end; ++i) bounds = scree_box_with_point(bounds, scree_box_middle(a.boxes[i]));
    a.chunk_bounds[c] = bounds;
}

/// Code of box i, before the sort.
SCREE_FN void scree_lbvh_codes_at(scree_lbvh_codes_args a, int64_t i)
{
    a.codes[i] = scree_morton_code(scree_box_middle(a.boxes[i]), a.bounds);
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
        if (offset + step < length && scree_lbvh_common_prefix(a, i, i + (offset + step) * direction) > prefix)
            offset += step;
    const int64_t split = direction > 0 ? i + offset : i - offset - 1;
    a.first_leaf[split] = (int32_t)(direction > 0 ? i : other);
    a.last_leaf[split] = (int32_t)(direction > 0 ? other : i);
}

/// How often the way from the root to sorted leaf r turns left. In the depth-first order of a binary tree the nodes
/// before the one over leaves l .. r are l leaves, l inner nodes with splits below l, and those ancestors in whose left
/// half it lies, one for each left turn: it is node 2 l + left turns. All nodes that end with leaf r make the same
/// left turns, and one more than those that end with the last leaf of the node with split r.
SCREE_FN void scree_lbvh_left_turns_at(scree_lbvh_left_turns_args a, int64_t r)
{
    int32_t num = 0;
    for (int64_t end = r; end + 1 < a.num_leaves; end = a.last_leaf[end]) ++num;
    a.num_left_turns[r] = (uint8_t)num;
}

/// Place of the node over sorted leaves first .. last.
SCREE_FN int32_t scree_lbvh_place(scree_lbvh_build_args a, int64_t first, int64_t last)
{
    return (int32_t)(2 * first + a.num_left_turns[last]);
}

/// Node of sorted leaf r, without its box.
SCREE_FN void scree_lbvh_leaves_at(scree_lbvh_leaves_args a, int64_t r)
{
    const int32_t k = scree_lbvh_place(a, r, r);
    a.nodes[k].first_child = -1 - a.items[r];
    a.nodes[k].escape = r + 1 < a.num_leaves ? k + 1 : SCREE_LBVH_END;
}

/// Inner node with this split, without its box; tells its children who their parent is.
SCREE_FN void scree_lbvh_inner_nodes_at(scree_lbvh_inner_nodes_args a, int64_t split)
{
    const int64_t first = a.first_leaf[split], last = a.last_leaf[split];
    const int32_t k = scree_lbvh_place(a, first, last);
    a.nodes[k].first_child = k + 1;
    a.nodes[k].escape = last + 1 < a.num_leaves ? (int32_t)(k + 2 * (last - first) + 1) : SCREE_LBVH_END;
    a.parents[k + 1] = k;
    a.parents[scree_lbvh_place(a, split + 1, last)] = k;
}

/// Box of sorted leaf r, and of every ancestor at which this call is the second to arrive: the union of the left and
/// the right child's box in this order, whoever comes first. The arrivals are left at 0 again.
SCREE_FN void scree_lbvh_refit_at(scree_lbvh_refit_args a, int64_t r)
{
    int32_t k = scree_lbvh_place(a, r, r);
    a.nodes[k].box = a.boxes[-1 - a.nodes[k].first_child];
    while (k > 0)
    {
        k = a.parents[k];
        if (scree_atomic_add_int32(a.arrivals + k, 1) == 0) return;
        a.arrivals[k] = 0;
        const scree_lbvh_node *left = a.nodes + k + 1;
        a.nodes[k].box = scree_box_union(left->box, a.nodes[left->escape].box);
    }
}

#endif
