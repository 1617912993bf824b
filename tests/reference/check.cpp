#include "check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

#define BOOST_BIND_GLOBAL_PLACEHOLDERS // property_tree of 1.74 still uses them
#include <boost/property_tree/json_parser.hpp>

namespace reference
{
namespace
{

constexpr int max_printed = 4;

/// One problem: what its reference says, and its unit of volume.
struct Context
{
    const Overlap exact;
    const Demands demands;
    const double larger, smaller, unit;
    const Vector area; // mean of the two views

    Context(const Pose &pose, const Demands &new_demands)
        : exact(exact_overlap(pose.a, pose.b)), demands(new_demands), larger(std::max(extent(pose.a), extent(pose.b))),
          smaller(std::min(extent(pose.a), extent(pose.b))), unit(epsilon * larger * smaller * smaller),
          area(0.5 * (exact.area_inner + exact.area_outer))
    {
    }
    /// Volume that may be wrong: the bound, and a layer over the surface of the overlap.
    double fuzziness() const { return volume_bound * unit + demands.displacement * exact.area; }
};

/// Collects what is wrong with one result.
class Faults
{
  public:
    void check(bool is_good, const char *what, double value, double bound)
    {
        if (is_good) return;
        char text[160];
        std::snprintf(text, sizeof text, "%s%s %.3g, bound %.3g", list.empty() ? "" : "; ", what, value, bound);
        list += text;
    }
    std::string list;
};

double minus(double value, const Long &exact) { return (value - exact.high) - exact.low; }

bool is_finite(const Result &r)
{
    double sum = r.volume + r.indentation + r.radius + r.residual;
    for (size_t k = 0; k < 3; ++k) sum += r.area[k] + r.centroid[k] + r.normal[k];
    return std::isfinite(sum);
}

void check_volume(const Context &c, const Result &r, Faults &faults, Statistics &s)
{
    const double error = std::fabs(minus(r.volume, c.exact.volume));
    const double units = std::max(0.0, error - c.demands.displacement * c.exact.area) / c.unit;
    s.worst_units = std::max(s.worst_units, units);
    s.worst_negative = std::max(s.worst_negative, -r.volume / c.unit);
    s.num_gross += units > gross_error ? 1 : 0;
    faults.check(units <= volume_bound, "|dV| in units", units, volume_bound);
    faults.check(r.volume >= -volume_bound * c.unit, "V in units", r.volume / c.unit, -volume_bound);
    if (!c.demands.area || c.exact.volume.high <= 0) return;
    const double relative = error / c.exact.volume.high;
    s.relative.push_back(relative);
    if (c.demands.volume_relative > 0)
        faults.check(relative <= c.demands.volume_relative, "|dV|/V", relative, c.demands.volume_relative);
}

void check_centroid(const Context &c, const Result &r, Faults &faults, Statistics &s)
{
    if (r.status == SCREE_OVERLAP_NONE || c.exact.volume.high <= 0) return;
    double sum = 0, magnitude = 0;
    for (size_t k = 0; k < 3; ++k)
    {
        const double d = minus(r.centroid[k], c.exact.centroid[k]);
        sum += d * d;
        magnitude = std::max(magnitude, std::fabs(r.centroid[k]));
    }
    const double error = std::sqrt(sum);
    if (c.demands.area) s.worst_centroid = std::max(s.worst_centroid, error / c.smaller);
    // wrong volume may lie anywhere in the smaller body; the result is a rounded world coordinate
    double bound = 2 * c.smaller * std::min(1.0, c.fuzziness() / c.exact.volume.high);
    if (c.demands.centroid_bound > 0) bound = std::min(bound, c.demands.centroid_bound * c.smaller);
    bound += 4 * epsilon * (magnitude + c.larger) + c.demands.displacement;
    faults.check(error <= bound, "|dc|", error, bound);
}

void check_area(const Context &c, const Result &r, Faults &faults, Statistics &s)
{
    const double length = norm(c.area), error = norm(r.area - c.area);
    if (c.demands.area && length > 0 && r.status == SCREE_OVERLAP_TOUCHING)
    {
        s.worst_area = std::max(s.worst_area, error / length);
        s.worst_residual = std::max(s.worst_residual, r.residual);
        faults.check(error <= c.demands.area_bound * length, "|dS|/|S|", error / length, c.demands.area_bound);
    }
    if (c.demands.lattice_area && r.status != SCREE_OVERLAP_NONE)
    {
        // each piece of coplanar area counts or does not: at most half of it away from the mean
        const double bound = 0.5 * c.exact.coplanar_area + 1e3 * epsilon * c.larger * c.smaller;
        faults.check(error <= bound, "|dS| beyond the coplanar area", error, bound);
    }
}

void check_indentation(const Context &c, const Result &r, Faults &faults, Statistics &s)
{
    if (r.status != SCREE_OVERLAP_TOUCHING) return;
    faults.check(r.indentation >= 0 && r.indentation <= 2 * c.smaller, "d", r.indentation, 2 * c.smaller);
    if (!c.demands.indentation || !c.exact.has_points) return;
    const double error = std::fabs(r.indentation - extent_along(c.exact.points, r.normal));
    s.worst_indentation = std::max(s.worst_indentation, error / c.smaller);
    const double bound = std::max(c.demands.centroid_bound, 1e-9) * c.smaller + 2 * c.demands.displacement;
    faults.check(error <= bound, "|dd|", error, bound);
    double radius = 0;
    for (const Vector &p : c.exact.points)
    {
        const Vector from = c.exact.origin - r.centroid + p;
        radius = std::max(radius, norm(cross(from, r.normal)));
    }
    const double radius_error = std::fabs(r.radius - radius);
    faults.check(radius_error <= bound, "error of the radius", radius_error, bound);
}

void check_status(const Context &c, const Result &r, Faults &faults)
{
    const bool is_nested = !(c.exact.is_crossing[0] && c.exact.is_crossing[1]);
    const double volume = c.exact.volume.high, noise = 2 * c.fuzziness();
    switch (r.status)
    {
    case SCREE_OVERLAP_NONE:
        faults.check(r.volume <= 0, "V with status none", r.volume, 0);
        break;
    case SCREE_OVERLAP_TOUCHING:
        faults.check(r.volume > 0, "V with status touching", r.volume, 0);
        faults.check(std::fabs(norm(r.normal) - 1) <= 4 * epsilon, "|n|", norm(r.normal), 1);
        faults.check(norm(r.normal - (1 / norm(r.area)) * r.area) <= 8 * epsilon, "n off S", norm(r.normal), 1);
        if (c.demands.area) faults.check(!is_nested, "touching, but nested: V", r.volume, 0);
        break;
    case SCREE_OVERLAP_NO_NORMAL:
        // S of a bar right through a body vanishes, too
        if (c.demands.area && !is_nested && norm(c.area) > 1e-6 * c.exact.area)
            faults.check(volume <= noise, "no normal, V in units", volume / c.unit, noise / c.unit);
        faults.check(norm(r.normal) == 0, "|n| without normal", norm(r.normal), 0);
        break;
    default:
        faults.check(false, "status", r.status, 0);
    }
    if (c.demands.area && volume > noise) faults.check(r.status != SCREE_OVERLAP_NONE, "status", r.status, 1);
}

std::string check_result(const Context &c, const Result &r, Statistics &s)
{
    Faults faults;
    s.num_fallbacks += r.used_fallback ? 1 : 0;
    ++s.num_results;
    s.num_touching += r.status == SCREE_OVERLAP_TOUCHING ? 1 : 0;
    if (!is_finite(r))
    {
        faults.check(false, "not finite: V", r.volume, 0);
        return faults.list;
    }
    check_volume(c, r, faults, s);
    check_centroid(c, r, faults, s);
    check_area(c, r, faults, s);
    check_indentation(c, r, faults, s);
    check_status(c, r, faults);
    return faults.list;
}

/// Swapped arguments must give the opposite area vector and normal; the rest is compared with the reference anyway.
Result turned_back(Result r)
{
    for (size_t k = 0; k < 3; ++k)
    {
        r.area[k] = -r.area[k];
        r.normal[k] = -r.normal[k];
    }
    return r;
}

bool check_bodies(const Pose &world, const Body &a, const Body &b, const Demands &demands, Engine &engine,
                  Statistics &s)
{
    const Context context(world, demands);
    ++s.num_poses;
    std::string faults;
    struct Way
    {
        const char *name;
        scree_overlap_scheme scheme;
        bool use_convex_path;
    };
    for (const Way &way :
         {Way{"filtered", SCREE_OVERLAP_FILTERED, false}, Way{"hierarchy", SCREE_OVERLAP_HIERARCHY, false},
          Way{"convex path", SCREE_OVERLAP_FILTERED, true}})
    {
        if (way.use_convex_path && !(a.view()->is_convex && b.view()->is_convex)) continue;
        const std::string name = way.name;
        const std::string straight = check_result(context, engine.compute(a, b, way.scheme, way.use_convex_path), s);
        if (!straight.empty()) faults += "\n    " + name + ": " + straight;
        const std::string swapped =
            check_result(context, turned_back(engine.compute(b, a, way.scheme, way.use_convex_path)), s);
        if (!swapped.empty()) faults += "\n    " + name + ", swapped: " + swapped;
    }
    if (faults.empty()) return true;
    if (++s.num_failed <= max_printed)
    {
        std::printf("failed: %s (exact V %.17g)%s\n", world.kind.c_str(), context.exact.volume.high, faults.c_str());
        if (world.a.triangles.size() + world.b.triangles.size() <= 200) std::printf("%s\n", to_json(world).c_str());
        std::fflush(stdout);
    }
    return false;
}

std::string mesh_to_json(const Mesh &mesh)
{
    std::string text = "{\"vertices\": [";
    char number[128];
    const char *separator = "";
    for (const Vector &v : mesh.vertices)
    {
        std::snprintf(number, sizeof number, "%s[%.17g, %.17g, %.17g]", separator, v[0], v[1], v[2]);
        text += number;
        separator = ", ";
    }
    text += "], \"triangles\": [";
    separator = "";
    for (const Triangle &t : mesh.triangles)
    {
        std::snprintf(number, sizeof number, "%s[%d, %d, %d]", separator, t[0], t[1], t[2]);
        text += number;
        separator = ", ";
    }
    return text + "]}";
}

Mesh mesh_from_json(const boost::property_tree::ptree &tree)
{
    Mesh mesh;
    for (const auto &row : tree.get_child("vertices"))
    {
        Vector v{};
        size_t k = 0;
        for (const auto &x : row.second) v.at(k++) = std::strtod(x.second.data().c_str(), nullptr);
        mesh.vertices.push_back(v);
    }
    for (const auto &row : tree.get_child("triangles"))
    {
        Triangle t{};
        size_t k = 0;
        for (const auto &x : row.second) t.at(k++) = std::atoi(x.second.data().c_str());
        mesh.triangles.push_back(t);
    }
    return mesh;
}

void print_result(const char *name, const Context &c, const Result &r)
{
    static const char *const texts[] = {"none", "touching", "no normal", "workspace full"};
    std::printf(
        "  %-19s %-9s V %.17g (%.3g units off) c (%.17g %.17g %.17g) S (%.9g %.9g %.9g) d %.9g residual %.2g%s\n", name,
        texts[r.status], r.volume, minus(r.volume, c.exact.volume) / c.unit, r.centroid[0], r.centroid[1],
        r.centroid[2], r.area[0], r.area[1], r.area[2], r.indentation, r.residual, r.used_fallback ? ", fallback" : "");
}

} // namespace

void Statistics::add(const Statistics &other)
{
    num_poses += other.num_poses;
    num_failed += other.num_failed;
    num_gross += other.num_gross;
    num_fallbacks += other.num_fallbacks;
    num_touching += other.num_touching;
    num_results += other.num_results;
    worst_units = std::max(worst_units, other.worst_units);
    worst_negative = std::max(worst_negative, other.worst_negative);
    worst_area = std::max(worst_area, other.worst_area);
    worst_centroid = std::max(worst_centroid, other.worst_centroid);
    worst_indentation = std::max(worst_indentation, other.worst_indentation);
    worst_residual = std::max(worst_residual, other.worst_residual);
    relative.insert(relative.end(), other.relative.begin(), other.relative.end());
}

double quantile(std::vector<double> values, double q)
{
    if (values.empty()) return 0;
    const auto place = values.begin() + static_cast<long>(q * double(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

bool check_pose(const Pose &pose, const Demands &demands, Engine &engine, Statistics &statistics)
{
    Pose world = pose;
    world.a = to_precision(pose.a);
    world.b = to_precision(pose.b);
    const Body a(world.a), b(world.b);
    return check_bodies(world, a, b, demands, engine, statistics);
}

bool check_placed_pose(const Pose &local, const Placement &at_a, const Placement &at_b, Demands demands, Engine &engine,
                       Statistics &statistics)
{
    Pose world = local;
    world.a = placed(to_precision(local.a), at_a);
    world.b = placed(to_precision(local.b), at_b);
    const Body a(local.a, at_a), b(local.b, at_b);
    return check_bodies(world, a, b, demands, engine, statistics);
}

bool is_representable(const Pose &pose)
{
    const double size = std::min(extent(pose.a), extent(pose.b));
    return norm(pose.a.vertices[0]) * epsilon <= 1e-3 * size;
}

void print_header()
{
    std::printf("%-32s %6s %6s %9s %9s %9s %9s %9s %9s %9s %6s\n", "", "poses", "failed", "|dV|/unit", "-V/unit",
                "med dV/V", "max dV/V", "|dS|/|S|", "|dc|/size", "|dd|/size", "fallbk");
}

void print_statistics(const std::string &name, const Statistics &s)
{
    std::printf("%-32s %6d %6d %9.3g %9.3g %9.2g %9.2g %9.2g %9.2g %9.2g %6d\n", name.c_str(), s.num_poses,
                s.num_failed, s.worst_units, s.worst_negative, quantile(s.relative, 0.5), quantile(s.relative, 1),
                s.worst_area, s.worst_centroid, s.worst_indentation, s.num_fallbacks);
    std::fflush(stdout);
}

std::string to_json(const Pose &pose)
{
    return "{\"id\": \"" + pose.kind + "\", \"a\": " + mesh_to_json(pose.a) + ", \"b\": " + mesh_to_json(pose.b) + "}";
}

std::vector<Pose> read_poses(const std::string &path)
{
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read " + path);
    std::vector<Pose> poses;
    for (std::string line; std::getline(file, line);)
    {
        if (line.empty() || line[0] != '{') continue; // what a test has printed may be given as it is
        std::istringstream text(line);
        boost::property_tree::ptree tree;
        boost::property_tree::read_json(text, tree);
        Pose pose;
        pose.kind = tree.get<std::string>("id", "");
        pose.a = mesh_from_json(tree.get_child("a"));
        pose.b = mesh_from_json(tree.get_child("b"));
        poses.push_back(pose);
    }
    return poses;
}

Arguments read_arguments(int argc, char **argv)
{
    Arguments arguments;
    for (int i = 1; i + 1 < argc; i += 2)
    {
        const std::string name = argv[i];
        if (name == "--replay") arguments.replay = argv[i + 1];
        else if (name == "--poses") arguments.num_poses = std::atoi(argv[i + 1]);
        else if (name == "--kind") arguments.kind = std::atoi(argv[i + 1]);
        else if (name == "--seed") arguments.seed = std::strtoull(argv[i + 1], nullptr, 10);
        else argc = 0;
    }
    if (argc % 2 == 0)
    {
        std::printf("usage: %s [--replay FILE] [--poses N] [--seed S] [--kind K]\n", argv[0]);
        std::exit(2);
    }
    return arguments;
}

int replay(const std::string &path)
{
    Engine engine;
    Statistics statistics;
    for (const Pose &given : read_poses(path))
    {
        Pose pose = given;
        pose.a = to_precision(given.a);
        pose.b = to_precision(given.b);
        const Context c(pose, {});
        const Body a(pose.a), b(pose.b);
        const auto &e = c.exact;
        std::printf("%s\n  %-19s           V %.17g unit %.3g c (%.17g %.17g %.17g) S (%.9g %.9g %.9g) coplanar %.3g\n",
                    pose.kind.c_str(), "exact", e.volume.high, c.unit, e.centroid[0].high, e.centroid[1].high,
                    e.centroid[2].high, c.area[0], c.area[1], c.area[2], e.coplanar_area);
        print_result("filtered", c, engine.compute(a, b, SCREE_OVERLAP_FILTERED));
        print_result("filtered, swapped", c, turned_back(engine.compute(b, a, SCREE_OVERLAP_FILTERED)));
        print_result("hierarchy", c, engine.compute(a, b, SCREE_OVERLAP_HIERARCHY));
        print_result("hierarchy, swapped", c, turned_back(engine.compute(b, a, SCREE_OVERLAP_HIERARCHY)));
        check_bodies(pose, a, b, {}, engine, statistics);
    }
    return statistics.num_failed > 0;
}

} // namespace reference
