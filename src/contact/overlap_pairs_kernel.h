/// \file overlap_pairs_kernel.h
/// Overlap of candidate pair p on the device, a thread per pair.
#ifndef SCREE_OVERLAP_PAIRS_KERNEL_H
#define SCREE_OVERLAP_PAIRS_KERNEL_H

#include "contact/narrow_phase.h"
#include "contact/overlap_kernel.h"

/// All pointers, those of the bodies too, in one memory.
typedef struct scree_overlap_pairs_args
{
    scree_bodies bodies;
    const scree_candidate_pair *pairs; ///< (num_pairs)
    scree_overlap_slice *slices;       ///< (num_pairs) buffers, none shared
    scree_overlap_result *results;     ///< (num_pairs)
    scree_overlap_options options;
} scree_overlap_pairs_args;

/// WORKSPACE_FULL stays in the result: the host enlarges that slice and launches such pairs again.
SCREE_FN void scree_overlap_pairs_at(scree_overlap_pairs_args a, int64_t p)
{
    const int32_t body[2] = {a.pairs[p].i, a.pairs[p].j};
    scree_overlap_pair pair;
    for (int32_t side = 0; side < 2; ++side)
    {
        pair.shape[side] = a.bodies.shapes + a.bodies.shape[body[side]];
        pair.pose[side] = a.bodies.pose + body[side];
    }
    scree_overlap_pair_compute(&pair, &a.options, a.slices + p, a.results + p, 1);
}

#endif
