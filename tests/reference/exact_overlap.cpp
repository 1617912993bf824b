#include "exact_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <gmpxx.h>

namespace reference
{
namespace
{

constexpr unsigned sum_bits = 640;
constexpr double filter = 0x1p-48; // several roundings of 2^-52 each, with room

/// Homogeneous point (x, y, z, w), w > 0, and its rounded Cartesian coordinates for the filter.
struct Point
{
    mpz_class x[3];
    mpz_class w = 1;
    double approx[3] = {0, 0, 0};
};

/// n . x + d w > 0 outside.
struct Plane
{
    mpz_class n[3], d;
    double approx_n[3] = {0, 0, 0}, approx_d = 0;
};

struct Piece
{
    std::vector<Plane> planes;
    int sign = 1;
};

struct Box
{
    double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    double upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

    void add(const Vector &p)
    {
        for (int k = 0; k < 3; ++k)
        {
            lower[k] = std::min(lower[k], p[k]);
            upper[k] = std::max(upper[k], p[k]);
        }
    }
    bool meets(const Box &other) const
    {
        for (int k = 0; k < 3; ++k)
        {
            if (lower[k] > other.upper[k] || other.lower[k] > upper[k]) return false;
        }
        return true;
    }
};

Box box_of(const std::vector<Vector> &points)
{
    Box box;
    for (const Vector &p : points) box.add(p);
    return box;
}

/// Integer coordinates of one problem: x = origin + 2^exponent * integer, exactly.
class Grid
{
  public:
    explicit Grid(const Vector &new_origin) : origin(new_origin) { include(origin); }

    void include(const Vector &p)
    {
        for (double x : p)
        {
            if (x == 0) continue;
            int e = 0;
            const auto mantissa = static_cast<int64_t>(std::ldexp(std::frexp(x, &e), 53));
            exponent = std::min(exponent, e - 53 + __builtin_ctzll(static_cast<uint64_t>(mantissa)));
        }
    }
    void include(const std::vector<Vector> &points)
    {
        for (const Vector &p : points) include(p);
    }
    Point point(const Vector &p) const
    {
        Point result;
        for (int k = 0; k < 3; ++k)
        {
            result.x[k] = integer(p[k]) - integer(origin[k]);
            result.approx[k] = result.x[k].get_d();
        }
        return result;
    }
    std::vector<Point> points(const std::vector<Vector> &list) const
    {
        std::vector<Point> result;
        for (const Vector &p : list) result.push_back(point(p));
        return result;
    }

    Vector origin;
    int exponent = std::numeric_limits<int>::max();

  private:
    mpz_class integer(double x) const
    {
        if (x == 0) return 0;
        int e = 0;
        const auto mantissa = static_cast<int64_t>(std::ldexp(std::frexp(x, &e), 53));
        mpz_class result = static_cast<long>(mantissa);
        const int shift = e - 53 - exponent;
        if (shift >= 0) return result << static_cast<unsigned>(shift);
        return result >> static_cast<unsigned>(-shift); // exact: only zero bits leave
    }
};

Plane plane_through(const Point &p, const Point &q, const Point &r)
{
    mpz_class u[3], v[3];
    for (int k = 0; k < 3; ++k)
    {
        u[k] = q.x[k] - p.x[k];
        v[k] = r.x[k] - p.x[k];
    }
    Plane plane;
    for (int k = 0; k < 3; ++k)
    {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        plane.n[k] = u[i] * v[j] - u[j] * v[i];
        plane.d -= plane.n[k] * p.x[k];
        plane.approx_n[k] = plane.n[k].get_d();
    }
    plane.approx_d = plane.d.get_d();
    return plane;
}

void flip(Plane &plane)
{
    for (int k = 0; k < 3; ++k)
    {
        plane.n[k] = -plane.n[k];
        plane.approx_n[k] = -plane.approx_n[k];
    }
    plane.d = -plane.d;
    plane.approx_d = -plane.approx_d;
}

/// value = n . x + d w, exactly.
void side_value(mpz_class &value, const Plane &plane, const Point &p)
{
    mpz_mul(value.get_mpz_t(), plane.d.get_mpz_t(), p.w.get_mpz_t());
    for (int k = 0; k < 3; ++k) mpz_addmul(value.get_mpz_t(), plane.n[k].get_mpz_t(), p.x[k].get_mpz_t());
}

int side_sign(const Plane &plane, const Point &p)
{
    double sum = plane.approx_d, size = std::fabs(plane.approx_d);
    for (int k = 0; k < 3; ++k)
    {
        const double term = plane.approx_n[k] * p.approx[k];
        sum += term;
        size += std::fabs(term);
    }
    if (sum > filter * size) return 1;
    if (sum < -filter * size) return -1;
    static thread_local mpz_class value;
    side_value(value, plane, p);
    return sgn(value);
}

/// Where the segment from `inside` (negative side) to `outside` (positive side) meets the plane, in lowest terms.
void cut(Point &result, const Plane &plane, const Point &inside, const Point &outside)
{
    static thread_local mpz_class s, t, divisor;
    side_value(s, plane, outside);
    side_value(t, plane, inside);
    for (int k = 0; k < 4; ++k)
    {
        mpz_class &target = k < 3 ? result.x[k] : result.w;
        const mpz_class &p = k < 3 ? inside.x[k] : inside.w;
        const mpz_class &q = k < 3 ? outside.x[k] : outside.w;
        mpz_mul(target.get_mpz_t(), s.get_mpz_t(), p.get_mpz_t());
        mpz_submul(target.get_mpz_t(), t.get_mpz_t(), q.get_mpz_t());
    }
    divisor = result.w;
    for (int k = 0; k < 3 && divisor != 1; ++k) divisor = gcd(divisor, result.x[k]);
    if (divisor != 1)
    {
        for (int k = 0; k < 3; ++k) mpz_divexact(result.x[k].get_mpz_t(), result.x[k].get_mpz_t(), divisor.get_mpz_t());
        mpz_divexact(result.w.get_mpz_t(), result.w.get_mpz_t(), divisor.get_mpz_t());
    }
    // mantissas and exponents apart: numerator and denominator may leave the range of doubles
    long ew = 0, ex = 0;
    const double w = mpz_get_d_2exp(&ew, result.w.get_mpz_t());
    for (int k = 0; k < 3; ++k)
    {
        const double x = mpz_get_d_2exp(&ex, result.x[k].get_mpz_t());
        result.approx[k] = std::ldexp(x / w, static_cast<int>(ex - ew));
    }
}

struct Polygon
{
    std::vector<Point> points;
    size_t size = 0;

    void clear() { size = 0; }
    Point &next()
    {
        if (size == points.size()) points.emplace_back();
        return points[size++];
    }
};

/// Keeps the part on the negative side of the plane; nothing if no vertex is strictly there.
void clip(Polygon &polygon, Polygon &scratch, const Plane &plane)
{
    static thread_local std::vector<int> signs;
    signs.resize(polygon.size);
    bool any_inside = false, any_outside = false;
    for (size_t i = 0; i < polygon.size; ++i)
    {
        signs[i] = side_sign(plane, polygon.points[i]);
        any_inside = any_inside || signs[i] < 0;
        any_outside = any_outside || signs[i] > 0;
    }
    if (!any_inside) polygon.clear();
    if (!any_inside || !any_outside) return;
    scratch.clear();
    for (size_t i = 0; i < polygon.size; ++i)
    {
        const size_t j = i + 1 == polygon.size ? 0 : i + 1;
        if (signs[i] <= 0) scratch.next() = polygon.points[i];
        if (signs[i] < 0 && signs[j] > 0) cut(scratch.next(), plane, polygon.points[i], polygon.points[j]);
        if (signs[i] > 0 && signs[j] < 0) cut(scratch.next(), plane, polygon.points[j], polygon.points[i]);
    }
    std::swap(polygon.points, scratch.points);
    std::swap(polygon.size, scratch.size);
}

using Float = mpf_class;

struct Float3
{
    Float v[3] = {Float(0, sum_bits), Float(0, sum_bits), Float(0, sum_bits)};
};

/// Sums over clipped polygons; v[0] and v[1] of the area: seen from inside and from outside.
struct Sums
{
    Float volume = Float(0, sum_bits);    // six times, both views averaged
    Float3 moment;                        // 24 times
    Float3 area[2][2];                    // twice; [body][view]
    Float3 torque;                        // 12 times, of A's surface about the grid's origin
    Float magnitude = Float(0, sum_bits); // of the terms of the volume
    double total_area = 0, coplanar_area = 0;
};

void to_cartesian(Float3 &result, const Point &p)
{
    static thread_local Float w(0, sum_bits);
    w = p.w;
    for (int k = 0; k < 3; ++k)
    {
        result.v[k] = p.x[k];
        result.v[k] /= w;
    }
}

/// Twice the area vector of triangle p q r.
void double_area(Float3 &result, const Float3 &p, const Float3 &q, const Float3 &r)
{
    static thread_local Float3 u, v;
    static thread_local Float product(0, sum_bits);
    for (int k = 0; k < 3; ++k)
    {
        u.v[k] = q.v[k] - p.v[k];
        v.v[k] = r.v[k] - p.v[k];
    }
    for (int k = 0; k < 3; ++k)
    {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        result.v[k] = u.v[i] * v.v[j];
        product = u.v[j] * v.v[i];
        result.v[k] -= product;
    }
}

double length(const Float3 &v) { return std::sqrt(Float(v.v[0] * v.v[0] + v.v[1] * v.v[1] + v.v[2] * v.v[2]).get_d()); }

/// How a polygon counts: sign of its piece, and whether it is seen from inside and from outside of its surface.
struct Weight
{
    int sign;
    bool inner, outer;
};

/// 12 times the torque about the grid's origin: three times the middle of a triangle, cross twice its area, in halves.
void add_torque(Float3 &torque, const Float3 &area, const Float3 &p, const Float3 &q, const Float3 &r, int halves)
{
    static thread_local Float3 sum;
    static thread_local Float product(0, sum_bits);
    for (int k = 0; k < 3; ++k) sum.v[k] = p.v[k] + q.v[k] + r.v[k];
    for (int k = 0; k < 3; ++k)
    {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        product = sum.v[i] * area.v[j];
        product -= sum.v[j] * area.v[i];
        torque.v[k] += halves * product;
    }
}

void add_polygon(Sums &sums, int body, const Polygon &polygon, Weight weight)
{
    static thread_local Float3 first, p, q, area;
    static thread_local Float height(0, sum_bits), term(0, sum_bits);
    // half of a polygon that is seen from one side only: both bodies' halves, or opposite ones, add up to what is right
    const int halves = weight.sign * (int(weight.inner) + int(weight.outer));
    to_cartesian(first, polygon.points[0]);
    to_cartesian(q, polygon.points[1]);
    for (size_t i = 2; i < polygon.size; ++i)
    {
        std::swap(p, q);
        to_cartesian(q, polygon.points[i]);
        double_area(area, first, p, q);
        height = 0;
        for (int k = 0; k < 3; ++k)
        {
            term = area.v[k] * first.v[k];
            height += term;
            if (weight.inner) sums.area[body][0].v[k] += weight.sign * area.v[k];
            if (weight.outer) sums.area[body][1].v[k] += weight.sign * area.v[k];
        }
        height *= halves;
        sums.volume += height;
        sums.magnitude += abs(height);
        for (int k = 0; k < 3; ++k)
        {
            term = first.v[k] + p.v[k];
            term += q.v[k];
            term *= height;
            sums.moment.v[k] += term;
        }
        if (body == 0) add_torque(sums.torque, area, first, p, q, halves);
        const double size = length(area) * weight.sign;
        sums.total_area += 0.25 * std::abs(halves) * size;
        if (weight.inner != weight.outer) sums.coplanar_area += (body == 0 ? 0.5 : 0.0) * std::fabs(size);
    }
}

/// Points, triangles and signed convex pieces of one body.
struct Body
{
    const Mesh *mesh = nullptr;
    std::vector<Point> vertices;
    std::vector<Piece> pieces;
    std::vector<Box> boxes; // of the pieces
    bool has_negative = false;
};

bool same_plane(const Plane &p, const Plane &q)
{
    const mpz_class *u[4] = {&p.n[0], &p.n[1], &p.n[2], &p.d};
    const mpz_class *v[4] = {&q.n[0], &q.n[1], &q.n[2], &q.d};
    for (int i = 0; i < 3; ++i)
    {
        if (sgn(*u[i]) != sgn(*v[i])) return false;
        for (int j = i + 1; j < 4; ++j)
        {
            if (*u[i] * *v[j] != *u[j] * *v[i]) return false;
        }
    }
    return true;
}

bool is_flat(const Plane &plane) { return plane.n[0] == 0 && plane.n[1] == 0 && plane.n[2] == 0; }

/// One piece of all face planes if no vertex is outside any of them.
bool make_convex(Body &body)
{
    Piece piece;
    for (const Triangle &t : body.mesh->triangles)
    {
        Plane plane = plane_through(body.vertices[t[0]], body.vertices[t[1]], body.vertices[t[2]]);
        if (is_flat(plane)) continue;
        for (const Point &p : body.vertices)
        {
            if (side_sign(plane, p) > 0) return false;
        }
        const auto same = [&](const Plane &other) { return same_plane(plane, other); };
        const size_t window = std::min<size_t>(piece.planes.size(), 32); // a plane named twice does no harm
        if (std::none_of(piece.planes.end() - static_cast<long>(window), piece.planes.end(), same))
            piece.planes.push_back(plane);
    }
    body.pieces.push_back(piece);
    body.boxes.push_back(box_of(body.mesh->vertices));
    return true;
}

/// Positive if p[3] is behind the triangle p[0] p[1] p[2] seen from outside.
void add_tetrahedron(Body &body, const std::array<const Point *, 4> &p)
{
    Piece piece;
    Plane base = plane_through(*p[0], *p[1], *p[2]);
    piece.sign = -side_sign(base, *p[3]);
    if (piece.sign == 0) return;
    body.has_negative = body.has_negative || piece.sign < 0;
    static constexpr int faces[4][4] = {{0, 1, 2, 3}, {0, 3, 1, 2}, {1, 3, 2, 0}, {2, 3, 0, 1}};
    for (const auto &f : faces)
    {
        Plane plane = plane_through(*p[f[0]], *p[f[1]], *p[f[2]]);
        if (side_sign(plane, *p[f[3]]) > 0) flip(plane);
        piece.planes.push_back(plane);
    }
    body.pieces.push_back(piece);
}

/// The cells that reach into `limit`, or cones from the mean of the vertices.
void make_tetrahedra(Body &body, const Grid &grid, const Vector &apex, const Box &limit)
{
    const Mesh &mesh = *body.mesh;
    const auto add = [&](const std::array<const Point *, 4> &points, const Box &box)
    {
        if (!box.meets(limit)) return;
        const size_t before = body.pieces.size();
        add_tetrahedron(body, points);
        if (body.pieces.size() > before) body.boxes.push_back(box);
    };
    if (!mesh.cells.empty())
    {
        for (const Cell &c : mesh.cells)
        {
            Box box;
            for (int32_t v : c) box.add(mesh.vertices[v]);
            add({&body.vertices[c[0]], &body.vertices[c[2]], &body.vertices[c[1]], &body.vertices[c[3]]}, box);
        }
        return;
    }
    const Point top = grid.point(apex);
    for (const Triangle &t : mesh.triangles)
    {
        Box box;
        box.add(apex);
        for (int32_t v : t) box.add(mesh.vertices[v]);
        add({&body.vertices[t[0]], &body.vertices[t[1]], &body.vertices[t[2]], &top}, box);
    }
}

/// A point near the middle, on a grid of 2^-10 of the size so that the integers stay short.
Vector apex_of(const Mesh &mesh)
{
    const Box box = box_of(mesh.vertices);
    Vector mean = {0, 0, 0};
    double size = 0;
    for (int k = 0; k < 3; ++k)
    {
        for (const Vector &v : mesh.vertices) mean[k] += (v[k] - box.lower[k]) / double(mesh.vertices.size());
        size = std::max(size, box.upper[k] - box.lower[k]);
    }
    int e = 0;
    std::frexp(size, &e);
    for (int k = 0; k < 3; ++k)
    {
        const double step = std::ldexp(1.0, e - 10), p = box.lower[k] + mean[k];
        const double snapped = std::round(p / step) * step;
        mean[k] =
            box.upper[k] - box.lower[k] > 8 * step && snapped > box.lower[k] && snapped < box.upper[k] ? snapped : p;
    }
    return mean;
}

/// Sums over the part of `outer`'s surface (body 0 or 1) inside `inner`.
void add_surface(Sums &sums, Overlap &result, const Body &surface, const Body &solid, int which)
{
    static thread_local Polygon polygon, scratch;
    const Mesh &mesh = *surface.mesh;
    const Box limit = box_of(solid.mesh->vertices);
    for (const Triangle &t : mesh.triangles)
    {
        Box box;
        for (int32_t v : t) box.add(mesh.vertices[v]);
        if (!box.meets(limit)) continue;
        const Plane own = plane_through(surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]);
        if (is_flat(own)) continue;
        for (size_t i = 0; i < solid.pieces.size(); ++i)
        {
            if (!box.meets(solid.boxes[i])) continue;
            const Piece &piece = solid.pieces[i];
            Weight weight = {piece.sign, true, true};
            polygon.clear();
            for (int32_t v : t) polygon.next() = surface.vertices[v];
            for (const Plane &plane : piece.planes)
            {
                bool is_coplanar = true;
                for (int k = 0; k < 3 && is_coplanar; ++k) is_coplanar = side_sign(plane, surface.vertices[t[k]]) == 0;
                if (is_coplanar)
                {
                    const mpz_class dot = plane.n[0] * own.n[0] + plane.n[1] * own.n[1] + plane.n[2] * own.n[2];
                    (dot > 0 ? weight.outer : weight.inner) = false;
                    continue;
                }
                clip(polygon, scratch, plane);
                if (polygon.size == 0) break;
            }
            if (polygon.size < 3) continue;
            add_polygon(sums, which, polygon, weight);
            if (!weight.inner) continue;
            for (size_t k = 0; k < polygon.size; ++k)
            {
                const double *p = polygon.points[k].approx;
                result.points.push_back({p[0], p[1], p[2]});
            }
        }
    }
}

Long rounded(const Float &value)
{
    Long result;
    result.high = value.get_d();
    result.low = Float(value - result.high).get_d();
    return result;
}

void finish(Overlap &result, Sums &sums, const Grid &grid)
{
    // terms that cancel exactly leave roundings of 2^-640
    if (abs(sums.volume) < Float(sums.magnitude * 0x1p-600)) sums.volume = 0;
    // volume was summed six times and in halves, lengths are in units of 2^exponent
    const auto scaled = [&](const Float &value, int power)
    {
        Float x(value, sum_bits);
        const int shift = grid.exponent * power;
        if (shift >= 0) mpf_mul_2exp(x.get_mpf_t(), x.get_mpf_t(), static_cast<unsigned>(shift));
        else mpf_div_2exp(x.get_mpf_t(), x.get_mpf_t(), static_cast<unsigned>(-shift));
        return x;
    };
    result.volume = rounded(scaled(Float(sums.volume / 12), 3));
    Float3 closure;
    for (int k = 0; k < 3; ++k)
    {
        if (sums.volume != 0)
        {
            Float c = scaled(Float(sums.moment.v[k] / sums.volume / 4), 1);
            c += grid.origin[k];
            result.centroid[k] = rounded(c);
        }
        result.area_inner[k] = scaled(Float(sums.area[0][0].v[k] / 2), 2).get_d();
        result.area_outer[k] = scaled(Float(sums.area[0][1].v[k] / 2), 2).get_d();
        // from the grid's origin to the centroid: less its distance cross the area vector
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        Float torque(sums.torque.v[k] / 12, sum_bits);
        if (sums.volume != 0)
        {
            const auto four_areas = [&](int m) { return Float(sums.area[0][0].v[m] + sums.area[0][1].v[m]); };
            torque -= (sums.moment.v[i] * four_areas(j) - sums.moment.v[j] * four_areas(i)) / sums.volume / 16;
        }
        result.torque[k] = scaled(torque, 3).get_d();
        closure.v[k] = sums.area[0][0].v[k] + sums.area[0][1].v[k] + sums.area[1][0].v[k] + sums.area[1][1].v[k];
    }
    result.closure_error = sums.total_area > 0 ? length(closure) / sums.total_area : 0;
    result.area = std::ldexp(sums.total_area, 2 * grid.exponent);
    result.coplanar_area = std::ldexp(sums.coplanar_area, 2 * grid.exponent);
    for (Vector &p : result.points)
    {
        for (double &x : p) x = std::ldexp(x, grid.exponent);
    }
}

} // namespace

Overlap exact_overlap(const Mesh &a, const Mesh &b)
{
    Overlap result;
    result.origin = a.vertices[0];
    const Box boxes[2] = {box_of(a.vertices), box_of(b.vertices)};
    if (!boxes[0].meets(boxes[1])) return result;
    const Mesh *meshes[2] = {&a, &b};
    const Vector apexes[2] = {apex_of(a), apex_of(b)};
    Grid grid(result.origin);
    for (int k = 0; k < 2; ++k)
    {
        grid.include(meshes[k]->vertices);
        grid.include(apexes[k]);
    }
    Body bodies[2];
    for (int k = 0; k < 2; ++k)
    {
        bodies[k].mesh = meshes[k];
        bodies[k].vertices = grid.points(meshes[k]->vertices);
        if (!make_convex(bodies[k])) make_tetrahedra(bodies[k], grid, apexes[k], boxes[1 - k]);
    }
    Sums sums;
    for (int k = 0; k < 2; ++k)
    {
        const size_t before = result.points.size();
        add_surface(sums, result, bodies[k], bodies[1 - k], k);
        result.is_crossing[static_cast<size_t>(k)] = result.points.size() > before;
    }
    result.has_points = !bodies[0].has_negative && !bodies[1].has_negative;
    finish(result, sums, grid);
    return result;
}

Long exact_volume(const Mesh &mesh)
{
    Grid grid(mesh.vertices[0]);
    grid.include(mesh.vertices);
    const std::vector<Point> p = grid.points(mesh.vertices);
    mpz_class sum = 0;
    for (const Triangle &t : mesh.triangles)
    {
        const Plane plane = plane_through(p[t[0]], p[t[1]], p[t[2]]);
        sum -= plane.d; // n . p = six times the volume of the cone from the origin
    }
    Float value(sum, sum_bits);
    value /= 6;
    const int shift = 3 * grid.exponent;
    if (shift >= 0) mpf_mul_2exp(value.get_mpf_t(), value.get_mpf_t(), static_cast<unsigned>(shift));
    else mpf_div_2exp(value.get_mpf_t(), value.get_mpf_t(), static_cast<unsigned>(-shift));
    return rounded(value);
}

bool is_exactly_convex(const Mesh &mesh)
{
    Grid grid(mesh.vertices[0]);
    grid.include(mesh.vertices);
    Body body;
    body.mesh = &mesh;
    body.vertices = grid.points(mesh.vertices);
    return make_convex(body);
}

bool cells_fill_mesh(const Mesh &mesh)
{
    // each face of each cell, turned outwards, cancels with its reverse or is a triangle of the mesh
    std::map<std::array<int32_t, 3>, int> count;
    const auto add = [&](std::array<int32_t, 3> f, int weight)
    {
        int parity = weight;
        for (int pass = 0; pass < 2; ++pass)
        {
            for (int k = 0; k < 2; ++k)
            {
                if (f[k] > f[k + 1])
                {
                    std::swap(f[k], f[k + 1]);
                    parity = -parity;
                }
            }
        }
        count[f] += parity;
    };
    for (const Cell &c : mesh.cells)
    {
        Mesh one;
        for (int32_t v : c) one.vertices.push_back(mesh.vertices[v]);
        one.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        if (exact_volume(one).high <= 0) return false;
        for (const Triangle &t : one.triangles) add({c[t[0]], c[t[1]], c[t[2]]}, 1);
    }
    for (const Triangle &t : mesh.triangles) add(t, -1);
    return std::all_of(count.begin(), count.end(), [](const auto &entry) { return entry.second == 0; });
}

double extent_along(const std::vector<Vector> &points, const Vector &direction)
{
    double lower = HUGE_VAL, upper = -HUGE_VAL;
    for (const Vector &p : points)
    {
        const double s = p[0] * direction[0] + p[1] * direction[1] + p[2] * direction[2];
        lower = std::min(lower, s);
        upper = std::max(upper, s);
    }
    const double norm =
        std::sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    return points.empty() || norm == 0 ? 0 : (upper - lower) / norm;
}

} // namespace reference
