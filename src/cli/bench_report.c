/// \file bench_report.c
/// Tables, samples, the machine, and comparison with a baseline.
#define _POSIX_C_SOURCE 200809L
#include "cli/bench.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double read_clock(clockid_t id)
{
    struct timespec t;
    clock_gettime(id, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double scree_bench_core_seconds(void) { return read_clock(CLOCK_PROCESS_CPUTIME_ID); }

double scree_bench_wall_seconds(void) { return read_clock(CLOCK_MONOTONIC); }

double scree_bench_uniform(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void scree_bench_sort(scree_bench_samples samples)
{
    qsort(samples.values, (size_t)samples.num, sizeof *samples.values, compare_numbers);
}

double scree_bench_median(scree_bench_samples samples)
{
    return 0.5 * (samples.values[(samples.num - 1) / 2] + samples.values[samples.num / 2]);
}

double scree_bench_spread(scree_bench_samples samples)
{
    const double middle = scree_bench_median(samples);
    return middle > 0 ? (samples.values[samples.num - 1] - samples.values[0]) / middle : 0;
}

void scree_bench_set_noise(json_t *measured, const char *key, scree_bench_samples samples)
{
    if (samples.num > 1) json_object_set_new(measured, key, json_real(scree_bench_spread(samples)));
}

/// Value of "a.b.c" in a case, or NULL.
static const json_t *find_value(const json_t *object, const char *key)
{
    char part[64];
    while (object != NULL)
    {
        const size_t length = strcspn(key, ".");
        if (length >= sizeof part) return NULL;
        memcpy(part, key, length);
        part[length] = '\0';
        object = json_object_get(object, part);
        if (key[length] == '\0') return object;
        key += length + 1;
    }
    return NULL;
}

void scree_bench_set_columns(scree_bench *bench, const scree_bench_column *columns, int num_columns)
{
    bench->columns = columns;
    bench->num_columns = num_columns;
    bench->has_header = false;
}

static void print_header(scree_bench *bench)
{
    for (int k = 0; k < bench->num_columns; ++k) printf("%s%s", k > 0 ? "  " : "", bench->columns[k].header);
    putchar('\n');
    bench->has_header = true;
}

scree_status scree_bench_add(scree_bench *bench, json_t *measured)
{
    if (measured == NULL || json_array_append_new(bench->cases, measured) != 0) return SCREE_OUT_OF_MEMORY;
    if (bench->is_quiet) return SCREE_OK;
    if (!bench->has_header) print_header(bench);
    for (int k = 0; k < bench->num_columns; ++k)
    {
        const scree_bench_column *column = bench->columns + k;
        const json_t *value = find_value(measured, column->key);
        const int width = (int)strlen(column->header);
        if (k > 0) fputs("  ", stdout);
        if (column->factor == 0) printf("%-*s", width, json_is_string(value) ? json_string_value(value) : "");
        else if (value == NULL) printf("%*s", width, "-");
        else printf("%*.*f", width, column->decimals, column->factor * json_number_value(value));
    }
    putchar('\n');
    fflush(stdout);
    return SCREE_OK;
}

/// Name of the processor as the system tells it, or "unknown".
static void read_processor(char *name, size_t size)
{
    snprintf(name, size, "unknown");
    FILE *file = fopen("/proc/cpuinfo", "r");
    if (file == NULL) return;
    char line[256];
    while (fgets(line, sizeof line, file) != NULL)
    {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || colon == NULL) continue;
        snprintf(name, size, "%.*s", (int)strcspn(colon + 2, "\n"), colon + 2);
        break;
    }
    fclose(file);
}

json_t *scree_bench_machine(void)
{
    char processor[128];
    read_processor(processor, sizeof processor);
#ifdef __clang__
    const char *compiler = "Clang " __clang_version__;
#else
    const char *compiler = "GCC " __VERSION__;
#endif
    return json_pack("{s:s, s:i, s:s, s:s}", "processor", processor, "processors", omp_get_num_procs(), "compiler",
                     compiler, "precision", sizeof(scree_real) == sizeof(double) ? "double" : "single");
}

/// Is what a case was measured on the same in both? Numbers in a file have six digits.
static bool is_same_value(const json_t *a, const json_t *b)
{
    if (a == NULL || b == NULL) return a == b;
    if (!json_is_real(a) && !json_is_real(b)) return json_equal(a, b) != 0;
    return fabs(json_number_value(a) - json_number_value(b)) <= 1e-5 * fabs(json_number_value(b));
}

/// The case of the same name and settings.
static const json_t *find_case(const json_t *cases, const json_t *wanted)
{
    static const char *const keys[] = {"name", "threads", "particles", "steps", "order", "depth", "search_every"};
    size_t k;
    const json_t *one;
    json_array_foreach(cases, k, one)
    {
        bool is_same = true;
        for (size_t n = 0; n < sizeof keys / sizeof *keys; ++n)
            is_same = is_same && is_same_value(json_object_get(one, keys[n]), json_object_get(wanted, keys[n]));
        if (is_same) return one;
    }
    return NULL;
}

/// "2.5 %", or that it is not known.
static const char *noise_text(const json_t *one, char *text, size_t size)
{
    const json_t *spread = json_object_get(one, "spread");
    if (spread == NULL) return "unknown (measured once)";
    snprintf(text, size, "%.0f %%", 100 * json_number_value(spread));
    return text;
}

/// Number of cases that the baseline lacks.
static int print_ratios(const scree_bench *bench, const json_t *then)
{
    size_t k;
    const json_t *now;
    int num_missing = 0;
    json_array_foreach(bench->cases, k, now)
    {
        const char *name = json_string_value(json_object_get(now, "name"));
        const json_t *old = find_case(json_object_get(then, "cases"), now);
        if (old == NULL)
        {
            printf("%-36s not in the baseline\n", name);
            ++num_missing;
            continue;
        }
        const double ratio = json_number_value(json_object_get(now, "core_seconds")) /
                             json_number_value(json_object_get(old, "core_seconds"));
        char texts[2][32];
        printf("%-36s %6.3f of the baseline; spread %s now, %s then\n", name, ratio,
               noise_text(now, texts[0], sizeof texts[0]), noise_text(old, texts[1], sizeof texts[1]));
    }
    return num_missing;
}

scree_status scree_bench_read_baseline(const scree_bench_request *request, json_t **baseline, scree_report *report)
{
    json_error_t fault;
    const char *path = request->baseline;
    json_t *file = json_load_file(path, 0, &fault);
    if (file == NULL)
    {
        if (fault.line > 0) scree_report_add(report, "--baseline %s, line %d: %s", path, fault.line, fault.text);
        else scree_report_add(report, "--baseline %s: %s", path, fault.text);
        return SCREE_READ_FAILED;
    }
    // a file of one benchmark, or of several by name
    json_t *then = json_object_get(file, request->name);
    *baseline = json_incref(then != NULL ? then : file);
    json_decref(file);
    const json_t *of = json_object_get(*baseline, "bench"), *machine = json_object_get(*baseline, "machine");
    if (json_is_array(json_object_get(*baseline, "cases")) && json_is_string(json_object_get(machine, "processor")) &&
        json_is_string(of) && strcmp(json_string_value(of), request->name) == 0)
        return SCREE_OK;
    scree_report_add(report, "--baseline %s: no result of scree bench %s; make one with --json", path, request->name);
    json_decref(*baseline);
    *baseline = NULL;
    return SCREE_INVALID_INPUT;
}

void scree_bench_compare(const scree_bench *bench, const json_t *baseline)
{
    const json_t *machine = json_object_get(baseline, "machine"), *options = json_object_get(baseline, "options");
    json_t *here = scree_bench_machine();
    printf("\nbaseline of %s, made by: scree bench %s", json_string_value(json_object_get(machine, "processor")),
           bench->request->name);
    size_t k;
    const json_t *word;
    json_array_foreach(options, k, word) printf(" %s", json_string_value(word));
    putchar('\n');
    if (!json_equal(machine, here)) printf("  made on another machine, or with another compiler\n");
    json_decref(here);
    const int num_missing = print_ratios(bench, baseline);
    if (num_missing > 0)
        printf(
            "%d of %zu not in the baseline: compare with the options that it was made by, given above, or make one of "
            "your own with --json\n",
            num_missing, json_array_size(bench->cases));
}
