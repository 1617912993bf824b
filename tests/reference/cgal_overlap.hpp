/// \file cgal_overlap.hpp
/// The same overlap by two algorithms of CGAL: Nef polyhedra (exact on every input, slow) and corefinement of surface
/// meshes (with exact or with rounded constructions; refuses some degenerate input).
#ifndef SCREE_REFERENCE_CGAL_OVERLAP_HPP
#define SCREE_REFERENCE_CGAL_OVERLAP_HPP

#include "exact_overlap.hpp"

namespace reference
{

struct NefOverlap
{
    Long volume;
    std::array<Long, 3> centroid{};
    Vector area{};       ///< of the facets that lie in a plane of A with the same sense
    int num_patches = 0; ///< connected pieces of the interior
};

/// Regularised intersection, integrated over its facets in exact rational numbers.
NefOverlap nef_overlap(const Mesh &a, const Mesh &b);

struct Corefinement
{
    bool is_done = false; ///< false: refused
    double volume = 0;
    double seconds = 0; ///< of the intersection itself, without filling the data structures
};

Corefinement corefined_overlap_exact(const Mesh &a, const Mesh &b);
Corefinement corefined_overlap_inexact(const Mesh &a, const Mesh &b);

} // namespace reference

#endif
