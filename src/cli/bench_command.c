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
    "  --particles N      bodies (overlap: pairs; broad-phase, scaling, rig: largest number)\n"
    "  --shape NAME       only cube, schoenhardt, rock or sphere (packing, scaling)\n"
    "  --triangles N      of rocks (packing, scaling); rig: at most so many\n"
    "  --depth D          mean indentation over the bounding diameter in a bed, default 1e-3, spheres 5e-3; deeper\n"
    "                     beds have more pairs; overlap: of all pairs, default at random from 1e-4 to 5e-2\n"
    "  --steps N          in one repetition; rig: in all\n"
    "  --repetitions N    of each measurement; medians are told, and the spread (largest minus smallest)/median\n"
    "  --search-every N   steps between searches of candidate pairs in a bed, default 20; 0: none, for nothing moves\n"
    "  --order NAME       of the particles in a bed: lattice (default), morton or random\n"
    "  --savings          beds: each piece of avoided work is done after all, in turn\n"
    "  --scene FILE       of the rig, default scenes/calibration_rig_demo.yaml, or of scene\n"
    "  --set PATH=VALUE   scene: replaces a value of it; can be repeated\n"
    "  --parts N          scene: rows of the table, default 10\n"
    "  --threads N        default 1; scaling: compares one with N, default all\n"
    "  --device WHERE     packing, spheres: cpu, the default, or cuda or cuda:N; then all times are elapsed ones, and "
    "those\n"
    "                     of the stages are what the processor waits in them\n"
    "  --json FILE        writes the result; \"-\" for standard output, then without tables\n"
    "  --baseline FILE    prints ratios to a result that was written before, one of --json or several by name\n"
    "  --help             this text\n"
    "\n"
    "Times are those of the processor, of all threads together, where they are not called wall. Exit code: 0 if done, "
    "1\n"
    "if a file or a step failed, 2 if the command line or the input was refused.\n";

/// A benchmark and what it does unless told otherwise.
typedef struct bench_kind
{
    const char *name;
    scree_status (*run)(scree_bench *bench);
    int64_t particles, steps, repetitions;
} bench_kind;

static const bench_kind kinds[] = {
    {"overlap", scree_bench_overlap, 400, 1, 9},    {"broad-phase", scree_bench_broad_phase, 1000000, 1, 5},
    {"packing", scree_bench_packing, 20000, 20, 5}, {"spheres", scree_bench_spheres, 50000, 20, 7},
    {"rig", scree_bench_rig, 160, 10000, 1},        {"scaling", scree_bench_scaling, 100000, 20, 3},
    {"scene", scree_bench_scene, 0, 0, 1},
};
enum
{
    NUM_KINDS = sizeof kinds / sizeof *kinds
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
    else if (strcmp(option, "--baseline") == 0) request->baseline = value;
    else return refuse("unknown option ", option);
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

static bool parse_options(scree_bench_request *request, int argc, char **argv)
{
    for (int i = 2; i < argc; ++i)
    {
        if (strcmp(argv[i], "--savings") == 0) request->shows_savings = true;
        else if (strncmp(argv[i], "--", 2) != 0) return refuse("one benchmark at a time, what is ", argv[i]);
        else if (i + 1 == argc) return refuse("unknown option, or one that needs a value: ", argv[i]);
        else
        {
            if (!parse_valued(request, argv[i], argv[i + 1])) return false;
            ++i;
        }
    }
    const bool has_beds = strcmp(request->name, "packing") == 0 || strcmp(request->name, "spheres") == 0;
    if (request->device >= 0 && (!has_beds || request->shows_savings))
        return refuse("a GPU is measured in packing and spheres, without --savings, not in ", request->name);
    return true;
}

/// The result to a file or to standard output.
static scree_status write_json(const scree_bench *bench)
{
    json_t *result = json_pack("{s:s, s:s, s:o, s:O}", "bench", bench->request->name, "version", SCREE_VERSION,
                               "machine", scree_bench_machine(), "cases", bench->cases);
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
    scree_status status = kind->run(&bench);
    if (status == SCREE_OK && request->json != NULL) status = write_json(&bench);
    if (status == SCREE_OK && request->baseline != NULL) status = scree_bench_compare(&bench, request->baseline);
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
                                   .threads = 1,
                                   .device = -1};
    int exit_code = SCREE_EXIT_USAGE;
    if (request.overrides == NULL) exit_code = SCREE_EXIT_FAILED;
    else if (parse_options(&request, argc, argv)) exit_code = run_benchmark(kind, &request);
    free(request.overrides);
    if (fflush(stdout) != 0 && exit_code == SCREE_EXIT_DONE)
    {
        fprintf(stderr, "scree bench: standard output could not be written\n");
        exit_code = SCREE_EXIT_FAILED;
    }
    return exit_code;
}
