#include "core/scratch.h"

#include <stdlib.h>
#include <string.h>

enum
{
    ALIGNMENT = 256 ///< that of a GPU's memory
};

int64_t scree_scratch_bytes(int64_t num_items, size_t item_size)
{
    if (num_items < 0 || item_size == 0 || (uint64_t)num_items > (PTRDIFF_MAX - ALIGNMENT) / 2 / item_size) return -1;
    const int64_t num_bytes = num_items > 0 ? num_items * (int64_t)item_size : 1;
    return (num_bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
}

static void free_blocks(scree_scratch *scratch)
{
    for (int32_t k = 0; k < scratch->num_blocks; ++k) scree_device_free(scratch->device, scratch->blocks[k].memory);
    scratch->num_blocks = 0;
}

/// One more block; NULL: memory is out.
static scree_scratch_block *add_block(scree_scratch *scratch, int64_t num_bytes)
{
    scree_scratch_block *blocks = realloc(scratch->blocks, (size_t)(scratch->num_blocks + 1) * sizeof *blocks);
    if (blocks == NULL) return NULL;
    scratch->blocks = blocks;
    char *memory = scree_device_alloc(scratch->device, num_bytes, 1);
    if (memory == NULL) return NULL;
    blocks[scratch->num_blocks] = (scree_scratch_block){memory, num_bytes, 0};
    return blocks + scratch->num_blocks++;
}

/// In checked builds what is dead is spoilt, so that nobody goes on reading it.
static void spoil(const scree_scratch *scratch)
{
#ifdef SCREE_CHECKED
    for (int32_t k = 0; k < scratch->num_blocks && scratch->device == NULL; ++k)
        memset(scratch->blocks[k].memory, 0xff, (size_t)scratch->blocks[k].num_taken);
#else
    (void)scratch;
#endif
}

scree_status scree_scratch_begin(scree_scratch *scratch, int64_t num_bytes)
{
    if (num_bytes > scratch->most) scratch->most = num_bytes;
    scratch->num_taken = 0;
    spoil(scratch);
    const int32_t num_blocks = scratch->num_blocks;
    const bool is_enough = num_blocks == 1 && scratch->blocks->num_bytes >= scratch->most;
    if (is_enough || scratch->most == 0)
    {
        if (is_enough) scratch->blocks->num_taken = 0;
        return SCREE_OK;
    }
    // the old ones first, so that they and the new one are never there together
    free_blocks(scratch);
    return add_block(scratch, scratch->most) != NULL ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

void *scree_scratch_take(scree_scratch *scratch, int64_t num_items, size_t item_size)
{
    const int64_t num_bytes = scree_scratch_bytes(num_items, item_size);
    if (num_bytes < 0) return NULL;
    scree_scratch_block *block = NULL;
    for (int32_t k = 0; k < scratch->num_blocks && block == NULL; ++k)
        if (scratch->blocks[k].num_bytes - scratch->blocks[k].num_taken >= num_bytes) block = scratch->blocks + k;
    if (block == NULL) block = add_block(scratch, num_bytes);
    if (block == NULL) return NULL;
    void *memory = block->memory + block->num_taken;
    block->num_taken += num_bytes;
    scratch->num_taken += num_bytes;
    if (scratch->num_taken > scratch->most) scratch->most = scratch->num_taken;
    return memory;
}

void scree_scratch_destroy(scree_scratch *scratch)
{
    free_blocks(scratch);
    free(scratch->blocks);
    *scratch = (scree_scratch){.device = scratch->device};
}
