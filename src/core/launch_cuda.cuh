/// \file launch_cuda.cuh
/// Turns a kernel body `name_at(args, i)` into `name_launch_cuda(queue, args, num)`: a grid of one thread per i.
#ifndef SCREE_LAUNCH_CUDA_CUH
#define SCREE_LAUNCH_CUDA_CUH

#include <cuda_runtime.h>
#include <stdint.h>

/// Threads of a block, at most.
#define SCREE_CUDA_BLOCK 128

/// Where launches go, in the order of the calls.
typedef struct scree_cuda_queue
{
    cudaStream_t stream;
    int32_t block; ///< threads of a block, 1 .. SCREE_CUDA_BLOCK; no result depends on it
} scree_cuda_queue;

#define SCREE_DECLARE_LAUNCH_CUDA(name) \
    extern "C" cudaError_t name##_launch_cuda(scree_cuda_queue queue, name##_args args, int64_t num);

#define SCREE_DEFINE_LAUNCH(name)                                                                         \
    static __global__ void __launch_bounds__(SCREE_CUDA_BLOCK) name##_grid(name##_args args, int64_t num) \
    {                                                                                                     \
        const int64_t i = (int64_t)blockIdx.x * blockDim.x + threadIdx.x;                                 \
        if (i < num) name##_at(args, i);                                                                  \
    }                                                                                                     \
    SCREE_DECLARE_LAUNCH_CUDA(name)                                                                       \
    cudaError_t name##_launch_cuda(scree_cuda_queue queue, name##_args args, int64_t num)                 \
    {                                                                                                     \
        if (num <= 0) return cudaSuccess;                                                                 \
        cudaLaunchConfig_t config = {};                                                                   \
        config.gridDim = dim3((unsigned)((num + queue.block - 1) / queue.block));                         \
        config.blockDim = dim3((unsigned)queue.block);                                                    \
        config.stream = queue.stream;                                                                     \
        return cudaLaunchKernelEx(&config, name##_grid, args, num);                                       \
    }

#endif
