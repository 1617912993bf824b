/// \file io.h
/// The folder of a run: scene.yaml, series.csv, frames.vtkhdf, checkpoint.h5, summary.json.
/// Whole files are written to a temporary name and renamed; files that grow stay readable after a kill at any moment.
#ifndef SCREE_IO_H
#define SCREE_IO_H

#include "scree/scene.h"
#include "scree/simulation.h"

#ifdef __cplusplus
extern "C"
{
#endif

    typedef struct scree_run_folder scree_run_folder;

    /// Opens the folder for a new run (made if missing; refused if it holds a run and `replace` is false), writes
    /// scene.yaml. With `restart` an existing run is continued: series and frames after the checkpoint's time are
    /// dropped.
    scree_status scree_run_folder_open(scree_run_folder **folder, const char *path, const scree_scene_file *file,
                                       const scree_simulation *simulation, bool replace, bool restart,
                                       scree_report *report);
    /// One row of series.csv. SCREE_WRITE_FAILED.
    scree_status scree_run_folder_write_series(scree_run_folder *folder, const scree_simulation *simulation,
                                               scree_report *report);
    /// One time step of frames.vtkhdf: particles as PolyData with connectivity written once, contacts as lines.
    scree_status scree_run_folder_write_frame(scree_run_folder *folder, const scree_simulation *simulation,
                                              scree_report *report);
    /// Everything the state is, to checkpoint.h5.
    scree_status scree_run_folder_write_checkpoint(scree_run_folder *folder, const scree_simulation *simulation,
                                                   scree_report *report);

    /// What summary.json tells beyond the state.
    typedef struct scree_run_result
    {
        const char *outcome; ///< "finished", "interrupted", "failed"
        double wall_seconds;
        double initial_energy; ///< [J] balance at the start
        double energy_error;   ///< [1] change of the balance over the largest energy turned over
        int64_t steps_run;
        int threads;
    } scree_run_result;

    scree_status scree_run_folder_write_summary(scree_run_folder *folder, const scree_simulation *simulation,
                                                const scree_run_result *result, scree_report *report);
    /// Flushes and closes. Returns the first write error that was not reported before.
    scree_status scree_run_folder_close(scree_run_folder *folder, scree_report *report);

    /// Replaces the state of a fresh simulation of the same scene by that of a checkpoint. Everything is checked before
    /// anything is changed: sizes, scene, version, finite numbers.
    scree_status scree_checkpoint_load(scree_simulation *simulation, const char *path, scree_report *report);

#ifdef __cplusplus
}
#endif
#endif
