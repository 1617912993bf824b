/// \file harness.h
/// A test is a program: functions called through SCREE_RUN(), checks inside them, SCREE_TEST_END() as the exit code.
/// A failed check prints place, text and values at 17 digits and lets the test go on.
#ifndef SCREE_HARNESS_H
#define SCREE_HARNESS_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static int scree_test_num_failed = 0;
static int scree_test_num_checks = 0;

#define SCREE_CHECK(condition)                                             \
    do {                                                                   \
        ++scree_test_num_checks;                                           \
        if (!(condition))                                                  \
        {                                                                  \
            ++scree_test_num_failed;                                       \
            printf("%s:%d: failed: %s\n", __FILE__, __LINE__, #condition); \
        }                                                                  \
    } while (0)

#define SCREE_CHECK_CLOSE(actual, expected, tolerance)                                                                 \
    do {                                                                                                               \
        const double scree_actual = (double)(actual), scree_expected = (double)(expected);                             \
        const double scree_tolerance = (double)(tolerance);                                                            \
        ++scree_test_num_checks;                                                                                       \
        if (!(fabs(scree_actual - scree_expected) <= scree_tolerance))                                                 \
        {                                                                                                              \
            ++scree_test_num_failed;                                                                                   \
            printf("%s:%d: failed: %s = %.17g, expected %.17g, difference %.3g > %.3g\n", __FILE__, __LINE__, #actual, \
                   scree_actual, scree_expected, fabs(scree_actual - scree_expected), scree_tolerance);                \
        }                                                                                                              \
    } while (0)

#define SCREE_CHECK_INT(actual, expected)                                                                  \
    do {                                                                                                   \
        const long long scree_actual = (long long)(actual), scree_expected = (long long)(expected);        \
        ++scree_test_num_checks;                                                                           \
        if (scree_actual != scree_expected)                                                                \
        {                                                                                                  \
            ++scree_test_num_failed;                                                                       \
            printf("%s:%d: failed: %s = %lld, expected %lld\n", __FILE__, __LINE__, #actual, scree_actual, \
                   scree_expected);                                                                        \
        }                                                                                                  \
    } while (0)

/// True if `text` contains `part`; prints the text otherwise.
#define SCREE_CHECK_CONTAINS(text, part)                                                                   \
    do {                                                                                                   \
        ++scree_test_num_checks;                                                                           \
        if (strstr((text), (part)) == NULL)                                                                \
        {                                                                                                  \
            ++scree_test_num_failed;                                                                       \
            printf("%s:%d: failed: \"%s\" does not contain \"%s\"\n", __FILE__, __LINE__, (text), (part)); \
        }                                                                                                  \
    } while (0)

#define SCREE_RUN(test)                                                                               \
    do {                                                                                              \
        const int scree_failed_before = scree_test_num_failed;                                        \
        test();                                                                                       \
        printf("%s %s\n", scree_test_num_failed == scree_failed_before ? "ok    " : "FAILED", #test); \
        fflush(stdout);                                                                               \
    } while (0)

#define SCREE_TEST_END()                                                             \
    (printf("%d checks, %d failed\n", scree_test_num_checks, scree_test_num_failed), \
     scree_test_num_checks == 0 || scree_test_num_failed != 0)

/// Random numbers for tests: splitmix64 (Steele, Lea & Flood 2014), the same everywhere.
static inline uint64_t scree_test_random_bits(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}
/// In [0, 1).
static inline double scree_test_random(uint64_t *state)
{
    return (double)(scree_test_random_bits(state) >> 11) * 0x1p-53;
}

#endif
