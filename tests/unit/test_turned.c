// Solids of revolution and bodies of copies: valid for many profiles, with the volume of the true solid.
#include "mesh_tools.h"
#include "polyhedra/generate.h"
#include "polyhedra/mass_properties.h"

#define PI 3.14159265358979323846
#define EPS ((double)SCREE_REAL_EPSILON)

static double volume_of(const scree_mesh *mesh)
{
    scree_mass_properties p;
    scree_mass_properties_compute(mesh, &p);
    return p.volume;
}

/// Volume of the true solid: cones between the corners, signed by the sense of the profile.
static double solid_volume(const scree_profile_point *p, int num)
{
    double volume = 0;
    for (int i = 0; i < num; ++i)
    {
        const double r = p[i].radius, q = p[(i + 1) % num].radius, h = p[(i + 1) % num].height - p[i].height;
        volume += PI / 3 * h * (r * r + r * q + q * q);
    }
    return fabs(volume);
}

static void check_turned(const scree_profile_point *profile, int num, int segments, const char *name)
{
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_turned(&mesh, profile, num, segments), SCREE_OK);
    SCREE_CHECK(scree_test_is_valid(&mesh, name));
    double size = 0;
    for (int i = 0; i < num; ++i) size = fmax(size, fmax(profile[i].radius, fabs(profile[i].height)));
    // each of the triangles adds a product of three coordinates with a few roundings; sin() near pi/3 loses two more
    const double tolerance = 64 * EPS * mesh.num_triangles * size * size * size;
    SCREE_CHECK_CLOSE(volume_of(&mesh), solid_volume(profile, num), tolerance);
    scree_mesh_destroy(&mesh);
}

static void test_drums_silos_and_discs_of_many_sizes(void)
{
    uint64_t state = 1;
    for (int n = 0; n < 40; ++n)
    {
        const double radius = 0.01 + scree_test_random(&state), half = 0.005 + scree_test_random(&state);
        const double wall = 0.001 + 0.2 * scree_test_random(&state) * radius;
        const int segments = 3 + (int)(scree_test_random(&state) * 60);
        const double outer = radius + wall, end = half + wall,
                     orifice = radius * (0.05 + 0.9 * scree_test_random(&state));
        const scree_profile_point drum[] = {{0, -end}, {outer, -end},  {outer, end},    {0, end},
                                            {0, half}, {radius, half}, {radius, -half}, {0, -half}};
        const scree_profile_point tube[] = {{radius, -half}, {outer, -half}, {outer, half}, {radius, half}};
        // open at the top, with a cone and an orifice; clockwise on purpose
        const scree_profile_point silo[] = {{orifice, -end}, {radius, -half},       {radius, half},
                                            {outer, half},   {outer, -half - wall}, {orifice, -end - 2 * wall}};
        const scree_profile_point disc[] = {{0, 0}, {radius, 0}, {radius, wall}, {0, wall}};
        const scree_profile_point cone[] = {{0, 0}, {radius, half}, {0, half}};
        check_turned(drum, 8, segments, "drum");
        check_turned(tube, 4, segments, "tube");
        check_turned(silo, 6, segments, "silo");
        check_turned(disc, 4, segments, "disc");
        check_turned(cone, 3, segments, "cone");
    }
}

static void test_drum_is_hollow(void)
{
    const scree_profile_point drum[] = {{0, -0.145}, {0.16, -0.145}, {0.16, 0.145},  {0, 0.145},
                                        {0, 0.135},  {0.15, 0.135},  {0.15, -0.135}, {0, -0.135}};
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_turned(&mesh, drum, 8, 64), SCREE_OK);
    // outside: two fans and a strip; the same again inside
    SCREE_CHECK_INT(mesh.num_triangles, 2 * (64 + 64 + 128));
    const double hollow = PI * 0.15 * 0.15 * 0.27, all = PI * 0.16 * 0.16 * 0.29;
    SCREE_CHECK_CLOSE(volume_of(&mesh), all - hollow, 1e4 * EPS * all);
    scree_mesh_destroy(&mesh);
}

/// Lifters: as many pieces as copies, each of the box's volume, all at the same distance from the axis.
static void test_copies_stand_around_the_axis(void)
{
    const double size[3] = {0.02, 0.01, 0.27}, offset[3] = {0.15, 0, 0.1};
    for (int32_t num = 1; num <= 24; ++num)
    {
        scree_mesh mesh;
        SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
        SCREE_CHECK_INT(scree_mesh_repeat(&mesh, offset, num), SCREE_OK);
        SCREE_CHECK(scree_test_is_valid(&mesh, "lifters"));
        SCREE_CHECK_INT(mesh.num_triangles, 12 * num);
        SCREE_CHECK_CLOSE(volume_of(&mesh), num * size[0] * size[1] * size[2], 1e3 * EPS * num * 0.16 * 0.16 * 0.27);
        for (int32_t v = 0; v < mesh.num_vertices; ++v)
        {
            const scree_vec3 p = mesh.vertices[v];
            const double x = v % 8 & 1 ? 0.16 : 0.14, distance = sqrt((double)(p.x * p.x + p.y * p.y));
            SCREE_CHECK_CLOSE(distance, sqrt(x * x + 0.005 * 0.005), 8 * EPS);
        }
        scree_mesh_destroy(&mesh);
    }
}

static void test_profiles_that_cross_themselves_are_no_bodies(void)
{
    const scree_profile_point bow[] = {{0.1, 0}, {0.2, 0.1}, {0.2, 0}, {0.1, 0.3}};
    const scree_profile_point twice_on_axis[] = {{0, 0}, {1, -1}, {1, 1}, {0, 0}, {0.5, 2}, {2, 0}, {0.5, -2}};
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_turned(&mesh, bow, 4, 16), SCREE_OK);
    SCREE_CHECK_INT(scree_mesh_validate(&mesh, "bow", NULL), SCREE_BAD_MESH);
    scree_mesh_destroy(&mesh);
    SCREE_CHECK_INT(scree_generate_turned(&mesh, twice_on_axis, 7, 16), SCREE_OK);
    SCREE_CHECK_INT(scree_mesh_validate(&mesh, "twice on the axis", NULL), SCREE_BAD_MESH);
    scree_mesh_destroy(&mesh);
}

static void test_nonsense_is_refused(void)
{
    const scree_profile_point good[] = {{0.1, 0}, {0.2, 0}, {0.2, 1}};
    const scree_profile_point negative[] = {{-0.1, 0}, {0.2, 0}, {0.2, 1}}, flat[] = {{0, 0}, {1, 1}, {2, 2}};
    const scree_profile_point endless[] = {{0.1, 0}, {INFINITY, 0}, {0.2, 1}};
    const double none[3] = {0};
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_turned(&mesh, good, 2, 16), SCREE_INVALID_INPUT);
    SCREE_CHECK_INT(scree_generate_turned(&mesh, good, 3, 2), SCREE_INVALID_INPUT);
    SCREE_CHECK_INT(scree_generate_turned(&mesh, good, 3, SCREE_MAX_SEGMENTS + 1), SCREE_INVALID_INPUT);
    SCREE_CHECK_INT(scree_generate_turned(&mesh, negative, 3, 16), SCREE_INVALID_INPUT);
    SCREE_CHECK_INT(scree_generate_turned(&mesh, flat, 3, 16), SCREE_INVALID_INPUT);
    SCREE_CHECK_INT(scree_generate_turned(&mesh, endless, 3, 16), SCREE_INVALID_INPUT);
    SCREE_CHECK(mesh.vertices == NULL);
    SCREE_CHECK_INT(scree_generate_turned(&mesh, good, 3, 16), SCREE_OK);
    SCREE_CHECK_INT(scree_mesh_repeat(&mesh, none, 0), SCREE_INVALID_INPUT);
    SCREE_CHECK_INT(mesh.num_triangles, 96);
    scree_mesh_destroy(&mesh);
}

int main(void)
{
    SCREE_RUN(test_drums_silos_and_discs_of_many_sizes);
    SCREE_RUN(test_drum_is_hollow);
    SCREE_RUN(test_copies_stand_around_the_axis);
    SCREE_RUN(test_profiles_that_cross_themselves_are_no_bodies);
    SCREE_RUN(test_nonsense_is_refused);
    return SCREE_TEST_END();
}
