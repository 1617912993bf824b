#include "poses.hpp"

#include <cmath>

namespace reference
{
namespace
{

constexpr double pi = 3.14159265358979323846;

/// Multiple of 1/16 in [lower, upper].
double sixteenth(Random &r, double lower, double upper)
{
    return r.integer(int(std::ceil(16 * lower)), int(std::floor(16 * upper))) / 16.0;
}

Matrix turned(const Vector &axis, double angle) { return rotation((1 / norm(axis)) * axis, angle); }

Mesh unit_box() { return box({0, 0, 0}, {1, 1, 1}); }
Mesh block(Random &r)
{
    const double x = sixteenth(r, 0.25, 2), y = sixteenth(r, 0.25, 2), z = sixteenth(r, 0.25, 1);
    return box({0, 0, 0}, {x, y, z});
}
Pose pair(Mesh a, Mesh b)
{
    Pose pose;
    pose.a = std::move(a);
    pose.b = std::move(b);
    return pose;
}

// coplanar faces, opposite sense

Pose stacked_faces(Random &r, int)
{
    const double x = sixteenth(r, 0.25, 2), y = sixteenth(r, 0.25, 2);
    return pair(box({0, 0, 0}, {x, y, 1}), box({0, 0, 1}, {x, y, 1.5}));
}
Pose shifted_faces(Random &r, int)
{
    return pair(unit_box(), shifted(block(r), {sixteenth(r, -0.5, 0.75), sixteenth(r, -0.5, 0.75), 1}));
}
Pose turned_faces(Random &r, int)
{
    const Mesh b = moved(shifted(block(r), {-0.25, -0.25, 0}), turned({0, 0, 1}, r.uniform(0, 2 * pi)), {0.5, 0.5, 1});
    return pair(unit_box(), b);
}
Pose filled_gap(Random &r, int)
{
    // a U and the block that fills it: three coplanar pairs, no volume
    const double width = sixteenth(r, 0.25, 1);
    const Mesh u = stretched(u_shape(width), {3, 1, 1});
    return pair(u, box({1, 0.3, 0}, {2, sixteenth(r, 0.5, 1.5), width}));
}

// coplanar faces, same sense

Pose same_sense(Random &r, int)
{
    return pair(unit_box(), shifted(block(r), {sixteenth(r, -0.5, 0.75), sixteenth(r, -0.5, 0.75), 0}));
}
Pose same_sense_turned(Random &r, int)
{
    const Mesh b = moved(shifted(block(r), {-0.25, -0.25, 0}), turned({0, 0, 1}, r.uniform(0, 2 * pi)), {0.5, 0.5, 0});
    return pair(unit_box(), b);
}
Pose slabs(Random &r, int)
{
    // the same two planes bound both
    Mesh a = box({0, 0, 0}, {1, 1, 0.25}), b = box({0, 0, 0}, {1, 1, 0.25});
    b = shifted(b, {sixteenth(r, 0, 0.9), sixteenth(r, 0, 0.9), 0});
    return pair(a, b);
}
Pose prisms_turned(Random &r, int)
{
    // two planes and the axis in common
    const Mesh a = prism(r.integer(3, 12), 1), b = prism(r.integer(3, 12), 1);
    return pair(a, moved(b, turned({0, 0, 1}, r.uniform(0, 2 * pi)), {0, 0, 0}));
}

// shared edges, vertices on faces, edges and vertices

Pose shared_edge(Random &r, int)
{
    const Mesh b = block(r);
    return pair(box({-1, -1, 0}, {0, 0, 1}), b); // outside of each other, along z
}
Pose shared_edge_inside(Random &r, int)
{
    const Mesh a = extrusion({{0, 0}, {1, -0.5}, {1, 0.5}}, {{0, 1, 2}}, 0, 1);
    const Mesh b = extrusion({{0, 0}, {1, sixteenth(r, -0.25, 0.25)}, {1, sixteenth(r, 0.5, 1)}}, {{0, 1, 2}},
                             sixteenth(r, -0.5, 0.5), 1);
    return pair(a, b);
}
Pose vertex_on_face(Random &r, int i)
{
    const Vector at = {sixteenth(r, 0.25, 0.75), sixteenth(r, 0.25, 0.75), 1};
    const double sense = i % 2 ? -1 : 1; // from outside, or from inside
    const Mesh tip = mesh_of_cells(
        {{0, 0, 0}, {0.25, 0, sense * 0.5}, {-0.25, 0.125, sense * 0.5}, {0, -0.25, sense * 0.5}}, {{0, 1, 2, 3}});
    return pair(unit_box(), shifted(tip, at));
}
Pose vertex_on_edge(Random &r, int)
{
    return pair(unit_box(), shifted(octahedron(0.5), {sixteenth(r, 0.25, 0.75), r.integer(0, 2) * 0.5 - 0.5, 1}));
}
Pose vertex_on_vertex(Random &r, int)
{
    const Vector at = {double(r.integer(0, 1)), double(r.integer(0, 1)), double(r.integer(0, 1))};
    const Mesh b = r.integer(0, 1) ? octahedron(0.5) : cube(1);
    const Vector to = {r.integer(-1, 1) * 0.5, r.integer(-1, 1) * 0.5, r.integer(-1, 1) * 0.5};
    return pair(unit_box(), shifted(b, at + to));
}
Pose crossing_edges(Random &r, int i)
{
    // an edge of each, at right angles, through one point; touching from outside, or with the bodies on the same side
    const Mesh a = extrusion({{-1, -1}, {1, -1}, {0, 0}}, {{0, 1, 2}}, -1, 1);
    Mesh b = extrusion({{0, 0}, {1, 1}, {-1, 1}}, {{0, 1, 2}}, -1, 1);
    if (i % 2) b = moved(b, lattice_rotation(12), {0, 0, 0});
    b = moved(b, {Vector{0, 0, 1}, Vector{0, 1, 0}, Vector{-1, 0, 0}}, {0, 0, 0});
    return pair(a, shifted(b, {sixteenth(r, -0.5, 0.5), 0, sixteenth(r, -0.5, 0.5)}));
}
Pose two_tetrahedra(Random &r, int)
{
    // stella octangula: every edge crosses one of the other body in its middle
    const Mesh a = mesh_of_cells({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2, 3}});
    const double scale = r.integer(0, 1) ? 1 : sixteenth(r, 0.5, 1.5);
    return pair(a, moved(a, {Vector{0, scale, 0}, Vector{-scale, 0, 0}, Vector{0, 0, scale}}, {0, 0, 0}));
}
Pose cube_and_octahedron(Random &r, int)
{
    // radius 1: vertices on faces; 2: edges cross edges; 3: vertices on faces
    const double radius = 0.5 * r.integer(2, 6);
    return pair(cube(2), octahedron(radius));
}

// the same body, one inside the other

Pose identical(Random &r, int i)
{
    const Mesh a = shape(i % 12, r);
    return pair(a, a);
}
Pose identical_shuffled(Random &r, int i)
{
    const Mesh a = shape(i % 12, r);
    return pair(a, shuffled(a, r));
}
Pose nearly_identical(Random &r, int i)
{
    const Mesh a = shape(i % 10, r);
    const double tiny = r.log_uniform(1e-16, 1e-3);
    if (i % 2) return pair(a, shifted(a, tiny * r.direction()));
    return pair(a, moved(a, rotation(r.direction(), tiny), {0, 0, 0}));
}
Pose nested(Random &r, int i)
{
    const Mesh b = moved(scaled(shape(i % 12, r), 0.3), random_rotation(r), 0.2 * r.direction());
    return i % 2 ? pair(b, cube(2)) : pair(sphere(1, 3), b);
}
Pose nested_common_face(Random &r, int)
{
    const Mesh b = box({sixteenth(r, 0.1, 0.4), sixteenth(r, 0.1, 0.4), 0}, {0.5, 0.75, sixteenth(r, 0.1, 0.9)});
    return r.integer(0, 1) ? pair(unit_box(), b) : pair(b, unit_box());
}
Pose nested_common_edge(Random &r, int)
{
    return pair(unit_box(), box({0, 0, sixteenth(r, 0.1, 0.4)}, {0.5, sixteenth(r, 0.1, 0.9), 0.75}));
}
Pose nested_common_corner(Random &r, int)
{
    return pair(unit_box(), box({0, 0, 0}, {sixteenth(r, 0.1, 1), sixteenth(r, 0.1, 1), sixteenth(r, 0.1, 1)}));
}
Pose scaled_copy(Random &r, int i)
{
    // the smaller copy touches from inside: all its faces are parallel to those of the other
    const Mesh a = shape(i % 12, r);
    return pair(a, scaled(a, i % 3 == 0 ? 1 - r.log_uniform(1e-16, 1e-3) : sixteenth(r, 0.25, 1.75)));
}

// nearly coplanar, depth, size, place

Pose nearly_coplanar(Random &r, int i)
{
    const Vector axis = i % 2 ? Vector{1, 0, 0} : Vector{r.uniform(-1, 1), 1, 0};
    const double depth = i % 3 == 0 ? 0 : r.log_uniform(1e-16, 1e-4) * (i % 3 == 1 ? 1 : -1);
    const Mesh b = shifted(block(r), {-0.5, -0.5, 0});
    return pair(unit_box(), moved(b, turned(axis, r.log_uniform(1e-16, 1e-3)), {0.5, 0.5, 1 - depth}));
}
Pose nearly_coplanar_same_sense(Random &r, int i)
{
    const Vector axis = i % 2 ? Vector{1, 0, 0} : Vector{r.uniform(-1, 1), 1, r.uniform(-1, 1)};
    const Mesh b = shifted(block(r), {-0.5, -0.5, 0});
    return pair(unit_box(), moved(b, turned(axis, r.log_uniform(1e-16, 1e-3)), {0.5, 0.5, 0}));
}
Pose depths(Random &r, int i)
{
    const Mesh a = moved(shape(i % 12, r), random_rotation(r), {0, 0, 0});
    const Mesh b = moved(shape(r.integer(0, 11), r), random_rotation(r), {0, 0, 0});
    return pair(a, brought_together(a, b, r.log_uniform(1e-15, 1e-1), r));
}
Pose stacked_depths(Random &r, int i)
{
    const double depth = r.log_uniform(1e-15, 1e-1);
    const Matrix m = i % 2 ? turned({0, 0, 1}, r.uniform(0, 2 * pi)) : lattice_rotation(0);
    return pair(unit_box(), moved(shifted(block(r), {-0.25, -0.25, 0}), m, {0.5, 0.5, 1 - depth}));
}
Pose sizes(Random &r, int i)
{
    Pose pose = ordinary_pose(i % 12, r.integer(0, 11), r);
    const double size = r.log_uniform(1e-6, 1e6);
    return pair(scaled(pose.a, size), scaled(pose.b, size));
}
Pose size_ratio(Random &r, int i)
{
    const Mesh a = moved(shape(i % 12, r), random_rotation(r), {0, 0, 0});
    Mesh b = moved(scaled(shape(r.integer(0, 11), r), 1e-4), random_rotation(r), {0, 0, 0});
    b = brought_together(a, b, 1e-4 * r.log_uniform(1e-4, 0.5), r);
    return i % 2 ? pair(a, b) : pair(b, a);
}
Pose far_away(Random &r, int i)
{
    const Pose pose = ordinary_pose(i % 12, r.integer(0, 11), r);
    const double distance = std::pow(10.0, 3 * (1 + i % 3));
    const Vector shift = distance * r.direction();
    return pair(shifted(pose.a, shift), shifted(pose.b, shift));
}
Pose far_away_stacked(Random &r, int i)
{
    const Pose pose = i % 2 ? stacked_depths(r, i) : same_sense_turned(r, i);
    const Vector shift = std::pow(10.0, 3 * (1 + i % 3)) * r.direction();
    return pair(shifted(pose.a, shift), shifted(pose.b, shift));
}

// extreme shapes

Pose slivers(Random &r, int i)
{
    const Mesh a = sliver_box(i % 2 ? 1e6 : r.log_uniform(1e3, 1e6), r);
    const Mesh b = i % 3 ? moved(shape(r.integer(0, 8), r), random_rotation(r), {0, 0, 0}) : sliver_box(1e6, r);
    return pair(a, brought_together(a, b, r.log_uniform(1e-6, 1e-1), r));
}
Pose sliver_edge(Random &r, int)
{
    // the slivers themselves are cut: b sits on the side where they are
    const Mesh a = sliver_box(1e6, r);
    const Mesh b = moved(cube(0.5), random_rotation(r), {-0.5, r.uniform(-0.4, 0.4), r.uniform(0.3, 0.6)});
    return pair(a, b);
}
Pose needles(Random &r, int i)
{
    const double w = r.log_uniform(1e-5, 1e-2);
    const Mesh needle = stretched(i % 2 ? cube(1) : octahedron(0.5), {1, w, w});
    const Mesh a = moved(needle, random_rotation(r), {0, 0, 0});
    const Mesh b = i % 3 ? moved(needle, random_rotation(r), {0, 0, 0}) : moved(cube(1), random_rotation(r), {0, 0, 0});
    return pair(a, brought_together(a, b, w * r.log_uniform(1e-3, 1), r));
}
Pose plates(Random &r, int i)
{
    const double h = r.log_uniform(1e-5, 1e-2);
    const Mesh plate = stretched(i % 2 ? cube(1) : scaled(prism(9, 1), 0.5), {1, 1, h});
    const Mesh a = moved(plate, random_rotation(r), {0, 0, 0});
    const Mesh b =
        i % 3 ? moved(plate, random_rotation(r), {0, 0, 0}) : moved(cube(0.7), random_rotation(r), {0, 0, 0});
    return pair(a, i % 4 < 2 ? shifted(b, 0.2 * r.direction()) : brought_together(a, b, h * r.log_uniform(1e-3, 1), r));
}
Pose needle_through_plate(Random &r, int)
{
    const double w = r.log_uniform(1e-5, 1e-2);
    const Mesh plate = stretched(cube(1), {1, 1, w});
    const Matrix tilt = rotation(r.direction(), r.uniform(0, 1));
    return pair(plate, moved(stretched(cube(1), {w, w, 1}), tilt, {sixteenth(r, -0.25, 0.25), 0, 0}));
}
Pose high_valence(Random &r, int i)
{
    const Mesh a = bipyramid(r.integer(50, 200), 0.5);
    Mesh b = i % 2 ? bipyramid(r.integer(50, 200), 0.75) : cube(1);
    if (i % 4 < 2) // tip over tip, on the axis
        return pair(a, shifted(b, {0, 0, (i % 2 ? 1.25 : 1.0) - (i % 3 == 0 ? 0 : r.log_uniform(1e-6, 0.3))}));
    return pair(a, brought_together(a, moved(b, random_rotation(r), {0, 0, 0}), r.log_uniform(1e-5, 1e-1), r));
}

// no volume

Pose touching(Random &r, int i)
{
    const Mesh a = moved(shape(i % 12, r), random_rotation(r), {0, 0, 0});
    const Mesh b = moved(shape(r.integer(0, 11), r), random_rotation(r), {0, 0, 0});
    return pair(a, brought_together(a, b, 0, r));
}
Pose disjoint(Random &r, int i)
{
    // the boxes overlap, the bodies do not: a bar in the gap of a U, or a corner cut off diagonally
    if (i % 2)
    {
        const double gap = sixteenth(r, 0, 0.2);
        return pair(stretched(u_shape(1), {3, 1, 1}), box({1 + gap, 0.4, -1}, {2 - gap, 2, 2}));
    }
    const Mesh a = mesh_of_cells({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
    const Matrix half_turn = {Vector{-1, 0, 0}, Vector{0, -1, 0}, Vector{0, 0, 1}};
    return pair(a, moved(a, half_turn, {1, 1, sixteenth(r, 0.25, 0.9)}));
}

// several pieces

Pose several_patches(Random &r, int i)
{
    const Mesh a = comb(r.integer(2, 6), 0.5);
    const double depth = i % 3 ? r.log_uniform(1e-6, 0.3) : sixteenth(r, 0.1, 0.5);
    const Matrix m = i % 2 ? rotation({0, 0, 1}, r.uniform(-0.02, 0.02)) : lattice_rotation(0);
    return pair(a, moved(box({-0.5, 0, -0.5}, {1.5, 1, 1}), m, {0, 1 - depth, 0}));
}
Pose two_combs(Random &r, int)
{
    const Mesh a = comb(r.integer(2, 5), 0.5), b = comb(r.integer(2, 5), 0.5);
    const Matrix m = {Vector{0, 0, 1}, Vector{0, -1, 0}, Vector{1, 0, 0}};
    return pair(a, moved(b, m, {sixteenth(r, -0.25, 0.75), 2 - sixteenth(r, 0.1, 0.6), sixteenth(r, -0.75, 0.25)}));
}
Pose linked_rings(Random &r, int i)
{
    // linked without contact, touching, or grown into each other
    const Mesh a = ring(0.75, r.integer(4, 16), 0.25);
    const Matrix upright = {Vector{1, 0, 0}, Vector{0, 0, -1}, Vector{0, 1, 0}};
    const double x = i % 3 == 0 ? 0.875 : r.uniform(0.3, 1.6);
    return pair(a, moved(ring(0.75, r.integer(4, 16), 0.25), upright, {x, 0, 0}));
}
Pose bar_through_ring(Random &r, int i)
{
    const Mesh a = ring(0.5, i % 2 ? 4 : 12, 0.5);
    const double w = sixteenth(r, 0.1, 0.9);
    const Matrix m = i % 3 ? rotation(r.direction(), r.uniform(0, 1)) : lattice_rotation(0);
    return pair(a, moved(box({-w / 2, -w / 2, -1}, {w / 2, w / 2, 1}), m, {sixteenth(r, -0.25, 0.25), 0, 0}));
}
Pose two_ls(Random &r, int)
{
    const Mesh a = l_shape(0.5);
    const Matrix half_turn = {Vector{-1, 0, 0}, Vector{0, -1, 0}, Vector{0, 0, 1}};
    return pair(a, moved(a, half_turn, {sixteenth(r, 0.5, 1.5), sixteenth(r, 0.5, 1.5), r.integer(-1, 1) * 0.25}));
}
Pose two_pieces(Random &r, int)
{
    // bodies of two separate pieces each
    const Mesh a = joined(unit_box(), shifted(unit_box(), {2, 0, 0}));
    return pair(a, shifted(a, {sixteenth(r, -1.5, 1.5), sixteenth(r, -0.75, 0.75), 0.5}));
}

struct Kind
{
    const char *name;
    Pose (*make)(Random &, int);
    bool may_turn;  ///< turning as a whole makes sense
    bool is_robust; ///< see Pose
};

const Kind kinds[] = {
    {"coplanar, opposite: stacked", stacked_faces, true, false},
    {"coplanar, opposite: shifted", shifted_faces, true, false},
    {"coplanar, opposite: turned", turned_faces, true, false},
    {"coplanar, opposite: filled gap", filled_gap, true, false},
    {"coplanar, same sense: shifted", same_sense, true, false},
    {"coplanar, same sense: turned", same_sense_turned, true, false},
    {"coplanar, same sense: slabs", slabs, true, false},
    {"coplanar, same sense: prisms", prisms_turned, true, false},
    {"shared edge, outside", shared_edge, true, false},
    {"shared edge, inside", shared_edge_inside, true, false},
    {"vertex on face", vertex_on_face, true, false},
    {"vertex on edge", vertex_on_edge, true, false},
    {"vertex on vertex", vertex_on_vertex, true, false},
    {"crossing edges", crossing_edges, true, false},
    {"two tetrahedra, edges cross", two_tetrahedra, true, false},
    {"cube and octahedron", cube_and_octahedron, true, false},
    {"identical", identical, true, false},
    {"identical, shuffled", identical_shuffled, true, false},
    {"nearly identical", nearly_identical, true, false},
    {"nested", nested, true, true},
    {"nested, common face", nested_common_face, true, false},
    {"nested, common edge", nested_common_edge, true, false},
    {"nested, common corner", nested_common_corner, true, false},
    {"scaled copy", scaled_copy, true, false},
    {"nearly coplanar, opposite", nearly_coplanar, true, false},
    {"nearly coplanar, same sense", nearly_coplanar_same_sense, true, false},
    {"depth 1e-15 to 1e-1", depths, true, false},
    {"depth 1e-15 to 1e-1, stacked", stacked_depths, true, false},
    {"size 1e-6 to 1e6", sizes, false, true},
    {"size ratio 1e4", size_ratio, true, true},
    {"far: 1e3, 1e6, 1e9 sizes", far_away, false, true},
    {"far, coplanar", far_away_stacked, false, false},
    {"slivers of aspect 1e6", slivers, true, false},
    {"sliver edge", sliver_edge, true, false},
    {"needles", needles, true, false},
    {"plates", plates, true, false},
    {"needle through plate", needle_through_plate, true, false},
    {"high valence", high_valence, true, false},
    {"touching", touching, true, false},
    {"disjoint, boxes overlap", disjoint, true, false},
    {"several patches", several_patches, true, false},
    {"two combs", two_combs, true, false},
    {"linked rings", linked_rings, true, false},
    {"bar through ring", bar_through_ring, true, false},
    {"two L", two_ls, true, false},
    {"bodies of two pieces", two_pieces, true, false},
};

} // namespace

int num_hard_kinds() { return static_cast<int>(sizeof(kinds) / sizeof(kinds[0])); }
std::string hard_kind_name(int kind) { return kinds[kind].name; }

Pose hard_pose(int kind, int index, Random &random)
{
    Pose pose = kinds[kind].make(random, index / 3);
    pose.kind = kinds[kind].name;
    pose.is_robust = kinds[kind].is_robust;
    if (!kinds[kind].may_turn) return pose;
    const Matrix m = index % 3 == 2 ? random_rotation(random) : lattice_rotation(random.integer(0, 23));
    const double scale = index % 3 == 1 ? random.uniform(0.5, 2) : 1;
    pose.a = scaled(moved(pose.a, m, {0, 0, 0}), scale);
    pose.b = scaled(moved(pose.b, m, {0, 0, 0}), scale);
    return pose;
}

} // namespace reference
