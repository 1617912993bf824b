/// \file scratch.h
/// Memory of stages that follow each other and leave nothing behind: a search of candidate pairs, then what the
/// contacts need from one step to the next only while no search comes between. Each begins anew and takes its arrays
/// from the start; what the stage before has taken is dead then.
#ifndef SCREE_SCRATCH_H
#define SCREE_SCRATCH_H

#include "core/device.h"

/// Memory that arrays are taken from, one after the other.
typedef struct scree_scratch_block
{
    char *memory;
    int64_t num_bytes, num_taken;
} scree_scratch_block;

/// Owns its blocks. Start from {0}, or from {.device = ...} for arrays on a GPU.
typedef struct scree_scratch
{
    scree_device *device;        ///< where the arrays lie, NULL: the CPU
    scree_scratch_block *blocks; ///< (num_blocks) one, unless a stage has taken more than any before
    int32_t num_blocks;
    int64_t num_taken; ///< of the present stage
    int64_t most;      ///< that any stage has taken or announced
} scree_scratch;

/// Bytes that `num_items` take in a block.
int64_t scree_scratch_bytes(int64_t num_items, size_t item_size);
/// A stage begins that will take num_bytes, or more: then only the first time are they in several blocks. All that was
/// taken is dead. SCREE_OUT_OF_MEMORY leaves no blocks.
scree_status scree_scratch_begin(scree_scratch *scratch, int64_t num_bytes);
/// Uninitialised memory for num_items >= 0, in whole cache lines, until the next stage begins. NULL: memory is out, or
/// the size overflows.
void *scree_scratch_take(scree_scratch *scratch, int64_t num_items, size_t item_size);
void scree_scratch_destroy(scree_scratch *scratch);

#endif
