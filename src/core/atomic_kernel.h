/// \file atomic_kernel.h
/// Atomic counters of kernels, on integers only: arrival flags and the ends of appended lists. What a kernel makes of
/// them must not depend on the order of arrival.
#ifndef SCREE_ATOMIC_KERNEL_H
#define SCREE_ATOMIC_KERNEL_H

#include "core/vec.h"

/// Adds to a counter and returns its value before. Who comes later sees all that earlier ones wrote before they came.
SCREE_FN int32_t scree_atomic_add_int32(int32_t *counter, int32_t value)
{
#ifdef __CUDA_ARCH__
    __threadfence();
    const int32_t before = atomicAdd(counter, value);
    __threadfence();
    return before;
#else
    return __atomic_fetch_add(counter, value, __ATOMIC_ACQ_REL);
#endif
}

/// As scree_atomic_add_int32().
SCREE_FN int64_t scree_atomic_add_int64(int64_t *counter, int64_t value)
{
#ifdef __CUDA_ARCH__
    __threadfence();
    const int64_t before = (int64_t)atomicAdd((unsigned long long *)counter, (unsigned long long)value);
    __threadfence();
    return before;
#else
    return __atomic_fetch_add(counter, value, __ATOMIC_ACQ_REL);
#endif
}

#endif
