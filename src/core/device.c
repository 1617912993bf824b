/// \file device.c
/// The CPU's part of device.h, and the way to the other part, which device_cuda.cu holds in builds with CUDA.
#include "core/device.h"

#include "core/buffer.h"
#include "core/device_cuda.h"

#include <stdlib.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif

scree_device_def scree_default_device_def(void)
{
    return (scree_device_def){.number = 0, .block = 128, .records = true, .arena_bytes = (int64_t)256 << 20};
}

scree_status scree_device_open(scree_device **device, const scree_device_def *def, scree_report *report)
{
    *device = NULL;
#ifdef SCREE_CUDA
    return scree_cuda_open(device, def, report);
#else
    (void)def;
    scree_report_add(report,
                     "this build of scree has no CUDA: configure it with \"cmake --preset cuda\", or run on the "
                     "CPU");
    return SCREE_NO_DEVICE;
#endif
}

void scree_device_close(scree_device *device)
{
    if (device != NULL) SCREE_CUDA_CALL(scree_cuda_close(device));
}

scree_status scree_device_status(scree_device *device, scree_report *report)
{
    scree_status status = SCREE_OK;
    if (device != NULL) SCREE_CUDA_CALL(status = scree_cuda_status(device, report));
    (void)report;
    return status;
}

int64_t scree_device_concurrency(scree_device *device)
{
#ifdef _OPENMP
    int64_t num = omp_get_max_threads();
#else
    int64_t num = 1;
#endif
    if (device != NULL) SCREE_CUDA_CALL(num = scree_cuda_concurrency(device));
    return num;
}

int64_t scree_device_free_memory(scree_device *device)
{
    int64_t num_bytes = INT64_MAX;
    if (device != NULL) SCREE_CUDA_CALL(num_bytes = scree_cuda_free_memory(device));
    return num_bytes;
}

bool scree_device_take(scree_device *device, int64_t num_bytes)
{
    bool is_taken = true;
    if (device != NULL) SCREE_CUDA_CALL(is_taken = scree_cuda_take(device, num_bytes));
    (void)num_bytes;
    return is_taken;
}

const char *scree_device_name(const scree_device *device)
{
    const char *name = "CPU";
    if (device != NULL) SCREE_CUDA_CALL(name = scree_cuda_name(device));
    return name;
}

scree_status scree_device_reserve(scree_device *device, void *array, int64_t *max_items, int64_t num_items,
                                  size_t item_size)
{
    void *const *items = array;
    if (num_items <= *max_items && *items != NULL) return SCREE_OK;
    return scree_device_reserve_only(device, array, max_items, scree_buffer_grown(num_items), item_size);
}

scree_status scree_device_reserve_only(scree_device *device, void *array, int64_t *max_items, int64_t num_items,
                                       size_t item_size)
{
    void **items = array;
    if (num_items <= *max_items && *items != NULL) return SCREE_OK;
    scree_device_free(device, *items);
    *items = scree_device_alloc(device, num_items, item_size);
    *max_items = *items != NULL ? num_items : 0;
    return *items != NULL ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

void *scree_device_alloc(scree_device *device, int64_t num_items, size_t item_size)
{
    if (device == NULL) return scree_buffer_alloc(num_items, item_size);
    void *memory = NULL;
    if (num_items >= 0 && item_size > 0 && (uint64_t)num_items <= (uint64_t)PTRDIFF_MAX / 2 / item_size)
        SCREE_CUDA_CALL(memory = scree_cuda_alloc(device, num_items * (int64_t)item_size));
    return memory;
}

void scree_device_free(scree_device *device, void *memory)
{
    if (device == NULL) free(memory);
    else if (memory != NULL) SCREE_CUDA_CALL(scree_cuda_free(device, memory));
}

void scree_device_write(scree_device *device, void *to, const void *from, size_t num_bytes)
{
    if (num_bytes == 0) return;
    if (device == NULL) memcpy(to, from, num_bytes);
    else SCREE_CUDA_CALL(scree_cuda_write(device, to, from, num_bytes));
}

void scree_device_read(scree_device *device, void *to, const void *from, size_t num_bytes)
{
    if (num_bytes == 0) return;
    if (device == NULL) memcpy(to, from, num_bytes);
    else SCREE_CUDA_CALL(scree_cuda_read(device, to, from, num_bytes));
}

void scree_device_copy(scree_device *device, void *to, const void *from, size_t num_bytes)
{
    if (num_bytes == 0) return;
    if (device == NULL) memcpy(to, from, num_bytes);
    else SCREE_CUDA_CALL(scree_cuda_copy(device, to, from, num_bytes));
}

void scree_device_zero(scree_device *device, void *memory, size_t num_bytes)
{
    if (num_bytes == 0) return;
    if (device == NULL) memset(memory, 0, num_bytes);
    else SCREE_CUDA_CALL(scree_cuda_zero(device, memory, num_bytes));
}

void scree_device_branch(scree_device *device, int32_t branch)
{
    if (device != NULL) SCREE_CUDA_CALL(scree_cuda_branch(device, branch));
    (void)branch;
}

void scree_device_join(scree_device *device)
{
    if (device != NULL) SCREE_CUDA_CALL(scree_cuda_join(device));
}

void scree_device_wait(scree_device *device)
{
    if (device != NULL) SCREE_CUDA_CALL(scree_cuda_wait(device));
}

void *scree_device_alloc_host(scree_device *device, size_t num_bytes)
{
    if (device == NULL) return calloc(1, num_bytes > 0 ? num_bytes : 1);
    void *memory = NULL;
    SCREE_CUDA_CALL(memory = scree_cuda_alloc_host(num_bytes > 0 ? num_bytes : 1));
    return memory;
}

void scree_device_free_host(scree_device *device, void *memory)
{
    if (device == NULL) free(memory);
    else if (memory != NULL) SCREE_CUDA_CALL(scree_cuda_free_host(device, memory));
}

void scree_device_send(scree_device *device, void *to, const void *from, size_t num_bytes)
{
    if (num_bytes == 0) return;
    if (device == NULL) memcpy(to, from, num_bytes);
    else SCREE_CUDA_CALL(scree_cuda_send(device, to, from, num_bytes));
}

void scree_device_fetch(scree_device *device, void *to, const void *from, size_t num_bytes)
{
    if (num_bytes == 0) return;
    if (device == NULL) memcpy(to, from, num_bytes);
    else SCREE_CUDA_CALL(scree_cuda_fetch(device, to, from, num_bytes));
}

bool scree_device_records(const scree_device *device)
{
    bool records = false;
    if (device != NULL) SCREE_CUDA_CALL(records = scree_cuda_records(device));
    return records;
}

void scree_device_record(scree_device *device, const scree_live *live)
{
    if (device != NULL) SCREE_CUDA_CALL(scree_cuda_record(device, live));
    (void)live;
}

bool scree_device_end_record(scree_device *device, scree_recording **recording)
{
    bool is_done = false;
    if (device != NULL) SCREE_CUDA_CALL(is_done = scree_cuda_end_record(device, recording));
    (void)recording;
    return is_done;
}

void scree_device_play(scree_device *device, const scree_recording *recording)
{
    if (device != NULL) SCREE_CUDA_CALL(scree_cuda_play(device, recording));
    (void)recording;
}

void scree_device_forget(scree_device *device, scree_recording *recording)
{
    if (recording != NULL) SCREE_CUDA_CALL(scree_cuda_forget(device, recording));
    (void)device;
}
