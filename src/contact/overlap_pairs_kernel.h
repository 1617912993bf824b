/// \file overlap_pairs_kernel.h
/// Overlaps of the pairs that may touch: an index of the launch stands for one who has buffers of its own and takes
/// pairs until none is left; on a GPU for a team of lanes. Who computes a pair does not matter to its result.
#ifndef SCREE_OVERLAP_PAIRS_KERNEL_H
#define SCREE_OVERLAP_PAIRS_KERNEL_H

#include "contact/mesh_pairs_kernel.h"
#include "contact/overlap_kernel.h"

/// All pointers, those of the bodies too, in one memory.
typedef struct scree_overlap_pairs_args
{
    scree_mesh_pairs_args meshes;
    scree_overlap_slice *slices;   ///< (num of the launch) buffers, none shared
    scree_overlap_result *results; ///< (num of the launch, max_results) of the pair under way
    int32_t max_results;
    scree_overlap_options options;
    int32_t work_class; ///< of the pairs that are taken
    int32_t num_lanes;  ///< of a team on a GPU: see scree_work_num_lanes(); no result depends on it
} scree_overlap_pairs_args;

/// Active entry k of the class, worked on by index i of the launch. Without enough room nothing but the lack is noted:
/// the host makes room and launches again.
SCREE_FN void scree_overlap_of_pair(const scree_overlap_pairs_args *a, const scree_team *team, int32_t i, int32_t k,
                                    bool may_separate)
{
    const scree_mesh_pairs_args *meshes = &a->meshes;
    const int32_t *active = scree_active_of_class(meshes, a->work_class);
    const int32_t p = scree_pair_of_batch(meshes->batch, active[k]);
    const int32_t body[2] = {meshes->pairs[p].i, meshes->pairs[p].j};
    scree_overlap_pair pair;
    for (int32_t side = 0; side < 2; ++side)
    {
        pair.shape[side] = meshes->bodies.shapes + meshes->bodies.shape[body[side]];
        pair.pose[side] = meshes->bodies.pose + body[side];
    }
    scree_overlap_slice *slice = a->slices + i;
    if (scree_team_leads(team)) slice->setup.known = scree_known_direction(meshes, active[k]);
    scree_overlap_result *results = a->results + (int64_t)i * a->max_results;
    scree_overlap_options options = a->options;
    options.separate_patches = options.separate_patches && may_separate;
    const int32_t num = scree_overlap_team_compute(team, &pair, &options, slice, results, a->max_results);
    if (!scree_team_leads(team)) return;
    if (results[0].status == SCREE_OVERLAP_WORKSPACE_FULL)
        scree_atomic_count(meshes->tally->num_lacking + slice->lack, 1);
    else if (num > a->max_results) scree_atomic_max(&meshes->tally->most_results, (scree_real)num);
    else scree_mesh_pair_note(meshes, scree_active_of_class(meshes, a->work_class)[k], results, num);
}

/// Index i takes pairs and works on them. `may_separate`: patches may be told apart.
SCREE_FN void scree_overlap_take_pairs(const scree_overlap_pairs_args *a, const scree_team *team, int32_t i,
                                       bool may_separate)
{
    const scree_pair_tally *tally = a->meshes.tally;
    for (;;)
    {
        // the one who leads takes for all; batches have indices of 32 bits
        int32_t k = 0;
        if (scree_team_leads(team)) k = (int32_t)scree_atomic_count(a->meshes.tally->num_taken + a->work_class, 1);
        k = scree_team_sum(team, k);
        if (k >= tally->num_active[a->work_class]) return;
        scree_overlap_of_pair(a, team, i, k, may_separate);
        scree_team_sync(team);
    }
}

SCREE_FN void scree_overlap_pairs_team_at(scree_overlap_pairs_args a, const scree_team *team, int64_t i)
{
    scree_overlap_take_pairs(&a, team, (int32_t)i, false);
}

/// The same where patches are told apart: by itself, because it takes a stack on a GPU that no other step needs.
typedef scree_overlap_pairs_args scree_overlap_patches_args;

SCREE_FN void scree_overlap_patches_team_at(scree_overlap_patches_args a, const scree_team *team, int64_t i)
{
    scree_overlap_take_pairs(&a, team, (int32_t)i, true);
}

#endif
