/// \file polygon.c
/// Ear clipping (Meisters 1975) with exact orientations, in the projection along the axis nearest to the normal.
/// The walk goes on behind each ear instead of staying, so that round polygons do not become fans of needles.
#include "polyhedra/polygon.h"
#include "core/exact_arith.h"

/// A polygon as seen along one axis, counter-clockwise.
typedef struct flat_polygon
{
    const scree_vec3 *corners;
    const int32_t *next; ///< ring of the corners that are left
    int axis;
    bool is_mirrored;
} flat_polygon;

static scree_exact_point2 project(const flat_polygon *polygon, int32_t i)
{
    const scree_vec3 p = polygon->corners[i];
    const double x[3] = {(double)p.x, (double)p.y, (double)p.z};
    const int j = (polygon->axis + 1) % 3;
    const int k = (polygon->axis + 2) % 3;
    return polygon->is_mirrored ? scree_exact_point2_make(x[k], x[j]) : scree_exact_point2_make(x[j], x[k]);
}

static int32_t turn(const flat_polygon *polygon, int32_t a, int32_t b, int32_t c)
{
    return scree_orient2d(project(polygon, a), project(polygon, b), project(polygon, c));
}

static bool are_equal(const flat_polygon *polygon, int32_t i, int32_t j)
{
    const scree_exact_point2 p = project(polygon, i);
    const scree_exact_point2 q = project(polygon, j);
    return p.x == q.x && p.y == q.y;
}

/// True if b is a convex corner and no other corner lies in the triangle a, b, c or on its rim.
static bool is_ear(const flat_polygon *polygon, int32_t a, int32_t b, int32_t c)
{
    if (turn(polygon, a, b, c) <= 0) return false;
    for (int32_t i = polygon->next[c]; i != a; i = polygon->next[i])
    {
        if (are_equal(polygon, i, a) || are_equal(polygon, i, b) || are_equal(polygon, i, c)) continue;
        if (turn(polygon, a, b, i) >= 0 && turn(polygon, b, c, i) >= 0 && turn(polygon, c, a, i) >= 0) return false;
    }
    return true;
}

/// Axis nearest to the normal after Newell, the sum of the cross products of neighbouring corners.
static flat_polygon flatten(const scree_vec3 *corners, int32_t num, const int32_t *next)
{
    scree_vec3 normal = scree_vec3_zero();
    for (int32_t i = 1; i + 1 < num; ++i)
        normal = scree_vec3_add(normal, scree_vec3_cross(scree_vec3_sub(corners[i], corners[0]),
                                                         scree_vec3_sub(corners[i + 1], corners[0])));
    const double n[3] = {(double)normal.x, (double)normal.y, (double)normal.z};
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (fabs(n[k]) > fabs(n[axis])) axis = k;
    const flat_polygon polygon = {corners, next, axis, n[axis] < 0.0};
    return polygon;
}

void scree_polygon_triangulate(const scree_vec3 *corners, int32_t num, int32_t (*triangles)[3], int32_t *scratch)
{
    int32_t *next = scratch;
    for (int32_t i = 0; i < num; ++i) next[i] = (i + 1) % num;
    const flat_polygon polygon = flatten(corners, num, next);
    int32_t before = 0;
    int32_t num_left = num;
    int32_t num_refused = 0;
    for (int32_t t = 0; t < num - 2;)
    {
        const int32_t corner = next[before];
        const int32_t after = next[corner];
        // when a whole round finds no ear, the polygon crosses itself or is flat: any corner will do
        const bool is_cut = num_refused >= num_left || is_ear(&polygon, before, corner, after);
        num_refused = is_cut ? 0 : num_refused + 1;
        if (!is_cut)
        {
            before = corner;
            continue;
        }
        triangles[t][0] = before;
        triangles[t][1] = corner;
        triangles[t][2] = after;
        next[before] = after;
        before = after;
        --num_left;
        ++t;
    }
}
