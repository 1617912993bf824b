/// \file arena.h
/// Book-keeping of memory that is taken in large blocks and handed out in pieces: first fit, neighbours that are free
/// join. Never touches the memory itself, so that may be a device's.
#ifndef SCREE_ARENA_H
#define SCREE_ARENA_H

#include "scree/base.h"

#ifdef __cplusplus
extern "C"
{
#endif

/// Every piece starts at a multiple of this from the start of its block.
#define SCREE_ARENA_ALIGNMENT 256

    /// A part of a block, free or taken.
    typedef struct scree_arena_piece
    {
        char *address;
        int64_t num_bytes;
        bool is_free;
        bool is_first; ///< of its block
    } scree_arena_piece;

    /// Owns its list of pieces, not the memory. Start from {0}.
    typedef struct scree_arena
    {
        scree_arena_piece *pieces; ///< (num_pieces) in the order of the blocks, and of addresses within one
        int64_t num_pieces, max_pieces;
        int64_t num_bytes; ///< of all blocks
    } scree_arena;

    /// Adds a block. Refused: SCREE_OUT_OF_MEMORY, for the list.
    scree_status scree_arena_add_block(scree_arena *arena, void *address, int64_t num_bytes);
    /// A piece of num_bytes >= 0, or NULL if no free one is large enough (or there is no memory for the list).
    void *scree_arena_take(scree_arena *arena, int64_t num_bytes);
    /// Gives a piece back; false if `address` is not one that was taken.
    bool scree_arena_give_back(scree_arena *arena, void *address);
    /// Bytes of all free pieces.
    int64_t scree_arena_free_bytes(const scree_arena *arena);
    void scree_arena_destroy(scree_arena *arena);

#ifdef __cplusplus
}
#endif
#endif
