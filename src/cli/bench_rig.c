/// \file bench_rig.c
/// scree bench rig: the beginning of a calibration rig with rocks of more and more triangles, and the exponent of the
/// time over the triangles.
#include "cli/bench.h"
#include "dynamics/state.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>

static const scree_bench_column columns[] = {
    {"name", "rig           ", 0, 0},
    {"threads", "thr", 1, 0},
    {"particles", "particles", 1, 0},
    {"steps", "  steps", 1, 0},
    {"contacts", "touching at the end", 1, 0},
    {"core_seconds", "core seconds", 1, 2},
    {"stages.contacts.core_seconds", "contacts", 1, 2},
    {"stages.search.core_seconds", "search", 1, 2},
    {"core_us_per_contact_step", "us/(touching pair and step)", 1, 2},
};

/// Runs the scene to its end with the clock on. NULL if it fails.
static json_t *run_scene(scree_bench *bench, int triangles)
{
    char texts[3][64];
    const char *overrides[3] = {texts[0], texts[1], texts[2]};
    snprintf(texts[0], sizeof texts[0], "shapes.rock.triangles=%d", triangles);
    snprintf(texts[1], sizeof texts[1], "particles.0.count=%lld", (long long)bench->request->particles);
    snprintf(texts[2], sizeof texts[2], "time.end=%.17g", (double)bench->request->steps * 1.8e-5);
    scree_scene_file file = {0};
    scree_simulation *s = NULL;
    scree_stage_times times = {{0}, {0}};
    scree_status status = scree_scene_read(&file, bench->request->scene, overrides, 3, bench->report);
    if (status == SCREE_OK) status = scree_simulation_create(&s, &file.scene, file.folder, bench->report);
    if (status == SCREE_OK) scree_simulation_time_stages(s, &times);
    double contact_steps = 0;
    const double begin = scree_bench_core_seconds(), wall = scree_bench_wall_seconds();
    while (status == SCREE_OK && s->step < bench->request->steps)
    {
        status = scree_simulation_step(s, bench->report);
        contact_steps += (double)s->contacts.num_contacts;
    }
    const double core = scree_bench_core_seconds() - begin;
    json_t *measured = NULL;
    if (status == SCREE_OK)
    {
        json_t *stages = json_object();
        for (int k = 0; k < SCREE_NUM_STAGES; ++k)
            json_object_set_new(stages, scree_stage_name((scree_stage)k),
                                json_pack("{s:f, s:f}", "core_seconds", times.core[k], "wall_seconds", times.wall[k]));
        measured =
            json_pack("{s:o, s:i, s:I, s:I, s:I, s:I, s:f, s:f, s:f, s:f, s:I}", "stages", stages, "threads",
                      omp_get_max_threads(), "particles", (json_int_t)s->particles.num_particles, "pairs",
                      (json_int_t)s->broad_phase.num_pairs, "contacts", (json_int_t)s->contacts.num_contacts, "steps",
                      (json_int_t)s->step, "core_seconds", core, "wall_seconds", scree_bench_wall_seconds() - wall,
                      "spread", 0.0, "core_us_per_contact_step", contact_steps > 0 ? 1e6 * core / contact_steps : 0,
                      "searches", (json_int_t)s->counters.num_rebuilds);
        json_object_set_new(measured, "triangles", json_integer(triangles));
        char name[32];
        snprintf(name, sizeof name, "%d triangles", triangles);
        json_object_set_new(measured, "name", json_string(name));
    }
    scree_simulation_destroy(s);
    scree_scene_close(&file);
    return measured;
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

scree_status scree_bench_rig(scree_bench *bench)
{
    static const int triangles[] = {10, 32, 100, 320, 1000};
    scree_bench_set_columns(bench, columns, (int)(sizeof columns / sizeof *columns));
    int num = 0;
    for (size_t k = 0; k < sizeof triangles / sizeof *triangles; ++k)
    {
        if (bench->request->triangles > 0 && triangles[k] > bench->request->triangles) continue;
        json_t *measured = run_scene(bench, triangles[k]);
        if (measured == NULL) return SCREE_INVALID_INPUT;
        const scree_status status = scree_bench_add(bench, measured);
        if (status != SCREE_OK) return status;
        ++num;
    }
    if (num > 1 && !bench->is_quiet)
        printf("time grows as triangles to the power of %.3f\n", fit_exponent(bench->cases));
    return SCREE_OK;
}
