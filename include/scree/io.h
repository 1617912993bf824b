/// \file io.h
/// The folder of a run: scene.yaml, series.csv, frames.vtkhdf, walls.vtkhdf, contacts.vtkhdf, fields.vtkhdf,
/// checkpoint.h5, summary.json. Formats: docs/format_hdf5.md.
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

    /// How a folder is opened.
    typedef struct scree_run_folder_def
    {
        const char *path;             ///< made if missing
        const scree_scene_file *file; ///< its text becomes scene.yaml
        bool replace;                 ///< default false: refused if the folder holds a run
        bool restart;                 ///< goes on with the run that the folder holds
    } scree_run_folder_def;

    /// Opens the folder for a new run and writes scene.yaml. With `restart` series and frames after the simulation's
    /// time are dropped; the simulation must have been loaded from the checkpoint before. The folder is locked against
    /// other runs until it is closed. SCREE_INVALID_INPUT, SCREE_OUT_OF_MEMORY, SCREE_WRITE_FAILED, SCREE_READ_FAILED.
    scree_status scree_run_folder_open(scree_run_folder **folder, const scree_run_folder_def *def,
                                       const scree_simulation *simulation, scree_report *report);
    /// One row of series.csv. SCREE_WRITE_FAILED.
    scree_status scree_run_folder_write_series(scree_run_folder *folder, const scree_simulation *simulation,
                                               scree_report *report);
    /// Largest energy [J] in motion, in springs or dissipated of all rows of series.csv, those before a restart too:
    /// what an error of the energy balance is compared with.
    double scree_run_folder_energy_turned_over(const scree_run_folder *folder);
    /// One time step of frames.vtkhdf (surfaces of the particles, connectivity written once), walls.vtkhdf and
    /// contacts.vtkhdf (contacts as lines). Nothing happens if there is a frame of this time. SCREE_WRITE_FAILED leaves
    /// the frames there were.
    scree_status scree_run_folder_write_frame(scree_run_folder *folder, const scree_simulation *simulation,
                                              scree_report *report);
    /// Everything the state is, to checkpoint.h5. SCREE_WRITE_FAILED leaves the checkpoint there was.
    scree_status scree_run_folder_write_checkpoint(scree_run_folder *folder, const scree_simulation *simulation,
                                                   scree_report *report);

    /// fields.vtkhdf, the averages of section "fields" of the scene. Nothing happens unless a period has been completed
    /// since it was last written. SCREE_WRITE_FAILED leaves the old file.
    scree_status scree_run_folder_write_fields(scree_run_folder *folder, const scree_simulation *simulation,
                                               scree_report *report);

    /// What summary.json tells beyond the state.
    typedef struct scree_run_result
    {
        const char *outcome; ///< "finished", "interrupted", "failed"; "failed" is not measured
        double wall_seconds;
        double processor_seconds; ///< of all threads
        double initial_energy;    ///< [J] balance at the start
        double energy_error;      ///< [1] change of the balance over the largest energy turned over
        int64_t steps_run;
        int threads;
    } scree_run_result;

    scree_status scree_run_folder_write_summary(scree_run_folder *folder, const scree_simulation *simulation,
                                                const scree_run_result *result, scree_report *report);
    /// Flushes and closes. Returns the first write error that was not reported before.
    scree_status scree_run_folder_close(scree_run_folder *folder, scree_report *report);

    /// Replaces the state of a fresh simulation of the same scene by that of a checkpoint. Everything is checked before
    /// anything is changed: sizes, scene, version, finite numbers. The scene may differ in what does not act on the
    /// particles: name, end, output, repose. SCREE_NOT_FOUND, SCREE_READ_FAILED, SCREE_INVALID_INPUT,
    /// SCREE_OUT_OF_MEMORY.
    scree_status scree_checkpoint_load(scree_simulation *simulation, const char *path, scree_report *report);

#ifdef __cplusplus
}
#endif
#endif
