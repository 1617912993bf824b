/// \file scan.h
/// Parallel prefix sum of counts.
#ifndef SCREE_SCAN_H
#define SCREE_SCAN_H

#include "core/device.h"

#ifdef __cplusplus
extern "C"
{
#endif

    /// Replaces values[i] >= 0, i < num_values, by the sum of all before it, and writes the total to values[num_values]
    /// as well as returning it. In place; no memory is allocated. Of a total above INT32_MAX a negative number is
    /// written, and the other sums are of no use.
    int64_t scree_scan_exclusive(int32_t *values, int64_t num_values);

    /// Scratch memory of scans. Owns it. Start from {0}, or from {.device = ...} for values on a GPU.
    typedef struct scree_scan_scratch
    {
        scree_device *device; ///< where the values lie, NULL: the CPU, which needs no memory
        void *memory;         ///< (num_bytes)
        int64_t num_bytes;
        int64_t max_values;
    } scree_scan_scratch;

    /// Room for scans of up to num_values. SCREE_OUT_OF_MEMORY.
    scree_status scree_scan_reserve(scree_scan_scratch *scratch, int64_t num_values);
    /// scree_scan_exclusive() where the values lie, without waiting: the total is at values[num_values] afterwards, on
    /// a GPU modulo 2^32.
    void scree_scan_on(scree_scan_scratch *scratch, int32_t *values, int64_t num_values);
    void scree_scan_destroy(scree_scan_scratch *scratch);

#ifdef __cplusplus
}
#endif
#endif
