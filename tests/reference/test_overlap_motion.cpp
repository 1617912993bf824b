// What must change nothing: another order of vertices and triangles, a motion of both bodies together.
#include "check.hpp"
#include "harness.h"

#include <cmath>

using namespace reference;

namespace
{

Pose some_pose(int i, Random &random)
{
    if (i % 2) return ordinary_pose(random.integer(0, num_shapes() - 4), random.integer(0, num_shapes() - 4), random);
    return hard_pose(random.integer(0, num_hard_kinds() - 1), random.integer(0, 23), random);
}

double unit_of(const Pose &pose)
{
    const double larger = std::max(extent(pose.a), extent(pose.b)), smaller = std::min(extent(pose.a), extent(pose.b));
    return epsilon * larger * smaller * smaller;
}

/// Every order is compared with the same exact numbers.
void test_shuffled()
{
    Random random(11);
    Engine engine;
    Statistics statistics;
    for (int i = 0; i < 300; ++i)
    {
        Pose pose = some_pose(i, random);
        Demands demands;
        demands.area = demands.indentation = i % 2;
        pose.a = shuffled(pose.a, random);
        pose.b = shuffled(pose.b, random);
        SCREE_CHECK(check_pose(pose, demands, engine, statistics));
    }
    print_statistics("shuffled", statistics);
}

/// Turns by quarters and shifts by powers of two are exact where the coordinates have few bits: all 24 positions of one
/// degenerate pose must have the volume of the first, which is compared with the reference.
void test_lattice_motion()
{
    Random random(12);
    Engine engine;
    for (int i = 0; i < 200; ++i)
    {
        Pose pose;
        do {
            bool is_exact = false;
            pose = lattice_pose(random, is_exact);
            if (is_exact) break;
        } while (true);
        const double exact = exact_overlap(pose.a, pose.b).volume.high;
        for (int turn = 0; turn < 24; ++turn)
        {
            const Vector shift = {double(random.integer(-8, 8)), double(random.integer(-8, 8)), 0.5};
            const Body a(moved(pose.a, lattice_rotation(turn), shift)), b(moved(pose.b, lattice_rotation(turn), shift));
            const Result r = engine.compute(a, b, turn % 2 ? SCREE_OVERLAP_HIERARCHY : SCREE_OVERLAP_FILTERED);
            SCREE_CHECK_CLOSE(r.volume, exact, volume_bound * unit_of(pose));
        }
    }
}

/// A general motion rounds every vertex anew, by 3 eps of its distance at most: the volume may change by a layer of
/// twice that over the surface of the overlap, and by the errors of both results.
void test_rigid_motion()
{
    Random random(13);
    Engine engine;
    for (int i = 0; i < 300; ++i)
    {
        const Pose pose = some_pose(2 * i + 1, random);
        const Matrix m = random_rotation(random);
        const Vector shift = random.uniform(0, 4) * random.direction();
        const Body a(pose.a), b(pose.b), moved_a(moved(pose.a, m, shift)), moved_b(moved(pose.b, m, shift));
        const Result before = engine.compute(a, b, SCREE_OVERLAP_FILTERED);
        const Result after = engine.compute(moved_a, moved_b, SCREE_OVERLAP_FILTERED);
        const double layer = 2 * 16 * epsilon * (norm(shift) + 4 * (extent(pose.a) + extent(pose.b)));
        const double area = exact_overlap(pose.a, pose.b).area;
        SCREE_CHECK_CLOSE(after.volume, before.volume, 2 * volume_bound * unit_of(pose) + layer * area);
        SCREE_CHECK_INT(after.status, before.status);
        SCREE_CHECK_CLOSE(norm(after.area - m * before.area), 0, 1e-8 * norm(before.area));
    }
}

/// A comb and its teeth and back as separate bodies: the overlaps of the pieces with another body add up to that of the
/// whole, which touches it in several places.
void test_cut_in_pieces()
{
    Random random(14);
    Engine engine;
    for (int i = 0; i < 100; ++i)
    {
        const int num_teeth = random.integer(2, 6), columns = 2 * num_teeth - 1;
        const Mesh other = moved(shape(random.integer(0, 9), random), random_rotation(random),
                                 {random.uniform(0, 1), random.uniform(0.2, 1.2), random.uniform(0, 0.5)});
        const Body whole(comb(num_teeth, 0.5)), b(other);
        std::vector<Mesh> pieces = {box({0, 0, 0}, {1, 0.3, 0.5})};
        for (int k = 0; k < columns; k += 2)
            pieces.push_back(box({double(k) / columns, 0.3, 0}, {double(k + 1) / columns, 1, 0.5}));
        double volume = 0;
        Vector moment = {0, 0, 0};
        for (const Mesh &mesh : pieces)
        {
            const Result r = engine.compute(Body(mesh), b, SCREE_OVERLAP_FILTERED);
            volume += r.volume;
            moment = moment + r.volume * r.centroid;
        }
        const Result r = engine.compute(whole, b, SCREE_OVERLAP_FILTERED);
        const double bound = double(pieces.size() + 1) * volume_bound * epsilon * std::max(1.0, extent(other));
        SCREE_CHECK_CLOSE(volume, r.volume, bound);
        if (r.status != SCREE_OVERLAP_NONE) SCREE_CHECK_CLOSE(norm(moment - r.volume * r.centroid), 0, 2 * bound);
    }
}

} // namespace

int main(void)
{
    SCREE_RUN(test_shuffled);
    SCREE_RUN(test_lattice_motion);
    SCREE_RUN(test_rigid_motion);
    SCREE_RUN(test_cut_in_pieces);
    return SCREE_TEST_END();
}
