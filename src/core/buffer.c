#include "core/buffer.h"

#include <stdlib.h>

enum
{
    ALIGNMENT = 64
};

void *scree_buffer_alloc(int64_t num_items, size_t item_size)
{
    if (num_items < 0 || item_size == 0) return NULL;
    if ((uint64_t)num_items > (PTRDIFF_MAX - ALIGNMENT) / item_size) return NULL;
    const size_t num_bytes = (size_t)num_items * item_size;
    return aligned_alloc(ALIGNMENT, (num_bytes / ALIGNMENT + 1) * ALIGNMENT);
}

int64_t scree_buffer_grown(int64_t num_items)
{
    const int64_t extra = num_items / 2 + 16;
    return num_items > INT64_MAX - extra ? num_items : num_items + extra;
}
