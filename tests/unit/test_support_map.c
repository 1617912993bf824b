/// The table of support values bounds the support function from above, and not far above.
#include "mesh_tools.h"
#include "polyhedra/generate.h"
#include "polyhedra/shape.h"
#include "polyhedra/support_map.h"

#include <float.h>

/// max d . v in more digits than the table's.
static double support(const scree_mesh *mesh, scree_vec3 d)
{
    long double most = -INFINITY;
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
    {
        const scree_vec3 v = mesh->vertices[i];
        const long double along = (long double)d.x * v.x + (long double)d.y * v.y + (long double)d.z * v.z;
        if (along > most) most = along;
    }
    return (double)most;
}

/// Largest distance of a vertex from a point.
static double radius_about(const scree_mesh *mesh, scree_vec3 point)
{
    double radius = 0;
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
        radius = fmax(radius, (double)scree_vec3_length(scree_vec3_sub(mesh->vertices[i], point)));
    return radius;
}

static double largest_component(scree_vec3 d)
{
    return fmax(fabs((double)d.x), fmax(fabs((double)d.y), fabs((double)d.z)));
}

/// What the test asks: axes, diagonals and grid points of the cube first, random ones of any length after.
static scree_vec3 test_direction(int n, uint64_t *state)
{
    double d[3];
    if (n < 27)
    {
        d[0] = n % 3 - 1;
        d[1] = n / 3 % 3 - 1;
        d[2] = n / 9 - 1;
    }
    else
    {
        const double length = pow(10, 12 * (scree_test_random(state) - 0.5));
        for (int k = 0; k < 3; ++k)
        {
            d[k] = 2 * scree_test_random(state) - 1;
            // multiples of half a cell: grid points and the middles of edges and cells
            if (n % 4 == 1) d[k] = floor(d[k] * SCREE_SUPPORT_CELLS) / SCREE_SUPPORT_CELLS;
            // nearly along an axis or a diagonal
            if (n % 4 == 2) d[k] = (double)(scree_test_random_bits(state) % 3) - 1 + 1e-12 * d[k];
        }
        if (n % 4 == 1) d[n / 4 % 3] = n % 8 < 4 ? 1 : -1;
        for (int k = 0; k < 3; ++k) d[k] *= length;
    }
    return scree_vec3_make((scree_real)d[0], (scree_real)d[1], (scree_real)d[2]);
}

/// What is interpolated is p . d with p its gradient (Euler: it is of degree one in d).
static void check_point(const float *map, scree_vec3 d, double bound, double radius)
{
    const scree_vec3 p = scree_support_map_point(map, d);
    // slopes are differences of values up to sqrt(3) radius times half the number of cells; the bound adds 8 eps radius
    const double largest = largest_component(d);
    const double rounding = 8 * (2 * SCREE_SUPPORT_CELLS + 1) * (double)SCREE_REAL_EPSILON * radius * largest;
    SCREE_CHECK_CLOSE((double)scree_vec3_dot(p, d), bound, rounding);
}

/// `excess` is what interpolation may add to a unit of the direction's largest component.
static void check_mesh(const scree_mesh *mesh, double excess, uint64_t seed)
{
    static float map[SCREE_SUPPORT_VALUES];
    scree_support_map_fill(map, mesh->vertices, mesh->num_vertices);
    const double radius = radius_about(mesh, scree_vec3_zero());
    // values up to sqrt(3) of the radius, each rounded up by less than 1.5 eps
    const double rounding = 3 * (double)FLT_EPSILON * radius + 2 * (double)FLT_MIN;
    uint64_t state = seed;
    for (int n = 0; n < 4000; ++n)
    {
        const scree_vec3 d = test_direction(n, &state);
        const double exact = support(mesh, d), bound = (double)scree_support_bound(map, d, (scree_real)radius);
        const double most = exact + largest_component(d) * (excess + rounding);
        check_point(map, d, bound, radius);
        const bool is_right = bound >= exact && bound <= most;
        SCREE_CHECK(is_right);
        if (!is_right)
            printf("direction (%.17g, %.17g, %.17g): bound %.17g, exact %.17g, at most %.17g\n", (double)d.x,
                   (double)d.y, (double)d.z, bound, exact, most);
    }
}

/// Any shape: h changes by no more than radius |d - d'|, so the mean of the four corners of a cell, weighted for its
/// middle, exceeds h by half a diagonal at most. A shift adds a linear function, which is interpolated exactly.
static double any_excess(double radius) { return radius * sqrt(2.0) / SCREE_SUPPORT_CELLS; }

/// At the centre first, then shifted by up to many radii.
static void check_shifted(scree_mesh *mesh, double excess, uint64_t seed)
{
    const double shifts[][3] = {{0, 0, 0}, {0.3, -0.7, 0.2}, {-5, 3, 8}, {100, -1000, 30}};
    for (int k = 0; k < 4; ++k)
    {
        scree_test_mesh_shift(mesh, shifts[k][0], shifts[k][1], shifts[k][2]);
        check_mesh(mesh, excess, seed + (uint64_t)k);
    }
    scree_mesh_destroy(mesh);
}

static void test_any_shape(void)
{
    scree_mesh mesh;
    const double flat[3] = {1, 0.5, 1e-6}, tiny[3] = {1e-7, 2e-7, 1e-7};
    SCREE_CHECK_INT(scree_generate_box(&mesh, flat), SCREE_OK);
    check_shifted(&mesh, any_excess(radius_about(&mesh, scree_vec3_zero())), 1);
    SCREE_CHECK_INT(scree_generate_box(&mesh, tiny), SCREE_OK);
    check_mesh(&mesh, any_excess(radius_about(&mesh, scree_vec3_zero())), 2);
    scree_mesh_destroy(&mesh);
    SCREE_CHECK_INT(scree_generate_tetrahedron(&mesh, 1), SCREE_OK);
    check_shifted(&mesh, any_excess(1), 10);
    SCREE_CHECK_INT(scree_generate_schoenhardt(&mesh, 2), SCREE_OK);
    check_shifted(&mesh, any_excess(2), 20);
    SCREE_CHECK_INT(scree_generate_rock(&mesh, 3, 200, 0), SCREE_OK);
    check_shifted(&mesh, any_excess(radius_about(&mesh, scree_vec3_zero())), 30);
}

/// A ball: h(1, u, v) = R sqrt(1 + u^2 + v^2), so h_uu + h_vv <= 2 R; interpolation over a cell of width w adds at most
/// w^2/8 of that. The mesh lies between two balls of R and r, and its own h may be less than R by R - r.
static void test_sphere(void)
{
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_sphere(&mesh, 1, 20000), SCREE_OK);
    const double outer = radius_about(&mesh, scree_vec3_zero());
    double inner = outer;
    for (int32_t i = 0; i < mesh.num_triangles; ++i)
    {
        const scree_vec3 a = mesh.vertices[mesh.triangles[i].v[0]], b = mesh.vertices[mesh.triangles[i].v[1]];
        const scree_vec3 c = mesh.vertices[mesh.triangles[i].v[2]];
        const scree_vec3 n = scree_vec3_cross(scree_vec3_sub(b, a), scree_vec3_sub(c, a));
        inner = fmin(inner, (double)(scree_vec3_dot(n, a) / scree_vec3_length(n)));
    }
    const double width = 2.0 / SCREE_SUPPORT_CELLS;
    check_shifted(&mesh, width * width / 8 * 2 * outer + sqrt(3.0) * (outer - inner), 40);
}

/// A single vertex is the point of every direction, up to the rounding of the values to float: two of them differ by at
/// most 3 eps |v| too much, over a cell of 2/SCREE_SUPPORT_CELLS.
static void test_point_of_vertex(void)
{
    static float map[SCREE_SUPPORT_VALUES];
    const scree_vec3 vertex = {1, -2, 3};
    scree_support_map_fill(map, &vertex, 1);
    const double off_axis = 3 * (double)FLT_EPSILON * 6.5 * SCREE_SUPPORT_CELLS / 2;
    uint64_t state = 60;
    for (int n = 0; n < 4000; ++n)
    {
        const scree_vec3 d = test_direction(n, &state);
        if (!(largest_component(d) > 0)) continue;
        const scree_vec3 p = scree_support_map_point(map, d);
        SCREE_CHECK_CLOSE((double)p.x, 1, 3 * off_axis);
        SCREE_CHECK_CLOSE((double)p.y, -2, 3 * off_axis);
        SCREE_CHECK_CLOSE((double)p.z, 3, 3 * off_axis);
    }
    const scree_vec3 none = scree_support_map_point(map, scree_vec3_zero());
    SCREE_CHECK(none.x == 0 && none.y == 0 && none.z == 0);
}

static void test_no_direction(void)
{
    static float map[SCREE_SUPPORT_VALUES];
    const scree_vec3 vertex = {1, 2, 3};
    scree_support_map_fill(map, &vertex, 1);
    SCREE_CHECK_CLOSE(scree_support_bound(map, scree_vec3_zero(), 4), 0, 0);
}

/// Shapes that use their tree bring the table of their vertices, those that do not have none.
static void test_shapes_have_maps(void)
{
    scree_mesh mesh;
    const int32_t sizes[] = {12, 500};
    for (int k = 0; k < 2; ++k)
    {
        scree_shape shape;
        SCREE_CHECK_INT(scree_generate_sphere(&mesh, 1, sizes[k]), SCREE_OK);
        SCREE_CHECK_INT(scree_shape_create(&shape, &mesh, SCREE_FRAME_PRINCIPAL), SCREE_OK);
        const bool has_map = shape.view.support_map != NULL;
        SCREE_CHECK_INT(has_map, mesh.num_triangles >= SCREE_LARGE_SHAPE);
        SCREE_CHECK_INT(shape.view.wide_tree.num_items, has_map ? mesh.num_triangles : 0);
        uint64_t state = 50;
        for (int n = 0; has_map && n < 1000; ++n)
        {
            const scree_vec3 d = test_direction(n, &state);
            SCREE_CHECK((double)scree_support_bound(shape.view.support_map, d, shape.view.bounding_radius) >=
                        support(&shape.mesh, d));
        }
        scree_shape_destroy(&shape);
        scree_mesh_destroy(&mesh);
    }
}

int main(void)
{
    SCREE_RUN(test_any_shape);
    SCREE_RUN(test_sphere);
    SCREE_RUN(test_point_of_vertex);
    SCREE_RUN(test_no_direction);
    SCREE_RUN(test_shapes_have_maps);
    return SCREE_TEST_END();
}
