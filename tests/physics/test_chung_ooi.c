// Chung & Ooi (2011), Granular Matter 13, 643: tests of single impacts of spheres, 1 to 8, with their parameters,
// against closed forms. What they published to four digits is met as well.
#include "chung_ooi_solids.h"

enum
{
    NUM_STEPS = 3 ///< time steps of an impact, each a quarter of the one before
};

/// Restitutions at time steps of t_c/num and a quarter and a sixteenth of it.
/// Damped: the force starts as d^(1/4), of which a sum over steps misses a part that goes as dt^(5/4), w dt of the
/// speed at the most. What does not depend on the step, `offset` at the most, is gone in differences; with a quarter of
/// the step they are a quarter or less for an order of one, at the most a third. Elastic: of second order, (w dt)^2/4;
/// how much of it depends on where within a step contact ends.
static void check_order(double wanted, int num, const double e[NUM_STEPS], double offset)
{
    printf("  e = %g: errors %.2e, %.2e and %.2e with %d, %d and %d steps\n", wanted, e[0] - wanted, e[1] - wanted,
           e[2] - wanted, num, 4 * num, 16 * num);
    for (int s = 0; s < NUM_STEPS; ++s)
    {
        const double share = M_PI / (num << 2 * s);
        SCREE_CHECK_CLOSE(e[s], wanted, offset + (wanted < 1 ? share : share * share / 4));
    }
    if (wanted < 1) SCREE_CHECK(fabs(e[2] - e[1]) < fabs(e[1] - e[0]) / 3);
}

/// Elastic impact at t_c/dt = 50 and 200 against Hertz's closed form and the published values (0: none).
static void check_elastic(const char *name, impact_def def, double deepest, double force, double time)
{
    double error[2][4];
    for (int k = 0; k < 2; ++k)
    {
        const int num = k == 0 ? 50 : 200;
        def.time_step = hertz_contact_time(&def) / num;
        const impact_result r = impact_run(&def);
        error[k][0] = fabs(r.deepest / hertz_deepest(&def) - 1);
        error[k][1] = fabs(r.largest_force / hertz_largest_force(&def) - 1);
        error[k][2] = fabs(r.contact_time / hertz_contact_time(&def) - 1);
        error[k][3] = fabs(r.kinetic_after / r.kinetic_before - 1);
        printf("%s, t_c/dt = %d: relative errors of d_max %.1e, F_max %.1e, t_c %.1e, energy %.1e\n", name, num,
               error[k][0], error[k][1], error[k][2], error[k][3]);
        // second order: velocity Verlet errs by (w dt)^2/8 at most in an oscillation of frequency w = pi/t_c, as much
        // again at the ends of the contact, where the force has a kink; force and energy go with higher powers
        const double square = pow(M_PI / num, 2);
        SCREE_CHECK(error[k][0] < square / 4 && error[k][2] < square / 4);
        SCREE_CHECK(error[k][1] < 1.5 * square / 4 && error[k][3] < 2 * square / 4);
        if (k == 0) continue;
        SCREE_CHECK_CLOSE(r.deepest, deepest, 0.005 * deepest);
        SCREE_CHECK_CLOSE(r.largest_force, force, 0.005 * force);
        SCREE_CHECK_CLOSE(r.contact_time, time, 0.005 * time);
    }
    // a quarter of the step, a sixteenth of the error: at least an eighth
    for (int q = 0; q < 3; ++q) SCREE_CHECK(error[1][q] < error[0][q] / 8);
}

static void test_1_elastic_impact_of_two_spheres(void)
{
    const solid solids[2] = {glass, limestone};
    const double published[2][3] = {{274.1e-6, 10.697e3, 40.34e-6}, {368.3e-6, 7.108e3, 54.20e-6}};
    for (int k = 0; k < 2; ++k)
    {
        impact_def def = define(solids[k], 0.01, 10);
        def.body[1] = (impact_body){0.01, {0, 0, 10}, {0}};
        check_elastic(solids[k].name, def, published[k][0], published[k][1], published[k][2]);
    }
}

static void test_2_elastic_impact_on_a_plane(void)
{
    const solid solids[2] = {al_alloy, mg_alloy};
    const double published[2][3] = {{49.72e-6, 11.370e3, 731.7e-6}, {52.12e-6, 7.233e3, 767.1e-6}};
    for (int k = 0; k < 2; ++k)
        check_elastic(solids[k].name, define(solids[k], 0.1, 0.2), published[k][0], published[k][1], published[k][2]);
}

static void test_3_restitution(void)
{
    const solid solids[2] = {al_oxide, cast_iron};
    const double published[2][3] = {{8.089e-6, 615.4, 6.105e-6}, {17.19e-6, 506.8, 12.97e-6}};
    for (int k = 0; k < 2; ++k)
    {
        impact_def def = define(solids[k], 0.0025, 3.9);
        check_elastic(solids[k].name, def, published[k][0], published[k][1], published[k][2]);
        for (int n = 1; n <= 5; ++n)
        {
            double e[NUM_STEPS];
            for (int s = 0; s < NUM_STEPS; ++s)
            {
                def.restitution = 0.2 * n;
                def.time_step = hertz_contact_time(&def) / (1000 << 2 * s);
                e[s] = impact_run(&def).velocity[0][2] / 3.9;
                SCREE_CHECK_CLOSE(e[s], def.restitution, 1e-3);
            }
            check_order(def.restitution, 1000, e, 0);
        }
    }
}

/// Impact that slides from touch to separation: friction is mu F_n in every step, so whatever the restitution is in the
/// numbers, the impulses keep the ratio mu to rounding at any time step: twice 2e-16 of a speed for each step. The
/// tangential force acts at the depth d/2, where the arm is up to d_max/R shorter than the radius. Between two spheres
/// the normal turns with the line of centres, and both impulses with it. Returns how far [rad].
static double check_sliding(const char *name, const impact_def *def, double *restitution)
{
    const impact_result r = impact_run(def);
    const int num = def->body[1].radius > 0 ? 2 : 1;
    const double sense = def->body[0].velocity[0] - def->body[0].spin[1] * def->body[0].radius > 0 ? 1 : -1;
    const double rolled = num > 1 ? fabs(r.velocity[0][0] - r.velocity[1][0]) * r.contact_time : 0;
    const double turn = num > 1 ? rolled / (def->body[0].radius + def->body[1].radius) : 0;
    const double scale = fabs(def->body[0].velocity[0]) + fabs(def->body[0].velocity[2]);
    const double rounding = 4e-16 * r.contact_time / def->time_step * scale;
    for (int k = 0; k < num; ++k)
    {
        const impact_body *b = def->body + k;
        const double pushed = r.velocity[k][2] - b->velocity[2], rubbed = r.velocity[k][0] - b->velocity[0];
        SCREE_CHECK_CLOSE(rubbed, -sense * def->friction * pushed,
                          rounding + turn * (1 + def->friction * def->friction) * fabs(pushed));
        // both spins change in the same sense: the forces and the arms are opposite
        const double spun = r.spin[k][1] - b->spin[1];
        const double expected = sense * 2.5 * def->friction * fabs(pushed) / b->radius;
        SCREE_CHECK_CLOSE(spun, expected, fabs(expected) * (hertz_deepest(def) / b->radius + turn));
        if (k == 0)
            printf("%s: v_t' %.5f m/s, spin %.5g, closed form %.5g rad/s\n", name, r.velocity[0][0], r.spin[0][1],
                   b->spin[1] + expected);
    }
    const double before = impact_approach(def), after = r.velocity[0][2] - (num > 1 ? r.velocity[1][2] : 0);
    *restitution = after / before;
    return turn;
}

/// Speed and spin after sliding throughout: e_t = 1 - mu (1 + e)/tan, spin = 2.5 mu (1 + e) v_n/R.
static void test_4_oblique_impact(void)
{
    const double degrees[] = {40, 60, 80}, e_t[] = {0.7829, 0.8948, 0.9679}, spin[] = {544.2, 355.2, 123.4};
    for (int k = 0; k < 3; ++k)
    {
        impact_def def = define(al_oxide, 0.0025, 0);
        const double angle = degrees[k] * M_PI / 180;
        def.body[0].velocity[0] = 3.9 * sin(angle);
        def.body[0].velocity[2] = -3.9 * cos(angle);
        def.friction = 0.092;
        def.restitution = 0.98;
        double e[NUM_STEPS];
        for (int s = 0; s < NUM_STEPS; ++s)
        {
            def.time_step = hertz_contact_time(&def) / (100 << 2 * s);
            const impact_result r = impact_run(&def);
            SCREE_CHECK_CLOSE(r.velocity[0][0] / def.body[0].velocity[0], e_t[k], 1e-3);
            SCREE_CHECK_CLOSE(r.spin[0][1], spin[k], 0.005 * spin[k]);
            check_sliding("4, Al oxide", &def, e + s);
        }
        check_order(0.98, 100, e, 0);
    }
}

/// Small spheres, high speeds along the plane; gross sliding from tan = 3.5 mu (1 + e) on.
static void test_5_constant_normal_velocity(void)
{
    const solid solids[2] = {steel, polyethylene};
    for (int k = 0; k < 2; ++k)
        for (double tangent = 2.2; tangent < 10; tangent *= 2)
        {
            impact_def def = define(solids[k], 1e-5, 5);
            def.body[0].velocity[0] = 5 * tangent;
            def.friction = 0.3;
            double e[NUM_STEPS];
            for (int s = 0; s < NUM_STEPS; ++s)
            {
                def.time_step = hertz_contact_time(&def) / (200 << 2 * s);
                check_sliding(solids[k].name, &def, e + s);
            }
            check_order(1, 200, e, 0);
        }
}

/// Spin alone; 6 on a plane, 8 on a sphere five times as large.
static void check_spin(const char *name, solid of, double partner)
{
    for (double spin = 10; spin < 50; spin *= 2) // from 3.5 mu (1 + e) v/R = 4.2 rad/s on it slides throughout
    {
        impact_def def = define(of, 0.1, 0.2);
        if (partner > 0) def.body[1].radius = partner;
        def.body[0].spin[1] = -spin;
        def.friction = 0.4;
        def.restitution = 0.5;
        double e[NUM_STEPS], turn = 0;
        for (int s = 0; s < NUM_STEPS; ++s)
        {
            def.time_step = hertz_contact_time(&def) / (400 << 2 * s);
            turn = check_sliding(name, &def, e + s);
        }
        // where the normal turns, friction lends it a part, and it takes one of the speed along the surface
        check_order(0.5, 400, e, 2 * def.friction * 1.5 * turn);
    }
}

static void test_6_spin_on_a_plane(void)
{
    check_spin(al_alloy.name, al_alloy, 0);
    check_spin(nylon.name, nylon, 0);
}

/// Equal spheres whose surfaces move alike at the contact: nothing rubs.
static void test_7_counter_spin_of_equal_spheres(void)
{
    const solid solids[2] = {al_alloy, copper};
    for (int k = 0; k < 2; ++k)
    {
        impact_def def = define(solids[k], 0.1, 0.2);
        def.body[1] = (impact_body){0.1, {0, 0, 0.2}, {0, 7, 0}};
        def.body[0].spin[1] = -7;
        def.friction = 0.4;
        def.restitution = 0.5;
        double e[NUM_STEPS];
        for (int s = 0; s < NUM_STEPS; ++s)
        {
            def.time_step = hertz_contact_time(&def) / (400 << 2 * s);
            const impact_result r = impact_run(&def);
            for (int b = 0; b < 2; ++b)
            {
                SCREE_CHECK_CLOSE(r.velocity[b][0], 0, 1e-15);
                SCREE_CHECK(r.velocity[b][1] == 0);
                SCREE_CHECK_CLOSE(r.spin[b][1], b == 0 ? -7 : 7, 1e-14);
            }
            e[s] = (r.velocity[0][2] - r.velocity[1][2]) / 0.4;
        }
        check_order(0.5, 400, e, 0);
    }
}

static void test_8_spin_on_a_larger_sphere(void)
{
    check_spin(al_alloy.name, al_alloy, 0.5);
    check_spin(nylon.name, nylon, 0.5);
}

int main(void)
{
    SCREE_RUN(test_1_elastic_impact_of_two_spheres);
    SCREE_RUN(test_2_elastic_impact_on_a_plane);
    SCREE_RUN(test_3_restitution);
    SCREE_RUN(test_4_oblique_impact);
    SCREE_RUN(test_5_constant_normal_velocity);
    SCREE_RUN(test_6_spin_on_a_plane);
    SCREE_RUN(test_7_counter_spin_of_equal_spheres);
    SCREE_RUN(test_8_spin_on_a_larger_sphere);
    return SCREE_TEST_END();
}
