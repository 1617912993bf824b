/// \file narrow_phase.h
/// Candidate pairs to contacts: separation test, overlap, compaction into the sorted contact list. Which algorithm
/// finds the contacts of a pair is read from a table over the kinds of its two shapes; pairs are worked on in one batch
/// per entry of the table, and a batch that is empty costs no memory.
///
/// A pair of meshes that was found apart by a gap is skipped until its bodies may have travelled that far; one that did
/// not touch is asked along its last separating direction first. Both outlast a search of candidates. Both can be
/// switched off; neither changes a bit of the result.
#ifndef SCREE_NARROW_PHASE_H
#define SCREE_NARROW_PHASE_H

#include "contact/contact_list.h"
#include "contact/overlap_pool.h"

/// Bodies as the narrow phase sees them: particles first, then walls.
typedef struct scree_bodies
{
    const scree_shape_view *shapes; ///< all shapes
    const int32_t *shape;           ///< (num_bodies) index into shapes
    const scree_pose *pose;         ///< (num_bodies)
    const scree_real *travel;       ///< [m] (num_bodies) bound of the way of any of its points since the last search
    const int32_t *ids;             ///< (num_bodies) of the bodies, or NULL: each is its own
    int64_t num_bodies;
    int64_t num_steps; ///< since the last search, in which the travels were made
    scree_real reach;  ///< [m] two bodies come closer by no more than this until pairs are forgotten; 0: not known
} scree_bodies;

/// Candidate pair of entry b of a batch; NULL stands for a batch of all pairs.
SCREE_FN int32_t scree_pair_of_batch(const int32_t *batch, int64_t b) { return batch ? batch[b] : (int32_t)b; }

/// Work that is avoided for pairs of meshes that do not touch. All false: every pair goes to the overlap.
typedef struct scree_separation_use
{
    bool finds;     ///< a plane between the two is looked for first
    bool remembers; ///< the search for it starts with that of the last time
    bool bounds;    ///< a pair is skipped until it may have travelled through its gap; where no plane was found, the
                    ///< distance of the surfaces is computed
} scree_separation_use;

/// What one search met.
typedef struct scree_narrow_phase_counts
{
    int64_t num_without_normal;
    int64_t num_fallbacks;
    scree_real worst_residual;
    int64_t num_inside; ///< spheres or clumps with a centre of a sphere inside the solid of a mesh
} scree_narrow_phase_counts;

/// Pairs of meshes by their work, for a GPU: each class goes to teams of its own size, see scree_work_class().
#define SCREE_NUM_WORK_CLASSES 3
typedef struct scree_work_classes
{
    int32_t first, last; ///< classes that there are; the same: pairs need not be told apart
} scree_work_classes;

/// Owns the workspaces and the results per pair. Start from {0}, or from {.device = ...} for bodies, pairs and list on
/// a GPU.
typedef struct scree_narrow_phase
{
    scree_device *device;       ///< where all arrays lie, NULL: the CPU
    scree_overlap_room room;    ///< of an overlap, to begin with; 0: chosen
    scree_work_classes classes; ///< of the pairs of meshes on a GPU, by their shapes; on the CPU one is enough
    scree_overlap_options options;
    scree_separation_use separation;
    struct scree_pair_tally *tally;   ///< borrowed, where the arrays lie: for counting; NULL: its own
    scree_narrow_phase_counts counts; ///< of the last search
    bool lacks_room; ///< of the last search: contacts have no room, and there are none; search candidates first
    struct scree_narrow_phase_buffers *buffers; ///< internal
} scree_narrow_phase;

/// Forgets what is known of the pairs; call when the candidate pairs have changed, or the bodies have been moved by
/// more than their travels say.
void scree_narrow_phase_forget(scree_narrow_phase *narrow_phase);
/// The same, but what is known of pairs of meshes goes to those of the next search that are among its pairs. Call
/// before the candidate pairs are searched anew and the travels begin at 0 again, with the bodies at the poses of that
/// search and the pairs of the one before.
void scree_narrow_phase_carry(scree_narrow_phase *narrow_phase, const scree_bodies *bodies,
                              const scree_candidate_pair *pairs);

/// Finds the contacts of all candidate pairs and writes the geometry of `list`; forces and history are left alone.
/// Same list for any number of threads and on a GPU. Memory is only taken for pairs that are not those of the last
/// time: for the same ones `lacks_room` tells that it did not do. SCREE_OUT_OF_MEMORY.
scree_status scree_narrow_phase_find(scree_narrow_phase *narrow_phase, const scree_bodies *bodies,
                                     const scree_candidate_pair *pairs, int64_t num_pairs, scree_contact_list *list);
/// The launches of scree_narrow_phase_find() for the same pairs as the last time, without waiting, to be recorded
/// (device.h). There is room for list->num_contacts. When they are played and find no room, `live` halts the recording;
/// otherwise it learns the number of contacts.
void scree_narrow_phase_again(scree_narrow_phase *narrow_phase, const scree_bodies *bodies,
                              const scree_candidate_pair *pairs, int64_t num_pairs, scree_contact_list *list,
                              struct scree_live *live);
/// Memory [bytes] that overlaps of pairs of meshes will work in, as `narrow_phase` is set up.
int64_t scree_narrow_phase_overlap_bytes(const scree_narrow_phase *narrow_phase);
/// Takes up what was counted, from a copy on the CPU.
void scree_narrow_phase_take_counts(scree_narrow_phase *narrow_phase, const struct scree_pair_tally *tally);
void scree_narrow_phase_destroy(scree_narrow_phase *narrow_phase);

#endif
