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

/// What a launch was recorded with still holds when it is played.
#define SCREE_AS_RECORDED(args, live, num) ((void)0)

/// A grid whose threads are shared out to indices i by `lanes` each, and its launch in blocks of `size` threads;
/// `body` is what a thread does. `look_up(args, live, num)` brings arguments and number of indices of a recorded launch
/// up to date.
#define SCREE_DEFINE_GRID(name, look_up, lanes, size, body, ...)                                    \
    static __global__ void __launch_bounds__(__VA_ARGS__)                                           \
        name##_grid(name##_args args, int64_t num, const scree_live *live)                          \
    {                                                                                               \
        if (live != NULL)                                                                           \
        {                                                                                           \
            if (live->halt != SCREE_HALT_NONE) return;                                              \
            look_up(&args, live, &num);                                                             \
        }                                                                                           \
        const int64_t i = ((int64_t)blockIdx.x * blockDim.x + threadIdx.x) / (lanes);               \
        body;                                                                                       \
    }                                                                                               \
    SCREE_DECLARE_LAUNCH_CUDA(name)                                                                 \
    void name##_launch_cuda(scree_device *device, name##_args args, int64_t num)                    \
    {                                                                                               \
        if (num <= 0 || device->error != cudaSuccess) return;                                       \
        const int32_t block = size;                                                                 \
        cudaLaunchConfig_t config = {};                                                             \
        config.gridDim = dim3((unsigned)((num * (lanes) + block - 1) / block));                     \
        config.blockDim = dim3((unsigned)block);                                                    \
        config.stream = device->stream;                                                             \
        scree_cuda_note(device, cudaLaunchKernelEx(&config, name##_grid, args, num, device->live)); \
    }

/// One thread for each index. A block is no larger than the launch, so that a single index can halt the others of its
/// recording.
#define SCREE_DEFINE_LAUNCH_AS(name, look_up, ...)                                          \
    SCREE_DEFINE_GRID(name, look_up, 1, num < device->block ? (int32_t)num : device->block, \
                      if (i < num) name##_at(args, i), __VA_ARGS__)

#define SCREE_DEFINE_LAUNCH(name) SCREE_DEFINE_LAUNCH_AS(name, SCREE_AS_RECORDED, SCREE_CUDA_BLOCK)
/// For a body that needs all the registers there are: one block on a multiprocessor is enough.
#define SCREE_DEFINE_LAUNCH_WIDE(name) SCREE_DEFINE_LAUNCH_AS(name, SCREE_AS_RECORDED, SCREE_CUDA_BLOCK, 1)
/// With a function `name_look_up(args, live, num)`.
#define SCREE_DEFINE_LAUNCH_LIVE(name) SCREE_DEFINE_LAUNCH_AS(name, name##_look_up, SCREE_CUDA_BLOCK)

/// The same for a body `name_team_at(args, team, i)` that a team of `lanes` threads works on, a power of two up to 32:
/// as many teams as fit side by side into a warp. Blocks are whole warps.
#define SCREE_DEFINE_LAUNCH_OF_TEAMS(name, look_up, lanes, ...) \
    SCREE_DEFINE_GRID(name, look_up, lanes, (device->block + 31) / 32 * 32, SCREE_TEAM_BODY(name, lanes), __VA_ARGS__)
#define SCREE_TEAM_BODY(name, lanes)                                           \
    const scree_team team = scree_team_of_thread((int32_t)threadIdx.x, lanes); \
    if (i < num) name##_team_at(args, &team, i)

/// Teams of args.num_lanes. One block on a multiprocessor is enough: a thread may have all the registers there are.
#define SCREE_DEFINE_TEAM_LAUNCH(name) \
    SCREE_DEFINE_LAUNCH_OF_TEAMS(name, SCREE_AS_RECORDED, args.num_lanes, SCREE_CUDA_BLOCK, 1)
/// Warps that make sums (team_sum.h) or bounds, five blocks at a time on a multiprocessor.
#define SCREE_DEFINE_SUM_LAUNCH(name) \
    SCREE_DEFINE_LAUNCH_OF_TEAMS(name, SCREE_AS_RECORDED, SCREE_SUM_LANES, SCREE_CUDA_BLOCK, 5)
/// With a function `name_look_up(args, live, num)`.
#define SCREE_DEFINE_SUM_LAUNCH_LIVE(name) \
    SCREE_DEFINE_LAUNCH_OF_TEAMS(name, name##_look_up, SCREE_SUM_LANES, SCREE_CUDA_BLOCK, 5)

#endif
