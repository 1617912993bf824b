// Random small bodies on integer lattices, as they are and perturbed by units in the last place, tiny turns and shifts:
// a seeded fuzzer. --poses N for more, --seed S for others.
#include "check.hpp"
#include "harness.h"

using namespace reference;

int main(int argc, char **argv)
{
    const Arguments arguments = read_arguments(argc, argv);
    if (!arguments.replay.empty()) return replay(arguments.replay);
    const int num_poses = arguments.num_poses > 0 ? arguments.num_poses : 50000;
    Random random(arguments.seed);
    Engine engine;
    std::map<std::string, Statistics> by_kind;
    Statistics all;
    for (int i = 0; i < num_poses; ++i)
    {
        bool is_exact = false;
        const Pose pose = lattice_pose(random, is_exact);
        Demands demands;
        demands.lattice_area = is_exact;
        Statistics statistics;
        SCREE_CHECK(check_pose(pose, demands, engine, statistics));
        by_kind[pose.kind].add(statistics);
        all.add(statistics);
    }
    print_header();
    for (const auto &entry : by_kind) print_statistics(entry.first, entry.second);
    print_statistics("all", all);
    SCREE_CHECK_INT(all.num_gross, 0);
    return SCREE_TEST_END();
}
