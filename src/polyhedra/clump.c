#include "polyhedra/clump.h"

#include "polyhedra/union_of_spheres.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// Indentation that the time step has in mind, over the radius of the largest sphere; see time_step.c.
#define SUPPORT_DEPTH 0.02

enum
{
    NUM_DIRECTIONS = 400
};

// ------------------------------------------------------------------------------------------------------------- faults

static double distance(const scree_clump_sphere *a, const scree_clump_sphere *b)
{
    const double d[3] = {a->position[0] - b->position[0], a->position[1] - b->position[1],
                         a->position[2] - b->position[2]};
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/// Marks all spheres that hang together with `seed`.
static void flood(const scree_clump_sphere *spheres, int32_t num, int32_t seed, bool *is_reached)
{
    int32_t waiting[SCREE_CLUMP_MAX_SPHERES], num_waiting = 0;
    waiting[num_waiting++] = seed;
    is_reached[seed] = true;
    while (num_waiting > 0)
    {
        const scree_clump_sphere *a = spheres + waiting[--num_waiting];
        for (int32_t k = 0; k < num; ++k)
        {
            if (is_reached[k] || !(distance(a, spheres + k) < a->radius + spheres[k].radius)) continue;
            is_reached[k] = true;
            waiting[num_waiting++] = k;
        }
    }
}

/// Is the clump one piece?
static scree_clump_fault check_connection(const scree_clump_sphere *spheres, int32_t num)
{
    scree_clump_fault fault = {SCREE_CLUMP_GOOD, 0, 0, 0};
    bool is_reached[SCREE_CLUMP_MAX_SPHERES] = {false}, is_apart[SCREE_CLUMP_MAX_SPHERES] = {false};
    flood(spheres, num, 0, is_reached);
    int32_t lost = 0;
    while (lost < num && is_reached[lost]) ++lost;
    if (lost == num) return fault;
    flood(spheres, num, lost, is_apart);
    fault = (scree_clump_fault){SCREE_CLUMP_APART, lost, 0, INFINITY};
    for (int32_t a = 0; a < num; ++a)
        for (int32_t b = 0; b < num; ++b)
        {
            if (!is_apart[a] || is_apart[b]) continue;
            const double gap = distance(spheres + a, spheres + b) - spheres[a].radius - spheres[b].radius;
            if (gap >= fault.gap) continue;
            fault = (scree_clump_fault){SCREE_CLUMP_APART, a, b, gap};
        }
    return fault;
}

scree_clump_fault scree_clump_check(const scree_clump_sphere *spheres, int32_t num)
{
    scree_clump_fault fault = {SCREE_CLUMP_GOOD, 0, 0, 0};
    if (num < 1) fault.kind = SCREE_CLUMP_EMPTY;
    else if (num > SCREE_CLUMP_MAX_SPHERES) fault = (scree_clump_fault){SCREE_CLUMP_TOO_MANY, num, 0, 0};
    if (fault.kind != SCREE_CLUMP_GOOD) return fault;
    for (int32_t a = 0; a < num; ++a)
        if (!(spheres[a].radius > 0)) return (scree_clump_fault){SCREE_CLUMP_NO_RADIUS, a, 0, 0};
    for (int32_t a = 0; a < num; ++a)
        for (int32_t b = 0; b < num; ++b)
        {
            // of two that are the same the later one is told
            const double reach = distance(spheres + a, spheres + b) + spheres[a].radius;
            if (a == b || reach > spheres[b].radius) continue;
            const bool is_same = reach == spheres[b].radius && spheres[a].radius == spheres[b].radius;
            if (!is_same || b < a) return (scree_clump_fault){SCREE_CLUMP_HIDDEN, a, b, 0};
        }
    return check_connection(spheres, num);
}

void scree_clump_describe_fault(const scree_clump_fault *fault, char *text, size_t size)
{
    text[0] = '\0';
    switch (fault->kind)
    {
    case SCREE_CLUMP_GOOD:
        break;
    case SCREE_CLUMP_EMPTY:
        snprintf(text, size, "is empty; a source clump needs 1 or more, each like {position: [0, 0, 0], radius: 0.01}");
        break;
    case SCREE_CLUMP_TOO_MANY:
        snprintf(text, size, "has %d items; a clump can have at most %d: take fewer and larger ones", fault->first,
                 SCREE_CLUMP_MAX_SPHERES);
        break;
    case SCREE_CLUMP_NO_RADIUS:
        snprintf(text, size, "has a number %d without radius; every radius must be above 0", fault->first);
        break;
    case SCREE_CLUMP_HIDDEN:
        snprintf(text, size, "has number %d wholly inside number %d; remove it, or move it until it shows",
                 fault->first, fault->second);
        break;
    case SCREE_CLUMP_APART:
        snprintf(text, size,
                 "is not connected: number %d is %g m from number %d, the nearest of the others; move them together "
                 "until they overlap, or make two shapes",
                 fault->first, fault->gap, fault->second);
        break;
    }
}

// -------------------------------------------------------------------------------------------------------------- shape

static double middle_of(double a, double b, double c) { return fmax(fmin(a, b), fmin(fmax(a, b), c)); }

/// Spheres from the source frame into the frame of the shape.
static void move_into_frame(scree_shape *shape, int32_t num)
{
    const double *o = shape->frame_position, *q = shape->frame_orientation;
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double axes[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                               {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                               {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
    for (int32_t k = 0; k < num; ++k)
    {
        scree_vec3 *c = &shape->spheres[k].centre;
        const double r[3] = {(double)c->x - o[0], (double)c->y - o[1], (double)c->z - o[2]};
        double b[3];
        for (int i = 0; i < 3; ++i) b[i] = axes[i][0] * r[0] + axes[i][1] * r[1] + axes[i][2] * r[2];
        *c = scree_vec3_make((scree_real)b[0], (scree_real)b[1], (scree_real)b[2]);
    }
}

static void fill_view(scree_shape *shape, int32_t num)
{
    scree_shape_view *view = &shape->view;
    view->kind = SCREE_KIND_CLUMP;
    view->spheres = shape->spheres;
    view->num_spheres = num;
    view->tree.root = SCREE_LBVH_END;
    view->box = scree_box_empty();
    for (int32_t k = 0; k < num; ++k)
    {
        const scree_sphere s = shape->spheres[k];
        const scree_vec3 r = scree_vec3_make(s.radius, s.radius, s.radius);
        view->box = scree_box_with_point(scree_box_with_point(view->box, scree_vec3_sub(s.centre, r)),
                                         scree_vec3_add(s.centre, r));
        // rounded outwards
        const scree_real reach = (scree_vec3_length(s.centre) + s.radius) * (1 + 4 * SCREE_REAL_EPSILON);
        view->bounding_radius = scree_max(view->bounding_radius, reach);
    }
    const scree_vec3 extent = scree_vec3_sub(view->box.upper, view->box.lower);
    shape->middle_size = middle_of((double)extent.x, (double)extent.y, (double)extent.z);
}

scree_status scree_shape_create_clump(scree_shape *shape, const scree_clump_sphere *spheres, int32_t num)
{
    if (num == 1)
    {
        scree_shape_create_sphere(shape, spheres[0].radius);
        for (int k = 0; k < 3; ++k) shape->frame_position[k] = spheres[0].position[k];
        return SCREE_OK;
    }
    *shape = (scree_shape){0};
    shape->spheres = malloc((size_t)num * sizeof *shape->spheres);
    if (shape->spheres == NULL) return SCREE_OUT_OF_MEMORY;
    double largest = 0;
    for (int32_t k = 0; k < num; ++k)
    {
        const double *p = spheres[k].position;
        shape->spheres[k].centre = scree_vec3_make((scree_real)p[0], (scree_real)p[1], (scree_real)p[2]);
        shape->spheres[k].radius = (scree_real)spheres[k].radius;
        largest = fmax(largest, spheres[k].radius);
    }
    double error;
    scree_mass_properties *p = &shape->properties;
    const scree_status status = scree_union_of_spheres_properties(shape->spheres, num, p, &error);
    if (status != SCREE_OK)
    {
        scree_shape_destroy(shape);
        return status;
    }
    for (int k = 0; k < 3; ++k) shape->frame_position[k] = p->centroid[k];
    for (int k = 0; k < 4; ++k) shape->frame_orientation[k] = p->principal_axes[k];
    move_into_frame(shape, num);
    for (int k = 0; k < 3; ++k)
    {
        p->centroid[k] = 0;
        p->principal_axes[k + 1] = 0;
        for (int i = 0; i < 3; ++i) p->inertia[k][i] = i == k ? p->principal[k] : 0;
    }
    p->principal_axes[0] = 1;
    fill_view(shape, num);
    shape->num_supports = scree_clump_num_supports(&shape->view, SUPPORT_DEPTH * largest);
    return SCREE_OK;
}

// ----------------------------------------------------------------------------------------------------------- supports

static double reach_along(scree_sphere s, const double u[3])
{
    return (double)s.centre.x * u[0] + (double)s.centre.y * u[1] + (double)s.centre.z * u[2] + (double)s.radius;
}

/// The spheres within `depth` of the plane that touches the clump from direction u; the three that reach farthest.
static int32_t count_along(const scree_shape_view *shape, const double u[3], double depth, int32_t top[3])
{
    double reach[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int32_t k = 0; k < shape->num_spheres; ++k)
    {
        double along = reach_along(shape->spheres[k], u);
        int32_t item = k;
        for (int place = 0; place < 3; ++place)
        {
            if (along <= reach[place]) continue;
            const double kept = reach[place];
            const int32_t kept_item = top[place];
            reach[place] = along;
            top[place] = item;
            along = kept;
            item = kept_item;
        }
    }
    int32_t num = 0;
    for (int32_t k = 0; k < shape->num_spheres; ++k) num += reach_along(shape->spheres[k], u) > reach[0] - depth;
    return num;
}

/// Direction of the plane that touches three spheres from outside, on the side of u. False if there is none.
static bool plane_on_three(const scree_shape_view *shape, const int32_t top[3], double u[3])
{
    // u.(c_k - c_0) = r_0 - r_k: a point of the plane of the centres, plus what is left of the length along its normal
    double e[2][3], rhs[2];
    const scree_sphere s = shape->spheres[top[0]];
    for (int k = 0; k < 2; ++k)
    {
        const scree_sphere t = shape->spheres[top[k + 1]];
        e[k][0] = (double)t.centre.x - (double)s.centre.x;
        e[k][1] = (double)t.centre.y - (double)s.centre.y;
        e[k][2] = (double)t.centre.z - (double)s.centre.z;
        rhs[k] = (double)s.radius - (double)t.radius;
    }
    const double n[3] = {e[0][1] * e[1][2] - e[0][2] * e[1][1], e[0][2] * e[1][0] - e[0][0] * e[1][2],
                         e[0][0] * e[1][1] - e[0][1] * e[1][0]};
    const double a = e[0][0] * e[0][0] + e[0][1] * e[0][1] + e[0][2] * e[0][2];
    const double b = e[0][0] * e[1][0] + e[0][1] * e[1][1] + e[0][2] * e[1][2];
    const double c = e[1][0] * e[1][0] + e[1][1] * e[1][1] + e[1][2] * e[1][2];
    const double squared = a * c - b * b; // of n
    if (!(squared > 1e-12 * a * c)) return false;
    const double x = (rhs[0] * c - rhs[1] * b) / squared, y = (rhs[1] * a - rhs[0] * b) / squared;
    double p[3], left = 1, side = 0;
    for (int k = 0; k < 3; ++k)
    {
        p[k] = x * e[0][k] + y * e[1][k];
        left -= p[k] * p[k];
        side += n[k] * u[k];
    }
    if (!(left > 0)) return false;
    const double factor = (side < 0 ? -1 : 1) * sqrt(left / squared);
    for (int k = 0; k < 3; ++k) u[k] = p[k] + factor * n[k];
    return true;
}

int32_t scree_clump_num_supports(const scree_shape_view *shape, double depth)
{
    int32_t most = 1;
    if (shape->num_spheres < 3) return shape->num_spheres;
    for (int d = 0; d < NUM_DIRECTIONS; ++d)
    {
        // on a spiral from pole to pole, evenly spread (golden angle)
        const double z = 1 - (2 * d + 1.0) / NUM_DIRECTIONS, r = sqrt(1 - z * z), angle = 2.39996322972865332 * d;
        double u[3] = {r * cos(angle), r * sin(angle), z};
        int32_t top[3] = {0, 0, 0};
        const int32_t num = count_along(shape, u, depth, top);
        most = num > most ? num : most;
        if (!plane_on_three(shape, top, u)) continue;
        const int32_t on_plane = count_along(shape, u, depth, top);
        most = on_plane > most ? on_plane : most;
    }
    return most;
}
