/// \file summary.c
/// summary.json: what came out, for people and scripts. A number that is none (not measured, out of range) is null.
#define _POSIX_C_SOURCE 200809L
#include "io/run_folder.h"

#include <hdf5.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- JSON

static void put_key(FILE *out, const char *key) { fprintf(out, "  \"%s\": ", key); }

static void put_value(FILE *out, double value)
{
    if (isfinite(value)) fprintf(out, "%.17g", value);
    else fputs("null", out);
}

static void put_number(FILE *out, const char *key, double value)
{
    put_key(out, key);
    put_value(out, value);
    fputs(",\n", out);
}

static void put_integer(FILE *out, const char *key, int64_t value)
{
    put_key(out, key);
    fprintf(out, "%" PRId64 ",\n", value);
}

/// A string: quotes, backslashes and control characters escaped, bytes that are not UTF-8 as question marks.
static void put_text(FILE *out, const char *key, const char *text)
{
    put_key(out, key);
    fputc('"', out);
    for (const unsigned char *c = (const unsigned char *)text; *c != '\0'; ++c)
    {
        int num_following = 0;
        if (*c >= 0xC2 && *c < 0xE0) num_following = 1;
        else if (*c >= 0xE0 && *c < 0xF0) num_following = 2;
        else if (*c >= 0xF0 && *c < 0xF5) num_following = 3;
        int num_found = 0;
        while (num_found < num_following && (c[num_found + 1] & 0xC0) == 0x80) ++num_found;
        if (*c == '"' || *c == '\\') fprintf(out, "\\%c", *c);
        else if (*c < 0x20 || *c == 0x7F) fprintf(out, "\\u%04x", *c);
        else if (*c < 0x80) fputc(*c, out);
        else if (num_following == 0 || num_found < num_following) fputc('?', out);
        else
        {
            fwrite(c, 1, (size_t)num_following + 1, out);
            c += num_following;
        }
    }
    fputs("\",\n", out);
}

/// Fields first .. last - 1 of a row as an object; all null without a row.
static void put_row_part(FILE *out, const char *key, const scree_series_row *row, int first, int last)
{
    int num_fields;
    const scree_field *fields = scree_series_fields(&num_fields);
    put_key(out, key);
    fputc('{', out);
    for (int k = first; k < last; ++k)
    {
        fprintf(out, "%s\n    \"%s\": ", k > first ? "," : "", fields[k].name);
        if (row == NULL) fputs("null", out);
        else if (fields[k].type == SCREE_FIELD_INT64) fprintf(out, "%.0f", scree_field_value(fields + k, row));
        else put_value(out, scree_field_value(fields + k, row));
    }
    fputs("\n  },\n", out);
}

static int field_index(const char *name)
{
    int num_fields;
    const scree_field *fields = scree_series_fields(&num_fields);
    int k = 0;
    while (k < num_fields && strcmp(fields[k].name, name) != 0) ++k;
    return k;
}

// ---- contents

static void put_list(FILE *out, const char *key, const double *values, int64_t num)
{
    put_key(out, key);
    fputc('[', out);
    for (int64_t k = 0; k < num; ++k)
    {
        if (k > 0) fputs(", ", out);
        put_value(out, values[k]);
    }
    fputs("],\n", out);
}

/// The angle and its fit; null where nothing was or could be measured.
static void put_repose(FILE *out, const scree_simulation *simulation, bool is_healthy)
{
    scree_repose repose;
    memset(&repose, 0, sizeof repose);
    const bool is_measured =
        simulation->scene->repose.measure && is_healthy && scree_simulation_repose(simulation, &repose) == SCREE_OK;
    put_number(out, "repose_angle_degrees", is_measured ? repose.angle_degrees : (double)NAN);
    put_number(out, "repose_fit_height", is_measured ? repose.height : (double)NAN);
    put_number(out, "repose_fit_steepness", is_measured ? repose.steepness : (double)NAN);
    put_number(out, "repose_fit_middle", is_measured ? repose.middle : (double)NAN);
    put_number(out, "repose_fit_residual", is_measured ? repose.residual : (double)NAN);
    put_list(out, "height_map_x", repose.bin_x, is_measured ? repose.num_bins : 0);
    put_list(out, "height_map_height", repose.bin_height, is_measured ? repose.num_bins : 0);
}

/// Of each moving wall, in a sound state, the work and, if it rotates, power and torque over its last whole revolution.
static void put_wall_loads(FILE *out, const scree_simulation *simulation, bool is_healthy)
{
    const scree_averages *averages = &simulation->averages;
    put_integer(out, "fields_periods", averages->num_periods);
    put_key(out, "wall_loads");
    fputc('{', out);
    bool is_first = true;
    for (int32_t w = 0; w < simulation->num_walls && is_healthy; ++w)
    {
        const scree_wall_def *wall = simulation->scene->walls + w;
        if (wall->motion.kind == SCREE_MOTION_FIXED) continue;
        const scree_wall_load load = scree_simulation_wall_load(simulation, w);
        const double power = load.num_revolutions > 0 ? load.revolution_power : (double)NAN;
        fprintf(out, "%s\n    \"%s\": {\"work\": ", is_first ? "" : ",", wall->name);
        put_value(out, load.work);
        fprintf(out, ", \"revolutions\": %" PRId64 ", \"power_of_last_revolution\": ", load.num_revolutions);
        put_value(out, power);
        fputs(", \"torque_of_last_revolution\": ", out);
        put_value(out, power / wall->motion.angular_velocity);
        fputs(", \"power_of_periods\": ", out);
        put_value(out, averages->is_on ? scree_mean_power(simulation, w) : (double)NAN);
        fputs(", \"torque_of_periods\": ", out);
        put_value(out, averages->is_on ? scree_mean_torque(simulation, w) : (double)NAN);
        fputc('}', out);
        is_first = false;
    }
    fputs(is_first ? "},\n" : "\n  },\n", out);
}

static double total_mass(const scree_particles *particles)
{
    double mass = 0;
    for (int64_t i = 0; i < particles->num_particles; ++i) mass += (double)particles->mass[i];
    return mass;
}

static void put_versions(FILE *out)
{
    put_text(out, "scree_version", SCREE_VERSION);
    char text[64];
    snprintf(text, sizeof text, "%d.%d.%d", H5_VERS_MAJOR, H5_VERS_MINOR, H5_VERS_RELEASE);
    put_text(out, "hdf5_version", text);
#ifdef __clang__
    put_text(out, "compiler", "clang " __clang_version__);
#else
    put_text(out, "compiler", "gcc " __VERSION__);
#endif
    put_text(out, "precision", sizeof(scree_real) == sizeof(double) ? "double" : "single");
}

/// Of a lost state, which is half of one step and half of another, nothing is told but how far it came.
static void put_state(FILE *out, const scree_simulation *simulation, const scree_run_result *result,
                      const scree_series_row *row)
{
    const bool is_healthy = strcmp(result->outcome, "failed") != 0;
    const int first_energy = field_index("kinetic"), balance = field_index("balance"), pairs = field_index("pairs");
    int num_fields;
    scree_series_fields(&num_fields);
    put_row_part(out, "energies", is_healthy ? row : NULL, first_energy, balance);
    put_number(out, "balance", is_healthy ? row->balance : (double)NAN);
    put_number(out, "initial_energy", result->initial_energy);
    put_number(out, "energy_error", is_healthy ? result->energy_error : (double)NAN);
    put_row_part(out, "counters", is_healthy ? row : NULL, pairs, num_fields);
    put_wall_loads(out, simulation, is_healthy);
    put_repose(out, simulation, is_healthy);
    char hash[17];
    snprintf(hash, sizeof hash, "%016" PRIx64, scree_simulation_hash(simulation));
    if (is_healthy) put_text(out, "state_hash", hash);
    else put_number(out, "state_hash", (double)NAN);
}

static void put_everything(FILE *out, const scree_simulation *simulation, const scree_run_result *result)
{
    const scree_series_row row = scree_series_row_of(simulation);
    const int64_t num_particles = simulation->particles.num_particles;
    fputs("{\n", out);
    put_text(out, "scene", simulation->scene->name != NULL ? simulation->scene->name : "");
    put_text(out, "outcome", result->outcome);
    put_number(out, "time", row.time);
    put_number(out, "end", simulation->scene->time.end);
    put_integer(out, "step", row.step);
    put_integer(out, "num_steps", scree_simulation_num_steps(simulation));
    put_number(out, "time_step", simulation->time_step);
    put_integer(out, "particles", num_particles);
    put_integer(out, "walls", simulation->num_walls);
    put_number(out, "mass", total_mass(&simulation->particles));
    put_state(out, simulation, result, &row);
    put_versions(out);
    put_integer(out, "threads", result->threads);
    put_integer(out, "steps_run", result->steps_run);
    const double work = (double)num_particles * (double)result->steps_run;
    put_number(out, "particle_steps_per_second", result->wall_seconds > 0 ? work / result->wall_seconds : (double)NAN);
    put_number(out, "processor_seconds", result->processor_seconds);
    put_key(out, "wall_seconds");
    put_value(out, result->wall_seconds);
    fputs("\n}\n", out);
}

char *scree_summary_text(const scree_simulation *simulation, const scree_run_result *result)
{
    char *text = NULL;
    size_t size = 0;
    const scree_locale locale = scree_locale_begin();
    FILE *out = open_memstream(&text, &size);
    if (out != NULL)
    {
        put_everything(out, simulation, result);
        const bool is_whole = !ferror(out);
        if (fclose(out) != 0 || !is_whole)
        {
            free(text);
            text = NULL;
        }
    }
    scree_locale_end(locale);
    return text;
}
