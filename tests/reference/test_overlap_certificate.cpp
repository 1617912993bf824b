// The certificate: one decision of each overlap is spoilt on purpose, and it must be noticed wherever it matters; in
// the default scheme the overlap is then computed again and must be right.
#include "check.hpp"
#include "harness.h"

#include <cmath>

extern "C"
{
#include "faulty_overlap.h"
}

using namespace reference;

namespace
{

constexpr double limit = 1e-6; // of the residual; volumes that are right to this count as right

struct Tally
{
    int num_runs = 0, num_wrong = 0, num_noticed = 0, num_wrong_after_fallback = 0;
    double worst_unnoticed = 0;
};

scree_overlap_result run(const Body &a, const Body &b, scree_overlap_scheme scheme, faulty_kind kind, int64_t place,
                         scree_overlap_workspace *workspace)
{
    scree_overlap_options options{};
    options.scheme = scheme;
    scree_overlap_result result{};
    do {
        faulty = faulty_state{};
        faulty.kind = kind;
        faulty.place = place;
        faulty_overlap_compute(a.view(), a.pose(), b.view(), b.pose(), &options, workspace, &result, 1);
    } while (result.status == SCREE_OVERLAP_WORKSPACE_FULL && faulty_workspace_grow(workspace) == SCREE_OK);
    return result;
}

int64_t num_places(faulty_kind kind, const faulty_state &counts)
{
    switch (kind)
    {
    case FAULTY_INVENTED:
        return counts.num_misses;
    case FAULTY_OUTSIDE:
        return counts.num_not_outside;
    default:
        return counts.num_crossings;
    }
}

Tally spoil(faulty_kind kind, int num_poses)
{
    Random random(21);
    Tally tally;
    scree_overlap_workspace *workspace = faulty_workspace_create();
    for (int i = 0; i < num_poses; ++i)
    {
        const int last = num_shapes() - 4;
        const Pose pose = ordinary_pose(random.integer(0, last), random.integer(0, last), random);
        const double exact = exact_overlap(pose.a, pose.b).volume.high;
        const Body a(pose.a), b(pose.b);
        for (scree_overlap_scheme scheme : {SCREE_OVERLAP_HIERARCHY, SCREE_OVERLAP_FILTERED})
        {
            const scree_overlap_result good = run(a, b, scheme, FAULTY_NONE, 0, workspace);
            SCREE_CHECK(std::fabs(good.volume - exact) <= limit * exact && good.residual <= limit);
            const int64_t places = num_places(kind, faulty);
            for (int k = 0; k < 4 && places > 0; ++k)
            {
                const int64_t place = random.integer(0, int(places) - 1);
                const scree_overlap_result r = run(a, b, scheme, kind, place, workspace);
                const double error = std::fabs(r.volume - exact) / exact;
                if (scheme == SCREE_OVERLAP_FILTERED)
                {
                    // noticed faults are gone after the second run; the residual must not hide one
                    tally.num_wrong_after_fallback += error > limit && r.residual <= limit ? 1 : 0;
                    continue;
                }
                ++tally.num_runs;
                if (error <= limit) continue;
                ++tally.num_wrong;
                if (r.residual > limit) ++tally.num_noticed;
                else tally.worst_unnoticed = std::max(tally.worst_unnoticed, error);
            }
        }
    }
    faulty_workspace_destroy(workspace);
    return tally;
}

} // namespace

int main(int argc, char **argv)
{
    const Arguments arguments = read_arguments(argc, argv);
    const int num_poses = arguments.num_poses > 0 ? arguments.num_poses : 200;
    static const char *const names[] = {"none", "missed", "flipped", "invented", "shifted", "outside"};
    std::printf("%-16s %6s %6s %8s %22s %22s\n", "fault", "runs", "wrong", "noticed", "worst not noticed",
                "wrong after fallback");
    for (int kind = FAULTY_MISSED; kind <= FAULTY_OUTSIDE; ++kind)
    {
        const Tally tally = spoil(faulty_kind(kind), num_poses);
        std::printf("%-16s %6d %6d %7.2f%% %22.3g %22d\n", names[kind], tally.num_runs, tally.num_wrong,
                    100.0 * tally.num_noticed / tally.num_wrong, tally.worst_unnoticed, tally.num_wrong_after_fallback);
        SCREE_CHECK(tally.num_wrong > num_poses / 2);
        SCREE_CHECK(tally.num_noticed >= 0.99 * tally.num_wrong);
    }
    return SCREE_TEST_END();
}
