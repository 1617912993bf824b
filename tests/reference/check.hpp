/// \file check.hpp
/// One pose through scree, both schemes and both orders of the bodies, compared with the exact overlap; bounds, failing
/// poses as lines of JSON at 17 digits, statistics, replay.
#ifndef SCREE_REFERENCE_CHECK_HPP
#define SCREE_REFERENCE_CHECK_HPP

#include <map>
#include <string>

#include "engine.hpp"
#include "poses.hpp"

namespace reference
{

/// |dV| is measured in units of epsilon L l^2, L and l the larger and the smaller extent of the two bodies.
constexpr double volume_bound = 10;
constexpr double gross_error = 1000;

/// What is demanded of one pose beyond the volume.
struct Demands
{
    bool area = false;         ///< area vector within area_bound of |S|, and a status that fits
    bool lattice_area = false; ///< area vector between the two views, but for rounding
    bool indentation = false;
    double area_bound = 1e-9;   ///< [1] of |S|
    double centroid_bound = 0;  ///< [1] of the smaller size; 0: only what the volume bound implies
    double volume_relative = 0; ///< [1] 0: only the volume bound
    double displacement = 0;    ///< how far scree's vertices may lie from the reference's, e.g. by rounded poses
};

/// Worst and typical errors over many poses.
struct Statistics
{
    int num_poses = 0, num_failed = 0, num_gross = 0, num_fallbacks = 0, num_touching = 0;
    int num_results = 0;          ///< of all schemes and orders
    double worst_units = 0;       ///< |dV|
    double worst_negative = 0;    ///< -V, in the same units
    double worst_area = 0;        ///< |dS| / |S|; of poses that demand it
    double worst_centroid = 0;    ///< |dc| / size; of poses that demand it
    double worst_indentation = 0; ///< |dd| / size; of poses that demand it
    double worst_residual = 0;    ///< of poses that demand the area
    std::vector<double> relative; ///< |dV| / V of every call; of poses that demand the area

    void add(const Statistics &other);
};

double quantile(std::vector<double> values, double q);

/// Compares and counts; prints what fails. True if nothing did.
bool check_pose(const Pose &pose, const Demands &demands, Engine &engine, Statistics &statistics);
/// The same for bodies in their own frames: the reference works on the rounded world coordinates.
bool check_placed_pose(const Pose &local, const Placement &at_a, const Placement &at_b, Demands demands, Engine &engine,
                       Statistics &statistics);

/// Far from the origin in float, a body may be smaller than the spacing of its coordinates: it is no body any more.
bool is_representable(const Pose &pose);

void print_header();
void print_statistics(const std::string &name, const Statistics &statistics);

/// One line, {"id", "a": {"vertices", "triangles"}, "b": ...}: what `scree overlap --batch` reads, too.
std::string to_json(const Pose &pose);
std::vector<Pose> read_poses(const std::string &path);

/// --replay FILE, --poses N, --seed S, --kind K.
struct Arguments
{
    std::string replay;
    int num_poses = -1, kind = -1;
    uint64_t seed = 1;
};
Arguments read_arguments(int argc, char **argv);
/// Prints reference and scree's results of every pose of a file. Exit code: whether one of them fails.
int replay(const std::string &path);

} // namespace reference

#endif
