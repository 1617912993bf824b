// Overlap with a hollow body: a cube in the wall of a drum shares with it what it shares with the drum without its
// hole, less what it shares with the hole.
#include "contact/overlap.h"
#include "harness.h"
#include "polyhedra/generate.h"

#define PI 3.14159265358979323846
#define EPS ((double)SCREE_REAL_EPSILON)

static const scree_profile_point drum_profile[] = {{0, -0.12}, {0.16, -0.12}, {0.16, 0.12}, {0, 0.12},
                                                   {0, 0.1},   {0.15, 0.1},   {0.15, -0.1}, {0, -0.1}};
static const scree_profile_point outside_profile[] = {{0, -0.12}, {0.16, -0.12}, {0.16, 0.12}, {0, 0.12}};
static const scree_profile_point hole_profile[] = {{0, -0.1}, {0.15, -0.1}, {0.15, 0.1}, {0, 0.1}};

static void make(scree_shape *shape, const scree_profile_point *profile, int num)
{
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_turned(&mesh, profile, num, 40), SCREE_OK);
    SCREE_CHECK_INT(scree_shape_create(shape, &mesh, SCREE_FRAME_SOURCE), SCREE_OK);
    scree_mesh_destroy(&mesh);
}

static scree_overlap_result overlap(const scree_shape *a, const scree_pose *pose, const scree_shape *b,
                                    scree_overlap_workspace *workspace)
{
    const scree_pose still = {scree_vec3_zero(), scree_quat_identity(), 1};
    const scree_overlap_options options = {SCREE_OVERLAP_FILTERED, false, true};
    scree_overlap_result result = {0};
    for (;;)
    {
        scree_overlap_compute(&a->view, pose, &b->view, &still, &options, workspace, &result, 1);
        if (result.status != SCREE_OVERLAP_WORKSPACE_FULL) return result;
        if (scree_overlap_workspace_grow(workspace) != SCREE_OK) return result;
    }
}

static double random_between(uint64_t *state, double low, double high)
{
    return low + (high - low) * scree_test_random(state);
}

static scree_pose random_pose(uint64_t *state)
{
    // about the shell, an end plate or the corner of both, so that the cube sticks out into the hole
    const double angle = random_between(state, 0, 2 * PI), half = 0.02 * sqrt(3.0) / 2;
    const bool is_at_end = scree_test_random(state) < 0.5;
    const double radius = random_between(state, is_at_end ? 0 : 0.15 - half, 0.15);
    const double height = random_between(state, is_at_end ? 0.1 - half : -0.1, 0.1);
    scree_pose pose;
    pose.position =
        scree_vec3_make((scree_real)(radius * cos(angle)), (scree_real)(radius * sin(angle)), (scree_real)height);
    pose.orientation = scree_quat_normalize(
        scree_quat_make((scree_real)random_between(state, -1, 1), (scree_real)random_between(state, -1, 1),
                        (scree_real)random_between(state, -1, 1), (scree_real)random_between(state, -1, 1)));
    pose.scale = 1;
    return pose;
}

static void test_shell_is_outside_less_hole(void)
{
    const double size[3] = {0.02, 0.02, 0.02};
    scree_shape cube, drum, outside, hole;
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
    SCREE_CHECK_INT(scree_shape_create(&cube, &mesh, SCREE_FRAME_SOURCE), SCREE_OK);
    scree_mesh_destroy(&mesh);
    make(&drum, drum_profile, 8);
    make(&outside, outside_profile, 4);
    make(&hole, hole_profile, 4);
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    uint64_t state = 5;
    int num_touching = 0;
    double worst = 0;
    for (int n = 0; n < 2000; ++n)
    {
        const scree_pose pose = random_pose(&state);
        const scree_overlap_result shell = overlap(&cube, &pose, &drum, workspace);
        const double all = (double)overlap(&cube, &pose, &outside, workspace).volume;
        const double inner = (double)overlap(&cube, &pose, &hole, workspace).volume;
        // three volumes, each good to 10 eps L l^2
        const double tolerance = 30 * EPS * 0.4 * 0.02 * 0.02, error = fabs((double)shell.volume - (all - inner));
        if (!(error <= tolerance))
            printf("pose %d at (%.17g, %.17g, %.17g)\n", n, (double)pose.position.x, (double)pose.position.y,
                   (double)pose.position.z);
        SCREE_CHECK_CLOSE(shell.volume, all - inner, tolerance);
        worst = fmax(worst, error);
        num_touching += shell.status == SCREE_OVERLAP_TOUCHING;
    }
    printf("%d of 2000 touch, worst error %.2g of eps L l^2\n", num_touching, worst / (EPS * 0.4 * 0.02 * 0.02));
    SCREE_CHECK(num_touching > 1000);
    scree_overlap_workspace_destroy(workspace);
    scree_shape_destroy(&cube);
    scree_shape_destroy(&drum);
    scree_shape_destroy(&outside);
    scree_shape_destroy(&hole);
}

int main(void)
{
    SCREE_RUN(test_shell_is_outside_less_hole);
    return SCREE_TEST_END();
}
