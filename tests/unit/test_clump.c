// Clumps: the union of spheres against closed forms, against itself turned, and against rays; frame, supports, faults.
#include "harness.h"
#include "polyhedra/clump.h"
#include "polyhedra/union_of_spheres.h"

#include <stdlib.h>

#define EPS ((double)SCREE_REAL_EPSILON)

static scree_sphere sphere(double x, double y, double z, double radius)
{
    return (scree_sphere){scree_vec3_make((scree_real)x, (scree_real)y, (scree_real)z), (scree_real)radius};
}

static void measure(const scree_sphere *spheres, int32_t num, scree_mass_properties *properties)
{
    double error;
    SCREE_CHECK_INT(scree_union_of_spheres_properties(spheres, num, properties, &error), SCREE_OK);
    SCREE_CHECK(error <= 1e-9);
}

static void test_one_sphere(void)
{
    const scree_sphere one = sphere(1, -2, 0.5, 0.75);
    scree_mass_properties p;
    measure(&one, 1, &p);
    SCREE_CHECK_CLOSE(p.volume, 4.0 / 3.0 * M_PI * pow(0.75, 3), 1e-12);
    SCREE_CHECK_CLOSE(p.area, 4 * M_PI * 0.75 * 0.75, 1e-12);
    SCREE_CHECK_CLOSE(p.centroid[0], 1, 1e-12);
    SCREE_CHECK_CLOSE(p.centroid[1], -2, 1e-12);
    SCREE_CHECK_CLOSE(p.centroid[2], 0.5, 1e-12);
    for (int k = 0; k < 3; ++k) SCREE_CHECK_CLOSE(p.principal[k], 8.0 / 15.0 * M_PI * pow(0.75, 5), 1e-12);
}

/// Integrals over a body of revolution about x of which r(x)^2 = radius^2 - (x - centre)^2: pi r^2, pi r^4/2 about the
/// axis, pi (r^4/4 + r^2 x^2) across; polynomials of fourth degree, so Gauss's rule of three points is exact.
typedef struct turned_sums
{
    double volume, first, about, across;
} turned_sums;

static turned_sums part_of_ball(double centre, double radius, double from, double to)
{
    const double place[3] = {-0.7745966692414834, 0, 0.7745966692414834}, weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
    turned_sums sums = {0};
    for (int k = 0; k < 3; ++k)
    {
        const double x = (from + to) / 2 + (to - from) / 2 * place[k], w = weight[k] * (to - from) / 2;
        const double squared = radius * radius - (x - centre) * (x - centre);
        sums.volume += w * M_PI * squared;
        sums.first += w * M_PI * squared * x;
        sums.about += w * M_PI * squared * squared / 2;
        sums.across += w * M_PI * (squared * squared / 4 + squared * x * x);
    }
    return sums;
}

/// Two spheres of different size along x, cut at the plane through the circle where they meet.
static void test_two_spheres(void)
{
    const double r = 1, s = 0.7, d = 1.2, cut = (d * d + r * r - s * s) / (2 * d);
    const scree_sphere pair[2] = {sphere(0, 0, 0, r), sphere(d, 0, 0, s)};
    scree_mass_properties p;
    measure(pair, 2, &p);
    const turned_sums a = part_of_ball(0, r, -r, cut), b = part_of_ball(d, s, cut, d + s);
    const double volume = a.volume + b.volume, centroid = (a.first + b.first) / volume;
    // the radius 0.7 is rounded in single precision
    const double tolerance = 1e-10 + 8 * EPS;
    SCREE_CHECK_CLOSE(p.volume, volume, tolerance);
    SCREE_CHECK_CLOSE(p.area, 2 * M_PI * (r * (cut + r) + s * (d + s - cut)), 10 * tolerance);
    SCREE_CHECK_CLOSE(p.centroid[0], centroid, tolerance);
    SCREE_CHECK_CLOSE(p.centroid[1], 0, tolerance);
    SCREE_CHECK_CLOSE(p.inertia[0][0], a.about + b.about, tolerance);
    SCREE_CHECK_CLOSE(p.inertia[1][1], a.across + b.across - volume * centroid * centroid, tolerance);
    SCREE_CHECK_CLOSE(p.inertia[2][2], p.inertia[1][1], tolerance);
    SCREE_CHECK_CLOSE(p.inertia[0][1], 0, tolerance);
    SCREE_CHECK_CLOSE(p.bounding_radius, fmax(centroid + r, d + s - centroid), tolerance);
}

/// A random heap of overlapping spheres about the origin.
static int32_t make_heap(scree_sphere *spheres, int32_t num, uint64_t *seed)
{
    for (int32_t k = 0; k < num; ++k)
    {
        double c[3];
        for (int i = 0; i < 3; ++i) c[i] = scree_test_random(seed) - 0.5;
        spheres[k] = sphere(c[0], c[1], c[2], 0.25 + 0.25 * scree_test_random(seed));
    }
    return num;
}

/// The slices of a turned heap are other slices, but volume, area and principal moments are the same.
static void test_turning_changes_nothing(void)
{
    uint64_t seed = 7;
    for (int round = 0; round < 5; ++round)
    {
        scree_sphere heap[9], turned[9];
        make_heap(heap, 9, &seed);
        const scree_mat3 rotation = scree_mat3_from_quat(scree_quat_normalize(
            scree_quat_make((scree_real)scree_test_random(&seed), (scree_real)scree_test_random(&seed),
                            (scree_real)scree_test_random(&seed), (scree_real)scree_test_random(&seed))));
        for (int k = 0; k < 9; ++k)
        {
            turned[k] = heap[k];
            turned[k].centre = scree_vec3_add(scree_mat3_apply(rotation, heap[k].centre), scree_vec3_make(3, -2, 1));
        }
        scree_mass_properties p, q;
        measure(heap, 9, &p);
        measure(turned, 9, &q);
        // what the error is told to be, of both; volume and second moments of the largest sphere are below 1; and the
        // shift is rounded
        const double tolerance = 2e-9 + 64 * EPS;
        SCREE_CHECK_CLOSE(q.volume, p.volume, tolerance);
        SCREE_CHECK_CLOSE(q.area, p.area, 1e-5 * p.area);
        SCREE_CHECK_CLOSE(q.bounding_radius, p.bounding_radius, tolerance);
        double sorted[2][3];
        for (int body = 0; body < 2; ++body)
        {
            const double *m = body ? q.principal : p.principal;
            sorted[body][0] = fmin(m[0], fmin(m[1], m[2]));
            sorted[body][2] = fmax(m[0], fmax(m[1], m[2]));
            sorted[body][1] = m[0] + m[1] + m[2] - sorted[body][0] - sorted[body][2];
        }
        for (int k = 0; k < 3; ++k) SCREE_CHECK_CLOSE(sorted[1][k], sorted[0][k], tolerance);
    }
}

/// Sums over a grid of rays along z, on each of which the union is a set of intervals.
static void test_rays(void)
{
    enum
    {
        NUM = 12,
        GRID = 600
    };
    uint64_t seed = 11;
    scree_sphere heap[NUM];
    make_heap(heap, NUM, &seed);
    scree_mass_properties p;
    measure(heap, NUM, &p);
    double volume = 0, first[3] = {0, 0, 0}, second = 0;
    for (int i = 0; i < GRID; ++i)
        for (int j = 0; j < GRID; ++j)
        {
            const double x = 2.0 * (i + 0.5) / GRID - 1, y = 2.0 * (j + 0.5) / GRID - 1;
            double low[NUM], high[NUM];
            int num = 0;
            for (int k = 0; k < NUM; ++k)
            {
                const double dx = x - (double)heap[k].centre.x, dy = y - (double)heap[k].centre.y;
                const double squared = (double)(heap[k].radius * heap[k].radius) - dx * dx - dy * dy;
                if (!(squared > 0)) continue;
                // kept sorted by the lower end
                int place = num++;
                const double begin = (double)heap[k].centre.z - sqrt(squared);
                for (; place > 0 && low[place - 1] > begin; --place)
                {
                    low[place] = low[place - 1];
                    high[place] = high[place - 1];
                }
                low[place] = begin;
                high[place] = (double)heap[k].centre.z + sqrt(squared);
            }
            double reached = -10;
            for (int k = 0; k < num; ++k)
            {
                const double from = fmax(low[k], reached), to = high[k];
                if (to <= from) continue;
                volume += to - from;
                first[0] += x * (to - from);
                first[1] += y * (to - from);
                first[2] += (to * to - from * from) / 2;
                second += (x * x + y * y) * (to - from);
                reached = to;
            }
        }
    const double cell = 4.0 / GRID / GRID;
    // a ray cell at the outline misses up to a cell times a chord of sqrt(2 r h); their signs are random, some 4 GRID
    // of them: 4e-8 * 0.05 * sqrt(2400) = 1e-6
    SCREE_CHECK_CLOSE(p.volume, volume * cell, 1e-5);
    for (int k = 0; k < 3; ++k) SCREE_CHECK_CLOSE(p.centroid[k], first[k] / volume, 1e-5);
    const double about_z = second * cell - p.volume * (p.centroid[0] * p.centroid[0] + p.centroid[1] * p.centroid[1]);
    SCREE_CHECK_CLOSE(p.inertia[2][2], about_z, 1e-5);
}

/// Where spheres overlap counts once: far less than the sum of all.
static void test_covered_parts_count_once(void)
{
    const scree_sphere same[3] = {sphere(0, 0, 0, 1), sphere(0, 0, 0, 1), sphere(0.1, 0, 0, 0.5)};
    scree_mass_properties one, three;
    measure(same, 1, &one);
    measure(same, 3, &three);
    SCREE_CHECK_CLOSE(three.volume, one.volume, 1e-10);
    SCREE_CHECK_CLOSE(three.area, one.area, 1e-9);
}

static scree_clump_sphere listed(double x, double y, double z, double radius)
{
    return (scree_clump_sphere){{x, y, z}, radius};
}

static void test_frame(void)
{
    const scree_clump_sphere spheres[3] = {listed(5, 1, 2, 0.5), listed(5.6, 1.2, 2, 0.4), listed(5, 1.6, 2.1, 0.3)};
    scree_shape shape;
    SCREE_CHECK_INT(scree_shape_create_clump(&shape, spheres, 3), SCREE_OK);
    SCREE_CHECK_INT(shape.view.kind, SCREE_KIND_CLUMP);
    SCREE_CHECK_INT(shape.view.num_spheres, 3);
    // measured anew, the frame is that of the principal axes
    scree_mass_properties p;
    measure(shape.view.spheres, 3, &p);
    const double tolerance = 2e-9 + 64 * EPS;
    SCREE_CHECK_CLOSE(p.volume, shape.properties.volume, tolerance);
    for (int k = 0; k < 3; ++k)
    {
        SCREE_CHECK_CLOSE(p.centroid[k], 0, tolerance);
        SCREE_CHECK_CLOSE(p.inertia[k][k], shape.properties.principal[k], tolerance);
        SCREE_CHECK_CLOSE(p.inertia[k][(k + 1) % 3], 0, tolerance);
        SCREE_CHECK_CLOSE(shape.properties.inertia[k][k], shape.properties.principal[k], 0);
    }
    // and leads back to where the spheres were given
    const double *q = shape.frame_orientation;
    const scree_mat3 rotation =
        scree_mat3_from_quat(scree_quat_make((scree_real)q[0], (scree_real)q[1], (scree_real)q[2], (scree_real)q[3]));
    for (int k = 0; k < 3; ++k)
    {
        const scree_vec3 c = scree_mat3_apply(rotation, shape.view.spheres[k].centre);
        SCREE_CHECK_CLOSE((double)c.x + shape.frame_position[0], spheres[k].position[0], 64 * EPS);
        SCREE_CHECK_CLOSE((double)c.y + shape.frame_position[1], spheres[k].position[1], 64 * EPS);
        SCREE_CHECK_CLOSE((double)c.z + shape.frame_position[2], spheres[k].position[2], 64 * EPS);
    }
    scree_shape_destroy(&shape);

    SCREE_CHECK_INT(scree_shape_create_clump(&shape, spheres, 1), SCREE_OK);
    SCREE_CHECK_INT(shape.view.kind, SCREE_KIND_SPHERE);
    SCREE_CHECK_CLOSE(shape.view.bounding_radius, 0.5, 0);
    scree_shape_destroy(&shape);
}

static void check_supports(const scree_clump_sphere *spheres, int32_t num, int expected)
{
    scree_shape shape;
    SCREE_CHECK_INT(scree_shape_create_clump(&shape, spheres, num), SCREE_OK);
    SCREE_CHECK_INT(shape.num_supports, expected);
    scree_shape_destroy(&shape);
}

/// A tetrahedron stands on three, a cube on four, a plate of three by three on nine, two on two.
static void test_supports(void)
{
    const scree_clump_sphere tetrahedron[4] = {listed(1, 1, 1, 1.5), listed(1, -1, -1, 1.5), listed(-1, 1, -1, 1.5),
                                               listed(-1, -1, 1, 1.5)};
    scree_clump_sphere cube[8], plate[9];
    for (int k = 0; k < 8; ++k) cube[k] = listed(k & 1, k >> 1 & 1, k >> 2, 0.6);
    for (int k = 0; k < 9; ++k) plate[k] = listed(k % 3, k / 3, 0.3 * (k % 3), 0.6);
    check_supports(tetrahedron, 2, 2);
    check_supports(tetrahedron, 4, 3);
    check_supports(cube, 8, 4);
    check_supports(plate, 9, 9);
}

static void check_fault(const scree_clump_sphere *spheres, int32_t num, scree_clump_fault_kind kind, const char *part)
{
    const scree_clump_fault fault = scree_clump_check(spheres, num);
    char text[256];
    scree_clump_describe_fault(&fault, text, sizeof text);
    SCREE_CHECK_INT(fault.kind, kind);
    SCREE_CHECK_CONTAINS(text, part);
}

static void test_faults(void)
{
    const scree_clump_sphere good[3] = {listed(0, 0, 0, 1), listed(1.5, 0, 0, 1), listed(3, 0, 0, 1)};
    check_fault(good, 3, SCREE_CLUMP_GOOD, "");
    check_fault(good, 0, SCREE_CLUMP_EMPTY, "is empty");
    const scree_clump_sphere apart[4] = {good[0], good[1], listed(5, 0, 0, 1), listed(6, 0, 0, 1)};
    check_fault(apart, 4, SCREE_CLUMP_APART, "number 2 is 1.5 m from number 1");
    // touching in a point is not enough
    const scree_clump_sphere point[2] = {listed(0, 0, 0, 1), listed(2, 0, 0, 1)};
    check_fault(point, 2, SCREE_CLUMP_APART, "not connected");
    const scree_clump_sphere twice[3] = {good[0], good[1], good[1]};
    check_fault(twice, 3, SCREE_CLUMP_HIDDEN, "number 2 wholly inside number 1");
    const scree_clump_sphere hidden[2] = {listed(0.1, 0, 0, 0.5), good[0]};
    check_fault(hidden, 2, SCREE_CLUMP_HIDDEN, "number 0 wholly inside number 1");
    const scree_clump_sphere point_sphere[2] = {good[0], listed(0.5, 0, 0, 0)};
    check_fault(point_sphere, 2, SCREE_CLUMP_NO_RADIUS, "number 1 without radius");
    scree_clump_sphere *many = calloc(SCREE_CLUMP_MAX_SPHERES + 1, sizeof *many);
    check_fault(many, SCREE_CLUMP_MAX_SPHERES + 1, SCREE_CLUMP_TOO_MANY, "at most 256");
    free(many);
}

int main(void)
{
    SCREE_RUN(test_one_sphere);
    SCREE_RUN(test_two_spheres);
    SCREE_RUN(test_turning_changes_nothing);
    SCREE_RUN(test_rays);
    SCREE_RUN(test_covered_parts_count_once);
    SCREE_RUN(test_frame);
    SCREE_RUN(test_supports);
    SCREE_RUN(test_faults);
    return SCREE_TEST_END();
}
