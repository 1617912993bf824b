#include "core/scan.h"

#include "core/buffer.h"
#include "core/device_cuda.h"

#ifdef _OPENMP
#include <omp.h>
#endif

enum
{
    MAX_CHUNKS = 256,
    MIN_CHUNK_VALUES = 16384 ///< smaller ones are not worth a thread
};

static int count_chunks(int64_t num_values)
{
    int64_t num_chunks = num_values / MIN_CHUNK_VALUES;
#ifdef _OPENMP
    if (num_chunks > omp_get_max_threads()) num_chunks = omp_get_max_threads();
#else
    num_chunks = 1;
#endif
    return num_chunks < 1 ? 1 : num_chunks > MAX_CHUNKS ? MAX_CHUNKS : (int)num_chunks;
}

/// First value of chunk c; without the overflow of num_values * c.
static int64_t first_of_chunk(int64_t num_values, int num_chunks, int c)
{
    return num_values / num_chunks * c + num_values % num_chunks * c / num_chunks;
}

/// Exclusive sums of values[begin .. end), starting from `sum`; returns the sum after the last one.
static int64_t scan_chunk(int32_t *values, int64_t begin, int64_t end, int64_t sum)
{
    for (int64_t i = begin; i < end; ++i)
    {
        const int32_t value = values[i];
        values[i] = (int32_t)sum;
        sum += value;
    }
    return sum;
}

int64_t scree_scan_exclusive(int32_t *values, int64_t num_values)
{
    const int num_chunks = count_chunks(num_values);
    int64_t sums[MAX_CHUNKS];
    if (num_chunks > 1)
    {
        // the sum of each chunk, then of all chunks before it
#pragma omp parallel for schedule(static, 1) num_threads(num_chunks)
        for (int c = 0; c < num_chunks; ++c)
        {
            int64_t sum = 0;
            const int64_t end = first_of_chunk(num_values, num_chunks, c + 1);
            for (int64_t i = first_of_chunk(num_values, num_chunks, c); i < end; ++i) sum += values[i];
            sums[c] = sum;
        }
    }

    int64_t total = 0;
    for (int c = 0; c < num_chunks; ++c)
    {
        const int64_t sum = num_chunks > 1 ? sums[c] : 0;
        sums[c] = total;
        total += sum;
    }
#pragma omp parallel for schedule(static, 1) num_threads(num_chunks)
    for (int c = 0; c < num_chunks; ++c)
    {
        const int64_t sum = scan_chunk(values, first_of_chunk(num_values, num_chunks, c),
                                       first_of_chunk(num_values, num_chunks, c + 1), sums[c]);
        if (c == num_chunks - 1) total = sum;
    }
    values[num_values] = total > INT32_MAX ? -1 : (int32_t)total;
    return total;
}

scree_status scree_scan_reserve(scree_scan_scratch *scratch, int64_t num_values)
{
    if (scratch->device == NULL || (num_values <= scratch->max_values && scratch->memory != NULL)) return SCREE_OK;
    scree_scan_destroy(scratch);
    const int64_t max_values = scree_buffer_grown(num_values);
    SCREE_CUDA_CALL(scratch->num_bytes = scree_cuda_scan_scratch(scratch->device, max_values + 1));
    scratch->memory = scree_device_alloc(scratch->device, scratch->num_bytes, 1);
    if (scratch->memory == NULL) return SCREE_OUT_OF_MEMORY;
    scratch->max_values = max_values;
    return SCREE_OK;
}

void scree_scan_on(scree_scan_scratch *scratch, int32_t *values, int64_t num_values)
{
    if (scratch->device == NULL)
    {
        scree_scan_exclusive(values, num_values);
        return;
    }
    // the last one has nothing but what is before it
    scree_device_zero(scratch->device, values + num_values, sizeof *values);
    SCREE_CUDA_CALL(scree_cuda_scan(scratch->device, values, num_values + 1, scratch->memory, scratch->num_bytes));
}

void scree_scan_destroy(scree_scan_scratch *scratch)
{
    scree_device_free(scratch->device, scratch->memory);
    *scratch = (scree_scan_scratch){.device = scratch->device};
}
