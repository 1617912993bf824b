// Ordinary contacts of bodies in their own frames, with position, orientation and scale, as a simulation has them. The
// reference works on world coordinates rounded as `scree overlap --batch` rounds them; scree works in A's frame, so the
// two see bodies that differ by the roundings of the transformations.
#include "check.hpp"
#include "harness.h"

#include <cmath>

using namespace reference;

namespace
{

double farthest(const Mesh &mesh)
{
    double r = 0;
    for (const Vector &v : mesh.vertices) r = std::max(r, norm(v));
    return r;
}

/// Bound on how far a vertex of one transformation lies from that of the other, for a distance |t| between the origins.
/// One transformation: R has entries off by 3 eps (and is used by its inverse, which adds the lack of orthogonality of
/// the rounded quaternion, 4 eps), applying it costs 3 eps per coordinate, the sum with t half an eps of the result;
/// scree does two of them in a row, the reference one. With sqrt(3) for three coordinates: 24 eps (r + |t|) covers it.
double displacement(const Mesh &a, const Placement &at_a, const Mesh &b, const Placement &at_b)
{
    return 24 * epsilon *
           (farthest(a) * at_a.scale + farthest(b) * at_b.scale + norm(at_a.position) + norm(at_b.position));
}

} // namespace

int main(int argc, char **argv)
{
    const Arguments arguments = read_arguments(argc, argv);
    if (!arguments.replay.empty()) return replay(arguments.replay);
    const int num_poses = arguments.num_poses > 0 ? arguments.num_poses : 600;
    Random random(arguments.seed + 100);
    Engine engine;
    Statistics all;
    for (int i = 0; i < num_poses; ++i)
    {
        Pose local;
        Placement at[2];
        local.a = shape(random.integer(0, num_shapes() - 3), random);
        local.b = shape(random.integer(0, num_shapes() - 3), random);
        at[0] = random_placement(random);
        at[1] = random_placement(random);
        at[0].scale = random.log_uniform(0.01, 100);
        at[1].scale = at[0].scale * random.log_uniform(0.3, 3);
        at[0].position = at[0].scale * random.uniform(0, 3) * random.direction();
        const Mesh a = placed(local.a, at[0]), b = placed(local.b, at[1]);
        const double size = std::min(extent(a), extent(b));
        const Mesh together = brought_together(a, b, size * random.log_uniform(1e-4, 5e-2), random);
        at[1].position = together.vertices[0] - b.vertices[0];
        local.kind = "placed";
        Demands demands;
        demands.area = demands.indentation = true;
        demands.area_bound = 1e-8; // the patch is as small as 1e-4 of the size, its edges move by 1e-14
        demands.displacement = displacement(local.a, at[0], local.b, at[1]);
        Statistics statistics;
        SCREE_CHECK(check_placed_pose(local, at[0], at[1], demands, engine, statistics));
        all.add(statistics);
    }
    print_header();
    print_statistics("placed", all);
    SCREE_CHECK_INT(all.num_gross, 0);
    SCREE_CHECK(quantile(all.relative, 0.5) <= 1e-11);
    return SCREE_TEST_END();
}
