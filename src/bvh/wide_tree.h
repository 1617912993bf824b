/// \file wide_tree.h
/// Builds a wide tree from a built LBVH, in the order of its leaves.
#ifndef SCREE_WIDE_TREE_H
#define SCREE_WIDE_TREE_H

#include "bvh/lbvh.h"
#include "bvh/wide_tree_kernel.h"

/// Owns its arrays. Start from {0}.
typedef struct scree_wide_tree
{
    scree_wide_tree_view view;
    scree_wide_node *nodes;
    scree_wide_corners *corners;
    int32_t *items;
} scree_wide_tree;

/// Builds the tree over `boxes` (num_boxes), which are those that `lbvh` was built over. SCREE_OUT_OF_MEMORY,
/// SCREE_TOO_MANY.
scree_status scree_wide_tree_build(scree_wide_tree *tree, const scree_lbvh *lbvh, const scree_box *boxes,
                                   int32_t num_boxes);
/// Adds `corners` (num_boxes, 3) of the triangles in the boxes to a tree that is built. SCREE_OUT_OF_MEMORY.
scree_status scree_wide_tree_add_corners(scree_wide_tree *tree, const scree_vec3 *corners);
void scree_wide_tree_destroy(scree_wide_tree *tree);

#endif
