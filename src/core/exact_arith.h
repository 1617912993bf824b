/// \file exact_arith.h
/// Exact sums and products of doubles as expansions, and the orientation predicates built on them (Shewchuk 1997,
/// "Adaptive precision floating-point arithmetic and fast robust geometric predicates"). A floating filter decides
/// nearly always; the rest is evaluated without any rounding, in two steps instead of Shewchuk's four.
/// The only file that calls fma(). Always in double, also in the single-precision build.
/// Limits: exact for coordinates that are zero or between SCREE_EXACT_MIN and SCREE_EXACT_MAX in magnitude. Then every
/// number met is a multiple of 2^-358, every product of three a multiple of the smallest double, and none overflows.
#ifndef SCREE_EXACT_ARITH_H
#define SCREE_EXACT_ARITH_H

#include "core/vec.h"

#define SCREE_EXACT_MIN 1e-90
#define SCREE_EXACT_MAX 1e90

/// Unit roundoff of double, 2^-53.
#define SCREE_ROUNDOFF 1.1102230246251565e-16

/// a + b = sum + *error, exactly (Knuth).
SCREE_FN double scree_two_sum(double a, double b, double *error)
{
    const double sum = a + b;
    const double b_part = sum - a;
    const double a_part = sum - b_part;
    *error = (a - a_part) + (b - b_part);
    return sum;
}

/// The same if |a| >= |b| or a is zero (Dekker).
SCREE_FN double scree_fast_two_sum(double a, double b, double *error)
{
    const double sum = a + b;
    *error = b - (sum - a);
    return sum;
}

/// a b = product + *error, exactly.
SCREE_FN double scree_two_product(double a, double b, double *error)
{
    const double product = a * b;
    *error = fma(a, b, -product);
    return product;
}

/// a b - c d to within 1.5 ulp (Kahan; Jeannerod, Louvet & Muller 2013).
SCREE_FN double scree_diff_of_products(double a, double b, double c, double d)
{
    const double cd = c * d;
    const double error = fma(-c, d, cd);
    return fma(a, b, -cd) + error;
}

/// sum = a + b of two expansions (Shewchuk, fig. 8, with zeros dropped). `sum` holds num_a + num_b numbers and is
/// neither a nor b. Expansions are nonoverlapping, smallest first; the empty one is zero. Returns the length.
SCREE_FN int32_t scree_expansion_add(const double *a, int32_t num_a, const double *b, int32_t num_b, double *sum)
{
    int32_t i = 0;
    int32_t j = 0;
    int32_t num = 0;
    double total = 0.0;
    while (i < num_a || j < num_b)
    {
        double next;
        double error;
        if (j == num_b || (i < num_a && fabs(a[i]) <= fabs(b[j]))) next = a[i++];
        else next = b[j++];
        total = scree_two_sum(total, next, &error);
        if (error != 0.0) sum[num++] = error;
    }
    if (total != 0.0) sum[num++] = total;
    return num;
}

/// product = factor * a (Shewchuk, fig. 13, with zeros dropped). `product` holds 2 num_a numbers. Returns the length.
SCREE_FN int32_t scree_expansion_scale(const double *a, int32_t num_a, double factor, double *product)
{
    int32_t num = 0;
    double total = 0.0;
    for (int32_t i = 0; i < num_a; ++i)
    {
        double low;
        double error;
        const double high = scree_two_product(a[i], factor, &low);
        double sum = scree_two_sum(total, low, &error);
        if (error != 0.0) product[num++] = error;
        total = scree_fast_two_sum(high, sum, &error);
        if (error != 0.0) product[num++] = error;
    }
    if (total != 0.0) product[num++] = total;
    return num;
}

/// a - b as an expansion of at most two numbers.
SCREE_FN int32_t scree_expansion_of_diff(double a, double b, double *diff)
{
    double error;
    int32_t num = 0;
    const double high = scree_two_sum(a, -b, &error);
    if (error != 0.0) diff[num++] = error;
    if (high != 0.0) diff[num++] = high;
    return num;
}

/// product = a b for b of at most two numbers. `product` holds 4 num_a numbers, num_a <= 16.
SCREE_FN int32_t scree_expansion_multiply(const double *a, int32_t num_a, const double *b, int32_t num_b,
                                          double *product)
{
    double part0[32];
    double part1[32];
    int32_t num0 = 0;
    int32_t num1 = 0;
    if (num_b > 0) num0 = scree_expansion_scale(a, num_a, b[0], part0);
    if (num_b > 1) num1 = scree_expansion_scale(a, num_a, b[1], part1);
    return scree_expansion_add(part0, num0, part1, num1, product);
}

SCREE_FN int32_t scree_expansion_sign(const double *a, int32_t num_a)
{
    if (num_a == 0) return 0;
    return a[num_a - 1] > 0.0 ? 1 : -1;
}

/// minor = a0 b1 - a1 b0, where each is an expansion of at most two numbers. `minor` holds 16 numbers.
SCREE_FN int32_t scree_expansion_minor(double a[2][2], const int32_t num_a[2], double b[2][2], const int32_t num_b[2],
                                       double *minor)
{
    double left[8];
    double right[8];
    const int32_t num_left = scree_expansion_multiply(a[0], num_a[0], b[1], num_b[1], left);
    const int32_t num_right = scree_expansion_multiply(a[1], num_a[1], b[0], num_b[0], right);
    for (int32_t i = 0; i < num_right; ++i) right[i] = -right[i];
    return scree_expansion_add(left, num_left, right, num_right, minor);
}

/// Point of the plane, always in double.
typedef struct scree_exact_point2
{
    double x, y;
} scree_exact_point2;

SCREE_FN scree_exact_point2 scree_exact_point2_make(double x, double y)
{
    scree_exact_point2 p;
    p.x = x;
    p.y = y;
    return p;
}

/// orient2d without a filter.
SCREE_FN int32_t scree_orient2d_exact(scree_exact_point2 a, scree_exact_point2 b, scree_exact_point2 c)
{
    double u[2][2];
    double v[2][2];
    int32_t num_u[2];
    int32_t num_v[2];
    double det[16];
    num_u[0] = scree_expansion_of_diff(a.x, c.x, u[0]);
    num_u[1] = scree_expansion_of_diff(a.y, c.y, u[1]);
    num_v[0] = scree_expansion_of_diff(b.x, c.x, v[0]);
    num_v[1] = scree_expansion_of_diff(b.y, c.y, v[1]);
    return scree_expansion_sign(det, scree_expansion_minor(u, num_u, v, num_v, det));
}

/// Sign of the area of the triangle a, b, c: +1 counter-clockwise, -1 clockwise, 0 exactly on one line.
SCREE_FN int32_t scree_orient2d(scree_exact_point2 a, scree_exact_point2 b, scree_exact_point2 c)
{
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double det = left - right;
    // Shewchuk, "A" stage: (3 + 16 u) u times the sum of the magnitudes
    const double bound = (3.0 + 16.0 * SCREE_ROUNDOFF) * SCREE_ROUNDOFF * (fabs(left) + fabs(right));
    if (det > bound) return 1;
    if (-det > bound) return -1;
    return scree_orient2d_exact(a, b, c);
}

/// The three differences of two points as expansions.
SCREE_FN void scree_expansion_of_vec_diff(scree_vec3 a, scree_vec3 b, double diff[3][2], int32_t num[3])
{
    num[0] = scree_expansion_of_diff((double)a.x, (double)b.x, diff[0]);
    num[1] = scree_expansion_of_diff((double)a.y, (double)b.y, diff[1]);
    num[2] = scree_expansion_of_diff((double)a.z, (double)b.z, diff[2]);
}

/// orient3d without a filter.
SCREE_FN int32_t scree_orient3d_exact(scree_vec3 a, scree_vec3 b, scree_vec3 c, scree_vec3 d)
{
    double u[3][2];
    double v[3][2];
    double w[3][2];
    int32_t num_u[3];
    int32_t num_v[3];
    int32_t num_w[3];
    double minor[16];
    double term[3][64];
    int32_t num_term[3];
    double sum[128];
    double det[192];
    scree_expansion_of_vec_diff(a, d, u, num_u);
    scree_expansion_of_vec_diff(b, d, v, num_v);
    scree_expansion_of_vec_diff(c, d, w, num_w);
    // row of z differences times the minors of x and y: minor k is of the two other rows in cyclic order
    int32_t num = scree_expansion_minor(v, num_v, w, num_w, minor);
    num_term[0] = scree_expansion_multiply(minor, num, u[2], num_u[2], term[0]);
    num = scree_expansion_minor(w, num_w, u, num_u, minor);
    num_term[1] = scree_expansion_multiply(minor, num, v[2], num_v[2], term[1]);
    num = scree_expansion_minor(u, num_u, v, num_v, minor);
    num_term[2] = scree_expansion_multiply(minor, num, w[2], num_w[2], term[2]);
    num = scree_expansion_add(term[0], num_term[0], term[1], num_term[1], sum);
    num = scree_expansion_add(sum, num, term[2], num_term[2], det);
    // det (a - d, b - d, c - d) is positive if d is on the side from which a, b, c run clockwise
    return -scree_expansion_sign(det, num);
}

/// Side of the plane through a, b, c on which d lies: +1 if a, b, c run counter-clockwise seen from d (d outside of an
/// outward face), -1 on the other side, 0 exactly in the plane. This is the sign of det (b - a, c - a, d - a).
SCREE_FN int32_t scree_orient3d(scree_vec3 a, scree_vec3 b, scree_vec3 c, scree_vec3 d)
{
    const double ux = (double)a.x - (double)d.x, uy = (double)a.y - (double)d.y, uz = (double)a.z - (double)d.z;
    const double vx = (double)b.x - (double)d.x, vy = (double)b.y - (double)d.y, vz = (double)b.z - (double)d.z;
    const double wx = (double)c.x - (double)d.x, wy = (double)c.y - (double)d.y, wz = (double)c.z - (double)d.z;
    const double vw1 = vx * wy, vw2 = wx * vy;
    const double wu1 = wx * uy, wu2 = ux * wy;
    const double uv1 = ux * vy, uv2 = vx * uy;
    const double det = uz * (vw1 - vw2) + vz * (wu1 - wu2) + wz * (uv1 - uv2);
    const double magnitude =
        (fabs(vw1) + fabs(vw2)) * fabs(uz) + (fabs(wu1) + fabs(wu2)) * fabs(vz) + (fabs(uv1) + fabs(uv2)) * fabs(wz);
    // Shewchuk, "A" stage: (7 + 56 u) u times the sum of the magnitudes
    const double bound = (7.0 + 56.0 * SCREE_ROUNDOFF) * SCREE_ROUNDOFF * magnitude;
    if (det > bound) return -1;
    if (-det > bound) return 1;
    return scree_orient3d_exact(a, b, c, d);
}

#endif
