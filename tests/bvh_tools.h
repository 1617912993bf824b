/// \file bvh_tools.h
/// Random boxes for the tests of trees and of the broad phase.
#ifndef SCREE_BVH_TOOLS_H
#define SCREE_BVH_TOOLS_H

#include <stdlib.h>

#include "core/vec.h"
#include "harness.h"

/// What random boxes look like.
typedef struct scree_test_boxes
{
    double extent;     ///< of the cube that holds the middles
    double smallest;   ///< half edge
    double largest;    ///< half edge; sizes are spread evenly over the logarithm
    double elongation; ///< longest over shortest edge, at most
    double grid;       ///< if > 0, all coordinates are multiples of it: many boxes touch or coincide
} scree_test_boxes;

/// Evenly over the logarithm, from a to b.
static inline double scree_test_size(uint64_t *state, double a, double b)
{
    return a * pow(b / a, scree_test_random(state));
}

static inline scree_box scree_test_box(const scree_test_boxes *kind, uint64_t *state)
{
    double lower[3], upper[3];
    const double size = scree_test_size(state, kind->smallest, kind->largest);
    for (int k = 0; k < 3; ++k)
    {
        const double middle = kind->extent * (scree_test_random(state) - 0.5);
        const double half = size * scree_test_size(state, 1 / kind->elongation, 1);
        lower[k] = middle - half;
        upper[k] = middle + half;
        if (kind->grid <= 0) continue;
        lower[k] = floor(lower[k] / kind->grid) * kind->grid;
        upper[k] = floor(upper[k] / kind->grid) * kind->grid;
    }
    scree_box box;
    box.lower = scree_vec3_make((scree_real)lower[0], (scree_real)lower[1], (scree_real)lower[2]);
    box.upper = scree_vec3_make((scree_real)upper[0], (scree_real)upper[1], (scree_real)upper[2]);
    return box;
}

/// Memory that a test cannot go on without.
static inline void *scree_test_alloc(int64_t num, size_t size)
{
    void *memory = calloc((size_t)num + 1, size);
    if (memory != NULL) return memory;
    printf("bvh_tools.h: there is not enough memory for %lld items\n", (long long)num);
    exit(EXIT_FAILURE);
}

/// (num) boxes; free() them.
static inline scree_box *scree_test_make_boxes(const scree_test_boxes *kind, int64_t num, uint64_t *state)
{
    scree_box *boxes = scree_test_alloc(num, sizeof *boxes);
    for (int64_t i = 0; i < num; ++i) boxes[i] = scree_test_box(kind, state);
    return boxes;
}

/// Number of messages of a report that contain `part`.
static inline int scree_test_num_messages(char **messages, int num, const char *part)
{
    int found = 0;
    for (int i = 0; i < num; ++i) found += strstr(messages[i], part) != NULL;
    return found;
}

#endif
