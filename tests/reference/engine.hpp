/// \file engine.hpp
/// scree's overlap behind C++: bodies from reference meshes, results in double. Compiled once per precision.
#ifndef SCREE_REFERENCE_ENGINE_HPP
#define SCREE_REFERENCE_ENGINE_HPP

#include <cfloat>
#include <memory>

#include "shapes.hpp"

extern "C"
{
#include "contact/overlap.h"
}

namespace reference
{

constexpr double epsilon = SCREE_REAL_EPSILON;

/// Where a body is: world = R(orientation) (scale * body) + position; identity by default.
struct Placement
{
    Vector position = {0, 0, 0};
    std::array<double, 4> orientation = {1, 0, 0, 0};
    double scale = 1;
};

Placement random_placement(Random &random);
/// What the placement's numbers are once they are held in scree_real.
Placement to_precision(const Placement &placement);
/// Coordinates rounded to scree_real, so that the reference sees what scree sees.
Mesh to_precision(Mesh mesh);
/// World vertices as scree makes them: scaled, ((R0 x + R1 y) + R2 z) + t in scree_real.
Mesh placed(const Mesh &mesh, const Placement &placement);

/// A mesh as scree's shape, source frame.
class Body
{
  public:
    explicit Body(const Mesh &mesh, const Placement &placement = {});
    ~Body();
    Body(const Body &) = delete;
    Body &operator=(const Body &) = delete;

    const scree_shape_view *view() const { return &shape.view; }
    const scree_pose *pose() const { return &pose_; }

  private:
    scree_shape shape{};
    scree_pose pose_{};
};

struct Result
{
    scree_overlap_status status = SCREE_OVERLAP_NONE;
    double volume = 0, indentation = 0, radius = 0, residual = 0;
    Vector area{}, torque{}, centroid{}, normal{}; ///< torque about the centroid, which is absolute
    bool used_fallback = false;
};

class Engine
{
  public:
    Engine();
    ~Engine();
    Engine(const Engine &) = delete;
    Engine &operator=(const Engine &) = delete;

    Result compute(const Body &a, const Body &b, scree_overlap_scheme scheme, bool use_convex_path = false);
    /// One result per connected piece of the overlap.
    std::vector<Result> patches(const Body &a, const Body &b, scree_overlap_scheme scheme);
    /// Seconds of one call, the least of several runs of many.
    double seconds(const Body &a, const Body &b, scree_overlap_scheme scheme, bool use_convex_path = false);

  private:
    std::vector<scree_overlap_result> run(const Body &a, const Body &b, const scree_overlap_options &options,
                                          int max_results);
    scree_overlap_workspace *workspace;
};

} // namespace reference

#endif
