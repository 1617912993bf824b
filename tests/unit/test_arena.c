// Pieces of an arena: inside of their blocks, aligned, never overlapping, and all one again when all are given back.
#include "core/arena.h"
#include "harness.h"

enum
{
    NUM_BLOCKS = 3,
    NUM_PIECES = 200,
    BLOCK_BYTES = 64 * 1024
};

static char blocks[NUM_BLOCKS][BLOCK_BYTES];

static void add_blocks(scree_arena *arena)
{
    for (int k = 0; k < NUM_BLOCKS; ++k)
        SCREE_CHECK_INT(scree_arena_add_block(arena, blocks[k], BLOCK_BYTES), SCREE_OK);
}

/// The block that holds all of the piece, or -1.
static int block_of(const char *piece, int64_t num_bytes)
{
    for (int k = 0; k < NUM_BLOCKS; ++k)
        if (piece >= blocks[k] && piece + num_bytes <= blocks[k] + BLOCK_BYTES) return k;
    return -1;
}

static void test_random_pieces(void)
{
    scree_arena arena = {0};
    add_blocks(&arena);
    char *piece[NUM_PIECES] = {NULL};
    int64_t num_bytes[NUM_PIECES] = {0};
    uint64_t state = 1;
    for (int round = 0; round < 5000; ++round)
    {
        const int k = (int)(scree_test_random_bits(&state) % NUM_PIECES);
        if (piece[k] != NULL)
        {
            // nobody else has written here
            bool is_untouched = true;
            for (int64_t i = 0; i < num_bytes[k]; ++i) is_untouched = is_untouched && piece[k][i] == (char)k;
            SCREE_CHECK(is_untouched);
            SCREE_CHECK(scree_arena_give_back(&arena, piece[k]));
            SCREE_CHECK(!scree_arena_give_back(&arena, piece[k]));
            piece[k] = NULL;
            continue;
        }
        num_bytes[k] = (int64_t)(scree_test_random_bits(&state) % 3000);
        piece[k] = scree_arena_take(&arena, num_bytes[k]);
        if (piece[k] == NULL) continue;
        const int block = block_of(piece[k], num_bytes[k]);
        SCREE_CHECK(block >= 0);
        if (block < 0) return;
        SCREE_CHECK_INT((piece[k] - blocks[block]) % SCREE_ARENA_ALIGNMENT, 0);
        memset(piece[k], k, (size_t)num_bytes[k]);
    }
    for (int k = 0; k < NUM_PIECES; ++k)
        if (piece[k] != NULL) SCREE_CHECK(scree_arena_give_back(&arena, piece[k]));
    SCREE_CHECK_INT(arena.num_pieces, NUM_BLOCKS);
    // every block is one piece, which can be taken as a whole
    for (int k = 0; k < NUM_BLOCKS; ++k) SCREE_CHECK(scree_arena_take(&arena, BLOCK_BYTES - 1) == blocks[k]);
    SCREE_CHECK(scree_arena_take(&arena, 0) == NULL);
    scree_arena_destroy(&arena);
}

static void test_refusals(void)
{
    scree_arena arena = {0};
    SCREE_CHECK(scree_arena_take(&arena, 10) == NULL);
    SCREE_CHECK(!scree_arena_give_back(&arena, blocks[0]));
    add_blocks(&arena);
    SCREE_CHECK_INT(arena.num_bytes, NUM_BLOCKS * BLOCK_BYTES);
    SCREE_CHECK(scree_arena_take(&arena, -1) == NULL);
    SCREE_CHECK(scree_arena_take(&arena, BLOCK_BYTES) == NULL); // a piece may not end with its block
    SCREE_CHECK(scree_arena_take(&arena, INT64_MAX) == NULL);
    char *none = scree_arena_take(&arena, 0);
    SCREE_CHECK(none != NULL && none != scree_arena_take(&arena, 0));
    SCREE_CHECK(!scree_arena_give_back(&arena, none + 1));
    scree_arena_destroy(&arena);
}

int main(void)
{
    SCREE_RUN(test_random_pieces);
    SCREE_RUN(test_refusals);
    return SCREE_TEST_END();
}
