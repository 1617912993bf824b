/// \file bench_steps.c
/// Steps of a simulation, measured by the clock of its stages.
#define _DEFAULT_SOURCE /* getrusage */
#include "cli/bench.h"
#include "dynamics/on_device.h"
#include "dynamics/plan.h"
#include "dynamics/step_buffers.h"

#include <malloc.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <sys/resource.h>

enum
{
    WARM_UP_STEPS = 2
};

const scree_bench_column scree_bench_step_columns[] = {
    {"name", "bed                                 ", 0, 0},
    {"threads", "thr", 1, 0},
    {"particles", "particles", 1, 0},
    {"pairs_per_particle", "cand/p", 1, 2},
    {"contacts_per_particle", "touch/p", 1, 2},
    {"core_us_per_contact", "us/touch", 1, 3},
    {"stages.contacts.core_us_per_contact", "contacts", 1, 3},
    {"stages.search.core_us_per_contact", "search", 1, 3},
    {"stages.history.core_us_per_contact", "history", 1, 3},
    {"stages.forces.core_us_per_contact", "forces", 1, 3},
    {"stages.gather.core_us_per_contact", "gather", 1, 3},
    {"stages.work.core_us_per_contact", " work", 1, 3},
    {"rest_us_per_contact", " rest", 1, 3},
    {"core_ns_per_particle", "ns/particle", 1, 0},
    {"particle_steps_per_second", "p.steps/s", 1, 0},
    {"spread", "spread %", 100, 0},
    {"times_as_long", "times as long", 1, 3},
    {"ratio_spread", "its spread %", 100, 0},
};
const int scree_bench_num_step_columns = sizeof scree_bench_step_columns / sizeof *scree_bench_step_columns;

/// Steps, searching candidate pairs anew every so many.
static scree_status run_steps(scree_simulation *s, const scree_bench_request *request, int64_t num_steps,
                              scree_report *report)
{
    const scree_simulation *there = scree_simulation_there(s);
    scree_status status = SCREE_OK;
    for (int64_t k = 0; k < num_steps && status == SCREE_OK; ++k)
    {
        if (request->search_every > 0 && s->step % request->search_every == 0) there->buffers->is_search_asked = true;
        status = scree_simulation_step(s, report);
    }
    return status;
}

bool scree_bench_times_create(scree_bench_times *times, int num)
{
    // one block: two rows for the whole, two for each stage
    *times = (scree_bench_times){.num = num};
    double *block = calloc((size_t)(2 + 2 * SCREE_NUM_STAGES) * (size_t)num, sizeof *block);
    if (block == NULL) return false;
    times->core = block;
    times->wall = block + num;
    for (int k = 0; k < SCREE_NUM_STAGES; ++k)
    {
        times->stage_core[k] = block + (2 + 2 * k) * num;
        times->stage_wall[k] = block + (3 + 2 * k) * num;
    }
    return true;
}

void scree_bench_times_destroy(scree_bench_times *times)
{
    free(times->core);
    *times = (scree_bench_times){0};
}

void scree_bench_times_set_stages(scree_bench_times *times, int r, const scree_stage_times *stages, double share)
{
    for (int k = 0; k < SCREE_NUM_STAGES; ++k)
    {
        times->stage_core[k][r] = stages->core[k] * share;
        times->stage_wall[k][r] = stages->wall[k] * share;
    }
}

static double median_of(double *values, int num)
{
    const scree_bench_samples samples = {values, num};
    scree_bench_sort(samples);
    return scree_bench_median(samples);
}

void scree_bench_times_describe(scree_bench_times *times, double num_contacts, json_t *measured)
{
    json_t *stages = json_object(), *turns = json_array();
    for (int r = 0; r < times->num; ++r) json_array_append_new(turns, json_real(times->core[r]));
    json_object_set_new(measured, "core_seconds_of_turns", turns);
    for (int k = 0; k < SCREE_NUM_STAGES; ++k)
    {
        const double core = median_of(times->stage_core[k], times->num);
        const double wall = median_of(times->stage_wall[k], times->num);
        json_object_set_new(stages, scree_stage_name((scree_stage)k),
                            json_pack("{s:f, s:f, s:f}", "core_seconds", core, "wall_seconds", wall,
                                      "core_us_per_contact", num_contacts > 0 ? 1e6 * core / num_contacts : 0));
    }
    json_object_set_new(measured, "core_seconds", json_real(median_of(times->core, times->num)));
    json_object_set_new(measured, "wall_seconds", json_real(median_of(times->wall, times->num)));
    json_object_set_new(measured, "repetitions", json_integer(times->num));
    scree_bench_set_noise(measured, "spread", (scree_bench_samples){times->core, times->num});
    json_object_set_new(measured, "stages", stages);
}

/// One repetition, number r.
static scree_status measure_once(const scree_bench_way *way, const scree_bench_request *request,
                                 scree_bench_times *times, int r, scree_report *report)
{
    scree_simulation *s = way->simulation;
    omp_set_num_threads(way->threads);
    const double num_steps = (double)request->steps;
    const int64_t searches = s->counters.num_rebuilds;
    scree_stage_times stages = {{0}, {0}};
    // the clock of a GPU waits after each stage, and steps are not recorded: stages are measured apart from the whole
    const bool is_on_gpu = s->there != NULL;
    if (!is_on_gpu) scree_simulation_time_stages(s, &stages);
    const double core = scree_bench_core_seconds(), wall = scree_bench_wall_seconds();
    scree_status status = run_steps(s, request, request->steps, report);
    times->core[r] = (scree_bench_core_seconds() - core) / num_steps;
    times->wall[r] = (scree_bench_wall_seconds() - wall) / num_steps;
    times->num_searches += s->counters.num_rebuilds - searches;
    // while a GPU works the processor's own time says nothing
    if (is_on_gpu)
    {
        times->core[r] = times->wall[r];
        scree_simulation_time_stages(s, &stages);
        if (status == SCREE_OK) status = run_steps(s, request, request->steps, report);
    }
    scree_simulation_time_stages(s, NULL);
    scree_bench_times_set_stages(times, r, &stages, 1 / num_steps);
    return status;
}

/// All repetitions, of the ways in turn, so that they meet the same state of the machine.
static scree_status measure(const scree_bench_way *ways, int num_ways, const scree_bench_request *request,
                            scree_bench_times *times, scree_report *report)
{
    scree_status status = SCREE_OK;
    for (int w = 0; w < num_ways && status == SCREE_OK; ++w)
        status = run_steps(ways[w].simulation, request, WARM_UP_STEPS, report);
    for (int r = 0; r < times->num && status == SCREE_OK; ++r)
        for (int w = 0; w < num_ways && status == SCREE_OK; ++w)
            status = measure_once(ways + w, request, times + w, r, report);
    return status;
}

json_t *scree_bench_memory(const scree_simulation *s)
{
    const scree_plan_bytes bytes = scree_plan_added_up(scree_simulation_plan_bytes(s), s->particles.num_particles,
                                                       s->counters.num_pairs, s->counters.num_contacts);
    const struct mallinfo2 info = mallinfo2();
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return json_pack("{s:I, s:I, s:I, s:I, s:I}", "per_particle", (json_int_t)(bytes.state + bytes.search), "per_pair",
                     (json_int_t)scree_plan_largest_pair(&bytes), "per_contact", (json_int_t)bytes.contact, "allocated",
                     (json_int_t)(info.uordblks + info.hblkhd), "peak_resident", (json_int_t)usage.ru_maxrss * 1024);
}

static json_t *describe(const scree_bench_way *way, const scree_bench_request *request, scree_bench_times *times)
{
    // what the host has of it is as old as the last observation
    scree_simulation *s = way->simulation;
    const scree_simulation *there = scree_simulation_there(s);
    const int64_t num_pairs = there->broad_phase.num_pairs, num_contacts = there->contacts.num_contacts;
    const double particles = (double)s->particles.num_particles, pairs = (double)num_pairs;
    const double contacts = (double)num_contacts;
    json_t *measured = json_pack(
        "{s:i, s:I, s:I, s:I, s:f, s:f, s:I, s:I, s:f, s:o}", "threads", way->threads, "particles",
        (json_int_t)s->particles.num_particles, "pairs", (json_int_t)num_pairs, "contacts", (json_int_t)num_contacts,
        "pairs_per_particle", pairs / particles, "contacts_per_particle", contacts / particles, "steps",
        (json_int_t)request->steps, "search_every", (json_int_t)request->search_every, "searches_per_step",
        (double)times->num_searches / (double)(request->steps * times->num), "bytes", scree_bench_memory(s));
    scree_bench_times_describe(times, contacts, measured);
    const double core = json_number_value(json_object_get(measured, "core_seconds"));
    json_object_set_new(measured, "core_us_per_contact", json_real(contacts > 0 ? 1e6 * core / contacts : 0));
    json_object_set_new(measured, "core_ns_per_pair", json_real(pairs > 0 ? 1e9 * core / pairs : 0));
    json_object_set_new(measured, "core_ns_per_particle", json_real(1e9 * core / particles));
    json_object_set_new(measured, "particle_steps_per_second",
                        json_real(particles / json_number_value(json_object_get(measured, "wall_seconds"))));
    double rest = 0;
    static const scree_stage small[] = {SCREE_STAGE_PREDICT, SCREE_STAGE_TRAVEL, SCREE_STAGE_CORRECT,
                                        SCREE_STAGE_OTHER};
    const json_t *stages = json_object_get(measured, "stages");
    for (size_t k = 0; k < sizeof small / sizeof *small; ++k)
        rest += json_number_value(
            json_object_get(json_object_get(stages, scree_stage_name(small[k])), "core_us_per_contact"));
    json_object_set_new(measured, "rest_us_per_contact", json_real(rest));
    return measured;
}

/// Median and spread of the ratios of times of two ways, turn by turn, so before the times are sorted. False if memory
/// is out.
static bool find_ratios(const double *times, const double *reference, int num, double *median_and_spread)
{
    double *ratios = malloc((size_t)num * sizeof *ratios);
    if (ratios == NULL) return false;
    for (int r = 0; r < num; ++r) ratios[r] = times[r] / reference[r];
    const scree_bench_samples samples = {ratios, num};
    scree_bench_sort(samples);
    median_and_spread[0] = scree_bench_median(samples);
    median_and_spread[1] = scree_bench_spread(samples);
    free(ratios);
    return true;
}

scree_status scree_bench_steps(const scree_bench_way *ways, int num_ways, const scree_bench_request *request,
                               json_t **cases, scree_report *report)
{
    scree_bench_times times[2] = {{0}, {0}};
    bool has_room = true;
    for (int w = 0; w < num_ways; ++w)
        has_room = scree_bench_times_create(times + w, (int)request->repetitions) && has_room;
    scree_status status = has_room ? measure(ways, num_ways, request, times, report) : SCREE_OUT_OF_MEMORY;
    omp_set_num_threads((int)request->threads);
    double ratio[2];
    if (status == SCREE_OK && num_ways == 2)
    {
        // threads share the work, and what they save is elapsed time
        const bool is_wall = ways[0].threads != ways[1].threads;
        if (!find_ratios(is_wall ? times[1].wall : times[1].core, is_wall ? times[0].wall : times[0].core, times[1].num,
                         ratio))
            status = SCREE_OUT_OF_MEMORY;
    }
    for (int w = 0; w < num_ways; ++w)
    {
        cases[w] = status == SCREE_OK ? describe(ways + w, request, times + w) : NULL;
        scree_bench_times_destroy(times + w);
    }
    if (status == SCREE_OK && num_ways == 2)
    {
        json_object_set_new(cases[1], "times_as_long", json_real(ratio[0]));
        if (request->repetitions > 1) json_object_set_new(cases[1], "ratio_spread", json_real(ratio[1]));
    }
    return status;
}
