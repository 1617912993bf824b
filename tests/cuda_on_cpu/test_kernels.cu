// The kernels of motion and neighbours on the device, emulated or real, on the data of a running scene: the same bits
// as on the CPU, for every size of block and every schedule.
#define _XOPEN_SOURCE 700
#include "scene_kernels.cuh"

#include <cub/device/device_radix_sort.cuh>

SCREE_DECLARE_LAUNCH_CUDA(scree_lbvh_bounds)
SCREE_DECLARE_LAUNCH_CUDA(scree_lbvh_codes)
SCREE_DECLARE_LAUNCH_CUDA(scree_lbvh_hierarchy)
SCREE_DECLARE_LAUNCH_CUDA(scree_lbvh_left_turns)
SCREE_DECLARE_LAUNCH_CUDA(scree_lbvh_nodes)
SCREE_DECLARE_LAUNCH_CUDA(scree_particle_pairs)
SCREE_DECLARE_LAUNCH_CUDA(scree_wall_pairs)
SCREE_DECLARE_LAUNCH_CUDA(scree_pair_unpack)
SCREE_DECLARE_LAUNCH_CUDA(scree_pair_own)
SCREE_DECLARE_LAUNCH_CUDA(scree_pair_second_keys)
SCREE_DECLARE_LAUNCH_CUDA(scree_pair_rows)
SCREE_DECLARE_LAUNCH_CUDA(scree_predict)
SCREE_DECLARE_LAUNCH_CUDA(scree_correct)
SCREE_DECLARE_LAUNCH_CUDA(scree_boxes)
SCREE_DECLARE_LAUNCH_CUDA(scree_travel)
SCREE_DECLARE_LAUNCH_CUDA(scree_skin)
SCREE_DECLARE_LAUNCH_CUDA(scree_place_walls)
SCREE_DECLARE_LAUNCH_CUDA(scree_place_particles)
SCREE_DECLARE_LAUNCH_CUDA(scree_far_followers)
SCREE_DECLARE_LAUNCH_CUDA(scree_home_order)
SCREE_DECLARE_LAUNCH_CUDA(scree_new_places)
SCREE_DECLARE_LAUNCH_CUDA(scree_move_pairs)
SCREE_DECLARE_LAUNCH_CUDA(scree_group_sizes)
SCREE_DECLARE_LAUNCH_CUDA(scree_sort_groups)
SCREE_DECLARE_LAUNCH_CUDA(scree_permute)

// ---- motion

static scree_ways ways_on(side &where)
{
    return {shapes_on(where), where.copy(b->shape, num_bodies), where.copy(b->travel, num_bodies)};
}

static void test_predict()
{
    check_two_sides(
        [](side &where)
        {
            scree_predict_args args;
            args.particles = particles_on(where);
            args.time_step = (scree_real)s->time_step;
            args.ways = ways_on(where);
            args.pose = where.copy(b->searched_pose, num_particles);
            args.moving = where.zeros<scree_moving_body>(num_particles);
            LAUNCH_ON(where, scree_predict, args, num_particles);
            where.keep(args.particles.position, num_particles);
            where.keep(args.particles.orientation, num_particles);
            where.keep(args.particles.velocity, num_particles);
            where.keep(args.particles.angular_momentum, num_particles);
            where.keep(args.pose, num_particles);
            where.keep(args.moving, num_particles);
            where.keep(args.ways.travel, num_bodies);
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
            args.moving = where.zeros<scree_moving_body>(num_particles);
            args.ids = nullptr;
            args.tally = where.zeros<scree_step_tally>(1);
            std::vector<scree_vec3> position(s->particles.position, s->particles.position + num_particles);
            position[17].x = position[19].y = NAN;
            args.particles.position = where.copy(position.data(), num_particles);
            LAUNCH_ON(where, scree_correct, args, num_particles);
            where.keep(&args.tally->num_from_unstable, 1);
            const scree_maximum from = where.read(&args.tally->num_from_unstable, 1)[0];
            SCREE_CHECK(scree_maximum_value(from) == (double)(num_particles - 17));
            where.keep(args.particles.velocity, num_particles);
            where.keep(args.particles.angular_momentum, num_particles);
            where.keep(args.moving, num_particles);
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

/// Those of the last search.
static std::vector<scree_box> boxes;
static std::vector<scree_vec3> centres;
static std::vector<scree_real> radii;

static void make_boxes()
{
    boxes.resize((size_t)num_particles);
    centres.resize((size_t)num_particles);
    radii.resize((size_t)num_particles);
    const scree_boxes_args args = {s->shape_views, b->shape,       b->searched_pose, b->skin,
                                   boxes.data(),   centres.data(), radii.data()};
    for (int64_t i = 0; i < num_particles; ++i) scree_boxes_at(args, i);
}

static scree_body_arrays empty_bodies(side &where)
{
    scree_body_arrays bodies;
    bodies.pose = where.zeros<scree_pose>(num_bodies);
    bodies.moving = where.zeros<scree_moving_body>(num_bodies);
    return bodies;
}

static void keep_bodies(side &where, const scree_body_arrays &bodies)
{
    where.keep(bodies.pose, num_bodies);
    where.keep(bodies.moving, num_bodies);
}

static void test_place()
{
    check_two_sides(
        [](side &where)
        {
            scree_place_particles_args args;
            args.particles = particles_on(where);
            args.bodies = empty_bodies(where);
            LAUNCH_ON(where, scree_place_particles, args, num_particles);
            scree_place_walls_args walls;
            walls.bodies = args.bodies;
            walls.ways = ways_on(where);
            walls.first = num_particles;
            walls.walls = where.copy(b->wall_motion_here, s->num_walls);
            LAUNCH_ON(where, scree_place_walls, walls, s->num_walls);
            keep_bodies(where, args.bodies);
            where.keep(walls.ways.travel, num_bodies);
        });
}

/// Halts if a body may have left its skin, or if nobody can say.
static void test_skin()
{
    for (const double moved : {0.75, 1.0, 1.25, (double)NAN})
        check_two_sides(
            [moved](side &where)
            {
                const scree_maximum most[2] = {{scree_bits_of(moved)}, {scree_bits_of(0.25)}};
                const scree_maximum *maxima = where.copy(most, 2);
                scree_skin_args args = {maxima, maxima + 1, (scree_real)1.25, where.zeros<scree_live>(1)};
                LAUNCH_ON(where, scree_skin, args, 1);
                const scree_live live = where.read(args.live, 1)[0];
                SCREE_CHECK_INT(live.halt, moved <= 1 ? SCREE_HALT_NONE : SCREE_HALT_SEARCH);
                where.keep(args.live, 1);
            });
}

static void test_travel()
{
    check_two_sides(
        [](side &where)
        {
            scree_travel_args args;
            args.shapes = shapes_on(where);
            args.shape = where.copy(b->shape, num_bodies);
            args.pose = where.copy(b->pose, num_bodies);
            args.searched_pose = where.copy(b->searched_pose, num_bodies);
            args.num_particles = num_particles;
            scree_step_tally *tally = where.zeros<scree_step_tally>(1);
            args.particles_moved = &tally->particles_moved;
            args.walls_moved = &tally->walls_moved;
            LAUNCH_ON(where, scree_travel, args, num_bodies);
            where.keep(&tally->particles_moved, 2);
            double largest = 0;
            for (int64_t i = 0; i < num_particles; ++i)
                largest = fmax(largest, (double)scree_displacement(s->shape_views + b->shape[i], b->searched_pose + i,
                                                                   b->pose + i));
            SCREE_CHECK(largest > 0);
            SCREE_CHECK(scree_maximum_value(where.read(&tally->particles_moved, 1)[0]) == largest);
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
    check_two_sides([](side &where) { build_tree_on(where, boxes.data(), num_particles); });

    // and the tree is that of the library
    side device(true, 128);
    build_tree_on(device, boxes.data(), num_particles);
    scree_lbvh tree = {};
    SCREE_CHECK_INT(scree_lbvh_build(&tree, boxes.data(), num_particles), SCREE_OK);
    SCREE_CHECK(
        memcmp(device.outcome.data(), tree.view.nodes, (size_t)(2 * num_particles - 1) * sizeof *tree.view.nodes) == 0);
    scree_lbvh_destroy(&tree);
}

/// Ids of the bodies in all places, the particles' from the last one down; the other way round they are the same.
static std::vector<int32_t> reversed()
{
    std::vector<int32_t> ids;
    for (int32_t k = 0; k < num_bodies; ++k) ids.push_back(k < num_particles ? (int32_t)num_particles - 1 - k : k);
    return ids;
}

/// Keys of all pairs, in no order; as the broad phase, asks again if the list was too short.
static uint64_t *find_keys_on(side &where, int32_t id_bits, const int32_t *ids, int64_t *num_keys)
{
    scree_particle_pairs_args particle_args = {};
    particle_args.tree = build_tree_on(where, boxes.data(), num_particles);
    scree_wall_pairs_args wall_args = {};
    std::vector<scree_broad_phase_wall> walls(b->broad_phase_walls, b->broad_phase_walls + s->num_walls);
    for (scree_broad_phase_wall &wall : walls) wall.tree = tree_on(where, wall.tree);
    wall_args.centres = where.copy(centres.data(), num_particles);
    wall_args.radii = where.copy(radii.data(), num_particles);
    particle_args.centres = wall_args.centres;
    particle_args.radii = wall_args.radii;
    wall_args.walls = where.copy(walls.data(), s->num_walls);
    wall_args.num_particles = num_particles;
    wall_args.num_walls = s->num_walls;
    wall_args.block_particles = 7;

    scree_pair_list list = {};
    list.id_bits = id_bits;
    list.ids = ids;
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

static void find_pairs_of(side &where, const int32_t *ids)
{
    int64_t num_pairs;
    const int32_t id_bits = 12;
    scree_pair_rows_args args = {};
    uint64_t *keys = find_keys_on(where, id_bits, ids, &num_pairs);
    int32_t *values = where.make<int32_t>(num_pairs);
    where.outcome.clear();
    sort_on(where, keys, values, num_pairs, 0);
    args.keys = keys;
    args.second_keys = where.make<uint64_t>(num_pairs);
    args.pairs = where.make<scree_candidate_pair>(num_pairs);
    args.own_begin = where.make<int32_t>(num_bodies + 1);
    args.row_begin = where.make<int32_t>(num_bodies + 1);
    args.row_pairs = where.make<int32_t>(num_pairs);
    args.num_pairs = num_pairs;
    args.num_bodies = num_bodies;
    args.id_bits = id_bits;
    args.ids = args.places = ids;
    LAUNCH_ON(where, scree_pair_unpack, args, num_pairs);
    if (ids != nullptr)
    {
        args.own_before = where.make<int32_t>(num_bodies + 1);
        LAUNCH_ON(where, scree_pair_own, args, num_bodies);
        where.keep(args.own_before, num_bodies);
        std::vector<int32_t> before = where.read(args.own_before, num_bodies);
        int32_t sum = 0;
        for (int32_t &num : before)
        {
            const int32_t own = num;
            num = sum;
            sum += own;
        }
        args.own_before = where.copy(before.data(), num_bodies);
    }
    LAUNCH_ON(where, scree_pair_second_keys, args, num_pairs);
    sort_on(where, args.second_keys, values, num_pairs, 32);
    LAUNCH_ON(where, scree_pair_rows, args, num_pairs);
    where.keep(args.pairs, num_pairs);
    where.keep(args.row_begin, num_bodies + 1);
    where.keep(args.own_begin, num_bodies + 1);
    where.keep(args.row_pairs, num_pairs);
}

static void find_pairs_on(side &where) { find_pairs_of(where, nullptr); }

static void find_pairs_elsewhere_on(side &where) { find_pairs_of(where, where.copy(reversed().data(), num_bodies)); }

static void test_pairs()
{
    check_two_sides(find_pairs_on);
    check_two_sides(find_pairs_elsewhere_on);

    // and they are those of the library, from the same boxes
    side device(true, 128), library(false);
    find_pairs_on(device);
    const scree_broad_phase *broad_phase = &s->broad_phase;
    library.keep(broad_phase->pairs, broad_phase->num_pairs);
    library.keep(broad_phase->row_begin, num_bodies + 1);
    library.keep(broad_phase->own_begin, num_bodies + 1);
    library.keep(broad_phase->row_pairs, broad_phase->num_pairs);
    SCREE_CHECK(broad_phase->num_pairs > 200);
    SCREE_CHECK(device.outcome == library.outcome);
}

// ---- places

static void test_places()
{
    check_two_sides(
        [](side &where)
        {
            const scree_home_order_args home = {where.make<int32_t>(num_bodies), where.make<int32_t>(num_bodies),
                                                where.make<int32_t>(num_bodies)};
            LAUNCH_ON(where, scree_home_order, home, num_bodies);
            where.keep(home.order, num_bodies);
            std::vector<int32_t> order;
            for (int64_t k = 0; k < num_bodies; ++k) order.push_back((int32_t)((k + 5) % num_bodies));
            scree_new_places_args places = {where.copy(order.data(), num_bodies), home.ids,
                                            where.make<int32_t>(num_bodies), home.places,
                                            where.make<int32_t>(num_bodies)};
            LAUNCH_ON(where, scree_new_places, places, num_bodies);
            where.keep(places.ids, num_bodies);
            where.keep(places.places, num_bodies);
            where.keep(places.moved_to, num_bodies);
            const int64_t num_pairs = s->broad_phase.num_pairs;
            const scree_move_pairs_args pairs = {where.copy(s->broad_phase.pairs, num_pairs), places.moved_to};
            LAUNCH_ON(where, scree_move_pairs, pairs, num_pairs);
            where.keep(pairs.pairs, num_pairs);
            const scree_permute_args poses = {where.copy(b->pose, num_bodies), where.make<scree_pose>(num_bodies),
                                              places.order, sizeof(scree_pose)};
            LAUNCH_ON(where, scree_permute, poses, num_bodies);
            where.keep((const scree_pose *)poses.to, num_bodies);
            std::vector<uint8_t> marks((size_t)num_bodies, 3);
            marks[5] = 9;
            const scree_permute_args bytes = {where.copy(marks.data(), num_bodies), where.make<uint8_t>(num_bodies),
                                              places.order, 1};
            LAUNCH_ON(where, scree_permute, bytes, num_bodies);
            where.keep((const uint8_t *)bytes.to, num_bodies);

            scree_far_followers_args far = {where.copy(centres.data(), num_particles),
                                            where.copy(radii.data(), num_particles), NULL, num_particles,
                                            where.zeros<int64_t>(1)};
            LAUNCH_ON(where, scree_far_followers, far, (num_particles + SCREE_FAR_BLOCK - 1) / SCREE_FAR_BLOCK);
            where.keep(far.num_far, 1);
            // an order of particles alone: walls have neither centre nor radius here
            for (int64_t k = 0; k < num_particles; ++k) order[(size_t)k] = (int32_t)((k + 5) % num_particles);
            far.order = where.copy(order.data(), num_particles);
            far.num_far = where.zeros<int64_t>(1);
            LAUNCH_ON(where, scree_far_followers, far, (num_particles + SCREE_FAR_BLOCK - 1) / SCREE_FAR_BLOCK);
            where.keep(far.num_far, 1);

            // three groups in an order of their own
            std::vector<int32_t> begin((size_t)num_bodies, 0), end((size_t)num_bodies, 0), first((size_t)num_bodies, 0);
            begin[9] = 0;
            end[9] = begin[2] = 2;
            end[2] = begin[4] = 5;
            end[4] = 6;
            scree_sort_groups_args groups = {where.copy(begin.data(), num_bodies), where.copy(end.data(), num_bodies),
                                             where.make<int32_t>(num_bodies), where.make<int32_t>(6)};
            LAUNCH_ON(where, scree_group_sizes, groups, num_bodies);
            where.keep(groups.first, num_bodies);
            for (int k = 3; k < num_bodies; ++k) first[(size_t)k] = k <= 4 ? 3 : k <= 9 ? 4 : 6;
            groups.first = where.copy(first.data(), num_bodies);
            LAUNCH_ON(where, scree_sort_groups, groups, num_bodies);
            where.keep(groups.order, 6);
            const int32_t wanted[6] = {2, 3, 4, 5, 0, 1};
            const std::vector<int32_t> found = where.read(groups.order, 6);
            for (int k = 0; k < 6; ++k) SCREE_CHECK_INT(found[(size_t)k], wanted[k]);
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

    make_boxes();
    SCREE_RUN(test_predict);
    SCREE_RUN(test_correct);
    SCREE_RUN(test_boxes);
    SCREE_RUN(test_place);
    SCREE_RUN(test_travel);
    SCREE_RUN(test_skin);
    SCREE_RUN(test_tree);
    SCREE_RUN(test_pairs);
    SCREE_RUN(test_places);
    scene_run_end(&run);
    return SCREE_TEST_END();
}
