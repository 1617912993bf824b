#include "shapes.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace reference
{
namespace
{
constexpr double pi = 3.14159265358979323846;
}

uint64_t Random::bits()
{
    uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}
double Random::uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
double Random::uniform(double lower, double upper) { return lower + (upper - lower) * uniform(); }
double Random::log_uniform(double lower, double upper) { return lower * std::pow(upper / lower, uniform()); }
double Random::normal() { return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * pi * uniform()); }
int Random::integer(int lower, int upper)
{
    return lower + static_cast<int>(bits() % static_cast<uint64_t>(upper - lower + 1));
}
Vector Random::direction()
{
    const double x = normal(), y = normal(), z = normal();
    const Vector v = {x, y, z};
    return (1 / norm(v)) * v;
}

Vector operator+(const Vector &a, const Vector &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator-(const Vector &a, const Vector &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector operator*(double s, const Vector &a) { return {s * a[0], s * a[1], s * a[2]}; }
Vector operator*(const Matrix &m, const Vector &a) { return {dot(m[0], a), dot(m[1], a), dot(m[2], a)}; }
double dot(const Vector &a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector &a, const Vector &b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double norm(const Vector &a) { return std::sqrt(dot(a, a)); }

Matrix rotation(const Vector &axis, double angle)
{
    // Rodrigues; 1 - cos from the half angle, so that tiny angles keep their digits
    const double s = std::sin(angle), h = std::sin(angle / 2), c1 = 2 * h * h;
    const Vector &k = axis;
    Matrix m{};
    for (size_t i = 0; i < 3; ++i)
    {
        for (size_t j = 0; j < 3; ++j) m[i][j] = c1 * (k[i] * k[j] - (i == j ? 1.0 : 0.0)) + (i == j ? 1.0 : 0.0);
    }
    m[0][1] -= s * k[2];
    m[0][2] += s * k[1];
    m[1][0] += s * k[2];
    m[1][2] -= s * k[0];
    m[2][0] -= s * k[1];
    m[2][1] += s * k[0];
    return m;
}

Matrix random_rotation(Random &random)
{
    const Vector axis = random.direction();
    return rotation(axis, random.uniform(0, 2 * pi));
}

Matrix lattice_rotation(int index)
{
    static constexpr size_t orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    const auto &order = orders[index % 6];
    const double parity = index % 6 < 3 ? 1 : -1;
    const double s0 = (index / 6) % 2 ? -1 : 1, s1 = (index / 12) % 2 ? -1 : 1;
    Matrix m{};
    m[0][order[0]] = s0;
    m[1][order[1]] = s1;
    m[2][order[2]] = s0 * s1 * parity;
    return m;
}

Mesh moved(Mesh mesh, const Matrix &m, const Vector &shift)
{
    for (Vector &v : mesh.vertices) v = m * v + shift;
    return mesh;
}
Mesh shifted(Mesh mesh, const Vector &shift)
{
    for (Vector &v : mesh.vertices) v = v + shift;
    return mesh;
}
Mesh scaled(Mesh mesh, double factor) { return stretched(std::move(mesh), {factor, factor, factor}); }
Mesh stretched(Mesh mesh, const Vector &factors)
{
    for (Vector &v : mesh.vertices)
    {
        for (size_t k = 0; k < 3; ++k) v[k] *= factors[k];
    }
    return mesh;
}

Mesh joined(const Mesh &a, const Mesh &b)
{
    Mesh mesh = a;
    const auto offset = static_cast<int32_t>(a.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), b.vertices.begin(), b.vertices.end());
    for (const Triangle &t : b.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    if (a.cells.empty() || b.cells.empty()) mesh.cells.clear();
    else
    {
        for (const Cell &c : b.cells)
            mesh.cells.push_back({c[0] + offset, c[1] + offset, c[2] + offset, c[3] + offset});
    }
    return mesh;
}

double extent(const Mesh &mesh)
{
    double result = 0;
    for (size_t k = 0; k < 3; ++k)
    {
        const auto less = [k](const Vector &a, const Vector &b) { return a[k] < b[k]; };
        const auto [low, high] = std::minmax_element(mesh.vertices.begin(), mesh.vertices.end(), less);
        result = std::max(result, (*high)[k] - (*low)[k]);
    }
    return result;
}

Mesh shuffled(const Mesh &mesh, Random &random)
{
    std::vector<int32_t> order(mesh.vertices.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int32_t>(i);
    const auto swap_all = [&](auto &list)
    {
        for (size_t i = list.size(); i > 1; --i)
            std::swap(list[i - 1], list[static_cast<size_t>(random.integer(0, static_cast<int>(i) - 1))]);
    };
    swap_all(order);
    Mesh result = mesh;
    for (size_t i = 0; i < order.size(); ++i) result.vertices[static_cast<size_t>(order[i])] = mesh.vertices[i];
    for (Triangle &t : result.triangles)
    {
        std::rotate(t.begin(), t.begin() + random.integer(0, 2), t.end());
        for (int32_t &v : t) v = order[static_cast<size_t>(v)];
    }
    for (Cell &c : result.cells)
    {
        for (int32_t &v : c) v = order[static_cast<size_t>(v)];
    }
    swap_all(result.triangles);
    return result;
}

Mesh mesh_of_cells(std::vector<Vector> vertices, std::vector<Cell> cells)
{
    Mesh mesh;
    mesh.vertices = std::move(vertices);
    std::map<Triangle, Triangle> faces; // by sorted corners; a face met twice is inside
    for (Cell &c : cells)
    {
        const Vector &p = mesh.vertices[static_cast<size_t>(c[0])];
        const auto edge = [&](size_t k) { return mesh.vertices[static_cast<size_t>(c[k])] - p; };
        if (dot(cross(edge(1), edge(2)), edge(3)) < 0) std::swap(c[2], c[3]);
        for (const Triangle &f : {Triangle{c[0], c[2], c[1]}, Triangle{c[0], c[1], c[3]}, Triangle{c[1], c[2], c[3]},
                                  Triangle{c[2], c[0], c[3]}})
        {
            Triangle key = f;
            std::sort(key.begin(), key.end());
            if (faces.erase(key) == 0) faces.emplace(key, f);
        }
    }
    for (const auto &entry : faces) mesh.triangles.push_back(entry.second);
    mesh.cells = std::move(cells);
    return mesh;
}

Mesh mesh_of_triangles(std::vector<Vector> vertices, std::vector<Triangle> triangles)
{
    Mesh mesh;
    mesh.vertices = std::move(vertices);
    mesh.triangles = std::move(triangles);
    return mesh;
}

Mesh extrusion(const std::vector<std::array<double, 2>> &points, const std::vector<Triangle> &triangles, double lower,
               double upper)
{
    std::vector<Vector> vertices;
    const auto n = static_cast<int32_t>(points.size());
    for (const auto &p : points) vertices.push_back({p[0], p[1], lower});
    for (const auto &p : points) vertices.push_back({p[0], p[1], upper});
    std::vector<Cell> cells;
    for (Triangle t : triangles)
    {
        // every wall is cut from its lower-numbered foot to its higher-numbered top, so that neighbours agree
        std::sort(t.begin(), t.end());
        cells.push_back({t[0], t[1], t[2], t[2] + n});
        cells.push_back({t[0], t[1], t[1] + n, t[2] + n});
        cells.push_back({t[0], t[0] + n, t[1] + n, t[2] + n});
    }
    return mesh_of_cells(std::move(vertices), std::move(cells));
}

Mesh box(const Vector &lower, const Vector &upper)
{
    return extrusion({{lower[0], lower[1]}, {upper[0], lower[1]}, {upper[0], upper[1]}, {lower[0], upper[1]}},
                     {{0, 1, 2}, {0, 2, 3}}, lower[2], upper[2]);
}
Mesh cube(double size) { return box({-size / 2, -size / 2, -size / 2}, {size / 2, size / 2, size / 2}); }

Mesh tetrahedron(double radius)
{
    const double s = radius / std::sqrt(3.0);
    return mesh_of_cells({{s, s, s}, {s, -s, -s}, {-s, s, -s}, {-s, -s, s}}, {{0, 1, 2, 3}});
}

Mesh octahedron(double r)
{
    return mesh_of_cells({{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}},
                         {{4, 5, 0, 2}, {4, 5, 2, 1}, {4, 5, 1, 3}, {4, 5, 3, 0}});
}

Mesh schoenhardt(double radius)
{
    // two triangles, the upper one turned by 30 degrees, walls cut along the concave diagonals
    std::vector<Vector> v;
    const double h = 0.55 * radius, r = std::sqrt(radius * radius - h * h);
    for (int k = 0; k < 3; ++k) v.push_back({r * std::cos(2 * pi * k / 3), r * std::sin(2 * pi * k / 3), -h});
    for (int k = 0; k < 3; ++k)
        v.push_back({r * std::cos(2 * pi * k / 3 + pi / 6), r * std::sin(2 * pi * k / 3 + pi / 6), h});
    return mesh_of_triangles(v,
                             {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}});
}

Mesh sphere(double radius, int frequency)
{
    const double g = (1 + std::sqrt(5.0)) / 2;
    const std::vector<Vector> corners = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                         {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    static constexpr Triangle faces[20] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                           {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                           {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                           {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    Mesh mesh;
    std::map<std::array<int64_t, 3>, int32_t> known; // by coordinates rounded to 1e-9
    const auto vertex = [&](const Vector &p)
    {
        const Vector q = (radius / norm(p)) * p;
        const std::array<int64_t, 3> key = {std::llround(q[0] / radius * 1e9), std::llround(q[1] / radius * 1e9),
                                            std::llround(q[2] / radius * 1e9)};
        const auto [place, is_new] = known.emplace(key, static_cast<int32_t>(mesh.vertices.size()));
        if (is_new) mesh.vertices.push_back(q);
        return place->second;
    };
    const int n = frequency;
    for (const Triangle &f : faces)
    {
        const auto at = [&](int i, int j)
        {
            const auto corner = [&](size_t k) { return corners[static_cast<size_t>(f[k])]; };
            return vertex(double(n - i - j) * corner(0) + double(i) * corner(1) + double(j) * corner(2));
        };
        for (int i = 0; i < n; ++i)
        {
            for (int j = 0; i + j < n; ++j)
            {
                mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
                if (i + j + 2 <= n) mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
            }
        }
    }
    return mesh;
}

Mesh rock(uint64_t seed, int frequency, double roughness)
{
    Random random(seed);
    Mesh mesh = sphere(1, frequency);
    const Vector stretch = {random.uniform(0.6, 1.0), random.uniform(0.6, 1.0), 1.0};
    std::vector<Vector> waves;
    std::vector<double> phases;
    for (int k = 0; k < 8; ++k)
    {
        waves.push_back(random.uniform(1.5, 5) * random.direction());
        phases.push_back(random.uniform(0, 2 * pi));
    }
    for (Vector &v : mesh.vertices)
    {
        double r = 1;
        for (size_t k = 0; k < waves.size(); ++k) r += roughness / 3 * std::sin(dot(waves[k], v) + phases[k]);
        r += roughness / 6 * random.uniform(-1, 1) / frequency;
        v = std::max(r, 0.3) * 0.5 * v;
        for (size_t k = 0; k < 3; ++k) v[k] *= stretch[k];
    }
    return mesh;
}

Mesh l_shape(double width)
{
    return extrusion({{0, 0}, {0.4, 0}, {1, 0}, {1, 0.4}, {0.4, 0.4}, {0.4, 1}, {0, 1}, {0, 0.4}},
                     {{0, 1, 4}, {0, 4, 7}, {1, 2, 3}, {1, 3, 4}, {7, 4, 5}, {7, 5, 6}}, 0, width);
}

Mesh u_shape(double width) { return comb(2, width); }

Mesh comb(int num_teeth, double width)
{
    // a bar below, teeth on it: columns of the polygon at x = 0, s, 2 s, ..., every other one carries a tooth
    const int columns = 2 * num_teeth - 1;
    std::vector<std::array<double, 2>> points;
    std::vector<Triangle> triangles;
    for (int row = 0; row < 2; ++row)
    {
        for (int i = 0; i <= columns; ++i) points.push_back({double(i) / columns, 0.3 * row});
    }
    for (int i = 0; i <= columns; ++i) points.push_back({double(i) / columns, 1.0});
    const int n = columns + 1;
    const auto cell = [&](int i, int row)
    {
        const int p = row * n + i;
        triangles.push_back({p, p + 1, p + n + 1});
        triangles.push_back({p, p + n + 1, p + n});
    };
    for (int i = 0; i < columns; ++i)
    {
        cell(i, 0);
        if (i % 2 == 0) cell(i, 1);
    }
    return extrusion(points, triangles, 0, width);
}

Mesh ring(double inner, int num_corners, double width)
{
    std::vector<std::array<double, 2>> points;
    std::vector<Triangle> triangles;
    const int n = num_corners;
    for (double r : {inner, 1.0})
    {
        for (int k = 0; k < n; ++k) points.push_back({r * std::cos(2 * pi * k / n), r * std::sin(2 * pi * k / n)});
    }
    for (int k = 0; k < n; ++k)
    {
        const int next = (k + 1) % n;
        triangles.push_back({k, n + k, n + next});
        triangles.push_back({k, n + next, next});
    }
    return extrusion(points, triangles, -width / 2, width / 2);
}

Mesh prism(int num_corners, double height)
{
    std::vector<std::array<double, 2>> points;
    std::vector<Triangle> triangles;
    for (int k = 0; k < num_corners; ++k)
        points.push_back({std::cos(2 * pi * k / num_corners), std::sin(2 * pi * k / num_corners)});
    for (int k = 2; k < num_corners; ++k) triangles.push_back({0, k - 1, k});
    return extrusion(points, triangles, -height / 2, height / 2);
}

Mesh bipyramid(int num_corners, double height)
{
    std::vector<Vector> v = {{0, 0, height}, {0, 0, -height}};
    std::vector<Cell> cells;
    for (int k = 0; k < num_corners; ++k)
    {
        v.push_back({std::cos(2 * pi * k / num_corners), std::sin(2 * pi * k / num_corners), 0});
        cells.push_back({0, 1, 2 + k, 2 + (k + 1) % num_corners});
    }
    return mesh_of_cells(v, cells);
}

Mesh sliver_box(double aspect, Random &random)
{
    // a 2 x 2 grid of cells whose inner line runs at 1/aspect from the side: half of the top and bottom are slivers
    const double t = 1 / aspect;
    std::vector<std::array<double, 2>> points;
    std::vector<Triangle> triangles;
    const std::vector<double> xs = {0, t, 1}, ys = {0, random.uniform(0.2, 0.8), 1};
    for (double y : ys)
    {
        for (double x : xs) points.push_back({x, y});
    }
    for (int j = 0; j < 2; ++j)
    {
        for (int i = 0; i < 2; ++i)
        {
            const int p = 3 * j + i;
            triangles.push_back({p, p + 1, p + 4});
            triangles.push_back({p, p + 4, p + 3});
        }
    }
    return shifted(extrusion(points, triangles, 0, 1), {-0.5, -0.5, -0.5});
}

namespace
{
struct Entry
{
    const char *name;
    Mesh (*make)(Random &);
};

// unnamed shapes of about unit extent
const Entry entries[] = {
    {"tetrahedron 4", [](Random &) { return tetrahedron(0.6); }},
    {"octahedron 8", [](Random &) { return octahedron(0.5); }},
    {"Schoenhardt 8", [](Random &) { return schoenhardt(0.55); }},
    {"box 12",
     [](Random &r) {
         return stretched(cube(1), {r.uniform(0.4, 1), r.uniform(0.4, 1), 1});
     }},
    {"L 28",
     [](Random &) {
         return shifted(l_shape(0.4), {-0.5, -0.5, -0.2});
     }},
    {"U 28",
     [](Random &) {
         return shifted(u_shape(0.4), {-0.5, -0.5, -0.2});
     }},
    {"rock 20", [](Random &r) { return rock(r.bits(), 1, 0.25); }},
    {"sphere 80", [](Random &) { return sphere(0.5, 2); }},
    {"rock 80", [](Random &r) { return rock(r.bits(), 2, 0.25); }},
    {"ring 96", [](Random &) { return scaled(ring(0.6, 12, 0.4), 0.5); }},
    {"rock 180", [](Random &r) { return rock(r.bits(), 3, 0.25); }},
    {"sphere 320", [](Random &) { return sphere(0.5, 4); }},
    {"rock 980", [](Random &r) { return rock(r.bits(), 7, 0.25); }},
    {"sphere 980", [](Random &) { return sphere(0.5, 7); }},
};
} // namespace

int num_shapes() { return static_cast<int>(sizeof(entries) / sizeof(entries[0])); }
Mesh shape(int index, Random &random) { return entries[index].make(random); }
std::string shape_name(int index) { return entries[index].name; }

} // namespace reference
