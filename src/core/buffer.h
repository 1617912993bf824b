/// \file buffer.h
/// Host memory for arrays: checked sizes, whole cache lines, growth by quarters.
#ifndef SCREE_BUFFER_H
#define SCREE_BUFFER_H

#include <stddef.h>
#include <stdint.h>

/// Uninitialised memory for num_items, aligned to 64 bytes; free() releases it. Never NULL but if memory is out or the
/// size overflows; num_items >= 0, and 0 gives a block as well.
void *scree_buffer_alloc(int64_t num_items, size_t item_size);

/// Capacity to ask for when num_items are needed: a quarter more than needed, so that growing item by item costs linear
/// time. num_items if more would overflow.
int64_t scree_buffer_grown(int64_t num_items);

#endif
