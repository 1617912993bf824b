// Overlap against closed forms, in both schemes: shifted cubes, a body with itself, nested, stacked and swapped bodies.
#include "contact/overlap.h"

#include "harness.h"
#include "polyhedra/generate.h"

#include <float.h>

static scree_shape cube, schoenhardt;

static scree_pose pose_at(double x, double y, double z, double scale)
{
    scree_pose pose;
    pose.position = scree_vec3_make((scree_real)x, (scree_real)y, (scree_real)z);
    pose.orientation = scree_quat_identity();
    pose.scale = (scree_real)scale;
    return pose;
}

static scree_overlap_result overlap(const scree_shape *a, scree_pose pose_a, const scree_shape *b, scree_pose pose_b,
                                    scree_overlap_scheme scheme)
{
    const scree_overlap_options options = {scheme, false, false};
    scree_overlap_result result = {0};
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    SCREE_CHECK(workspace != NULL);
    if (workspace == NULL) return result;
    SCREE_CHECK_INT(scree_overlap_compute(&a->view, &pose_a, &b->view, &pose_b, &options, workspace, &result, 1), 1);
    scree_overlap_workspace_destroy(workspace);
    return result;
}

/// Unit cubes shifted by less than their size share a box; the bound is 10 eps L l^2 with L = l = 1.
static void test_shifted_cubes(void)
{
    uint64_t state = 7;
    for (int i = 0; i < 200; ++i)
    {
        double shift[3], side[3];
        for (int k = 0; k < 3; ++k)
        {
            shift[k] = 1.8 * scree_test_random(&state) - 0.9;
            side[k] = 1 - fabs(shift[k]);
        }
        const scree_pose a = pose_at(0, 0, 0, 1);
        const scree_pose b = pose_at(shift[0], shift[1], shift[2], 1);
        const scree_overlap_result r =
            overlap(&cube, a, &cube, b, i % 2 ? SCREE_OVERLAP_FILTERED : SCREE_OVERLAP_HIERARCHY);
        SCREE_CHECK_INT(r.status, SCREE_OVERLAP_TOUCHING);
        SCREE_CHECK_CLOSE(r.volume, side[0] * side[1] * side[2], 10 * DBL_EPSILON);
        SCREE_CHECK_CLOSE(r.area_vector.x, copysign(side[1] * side[2], shift[0]), 10 * DBL_EPSILON);
        SCREE_CHECK_CLOSE(r.area_vector.y, copysign(side[2] * side[0], shift[1]), 10 * DBL_EPSILON);
        SCREE_CHECK_CLOSE(r.area_vector.z, copysign(side[0] * side[1], shift[2]), 10 * DBL_EPSILON);
        const scree_overlap_result swapped = overlap(&cube, b, &cube, a, SCREE_OVERLAP_FILTERED);
        SCREE_CHECK_CLOSE(swapped.volume, r.volume, 10 * DBL_EPSILON);
        SCREE_CHECK_CLOSE(swapped.normal.x, -r.normal.x, 1e-12);
    }
}

/// V(A, A) = V(A), exactly coincident as the surfaces are.
static void test_same_body(void)
{
    const scree_pose pose = pose_at(0, 0, 0, 1);
    for (int scheme = 0; scheme < 2; ++scheme)
    {
        const scree_overlap_result r = overlap(&schoenhardt, pose, &schoenhardt, pose, (scree_overlap_scheme)scheme);
        SCREE_CHECK_CLOSE(r.volume, schoenhardt.properties.volume, 10 * DBL_EPSILON * 8);
    }
}

static void test_nested_and_stacked(void)
{
    for (int scheme = 0; scheme < 2; ++scheme)
    {
        const scree_overlap_result nested =
            overlap(&cube, pose_at(0, 0, 0, 1), &cube, pose_at(0.1, 0.2, 0.1, 0.25), (scree_overlap_scheme)scheme);
        SCREE_CHECK_INT(nested.status, SCREE_OVERLAP_NO_NORMAL);
        SCREE_CHECK_CLOSE(nested.volume, 1.0 / 64, 10 * DBL_EPSILON);
        const scree_overlap_result stacked =
            overlap(&cube, pose_at(0, 0, 0, 1), &cube, pose_at(0, 0, 1, 1), (scree_overlap_scheme)scheme);
        SCREE_CHECK(stacked.status != SCREE_OVERLAP_TOUCHING);
        SCREE_CHECK_CLOSE(stacked.volume, 0, 10 * DBL_EPSILON);
    }
}

int main(void)
{
    const double size[3] = {1, 1, 1};
    scree_mesh mesh = {0};
    SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
    SCREE_CHECK_INT(scree_shape_create(&cube, &mesh, SCREE_FRAME_SOURCE), SCREE_OK);
    scree_mesh_destroy(&mesh);
    SCREE_CHECK_INT(scree_generate_schoenhardt(&mesh, 1), SCREE_OK);
    SCREE_CHECK_INT(scree_shape_create(&schoenhardt, &mesh, SCREE_FRAME_SOURCE), SCREE_OK);
    scree_mesh_destroy(&mesh);
    SCREE_RUN(test_shifted_cubes);
    SCREE_RUN(test_same_body);
    SCREE_RUN(test_nested_and_stacked);
    scree_shape_destroy(&cube);
    scree_shape_destroy(&schoenhardt);
    return SCREE_TEST_END();
}
