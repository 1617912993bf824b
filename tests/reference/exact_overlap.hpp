/// \file exact_overlap.hpp
/// Overlap of two triangle meshes in exact integer arithmetic: the reference that scree's overlap is compared with.
///
/// Method, on purpose another one than scree's: B is written as a signed sum of convex pieces (itself if it is convex,
/// the tetrahedra of Mesh::cells, or the cones of its triangles from an inner point). Each triangle of A is clipped by
/// the planes of each piece; the clipped polygons are the part of A's surface inside B, and the other way round. Volume
/// and first moment follow from the divergence theorem. All coordinates are integers after a common power of two is
/// taken out, points are homogeneous big integers, every sign is exact. The sums of the clipped polygons use 640-bit
/// floating point. Coplanar faces are seen from both of their sides, so that nothing is perturbed or left open.
#ifndef SCREE_REFERENCE_EXACT_OVERLAP_HPP
#define SCREE_REFERENCE_EXACT_OVERLAP_HPP

#include <array>
#include <cstdint>
#include <vector>

namespace reference
{

using Vector = std::array<double, 3>;
using Triangle = std::array<int32_t, 3>;
using Cell = std::array<int32_t, 4>;

/// Closed, outward oriented triangle mesh in world coordinates.
struct Mesh
{
    std::vector<Vector> vertices;
    std::vector<Triangle> triangles;
    std::vector<Cell> cells; ///< tetrahedra over the vertices whose boundary is exactly `triangles`, or none
};

/// A number known to about 106 bits: high + low.
struct Long
{
    double high = 0, low = 0;
};

struct Overlap
{
    Long volume;
    std::array<Long, 3> centroid{}; ///< absolute; meaningless without volume
    /// Area vector of the part of A's surface inside B, seen from just inside and from just outside of A's surface.
    /// They differ where faces are coplanar: there the area vector is not continuous, and any value between is fair.
    Vector area_inner{}, area_outer{};
    /// Integral of x cross n over the same part of A's surface, x from the centroid; the mean of the two views.
    Vector torque{};
    double coplanar_area = 0;          ///< area of A's surface in which the two views differ
    double area = 0;                   ///< area of the part of A's surface inside B, and of B's inside A
    std::array<bool, 2> is_crossing{}; ///< some of A's surface is inside B; some of B's inside A
    Vector origin{};                   ///< a vertex of A
    std::vector<Vector> points;        ///< vertices of the overlap solid minus origin, rounded
    bool has_points = true;            ///< false: signed pieces were needed, `points` may lie outside
    double closure_error = 0;          ///< |S_A + S_B| with both views averaged: zero but for 640-bit rounding
};

Overlap exact_overlap(const Mesh &a, const Mesh &b);

/// Volume of one mesh, exactly summed.
Long exact_volume(const Mesh &mesh);

/// True if no vertex lies outside the plane of any triangle, exactly.
bool is_exactly_convex(const Mesh &mesh);

/// True if `cells` are positively oriented and their boundary is `triangles`: a check of the generators.
bool cells_fill_mesh(const Mesh &mesh);

/// Extent of the points along a direction, divided by its length.
double extent_along(const std::vector<Vector> &points, const Vector &direction);

} // namespace reference

#endif
