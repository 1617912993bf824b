// A ball on a plane: sliding that becomes rolling, rolling and slipping down an incline, rolling resistance. The ball
// starts at the depth where the plane carries it, so that the normal force is its weight from the first step on.
#include "scene_run.h"

static const double radius = 0.01, gravity = 9.81;

/// What is known before the run.
typedef struct ball
{
    scene_run run;
    double arm;   ///< [m] from the centre to the point of contact, in the middle of the overlap
    double share; ///< 1/(1 + I/(m arm^2)): of the sliding speed left when it rolls; 5/7 for arm = R
} ball;

/// The plane is tilted by atan(tangent): gravity has a part along x.
static void start(ball *b, double tangent, double friction, double speed, double time_step, const char *law)
{
    const double angle = atan(tangent), mass = 2500 * 4.0 / 3.0 * M_PI * pow(radius, 3), modulus = 1e8 / (2 * 0.9375);
    const double depth = pow(0.75 * mass * gravity * cos(angle) / (modulus * sqrt(radius)), 2.0 / 3.0);
    char text[2000];
    snprintf(
        text, sizeof text,
        "gravity: [%.17g, 0, %.17g]\ntime: {end: 2, step: %.17g}\n"
        "materials: [{name: glass, density: 2500, youngs_modulus: 1e8, poisson_ratio: 0.25}]\n"
        "contact_laws: [{materials: [glass, glass], friction_coefficient: %.17g, restitution_coefficient: 0.5%s}]\n"
        "shapes: [{name: ball, source: sphere, size: 0.02}, {name: plate, source: box, size: [20, 2, 0.2]}]\n"
        "particles:\n  - {name: one, shape: ball, material: glass, bodies: [{position: [0, 0, %.17g], "
        "velocity: [%.17g, 0, 0]}]}\n"
        "walls:\n  - {name: floor, shape: plate, material: glass, position: [0, 0, -0.1]}\n",
        gravity * sin(angle), -gravity * cos(angle), time_step, friction, law, radius - depth, speed);
    scene_run_start(&b->run, text);
    b->arm = radius - depth / 2;
    b->share = 1 / (1 + 0.4 * radius * radius / (b->arm * b->arm));
}

static double speed_of(const ball *b) { return (double)b->run.simulation->particles.velocity[0].x; }
static double spin_of(const ball *b)
{
    const scree_particles *p = &b->run.simulation->particles;
    return (double)p->angular_momentum[0].y / (double)p->inertia[0].y;
}

/// It slides with the deceleration mu g until 2 v0/(7 mu g) and rolls at 5/7 v0 from then on.
static void test_sliding_becomes_rolling(void)
{
    const double v0 = 0.5, mu = 0.3, end = 2 * v0 / (7 * mu * gravity);
    for (double dt = 1e-5; dt > 2e-6; dt /= 4)
    {
        ball b;
        start(&b, 0, mu, v0, dt, "");
        if (b.run.simulation == NULL) return;
        scene_run_until(&b.run, 0.9 * end);
        const double time = scree_simulation_time(b.run.simulation);
        // the first half step has the full force already; then it is constant
        SCREE_CHECK_CLOSE(speed_of(&b), v0 - mu * gravity * time, mu * gravity * dt);
        SCREE_CHECK_CLOSE(spin_of(&b), 2.5 * mu * gravity * time * b.arm / (radius * radius), 250 * mu * gravity * dt);
        scene_run_until(&b.run, 3 * end);
        printf("dt = %g s: rolls at %.9f m/s, 5/7 v0 = %.9f, with the arm of the contact %.9f\n", dt, speed_of(&b),
               5.0 / 7.0 * v0, b.share * v0);
        // angular momentum about the line of contact points is kept in every step, so the end depends on the arm alone
        SCREE_CHECK_CLOSE(speed_of(&b), b.share * v0, 1e-9 * v0);
        SCREE_CHECK_CLOSE(spin_of(&b) * b.arm, speed_of(&b), 1e-9 * v0);
        SCREE_CHECK_CLOSE(speed_of(&b), 5.0 / 7.0 * v0, v0 * (radius - b.arm) / radius);
        scene_run_end(&b.run);
    }
}

/// Mean acceleration between two times after the start has died out.
static double acceleration(ball *b, double from, double to)
{
    scene_run_until(&b->run, from);
    const double v = speed_of(b), t = scree_simulation_time(b->run.simulation);
    scene_run_until(&b->run, to);
    return (speed_of(b) - v) / (scree_simulation_time(b->run.simulation) - t);
}

/// On an incline it rolls if mu >= 2/7 tan, a = 5/7 g sin; else it slips, a = g (sin - mu cos).
static void test_ball_on_an_incline(void)
{
    const double tangents[] = {0.2, 0.5, 1.0}, mu = 0.1; // rolls below tan = 0.35
    for (int k = 0; k < 3; ++k)
        for (double dt = 1e-5; dt > 2e-6; dt /= 4)
        {
            const double angle = atan(tangents[k]);
            const bool is_rolling = mu >= 2.0 / 7.0 * tangents[k];
            ball b;
            start(&b, tangents[k], mu, 0, dt, "");
            if (b.run.simulation == NULL) return;
            const double rolling = b.share * gravity * sin(angle);
            const double slipping = gravity * (sin(angle) - mu * cos(angle));
            const double expected = is_rolling ? rolling : slipping, found = acceleration(&b, 0.1, 0.2);
            printf("tan %.2f, dt %g: acceleration %.9f, expected %.9f m/s^2\n", tangents[k], dt, found, expected);
            SCREE_CHECK_CLOSE(found, expected, 1e-9 * gravity);
            if (is_rolling)
                SCREE_CHECK_CLOSE(found, 5.0 / 7.0 * gravity * sin(angle), gravity * (radius - b.arm) / radius);
            scene_run_end(&b.run);
        }
}

/// Above tan = mu_r the resistance takes its constant share, a = (g sin - mu_r (R/arm) g cos)/(1 + I/(m arm^2)).
static void test_rolling_resistance_on_an_incline(void)
{
    const char *kinds[] = {"constant", "spring"};
    for (int k = 0; k < 2; ++k)
        for (double dt = 1e-5; dt > 2e-6; dt /= 4)
        {
            const double tangent = 0.3, rolling_friction = 0.1, angle = atan(tangent);
            char law[200];
            snprintf(law, sizeof law, ", rolling_resistance: %s, rolling_friction_coefficient: %g", kinds[k],
                     rolling_friction);
            ball b;
            start(&b, tangent, 0.5, 0, dt, law);
            if (b.run.simulation == NULL) return;
            const double expected = b.share * gravity * (sin(angle) - rolling_friction * radius / b.arm * cos(angle));
            const double found = acceleration(&b, 0.1, 0.2);
            printf("%s, dt %g: acceleration %.9f, expected %.9f m/s^2\n", kinds[k], dt, found, expected);
            SCREE_CHECK_CLOSE(found, expected, 1e-9 * gravity);
            scene_run_end(&b.run);
        }
}

/// Below it the spring holds the ball. It has come to rest: its last swing dies out by rolling damping.
static void test_rolling_spring_holds_a_ball(void)
{
    for (double dt = 1e-5; dt > 2e-6; dt /= 4)
    {
        ball b;
        start(&b, 0.09, 0.5, 0, dt,
              ", rolling_resistance: spring, rolling_friction_coefficient: 0.1, rolling_damping_ratio: 0.3");
        if (b.run.simulation == NULL) return;
        scene_run_until(&b.run, 0.4);
        const double x = (double)b.run.simulation->particles.position[0].x;
        scene_run_until(&b.run, 0.5);
        printf("held, dt %g: speed %.2e m/s, moved %.2e m after %.9e m\n", dt, speed_of(&b),
               (double)b.run.simulation->particles.position[0].x - x, x);
        SCREE_CHECK(fabs(speed_of(&b)) < 1e-9);
        SCREE_CHECK_CLOSE(b.run.simulation->particles.position[0].x, x, 1e-10);
        // what balances it, at any step: the moment of the weight about the point of contact
        const double mass = (double)b.run.simulation->particles.mass[0], angle = atan(0.09);
        SCREE_CHECK_CLOSE(b.run.simulation->contacts.moment[0].y, -mass * gravity * sin(angle) * b.arm,
                          1e-6 * mass * gravity * radius);
        scene_run_end(&b.run);
    }
}

int main(void)
{
    SCREE_RUN(test_sliding_becomes_rolling);
    SCREE_RUN(test_ball_on_an_incline);
    SCREE_RUN(test_rolling_resistance_on_an_incline);
    SCREE_RUN(test_rolling_spring_holds_a_ball);
    return SCREE_TEST_END();
}
