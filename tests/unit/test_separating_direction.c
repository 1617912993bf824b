/// The search for a plane between two bodies, by their vertices and by the tables of large ones: the gap it tells is
/// never more than that of all vertices along its direction in more digits, and what is far enough apart is found.
#include "contact/separating_direction_kernel.h"
#include "polyhedra/generate.h"

#include <stdlib.h>

#include "harness.h"

enum
{
    NUM_SHAPES = 5
};

static scree_shape shapes[NUM_SHAPES];
static scree_mesh meshes[NUM_SHAPES];

static void make_shapes(void)
{
    const double size[3] = {2, 1, 0.3};
    SCREE_CHECK_INT(scree_generate_box(meshes + 0, size), SCREE_OK);
    SCREE_CHECK_INT(scree_generate_rock(meshes + 1, 5, 40, 1000), SCREE_OK);
    SCREE_CHECK_INT(scree_generate_rock(meshes + 2, 6, 320, 1000), SCREE_OK);
    SCREE_CHECK_INT(scree_generate_rock(meshes + 3, 7, 1000, 1000), SCREE_OK);
    SCREE_CHECK_INT(scree_generate_sphere(meshes + 4, 1, 500), SCREE_OK);
    for (int k = 0; k < NUM_SHAPES; ++k)
        SCREE_CHECK_INT(scree_shape_create(shapes + k, meshes + k, SCREE_FRAME_PRINCIPAL), SCREE_OK);
}

static scree_pose random_pose(uint64_t *state, double distance)
{
    scree_pose pose;
    double q[4], x[3];
    for (int k = 0; k < 4; ++k) q[k] = scree_test_random(state) - 0.5;
    for (int k = 0; k < 3; ++k) x[k] = scree_test_random(state) - 0.5;
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double away = distance / sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    pose.orientation.w = (scree_real)(q[0] / length);
    pose.orientation.x = (scree_real)(q[1] / length);
    pose.orientation.y = (scree_real)(q[2] / length);
    pose.orientation.z = (scree_real)(q[3] / length);
    pose.position = scree_vec3_make((scree_real)(x[0] * away), (scree_real)(x[1] * away), (scree_real)(x[2] * away));
    pose.scale = (scree_real)(0.3 + scree_test_random(state));
    return pose;
}

/// Largest d . x over the vertices of a posed body, the rotation by a quaternion that need not be of length 1.
static long double farthest(const scree_shape_view *shape, const scree_pose *pose, const long double d[3])
{
    const long double w = pose->orientation.w, x = pose->orientation.x, y = pose->orientation.y,
                      z = pose->orientation.z, squared = w * w + x * x + y * y + z * z, s = pose->scale;
    long double most = -INFINITY;
    for (int32_t v = 0; v < shape->num_vertices; ++v)
    {
        const long double p[3] = {shape->vertices[v].x, shape->vertices[v].y, shape->vertices[v].z};
        const long double t[3] = {2 * (y * p[2] - z * p[1]) / squared, 2 * (z * p[0] - x * p[2]) / squared,
                                  2 * (x * p[1] - y * p[0]) / squared};
        const long double turned[3] = {p[0] + w * t[0] + y * t[2] - z * t[1], p[1] + w * t[1] + z * t[0] - x * t[2],
                                       p[2] + w * t[2] + x * t[1] - y * t[0]};
        const long double along = d[0] * (s * turned[0] + (long double)pose->position.x) +
                                  d[1] * (s * turned[1] + (long double)pose->position.y) +
                                  d[2] * (s * turned[2] + (long double)pose->position.z);
        most = fmaxl(most, along);
    }
    return most;
}

/// One pair; returns the gap found.
static double check_pair(const scree_shape_view *a, const scree_pose *pose_a, const scree_shape_view *b,
                         const scree_pose *pose_b, scree_vec3 start)
{
    scree_vec3 direction = start;
    const double gap = (double)scree_separation_search(a, pose_a, b, pose_b, &direction);
    if (!(gap > 0)) return gap;
    const long double d[3] = {direction.x, direction.y, direction.z};
    const long double back[3] = {-d[0], -d[1], -d[2]};
    const long double length = sqrtl(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const long double exact = -(farthest(a, pose_a, d) + farthest(b, pose_b, back)) / length;
    SCREE_CHECK((long double)gap <= exact);
    // what interpolation adds at most for any shape, see test_support_map.c
    const long double size = (long double)(a->bounding_radius * pose_a->scale + b->bounding_radius * pose_b->scale);
    SCREE_CHECK((long double)gap >= exact - sqrtl(2) / SCREE_SUPPORT_CELLS * size);
    return gap;
}

static void test_gaps_are_no_larger_than_they_are(void)
{
    make_shapes();
    uint64_t state = 3;
    int num_found = 0, num_not = 0;
    for (int n = 0; n < 20000; ++n)
    {
        const scree_shape_view *a = &shapes[n % NUM_SHAPES].view, *b = &shapes[n / NUM_SHAPES % NUM_SHAPES].view;
        scree_pose pose_a = random_pose(&state, 0.1), pose_b = random_pose(&state, 1);
        const double reach =
            (double)a->bounding_radius * (double)pose_a.scale + (double)b->bounding_radius * (double)pose_b.scale;
        const double share = 0.1 + 1.1 * scree_test_random(&state);
        pose_b.position =
            scree_vec3_add(scree_vec3_scale(pose_b.position, (scree_real)(share * reach)), pose_a.position);
        const scree_vec3 start = n % 2 == 0 ? scree_vec3_zero() : random_pose(&state, 1).position;
        const double gap = check_pair(a, &pose_a, b, &pose_b, start);
        num_found += gap > 0;
        num_not += !(gap > 0);
        // bounding spheres apart by more than tables exceed both bodies, and the line of centres is tried first
        if (n % 2 == 0 && share > 1 + sqrt(2) / SCREE_SUPPORT_CELLS) SCREE_CHECK(gap > 0);
    }
    printf("%d planes found, %d not\n", num_found, num_not);
    SCREE_CHECK(num_found > 2000 && num_not > 2000);
    for (int k = 0; k < NUM_SHAPES; ++k)
    {
        scree_shape_destroy(shapes + k);
        scree_mesh_destroy(meshes + k);
    }
}

int main(void)
{
    SCREE_RUN(test_gaps_are_no_larger_than_they_are);
    return SCREE_TEST_END();
}
