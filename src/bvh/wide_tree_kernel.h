/// \file wide_tree_kernel.h
/// A tree with eight children per node over boxes that never change: the triangles of a shape, in its body frame.
/// Nodes are complete and need no links: node j of a level holds the boxes of nodes 8 j to 8 j + 7 of the level below,
/// at the lowest those of the items. Boxes are in single precision, rounded outwards, eight to a node side by side, so
/// that a query tests them together.
#ifndef SCREE_WIDE_TREE_KERNEL_H
#define SCREE_WIDE_TREE_KERNEL_H

#include "bvh/wide_boxes_kernel.h"
#include "core/bits.h"

#define SCREE_WIDE_CHILDREN SCREE_WIDE
#define SCREE_WIDE_LEVELS 10 ///< enough for 2^30 items

/// The boxes of eight children; of those that are not there, empty ones.
typedef scree_wide_boxes scree_wide_node;

/// The corners of eight triangles.
typedef struct scree_wide_corners
{
    float x[3][SCREE_WIDE_CHILDREN], y[3][SCREE_WIDE_CHILDREN], z[3][SCREE_WIDE_CHILDREN];
} scree_wide_corners;

/// Borrowed pointers.
typedef struct scree_wide_tree_view
{
    const scree_wide_node *nodes;          ///< level by level from the lowest, or NULL
    const scree_wide_corners *corners;     ///< (nodes of the lowest level) of the items, triangles; NULL: unknown
    const int32_t *items;                  ///< (num_items) in the order of the lowest level
    int32_t first_node[SCREE_WIDE_LEVELS]; ///< of each level
    int32_t num_levels;
    int32_t num_items;
} scree_wide_tree_view;

/// direction . x <= reach
typedef struct scree_wide_half_space
{
    float direction[3];
    float reach;     ///< widened by the rounding of the products
    int32_t near[3]; ///< bounds of the corner of a box that is deepest in it
} scree_wide_half_space;

#define SCREE_WIDE_SIDES 4

/// What is looked for: boxes that overlap a box and reach into half-spaces. Triangles must reach into the first of
/// these by a corner; for the others, the sides, their boxes are enough.
typedef struct scree_wide_query
{
    scree_wide_range range;
    scree_wide_half_space half_space;
    scree_wide_half_space sides[SCREE_WIDE_SIDES];
    int32_t num_sides;
} scree_wide_query;

/// `size` bounds every coordinate of the tree.
SCREE_FN scree_wide_half_space scree_wide_half_space_make(scree_vec3 direction, scree_real reach, scree_real size)
{
    const scree_real along[3] = {direction.x, direction.y, direction.z};
    scree_wide_half_space half_space;
    scree_real rounding = 0;
    for (int32_t k = 0; k < 3; ++k)
    {
        half_space.direction[k] = (float)along[k];
        half_space.near[k] = along[k] > 0 ? k : k + 3;
        rounding += scree_abs(along[k]) * size;
    }
    half_space.reach = scree_float_above(reach + 8 * (scree_real)FLT_EPSILON * rounding);
    return half_space;
}

/// Without sides.
SCREE_FN void scree_wide_query_set(scree_wide_query *query, scree_box box, scree_wide_half_space half_space)
{
    query->range.lower[0] = scree_float_below(box.lower.x);
    query->range.lower[1] = scree_float_below(box.lower.y);
    query->range.lower[2] = scree_float_below(box.lower.z);
    query->range.upper[0] = scree_float_above(box.upper.x);
    query->range.upper[1] = scree_float_above(box.upper.y);
    query->range.upper[2] = scree_float_above(box.upper.z);
    query->half_space = half_space;
    query->num_sides = 0;
}

SCREE_FN void scree_wide_query_add_side(scree_wide_query *query, scree_wide_half_space side)
{
    query->sides[query->num_sides++] = side;
}

/// Bits of the children whose boxes reach into a half-space.
SCREE_FN uint32_t scree_wide_boxes_reach(const scree_wide_node *node, const scree_wide_half_space *half_space)
{
    return scree_wide_points_within(node->bounds[half_space->near[0]], node->bounds[half_space->near[1]],
                                    node->bounds[half_space->near[2]], half_space->direction, half_space->reach);
}

/// Bits of the children that meet the box and the sides of a query.
SCREE_FN uint32_t scree_wide_boxes_between(const scree_wide_node *node, const scree_wide_query *query)
{
    uint32_t found = scree_wide_boxes_meet(node, &query->range);
    for (int32_t k = 0; k < query->num_sides && found != 0; ++k)
        found &= scree_wide_boxes_reach(node, query->sides + k);
    return found;
}

/// Bits of the children that may meet the query; all that do are among them.
SCREE_FN uint32_t scree_wide_node_query(const scree_wide_node *node, const scree_wide_query *query)
{
    return scree_wide_boxes_reach(node, &query->half_space) & scree_wide_boxes_between(node, query);
}

/// The same for a node of the lowest level: triangles by their corners, not their boxes, in the half-space.
SCREE_FN uint32_t scree_wide_leaf_query(const scree_wide_tree_view *tree, int32_t node, const scree_wide_query *query)
{
    if (tree->corners == NULL) return scree_wide_node_query(tree->nodes + node, query);
    const scree_wide_corners *corners = tree->corners + node;
    uint32_t within = 0;
    for (int32_t c = 0; c < 3; ++c)
        within |= scree_wide_points_within(corners->x[c], corners->y[c], corners->z[c], query->half_space.direction,
                                           query->half_space.reach);
    return within & scree_wide_boxes_between(tree->nodes + node, query);
}

/// Of a node of any level.
SCREE_FN uint32_t scree_wide_query_at(const scree_wide_tree_view *tree, int32_t level, int32_t node,
                                      const scree_wide_query *query)
{
    return level == 0 ? scree_wide_leaf_query(tree, node, query)
                      : scree_wide_node_query(tree->nodes + tree->first_node[level] + node, query);
}

/// What a walk over the tree looks for, and where it is.
typedef struct scree_wide_walk
{
    scree_wide_query query;
    uint32_t open[SCREE_WIDE_LEVELS]; ///< children still to visit
    int32_t node[SCREE_WIDE_LEVELS];
    int32_t level;
} scree_wide_walk;

/// Begins, once the query is there.
SCREE_FN void scree_wide_walk_start(const scree_wide_tree_view *tree, scree_wide_walk *walk)
{
    walk->level = tree->num_levels - 1;
    if (walk->level < 0) return;
    walk->node[walk->level] = 0;
    walk->open[walk->level] = scree_wide_query_at(tree, walk->level, 0, &walk->query);
}

/// Next node of the lowest level of which something may meet the query: its number, its children in *found; -1 at the
/// end.
SCREE_FN int32_t scree_wide_walk_next(const scree_wide_tree_view *tree, scree_wide_walk *walk, uint32_t *found)
{
    while (walk->level < tree->num_levels && walk->level >= 0)
    {
        if (walk->open[walk->level] == 0)
        {
            ++walk->level;
            continue;
        }
        if (walk->level == 0)
        {
            *found = walk->open[0];
            walk->open[0] = 0;
            return walk->node[0];
        }
        const int32_t child = SCREE_WIDE_CHILDREN * walk->node[walk->level] + scree_lowest_bit(walk->open[walk->level]);
        walk->open[walk->level] &= walk->open[walk->level] - 1;
        --walk->level;
        walk->node[walk->level] = child;
        walk->open[walk->level] = scree_wide_query_at(tree, walk->level, child, &walk->query);
    }
    return -1;
}

#endif
