// The kernels of contacts and forces on the device, emulated or real, on the data of a running scene: the same bits as
// on the CPU, for every size of block and every schedule.
#define _XOPEN_SOURCE 700
#include "scene_kernels.cuh"

#include <malloc.h>

SCREE_DECLARE_LAUNCH_CUDA(scree_overlap_pairs)
SCREE_DECLARE_LAUNCH_CUDA(scree_overlap_patches)
SCREE_DECLARE_LAUNCH_CUDA(scree_place_spheres)
SCREE_DECLARE_LAUNCH_CUDA(scree_sphere_sphere_count)
SCREE_DECLARE_LAUNCH_CUDA(scree_sphere_sphere_write)
SCREE_DECLARE_LAUNCH_CUDA(scree_sphere_mesh_near)
SCREE_DECLARE_LAUNCH_CUDA(scree_sphere_mesh_count)
SCREE_DECLARE_LAUNCH_CUDA(scree_sphere_mesh_write)
SCREE_DECLARE_LAUNCH_CUDA(scree_clump_clump_count)
SCREE_DECLARE_LAUNCH_CUDA(scree_clump_clump_write)
SCREE_DECLARE_LAUNCH_CUDA(scree_history_match)
SCREE_DECLARE_LAUNCH_CUDA(scree_group_bounds)
SCREE_DECLARE_LAUNCH_CUDA(scree_contact_force)
SCREE_DECLARE_LAUNCH_CUDA(scree_gather)
SCREE_DECLARE_LAUNCH_CUDA(scree_work)
SCREE_DECLARE_LAUNCH_CUDA(scree_collision)
SCREE_DECLARE_LAUNCH_CUDA(scree_ended_flag)
SCREE_DECLARE_LAUNCH_CUDA(scree_ended_collisions)
SCREE_DECLARE_LAUNCH_CUDA(scree_wall_load)
SCREE_DECLARE_LAUNCH_CUDA(scree_pair_flag)
SCREE_DECLARE_LAUNCH_CUDA(scree_pair_scatter)
SCREE_DECLARE_LAUNCH_CUDA(scree_pair_keep)
SCREE_DECLARE_LAUNCH_CUDA(scree_pair_carry)
SCREE_DECLARE_LAUNCH_CUDA(scree_mesh_apart)
SCREE_DECLARE_LAUNCH_CUDA(scree_mesh_gap)
SCREE_DECLARE_LAUNCH_CUDA(scree_mesh_write)
SCREE_DECLARE_LAUNCH_CUDA(scree_room)
SCREE_DECLARE_LAUNCH_CUDA(scree_work_reduce)
SCREE_DECLARE_LAUNCH_CUDA(scree_wall_load_reduce)
SCREE_DECLARE_LAUNCH_CUDA(scree_indentations)

// ---- contacts

static scree_pair_kind kind_of(int64_t p)
{
    const scree_candidate_pair pair = s->broad_phase.pairs[p];
    return scree_kind_of_pair(s->shape_views[b->shape[pair.i]].kind, s->shape_views[b->shape[pair.j]].kind);
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

/// Room for the geometry of n contacts.
static scree_contact_list empty_list(side &where, const std::vector<int32_t> &first, int64_t n)
{
    scree_contact_list list = {};
    list.first_of_pair = where.copy(first.data(), (int64_t)first.size());
    list.bodies = where.make<scree_candidate_pair>(n);
    list.patch = where.make<int32_t>(n);
    list.volume = where.make<scree_real>(n);
    list.indentation = where.make<scree_real>(n);
    list.radius = where.make<scree_real>(n);
    list.normal = where.make<scree_vec3>(n);
    list.area_vector = where.make<scree_vec3>(n);
    list.torque_vector = where.make<scree_vec3>(n);
    list.arm = where.make<scree_vec3>(n);
    return list;
}

static void keep_geometry(side &where, const scree_contact_list &list, int64_t n)
{
    where.keep(list.bodies, n);
    where.keep(list.patch, n);
    where.keep(list.volume, n);
    where.keep(list.indentation, n);
    where.keep(list.radius, n);
    where.keep(list.normal, n);
    where.keep(list.area_vector, n);
    where.keep(list.torque_vector, n);
    where.keep(list.arm, n);
}

/// Other ids than their places for all particles, from the last one down; the same the other way round.
static std::vector<int32_t> ids()
{
    std::vector<int32_t> ids;
    for (int32_t k = 0; k < num_bodies; ++k) ids.push_back(k < num_particles ? (int32_t)num_particles - 1 - k : k);
    return ids;
}

static scree_pair_groups groups_on(side &where, const int32_t *first, const int32_t *second, int64_t stride,
                                   int64_t num)
{
    int32_t *bounds = where.zeros<int32_t>(2 * num_bodies);
    const scree_pair_groups groups = {first, second, nullptr, stride, num, bounds, bounds + num_bodies};
    LAUNCH_ON(where, scree_group_bounds, groups, num);
    where.keep(bounds, 2 * num_bodies);
    return groups;
}

/// What is known of the pairs of meshes in the batch to a batch of only every third, as after a search.
static void carry_memory_on(side &where, const scree_mesh_pairs_args &args, int64_t num)
{
    scree_pair_keep_args keep = {};
    keep.bodies = args.bodies;
    keep.bodies.num_steps = 10;
    keep.pairs = args.pairs;
    keep.batch = args.batch;
    keep.memory = args.memory;
    keep.kept_i = where.make<int32_t>(num);
    keep.kept_j = where.make<int32_t>(num);
    LAUNCH_ON(where, scree_pair_keep, keep, num);
    where.keep(keep.memory, num);
    where.keep(keep.kept_i, num);

    std::vector<int32_t> batch;
    for (const int32_t p : where.read(args.batch, num))
        if (p % 3 == 0) batch.push_back(p);
    const int64_t num_carried = (int64_t)batch.size();
    scree_pair_carry_args carry = {};
    carry.pairs = args.pairs;
    carry.batch = where.copy(batch.data(), num_carried);
    carry.memory = where.make<scree_pair_memory>(num_carried);
    carry.kept = groups_on(where, keep.kept_i, keep.kept_j, 1, num);
    carry.old_memory = keep.memory;
    LAUNCH_ON(where, scree_pair_carry, carry, num_carried);
    where.keep(carry.memory, num_carried);
    int64_t num_known = 0;
    for (const scree_pair_memory &memory : where.read(carry.memory, num_carried)) num_known += memory.apart_until != 0;
    SCREE_CHECK(num_known > 10);
}

/// The pairs of meshes, from all candidates to what they write into the list.
static void find_overlaps_on(side &where, bool separates)
{
    const int64_t num_pairs = s->broad_phase.num_pairs;
    scree_mesh_pairs_args args = {};
    args.bodies.shapes = shapes_on(where);
    args.bodies.shape = where.copy(b->shape, num_bodies);
    args.bodies.pose = where.copy(b->pose, num_bodies);
    args.bodies.travel = where.copy(b->travel, num_bodies);
    args.bodies.num_bodies = num_bodies;
    args.pairs = where.copy(s->broad_phase.pairs, num_pairs);

    scree_pair_kinds_args kinds = {};
    kinds.bodies = args.bodies;
    kinds.pairs = args.pairs;
    kinds.kind = SCREE_PAIR_MESH_MESH;
    kinds.places = where.make<int32_t>(num_pairs + 1);
    kinds.batch = where.make<int32_t>(num_pairs);
    LAUNCH_ON(where, scree_pair_flag, kinds, num_pairs);
    std::vector<int32_t> places(1, 0);
    for (const int64_t flag : where.read(kinds.places, num_pairs)) places.push_back(places.back() + flag);
    kinds.places = where.copy(places.data(), num_pairs + 1);
    LAUNCH_ON(where, scree_pair_scatter, kinds, num_pairs);
    const int64_t num = places.back();
    SCREE_CHECK(num > 60);
    where.keep(kinds.batch, num);

    args.batch = kinds.batch;
    args.memory = where.zeros<scree_pair_memory>(num);
    args.classes = {0, 2};
    args.max_active = num;
    args.active = where.make<int32_t>(3 * num);
    args.num_shares = 3;
    args.shares = where.zeros<scree_pair_share>(args.num_shares);
    args.max_kept = num;
    args.kept = where.make<scree_kept_overlap>(num);
    args.kept_levers = where.make<scree_kept_lever>(num);
    args.first_kept = where.make<int32_t>(num);
    args.list.first_of_pair = where.zeros<int32_t>(num_pairs + 1);
    args.tally = where.zeros<scree_pair_tally>(1);
    args.use = s->narrow_phase.separation;
    LAUNCH_ON(where, scree_mesh_apart, args, num);
    where.keep(args.memory, num);

    const int64_t num_slices = 5;
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    std::vector<scree_overlap_slice> slices;
    for (int64_t k = 0; k < num_slices; ++k)
        slices.push_back(slice_on(where, *reinterpret_cast<const scree_overlap_slice *>(workspace)));
    scree_overlap_workspace_destroy(workspace);
    scree_overlap_pairs_args overlaps = {};
    overlaps.meshes = args;
    overlaps.slices = where.copy(slices.data(), num_slices);
    overlaps.options = s->narrow_phase.options;
    overlaps.options.separate_patches = separates;
    overlaps.max_results = separates ? 4 : 1;
    overlaps.results = where.make<scree_overlap_result>(num_slices * overlaps.max_results);
    for (int32_t work_class = 0; work_class < 3; ++work_class)
    {
        overlaps.work_class = work_class;
        overlaps.num_lanes = scree_work_num_lanes(work_class);
        if (separates) LAUNCH_ON(where, scree_overlap_patches, overlaps, num_slices);
        else LAUNCH_ON(where, scree_overlap_pairs, overlaps, num_slices);
    }
    where.keep(args.memory, num);
    const scree_pair_tally tally = where.read(args.tally, 1)[0];
    const int64_t *num_of = tally.num_active, num_active = num_of[0] + num_of[1] + num_of[2];
    SCREE_CHECK(num_of[0] > 0 && num_active > 20 && num_active < num && tally.num_lacking[SCREE_LACK_PIECES] == 0);

    std::vector<int32_t> first(1, 0);
    for (const int32_t num_contacts : where.read(args.list.first_of_pair, num_pairs))
        first.push_back(first.back() + num_contacts);
    const int64_t n = first.back();
    SCREE_CHECK(n > 20);
    LAUNCH_ON(where, scree_mesh_gap, args, num);
    where.keep(args.memory, num);
    args.list = empty_list(where, first, n);
    LAUNCH_ON(where, scree_mesh_write, args, num);
    keep_geometry(where, args.list, n);
    carry_memory_on(where, args, num);
}

static void test_overlaps()
{
    check_two_sides([](side &where) { find_overlaps_on(where, false); });
    check_two_sides([](side &where) { find_overlaps_on(where, true); });
}

/// Both passes over the pairs of two spheres, of a sphere or clump and a mesh, or of two clumps.
static void find_spheres_on(side &where, scree_pair_kind kind)
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
    args.list.first_of_pair = where.zeros<int32_t>(num_pairs + 1);
    args.near = where.zeros<scree_near_nodes>(num);
    args.reach = 2 * b->skin;
    args.max_found = 8;
    args.found = where.make<scree_sphere_contact>(num * args.max_found);
    args.tally = where.zeros<scree_pair_tally>(1);
    if (kind == SCREE_PAIR_SPHERE_SPHERE) LAUNCH_ON(where, scree_sphere_sphere_count, args, num);
    else if (kind == SCREE_PAIR_CLUMP_CLUMP) LAUNCH_ON(where, scree_clump_clump_count, args, num);
    else
    {
        LAUNCH_ON(where, scree_sphere_mesh_near, args, num);
        LAUNCH_ON(where, scree_sphere_mesh_count, args, num);
    }
    where.keep(args.list.first_of_pair, num_pairs);
    where.keep(args.tally, 1);
    where.keep(args.near, num);

    std::vector<int32_t> first(1, 0);
    for (const int32_t num_contacts : where.read(args.list.first_of_pair, num_pairs))
        first.push_back(first.back() + num_contacts);
    const int64_t n = first.back();
    SCREE_CHECK(n > 10);
    args.list = empty_list(where, first, n);
    if (kind == SCREE_PAIR_SPHERE_SPHERE) LAUNCH_ON(where, scree_sphere_sphere_write, args, num);
    else if (kind == SCREE_PAIR_CLUMP_CLUMP) LAUNCH_ON(where, scree_clump_clump_write, args, num);
    else LAUNCH_ON(where, scree_sphere_mesh_write, args, num);
    keep_geometry(where, args.list, n);
}

static void test_spheres()
{
    check_two_sides([](side &where) { find_spheres_on(where, SCREE_PAIR_SPHERE_MESH); });
    check_two_sides([](side &where) { find_spheres_on(where, SCREE_PAIR_SPHERE_SPHERE); });
    check_two_sides([](side &where) { find_spheres_on(where, SCREE_PAIR_CLUMP_CLUMP); });
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
    args.old_groups = groups_on(where, &old.bodies->i, &old.bodies->j, 2, old.num_contacts);
    args.patch = contacts.patch;
    args.old_patch = old.patch;
    args.arm = contacts.arm;
    args.old_arm = old.arm;
    args.old_of_contact = where.make<int32_t>(num_contacts);
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

/// `has_sides`: on the device the gathering reads what the forces leave for it; elsewhere it makes that itself.
static void compare_forces(bool has_sides)
{
    check_two_sides(
        [has_sides](side &where)
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
            force.sides = has_sides && where.is_device ? where.make<scree_contact_side>(2 * (n + 5)) : nullptr;
            force.max_sides = n + 5;
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
            gather.sides = force.sides;
            gather.max_sides = force.max_sides;
            gather.own_begin = where.copy(s->broad_phase.own_begin, num_bodies + 1);
            gather.row_begin = where.copy(s->broad_phase.row_begin, num_bodies + 1);
            gather.row_pairs = where.copy(s->broad_phase.row_pairs, num_pairs);
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

static void test_forces()
{
    compare_forces(false);
    compare_forces(true);
}

/// `k`: 0: bodies at home and old contacts of the same pairs; 1: in other places, and old contacts in groups.
static void compare_work(int k)
{
    check_two_sides(
        [k](side &where)
        {
            const scree_contact_list *old = &s->old_contacts;
            const int64_t num_pairs = s->broad_phase.num_pairs, num_old = old->num_contacts;
            const int64_t num_blocks = scree_count_blocks(num_particles, SCREE_WORK_BLOCK);
            std::vector<uint8_t> is_continued;
            for (int64_t o = 0; o < num_old; ++o) is_continued.push_back(o % 3 != 0);
            const scree_pair_groups groups =
                groups_on(where, &where.copy(old->bodies, num_old)->i, nullptr, 2, num_old);
            scree_work_args work = {};
            work.contacts = contacts_on(where, s->contacts, num_pairs);
            work.own_begin = where.copy(s->broad_phase.own_begin, num_bodies + 1);
            work.old.elastic_energy = where.copy(old->elastic_energy, num_old);
            work.old.spring_energy = where.copy(old->spring_energy, num_old);
            work.old.is_continued = where.copy(is_continued.data(), num_old);
            work.old.first_of_pair = k == 0 ? where.copy(old->first_of_pair, num_pairs + 1) : nullptr;
            work.old.group_begin = groups.begin;
            work.old.group_end = groups.end;
            work.bodies = motion_on(where);
            work.ids = work.places = k == 0 ? nullptr : where.copy(ids().data(), num_bodies);
            work.of_bodies = where.make<scree_real>(4 * num_particles);
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

static void test_work()
{
    SCREE_CHECK(s->old_contacts.num_contacts > 40);
    compare_work(0);
    compare_work(1);
}

/// Sums of many parts, against sums in one go where the order does not matter.
static void test_sums()
{
    check_two_sides(
        [](side &where)
        {
            const int64_t num = 1000, num_groups = (num + SCREE_SUM_FAN_IN - 1) / SCREE_SUM_FAN_IN;
            std::vector<scree_work_sums> parts;
            double all = 0;
            for (int64_t k = 0; k < num; ++k)
            {
                const scree_real x = (scree_real)k;
                parts.push_back({x, 1 / (x + 1), -x, 3 * x, 5 + x});
                all += (double)x;
            }
            scree_work_reduce_args reduce = {where.copy(parts.data(), num), num,
                                             where.make<scree_work_sums>(num_groups)};
            LAUNCH_ON(where, scree_work_reduce, reduce, num_groups);
            where.keep(reduce.sums, num_groups);
            reduce = {reduce.sums, num_groups, where.make<scree_work_sums>(1)};
            LAUNCH_ON(where, scree_work_reduce, reduce, 1);
            where.keep(reduce.sums, 1);
            const scree_work_sums sum = where.read(reduce.sums, 1)[0];
            SCREE_CHECK((double)sum.damping == all && (double)sum.input == 3 * all && sum.smallest_step_squared == 5);

            const int64_t num_moving = 5;
            std::vector<scree_real> loads;
            for (int64_t k = 0; k < num * num_moving; ++k) loads.push_back((scree_real)(k % 7));
            const scree_wall_load_reduce_args wall = {where.copy(loads.data(), num * num_moving), num, num_moving,
                                                      where.make<scree_real>(num_groups * num_moving)};
            LAUNCH_ON(where, scree_wall_load_reduce, wall, num_groups * num_moving);
            where.keep(wall.sums, num_groups * num_moving);
        });
}

/// Halts for each thing that may lack room, and tells the number of contacts where nothing does.
static void test_room()
{
    for (int lack = 0; lack < 7; ++lack)
        check_two_sides(
            [lack](side &where)
            {
                scree_pair_tally tally = {};
                tally.num_contacts = lack == 1 ? 9 : 8;
                tally.num_kept = lack == 2 ? 6 : 5;
                if (lack == 3) tally.most_results.bits = scree_bits_of(2);
                if (lack == 4) tally.most_found.bits = scree_bits_of(4);
                if (lack == 5) tally.num_lacking[SCREE_LACK_PIECES] = 1;
                if (lack == 6) tally.num_lacking[SCREE_LACK_CROSSINGS] = 1;
                scree_room_args args = {where.copy(&tally, 1), 5, 8, where.zeros<scree_live>(1)};
                LAUNCH_ON(where, scree_room, args, 1);
                const scree_live live = where.read(args.live, 1)[0];
                SCREE_CHECK_INT(live.halt, lack == 0 ? SCREE_HALT_NONE : SCREE_HALT_ROOM);
                SCREE_CHECK_INT(live.num_contacts, lack == 0 ? 8 : 0);
                where.keep(args.live, 1);
            });
}

static void test_indentations()
{
    check_two_sides(
        [](side &where)
        {
            const scree_contact_list *c = &s->contacts;
            const int64_t n = c->num_contacts;
            double largest = 0;
            for (int64_t k = 0; k < n; ++k) largest = fmax(largest, (double)c->indentation[k]);
            const scree_indentations_args args = {where.copy(c->indentation, n), n, where.zeros<scree_maximum>(1)};
            LAUNCH_ON(where, scree_indentations, args, scree_count_blocks(n, SCREE_CONTACT_BLOCK));
            where.keep(args.largest, 1);
            SCREE_CHECK(largest > 0 && scree_maximum_value(where.read(args.largest, 1)[0]) == largest);
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

            // every fifth has ended
            std::vector<uint8_t> is_continued;
            std::vector<int32_t> places(1, 0);
            for (int64_t o = 0; o < num_old; ++o) is_continued.push_back(o % 5 != 0);
            for (int64_t o = 0; o < num_old; ++o) places.push_back(places.back() + (o % 5 == 0));
            scree_ended_collisions_args ended = {};
            ended.bodies = where.copy(s->old_contacts.bodies, num_old);
            ended.patch = where.copy(s->old_contacts.patch, num_old);
            ended.ids = where.copy(ids().data(), num_bodies);
            ended.is_continued = where.copy(is_continued.data(), num_old);
            ended.normal = args.old_normal;
            ended.tangential = args.old_tangential;
            ended.num_particles = (int32_t)num_particles;
            ended.places = where.make<int32_t>(num_old + 1);
            LAUNCH_ON(where, scree_ended_flag, ended, num_old);
            where.keep(ended.places, num_old);
            ended.places = where.copy(places.data(), num_old + 1);
            ended.ended = where.zeros<scree_ended_collision>(places.back());
            LAUNCH_ON(where, scree_ended_collisions, ended, num_old);
            int64_t o = 0;
            for (const scree_ended_collision &collision : where.read(ended.ended, places.back()))
            {
                const int32_t is_with_wall = s->old_contacts.bodies[o].j >= num_particles;
                SCREE_CHECK(collision.normal == normal[(size_t)o] && collision.tangential == tangential[(size_t)o]);
                SCREE_CHECK_INT(collision.is_with_wall, is_with_wall);
                SCREE_CHECK_INT(collision.first, ids()[(size_t)s->old_contacts.bodies[o].i]);
                SCREE_CHECK_INT(collision.second, ids()[(size_t)s->old_contacts.bodies[o].j]);
                SCREE_CHECK_INT(collision.patch, s->old_contacts.patch[o]);
                o += 5;
            }
        });
}

static void test_wall_loads()
{
    SCREE_CHECK(b->num_moving_walls > 0);
    check_two_sides(
        [](side &where)
        {
            const int64_t num_pairs = s->broad_phase.num_pairs, num_moving = b->num_moving_walls;
            const int64_t num_sums = scree_count_blocks(num_particles, SCREE_WALL_LOAD_BLOCK) * num_moving;
            scree_wall_load_args args = {};
            args.contacts = contacts_on(where, s->contacts, num_pairs);
            args.pairs = where.copy(s->broad_phase.pairs, num_pairs);
            args.row_begin = where.copy(s->broad_phase.row_begin, num_bodies + 1);
            args.row_pairs = where.copy(s->broad_phase.row_pairs, num_pairs);
            args.pose = where.copy(b->pose, num_bodies);
            args.axes = where.copy(b->wall_axes, num_moving);
            args.num_moving = num_moving;
            args.sums = where.make<scree_real>(num_sums);
            LAUNCH_ON(where, scree_wall_load, args, num_sums);
            where.keep(args.sums, num_sums);
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
    // the old contacts are those of the same pairs
    while (b->has_old_groups) SCREE_CHECK_INT(scree_simulation_step(s, NULL), SCREE_OK);
    num_particles = s->particles.num_particles;
    num_bodies = num_particles + s->num_walls;
    printf("%lld pairs, %lld contacts\n", (long long)s->broad_phase.num_pairs, (long long)s->contacts.num_contacts);
    SCREE_CHECK(s->contacts.num_contacts > 40);

    SCREE_RUN(test_overlaps);
    SCREE_RUN(test_spheres);
    SCREE_RUN(test_history);
    SCREE_RUN(test_forces);
    SCREE_RUN(test_work);
    SCREE_RUN(test_wall_loads);
    SCREE_RUN(test_sums);
    SCREE_RUN(test_room);
    SCREE_RUN(test_indentations);
    SCREE_RUN(test_collisions);
    scene_run_end(&run);
    return SCREE_TEST_END();
}
