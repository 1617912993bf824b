/// \file launch_cuda.cuh
/// Turns a kernel body `name_at(args, i)` into `name_launch_cuda(args, num, stream)`: a grid of one thread per i.
#ifndef SCREE_LAUNCH_CUDA_CUH
#define SCREE_LAUNCH_CUDA_CUH

#include <cuda_runtime.h>
#include <stdint.h>

#define SCREE_CUDA_BLOCK 128

#define SCREE_DEFINE_LAUNCH(name)                                                                  \
    __global__ void __launch_bounds__(SCREE_CUDA_BLOCK) name##_grid(name##_args args, int64_t num) \
    {                                                                                              \
        const int64_t i = (int64_t)blockIdx.x * SCREE_CUDA_BLOCK + threadIdx.x;                    \
        if (i < num) name##_at(args, i);                                                           \
    }                                                                                              \
    extern "C" cudaError_t name##_launch_cuda(name##_args args, int64_t num, cudaStream_t stream)  \
    {                                                                                              \
        if (num <= 0) return cudaSuccess;                                                          \
        const unsigned num_blocks = (unsigned)((num + SCREE_CUDA_BLOCK - 1) / SCREE_CUDA_BLOCK);   \
        name##_grid<<<num_blocks, SCREE_CUDA_BLOCK, 0, stream>>>(args, num);                       \
        return cudaGetLastError();                                                                 \
    }

#endif
