/// \file bench_broad_phase.c
/// Time of the stages of the broad phase for random boxes at the density of a packing: build and refit of the tree,
/// search for pairs (unsorted), and the whole search with sort and rows. Least of some repetitions, processor time, so
/// run it with OMP_NUM_THREADS=1; --wall measures elapsed time instead, for several threads.
/// Usage: bench_broad_phase [--wall] [largest number of boxes, default 1000000]
#define _POSIX_C_SOURCE 200809L
#include "bvh/broad_phase.h"
#include "bvh/bvh_launch.h"
#include "core/sort.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bvh_tools.h"

enum
{
    NUM_REPEATS = 5
};

/// Boxes of one kind; the cube that holds them has the volume num * volume_per_box, in units of the largest half edge.
typedef struct bench_kind
{
    const char *name;
    double smallest;
    double elongation;
    double volume_per_box;
} bench_kind;

static const bench_kind kinds[] = {
    {"size 1:2", 0.5, 1, 2.6},
    {"size 1:1000", 0.001, 1, 0.55},
    {"elongation 1:50", 0.5, 50, 0.12},
};

static clockid_t bench_clock = CLOCK_PROCESS_CPUTIME_ID;

static double now(void)
{
    struct timespec t;
    clock_gettime(bench_clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void stop_unless(bool is_well)
{
    if (is_well) return;
    fprintf(stderr, "bench_broad_phase: not enough memory\n");
    exit(EXIT_FAILURE);
}

/// Stages of one measurement [s].
typedef struct bench_times
{
    double build, refit, search, plain, whole;
} bench_times;

static void measure_once(scree_broad_phase *broad_phase, const scree_broad_phase_input *input, scree_sort_buffers *keys,
                         bench_times *least)
{
    const double start = now();
    stop_unless(scree_broad_phase_find(broad_phase, input) == SCREE_OK);
    const double whole = now() - start;
    stop_unless(scree_sort_reserve(keys, broad_phase->num_pairs, false) == SCREE_OK);
    int64_t num_keys = 0, num_plain_keys = 0;
    scree_particle_pairs_args args = {
        broad_phase->tree.view, {keys->keys, &num_keys, keys->max_items, 31}, input->centres, input->radii};
    const double begin = now();
    stop_unless(scree_lbvh_build(&broad_phase->tree, input->boxes, input->num_particles) == SCREE_OK);
    const double built = now();
    scree_lbvh_refit(&broad_phase->tree, input->boxes);
    const double refitted = now();
    scree_particle_pairs_find(args);
    const double found = now();
    args.list.num_keys = &num_plain_keys;
    scree_particle_pairs_launch(args, 2 * input->num_particles - 1);
    const double found_plainly = now();
    SCREE_CHECK_INT(num_keys, broad_phase->num_pairs);
    SCREE_CHECK_INT(num_plain_keys, broad_phase->num_pairs);
    least->build = fmin(least->build, built - begin);
    least->refit = fmin(least->refit, refitted - built);
    least->search = fmin(least->search, found - refitted);
    least->plain = fmin(least->plain, found_plainly - found);
    least->whole = fmin(least->whole, whole);
}

static void measure(const bench_kind *kind, int64_t num)
{
    uint64_t state = 1;
    const scree_test_boxes boxes_kind = {.extent = cbrt((double)num * kind->volume_per_box),
                                         .smallest = kind->smallest,
                                         .largest = 1,
                                         .elongation = kind->elongation};
    scree_box *boxes = scree_test_make_boxes(&boxes_kind, num, &state);
    const scree_broad_phase_input input = {.boxes = boxes, .num_particles = num};
    scree_broad_phase broad_phase = {0};
    scree_sort_buffers keys = {0};
    bench_times t = {INFINITY, INFINITY, INFINITY, INFINITY, INFINITY};
    for (int repeat = 0; repeat < NUM_REPEATS; ++repeat) measure_once(&broad_phase, &input, &keys, &t);
    printf("%-16s %8lld %6.2f %9.2f %9.2f %9.2f %9.2f %9.2f %9.2f\n", kind->name, (long long)num,
           (double)broad_phase.num_pairs / (double)num, 1e3 * t.build, 1e3 * t.refit, 1e3 * t.search, 1e3 * t.plain,
           1e3 * (t.build + t.search), 1e3 * t.whole);
    fflush(stdout);
    scree_sort_destroy(&keys);
    scree_broad_phase_destroy(&broad_phase);
    free(boxes);
}

int main(int num_args, char **args)
{
    int64_t largest = 1000000;
    for (int a = 1; a < num_args; ++a)
    {
        if (strcmp(args[a], "--wall") == 0) bench_clock = CLOCK_MONOTONIC;
        else largest = strtoll(args[a], NULL, 10);
    }
    printf("milliseconds; pairs per box; search: by clusters; plain: leaf by leaf; whole: with sort and rows\n");
    printf("%-16s %8s %6s %9s %9s %9s %9s %9s %9s\n", "boxes", "number", "pairs", "build", "refit", "search", "plain",
           "b.+search", "whole");
    for (int k = 0; k < (int)(sizeof kinds / sizeof *kinds); ++k)
        for (int64_t num = 10000; num <= largest; num *= 10) measure(kinds + k, num);
    return SCREE_TEST_END();
}
