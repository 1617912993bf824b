/// \file scratch.cuh
/// The protocol of CUB's device-wide functions: a call without scratch memory asks how much is needed.
#ifndef CUDA_ON_CPU_CUB_SCRATCH_CUH
#define CUDA_ON_CPU_CUB_SCRATCH_CUH

#include "cuda_runtime.h"

namespace cuda_on_cpu
{

/// True if this call only asked. Otherwise spoils the scratch memory when its turn comes: nothing may be kept there.
inline bool asks_for_scratch(void *scratch, size_t *num_bytes, size_t num_items, cudaStream_t stream)
{
    const size_t needed = 256 + num_items;
    if (scratch == nullptr)
    {
        *num_bytes = needed;
        return true;
    }
    if (*num_bytes < needed) fail("CUB: scratch memory of %zu bytes, needed are %zu", *num_bytes, needed);
    enqueue(
        node_kind::other, [scratch, needed] { std::memset(scratch, 0xab, needed); }, stream);
    return false;
}

} // namespace cuda_on_cpu

#endif
