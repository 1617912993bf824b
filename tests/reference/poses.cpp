#include "poses.hpp"

#include <algorithm>
#include <cmath>

namespace reference
{
namespace
{

/// Coordinates with the direction as third axis.
std::vector<Vector> seen_along(const Mesh &mesh, const Vector &direction)
{
    const Vector helper = std::fabs(direction[0]) < 0.5 ? Vector{1, 0, 0} : Vector{0, 1, 0};
    Vector u = cross(direction, helper);
    u = (1 / norm(u)) * u;
    const Vector v = cross(direction, u);
    std::vector<Vector> result;
    for (const Vector &p : mesh.vertices) result.push_back({dot(p, u), dot(p, v), dot(p, direction)});
    return result;
}

double turn(const Vector &p, const Vector &q, const Vector &r)
{
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
}

/// Least of sign (z of point - z of triangle above or below it).
void points_to_triangles(const std::vector<Vector> &points, const std::vector<Vector> &corners,
                         const std::vector<Triangle> &triangles, double sign, double &gap)
{
    for (const Triangle &t : triangles)
    {
        const Vector &p = corners[size_t(t[0])], &q = corners[size_t(t[1])], &r = corners[size_t(t[2])];
        const double area = turn(p, q, r);
        if (area == 0) continue;
        const double x0 = std::min({p[0], q[0], r[0]}), x1 = std::max({p[0], q[0], r[0]});
        const double y0 = std::min({p[1], q[1], r[1]}), y1 = std::max({p[1], q[1], r[1]});
        for (const Vector &s : points)
        {
            if (s[0] < x0 || s[0] > x1 || s[1] < y0 || s[1] > y1) continue;
            const double a = turn(q, r, s) / area, b = turn(r, p, s) / area, c = turn(p, q, s) / area;
            if (a < 0 || b < 0 || c < 0) continue;
            gap = std::min(gap, sign * (s[2] - (a * p[2] + b * q[2] + c * r[2])));
        }
    }
}

void edges_to_edges(const std::vector<Vector> &points_a, const Mesh &a, const std::vector<Vector> &points_b,
                    const Mesh &b, double &gap)
{
    for (const Triangle &t : a.triangles)
    {
        for (size_t i = 0; i < 3; ++i)
        {
            if (t[i] > t[(i + 1) % 3]) continue;
            const Vector &p = points_a[size_t(t[i])], &q = points_a[size_t(t[(i + 1) % 3])];
            const double x0 = std::min(p[0], q[0]), x1 = std::max(p[0], q[0]);
            const double y0 = std::min(p[1], q[1]), y1 = std::max(p[1], q[1]);
            for (const Triangle &g : b.triangles)
            {
                for (size_t j = 0; j < 3; ++j)
                {
                    if (g[j] > g[(j + 1) % 3]) continue;
                    const Vector &r = points_b[size_t(g[j])], &s = points_b[size_t(g[(j + 1) % 3])];
                    if (std::max(r[0], s[0]) < x0 || std::min(r[0], s[0]) > x1 || std::max(r[1], s[1]) < y0 ||
                        std::min(r[1], s[1]) > y1)
                        continue;
                    const double e = turn(p, q, r), f = turn(p, q, s), c = turn(r, s, p), d = turn(r, s, q);
                    if ((e > 0) == (f > 0) || (c > 0) == (d > 0)) continue;
                    const double z_b = r[2] + (s[2] - r[2]) * e / (e - f), z_a = p[2] + (q[2] - p[2]) * c / (c - d);
                    gap = std::min(gap, z_b - z_a);
                }
            }
        }
    }
}

Vector middle(const Mesh &mesh)
{
    Vector sum = {0, 0, 0};
    for (const Vector &v : mesh.vertices) sum = sum + v;
    return (1.0 / double(mesh.vertices.size())) * sum;
}

double radius_about(const Mesh &mesh, const Vector &center)
{
    double r = 0;
    for (const Vector &v : mesh.vertices) r = std::max(r, norm(v - center));
    return r;
}

} // namespace

double gap_along(const Mesh &a, const Mesh &b, const Vector &direction)
{
    const std::vector<Vector> pa = seen_along(a, direction), pb = seen_along(b, direction);
    double gap = HUGE_VAL;
    points_to_triangles(pb, pa, a.triangles, 1, gap);
    points_to_triangles(pa, pb, b.triangles, -1, gap);
    edges_to_edges(pa, a, pb, b, gap);
    return gap;
}

Mesh brought_together(const Mesh &a, Mesh b, double depth, Random &random)
{
    const Vector center_a = middle(a), center_b = middle(b);
    const double reach = radius_about(a, center_a) + radius_about(b, center_b);
    for (int attempt = 0; attempt < 100; ++attempt)
    {
        const Vector direction = random.direction();
        // not always head-on: the centres pass each other at up to half of the smaller radius
        const double offset = 0.5 * std::min(radius_about(a, center_a), radius_about(b, center_b)) * random.uniform();
        const Vector side = cross(direction, random.direction());
        const Mesh far = shifted(b, center_a - center_b + reach * direction + offset * side);
        const double gap = gap_along(a, far, direction);
        if (gap < HUGE_VAL) return shifted(far, -(gap + depth) * direction);
    }
    return b;
}

Pose ordinary_pose(int shape_a, int shape_b, Random &random)
{
    Pose pose;
    pose.kind = shape_name(shape_a) + " / " + shape_name(shape_b);
    pose.a = moved(shape(shape_a, random), random_rotation(random), {0, 0, 0});
    const double ratio = random.log_uniform(0.3, 3);
    Mesh b = moved(scaled(shape(shape_b, random), ratio), random_rotation(random), {0, 0, 0});
    const double size = std::min(extent(pose.a), extent(b));
    pose.b = brought_together(pose.a, b, size * random.log_uniform(1e-4, 5e-2), random);
    pose.is_robust = true;
    return pose;
}

} // namespace reference
