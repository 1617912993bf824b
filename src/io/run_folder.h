/// \file run_folder.h
/// The parts of a run folder, each in its own file. Internal to io.
#ifndef SCREE_RUN_FOLDER_H
#define SCREE_RUN_FOLDER_H

#include "io/fields.h"
#include "scree/io.h"

/// folder/name in fresh memory; NULL if there is none.
char *scree_path_join(const char *folder, const char *name);
/// Writes a whole file: temporary name, fsync, rename. SCREE_WRITE_FAILED leaves the old file.
scree_status scree_write_whole_file(const char *path, const char *text, size_t size, scree_report *report);
/// Makes a file that was written under `temporary` lasting and puts it in the place of `path`.
scree_status scree_put_in_place(const char *temporary, const char *path, scree_report *report);

/// Decimal points whatever the program's locale is: bracket what formats or parses numbers.
typedef struct scree_locale
{
    void *c_locale, *previous;
} scree_locale;
scree_locale scree_locale_begin(void);
void scree_locale_end(scree_locale locale);

typedef struct scree_series scree_series;

/// series.csv at `path`, locked against a second run. Moving walls of the scene bring columns of their own. With
/// `last_step` >= 0 the rows up to it are kept.
scree_status scree_series_open(scree_series **series, const char *path, const scree_scene *scene, int64_t last_step,
                               scree_report *report);
/// Nothing happens if there is a row of this or a later step. On SCREE_WRITE_FAILED the file ends with a whole line.
scree_status scree_series_write(scree_series *series, const scree_simulation *simulation, scree_report *report);
/// Largest energy in motion, in springs or dissipated that a row had [J].
double scree_series_energy_turned_over(const scree_series *series);
scree_status scree_series_close(scree_series *series, scree_report *report);

typedef struct scree_frames scree_frames;

/// frames.vtkhdf, walls.vtkhdf and contacts.vtkhdf in `folder`. With `is_restart` the frames up to the simulation's
/// time are kept. The simulation may change, but not its shapes and numbers of particles and walls.
scree_status scree_frames_open(scree_frames **frames, const char *folder, const scree_simulation *simulation,
                               bool is_restart, scree_report *report);
/// Nothing happens in a file that has a frame of this or a later time.
scree_status scree_frames_write(scree_frames *frames, const scree_simulation *simulation, scree_report *report);
scree_status scree_frames_close(scree_frames *frames, scree_report *report);

/// fields.vtkhdf at `path`; the simulation must have averaged over a period.
scree_status scree_fields_save(const scree_simulation *simulation, const char *path, scree_report *report);

/// checkpoint.h5 at `path`.
scree_status scree_checkpoint_save(const scree_simulation *simulation, const char *path, scree_report *report);

/// Text of summary.json in fresh memory; NULL if there is none.
char *scree_summary_text(const scree_simulation *simulation, const scree_run_result *result);

#endif
