/// Overlaps by teams of 1, 8, 16 and 32 lanes: each gives the bytes of the library on the CPU. Shapes small and with a
/// tree, convex and not, of unlike size; both schemes; with patches; with too little room.
extern "C"
{
#include "contact/overlap_kernel.h"
#include "harness.h"
#include "polyhedra/generate.h"
}
#include "core/launch_cuda.cuh"
#include "two_sides.cuh"

#include <cstddef>

enum
{
    MAX_RESULTS = 3,
    NUM_SHAPES = 5,
    NUM_POSES = 2 ///< of each pair of shapes
};

typedef struct overlap_teams_args
{
    const scree_shape_view *shapes;
    const scree_pose *poses;       ///< (num, 2)
    const int32_t *shape;          ///< (num, 2)
    scree_overlap_slice *slices;   ///< (num)
    scree_overlap_result *results; ///< (num, MAX_RESULTS)
    int32_t *num_results;          ///< (num)
    scree_overlap_options options;
    int32_t num_lanes;
} overlap_teams_args;

SCREE_FN void overlap_teams_team_at(overlap_teams_args a, const scree_team *team, int64_t i)
{
    scree_overlap_pair pair;
    for (int32_t side = 0; side < 2; ++side)
    {
        pair.shape[side] = a.shapes + a.shape[2 * i + side];
        pair.pose[side] = a.poses + 2 * i + side;
    }
    const int32_t num =
        scree_overlap_team_compute(team, &pair, &a.options, a.slices + i, a.results + MAX_RESULTS * i, MAX_RESULTS);
    if (scree_team_leads(team)) a.num_results[i] = num;
}

SCREE_DEFINE_TEAM_LAUNCH(overlap_teams)

// ---- what is computed

static scree_shape shapes[NUM_SHAPES];
static std::vector<scree_pose> poses;
static std::vector<int32_t> shape_of;

static void make_shape(scree_shape *shape, scree_status status, scree_mesh *mesh)
{
    SCREE_CHECK_INT(status, SCREE_OK);
    SCREE_CHECK_INT(scree_shape_create(shape, mesh, SCREE_FRAME_PRINCIPAL), SCREE_OK);
    scree_mesh_destroy(mesh);
}

static void make_shapes()
{
    const double sides[3] = {1.0, 0.8, 1.1};
    scree_mesh mesh = {};
    make_shape(shapes, scree_generate_rock(&mesh, 1, 40, 0), &mesh);
    make_shape(shapes + 1, scree_generate_rock(&mesh, 1, 300, 0), &mesh);
    make_shape(shapes + 2, scree_generate_box(&mesh, sides), &mesh);
    make_shape(shapes + 3, scree_generate_sphere(&mesh, 1, 84), &mesh);
    make_shape(shapes + 4, scree_generate_schoenhardt(&mesh, 1), &mesh);
}

static scree_quat random_orientation(uint64_t *state)
{
    double q[4];
    for (double &x : q) x = 2 * scree_test_random(state) - 1;
    return scree_quat_normalize(
        scree_quat_make((scree_real)q[0], (scree_real)q[1], (scree_real)q[2], (scree_real)q[3]));
}

/// From just apart to deep in each other; every third pair without turning, so that faces are in one plane.
static void make_poses()
{
    uint64_t state = 77;
    for (int k = 0; k < NUM_SHAPES * NUM_SHAPES * NUM_POSES; ++k)
    {
        const int a = k % NUM_SHAPES, b = k / NUM_SHAPES % NUM_SHAPES;
        scree_pose pose[2];
        for (int side = 0; side < 2; ++side)
        {
            pose[side].position = scree_vec3_make((scree_real)0.25, (scree_real)-0.5, 1);
            pose[side].orientation = k % 3 == 0 ? scree_quat_identity() : random_orientation(&state);
            pose[side].scale = k % 5 == 4 && side == 1 ? (scree_real)0.25 : 1;
        }
        const double reach = (double)(shapes[a].view.box.upper.x - shapes[b].view.box.lower.x * pose[1].scale);
        pose[1].position.x += (scree_real)(reach * (1.02 - 0.6 * scree_test_random(&state)));
        poses.push_back(pose[0]);
        poses.push_back(pose[1]);
        shape_of.push_back(a);
        shape_of.push_back(b);
    }
}

// ---- on either side

static const scree_shape_view *shapes_on(side &where)
{
    scree_shape_view views[NUM_SHAPES];
    for (int k = 0; k < NUM_SHAPES; ++k)
    {
        scree_shape_view &view = views[k] = shapes[k].view;
        view.vertices = where.copy(view.vertices, view.num_vertices);
        view.triangles = where.copy(view.triangles, view.num_triangles);
        view.neighbours = where.copy(view.neighbours, 3 * (int64_t)view.num_triangles);
        view.normals = where.copy(view.normals, view.num_triangles);
        view.tree.nodes = where.copy(view.tree.nodes, 2 * (int64_t)view.tree.num_leaves - 1);
        if (view.flat_faces != nullptr) view.flat_faces = where.copy(view.flat_faces, view.num_triangles);
        scree_wide_tree_view &wide = view.wide_tree;
        if (wide.nodes == nullptr) continue;
        wide.nodes = where.copy(wide.nodes, wide.first_node[wide.num_levels - 1] + 1);
        wide.items = where.copy(wide.items, wide.num_items);
        wide.corners = where.copy(wide.corners, (wide.num_items + SCREE_WIDE_CHILDREN - 1) / SCREE_WIDE_CHILDREN);
        view.support_map = where.copy(view.support_map, SCREE_SUPPORT_VALUES);
    }
    return where.copy(views, NUM_SHAPES);
}

static scree_overlap_slice slice_on(side &where, int32_t max_pieces, int32_t max_crossings)
{
    scree_overlap_slice slice = {};
    for (int k = 0; k < 2; ++k)
    {
        scree_overlap_body *body = slice.body + k;
        body->vertices = where.zeros<scree_overlap_vertex>(max_pieces);
        body->kept = where.zeros<scree_kept_triangle>(max_pieces);
        body->triangles = where.zeros<scree_overlap_triangle>(max_pieces);
        body->triangle_boxes = where.zeros<scree_box>(max_pieces);
        body->links = where.zeros<scree_overlap_link>(2 * max_pieces);
        body->max_shape_vertices = body->max_shape_triangles = 512;
        body->vertex_slot = where.zeros<int32_t>(512);
        body->triangle_slot = where.zeros<int32_t>(512);
        body->max_vertices = body->max_triangles = max_pieces;
    }
    slice.crossings = where.zeros<scree_overlap_crossing>(max_crossings);
    slice.segments = where.zeros<scree_overlap_segment>(max_crossings);
    slice.max_crossings = max_crossings;
    slice.max_corners = max_crossings + 2 * max_pieces;
    slice.corners = where.zeros<scree_vec3>(slice.max_corners);
    return slice;
}

struct plan
{
    scree_overlap_options options;
    int32_t max_pieces, max_crossings;
};

/// Every field of what is written of results, for there are gaps between them; how many are of some status.
static void keep_results(side &where, const overlap_teams_args &args, int64_t num, int *num_of_status)
{
    const std::vector<scree_overlap_result> results = where.read(args.results, MAX_RESULTS * num);
    const std::vector<int32_t> num_results = where.read(args.num_results, num);
    where.keep(args.num_results, num);
    for (int64_t i = 0; i < num; ++i)
    {
        ++num_of_status[results[(size_t)(MAX_RESULTS * i)].status];
        for (int32_t k = 0; k < num_results[(size_t)i] && k < MAX_RESULTS; ++k)
        {
            const scree_overlap_result &r = results[(size_t)(MAX_RESULTS * i + k)];
            const int32_t marks[2] = {(int32_t)r.status, r.used_fallback};
            const unsigned char *bytes = reinterpret_cast<const unsigned char *>(&r);
            where.outcome.insert(where.outcome.end(), bytes, bytes + offsetof(scree_overlap_result, status));
            bytes = reinterpret_cast<const unsigned char *>(marks);
            where.outcome.insert(where.outcome.end(), bytes, bytes + sizeof marks);
        }
    }
}

static void compute_on(side &where, const plan &plan, int32_t num_lanes, int *num_of_status)
{
    const int64_t num = (int64_t)shape_of.size() / 2;
    std::vector<scree_overlap_slice> slices;
    for (int64_t i = 0; i < num; ++i) slices.push_back(slice_on(where, plan.max_pieces, plan.max_crossings));
    overlap_teams_args args = {};
    args.shapes = shapes_on(where);
    args.poses = where.copy(poses.data(), 2 * num);
    args.shape = where.copy(shape_of.data(), 2 * num);
    args.slices = where.copy(slices.data(), num);
    args.results = where.make<scree_overlap_result>(MAX_RESULTS * num);
    args.num_results = where.make<int32_t>(num);
    args.options = plan.options;
    args.num_lanes = num_lanes;
    const scree_team alone = scree_team_alone();
    if (where.is_device) overlap_teams_launch_cuda(where.device, args, num);
    else
        for (int64_t i = 0; i < num; ++i) overlap_teams_team_at(args, &alone, i);
    keep_results(where, args, num, num_of_status);
}

/// Host: the library itself. It has no teams, so its results are those of one lane.
static void compare_with_library(const plan &plan)
{
    side host(false);
    int num_of_status[8] = {};
    compute_on(host, plan, 1, num_of_status);
    std::vector<unsigned char> expected;
    std::vector<int32_t> nums;
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    std::vector<scree_overlap_result> kept;
    for (size_t i = 0; i < shape_of.size() / 2; ++i)
    {
        scree_overlap_result results[MAX_RESULTS];
        const int32_t num =
            scree_overlap_compute(&shapes[shape_of[2 * i]].view, &poses[2 * i], &shapes[shape_of[2 * i + 1]].view,
                                  &poses[2 * i + 1], &plan.options, workspace, results, MAX_RESULTS);
        nums.push_back(num);
        for (int32_t k = 0; k < num && k < MAX_RESULTS; ++k) kept.push_back(results[k]);
    }
    scree_overlap_workspace_destroy(workspace);
    const unsigned char *bytes = reinterpret_cast<const unsigned char *>(nums.data());
    expected.insert(expected.end(), bytes, bytes + nums.size() * sizeof nums[0]);
    for (const scree_overlap_result &r : kept)
    {
        const int32_t marks[2] = {(int32_t)r.status, r.used_fallback};
        bytes = reinterpret_cast<const unsigned char *>(&r);
        expected.insert(expected.end(), bytes, bytes + offsetof(scree_overlap_result, status));
        bytes = reinterpret_cast<const unsigned char *>(marks);
        expected.insert(expected.end(), bytes, bytes + sizeof marks);
    }
    SCREE_CHECK(host.outcome == expected);
}

static void check_teams(const plan &plan, scree_overlap_status wanted)
{
    side host(false);
    int num_of_status[8] = {};
    compute_on(host, plan, 1, num_of_status);
    SCREE_CHECK(num_of_status[wanted] > 10);
    for (const int32_t num_lanes : {1, 8, 16, 32})
    {
        side device(true, num_lanes == 16 ? 32 : 128);
        compute_on(device, plan, num_lanes, num_of_status);
        SCREE_CHECK(device.outcome == host.outcome);
    }
}

static void test_general() { check_teams({{SCREE_OVERLAP_FILTERED, false, false}, 320, 400}, SCREE_OVERLAP_TOUCHING); }
static void test_convex() { check_teams({{SCREE_OVERLAP_FILTERED, false, true}, 320, 400}, SCREE_OVERLAP_TOUCHING); }
static void test_hierarchy()
{
    check_teams({{SCREE_OVERLAP_HIERARCHY, false, false}, 320, 400}, SCREE_OVERLAP_TOUCHING);
}
static void test_patches() { check_teams({{SCREE_OVERLAP_FILTERED, true, false}, 320, 400}, SCREE_OVERLAP_TOUCHING); }
static void test_little_room()
{
    check_teams({{SCREE_OVERLAP_FILTERED, false, true}, 320, 4}, SCREE_OVERLAP_WORKSPACE_FULL);
    check_teams({{SCREE_OVERLAP_FILTERED, false, false}, 40, 400}, SCREE_OVERLAP_WORKSPACE_FULL);
}
static void test_library()
{
    compare_with_library({{SCREE_OVERLAP_FILTERED, false, true}, 320, 400});
    compare_with_library({{SCREE_OVERLAP_FILTERED, true, false}, 320, 400});
}

int main()
{
    if (is_without_device()) return SKIPPED;
    make_shapes();
    make_poses();
    SCREE_RUN(test_general);
    SCREE_RUN(test_convex);
    SCREE_RUN(test_hierarchy);
    SCREE_RUN(test_patches);
    SCREE_RUN(test_little_room);
    SCREE_RUN(test_library);
    for (scree_shape &shape : shapes) scree_shape_destroy(&shape);
    return SCREE_TEST_END();
}
