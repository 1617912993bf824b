/// \file clump_fill.c
/// Greedy filling: the centres to choose from are the points of a grid inside the mesh, each with the largest sphere
/// that fits, whose radius is its distance from the surface. Of a sphere of radius r whose centre is g outside of the
/// spheres before (negative inside), min(2 r, r + g) sticks out; the one with the most r^2 min(2 r, r + g) is next.
/// It overlaps them if g < r. No sphere reaches out of the mesh, so the clump is smaller than the mesh, at its edges
/// above all.
#include "contact/clump_fill.h"

#include "contact/closest_point_kernel.h"

#include <math.h>
#include <stdlib.h>

enum
{
    GRID = 33 ///< points along the longest extent; odd, so that the middle is one
};

/// A point that a sphere can be centred at.
typedef struct fill_point
{
    double position[3];
    double radius;  ///< of the sphere that fits
    double outside; ///< [m] from the spheres before; negative inside
    double hiding;  ///< [m] radius from which on it would hide one of them
} fill_point;

/// Inside points of the grid. Returns their number.
static int64_t make_points(const scree_shape_view *shape, fill_point *points)
{
    const double lower[3] = {(double)shape->box.lower.x, (double)shape->box.lower.y, (double)shape->box.lower.z};
    const double upper[3] = {(double)shape->box.upper.x, (double)shape->box.upper.y, (double)shape->box.upper.z};
    int64_t num = 0;
    for (int64_t n = 0; n < (int64_t)GRID * GRID * GRID; ++n)
    {
        const int64_t cell[3] = {n % GRID, n / GRID % GRID, n / GRID / GRID};
        fill_point *point = points + num;
        for (int k = 0; k < 3; ++k)
            point->position[k] = lower[k] + (upper[k] - lower[k]) * ((double)cell[k] + 0.5) / GRID;
        const scree_vec3 centre = scree_vec3_make((scree_real)point->position[0], (scree_real)point->position[1],
                                                  (scree_real)point->position[2]);
        const scree_closest_point closest = scree_closest_on_mesh(shape, centre);
        point->radius = -(double)scree_approach_of(shape, &closest).height;
        point->outside = INFINITY;
        point->hiding = INFINITY;
        num += point->radius > 0;
    }
    return num;
}

/// The point whose sphere is next, or NULL if none is left that joins the others and shows.
static const fill_point *choose(const fill_point *points, int64_t num, bool is_first)
{
    const fill_point *best = NULL;
    double most = 0;
    for (int64_t k = 0; k < num; ++k)
    {
        const fill_point *p = points + k;
        const double out = fmin(2 * p->radius, p->radius + p->outside), score = p->radius * p->radius * out;
        if ((!is_first && !(p->outside < p->radius)) || !(p->radius < p->hiding) || !(score > most)) continue;
        most = score;
        best = p;
    }
    return best;
}

scree_status scree_clump_fill(const scree_mesh *mesh, int32_t num, scree_clump_sphere *spheres, int32_t *num_made)
{
    *num_made = 0;
    scree_shape shape;
    fill_point *points = malloc((size_t)GRID * GRID * GRID * sizeof *points);
    if (points == NULL) return SCREE_OUT_OF_MEMORY;
    const scree_status status = scree_shape_create(&shape, mesh, SCREE_FRAME_SOURCE);
    const int64_t num_points = status == SCREE_OK ? make_points(&shape.view, points) : 0;
    while (*num_made < num)
    {
        const fill_point *next = choose(points, num_points, *num_made == 0);
        if (next == NULL) break;
        scree_clump_sphere *added = spheres + (*num_made)++;
        for (int k = 0; k < 3; ++k) added->position[k] = next->position[k];
        added->radius = next->radius;
        for (int64_t k = 0; k < num_points; ++k)
        {
            const double d[3] = {points[k].position[0] - added->position[0], points[k].position[1] - added->position[1],
                                 points[k].position[2] - added->position[2]};
            const double distance = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            points[k].outside = fmin(points[k].outside, distance - added->radius);
            points[k].hiding = fmin(points[k].hiding, distance + added->radius);
        }
    }
    if (status == SCREE_OK) scree_shape_destroy(&shape);
    free(points);
    return status;
}
