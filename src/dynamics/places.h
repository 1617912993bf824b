/// \file places.h
/// Where particles lie in the arrays over bodies. They start in the order of their ids. Once they have mixed, what
/// follows in memory is far away in space, and every contact waits for its bodies; then they change places, to the
/// order of the tree's leaves along its Morton curve. Ids stay: of two bodies the one with the smaller id is the first,
/// and sums are made in the order of ids, so that no bit of the result depends on places. Whoever looks at the
/// simulation finds everything in the order of ids: before that, all bodies come home.
#ifndef SCREE_PLACES_H
#define SCREE_PLACES_H

#include "core/scan.h"
#include "dynamics/state.h"

/// All arrays lie where the simulation's do, and are NULL until bodies change places for the first time.
typedef struct scree_places
{
    bool are_kept;       ///< the scene wants particles to stay where they are
    bool are_ids;        ///< all are home
    bool is_due;         ///< particles change places at the next search
    int64_t few;         ///< particles that need not change places
    int64_t looked_step; ///< when somebody last looked at the simulation
    bool has_short_stay; ///< he had looked so shortly before that changing places would not have paid
    int32_t *ids;        ///< (num_bodies) of the body in each place
    int32_t *places;     ///< (num_bodies) of the body of each id
    int32_t *order;      ///< (num_bodies) present place of the body that each place gets
    int32_t *moved_to;   ///< (num_bodies) where the body in each place went the last time
    int32_t *spare_ids;  ///< (num_bodies)
    int64_t *num_far;    ///< counts
    void *scratch;       ///< (num_bodies) poses
    scree_scan_scratch scan;
} scree_places;

void scree_places_start(scree_simulation *simulation);
void scree_places_destroy(scree_places *places, scree_device *device);

/// Of the bodies, or NULL while all are home.
const int32_t *scree_ids(const scree_simulation *simulation);
/// Of the ids, or NULL.
const int32_t *scree_places_of_ids(const scree_simulation *simulation);

/// At the next search, before the next step, the particle in place order[k] comes to place k. `order` (num_particles)
/// lies where the arrays do. SCREE_OUT_OF_MEMORY.
scree_status scree_ask_for_places(scree_simulation *simulation, const int32_t *order);
/// After the search of `input`: is it time to change places? Then the next step searches again. Without memory for it
/// particles stay.
void scree_compare_places(scree_simulation *simulation, const scree_broad_phase_input *input);
/// Before a search: particles change places if it is time. What is known of pairs and contacts follows them.
void scree_change_places(scree_simulation *simulation);
/// Between steps: all bodies to the places of their ids, contacts in the order of ids; then the next step searches.
/// SCREE_OUT_OF_MEMORY leaves everything as it was.
scree_status scree_bring_home(scree_simulation *simulation);

#endif
