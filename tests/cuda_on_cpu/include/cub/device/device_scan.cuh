/// \file device_scan.cuh
/// Stands in for CUB's header of this name: exclusive sums.
#ifndef CUDA_ON_CPU_CUB_DEVICE_SCAN_CUH
#define CUDA_ON_CPU_CUB_DEVICE_SCAN_CUH

#include "cub/device/scratch.cuh"

namespace cub
{

struct DeviceScan
{
    template <class T, class Count>
    static cudaError_t ExclusiveSum(void *scratch, size_t &num_bytes, const T *in, T *out, Count num_items,
                                    cudaStream_t stream = nullptr)
    {
        if (cuda_on_cpu::asks_for_scratch(scratch, &num_bytes, static_cast<size_t>(num_items), stream))
            return cudaSuccess;
        const int error = cuda_on_cpu::enqueue(
            cuda_on_cpu::node_kind::other,
            [=]
            {
                T sum = 0;
                for (Count i = 0; i < num_items; ++i)
                {
                    const T value = in[i];
                    out[i] = sum;
                    sum = static_cast<T>(sum + value);
                }
            },
            stream);
        return static_cast<cudaError_t>(error);
    }
};

} // namespace cub

#endif
