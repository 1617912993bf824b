#include "engine.hpp"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include <omp.h>

namespace reference
{
namespace
{

scree_vec3 to_real(const Vector &v) { return scree_vec3_make(scree_real(v[0]), scree_real(v[1]), scree_real(v[2])); }
Vector to_double(scree_vec3 v) { return {double(v.x), double(v.y), double(v.z)}; }

scree_pose to_pose(const Placement &p)
{
    scree_pose pose;
    pose.position = to_real(p.position);
    pose.orientation = scree_quat_make(scree_real(p.orientation[0]), scree_real(p.orientation[1]),
                                       scree_real(p.orientation[2]), scree_real(p.orientation[3]));
    pose.scale = scree_real(p.scale);
    return pose;
}

Result to_result(const scree_overlap_result &r, const scree_pose &pose_a)
{
    Result result;
    result.status = r.status;
    result.volume = double(r.volume);
    result.indentation = double(r.indentation);
    result.radius = double(r.radius);
    result.residual = double(r.residual);
    result.area = to_double(r.area_vector);
    result.torque = to_double(r.torque_vector);
    result.normal = to_double(r.normal);
    result.centroid = to_double(r.arm) + to_double(pose_a.position);
    result.used_fallback = r.used_fallback;
    return result;
}

} // namespace

Placement random_placement(Random &random)
{
    Placement p;
    double sum = 0;
    for (double &q : p.orientation)
    {
        q = random.normal();
        sum += q * q;
    }
    for (double &q : p.orientation) q /= std::sqrt(sum);
    return to_precision(p);
}

Placement to_precision(const Placement &placement)
{
    const scree_pose pose = to_pose(placement);
    Placement result;
    result.position = to_double(pose.position);
    result.orientation = {double(pose.orientation.w), double(pose.orientation.x), double(pose.orientation.y),
                          double(pose.orientation.z)};
    result.scale = double(pose.scale);
    return result;
}

Mesh to_precision(Mesh mesh)
{
    for (Vector &v : mesh.vertices) v = to_double(to_real(v));
    return mesh;
}

Mesh placed(const Mesh &mesh, const Placement &placement)
{
    const scree_pose pose = to_pose(placement);
    const scree_mat3 m = scree_mat3_from_quat(pose.orientation);
    Mesh result = mesh;
    for (Vector &v : result.vertices)
    {
        const scree_vec3 x = scree_vec3_scale(to_real(v), pose.scale);
        v = to_double(scree_vec3_add(scree_mat3_apply(m, x), pose.position));
    }
    return result;
}

Body::Body(const Mesh &mesh, const Placement &placement)
{
    scree_mesh source{};
    const auto num_vertices = static_cast<int32_t>(mesh.vertices.size());
    const auto num_triangles = static_cast<int32_t>(mesh.triangles.size());
    if (scree_mesh_create(&source, num_vertices, num_triangles) != SCREE_OK) throw std::bad_alloc();
    for (size_t i = 0; i < mesh.vertices.size(); ++i) source.vertices[i] = to_real(mesh.vertices[i]);
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
    {
        for (size_t k = 0; k < 3; ++k) source.triangles[i].v[k] = mesh.triangles[i][k];
    }
    const scree_status status = scree_shape_create(&shape, &source, SCREE_FRAME_SOURCE);
    scree_mesh_destroy(&source);
    if (status != SCREE_OK) throw std::runtime_error(scree_status_text(status));
    pose_ = to_pose(placement);
}

Body::~Body() { scree_shape_destroy(&shape); }

Engine::Engine() : workspace(scree_overlap_workspace_create())
{
    if (workspace == nullptr) throw std::bad_alloc();
    omp_set_num_threads(1); // trees of a few triangles: more threads only wait for each other
}

Engine::~Engine() { scree_overlap_workspace_destroy(workspace); }

std::vector<scree_overlap_result> Engine::run(const Body &a, const Body &b, const scree_overlap_options &options,
                                              int max_results)
{
    std::vector<scree_overlap_result> results(static_cast<size_t>(max_results));
    for (;;)
    {
        const int32_t num = scree_overlap_compute(a.view(), a.pose(), b.view(), b.pose(), &options, workspace,
                                                  results.data(), max_results);
        const bool is_full = num > 0 && results[0].status == SCREE_OVERLAP_WORKSPACE_FULL;
        if (!is_full)
        {
            results.resize(static_cast<size_t>(num));
            return results;
        }
        if (scree_overlap_workspace_grow(workspace) != SCREE_OK) throw std::bad_alloc();
    }
}

Result Engine::compute(const Body &a, const Body &b, scree_overlap_scheme scheme, bool use_convex_path)
{
    scree_overlap_options options{};
    options.scheme = scheme;
    options.use_convex_path = use_convex_path;
    const auto results = run(a, b, options, 1);
    if (results.size() != 1) throw std::runtime_error("one result was expected");
    return to_result(results[0], *a.pose());
}

std::vector<Result> Engine::patches(const Body &a, const Body &b, scree_overlap_scheme scheme)
{
    scree_overlap_options options{};
    options.scheme = scheme;
    options.separate_patches = true;
    size_t most = 4;
    auto results = run(a, b, options, int(most));
    while (results.size() > most)
    {
        most = results.size();
        results = run(a, b, options, int(most));
    }
    std::vector<Result> list;
    for (const scree_overlap_result &r : results) list.push_back(to_result(r, *a.pose()));
    return list;
}

double Engine::seconds(const Body &a, const Body &b, scree_overlap_scheme scheme, bool use_convex_path)
{
    scree_overlap_options options{};
    options.scheme = scheme;
    options.use_convex_path = use_convex_path;
    run(a, b, options, 1); // the workspace is large enough from here on
    using clock = std::chrono::steady_clock;
    double best = HUGE_VAL;
    int repeats = 1;
    for (int round = 0; round < 5;)
    {
        scree_overlap_result result;
        const auto start = clock::now();
        for (int i = 0; i < repeats; ++i)
            scree_overlap_compute(a.view(), a.pose(), b.view(), b.pose(), &options, workspace, &result, 1);
        const double elapsed = std::chrono::duration<double>(clock::now() - start).count();
        if (elapsed < 20e-6)
        {
            repeats *= 4;
            continue;
        }
        best = std::min(best, elapsed / repeats);
        ++round;
    }
    return best;
}

} // namespace reference
