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

#endif
