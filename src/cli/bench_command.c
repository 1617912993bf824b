/// \file bench_command.c
/// scree bench: where the time goes, as tables and as JSON.
#include "cli/bench.h"
#include "cli/commands.h"
#include "cli/device_argument.h"
#include "cli/mesh_argument.h"
#include "io/nearest_name.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: scree bench NAME [options]\n"
    "\n"
    "Measures this machine. NAME is one of\n"
    "  overlap      the overlap of two bodies of 4 to 1000 triangles: ways, stages, work\n"
    "  broad-phase  search for pairs among random boxes, stage by stage\n"
    "  packing      whole steps of dense beds at rest: cubes, Schoenhardt polyhedra, rocks of 28 and 40 triangles,\n"
    "               spheres\n"
    "  spheres      whole steps of a bed of spheres with five contacts each; the same on two threads (or --threads) "
    "in\n"
    "               turn with one; beads at rest in a drum of meshes, in turn with the same beads without it\n"
    "  rig          the first steps of the calibration rig with rocks of 10 to 1000 triangles\n"
    "  scene        a scene from its start, part by part\n"
    "  scaling      beds of more and more particles on one and on more threads\n"
    "\n"
    "Options, and the benchmarks that take them; others refuse them:\n"
    "  --particles N      all but scene: bodies (overlap: pairs; broad-phase, scaling: largest number)\n"
    "  --shape NAME       packing, scaling: only cube, schoenhardt, rock or sphere\n"
    "  --triangles N      packing, scaling: of rocks; rig: at most so many\n"
    "  --depth D          packing, spheres, scaling: mean indentation over the bounding diameter in a bed, default\n"
    "                     1e-3, spheres 5e-3; deeper beds have more pairs; overlap: of all pairs, default at\n"
    "                     random from 1e-4 to 5e-2\n"
    "  --steps N          packing, spheres, scaling: in one repetition; rig, scene: in all\n"
    "  --repetitions N    all: of each measurement; rig, scene: runs from the start, default 1. Medians are told,\n"
    "                     and the spread (largest minus smallest)/median; measured once, nothing is known of the\n"
    "                     noise\n"
    "  --search-every N   packing, spheres, scaling: steps between searches of candidate pairs in a bed, default\n"
    "                     20; --steps must be a multiple, so that each repetition has as many; 0: none, for\n"
    "                     nothing moves\n"
    "  --order NAME       packing, spheres, scaling: of the particles in a bed: lattice (default), morton or\n"
    "                     random\n"
    "  --savings          packing, spheres: each piece of avoided work is done after all, in turn with the bed.\n"
    "                     Beds at rest do not show what the automatic skin saves; in spheres beads that fall do,\n"
    "                     against a skin of a tenth of the radius (their spread is also that of the fall), and\n"
    "                     validation/performance has a table. Bodies in the order of a lattice need not change\n"
    "                     places; the last row is of the same bed mixed, of some 10 000 bodies at least\n"
    "  --scene FILE       rig, default scenes/calibration_rig_demo.yaml; scene\n"
    "  --set PATH=VALUE   scene: replaces a value of it; can be repeated\n"
    "  --parts N          scene: rows of the table, default 10\n"
    "  --threads N        all but overlap: default 1; spheres: also compares one with N, default 2; scaling:\n"
    "                     compares one with N, default all\n"
    "  --device WHERE     packing, spheres: cpu, the default, or cuda or cuda:N; then all times are elapsed ones,\n"
    "                     and those of the stages are what the processor waits in them\n"
    "  --json FILE        all: writes the result; \"-\" for standard output, then without tables\n"
    "  --baseline FILE    all: prints ratios to a result that was written before, one of --json or several by name\n"
    "                     as in benchmarks/baseline.json; tells by which options that was made, for only rows of\n"
    "                     the same size are compared\n"
    "  --help             this text\n"
    "\n"
    "Times are those of the processor, of all threads together, where they are not called wall. Rows of whole steps\n"
    "(all but overlap and broad-phase) have the time per stage, per touching pair and per candidate, particle-steps\n"
    "per second and bytes per particle, candidate and contact. Overlap has the time of one touching pair and of its\n"
    "stages, broad-phase that of a search, of its stages and per candidate. Exit code: 0 if done, 1 if a file or a\n"
    "step failed, 2 if the command line or the input was refused.\n";

/// Benchmarks, as bits.
enum
{
    OVERLAP = 1,
    BROAD_PHASE = 2,
    PACKING = 4,
    SPHERES = 8,
    RIG = 16,
    SCENE = 32,
    SCALING = 64,
    BEDS = PACKING | SPHERES | SCALING,
    ALL = BEDS | OVERLAP | BROAD_PHASE | RIG | SCENE
};

/// A benchmark and what it does unless told otherwise.
typedef struct bench_kind
{
    const char *name;
    scree_status (*run)(scree_bench *bench);
    int bit;
    int64_t particles, steps, repetitions;
} bench_kind;

static const bench_kind kinds[] = {
    {"overlap", scree_bench_overlap, OVERLAP, 400, 1, 9},
    {"broad-phase", scree_bench_broad_phase, BROAD_PHASE, 1000000, 1, 5},
    {"packing", scree_bench_packing, PACKING, 20000, 20, 5},
    {"spheres", scree_bench_spheres, SPHERES, 50000, 20, 7},
    {"rig", scree_bench_rig, RIG, 160, 14000, 1},
    {"scaling", scree_bench_scaling, SCALING, 100000, 20, 3},
    {"scene", scree_bench_scene, SCENE, 0, 0, 1},
};
enum
{
    NUM_KINDS = sizeof kinds / sizeof *kinds
};

/// An option and the benchmarks that take it.
typedef struct bench_option
{
    const char *name;
    int users;
} bench_option;

static const bench_option options[] = {
    {"--particles", ALL & ~SCENE},
    {"--shape", PACKING | SCALING},
    {"--triangles", PACKING | SCALING | RIG},
    {"--depth", BEDS | OVERLAP},
    {"--steps", BEDS | RIG | SCENE},
    {"--repetitions", ALL},
    {"--search-every", BEDS},
    {"--order", BEDS},
    {"--savings", PACKING | SPHERES},
    {"--scene", RIG | SCENE},
    {"--set", SCENE},
    {"--parts", SCENE},
    {"--threads", ALL & ~OVERLAP},
    {"--device", PACKING | SPHERES},
    {"--json", ALL},
    {"--baseline", ALL},
};
enum
{
    NUM_OPTIONS = sizeof options / sizeof *options
};

/// An option that takes a whole number.
typedef struct number_option
{
    const char *name;
    int64_t *value;
    int64_t min, max;
} number_option;

static bool refuse(const char *what, const char *argument)
{
    fprintf(stderr, "scree bench: %s%s; see scree bench --help\n", what, argument);
    return false;
}

static bool is_among(const char *value, const char *const *words, int num_words)
{
    for (int k = 0; k < num_words; ++k)
        if (strcmp(value, words[k]) == 0) return true;
    return false;
}

/// Does the benchmark take the option? False, with a message, if it would do nothing.
static bool check_option(const bench_kind *kind, const char *option)
{
    for (int k = 0; k < NUM_OPTIONS; ++k)
    {
        if (strcmp(option, options[k].name) != 0) continue;
        if ((options[k].users & kind->bit) != 0) return true;
        fprintf(stderr, "scree bench: %s does not take %s, which is for", kind->name, option);
        const char *between = " ";
        for (int n = 0; n < NUM_KINDS; ++n)
        {
            if ((options[k].users & kinds[n].bit) == 0) continue;
            fprintf(stderr, "%s%s", between, kinds[n].name);
            between = ", ";
        }
        fprintf(stderr, "; leave it out, or see scree bench --help\n");
        return false;
    }
    return refuse("unknown option ", option);
}

/// An option with a value. False, with a message, if it is unknown or its value is wrong.
static bool parse_valued(scree_bench_request *request, const char *option, const char *value)
{
    static const char *const shapes[] = {"cube", "schoenhardt", "rock", "sphere"};
    static const char *const orders[] = {"lattice", "morton", "random"};
    const number_option numbers[] = {
        {"--particles", &request->particles, 8, 100000000},
        {"--triangles", &request->triangles, 4, 1000000},
        {"--steps", &request->steps, 1, 1000000000},
        {"--repetitions", &request->repetitions, 1, 1000},
        {"--search-every", &request->search_every, 0, 1000000},
        {"--threads", &request->threads, 1, 4096},
        {"--parts", &request->parts, 1, 100000},
    };
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; ++k)
    {
        if (strcmp(option, numbers[k].name) != 0) continue;
        char *end;
        const long long number = strtoll(value, &end, 10);
        if (*value != '\0' && *end == '\0' && number >= numbers[k].min && number <= numbers[k].max)
        {
            *numbers[k].value = number;
            return true;
        }
        fprintf(stderr, "scree bench: %s %s: it must be a whole number from %lld to %lld\n", option, value,
                (long long)numbers[k].min, (long long)numbers[k].max);
        return false;
    }
    if (strcmp(option, "--depth") == 0)
    {
        if (scree_parse_number(value, &request->depth) && request->depth >= 1e-5 && request->depth <= 0.1) return true;
        return refuse("--depth must be a number from 1e-5 to 0.1, not ", value);
    }
    if (strcmp(option, "--device") == 0)
        return scree_parse_device(value, &request->device) || refuse("--device needs cpu, cuda or cuda:N, not ", value);
    if (strcmp(option, "--shape") == 0) request->shape = value;
    else if (strcmp(option, "--order") == 0) request->order = value;
    else if (strcmp(option, "--scene") == 0) request->scene = value;
    else if (strcmp(option, "--set") == 0) request->overrides[request->num_overrides++] = value;
    else if (strcmp(option, "--json") == 0) request->json = value;
    else request->baseline = value;
    if (request->shape != NULL && !is_among(request->shape, shapes, 4))
        return refuse("--shape must be cube, schoenhardt, rock or sphere, not ", request->shape);
    if (!is_among(request->order, orders, 3))
        return refuse("--order must be lattice, morton or random, not ", request->order);
    return true;
}

static const bench_kind *find_kind(const char *name)
{
    for (int k = 0; k < NUM_KINDS; ++k)
        if (strcmp(kinds[k].name, name) == 0) return kinds + k;
    const char *names[NUM_KINDS];
    for (int k = 0; k < NUM_KINDS; ++k) names[k] = kinds[k].name;
    const char *nearest = scree_nearest_name(name, names, NUM_KINDS);
    fprintf(stderr, "scree bench: there is no benchmark \"%.60s\"; ", name);
    if (nearest != NULL) fprintf(stderr, "did you mean \"%s\"?\n", nearest);
    else fprintf(stderr, "see scree bench --help\n");
    return NULL;
}

/// Options that do nothing together, or would make rows that cannot be compared.
static bool check_together(const bench_kind *kind, const scree_bench_request *request)
{
    if (request->device >= 0 && request->shows_savings)
        return refuse("--savings are measured on the CPU, not with --device cuda", "");
    if (request->json != NULL && strcmp(request->json, "-") == 0 && request->baseline != NULL)
        return refuse("--json - leaves no place for the ratios of --baseline; write to a file", "");
    const bool are_rocks = request->shape == NULL ? kind->bit != SCALING : strcmp(request->shape, "rock") == 0;
    if (request->triangles > 0 && !are_rocks)
        return refuse("--triangles is for --shape rock, not for ",
                      request->shape != NULL ? request->shape : "schoenhardt");
    if (kind->bit == RIG && request->triangles > 0 && request->triangles < 10)
        return refuse("the rig has rocks of 10 triangles and more: --triangles must be at least 10", "");
    if ((kind->bit & BEDS) != 0 && request->search_every > 0 && request->steps % request->search_every != 0)
    {
        fprintf(
            stderr,
            "scree bench: --steps %lld must be a multiple of --search-every %lld, or repetitions have more searches or "
            "fewer; --search-every %lld would do\n",
            (long long)request->steps, (long long)request->search_every, (long long)request->steps);
        return false;
    }
    return true;
}

static bool parse_options(const bench_kind *kind, scree_bench_request *request, int argc, char **argv)
{
    for (int i = 2; i < argc; ++i)
    {
        const char *option = argv[i];
        if (strncmp(option, "--", 2) != 0) return refuse("one benchmark at a time, what is ", option);
        if (!check_option(kind, option)) return false;
        const bool is_kept = strcmp(option, "--json") != 0 && strcmp(option, "--baseline") != 0;
        if (is_kept) request->words[request->num_words++] = option;
        if (strcmp(option, "--savings") == 0)
        {
            request->shows_savings = true;
            continue;
        }
        if (++i == argc) return refuse("a value is needed after ", option);
        if (!parse_valued(request, option, argv[i])) return false;
        if (is_kept) request->words[request->num_words++] = argv[i];
    }
    return check_together(kind, request);
}

/// Before anything is measured: can the result be written where it shall go? Leaves no file behind.
static scree_status check_place(const scree_bench_request *request, scree_report *report)
{
    const char *path = request->json;
    if (path == NULL || strcmp(path, "-") == 0) return SCREE_OK;
    FILE *old = fopen(path, "r"), *file = fopen(path, "a");
    if (file == NULL) scree_report_add(report, "--json %s could not be written", path);
    else fclose(file);
    if (file != NULL && old == NULL) remove(path);
    if (old != NULL) fclose(old);
    return file != NULL ? SCREE_OK : SCREE_WRITE_FAILED;
}

/// The result to a file or to standard output.
static scree_status write_json(const scree_bench *bench)
{
    json_t *words = json_array();
    for (int k = 0; k < bench->request->num_words; ++k)
        json_array_append_new(words, json_string(bench->request->words[k]));
    json_t *result = json_pack("{s:s, s:s, s:o, s:o, s:O}", "bench", bench->request->name, "version", SCREE_VERSION,
                               "options", words, "machine", scree_bench_machine(), "cases", bench->cases);
    if (result == NULL) return SCREE_OUT_OF_MEMORY;
    const char *path = bench->request->json;
    const bool is_standard = strcmp(path, "-") == 0;
    FILE *out = is_standard ? stdout : fopen(path, "w");
    bool is_written =
        out != NULL && json_dumpf(result, out, JSON_INDENT(1) | JSON_REAL_PRECISION(6)) == 0 && fputc('\n', out) != EOF;
    if (out != NULL && !is_standard) is_written = fclose(out) == 0 && is_written;
    json_decref(result);
    if (!is_written) scree_report_add(bench->report, "%s could not be written", path);
    return is_written ? SCREE_OK : SCREE_WRITE_FAILED;
}

static int run_benchmark(const bench_kind *kind, const scree_bench_request *request)
{
    // tables are for people
    const bool is_quiet = request->json != NULL && strcmp(request->json, "-") == 0;
    scree_report report = {0};
    scree_bench bench = {.request = request, .cases = json_array(), .report = &report, .is_quiet = is_quiet};
    omp_set_num_threads((int)request->threads);
    json_t *baseline = NULL;
    scree_status status = check_place(request, &report);
    if (status == SCREE_OK && request->baseline != NULL)
        status = scree_bench_read_baseline(request, &baseline, &report);
    if (status == SCREE_OK) status = kind->run(&bench);
    if (status == SCREE_OK && request->json != NULL) status = write_json(&bench);
    if (status == SCREE_OK && baseline != NULL) scree_bench_compare(&bench, baseline);
    json_decref(baseline);
    scree_print_report(&report);
    if (status != SCREE_OK && scree_report_num_faults(&report) == 0)
        fprintf(stderr, "scree bench: %s\n", scree_status_text(status));
    scree_report_clear(&report);
    json_decref(bench.cases);
    if (status == SCREE_OK) return SCREE_EXIT_DONE;
    return status == SCREE_INVALID_INPUT || status == SCREE_NOT_FOUND ? SCREE_EXIT_USAGE : SCREE_EXIT_FAILED;
}

int scree_bench_command(int argc, char **argv)
{
    for (int i = 1; i < argc; ++i)
    {
        if (strcmp(argv[i], "--help") != 0 && strcmp(argv[i], "-h") != 0) continue;
        fputs(usage, stdout);
        return fflush(stdout) == 0 ? SCREE_EXIT_DONE : SCREE_EXIT_FAILED;
    }
    if (argc < 2)
    {
        refuse("no benchmark given", "");
        return SCREE_EXIT_USAGE;
    }
    const bench_kind *kind = find_kind(argv[1]);
    if (kind == NULL) return SCREE_EXIT_USAGE;
    scree_bench_request request = {.name = kind->name,
                                   .scene = "scenes/calibration_rig_demo.yaml",
                                   .order = "lattice",
                                   .particles = kind->particles,
                                   .steps = kind->steps,
                                   .repetitions = kind->repetitions,
                                   .search_every = 20,
                                   .parts = 10,
                                   .overrides = calloc((size_t)argc, sizeof(const char *)),
                                   .words = calloc((size_t)argc, sizeof(const char *)),
                                   .threads = 1,
                                   .device = -1};
    int exit_code = SCREE_EXIT_USAGE;
    if (request.overrides == NULL || request.words == NULL) exit_code = SCREE_EXIT_FAILED;
    else if (parse_options(kind, &request, argc, argv)) exit_code = run_benchmark(kind, &request);
    free(request.overrides);
    free(request.words);
    if (fflush(stdout) != 0 && exit_code == SCREE_EXIT_DONE)
    {
        fprintf(stderr, "scree bench: standard output could not be written\n");
        exit_code = SCREE_EXIT_FAILED;
    }
    return exit_code;
}
