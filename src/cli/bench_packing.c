/// \file bench_packing.c
/// Whole steps of dense beds at rest: scree bench packing, spheres and scaling.
#include "cli/bench.h"
#include "cli/device_argument.h"
#include "dynamics/on_device.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Steps of a bed, measured: its case, or NULL.
static json_t *measure_bed(const scree_bench *bench, const scree_bench_bodies *bodies, const scree_bench_bed *bed,
                           const char *name)
{
    json_t *measured = scree_bench_steps(bodies->simulation, bench->request, bench->report);
    if (measured == NULL) return NULL;
    json_object_set_new(measured, "name", json_string(name));
    json_object_set_new(measured, "mean_depth", json_real(bodies->depth));
    json_object_set_new(measured, "order", json_string(bed->order));
    return measured;
}

/// The bed to the GPU; what it takes there goes to `machine`, the description of the GPU.
static scree_status move_bed(scree_bench *bench, scree_simulation *simulation, scree_device *device, json_t *machine)
{
    json_object_set_new(machine, "scene_bytes", json_integer(scree_device_memory_of(simulation).total));
    return scree_simulation_use_device(simulation, device, bench->report);
}

static scree_status add_bed(scree_bench *bench, const scree_bench_bed *bed, const char *name)
{
    const int32_t number = bench->request->device;
    json_t *machine = NULL;
    scree_device *device = NULL;
    scree_status status = number >= 0 ? scree_bench_device(number, &machine, bench->report) : SCREE_OK;
    if (status == SCREE_OK) status = scree_open_device(number, &device, bench->report);
    scree_bench_bodies bodies = {0};
    if (status == SCREE_OK) status = scree_bench_bed_create(&bodies, bed, bench->report);
    if (status == SCREE_OK && device != NULL) status = move_bed(bench, bodies.simulation, device, machine);
    json_t *measured = status == SCREE_OK ? measure_bed(bench, &bodies, bed, name) : NULL;
    if (measured != NULL && machine != NULL) json_object_set(measured, "device", machine);
    if (measured != NULL) status = scree_bench_add(bench, measured);
    else if (status == SCREE_OK) status = SCREE_UNSTABLE;
    scree_bench_bed_destroy(&bodies);
    scree_device_close(device);
    json_decref(machine);
    return status;
}

/// A piece of avoided work and the key that switches it off.
typedef struct saving
{
    const char *name, *solver;
} saving;

static const saving savings[] = {
    {"- compare_spheres", "compare_spheres: false"},
    {"- find_separation", "find_separation: false"},
    {"- remember_separation", "remember_separation: false"},
    {"- bound_separation", "bound_separation: false"},
    {"- reuse_pairs", "reuse_pairs: false"},
    {"- all of these", "compare_spheres: false, find_separation: false, reuse_pairs: false"},
};

/// A simulation and on how many threads its steps are done.
typedef struct bench_way
{
    scree_simulation *simulation;
    int threads;
} bench_way;

/// Steps done in one way, measured in turn with another, so that both meet the same state of the machine: the case of
/// `way` with the median ratio of times of `kind` ("core_seconds" or "wall_seconds"). The spread is that of the ratios.
static json_t *measure_in_turn(const scree_bench *bench, bench_way reference, bench_way way, const char *kind)
{
    scree_bench_request once = *bench->request;
    once.repetitions = 1;
    double *ratios = malloc((size_t)bench->request->repetitions * sizeof *ratios);
    json_t *measured = NULL;
    bool is_complete = ratios != NULL;
    for (int64_t r = 0; r < bench->request->repetitions && is_complete; ++r)
    {
        json_decref(measured);
        omp_set_num_threads(reference.threads);
        json_t *before = scree_bench_steps(reference.simulation, &once, bench->report);
        omp_set_num_threads(way.threads);
        measured = scree_bench_steps(way.simulation, &once, bench->report);
        is_complete = before != NULL && measured != NULL;
        if (is_complete)
            ratios[r] =
                json_number_value(json_object_get(measured, kind)) / json_number_value(json_object_get(before, kind));
        json_decref(before);
    }
    omp_set_num_threads((int)bench->request->threads);
    if (is_complete)
    {
        const scree_bench_samples samples = {ratios, (int)bench->request->repetitions};
        scree_bench_sort(samples);
        json_object_set_new(measured, "times_as_long", json_real(scree_bench_median(samples)));
        json_object_set_new(measured, "spread", json_real(scree_bench_spread(samples)));
        json_object_set_new(measured, "repetitions", json_integer(samples.num));
    }
    else
    {
        json_decref(measured);
        measured = NULL;
    }
    free(ratios);
    return measured;
}

static scree_status add_savings(scree_bench *bench, scree_bench_bed bed, const char *name)
{
    scree_bench_bodies reference;
    const int threads = (int)bench->request->threads;
    scree_status status = scree_bench_bed_create(&reference, &bed, bench->report);
    for (size_t k = 0; k < sizeof savings / sizeof *savings && status == SCREE_OK; ++k)
    {
        char text[96];
        snprintf(text, sizeof text, "%s %s", name, savings[k].name);
        bed.solver = savings[k].solver;
        bed.like = reference.simulation;
        scree_bench_bodies without;
        status = scree_bench_bed_create(&without, &bed, bench->report);
        if (status != SCREE_OK) break;
        json_t *measured = measure_in_turn(bench, (bench_way){reference.simulation, threads},
                                           (bench_way){without.simulation, threads}, "core_seconds");
        if (measured != NULL) json_object_set_new(measured, "name", json_string(text));
        status = measured != NULL ? scree_bench_add(bench, measured) : SCREE_UNSTABLE;
        scree_bench_bed_destroy(&without);
    }
    scree_bench_bed_destroy(&reference);
    return status;
}

scree_status scree_bench_packing(scree_bench *bench)
{
    static const scree_bench_bed beds[] = {
        {"cube", 12, 0, 4, 1e-3, "", "", NULL},  {"schoenhardt", 8, 0, 4, 1e-3, "", "", NULL},
        {"rock", 28, 0, 4, 1e-3, "", "", NULL},  {"rock", 40, 0, 4, 1e-3, "", "", NULL},
        {"sphere", 0, 0, 4, 5e-3, "", "", NULL},
    };
    const scree_bench_request *request = bench->request;
    scree_bench_set_columns(bench, scree_bench_step_columns, scree_bench_num_step_columns);
    scree_status status = SCREE_OK;
    for (size_t k = 0; k < sizeof beds / sizeof *beds && status == SCREE_OK; ++k)
    {
        scree_bench_bed bed = beds[k];
        if (request->shape != NULL && strcmp(request->shape, bed.shape) != 0) continue;
        if (strcmp(bed.shape, "rock") == 0 && request->triangles > 0)
        {
            if (bed.triangles == 28) continue;
            bed.triangles = request->triangles;
        }
        char name[64];
        snprintf(name, sizeof name, strcmp(bed.shape, "rock") == 0 ? "%s %lld" : "%s", bed.shape,
                 (long long)bed.triangles);
        bed.particles = request->particles;
        bed.order = request->order;
        if (request->depth > 0) bed.depth = request->depth;
        status = add_bed(bench, &bed, name);
        if (status == SCREE_OK && request->shows_savings) status = add_savings(bench, bed, name);
    }
    return status;
}

/// The median ratio of the last case.
static double last_ratio(const scree_bench *bench)
{
    const json_t *last = json_array_get(bench->cases, json_array_size(bench->cases) - 1);
    return json_number_value(json_object_get(last, "times_as_long"));
}

/// The bed on more threads, in turn with one.
static scree_status add_threads(scree_bench *bench, const scree_bench_bed *bed)
{
    const int threads = bench->request->threads > 1 ? (int)bench->request->threads : 2;
    scree_bench_bodies bodies;
    scree_status status = scree_bench_bed_create(&bodies, bed, bench->report);
    if (status != SCREE_OK) return status;
    json_t *measured = measure_in_turn(bench, (bench_way){bodies.simulation, 1},
                                       (bench_way){bodies.simulation, threads}, "wall_seconds");
    char name[64];
    snprintf(name, sizeof name, "sphere, %d threads in turn with one", threads);
    if (measured != NULL) json_object_set_new(measured, "name", json_string(name));
    status = measured != NULL ? scree_bench_add(bench, measured) : SCREE_UNSTABLE;
    if (status == SCREE_OK && !bench->is_quiet)
        printf("%d threads are %.2f times as fast as one\n", threads, 1 / last_ratio(bench));
    scree_bench_bed_destroy(&bodies);
    return status;
}

/// Beads in a drum, without its walls and with them. Fewer, for they have to fall first; at least as many as fit beside
/// the lifters.
static scree_status add_drum(scree_bench *bench)
{
    const int64_t num_beads = bench->request->particles < 500 ? 200 : bench->request->particles * 2 / 5;
    const int threads = (int)bench->request->threads;
    scree_bench_bodies drums[2];
    scree_status status = scree_bench_drum_create(drums, num_beads, bench->report);
    if (status != SCREE_OK) return status;
    json_t *bare = scree_bench_steps(drums[0].simulation, bench->request, bench->report);
    if (bare != NULL) json_object_set_new(bare, "name", json_string("beads of a drum, no walls"));
    status = bare != NULL ? scree_bench_add(bench, bare) : SCREE_UNSTABLE;
    json_t *measured = status == SCREE_OK ? measure_in_turn(bench, (bench_way){drums[0].simulation, threads},
                                                            (bench_way){drums[1].simulation, threads}, "core_seconds")
                                          : NULL;
    if (measured != NULL) json_object_set_new(measured, "name", json_string("beads in a drum of meshes"));
    if (status == SCREE_OK) status = measured != NULL ? scree_bench_add(bench, measured) : SCREE_UNSTABLE;
    if (status == SCREE_OK && !bench->is_quiet)
        printf(
            "walls of meshes take %.0f %% on top in the drum of %lld beads, with %.2f contacts of a bead with them\n",
            100 * (last_ratio(bench) - 1), (long long)num_beads,
            (double)(drums[1].simulation->contacts.num_contacts - drums[0].simulation->contacts.num_contacts) /
                (double)num_beads);
    for (int k = 0; k < 2; ++k) scree_bench_bed_destroy(drums + k);
    return status;
}

scree_status scree_bench_spheres(scree_bench *bench)
{
    // five contacts each
    const scree_bench_bed bed = {"sphere", 0, bench->request->particles, 2.5, 5e-3, bench->request->order, "", NULL};
    scree_bench_set_columns(bench, scree_bench_step_columns, scree_bench_num_step_columns);
    scree_status status = add_bed(bench, &bed, "sphere");
    if (status == SCREE_OK && bench->request->shows_savings) status = add_savings(bench, bed, "sphere");
    if (status != SCREE_OK || bench->request->device >= 0) return status;
    status = add_threads(bench, &bed);
    return status == SCREE_OK ? add_drum(bench) : status;
}

/// How one bed's cost grows with its bodies, and falls with threads.
static void print_scaling(const scree_bench *bench)
{
    size_t k;
    const json_t *one;
    double smallest = 1e300, largest = 0;
    json_array_foreach(bench->cases, k, one)
    {
        const double particles = json_number_value(json_object_get(one, "particles"));
        const double wall = json_number_value(json_object_get(one, "wall_seconds"));
        const double per_contact = json_number_value(json_object_get(one, "core_us_per_contact"));
        if (json_integer_value(json_object_get(one, "threads")) == 1)
        {
            smallest = per_contact < smallest ? per_contact : smallest;
            largest = per_contact > largest ? per_contact : largest;
            continue;
        }
        const json_t *alone = json_array_get(bench->cases, k - 1);
        printf("%.0f particles: %lld threads are %.2f times as fast as one\n", particles,
               (long long)json_integer_value(json_object_get(one, "threads")),
               json_number_value(json_object_get(alone, "wall_seconds")) / wall);
    }
    if (largest > 0)
        printf("one thread, time per touching pair: largest over smallest of all sizes %.3f\n", largest / smallest);
}

scree_status scree_bench_scaling(scree_bench *bench)
{
    scree_bench_bed bed = {"schoenhardt", 8, 0, 4, 1e-3, bench->request->order, "", NULL};
    if (bench->request->shape != NULL) bed.shape = bench->request->shape;
    if (bench->request->depth > 0) bed.depth = bench->request->depth;
    bed.triangles = bench->request->triangles > 0 ? bench->request->triangles : 40;
    const int threads[2] = {1, bench->request->threads > 1 ? (int)bench->request->threads : omp_get_num_procs()};
    scree_bench_set_columns(bench, scree_bench_step_columns, scree_bench_num_step_columns);
    scree_status status = SCREE_OK;
    int64_t num = bench->request->particles;
    while (num > 10000) num /= 10;
    for (; num <= bench->request->particles && status == SCREE_OK; num *= 10)
    {
        bed.particles = num;
        scree_bench_bodies bodies;
        status = scree_bench_bed_create(&bodies, &bed, bench->report);
        for (int k = 0; k < 2 && status == SCREE_OK; ++k)
        {
            omp_set_num_threads(threads[k]);
            json_t *measured = measure_bed(bench, &bodies, &bed, bed.shape);
            status = measured != NULL ? scree_bench_add(bench, measured) : SCREE_UNSTABLE;
        }
        scree_bench_bed_destroy(&bodies);
    }
    if (status == SCREE_OK && !bench->is_quiet) print_scaling(bench);
    return status;
}
