/// \file permute_kernel.h
/// Items of an array to other places in it.
#ifndef SCREE_PERMUTE_KERNEL_H
#define SCREE_PERMUTE_KERNEL_H

#include "core/vec.h"

#include <string.h>

typedef struct scree_permute_args
{
    const void *from; ///< items
    void *to;
    const int32_t *order; ///< where each item comes from
    int64_t num_bytes;    ///< of an item
} scree_permute_args;

/// Item k.
SCREE_FN void scree_permute_at(scree_permute_args a, int64_t k)
{
    const char *from = (const char *)a.from + a.order[k] * a.num_bytes;
    char *to = (char *)a.to + k * a.num_bytes;
    int64_t n = 0;
    for (; n + 4 <= a.num_bytes; n += 4) memcpy(to + n, from + n, 4);
    for (; n < a.num_bytes; ++n) to[n] = from[n];
}

#endif
