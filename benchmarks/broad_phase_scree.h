/// \file broad_phase_scree.h
/// scree's side of the comparison of broad phases, for programs in C++.
#ifndef SCREE_BROAD_PHASE_SCREE_H
#define SCREE_BROAD_PHASE_SCREE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C"
{
#endif

    /// Tree and unsorted pairs of (num) boxes, (x, y, z) of their lower and upper corners each. Returns the number of
    /// pairs, or -1 if memory is out.
    int64_t scree_bench_search_unsorted(const double (*boxes)[6], int64_t num);
    /// The whole search as a step needs it: sorted pairs and a row of pairs for each box.
    int64_t scree_bench_search_sorted(const double (*boxes)[6], int64_t num);

#ifdef __cplusplus
}
#endif
#endif
