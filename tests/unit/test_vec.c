/// Vectors, quaternions, matrices and boxes: small integers, where every result is exact, and random input against the
/// same thing done another way.
#include <stdlib.h>

#include "core/vec.h"
#include "harness.h"

static scree_vec3 random_vec(uint64_t *state)
{
    const double x = 2 * scree_test_random(state) - 1, y = 2 * scree_test_random(state) - 1;
    return scree_vec3_make(x, y, 2 * scree_test_random(state) - 1);
}

static scree_quat random_rotation(uint64_t *state)
{
    const scree_vec3 v = random_vec(state);
    return scree_quat_normalize(scree_quat_make(2 * scree_test_random(state) - 1.0, v.x, v.y, v.z));
}

static bool same_vec(scree_vec3 a, scree_vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

static double distance(scree_vec3 a, scree_vec3 b) { return scree_vec3_length(scree_vec3_sub(a, b)); }

static void vectors_of_integers(void)
{
    const scree_vec3 a = scree_vec3_make(1, 2, 3), b = scree_vec3_make(-5, 7, 11);
    SCREE_CHECK(same_vec(scree_vec3_add(a, b), scree_vec3_make(-4, 9, 14)));
    SCREE_CHECK(same_vec(scree_vec3_sub(a, b), scree_vec3_make(6, -5, -8)));
    SCREE_CHECK(same_vec(scree_vec3_scale(a, -2), scree_vec3_make(-2, -4, -6)));
    SCREE_CHECK(same_vec(scree_vec3_add_scaled(a, b, 3), scree_vec3_make(-14, 23, 36)));
    SCREE_CHECK(same_vec(scree_vec3_negate(a), scree_vec3_make(-1, -2, -3)));
    SCREE_CHECK(scree_vec3_dot(a, b) == 42);
    SCREE_CHECK(same_vec(scree_vec3_cross(a, b), scree_vec3_make(1, -26, 17)));
    SCREE_CHECK(same_vec(scree_vec3_cross(b, a), scree_vec3_make(-1, 26, -17)));
    SCREE_CHECK(scree_vec3_length(scree_vec3_make(2, -3, 6)) == 7);
    SCREE_CHECK(same_vec(scree_vec3_min(a, b), scree_vec3_make(-5, 2, 3)));
    SCREE_CHECK(same_vec(scree_vec3_max(a, b), scree_vec3_make(1, 7, 11)));
    SCREE_CHECK(same_vec(scree_vec3_zero(), scree_vec3_make(0, 0, 0)));
    const scree_vec3 x = scree_vec3_make(1, 0, 0), y = scree_vec3_make(0, 1, 0), z = scree_vec3_make(0, 0, 1);
    SCREE_CHECK(same_vec(scree_vec3_cross(x, y), z));
    SCREE_CHECK(same_vec(scree_vec3_cross(y, z), x));
}

/// The first argument wins a tie, also between the two zeros: that makes the result the same on every machine.
static void minimum_and_maximum_of_equals(void)
{
    SCREE_CHECK(signbit(scree_min(-0.0, 0.0)) && !signbit(scree_min(0.0, -0.0)));
    SCREE_CHECK(signbit(scree_max(-0.0, 0.0)) && !signbit(scree_max(0.0, -0.0)));
    SCREE_CHECK(scree_min(1, 2) == 1 && scree_min(2, 1) == 1 && scree_max(1, 2) == 2 && scree_max(2, 1) == 2);
    SCREE_CHECK(scree_abs(-3) == 3 && scree_abs(3) == 3 && !signbit(scree_abs(-0.0)));
}

/// A quarter turn about z takes x to y; about a general axis the matrix is compared with q v q*.
static void rotations(void)
{
    const double half = sqrt(0.5);
    const scree_quat quarter = scree_quat_make(half, 0, 0, half);
    const scree_vec3 turned = scree_mat3_apply(scree_mat3_from_quat(quarter), scree_vec3_make(1, 0, 0));
    SCREE_CHECK(distance(turned, scree_vec3_make(0, 1, 0)) <= 4 * DBL_EPSILON);
    const scree_mat3 identity = scree_mat3_from_quat(scree_quat_identity());
    SCREE_CHECK(same_vec(scree_mat3_apply(identity, scree_vec3_make(1, 2, 3)), scree_vec3_make(1, 2, 3)));

    uint64_t state = 7;
    for (int i = 0; i < 1000; ++i)
    {
        const scree_quat p = random_rotation(&state), q = random_rotation(&state);
        const scree_vec3 v = random_vec(&state);
        const scree_mat3 matrix = scree_mat3_from_quat(q);
        const scree_vec3 rotated = scree_mat3_apply(matrix, v);
        const scree_quat sandwich =
            scree_quat_multiply(scree_quat_multiply(q, scree_quat_make(0, v.x, v.y, v.z)), scree_quat_conjugate(q));
        // some 30 roundings of numbers of size at most 2
        const double tolerance = 64 * DBL_EPSILON;
        SCREE_CHECK(distance(rotated, scree_vec3_make(sandwich.x, sandwich.y, sandwich.z)) <= tolerance);
        SCREE_CHECK_CLOSE(sandwich.w, 0, tolerance);
        SCREE_CHECK_CLOSE(scree_vec3_length(rotated), scree_vec3_length(v), tolerance);
        SCREE_CHECK(distance(scree_mat3_apply_transposed(matrix, rotated), v) <= tolerance);
        const scree_vec3 twice = scree_mat3_apply(scree_mat3_from_quat(p), rotated);
        const scree_vec3 at_once = scree_mat3_apply(scree_mat3_from_quat(scree_quat_multiply(p, q)), v);
        SCREE_CHECK(distance(twice, at_once) <= 2 * tolerance);
    }
}

/// Hamilton's ij = k and its kin; the conjugate turns back.
static void quaternion_products(void)
{
    const scree_quat i = scree_quat_make(0, 1, 0, 0), j = scree_quat_make(0, 0, 1, 0), k = scree_quat_make(0, 0, 0, 1);
    const scree_quat ij = scree_quat_multiply(i, j), ji = scree_quat_multiply(j, i), ijk = scree_quat_multiply(ij, k);
    SCREE_CHECK(ij.w == 0 && ij.x == 0 && ij.y == 0 && ij.z == 1);
    SCREE_CHECK(ji.w == 0 && ji.x == 0 && ji.y == 0 && ji.z == -1);
    SCREE_CHECK(ijk.w == -1 && ijk.x == 0 && ijk.y == 0 && ijk.z == 0);
    const scree_quat q = scree_quat_make(1, -2, 3, 4), product = scree_quat_multiply(q, scree_quat_conjugate(q));
    SCREE_CHECK(product.w == 30 && product.x == 0 && product.y == 0 && product.z == 0);
    const scree_quat unit = scree_quat_normalize(scree_quat_make(2, 4, -4, 8));
    SCREE_CHECK(unit.w == 0.2 && unit.x == 0.4 && unit.y == -0.4 && unit.z == 0.8);
}

static void boxes(void)
{
    const scree_box empty = scree_box_empty();
    SCREE_CHECK(!scree_box_overlaps(empty, empty));
    scree_box cube = scree_box_with_point(empty, scree_vec3_make(0, 0, 0));
    SCREE_CHECK(scree_box_overlaps(cube, cube)); // a point is not empty
    cube = scree_box_with_point(cube, scree_vec3_make(1, 1, 1));
    SCREE_CHECK(!scree_box_overlaps(cube, empty) && !scree_box_overlaps(empty, cube));
    const scree_box same = scree_box_union(cube, empty);
    SCREE_CHECK(same_vec(same.lower, cube.lower) && same_vec(same.upper, cube.upper));
    // the 27 places around the cube touch it; one more step away on any axis does not
    for (int place = 0; place < 125; ++place)
    {
        const int dx = place % 5 - 2, dy = place / 5 % 5 - 2, dz = place / 25 - 2;
        scree_box other = scree_box_with_point(empty, scree_vec3_make(dx, dy, dz));
        other = scree_box_with_point(other, scree_vec3_make(dx + 1, dy + 1, dz + 1));
        const bool touches = abs(dx) <= 1 && abs(dy) <= 1 && abs(dz) <= 1;
        SCREE_CHECK(scree_box_overlaps(cube, other) == touches && scree_box_overlaps(other, cube) == touches);
        const scree_box both = scree_box_union(cube, other);
        SCREE_CHECK(both.lower.x == (dx < 0 ? dx : 0) && both.upper.y == (dy > 0 ? dy + 1 : 1));
    }
}

int main(void)
{
    SCREE_RUN(vectors_of_integers);
    SCREE_RUN(minimum_and_maximum_of_equals);
    SCREE_RUN(rotations);
    SCREE_RUN(quaternion_products);
    SCREE_RUN(boxes);
    return SCREE_TEST_END();
}
