/// \file lbvh.c
/// Order of a build: bounds of the middles, Morton codes, sort, hierarchy, nodes, boxes from the leaves upwards.
/// Linear in the number of boxes; about 150 bytes per box, nodes included.
#include "bvh/lbvh.h"

#include "bvh/bvh_launch.h"
#include "core/buffer.h"
#include "core/sort.h"

#include <stdlib.h>

enum
{
    BLOCK_LEAVES = 256,  ///< larger ones save atomic counters, smaller ones share the work better
    MAX_LEAVES = 1 << 30 ///< 2 num_leaves - 1 nodes must have an int32_t index
};

struct scree_lbvh_buffers
{
    scree_lbvh_build_args arrays; ///< all but boxes, codes and items is owned
    scree_sort_buffers sort;
    int64_t max_leaves;
};

static void destroy_buffers(struct scree_lbvh_buffers *b)
{
    const scree_lbvh_build_args *a = &b->arrays;
    void *const arrays[] = {a->first_leaf, a->last_leaf, a->num_left_turns, a->nodes, a->arrivals, a->chunk_bounds};
    for (size_t k = 0; k < sizeof arrays / sizeof arrays[0] && b->sort.scratch == NULL; ++k)
        scree_device_free(b->sort.device, arrays[k]);
    scree_sort_destroy(&b->sort);
}

void scree_lbvh_destroy(scree_lbvh *tree)
{
    if (tree->buffers != NULL) destroy_buffers(tree->buffers);
    free(tree->buffers);
    *tree = (scree_lbvh){.device = tree->device, .scratch = tree->scratch, .view = {NULL, 0, SCREE_LBVH_END}};
}

static void *take(const scree_lbvh *tree, int64_t num_items, size_t item_size)
{
    return tree->scratch != NULL ? scree_scratch_take(tree->scratch, num_items, item_size)
                                 : scree_device_alloc(tree->device, num_items, item_size);
}

/// Room for num_leaves; refused with the tree as it was, unless that was scratch.
static scree_status reserve(scree_lbvh *tree, int64_t num_leaves)
{
    if (num_leaves > MAX_LEAVES) return SCREE_TOO_MANY;
    scree_device *device = tree->device;
    if (tree->buffers == NULL) tree->buffers = calloc(1, sizeof *tree->buffers);
    if (tree->buffers == NULL) return SCREE_OUT_OF_MEMORY;
    struct scree_lbvh_buffers *b = tree->buffers;
    b->sort.device = device;
    b->sort.scratch = tree->scratch;
    if (num_leaves <= b->max_leaves && tree->scratch == NULL) return SCREE_OK;

    // a first build takes what it needs: trees of shapes and walls do not grow
    const bool is_exact = b->max_leaves == 0 || tree->scratch != NULL;
    const int64_t max_leaves = is_exact ? num_leaves : scree_buffer_grown(num_leaves);
    struct scree_lbvh_buffers grown = {.max_leaves = max_leaves, .sort = {.device = device, .scratch = tree->scratch}};
    grown.arrays.first_leaf = take(tree, max_leaves, sizeof *grown.arrays.first_leaf);
    grown.arrays.last_leaf = take(tree, max_leaves, sizeof *grown.arrays.last_leaf);
    grown.arrays.num_left_turns = take(tree, max_leaves, sizeof *grown.arrays.num_left_turns);
    grown.arrays.nodes = take(tree, 2 * max_leaves, sizeof *grown.arrays.nodes);
    grown.arrays.arrivals = take(tree, max_leaves, sizeof *grown.arrays.arrivals);
    grown.arrays.chunk_bounds = take(tree, SCREE_LBVH_BOUNDS_CHUNKS, sizeof *grown.arrays.chunk_bounds);
    const bool has_all = grown.arrays.first_leaf != NULL && grown.arrays.last_leaf != NULL &&
                         grown.arrays.num_left_turns != NULL && grown.arrays.nodes != NULL &&
                         grown.arrays.arrivals != NULL && grown.arrays.chunk_bounds != NULL;
    if (!has_all || scree_sort_reserve(&grown.sort, max_leaves, true) != SCREE_OK)
    {
        destroy_buffers(&grown);
        return SCREE_OUT_OF_MEMORY;
    }
    // the kernels leave the arrivals at 0, so this is done once
    scree_device_zero(device, grown.arrays.arrivals, (size_t)max_leaves * sizeof *grown.arrays.arrivals);
    destroy_buffers(b);
    *b = grown;
    return SCREE_OK;
}

static int64_t count_blocks(int64_t num_leaves) { return (num_leaves + BLOCK_LEAVES - 1) / BLOCK_LEAVES; }

static scree_morton_frame bound_middles(scree_device *device, scree_lbvh_build_args args)
{
    scree_lbvh_bounds_launch_on(device, args, SCREE_LBVH_BOUNDS_CHUNKS);
    scree_box chunk_bounds[SCREE_LBVH_BOUNDS_CHUNKS];
    for (int c = 0; c < SCREE_LBVH_BOUNDS_CHUNKS; ++c) chunk_bounds[c] = scree_box_empty();
    scree_device_read(device, chunk_bounds, args.chunk_bounds, sizeof chunk_bounds);
    scree_box bounds = scree_box_empty();
    for (int c = 0; c < SCREE_LBVH_BOUNDS_CHUNKS; ++c) bounds = scree_box_union(bounds, chunk_bounds[c]);
    return scree_morton_frame_make(bounds);
}

scree_status scree_lbvh_build(scree_lbvh *tree, const scree_box *boxes, int64_t num_boxes)
{
    const scree_status status = reserve(tree, num_boxes);
    if (status != SCREE_OK) return status;
    struct scree_lbvh_buffers *b = tree->buffers;
    tree->view.nodes = num_boxes > 0 ? b->arrays.nodes : NULL;
    tree->view.num_leaves = (int32_t)num_boxes;
    tree->view.root = num_boxes > 0 ? 0 : SCREE_LBVH_END;
    if (num_boxes == 0) return SCREE_OK;

    scree_lbvh_build_args args = b->arrays;
    args.boxes = boxes;
    args.num_leaves = num_boxes;
    args.block_leaves = BLOCK_LEAVES;
    args.frame = bound_middles(tree->device, args);
    args.codes = b->sort.keys;
    args.items = b->sort.values;
    scree_lbvh_codes_launch_on(tree->device, args, num_boxes);
    scree_sort(&b->sort, num_boxes, 0);
    args.codes = b->sort.keys;
    args.items = b->sort.values;
    scree_lbvh_hierarchy_launch_on(tree->device, args, num_boxes - 1);
    scree_lbvh_left_turns_launch_on(tree->device, args, count_blocks(num_boxes));
    scree_lbvh_nodes_launch_on(tree->device, args, count_blocks(num_boxes));
    return SCREE_OK;
}

const int32_t *scree_lbvh_order(const scree_lbvh *tree) { return tree->buffers->sort.values; }

void scree_lbvh_refit(scree_lbvh *tree, const scree_box *boxes)
{
    if (tree->view.num_leaves == 0) return;
    scree_lbvh_build_args args = tree->buffers->arrays;
    args.boxes = boxes;
    args.num_leaves = tree->view.num_leaves;
    args.block_leaves = BLOCK_LEAVES;
    args.items = tree->buffers->sort.values;
    scree_lbvh_nodes_launch_on(tree->device, args, count_blocks(args.num_leaves));
}

/// Smallest number that is wrong about node k, as text; NULL if all is well.
static const char *find_fault(const scree_lbvh_node *nodes, int32_t k, int32_t end, const scree_box *boxes)
{
    const scree_lbvh_node *node = nodes + k;
    const int32_t next = node->escape == SCREE_LBVH_END ? end : node->escape;
    if (node->first_child < 0)
    {
        if (next != k + 1) return "is a leaf, but its escape is not the next node";
        const scree_box box = boxes[-1 - node->first_child], own = node->box;
        const bool is_same = own.lower.x == box.lower.x && own.lower.y == box.lower.y && own.lower.z == box.lower.z &&
                             own.upper.x == box.upper.x && own.upper.y == box.upper.y && own.upper.z == box.upper.z;
        return is_same ? NULL : "is a leaf, but does not have the box of its item";
    }
    if (node->first_child != k + 1 || k + 1 >= end) return "does not have the next node as its first child";
    const int32_t right = nodes[k + 1].escape;
    if (right <= k + 1 || right >= end) return "has a first child that does not escape to a second one";
    if ((nodes[right].escape == SCREE_LBVH_END ? end : nodes[right].escape) != next)
        return "has a second child that does not escape to where the node does";
    const scree_box both = scree_box_union(nodes[k + 1].box, nodes[right].box), own = node->box;
    const bool is_tight = own.lower.x == both.lower.x && own.lower.y == both.lower.y && own.lower.z == both.lower.z &&
                          own.upper.x == both.upper.x && own.upper.y == both.upper.y && own.upper.z == both.upper.z;
    return is_tight ? NULL : "does not have the union of its children's boxes";
}

bool scree_lbvh_validate(const scree_lbvh *tree, const scree_box *boxes, int64_t num_boxes, scree_report *report)
{
    const int64_t num_nodes = num_boxes > 0 ? 2 * num_boxes - 1 : 0;
    if (tree->view.num_leaves != num_boxes || tree->view.root != (num_boxes > 0 ? 0 : SCREE_LBVH_END))
    {
        scree_report_add(report, "tree: it has %d leaves and root %d for %lld boxes", tree->view.num_leaves,
                         tree->view.root, (long long)num_boxes);
        return false;
    }
    uint8_t *is_met = calloc((size_t)num_boxes + 1, 1);
    if (is_met == NULL)
    {
        scree_report_add(report, "tree: not enough memory to check it");
        return false;
    }
    bool is_valid = true;
    for (int64_t k = 0; k < num_nodes && is_valid; ++k)
    {
        const int32_t item = -1 - tree->view.nodes[k].first_child;
        const char *fault = NULL;
        if (item >= num_boxes || (item >= 0 && is_met[item])) fault = "has an item that is out of range or met before";
        else
        {
            if (item >= 0) is_met[item] = 1;
            fault = find_fault(tree->view.nodes, (int32_t)k, (int32_t)num_nodes, boxes);
        }
        if (fault != NULL)
            scree_report_add(report, "tree: node %lld of %lld %s", (long long)k, (long long)num_nodes, fault);
        is_valid = fault == NULL;
    }
    // as many nodes as leaves need, each item at most once: if one is missing, a node must be wrong
    int64_t num_met = 0;
    for (int64_t i = 0; i < num_boxes; ++i) num_met += is_met[i];
    if (is_valid && num_met != num_boxes)
    {
        scree_report_add(report, "tree: %lld of %lld boxes are in no leaf", (long long)(num_boxes - num_met),
                         (long long)num_boxes);
        is_valid = false;
    }
    free(is_met);
    return is_valid;
}
