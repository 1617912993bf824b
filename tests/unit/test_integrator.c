// Free rotation and free flight of one body against closed forms.
#include "dynamics/dynamics.h"
#include "harness.h"

/// Complete elliptic integral of the first kind by the arithmetic-geometric mean; m = k^2.
static double elliptic_k(double m)
{
    double a = 1, b = sqrt(1 - m);
    while (fabs(a - b) > 1e-15 * a)
    {
        const double mean = 0.5 * (a + b);
        b = sqrt(a * b);
        a = mean;
    }
    return M_PI / (2 * a);
}

/// Asymmetric top with moments 1, 2, 3, nearly about the middle axis.
static const scree_vec3 inertia = {1, 2, 3};
static const scree_vec3 start_omega = {0.05, 1.0, 0.1};

static scree_vec3 start_momentum(void)
{
    return scree_vec3_make(inertia.x * start_omega.x, inertia.y * start_omega.y, inertia.z * start_omega.z);
}

static double rotational_energy(scree_quat q, scree_vec3 momentum)
{
    const scree_vec3 omega = scree_angular_velocity(momentum, inertia, q);
    return 0.5 * (double)scree_vec3_dot(omega, momentum);
}

/// Time between two upward zero crossings of the middle component of w in the body frame, mean over several.
static double measured_period(double dt, int num_periods)
{
    scree_quat q = scree_quat_identity();
    const scree_vec3 momentum = start_momentum();
    double previous = (double)start_omega.y, time = 0, first = -1;
    for (int found = 0;;)
    {
        q = scree_rotate(q, momentum, inertia, dt);
        time += dt;
        const scree_vec3 body = scree_mat3_apply_transposed(scree_mat3_from_quat(q), momentum);
        const double now = (double)body.y / (double)inertia.y;
        if (previous < 0 && now >= 0)
        {
            const double crossing = time - dt * now / (now - previous);
            if (first < 0) first = crossing;
            else if (++found == num_periods) return (crossing - first) / num_periods;
        }
        previous = now;
    }
}

/// Landau & Lifshitz, Mechanics, section 37: period of w in the body frame is 4 K(k^2)/rate.
static double exact_period(void)
{
    const scree_vec3 l = start_momentum();
    const double two_t = 2 * rotational_energy(scree_quat_identity(), l), l2 = (double)scree_vec3_dot(l, l);
    const double i1 = 1, i2 = 2, i3 = 3;
    // for L^2 > 2 T I2 the axes keep their order, otherwise 1 and 3 change places
    const bool is_above = l2 > two_t * i2;
    const double a = is_above ? i1 : i3, c = is_above ? i3 : i1;
    const double rate = sqrt((c - i2) * (l2 - two_t * a) / (i1 * i2 * i3));
    const double m = (i2 - a) * (two_t * c - l2) / ((c - i2) * (l2 - two_t * a));
    return 4 * elliptic_k(m) / rate;
}

static void test_flip_period_of_an_asymmetric_top(void)
{
    const double exact = exact_period();
    const double coarse = fabs(measured_period(0.04, 5) - exact), fine = fabs(measured_period(0.02, 5) - exact);
    printf("flip period %.12g s, errors %.3g and %.3g s at steps 0.04 and 0.02 s\n", exact, coarse, fine);
    // second order: the error falls by four; what the linear interpolation of the crossing adds is smaller still
    SCREE_CHECK(fine < 2e-3 * exact);
    SCREE_CHECK_CLOSE(coarse / fine, 4, 0.4);
}

static void test_energy_does_not_drift(void)
{
    scree_quat q = scree_quat_identity();
    const scree_vec3 momentum = start_momentum();
    const double before = rotational_energy(q, momentum);
    double worst_early = 0, worst_late = 0;
    for (int k = 0; k < 200000; ++k)
    {
        q = scree_rotate(q, momentum, inertia, 0.02);
        const double error = fabs(rotational_energy(q, momentum) / before - 1);
        if (k < 20000) worst_early = fmax(worst_early, error);
        else worst_late = fmax(worst_late, error);
    }
    // the error of a symmetric map oscillates; it is no larger after ten times as many turns
    SCREE_CHECK(worst_early < 1e-4);
    SCREE_CHECK(worst_late < 1.01 * worst_early);
    const double length = (double)(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    SCREE_CHECK_CLOSE(length, 1, 8 * (double)SCREE_REAL_EPSILON);
}

static void test_rotation_is_reversible(void)
{
    scree_quat q = scree_quat_identity();
    const scree_vec3 momentum = start_momentum();
    for (int k = 0; k < 1000; ++k) q = scree_rotate(q, momentum, inertia, 0.05);
    for (int k = 0; k < 1000; ++k) q = scree_rotate(q, momentum, inertia, -0.05);
    // roundings of 2000 steps, amplified by the unstable middle axis: exp(0.6 t) over a flip, a few hundred at most
    SCREE_CHECK_CLOSE(fabs((double)q.w), 1, 1e-9);
    SCREE_CHECK_CLOSE(q.x, 0, 1e-9);
    SCREE_CHECK_CLOSE(q.y, 0, 1e-9);
    SCREE_CHECK_CLOSE(q.z, 0, 1e-9);
}

/// A ball of equal moments turns by exactly w t about w, up to the map's (w dt)^3/48 per step.
static void test_ball_turns_uniformly(void)
{
    const scree_vec3 equal = {2, 2, 2};
    const double omega = 1.5, dt = 0.01;
    scree_quat q = scree_quat_identity();
    for (int k = 0; k < 100; ++k) q = scree_rotate(q, scree_vec3_make(0, 0, 2 * omega), equal, dt);
    const double angle = 2 * atan2((double)q.z, (double)q.w);
    const double expected = 100 * 4 * atan(omega * dt / 4);
    SCREE_CHECK_CLOSE(angle, expected, 1e-13);
    SCREE_CHECK_CLOSE(angle, omega * 100 * dt, 100 * pow(omega * dt, 3) / 40);
}

int main(void)
{
    SCREE_RUN(test_flip_period_of_an_asymmetric_top);
    SCREE_RUN(test_energy_does_not_drift);
    SCREE_RUN(test_rotation_is_reversible);
    SCREE_RUN(test_ball_turns_uniformly);
    return SCREE_TEST_END();
}
