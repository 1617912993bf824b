/// \file bench_scene.c
/// Scenes run with the clock on: scree bench scene, part by part of a run, and scree bench rig, the beginning of a
/// calibration rig with rocks of more and more triangles.
#include "cli/bench.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

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
    {"core_ns_per_pair_step", "ns/(candidate and step)", 1, 0},
    {"particle_steps_per_second", "p.steps/s", 1, 0},
    {"spread", "spread %", 100, 0},
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

/// Values of a scene that are replaced.
typedef struct scene_words
{
    const char *const *overrides; ///< (num)
    int num;
} scene_words;

static scree_status start(const scree_bench *bench, const scene_words *words, scene_run *run)
{
    *run = (scene_run){0};
    scree_status status =
        scree_scene_read(&run->file, bench->request->scene, words->overrides, words->num, bench->report);
    if (status == SCREE_OK)
        status = scree_simulation_create(&run->simulation, &run->file.scene, run->file.folder, bench->report);
    return status;
}

/// A part of a run: what its steps took in each repetition, and what they had to do, which is the same in all.
typedef struct run_part
{
    scree_bench_times times;
    int64_t num_steps, last_step, num_searches;
    double contact_steps, pair_steps; ///< touching pairs and candidates, summed over the steps
    json_t *at_end;                   ///< counts and bytes
} run_part;

/// The steps up to the part's last one with the clock on, in repetition r.
static scree_status run(scree_simulation *s, run_part *part, int r, scree_report *report)
{
    scree_stage_times stages = {{0}, {0}};
    scree_simulation_time_stages(s, &stages);
    const int64_t first_step = s->step, searches = s->counters.num_rebuilds;
    part->contact_steps = part->pair_steps = 0;
    const double core = scree_bench_core_seconds(), wall = scree_bench_wall_seconds();
    scree_status status = SCREE_OK;
    while (status == SCREE_OK && s->step < part->last_step)
    {
        status = scree_simulation_step(s, report);
        part->contact_steps += (double)s->contacts.num_contacts;
        part->pair_steps += (double)s->broad_phase.num_pairs;
    }
    part->times.core[r] = scree_bench_core_seconds() - core;
    part->times.wall[r] = scree_bench_wall_seconds() - wall;
    scree_bench_times_set_stages(&part->times, r, &stages, 1);
    scree_simulation_time_stages(s, NULL);
    part->num_steps = s->step - first_step;
    part->num_searches = s->counters.num_rebuilds - searches;
    json_decref(part->at_end);
    part->at_end = json_pack("{s:i, s:I, s:I, s:I, s:f, s:o}", "threads", omp_get_max_threads(), "particles",
                             (json_int_t)s->particles.num_particles, "pairs", (json_int_t)s->broad_phase.num_pairs,
                             "contacts", (json_int_t)s->contacts.num_contacts, "time", scree_simulation_time(s),
                             "bytes", scree_bench_memory(s));
    return status;
}

/// The case of a part whose repetitions are done. triangles: of the rig's rocks, 0 for a scene.
static scree_status add_part(scree_bench *bench, run_part *part, int triangles)
{
    json_t *measured = json_incref(part->at_end);
    const double steps = (double)part->num_steps;
    char name[64];
    if (triangles > 0) snprintf(name, sizeof name, "%d triangles", triangles);
    else snprintf(name, sizeof name, "to step %lld", (long long)part->last_step);
    json_object_set_new(measured, "name", json_string(name));
    if (triangles > 0) json_object_set_new(measured, "triangles", json_integer(triangles));
    scree_bench_times_describe(&part->times, part->contact_steps, measured);
    const double core = json_number_value(json_object_get(measured, "core_seconds"));
    const double wall = json_number_value(json_object_get(measured, "wall_seconds"));
    const double particles = json_number_value(json_object_get(measured, "particles"));
    json_object_set_new(measured, "steps", json_integer((json_int_t)part->num_steps));
    json_object_set_new(measured, "searches", json_integer((json_int_t)part->num_searches));
    json_object_set_new(measured, "mean_contacts", json_real(part->contact_steps / steps));
    if (part->contact_steps > 0)
        json_object_set_new(measured, "core_us_per_contact_step", json_real(1e6 * core / part->contact_steps));
    if (part->pair_steps > 0)
        json_object_set_new(measured, "core_ns_per_pair_step", json_real(1e9 * core / part->pair_steps));
    json_object_set_new(measured, "particle_steps_per_second", json_real(particles * steps / wall));
    return scree_bench_add(bench, measured);
}

static void destroy_parts(run_part *parts, int64_t num)
{
    for (int64_t k = 0; k < num && parts != NULL; ++k)
    {
        scree_bench_times_destroy(&parts[k].times);
        json_decref(parts[k].at_end);
    }
    free(parts);
}

static run_part *create_parts(int64_t num, int64_t num_steps, int num_repetitions)
{
    run_part *parts = calloc((size_t)num, sizeof *parts);
    bool has_room = parts != NULL;
    for (int64_t k = 0; k < num && has_room; ++k)
    {
        parts[k].last_step = num_steps * (k + 1) / num;
        has_room = scree_bench_times_create(&parts[k].times, num_repetitions);
    }
    if (has_room) return parts;
    destroy_parts(parts, num);
    return NULL;
}

/// num_steps of a scene from its start, 0 for all, in parts, as often as is asked for: the same steps each time.
static scree_status add_run(scree_bench *bench, const scene_words *words, int64_t num_steps, int64_t num_parts,
                            int triangles)
{
    const int num_repetitions = (int)bench->request->repetitions;
    run_part *parts = NULL;
    scree_status status = SCREE_OK;
    for (int r = 0; r < num_repetitions && status == SCREE_OK; ++r)
    {
        scene_run scene;
        status = start(bench, words, &scene);
        if (status == SCREE_OK && parts == NULL)
        {
            if (num_steps == 0) num_steps = scree_simulation_num_steps(scene.simulation);
            if (num_parts > num_steps) num_parts = num_steps;
            parts = create_parts(num_parts, num_steps, num_repetitions);
            if (parts == NULL) status = SCREE_OUT_OF_MEMORY;
        }
        for (int64_t k = 0; k < num_parts && status == SCREE_OK; ++k)
        {
            status = run(scene.simulation, parts + k, r, bench->report);
            if (status == SCREE_OK && r + 1 == num_repetitions) status = add_part(bench, parts + k, triangles);
        }
        end(&scene);
    }
    destroy_parts(parts, num_parts);
    return status;
}

scree_status scree_bench_scene(scree_bench *bench)
{
    const scree_bench_request *request = bench->request;
    const scene_words words = {request->overrides, request->num_overrides};
    scree_bench_set_columns(bench, columns, (int)(sizeof columns / sizeof *columns));
    return add_run(bench, &words, request->steps, request->parts, 0);
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

static scree_status add_rig(scree_bench *bench, int triangles)
{
    char texts[2][64];
    const char *overrides[2] = {texts[0], texts[1]};
    snprintf(texts[0], sizeof texts[0], "shapes.rock.triangles=%d", triangles);
    snprintf(texts[1], sizeof texts[1], "particles.0.count=%lld", (long long)bench->request->particles);
    const scene_words words = {overrides, 2};
    return add_run(bench, &words, bench->request->steps, 1, triangles);
}

/// Have the rocks of each case touched anything?
static bool has_contacts(const json_t *cases)
{
    size_t k;
    const json_t *one;
    json_array_foreach(cases, k, one)
    {
        if (!(json_number_value(json_object_get(one, "mean_contacts")) > 0)) return false;
    }
    return true;
}

scree_status scree_bench_rig(scree_bench *bench)
{
    static const int triangles[] = {10, 32, 100, 320, 1000};
    scree_bench_set_columns(bench, columns, (int)(sizeof columns / sizeof *columns));
    scree_status status = SCREE_OK;
    for (size_t k = 0; k < sizeof triangles / sizeof *triangles && status == SCREE_OK; ++k)
        if (bench->request->triangles == 0 || triangles[k] <= bench->request->triangles)
            status = add_rig(bench, triangles[k]);
    if (status != SCREE_OK || bench->is_quiet) return status;
    if (!has_contacts(bench->cases))
        printf("no growth with triangles is told: not all rocks have touched anything yet in %lld steps; take more\n",
               (long long)bench->request->steps);
    else if (json_array_size(bench->cases) > 1)
        printf("time grows as triangles to the power of %.3f\n", fit_exponent(bench->cases));
    return SCREE_OK;
}
