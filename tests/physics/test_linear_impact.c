// Impacts of spheres by model linear_spring, whose motion has closed forms: time in contact, restitution, sticking
// friction; and what every impact keeps: momentum and the balance of energy.
#include "sphere_impact.h"

static const double stiffness = 1e6;

/// A ball of 1 cm that comes down slowly, so that it dips in by less than 1e-5 of its radius.
static impact_def define(double speed, double restitution)
{
    impact_def def = {1e9, 0.25, 2500, .restitution = restitution,
                      .law = ", model: linear_spring, normal_stiffness: 1e6"};
    def.body[0].radius = 0.01;
    def.body[0].velocity[2] = -speed;
    return def;
}

/// t_c = sqrt(m*/k) sqrt(pi^2 + ln^2 e) where the force may attract to the end; e itself in any case.
static void test_contact_time_and_restitution(void)
{
    const double values[] = {0.3, 0.7, 1};
    for (int k = 0; k < 3; ++k)
    {
        impact_def def = define(1e-3, values[k]);
        def.law = ", model: linear_spring, normal_stiffness: 1e6, attraction: true";
        const double expected = sqrt(impact_mass(&def, 0) / stiffness) * sqrt(M_PI * M_PI + pow(log(values[k]), 2));
        for (int num = 200; num <= 3200; num *= 16)
        {
            def.time_step = expected / num;
            const impact_result r = impact_run(&def);
            // the jump of the damping force and the end of the contact are met within half a step each: first order
            SCREE_CHECK_CLOSE(r.contact_time / expected, 1, 1.0 / num);
            SCREE_CHECK_CLOSE(r.velocity[0][2] / 1e-3, values[k], M_PI / num);
            def.law = ", model: linear_spring, normal_stiffness: 1e6";
            SCREE_CHECK_CLOSE(impact_run(&def).velocity[0][2] / 1e-3, values[k], M_PI / num);
            def.law = ", model: linear_spring, normal_stiffness: 1e6, attraction: true";
        }
    }
}

/// Without damping and sliding the point of contact swings with w_t = sqrt(3.5 k_t/m), the ball against the plane with
/// w_n = sqrt(k_n/m). With k_t/k_n = 2/7 the contact ends after half a swing, v_s' = -v_s, with 8/7 after a whole one,
/// v_s' = v_s; the tangential force is then bounded by v_t/v_n times the normal one all the time, so it does not slide.
static void test_sticking_friction(void)
{
    for (int whole = 0; whole < 2; ++whole)
    {
        impact_def def = define(1e-3, 1);
        char law[200];
        snprintf(law, sizeof law, ", model: linear_spring, normal_stiffness: 1e6, tangential_stiffness: %.17g",
                 (whole ? 8.0 : 2.0) / 7.0 * stiffness);
        def.law = law;
        def.friction = 10;
        def.body[0].velocity[0] = 2e-3;
        double error[2];
        for (int k = 0; k < 2; ++k)
        {
            const int num = k == 0 ? 50 : 200;
            def.time_step = M_PI * sqrt(impact_mass(&def, 0) / stiffness) / num;
            const impact_result r = impact_run(&def);
            // of -2 v_s that the point of contact changes by, 2/7 are translation and 5/7 spin
            const double slip = 2e-3, change = whole ? 0 : -2 * slip;
            error[k] = fabs(r.velocity[0][0] - (slip + 2.0 / 7.0 * change)) / slip +
                       fabs(r.spin[0][1] + 5.0 / 7.0 * change / 0.01) * 0.01 / slip;
            printf("k_t/k_n = %s, t_c/dt = %d: v_t' %.7g m/s, spin %.7g rad/s, error %.2e\n", whole ? "8/7" : "2/7",
                   num, r.velocity[0][0], r.spin[0][1], error[k]);
            // The period errs by (w dt)^2/24 for w_n as for w_t (twice as fast, so four times as much, if whole), the
            // phase at the end by pi times that; at a turning point of v_s that would count twice only. The spring is
            // integrated from velocities of the step's end: half a step of phase, w dt/2, of first order. The arm is
            // shorter than R by d/2.
            SCREE_CHECK(error[k] < 2 * (1 + whole) * M_PI / num + 1e-5);
        }
        SCREE_CHECK(error[1] < 0.3 * error[0]);
    }
}

/// Oblique impact of unequal balls with friction and damping: momentum to rounding, the balance of energy by order.
static void test_momentum_and_energy(void)
{
    impact_def def = define(0.5, 0.7);
    def.body[0].velocity[0] = 0.3;
    def.body[0].velocity[1] = -0.1;
    def.body[0].spin[2] = 30;
    def.body[1] = (impact_body){0.006, {-0.2, 0.1, 0.4}, {10, -40, 5}};
    def.friction = 0.3;
    const char *laws[] = {
        "", ", model: linear_spring, normal_stiffness: 1e6",
        ", rolling_resistance: spring, rolling_friction_coefficient: 0.2, rolling_damping_ratio: 0.3"};
    for (int model = 0; model < 3; ++model)
    {
        double error[2];
        def.law = laws[model];
        for (int k = 0; k < 2; ++k)
        {
            def.time_step = hertz_contact_time(&def) / (k == 0 ? 100 : 400);
            const impact_result r = impact_run(&def);
            for (int c = 0; c < 3; ++c)
            {
                double before = 0, after = 0, scale = 0;
                for (int b = 0; b < 2; ++b)
                {
                    before += impact_mass(&def, b) * def.body[b].velocity[c];
                    after += impact_mass(&def, b) * r.velocity[b][c];
                    scale += impact_mass(&def, b) * 0.6;
                }
                // one rounding of each momentum in each half step, 1000 of them at most
                SCREE_CHECK_CLOSE(after, before, 1000 * 2.2e-16 * scale);
            }
            error[k] = fabs(r.balance_after - r.balance_before) / r.kinetic_before;
            printf("%s: lost %.3g of the energy, balance off by %.2e\n", model == 1 ? "linear_spring" : "hertz_mindlin",
                   1 - r.kinetic_after / r.kinetic_before, error[k]);
        }
        // in the balance nothing is lost but what rounding takes and the orientation's order leaves
        SCREE_CHECK(error[0] < pow(M_PI / 100, 2) && error[1] < pow(M_PI / 400, 2));
    }
}

/// The automatic step knows the spring: half of sqrt(m/7/k), a partner of equal mass hit along the tangent, k the
/// stiffer of the two springs. A run counts sqrt(m/k) for a ball on a plane.
static void test_automatic_time_step(void)
{
    const double tangential[] = {5e5, 4e6};
    for (int k = 0; k < 2; ++k)
    {
        char text[1000];
        snprintf(text, sizeof text,
                 "time: {end: 1}\nmaterials: [{name: glass, density: 2500, youngs_modulus: 1e9, poisson_ratio: 0.25}]\n"
                 "contact_laws: [{materials: [glass, glass], model: linear_spring, normal_stiffness: 1e6, "
                 "tangential_stiffness: %g, friction_coefficient: 0.3, damping_ratio: 0.1}]\n"
                 "shapes: [{name: ball, source: sphere, size: 0.02}, {name: plate, source: box, size: [1, 1, 0.1]}]\n"
                 "particles: [{name: one, shape: ball, material: glass, bodies: [{position: [0, 0, 0.00999]}]}]\n"
                 "walls: [{name: floor, shape: plate, material: glass, position: [0, 0, -0.05]}]\n",
                 tangential[k]);
        scene_run run;
        scene_run_start(&run, text);
        if (run.simulation == NULL) return;
        const double mass = (double)run.simulation->particles.mass[0], largest = fmax(stiffness, tangential[k]);
        SCREE_CHECK_CLOSE(scree_simulation_time_step(run.simulation), 0.5 * sqrt(mass / 7 / largest),
                          1e-15 * sqrt(mass / largest));
        SCREE_CHECK_INT(scree_simulation_step(run.simulation, &run.report), SCREE_OK);
        SCREE_CHECK_CLOSE(scree_simulation_counters(run.simulation).smallest_critical_step, sqrt(mass / largest),
                          1e-14 * sqrt(mass / largest));
        scene_run_end(&run);
    }
}

int main(void)
{
    SCREE_RUN(test_contact_time_and_restitution);
    SCREE_RUN(test_sticking_friction);
    SCREE_RUN(test_momentum_and_energy);
    SCREE_RUN(test_automatic_time_step);
    return SCREE_TEST_END();
}
