#include "cgal_overlap.hpp"

#include <chrono>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Surface_mesh.h>

namespace reference
{
namespace
{

template <class Kernel> Corefinement corefined_overlap(const Mesh &a, const Mesh &b)
{
    using SurfaceMesh = CGAL::Surface_mesh<typename Kernel::Point_3>;
    namespace processing = CGAL::Polygon_mesh_processing;
    SurfaceMesh meshes[3];
    const Mesh *sources[2] = {&a, &b};
    for (int k = 0; k < 2; ++k)
    {
        std::vector<typename SurfaceMesh::Vertex_index> index;
        for (const Vector &v : sources[k]->vertices)
            index.push_back(meshes[k].add_vertex(typename Kernel::Point_3(v[0], v[1], v[2])));
        const auto at = [&](int32_t i) { return index[static_cast<size_t>(i)]; };
        for (const Triangle &t : sources[k]->triangles) meshes[k].add_face(at(t[0]), at(t[1]), at(t[2]));
    }
    Corefinement result;
    const auto start = std::chrono::steady_clock::now();
    try
    {
        result.is_done = processing::corefine_and_compute_intersection(meshes[0], meshes[1], meshes[2]);
        if (result.is_done) result.volume = CGAL::to_double(CGAL::exact(processing::volume(meshes[2])));
    }
    catch (const std::exception &)
    {
        result.is_done = false;
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

} // namespace

Corefinement corefined_overlap_exact(const Mesh &a, const Mesh &b)
{
    return corefined_overlap<CGAL::Exact_predicates_exact_constructions_kernel>(a, b);
}

Corefinement corefined_overlap_inexact(const Mesh &a, const Mesh &b)
{
    return corefined_overlap<CGAL::Exact_predicates_inexact_constructions_kernel>(a, b);
}

} // namespace reference
