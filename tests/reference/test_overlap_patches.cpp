// Connected pieces of the overlap, each a contact of its own: their number against Nef polyhedra, each one's measures
// against closed forms, their sums against the merged contact. The torque vector against exact arithmetic and against
// the volume's change under small turns.
#include "cgal_overlap.hpp"
#include "check.hpp"
#include "harness.h"

#include <algorithm>
#include <cmath>

using namespace reference;

namespace
{

constexpr scree_overlap_scheme schemes[] = {SCREE_OVERLAP_FILTERED, SCREE_OVERLAP_HIERARCHY};

/// What one patch must be.
struct Patch
{
    double volume;
    Vector centroid, area, torque;
};

struct Sizes
{
    double larger, smaller, unit;
    explicit Sizes(const Pose &pose)
        : larger(std::max(extent(pose.a), extent(pose.b))), smaller(std::min(extent(pose.a), extent(pose.b))),
          unit(epsilon * larger * smaller * smaller)
    {
    }
};

/// Torque about another point: from x - centroid to x - point.
Vector torque_about(const Vector &torque, const Vector &area, const Vector &centroid, const Vector &point)
{
    return torque + cross(centroid - point, area);
}

void print_pose(const Pose &pose) { std::printf("%s\n", to_json(pose).c_str()); }

/// Volume, first moment, area vector and torque of the patches add up to those of all as one.
void check_sums(const Pose &pose, const std::vector<Result> &patches, const Result &merged)
{
    const Sizes sizes(pose);
    const double n = double(patches.size()) + 1;
    double volume = 0;
    Vector moment{}, area{}, torque{};
    for (const Result &r : patches)
    {
        volume += r.volume;
        moment = moment + r.volume * (r.centroid - merged.centroid);
        area = area + r.area;
        torque = torque + torque_about(r.torque, r.area, r.centroid, merged.centroid);
    }
    const double magnitude = norm(merged.centroid) + sizes.larger;
    SCREE_CHECK_CLOSE(volume, merged.volume, n * volume_bound * sizes.unit);
    if (merged.status == SCREE_OVERLAP_NONE) return;
    // a volume that is off lies anywhere in the smaller body; centroids are rounded
    SCREE_CHECK_CLOSE(norm(moment), 0,
                      n * (2 * volume_bound * sizes.unit * sizes.smaller + 4 * epsilon * magnitude * merged.volume));
    // the same segments about other points: each loses a few roundings of its length times its distance, and all of
    // them together are some tens of the smaller body long
    const double lost = 100 * n * epsilon * sizes.smaller * sizes.larger;
    SCREE_CHECK_CLOSE(norm(area - merged.area), 0, lost);
    SCREE_CHECK_CLOSE(norm(torque - merged.torque), 0,
                      2 * sizes.larger * lost + 4 * n * epsilon * magnitude * norm(merged.area) + n * sizes.unit);
}

/// The patch whose centroid is nearest; patches have no order that means anything.
const Result &nearest(const std::vector<Result> &patches, const Vector &centroid)
{
    return *std::min_element(patches.begin(), patches.end(),
                             [&](const Result &a, const Result &b)
                             { return norm(a.centroid - centroid) < norm(b.centroid - centroid); });
}

/// Both schemes and both orders of the bodies: as many patches as expected, and their sums. Returns the default's.
std::vector<Result> check_number(const Pose &pose, int expected, Engine &engine)
{
    const Body a(pose.a), b(pose.b);
    const int failed = scree_test_num_failed;
    std::vector<Result> first;
    for (const scree_overlap_scheme scheme : schemes)
    {
        for (const bool is_swapped : {false, true})
        {
            const Body &one = is_swapped ? b : a, &two = is_swapped ? a : b;
            const auto patches = engine.patches(one, two, scheme);
            const Result merged = engine.compute(one, two, scheme);
            const bool has_volume = patches.size() > 1 || patches[0].status != SCREE_OVERLAP_NONE;
            SCREE_CHECK_INT(has_volume ? patches.size() : 0, expected);
            check_sums(pose, patches, merged);
            if (first.empty()) first = patches;
        }
    }
    if (scree_test_num_failed > failed) print_pose(pose);
    return first;
}

// number of patches

/// Bodies shifted by a random hundredth of their size: what coincides as constructed (faces, edges, corners) does not
/// any more. With coincidences, whether two pieces touch in a point or edge is a matter of rounding.
Pose without_coincidences(Pose pose, Random &random)
{
    pose.b = shifted(pose.b, (0.01 * Sizes(pose).smaller) * random.direction());
    return pose;
}

/// Deep, so that there are several pieces more often.
Pose deep_pose(Random &random)
{
    static constexpr int kinds[] = {3, 4, 5, 9}; // box, L, U, ring
    Pose pose;
    pose.kind = "deep";
    const auto one = [&](int kind) { return kind == 4 ? comb(random.integer(2, 3), 0.4) : shape(kinds[kind], random); };
    const int kind_a = random.integer(0, 4), kind_b = random.integer(0, 4);
    pose.a = moved(one(kind_a), random_rotation(random), {0, 0, 0});
    pose.b = moved(one(kind_b), random_rotation(random), random.uniform(0, 0.6) * random.direction());
    return pose;
}

void test_number_against_nef()
{
    Random random(21);
    Engine engine;
    int num_poses = 0, num_several = 0;
    const auto compare = [&](const Pose &pose)
    {
        const NefOverlap nef = nef_overlap(pose.a, pose.b);
        const auto patches = check_number(pose, nef.num_patches, engine);
        double volume = 0;
        for (const Result &r : patches) volume += r.volume;
        SCREE_CHECK_CLOSE(volume, nef.volume.high, double(patches.size()) * volume_bound * Sizes(pose).unit);
        ++num_poses;
        num_several += nef.num_patches > 1;
    };
    for (int i = 0; i < 20; ++i) compare(ordinary_pose(random.integer(0, 8), random.integer(0, 8), random));
    for (int i = 0; i < 40; ++i) compare(deep_pose(random));
    for (int kind = 0; kind < num_hard_kinds(); ++kind)
    {
        const std::string name = hard_kind_name(kind);
        if (name != "several patches" && name != "two combs" && name != "linked rings" && name != "bar through ring" &&
            name != "two L" && name != "bodies of two pieces")
            continue;
        for (int i = 0; i < 8; ++i) compare(without_coincidences(hard_pose(kind, 3 * i, random), random));
    }
    std::printf("%d poses compared with Nef polyhedra, %d in several pieces\n", num_poses, num_several);
    SCREE_CHECK(num_several > num_poses / 4);
}

// closed forms

/// As constructed, and moved as a whole: rounded anew, so that each vertex lies elsewhere by 16 eps of its distance.
void check_patches(const Mesh &a, const Mesh &b, const std::vector<Patch> &expected, Engine &engine)
{
    Random random(22);
    for (int turn = 0; turn < 6; ++turn)
    {
        const bool is_moved = turn > 0;
        const Matrix m = is_moved ? random_rotation(random) : lattice_rotation(0);
        const Vector shift = is_moved ? random.uniform(0, 4) * random.direction() : Vector{0, 0, 0};
        Pose pose;
        pose.a = moved(a, m, shift);
        pose.b = moved(b, m, shift);
        const Sizes sizes(pose);
        const double displacement = is_moved ? 32 * epsilon * (norm(shift) + 4 * sizes.larger) : 0;
        const auto patches = check_number(pose, int(expected.size()), engine);
        for (const Patch &patch : expected)
        {
            const Vector centroid = m * patch.centroid + shift;
            const Result &r = nearest(patches, centroid);
            // the surface of a patch of any of these is below six times the smaller size squared, edges below 40 times
            const double layer = displacement * 6 * sizes.smaller * sizes.smaller;
            const double volume_error = volume_bound * sizes.unit + layer;
            SCREE_CHECK_CLOSE(r.volume, patch.volume, volume_error);
            const double centroid_error =
                2 * sizes.smaller * volume_error / patch.volume + 4 * epsilon * norm(centroid) + displacement;
            SCREE_CHECK_CLOSE(norm(r.centroid - centroid), 0, centroid_error);
            const double area_error = (100 * epsilon * sizes.larger + displacement) * 40 * sizes.smaller;
            SCREE_CHECK_CLOSE(norm(r.area - m * patch.area), 0, area_error);
            SCREE_CHECK_CLOSE(norm(r.torque - m * patch.torque), 0,
                              2 * sizes.smaller * area_error + centroid_error * norm(patch.area));
        }
    }
}

/// A U in the xy plane, its legs at x in [0, 1] and [2, 3] of the given heights.
Mesh u_with_legs(double left, double right, double width)
{
    return extrusion({{0, 0}, {1, 0}, {1, 1}, {1, left}, {0, left}, {2, 0}, {3, 0}, {3, right}, {2, right}, {2, 1}},
                     {{0, 1, 2}, {0, 2, 4}, {2, 3, 4}, {1, 5, 9}, {1, 9, 2}, {5, 6, 7}, {5, 7, 9}, {9, 7, 8}}, 0,
                     width);
}

void test_u_on_floor()
{
    Engine engine;
    // both legs end in a floor at y = 2, one deeper than the other
    const Mesh u = u_with_legs(2.25, 2.0625, 0.5), floor = box({-4, 2, -3}, {8, 3, 5});
    check_patches(
        u, floor,
        {{0.125, {0.5, 2.125, 0.25}, {0, 0.5, 0}, {0, 0, 0}}, {0.03125, {2.5, 2.03125, 0.25}, {0, 0.5, 0}, {0, 0, 0}}},
        engine);
    // and over the edge of the floor with a part of the left leg, which then also has a side in it: in A's surface
    // there are the end, area 0.75 by 0.5 at y = 2.25, and three sides of which two cancel; the floor's side lets x =
    // 0.25 open
    const Mesh edge = box({0.25, 2, -3}, {8, 3, 5});
    const Vector area = {0.125, 0.375, 0};
    // about the centroid (0.625, 2.125, 0.25): the end's middle is above it, the side x = 1 beside it, z sides cancel
    check_patches(
        u, edge,
        {{0.09375, {0.625, 2.125, 0.25}, area, {0, 0, 0}}, {0.03125, {2.5, 2.03125, 0.25}, {0, 0.5, 0}, {0, 0, 0}}},
        engine);
}

double ring_area(int num_corners, double inner)
{
    return num_corners / 2.0 * std::sin(2 * M_PI / num_corners) * (1 - inner * inner);
}

/// The plate's face is cut in a ring; with a pin in the middle of it there is another piece within.
void test_ring_in_plate()
{
    Engine engine;
    for (const double middle : {0.0, 4.0}) // across the diagonal of the plate's face, and within one triangle
    {
        const Mesh plate = box({middle - 12, -middle - 12, -1}, {middle + 12, -middle + 12, 0.125});
        for (const int num_corners : {4, 12})
        {
            const Mesh a = shifted(ring(0.5, num_corners, 0.5), {0, 0, 0.25});
            const double area = ring_area(num_corners, 0.5);
            const Patch of_ring = {area / 8, {0, 0, 0.0625}, {0, 0, -area}, {0, 0, 0}};
            check_patches(a, plate, {of_ring}, engine);
            const Mesh pin = box({-0.125, -0.125, 0.0625}, {0.125, 0.125, 1});
            const Patch of_pin = {1.0 / 256, {0, 0, 0.09375}, {0, 0, -0.0625}, {0, 0, 0}};
            check_patches(joined(a, pin), plate, {of_ring, of_pin}, engine);
        }
    }
}

/// A tube through a thin plate: no edge of the solid leads from its outer wall to the inner one where the plate's faces
/// are whole, only the holes in these faces say that both are of one piece, and not of the post beside it, which is the
/// largest. A pin in the tube is another.
void test_tube_through_plate()
{
    Engine engine;
    for (const double middle : {0.0, 4.0})
    {
        const Mesh plate = box({middle - 12, -middle - 12, 0.0625}, {middle + 12, -middle + 12, 0.125});
        for (const int num_corners : {4, 12})
        {
            const Mesh tube = shifted(ring(0.5, num_corners, 0.5), {0, 0, 0.25});
            const Mesh a = joined(tube, box({2, 0, -1}, {4, 2, 1}));
            const Patch of_ring = {ring_area(num_corners, 0.5) / 16, {0, 0, 0.09375}, {0, 0, 0}, {0, 0, 0}};
            const Patch of_post = {0.25, {3, 1, 0.09375}, {0, 0, 0}, {0, 0, 0}};
            check_patches(tube, plate, {of_ring}, engine);
            check_patches(a, plate, {of_ring, of_post}, engine);
            const Mesh pin = box({-0.25, 0, 0.109375}, {-0.125, 0.125, 1});
            const Patch of_pin = {1.0 / 4096, {-0.1875, 0.0625, 0.1171875}, {0, 0, -1.0 / 64}, {0, 0, 0}};
            check_patches(joined(a, pin), plate, {of_ring, of_post, of_pin}, engine);
        }
    }
}

Mesh inside_out(Mesh mesh)
{
    for (Triangle &t : mesh.triangles) std::swap(t[1], t[2]);
    mesh.cells.clear();
    return mesh;
}

void test_hollows()
{
    Engine engine;
    const Mesh hollow = joined(box({0, 0, 0}, {1, 1, 1}), inside_out(box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.5})));
    const double inner = 0.5 * 0.5 * 0.25, volume = 1 - inner;
    const Vector centroid = {0.5, 0.5, (0.5 - inner * 0.375) / volume};
    // wholly inside: the surface is closed
    check_patches(hollow, box({-1, -1, -1}, {2, 2, 2}), {{volume, centroid, {0, 0, 0}, {0, 0, 0}}}, engine);
    // beside a larger piece without one
    const Mesh pair = joined(hollow, box({2, 0, 0}, {4, 2, 2}));
    check_patches(pair, box({-1, -1, -1}, {5, 3, 3}),
                  {{volume, centroid, {0, 0, 0}, {0, 0, 0}}, {8, {3, 1, 1}, {0, 0, 0}, {0, 0, 0}}}, engine);
    // cut below the hollow's top, which leaves a cup whose rim has a hole; and above it
    const double cup = 0.375 - 0.25 * 0.125, cut = 0.75 - inner;
    check_patches(hollow, box({-1, -1, -1}, {2, 2, 0.375}),
                  {{cup, {0.5, 0.5, (0.375 * 0.1875 - 0.03125 * 0.3125) / cup}, {0, 0, -0.75}, {0, 0, 0}}}, engine);
    check_patches(hollow, box({-1, -1, -1}, {2, 2, 0.75}),
                  {{cut, {0.5, 0.5, (0.75 * 0.375 - inner * 0.375) / cut}, {0, 0, -1}, {0, 0, 0}}}, engine);
}

// torque vector

/// Against the exact reference. A piece of A's surface that is taken for inside counts with its area in S and with its
/// distance from the centroid on top of that in the torque.
void test_torque_is_exact()
{
    Random random(23);
    Engine engine;
    double worst = 0;
    for (int i = 0; i < 300; ++i)
    {
        Pose pose = ordinary_pose(random.integer(0, num_shapes() - 4), random.integer(0, num_shapes() - 4), random);
        const double size = random.log_uniform(1e-3, 1e3);
        pose.a = scaled(pose.a, size);
        pose.b = scaled(pose.b, size);
        const Overlap exact = exact_overlap(pose.a, pose.b);
        const Body a(pose.a), b(pose.b);
        for (const bool is_swapped : {false, true})
        {
            const Body &one = is_swapped ? b : a, &two = is_swapped ? a : b;
            const bool use_convex_path = i % 4 < 2;
            const Result r = engine.compute(one, two, schemes[i % 2], use_convex_path);
            if (r.status != SCREE_OVERLAP_TOUCHING) continue;
            const double reach = r.radius + r.indentation, sign = is_swapped ? -1 : 1;
            const double error = norm(sign * r.torque - exact.torque) / (exact.area * reach);
            worst = std::max(worst, error);
            SCREE_CHECK(error <= 1e-9); // as demanded of the area vector
            if (error > 1e-9) print_pose(pose);
        }
    }
    std::printf("worst error of the torque vector: %.2g of area times reach\n", worst);
}

double turned_volume(const Pose &pose, const Vector &axis, double angle, const Vector &centre, Engine &engine,
                     double &along)
{
    const Matrix m = rotation(axis, angle);
    const Body a(moved(pose.a, m, centre - m * centre)), b(pose.b);
    const Result r = engine.compute(a, b, SCREE_OVERLAP_FILTERED);
    along = dot(axis, torque_about(r.torque, r.area, r.centroid, centre));
    return r.volume;
}

/// dV = t . M for a small turn t of A about the contact point. The volume between two angles is the integral of t . M,
/// which for a step so small that t . M only rises or only falls lies between the values at its ends.
void test_torque_turns_volume()
{
    Random random(24);
    Engine engine;
    int num_checked = 0;
    double widest = 0;
    for (int i = 0; i < 200; ++i)
    {
        Pose pose =
            i % 2 ? deep_pose(random)
                  : ordinary_pose(random.integer(0, num_shapes() - 4), random.integer(0, num_shapes() - 4), random);
        const double size = random.log_uniform(1e-3, 1e3);
        pose.a = scaled(pose.a, size);
        pose.b = scaled(pose.b, size);
        const Result r = engine.compute(Body(pose.a), Body(pose.b), SCREE_OVERLAP_FILTERED);
        if (r.status != SCREE_OVERLAP_TOUCHING) continue;
        const Vector axis = random.direction();
        const double reach = r.radius + r.indentation, h = 1e-4 * r.indentation / reach;
        double m[3], v[3];
        for (int k = 0; k < 3; ++k) v[k] = turned_volume(pose, axis, (k - 1) * h, r.centroid, engine, m[k]);
        double least = 0, most = 0;
        for (int k = 0; k < 2; ++k)
        {
            least += h * std::min(m[k], m[k + 1]);
            most += h * std::max(m[k], m[k + 1]);
        }
        // vertices are rounded anew at each angle, by a layer of 16 eps over the patch
        const Sizes sizes(pose);
        const double area = exact_overlap(pose.a, pose.b).area;
        const double rounding = 2 * volume_bound * sizes.unit + 64 * epsilon * (sizes.larger + norm(r.centroid)) * area;
        const double change = v[2] - v[0];
        const bool is_between = change >= least - rounding && change <= most + rounding;
        SCREE_CHECK(is_between);
        if (!is_between)
        {
            std::printf("dV %.17g, between %.17g and %.17g, rounding %.3g\n", change, least, most, rounding);
            print_pose(pose);
        }
        // where the rounding is as large as the change itself, nothing was shown
        if (rounding > 1e-2 * 2 * h * area * reach) continue;
        ++num_checked;
        widest = std::max(widest, (most - least) / (2 * h * area * reach));
    }
    std::printf("%d turns checked, intervals up to %.2g of area times reach wide\n", num_checked, widest);
    SCREE_CHECK(num_checked > 50);
}

} // namespace

int main(void)
{
    SCREE_RUN(test_u_on_floor);
    SCREE_RUN(test_ring_in_plate);
    SCREE_RUN(test_tube_through_plate);
    SCREE_RUN(test_hollows);
    SCREE_RUN(test_torque_is_exact);
    SCREE_RUN(test_torque_turns_volume);
    SCREE_RUN(test_number_against_nef);
    return SCREE_TEST_END();
}
