/// Prefix sums against the sum as a plain loop forms it, for sizes around the shares of the threads.
#include "core/scan.h"

#include <omp.h>
#include <stdlib.h>

#include "harness.h"

static void check_size(int64_t num, int64_t largest)
{
    int64_t *values = malloc((size_t)(num + 1) * sizeof *values);
    int64_t *expected = malloc((size_t)(num + 1) * sizeof *expected);
    if (values == NULL || expected == NULL) exit(EXIT_FAILURE);
    for (int threads = 1; threads <= 7; threads += threads == 1 ? 1 : 5)
    {
        omp_set_num_threads(threads);
        uint64_t state = (uint64_t)num;
        int64_t sum = 0;
        for (int64_t i = 0; i < num; ++i)
        {
            values[i] = (int64_t)(scree_test_random_bits(&state) % (uint64_t)(largest + 1));
            expected[i] = sum;
            sum += values[i];
        }
        expected[num] = sum;
        values[num] = -1;
        SCREE_CHECK_INT(scree_scan_exclusive(values, num), sum);
        SCREE_CHECK(memcmp(values, expected, (size_t)(num + 1) * sizeof *values) == 0);
    }
    free(values);
    free(expected);
}

static void test_sums_of_any_size(void)
{
    const int64_t sizes[] = {0, 1, 2, 3, 1000, 16383, 16384, 32767, 32768, 32769, 114688, 300001};
    for (int s = 0; s < (int)(sizeof sizes / sizeof *sizes); ++s) check_size(sizes[s], 100);
}

static void test_sums_beyond_32_bits(void) { check_size(100000, (int64_t)1 << 44); }

static void test_all_zero(void) { check_size(100000, 0); }

int main(void)
{
    SCREE_RUN(test_sums_of_any_size);
    SCREE_RUN(test_sums_beyond_32_bits);
    SCREE_RUN(test_all_zero);
    return SCREE_TEST_END();
}
