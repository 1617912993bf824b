// The contacts of spheres and clumps with meshes that are found in lanes are those that the kernels find one by one.
#include "contact/sphere_pairs.h"
#include "harness.h"
#include "mesh_tools.h"
#include "polyhedra/generate.h"

#include <string.h>

enum
{
    NUM_BODIES = 1500, ///< spheres and clumps; then come the two meshes
    NUM_PAIRS = 2 * NUM_BODIES,
    MAX_FOUND = 2 ///< fewer than some clumps have
};

static scree_shape ball, disc;
static const scree_sphere spheres_of_clump[3] = {{{0, 0, 0}, (scree_real)0.1},
                                                 {{(scree_real)0.1, 0, 0}, (scree_real)0.05},
                                                 {{0, (scree_real)-0.1, 0}, (scree_real)0.07}};
static scree_shape_view shapes[4]; ///< sphere, clump, ball and disc of triangles
static int32_t shape[NUM_BODIES + 2], batch[NUM_PAIRS];
static scree_pose pose[NUM_BODIES + 2];
static scree_candidate_pair pairs[NUM_PAIRS];
static scree_near_nodes near_nodes[NUM_PAIRS];

static void make_shapes(void)
{
    const scree_profile_point profile[] = {{0, -0.1}, {2, -0.1}, {2, 0}, {0, 0}};
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_sphere(&mesh, 0.5, 320), SCREE_OK);
    SCREE_CHECK_INT(scree_shape_create(&ball, &mesh, SCREE_FRAME_SOURCE), SCREE_OK);
    scree_mesh_destroy(&mesh);
    SCREE_CHECK_INT(scree_generate_turned(&mesh, profile, 4, 60), SCREE_OK);
    SCREE_CHECK_INT(scree_shape_create(&disc, &mesh, SCREE_FRAME_SOURCE), SCREE_OK);
    scree_mesh_destroy(&mesh);
    shapes[0].kind = SCREE_KIND_SPHERE;
    shapes[0].num_spheres = 1;
    shapes[0].bounding_radius = (scree_real)0.1;
    shapes[1].kind = SCREE_KIND_CLUMP;
    shapes[1].num_spheres = 3;
    shapes[1].spheres = spheres_of_clump;
    shapes[1].bounding_radius = (scree_real)0.18;
    shapes[2] = ball.view;
    shapes[3] = disc.view;
}

/// A ball of triangles stands on a disc.
static void place_bodies(void)
{
    uint64_t state = 3;
    for (int32_t i = 0; i < NUM_BODIES; ++i)
    {
        shape[i] = i % 3 == 0 ? 1 : 0;
        // near the ball's surface, or above the disc
        const double x = 2 * scree_test_random(&state) - 1, y = 2 * scree_test_random(&state) - 1;
        const double z = 2 * scree_test_random(&state) - 1, length = sqrt(x * x + y * y + z * z);
        const double away = (0.35 + 0.3 * scree_test_random(&state)) / length;
        pose[i].position =
            i % 2 == 0 ? scree_vec3_make((scree_real)(away * x), (scree_real)(away * y), (scree_real)(0.5 + away * z))
                       : scree_vec3_make((scree_real)x, (scree_real)y, (scree_real)(0.15 * z + 0.05));
        const double c = 2 * scree_test_random(&state) - 1;
        pose[i].orientation.w = (scree_real)c;
        pose[i].orientation.y = (scree_real)sqrt(1 - c * c);
        pose[i].scale = (scree_real)(0.2 + 0.8 * scree_test_random(&state));
        for (int32_t m = 0; m < 2; ++m)
        {
            const int32_t p = 2 * i + m;
            pairs[p].i = i;
            pairs[p].j = NUM_BODIES + m;
            batch[p] = p;
        }
    }
    for (int32_t m = 0; m < 2; ++m)
    {
        shape[NUM_BODIES + m] = 2 + m;
        pose[NUM_BODIES + m].orientation.w = 1;
        pose[NUM_BODIES + m].scale = 1;
    }
    pose[NUM_BODIES].position.z = (scree_real)0.5;
}

typedef struct found_contacts
{
    int32_t num[NUM_PAIRS + 1];
    scree_sphere_contact found[NUM_PAIRS * MAX_FOUND];
    scree_pair_tally tally;
} found_contacts;

static found_contacts in_lanes, one_by_one;

static scree_sphere_pairs_args args_for(found_contacts *to)
{
    scree_sphere_pairs_args args;
    memset(&args, 0, sizeof args);
    memset(to, 0, sizeof *to);
    args.shapes = shapes;
    args.shape = shape;
    args.pose = pose;
    args.pairs = pairs;
    args.batch = batch;
    args.list.first_of_pair = to->num;
    args.near = near_nodes;
    args.found = to->found;
    args.max_found = MAX_FOUND;
    args.tally = &to->tally;
    return args;
}

/// `reach` 0: nothing is known of what is near.
static void check_reach(double reach)
{
    scree_sphere_pairs_args args = args_for(&in_lanes);
    args.reach = (scree_real)reach;
    scree_sphere_mesh_near_launch(args, NUM_PAIRS);
    scree_sphere_mesh_count_launch(args, NUM_PAIRS);
    args = args_for(&one_by_one);
    for (int64_t b = 0; b < NUM_PAIRS; ++b) scree_sphere_mesh_count_at(args, b);
    int num_different = 0, num_touching = 0, num_listed[2] = {0, 0};
    for (int64_t p = 0; p < NUM_PAIRS; ++p)
    {
        const int32_t num = one_by_one.num[p];
        num_touching += num > 0;
        if (near_nodes[p].num > 0)
            ++num_listed[shapes[shape[pairs[p].j]].tree.nodes[near_nodes[p].node[0]].first_child < 0];
        // of a pair that lacks room nothing is of use
        const size_t size = num <= MAX_FOUND ? (size_t)num * sizeof *in_lanes.found : 0;
        num_different += in_lanes.num[p] != num ||
                         memcmp(in_lanes.found + p * MAX_FOUND, one_by_one.found + p * MAX_FOUND, size) != 0;
    }
    SCREE_CHECK_INT(num_different, 0);
    SCREE_CHECK(memcmp(&in_lanes.tally, &one_by_one.tally, sizeof in_lanes.tally) == 0);
    const int most = (int)scree_maximum_value(in_lanes.tally.most_found);
    printf("%d pairs touch, %d with centres inside, up to %d contacts; %d pairs with lists, %d with trees\n",
           num_touching, (int)in_lanes.tally.num_inside, most, num_listed[1], num_listed[0]);
    SCREE_CHECK(num_touching > 500 && in_lanes.tally.num_inside > 50 && most > MAX_FOUND && num_listed[0] > 50);
    SCREE_CHECK(reach > 0 ? num_listed[1] > 500 : num_listed[1] == 0);
}

static void test_lanes(void)
{
    make_shapes();
    place_bodies();
    check_reach(0.01);
    const found_contacts with_lists = in_lanes;
    check_reach(0);
    // which changes nothing
    SCREE_CHECK(memcmp(with_lists.num, in_lanes.num, sizeof in_lanes.num) == 0);
    scree_shape_destroy(&ball);
    scree_shape_destroy(&disc);
}

int main(void)
{
    SCREE_RUN(test_lanes);
    return SCREE_TEST_END();
}
