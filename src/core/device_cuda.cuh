/// \file device_cuda.cuh
/// An opened GPU, as the .cu files see it.
#ifndef SCREE_DEVICE_CUDA_CUH
#define SCREE_DEVICE_CUDA_CUH

#include <cuda_runtime.h>

#include "core/arena.h"
#include "core/device.h"

struct scree_device
{
    cudaStream_t stream; ///< that calls go to now
    int32_t block;
    cudaStream_t streams[SCREE_NUM_BRANCHES + 1]; ///< the first one outside of branches
    cudaEvent_t events[SCREE_NUM_BRANCHES + 1];   ///< for those who wait for these streams
    bool is_open[SCREE_NUM_BRANCHES + 1];         ///< branches that nobody has waited for
    cudaError_t error;                            ///< the first one; nothing is done after it
    bool records;                                 ///< and has not failed to
    const scree_live *live;                       ///< of the recording under way; NULL: calls are done
    int64_t arena_bytes;
    int64_t concurrency; ///< threads that its multiprocessors hold, as far as registers of large kernels allow
    scree_arena arena;
    char name[256];
};

/// Keeps the first error. True if all is well.
static inline bool scree_cuda_note(scree_device *device, cudaError_t error)
{
    if (device->error == cudaSuccess) device->error = error;
    return device->error == cudaSuccess;
}

#endif
