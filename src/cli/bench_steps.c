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

/// Seconds of each repetition, whole and per stage, per step.
typedef struct step_samples
{
    double *core, *wall;                                                 ///< (num)
    double *stage_core[SCREE_NUM_STAGES], *stage_wall[SCREE_NUM_STAGES]; ///< (num)
    int num;
} step_samples;

static void destroy_samples(step_samples *samples) { free(samples->core); }

static bool create_samples(step_samples *samples, int num)
{
    // one block: two rows for the whole, two for each stage
    double *block = calloc((size_t)(2 + 2 * SCREE_NUM_STAGES) * (size_t)num, sizeof *block);
    if (block == NULL) return false;
    samples->num = num;
    samples->core = block;
    samples->wall = block + num;
    for (int k = 0; k < SCREE_NUM_STAGES; ++k)
    {
        samples->stage_core[k] = block + (2 + 2 * k) * num;
        samples->stage_wall[k] = block + (3 + 2 * k) * num;
    }
    return true;
}

static scree_status measure(scree_simulation *s, const scree_bench_request *request, step_samples *samples,
                            scree_report *report)
{
    const double num_steps = (double)request->steps;
    scree_status status = run_steps(s, request, WARM_UP_STEPS, report);
    for (int r = 0; r < samples->num && status == SCREE_OK; ++r)
    {
        scree_stage_times times = {{0}, {0}};
        // the clock of a GPU waits after each stage, and steps are not recorded: stages are measured apart from the
        // whole
        const bool is_on_gpu = s->there != NULL;
        if (!is_on_gpu) scree_simulation_time_stages(s, &times);
        const double core = scree_bench_core_seconds(), wall = scree_bench_wall_seconds();
        status = run_steps(s, request, request->steps, report);
        samples->core[r] = (scree_bench_core_seconds() - core) / num_steps;
        samples->wall[r] = (scree_bench_wall_seconds() - wall) / num_steps;
        // while a GPU works the processor's own time says nothing
        if (is_on_gpu)
        {
            samples->core[r] = samples->wall[r];
            scree_simulation_time_stages(s, &times);
            if (status == SCREE_OK) status = run_steps(s, request, request->steps, report);
        }
        scree_simulation_time_stages(s, NULL);
        for (int k = 0; k < SCREE_NUM_STAGES; ++k)
        {
            samples->stage_core[k][r] = times.core[k] / num_steps;
            samples->stage_wall[k][r] = times.wall[k] / num_steps;
        }
    }
    return status;
}

static double median_of(double *values, int num)
{
    const scree_bench_samples samples = {values, num};
    scree_bench_sort(samples);
    return scree_bench_median(samples);
}

static json_t *describe_stages(step_samples *samples, double num_contacts)
{
    json_t *stages = json_object();
    for (int k = 0; k < SCREE_NUM_STAGES; ++k)
    {
        const double core = median_of(samples->stage_core[k], samples->num);
        const double wall = median_of(samples->stage_wall[k], samples->num);
        json_object_set_new(stages, scree_stage_name((scree_stage)k),
                            json_pack("{s:f, s:f, s:f}", "core_seconds", core, "wall_seconds", wall,
                                      "core_us_per_contact", num_contacts > 0 ? 1e6 * core / num_contacts : 0));
    }
    return stages;
}

/// What the plan says of one item, and what the whole process takes.
static json_t *describe_memory(const scree_simulation *s)
{
    const scree_plan_bytes bytes = scree_simulation_plan_bytes(s);
    const struct mallinfo2 info = mallinfo2();
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return json_pack("{s:I, s:I, s:I, s:I, s:I}", "per_particle", (json_int_t)(bytes.state + bytes.search), "per_pair",
                     (json_int_t)scree_plan_largest_pair(&bytes), "per_contact", (json_int_t)bytes.contact, "allocated",
                     (json_int_t)(info.uordblks + info.hblkhd), "peak_resident", (json_int_t)usage.ru_maxrss * 1024);
}

static json_t *describe(scree_simulation *s, const scree_bench_request *request, step_samples *samples,
                        double num_searches)
{
    // what the host has of it is as old as the last observation
    const scree_simulation *there = scree_simulation_there(s);
    const int64_t num_pairs = there->broad_phase.num_pairs, num_contacts = there->contacts.num_contacts;
    const double particles = (double)s->particles.num_particles, pairs = (double)num_pairs;
    const double contacts = (double)num_contacts;
    scree_bench_samples core = {samples->core, samples->num};
    scree_bench_sort(core);
    const double middle = scree_bench_median(core), wall = median_of(samples->wall, samples->num);
    json_t *stages = describe_stages(samples, contacts);
    double rest = 0;
    static const scree_stage small[] = {SCREE_STAGE_PREDICT, SCREE_STAGE_TRAVEL, SCREE_STAGE_CORRECT,
                                        SCREE_STAGE_OTHER};
    for (size_t k = 0; k < sizeof small / sizeof *small; ++k)
        rest += json_number_value(
            json_object_get(json_object_get(stages, scree_stage_name(small[k])), "core_us_per_contact"));
    json_t *measured =
        json_pack("{s:i, s:I, s:I, s:I, s:f, s:f, s:I, s:i, s:f, s:f, s:f, s:f}", "threads", omp_get_max_threads(),
                  "particles", (json_int_t)s->particles.num_particles, "pairs", (json_int_t)num_pairs, "contacts",
                  (json_int_t)num_contacts, "pairs_per_particle", pairs / particles, "contacts_per_particle",
                  contacts / particles, "steps", (json_int_t)request->steps, "repetitions", samples->num,
                  "searches_per_step", num_searches / (double)(request->steps * samples->num), "core_seconds", middle,
                  "wall_seconds", wall, "spread", scree_bench_spread(core));
    json_object_set_new(measured, "core_us_per_contact", json_real(contacts > 0 ? 1e6 * middle / contacts : 0));
    json_object_set_new(measured, "core_ns_per_pair", json_real(pairs > 0 ? 1e9 * middle / pairs : 0));
    json_object_set_new(measured, "core_ns_per_particle", json_real(1e9 * middle / particles));
    json_object_set_new(measured, "particle_steps_per_second", json_real(particles / wall));
    json_object_set_new(measured, "rest_us_per_contact", json_real(rest));
    json_object_set_new(measured, "stages", stages);
    json_object_set_new(measured, "bytes", describe_memory(s));
    return measured;
}

json_t *scree_bench_steps(scree_simulation *simulation, const scree_bench_request *request, scree_report *report)
{
    step_samples samples;
    if (!create_samples(&samples, (int)request->repetitions)) return NULL;
    json_t *measured = NULL;
    const int64_t before = simulation->counters.num_rebuilds;
    if (measure(simulation, request, &samples, report) == SCREE_OK)
        measured = describe(simulation, request, &samples, (double)(simulation->counters.num_rebuilds - before));
    destroy_samples(&samples);
    return measured;
}
