/// \file launch_cuda.cuh
/// Turns a kernel body `name_at(args, i)` into `name_launch_cuda(device, args, num)`: a grid of one thread per i.
#ifndef SCREE_LAUNCH_CUDA_CUH
#define SCREE_LAUNCH_CUDA_CUH

#include "core/device_cuda.cuh"
#include "core/team_sum.h"

/// Threads of a block, at most.
#define SCREE_CUDA_BLOCK 128

#define SCREE_DECLARE_LAUNCH_CUDA(name) \
    extern "C" void name##_launch_cuda(scree_device *device, name##_args args, int64_t num);

#define SCREE_DEFINE_LAUNCH_BOUNDED(name, ...)                                                       \
    static __global__ void __launch_bounds__(__VA_ARGS__) name##_grid(name##_args args, int64_t num) \
    {                                                                                                \
        const int64_t i = (int64_t)blockIdx.x * blockDim.x + threadIdx.x;                            \
        if (i < num) name##_at(args, i);                                                             \
    }                                                                                                \
    SCREE_DECLARE_LAUNCH_CUDA(name)                                                                  \
    void name##_launch_cuda(scree_device *device, name##_args args, int64_t num)                     \
    {                                                                                                \
        if (num <= 0 || device->error != cudaSuccess) return;                                        \
        cudaLaunchConfig_t config = {};                                                              \
        config.gridDim = dim3((unsigned)((num + device->block - 1) / device->block));                \
        config.blockDim = dim3((unsigned)device->block);                                             \
        config.stream = device->stream;                                                              \
        scree_cuda_note(device, cudaLaunchKernelEx(&config, name##_grid, args, num));                \
    }

#define SCREE_DEFINE_LAUNCH(name) SCREE_DEFINE_LAUNCH_BOUNDED(name, SCREE_CUDA_BLOCK)
/// For a body that needs all the registers there are: one block on a multiprocessor is enough.
#define SCREE_DEFINE_LAUNCH_WIDE(name) SCREE_DEFINE_LAUNCH_BOUNDED(name, SCREE_CUDA_BLOCK, 1)

/// The same for a body `name_team_at(args, team, i)` that a team of `lanes` threads works on, a power of two up to 32:
/// as many teams as fit side by side into a warp. Blocks are whole warps.
#define SCREE_DEFINE_LAUNCH_OF_TEAMS(name, lanes, ...)                                               \
    static __global__ void __launch_bounds__(__VA_ARGS__) name##_grid(name##_args args, int64_t num) \
    {                                                                                                \
        const scree_team team = scree_team_of_thread((int32_t)threadIdx.x, lanes);                   \
        const int64_t i = ((int64_t)blockIdx.x * blockDim.x + threadIdx.x) / (lanes);                \
        if (i < num) name##_team_at(args, &team, i);                                                 \
    }                                                                                                \
    SCREE_DECLARE_LAUNCH_CUDA(name)                                                                  \
    void name##_launch_cuda(scree_device *device, name##_args args, int64_t num)                     \
    {                                                                                                \
        if (num <= 0 || device->error != cudaSuccess) return;                                        \
        const int32_t block = (device->block + 31) / 32 * 32;                                        \
        cudaLaunchConfig_t config = {};                                                              \
        config.gridDim = dim3((unsigned)((num * (lanes) + block - 1) / block));                      \
        config.blockDim = dim3((unsigned)block);                                                     \
        config.stream = device->stream;                                                              \
        scree_cuda_note(device, cudaLaunchKernelEx(&config, name##_grid, args, num));                \
    }

/// Teams of args.num_lanes. One block on a multiprocessor is enough: a thread may have all the registers there are.
#define SCREE_DEFINE_TEAM_LAUNCH(name) SCREE_DEFINE_LAUNCH_OF_TEAMS(name, args.num_lanes, SCREE_CUDA_BLOCK, 1)
/// Warps that make sums (team_sum.h) or bounds, five blocks at a time on a multiprocessor.
#define SCREE_DEFINE_SUM_LAUNCH(name) SCREE_DEFINE_LAUNCH_OF_TEAMS(name, SCREE_SUM_LANES, SCREE_CUDA_BLOCK, 5)

#endif
