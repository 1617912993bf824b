/// \file poses.hpp
/// Pairs of bodies: ordinary contacts, hard cases by kind, and random ones on small integer lattices.
#ifndef SCREE_REFERENCE_POSES_HPP
#define SCREE_REFERENCE_POSES_HPP

#include <string>

#include "shapes.hpp"

namespace reference
{

struct Pose
{
    std::string kind;
    Mesh a, b;              ///< world coordinates
    bool is_robust = false; ///< a change by many units in the last place changes nothing but digits
};

/// Distance that b can move along -direction before it first meets a; infinite if it never does. b must lie on the
/// side of `direction`. Rounded.
double gap_along(const Mesh &a, const Mesh &b, const Vector &direction);

/// b moved along a random direction until it reaches into a by `depth`.
Mesh brought_together(const Mesh &a, Mesh b, double depth, Random &random);

/// Two shapes of num_shapes(), turned at random, that reach into each other by 1e-4 to 5e-2 of the smaller one.
Pose ordinary_pose(int shape_a, int shape_b, Random &random);

int num_hard_kinds();
std::string hard_kind_name(int kind);
/// Number `index` of the cases of one kind. Every third as constructed (coordinates of few bits, so that coplanarity
/// and incidence are exact) in one of the 24 axis-parallel positions, every third with all coordinates scaled by a
/// number of 53 bits, every third turned as a whole, so that all that was exact becomes nearly so.
Pose hard_pose(int kind, int index, Random &random);

/// Small bodies on a lattice of integers, perturbed by units in the last place, tiny turns or shifts, or not at all.
/// `is_exact`: the coordinates are small integers times a power of two.
Pose lattice_pose(Random &random, bool &is_exact);

} // namespace reference

#endif
