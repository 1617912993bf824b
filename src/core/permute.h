/// \file permute.h
/// Host side of permute_kernel.h.
#ifndef SCREE_PERMUTE_H
#define SCREE_PERMUTE_H

#include "core/launch_cpu.h"
#include "core/permute_kernel.h"

SCREE_DECLARE_LAUNCH(scree_permute) ///< over items

/// Item order[k] of the first `num` items to place k, where the array is. `scratch` has room for all of them.
/// NULL has no items.
void scree_permute(scree_device *device, void *items, size_t size, const int32_t *order, int64_t num, void *scratch);

#endif
