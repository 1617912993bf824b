// Polygons cut into triangles: same sense, same area, each side used once.
#include "mesh_tools.h"
#include "polyhedra/polygon.h"

enum
{
    MAX_CORNERS = 400
};

/// Twice the area vector of a triangle.
static scree_vec3 area_of(const scree_vec3 *corners, const int32_t t[3])
{
    return scree_vec3_cross(scree_vec3_sub(corners[t[1]], corners[t[0]]), scree_vec3_sub(corners[t[2]], corners[t[0]]));
}

/// Cuts, and checks what holds for every polygon that does not cross itself.
static void check_polygon(const scree_vec3 *corners, int32_t num, scree_vec3 normal)
{
    static int32_t triangles[MAX_CORNERS][3];
    static int32_t scratch[MAX_CORNERS];
    static int num_sides[MAX_CORNERS][MAX_CORNERS];
    scree_polygon_triangulate(corners, num, triangles, scratch);
    memset(num_sides, 0, sizeof num_sides);
    double sum = 0.0, sum_of_sizes = 0.0;
    for (int32_t t = 0; t < num - 2; ++t)
    {
        const double area = (double)scree_vec3_dot(area_of(corners, triangles[t]), normal);
        sum += area;
        sum_of_sizes += fabs(area);
        for (int k = 0; k < 3; ++k) ++num_sides[triangles[t][k]][triangles[t][(k + 1) % 3]];
    }
    // the triangles' areas are that of the polygon; if one were turned over, the sizes would exceed it
    double expected = 0.0, largest = 0.0;
    for (int32_t i = 1; i + 1 < num; ++i)
    {
        const int32_t fan[3] = {0, i, i + 1};
        const double area = (double)scree_vec3_dot(area_of(corners, fan), normal);
        expected += area;
        largest += fabs(area);
    }
    const double noise = 64.0 * (double)SCREE_REAL_EPSILON * largest;
    SCREE_CHECK_CLOSE(sum, expected, noise);
    SCREE_CHECK_CLOSE(sum_of_sizes, expected, noise);
    // each side of the polygon once in its sense, each cut once either way
    for (int32_t i = 0; i < num; ++i)
    {
        for (int32_t j = 0; j < num; ++j)
        {
            const bool is_side = j == (i + 1) % num;
            const bool is_reverse = i == (j + 1) % num;
            if (is_side) SCREE_CHECK_INT(num_sides[i][j], 1);
            else if (is_reverse) SCREE_CHECK_INT(num_sides[i][j], 0);
            else SCREE_CHECK(num_sides[i][j] <= 1 && num_sides[i][j] == num_sides[j][i]);
        }
    }
}

static scree_vec3 in_plane(scree_mat3 frame, double x, double y)
{
    return scree_mat3_apply(frame, scree_vec3_make((scree_real)x, (scree_real)y, (scree_real)0.5));
}

static void stars_in_any_plane(void)
{
    uint64_t state = 3;
    for (int trial = 0; trial < 300; ++trial)
    {
        scree_vec3 corners[64];
        const int32_t num = 3 + (int32_t)(scree_test_random(&state) * 40.0);
        const scree_mat3 frame = scree_mat3_from_quat(scree_test_random_rotation(&state));
        for (int32_t i = 0; i < num; ++i)
        {
            const double radius = 0.1 + scree_test_random(&state);
            const double angle = 6.283185307179586 * i / num;
            corners[i] = in_plane(frame, radius * cos(angle), radius * sin(angle));
        }
        check_polygon(corners, num, scree_mat3_apply(frame, scree_vec3_make(0, 0, 1)));
    }
}

static void spirals_combs_and_straight_corners(void)
{
    scree_vec3 corners[MAX_CORNERS];
    const scree_mat3 flat = scree_mat3_from_quat(scree_quat_identity());
    const scree_vec3 up = scree_vec3_make(0, 0, 1);
    // a band wound three times: out along one side, back along the other
    for (int32_t i = 0; i < 100; ++i)
    {
        const double angle = 0.19 * i, radius = 1.0 + 0.1 * i;
        corners[i] = in_plane(flat, (radius + 0.8) * cos(angle), (radius + 0.8) * sin(angle));
        corners[199 - i] = in_plane(flat, radius * cos(angle), radius * sin(angle));
    }
    check_polygon(corners, 200, up);
    // a comb
    for (int32_t i = 0; i < 99; ++i) corners[i] = in_plane(flat, i, i % 2 == 0 ? 0.0 : -5.0);
    corners[99] = in_plane(flat, 98, 1);
    corners[100] = in_plane(flat, 0, 1);
    check_polygon(corners, 101, up);
    // a square with many corners along its sides, exactly straight
    for (int32_t i = 0; i < 40; ++i)
    {
        const double s = i % 10;
        corners[i] = i < 10   ? in_plane(flat, s, 0)
                     : i < 20 ? in_plane(flat, 10, s)
                     : i < 30 ? in_plane(flat, 10 - s, 10)
                              : in_plane(flat, 0, 10 - s);
    }
    check_polygon(corners, 40, up);
}

static void squares_with_a_slit_to_their_hole(void)
{
    // outside counter-clockwise, slit, inside clockwise, slit: two pairs of corners coincide
    static const double plan[10][2] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
    scree_vec3 corners[10];
    const scree_mat3 flat = scree_mat3_from_quat(scree_quat_identity());
    for (int i = 0; i < 10; ++i) corners[i] = in_plane(flat, plan[i][0], plan[i][1]);
    int32_t triangles[8][3], scratch[10];
    scree_polygon_triangulate(corners, 10, triangles, scratch);
    double area = 0.0, sizes = 0.0;
    for (int t = 0; t < 8; ++t)
    {
        const double z = 0.5 * (double)area_of(corners, triangles[t]).z;
        area += z;
        sizes += fabs(z);
    }
    SCREE_CHECK_CLOSE(area, 12.0, 1e-12);
    SCREE_CHECK_CLOSE(sizes, 12.0, 1e-12);
}

static void polygons_that_cross_themselves_come_to_an_end(void)
{
    uint64_t state = 4;
    for (int trial = 0; trial < 200; ++trial)
    {
        scree_vec3 corners[30];
        int32_t triangles[28][3], scratch[30];
        for (int i = 0; i < 30; ++i)
            corners[i] = scree_vec3_make((scree_real)floor(4.0 * scree_test_random(&state)),
                                         (scree_real)floor(4.0 * scree_test_random(&state)), 0);
        scree_polygon_triangulate(corners, 30, triangles, scratch);
        for (int t = 0; t < 28; ++t)
            for (int k = 0; k < 3; ++k)
                SCREE_CHECK(triangles[t][k] >= 0 && triangles[t][k] < 30 &&
                            triangles[t][k] != triangles[t][(k + 1) % 3]);
    }
}

int main(void)
{
    SCREE_RUN(stars_in_any_plane);
    SCREE_RUN(spirals_combs_and_straight_corners);
    SCREE_RUN(squares_with_a_slit_to_their_hole);
    SCREE_RUN(polygons_that_cross_themselves_come_to_an_end);
    return SCREE_TEST_END();
}
