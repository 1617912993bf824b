/// \file live.h
/// What recorded launches look up on the device when they are played, see scree_device_record(): the numbers that
/// change from step to step, and whether to go on.
#ifndef SCREE_LIVE_H
#define SCREE_LIVE_H

#include "scree/base.h"

/// Why the rest of a recording does nothing.
typedef enum scree_halt
{
    SCREE_HALT_NONE,
    SCREE_HALT_SEARCH, ///< candidate pairs must be searched first
    SCREE_HALT_ROOM,   ///< contacts, or what is found of a pair, had no room
    SCREE_HALT_START   ///< nothing was played
} scree_halt;

/// Integers of one size, so that there are no gaps in it.
typedef struct scree_live
{
    int64_t halt;         ///< a scree_halt; once it is not SCREE_HALT_NONE all launches return at once
    int64_t num_steps;    ///< since the last search
    int64_t num_contacts; ///< of this step, once they are counted
} scree_live;

#endif
