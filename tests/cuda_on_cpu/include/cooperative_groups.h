/// \file cooperative_groups.h
/// Stands in for CUDA's header of this name: blocks, and tiles of 1 to 32 lanes.
#ifndef CUDA_ON_CPU_COOPERATIVE_GROUPS_H
#define CUDA_ON_CPU_COOPERATIVE_GROUPS_H

#include "cuda_runtime.h"

namespace cooperative_groups
{

struct thread_block
{
    void sync(CUDA_ON_CPU_PLACE) const { __syncthreads(CUDA_ON_CPU_SAME_PLACE); }
    unsigned thread_rank() const { return cuda_on_cpu::current->rank; }
    unsigned num_threads() const { return blockDim.x * blockDim.y * blockDim.z; }
};
inline thread_block this_thread_block() { return {}; }

template <unsigned Size> struct thread_block_tile
{
    static_assert(Size >= 1 && Size <= 32 && (Size & (Size - 1)) == 0, "a tile has 1, 2, 4, 8, 16 or 32 lanes");

    static constexpr unsigned num_threads() { return Size; }
    static constexpr unsigned size() { return Size; }
    unsigned thread_rank() const { return cuda_on_cpu::current->lane & (Size - 1); }
    unsigned meta_group_rank() const { return cuda_on_cpu::current->rank / Size; }
    void sync(CUDA_ON_CPU_PLACE) const { __syncwarp(mask(), CUDA_ON_CPU_SAME_PLACE); }
    unsigned ballot(int predicate, CUDA_ON_CPU_PLACE) const
    {
        return __ballot_sync(mask(), predicate, CUDA_ON_CPU_SAME_PLACE) >> first();
    }
    bool any(int predicate, CUDA_ON_CPU_PLACE) const
    {
        return __any_sync(mask(), predicate, CUDA_ON_CPU_SAME_PLACE) != 0;
    }
    bool all(int predicate, CUDA_ON_CPU_PLACE) const
    {
        return __all_sync(mask(), predicate, CUDA_ON_CPU_SAME_PLACE) != 0;
    }
    template <class T> T shfl(T value, int from, CUDA_ON_CPU_PLACE) const
    {
        return __shfl_sync(mask(), value, from, Size, CUDA_ON_CPU_SAME_PLACE);
    }
    template <class T> T shfl_up(T value, unsigned by, CUDA_ON_CPU_PLACE) const
    {
        return __shfl_up_sync(mask(), value, by, Size, CUDA_ON_CPU_SAME_PLACE);
    }
    template <class T> T shfl_down(T value, unsigned by, CUDA_ON_CPU_PLACE) const
    {
        return __shfl_down_sync(mask(), value, by, Size, CUDA_ON_CPU_SAME_PLACE);
    }
    template <class T> T shfl_xor(T value, int with, CUDA_ON_CPU_PLACE) const
    {
        return __shfl_xor_sync(mask(), value, with, Size, CUDA_ON_CPU_SAME_PLACE);
    }

  private:
    static unsigned first() { return cuda_on_cpu::current->lane & ~(Size - 1); }
    static unsigned mask() { return (Size == 32 ? 0xffffffffu : (1u << (Size & 31)) - 1) << first(); }
};

template <unsigned Size> thread_block_tile<Size> tiled_partition(const thread_block &) { return {}; }

} // namespace cooperative_groups

#endif
