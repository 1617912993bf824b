/// The radix sort against what a stable sort must give: keys ascending, equal keys in the order of their values, which
/// are their places before, and every item still there.
#include "core/sort.h"

#include <omp.h>
#include <stdlib.h>

#include "harness.h"

/// Kinds of keys.
enum
{
    RANDOM,
    FEW_DISTINCT,
    ALL_EQUAL,
    ASCENDING,
    DESCENDING,
    HIGHEST_BIT,
    SPARSE_BITS,
    NUM_KINDS
};

static uint64_t make_key(int kind, int64_t i, uint64_t *state)
{
    const uint64_t bits = scree_test_random_bits(state);
    switch (kind)
    {
    case FEW_DISTINCT:
        return bits % 3 << 30;
    case ALL_EQUAL:
        return 0x123456789abcdef0u;
    case ASCENDING:
        return (uint64_t)i;
    case DESCENDING:
        return ~(uint64_t)i;
    case HIGHEST_BIT:
        return bits & ((uint64_t)1 << 63 | 1);
    case SPARSE_BITS:
        return bits & 0x8001000010000801u;
    default:
        return bits;
    }
}

static void fill(scree_sort_buffers *buffers, int kind, int64_t num)
{
    uint64_t state = (uint64_t)(kind + 1) * 1000003u + (uint64_t)num;
    for (int64_t i = 0; i < num; ++i)
    {
        buffers->keys[i] = make_key(kind, i, &state);
        if (buffers->has_values) buffers->values[i] = (int32_t)i;
    }
}

/// Compares with the items as they were: `unsorted` by place.
static void check_sorted(const scree_sort_buffers *buffers, const uint64_t *unsorted, int64_t num, int first_bit)
{
    int64_t num_wrong = 0;
    for (int64_t k = 0; k < num; ++k)
    {
        const int32_t place = buffers->values[k];
        if (place < 0 || place >= num || buffers->keys[k] != unsorted[place]) ++num_wrong;
        if (k == 0) continue;
        // strictly ascending in (key, place): sorted, stable, and no item twice
        const uint64_t before = buffers->keys[k - 1] >> first_bit, key = buffers->keys[k] >> first_bit;
        if (before > key || (before == key && buffers->values[k - 1] >= place)) ++num_wrong;
    }
    SCREE_CHECK_INT(num_wrong, 0);
}

static void check_size(scree_sort_buffers *buffers, int64_t num, int first_bit)
{
    uint64_t *unsorted = malloc((size_t)(num + 1) * sizeof *unsorted);
    if (unsorted == NULL) exit(EXIT_FAILURE);
    for (int kind = 0; kind < NUM_KINDS; ++kind)
    {
        fill(buffers, kind, num);
        memcpy(unsorted, buffers->keys, (size_t)num * sizeof *unsorted);
        scree_sort(buffers, num, first_bit);
        check_sorted(buffers, unsorted, num, first_bit);
    }
    free(unsorted);
}

static void test_sizes_and_threads(void)
{
    const int64_t sizes[] = {0, 1, 2, 3, 47, 48, 49, 255, 1000, 16383, 16384, 60001};
    scree_sort_buffers buffers = {0};
    for (int threads = 1; threads <= 7; threads += threads == 1 ? 1 : 5)
    {
        omp_set_num_threads(threads);
        for (int s = 0; s < (int)(sizeof sizes / sizeof *sizes); ++s)
        {
            SCREE_CHECK(scree_sort_reserve(&buffers, sizes[s], true) == SCREE_OK);
            check_size(&buffers, sizes[s], 0);
        }
    }
    scree_sort_destroy(&buffers);
}

static void test_lowest_bits_left_alone(void)
{
    scree_sort_buffers buffers = {0};
    SCREE_CHECK(scree_sort_reserve(&buffers, 20000, true) == SCREE_OK);
    check_size(&buffers, 40, 32);
    check_size(&buffers, 20000, 32);
    check_size(&buffers, 20000, 61);
    scree_sort_destroy(&buffers);
}

/// The keys alone, against the same keys sorted with values.
static void test_without_values(void)
{
    scree_sort_buffers keys = {0}, both = {0};
    SCREE_CHECK(scree_sort_reserve(&keys, 20000, false) == SCREE_OK);
    SCREE_CHECK(scree_sort_reserve(&both, 20000, true) == SCREE_OK);
    for (int64_t num = 30; num <= 20000; num += 19970)
    {
        for (int kind = 0; kind < NUM_KINDS; ++kind)
        {
            fill(&keys, kind, num);
            fill(&both, kind, num);
            scree_sort(&keys, num, 0);
            scree_sort(&both, num, 0);
            SCREE_CHECK(memcmp(keys.keys, both.keys, (size_t)num * sizeof *keys.keys) == 0);
        }
    }
    scree_sort_destroy(&keys);
    scree_sort_destroy(&both);
}

static void test_room(void)
{
    scree_sort_buffers buffers = {0};
    SCREE_CHECK(scree_sort_reserve(&buffers, 100, false) == SCREE_OK);
    const uint64_t *keys = buffers.keys;
    SCREE_CHECK(scree_sort_reserve(&buffers, 100, false) == SCREE_OK);
    SCREE_CHECK(buffers.keys == keys); // no allocation if there is room
    SCREE_CHECK(scree_sort_reserve(&buffers, (int64_t)1 << 32, false) == SCREE_TOO_MANY);
    SCREE_CHECK(buffers.keys == keys && buffers.max_items >= 100);
    SCREE_CHECK(scree_sort_reserve(&buffers, 50, true) == SCREE_OK); // values are wanted later
    SCREE_CHECK(buffers.values != NULL && buffers.max_items >= 100);
    check_size(&buffers, 100, 0);
    scree_sort_destroy(&buffers);
    SCREE_CHECK(buffers.keys == NULL && buffers.max_items == 0);
}

int main(void)
{
    SCREE_RUN(test_sizes_and_threads);
    SCREE_RUN(test_lowest_bits_left_alone);
    SCREE_RUN(test_without_values);
    SCREE_RUN(test_room);
    return SCREE_TEST_END();
}
