#include "bvh/wide_tree.h"

#include <stdlib.h>

void scree_wide_tree_destroy(scree_wide_tree *tree)
{
    free(tree->nodes);
    free(tree->corners);
    free(tree->items);
    *tree = (scree_wide_tree){0};
}

/// Numbers of nodes per level, from the lowest to the one node at the top; their sum, or -1 if there are too many.
static int64_t plan_levels(scree_wide_tree_view *view)
{
    int64_t num_nodes = 0, below = view->num_items;
    while (view->num_levels == 0 || below > 1)
    {
        if (view->num_levels == SCREE_WIDE_LEVELS) return -1;
        view->first_node[view->num_levels++] = (int32_t)num_nodes;
        below = (below + SCREE_WIDE_CHILDREN - 1) / SCREE_WIDE_CHILDREN;
        num_nodes += below;
    }
    return num_nodes;
}

static void set_child(scree_wide_node *node, int32_t child, const float bounds[6])
{
    for (int k = 0; k < 6; ++k) node->bounds[k][child] = bounds[k];
}

/// The box around the children of a node.
static void node_bounds(const scree_wide_node *node, float bounds[6])
{
    for (int k = 0; k < 6; ++k)
    {
        bounds[k] = node->bounds[k][0];
        for (int c = 1; c < SCREE_WIDE_CHILDREN; ++c)
        {
            const float x = node->bounds[k][c];
            if (k < 3 ? x < bounds[k] : x > bounds[k]) bounds[k] = x;
        }
    }
}

static void fill_nodes(scree_wide_tree *tree, const scree_box *boxes, int64_t num_nodes)
{
    const scree_wide_tree_view *view = &tree->view;
    const float empty[6] = {FLT_MAX, FLT_MAX, FLT_MAX, -FLT_MAX, -FLT_MAX, -FLT_MAX};
    for (int64_t i = 0; i < num_nodes; ++i)
        for (int32_t c = 0; c < SCREE_WIDE_CHILDREN; ++c) set_child(tree->nodes + i, c, empty);
    for (int32_t i = 0; i < view->num_items; ++i)
    {
        const scree_box box = boxes[tree->items[i]];
        const float bounds[6] = {scree_float_below(box.lower.x), scree_float_below(box.lower.y),
                                 scree_float_below(box.lower.z), scree_float_above(box.upper.x),
                                 scree_float_above(box.upper.y), scree_float_above(box.upper.z)};
        set_child(tree->nodes + i / SCREE_WIDE_CHILDREN, i % SCREE_WIDE_CHILDREN, bounds);
    }
    for (int32_t level = 1; level < view->num_levels; ++level)
    {
        const int32_t below = view->first_node[level - 1];
        for (int32_t i = 0; below + i < view->first_node[level]; ++i)
        {
            float bounds[6];
            node_bounds(tree->nodes + below + i, bounds);
            set_child(tree->nodes + view->first_node[level] + i / SCREE_WIDE_CHILDREN, i % SCREE_WIDE_CHILDREN, bounds);
        }
    }
}

scree_status scree_wide_tree_build(scree_wide_tree *tree, const scree_lbvh *lbvh, const scree_box *boxes,
                                   int32_t num_boxes)
{
    scree_wide_tree_destroy(tree);
    if (num_boxes == 0) return SCREE_OK;
    tree->view.num_items = num_boxes;
    const int64_t num_nodes = plan_levels(&tree->view);
    if (num_nodes < 0)
    {
        *tree = (scree_wide_tree){0};
        return SCREE_TOO_MANY;
    }
    tree->nodes = malloc((size_t)num_nodes * sizeof *tree->nodes);
    tree->items = malloc((size_t)num_boxes * sizeof *tree->items);
    if (tree->nodes == NULL || tree->items == NULL)
    {
        scree_wide_tree_destroy(tree);
        return SCREE_OUT_OF_MEMORY;
    }
    // leaves from left to right: neighbours in space
    int32_t num = 0;
    for (int32_t k = lbvh->view.root; k != SCREE_LBVH_END;)
    {
        const scree_lbvh_node *node = lbvh->view.nodes + k;
        if (node->first_child < 0) tree->items[num++] = -1 - node->first_child;
        k = node->first_child < 0 ? node->escape : node->first_child;
    }
    fill_nodes(tree, boxes, num_nodes);
    tree->view.nodes = tree->nodes;
    tree->view.items = tree->items;
    return SCREE_OK;
}

scree_status scree_wide_tree_add_corners(scree_wide_tree *tree, const scree_vec3 *corners)
{
    const int32_t num_items = tree->view.num_items;
    const int32_t num_nodes = (num_items + SCREE_WIDE_CHILDREN - 1) / SCREE_WIDE_CHILDREN;
    // boxes of children that are not there are empty, so their corners may be anything
    tree->corners = calloc((size_t)num_nodes + 1, sizeof *tree->corners);
    if (tree->corners == NULL) return SCREE_OUT_OF_MEMORY;
    for (int32_t i = 0; i < num_items; ++i)
    {
        scree_wide_corners *node = tree->corners + i / SCREE_WIDE_CHILDREN;
        const int32_t child = i % SCREE_WIDE_CHILDREN;
        for (int c = 0; c < 3; ++c)
        {
            const scree_vec3 p = corners[3 * (int64_t)tree->items[i] + c];
            node->x[c][child] = (float)p.x;
            node->y[c][child] = (float)p.y;
            node->z[c][child] = (float)p.z;
        }
    }
    tree->view.corners = tree->corners;
    return SCREE_OK;
}
