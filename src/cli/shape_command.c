/// \file shape_command.c
/// scree shape: what a mesh is worth as a body. Reads or generates meshes, tells their measures or why they are
/// refused, simplifies them, scales them, writes them.
#include "cli/commands.h"
#include "cli/mesh_argument.h"
#include "polyhedra/import.h"
#include "polyhedra/mesh_edges.h"
#include "polyhedra/shape.h"
#include "polyhedra/simplify.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: scree shape [options] FILE...\n"
    "\n"
    "Tells whether each mesh (OBJ, STL, PLY, OFF) can be a body, and its measures.\n"
    "Lengths are in metres, as scree takes the numbers of the file; inertia is at unit density.\n"
    "\n"
    "  --generate SPEC   make a mesh instead of reading one; SPEC is one of\n" SCREE_GENERATOR_HELP
    "  --simplify N      reduce to about N triangles, keeping the volume\n"
    "  --volume V        scale to the volume V [m^3] about the centroid\n"
    "  -o FILE           write the resulting mesh as OBJ (one input only)\n"
    "  --json            tell everything as a JSON array, one object for each input\n"
    "  --help            this text\n"
    "\n"
    "Exit code: 0 if every mesh is a valid body, 1 if one could not be read or written, 2 if one was refused or the\n"
    "command line is wrong.\n";

/// The command line, understood.
typedef struct shape_request
{
    const char **inputs; ///< (num_inputs) files and specifications
    bool *is_generated;  ///< (num_inputs)
    int num_inputs;
    int64_t num_triangles; ///< 0: as it is
    double volume;         ///< 0: as it is
    const char *output;
    bool is_json;
    bool wants_help;
} shape_request;

/// One mesh with all that is told about it.
typedef struct shape_result
{
    const char *name;
    scree_status status;
    scree_report report;
    scree_mesh mesh;
    scree_mass_properties properties;
    scree_box box;
    double middle_size; ///< in the body frame
    double edge_range[2];
    double rounding; ///< of the importer; 0 for a generated mesh
    int32_t num_pieces;
    int64_t euler; ///< V - E + F
    bool is_convex;
} shape_result;

static bool parse_count(const char *text, int64_t low, int64_t high, int64_t *value)
{
    char *end;
    errno = 0;
    const long long number = strtoll(text, &end, 10);
    *value = number;
    return errno == 0 && end != text && *end == '\0' && number >= low && number <= high;
}

/// The value that follows option argv[*i]; NULL, with a message, at the end of the line.
static const char *option_value(int argc, char **argv, int *i)
{
    if (*i + 1 < argc) return argv[++*i];
    fprintf(stderr, "scree shape: %s needs a value; see scree shape --help\n", argv[*i]);
    return NULL;
}

static bool parse_option(shape_request *request, int argc, char **argv, int *i)
{
    const char *option = argv[*i];
    if (strcmp(option, "--json") == 0) return request->is_json = true;
    if (strcmp(option, "--help") == 0 || strcmp(option, "-h") == 0) return request->wants_help = true;
    const bool is_known = strcmp(option, "--generate") == 0 || strcmp(option, "--simplify") == 0 ||
                          strcmp(option, "--volume") == 0 || strcmp(option, "-o") == 0 ||
                          strcmp(option, "--output") == 0;
    if (!is_known)
    {
        fprintf(stderr, "scree shape: unknown option %s; see scree shape --help\n", option);
        return false;
    }
    const char *value = option_value(argc, argv, i);
    if (value == NULL) return false;
    if (strcmp(option, "--generate") == 0)
    {
        request->is_generated[request->num_inputs] = true;
        request->inputs[request->num_inputs++] = value;
    }
    else if (strcmp(option, "--simplify") == 0)
    {
        if (parse_count(value, 4, INT32_MAX, &request->num_triangles)) return true;
        fprintf(stderr, "scree shape: --simplify %s: the number of triangles must be a whole number >= 4\n", value);
        return false;
    }
    else if (strcmp(option, "--volume") == 0)
    {
        if (scree_parse_number(value, &request->volume) && request->volume > 0.0) return true;
        fprintf(stderr, "scree shape: --volume %s: the volume [m^3] must be a number > 0\n", value);
        return false;
    }
    else request->output = value;
    return true;
}

static bool parse_command_line(shape_request *request, int argc, char **argv)
{
    bool is_file_only = false;
    for (int i = 1; i < argc; ++i)
    {
        if (!is_file_only && strcmp(argv[i], "--") == 0) is_file_only = true;
        else if (!is_file_only && argv[i][0] == '-' && argv[i][1] != '\0')
        {
            if (!parse_option(request, argc, argv, &i)) return false;
        }
        else request->inputs[request->num_inputs++] = argv[i];
    }
    if (request->wants_help) return true;
    if (request->num_inputs == 0)
    {
        fprintf(stderr, "scree shape: no mesh given; see scree shape --help\n");
        return false;
    }
    if (request->output != NULL && request->num_inputs > 1)
    {
        fprintf(stderr, "scree shape: -o takes one mesh, but %d are given\n", request->num_inputs);
        return false;
    }
    return true;
}

static void measure_edges(shape_result *result)
{
    const scree_mesh *mesh = &result->mesh;
    result->edge_range[0] = INFINITY;
    for (int32_t i = 0; i < mesh->num_triangles; ++i)
    {
        for (int k = 0; k < 3; ++k)
        {
            const scree_vec3 p = mesh->vertices[mesh->triangles[i].v[k]];
            const scree_vec3 q = mesh->vertices[mesh->triangles[i].v[(k + 1) % 3]];
            const double length = (double)scree_vec3_length(scree_vec3_sub(q, p));
            if (length < result->edge_range[0]) result->edge_range[0] = length;
            if (length > result->edge_range[1]) result->edge_range[1] = length;
        }
    }
}

static scree_status measure(shape_result *result)
{
    scree_shape shape;
    const scree_mesh *mesh = &result->mesh;
    const scree_status status = scree_shape_create(&shape, mesh, SCREE_FRAME_PRINCIPAL);
    if (status != SCREE_OK) return status;
    result->middle_size = shape.middle_size;
    result->is_convex = shape.view.is_convex;
    result->box = scree_mesh_box(mesh);
    scree_mass_properties_compute(mesh, &result->properties);
    measure_edges(result);
    int32_t *labels = malloc(2 * (size_t)mesh->num_triangles * sizeof *labels);
    if (labels != NULL)
        result->num_pieces = scree_mesh_label_pieces(mesh, shape.neighbours, labels, labels + mesh->num_triangles);
    result->euler = mesh->num_vertices - 3 * (int64_t)mesh->num_triangles / 2 + mesh->num_triangles;
    free(labels);
    scree_shape_destroy(&shape);
    return labels != NULL ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

/// Everything that is asked for one input, up to its measures and its output file.
static void work_on(shape_result *result, const shape_request *request, bool is_generated)
{
    result->status = is_generated ? scree_mesh_generate(&result->mesh, result->name, &result->report)
                                  : scree_mesh_import(&result->mesh, result->name, &result->report);
    if (result->status != SCREE_OK) return;
    if (!is_generated) result->rounding = scree_mesh_import_rounding(&result->mesh);
    if (request->num_triangles > 0 || request->volume > 0.0)
    {
        const int32_t num = request->num_triangles > 0 ? (int32_t)request->num_triangles : result->mesh.num_triangles;
        result->status = scree_mesh_simplify(&result->mesh, num, request->volume, &result->report);
        if (result->status != SCREE_OK) return;
    }
    // also proves what the generators and the simplification promise
    result->status = scree_mesh_validate(&result->mesh, result->name, &result->report);
    if (result->status != SCREE_OK) return;
    result->status = measure(result);
    if (result->status != SCREE_OK || request->output == NULL) return;
    result->status = scree_mesh_export_obj(&result->mesh, request->output, &result->report);
}

static void print_line(const char *label, const char *unit, const double *values, int num)
{
    printf("  %-24s", label);
    for (int k = 0; k < num; ++k) printf(" %-16.9g", values[k]);
    printf(" %s\n", unit);
}

static void print_text(const shape_result *r)
{
    printf("%s\n", r->name);
    if (r->status == SCREE_OK)
    {
        const scree_mass_properties *p = &r->properties;
        const scree_vec3 e = scree_vec3_sub(r->box.upper, r->box.lower);
        const double extents[3] = {(double)e.x, (double)e.y, (double)e.z};
        printf("  %-24s closed, oriented outwards, no self-intersection\n", "surface");
        printf("  %-24s %d triangles, %d vertices\n", "mesh", r->mesh.num_triangles, r->mesh.num_vertices);
        printf("  %-24s %d\n  %-24s %" PRId64 "\n", "pieces", r->num_pieces, "handles", r->num_pieces - r->euler / 2);
        printf("  %-24s %s\n", "convex", r->is_convex ? "yes" : "no");
        print_line("volume", "m^3", &p->volume, 1);
        print_line("area", "m^2", &p->area, 1);
        print_line("centroid", "m", p->centroid, 3);
        print_line("box", "m", extents, 3);
        print_line("middle size (body frame)", "m", &r->middle_size, 1);
        print_line("bounding radius", "m", &p->bounding_radius, 1);
        print_line("edges, from and to", "m", r->edge_range, 2);
        print_line("principal moments", "m^5", p->principal, 3);
        print_line("principal axes (w x y z)", "", p->principal_axes, 4);
        if (r->rounding > 0.0)
            printf("  %-24s read in single precision: coordinates within %.2g m of the file's\n", "precision",
                   r->rounding);
    }
    else printf("  refused: %s\n", scree_status_text(r->status));
    fflush(stdout);
    scree_print_report(&r->report);
}

static void print_json_string(const char *text)
{
    putchar('"');
    for (; *text != '\0'; ++text)
    {
        const unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\') printf("\\%c", c);
        else if (c < 0x20) printf("\\u%04x", c);
        else putchar(c);
    }
    putchar('"');
}

static void print_json_numbers(const char *key, const double *values, int num)
{
    printf("    \"%s\": %s", key, num > 1 ? "[" : "");
    for (int k = 0; k < num; ++k) printf("%s%.17g", k > 0 ? ", " : "", values[k]);
    printf("%s,\n", num > 1 ? "]" : "");
}

static void print_json_measures(const shape_result *r)
{
    const scree_mass_properties *p = &r->properties;
    const double lower[3] = {(double)r->box.lower.x, (double)r->box.lower.y, (double)r->box.lower.z};
    const double upper[3] = {(double)r->box.upper.x, (double)r->box.upper.y, (double)r->box.upper.z};
    printf("    \"num_triangles\": %d,\n    \"num_vertices\": %d,\n", r->mesh.num_triangles, r->mesh.num_vertices);
    printf("    \"num_pieces\": %d,\n    \"euler_characteristic\": %" PRId64 ",\n", r->num_pieces, r->euler);
    printf("    \"is_convex\": %s,\n", r->is_convex ? "true" : "false");
    print_json_numbers("volume", &p->volume, 1);
    print_json_numbers("area", &p->area, 1);
    print_json_numbers("centroid", p->centroid, 3);
    print_json_numbers("box_lower", lower, 3);
    print_json_numbers("box_upper", upper, 3);
    print_json_numbers("middle_size", &r->middle_size, 1);
    print_json_numbers("bounding_radius", &p->bounding_radius, 1);
    print_json_numbers("edge_range", r->edge_range, 2);
    printf("    \"inertia\": [");
    for (int i = 0; i < 3; ++i)
        printf("%s[%.17g, %.17g, %.17g]", i > 0 ? ", " : "", p->inertia[i][0], p->inertia[i][1], p->inertia[i][2]);
    printf("],\n");
    print_json_numbers("principal_moments", p->principal, 3);
    print_json_numbers("principal_axes", p->principal_axes, 4);
    print_json_numbers("import_rounding", &r->rounding, 1);
}

static void print_json(const shape_result *r, bool is_first, bool is_last)
{
    printf("%s  {\n    \"name\": ", is_first ? "[\n" : "");
    print_json_string(r->name);
    printf(",\n    \"is_valid\": %s,\n", r->status == SCREE_OK ? "true" : "false");
    if (r->status == SCREE_OK) print_json_measures(r);
    printf("    \"status\": ");
    print_json_string(scree_status_text(r->status));
    printf(",\n    \"messages\": [");
    for (int i = 0; i < r->report.num_messages; ++i)
    {
        printf("%s", i > 0 ? ", " : "");
        print_json_string(r->report.messages[i]);
    }
    printf("]\n  }%s\n", is_last ? "\n]" : ",");
}

static int exit_code_of(scree_status status)
{
    if (status == SCREE_OK) return SCREE_EXIT_DONE;
    return status == SCREE_BAD_MESH || status == SCREE_INVALID_INPUT ? SCREE_EXIT_USAGE : SCREE_EXIT_FAILED;
}

static int run(const shape_request *request)
{
    int exit_code = SCREE_EXIT_DONE;
    for (int i = 0; i < request->num_inputs; ++i)
    {
        shape_result result = {.name = request->inputs[i]};
        work_on(&result, request, request->is_generated[i]);
        if (request->is_json) print_json(&result, i == 0, i == request->num_inputs - 1);
        else print_text(&result);
        if (exit_code_of(result.status) > exit_code) exit_code = exit_code_of(result.status);
        scree_mesh_destroy(&result.mesh);
        scree_report_clear(&result.report);
    }
    return exit_code;
}

int scree_shape_command(int argc, char **argv)
{
    shape_request request = {0};
    request.inputs = calloc((size_t)argc + 1, sizeof *request.inputs);
    request.is_generated = calloc((size_t)argc + 1, sizeof *request.is_generated);
    int exit_code = SCREE_EXIT_FAILED;
    if (request.inputs == NULL || request.is_generated == NULL)
        fprintf(stderr, "scree shape: %s\n", scree_status_text(SCREE_OUT_OF_MEMORY));
    else if (!parse_command_line(&request, argc, argv)) exit_code = SCREE_EXIT_USAGE;
    else if (request.wants_help)
    {
        fputs(usage, stdout);
        exit_code = SCREE_EXIT_DONE;
    }
    else exit_code = run(&request);
    free(request.inputs);
    free(request.is_generated);
    return exit_code;
}
