/// \file triangle_intersection.c
/// Case distinction by the number of shared vertices; each case comes down to segments against triangles.
#include "polyhedra/triangle_intersection.h"
#include "core/exact_arith.h"

/// The point without its coordinate `axis`.
static scree_exact_point2 project(scree_vec3 p, int axis)
{
    if (axis == 0) return scree_exact_point2_make((double)p.y, (double)p.z);
    if (axis == 1) return scree_exact_point2_make((double)p.z, (double)p.x);
    return scree_exact_point2_make((double)p.x, (double)p.y);
}

/// An axis along which the triangle is seen with an area, or -1 if there is none.
static int projection_axis(scree_vec3 a, scree_vec3 b, scree_vec3 c)
{
    for (int axis = 0; axis < 3; ++axis)
        if (scree_orient2d(project(a, axis), project(b, axis), project(c, axis)) != 0) return axis;
    return -1;
}

bool scree_triangle_is_degenerate(scree_vec3 a, scree_vec3 b, scree_vec3 c) { return projection_axis(a, b, c) < 0; }

/// True if point c, known to be on the line of a and b, lies within their segment.
static bool is_between(scree_exact_point2 a, scree_exact_point2 b, scree_exact_point2 c)
{
    const bool in_x = (a.x <= c.x && c.x <= b.x) || (b.x <= c.x && c.x <= a.x);
    const bool in_y = (a.y <= c.y && c.y <= b.y) || (b.y <= c.y && c.y <= a.y);
    return in_x && in_y;
}

static bool segments_meet(scree_exact_point2 a, scree_exact_point2 b, scree_exact_point2 c, scree_exact_point2 d)
{
    const int32_t abc = scree_orient2d(a, b, c);
    const int32_t abd = scree_orient2d(a, b, d);
    const int32_t cda = scree_orient2d(c, d, a);
    const int32_t cdb = scree_orient2d(c, d, b);
    if (abc * abd < 0 && cda * cdb < 0) return true;
    return (abc == 0 && is_between(a, b, c)) || (abd == 0 && is_between(a, b, d)) ||
           (cda == 0 && is_between(c, d, a)) || (cdb == 0 && is_between(c, d, b));
}

/// Segment in the plane of the triangle.
static bool coplanar_segment_meets_triangle(scree_vec3 p, scree_vec3 q, const scree_vec3 triangle[3])
{
    const int axis = projection_axis(triangle[0], triangle[1], triangle[2]);
    if (axis < 0) return false;
    const scree_exact_point2 t[3] = {project(triangle[0], axis), project(triangle[1], axis),
                                     project(triangle[2], axis)};
    const scree_exact_point2 start = project(p, axis);
    const scree_exact_point2 end = project(q, axis);
    const int32_t sense = scree_orient2d(t[0], t[1], t[2]);
    bool is_inside = true;
    for (int k = 0; k < 3; ++k)
    {
        if (segments_meet(start, end, t[k], t[(k + 1) % 3])) return true;
        is_inside = is_inside && scree_orient2d(t[k], t[(k + 1) % 3], start) * sense > 0;
    }
    return is_inside;
}

bool scree_segment_meets_triangle(scree_vec3 p, scree_vec3 q, const scree_vec3 triangle[3])
{
    const int32_t side_p = scree_orient3d(triangle[0], triangle[1], triangle[2], p);
    const int32_t side_q = scree_orient3d(triangle[0], triangle[1], triangle[2], q);
    if (side_p * side_q > 0) return false;
    if (side_p == 0 && side_q == 0) return coplanar_segment_meets_triangle(p, q, triangle);
    // the line p q pierces the plane once: inside if it passes all three edges on the same side
    bool is_negative = false;
    bool is_positive = false;
    for (int k = 0; k < 3; ++k)
    {
        const int32_t side = scree_orient3d(p, q, triangle[k], triangle[(k + 1) % 3]);
        is_negative = is_negative || side < 0;
        is_positive = is_positive || side > 0;
    }
    return !(is_negative && is_positive);
}

/// True if all three corners of t are strictly on one side of the plane of s.
static bool is_clear_of_plane(const scree_vec3 s[3], const scree_vec3 t[3])
{
    const int32_t side = scree_orient3d(s[0], s[1], s[2], t[0]);
    return side != 0 && scree_orient3d(s[0], s[1], s[2], t[1]) == side &&
           scree_orient3d(s[0], s[1], s[2], t[2]) == side;
}

static bool strangers_meet(const scree_vec3 s[3], const scree_vec3 t[3])
{
    if (is_clear_of_plane(s, t) || is_clear_of_plane(t, s)) return false;
    for (int k = 0; k < 3; ++k)
        if (scree_segment_meets_triangle(s[k], s[(k + 1) % 3], t) ||
            scree_segment_meets_triangle(t[k], t[(k + 1) % 3], s))
            return true;
    return false;
}

/// Triangles with the edge s[0], s[1] in common; u is the third corner of the other one. They meet outside of that
/// edge only if folded flat onto each other.
static bool folded_flat(const scree_vec3 s[3], scree_vec3 u)
{
    if (scree_orient3d(s[0], s[1], s[2], u) != 0) return false;
    const int axis = projection_axis(s[0], s[1], s[2]);
    if (axis < 0) return false;
    const scree_exact_point2 a = project(s[0], axis);
    const scree_exact_point2 b = project(s[1], axis);
    return scree_orient2d(a, b, project(s[2], axis)) * scree_orient2d(a, b, project(u, axis)) > 0;
}

/// Corner of triangle a that triangle b does not have, for two shared vertices; corner that both have, for one.
static int odd_corner(const int32_t a[3], const int32_t b[3], bool is_wanted_shared)
{
    for (int k = 0; k < 3; ++k)
    {
        const bool is_shared = a[k] == b[0] || a[k] == b[1] || a[k] == b[2];
        if (is_shared == is_wanted_shared) return k;
    }
    return 0;
}

bool scree_mesh_triangles_meet(const scree_mesh *mesh, int32_t i, int32_t j)
{
    const int32_t *a = mesh->triangles[i].v;
    const int32_t *b = mesh->triangles[j].v;
    int num_shared = 0;
    for (int k = 0; k < 3; ++k) num_shared += a[k] == b[0] || a[k] == b[1] || a[k] == b[2];
    const int ka = odd_corner(a, b, num_shared == 1);
    const int kb = odd_corner(b, a, num_shared == 1);
    scree_vec3 s[3];
    scree_vec3 t[3];
    // rotated so that the odd corner comes last
    for (int k = 0; k < 3; ++k)
    {
        s[k] = mesh->vertices[a[(ka + 1 + k) % 3]];
        t[k] = mesh->vertices[b[(kb + 1 + k) % 3]];
    }
    if (num_shared == 0) return strangers_meet(s, t);
    if (num_shared == 1)
        // whatever is common begins at the shared corner and ends where it leaves one triangle by the far edge
        return scree_segment_meets_triangle(s[0], s[1], t) || scree_segment_meets_triangle(t[0], t[1], s);
    if (num_shared == 2) return folded_flat(s, t[2]);
    return false;
}
