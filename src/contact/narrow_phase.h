/// \file narrow_phase.h
/// Candidate pairs to contacts: separation test, overlap, compaction into the sorted contact list. Which algorithm
/// finds the contacts of a pair is read from a table over the kinds of its two shapes; pairs are worked on in one batch
/// per entry of the table, and a batch that is empty costs no memory.
///
/// A pair of meshes that was found apart by a gap is skipped until its bodies may have travelled that far; one that did
/// not touch is asked along its last separating direction first. Both can be switched off; neither changes a bit of the
/// result.
#ifndef SCREE_NARROW_PHASE_H
#define SCREE_NARROW_PHASE_H

#include "contact/contact_list.h"
#include "contact/overlap.h"

/// Bodies as the narrow phase sees them: particles first, then walls.
typedef struct scree_bodies
{
    const scree_shape_view *shapes; ///< all shapes
    const int32_t *shape;           ///< (num_bodies) index into shapes
    const scree_pose *pose;         ///< (num_bodies)
    const scree_real *travel;       ///< [m] (num_bodies) bound of the way of any of its points since the last search
    int64_t num_bodies;
} scree_bodies;

/// What one search met.
typedef struct scree_narrow_phase_counts
{
    int64_t num_without_normal;
    int64_t num_fallbacks;
    scree_real worst_residual;
    int64_t num_inside; ///< spheres or clumps with a centre of a sphere inside the solid of a mesh
    scree_real largest_indentation;
} scree_narrow_phase_counts;

/// Owns a workspace per thread and the results per pair. Start from {0}.
typedef struct scree_narrow_phase
{
    scree_overlap_options options;
    bool finds_separation;                      ///< false: every candidate pair of meshes goes to the overlap
    bool remembers_separation;                  ///< the search for a direction starts with that of the last time
    bool bounds_separation;                     ///< a pair is skipped until it may have travelled through its gap
    scree_narrow_phase_counts counts;           ///< of the last search
    struct scree_narrow_phase_buffers *buffers; ///< internal
} scree_narrow_phase;

/// Forgets what is known of the pairs; call when the candidate pairs have changed.
void scree_narrow_phase_forget(scree_narrow_phase *narrow_phase);

/// Finds the contacts of all candidate pairs and writes the geometry of `list`; forces and history are left alone.
/// Same list for any number of threads. SCREE_OUT_OF_MEMORY.
scree_status scree_narrow_phase_find(scree_narrow_phase *narrow_phase, const scree_bodies *bodies,
                                     const scree_candidate_pair *pairs, int64_t num_pairs, scree_contact_list *list);
void scree_narrow_phase_destroy(scree_narrow_phase *narrow_phase);

#endif
