/// \file launch_any_order.h
/// Runs a kernel body `name_at(args, i)` over i = 0 .. num - 1 in a chosen order. What a kernel writes must not depend
/// on it: run on copies of the same input in every order and compare bit for bit.
#ifndef SCREE_LAUNCH_ANY_ORDER_H
#define SCREE_LAUNCH_ANY_ORDER_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "harness.h"

/// 0: ascending, 1: descending, larger ones: shuffled, each number another way.
#define SCREE_TEST_NUM_ORDERS 5

/// The indices 0 .. num - 1 in this order; free() them. A test cannot go on without: ends the program if memory is out.
static inline int64_t *scree_test_order(int order, int64_t num)
{
    int64_t *index = malloc((size_t)(num > 0 ? num : 1) * sizeof *index);
    if (index == NULL)
    {
        printf("launch_any_order.h: there is not enough memory for %lld indices\n", (long long)num);
        exit(EXIT_FAILURE);
    }
    for (int64_t i = 0; i < num; ++i) index[i] = order == 1 ? num - 1 - i : i;
    if (order < 2) return index;
    uint64_t state = (uint64_t)order;
    for (int64_t i = num - 1; i > 0; --i) // Fisher & Yates
    {
        const int64_t j = (int64_t)(scree_test_random_bits(&state) % (uint64_t)(i + 1));
        const int64_t kept = index[i];
        index[i] = index[j];
        index[j] = kept;
    }
    return index;
}

/// The loop of one kernel; `args` is evaluated once per index.
#define SCREE_LAUNCH_IN_ORDER(name, args, num, order)                                                      \
    do {                                                                                                   \
        const int64_t scree_num = (num);                                                                   \
        int64_t *scree_order = scree_test_order((order), scree_num);                                       \
        for (int64_t scree_k = 0; scree_k < scree_num; ++scree_k) name##_at((args), scree_order[scree_k]); \
        free(scree_order);                                                                                 \
    } while (0)

#endif
