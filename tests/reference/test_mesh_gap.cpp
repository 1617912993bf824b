// The gap of two meshes that do not overlap against CGAL's exact distances of their triangles: never more, and less
// only by rounding, up to the reach it has. Bodies side by side, and bodies in the hole of a ring or between the teeth
// of a comb, where no plane separates them.
#include <CGAL/Gmpq.h>
#include <CGAL/Simple_cartesian.h>

#include "engine.hpp"
#include "harness.h"
#include "poses.hpp"

extern "C"
{
#include "contact/mesh_gap_kernel.h"
}

#include <cmath>
#include <cstdlib>

using namespace reference;
using Kernel = CGAL::Simple_cartesian<CGAL::Gmpq>;

namespace
{

std::vector<Kernel::Triangle_3> triangles_of(const Mesh &mesh)
{
    std::vector<Kernel::Point_3> points;
    for (const Vector &v : mesh.vertices) points.emplace_back(v[0], v[1], v[2]);
    std::vector<Kernel::Triangle_3> triangles;
    for (const Triangle &t : mesh.triangles)
        triangles.emplace_back(points[(size_t)t[0]], points[(size_t)t[1]], points[(size_t)t[2]]);
    return triangles;
}

double distance(const Mesh &a, const Mesh &b)
{
    const std::vector<Kernel::Triangle_3> of_b = triangles_of(b);
    double least = INFINITY;
    for (const Kernel::Triangle_3 &t : triangles_of(a))
        for (const Kernel::Triangle_3 &u : of_b) least = std::min(least, CGAL::to_double(CGAL::squared_distance(t, u)));
    return std::sqrt(least);
}

double gap(const Body &large, const Body &small, double useful)
{
    return (double)scree_mesh_gap(large.view(), large.pose(), small.view(), small.pose(), (scree_real)useful);
}

/// Both orders, against the distance of the bodies as they lie in the world.
void check(const Mesh &local_a, const Placement &at_a, const Mesh &local_b, const Placement &at_b)
{
    const Mesh a = placed(local_a, at_a), b = placed(local_b, at_b);
    const Body body_a(local_a, at_a), body_b(local_b, at_b);
    const double exact = distance(a, b);
    const double radius_a = (double)(body_a.view()->bounding_radius * body_a.pose()->scale);
    const double radius_b = (double)(body_b.view()->bounding_radius * body_b.pose()->scale);
    const double size = radius_a + radius_b + norm(at_b.position - at_a.position);
    const double seen = std::min(exact, (double)SCREE_GAP_REACH * std::min(radius_a, radius_b));
    // positions are off by eps times their own size in the reference's world, which scree does not go through
    const double world = 8 * epsilon * (norm(at_a.position) + norm(at_b.position));
    for (const double found : {gap(body_a, body_b, 0), gap(body_b, body_a, 0)})
    {
        SCREE_CHECK(found <= seen + world);
        SCREE_CHECK(found >= seen - 1024 * epsilon * size - world);
    }
    // what would last too shortly is not told; neither is it told wrongly
    const double rounding = 1024 * epsilon * size + world;
    SCREE_CHECK(gap(body_a, body_b, seen + rounding) <= 0);
    SCREE_CHECK(gap(body_a, body_b, std::max(0.0, seen - rounding)) == gap(body_a, body_b, 0));
}

void test_side_by_side(Random &random)
{
    for (int i = 0; i < 60; ++i)
    {
        Mesh local[2];
        for (Mesh &mesh : local) do
                mesh = shape(random.integer(0, num_shapes() - 3), random);
            while (mesh.triangles.size() > 30);
        Placement at[2] = {random_placement(random), random_placement(random)};
        at[0].scale = random.log_uniform(0.01, 100);
        at[1].scale = at[0].scale * random.log_uniform(0.3, 3);
        at[0].position = at[0].scale * random.uniform(0, 3) * random.direction();
        const Mesh a = placed(local[0], at[0]), b = placed(local[1], at[1]);
        const double apart = std::min(extent(a), extent(b)) * random.log_uniform(1e-5, 1e-1);
        const Mesh beside = brought_together(a, b, -apart, random);
        at[1].position = beside.vertices[0] - b.vertices[0];
        check(local[0], at[0], local[1], at[1]);
    }
}

void test_in_hollows(Random &random)
{
    for (int i = 0; i < 40; ++i)
    {
        const bool is_ring = i % 2 == 0;
        const Mesh hollow = is_ring ? ring(0.6, 6, 0.8) : comb(3, 1);
        const Mesh body = i % 4 < 2 ? cube(1) : schoenhardt(0.5);
        Placement at[2] = {random_placement(random), random_placement(random)};
        at[0].scale = random.log_uniform(0.01, 100);
        // in the middle of the ring's hole, or anywhere near the comb as long as it is free
        Engine engine;
        bool is_free = false;
        while (!is_free)
        {
            at[1].scale = at[0].scale * (is_ring ? random.uniform(0.3, 0.65) : random.uniform(0.05, 0.3));
            Mesh of_hollow = placed(hollow, at[0]);
            Vector lower = of_hollow.vertices[0], upper = lower, middle;
            for (const Vector &v : of_hollow.vertices)
                for (size_t k = 0; k < 3; ++k)
                {
                    lower[k] = std::min(lower[k], v[k]);
                    upper[k] = std::max(upper[k], v[k]);
                }
            for (size_t k = 0; k < 3; ++k)
                middle[k] = is_ring ? (lower[k] + upper[k]) / 2 : random.uniform(lower[k], upper[k]);
            at[1].position = middle;
            const Body a(hollow, at[0]), b(body, at[1]);
            is_free = engine.compute(a, b, SCREE_OVERLAP_FILTERED).status == SCREE_OVERLAP_NONE;
        }
        check(hollow, at[0], body, at[1]);
    }
}

} // namespace

int main()
{
    Random random(11);
    test_side_by_side(random);
    test_in_hollows(random);
    return SCREE_TEST_END();
}
