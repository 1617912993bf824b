/// Candidate pairs: known answers, walls in any pose, rows, threads, the two ways of searching, refusals.
#include "bvh/broad_phase.h"

#include <omp.h>
#include <stdlib.h>
#include <sys/resource.h>

#include "bvh/bvh_launch.h"
#include "bvh_tools.h"
#include "core/sort.h"
#include "harness.h"
#include "launch_any_order.h"

static scree_box make_box(double x, double y, double z, double half)
{
    scree_box box;
    box.lower = scree_vec3_make((scree_real)(x - half), (scree_real)(y - half), (scree_real)(z - half));
    box.upper = scree_vec3_make((scree_real)(x + half), (scree_real)(y + half), (scree_real)(z + half));
    return box;
}

static void check_valid(const scree_broad_phase *broad_phase, const scree_broad_phase_input *input)
{
    scree_report report = {0};
    SCREE_CHECK(scree_broad_phase_validate(broad_phase, input, &report));
    for (int m = 0; m < report.num_messages; ++m) printf("    %s\n", report.messages[m]);
    scree_report_clear(&report);
}

static void check_pairs(const scree_broad_phase *broad_phase, const int32_t (*expected)[2], int64_t num)
{
    SCREE_CHECK_INT(broad_phase->num_pairs, num);
    for (int64_t p = 0; p < num && p < broad_phase->num_pairs; ++p)
    {
        SCREE_CHECK_INT(broad_phase->pairs[p].i, expected[p][0]);
        SCREE_CHECK_INT(broad_phase->pairs[p].j, expected[p][1]);
    }
}

/// A chain of boxes that touch at faces, its ids in no order, and its rows as they must be.
static void test_chain(void)
{
    const scree_box boxes[5] = {make_box(2, 0, 0, 0.5), make_box(0, 0, 0, 0.5), make_box(3, 0, 0, 0.5),
                                make_box(1, 0, 0, 0.5), make_box(9, 0, 0, 0.5)};
    const int32_t expected[3][2] = {{0, 2}, {0, 3}, {1, 3}};
    const int32_t own_begin[6] = {0, 2, 3, 3, 3, 3}, row_begin[6] = {0, 0, 0, 1, 3, 3}, row_pairs[3] = {0, 1, 2};
    const scree_broad_phase_input input = {.boxes = boxes, .num_particles = 5};
    scree_broad_phase broad_phase = {0};
    SCREE_CHECK(scree_broad_phase_find(&broad_phase, &input) == SCREE_OK);
    check_pairs(&broad_phase, expected, 3);
    SCREE_CHECK(memcmp(broad_phase.own_begin, own_begin, sizeof own_begin) == 0);
    SCREE_CHECK(memcmp(broad_phase.row_begin, row_begin, sizeof row_begin) == 0);
    SCREE_CHECK(memcmp(broad_phase.row_pairs, row_pairs, sizeof row_pairs) == 0);
    check_valid(&broad_phase, &input);
    scree_broad_phase_destroy(&broad_phase);
}

/// n^3 cubes that fill a cube: a pair for each two cells whose places differ by at most one along each axis. The
/// number of ordered ones, with a cell itself, is (3n - 2)^3: n along an axis with itself, 2(n - 1) with neighbours.
static void test_grids_and_sizes(void)
{
    scree_broad_phase broad_phase = {0};
    const int sizes[] = {1, 2, 30, 3, 0, 12}; // up and down: buffers are kept
    for (int s = 0; s < (int)(sizeof sizes / sizeof *sizes); ++s)
    {
        const int64_t n = sizes[s], num = n * n * n;
        scree_box *boxes = scree_test_alloc(num, sizeof *boxes);
        for (int64_t c = 0; c < num; ++c)
            boxes[c] = make_box((double)(c % n), (double)(c / n % n), (double)(c / (n * n)), 0.5);
        const scree_broad_phase_input input = {.boxes = boxes, .num_particles = num};
        SCREE_CHECK(scree_broad_phase_find(&broad_phase, &input) == SCREE_OK);
        SCREE_CHECK_INT(broad_phase.num_pairs, n > 0 ? ((3 * n - 2) * (3 * n - 2) * (3 * n - 2) - num) / 2 : 0);
        check_valid(&broad_phase, &input);
        // a cell within the cube has 26 neighbours
        if (n >= 3)
        {
            const int64_t within = 1 + n + n * n;
            SCREE_CHECK_INT(broad_phase.own_begin[within + 1] - broad_phase.own_begin[within], 13);
            SCREE_CHECK_INT(broad_phase.row_begin[within + 1] - broad_phase.row_begin[within], 13);
        }
        free(boxes);
    }
    scree_broad_phase_destroy(&broad_phase);
}

/// All overlap all: every pair there is, also where a cluster of leaves meets more than fit into its list.
static void test_all_pairs(void)
{
    enum
    {
        NUM = 1800
    };
    scree_box *boxes = scree_test_alloc(NUM, sizeof *boxes);
    uint64_t state = 1;
    for (int i = 0; i < NUM; ++i)
        boxes[i] = make_box(scree_test_random(&state), scree_test_random(&state), scree_test_random(&state), 1);
    const scree_broad_phase_input input = {.boxes = boxes, .num_particles = NUM};
    scree_broad_phase broad_phase = {0};
    SCREE_CHECK(scree_broad_phase_find(&broad_phase, &input) == SCREE_OK);
    SCREE_CHECK_INT(broad_phase.num_pairs, (int64_t)NUM * (NUM - 1) / 2);
    check_valid(&broad_phase, &input);
    scree_broad_phase_destroy(&broad_phase);
    free(boxes);
}

/// Boxes as large as numbers go, and a small one: all meet, and nothing else is found.
static void test_largest_boxes(void)
{
    scree_box boxes[3] = {make_box(0, 0, 0, 1), make_box(0, 0, 0, (double)SCREE_REAL_MAX),
                          make_box(0, 0, 0, (double)SCREE_REAL_MAX)};
    const scree_broad_phase_input input = {.boxes = boxes, .num_particles = 3};
    const int32_t expected[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    scree_broad_phase broad_phase = {0};
    SCREE_CHECK(scree_broad_phase_find(&broad_phase, &input) == SCREE_OK);
    check_pairs(&broad_phase, expected, 3);
    check_valid(&broad_phase, &input);
    scree_broad_phase_destroy(&broad_phase);
}

/// Tree over the boxes of six triangles that make a floor of 6 x 1 at z = 0, in the wall's frame.
static scree_lbvh make_floor(void)
{
    scree_box boxes[6];
    scree_lbvh tree = {0};
    for (int t = 0; t < 6; ++t)
    {
        boxes[t].lower = scree_vec3_make((scree_real)t, 0, 0);
        boxes[t].upper = scree_vec3_make((scree_real)t + 1, 1, 0);
    }
    SCREE_CHECK(scree_lbvh_build(&tree, boxes, 6) == SCREE_OK);
    return tree;
}

/// Particles and walls of one search, at most 8 of each.
typedef struct scene
{
    scree_box boxes[8];
    scree_vec3 centres[8];
    scree_real radii[8];
    scree_broad_phase_wall walls[8];
    scree_broad_phase_input input;
} scene;

static void add_sphere(scene *s, double x, double y, double z, double radius)
{
    const int64_t i = s->input.num_particles++;
    s->boxes[i] = make_box(x, y, z, radius);
    s->centres[i] = scree_vec3_make((scree_real)x, (scree_real)y, (scree_real)z);
    s->radii[i] = (scree_real)radius;
    s->input.boxes = s->boxes;
    s->input.centres = s->centres;
    s->input.radii = s->radii;
    s->input.walls = s->walls;
}

static scree_pose make_pose(double x, double y, double z, double scale)
{
    scree_pose pose = {scree_vec3_make((scree_real)x, (scree_real)y, (scree_real)z), scree_quat_identity(),
                       (scree_real)scale};
    return pose;
}

static void test_walls(void)
{
    scree_lbvh tree = make_floor(), nothing = {0};
    SCREE_CHECK(scree_lbvh_build(&nothing, NULL, 0) == SCREE_OK);
    scene s = {0};
    add_sphere(&s, 0.5, 0.5, 0.25, 0.25); // touches the floor
    add_sphere(&s, 3.5, 0.5, 0.3, 0.25);  // above it
    add_sphere(&s, 12, 1, 4, 1);          // reaches the raised, doubled floor at x = 10 .. 22, z = 5 from below
    add_sphere(&s, 3.5, 0.5, 0.2, 0.1);   // meets sphere 1, not the floor: a pair of particles
    add_sphere(&s, -0.8, 1.8, 0, 1.14);   // beside the corner: sqrt(0.8^2 + 0.8^2) = 1.131...
    add_sphere(&s, -0.8, 1.8, 0, 1.12);   // ... so this one, within the last one's box, does not reach it
    s.walls[0] = (scree_broad_phase_wall){tree.view, make_pose(0, 0, 0, 1), true};
    s.walls[1] = (scree_broad_phase_wall){tree.view, make_pose(10, 0, 5, 2), true};
    s.walls[2] = (scree_broad_phase_wall){tree.view, make_pose(0, 0, 0, 1), false};
    s.walls[3] = (scree_broad_phase_wall){nothing.view, make_pose(0, 0, 0, 1), true};
    s.input.num_walls = 4;
    const int32_t expected[7][2] = {{0, 4}, {0, 5}, {0, 6}, {1, 3}, {2, 7}, {4, 5}, {4, 6}};
    scree_broad_phase broad_phase = {0};
    SCREE_CHECK(scree_broad_phase_find(&broad_phase, &s.input) == SCREE_OK);
    // the boxes of spheres 4 and 5 reach to x > 0.3, y < 0.7: they overlap that of sphere 0, and each other
    check_pairs(&broad_phase, expected, 7);
    check_valid(&broad_phase, &s.input);

    s.walls[2].is_present = true; // the same floor once more
    SCREE_CHECK(scree_broad_phase_find(&broad_phase, &s.input) == SCREE_OK);
    SCREE_CHECK_INT(broad_phase.num_pairs, 9);
    SCREE_CHECK_INT(broad_phase.row_begin[9] - broad_phase.row_begin[8], 2);
    check_valid(&broad_phase, &s.input);
    scree_broad_phase_destroy(&broad_phase);
    scree_lbvh_destroy(&tree);
    scree_lbvh_destroy(&nothing);
}

/// Walls without particles, particles without walls.
static void test_nothing_to_find(void)
{
    scree_lbvh tree = make_floor();
    scene s = {0};
    scree_broad_phase broad_phase = {0};
    SCREE_CHECK(scree_broad_phase_find(&broad_phase, &s.input) == SCREE_OK);
    SCREE_CHECK_INT(broad_phase.num_pairs, 0);
    SCREE_CHECK_INT(broad_phase.row_begin[0], 0);
    s.walls[0] = (scree_broad_phase_wall){tree.view, make_pose(0, 0, 0, 1), true};
    s.input.walls = s.walls;
    s.input.num_walls = 1;
    SCREE_CHECK(scree_broad_phase_find(&broad_phase, &s.input) == SCREE_OK);
    SCREE_CHECK_INT(broad_phase.num_pairs, 0);
    SCREE_CHECK_INT(broad_phase.row_begin[1], 0);
    check_valid(&broad_phase, &s.input);
    add_sphere(&s, 0, 0, 9, 1);
    SCREE_CHECK(scree_broad_phase_find(&broad_phase, &s.input) == SCREE_OK);
    SCREE_CHECK_INT(broad_phase.num_pairs, 0);
    check_valid(&broad_phase, &s.input);
    scree_broad_phase_destroy(&broad_phase);
    scree_lbvh_destroy(&tree);
}

/// A point of the frame of a pose in the world, with more digits than the search has.
static void to_world(const scree_pose *pose, const long double local[3], long double world[3])
{
    const long double q[4] = {pose->orientation.w, pose->orientation.x, pose->orientation.y, pose->orientation.z};
    const long double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    const long double position[3] = {pose->position.x, pose->position.y, pose->position.z};
    // v + 2 u x (u x v + w v), u = (x, y, z)
    long double t[3];
    for (int k = 0; k < 3; ++k)
    {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        t[k] = q[a + 1] * local[b] - q[b + 1] * local[a] + q[0] * local[k];
    }
    for (int k = 0; k < 3; ++k)
    {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        world[k] = position[k] + pose->scale * (local[k] + 2 / n * (q[a + 1] * t[b] - q[b + 1] * t[a]));
    }
}

/// Spheres over the middle of a floor in any pose that touch it but for the last digits: none that truly reaches it may
/// be lost, and none that stays clear by 4096 eps may be taken for one.
static void test_walls_are_rounded_outwards(void)
{
    scree_lbvh tree = make_floor();
    scree_broad_phase broad_phase = {0};
    uint64_t state = 2;
    int num_lost = 0, num_false = 0, num_touching = 0;
    for (int n = 0; n < 4000; ++n)
    {
        scree_pose pose = make_pose(scree_test_random(&state) * 100 - 50, scree_test_random(&state) * 100 - 50,
                                    scree_test_random(&state) * 100 - 50, scree_test_size(&state, 0.01, 10));
        pose.orientation = scree_quat_normalize(scree_quat_make(
            (scree_real)(scree_test_random(&state) - 0.5), (scree_real)(scree_test_random(&state) - 0.5),
            (scree_real)(scree_test_random(&state) - 0.5), (scree_real)(scree_test_random(&state) - 0.5)));
        const scree_real radius = (scree_real)scree_test_size(&state, 0.001, 0.4) * pose.scale;
        const long double excess = n % 2 == 0 ? 0 : 4096 * SCREE_REAL_EPSILON; // coordinates are below 100
        const long double local[3] = {3, 0.5L, ((long double)radius + excess) / pose.scale};
        long double world[3], foot[3], normal[3], distance = 0;
        const long double local_foot[3] = {3, 0.5L, 0};
        to_world(&pose, local, world);
        to_world(&pose, local_foot, foot);
        for (int k = 0; k < 3; ++k) normal[k] = (world[k] - foot[k]) / (radius + excess);
        scene s = {0};
        add_sphere(&s, (double)world[0], (double)world[1], (double)world[2], (double)radius);
        s.walls[0] = (scree_broad_phase_wall){tree.view, pose, true};
        s.input.num_walls = 1;
        SCREE_CHECK(scree_broad_phase_find(&broad_phase, &s.input) == SCREE_OK);

        // how far the rounded centre really is
        const long double centre[3] = {s.centres[0].x, s.centres[0].y, s.centres[0].z};
        for (int k = 0; k < 3; ++k) distance += (centre[k] - foot[k]) * normal[k];
        num_touching += distance <= radius;
        num_lost += distance <= radius && broad_phase.num_pairs == 0;
        num_false += excess > 0 && broad_phase.num_pairs != 0;
    }
    SCREE_CHECK_INT(num_lost, 0);
    SCREE_CHECK_INT(num_false, 0);
    SCREE_CHECK(num_touching > 500); // half of 2000 by chance
    scree_broad_phase_destroy(&broad_phase);
    scree_lbvh_destroy(&tree);
}

/// Particles of very different size among two floors.
static const scree_test_boxes mixed = {.extent = 18, .smallest = 0.01, .largest = 5, .elongation = 50};

typedef struct crowd
{
    scree_box *boxes;
    scree_vec3 *centres;
    scree_real *radii;
    scree_lbvh floor;
    scree_broad_phase_wall walls[2];
    scree_broad_phase_input input;
} crowd;

static void make_crowd(crowd *c, int64_t num)
{
    uint64_t state = 3;
    c->boxes = scree_test_make_boxes(&mixed, num, &state);
    c->centres = scree_test_alloc(num, sizeof *c->centres);
    c->radii = scree_test_alloc(num, sizeof *c->radii);
    for (int64_t i = 0; i < num; ++i)
    {
        c->centres[i] = scree_morton_middle(c->boxes[i]);
        c->radii[i] = scree_vec3_length(scree_vec3_sub(c->boxes[i].upper, c->centres[i]));
    }
    c->floor = make_floor();
    c->walls[0] = (scree_broad_phase_wall){c->floor.view, make_pose(-6, -6, -2, 2), true};
    c->walls[1] = (scree_broad_phase_wall){c->floor.view, make_pose(-6, 0, 3, 2), true};
    c->input = (scree_broad_phase_input){.boxes = c->boxes,
                                         .centres = c->centres,
                                         .radii = c->radii,
                                         .walls = c->walls,
                                         .num_particles = num,
                                         .num_walls = 2};
}

static void destroy_crowd(crowd *c)
{
    free(c->boxes);
    free(c->centres);
    free(c->radii);
    scree_lbvh_destroy(&c->floor);
}

static void check_same(const scree_broad_phase *a, const scree_broad_phase *b, int64_t num_bodies)
{
    SCREE_CHECK_INT(a->num_pairs, b->num_pairs);
    if (a->num_pairs != b->num_pairs) return;
    const size_t num = (size_t)a->num_pairs;
    SCREE_CHECK(memcmp(a->pairs, b->pairs, num * sizeof *a->pairs) == 0);
    SCREE_CHECK(memcmp(a->row_begin, b->row_begin, (size_t)(num_bodies + 1) * sizeof *a->row_begin) == 0);
    SCREE_CHECK(memcmp(a->own_begin, b->own_begin, (size_t)(num_bodies + 1) * sizeof *a->own_begin) == 0);
    SCREE_CHECK(memcmp(a->row_pairs, b->row_pairs, num * sizeof *a->row_pairs) == 0);
}

static void test_same_bits_for_any_number_of_threads(void)
{
    crowd c;
    make_crowd(&c, 20000);
    scree_broad_phase found[3] = {0};
    const int num_threads[3] = {1, 2, 7};
    for (int t = 0; t < 3; ++t)
    {
        omp_set_num_threads(num_threads[t]);
        for (int repeat = 0; repeat < 3; ++repeat) // the first search of all grows the list and starts again
        {
            SCREE_CHECK(scree_broad_phase_find(found + t, &c.input) == SCREE_OK);
            check_same(found, found + t, 20002);
        }
    }
    check_valid(found, &c.input);
    SCREE_CHECK(found[0].num_pairs > 20000);
    for (int t = 0; t < 3; ++t) scree_broad_phase_destroy(found + t);
    destroy_crowd(&c);
}

/// The keys of the plain kernel in any order, sorted, are the pairs of the search by clusters.
static void test_plain_kernels_find_the_same(void)
{
    crowd c;
    make_crowd(&c, 4000);
    scree_broad_phase broad_phase = {0};
    SCREE_CHECK(scree_broad_phase_find(&broad_phase, &c.input) == SCREE_OK);
    scree_sort_buffers sort = {0};
    SCREE_CHECK(scree_sort_reserve(&sort, broad_phase.num_pairs, false) == SCREE_OK);
    for (int order = 0; order < SCREE_TEST_NUM_ORDERS; ++order)
    {
        int64_t num_keys = 0;
        const scree_pair_list list = {sort.keys, &num_keys, broad_phase.num_pairs, NULL, 13};
        const scree_particle_pairs_args particle_args = {broad_phase.tree.view, list, NULL, NULL};
        const scree_wall_pairs_args wall_args = {c.centres, c.radii, c.walls, 4000, 2, 1 + 20 * order, list};
        SCREE_LAUNCH_IN_ORDER(scree_particle_pairs, particle_args, 2 * 4000 - 1, order);
        SCREE_LAUNCH_IN_ORDER(scree_wall_pairs, wall_args, 4000 / wall_args.block_particles + 1, order);
        SCREE_CHECK_INT(num_keys, broad_phase.num_pairs);
        scree_sort(&sort, broad_phase.num_pairs, 0);
        int64_t num_wrong = 0;
        for (int64_t p = 0; p < broad_phase.num_pairs; ++p)
            num_wrong += sort.keys[p] != ((uint64_t)broad_phase.pairs[p].i << 13 | (uint64_t)broad_phase.pairs[p].j);
        SCREE_CHECK_INT(num_wrong, 0);
    }
    // a list that is too short counts on and does not write past its end
    int64_t num_keys = 0;
    sort.keys[100] = 12345;
    const scree_particle_pairs_args args = {broad_phase.tree.view, {sort.keys, &num_keys, 100, NULL, 13}, NULL, NULL};
    scree_particle_pairs_find(args);
    const int64_t num_found = num_keys;
    num_keys = 0;
    scree_particle_pairs_launch(args, 2 * 4000 - 1);
    SCREE_CHECK_INT(num_keys, num_found);
    SCREE_CHECK(num_found > 1000 && sort.keys[100] == 12345);
    scree_sort_destroy(&sort);
    scree_broad_phase_destroy(&broad_phase);
    destroy_crowd(&c);
}

/// Groups of 31 equal boxes and one beside them are subtrees of 32 leaves with 31 of them in the left half, so that
/// blocks of nodes begin deep within the left half of a cluster. Each cluster must still be searched once.
static void test_clusters_across_blocks(void)
{
    enum
    {
        NUM_GROUPS = 512,
        NUM = 32 * NUM_GROUPS
    };
    scree_box *boxes = scree_test_alloc(NUM, sizeof *boxes);
    for (int i = 0; i < NUM; ++i) boxes[i] = make_box(i / 32 + (i % 32 == 31 ? 0.4 : 0), 0, 0, 0.4);
    scree_lbvh tree = {0};
    SCREE_CHECK(scree_lbvh_build(&tree, boxes, NUM) == SCREE_OK);
    int64_t num_keys = 0;
    const scree_particle_pairs_args args = {tree.view, {NULL, &num_keys, 0, NULL, 15}, NULL, NULL}; // only counted
    scree_particle_pairs_find(args);
    // within a group all, and the last box of a group with all but the last of the next one: 1 - 0.4 < 2 0.4 < 1
    SCREE_CHECK_INT(num_keys, NUM_GROUPS * (32 * 31 / 2) + (NUM_GROUPS - 1) * 31);
    scree_lbvh_destroy(&tree);
    free(boxes);
}

/// Rows in any order of the kernels' indices.
static void test_rows_in_any_order(void)
{
    enum
    {
        NUM_PAIRS = 6,
        NUM_BODIES = 9
    };
    // bodies 0, 3 and 8 have no pairs
    const int32_t ids[NUM_PAIRS][2] = {{1, 4}, {1, 7}, {2, 4}, {4, 5}, {4, 7}, {6, 7}};
    const int32_t own_begin[NUM_BODIES + 1] = {0, 0, 2, 3, 3, 5, 5, 6, 6, 6};
    const int32_t row_begin[NUM_BODIES + 1] = {0, 0, 0, 0, 0, 2, 3, 3, 6, 6};
    const int32_t row_pairs[NUM_PAIRS] = {0, 2, 3, 1, 4, 5};
    uint64_t keys[NUM_PAIRS];
    for (int p = 0; p < NUM_PAIRS; ++p) keys[p] = (uint64_t)ids[p][0] << 4 | (uint64_t)ids[p][1];
    for (int order = 0; order < SCREE_TEST_NUM_ORDERS; ++order)
    {
        scree_sort_buffers sort = {0};
        SCREE_CHECK(scree_sort_reserve(&sort, NUM_PAIRS, false) == SCREE_OK);
        scree_candidate_pair pairs[NUM_PAIRS];
        int32_t found_own[NUM_BODIES + 1], found_begin[NUM_BODIES + 1], found_pairs[NUM_PAIRS];
        const scree_pair_rows_args args = {.keys = keys,
                                           .second_keys = sort.keys,
                                           .pairs = pairs,
                                           .own_begin = found_own,
                                           .row_begin = found_begin,
                                           .row_pairs = found_pairs,
                                           .num_pairs = NUM_PAIRS,
                                           .num_bodies = NUM_BODIES,
                                           .id_bits = 4};
        SCREE_LAUNCH_IN_ORDER(scree_pair_unpack, args, NUM_PAIRS, order);
        SCREE_LAUNCH_IN_ORDER(scree_pair_second_keys, args, NUM_PAIRS, order);
        scree_sort(&sort, NUM_PAIRS, 32);
        SCREE_LAUNCH_IN_ORDER(scree_pair_rows, args, NUM_PAIRS, order);
        SCREE_CHECK(memcmp(pairs, ids, sizeof pairs) == 0);
        SCREE_CHECK(memcmp(found_own, own_begin, sizeof own_begin) == 0);
        SCREE_CHECK(memcmp(found_begin, row_begin, sizeof row_begin) == 0);
        SCREE_CHECK(memcmp(found_pairs, row_pairs, sizeof row_pairs) == 0);
        scree_sort_destroy(&sort);
    }
}

/// What a check must not let pass.
static void test_validation_sees_faults(void)
{
    const scree_box boxes[4] = {make_box(0, 0, 0, 0.5), make_box(1, 0, 0, 0.5), make_box(2, 0, 0, 0.5),
                                make_box(3, 0, 0, 0.5)};
    const scree_box apart[4] = {make_box(0, 0, 0, 0.5), make_box(1, 0, 0, 0.5), make_box(2, 0, 0, 0.5),
                                make_box(9, 0, 0, 0.5)};
    const scree_broad_phase_input input = {.boxes = boxes, .num_particles = 4};
    const scree_broad_phase_input fewer = {.boxes = apart, .num_particles = 4}, other = {.boxes = boxes};
    for (int fault = 0; fault < 8; ++fault)
    {
        scree_broad_phase broad_phase = {0};
        SCREE_CHECK(scree_broad_phase_find(&broad_phase, fault == 0 ? &fewer : &input) == SCREE_OK);
        if (fault == 1) broad_phase.pairs[1] = broad_phase.pairs[0];
        if (fault == 2) broad_phase.pairs[0] = (scree_candidate_pair){1, 0};
        if (fault == 3) broad_phase.pairs[2].j = 4;
        if (fault == 4) broad_phase.row_pairs[1] = 2;
        if (fault == 5) broad_phase.row_begin[2] = 2;
        if (fault == 6) broad_phase.num_pairs = 2;
        scree_report report = {0};
        const scree_broad_phase_input *asked = fault == 7 ? &other : &input;
        SCREE_CHECK(!scree_broad_phase_validate(&broad_phase, asked, &report));
        SCREE_CHECK_INT(report.num_messages, 1);
        if (fault == 0 && report.num_messages == 1) SCREE_CHECK_CONTAINS(report.messages[0], "(2, 3) is missing");
        scree_report_clear(&report);
        // and the other way round: pairs that should not be there
        if (fault == 0) SCREE_CHECK(scree_broad_phase_find(&broad_phase, &input) == SCREE_OK);
        if (fault == 0) SCREE_CHECK(!scree_broad_phase_validate(&broad_phase, &fewer, NULL));
        scree_broad_phase_destroy(&broad_phase);
    }
    const scree_broad_phase never = {0};
    SCREE_CHECK(!scree_broad_phase_validate(&never, &input, NULL));
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HAS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HAS_SANITIZER 1
#endif
#endif

/// A refused search leaves the pairs of the last one, and the next one works.
static void test_refusals(void)
{
    crowd c;
    make_crowd(&c, 3000);
    scree_broad_phase broad_phase = {0}, reference = {0};
    SCREE_CHECK(scree_broad_phase_find(&broad_phase, &c.input) == SCREE_OK);
    SCREE_CHECK(scree_broad_phase_find(&reference, &c.input) == SCREE_OK);

    scree_broad_phase_input too_many = c.input;
    too_many.num_walls = INT32_MAX;
    SCREE_CHECK(scree_broad_phase_find(&broad_phase, &too_many) == SCREE_TOO_MANY);
    check_same(&broad_phase, &reference, 3002);
#ifndef HAS_SANITIZER
    // 10000 boxes that all overlap have 5e7 pairs: the tree fits into 300 MiB more than now, the pairs do not
    scree_box *boxes = scree_test_alloc(10000, sizeof *boxes);
    const scree_broad_phase_input dense = {.boxes = boxes, .num_particles = 10000};
    struct rlimit kept, limit;
    SCREE_CHECK(getrlimit(RLIMIT_AS, &kept) == 0);
    limit = kept;
    limit.rlim_cur = (rlim_t)600 << 20;
    SCREE_CHECK(setrlimit(RLIMIT_AS, &limit) == 0);
    SCREE_CHECK(scree_broad_phase_find(&broad_phase, &dense) == SCREE_OUT_OF_MEMORY);
    SCREE_CHECK(setrlimit(RLIMIT_AS, &kept) == 0);
    check_same(&broad_phase, &reference, 3002);
    free(boxes);
#endif
    SCREE_CHECK(scree_broad_phase_find(&broad_phase, &c.input) == SCREE_OK);
    check_same(&broad_phase, &reference, 3002);
    check_valid(&broad_phase, &c.input);
    scree_broad_phase_destroy(&broad_phase);
    scree_broad_phase_destroy(&reference);
    destroy_crowd(&c);
}

int main(void)
{
    omp_set_num_threads(1); // thousands of small searches; the last test asks for more
    SCREE_RUN(test_chain);
    SCREE_RUN(test_grids_and_sizes);
    SCREE_RUN(test_all_pairs);
    SCREE_RUN(test_largest_boxes);
    SCREE_RUN(test_walls);
    SCREE_RUN(test_nothing_to_find);
    SCREE_RUN(test_walls_are_rounded_outwards);
    SCREE_RUN(test_plain_kernels_find_the_same);
    SCREE_RUN(test_clusters_across_blocks);
    SCREE_RUN(test_rows_in_any_order);
    SCREE_RUN(test_validation_sees_faults);
    SCREE_RUN(test_refusals); // before further threads take their share of the address space
    SCREE_RUN(test_same_bits_for_any_number_of_threads);
    return SCREE_TEST_END();
}
