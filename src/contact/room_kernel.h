/// \file room_kernel.h
/// Was there room for all that a recorded search for contacts found? Otherwise the rest of the recording is not done.
#ifndef SCREE_ROOM_KERNEL_H
#define SCREE_ROOM_KERNEL_H

#include "contact/pair_tally.h"
#include "core/live.h"

typedef struct scree_room_args
{
    const scree_pair_tally *tally; ///< of all pairs, with the number of contacts
    int64_t max_kept;              ///< overlaps of meshes
    int64_t max_contacts;
    scree_live *live; ///< out
} scree_room_args;

/// Did any pair lack room for what was found of it?
SCREE_FN bool scree_lacks_room(const scree_pair_tally *tally, int64_t max_kept)
{
    const int64_t num_lacking = tally->num_lacking[SCREE_LACK_PIECES] + tally->num_lacking[SCREE_LACK_SHAPE] +
                                tally->num_lacking[SCREE_LACK_CROSSINGS];
    return num_lacking > 0 || tally->most_results.bits != 0 || tally->most_found.bits != 0 ||
           tally->num_kept > max_kept;
}

/// By the one index of the launch.
SCREE_FN void scree_room_at(scree_room_args a, int64_t i)
{
    (void)i;
    if (scree_lacks_room(a.tally, a.max_kept) || a.tally->num_contacts < 0 || a.tally->num_contacts > a.max_contacts)
        a.live->halt = SCREE_HALT_ROOM;
    else a.live->num_contacts = a.tally->num_contacts;
}

#endif
