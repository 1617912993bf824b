#include "core/arena.h"

#include <stdlib.h>
#include <string.h>

/// Room for one more piece.
static bool make_room(scree_arena *arena)
{
    if (arena->num_pieces < arena->max_pieces) return true;
    const int64_t max_pieces = 2 * arena->max_pieces + 16;
    scree_arena_piece *pieces = realloc(arena->pieces, (size_t)max_pieces * sizeof *pieces);
    if (pieces == NULL) return false;
    arena->pieces = pieces;
    arena->max_pieces = max_pieces;
    return true;
}

scree_status scree_arena_add_block(scree_arena *arena, void *address, int64_t num_bytes)
{
    if (!make_room(arena)) return SCREE_OUT_OF_MEMORY;
    arena->pieces[arena->num_pieces++] = (scree_arena_piece){address, num_bytes, true, true};
    arena->num_bytes += num_bytes;
    return SCREE_OK;
}

void *scree_arena_take(scree_arena *arena, int64_t num_bytes)
{
    if (num_bytes < 0 || num_bytes > INT64_MAX - SCREE_ARENA_ALIGNMENT || !make_room(arena)) return NULL;
    const int64_t num_taken = (num_bytes / SCREE_ARENA_ALIGNMENT + 1) * SCREE_ARENA_ALIGNMENT;
    for (int64_t k = 0; k < arena->num_pieces; ++k)
    {
        scree_arena_piece *piece = arena->pieces + k;
        if (!piece->is_free || piece->num_bytes < num_taken) continue;
        piece->is_free = false;
        if (piece->num_bytes > num_taken)
        {
            // what is left over is a piece of its own
            memmove(piece + 2, piece + 1, (size_t)(arena->num_pieces - k - 1) * sizeof *piece);
            piece[1] = (scree_arena_piece){piece->address + num_taken, piece->num_bytes - num_taken, true, false};
            piece->num_bytes = num_taken;
            ++arena->num_pieces;
        }
        return piece->address;
    }
    return NULL;
}

/// Joins piece k and the one after it if both are free and of one block.
static void join_with_next(scree_arena *arena, int64_t k)
{
    if (k < 0 || k + 1 >= arena->num_pieces) return;
    scree_arena_piece *piece = arena->pieces + k;
    if (!piece[0].is_free || !piece[1].is_free || piece[1].is_first) return;
    piece->num_bytes += piece[1].num_bytes;
    memmove(piece + 1, piece + 2, (size_t)(arena->num_pieces - k - 2) * sizeof *piece);
    --arena->num_pieces;
}

bool scree_arena_give_back(scree_arena *arena, void *address)
{
    for (int64_t k = 0; k < arena->num_pieces; ++k)
    {
        if (arena->pieces[k].is_free || arena->pieces[k].address != (char *)address) continue;
        arena->pieces[k].is_free = true;
        join_with_next(arena, k);
        join_with_next(arena, k - 1);
        return true;
    }
    return false;
}

int64_t scree_arena_free_bytes(const scree_arena *arena)
{
    int64_t num_bytes = 0;
    for (int64_t k = 0; k < arena->num_pieces; ++k)
        if (arena->pieces[k].is_free) num_bytes += arena->pieces[k].num_bytes;
    return num_bytes;
}

void scree_arena_destroy(scree_arena *arena)
{
    free(arena->pieces);
    *arena = (scree_arena){0};
}
