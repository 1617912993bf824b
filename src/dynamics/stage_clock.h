/// \file stage_clock.h
/// Where the time of a step goes. Off, it costs a comparison per stage.
#ifndef SCREE_STAGE_CLOCK_H
#define SCREE_STAGE_CLOCK_H

#include "core/device.h"
#include "scree/simulation.h"

/// Start from {0}, which is off.
typedef struct scree_stage_clock
{
    scree_stage_times *times; ///< borrowed; NULL: off
    scree_device *device;     ///< that is waited for at the end of each stage; NULL: the CPU
    double wall, core;        ///< [s] at the end of the last stage
} scree_stage_clock;

/// The next stage begins now.
void scree_stage_clock_start(scree_stage_clock *clock);
/// The time since the last stage goes to this one.
void scree_stage_clock_read(scree_stage_clock *clock, scree_stage stage);

static inline void scree_stage_begin(scree_stage_clock *clock)
{
    if (clock->times != NULL) scree_stage_clock_start(clock);
}

static inline void scree_stage_end(scree_stage_clock *clock, scree_stage stage)
{
    if (clock->times != NULL) scree_stage_clock_read(clock, stage);
}

#endif
