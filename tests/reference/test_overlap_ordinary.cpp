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
    // A vertex is rounded by 6e-8 of its coordinate, the depth is down to 1e-4: digits are few, but none is lost beyond
    // that. The bounds are eps(float)/eps(double) times looser than those of double would be, cut off at "all wrong".
    demands.area_bound = 0.5;
    demands.centroid_bound = 0.1;
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
    std::printf("worst residual %.3g\n", all.worst_residual);
    SCREE_CHECK_INT(all.num_gross, 0);
#ifndef SCREE_SINGLE
    SCREE_CHECK(quantile(all.relative, 0.5) <= 1e-12);
#else
    SCREE_CHECK(quantile(all.relative, 0.5) <= 1e-12 * (FLT_EPSILON / DBL_EPSILON));
#endif
    // ordinary contacts have a normal and need no fallback
    SCREE_CHECK(all.num_touching >= 4 * all.num_poses * 95 / 100);
    return SCREE_TEST_END();
}
