// Hard poses in named kinds against the exact overlap: degenerate, nearly degenerate, extreme in shape, size or place.
#include "check.hpp"
#include "harness.h"

using namespace reference;

int main(int argc, char **argv)
{
    const Arguments arguments = read_arguments(argc, argv);
    if (!arguments.replay.empty()) return replay(arguments.replay);
    const int num_poses = arguments.num_poses > 0 ? arguments.num_poses : 60;
    Engine engine;
    Statistics all;
    print_header();
    for (int kind = 0; kind < num_hard_kinds(); ++kind)
    {
        if (arguments.kind >= 0 && kind != arguments.kind) continue;
        Random random(arguments.seed * 1000 + uint64_t(kind));
        Statistics statistics;
        for (int i = 0; i < num_poses; ++i)
        {
            const Pose pose = hard_pose(kind, i, random);
            if (!is_representable(pose)) continue;
            Demands demands;
            demands.area = pose.is_robust;
            // a patch as small as 1e-8 of the larger body, whose vertices are right to eps times its size
            demands.area_bound = 1e9 * epsilon;
            SCREE_CHECK(check_pose(pose, demands, engine, statistics));
        }
        print_statistics(hard_kind_name(kind), statistics);
        all.add(statistics);
    }
    print_statistics("all", all);
    SCREE_CHECK_INT(all.num_gross, 0);
    return SCREE_TEST_END();
}
