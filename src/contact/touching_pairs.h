/// \file touching_pairs.h
/// Candidate pairs that touch, picked from a block without a branch: which ones do cannot be foreseen, and a wrong
/// guess costs a processor more than all that is done for a pair that does not touch. For launches on the CPU.
#ifndef SCREE_TOUCHING_PAIRS_H
#define SCREE_TOUCHING_PAIRS_H

#include <stddef.h>
#include <stdint.h>

enum
{
    SCREE_BLOCK_PAIRS = 256
};

/// Of entries begin .. end - 1 of `batch`, or of the pairs themselves if it is NULL, those with contacts; returns how
/// many. `touching` has room for one more than there are entries.
static inline int32_t scree_pick_touching(const int32_t *first_of_pair, const int32_t *batch, int64_t begin,
                                          int64_t end, int32_t *touching)
{
    int32_t num = 0;
    for (int64_t b = begin; b < end; ++b)
    {
        const int32_t p = batch != NULL ? batch[b] : (int32_t)b;
        touching[num] = p;
        num += first_of_pair[p + 1] > first_of_pair[p];
    }
    return num;
}

#endif
