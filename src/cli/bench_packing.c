/// \file bench_packing.c
/// Whole steps of dense beds at rest: scree bench packing, spheres and scaling.
#include "cli/bench.h"
#include "cli/device_argument.h"
#include "dynamics/on_device.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum
{
    FALLING_STEPS = 10 ///< steps of things that move for one of a bed at rest: a skin lasts long
};

/// What a baseline is matched by.
static void set_bed(json_t *measured, const scree_bench_bed *bed)
{
    json_object_set_new(measured, "depth", json_real(bed->depth));
    json_object_set_new(measured, "order", json_string(bed->order));
}

/// Steps of a bed, measured: its case, or NULL.
static json_t *measure_bed(const scree_bench *bench, const scree_bench_bodies *bodies, const scree_bench_bed *bed,
                           const char *name)
{
    const scree_bench_way way = {bodies->simulation, omp_get_max_threads()};
    json_t *measured = NULL;
    if (scree_bench_steps(&way, 1, bench->request, &measured, bench->report) != SCREE_OK) return NULL;
    json_object_set_new(measured, "name", json_string(name));
    json_object_set_new(measured, "mean_depth", json_real(bodies->depth));
    set_bed(measured, bed);
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

/// Measures steps of two simulations in turn and adds their cases: of `names`, NULL for one that is not wanted.
static scree_status add_in_turn(scree_bench *bench, const scree_bench_request *request, const scree_bench_way ways[2],
                                const scree_bench_bed *bed, const char *const names[2])
{
    json_t *cases[2] = {NULL, NULL};
    scree_status status = scree_bench_steps(ways, 2, request, cases, bench->report);
    for (int w = 0; w < 2; ++w)
    {
        if (status != SCREE_OK || names[w] == NULL)
        {
            json_decref(cases[w]);
            continue;
        }
        if (bed != NULL) set_bed(cases[w], bed);
        json_object_set_new(cases[w], "name", json_string(names[w]));
        status = scree_bench_add(bench, cases[w]);
    }
    return status;
}

/// The bed with one piece of work done after all, in turn with the bed.
static scree_status add_saving(scree_bench *bench, scree_bench_bed bed, const scree_bench_bodies *reference,
                               const char *name, saving saving)
{
    char text[96];
    snprintf(text, sizeof text, "%s %s", name, saving.name);
    bed.solver = saving.solver;
    bed.like = reference->simulation;
    scree_bench_bodies without;
    scree_status status = scree_bench_bed_create(&without, &bed, bench->report);
    if (status != SCREE_OK) return status;
    const int threads = (int)bench->request->threads;
    const scree_bench_way ways[2] = {{reference->simulation, threads}, {without.simulation, threads}};
    status = add_in_turn(bench, bench->request, ways, &bed, (const char *const[2]){NULL, text});
    scree_bench_bed_destroy(&without);
    return status;
}

static scree_status add_savings(scree_bench *bench, scree_bench_bed bed, const char *name)
{
    scree_bench_bodies reference;
    scree_status status = scree_bench_bed_create(&reference, &bed, bench->report);
    for (size_t k = 0; k < sizeof savings / sizeof *savings && status == SCREE_OK; ++k)
        status = add_saving(bench, bed, &reference, name, savings[k]);
    scree_bench_bed_destroy(&reference);
    if (status != SCREE_OK) return status;
    // only bodies that have mixed change places
    bed.order = "random";
    status = scree_bench_bed_create(&reference, &bed, bench->report);
    const saving places = {"mixed - reorder_particles", "reorder_particles: false"};
    if (status == SCREE_OK) status = add_saving(bench, bed, &reference, name, places);
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
    char name[64];
    snprintf(name, sizeof name, "sphere, %d threads in turn with one", threads);
    const scree_bench_way ways[2] = {{bodies.simulation, 1}, {bodies.simulation, threads}};
    status = add_in_turn(bench, bench->request, ways, bed, (const char *const[2]){NULL, name});
    if (status == SCREE_OK && !bench->is_quiet)
        printf("%d threads are %.2f times as fast as one\n", threads, 1 / last_ratio(bench));
    scree_bench_bed_destroy(&bodies);
    return status;
}

/// Beads in a drum: fewer than in the bed, for they have to fall first; at least as many as fit beside the lifters.
static int64_t num_beads_of(const scree_bench *bench)
{
    return bench->request->particles < 500 ? 200 : bench->request->particles * 2 / 5;
}

/// Beads in a drum, without its walls and with them.
static scree_status add_drum(scree_bench *bench)
{
    const int64_t num_beads = num_beads_of(bench);
    const int threads = (int)bench->request->threads;
    scree_bench_bodies drums[2];
    scree_status status = scree_bench_drum_create(drums, num_beads, bench->report);
    if (status != SCREE_OK) return status;
    const scree_bench_way ways[2] = {{drums[0].simulation, threads}, {drums[1].simulation, threads}};
    static const char *const names[2] = {"beads of a drum, no walls", "beads in a drum of meshes"};
    status = add_in_turn(bench, bench->request, ways, NULL, names);
    if (status == SCREE_OK && !bench->is_quiet)
        printf(
            "walls of meshes take %.0f %% on top in the drum of %lld beads, with %.2f contacts of a bead with them\n",
            100 * (last_ratio(bench) - 1), (long long)num_beads,
            (double)(drums[1].simulation->contacts.num_contacts - drums[0].simulation->contacts.num_contacts) /
                (double)num_beads);
    for (int k = 0; k < 2; ++k) scree_bench_bed_destroy(drums + k);
    return status;
}

/// What the automatic skin gains, which only shows where things move: beads on their fall into a drum, by the automatic
/// skin and by one of a tenth. No result depends on the skin, so both go through the same states.
static scree_status add_skins(scree_bench *bench)
{
    const int threads = (int)bench->request->threads;
    scree_bench_request request = *bench->request;
    request.search_every = 0;
    request.steps *= FALLING_STEPS;
    scree_bench_bodies twins[2];
    scree_status status = scree_bench_falling_create(twins, num_beads_of(bench), bench->report);
    if (status != SCREE_OK) return status;
    static const char *const names[2] = {"beads falling into a drum", "beads falling - automatic skin"};
    const scree_bench_way ways[2] = {{twins[0].simulation, threads}, {twins[1].simulation, threads}};
    status = add_in_turn(bench, &request, ways, NULL, names);
    for (int k = 0; k < 2; ++k) scree_bench_bed_destroy(twins + k);
    return status;
}

scree_status scree_bench_spheres(scree_bench *bench)
{
    // five contacts each
    scree_bench_bed bed = {"sphere", 0, bench->request->particles, 2.5, 5e-3, bench->request->order, "", NULL};
    if (bench->request->depth > 0) bed.depth = bench->request->depth;
    scree_bench_set_columns(bench, scree_bench_step_columns, scree_bench_num_step_columns);
    scree_status status = add_bed(bench, &bed, "sphere");
    if (status == SCREE_OK && bench->request->shows_savings) status = add_savings(bench, bed, "sphere");
    if (status != SCREE_OK || bench->request->device >= 0) return status;
    status = add_threads(bench, &bed);
    if (status == SCREE_OK) status = add_drum(bench);
    return status == SCREE_OK && bench->request->shows_savings ? add_skins(bench) : status;
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
