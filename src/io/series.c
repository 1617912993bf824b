/// \file series.c
/// series.csv: a header of names and units, one row per time. Each row is one write, so a killed run leaves whole lines
/// and at most one part of a line, which a restart drops.
#define _POSIX_C_SOURCE 200809L
#include "io/run_folder.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum
{
    MAX_FIELDS_LENGTH = 2048,     ///< of the columns that every series has
    MAX_WALL_COLUMNS_LENGTH = 640 ///< of the two columns of one moving wall
};

struct scree_series
{
    char *path;
    int file;
    int64_t size;      ///< bytes of whole lines
    int64_t last_step; ///< of the last row; -1 if there is none
    double turned_over;
    int num_columns;
    char *line; ///< (max_line) scratch
    size_t max_line;
};

static bool has_columns(const scree_wall_def *wall) { return wall->motion.kind != SCREE_MOTION_FIXED; }

/// Room for the longest line.
static scree_status reserve_line(scree_series *series, const scree_scene *scene)
{
    int num_fields;
    scree_series_fields(&num_fields);
    series->num_columns = num_fields;
    series->max_line = MAX_FIELDS_LENGTH;
    for (uint32_t w = 0; w < scene->num_walls; ++w)
    {
        if (!has_columns(scene->walls + w)) continue;
        series->num_columns += 2;
        series->max_line += MAX_WALL_COLUMNS_LENGTH;
    }
    series->line = malloc(series->max_line);
    return series->line != NULL ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

/// The header into `series->line`; returns its length.
static int format_header(scree_series *series, const scree_scene *scene)
{
    int num_fields;
    size_t length = 0;
    const scree_field *fields = scree_series_fields(&num_fields);
    for (int k = 0; k < num_fields; ++k)
        length += (size_t)snprintf(series->line + length, series->max_line - length, "%s%s [%s]", k > 0 ? "," : "",
                                   fields[k].name, fields[k].unit);
    for (uint32_t w = 0; w < scene->num_walls; ++w)
    {
        const scree_wall_def *wall = scene->walls + w;
        const bool is_rotating = wall->motion.kind == SCREE_MOTION_ROTATE;
        if (!has_columns(wall)) continue;
        length += (size_t)snprintf(series->line + length, series->max_line - length, ",%s_%.255s [%s],work_%.255s [J]",
                                   is_rotating ? "torque" : "force", wall->name, is_rotating ? "N m" : "N", wall->name);
    }
    return (int)length + snprintf(series->line + length, series->max_line - length, "\n");
}

/// Numbers with 17 digits: reading them back gives the same bits.
static int format_row(scree_series *series, const scree_series_row *row, const scree_simulation *simulation)
{
    int num_fields;
    size_t length = 0;
    const scree_field *fields = scree_series_fields(&num_fields);
    for (int k = 0; k < num_fields; ++k)
    {
        const double value = scree_field_value(fields + k, row);
        length += (size_t)snprintf(series->line + length, series->max_line - length,
                                   fields[k].type == SCREE_FIELD_INT64 ? "%s%.0f" : "%s%.17g", k > 0 ? "," : "", value);
    }
    for (int32_t w = 0; w < simulation->num_walls; ++w)
    {
        if (!has_columns(simulation->scene->walls + w)) continue;
        const scree_wall_load load = scree_simulation_wall_load(simulation, w);
        length +=
            (size_t)snprintf(series->line + length, series->max_line - length, ",%.17g,%.17g", load.load, load.work);
    }
    return (int)length + snprintf(series->line + length, series->max_line - length, "\n");
}

/// Energy that is in motion or in springs, or has been dissipated: what an error of the balance is compared with.
static double energy_turned_over(const scree_energies *e)
{
    return e->kinetic + e->rotational + e->elastic_normal + e->elastic_tangential + fabs(e->damping) +
           fabs(e->friction) + fabs(e->hysteresis);
}

static void note_row(scree_series *series, const scree_series_row *row)
{
    const double turned_over = energy_turned_over(&row->energies);
    if (turned_over > series->turned_over) series->turned_over = turned_over;
    series->last_step = row->step;
}

/// False if the line is not a row of num_columns numbers.
static bool parse_row(const char *line, int num_columns, scree_series_row *row)
{
    int num_fields;
    const scree_field *fields = scree_series_fields(&num_fields);
    for (int k = 0; k < num_columns; ++k)
    {
        char *end;
        const double value = strtod(line, &end);
        if (end == line || *end != (k + 1 < num_columns ? ',' : '\n')) return false;
        line = end + 1;
        if (k >= num_fields) continue;
        char *place = (char *)row + fields[k].offset;
        const int64_t whole = (int64_t)(fields[k].type == SCREE_FIELD_INT64 ? value : 0);
        if (fields[k].type == SCREE_FIELD_INT64) memcpy(place, &whole, sizeof whole);
        else memcpy(place, &value, sizeof value);
    }
    return true;
}

static scree_status fault(const scree_series *series, const char *verb, scree_report *report)
{
    scree_report_add(report, "%s could not be %s: %s", series->path, verb, strerror(errno));
    return strcmp(verb, "read") == 0 ? SCREE_READ_FAILED : SCREE_WRITE_FAILED;
}

/// Appends whole lines or nothing.
static scree_status append(scree_series *series, const char *line, int length, scree_report *report)
{
    for (int done = 0; done < length;)
    {
        const ssize_t num = write(series->file, line + done, (size_t)(length - done));
        if (num < 0 && errno == EINTR) continue;
        if (num < 0)
        {
            const scree_status status = fault(series, "written", report);
            if (ftruncate(series->file, series->size) != 0) return status;
            lseek(series->file, series->size, SEEK_SET);
            return status;
        }
        done += (int)num;
    }
    series->size += length;
    return SCREE_OK;
}

/// The file as text, with a final zero; NULL on failure.
static char *read_all(int file, int64_t size)
{
    char *text = malloc((size_t)size + 1);
    int64_t done = 0;
    while (text != NULL && done < size)
    {
        const ssize_t num = pread(file, text + done, (size_t)(size - done), done);
        if (num < 0 && errno == EINTR) continue;
        if (num <= 0) break;
        done += num;
    }
    if (text != NULL) text[done] = '\0';
    return text;
}

/// Keeps the header and the rows up to last_step, drops the rest.
static scree_status keep_rows(scree_series *series, const scree_scene *scene, int64_t last_step, scree_report *report)
{
    struct stat info;
    if (fstat(series->file, &info) != 0) return fault(series, "read", report);
    const int64_t size = (int64_t)info.st_size;
    const int header_length = format_header(series, scene);
    char *text = read_all(series->file, size);
    if (text == NULL) return SCREE_OUT_OF_MEMORY;
    if (strncmp(text, series->line, (size_t)header_length) != 0)
    {
        scree_report_add(
            report, "%s has other columns than this version writes for this scene; move it away to go on without it",
            series->path);
        free(text);
        return SCREE_READ_FAILED;
    }
    const char *line = text + header_length;
    for (const char *end; (end = strchr(line, '\n')) != NULL; line = end + 1)
    {
        scree_series_row row;
        if (!parse_row(line, series->num_columns, &row) || row.step > last_step) break;
        note_row(series, &row);
    }
    series->size = line - text;
    free(text);
    if (ftruncate(series->file, series->size) != 0) return fault(series, "shortened", report);
    lseek(series->file, series->size, SEEK_SET);
    return SCREE_OK;
}

/// Only one run may write to a folder; the lock goes with the process.
static scree_status lock(const scree_series *series, scree_report *report)
{
    struct flock lock;
    memset(&lock, 0, sizeof lock);
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    if (fcntl(series->file, F_SETLK, &lock) == 0 || (errno != EACCES && errno != EAGAIN)) return SCREE_OK;
    scree_report_add(report, "%s is being written by another run; wait for it or choose another folder", series->path);
    return SCREE_INVALID_INPUT;
}

static scree_status open_rows(scree_series *series, const scree_scene *scene, int64_t last_step, scree_report *report)
{
    struct stat info;
    series->file = open(series->path, O_RDWR | O_CREAT, 0666);
    if (series->file < 0 || fstat(series->file, &info) != 0) return fault(series, "opened", report);
    const scree_status status = lock(series, report);
    if (status != SCREE_OK) return status;
    if (last_step >= 0 && info.st_size > 0) return keep_rows(series, scene, last_step, report);
    const int length = format_header(series, scene);
    if (ftruncate(series->file, 0) != 0) return fault(series, "emptied", report);
    return append(series, series->line, length, report);
}

scree_status scree_series_open(scree_series **series, const char *path, const scree_scene *scene, int64_t last_step,
                               scree_report *report)
{
    *series = NULL;
    scree_series *s = calloc(1, sizeof *s);
    if (s == NULL) return SCREE_OUT_OF_MEMORY;
    s->file = -1;
    s->last_step = -1;
    s->path = scree_path_join(path, "");
    const scree_locale locale = scree_locale_begin();
    scree_status status = s->path == NULL ? SCREE_OUT_OF_MEMORY : reserve_line(s, scene);
    if (status == SCREE_OK) status = open_rows(s, scene, last_step, report);
    scree_locale_end(locale);
    if (status == SCREE_OK) *series = s;
    else scree_series_close(s, NULL);
    return status;
}

scree_status scree_series_write(scree_series *series, const scree_simulation *simulation, scree_report *report)
{
    const scree_series_row row = scree_series_row_of(simulation);
    if (row.step <= series->last_step) return SCREE_OK;
    const scree_locale locale = scree_locale_begin();
    const int length = format_row(series, &row, simulation);
    scree_locale_end(locale);
    const scree_status status = append(series, series->line, length, report);
    if (status == SCREE_OK) note_row(series, &row);
    return status;
}

double scree_series_energy_turned_over(const scree_series *series) { return series->turned_over; }

scree_status scree_series_close(scree_series *series, scree_report *report)
{
    if (series == NULL) return SCREE_OK;
    scree_status status = SCREE_OK;
    if (series->file >= 0 && close(series->file) != 0) status = fault(series, "closed", report);
    free(series->path);
    free(series->line);
    free(series);
    return status;
}
