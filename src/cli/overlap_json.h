/// \file overlap_json.h
/// Overlap results as JSON, and a batch of cases, one a line.
#ifndef SCREE_OVERLAP_JSON_H
#define SCREE_OVERLAP_JSON_H

#include "cli/posed_overlap.h"

#include <jansson.h>

/// volume, centroid, area_vector, normal, indentation, residual, status; what is undefined is null. With patches also
/// their list, and the first level tells the sums. New reference, or NULL: out of memory.
json_t *scree_overlap_to_json(const scree_overlap_result *results, int32_t num_results, bool has_patches);

/// Reads cases from `input_path` ("-": standard input), writes results to `output_path` ("-": standard output), in the
/// order of the cases. A case that cannot be computed gives a line with status "error" and a message.
/// Returns the exit code.
int scree_overlap_batch(const char *input_path, const char *output_path, const scree_overlap_options *options);

#endif
