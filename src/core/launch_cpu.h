/// \file launch_cpu.h
/// Turns a kernel body `name_at(args, i)` into `name_launch(args, num)`: an OpenMP loop over i = 0 .. num - 1.
/// The bodies write only what belongs to i, so the result does not depend on the number of threads or the schedule.
#ifndef SCREE_LAUNCH_CPU_H
#define SCREE_LAUNCH_CPU_H

#include <stdint.h>

#define SCREE_PRAGMA(text) _Pragma(#text)

/// Loops shorter than this are not worth waking threads for.
#define SCREE_LAUNCH_MIN 256

#define SCREE_DECLARE_LAUNCH(name) void name##_launch(name##_args args, int64_t num);

/// Equal shares: for bodies of equal cost.
#define SCREE_DEFINE_LAUNCH(name)                                                    \
    void name##_launch(name##_args args, int64_t num)                                \
    {                                                                                \
        SCREE_PRAGMA(omp parallel for schedule(static) if (num >= SCREE_LAUNCH_MIN)) \
        for (int64_t i = 0; i < num; ++i) name##_at(args, i);                        \
    }

/// Shares handed out while the loop runs: for bodies of very different cost.
#define SCREE_DEFINE_LAUNCH_DYNAMIC(name)                                                 \
    void name##_launch(name##_args args, int64_t num)                                     \
    {                                                                                     \
        SCREE_PRAGMA(omp parallel for schedule(dynamic, 64) if (num >= SCREE_LAUNCH_MIN)) \
        for (int64_t i = 0; i < num; ++i) name##_at(args, i);                             \
    }

#endif
