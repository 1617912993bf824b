/// \file scene_kernels.cuh
/// For the tests of single kernels: a running scene, and what kernels read of it on either side. Define
/// _XOPEN_SOURCE 700 before.
#ifndef CUDA_ON_CPU_SCENE_KERNELS_CUH
#define CUDA_ON_CPU_SCENE_KERNELS_CUH

extern "C"
{
#include "bvh/bvh_launch.h"
#include "contact/history.h"
#include "contact/narrow_phase_launch.h"
#include "contact/sphere_pairs.h"
#include "core/permute.h"
#include "core/sort.h"
#include "dynamics/dynamics.h"
#include "dynamics/step_buffers.h"
#include "forces/forces.h"
#include "scene_run.h"
}
#undef SCREE_DEFINE_LAUNCH
#include "core/launch_cuda.cuh"

#include "two_sides.cuh"

inline const char scene_text[] =
    "name: kernels\n"
    "time: {end: 1, step: 5e-5}\n"
    "materials:\n"
    "  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}\n"
    "  - {name: steel, density: 7800, youngs_modulus: 1e8, poisson_ratio: 0.3}\n"
    "contact_laws:\n"
    "  - {materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}\n"
    "  - {materials: [stone, steel], friction_coefficient: 0.3, damping_ratio: 0.2}\n"
    "shapes:\n"
    "  - {name: rock, source: rock, triangles: 40, seed: 3}\n"
    "  - {name: ball, source: sphere, size: [0.016, 0, 0]}\n"
    "  - {name: trio, source: clump, spheres: [{position: [0, 0, 0], radius: 0.007},\n"
    "     {position: [0.006, 0, 0], radius: 0.006}, {position: [0, 0.007, 0], radius: 0.005}]}\n"
    "  - {name: schoenhardt, source: schoenhardt, size: [0.02, 0, 0]}\n"
    "  - {name: floor, source: box, size: [0.3, 0.3, 0.02]}\n"
    "particles:\n"
    "  - {name: rocks, shape: rock, material: stone, count: 60, seed: 1, velocity: [0, 0, -3],\n"
    "     size: {distribution: uniform, min: 0.01, max: 0.02},\n"
    "     region: {min: [-0.05, -0.05, 0.001], max: [0.05, 0.05, 0.24]}}\n"
    "  - {name: twisted, shape: schoenhardt, material: stone, count: 30, seed: 2, velocity: [0, 0, -5],\n"
    "     region: {min: [-0.05, -0.05, 0.24], max: [0.05, 0.05, 0.4]}}\n"
    "  - {name: balls, shape: ball, material: stone, count: 40, seed: 4, velocity: [0, 0, -8],\n"
    "     region: {min: [-0.05, -0.05, 0.4], max: [0.05, 0.05, 0.55]}}\n"
    "  - {name: trios, shape: trio, material: stone, count: 30, seed: 5, velocity: [0, 0, -9],\n"
    "     region: {min: [-0.05, -0.05, 0.55], max: [0.05, 0.05, 0.68]}}\n"
    "  - {name: late, shape: trio, material: stone, count: 27, seed: 6, velocity: [0, 0, -14],\n"
    "     region: {min: [-0.05, -0.05, 0.68], max: [0.05, 0.05, 0.8]}}\n"
    "walls:\n"
    "  - {name: floor, shape: floor, material: steel, position: [0, 0, -0.01],\n"
    "     motion: {kind: translate, velocity: [0, 0, 0.2], start: 0.0, end: 0.02}}\n"
    "  - {name: side, shape: floor, material: steel, position: [0.07, 0, 0.05], orientation: [0.70710678, 0, "
    "0.70710678, 0]}\n";

inline scene_run run;
inline scree_simulation *s;
inline scree_step_buffers *b;
inline int64_t num_particles, num_bodies;

// ---- what kernels read, on either side

inline scree_particles particles_on(side &where)
{
    scree_particles p = s->particles;
    const int64_t n = num_particles;
    p.position = where.copy(p.position, n);
    p.orientation = where.copy(p.orientation, n);
    p.velocity = where.copy(p.velocity, n);
    p.angular_momentum = where.copy(p.angular_momentum, n);
    p.force = where.copy(p.force, n);
    p.torque = where.copy(p.torque, n);
    p.scale = where.copy(p.scale, n);
    p.mass = where.copy(p.mass, n);
    p.inertia = where.copy(p.inertia, n);
    p.shape = where.copy(p.shape, n);
    p.material = where.copy(p.material, n);
    p.group = where.copy(p.group, n);
    return p;
}

inline scree_lbvh_view tree_on(side &where, scree_lbvh_view tree)
{
    if (tree.num_leaves > 0) tree.nodes = where.copy(tree.nodes, 2 * (int64_t)tree.num_leaves - 1);
    return tree;
}

inline const scree_shape_view *shapes_on(side &where)
{
    std::vector<scree_shape_view> views(s->shape_views, s->shape_views + 2 * s->num_shapes);
    for (scree_shape_view &view : views)
    {
        if (view.kind == SCREE_KIND_CLUMP) view.spheres = where.copy(view.spheres, view.num_spheres);
        if (view.kind != SCREE_KIND_MESH) continue;
        view.vertices = where.copy(view.vertices, view.num_vertices);
        view.triangles = where.copy(view.triangles, view.num_triangles);
        view.neighbours = where.copy(view.neighbours, 3 * (int64_t)view.num_triangles);
        view.normals = where.copy(view.normals, view.num_triangles);
        view.tree = tree_on(where, view.tree);
        if (view.flat_faces != nullptr) view.flat_faces = where.copy(view.flat_faces, view.num_triangles);
        scree_wide_tree_view &wide = view.wide_tree;
        if (wide.nodes == nullptr) continue;
        wide.nodes = where.copy(wide.nodes, wide.first_node[wide.num_levels - 1] + 1);
        wide.items = where.copy(wide.items, wide.num_items);
        wide.corners = where.copy(wide.corners, (wide.num_items + SCREE_WIDE_CHILDREN - 1) / SCREE_WIDE_CHILDREN);
        view.support_map = where.copy(view.support_map, SCREE_SUPPORT_VALUES);
    }
    return where.copy(views.data(), (int64_t)views.size());
}

inline scree_body_motion motion_on(side &where)
{
    scree_body_motion motion;
    motion.pose = where.copy(b->pose, num_bodies);
    motion.moving = where.copy(b->moving, num_bodies);
    motion.inverse_radius = where.copy(b->inverse_radius, num_bodies);
    return motion;
}

inline scree_contact_list contacts_on(side &where, const scree_contact_list &list, int64_t num_pairs)
{
    scree_contact_list c = scree_contact_list_view(&list);
    const int64_t n = list.num_contacts;
    c.first_of_pair = where.copy(list.first_of_pair, num_pairs + 1);
    c.bodies = where.copy(list.bodies, n);
    c.patch = where.copy(list.patch, n);
    c.volume = where.copy(list.volume, n);
    c.indentation = where.copy(list.indentation, n);
    c.radius = where.copy(list.radius, n);
    c.normal = where.copy(list.normal, n);
    c.area_vector = where.copy(list.area_vector, n);
    c.torque_vector = where.copy(list.torque_vector, n);
    c.arm = where.copy(list.arm, n);
    c.normal_force = where.copy(list.normal_force, n);
    c.tangential_force = where.copy(list.tangential_force, n);
    c.elastic_force = where.copy(list.elastic_force, n);
    c.moment = where.copy(list.moment, n);
    c.elastic_work = where.copy(list.elastic_work, n);
    c.spring_work = where.copy(list.spring_work, n);
    c.is_slipping = where.copy(list.is_slipping, n);
    c.is_turning = where.copy(list.is_turning, n);
    c.spring_force = where.copy(list.spring_force, n);
    c.tangential_stiffness = where.copy(list.tangential_stiffness, n);
    c.torsion = where.copy(list.torsion, n);
    c.rolling_moment = where.copy(list.rolling_moment, n);
    c.elastic_energy = where.copy(list.elastic_energy, n);
    c.spring_energy = where.copy(list.spring_energy, n);
    return c;
}

#endif
