/// \file scene_run.h
/// Scenes written inside a test: from YAML text to a simulation at time 0, and steps until a time.
#ifndef SCREE_SCENE_RUN_H
#define SCREE_SCENE_RUN_H

#include "harness.h"

#include "dynamics/state.h"
#include "scree/scene.h"

typedef struct scene_run
{
    scree_scene_file file;
    scree_simulation *simulation; ///< NULL if the scene was refused
    scree_report report;
} scene_run;

/// With overrides "a.b=value". The messages are printed if the scene is refused.
static inline void scene_run_start_with(scene_run *run, const char *text, const char *const *overrides,
                                        int num_overrides)
{
    memset(run, 0, sizeof *run);
    scree_status status = scree_scene_parse(&run->file, text, "test.yaml", overrides, num_overrides, &run->report);
    if (status == SCREE_OK)
        status = scree_simulation_create(&run->simulation, &run->file.scene, run->file.folder, &run->report);
    if (status != SCREE_OK)
        for (int k = 0; k < run->report.num_messages; ++k) printf("%s\n", run->report.messages[k]);
    SCREE_CHECK_INT(status, SCREE_OK);
}

static inline void scene_run_start(scene_run *run, const char *text) { scene_run_start_with(run, text, NULL, 0); }

/// All messages of a scene in one text, which is overwritten by the next call.
static inline const char *scene_run_messages(const char *text)
{
    static char all[8192];
    scene_run run;
    memset(&run, 0, sizeof run);
    all[0] = '\0';
    scree_status status = scree_scene_parse(&run.file, text, "test.yaml", NULL, 0, &run.report);
    if (status == SCREE_OK)
        status = scree_simulation_create(&run.simulation, &run.file.scene, run.file.folder, &run.report);
    SCREE_CHECK((status == SCREE_OK) == (scree_report_num_faults(&run.report) == 0));
    for (int k = 0; k < run.report.num_messages; ++k)
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s\n", run.report.messages[k]);
    scree_simulation_destroy(run.simulation);
    scree_scene_close(&run.file);
    scree_report_clear(&run.report);
    return all;
}

/// Steps until `time` [s] is reached.
static inline void scene_run_until(scene_run *run, double time)
{
    if (run->simulation == NULL) return;
    const int64_t last = (int64_t)(time / scree_simulation_time_step(run->simulation) + 0.5);
    while (run->simulation->step < last)
    {
        const scree_status status = scree_simulation_step(run->simulation, &run->report);
        SCREE_CHECK_INT(status, SCREE_OK);
        if (status != SCREE_OK) return;
    }
}

static inline void scene_run_end(scene_run *run)
{
    scree_simulation_destroy(run->simulation);
    scree_scene_close(&run->file);
    scree_report_clear(&run->report);
}

#endif
