/// \file pair_tally.h
/// What the kernels of the narrow phase count while they go over the pairs: sums of integers and maxima, which do not
/// depend on who came first.
#ifndef SCREE_PAIR_TALLY_H
#define SCREE_PAIR_TALLY_H

#include "contact/narrow_phase.h"
#include "contact/overlap_parts.h"
#include "core/atomic_kernel.h"

/// Zeroed before a search.
typedef struct scree_pair_tally
{
    int64_t num_active[SCREE_NUM_WORK_CLASSES];    ///< pairs of meshes that are not known to be apart
    int64_t num_lacking[SCREE_LACK_CROSSINGS + 1]; ///< overlaps that were not computed for lack of room, by what lacked
    scree_maximum most_results;                    ///< of one pair of meshes, if there was no room for them
    scree_maximum most_found;                      ///< on one mesh by a sphere, if there was no room for them
    int32_t num_contacts;                          ///< of all pairs; negative: above INT32_MAX
    int32_t unused;                                ///< so that there is no gap
    int64_t num_without_normal;
    int64_t num_fallbacks;
    int64_t num_inside; ///< centres of spheres inside the solid of a mesh
    scree_maximum worst_residual;
    // what is above is mostly read while overlaps are computed, what is below is written by all threads: another line
    // of the caches, or each would wait for the others at every look
    int64_t between[8];
    int64_t num_taken[SCREE_NUM_WORK_CLASSES]; ///< active pairs that somebody has taken up
    int64_t num_kept;                          ///< overlaps that touch, with or without room to keep them
} scree_pair_tally;

#endif
