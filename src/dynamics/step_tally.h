/// \file step_tally.h
/// What the kernels of a step leave for the host: one small read where the arrays are.
#ifndef SCREE_STEP_TALLY_H
#define SCREE_STEP_TALLY_H

#include "core/atomic_kernel.h"
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

#endif
