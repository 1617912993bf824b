/// \file step_tally.h
/// What the kernels of a step leave for the host: one small copy from where the arrays are.
#ifndef SCREE_STEP_TALLY_H
#define SCREE_STEP_TALLY_H

#include "contact/pair_tally.h"
#include "core/atomic_kernel.h"
#include "core/live.h"
#include "forces/work_kernel.h"

/// Zeroed after it has been read.
typedef struct scree_step_tally
{
    scree_maximum particles_moved;     ///< [m] largest displacement since the last search
    scree_maximum walls_moved;         ///< [m] the same of the walls
    scree_maximum largest_indentation; ///< [m]
    scree_maximum num_from_unstable;   ///< particles from the first one on that is not finite; 0: all are
    scree_work_sums work;              ///< of all contacts, and of those that ended
} scree_step_tally;

/// All of it. The loads [N m] or [N] of the moving walls stand behind it.
typedef struct scree_step_board
{
    scree_step_tally tally;
    scree_pair_tally pairs; ///< of the last search for contacts
    scree_live live;        ///< of recorded steps
} scree_step_board;

static inline scree_real *scree_board_loads(scree_step_board *board) { return (scree_real *)(board + 1); }

static inline size_t scree_board_bytes(int64_t num_walls)
{
    return sizeof(scree_step_board) + (size_t)num_walls * sizeof(scree_real);
}

#endif
