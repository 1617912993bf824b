// Scratch: arrays of one stage never overlap, a stage begins where the last one did, and its memory is one block once
// its size is known.
#include "core/scratch.h"
#include "harness.h"

#include <string.h>

enum
{
    NUM_ARRAYS = 40
};

/// Arrays of some sizes, each filled with a number of its own; false if one of them is not what it was filled with.
static bool take_arrays(scree_scratch *scratch, uint64_t *state, int64_t num_bytes[NUM_ARRAYS])
{
    unsigned char *array[NUM_ARRAYS];
    for (int k = 0; k < NUM_ARRAYS; ++k)
    {
        const size_t item_size = 1 + scree_test_random_bits(state) % 24;
        const int64_t num_items = (int64_t)(scree_test_random_bits(state) % 3000);
        num_bytes[k] = num_items * (int64_t)item_size;
        array[k] = scree_scratch_take(scratch, num_items, item_size);
        if (array[k] == NULL || (uintptr_t)array[k] % 64 != 0) return false;
        memset(array[k], k, (size_t)num_bytes[k]);
    }
    for (int k = 0; k < NUM_ARRAYS; ++k)
        for (int64_t i = 0; i < num_bytes[k]; ++i)
            if (array[k][i] != k) return false;
    return true;
}

static void test_arrays_do_not_overlap(void)
{
    scree_scratch scratch = {0};
    uint64_t state = 5;
    int64_t num_bytes[NUM_ARRAYS];
    for (int stage = 0; stage < 50; ++stage)
    {
        SCREE_CHECK_INT(scree_scratch_begin(&scratch, 0), SCREE_OK);
        SCREE_CHECK(take_arrays(&scratch, &state, num_bytes));
        int64_t sum = 0;
        for (int k = 0; k < NUM_ARRAYS; ++k) sum += scree_scratch_bytes(num_bytes[k], 1);
        SCREE_CHECK_INT(scratch.num_taken, sum);
        SCREE_CHECK(scratch.most >= sum);
    }
    scree_scratch_destroy(&scratch);
    SCREE_CHECK(scratch.blocks == NULL && scratch.num_blocks == 0);
}

/// Two stages in turn, as a search and the contacts are: after the first turn both have the same memory.
static void test_stages_share_memory(void)
{
    scree_scratch scratch = {0};
    const void *first = NULL;
    for (int turn = 0; turn < 3; ++turn)
    {
        SCREE_CHECK_INT(scree_scratch_begin(&scratch, 0), SCREE_OK);
        void *keys = scree_scratch_take(&scratch, 1000, sizeof(uint64_t));
        SCREE_CHECK(scree_scratch_take(&scratch, 5000, sizeof(uint64_t)) != NULL);
        SCREE_CHECK_INT(scratch.num_blocks, turn == 0 ? 2 : 1);
        SCREE_CHECK_INT(scree_scratch_begin(&scratch, 40000), SCREE_OK);
        SCREE_CHECK_INT(scratch.num_blocks, 1);
        void *forces = scree_scratch_take(&scratch, 40000, 1);
        if (turn > 0) SCREE_CHECK(keys == forces && (turn == 1 || keys == first));
        first = keys;
        SCREE_CHECK_INT(scratch.blocks->num_bytes,
                        scree_scratch_bytes(1000, sizeof(uint64_t)) + scree_scratch_bytes(5000, sizeof(uint64_t)));
    }
    scree_scratch_destroy(&scratch);
}

static void test_sizes_that_cannot_be(void)
{
    scree_scratch scratch = {0};
    SCREE_CHECK(scree_scratch_take(&scratch, -1, 8) == NULL);
    SCREE_CHECK(scree_scratch_take(&scratch, INT64_MAX / 2, 8) == NULL);
    SCREE_CHECK(scree_scratch_take(&scratch, (int64_t)1 << 55, 8) == NULL);
    SCREE_CHECK(scree_scratch_take(&scratch, 0, 8) != NULL);
    SCREE_CHECK(scree_scratch_begin(&scratch, (int64_t)1 << 60) == SCREE_OUT_OF_MEMORY);
    SCREE_CHECK_INT(scratch.num_blocks, 0);
    scree_scratch_destroy(&scratch);
}

int main(void)
{
    SCREE_RUN(test_arrays_do_not_overlap);
    SCREE_RUN(test_stages_share_memory);
    SCREE_RUN(test_sizes_that_cannot_be);
    return SCREE_TEST_END();
}
