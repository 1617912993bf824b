#define _POSIX_C_SOURCE 200809L
#include "dynamics/stage_clock.h"

#include "dynamics/state.h"

#include <time.h>

static const char *const stage_names[SCREE_NUM_STAGES] = {
#define SCREE_STAGE_NAME(name, text) text,
    SCREE_STAGE_LIST(SCREE_STAGE_NAME)
#undef SCREE_STAGE_NAME
};

const char *scree_stage_name(scree_stage stage) { return stage_names[stage]; }

static double read_clock(clockid_t id)
{
    struct timespec t;
    clock_gettime(id, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void scree_stage_clock_start(scree_stage_clock *clock)
{
    clock->wall = read_clock(CLOCK_MONOTONIC);
    clock->core = read_clock(CLOCK_PROCESS_CPUTIME_ID);
}

void scree_stage_clock_read(scree_stage_clock *clock, scree_stage stage)
{
    const double wall = clock->wall, core = clock->core;
    scree_device_status(clock->device, NULL);
    scree_stage_clock_start(clock);
    clock->times->wall[stage] += clock->wall - wall;
    clock->times->core[stage] += clock->core - core;
}

void scree_simulation_time_stages(scree_simulation *simulation, scree_stage_times *times)
{
    simulation->clock.times = times;
    if (simulation->there != NULL) simulation->there->clock.times = times;
}
