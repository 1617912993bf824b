// Overlap against closed forms, in both schemes: shifted cubes, a body with itself, nested, stacked and swapped bodies;
// the convex path on flat faces of many triangles.
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

/// The unit cube with n x n squares of two triangles on each side, so that vertices lie inside flat faces.
static void make_tiled_cube(scree_mesh *mesh, int n)
{
    SCREE_CHECK_INT(scree_mesh_create(mesh, 6 * n * n + 2, 12 * n * n), SCREE_OK);
    int32_t index[5][5][5], num_vertices = 0, num_triangles = 0;
    for (int place = 0; place < 125; ++place)
    {
        const int p[3] = {place / 25, place / 5 % 5, place % 5};
        bool is_outer = false;
        for (int axis = 0; axis < 3; ++axis) is_outer |= p[axis] == 0 || p[axis] == n;
        if (p[0] > n || p[1] > n || p[2] > n || !is_outer) continue;
        index[p[0]][p[1]][p[2]] = num_vertices;
        mesh->vertices[num_vertices++] =
            scree_vec3_make((scree_real)p[0] / n - (scree_real)0.5, (scree_real)p[1] / n - (scree_real)0.5,
                            (scree_real)p[2] / n - (scree_real)0.5);
    }
    for (int square = 0; square < 6 * n * n; ++square)
    {
        const int axis = square % 3, is_upper = square / 3 % 2, i = square / 6 % n, j = square / (6 * n);
        static const int step[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        int32_t corner[4];
        for (int c = 0; c < 4; ++c)
        {
            int p[3];
            p[axis] = is_upper * n;
            p[(axis + 1) % 3] = i + step[c][0];
            p[(axis + 2) % 3] = j + step[c][1];
            corner[c] = index[p[0]][p[1]][p[2]];
        }
        for (int half = 1; half < 3; ++half)
        {
            int32_t *v = mesh->triangles[num_triangles++].v;
            v[0] = corner[0];
            v[1] = corner[is_upper ? half : half + 1];
            v[2] = corner[is_upper ? half + 1 : half];
        }
    }
}

static double uniform(void)
{
    static uint64_t state = 5;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 11) * 0x1p-53;
}

static scree_pose random_pose(double spread)
{
    scree_real x[7];
    for (int k = 0; k < 7; ++k) x[k] = (scree_real)((uniform() - 0.5) * (k < 3 ? 2 * spread : 1));
    const scree_quat q = scree_quat_normalize(scree_quat_make(x[3], x[4], x[5], x[6]));
    const scree_pose pose = {{x[0], x[1], x[2]}, q, (scree_real)(0.3 + uniform())};
    return pose;
}

/// Tiled cubes by the convex path, merged and by patches, against plain ones by the general path: the same body, one
/// piece, whatever lies inside its flat faces.
static void test_flat_faces(void)
{
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    int num_touching = 0;
    for (int n = 1; n <= 4; ++n)
    {
        scree_mesh mesh = {0};
        scree_shape tiled = {0};
        make_tiled_cube(&mesh, n);
        SCREE_CHECK_INT(scree_shape_create(&tiled, &mesh, SCREE_FRAME_SOURCE), SCREE_OK);
        scree_mesh_destroy(&mesh);
        SCREE_CHECK(tiled.view.is_convex && tiled.view.flat_faces != NULL);
        for (int i = 0; i < 300; ++i)
        {
            const scree_pose a = random_pose(0), b = random_pose(1);
            const scree_overlap_result plain = overlap(&cube, a, &cube, b, SCREE_OVERLAP_FILTERED);
            for (int has_patches = 0; has_patches < 2; ++has_patches)
            {
                const scree_overlap_options options = {SCREE_OVERLAP_FILTERED, has_patches == 1, true};
                scree_overlap_result r[4];
                SCREE_CHECK_INT(scree_overlap_compute(&tiled.view, &a, &tiled.view, &b, &options, workspace, r, 4), 1);
                SCREE_CHECK_INT(r[0].status, plain.status);
                // ten units of eps L l^2, the diagonal of the largest cube
                SCREE_CHECK_CLOSE(r[0].volume, plain.volume, 10 * (double)SCREE_REAL_EPSILON * 3 * sqrt(3) * 2.2);
                SCREE_CHECK_INT(r[0].used_fallback, 0);
            }
            num_touching += plain.status == SCREE_OVERLAP_TOUCHING;
        }
        scree_shape_destroy(&tiled);
    }
    SCREE_CHECK(num_touching > 400);
    scree_overlap_workspace_destroy(workspace);
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
    SCREE_RUN(test_flat_faces);
    scree_shape_destroy(&cube);
    scree_shape_destroy(&schoenhardt);
    return SCREE_TEST_END();
}
