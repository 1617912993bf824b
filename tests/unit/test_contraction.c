/// Floating point as scree needs it: a * b + c is rounded twice, denormals are kept, rounding is to nearest, no excess
/// precision. Inputs are volatile, so that the machine computes and not the compiler; the kernels' own functions are
/// tried as well, since they are what must not be contracted.
#include <fenv.h>
#include <float.h>

#include "core/vec.h"
#include "harness.h"

/// (1 + e)(1 - e) = 1 - e^2 rounds to 1 if rounded before the sum; fused, minus one gives -e^2.
static void product_is_rounded_before_the_sum(void)
{
    volatile double a = 1.0 + 0x1p-30, b = 1.0 - 0x1p-30, c = -1.0;
    SCREE_CHECK(a * b + c == 0.0);
    SCREE_CHECK(c + a * b == 0.0);
    SCREE_CHECK(a * b - 1.0 == 0.0);
    volatile double minus_b = -b;
    SCREE_CHECK(1.0 + a * minus_b == 0.0);
    SCREE_CHECK(fma(a, b, c) == -0x1p-60); // the inputs do tell the two apart
    volatile float fa = 1.0f + 0x1p-13f, fb = 1.0f - 0x1p-13f, fc = -1.0f;
    SCREE_CHECK(fa * fb + fc == 0.0f);
    SCREE_CHECK(fmaf(fa, fb, fc) == -0x1p-26f);
}

static void vectors_are_not_contracted(void)
{
    volatile double a = 1.0 + 0x1p-30, b = 1.0 - 0x1p-30;
    const scree_vec3 u = scree_vec3_make(a, 1.0, 0.0), v = scree_vec3_make(b, -1.0, 0.0);
    SCREE_CHECK(scree_vec3_dot(u, v) == 0.0);
    SCREE_CHECK(scree_vec3_cross(scree_vec3_make(a, 1.0, 0.0), scree_vec3_make(1.0, b, 0.0)).z == 0.0);
    SCREE_CHECK(scree_vec3_add_scaled(scree_vec3_make(-1.0, 0.0, 0.0), scree_vec3_make(b, 0.0, 0.0), a).x == 0.0);
    const scree_mat3 m = {{u, u, u}};
    SCREE_CHECK(scree_mat3_apply(m, v).y == 0.0);
}

/// The loop is one that compilers turn into vector instructions.
static void loops_are_not_contracted(void)
{
    enum
    {
        num = 1000
    };
    static double a[num], b[num], c[num];
    volatile double step = 0x1p-30;
    for (int i = 0; i < num; ++i)
    {
        a[i] = 1.0 + (i + 1) * step;
        b[i] = 1.0 - (i + 1) * step;
        c[i] = -1.0;
    }
    for (int i = 0; i < num; ++i) c[i] += a[i] * b[i];
    int num_wrong = 0;
    for (int i = 0; i < num; ++i)
    {
        volatile double product = a[i] * b[i];
        num_wrong += c[i] != product - 1.0;
    }
    SCREE_CHECK_INT(num_wrong, 0);
}

static void denormals_are_kept(void)
{
    volatile double smallest_normal = DBL_MIN, half = 0.5;
    volatile double denormal = smallest_normal * half;
    SCREE_CHECK(denormal > 0.0);
    SCREE_CHECK(denormal + denormal == smallest_normal);
    volatile double smallest = 0x1p-1074;
    SCREE_CHECK(smallest > 0.0 && smallest * half == 0.0);
    volatile float denormal_float = FLT_MIN * (float)half;
    SCREE_CHECK(denormal_float > 0.0f && denormal_float + denormal_float == FLT_MIN);
    volatile double x = 1.5 * DBL_MIN, y = DBL_MIN;
    SCREE_CHECK(x != y && x - y != 0.0); // gradual underflow: differences of different numbers are not zero
}

/// Also in the threads of a parallel loop: the control register belongs to each thread.
static void threads_round_as_the_first_does(void)
{
    int num_wrong = 0;
#pragma omp parallel for num_threads(7) reduction(+ : num_wrong)
    for (int i = 0; i < 700; ++i)
    {
        volatile double third = 1.0, three = 3.0, tiny = DBL_MIN, half = 0.5;
        num_wrong += third / three != 0x1.5555555555555p-2;
        num_wrong += !(tiny * half > 0.0);
    }
    SCREE_CHECK_INT(num_wrong, 0);
    SCREE_CHECK_INT(fegetround(), FE_TONEAREST);
}

static void no_excess_precision(void)
{
    SCREE_CHECK_INT(FLT_EVAL_METHOD, 0);
    volatile double one = 1.0, tiny = 0x1p-53;
    SCREE_CHECK((one + tiny) + tiny == 1.0);
    volatile double big = DBL_MAX, two = 2.0;
    SCREE_CHECK((big * two) * 0.5 == (double)INFINITY);
    volatile double number = 2.0;
    SCREE_CHECK(sqrt(number) == 0x1.6a09e667f3bcdp+0);
    volatile double not_a_number = NAN;
    SCREE_CHECK(!(not_a_number == not_a_number)); // no finite-math-only
    volatile double minus_zero = -0.0;
    SCREE_CHECK(signbit(minus_zero * 1.0) && 1.0 / minus_zero < 0.0);
}

int main(void)
{
    SCREE_RUN(product_is_rounded_before_the_sum);
    SCREE_RUN(vectors_are_not_contracted);
    SCREE_RUN(loops_are_not_contracted);
    SCREE_RUN(denormals_are_kept);
    SCREE_RUN(threads_round_as_the_first_does);
    SCREE_RUN(no_excess_precision);
    return SCREE_TEST_END();
}
