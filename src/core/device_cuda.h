/// \file device_cuda.h
/// What device.c and sort.c call in builds with CUDA, where SCREE_CUDA is defined. Errors are kept in the device.
#ifndef SCREE_DEVICE_CUDA_H
#define SCREE_DEVICE_CUDA_H

#include "core/device.h"
#include "core/sort.h"

/// A call that is there in builds with CUDA only; elsewhere no device exists.
#ifdef SCREE_CUDA
#define SCREE_CUDA_CALL(call) ((void)(call))
#else
#define SCREE_CUDA_CALL(call) ((void)0)
#endif

#ifdef __cplusplus
extern "C"
{
#endif

    scree_status scree_cuda_open(scree_device **device, const scree_device_def *def, scree_report *report);
    void scree_cuda_close(scree_device *device);
    scree_status scree_cuda_status(scree_device *device, scree_report *report);
    int64_t scree_cuda_concurrency(scree_device *device);
    int64_t scree_cuda_free_memory(scree_device *device);
    bool scree_cuda_take(scree_device *device, int64_t num_bytes);
    const char *scree_cuda_name(const scree_device *device);
    void *scree_cuda_alloc(scree_device *device, int64_t num_bytes);
    void scree_cuda_free(scree_device *device, void *memory);
    void scree_cuda_write(scree_device *device, void *to, const void *from, size_t num_bytes);
    void scree_cuda_read(scree_device *device, void *to, const void *from, size_t num_bytes);
    void scree_cuda_copy(scree_device *device, void *to, const void *from, size_t num_bytes);
    void scree_cuda_zero(scree_device *device, void *memory, size_t num_bytes);

    void scree_cuda_branch(scree_device *device, int32_t branch);
    void scree_cuda_join(scree_device *device);
    void scree_cuda_wait(scree_device *device);
    void *scree_cuda_alloc_host(size_t num_bytes);
    void scree_cuda_free_host(scree_device *device, void *memory);
    void scree_cuda_send(scree_device *device, void *to, const void *from, size_t num_bytes);
    void scree_cuda_fetch(scree_device *device, void *to, const void *from, size_t num_bytes);
    bool scree_cuda_records(const scree_device *device);
    void scree_cuda_record(scree_device *device, const scree_live *live);
    bool scree_cuda_end_record(scree_device *device, scree_recording **recording);
    void scree_cuda_play(scree_device *device, const scree_recording *recording);
    void scree_cuda_forget(scree_device *device, scree_recording *recording);

    /// Scratch memory [bytes] that the sort of num_items takes.
    int64_t scree_cuda_sort_scratch(scree_device *device, int64_t num_items, bool has_values);
    /// scree_sort() on the device of the buffers.
    void scree_cuda_sort(scree_sort_buffers *buffers, int64_t num_items, int first_bit);

    /// Scratch memory [bytes] that the scan of num_values takes.
    int64_t scree_cuda_scan_scratch(scree_device *device, int64_t num_values);
    /// Exclusive sums of values (num_values) in place, with scratch memory of num_bytes.
    void scree_cuda_scan(scree_device *device, int32_t *values, int64_t num_values, void *scratch, int64_t num_bytes);

#ifdef __cplusplus
}
#endif
#endif
