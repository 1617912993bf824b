/// \file bench_device.c
/// What a GPU is held against: its memory, and how fast it copies within it.
#include "cli/bench.h"
#include "dynamics/on_device.h"

#include <stdlib.h>

enum
{
    NUM_COPIES = 7
};

/// Bytes of each of the two arrays: far more than a cache holds, so that memory itself is measured.
#define COPIED_BYTES ((int64_t)256 << 20)

/// [bytes/s] read and written by a copy of arrays of num_bytes: the median of some. 0: no memory, or the GPU failed.
static double copy_rate(scree_device *device, int64_t num_bytes)
{
    char *from = scree_device_alloc(device, num_bytes, 1), *to = scree_device_alloc(device, num_bytes, 1);
    double rates[NUM_COPIES];
    bool is_sound = from != NULL && to != NULL;
    if (is_sound) scree_device_zero(device, from, (size_t)num_bytes);
    // the first one is not counted
    for (int k = -1; k < NUM_COPIES && is_sound; ++k)
    {
        is_sound = scree_device_status(device, NULL) == SCREE_OK;
        const double start = scree_bench_wall_seconds();
        scree_device_copy(device, to, from, (size_t)num_bytes);
        is_sound = is_sound && scree_device_status(device, NULL) == SCREE_OK;
        if (k >= 0) rates[k] = 2 * (double)num_bytes / (scree_bench_wall_seconds() - start);
    }
    scree_device_free(device, to);
    scree_device_free(device, from);
    const scree_bench_samples samples = {rates, NUM_COPIES};
    if (is_sound) scree_bench_sort(samples);
    return is_sound ? scree_bench_median(samples) : 0;
}

scree_status scree_bench_device(int32_t number, json_t **described, scree_report *report)
{
    *described = NULL;
    scree_device_def def = scree_default_device_def();
    def.number = number;
    def.arena_bytes = 0; // so that all of it is given back
    scree_device *device;
    scree_status status = scree_device_open(&device, &def, report);
    if (status != SCREE_OK) return status;
    const int64_t num_free = scree_device_free_memory(device);
    const double rate = copy_rate(device, num_free / 4 < COPIED_BYTES ? num_free / 4 : COPIED_BYTES);
    status = scree_device_status(device, report);
    if (status == SCREE_OK)
        *described = json_pack("{s:s, s:I, s:f}", "name", scree_device_name(device), "free_bytes", (json_int_t)num_free,
                               "copy_bytes_per_second", rate);
    if (status == SCREE_OK && *described == NULL) status = SCREE_OUT_OF_MEMORY;
    scree_device_close(device);
    return status;
}
