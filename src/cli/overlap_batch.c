/// \file overlap_batch.c
/// scree overlap --batch: lines are read and parsed one after another, meshes named in them are imported once, a block
/// of cases is computed in parallel, and the results are written in the order of the cases.
#define _POSIX_C_SOURCE 200809L /* getline, strdup */
#include "cli/commands.h"
#include "cli/overlap_json.h"
#include "polyhedra/import.h"

#include <errno.h>
#include <omp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK 256

/// A file that has been imported, with what was said if it was refused.
typedef struct known_mesh
{
    char *path;
    scree_mesh mesh;
    char *fault; ///< NULL if the mesh is good
} known_mesh;

/// One line: the two bodies in world coordinates, then their overlap, or what is wrong with them.
typedef struct overlap_case
{
    json_t *id;
    scree_mesh mesh[2]; ///< in world coordinates
    bool is_checked[2]; ///< the mesh came from a file and was checked there
    char fault[2048];   ///< empty while all is well
    scree_overlap_result results[SCREE_MAX_PATCHES];
    int32_t num_results;
} overlap_case;

typedef struct overlap_batch
{
    const char *folder; ///< of the file of cases, for meshes that are not found from here
    known_mesh *known;
    size_t num_known;
    overlap_case *cases;                  ///< (BLOCK)
    scree_overlap_workspace **workspaces; ///< (num_workspaces) one per thread
    int num_workspaces;
    scree_overlap_options options;
    FILE *output;
    bool has_faults;
} overlap_batch;

static void fault(overlap_case *c, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// Keeps the first fault of a case.
static void fault(overlap_case *c, const char *format, ...)
{
    if (c->fault[0] != '\0') return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(c->fault, sizeof c->fault, format, arguments);
    va_end(arguments);
}

/// All faults of a report in one text.
static void fault_from_report(overlap_case *c, const scree_report *report, scree_status status)
{
    char text[sizeof c->fault] = "";
    for (int k = 0; k < report->num_messages; ++k)
    {
        if (strncmp(report->messages[k], "warning: ", 9) == 0) continue;
        const size_t length = strlen(text);
        snprintf(text + length, sizeof text - length, "%s%s", length > 0 ? "; " : "", report->messages[k]);
    }
    fault(c, "%s", text[0] != '\0' ? text : scree_status_text(status));
}

/// Reads `num` finite numbers; false if `json` is not a list of that many.
static bool read_numbers(const json_t *json, double *values, size_t num)
{
    if (!json_is_array(json) || json_array_size(json) != num) return false;
    for (size_t k = 0; k < num; ++k)
    {
        const json_t *item = json_array_get(json, k);
        if (!json_is_number(item)) return false;
        values[k] = json_number_value(item);
    }
    return true;
}

/// Imports a mesh file, or finds it among those imported before.
static known_mesh *find_mesh(overlap_batch *batch, const char *path)
{
    for (size_t k = 0; k < batch->num_known; ++k)
        if (strcmp(batch->known[k].path, path) == 0) return batch->known + k;
    known_mesh *grown = realloc(batch->known, (batch->num_known + 1) * sizeof *grown);
    if (grown == NULL) return NULL;
    batch->known = grown;
    known_mesh *known = grown + batch->num_known;
    memset(known, 0, sizeof *known);
    known->path = strdup(path);
    if (known->path == NULL) return NULL;
    ++batch->num_known;

    // as given from here; otherwise beside the file of cases
    char beside[4096];
    FILE *file = fopen(path, "rb");
    if (file != NULL) fclose(file);
    const int length = snprintf(beside, sizeof beside, "%s/%s", batch->folder, path);
    const bool is_beside = file == NULL && path[0] != '/' && length > 0 && (size_t)length < sizeof beside;
    scree_report report = {0};
    const scree_status status = scree_mesh_import(&known->mesh, is_beside ? beside : path, &report);
    if (status != SCREE_OK)
    {
        overlap_case refused = {.fault = ""};
        fault_from_report(&refused, &report, status);
        known->fault = strdup(refused.fault);
    }
    scree_report_clear(&report);
    return known;
}

/// "vertices" and "triangles" as they stand.
static void read_inline_mesh(overlap_case *c, const json_t *body, const char *name, scree_mesh *mesh)
{
    const json_t *vertices = json_object_get(body, "vertices"), *triangles = json_object_get(body, "triangles");
    if (!json_is_array(vertices) || !json_is_array(triangles))
    {
        fault(c, "%s: needs \"mesh\", or \"vertices\" and \"triangles\" as lists", name);
        return;
    }
    const size_t num_vertices = json_array_size(vertices), num_triangles = json_array_size(triangles);
    if (num_vertices > INT32_MAX / 8 || num_triangles > INT32_MAX / 8 ||
        scree_mesh_create(mesh, (int32_t)num_vertices, (int32_t)num_triangles) != SCREE_OK)
    {
        fault(c, "%s: %s", name, scree_status_text(SCREE_OUT_OF_MEMORY));
        return;
    }
    for (size_t v = 0; v < num_vertices; ++v)
    {
        double x[3];
        if (!read_numbers(json_array_get(vertices, v), x, 3))
        {
            fault(c, "%s: vertices[%zu] is not a list of three numbers", name, v);
            return;
        }
        mesh->vertices[v] = scree_vec3_make((scree_real)x[0], (scree_real)x[1], (scree_real)x[2]);
    }
    for (size_t t = 0; t < num_triangles; ++t)
        for (size_t k = 0; k < 3; ++k)
        {
            const json_t *corners = json_array_get(triangles, t);
            const json_t *index = json_array_get(corners, k);
            const json_int_t v = json_integer_value(index);
            if (json_array_size(corners) != 3 || !json_is_integer(index) || v < 0 || v >= (json_int_t)num_vertices)
            {
                fault(c, "%s: triangles[%zu] is not a list of three whole numbers in [0, %zu]", name, t,
                      num_vertices > 0 ? num_vertices - 1 : 0);
                return;
            }
            mesh->triangles[t].v[k] = (int32_t)v;
        }
}

/// Any of "scale", "position", "orientation" that stands beside a mesh.
static bool read_pose(overlap_case *c, const json_t *body, const char *name, scree_posed_mesh *posed)
{
    const json_t *scale = json_object_get(body, "scale"), *position = json_object_get(body, "position");
    const json_t *orientation = json_object_get(body, "orientation");
    if (scale != NULL) posed->scale = json_is_number(scale) ? json_number_value(scale) : 0;
    if (!(posed->scale > 0)) fault(c, "%s: scale must be a number > 0", name);
    if (position != NULL && !read_numbers(position, posed->position, 3))
        fault(c, "%s: position must be a list of three numbers", name);
    if (orientation != NULL && !read_numbers(orientation, posed->orientation, 4))
        fault(c, "%s: orientation must be a list of four numbers, w x y z", name);
    return c->fault[0] == '\0';
}

static void read_body(overlap_batch *batch, overlap_case *c, const json_t *line, int which)
{
    const char *name = which == 0 ? "a" : "b";
    const json_t *body = json_object_get(line, name), *path = json_object_get(body, "mesh");
    if (!json_is_object(body))
    {
        fault(c, "%s: missing, or not an object", name);
        return;
    }
    if (path == NULL)
    {
        read_inline_mesh(c, body, name, c->mesh + which);
        return;
    }
    if (!json_is_string(path))
    {
        fault(c, "%s: mesh must be the path of a file", name);
        return;
    }
    const known_mesh *known = find_mesh(batch, json_string_value(path));
    if (known == NULL || known->fault != NULL)
    {
        fault(c, "%s: %s", name, known == NULL ? scree_status_text(SCREE_OUT_OF_MEMORY) : known->fault);
        return;
    }
    scree_posed_mesh posed = scree_posed_mesh_default(&known->mesh);
    if (!read_pose(c, body, name, &posed)) return;
    if (scree_posed_mesh_place(&posed, c->mesh + which) != SCREE_OK)
        fault(c, "%s: %s", name, scree_status_text(SCREE_OUT_OF_MEMORY));
    c->is_checked[which] = true;
}

static void read_case(overlap_batch *batch, overlap_case *c, const char *text, size_t length, int64_t line_number)
{
    json_error_t error;
    json_t *line = json_loadb(text, length, JSON_REJECT_DUPLICATES, &error);
    const json_t *id = json_object_get(line, "id");
    c->id = id != NULL ? json_deep_copy(id) : json_integer(line_number);
    if (line == NULL) fault(c, "line %lld, column %d: %s", (long long)line_number, error.column, error.text);
    else if (!json_is_object(line)) fault(c, "line %lld: not an object with \"a\" and \"b\"", (long long)line_number);
    for (int which = 0; which < 2 && c->fault[0] == '\0'; ++which) read_body(batch, c, line, which);
    json_decref(line);
}

/// Checks what has not been checked, then the overlap.
static void compute_case(overlap_batch *batch, overlap_case *c, int thread)
{
    scree_report report = {0};
    for (int which = 0; which < 2 && c->fault[0] == '\0'; ++which)
    {
        if (c->is_checked[which]) continue;
        const scree_status status = scree_mesh_validate(c->mesh + which, which == 0 ? "a" : "b", &report);
        if (status != SCREE_OK) fault_from_report(c, &report, status);
    }
    if (c->fault[0] == '\0')
    {
        const scree_status status = scree_overlap_of_meshes(c->mesh, c->mesh + 1, &batch->options,
                                                            batch->workspaces[thread], c->results, &c->num_results);
        if (status != SCREE_OK) fault(c, "%s", scree_status_text(status));
    }
    scree_report_clear(&report);
}

/// Writes the result of one case and frees it. False if writing failed.
static bool write_case(overlap_batch *batch, overlap_case *c)
{
    json_t *line = json_object();
    json_object_set_new(line, "id", c->id);
    if (c->fault[0] != '\0')
    {
        json_object_set_new(line, "status", json_string("error"));
        // a name in the message that is not UTF-8 has no JSON
        json_t *message = json_string(c->fault);
        json_object_set_new(line, "message", message != NULL ? message : json_string("the input is not UTF-8"));
        batch->has_faults = true;
    }
    else
    {
        json_t *result = scree_overlap_to_json(c->results, c->num_results, batch->options.separate_patches);
        json_object_update(line, result);
        json_decref(result);
    }
    const bool is_written =
        json_dumpf(line, batch->output, JSON_REAL_PRECISION(17)) == 0 && fputc('\n', batch->output) != EOF;
    json_decref(line);
    scree_mesh_destroy(c->mesh);
    scree_mesh_destroy(c->mesh + 1);
    memset(c, 0, sizeof *c);
    return is_written;
}

static bool run_block(overlap_batch *batch, int num_cases)
{
#pragma omp parallel for schedule(dynamic, 4) num_threads(batch->num_workspaces)
    for (int k = 0; k < num_cases; ++k) compute_case(batch, batch->cases + k, omp_get_thread_num());
    bool is_written = true;
    for (int k = 0; k < num_cases; ++k) is_written = write_case(batch, batch->cases + k) && is_written;
    return is_written;
}

static bool is_blank(const char *text) { return text[strspn(text, " \t\r\n")] == '\0'; }

/// All lines of the input. Returns the exit code.
static int run_lines(overlap_batch *batch, FILE *input)
{
    char *text = NULL;
    size_t size = 0;
    int num_cases = 0;
    bool is_written = true;
    int64_t line_number = 0;
    for (ssize_t length; is_written && (length = getline(&text, &size, input)) >= 0;)
    {
        ++line_number;
        if (is_blank(text)) continue;
        read_case(batch, batch->cases + num_cases, text, (size_t)length, line_number);
        if (++num_cases < BLOCK) continue;
        is_written = run_block(batch, num_cases);
        num_cases = 0;
    }
    const bool is_read = !ferror(input);
    is_written = run_block(batch, num_cases) && is_written;
    is_written = fflush(batch->output) == 0 && is_written;
    free(text);
    if (!is_read) fprintf(stderr, "scree overlap: reading the cases failed after line %lld\n", (long long)line_number);
    if (!is_written) fprintf(stderr, "scree overlap: writing the results failed: %s\n", strerror(errno));
    return is_read && is_written && !batch->has_faults ? SCREE_EXIT_DONE : SCREE_EXIT_FAILED;
}

static bool allocate(overlap_batch *batch)
{
    batch->num_workspaces = omp_get_max_threads();
    batch->cases = calloc(BLOCK, sizeof *batch->cases);
    batch->workspaces = calloc((size_t)batch->num_workspaces, sizeof *batch->workspaces);
    if (batch->cases == NULL || batch->workspaces == NULL) return false;
    for (int t = 0; t < batch->num_workspaces; ++t)
        if ((batch->workspaces[t] = scree_overlap_workspace_create()) == NULL) return false;
    return true;
}

static void release(overlap_batch *batch)
{
    for (size_t k = 0; k < batch->num_known; ++k)
    {
        free(batch->known[k].path);
        free(batch->known[k].fault);
        scree_mesh_destroy(&batch->known[k].mesh);
    }
    for (int t = 0; batch->workspaces != NULL && t < batch->num_workspaces; ++t)
        scree_overlap_workspace_destroy(batch->workspaces[t]);
    free(batch->known);
    free(batch->workspaces);
    free(batch->cases);
}

int scree_overlap_batch(const char *input_path, const char *output_path, const scree_overlap_options *options)
{
    char folder[4096];
    const char *slash = strrchr(input_path, '/');
    snprintf(folder, sizeof folder, "%.*s", slash != NULL ? (int)(slash - input_path) : 1,
             slash != NULL ? input_path : ".");
    overlap_batch batch = {.folder = folder, .options = *options};
    FILE *input = strcmp(input_path, "-") == 0 ? stdin : fopen(input_path, "r");
    if (input == NULL)
    {
        fprintf(stderr, "scree overlap: cannot read %s: %s\n", input_path, strerror(errno));
        return SCREE_EXIT_FAILED;
    }
    batch.output = strcmp(output_path, "-") == 0 ? stdout : fopen(output_path, "w");
    int exit_code = SCREE_EXIT_FAILED;
    if (batch.output == NULL) fprintf(stderr, "scree overlap: cannot write %s: %s\n", output_path, strerror(errno));
    else if (!allocate(&batch)) fprintf(stderr, "scree overlap: %s\n", scree_status_text(SCREE_OUT_OF_MEMORY));
    else exit_code = run_lines(&batch, input);
    release(&batch);
    if (batch.output != NULL && batch.output != stdout && fclose(batch.output) != 0)
    {
        fprintf(stderr, "scree overlap: writing %s failed: %s\n", output_path, strerror(errno));
        exit_code = SCREE_EXIT_FAILED;
    }
    if (input != stdin) fclose(input);
    return exit_code;
}
