// Volume, centroid and inertia against closed forms, laws of scaling, shifting, turning and joining, and against
// quadrature over the surface.
#include "mesh_tools.h"
#include "polyhedra/generate.h"
#include "polyhedra/mass_properties.h"

#define EPS ((double)SCREE_REAL_EPSILON)

static scree_mass_properties properties_of(const scree_mesh *mesh)
{
    scree_mass_properties p;
    scree_mass_properties_compute(mesh, &p);
    return p;
}

static scree_mesh rock(uint64_t seed)
{
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_rock(&mesh, seed, 1000, 0), SCREE_OK);
    return mesh;
}

static void box_has_its_closed_form(void)
{
    const double size[3] = {1.0, 2.0, 3.5};
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
    const scree_mass_properties p = properties_of(&mesh);
    SCREE_CHECK_CLOSE(p.volume, 7.0, 7.0 * 8 * EPS);
    SCREE_CHECK_CLOSE(p.area, 2 * (2.0 + 3.5 + 7.0), 25.0 * 8 * EPS);
    for (int i = 0; i < 3; ++i)
    {
        const double a = size[(i + 1) % 3], b = size[(i + 2) % 3];
        SCREE_CHECK_CLOSE(p.centroid[i], 0.0, 8 * EPS);
        SCREE_CHECK_CLOSE(p.inertia[i][i], 7.0 * (a * a + b * b) / 12.0, 16 * EPS * 10.0);
        SCREE_CHECK_CLOSE(p.inertia[i][(i + 1) % 3], 0.0, 16 * EPS);
        SCREE_CHECK(p.principal[i] == p.inertia[i][i]);
        SCREE_CHECK(p.principal_axes[i + 1] == 0.0);
    }
    SCREE_CHECK(p.principal_axes[0] == 1.0);
    SCREE_CHECK_CLOSE(p.bounding_radius, 0.5 * sqrt(1.0 + 4.0 + 12.25), 4 * EPS);
    scree_mesh_destroy(&mesh);
}

static void tetrahedron_has_its_closed_form(void)
{
    // corner at the origin, legs a, b, c along the axes: V = abc/6, centroid (a, b, c)/4,
    // integral of x^2 = abc a^2/60, of xy = abc ab/120, about the corner
    static const double vertices[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 5}};
    static const int32_t triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const double leg[3] = {2, 3, 5};
    scree_mesh mesh = scree_test_mesh(vertices, 4, triangles, 4);
    const scree_mass_properties p = properties_of(&mesh);
    SCREE_CHECK_CLOSE(p.volume, 5.0, 5.0 * 8 * EPS);
    double second[3][3];
    for (int i = 0; i < 3; ++i)
    {
        SCREE_CHECK_CLOSE(p.centroid[i], 0.25 * leg[i], 8 * EPS);
        for (int j = 0; j < 3; ++j)
            second[i][j] = 30.0 * leg[i] * leg[j] / (i == j ? 60.0 : 120.0) - 5.0 * leg[i] * leg[j] / 16.0;
    }
    const double trace = second[0][0] + second[1][1] + second[2][2];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            SCREE_CHECK_CLOSE(p.inertia[i][j], (i == j ? trace : 0.0) - second[i][j], 64 * EPS * trace);
    scree_mesh_destroy(&mesh);

    // regular, circumradius 1: edge sqrt(8/3), V = edge^3/(6 sqrt 2), I = V edge^2/20
    SCREE_CHECK_INT(scree_generate_tetrahedron(&mesh, 1.0), SCREE_OK);
    const scree_mass_properties q = properties_of(&mesh);
    const double edge = sqrt(8.0 / 3.0);
    SCREE_CHECK_CLOSE(q.volume, edge * edge * edge / (6.0 * sqrt(2.0)), 16 * EPS);
    for (int i = 0; i < 3; ++i) SCREE_CHECK_CLOSE(q.principal[i], q.volume * edge * edge / 20.0, 16 * EPS);
    SCREE_CHECK_CLOSE(q.area, sqrt(3.0) * edge * edge, 32 * EPS);
    SCREE_CHECK(q.principal_axes[0] == 1.0);
    scree_mesh_destroy(&mesh);
}

static void nothing_is_lost_far_from_the_origin(void)
{
    // whole numbers, so that the shift is exact and the properties must be the same to the last digits
    const double size[3] = {2.0, 4.0, 6.0};
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
    const scree_mass_properties near = properties_of(&mesh);
#ifdef SCREE_SINGLE
    const double far = 0x1p20;
#else
    const double far = 0x1p50;
#endif
    scree_test_mesh_shift(&mesh, far, -far, 0.5 * far);
    const scree_mass_properties p = properties_of(&mesh);
    SCREE_CHECK_CLOSE(p.volume, near.volume, 16 * EPS * near.volume);
    SCREE_CHECK_CLOSE(p.area, near.area, 16 * EPS * near.area);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            SCREE_CHECK_CLOSE(p.inertia[i][j], near.inertia[i][j], 32 * EPS * near.inertia[0][0]);
    SCREE_CHECK(p.centroid[0] == far && p.centroid[1] == -far && p.centroid[2] == 0.5 * far);
    SCREE_CHECK_CLOSE(p.bounding_radius, near.bounding_radius, 4 * EPS * near.bounding_radius);
    scree_mesh_destroy(&mesh);
}

/// Rounding of sums over `num` triangles of magnitude 1, which errs on the safe side of num EPS.
static double sum_noise(const scree_mesh *mesh) { return (double)mesh->num_triangles * EPS; }

static void properties_scale_with_their_powers_of_length(void)
{
    scree_mesh mesh = rock(3);
    const scree_mass_properties p = properties_of(&mesh);
    scree_test_mesh_scale(&mesh, 0.001953125, 0.001953125, 0.001953125);
    const scree_mass_properties q = properties_of(&mesh);
    // a power of two: exact
    SCREE_CHECK(q.volume == p.volume * 0x1p-27);
    SCREE_CHECK(q.area == p.area * 0x1p-18);
    SCREE_CHECK(q.inertia[0][1] == p.inertia[0][1] * 0x1p-45);
    SCREE_CHECK(q.bounding_radius == p.bounding_radius * 0x1p-9);
    scree_mesh_destroy(&mesh);
}

/// R I R^T
static void turned_tensor(scree_mat3 m, double inertia[3][3], double result[3][3])
{
    const double r[3][3] = {{(double)m.row[0].x, (double)m.row[0].y, (double)m.row[0].z},
                            {(double)m.row[1].x, (double)m.row[1].y, (double)m.row[1].z},
                            {(double)m.row[2].x, (double)m.row[2].y, (double)m.row[2].z}};
    for (int i = 0; i < 3; ++i)
    {
        for (int j = 0; j < 3; ++j)
        {
            result[i][j] = 0.0;
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < 3; ++l) result[i][j] += r[i][k] * inertia[k][l] * r[j][l];
        }
    }
}

static void rigid_motion_turns_the_tensor_and_keeps_the_moments(void)
{
    uint64_t state = 5;
    for (uint64_t seed = 1; seed <= 6; ++seed)
    {
        scree_mesh mesh = rock(seed);
        scree_mass_properties p = properties_of(&mesh);
        const scree_quat turn = scree_test_random_rotation(&state);
        scree_test_mesh_rotate(&mesh, turn);
        scree_test_mesh_shift(&mesh, 0.5, -0.25, 2.0);
        const scree_mass_properties q = properties_of(&mesh);
        double expected[3][3];
        turned_tensor(scree_mat3_from_quat(turn), p.inertia, expected);
        const double noise = sum_noise(&mesh);
        SCREE_CHECK_CLOSE(q.volume, p.volume, noise * p.volume);
        for (int i = 0; i < 3; ++i)
        {
            for (int j = 0; j < 3; ++j) SCREE_CHECK_CLOSE(q.inertia[i][j], expected[i][j], noise * p.principal[2]);
            SCREE_CHECK_CLOSE(q.principal[i], p.principal[i], noise * p.principal[2]);
        }
        scree_mesh_destroy(&mesh);
    }
}

static void principal_axes_make_the_tensor_diagonal(void)
{
    uint64_t state = 6;
    for (uint64_t seed = 1; seed <= 6; ++seed)
    {
        scree_mesh mesh = rock(seed);
        scree_test_mesh_rotate(&mesh, scree_test_random_rotation(&state));
        scree_mass_properties p = properties_of(&mesh);
        const double *q = p.principal_axes;
        SCREE_CHECK_CLOSE(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1.0, 8 * DBL_EPSILON);
        SCREE_CHECK(q[0] >= 0.0);
        SCREE_CHECK(0.0 < p.principal[0] && p.principal[0] <= p.principal[1] && p.principal[1] <= p.principal[2]);
        // moments of a body obey the triangle inequality
        SCREE_CHECK(p.principal[0] + p.principal[1] > p.principal[2]);
        double diagonal[3][3];
        const scree_quat back =
            scree_quat_make((scree_real)q[0], (scree_real)-q[1], (scree_real)-q[2], (scree_real)-q[3]);
        turned_tensor(scree_mat3_from_quat(back), p.inertia, diagonal);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                SCREE_CHECK_CLOSE(diagonal[i][j], i == j ? p.principal[i] : 0.0, 64 * EPS * p.principal[2]);
        scree_mesh_destroy(&mesh);
    }
}

static void cubes_keep_their_axes_and_turned_ones_get_a_frame(void)
{
    const double size[3] = {1.0, 1.0, 1.0};
    uint64_t state = 7;
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
    scree_test_mesh_rotate(&mesh, scree_test_random_rotation(&state));
    // a cube has the same moment about every axis, so any axes are principal: none are changed
    const scree_mass_properties p = properties_of(&mesh);
    SCREE_CHECK(p.principal_axes[0] == 1.0 && p.principal_axes[1] == 0.0);
    for (int i = 0; i < 3; ++i) SCREE_CHECK_CLOSE(p.principal[i], 1.0 / 6.0, 16 * EPS);
    scree_mesh_destroy(&mesh);

    // two equal moments, turned about an odd axis: the third axis is found
    const double bar[3] = {1.0, 1.0, 4.0};
    const scree_quat turn = scree_quat_normalize(scree_quat_make(1, (scree_real)0.3, (scree_real)-0.2, 0));
    SCREE_CHECK_INT(scree_generate_box(&mesh, bar), SCREE_OK);
    scree_test_mesh_rotate(&mesh, turn);
    scree_mass_properties q = properties_of(&mesh);
    SCREE_CHECK_CLOSE(q.principal[0], 4.0 * 2.0 / 12.0, 32 * EPS);
    SCREE_CHECK_CLOSE(q.principal[1], 4.0 * 17.0 / 12.0, 64 * EPS);
    SCREE_CHECK_CLOSE(q.principal[2], 4.0 * 17.0 / 12.0, 64 * EPS);
    const scree_mat3 axes =
        scree_mat3_from_quat(scree_quat_make((scree_real)q.principal_axes[0], (scree_real)q.principal_axes[1],
                                             (scree_real)q.principal_axes[2], (scree_real)q.principal_axes[3]));
    const scree_vec3 slim = scree_mat3_apply(axes, scree_vec3_make(1, 0, 0));
    const scree_vec3 expected = scree_mat3_apply(scree_mat3_from_quat(turn), scree_vec3_make(0, 0, 1));
    SCREE_CHECK_CLOSE(fabs((double)scree_vec3_dot(slim, expected)), 1.0, 64 * EPS);
    scree_mesh_destroy(&mesh);
}

static void parts_add_up_to_the_whole(void)
{
    // a rock and a shifted copy of another as one body: volumes add, and so do moments about a common point
    scree_mesh whole = rock(1);
    scree_mesh other = rock(2);
    scree_test_mesh_shift(&other, 3.0, 1.0, -2.0);
    const scree_mass_properties a = properties_of(&whole);
    const scree_mass_properties b = properties_of(&other);
    scree_test_mesh_append(&whole, &other);
    const scree_mass_properties p = properties_of(&whole);
    const double noise = 16.0 * sum_noise(&whole);
    SCREE_CHECK_CLOSE(p.volume, a.volume + b.volume, noise);
    SCREE_CHECK_CLOSE(p.area, a.area + b.area, noise);
    // steiner: about the common centroid, with the reduced mass and the distance of the centroids
    const double reduced = a.volume * b.volume / (a.volume + b.volume);
    double d[3];
    for (int i = 0; i < 3; ++i)
    {
        d[i] = b.centroid[i] - a.centroid[i];
        SCREE_CHECK_CLOSE(p.centroid[i], (a.volume * a.centroid[i] + b.volume * b.centroid[i]) / p.volume, noise);
    }
    const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            SCREE_CHECK_CLOSE(p.inertia[i][j],
                              a.inertia[i][j] + b.inertia[i][j] + reduced * ((i == j ? square : 0.0) - d[i] * d[j]),
                              8.0 * noise);
    scree_mesh_destroy(&whole);
    scree_mesh_destroy(&other);
}

static void cavities_are_taken_away(void)
{
    const double outer[3] = {4.0, 4.0, 4.0};
    const double inner[3] = {2.0, 1.0, 1.0};
    scree_mesh mesh, hole;
    SCREE_CHECK_INT(scree_generate_box(&mesh, outer), SCREE_OK);
    SCREE_CHECK_INT(scree_generate_box(&hole, inner), SCREE_OK);
    scree_test_mesh_shift(&hole, 0.5, 0.0, 0.0);
    scree_test_mesh_turn_inside_out(&hole);
    scree_test_mesh_append(&mesh, &hole);
    const scree_mass_properties p = properties_of(&mesh);
    SCREE_CHECK_CLOSE(p.volume, 62.0, 62.0 * 16 * EPS);
    SCREE_CHECK_CLOSE(p.centroid[0], -1.0 / 62.0, 16 * EPS);
    const double shift = 2.0 * 0.25 + 1.0 / 62.0;
    SCREE_CHECK_CLOSE(p.inertia[0][0], 64.0 * 32.0 / 12.0 - 2.0 * 2.0 / 12.0, 170.0 * 16 * EPS);
    SCREE_CHECK_CLOSE(p.inertia[1][1], 64.0 * 32.0 / 12.0 - 2.0 * 5.0 / 12.0 - shift, 170.0 * 16 * EPS);
    scree_mesh_destroy(&mesh);
    scree_mesh_destroy(&hole);
}

/// Integral over the surface of g(p) n_axis dA for a cubic g, by the rule of four points that is exact for it.
static double surface_integral(const scree_mesh *mesh, double (*g)(const double p[3]), int axis)
{
    static const double weights[4] = {-27.0 / 48.0, 25.0 / 48.0, 25.0 / 48.0, 25.0 / 48.0};
    static const double corners[4][3] = {
        {1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.6, 0.2, 0.2}, {0.2, 0.6, 0.2}, {0.2, 0.2, 0.6}};
    double sum = 0.0;
    for (int32_t t = 0; t < mesh->num_triangles; ++t)
    {
        double v[3][3], u[3], w[3], values = 0.0;
        for (int k = 0; k < 3; ++k)
        {
            const scree_vec3 p = mesh->vertices[mesh->triangles[t].v[k]];
            v[k][0] = (double)p.x;
            v[k][1] = (double)p.y;
            v[k][2] = (double)p.z;
        }
        for (int i = 0; i < 3; ++i)
        {
            u[i] = v[1][i] - v[0][i];
            w[i] = v[2][i] - v[0][i];
        }
        const int j = (axis + 1) % 3, k = (axis + 2) % 3;
        const double area_along_axis = 0.5 * (u[j] * w[k] - u[k] * w[j]);
        for (int point = 0; point < 4; ++point)
        {
            double p[3];
            for (int i = 0; i < 3; ++i)
                p[i] = corners[point][0] * v[0][i] + corners[point][1] * v[1][i] + corners[point][2] * v[2][i];
            values += weights[point] * g(p);
        }
        sum += area_along_axis * values;
    }
    return sum;
}

static double first_power(const double p[3]) { return p[0]; }
static double half_square(const double p[3]) { return 0.5 * p[0] * p[0]; }
static double third_cube(const double p[3]) { return p[0] * p[0] * p[0] / 3.0; }
static double product(const double p[3]) { return 0.5 * p[0] * p[0] * p[1]; }
static double cube_of_y(const double p[3]) { return p[1] * p[1] * p[1] / 3.0; }

static void volume_integrals_equal_surface_integrals(void)
{
    for (uint64_t seed = 11; seed <= 14; ++seed)
    {
        scree_mesh mesh = rock(seed);
        scree_test_mesh_shift(&mesh, 0.3, 0.2, -0.1);
        const scree_mass_properties p = properties_of(&mesh);
        const double noise = 4.0 * sum_noise(&mesh);
        // Gauss: the volume integral of dg/dx is the surface integral of g n_x
        SCREE_CHECK_CLOSE(p.volume, surface_integral(&mesh, first_power, 0), noise);
        SCREE_CHECK_CLOSE(p.volume * p.centroid[0], surface_integral(&mesh, half_square, 0), noise);
        const double xx = surface_integral(&mesh, third_cube, 0);
        const double yy = surface_integral(&mesh, cube_of_y, 1);
        const double xy = surface_integral(&mesh, product, 0);
        const double *c = p.centroid;
        SCREE_CHECK_CLOSE(p.inertia[2][2], xx + yy - p.volume * (c[0] * c[0] + c[1] * c[1]), noise);
        SCREE_CHECK_CLOSE(p.inertia[0][1], -(xy - p.volume * c[0] * c[1]), noise);
        SCREE_CHECK(p.inertia[0][1] == p.inertia[1][0]);
        scree_mesh_destroy(&mesh);
    }
}

static void spheres_approach_two_fifths_in_second_order(void)
{
    double excess[3];
    for (int level = 0; level < 3; ++level)
    {
        scree_mesh mesh;
        SCREE_CHECK_INT(scree_generate_sphere(&mesh, 2.0, 200 << (2 * level)), SCREE_OK);
        const scree_mass_properties p = properties_of(&mesh);
        const double volume = 4.0 / 3.0 * 3.14159265358979323846 * 8.0;
        SCREE_CHECK_CLOSE(p.volume, volume, 64.0 * sum_noise(&mesh));
        const double mean = (p.principal[0] + p.principal[1] + p.principal[2]) / 3.0;
        excess[level] = mean / (0.4 * volume * 4.0) - 1.0;
        // at given volume the ball has the least moments, and the surface exceeds that of the ball
        SCREE_CHECK(excess[level] > 0.0);
        SCREE_CHECK(p.area > 16.0 * 3.14159265358979323846);
        scree_mesh_destroy(&mesh);
    }
    // the excess is of second order in the variation of the radius, which falls with the size of the triangles squared:
    // four times the triangles, a quarter of the size squared, a sixteenth of the excess; 10 to 25 allows for
    // triangles that are not alike
    for (int level = 0; level < 2; ++level)
        SCREE_CHECK(excess[level] / excess[level + 1] > 10.0 && excess[level] / excess[level + 1] < 25.0);
}

static void empty_meshes_have_no_properties(void)
{
    scree_mesh mesh = {0};
    const scree_mass_properties p = properties_of(&mesh);
    SCREE_CHECK(p.volume == 0.0 && p.area == 0.0 && p.bounding_radius == 0.0 && p.principal_axes[0] == 1.0);
}

int main(void)
{
    SCREE_RUN(box_has_its_closed_form);
    SCREE_RUN(tetrahedron_has_its_closed_form);
    SCREE_RUN(nothing_is_lost_far_from_the_origin);
    SCREE_RUN(properties_scale_with_their_powers_of_length);
    SCREE_RUN(rigid_motion_turns_the_tensor_and_keeps_the_moments);
    SCREE_RUN(principal_axes_make_the_tensor_diagonal);
    SCREE_RUN(cubes_keep_their_axes_and_turned_ones_get_a_frame);
    SCREE_RUN(parts_add_up_to_the_whole);
    SCREE_RUN(cavities_are_taken_away);
    SCREE_RUN(volume_integrals_equal_surface_integrals);
    SCREE_RUN(spheres_approach_two_fifths_in_second_order);
    SCREE_RUN(empty_meshes_have_no_properties);
    return SCREE_TEST_END();
}
