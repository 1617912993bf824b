/// \file device_radix_sort.cuh
/// Stands in for CUB's header of this name: stable sorts of unsigned keys between two buffers.
#ifndef CUDA_ON_CPU_CUB_DEVICE_RADIX_SORT_CUH
#define CUDA_ON_CPU_CUB_DEVICE_RADIX_SORT_CUH

#include <algorithm>
#include <numeric>
#include <vector>

#include "cub/device/scratch.cuh"

namespace cub
{

template <class T> struct DoubleBuffer
{
    T *d_buffers[2];
    int selector = 0;
    DoubleBuffer() : d_buffers{nullptr, nullptr} {}
    DoubleBuffer(T *current, T *alternate) : d_buffers{current, alternate} {}
    T *Current() { return d_buffers[selector]; }
    T *Alternate() { return d_buffers[selector ^ 1]; }
};

struct DeviceRadixSort
{
    template <class Key, class Value, class Count>
    static cudaError_t SortPairs(void *scratch, size_t &num_bytes, DoubleBuffer<Key> &keys, DoubleBuffer<Value> &values,
                                 Count num_items, int begin_bit, int end_bit, cudaStream_t stream = nullptr)
    {
        if (cuda_on_cpu::asks_for_scratch(scratch, &num_bytes, static_cast<size_t>(num_items), stream))
            return cudaSuccess;
        const int flip = num_passes(begin_bit, end_bit) & 1;
        sort(keys, values.Current(), values.d_buffers[values.selector ^ flip], static_cast<size_t>(num_items),
             begin_bit, end_bit, flip, stream);
        values.selector ^= flip;
        return cudaSuccess;
    }
    template <class Key, class Count>
    static cudaError_t SortKeys(void *scratch, size_t &num_bytes, DoubleBuffer<Key> &keys, Count num_items,
                                int begin_bit, int end_bit, cudaStream_t stream = nullptr)
    {
        if (cuda_on_cpu::asks_for_scratch(scratch, &num_bytes, static_cast<size_t>(num_items), stream))
            return cudaSuccess;
        sort(keys, static_cast<const int *>(nullptr), static_cast<int *>(nullptr), static_cast<size_t>(num_items),
             begin_bit, end_bit, num_passes(begin_bit, end_bit) & 1, stream);
        return cudaSuccess;
    }

  private:
    /// In which buffer the answer stands depends on the number of passes, so callers must ask for Current().
    static int num_passes(int begin_bit, int end_bit) { return (end_bit - begin_bit + 7) / 8; }

    /// Sorted items to the buffers that are current after `flip`; the keys of the others are spoilt.
    template <class Key, class Value>
    static void sort(DoubleBuffer<Key> &keys, const Value *values, Value *sorted_values, size_t num, int begin_bit,
                     int end_bit, int flip, cudaStream_t stream)
    {
        static_assert(std::is_unsigned<Key>::value, "keys are unsigned");
        Key *from = keys.Current();
        keys.selector ^= flip;
        Key *to = keys.Current(), *spare = keys.Alternate();
        const Key mask = end_bit - begin_bit >= 64 ? ~Key(0) : ((Key(1) << (end_bit - begin_bit)) - 1);
        cuda_on_cpu::enqueue(
            cuda_on_cpu::node_kind::other,
            [=]
            {
                const std::vector<Key> old_keys(from, from + num);
                const std::vector<Value> old_values(values, values + (values ? num : 0));
                std::vector<size_t> order(num);
                std::iota(order.begin(), order.end(), size_t(0));
                const auto digits = [&](size_t i) { return old_keys[i] >> begin_bit & mask; };
                std::stable_sort(order.begin(), order.end(), [&](size_t i, size_t j) { return digits(i) < digits(j); });
                std::memset(static_cast<void *>(spare), 0xab, num * sizeof(Key));
                for (size_t i = 0; i < num; ++i) to[i] = old_keys[order[i]];
                for (size_t i = 0; values && i < num; ++i) sorted_values[i] = old_values[order[i]];
            },
            stream);
    }
};

} // namespace cub

#endif
