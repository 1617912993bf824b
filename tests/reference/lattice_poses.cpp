#include "poses.hpp"

#include <cmath>

namespace reference
{
namespace
{

Mesh lattice_tetrahedron(Random &random)
{
    for (;;)
    {
        std::vector<Vector> v(4);
        for (Vector &p : v)
        {
            for (double &x : p) x = random.integer(0, 3);
        }
        if (dot(cross(v[1] - v[0], v[2] - v[0]), v[3] - v[0]) != 0) return mesh_of_cells(v, {{0, 1, 2, 3}});
    }
}

Mesh lattice_box(Random &random)
{
    const double x = random.integer(1, 3), y = random.integer(1, 3), z = random.integer(1, 3);
    return box({0, 0, 0}, {x, y, z});
}

Mesh lattice_wedge(Random &random)
{
    const double x = random.integer(1, 3), y = random.integer(1, 3);
    return extrusion({{0, 0}, {x, 0}, {double(random.integer(0, 2)), y}}, {{0, 1, 2}}, 0, random.integer(1, 3));
}

Mesh lattice_octahedron(Random &random) { return octahedron(random.integer(1, 2)); }

Mesh lattice_pyramid(Random &random)
{
    const Vector top = {double(random.integer(0, 2)), double(random.integer(0, 2)), double(random.integer(1, 3))};
    return mesh_of_cells({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, top}, {{0, 1, 2, 4}, {0, 2, 3, 4}});
}

/// Twisted octahedron with three concave edges on integers; the cones from the middle fill it.
Mesh lattice_schoenhardt(Random &)
{
    return mesh_of_triangles({{4, 0, 0}, {-2, 3, 0}, {-2, -3, 0}, {3, 2, 4}, {-3, 2, 4}, {0, -4, 4}},
                             {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}});
}

Mesh lattice_l(Random &random)
{
    return extrusion({{0, 0}, {1, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 1}},
                     {{0, 1, 4}, {0, 4, 7}, {1, 2, 3}, {1, 3, 4}, {7, 4, 5}, {7, 5, 6}}, 0, random.integer(1, 2));
}

Mesh lattice_ring(Random &)
{
    return extrusion({{1, 1}, {2, 1}, {2, 2}, {1, 2}, {0, 0}, {3, 0}, {3, 3}, {0, 3}},
                     {{0, 4, 5}, {0, 5, 1}, {1, 5, 6}, {1, 6, 2}, {2, 6, 7}, {2, 7, 3}, {3, 7, 4}, {3, 4, 0}}, 0, 1);
}

Mesh lattice_shape(Random &random)
{
    static Mesh (*const makers[])(Random &) = {
        lattice_tetrahedron, lattice_tetrahedron, lattice_box,         lattice_box, lattice_wedge,
        lattice_octahedron,  lattice_pyramid,     lattice_schoenhardt, lattice_l,   lattice_ring,
    };
    const Mesh mesh = makers[random.integer(0, 9)](random);
    return moved(mesh, lattice_rotation(random.integer(0, 23)), {0, 0, 0});
}

void move_by_ulps(Mesh &mesh, Random &random)
{
    for (Vector &v : mesh.vertices)
    {
        for (double &x : v)
        {
            if (random.integer(0, 3) == 0) x = std::nextafter(x, random.integer(0, 1) ? HUGE_VAL : -HUGE_VAL);
        }
    }
}

} // namespace

Pose lattice_pose(Random &random, bool &is_exact)
{
    Pose pose;
    pose.a = lattice_shape(random);
    pose.b = lattice_shape(random);
    const double step = random.integer(0, 1) ? 1 : 0.5;
    Vector shift;
    for (double &s : shift) s = step * random.integer(-4, 4);
    pose.b = shifted(pose.b, shift);
    const int mode = random.integer(0, 7);
    static const char *const names[] = {"lattice",    "lattice, far",    "ulps",          "tiny turn",
                                        "tiny shift", "lattice, scaled", "turned as one", "ulps, turned as one"};
    pose.kind = names[mode];
    is_exact = mode <= 1;
    if (mode == 1)
    {
        for (double &s : shift) s = random.integer(-1000, 1000);
        pose.a = shifted(pose.a, shift);
        pose.b = shifted(pose.b, shift);
    }
    if (mode == 2 || mode == 7)
    {
        const Vector off = {1.25, 0.75, 5.5}; // no coordinate is zero, where an ulp would be nothing at all
        pose.a = shifted(pose.a, off);
        pose.b = shifted(pose.b, off);
        move_by_ulps(pose.b, random);
        if (random.integer(0, 1)) move_by_ulps(pose.a, random);
    }
    if (mode == 3)
    {
        const Vector axis = random.integer(0, 1) ? random.direction() : Vector{0, 0, 1};
        pose.b = moved(pose.b, rotation(axis, random.log_uniform(1e-17, 1e-3)), {0, 0, 0});
    }
    if (mode == 4) pose.b = shifted(pose.b, random.log_uniform(1e-17, 1e-3) * random.direction());
    if (mode == 5)
    {
        const double factor = random.log_uniform(1e-3, 1e3);
        pose.a = scaled(pose.a, factor);
        pose.b = scaled(pose.b, factor);
    }
    if (mode >= 6)
    {
        const Matrix m = random_rotation(random);
        pose.a = moved(pose.a, m, {0, 0, 0});
        pose.b = moved(pose.b, m, {0, 0, 0});
    }
    return pose;
}

} // namespace reference
