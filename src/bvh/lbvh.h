/// \file lbvh.h
/// Linear bounding-volume hierarchy over boxes (Karras 2012): build, refit, validate.
#ifndef SCREE_LBVH_H
#define SCREE_LBVH_H

#include "bvh/lbvh_kernel.h"
#include "core/scratch.h"

/// Owns its buffers and keeps them between builds. Start from {0}, or from {.device = ...} for a tree on a GPU.
typedef struct scree_lbvh
{
    scree_device *device;   ///< where the boxes and the tree lie, NULL: the CPU
    scree_scratch *scratch; ///< borrowed: each build takes its arrays there, and they live as long; NULL: its own
    scree_lbvh_view view;
    struct scree_lbvh_buffers *buffers; ///< internal
} scree_lbvh;

/// Builds the tree over `boxes` (num_boxes); parallel; same tree for any number of threads and on a GPU.
/// Leaves carry the index of their box. Equal Morton codes are split by index. SCREE_OUT_OF_MEMORY, SCREE_TOO_MANY.
scree_status scree_lbvh_build(scree_lbvh *tree, const scree_box *boxes, int64_t num_boxes);
/// The boxes in the order of the leaves, that of a Morton curve (num_leaves), where the tree lies; until the next
/// build.
const int32_t *scree_lbvh_order(const scree_lbvh *tree);
/// New boxes, same hierarchy.
void scree_lbvh_refit(scree_lbvh *tree, const scree_box *boxes);
/// On the CPU: every item once, parents contain children, escape links lead through all nodes. Faults go to the report.
bool scree_lbvh_validate(const scree_lbvh *tree, const scree_box *boxes, int64_t num_boxes, scree_report *report);
void scree_lbvh_destroy(scree_lbvh *tree);

#endif
