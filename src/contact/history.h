/// \file history.h
/// Host side of history_kernel.h.
#ifndef SCREE_HISTORY_H
#define SCREE_HISTORY_H

#include "contact/history_kernel.h"
#include "core/launch_cpu.h"

/// Over candidate pairs.
SCREE_DECLARE_LAUNCH(scree_history_match)

#endif
