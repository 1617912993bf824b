/// \file run_folder.c
/// The folder of a run: makes it, guards an old run in it, hands out to its files. The format is docs/format_hdf5.md.
#define _POSIX_C_SOURCE 200809L
#include "io/run_folder.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct scree_run_folder
{
    char *path;
    scree_series *series;
    scree_frames *frames; ///< NULL until the first frame
    int64_t num_periods;  ///< in fields.vtkhdf; 0: there is none
    bool is_restart;
};

/// Everything a run writes; with --replace these and nothing else are removed.
static const char *const file_names[] = {
    "scene.yaml",        "series.csv",          "frames.vtkhdf",      "walls.vtkhdf",      "contacts.vtkhdf",
    "checkpoint.h5",     "summary.json",        "fields.vtkhdf",      "frames.vtkhdf.tmp", "fields.vtkhdf.tmp",
    "walls.vtkhdf.tmp",  "contacts.vtkhdf.tmp", "frames.vtkhdf.grow", "walls.vtkhdf.grow", "contacts.vtkhdf.grow",
    "checkpoint.h5.tmp", "summary.json.tmp",    "scene.yaml.tmp"};
enum
{
    NUM_FILES = sizeof file_names / sizeof file_names[0],
    NUM_LASTING_FILES = 8
};

// ---- files

char *scree_path_join(const char *folder, const char *name)
{
    const size_t size = strlen(folder) + strlen(name) + 2;
    char *path = malloc(size);
    if (path != NULL) snprintf(path, size, "%s%s%s", folder, name[0] != '\0' ? "/" : "", name);
    return path;
}

scree_locale scree_locale_begin(void)
{
    scree_locale locale;
    locale.c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    locale.previous = locale.c_locale != NULL ? uselocale((locale_t)locale.c_locale) : NULL;
    return locale;
}

void scree_locale_end(scree_locale locale)
{
    if (locale.c_locale == NULL) return;
    uselocale((locale_t)locale.previous);
    freelocale((locale_t)locale.c_locale);
}

static scree_status system_fault(const char *path, const char *verb, scree_report *report)
{
    scree_report_add(report, "%s could not be %s: %s", path, verb, strerror(errno));
    return SCREE_WRITE_FAILED;
}

/// fsync of a file or folder by its path.
static bool sync_path(const char *path)
{
    const int file = open(path, O_RDONLY);
    if (file < 0) return false;
    const bool is_done = fsync(file) == 0;
    const int error = errno;
    close(file);
    errno = error;
    return is_done;
}

scree_status scree_put_in_place(const char *temporary, const char *path, scree_report *report)
{
    if (!sync_path(temporary)) return system_fault(temporary, "written", report);
    if (rename(temporary, path) != 0) return system_fault(path, "replaced", report);
    // the new name itself; some file systems cannot, which costs nothing but this promise
    char *copy = scree_path_join(path, "");
    if (copy != NULL) sync_path(dirname(copy));
    free(copy);
    return SCREE_OK;
}

scree_status scree_write_whole_file(const char *path, const char *text, size_t size, scree_report *report)
{
    const size_t length = strlen(path) + 5;
    char *temporary = malloc(length);
    if (temporary == NULL) return SCREE_OUT_OF_MEMORY;
    snprintf(temporary, length, "%s.tmp", path);
    FILE *stream = fopen(temporary, "w");
    bool is_written = stream != NULL && fwrite(text, 1, size, stream) == size;
    if (stream != NULL) is_written = fclose(stream) == 0 && is_written;
    scree_status status = is_written ? SCREE_OK : system_fault(path, "written", report);
    if (status == SCREE_OK) status = scree_put_in_place(temporary, path, report);
    if (status != SCREE_OK) unlink(temporary);
    free(temporary);
    return status;
}

/// The folder and those above it.
static scree_status make_folders(const char *path, scree_report *report)
{
    char *partial = scree_path_join(path, "");
    if (partial == NULL) return SCREE_OUT_OF_MEMORY;
    scree_status status = SCREE_OK;
    for (char *place = partial + 1; status == SCREE_OK; ++place)
    {
        const char mark = *place;
        if (mark != '/' && mark != '\0') continue;
        *place = '\0';
        if (mkdir(partial, 0777) != 0 && errno != EEXIST) status = system_fault(partial, "made", report);
        *place = mark;
        if (mark == '\0') break;
    }
    free(partial);
    struct stat info;
    if (status != SCREE_OK || (stat(path, &info) == 0 && S_ISDIR(info.st_mode))) return status;
    scree_report_add(report, "%s is not a folder; choose another one with -o", path);
    return SCREE_WRITE_FAILED;
}

// ---- opening

static bool holds_file(const char *folder, const char *name)
{
    char *path = scree_path_join(folder, name);
    const bool is_there = path != NULL && access(path, F_OK) == 0;
    free(path);
    return is_there;
}

/// A file that is not there counts as removed.
static scree_status remove_file(const char *folder, const char *name, scree_report *report)
{
    char *path = scree_path_join(folder, name);
    if (path == NULL) return SCREE_OUT_OF_MEMORY;
    const bool is_gone = unlink(path) == 0 || errno == ENOENT;
    const scree_status status = is_gone ? SCREE_OK : system_fault(path, "removed", report);
    free(path);
    return status;
}

static scree_status remove_files(const char *folder, scree_report *report)
{
    scree_status status = SCREE_OK;
    for (int k = 0; k < NUM_FILES && status == SCREE_OK; ++k)
    {
        // series.csv is locked by a run that is going on; it is emptied when it is opened
        if (strcmp(file_names[k], "series.csv") == 0) continue;
        status = remove_file(folder, file_names[k], report);
    }
    return status;
}

static scree_status refuse_old_run(const char *path, scree_report *report)
{
    for (int k = 0; k < NUM_LASTING_FILES; ++k)
    {
        if (!holds_file(path, file_names[k])) continue;
        scree_report_add(report,
                         "%s holds a run already (%s); go on with it (--restart), write over it (--replace) or choose "
                         "another folder (-o)",
                         path, file_names[k]);
        return SCREE_INVALID_INPUT;
    }
    return SCREE_OK;
}

/// scene.yaml as used, with the version that used it.
static scree_status write_scene(const scree_run_folder *folder, const scree_scene_file *file, scree_report *report)
{
    static const char format[] = "# as used by scree %s: every default filled in\n%s";
    const char *text = file->text != NULL ? file->text : "";
    const size_t size = sizeof format + sizeof SCREE_VERSION + strlen(text);
    char *buffer = malloc(size);
    char *path = scree_path_join(folder->path, "scene.yaml");
    scree_status status = SCREE_OUT_OF_MEMORY;
    if (buffer != NULL && path != NULL)
    {
        const int length = snprintf(buffer, size, format, SCREE_VERSION, text);
        status = scree_write_whole_file(path, buffer, (size_t)length, report);
    }
    free(path);
    free(buffer);
    return status;
}

static scree_status open_files(scree_run_folder *folder, const scree_run_folder_def *def,
                               const scree_simulation *simulation, scree_report *report)
{
    char *series_path = scree_path_join(folder->path, "series.csv");
    if (series_path == NULL) return SCREE_OUT_OF_MEMORY;
    scree_status status = scree_series_open(&folder->series, series_path, simulation->scene,
                                            folder->is_restart ? simulation->step : -1, report);
    free(series_path);
    // the series is locked now, so nobody else writes what is removed here
    if (status == SCREE_OK && !folder->is_restart) status = remove_files(folder->path, report);
    if (status == SCREE_OK) status = write_scene(folder, def->file, report);
    return status;
}

scree_status scree_run_folder_open(scree_run_folder **folder, const scree_run_folder_def *def,
                                   const scree_simulation *simulation, scree_report *report)
{
    *folder = NULL;
    const char *path = def->path;
    scree_status status = make_folders(path, report);
    if (status == SCREE_OK && !def->replace && !def->restart) status = refuse_old_run(path, report);
    if (status != SCREE_OK) return status;
    scree_run_folder *f = calloc(1, sizeof *f);
    if (f == NULL) return SCREE_OUT_OF_MEMORY;
    f->is_restart = def->restart;
    f->path = scree_path_join(path, "");
    status = f->path == NULL ? SCREE_OUT_OF_MEMORY : open_files(f, def, simulation, report);
    // averages of a time that the checkpoint has not reached are no longer so
    if (status == SCREE_OK && f->is_restart && simulation->averages.num_periods == 0)
        status = remove_file(path, "fields.vtkhdf", report);
    // on a restart old frames are shortened now, not when the first new one is due
    const bool has_frames =
        holds_file(path, "frames.vtkhdf") || holds_file(path, "walls.vtkhdf") || holds_file(path, "contacts.vtkhdf");
    if (status == SCREE_OK && f->is_restart && has_frames)
        status = scree_frames_open(&f->frames, path, simulation, true, report);
    if (status == SCREE_OK) *folder = f;
    else scree_run_folder_close(f, NULL);
    return status;
}

// ---- writing

scree_status scree_run_folder_write_series(scree_run_folder *folder, const scree_simulation *simulation,
                                           scree_report *report)
{
    return scree_series_write(folder->series, simulation, report);
}

double scree_run_folder_energy_turned_over(const scree_run_folder *folder)
{
    return scree_series_energy_turned_over(folder->series);
}

scree_status scree_run_folder_write_frame(scree_run_folder *folder, const scree_simulation *simulation,
                                          scree_report *report)
{
    scree_status status = SCREE_OK;
    if (folder->frames == NULL)
        status = scree_frames_open(&folder->frames, folder->path, simulation, folder->is_restart, report);
    return status == SCREE_OK ? scree_frames_write(folder->frames, simulation, report) : status;
}

scree_status scree_run_folder_write_fields(scree_run_folder *folder, const scree_simulation *simulation,
                                           scree_report *report)
{
    if (simulation->averages.num_periods == folder->num_periods) return SCREE_OK;
    char *path = scree_path_join(folder->path, "fields.vtkhdf");
    if (path == NULL) return SCREE_OUT_OF_MEMORY;
    const scree_status status = scree_fields_save(simulation, path, report);
    if (status == SCREE_OK) folder->num_periods = simulation->averages.num_periods;
    free(path);
    return status;
}

scree_status scree_run_folder_write_checkpoint(scree_run_folder *folder, const scree_simulation *simulation,
                                               scree_report *report)
{
    char *path = scree_path_join(folder->path, "checkpoint.h5");
    if (path == NULL) return SCREE_OUT_OF_MEMORY;
    const scree_status status = scree_checkpoint_save(simulation, path, report);
    free(path);
    return status;
}

scree_status scree_run_folder_write_summary(scree_run_folder *folder, const scree_simulation *simulation,
                                            const scree_run_result *result, scree_report *report)
{
    char *path = scree_path_join(folder->path, "summary.json"), *text = scree_summary_text(simulation, result);
    scree_status status = SCREE_OUT_OF_MEMORY;
    if (path != NULL && text != NULL) status = scree_write_whole_file(path, text, strlen(text), report);
    free(text);
    free(path);
    return status;
}

scree_status scree_run_folder_close(scree_run_folder *folder, scree_report *report)
{
    if (folder == NULL) return SCREE_OK;
    const scree_status frames = scree_frames_close(folder->frames, report);
    const scree_status series = scree_series_close(folder->series, report);
    free(folder->path);
    free(folder);
    return frames != SCREE_OK ? frames : series;
}
