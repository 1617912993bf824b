/// \file lbvh_kernel.h
/// Nodes and stackless traversal of the linear bounding-volume hierarchy, shared by particles, triangles and walls.
#ifndef SCREE_LBVH_KERNEL_H
#define SCREE_LBVH_KERNEL_H

#include "core/vec.h"

/// End of a traversal: no further node.
#define SCREE_LBVH_END (-1)

/// One node. A hit goes on with first_child, a miss or a leaf with escape (Prokopenko & Lebrun-Grandie 2024).
/// Nodes are stored depth first, so the first child of node k is k + 1, and so is the escape of a leaf that has one.
typedef struct scree_lbvh_node
{
    scree_box box;
    int32_t first_child; ///< inner node: its left child; leaf: ~item, that is -1 - item, always < 0
    int32_t escape;      ///< the node after this subtree, or SCREE_LBVH_END
} scree_lbvh_node;

/// A built tree as kernels see it: borrowed pointers.
typedef struct scree_lbvh_view
{
    const scree_lbvh_node *nodes; ///< (2 num_leaves - 1), or NULL if there are no leaves
    int32_t num_leaves;
    int32_t root; ///< SCREE_LBVH_END if there are no leaves
} scree_lbvh_view;

/// Goes on from node k (start with tree.root) to the next leaf whose box overlaps the query.
/// Returns the leaf's item and stores the node to go on from in *next; returns -1 at the end.
SCREE_FN int32_t scree_lbvh_next_overlap(scree_lbvh_view tree, scree_box query, int32_t k, int32_t *next)
{
    while (k != SCREE_LBVH_END)
    {
        const scree_lbvh_node *node = tree.nodes + k;
        if (!scree_box_overlaps(node->box, query))
        {
            k = node->escape;
            continue;
        }
        if (node->first_child < 0)
        {
            *next = node->escape;
            return -1 - node->first_child;
        }
        ++k;
    }
    *next = SCREE_LBVH_END;
    return -1;
}

/// Squared distance of a point to a box; 0 inside.
SCREE_FN scree_real scree_box_distance_squared(scree_box box, scree_vec3 p)
{
    const scree_real x = scree_max(0, scree_max(box.lower.x - p.x, p.x - box.upper.x));
    const scree_real y = scree_max(0, scree_max(box.lower.y - p.y, p.y - box.upper.y));
    const scree_real z = scree_max(0, scree_max(box.lower.z - p.z, p.z - box.upper.z));
    return x * x + y * y + z * z;
}

/// The lowest node above all leaves with boxes no farther than `radius` from `centre`; SCREE_LBVH_END if there are
/// none.
SCREE_FN int32_t scree_lbvh_node_around(scree_lbvh_view tree, scree_vec3 centre, scree_real radius)
{
    int32_t k = tree.root;
    while (k != SCREE_LBVH_END && tree.nodes[k].first_child >= 0)
    {
        const int32_t left = tree.nodes[k].first_child, right = tree.nodes[left].escape;
        const bool is_left = scree_box_distance_squared(tree.nodes[left].box, centre) <= radius * radius;
        const bool is_right = scree_box_distance_squared(tree.nodes[right].box, centre) <= radius * radius;
        if (is_left && is_right) return k;
        k = is_left ? left : is_right ? right : SCREE_LBVH_END;
    }
    return k;
}

/// True if a leaf's box is no farther than `radius` from `centre`.
SCREE_FN bool scree_lbvh_meets_sphere(scree_lbvh_view tree, scree_vec3 centre, scree_real radius)
{
    for (int32_t k = tree.root; k != SCREE_LBVH_END;)
    {
        const scree_lbvh_node *node = tree.nodes + k;
        const bool is_met = scree_box_distance_squared(node->box, centre) <= radius * radius;
        if (is_met && node->first_child < 0) return true;
        k = is_met ? k + 1 : node->escape;
    }
    return false;
}

#endif
