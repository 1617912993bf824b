/// Prefix sums against the sum as a plain loop forms it, for sizes around the shares of the threads.
#include "core/scan.h"

#include <omp.h>
#include <stdlib.h>

#include "harness.h"

static void check_size(int64_t num, int32_t largest)
{
    int32_t *values = malloc((size_t)(num + 1) * sizeof *values);
    int32_t *expected = malloc((size_t)(num + 1) * sizeof *expected);
    if (values == NULL || expected == NULL) exit(EXIT_FAILURE);
    for (int threads = 1; threads <= 7; threads += threads == 1 ? 1 : 5)
    {
        omp_set_num_threads(threads);
        uint64_t state = (uint64_t)num;
        int64_t sum = 0;
        for (int64_t i = 0; i < num; ++i)
        {
            values[i] = (int32_t)(scree_test_random_bits(&state) % (uint64_t)(largest + 1));
            expected[i] = (int32_t)sum;
            sum += values[i];
        }
        expected[num] = (int32_t)sum;
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

/// The largest total that there may be, and those above: just so, and with parts above as well.
static void test_too_large_sums(void)
{
    enum
    {
        NUM = 100000
    };
    static int32_t values[NUM + 1];
    const int64_t totals[] = {INT32_MAX, (int64_t)INT32_MAX + 1, (int64_t)1 << 32, ((int64_t)1 << 32) + 5,
                              (int64_t)1 << 45};
    for (int k = 0; k < (int)(sizeof totals / sizeof *totals); ++k)
        for (int threads = 1; threads <= 7; threads += 6)
        {
            omp_set_num_threads(threads);
            for (int i = 0; i < NUM; ++i) values[i] = (int32_t)(totals[k] / NUM + (i < totals[k] % NUM));
            values[NUM] = 7;
            SCREE_CHECK(scree_scan_exclusive(values, NUM) == totals[k]);
            SCREE_CHECK_INT(values[NUM], k == 0 ? INT32_MAX : -1);
        }
}

static void test_all_zero(void) { check_size(100000, 0); }

int main(void)
{
    SCREE_RUN(test_sums_of_any_size);
    SCREE_RUN(test_too_large_sums);
    SCREE_RUN(test_all_zero);
    return SCREE_TEST_END();
}
