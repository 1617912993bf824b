#include "bvh/broad_phase.h"
#include "contact/overlap_kernel.h"
#include "core/launch_cuda.cuh"

/// Overlaps of candidate pairs, a thread per pair. All pointers on the device.
typedef struct scree_overlap_pairs_args
{
    const scree_shape_view *shapes;    ///< (num_shapes)
    const int32_t *shape;              ///< (num_bodies) index of each body's shape
    const scree_pose *pose;            ///< (num_bodies)
    const scree_candidate_pair *pairs; ///< (num_pairs)
    scree_overlap_slice *slices;       ///< (num_pairs) buffers, none shared
    scree_overlap_result *results;     ///< (num_pairs)
    scree_overlap_options options;
} scree_overlap_pairs_args;

/// WORKSPACE_FULL stays in the result: the host enlarges that slice and launches such pairs again.
SCREE_FN void scree_overlap_pairs_at(scree_overlap_pairs_args a, int64_t p)
{
    scree_overlap_pair pair;
    pair.shape[0] = a.shapes + a.shape[a.pairs[p].i];
    pair.shape[1] = a.shapes + a.shape[a.pairs[p].j];
    pair.pose[0] = a.pose + a.pairs[p].i;
    pair.pose[1] = a.pose + a.pairs[p].j;
    a.results[p] = scree_overlap_pair_compute(&pair, &a.options, a.slices + p);
}

SCREE_DEFINE_LAUNCH(scree_overlap_pairs)
