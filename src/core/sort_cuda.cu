/// \file sort_cuda.cu
/// The stable radix sort of CUB (Merrill & Garland) on the buffers of sort.h.
#include <cub/device/device_radix_sort.cuh>

#include "core/device_cuda.cuh"
#include "core/device_cuda.h"

/// One call of CUB. Without scratch memory it asks how much is needed.
static cudaError_t sort(scree_sort_buffers *b, int64_t num_items, int first_bit, void *scratch, size_t *num_bytes)
{
    cub::DoubleBuffer<uint64_t> keys(b->keys, b->spare_keys);
    cub::DoubleBuffer<int32_t> values(b->values, b->spare_values);
    const cudaStream_t stream = b->device->stream;
    const cudaError_t error =
        b->has_values
            ? cub::DeviceRadixSort::SortPairs(scratch, *num_bytes, keys, values, num_items, first_bit, 64, stream)
            : cub::DeviceRadixSort::SortKeys(scratch, *num_bytes, keys, num_items, first_bit, 64, stream);
    b->keys = keys.Current();
    b->spare_keys = keys.Alternate();
    b->values = values.Current();
    b->spare_values = values.Alternate();
    return error;
}

int64_t scree_cuda_sort_scratch(scree_device *device, int64_t num_items, bool has_values)
{
    scree_sort_buffers buffers = {};
    buffers.device = device;
    buffers.has_values = has_values;
    size_t num_bytes = 0;
    scree_cuda_note(device, sort(&buffers, num_items, 0, NULL, &num_bytes));
    return (int64_t)num_bytes;
}

void scree_cuda_sort(scree_sort_buffers *buffers, int64_t num_items, int first_bit)
{
    scree_device *device = buffers->device;
    size_t num_bytes = (size_t)buffers->num_count_bytes;
    if (device->error == cudaSuccess)
        scree_cuda_note(device, sort(buffers, num_items, first_bit, buffers->counts, &num_bytes));
}
