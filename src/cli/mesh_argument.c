#include "cli/mesh_argument.h"

#include "polyhedra/generate.h"

#include <stdlib.h>
#include <string.h>

bool scree_parse_number(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && *end == '\0' && *value - *value == 0.0;
}

/// Splits "kind:1:2:3" into its numbers; -1 if one of them is none or there are more than max_values.
static int split_numbers(const char *text, double *values, int max_values)
{
    int num = 0;
    while (*text == ':')
    {
        char *end;
        if (num == max_values) return -1;
        values[num++] = strtod(text + 1, &end);
        if (end == text + 1) return -1;
        text = end;
    }
    return *text == '\0' ? num : -1;
}

static bool is_count(double x) { return x >= 0.0 && x <= 2147483647.0 && (double)(int64_t)x == x; }

enum
{
    MAX_VALUES = 2 * SCREE_PROFILE_MAX_POINTS + 1
};

/// "turned:N:R:Z:R:Z...": segments, then the corners of the profile.
static scree_status call_turned(scree_mesh *mesh, const double *v, int num)
{
    scree_profile_point profile[SCREE_PROFILE_MAX_POINTS];
    const int num_points = (num - 1) / 2;
    for (int k = 0; k < num_points; ++k) profile[k] = (scree_profile_point){v[1 + 2 * k], v[2 + 2 * k]};
    return scree_generate_turned(mesh, profile, num_points, (int32_t)v[0]);
}

static scree_status call_generator(scree_mesh *mesh, const char *kind, const double *v, int num)
{
    if (strcmp(kind, "box") == 0 && num == 3) return scree_generate_box(mesh, v);
    if (strcmp(kind, "tetrahedron") == 0 && num == 1) return scree_generate_tetrahedron(mesh, v[0]);
    if (strcmp(kind, "schoenhardt") == 0 && num == 1) return scree_generate_schoenhardt(mesh, v[0]);
    if (strcmp(kind, "sphere") == 0 && num == 2 && is_count(v[1]))
        return scree_generate_sphere(mesh, v[0], (int32_t)v[1]);
    if (strcmp(kind, "rock") == 0 && (num == 2 || num == 3) && is_count(v[0]) && is_count(v[1]) &&
        (num == 2 || is_count(v[2])))
        return scree_generate_rock(mesh, (uint64_t)v[0], (int32_t)v[1], num == 3 ? (int32_t)v[2] : 0);
    if (strcmp(kind, "turned") == 0 && num % 2 == 1 && is_count(v[0])) return call_turned(mesh, v, num);
    return SCREE_INVALID_INPUT;
}

scree_status scree_mesh_generate(scree_mesh *mesh, const char *specification, scree_report *report)
{
    char kind[16];
    double values[MAX_VALUES];
    const size_t length = strcspn(specification, ":");
    scree_status status = SCREE_INVALID_INPUT;
    bool is_true_sphere = false;
    if (length < sizeof kind)
    {
        memcpy(kind, specification, length);
        kind[length] = '\0';
        const int num = split_numbers(specification + length, values, MAX_VALUES);
        status = call_generator(mesh, kind, values, num);
        is_true_sphere = strcmp(kind, "sphere") == 0 && (num == 1 || (num == 2 && values[1] == 0));
    }
    if (status == SCREE_INVALID_INPUT && is_true_sphere)
        scree_report_add(report,
                         "%s: a true sphere has no mesh to look at; give 4 or more triangles, sphere:R:N. In a scene a "
                         "shape of source sphere without triangles is a true sphere",
                         specification);
    else if (status == SCREE_INVALID_INPUT)
        scree_report_add(
            report,
            "%s: not a shape that can be made: box:X:Y:Z, tetrahedron:R, schoenhardt:R, sphere:R:N, "
            "rock:SEED:N, rock:SEED:N:D or turned:N:R:Z:R:Z:R:Z, with lengths > 0, 4 or more triangles, 3 or "
            "more segments and corners of a profile",
            specification);
    return status;
}

bool scree_mesh_is_generated(const char *argument)
{
    static const char *const kinds[] = {"box:", "tetrahedron:", "schoenhardt:", "sphere:", "rock:", "turned:"};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; ++k)
        if (strncmp(argument, kinds[k], strlen(kinds[k])) == 0) return true;
    return false;
}
