/// \file history.h
/// Host side of history_kernel.h.
#ifndef SCREE_HISTORY_H
#define SCREE_HISTORY_H

#include "contact/history_kernel.h"
#include "core/launch_cpu.h"

SCREE_DECLARE_LAUNCH(scree_group_bounds)  ///< over the entries of a list
SCREE_DECLARE_LAUNCH(scree_history_match) ///< over candidate pairs

#endif
