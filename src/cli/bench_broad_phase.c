/// \file bench_broad_phase.c
/// scree bench broad-phase: random boxes at the density of a packing; build and refit of the tree, search for pairs,
/// and the whole search with sort and rows.
#include "bvh/broad_phase.h"
#include "bvh/bvh_launch.h"
#include "cli/bench.h"
#include "core/sort.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

static const scree_bench_column columns[] = {
    {"name", "boxes           ", 0, 0},
    {"threads", "thr", 1, 0},
    {"particles", "  number", 1, 0},
    {"pairs_per_particle", "pairs/box", 1, 2},
    {"stages.build", "build ms", 1e3, 2},
    {"stages.refit", "refit ms", 1e3, 2},
    {"stages.search", "search ms", 1e3, 2},
    {"stages.plain_search", "plain search ms", 1e3, 2},
    {"stages.sort_and_rows", "sort, rows ms", 1e3, 2},
    {"build_and_search", "build+search ms", 1e3, 2},
    {"core_seconds", "whole ms", 1e3, 2},
    {"wall_seconds", "wall ms", 1e3, 2},
    {"core_ns_per_pair", "ns/pair", 1, 1},
    {"spread", "spread %", 100, 0},
};

/// Boxes of one kind; the cube that holds them has the volume num * volume_per_box, in units of the largest half edge.
typedef struct box_kind
{
    const char *name;
    double smallest;
    double elongation;
    double volume_per_box;
} box_kind;

static const box_kind kinds[] = {
    {"size 1:2", 0.5, 1, 2.6},
    {"size 1:1000", 0.001, 1, 0.55},
    {"elongation 1:50", 0.5, 50, 0.12},
};

static scree_box *make_boxes(const box_kind *kind, int64_t num)
{
    scree_box *boxes = malloc((size_t)num * sizeof *boxes);
    if (boxes == NULL) return NULL;
    uint64_t state = 1;
    const double extent = cbrt((double)num * kind->volume_per_box);
    for (int64_t i = 0; i < num; ++i)
    {
        double lower[3], upper[3];
        const double size = kind->smallest * pow(1 / kind->smallest, scree_bench_uniform(&state));
        for (int k = 0; k < 3; ++k)
        {
            const double middle = extent * (scree_bench_uniform(&state) - 0.5);
            const double half = size * pow(kind->elongation, scree_bench_uniform(&state) - 1);
            lower[k] = middle - half;
            upper[k] = middle + half;
        }
        boxes[i].lower = scree_vec3_make((scree_real)lower[0], (scree_real)lower[1], (scree_real)lower[2]);
        boxes[i].upper = scree_vec3_make((scree_real)upper[0], (scree_real)upper[1], (scree_real)upper[2]);
    }
    return boxes;
}

/// Stages of the measurements [s].
enum
{
    BUILD,
    REFIT,
    SEARCH,
    PLAIN_SEARCH,
    WHOLE,
    WALL,
    NUM_TIMES
};

/// One measurement to samples[stage][repeat]. False if memory is out.
static bool measure_once(scree_broad_phase *broad_phase, const scree_broad_phase_input *input, scree_sort_buffers *keys,
                         double times[NUM_TIMES])
{
    const double start = scree_bench_core_seconds(), wall = scree_bench_wall_seconds();
    if (scree_broad_phase_find(broad_phase, input) != SCREE_OK) return false;
    times[WHOLE] = scree_bench_core_seconds() - start;
    times[WALL] = scree_bench_wall_seconds() - wall;
    if (scree_sort_reserve(keys, broad_phase->num_pairs, false) != SCREE_OK) return false;
    int64_t num_keys = 0;
    scree_particle_pairs_args args = {
        broad_phase->tree.view, {keys->keys, &num_keys, keys->max_items, NULL, 31}, input->centres, input->radii};
    const double begin = scree_bench_core_seconds();
    if (scree_lbvh_build(&broad_phase->tree, input->boxes, input->num_particles) != SCREE_OK) return false;
    const double built = scree_bench_core_seconds();
    scree_lbvh_refit(&broad_phase->tree, input->boxes);
    const double refitted = scree_bench_core_seconds();
    scree_particle_pairs_find(args);
    const double found = scree_bench_core_seconds();
    num_keys = 0;
    scree_particle_pairs_launch(args, 2 * input->num_particles - 1);
    times[PLAIN_SEARCH] = scree_bench_core_seconds() - found;
    times[BUILD] = built - begin;
    times[REFIT] = refitted - built;
    times[SEARCH] = found - refitted;
    return true;
}

static json_t *describe(const box_kind *kind, int64_t num, int64_t num_pairs, double *times, int num_repeats)
{
    double middle[NUM_TIMES];
    for (int k = 0; k < NUM_TIMES; ++k)
    {
        const scree_bench_samples samples = {times + k * num_repeats, num_repeats};
        scree_bench_sort(samples);
        middle[k] = scree_bench_median(samples);
    }
    json_t *stages = json_pack("{s:f, s:f, s:f, s:f, s:f}", "build", middle[BUILD], "refit", middle[REFIT], "search",
                               middle[SEARCH], "plain_search", middle[PLAIN_SEARCH], "sort_and_rows",
                               middle[WHOLE] - middle[BUILD] - middle[SEARCH]);
    json_t *measured = json_pack(
        "{s:s, s:i, s:I, s:I, s:f, s:f, s:f, s:f, s:f, s:i, s:o}", "name", kind->name, "threads", omp_get_max_threads(),
        "particles", (json_int_t)num, "pairs", (json_int_t)num_pairs, "pairs_per_particle",
        (double)num_pairs / (double)num, "core_seconds", middle[WHOLE], "wall_seconds", middle[WALL],
        "build_and_search", middle[BUILD] + middle[SEARCH], "core_ns_per_pair",
        num_pairs > 0 ? 1e9 * middle[WHOLE] / (double)num_pairs : 0, "repetitions", num_repeats, "stages", stages);
    scree_bench_set_noise(measured, "spread", (scree_bench_samples){times + WHOLE * num_repeats, num_repeats});
    return measured;
}

static json_t *measure(const box_kind *kind, int64_t num, int num_repeats)
{
    scree_box *boxes = make_boxes(kind, num);
    double *times = calloc((size_t)(NUM_TIMES * num_repeats), sizeof *times);
    scree_broad_phase broad_phase = {0};
    scree_sort_buffers keys = {0};
    bool is_complete = boxes != NULL && times != NULL;
    const scree_broad_phase_input input = {.boxes = boxes, .num_particles = num};
    // the first search makes room and is not counted
    is_complete = is_complete && scree_broad_phase_find(&broad_phase, &input) == SCREE_OK;
    for (int r = 0; r < num_repeats && is_complete; ++r)
    {
        double one[NUM_TIMES];
        is_complete = measure_once(&broad_phase, &input, &keys, one);
        for (int k = 0; k < NUM_TIMES; ++k) times[k * num_repeats + r] = is_complete ? one[k] : 0;
    }
    json_t *measured = is_complete ? describe(kind, num, broad_phase.num_pairs, times, num_repeats) : NULL;
    scree_sort_destroy(&keys);
    scree_broad_phase_destroy(&broad_phase);
    free(boxes);
    free(times);
    return measured;
}

scree_status scree_bench_broad_phase(scree_bench *bench)
{
    scree_bench_set_columns(bench, columns, (int)(sizeof columns / sizeof *columns));
    int64_t smallest = bench->request->particles;
    while (smallest > 10000) smallest /= 10;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k)
        for (int64_t num = smallest; num <= bench->request->particles; num *= 10)
        {
            const scree_status status =
                scree_bench_add(bench, measure(kinds + k, num, (int)bench->request->repetitions));
            if (status != SCREE_OK) return status;
        }
    return SCREE_OK;
}
