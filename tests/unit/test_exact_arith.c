// Exact sums, products and orientations against integers of 128 bits.
#include "core/exact_arith.h"
#include "harness.h"

typedef __int128 wide;

static uint64_t state = 2024;

/// Whole number of up to `bits` bits, with sign.
static int64_t random_whole(int bits)
{
    const int64_t magnitude = (int64_t)(scree_test_random_bits(&state) >> (64 - bits));
    return scree_test_random_bits(&state) & 1 ? -magnitude : magnitude;
}

static void sums_and_products_have_exact_errors(void)
{
    for (int i = 0; i < 20000; ++i)
    {
        const int64_t a = random_whole(53);
        const int64_t b = random_whole(1 + i % 53);
        double error;
        const double sum = scree_two_sum((double)a, (double)b, &error);
        SCREE_CHECK((wide)sum + (wide)error == (wide)a + b);
        const double product = scree_two_product((double)a, (double)b, &error);
        SCREE_CHECK((wide)product + (wide)error == (wide)a * b);
    }
}

static void difference_of_products_is_good_to_the_last_digits(void)
{
    for (int i = 0; i < 20000; ++i)
    {
        // nearly equal products, where the plain difference has no digit right
        const int64_t a = random_whole(52), b = random_whole(52);
        const int64_t c = a + random_whole(4), d = b + random_whole(4);
        const wide exact = (wide)a * b - (wide)c * d;
        const double difference = scree_diff_of_products((double)a, (double)b, (double)c, (double)d);
        SCREE_CHECK_CLOSE(difference, (double)exact, 4.0 * SCREE_ROUNDOFF * fabs((double)exact));
    }
}

static wide value_of(const double *expansion, int32_t num)
{
    wide value = 0;
    for (int32_t i = 0; i < num; ++i) value += (wide)expansion[i];
    return value;
}

static void expansions_add_and_scale_exactly(void)
{
    for (int i = 0; i < 20000; ++i)
    {
        double a[2], b[2], sum[4], scaled[8];
        // numbers of 80 bits as two doubles
        const int64_t high = random_whole(50), low = random_whole(29);
        const int32_t num_a = scree_expansion_of_diff((double)low, (double)high * 0x1p30, a);
        const int32_t num_b = scree_expansion_of_diff((double)random_whole(53), (double)random_whole(20), b);
        SCREE_CHECK(value_of(a, num_a) == (wide)low - (wide)high * (1 << 30));
        const int32_t num_sum = scree_expansion_add(a, num_a, b, num_b, sum);
        SCREE_CHECK(value_of(sum, num_sum) == value_of(a, num_a) + value_of(b, num_b));
        const int64_t factor = random_whole(40);
        const int32_t num_scaled = scree_expansion_scale(a, num_a, (double)factor, scaled);
        SCREE_CHECK(value_of(scaled, num_scaled) == value_of(a, num_a) * factor);
        // the last number carries the sign and is larger than all before it together
        for (int32_t k = 1; k < num_scaled; ++k) SCREE_CHECK(fabs(scaled[k]) > fabs(scaled[k - 1]));
    }
}

typedef struct whole_point
{
    int64_t x, y, z;
} whole_point;

static int sign_of(wide x) { return (x > 0) - (x < 0); }

/// det (b - a, c - a, d - a) in integers: the sign of d over the plane a, b, c counter-clockwise.
static int whole_orient3d(whole_point a, whole_point b, whole_point c, whole_point d)
{
    const wide ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const wide vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const wide wx = d.x - a.x, wy = d.y - a.y, wz = d.z - a.z;
    return sign_of(ux * (vy * wz - vz * wy) + uy * (vz * wx - vx * wz) + uz * (vx * wy - vy * wx));
}

static scree_vec3 scaled_point(whole_point p, double scale)
{
    return scree_vec3_make((scree_real)((double)p.x * scale), (scree_real)((double)p.y * scale),
                           (scree_real)((double)p.z * scale));
}

static whole_point random_point(int bits)
{
    const whole_point p = {random_whole(bits), random_whole(bits), random_whole(bits)};
    return p;
}

/// A point of the plane a, b, c, or off by `off` in one coordinate.
static whole_point near_plane(whole_point a, whole_point b, whole_point c, int64_t off)
{
    const int64_t s = random_whole(4), t = random_whole(4);
    whole_point d;
    d.x = a.x + s * (b.x - a.x) + t * (c.x - a.x);
    d.y = a.y + s * (b.y - a.y) + t * (c.y - a.y);
    d.z = a.z + s * (b.z - a.z) + t * (c.z - a.z) + off;
    return d;
}

// single precision holds whole numbers of 24 bits, double of 53, and the determinant must fit into 127
#ifdef SCREE_SINGLE
#define PLANE_BITS 17
#else
#define PLANE_BITS 34
#endif

static void orient3d_has_the_sign_of_the_determinant(void)
{
    int num_zero = 0;
    for (int i = 0; i < 60000; ++i)
    {
        const whole_point a = random_point(PLANE_BITS), b = random_point(PLANE_BITS), c = random_point(PLANE_BITS);
        const whole_point d = i % 3 == 0 ? random_point(PLANE_BITS) : near_plane(a, b, c, i % 3 == 1 ? 0 : i % 5 - 2);
        const double scale = i % 2 == 0 ? 1.0 : 0x1p-60;
        const scree_vec3 p = scaled_point(a, scale), q = scaled_point(b, scale), r = scaled_point(c, scale);
        const scree_vec3 s = scaled_point(d, scale);
        const int expected = whole_orient3d(a, b, c, d);
        num_zero += expected == 0;
        SCREE_CHECK_INT(scree_orient3d(p, q, r, s), expected);
        SCREE_CHECK_INT(scree_orient3d_exact(p, q, r, s), expected);
        // any two points swapped
        SCREE_CHECK_INT(scree_orient3d(q, p, r, s), -expected);
        SCREE_CHECK_INT(scree_orient3d(p, q, s, r), -expected);
    }
    SCREE_CHECK(num_zero > 10000);
}

static void orient2d_has_the_sign_of_the_area(void)
{
    for (int i = 0; i < 60000; ++i)
    {
        const int64_t ax = random_whole(45), ay = random_whole(45), bx = random_whole(45), by = random_whole(45);
        const int64_t s = random_whole(5);
        int64_t cx = ax + s * (bx - ax), cy = ay + s * (by - ay) + i % 3 - 1;
        if (i % 4 == 0)
        {
            cx = random_whole(45);
            cy = random_whole(45);
        }
        const int expected = sign_of((wide)(bx - ax) * (cy - ay) - (wide)(by - ay) * (cx - ax));
        const scree_exact_point2 a = scree_exact_point2_make((double)ax, (double)ay);
        const scree_exact_point2 b = scree_exact_point2_make((double)bx, (double)by);
        const scree_exact_point2 c = scree_exact_point2_make((double)cx, (double)cy);
        SCREE_CHECK_INT(scree_orient2d(a, b, c), expected);
        SCREE_CHECK_INT(scree_orient2d_exact(a, b, c), expected);
        SCREE_CHECK_INT(scree_orient2d(b, a, c), -expected);
    }
}

static void orientations_are_right_at_the_limits_of_the_numbers(void)
{
#ifndef SCREE_SINGLE
    // a tetrahedron of edge s with its last corner lifted from the plane by the smallest amount there is
    const double sizes[] = {SCREE_EXACT_MIN, 1e-30, 1.0, 1e30, SCREE_EXACT_MAX};
    for (int i = 0; i < 5; ++i)
    {
        const double s = sizes[i];
        const scree_vec3 a = {s, 0, 0}, b = {0, s, 0}, c = {0, 0, s};
        // (1/4, 1/4, 1/2) lies in the plane; the next number up and down does not
        scree_vec3 d = {0.25 * s, 0.25 * s, 0.5 * s};
        SCREE_CHECK_INT(scree_orient3d(a, b, c, d), 0);
        d.z = nextafter(0.5 * s, INFINITY);
        SCREE_CHECK_INT(scree_orient3d(a, b, c, d), 1);
        d.z = nextafter(0.5 * s, 0.0);
        SCREE_CHECK_INT(scree_orient3d(a, b, c, d), -1);
        // a tiny height over a large triangle
        const scree_vec3 o = {0, 0, 0}, u = {s, 0, 0}, v = {0, s, 0};
        const scree_vec3 above = {0.3 * s, 0.3 * s, SCREE_EXACT_MIN};
        const scree_vec3 below = {0.3 * s, 0.3 * s, -SCREE_EXACT_MIN};
        SCREE_CHECK_INT(scree_orient3d(o, u, v, above), 1);
        SCREE_CHECK_INT(scree_orient3d(o, u, v, below), -1);
        SCREE_CHECK_INT(scree_orient3d_exact(o, u, v, above), 1);
        SCREE_CHECK_INT(scree_orient3d_exact(o, u, v, below), -1);
    }
#endif
}

int main(void)
{
    SCREE_RUN(sums_and_products_have_exact_errors);
    SCREE_RUN(difference_of_products_is_good_to_the_last_digits);
    SCREE_RUN(expansions_add_and_scale_exactly);
    SCREE_RUN(orient3d_has_the_sign_of_the_determinant);
    SCREE_RUN(orient2d_has_the_sign_of_the_area);
    SCREE_RUN(orientations_are_right_at_the_limits_of_the_numbers);
    return SCREE_TEST_END();
}
