/// \file atomic_kernel.h
/// Atomic counters of kernels, on integers only: arrival flags, the ends of appended lists, maxima. What a kernel makes
/// of them must not depend on the order of arrival.
#ifndef SCREE_ATOMIC_KERNEL_H
#define SCREE_ATOMIC_KERNEL_H

#include "core/bits.h"

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

/// Counts on without ordering anything else: for what is read only after the kernel. Returns the value before.
SCREE_FN int64_t scree_atomic_count(int64_t *counter, int64_t value)
{
#ifdef __CUDA_ARCH__
    return (int64_t)atomicAdd((unsigned long long *)counter, (unsigned long long)value);
#else
    return __atomic_fetch_add(counter, value, __ATOMIC_RELAXED);
#endif
}

/// A maximum of numbers that are not negative: their bits, which are in the same order. Start from 0. Not a number is
/// above all numbers.
typedef struct scree_maximum
{
    uint64_t bits;
} scree_maximum;

/// Raises *most to `value` >= 0. Unordered, as above. Looks first: a maximum is seldom raised.
SCREE_FN void scree_atomic_max(scree_maximum *most, scree_real value)
{
    const uint64_t bits = scree_bits_of((double)value);
#ifdef __CUDA_ARCH__
    if ((uint64_t)__ldcg((const unsigned long long *)&most->bits) >= bits) return;
    atomicMax((unsigned long long *)&most->bits, (unsigned long long)bits);
#else
    uint64_t now = __atomic_load_n(&most->bits, __ATOMIC_RELAXED);
    while (bits > now &&
           !__atomic_compare_exchange_n(&most->bits, &now, bits, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED))
        continue;
#endif
}

SCREE_FN double scree_maximum_value(scree_maximum most) { return scree_number_of(most.bits); }

#endif
