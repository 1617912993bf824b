#include "cgal_overlap.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Polyhedron_incremental_builder_3.h>

namespace reference
{
namespace
{

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using Polyhedron = CGAL::Polyhedron_3<Kernel>;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;
using Point = Kernel::Point_3;
using Direction = Kernel::Vector_3;

class Builder : public CGAL::Modifier_base<Polyhedron::HalfedgeDS>
{
  public:
    explicit Builder(const Mesh &new_mesh) : mesh(new_mesh) {}
    void operator()(Polyhedron::HalfedgeDS &target) override
    {
        CGAL::Polyhedron_incremental_builder_3<Polyhedron::HalfedgeDS> builder(target);
        builder.begin_surface(mesh.vertices.size(), mesh.triangles.size());
        for (const Vector &v : mesh.vertices) builder.add_vertex(Point(v[0], v[1], v[2]));
        for (const Triangle &t : mesh.triangles) builder.add_facet(t.begin(), t.end());
        builder.end_surface();
    }

  private:
    const Mesh &mesh;
};

Nef nef_of(const Mesh &mesh)
{
    Polyhedron polyhedron;
    Builder builder(mesh);
    polyhedron.delegate(builder);
    return Nef(polyhedron);
}

Long rounded(const Number &value)
{
    // a lazy number rounds well only after it has been made exact
    const auto &exact = value.exact();
    Long result;
    result.high = CGAL::to_double(exact);
    const std::remove_cv_t<std::remove_reference_t<decltype(exact)>> rest = exact - result.high;
    result.low = CGAL::to_double(rest);
    return result;
}

/// Integrals over the facets of the marked volumes.
struct Integrals
{
    Number volume = 0; ///< six times
    Direction moment = Direction(0, 0, 0);
    Direction area = Direction(0, 0, 0); ///< twice
};

/// Adds one facet; `origin` is the point the cones start from. True normals point out of the solid or into it alike for
/// all facets: the sign of the volume tells.
void add_facet(Integrals &sums, const Nef::Halffacet_const_handle &facet, const Point &origin, bool is_of_a)
{
    bool has_reference = false;
    Direction reference;
    for (auto cycle = facet->facet_cycles_begin(); cycle != facet->facet_cycles_end(); ++cycle)
    {
        if (!cycle.is_shalfedge()) continue;
        const Nef::SHalfedge_const_handle start = cycle;
        Nef::SHalfedge_around_facet_const_circulator at(start), end(at);
        CGAL_For_all(at, end)
        {
            const Direction p = at->source()->source()->point() - origin;
            const Direction q = at->next()->source()->source()->point() - origin;
            if (!has_reference) reference = p;
            has_reference = true;
            const Direction area = CGAL::cross_product(p - reference, q - reference);
            const Number height = area * reference;
            sums.volume += height;
            sums.moment = sums.moment + height * (reference + p + q);
            if (is_of_a) sums.area = sums.area + area;
        }
    }
}

} // namespace

NefOverlap nef_overlap(const Mesh &a, const Mesh &b)
{
    const Nef common = (nef_of(a) * nef_of(b)).regularization();
    const Point origin(a.vertices[0][0], a.vertices[0][1], a.vertices[0][2]);
    std::vector<Kernel::Plane_3> planes;
    for (const Triangle &t : a.triangles)
    {
        Point p[3];
        for (int k = 0; k < 3; ++k)
        {
            const Vector &v = a.vertices[static_cast<size_t>(t[static_cast<size_t>(k)])];
            p[k] = Point(v[0], v[1], v[2]);
        }
        planes.emplace_back(p[0], p[1], p[2]);
    }
    Integrals sums;
    NefOverlap result;
    Nef::Volume_const_iterator volume;
    CGAL_forall_volumes(volume, common) result.num_patches += volume->mark() ? 1 : 0;
    Nef::Halffacet_const_iterator facet;
    CGAL_forall_halffacets(facet, common)
    {
        if (!facet->incident_volume()->mark()) continue;
        const Kernel::Plane_3 outside = facet->twin()->plane(), inside = facet->plane();
        bool is_of_a = false;
        for (const auto &plane : planes) is_of_a = is_of_a || plane == outside || plane == inside;
        add_facet(sums, facet, origin, is_of_a);
    }
    if (sums.volume == 0) return result;
    const int sign = sums.volume > 0 ? 1 : -1;
    result.volume = rounded(sign * sums.volume / 6);
    for (int k = 0; k < 3; ++k)
    {
        result.centroid[static_cast<size_t>(k)] = rounded(origin[k] + sums.moment[k] / sums.volume / 4);
        result.area[static_cast<size_t>(k)] = rounded(sign * sums.area[k] / 2).high;
    }
    return result;
}

} // namespace reference
