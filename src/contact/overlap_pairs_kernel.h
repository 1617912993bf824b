/// \file overlap_pairs_kernel.h
/// Overlap of candidate pair p on the device, a team of lanes per pair.
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
    int32_t num_lanes; ///< of the team for each pair, on a GPU: see scree_overlap_num_lanes(); no result depends on it
} scree_overlap_pairs_args;

/// Lanes for pairs of shapes with so many triangles: few where few are kept, so that more pairs are under way at once.
SCREE_FN int32_t scree_overlap_num_lanes(int32_t num_triangles)
{
    return num_triangles < SCREE_LARGE_SHAPE ? 8 : num_triangles < 512 ? 16 : 32;
}

/// WORKSPACE_FULL stays in the result: the host enlarges that slice and launches such pairs again.
SCREE_FN void scree_overlap_pairs_team_at(scree_overlap_pairs_args a, const scree_team *team, int64_t p)
{
    const int32_t body[2] = {a.pairs[p].i, a.pairs[p].j};
    scree_overlap_pair pair;
    for (int32_t side = 0; side < 2; ++side)
    {
        pair.shape[side] = a.bodies.shapes + a.bodies.shape[body[side]];
        pair.pose[side] = a.bodies.pose + body[side];
    }
    scree_overlap_team_compute(team, &pair, &a.options, a.slices + p, a.results + p, 1);
}

SCREE_FN void scree_overlap_pairs_at(scree_overlap_pairs_args a, int64_t p)
{
    const scree_team team = scree_team_alone();
    scree_overlap_pairs_team_at(a, &team, p);
}

#endif
