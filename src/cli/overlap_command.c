/// \file overlap_command.c
/// scree overlap: the overlap of two posed meshes, and batches of them.
#include "cli/commands.h"
#include "cli/mesh_argument.h"
#include "cli/overlap_json.h"
#include "polyhedra/import.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: scree overlap [options] A B\n"
    "       scree overlap --batch CASES [-o RESULTS] [options]\n"
    "\n"
    "Volume, centroid, area vector, normal, indentation and certificate of the overlap of two closed meshes.\n"
    "A and B are mesh files (OBJ, STL, PLY, OFF) or\n" SCREE_GENERATOR_HELP "\n"
    "  --position-a X,Y,Z       where A is put [m]; likewise --position-b\n"
    "  --orientation-a W,X,Y,Z  quaternion of A, used as given; likewise --orientation-b\n"
    "  --scale-a S              A times S, before turning and shifting; likewise --scale-b\n"
    "  --scheme NAME            filtered (default) or hierarchy\n"
    "  --patches                the connected pieces of the overlap one by one, beside their sum\n"
    "  --json                   the result as JSON\n"
    "  --batch CASES            one case a line, \"-\" for standard input:\n"
    "                             {\"id\": \"1\", \"a\": BODY, \"b\": BODY}, BODY one of\n"
    "                             {\"mesh\": \"file.obj\", \"scale\": 1, \"position\": [x,y,z], \"orientation\": "
    "[w,x,y,z]}\n"
    "                             {\"vertices\": [[x,y,z], ...], \"triangles\": [[i,j,k], ...]} in world coordinates\n"
    "  -o RESULTS               where the results of a batch go, one a line; default standard output\n"
    "  --help                   this text\n"
    "\n"
    "The area vector is that of A's surface inside B; the normal is its direction, out of A into B. A world vertex is\n"
    "((R0 x + R1 y) + R2 z) + t in plain doubles, x, y, z already scaled; these coordinates decide exactly.\n"
    "status: touching; none (no common volume); no_normal (a volume at noise level, or one body inside the other).\n"
    "Exit code: 0 if done, 1 if a case of a batch or a file failed, 2 if the input or the command line was refused.\n";

/// The command line, understood.
typedef struct overlap_request
{
    const char *inputs[2];
    int num_inputs;
    scree_posed_mesh pose[2]; ///< mesh NULL
    scree_overlap_options options;
    const char *batch;
    const char *output;
    bool is_json;
    bool wants_help;
} overlap_request;

/// "x,y,z" and the like: exactly `num` finite numbers.
static bool parse_numbers(const char *text, double *values, int num)
{
    for (int k = 0; k < num; ++k)
    {
        char one[64];
        const size_t length = strcspn(text, ",");
        if (length >= sizeof one) return false;
        memcpy(one, text, length);
        one[length] = '\0';
        if (!scree_parse_number(one, values + k)) return false;
        text += length;
        if (k + 1 < num && *text++ != ',') return false;
    }
    return *text == '\0';
}

/// An option with a value. False, with a message, if it is unknown or its value is wrong.
static bool parse_valued(overlap_request *request, const char *option, const char *value)
{
    const size_t length = strlen(option);
    const int which = option[length - 1] == 'b';
    const char *wanted = NULL;
    if (strcmp(option, "--batch") == 0) request->batch = value;
    else if (strcmp(option, "-o") == 0) request->output = value;
    else if (strcmp(option, "--scheme") == 0)
    {
        request->options.scheme = strcmp(value, "hierarchy") == 0 ? SCREE_OVERLAP_HIERARCHY : SCREE_OVERLAP_FILTERED;
        if (strcmp(value, "hierarchy") != 0 && strcmp(value, "filtered") != 0) wanted = "filtered or hierarchy";
    }
    else if (strncmp(option, "--position-", 11) == 0)
    {
        if (!parse_numbers(value, request->pose[which].position, 3)) wanted = "three numbers X,Y,Z";
    }
    else if (strncmp(option, "--orientation-", 14) == 0)
    {
        if (!parse_numbers(value, request->pose[which].orientation, 4)) wanted = "four numbers W,X,Y,Z";
    }
    else if (!scree_parse_number(value, &request->pose[which].scale) || !(request->pose[which].scale > 0))
        wanted = "a number > 0";
    if (wanted != NULL) fprintf(stderr, "scree overlap: %s %s: it must be %s\n", option, value, wanted);
    return wanted == NULL;
}

static bool takes_value(const char *option)
{
    static const char *const known[] = {"--batch",         "-o",           "--scheme",
                                        "--position-a",    "--position-b", "--orientation-a",
                                        "--orientation-b", "--scale-a",    "--scale-b"};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; ++k)
        if (strcmp(option, known[k]) == 0) return true;
    return false;
}

static bool parse_command_line(overlap_request *request, int argc, char **argv)
{
    for (int i = 1; i < argc; ++i)
    {
        const char *argument = argv[i];
        if (strcmp(argument, "--json") == 0) request->is_json = true;
        else if (strcmp(argument, "--patches") == 0) request->options.separate_patches = true;
        else if (strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0) request->wants_help = true;
        else if (takes_value(argument))
        {
            if (i + 1 == argc)
            {
                fprintf(stderr, "scree overlap: %s needs a value; see scree overlap --help\n", argument);
                return false;
            }
            if (!parse_valued(request, argument, argv[++i])) return false;
        }
        else if (argument[0] == '-' && argument[1] != '\0')
        {
            fprintf(stderr, "scree overlap: unknown option %s; see scree overlap --help\n", argument);
            return false;
        }
        else if (request->num_inputs < 2) request->inputs[request->num_inputs++] = argument;
        else ++request->num_inputs;
    }
    if (request->wants_help || (request->batch != NULL && request->num_inputs == 0)) return true;
    if (request->batch == NULL && request->num_inputs == 2) return true;
    fprintf(stderr, "scree overlap: %d meshes given; it takes two, or --batch and none; see scree overlap --help\n",
            request->num_inputs);
    return false;
}

static void print_vector(const char *label, scree_vec3 v, const char *unit)
{
    printf("  %-14s %-24.17g %-24.17g %-24.17g %s\n", label, (double)v.x, (double)v.y, (double)v.z, unit);
}

static void print_result(const scree_overlap_result *r)
{
    printf("  %-14s %s\n", "status", scree_overlap_status_text(r->status));
    if (r->status == SCREE_OVERLAP_NONE) return;
    printf("  %-14s %.17g m^3\n", "volume", (double)r->volume);
    print_vector("centroid", r->arm, "m");
    print_vector("area vector", r->area_vector, "m^2");
    if (r->status == SCREE_OVERLAP_TOUCHING)
    {
        print_vector("normal", r->normal, "");
        printf("  %-14s %.17g m\n", "indentation", (double)r->indentation);
    }
    printf("  %-14s %.3g\n", "residual", (double)r->residual);
}

static void print_results(const overlap_request *request, const scree_overlap_result *results, int32_t num)
{
    if (request->is_json)
    {
        json_t *json = scree_overlap_to_json(results, num, request->options.separate_patches);
        json_dumpf(json, stdout, JSON_REAL_PRECISION(17) | JSON_INDENT(2));
        putchar('\n');
        json_decref(json);
        return;
    }
    printf("overlap of %s and %s\n", request->inputs[0], request->inputs[1]);
    if (num == 0) printf("  %-14s none\n", "status");
    for (int32_t r = 0; r < num; ++r)
    {
        if (num > 1) printf(" patch %d of %d\n", r + 1, num);
        print_result(results + r);
    }
}

/// Mesh `which` of the command line in world coordinates.
static scree_status make_world_mesh(overlap_request *request, int which, scree_mesh *world, scree_report *report)
{
    const char *name = request->inputs[which];
    scree_mesh mesh = {0};
    scree_status status = scree_mesh_is_generated(name) ? scree_mesh_generate(&mesh, name, report)
                                                        : scree_mesh_import(&mesh, name, report);
    request->pose[which].mesh = &mesh;
    if (status == SCREE_OK) status = scree_posed_mesh_place(&request->pose[which], world);
    if (status == SCREE_OK) status = scree_mesh_validate(world, name, report);
    scree_mesh_destroy(&mesh);
    return status;
}

static int run_pair(overlap_request *request)
{
    scree_report report = {0};
    scree_mesh world[2] = {{0}, {0}};
    scree_status status = make_world_mesh(request, 0, &world[0], &report);
    const scree_status other = make_world_mesh(request, 1, &world[1], &report);
    if (status == SCREE_OK) status = other;
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    if (workspace == NULL) status = SCREE_OUT_OF_MEMORY;
    scree_overlap_result results[SCREE_MAX_PATCHES];
    int32_t num_results = 0;
    if (status == SCREE_OK)
        status = scree_overlap_of_meshes(&world[0], &world[1], &request->options, workspace, results, &num_results);
    if (status == SCREE_OK) print_results(request, results, num_results);
    else if (scree_report_num_faults(&report) == 0) scree_report_add(&report, "%s", scree_status_text(status));
    scree_print_report(&report);
    scree_report_clear(&report);
    scree_overlap_workspace_destroy(workspace);
    scree_mesh_destroy(&world[0]);
    scree_mesh_destroy(&world[1]);
    if (status == SCREE_OK) return SCREE_EXIT_DONE;
    return status == SCREE_BAD_MESH || status == SCREE_INVALID_INPUT ? SCREE_EXIT_USAGE : SCREE_EXIT_FAILED;
}

int scree_overlap_command(int argc, char **argv)
{
    overlap_request request = {.output = "-"};
    request.pose[0] = scree_posed_mesh_default(NULL);
    request.pose[1] = scree_posed_mesh_default(NULL);
    request.options.use_convex_path = true;
    if (!parse_command_line(&request, argc, argv)) return SCREE_EXIT_USAGE;
    if (request.wants_help)
    {
        fputs(usage, stdout);
        return SCREE_EXIT_DONE;
    }
    if (request.batch != NULL) return scree_overlap_batch(request.batch, request.output, &request.options);
    return run_pair(&request);
}
