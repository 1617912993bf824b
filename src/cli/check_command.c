/// \file check_command.c
/// scree check: is a scene right, and what would running it mean? Nothing is written.
#include "cli/commands.h"
#include "cli/device_argument.h"
#include "dynamics/on_device.h"
#include "dynamics/time_step.h"
#include "scree/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: scree check [options] SCENE\n"
    "\n"
    "Reads a scene, makes its particles and walls at time 0, and prints the plan of the run: stages, memory, time "
    "step.\n"
    "All faults of a scene are told at once. Nothing is written.\n"
    "\n"
    "  --set PATH=VALUE  replaces a value of the scene, like time.end=2 or particles.fill.count=100; can be repeated\n"
    "  --device WHERE    cpu, cuda or cuda:N: also whether the scene fits into that NVIDIA GPU\n"
    "  --print           prints the scene with every default filled in instead of the plan\n"
    "  --help            this text\n"
    "\n"
    "The keys of scenes: scree --help scene. Exit code: 0 if the scene is right, 2 if it is refused, 1 if there is "
    "not\n"
    "enough memory or no such GPU.\n";

/// The command line, understood.
typedef struct check_request
{
    const char *path;
    const char **overrides; ///< (num_overrides)
    int num_overrides;
    int32_t device; ///< number of a GPU; -1: the CPU
    bool is_print_only;
    bool wants_help;
} check_request;

static bool refuse(const char *what, const char *argument)
{
    fprintf(stderr, "scree check: %s%s; see scree check --help\n", what, argument);
    return false;
}

static bool parse_command_line(check_request *request, int argc, char **argv)
{
    for (int i = 1; i < argc; ++i)
    {
        const char *argument = argv[i];
        if (strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0) return request->wants_help = true;
        if (strcmp(argument, "--print") == 0) request->is_print_only = true;
        else if (strcmp(argument, "--device") == 0 || strncmp(argument, "--device=", 9) == 0)
        {
            const char *value = argument[8] == '=' ? argument + 9 : ++i < argc ? argv[i] : "";
            if (!scree_parse_device(value, &request->device))
                return refuse("--device needs cpu, cuda or cuda:N, not ", value);
        }
        else if (strncmp(argument, "--set=", 6) == 0) request->overrides[request->num_overrides++] = argument + 6;
        else if (strcmp(argument, "--set") == 0)
        {
            if (++i == argc) return refuse("--set needs PATH=VALUE", "");
            request->overrides[request->num_overrides++] = argv[i];
        }
        else if (argument[0] == '-' && argument[1] != '\0') return refuse("unknown option ", argument);
        else if (request->path != NULL) return refuse("one scene at a time, what is ", argument);
        else request->path = argument;
    }
    return request->path != NULL || refuse("no scene given", "");
}

/// Groups that are told one by one; the others are counted.
#define MAX_GROUPS 20

/// How many particles of what mass each group has: of those filled in by mass or size nobody else tells.
static void print_groups(const scree_simulation *simulation)
{
    const scree_particles *p = &simulation->particles;
    const uint32_t num_groups = simulation->scene->num_particles;
    for (uint32_t g = 0; num_groups > 1 && g < num_groups && g < MAX_GROUPS; ++g)
    {
        int64_t num = 0;
        double mass = 0;
        for (int64_t i = 0; i < p->num_particles; ++i)
        {
            if (p->group[i] != (int32_t)g) continue;
            ++num;
            mass += (double)p->mass[i];
        }
        printf("    \"%s\" %lld, mass %.6g kg\n", simulation->scene->particles[g].name, (long long)num, mass);
    }
    if (num_groups > MAX_GROUPS) printf("    and %u more groups\n", num_groups - MAX_GROUPS);
}

/// What the plan leaves out: masses and the time step against what it should be.
static void print_measures(const scree_simulation *simulation)
{
    double mass = 0;
    for (int64_t i = 0; i < simulation->particles.num_particles; ++i) mass += (double)simulation->particles.mass[i];
    const double critical = scree_time_step_critical(simulation), step = scree_simulation_time_step(simulation);
    printf("  particles %lld, mass %.6g kg\n", (long long)scree_simulation_num_particles(simulation), mass);
    print_groups(simulation);
    printf("  contacts now %lld\n", (long long)scree_simulation_counters(simulation).num_contacts);
    printf("  time step %.4g s", step);
    if (isfinite(critical))
        printf(", %.3g of the critical step of %.4g s; suggested %.4g s", step / critical, critical,
               simulation->scene->time.step_fraction * critical);
    putchar('\n');
}

/// Does the scene fit into a GPU?
static scree_status check_device(const scree_simulation *simulation, int32_t number, scree_report *report)
{
    scree_device *device = NULL;
    scree_status status = scree_open_device(number, &device, report);
    if (status != SCREE_OK || device == NULL) return status;
    scree_simulation_print_device_memory(simulation, device, stdout);
    scree_device_close(device);
    return status;
}

static scree_status check_scene(const check_request *request, scree_scene_file *file, scree_report *report)
{
    scree_simulation *simulation = NULL;
    scree_status status = scree_scene_read(file, request->path, request->overrides, request->num_overrides, report);
    if (status != SCREE_OK) return status;
    if (request->is_print_only)
    {
        fputs(file->text, stdout);
        return status;
    }
    status = scree_simulation_create(&simulation, &file->scene, file->folder, report);
    if (status != SCREE_OK) return status;
    scree_simulation_print_plan(simulation, stdout);
    print_measures(simulation);
    status = check_device(simulation, request->device, report);
    scree_simulation_destroy(simulation);
    return status;
}

/// The last line, and the exit code. A machine or a build that lacks something is no fault of the scene.
static int conclude(const check_request *request, scree_status status, int num_faults)
{
    if (status == SCREE_OK) return SCREE_EXIT_DONE;
    if (num_faults == 0) fprintf(stderr, "scree check: %s\n", scree_status_text(status));
    if (status == SCREE_NO_DEVICE)
        fprintf(stderr, "%s: no fault found in the scene, but it cannot run on cuda:%d here\n", request->path,
                request->device);
    if (status == SCREE_OUT_OF_MEMORY || status == SCREE_NO_DEVICE) return SCREE_EXIT_FAILED;
    if (num_faults > 0)
        fprintf(stderr, "%s: refused, %d fault%s\n", request->path, num_faults, num_faults == 1 ? "" : "s");
    return SCREE_EXIT_USAGE;
}

int scree_check_command(int argc, char **argv)
{
    check_request request = {.device = -1, .overrides = calloc((size_t)argc + 1, sizeof(const char *))};
    if (request.overrides == NULL) return SCREE_EXIT_FAILED;
    int exit_code = SCREE_EXIT_USAGE;
    if (parse_command_line(&request, argc, argv))
    {
        exit_code = SCREE_EXIT_DONE;
        if (request.wants_help) fputs(usage, stdout);
        else
        {
            scree_scene_file file = {0};
            scree_report report = {0};
            const scree_status status = check_scene(&request, &file, &report);
            scree_print_report(&report);
            exit_code = conclude(&request, status, scree_report_num_faults(&report));
            scree_report_clear(&report);
            scree_scene_close(&file);
        }
    }
    free(request.overrides);
    if (fflush(stdout) != 0 && exit_code == SCREE_EXIT_DONE)
    {
        fprintf(stderr, "scree check: standard output could not be written\n");
        exit_code = SCREE_EXIT_FAILED;
    }
    return exit_code;
}
