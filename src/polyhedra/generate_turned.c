/// \file generate_turned.c
/// Solids of revolution: a profile turned about z. Cross-sections are regular polygons with the area of the circle, so
/// volumes are those of the true solid: vessels hold what they should.
#include "polyhedra/generate.h"

#include <math.h>

#define PI 3.14159265358979323846

static bool is_on_axis(scree_profile_point p) { return p.radius == 0.0; }

/// Twice the area, positive if the profile runs counter-clockwise with r to the right and z up.
static double twice_area(const scree_profile_point *profile, int32_t num)
{
    double sum = 0.0;
    for (int32_t i = 0; i < num; ++i)
    {
        const scree_profile_point a = profile[i], b = profile[(i + 1) % num];
        sum += a.radius * b.height - b.radius * a.height;
    }
    return sum;
}

static bool is_usable(const scree_profile_point *profile, int32_t num, int32_t num_segments)
{
    if (num < 3 || num > SCREE_PROFILE_MAX_POINTS || num_segments < 3 || num_segments > SCREE_MAX_SEGMENTS)
        return false;
    for (int32_t i = 0; i < num; ++i)
        if (!(profile[i].radius >= 0.0 && profile[i].radius <= 1e30) || !(fabs(profile[i].height) <= 1e30))
            return false;
    return twice_area(profile, num) != 0.0;
}

/// Number of triangles between the rings of two points of the profile.
static int32_t num_strip_triangles(scree_profile_point a, scree_profile_point b, int32_t num_segments)
{
    return (is_on_axis(a) ? 0 : num_segments) + (is_on_axis(b) ? 0 : num_segments);
}

/// A point of the profile as a ring of vertices, or the one vertex that it is on the axis.
static int32_t add_ring(scree_mesh *mesh, int32_t first, scree_profile_point p, int32_t num_segments)
{
    if (is_on_axis(p))
    {
        mesh->vertices[first] = scree_vec3_make(0, 0, (scree_real)p.height);
        return first + 1;
    }
    const double angle = 2.0 * PI / num_segments;
    const double radius = p.radius * sqrt(angle / sin(angle));
    for (int32_t k = 0; k < num_segments; ++k)
        mesh->vertices[first + k] = scree_vec3_make((scree_real)(radius * cos(k * angle)),
                                                    (scree_real)(radius * sin(k * angle)), (scree_real)p.height);
    return first + num_segments;
}

static void add_triangle(scree_mesh *mesh, int32_t *t, int32_t a, int32_t b, int32_t c)
{
    mesh->triangles[*t].v[0] = a;
    mesh->triangles[*t].v[1] = b;
    mesh->triangles[*t].v[2] = c;
    ++*t;
}

/// Triangles between the rings `from` and `to`, which follow each other on a profile that runs counter-clockwise.
static void add_strip(scree_mesh *mesh, int32_t *t, const int32_t from[2], const int32_t to[2])
{
    const int32_t num = from[1] > to[1] ? from[1] : to[1];
    for (int32_t k = 0; k < num; ++k)
    {
        const int32_t next = (k + 1) % num;
        if (from[1] > 1) add_triangle(mesh, t, from[0] + k, from[0] + next, to[1] > 1 ? to[0] + next : to[0]);
        if (to[1] > 1) add_triangle(mesh, t, from[1] > 1 ? from[0] + k : from[0], to[0] + next, to[0] + k);
    }
}

scree_status scree_generate_turned(scree_mesh *mesh, const scree_profile_point *profile, int32_t num_points,
                                   int32_t num_segments)
{
    *mesh = (scree_mesh){0};
    if (!is_usable(profile, num_points, num_segments)) return SCREE_INVALID_INPUT;
    int32_t num_vertices = 0, num_triangles = 0;
    for (int32_t i = 0; i < num_points; ++i)
    {
        num_vertices += is_on_axis(profile[i]) ? 1 : num_segments;
        num_triangles += num_strip_triangles(profile[i], profile[(i + 1) % num_points], num_segments);
    }
    const scree_status status = scree_mesh_create(mesh, num_vertices, num_triangles);
    if (status != SCREE_OK) return status;

    // rings in the order of the profile, which is walked backwards if it runs clockwise
    const bool is_clockwise = twice_area(profile, num_points) < 0.0;
    int32_t rings[SCREE_PROFILE_MAX_POINTS][2], first = 0, t = 0;
    for (int32_t i = 0; i < num_points; ++i)
    {
        rings[i][0] = first;
        first = add_ring(mesh, first, profile[i], num_segments);
        rings[i][1] = first - rings[i][0];
    }
    for (int32_t i = 0; i < num_points; ++i)
    {
        const int32_t *a = rings[i], *b = rings[(i + 1) % num_points];
        if (a[1] == 1 && b[1] == 1) continue;
        add_strip(mesh, &t, is_clockwise ? b : a, is_clockwise ? a : b);
    }
    return SCREE_OK;
}
