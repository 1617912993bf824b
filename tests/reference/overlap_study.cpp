// Numbers behind validation/overlap: errors and times of scree's overlap, and of CGAL's on the same poses, as lines of
// JSON. Built once per precision; the single-precision program leaves CGAL out.
// Usage: overlap_study [poses per shape, default 40] [poses per hard kind, default 60] [lattice poses, default 20000]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "check.hpp"
#ifndef SCREE_SINGLE
#include "cgal_overlap.hpp"
#endif

using namespace reference;

namespace
{

#ifdef SCREE_SINGLE
const char *const precision = "single";
#else
const char *const precision = "double";
#endif

struct Case
{
    std::string name;
    int num_triangles;
    Pose local; ///< bodies in their own frames
    Placement at[2];
    double depth; ///< [1] of the smaller size
};

void print_measures(const char *name, const Result &r, const Overlap &exact, double size)
{
    const double volume = exact.volume.high;
    double centroid = 0;
    for (size_t k = 0; k < 3; ++k)
    {
        const double d = (r.centroid[k] - exact.centroid[k].high) - exact.centroid[k].low;
        centroid += d * d;
    }
    const Vector area = 0.5 * (exact.area_inner + exact.area_outer);
    std::printf(", \"%s_volume\": %.3g, \"%s_area\": %.3g, \"%s_centroid\": %.3g", name,
                std::fabs((r.volume - volume) - exact.volume.low) / volume, name, norm(r.area - area) / norm(area),
                name, std::sqrt(centroid) / size);
}

#ifndef SCREE_SINGLE
double seconds_of_exact(const Mesh &a, const Mesh &b)
{
    const auto start = std::chrono::steady_clock::now();
    exact_overlap(a, b);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void print_cgal(const char *name, Corefinement (*compute)(const Mesh &, const Mesh &), const Case &c, const Mesh &a,
                const Mesh &b, double volume)
{
    Corefinement best = compute(a, b);
    const int repeats = c.num_triangles > 100 ? 2 : 4;
    for (int i = 1; i < repeats && best.is_done; ++i) best.seconds = std::min(best.seconds, compute(a, b).seconds);
    if (!best.is_done) return;
    std::printf(", \"%s_s\": %.4g, \"%s_volume\": %.3g", name, best.seconds, name,
                std::fabs(best.volume - volume) / volume);
}
#endif

/// One line: errors of both schemes on the world coordinates, times on the placed bodies, all in the same run.
void study_case(const Case &c, Engine &engine)
{
    const Mesh a = placed(to_precision(c.local.a), c.at[0]), b = placed(to_precision(c.local.b), c.at[1]);
    const Overlap exact = exact_overlap(a, b);
    if (exact.volume.high <= 0) return;
    const Body world_a(a), world_b(b), body_a(c.local.a, c.at[0]), body_b(c.local.b, c.at[1]);
    const double size = std::min(extent(a), extent(b));
    std::printf("{\"part\": \"size\", \"precision\": \"%s\", \"shape\": \"%s\", \"triangles\": %d, \"depth\": %.4g",
                precision, c.name.c_str(), c.num_triangles, c.depth);
    print_measures("filtered", engine.compute(world_a, world_b, SCREE_OVERLAP_FILTERED), exact, size);
    print_measures("hierarchy", engine.compute(world_a, world_b, SCREE_OVERLAP_HIERARCHY), exact, size);
    // flat faces lose that by being turned: the world's bodies may not be convex any more where their own frames' are
    if (world_a.view()->is_convex && world_b.view()->is_convex)
        print_measures("convex", engine.compute(world_a, world_b, SCREE_OVERLAP_FILTERED, true), exact, size);
    if (body_a.view()->is_convex && body_b.view()->is_convex)
        std::printf(", \"convex_s\": %.4g", engine.seconds(body_a, body_b, SCREE_OVERLAP_FILTERED, true));
    std::printf(", \"filtered_s\": %.4g, \"hierarchy_s\": %.4g", engine.seconds(body_a, body_b, SCREE_OVERLAP_FILTERED),
                engine.seconds(body_a, body_b, SCREE_OVERLAP_HIERARCHY));
#ifndef SCREE_SINGLE
    std::printf(", \"rational_s\": %.4g", seconds_of_exact(a, b));
    print_cgal("cgal_exact", corefined_overlap_exact, c, a, b, exact.volume.high);
    print_cgal("cgal_inexact", corefined_overlap_inexact, c, a, b, exact.volume.high);
#endif
    std::printf("}\n");
    std::fflush(stdout);
}

Case make_case(const std::string &name, const Mesh &a, const Mesh &b, Random &random)
{
    Case c;
    c.name = name;
    c.num_triangles = int(a.triangles.size());
    c.local = {name, to_precision(a), to_precision(b), true};
    c.at[0] = random_placement(random);
    c.at[1] = random_placement(random);
    c.depth = random.log_uniform(1e-4, 5e-2);
    const Mesh world_a = placed(c.local.a, c.at[0]), world_b = placed(c.local.b, c.at[1]);
    const double size = std::min(extent(world_a), extent(world_b));
    const Mesh together = brought_together(world_a, world_b, c.depth * size, random);
    c.at[1].position = together.vertices[0] - world_b.vertices[0];
    c.at[1] = to_precision(c.at[1]);
    return c;
}

void study_sizes(int num_poses)
{
    Random random(31);
    Engine engine;
    for (int i = 0; i < num_poses; ++i)
    {
        study_case(make_case("tetrahedron", tetrahedron(0.6), tetrahedron(0.6), random), engine);
        study_case(make_case("Schoenhardt", schoenhardt(0.55), schoenhardt(0.55), random), engine);
        study_case(make_case("box", cube(0.8), cube(0.8), random), engine);
        study_case(make_case("L", shifted(l_shape(0.4), {-0.5, -0.5, -0.2}), shifted(l_shape(0.4), {-0.5, -0.5, -0.2}),
                             random),
                   engine);
        for (int frequency = 1; frequency <= 7; ++frequency)
        {
            if (frequency > 3 && i % 2) continue;
            study_case(make_case("sphere", sphere(0.5, frequency), sphere(0.5, frequency), random), engine);
            const Mesh a = rock(random.bits(), frequency, 0.25), b = rock(random.bits(), frequency, 0.25);
            study_case(make_case("rock", a, b, random), engine);
        }
    }
}

void print_kind(const char *part, const std::string &name, const Statistics &s)
{
    std::printf(
        "{\"part\": \"%s\", \"precision\": \"%s\", \"name\": \"%s\", \"poses\": %d, \"failed\": %d, \"gross\": %d, "
        "\"units\": %.3g, \"negative\": %.3g, \"fallbacks\": %d}\n",
        part, precision, name.c_str(), s.num_poses, s.num_failed, s.num_gross, s.worst_units, s.worst_negative,
        s.num_fallbacks);
    std::fflush(stdout);
}

void study_hard(int num_poses)
{
    Engine engine;
    for (int kind = 0; kind < num_hard_kinds(); ++kind)
    {
        Random random(77000 + uint64_t(kind));
        Statistics statistics;
        for (int i = 0; i < num_poses; ++i)
        {
            const Pose pose = hard_pose(kind, i, random);
            if (is_representable(pose)) check_pose(pose, {}, engine, statistics);
        }
        print_kind("kind", hard_kind_name(kind), statistics);
    }
}

void study_lattice(int num_poses)
{
    Engine engine;
    Random random(78);
    std::map<std::string, Statistics> by_kind;
    for (int i = 0; i < num_poses; ++i)
    {
        bool is_exact = false;
        const Pose pose = lattice_pose(random, is_exact);
        check_pose(pose, {}, engine, by_kind[pose.kind]);
    }
    for (const auto &entry : by_kind) print_kind("lattice", entry.first, entry.second);
}

} // namespace

int main(int argc, char **argv)
{
    study_sizes(argc > 1 ? std::atoi(argv[1]) : 40);
    study_hard(argc > 2 ? std::atoi(argv[2]) : 60);
    study_lattice(argc > 3 ? std::atoi(argv[3]) : 20000);
    return 0;
}
