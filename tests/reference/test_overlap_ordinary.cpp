// Ordinary contacts, 4 to about 1000 triangles, against the exact overlap: relative errors of all measures.
#include "check.hpp"
#include "harness.h"

using namespace reference;

int main(int argc, char **argv)
{
    const Arguments arguments = read_arguments(argc, argv);
    if (!arguments.replay.empty()) return replay(arguments.replay);
    const int num_poses = arguments.num_poses > 0 ? arguments.num_poses : 2000;
    Random random(arguments.seed);
    Engine engine;
    Statistics all;
    std::map<std::string, Statistics> by_shape;
    Demands demands;
    demands.area = true;
    demands.indentation = true;
#ifdef SCREE_SINGLE
    // the same bounds in units of float's eps, 5e8 times that of double, would be no bounds: these are what is left of
    // the digits at a depth of 1e-4, where a vertex is rounded by 1e-3 of the depth
    demands.area_bound = 1e-2;
    demands.centroid_bound = 1e-2;
#else
    demands.area_bound = 1e-9;
    demands.centroid_bound = 1e-9;
    demands.volume_relative = 1e-8;
#endif
    for (int i = 0; i < num_poses; ++i)
    {
        // large bodies are slow in exact arithmetic: the last two shapes in one pose of eight
        const int num_small = num_shapes() - 2;
        const int a = i % 8 ? random.integer(0, num_small - 1) : random.integer(num_small, num_shapes() - 1);
        const int b = i % 16 ? random.integer(0, num_small - 1) : random.integer(num_small, num_shapes() - 1);
        const Pose pose = ordinary_pose(a, b, random);
        Statistics statistics;
        SCREE_CHECK(check_pose(pose, demands, engine, statistics));
        by_shape[shape_name(a)].add(statistics);
        all.add(statistics);
    }
    print_header();
    for (const auto &entry : by_shape) print_statistics(entry.first, entry.second);
    print_statistics("all", all);
    std::printf("worst residual %.3g, %d of %d results have a normal\n", all.worst_residual, all.num_touching,
                all.num_results);
    SCREE_CHECK_INT(all.num_gross, 0);
#ifndef SCREE_SINGLE
    SCREE_CHECK(quantile(all.relative, 0.5) <= 1e-12);
    SCREE_CHECK(all.num_touching >= all.num_results * 99 / 100); // a sharp tip at 1e-4 may have less than 10 units
    SCREE_CHECK_INT(all.num_fallbacks, 0);
#else
    SCREE_CHECK(quantile(all.relative, 0.5) <= 1e-4);
    SCREE_CHECK(all.num_touching >= all.num_results / 2); // the volume of the others is noise in float
#endif
    return SCREE_TEST_END();
}
