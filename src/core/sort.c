#include "core/sort.h"

#include "core/device_cuda.h"

#include <stdlib.h>
#ifdef _OPENMP
#include <omp.h>
#endif

/// Unrolls the next loop. On some processors the counters of a loop that is not unrolled wait for each other, whether
/// they are the same or not: measured 10 ns per item and digit, and 4 ns unrolled (AMD EPYC).
#if defined(__clang__)
#define UNROLL_LOOP _Pragma("clang loop unroll_count(16)")
#else
#define UNROLL_LOOP _Pragma("GCC unroll 16")
#endif

enum
{
    DIGIT_BITS = 8,
    NUM_DIGITS = 1 << DIGIT_BITS,
    MAX_CHUNKS = 64,
    MIN_CHUNK_ITEMS = 8192, ///< smaller ones are not worth a thread
    MAX_INSERTION_ITEMS = 48
};

/// Bytes of the histograms, or of what the GPU wants instead.
static int64_t count_bytes(scree_device *device, int64_t max_items, bool has_values)
{
    int64_t num_bytes = 0;
    (void)has_values;
    if (device != NULL) SCREE_CUDA_CALL(num_bytes = scree_cuda_sort_scratch(device, max_items, has_values));
    if (device != NULL) return num_bytes;
    const int64_t max_chunks = max_items / MIN_CHUNK_ITEMS + 1;
    return (max_chunks < MAX_CHUNKS ? max_chunks : MAX_CHUNKS) * NUM_DIGITS * (int64_t)sizeof(uint32_t);
}

scree_status scree_sort_reserve(scree_sort_buffers *buffers, int64_t num_items, bool has_values)
{
    if (num_items > (int64_t)UINT32_MAX) return SCREE_TOO_MANY;
    if (buffers->counts != NULL && num_items <= buffers->max_items && (buffers->has_values || !has_values))
        return SCREE_OK;
    scree_device *device = buffers->device;
    scree_sort_buffers grown = {.device = device};
    grown.has_values = buffers->has_values || has_values;
    grown.max_items = num_items <= buffers->max_items ? buffers->max_items : num_items;
    grown.keys = scree_device_alloc(device, grown.max_items, sizeof *grown.keys);
    grown.spare_keys = scree_device_alloc(device, grown.max_items, sizeof *grown.keys);
    grown.num_count_bytes = count_bytes(device, grown.max_items, grown.has_values);
    grown.counts = scree_device_alloc(device, grown.num_count_bytes, 1);
    bool is_complete = grown.keys != NULL && grown.spare_keys != NULL && grown.counts != NULL;
    if (grown.has_values)
    {
        grown.values = scree_device_alloc(device, grown.max_items, sizeof *grown.values);
        grown.spare_values = scree_device_alloc(device, grown.max_items, sizeof *grown.values);
        is_complete = is_complete && grown.values != NULL && grown.spare_values != NULL;
    }
    scree_sort_destroy(is_complete ? buffers : &grown);
    if (!is_complete) return SCREE_OUT_OF_MEMORY;
    *buffers = grown;
    return SCREE_OK;
}

void scree_sort_destroy(scree_sort_buffers *buffers)
{
    scree_device *device = buffers->device;
    scree_device_free(device, buffers->keys);
    scree_device_free(device, buffers->values);
    scree_device_free(device, buffers->spare_keys);
    scree_device_free(device, buffers->spare_values);
    scree_device_free(device, buffers->counts);
    *buffers = (scree_sort_buffers){.device = device};
}

/// How the items are shared: chunk c holds first_of_chunk(c) up to first_of_chunk(c + 1).
static int count_chunks(int64_t num_items)
{
    int64_t num_chunks = num_items / MIN_CHUNK_ITEMS;
#ifdef _OPENMP
    if (num_chunks > omp_get_max_threads()) num_chunks = omp_get_max_threads();
#else
    num_chunks = 1;
#endif
    return num_chunks < 1 ? 1 : num_chunks > MAX_CHUNKS ? MAX_CHUNKS : (int)num_chunks;
}

static int64_t first_of_chunk(int64_t num_items, int num_chunks, int c) { return num_items * c / num_chunks; }

static void insertion_sort(scree_sort_buffers *buffers, int64_t num_items, int first_bit)
{
    for (int64_t i = 1; i < num_items; ++i)
    {
        const uint64_t key = buffers->keys[i];
        const int32_t value = buffers->has_values ? buffers->values[i] : 0;
        int64_t k = i;
        for (; k > 0 && buffers->keys[k - 1] >> first_bit > key >> first_bit; --k)
        {
            buffers->keys[k] = buffers->keys[k - 1];
            if (buffers->has_values) buffers->values[k] = buffers->values[k - 1];
        }
        buffers->keys[k] = key;
        if (buffers->has_values) buffers->values[k] = value;
    }
}

/// The bits in which keys differ.
static uint64_t find_varying_bits(const uint64_t *keys, int64_t num_items)
{
    uint64_t varying = 0;
    const uint64_t first = keys[0];
#pragma omp parallel for schedule(static) reduction(| : varying)
    for (int64_t i = 0; i < num_items; ++i) varying |= keys[i] ^ first;
    return varying;
}

static void count_digits(const uint64_t *keys, int64_t num_items, int shift, uint32_t *counts)
{
    for (int d = 0; d < NUM_DIGITS; ++d) counts[d] = 0;
    UNROLL_LOOP
    for (int64_t i = 0; i < num_items; ++i) ++counts[keys[i] >> shift & (NUM_DIGITS - 1)];
}

/// Counts to places: digit by digit, and for equal digits chunk by chunk.
static void counts_to_places(uint32_t *counts, int num_chunks)
{
    uint32_t place = 0;
    for (int d = 0; d < NUM_DIGITS; ++d)
    {
        for (int c = 0; c < num_chunks; ++c)
        {
            const uint32_t count = counts[c * NUM_DIGITS + d];
            counts[c * NUM_DIGITS + d] = place;
            place += count;
        }
    }
}

/// Keys begin .. end - 1 to their places.
static void scatter_keys(const scree_sort_buffers *b, int64_t begin, int64_t end, int shift, uint32_t *places)
{
    const uint64_t *restrict keys = b->keys;
    uint64_t *restrict sorted_keys = b->spare_keys;
    UNROLL_LOOP
    for (int64_t i = begin; i < end; ++i)
    {
        const uint64_t key = keys[i];
        sorted_keys[places[key >> shift & (NUM_DIGITS - 1)]++] = key;
    }
}

/// Keys and values begin .. end - 1 to their places.
static void scatter_items(const scree_sort_buffers *b, int64_t begin, int64_t end, int shift, uint32_t *places)
{
    const uint64_t *restrict keys = b->keys;
    const int32_t *restrict values = b->values;
    uint64_t *restrict sorted_keys = b->spare_keys;
    int32_t *restrict sorted_values = b->spare_values;
    UNROLL_LOOP
    for (int64_t i = begin; i < end; ++i)
    {
        const uint64_t key = keys[i];
        const uint32_t place = places[key >> shift & (NUM_DIGITS - 1)]++;
        sorted_keys[place] = key;
        sorted_values[place] = values[i];
    }
}

static void sort_digit(scree_sort_buffers *buffers, int64_t num_items, int shift)
{
    const int num_chunks = count_chunks(num_items);
    uint32_t *counts = buffers->counts;
#pragma omp parallel for schedule(static, 1) num_threads(num_chunks)
    for (int c = 0; c < num_chunks; ++c)
    {
        const int64_t begin = first_of_chunk(num_items, num_chunks, c);
        const int64_t end = first_of_chunk(num_items, num_chunks, c + 1);
        count_digits(buffers->keys + begin, end - begin, shift, counts + c * NUM_DIGITS);
    }
    counts_to_places(counts, num_chunks);
#pragma omp parallel for schedule(static, 1) num_threads(num_chunks)
    for (int c = 0; c < num_chunks; ++c)
    {
        const int64_t begin = first_of_chunk(num_items, num_chunks, c);
        const int64_t end = first_of_chunk(num_items, num_chunks, c + 1);
        if (buffers->has_values) scatter_items(buffers, begin, end, shift, counts + c * NUM_DIGITS);
        else scatter_keys(buffers, begin, end, shift, counts + c * NUM_DIGITS);
    }

    uint64_t *keys = buffers->keys;
    int32_t *values = buffers->values;
    buffers->keys = buffers->spare_keys;
    buffers->values = buffers->spare_values;
    buffers->spare_keys = keys;
    buffers->spare_values = values;
}

void scree_sort(scree_sort_buffers *buffers, int64_t num_items, int first_bit)
{
    if (num_items < 2) return;
    if (buffers->device != NULL)
    {
        SCREE_CUDA_CALL(scree_cuda_sort(buffers, num_items, first_bit));
        return;
    }
    if (num_items <= MAX_INSERTION_ITEMS)
    {
        insertion_sort(buffers, num_items, first_bit);
        return;
    }
    // a digit starts at the lowest bit that is left: gaps between the used bits of composed keys are skipped
    uint64_t varying = find_varying_bits(buffers->keys, num_items) >> first_bit << first_bit;
    for (int shift = 0; varying != 0; ++shift)
    {
        if ((varying >> shift & 1) == 0) continue;
        sort_digit(buffers, num_items, shift);
        varying &= ~((uint64_t)(NUM_DIGITS - 1) << shift);
    }
}
