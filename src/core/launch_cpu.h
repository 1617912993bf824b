/// \file launch_cpu.h
/// Turns a kernel body `name_at(args, i)` into `name_launch(args, num)`: an OpenMP loop over i = 0 .. num - 1.
/// The bodies write only what belongs to i, so the result does not depend on the number of threads or the schedule.
/// `name_launch_on(device, args, num)` does the same where the arrays are; in builds with CUDA, launch_cuda.cuh makes
/// the other half of it.
#ifndef SCREE_LAUNCH_CPU_H
#define SCREE_LAUNCH_CPU_H

#include "core/device.h"

#define SCREE_PRAGMA(text) _Pragma(#text)

/// Loops shorter than this are not worth waking threads for.
#define SCREE_LAUNCH_MIN 256

#define SCREE_DECLARE_LAUNCH(name)                     \
    void name##_launch(name##_args args, int64_t num); \
    void name##_launch_on(scree_device *device, name##_args args, int64_t num);

#ifdef SCREE_CUDA
#define SCREE_DEFINE_LAUNCH_ON(name)                                              \
    void name##_launch_cuda(scree_device *device, name##_args args, int64_t num); \
    void name##_launch_on(scree_device *device, name##_args args, int64_t num)    \
    {                                                                             \
        if (device != NULL) name##_launch_cuda(device, args, num);                \
        else name##_launch(args, num);                                            \
    }
#else
#define SCREE_DEFINE_LAUNCH_ON(name)                                           \
    void name##_launch_on(scree_device *device, name##_args args, int64_t num) \
    {                                                                          \
        (void)device;                                                          \
        name##_launch(args, num);                                              \
    }
#endif

/// Equal shares: for bodies of equal cost.
#define SCREE_DEFINE_LAUNCH(name)                                                    \
    void name##_launch(name##_args args, int64_t num)                                \
    {                                                                                \
        SCREE_PRAGMA(omp parallel for schedule(static) if (num >= SCREE_LAUNCH_MIN)) \
        for (int64_t i = 0; i < num; ++i) name##_at(args, i);                        \
    }                                                                                \
    SCREE_DEFINE_LAUNCH_ON(name)

/// Shares handed out while the loop runs: for bodies of very different cost.
#define SCREE_DEFINE_LAUNCH_DYNAMIC(name)                                                 \
    void name##_launch(name##_args args, int64_t num)                                     \
    {                                                                                     \
        SCREE_PRAGMA(omp parallel for schedule(dynamic, 64) if (num >= SCREE_LAUNCH_MIN)) \
        for (int64_t i = 0; i < num; ++i) name##_at(args, i);                             \
    }                                                                                     \
    SCREE_DEFINE_LAUNCH_ON(name)

#endif
