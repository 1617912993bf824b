/// \file sort.h
/// Stable parallel radix sort by a 64-bit key, least significant digit first (Zagha & Blelloch 1991). A stable sort
/// has one answer only, so it is the same for any number of threads, and for CUB, which does it on a GPU.
#ifndef SCREE_SORT_H
#define SCREE_SORT_H

#include "core/scratch.h"

/// Two places for the items: a pass reads one and writes the other. Start from {0}, reserve, fill `keys` and, if they
/// are wanted, `values`; after the sort the answer stands in `keys` and `values`, which may then be other addresses.
typedef struct scree_sort_buffers
{
    scree_device *device;   ///< where the arrays lie; set before the first call, NULL for the CPU
    scree_scratch *scratch; ///< borrowed: the arrays are taken there and live as long; NULL: they are owned
    uint64_t *keys;         ///< (max_items)
    int32_t *values;        ///< (max_items), NULL if reserved without values
    uint64_t *spare_keys;
    int32_t *spare_values;
    void *counts; ///< histograms of the digits, one per chunk; on a GPU scratch memory of CUB
    int64_t num_count_bytes;
    int64_t max_items;
    bool has_values;
} scree_sort_buffers;

/// Makes room for exactly num_items or more; what was stored is lost if it has to grow. Refused, with nothing changed:
/// SCREE_OUT_OF_MEMORY, SCREE_TOO_MANY above 2^32 - 1.
scree_status scree_sort_reserve(scree_sort_buffers *buffers, int64_t num_items, bool has_values);
/// Sorts the first num_items keys ascending, and the values with them if there are any. The lowest first_bit bits of a
/// key are not looked at. Keys that are equal in the others keep their order; bits in which no two keys differ cost
/// nothing.
void scree_sort(scree_sort_buffers *buffers, int64_t num_items, int first_bit);
void scree_sort_destroy(scree_sort_buffers *buffers);

#endif
