/// \file scan.h
/// Parallel prefix sum of counts.
#ifndef SCREE_SCAN_H
#define SCREE_SCAN_H

#include <stdint.h>

/// Replaces values[i], i < num_values, by the sum of all before it, and writes the total to values[num_values] as
/// well as returning it. In place; no memory is allocated. Sums must fit an int64_t.
int64_t scree_scan_exclusive(int64_t *values, int64_t num_values);

#endif
