/// \file bench_scene.c
/// Scenes run with the clock on: scree bench scene, part by part of a run, and scree bench rig, the beginning of a
/// calibration rig with rocks of more and more triangles.
#include "cli/bench.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>

static const scree_bench_column columns[] = {
    {"name", "part            ", 0, 0},
    {"threads", "thr", 1, 0},
    {"particles", "particles", 1, 0},
    {"steps", "  steps", 1, 0},
    {"pairs", "candidates", 1, 0},
    {"contacts", "touching at the end", 1, 0},
    {"searches", "searches", 1, 0},
    {"core_seconds", "core seconds", 1, 2},
    {"stages.contacts.core_seconds", "contacts", 1, 2},
    {"stages.search.core_seconds", "search", 1, 2},
    {"stages.forces.core_seconds", "forces", 1, 2},
    {"core_us_per_contact_step", "us/(touching pair and step)", 1, 2},
};

/// A scene being run.
typedef struct scene_run
{
    scree_scene_file file;
    scree_simulation *simulation;
} scene_run;

static void end(scene_run *run)
{
    scree_simulation_destroy(run->simulation);
    scree_scene_close(&run->file);
}

static scree_status start(const scree_bench *bench, const char *const *overrides, int num_overrides, scene_run *run)
{
    *run = (scene_run){0};
    scree_status status = scree_scene_read(&run->file, bench->request->scene, overrides, num_overrides, bench->report);
    if (status == SCREE_OK)
        status = scree_simulation_create(&run->simulation, &run->file.scene, run->file.folder, bench->report);
    return status;
}

static json_t *describe(const scree_simulation *s, const scree_stage_times *times, double core, double wall,
                        double contact_steps)
{
    json_t *stages = json_object();
    for (int k = 0; k < SCREE_NUM_STAGES; ++k)
        json_object_set_new(stages, scree_stage_name((scree_stage)k),
                            json_pack("{s:f, s:f}", "core_seconds", times->core[k], "wall_seconds", times->wall[k]));
    return json_pack("{s:o, s:i, s:I, s:I, s:I, s:f, s:f, s:f, s:f, s:f}", "stages", stages, "threads",
                     omp_get_max_threads(), "particles", (json_int_t)s->particles.num_particles, "pairs",
                     (json_int_t)s->broad_phase.num_pairs, "contacts", (json_int_t)s->contacts.num_contacts,
                     "core_seconds", core, "wall_seconds", wall, "spread", 0.0, "time", scree_simulation_time(s),
                     "core_us_per_contact_step", contact_steps > 0 ? 1e6 * core / contact_steps : 0);
}

/// Runs to a step with the clock on. The case, with the sums over these steps; NULL if one fails. Measured once: the
/// same state does not come again.
static json_t *measure(scree_simulation *s, int64_t last_step, scree_report *report)
{
    scree_stage_times times = {{0}, {0}};
    scree_simulation_time_stages(s, &times);
    double contact_steps = 0;
    const int64_t first_step = s->step, searches = s->counters.num_rebuilds;
    const double core = scree_bench_core_seconds(), wall = scree_bench_wall_seconds();
    scree_status status = SCREE_OK;
    while (status == SCREE_OK && s->step < last_step)
    {
        status = scree_simulation_step(s, report);
        contact_steps += (double)s->contacts.num_contacts;
    }
    json_t *measured = status != SCREE_OK ? NULL
                                          : describe(s, &times, scree_bench_core_seconds() - core,
                                                     scree_bench_wall_seconds() - wall, contact_steps);
    scree_simulation_time_stages(s, NULL);
    if (measured == NULL) return NULL;
    json_object_set_new(measured, "steps", json_integer((json_int_t)(s->step - first_step)));
    json_object_set_new(measured, "searches", json_integer((json_int_t)(s->counters.num_rebuilds - searches)));
    json_object_set_new(measured, "mean_contacts", json_real(contact_steps / (double)(s->step - first_step)));
    return measured;
}

scree_status scree_bench_scene(scree_bench *bench)
{
    const scree_bench_request *request = bench->request;
    scree_bench_set_columns(bench, columns, (int)(sizeof columns / sizeof *columns));
    scene_run run;
    scree_status status = start(bench, request->overrides, request->num_overrides, &run);
    const int64_t num_steps = status != SCREE_OK   ? 0
                              : request->steps > 0 ? request->steps
                                                   : scree_simulation_num_steps(run.simulation);
    for (int64_t part = 0; part < request->parts && status == SCREE_OK; ++part)
    {
        const int64_t first = num_steps * part / request->parts, last = num_steps * (part + 1) / request->parts;
        if (first == last) continue;
        json_t *measured = measure(run.simulation, last, bench->report);
        char name[64];
        snprintf(name, sizeof name, "to step %lld", (long long)last);
        if (measured != NULL) json_object_set_new(measured, "name", json_string(name));
        status = measured != NULL ? scree_bench_add(bench, measured) : SCREE_UNSTABLE;
    }
    end(&run);
    return status;
}

/// Least squares of log(time) over log(triangles).
static double fit_exponent(const json_t *cases)
{
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    size_t k;
    const json_t *one;
    json_array_foreach(cases, k, one)
    {
        const double a = log(json_number_value(json_object_get(one, "triangles")));
        const double b = log(json_number_value(json_object_get(one, "core_seconds")));
        n += 1;
        x += a;
        y += b;
        xx += a * a;
        xy += a * b;
    }
    return (n * xy - x * y) / (n * xx - x * x);
}

static json_t *measure_rig(const scree_bench *bench, int triangles)
{
    char texts[2][64];
    const char *overrides[2] = {texts[0], texts[1]};
    snprintf(texts[0], sizeof texts[0], "shapes.rock.triangles=%d", triangles);
    snprintf(texts[1], sizeof texts[1], "particles.0.count=%lld", (long long)bench->request->particles);
    scene_run run;
    json_t *measured = NULL;
    if (start(bench, overrides, 2, &run) == SCREE_OK)
        measured = measure(run.simulation, bench->request->steps, bench->report);
    end(&run);
    if (measured == NULL) return NULL;
    char name[32];
    snprintf(name, sizeof name, "%d triangles", triangles);
    json_object_set_new(measured, "name", json_string(name));
    json_object_set_new(measured, "triangles", json_integer(triangles));
    return measured;
}

scree_status scree_bench_rig(scree_bench *bench)
{
    static const int triangles[] = {10, 32, 100, 320, 1000};
    scree_bench_set_columns(bench, columns, (int)(sizeof columns / sizeof *columns));
    int num = 0;
    for (size_t k = 0; k < sizeof triangles / sizeof *triangles; ++k)
    {
        if (bench->request->triangles > 0 && triangles[k] > bench->request->triangles) continue;
        json_t *measured = measure_rig(bench, triangles[k]);
        if (measured == NULL) return SCREE_INVALID_INPUT;
        const scree_status status = scree_bench_add(bench, measured);
        if (status != SCREE_OK) return status;
        ++num;
    }
    if (num > 1 && !bench->is_quiet)
        printf("time grows as triangles to the power of %.3f\n", fit_exponent(bench->cases));
    return SCREE_OK;
}
