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
    MAX_DIGIT_BITS = 11, ///< counters that stay in the fastest cache
    MAX_DIGITS = 1 << MAX_DIGIT_BITS,
    FEW_DIGIT_BITS = 8, ///< for so few items that counters would cost more than a pass
    FEW_ITEMS = 16384,
    MAX_CHUNKS = 64,
    MIN_CHUNK_ITEMS = 8192, ///< smaller ones are not worth a thread
    MAX_INSERTION_ITEMS = 48,
    MAX_KEY_DIGITS = 8 ///< of 8 bits and more
};

/// Bytes of the histograms, or of what the GPU wants instead.
static int64_t count_bytes(scree_device *device, int64_t max_items, bool has_values)
{
    int64_t num_bytes = 0;
    (void)has_values;
    if (device != NULL) SCREE_CUDA_CALL(num_bytes = scree_cuda_sort_scratch(device, max_items, has_values));
    if (device != NULL) return num_bytes;
    const int64_t max_chunks = max_items / MIN_CHUNK_ITEMS + 1;
    return (max_chunks < MAX_CHUNKS ? max_chunks : MAX_CHUNKS) * MAX_DIGITS * (int64_t)sizeof(uint32_t);
}

static void *take(const scree_sort_buffers *buffers, int64_t num_items, size_t item_size)
{
    return buffers->scratch != NULL ? scree_scratch_take(buffers->scratch, num_items, item_size)
                                    : scree_device_alloc(buffers->device, num_items, item_size);
}

scree_status scree_sort_reserve(scree_sort_buffers *buffers, int64_t num_items, bool has_values)
{
    if (num_items > (int64_t)UINT32_MAX) return SCREE_TOO_MANY;
    if (buffers->counts != NULL && num_items <= buffers->max_items && (buffers->has_values || !has_values))
        return SCREE_OK;
    scree_device *device = buffers->device;
    scree_sort_buffers grown = {.device = device, .scratch = buffers->scratch};
    grown.has_values = buffers->has_values || has_values;
    grown.max_items = num_items <= buffers->max_items ? buffers->max_items : num_items;
    grown.keys = take(&grown, grown.max_items, sizeof *grown.keys);
    grown.spare_keys = take(&grown, grown.max_items, sizeof *grown.keys);
    grown.num_count_bytes = count_bytes(device, grown.max_items, grown.has_values);
    grown.counts = take(&grown, grown.num_count_bytes, 1);
    bool is_complete = grown.keys != NULL && grown.spare_keys != NULL && grown.counts != NULL;
    if (grown.has_values)
    {
        grown.values = take(&grown, grown.max_items, sizeof *grown.values);
        grown.spare_values = take(&grown, grown.max_items, sizeof *grown.values);
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
    void *const arrays[] = {buffers->keys, buffers->values, buffers->spare_keys, buffers->spare_values,
                            buffers->counts};
    for (size_t k = 0; k < sizeof arrays / sizeof arrays[0] && buffers->scratch == NULL; ++k)
        scree_device_free(device, arrays[k]);
    *buffers = (scree_sort_buffers){.device = device, .scratch = buffers->scratch};
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

/// Items begin .. end - 1.
static void insertion_sort(scree_sort_buffers *buffers, int64_t begin, int64_t end, int first_bit)
{
    for (int64_t i = begin + 1; i < end; ++i)
    {
        const uint64_t key = buffers->keys[i];
        const int32_t value = buffers->has_values ? buffers->values[i] : 0;
        int64_t k = i;
        for (; k > begin && buffers->keys[k - 1] >> first_bit > key >> first_bit; --k)
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

/// The bits of a key that a pass looks at.
typedef struct sort_pass
{
    int shift, num_digits;
} sort_pass;

static void count_digits(const uint64_t *keys, int64_t num_items, sort_pass pass, uint32_t *counts)
{
    const int shift = pass.shift;
    const uint64_t mask = (uint64_t)pass.num_digits - 1;
    for (int d = 0; d < pass.num_digits; ++d) counts[d] = 0;
    UNROLL_LOOP
    for (int64_t i = 0; i < num_items; ++i) ++counts[keys[i] >> shift & mask];
}

/// Counts to places: digit by digit, and for equal digits chunk by chunk.
static void counts_to_places(uint32_t *counts, int num_chunks, int num_digits)
{
    uint32_t place = 0;
    for (int d = 0; d < num_digits; ++d)
    {
        for (int c = 0; c < num_chunks; ++c)
        {
            const uint32_t count = counts[c * MAX_DIGITS + d];
            counts[c * MAX_DIGITS + d] = place;
            place += count;
        }
    }
}

/// Keys begin .. end - 1 to their places.
static void scatter_keys(const scree_sort_buffers *b, int64_t begin, int64_t end, sort_pass pass, uint32_t *places)
{
    const int shift = pass.shift;
    const uint64_t mask = (uint64_t)pass.num_digits - 1;
    const uint64_t *restrict keys = b->keys;
    uint64_t *restrict sorted_keys = b->spare_keys;
    UNROLL_LOOP
    for (int64_t i = begin; i < end; ++i)
    {
        const uint64_t key = keys[i];
        sorted_keys[places[key >> shift & mask]++] = key;
    }
}

/// Keys and values begin .. end - 1 to their places.
static void scatter_items(const scree_sort_buffers *b, int64_t begin, int64_t end, sort_pass pass, uint32_t *places)
{
    const int shift = pass.shift;
    const uint64_t mask = (uint64_t)pass.num_digits - 1;
    const uint64_t *restrict keys = b->keys;
    const int32_t *restrict values = b->values;
    uint64_t *restrict sorted_keys = b->spare_keys;
    int32_t *restrict sorted_values = b->spare_values;
    UNROLL_LOOP
    for (int64_t i = begin; i < end; ++i)
    {
        const uint64_t key = keys[i];
        const uint32_t place = places[key >> shift & mask]++;
        sorted_keys[place] = key;
        sorted_values[place] = values[i];
    }
}

static void sort_digit(scree_sort_buffers *buffers, int64_t num_items, sort_pass pass)
{
    const int num_chunks = count_chunks(num_items);
    uint32_t *counts = buffers->counts;
#pragma omp parallel for schedule(static, 1) num_threads(num_chunks)
    for (int c = 0; c < num_chunks; ++c)
    {
        const int64_t begin = first_of_chunk(num_items, num_chunks, c);
        const int64_t end = first_of_chunk(num_items, num_chunks, c + 1);
        count_digits(buffers->keys + begin, end - begin, pass, counts + c * MAX_DIGITS);
    }
    counts_to_places(counts, num_chunks, pass.num_digits);
#pragma omp parallel for schedule(static, 1) num_threads(num_chunks)
    for (int c = 0; c < num_chunks; ++c)
    {
        const int64_t begin = first_of_chunk(num_items, num_chunks, c);
        const int64_t end = first_of_chunk(num_items, num_chunks, c + 1);
        if (buffers->has_values) scatter_items(buffers, begin, end, pass, counts + c * MAX_DIGITS);
        else scatter_keys(buffers, begin, end, pass, counts + c * MAX_DIGITS);
    }

    uint64_t *keys = buffers->keys;
    int32_t *values = buffers->values;
    buffers->keys = buffers->spare_keys;
    buffers->values = buffers->spare_values;
    buffers->spare_keys = keys;
    buffers->spare_values = values;
}

/// Cuts the varying bits, none below first_bit, into digits, the highest first; returns how many. Gaps are skipped.
static int choose_passes(uint64_t varying, int first_bit, int num_bits, sort_pass *passes)
{
    int num_passes = 0;
    while (varying != 0)
    {
        const int top = 63 - __builtin_clzll(varying);
        const int shift = top - num_bits + 1 > first_bit ? top - num_bits + 1 : first_bit;
        passes[num_passes++] = (sort_pass){shift, 1 << num_bits};
        varying &= ((uint64_t)1 << shift) - 1;
    }
    return num_passes;
}

/// Passes 0 .. num_passes - 1, the lowest bits first.
static void sort_digits(scree_sort_buffers *buffers, int64_t num_items, const sort_pass *passes, int num_passes)
{
    for (int p = num_passes - 1; p >= 0; --p) sort_digit(buffers, num_items, passes[p]);
}

/// First item from `begin` on whose key differs from the one before it in the bits from `shift` up; -1 if that is far.
static int64_t first_of_run(const uint64_t *keys, int64_t begin, int64_t num_items, int shift)
{
    int64_t i = begin;
    while (i > 0 && i < num_items && keys[i] >> shift == keys[i - 1] >> shift)
        if (++i - begin > MAX_INSERTION_ITEMS) return -1;
    return i;
}

/// Items that are sorted by the bits from `shift` up: sorts runs of equal ones by the rest. False, with some runs
/// sorted, if one of them is long.
static bool sort_runs(scree_sort_buffers *buffers, int64_t num_items, int shift, int first_bit)
{
    const int num_chunks = count_chunks(num_items);
    int64_t first[MAX_CHUNKS + 1];
    for (int c = 0; c <= num_chunks; ++c)
    {
        first[c] = first_of_run(buffers->keys, first_of_chunk(num_items, num_chunks, c), num_items, shift);
        if (first[c] < 0) return false;
    }
    int has_long = 0;
#pragma omp parallel for schedule(static, 1) num_threads(num_chunks) reduction(| : has_long)
    for (int c = 0; c < num_chunks; ++c)
    {
        for (int64_t i = first[c]; i < first[c + 1] && !has_long;)
        {
            int64_t end = i + 1;
            while (end < first[c + 1] && buffers->keys[end] >> shift == buffers->keys[i] >> shift) ++end;
            if (end - i > MAX_INSERTION_ITEMS) has_long = 1;
            else if (end - i > 1) insertion_sort(buffers, i, end, first_bit);
            i = end;
        }
    }
    return !has_long;
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
        insertion_sort(buffers, 0, num_items, first_bit);
        return;
    }
    const uint64_t varying = find_varying_bits(buffers->keys, num_items) >> first_bit << first_bit;
    sort_pass passes[MAX_KEY_DIGITS];
    const int num_passes =
        choose_passes(varying, first_bit, num_items < FEW_ITEMS ? FEW_DIGIT_BITS : MAX_DIGIT_BITS, passes);

    // the highest bits, as many as tell most keys apart, leave short runs; only where they do not are all bits gone
    // over, which is right after any stable sort by some of them
    int num_upper = 0;
    while (num_upper < num_passes && num_items >> __builtin_popcountll(varying >> passes[num_upper].shift) > 0)
        ++num_upper;
    if (num_upper + 1 < num_passes)
    {
        sort_digits(buffers, num_items, passes, num_upper + 1);
        if (sort_runs(buffers, num_items, passes[num_upper].shift, first_bit)) return;
    }
    sort_digits(buffers, num_items, passes, num_passes);
}
