/// Direction of an overlap: never one along which the bodies overlap more than along the line of centres, and much
/// less where the two differ.
#include "contact/overlap_direction_kernel.h"
#include "polyhedra/generate.h"

#include "harness.h"
#include "mesh_tools.h"

/// Depth of the overlap of the extents along a direction, in the body frame of A, over all vertices.
static double depth_along(const scree_shape *a, const scree_shape *b, const scree_relative_pose *pose, scree_vec3 d)
{
    double most = -1e300, least = 1e300;
    for (int32_t v = 0; v < a->view.num_vertices; ++v)
        most = fmax(most, (double)scree_vec3_dot(d, a->view.vertices[v]));
    for (int32_t v = 0; v < b->view.num_vertices; ++v)
        least = fmin(least,
                     (double)scree_vec3_dot(d, scree_affine(&pose->rotation, b->view.vertices[v], pose->translation)));
    return (most - least) / (double)scree_vec3_length(d);
}

/// A ball of a radius stretched along the axes; its own frame may be turned against them.
static void make_ellipsoid(scree_shape *shape, double x, double y, double z)
{
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_sphere(&mesh, 1, 500), SCREE_OK);
    scree_test_mesh_scale(&mesh, x, y, z);
    SCREE_CHECK_INT(scree_shape_create(shape, &mesh, SCREE_FRAME_SOURCE), SCREE_OK);
    scree_mesh_destroy(&mesh);
}

static scree_quat random_quat(uint64_t *state)
{
    double q[4];
    for (int k = 0; k < 4; ++k) q[k] = 2 * scree_test_random(state) - 1;
    return scree_quat_normalize(
        scree_quat_make((scree_real)q[0], (scree_real)q[1], (scree_real)q[2], (scree_real)q[3]));
}

/// The tables exceed the extents by interpolation over cells of width w = 1/8: w^2/8 (h_uu + h_vv), where the second
/// slopes are radii of curvature, at most 1/0.4 here, and up to sqrt(3) for directions that are not along an axis. The
/// depth that was taken to be the least may be so by that much of each body.
static void test_not_deeper(void)
{
    const double excess = 2 * sqrt(3.0) / (8 * 64) * 2 / 0.4;
    scree_shape shape;
    make_ellipsoid(&shape, 1, 0.6, 0.4);
    uint64_t state = 5;
    int num_better = 0;
    for (int n = 0; n < 2000; ++n)
    {
        scree_relative_pose pose;
        pose.rotation = scree_mat3_from_quat(random_quat(&state));
        for (;;)
        {
            double t[3];
            for (int k = 0; k < 3; ++k) t[k] = 3 * scree_test_random(&state) - 1.5;
            pose.translation = scree_vec3_make((scree_real)t[0], (scree_real)t[1], (scree_real)t[2]);
            if (depth_along(&shape, &shape, &pose, pose.translation) > 0.01) break;
        }
        const scree_vec3 found = scree_overlap_direction(&shape.view, &shape.view, &pose);
        const double before = depth_along(&shape, &shape, &pose, pose.translation);
        const double after = depth_along(&shape, &shape, &pose, found);
        SCREE_CHECK(after <= before + excess);
        num_better += after < 0.9 * before;
    }
    // a body two and a half times as long as it is thick does not touch along the line of centres as a rule
    SCREE_CHECK(num_better > 1000);
    scree_shape_destroy(&shape);
}

/// Two bars side by side, shifted along each other: the line of centres is 45 degrees off.
static void test_bars(void)
{
    scree_shape bar;
    make_ellipsoid(&bar, 1, 0.3, 0.3);
    scree_relative_pose pose;
    pose.rotation = scree_mat3_from_quat(scree_quat_make(1, 0, 0, 0));
    pose.translation = scree_vec3_make((scree_real)0.5, (scree_real)0.5, 0);
    const scree_vec3 found = scree_overlap_direction(&bar.view, &bar.view, &pose);
    // of equal ellipsoids the depth along (m, n) is (2 sqrt(m^2 + 0.09 n^2) - (m + n)/2)/sqrt(m^2 + n^2)
    double least = 1e300;
    for (int k = 0; k <= 9000; ++k)
    {
        const double angle = k * 1.5707963267948966 / 9000, m = cos(angle), n = sin(angle);
        least = fmin(least, 2 * sqrt(m * m + 0.09 * n * n) - (m + n) / 2);
    }
    // a few steps go at least four fifths of the way from the line of centres to the least depth
    const double straight = depth_along(&bar, &bar, &pose, pose.translation);
    const double after = depth_along(&bar, &bar, &pose, found);
    SCREE_CHECK(straight > 8 * least);
    SCREE_CHECK(after - least < (straight - least) / 5);
    scree_shape_destroy(&bar);
}

/// Concentric bodies have no line of centres and no direction.
static void test_same_centre(void)
{
    scree_shape shape;
    make_ellipsoid(&shape, 1, 1, 1);
    scree_relative_pose pose;
    pose.rotation = scree_mat3_from_quat(scree_quat_make(1, 0, 0, 0));
    pose.translation = scree_vec3_zero();
    const scree_vec3 found = scree_overlap_direction(&shape.view, &shape.view, &pose);
    SCREE_CHECK(found.x == found.x && found.y == found.y && found.z == found.z);
    scree_shape_destroy(&shape);
}

int main(void)
{
    SCREE_RUN(test_not_deeper);
    SCREE_RUN(test_bars);
    SCREE_RUN(test_same_centre);
    return SCREE_TEST_END();
}
