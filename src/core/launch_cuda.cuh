/// \file launch_cuda.cuh
/// Turns a kernel body `name_at(args, i)` into `name_launch_cuda(device, args, num)`: a grid of one thread per i.
#ifndef SCREE_LAUNCH_CUDA_CUH
#define SCREE_LAUNCH_CUDA_CUH

#include "core/device_cuda.cuh"

/// Threads of a block, at most.
#define SCREE_CUDA_BLOCK 128

#define SCREE_DECLARE_LAUNCH_CUDA(name) \
    extern "C" void name##_launch_cuda(scree_device *device, name##_args args, int64_t num);

#define SCREE_DEFINE_LAUNCH(name)                                                                         \
    static __global__ void __launch_bounds__(SCREE_CUDA_BLOCK) name##_grid(name##_args args, int64_t num) \
    {                                                                                                     \
        const int64_t i = (int64_t)blockIdx.x * blockDim.x + threadIdx.x;                                 \
        if (i < num) name##_at(args, i);                                                                  \
    }                                                                                                     \
    SCREE_DECLARE_LAUNCH_CUDA(name)                                                                       \
    void name##_launch_cuda(scree_device *device, name##_args args, int64_t num)                          \
    {                                                                                                     \
        if (num <= 0 || device->error != cudaSuccess) return;                                             \
        cudaLaunchConfig_t config = {};                                                                   \
        config.gridDim = dim3((unsigned)((num + device->block - 1) / device->block));                     \
        config.blockDim = dim3((unsigned)device->block);                                                  \
        config.stream = device->stream;                                                                   \
        scree_cuda_note(device, cudaLaunchKernelEx(&config, name##_grid, args, num));                     \
    }

#endif
