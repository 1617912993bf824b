/// \file bits.h
/// Words of bits.
#ifndef SCREE_BITS_H
#define SCREE_BITS_H

#include "core/vec.h"

/// Number of the lowest bit that is set; word is not 0.
SCREE_FN int32_t scree_lowest_bit(uint64_t word)
{
#ifdef __CUDA_ARCH__
    return __ffsll((long long)word) - 1;
#else
    return __builtin_ctzll(word);
#endif
}

/// Item k of two or three. On a GPU it is chosen among them: what is indexed would not be kept in registers.
#ifdef __CUDA_ARCH__
#define SCREE_PICK2(items, k) ((k) == 0 ? (items)[0] : (items)[1])
#define SCREE_PICK3(items, k) ((k) == 0 ? (items)[0] : (k) == 1 ? (items)[1] : (items)[2])
#else
#define SCREE_PICK2(items, k) ((items)[k])
#define SCREE_PICK3(items, k) ((items)[k])
#endif

/// The bits of a number.
SCREE_FN uint64_t scree_bits_of(double number)
{
#ifdef __CUDA_ARCH__
    return (uint64_t)__double_as_longlong(number);
#else
    uint64_t bits;
    __builtin_memcpy(&bits, &number, sizeof bits);
    return bits;
#endif
}

/// The number of these bits.
SCREE_FN double scree_number_of(uint64_t bits)
{
#ifdef __CUDA_ARCH__
    return __longlong_as_double((long long)bits);
#else
    double number;
    __builtin_memcpy(&number, &bits, sizeof number);
    return number;
#endif
}

#endif
