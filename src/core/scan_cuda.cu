/// \file scan_cuda.cu
/// Exclusive sums of CUB (Merrill & Garland) for scan.h.
#include <cub/device/device_scan.cuh>

#include "core/device_cuda.cuh"
#include "core/device_cuda.h"

int64_t scree_cuda_scan_scratch(scree_device *device, int64_t num_values)
{
    size_t num_bytes = 0;
    int32_t *values = NULL;
    scree_cuda_note(device, cub::DeviceScan::ExclusiveSum(NULL, num_bytes, values, values, num_values, device->stream));
    return (int64_t)num_bytes;
}

void scree_cuda_scan(scree_device *device, int32_t *values, int64_t num_values, void *scratch, int64_t num_bytes)
{
    size_t num = (size_t)num_bytes;
    if (device->error == cudaSuccess)
        scree_cuda_note(device,
                        cub::DeviceScan::ExclusiveSum(scratch, num, values, values, num_values, device->stream));
}
