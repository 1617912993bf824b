// Every kernel of the step on the device, emulated or real, on the data of a running scene: the same bits as on the
// CPU, for every size of block and every schedule.
#define _XOPEN_SOURCE 700
extern "C"
{
#include "bvh/bvh_launch.h"
#include "contact/history.h"
#include "contact/overlap_pairs_kernel.h"
#include "contact/sphere_pairs.h"
#include "core/sort.h"
#include "dynamics/dynamics.h"
#include "dynamics/step_buffers.h"
#include "forces/forces.h"
#include "scene_run.h"
}
#undef SCREE_DEFINE_LAUNCH
#include "core/launch_cuda.cuh"

#include "two_sides.cuh"

#include <cub/device/device_radix_sort.cuh>
#include <malloc.h>

SCREE_DECLARE_LAUNCH_CUDA(scree_lbvh_bounds)
SCREE_DECLARE_LAUNCH_CUDA(scree_lbvh_codes)
SCREE_DECLARE_LAUNCH_CUDA(scree_lbvh_hierarchy)
SCREE_DECLARE_LAUNCH_CUDA(scree_lbvh_left_turns)
SCREE_DECLARE_LAUNCH_CUDA(scree_lbvh_nodes)
SCREE_DECLARE_LAUNCH_CUDA(scree_particle_pairs)
SCREE_DECLARE_LAUNCH_CUDA(scree_wall_pairs)
SCREE_DECLARE_LAUNCH_CUDA(scree_pair_unpack)
SCREE_DECLARE_LAUNCH_CUDA(scree_pair_second_begin)
SCREE_DECLARE_LAUNCH_CUDA(scree_pair_row_begin)
SCREE_DECLARE_LAUNCH_CUDA(scree_pair_rows)
SCREE_DECLARE_LAUNCH_CUDA(scree_overlap_pairs)
SCREE_DECLARE_LAUNCH_CUDA(scree_place_spheres)
SCREE_DECLARE_LAUNCH_CUDA(scree_sphere_sphere_count)
SCREE_DECLARE_LAUNCH_CUDA(scree_sphere_sphere_write)
SCREE_DECLARE_LAUNCH_CUDA(scree_sphere_mesh_count)
SCREE_DECLARE_LAUNCH_CUDA(scree_sphere_mesh_write)
SCREE_DECLARE_LAUNCH_CUDA(scree_clump_clump_count)
SCREE_DECLARE_LAUNCH_CUDA(scree_clump_clump_write)
SCREE_DECLARE_LAUNCH_CUDA(scree_history_match)
SCREE_DECLARE_LAUNCH_CUDA(scree_contact_force)
SCREE_DECLARE_LAUNCH_CUDA(scree_gather)
SCREE_DECLARE_LAUNCH_CUDA(scree_work)
SCREE_DECLARE_LAUNCH_CUDA(scree_collision)
SCREE_DECLARE_LAUNCH_CUDA(scree_wall_load)
SCREE_DECLARE_LAUNCH_CUDA(scree_predict)
SCREE_DECLARE_LAUNCH_CUDA(scree_correct)
SCREE_DECLARE_LAUNCH_CUDA(scree_boxes)

static const char scene_text[] =
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

static scene_run run;
static scree_simulation *s;
static scree_step_buffers *b;
static int64_t num_particles, num_bodies;

// ---- what kernels read, on either side

static scree_particles particles_on(side &where)
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

static scree_lbvh_view tree_on(side &where, scree_lbvh_view tree)
{
    if (tree.num_leaves > 0) tree.nodes = where.copy(tree.nodes, 2 * (int64_t)tree.num_leaves - 1);
    return tree;
}

static const scree_shape_view *shapes_on(side &where)
{
    std::vector<scree_shape_view> views(s->shape_views, s->shape_views + 2 * s->num_shapes);
    for (scree_shape_view &view : views)
    {
        if (view.kind == SCREE_KIND_CLUMP) view.spheres = where.copy(view.spheres, view.num_spheres);
        if (view.kind != SCREE_KIND_MESH) continue;
        view.vertices = where.copy(view.vertices, view.num_vertices);
        view.triangles = where.copy(view.triangles, view.num_triangles);
        view.neighbours = where.copy(view.neighbours, 3 * (int64_t)view.num_triangles);
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

static scree_body_motion motion_on(side &where)
{
    scree_body_motion motion;
    motion.pose = where.copy(b->pose, num_bodies);
    motion.velocity = where.copy(b->velocity, num_bodies);
    motion.angular_velocity = where.copy(b->angular_velocity, num_bodies);
    motion.inverse_mass = where.copy(b->inverse_mass, num_bodies);
    motion.inverse_radius = where.copy(b->inverse_radius, num_bodies);
    motion.material = where.copy(b->material, num_bodies);
    return motion;
}

static scree_contact_list contacts_on(side &where, const scree_contact_list &list, int64_t num_pairs)
{
    scree_contact_list c = list;
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

// ---- motion

static void test_predict()
{
    check_two_sides(
        [](side &where)
        {
            scree_predict_args args;
            args.particles = particles_on(where);
            args.time_step = (scree_real)s->time_step;
            args.pose = where.make<scree_pose>(num_particles);
            args.velocity = where.make<scree_vec3>(num_particles);
            args.angular_velocity = where.make<scree_vec3>(num_particles);
            LAUNCH_ON(where, scree_predict, args, num_particles);
            where.keep(args.particles.position, num_particles);
            where.keep(args.particles.orientation, num_particles);
            where.keep(args.particles.velocity, num_particles);
            where.keep(args.particles.angular_momentum, num_particles);
            where.keep(args.pose, num_particles);
            where.keep(args.velocity, num_particles);
            where.keep(args.angular_velocity, num_particles);
        });
}

static void test_correct()
{
    check_two_sides(
        [](side &where)
        {
            scree_correct_args args;
            args.particles = particles_on(where);
            args.time_step = (scree_real)s->time_step;
            args.velocity = where.make<scree_vec3>(num_particles);
            args.angular_velocity = where.make<scree_vec3>(num_particles);
            LAUNCH_ON(where, scree_correct, args, num_particles);
            where.keep(args.particles.velocity, num_particles);
            where.keep(args.particles.angular_momentum, num_particles);
            where.keep(args.velocity, num_particles);
            where.keep(args.angular_velocity, num_particles);
        });
}

static void test_boxes()
{
    check_two_sides(
        [](side &where)
        {
            scree_boxes_args args;
            args.shapes = shapes_on(where);
            args.shape = where.copy(b->shape, num_bodies);
            args.pose = where.copy(b->pose, num_bodies);
            args.skin = b->skin;
            args.boxes = where.make<scree_box>(num_particles);
            args.centres = where.make<scree_vec3>(num_particles);
            args.radii = where.make<scree_real>(num_particles);
            LAUNCH_ON(where, scree_boxes, args, num_particles);
            where.keep(args.boxes, num_particles);
            where.keep(args.centres, num_particles);
            where.keep(args.radii, num_particles);
        });
}

// ---- neighbours

/// Sorts where the keys are; the answer may stand in other arrays.
static void sort_on(side &where, uint64_t *&keys, int32_t *&values, int64_t num, int first_bit)
{
    if (!where.is_device)
    {
        scree_sort_buffers buffers = {};
        SCREE_CHECK_INT(scree_sort_reserve(&buffers, num, true), SCREE_OK);
        memcpy(buffers.keys, keys, (size_t)num * sizeof *keys);
        memcpy(buffers.values, values, (size_t)num * sizeof *values);
        scree_sort(&buffers, num, first_bit);
        memcpy(keys, buffers.keys, (size_t)num * sizeof *keys);
        memcpy(values, buffers.values, (size_t)num * sizeof *values);
        scree_sort_destroy(&buffers);
        return;
    }
    cub::DoubleBuffer<uint64_t> both_keys(keys, where.make<uint64_t>(num));
    cub::DoubleBuffer<int32_t> both_values(values, where.make<int32_t>(num));
    size_t num_bytes = 0;
    MUST_CUDA(cub::DeviceRadixSort::SortPairs(nullptr, num_bytes, both_keys, both_values, num, first_bit, 64));
    char *scratch = where.make<char>((int64_t)num_bytes);
    MUST_CUDA(cub::DeviceRadixSort::SortPairs(scratch, num_bytes, both_keys, both_values, num, first_bit, 64));
    keys = both_keys.Current();
    values = both_values.Current();
}

/// The steps of scree_lbvh_build() and a refit, one kernel after the other.
static scree_lbvh_view build_tree_on(side &where, const scree_box *boxes, int64_t num)
{
    scree_lbvh_build_args args = {};
    args.boxes = where.copy(boxes, num);
    args.codes = where.make<uint64_t>(num);
    args.items = where.make<int32_t>(num);
    args.first_leaf = where.make<int32_t>(num);
    args.last_leaf = where.make<int32_t>(num);
    args.num_left_turns = where.make<uint8_t>(num);
    args.arrivals = where.zeros<int32_t>(num);
    args.nodes = where.make<scree_lbvh_node>(2 * num);
    args.chunk_bounds = where.make<scree_box>(SCREE_LBVH_BOUNDS_CHUNKS);
    args.num_leaves = num;
    args.block_leaves = 8; // few, so that most ancestors are met by two threads
    LAUNCH_ON(where, scree_lbvh_bounds, args, SCREE_LBVH_BOUNDS_CHUNKS);
    scree_box bounds = scree_box_empty();
    for (const scree_box &chunk : where.read(args.chunk_bounds, SCREE_LBVH_BOUNDS_CHUNKS))
        bounds = scree_box_union(bounds, chunk);
    args.frame = scree_morton_frame_make(bounds);
    LAUNCH_ON(where, scree_lbvh_codes, args, num);
    sort_on(where, args.codes, args.items, num, 0);
    LAUNCH_ON(where, scree_lbvh_hierarchy, args, num - 1);
    const int64_t num_blocks = (num + args.block_leaves - 1) / args.block_leaves;
    LAUNCH_ON(where, scree_lbvh_left_turns, args, num_blocks);
    LAUNCH_ON(where, scree_lbvh_nodes, args, num_blocks);
    where.keep(args.nodes, 2 * num - 1);
    LAUNCH_ON(where, scree_lbvh_nodes, args, num_blocks);
    where.keep(args.nodes, 2 * num - 1);
    where.keep(args.arrivals, num);
    scree_lbvh_view view = {args.nodes, (int32_t)num, 0};
    return view;
}

static void test_tree()
{
    check_two_sides([](side &where) { build_tree_on(where, b->boxes, num_particles); });

    // and the tree is that of the library
    side device(true, 128);
    build_tree_on(device, b->boxes, num_particles);
    scree_lbvh tree = {};
    SCREE_CHECK_INT(scree_lbvh_build(&tree, b->boxes, num_particles), SCREE_OK);
    SCREE_CHECK(
        memcmp(device.outcome.data(), tree.view.nodes, (size_t)(2 * num_particles - 1) * sizeof *tree.view.nodes) == 0);
    scree_lbvh_destroy(&tree);
}

/// Keys of all pairs, in no order; as the broad phase, asks again if the list was too short.
static uint64_t *find_keys_on(side &where, int32_t id_bits, int64_t *num_keys)
{
    scree_particle_pairs_args particle_args = {};
    particle_args.tree = build_tree_on(where, b->boxes, num_particles);
    scree_wall_pairs_args wall_args = {};
    std::vector<scree_broad_phase_wall> walls(b->broad_phase_walls, b->broad_phase_walls + s->num_walls);
    for (scree_broad_phase_wall &wall : walls) wall.tree = tree_on(where, wall.tree);
    wall_args.centres = where.copy(b->centres, num_particles);
    wall_args.radii = where.copy(b->radii, num_particles);
    particle_args.centres = wall_args.centres;
    particle_args.radii = wall_args.radii;
    wall_args.walls = where.copy(walls.data(), s->num_walls);
    wall_args.num_particles = num_particles;
    wall_args.num_walls = s->num_walls;
    wall_args.block_particles = 7;

    scree_pair_list list = {};
    list.id_bits = id_bits;
    for (int64_t max_keys = 10;; max_keys = *num_keys)
    {
        list.max_keys = max_keys;
        list.keys = where.make<uint64_t>(max_keys);
        list.num_keys = where.zeros<int64_t>(1);
        particle_args.list = wall_args.list = list;
        LAUNCH_ON(where, scree_particle_pairs, particle_args, 2 * num_particles - 1);
        LAUNCH_ON(where, scree_wall_pairs, wall_args, (num_particles + 6) / 7);
        *num_keys = where.read(list.num_keys, 1)[0];
        if (*num_keys <= max_keys) return list.keys;
    }
}

static void find_pairs_on(side &where)
{
    int64_t num_pairs;
    const int32_t id_bits = 12;
    scree_pair_rows_args args = {};
    uint64_t *keys = find_keys_on(where, id_bits, &num_pairs);
    int32_t *values = where.make<int32_t>(num_pairs);
    where.outcome.clear();
    sort_on(where, keys, values, num_pairs, 0);
    args.keys = keys;
    args.second_keys = where.make<uint64_t>(num_pairs);
    args.pairs = where.make<scree_candidate_pair>(num_pairs);
    args.first_as_i = where.make<int32_t>(num_bodies + 1);
    args.first_as_j = where.make<int32_t>(num_bodies + 1);
    args.row_begin = where.make<int64_t>(num_bodies + 1);
    args.row_pairs = where.make<int32_t>(2 * num_pairs);
    args.num_pairs = num_pairs;
    args.num_bodies = num_bodies;
    args.id_bits = id_bits;
    LAUNCH_ON(where, scree_pair_unpack, args, num_pairs);
    sort_on(where, args.second_keys, values, num_pairs, 32);
    LAUNCH_ON(where, scree_pair_second_begin, args, num_pairs);
    LAUNCH_ON(where, scree_pair_row_begin, args, num_bodies + 1);
    LAUNCH_ON(where, scree_pair_rows, args, num_pairs);
    where.keep(args.pairs, num_pairs);
    where.keep(args.row_begin, num_bodies + 1);
    where.keep(args.row_pairs, 2 * num_pairs);
}

static void test_pairs()
{
    check_two_sides(find_pairs_on);

    // and they are those of the library, from the same boxes
    side device(true, 128), library(false);
    find_pairs_on(device);
    const scree_broad_phase *broad_phase = &s->broad_phase;
    library.keep(broad_phase->pairs, broad_phase->num_pairs);
    library.keep(broad_phase->row_begin, num_bodies + 1);
    library.keep(broad_phase->row_pairs, 2 * broad_phase->num_pairs);
    SCREE_CHECK(broad_phase->num_pairs > 200);
    SCREE_CHECK(device.outcome == library.outcome);
}

// ---- contacts

/// 0: two meshes, 1: a mesh with a sphere or clump, 2: two spheres, 3: two clumps or a clump and a sphere.
static int kind_of(int64_t p)
{
    const scree_candidate_pair pair = s->broad_phase.pairs[p];
    const scree_shape_kind i = s->shape_views[b->shape[pair.i]].kind, j = s->shape_views[b->shape[pair.j]].kind;
    const int num_meshes = (i == SCREE_KIND_MESH) + (j == SCREE_KIND_MESH);
    if (num_meshes > 0) return 2 - num_meshes;
    return i == SCREE_KIND_SPHERE && j == SCREE_KIND_SPHERE ? 2 : 3;
}

/// A workspace of the host whose arrays, whatever they are, lie where they are needed; zeroed, as new ones are.
static scree_overlap_slice slice_on(side &where, const scree_overlap_slice &slice)
{
    scree_overlap_slice copy = slice;
    for (size_t at = 0; at + sizeof(void *) <= sizeof copy; at += sizeof(void *))
    {
        char *array;
        memcpy(&array, (const char *)&copy + at, sizeof array);
        if ((uintptr_t)array < (uintptr_t)0x55 << 40 || (uintptr_t)array >= (uintptr_t)0x80 << 40) continue;
        char *moved = where.zeros<char>((int64_t)malloc_usable_size(array));
        memcpy((char *)&copy + at, &moved, sizeof moved);
    }
    return copy;
}

static void find_overlaps_on(side &where)
{
    // those that touch, and a few that may not
    std::vector<scree_candidate_pair> pairs;
    int64_t num_apart = 0;
    for (int64_t p = 0; p < s->broad_phase.num_pairs; ++p)
    {
        const bool is_touching = s->contacts.first_of_pair[p] < s->contacts.first_of_pair[p + 1];
        if (kind_of(p) == 0 && (is_touching || ++num_apart <= 20)) pairs.push_back(s->broad_phase.pairs[p]);
    }
    const int64_t num_pairs = (int64_t)pairs.size();
    SCREE_CHECK(num_pairs > 60);
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    std::vector<scree_overlap_slice> slices;
    for (int64_t p = 0; p < num_pairs; ++p)
        slices.push_back(slice_on(where, *reinterpret_cast<const scree_overlap_slice *>(workspace)));
    scree_overlap_workspace_destroy(workspace);

    scree_overlap_pairs_args args = {};
    args.bodies.shapes = shapes_on(where);
    args.bodies.shape = where.copy(b->shape, num_bodies);
    args.bodies.pose = where.copy(b->pose, num_bodies);
    args.bodies.num_bodies = num_bodies;
    args.pairs = where.copy(pairs.data(), num_pairs);
    args.slices = where.copy(slices.data(), num_pairs);
    args.results = where.make<scree_overlap_result>(num_pairs);
    args.options = s->narrow_phase.options;
    args.num_lanes = 8;
    if (where.is_device) scree_overlap_pairs_launch_cuda(where.device, args, num_pairs);
    else
        for (int64_t p = 0; p < num_pairs; ++p) scree_overlap_pairs_at(args, p);

    // field by field, for there are gaps between them
    for (const scree_overlap_result &r : where.read(args.results, num_pairs))
    {
        const int32_t marks[2] = {(int32_t)r.status, r.used_fallback};
        const unsigned char *bytes = reinterpret_cast<const unsigned char *>(&r);
        where.outcome.insert(where.outcome.end(), bytes, bytes + offsetof(scree_overlap_result, status));
        bytes = reinterpret_cast<const unsigned char *>(marks);
        where.outcome.insert(where.outcome.end(), bytes, bytes + sizeof marks);
    }
}

static void test_overlaps() { check_two_sides(find_overlaps_on); }

/// Both passes over the pairs of two spheres, of a sphere or clump and a mesh, or of two clumps.
static void find_spheres_on(side &where, int kind)
{
    const int64_t num_pairs = s->broad_phase.num_pairs;
    std::vector<int32_t> batch;
    for (int64_t p = 0; p < num_pairs; ++p)
        if (kind_of(p) == kind) batch.push_back((int32_t)p);
    const int64_t num = (int64_t)batch.size();
    scree_sphere_pairs_args args = {};
    args.shapes = shapes_on(where);
    args.shape = where.copy(b->shape, num_bodies);
    args.pose = where.copy(b->pose, num_bodies);
    scree_sphere *spheres = where.make<scree_sphere>(num_bodies);
    const scree_place_spheres_args place = {args.shapes, args.shape, args.pose, spheres};
    LAUNCH_ON(where, scree_place_spheres, place, num_bodies);
    where.keep(spheres, num_bodies);
    args.spheres = spheres;
    args.pairs = where.copy(s->broad_phase.pairs, num_pairs);
    args.batch = where.copy(batch.data(), num);
    args.num_contacts = where.zeros<int32_t>(num_pairs);
    args.max_found = 8;
    args.found = where.make<scree_sphere_contact>(num * args.max_found);
    args.is_inside = where.make<uint8_t>(num);
    if (kind == 2) LAUNCH_ON(where, scree_sphere_sphere_count, args, num);
    else if (kind == 3) LAUNCH_ON(where, scree_clump_clump_count, args, num);
    else LAUNCH_ON(where, scree_sphere_mesh_count, args, num);
    where.keep(args.num_contacts, num_pairs);
    if (kind == 1) where.keep(args.is_inside, num);

    std::vector<int64_t> first(1, 0);
    for (const int32_t num_contacts : where.read(args.num_contacts, num_pairs))
        first.push_back(first.back() + num_contacts);
    const int64_t n = first.back();
    SCREE_CHECK(n > 10);
    args.list.first_of_pair = where.copy(first.data(), num_pairs + 1);
    args.list.bodies = where.make<scree_candidate_pair>(n);
    args.list.patch = where.make<int32_t>(n);
    args.list.volume = where.make<scree_real>(n);
    args.list.indentation = where.make<scree_real>(n);
    args.list.radius = where.make<scree_real>(n);
    args.list.normal = where.make<scree_vec3>(n);
    args.list.area_vector = where.make<scree_vec3>(n);
    args.list.torque_vector = where.make<scree_vec3>(n);
    args.list.arm = where.make<scree_vec3>(n);
    if (kind == 2) LAUNCH_ON(where, scree_sphere_sphere_write, args, num);
    else if (kind == 3) LAUNCH_ON(where, scree_clump_clump_write, args, num);
    else LAUNCH_ON(where, scree_sphere_mesh_write, args, num);
    where.keep(args.list.bodies, n);
    where.keep(args.list.patch, n);
    where.keep(args.list.volume, n);
    where.keep(args.list.indentation, n);
    where.keep(args.list.radius, n);
    where.keep(args.list.normal, n);
    where.keep(args.list.area_vector, n);
    where.keep(args.list.torque_vector, n);
    where.keep(args.list.arm, n);
}

static void test_spheres()
{
    check_two_sides([](side &where) { find_spheres_on(where, 1); });
    check_two_sides([](side &where) { find_spheres_on(where, 2); });
    check_two_sides([](side &where) { find_spheres_on(where, 3); });
}

static void match_history_on(side &where, bool has_same_pairs)
{
    const int64_t num_pairs = s->broad_phase.num_pairs, num_contacts = s->contacts.num_contacts;
    const scree_contact_list contacts = contacts_on(where, s->contacts, num_pairs);
    const scree_contact_list old = contacts_on(where, s->old_contacts, has_same_pairs ? num_pairs : 0);
    scree_history_match_args args;
    args.pairs = where.copy(s->broad_phase.pairs, num_pairs);
    args.first_of_pair = contacts.first_of_pair;
    args.old_first_of_pair = has_same_pairs ? old.first_of_pair : nullptr;
    args.old_bodies = old.bodies;
    args.patch = contacts.patch;
    args.old_patch = old.patch;
    args.arm = contacts.arm;
    args.old_arm = old.arm;
    args.num_old = old.num_contacts;
    args.old_of_contact = where.make<int64_t>(num_contacts);
    args.is_continued = where.zeros<uint8_t>(old.num_contacts);
    LAUNCH_ON(where, scree_history_match, args, num_pairs);
    where.keep(args.old_of_contact, num_contacts);
    where.keep(args.is_continued, old.num_contacts);
}

static void test_history()
{
    SCREE_CHECK(b->is_old_list_of_same_pairs);
    check_two_sides([](side &where) { match_history_on(where, true); });
    check_two_sides([](side &where) { match_history_on(where, false); });
}

// ---- forces

static void test_forces()
{
    check_two_sides(
        [](side &where)
        {
            const int64_t num_pairs = s->broad_phase.num_pairs, n = s->contacts.num_contacts;
            scree_contact_force_args force;
            force.contacts = contacts_on(where, s->contacts, num_pairs);
            force.old_contacts = contacts_on(where, s->old_contacts, num_pairs);
            force.old_of_contact = where.copy(b->old_of_contact, n);
            force.bodies = motion_on(where);
            force.laws = where.copy(s->laws, s->num_materials * s->num_materials);
            force.num_materials = s->num_materials;
            force.time_step = (scree_real)s->time_step;
            LAUNCH_ON(where, scree_contact_force, force, n);
            where.keep(force.contacts.normal_force, n);
            where.keep(force.contacts.tangential_force, n);
            where.keep(force.contacts.moment, n);
            where.keep(force.contacts.spring_force, n);
            where.keep(force.contacts.torsion, n);
            where.keep(force.contacts.elastic_work, n);
            where.keep(force.contacts.spring_work, n);

            scree_gather_args gather;
            gather.contacts = force.contacts;
            gather.row_begin = where.copy(s->broad_phase.row_begin, num_bodies + 1);
            gather.row_pairs = where.copy(s->broad_phase.row_pairs, 2 * num_pairs);
            gather.pose = force.bodies.pose;
            gather.mass = where.copy(s->particles.mass, num_particles);
            gather.gravity = scree_vec3_make(0, 0, (scree_real)-9.81);
            gather.force = where.make<scree_vec3>(num_particles);
            gather.torque = where.make<scree_vec3>(num_particles);
            LAUNCH_ON(where, scree_gather, gather, num_particles);
            where.keep(gather.force, num_particles);
            where.keep(gather.torque, num_particles);
        });
}

static void test_work()
{
    check_two_sides(
        [](side &where)
        {
            const int64_t n = s->contacts.num_contacts, num_blocks = (n + SCREE_WORK_BLOCK - 1) / SCREE_WORK_BLOCK;
            scree_work_args work;
            work.contacts = contacts_on(where, s->contacts, s->broad_phase.num_pairs);
            work.bodies = motion_on(where);
            work.inertia = where.copy(s->particles.inertia, num_particles);
            work.laws = where.copy(s->laws, s->num_materials * s->num_materials);
            work.num_materials = s->num_materials;
            work.num_particles = (int32_t)num_particles;
            work.time_step = (scree_real)s->time_step;
            work.sums = where.make<scree_work_sums>(num_blocks);
            LAUNCH_ON(where, scree_work, work, num_blocks);
            where.keep(work.sums, num_blocks);
        });
}

static void test_collisions()
{
    check_two_sides(
        [](side &where)
        {
            const int64_t n = s->contacts.num_contacts, num_old = s->old_contacts.num_contacts;
            std::vector<double> normal, tangential;
            for (int64_t o = 0; o < num_old; ++o)
            {
                normal.push_back(1e-3 / (double)(o + 1));
                tangential.push_back(1e-4 / (double)(o + 3));
            }
            scree_collision_args args = {};
            args.contacts = contacts_on(where, s->contacts, s->broad_phase.num_pairs);
            args.bodies = motion_on(where);
            args.old_of_contact = where.copy(b->old_of_contact, n);
            args.old_normal = where.copy(normal.data(), num_old);
            args.old_tangential = where.copy(tangential.data(), num_old);
            args.time_step = s->time_step;
            args.normal = where.make<double>(n);
            args.tangential = where.make<double>(n);
            LAUNCH_ON(where, scree_collision, args, n);
            where.keep(args.normal, n);
            where.keep(args.tangential, n);
        });
}

static void test_wall_loads()
{
    SCREE_CHECK(b->num_moving_walls > 0);
    check_two_sides(
        [](side &where)
        {
            const int64_t num_blocks = (s->contacts.num_contacts + SCREE_WALL_LOAD_BLOCK - 1) / SCREE_WALL_LOAD_BLOCK;
            scree_wall_load_args args = {};
            args.contacts = contacts_on(where, s->contacts, s->broad_phase.num_pairs);
            args.pose = where.copy(b->pose, num_bodies);
            args.moving = where.copy(b->moving_wall, s->num_walls);
            args.axes = where.copy(b->wall_axes, b->num_moving_walls);
            args.num_moving = b->num_moving_walls;
            args.num_particles = (int32_t)num_particles;
            args.sums = where.make<scree_real>(num_blocks * args.num_moving);
            LAUNCH_ON(where, scree_wall_load, args, num_blocks);
            where.keep(args.sums, num_blocks * args.num_moving);
        });
}

int main()
{
    if (is_without_device()) return SKIPPED;
    scene_run_start(&run, scene_text);
    scene_run_until(&run, 0.05);
    if (run.simulation == nullptr) return EXIT_FAILURE;
    s = run.simulation;
    b = s->buffers;
    num_particles = s->particles.num_particles;
    num_bodies = num_particles + s->num_walls;
    printf("%lld pairs, %lld contacts\n", (long long)s->broad_phase.num_pairs, (long long)s->contacts.num_contacts);
    SCREE_CHECK(s->contacts.num_contacts > 40);

    SCREE_RUN(test_predict);
    SCREE_RUN(test_correct);
    SCREE_RUN(test_boxes);
    SCREE_RUN(test_tree);
    SCREE_RUN(test_pairs);
    SCREE_RUN(test_overlaps);
    SCREE_RUN(test_spheres);
    SCREE_RUN(test_history);
    SCREE_RUN(test_forces);
    SCREE_RUN(test_work);
    SCREE_RUN(test_wall_loads);
    SCREE_RUN(test_collisions);
    scene_run_end(&run);
    return SCREE_TEST_END();
}
