// Rolling resistance of clumps and polyhedra: the limit mu_r R F_n with R of the sphere of the same volume. A dumbbell
// rolls down an incline like a roller, a roller of many flat sides spins on a smooth plate.
#include "scene_run.h"

static const double gravity = 9.81, modulus = 1e8 / (2 * 0.9375); // E* of two bodies with E 1e8 Pa, nu 0.25

/// A dumbbell across the slope, each of its spheres at the depth where it carries half the weight.
typedef struct dumbbell
{
    scene_run run;
    double arm;   ///< [m] from the axis to the points of contact
    double share; ///< 1/(1 + I/(m arm^2))
    double equal; ///< [m] radius of the sphere of the same volume
} dumbbell;

static void start_dumbbell(dumbbell *d, double tangent, const char *law)
{
    const double radius = 0.01, half = 0.008, angle = atan(tangent);
    // each a ball cut at the middle; about the axis pi/2 times the integral of (r^2 - x^2)^2 from -half to r
    const double h = radius - half, volume = 2 * (4.0 / 3.0 * M_PI * pow(radius, 3) - M_PI * h * h * (radius - h / 3));
    const double r2 = radius * radius, r4 = r2 * r2;
    const double inertia =
        2 * M_PI / 2 *
        (r4 * (radius + half) - 2.0 / 3.0 * r2 * (pow(radius, 3) + pow(half, 3)) + (pow(radius, 5) + pow(half, 5)) / 5);
    const double press = 2500 * volume * gravity * cos(angle) / 2;
    const double depth = pow(0.75 * press / (modulus * sqrt(radius)), 2.0 / 3.0);
    char text[2000];
    snprintf(text, sizeof text,
             "gravity: [%.17g, 0, %.17g]\ntime: {end: 2, step: 1e-5}\n"
             "materials: [{name: glass, density: 2500, youngs_modulus: 1e8, poisson_ratio: 0.25}]\n"
             "contact_laws: [{materials: [glass, glass], friction_coefficient: 0.5, restitution_coefficient: 0.5%s}]\n"
             "shapes: [{name: two, source: clump, spheres: [{position: [0, %.17g, 0], radius: 0.01},\n"
             "  {position: [0, %.17g, 0], radius: 0.01}]}, {name: plate, source: box, size: [20, 2, 0.2]}]\n"
             "particles: [{name: one, shape: two, material: glass, bodies: [{position: [0, 0, %.17g]}]}]\n"
             "walls: [{name: floor, shape: plate, material: glass, position: [0, 0, -0.1]}]\n",
             gravity * sin(angle), -gravity * cos(angle), law, -half, half, radius - depth);
    scene_run_start(&d->run, text);
    d->arm = radius - depth / 2;
    d->share = 1 / (1 + inertia / volume / (d->arm * d->arm));
    d->equal = cbrt(volume * 3 / (4 * M_PI));
}

static double speed_of(const dumbbell *d) { return (double)d->run.simulation->particles.velocity[0].x; }

/// a = (g sin - mu_r (R/arm) g cos)/(1 + I/(m arm^2)) of both kinds, and 0 resistance for comparison.
static void test_a_dumbbell_rolls_down(void)
{
    static const char *const laws[] = {"", ", rolling_resistance: constant, rolling_friction_coefficient: 0.1",
                                       ", rolling_resistance: spring, rolling_friction_coefficient: 0.1"};
    for (int k = 0; k < 3; ++k)
    {
        const double angle = atan(0.3), resistance = k == 0 ? 0 : 0.1;
        dumbbell d;
        start_dumbbell(&d, 0.3, laws[k]);
        if (d.run.simulation == NULL) return;
        scene_run_until(&d.run, 0.1);
        const double v = speed_of(&d);
        scene_run_until(&d.run, 0.2);
        const double found = (speed_of(&d) - v) / 0.1;
        const double expected = d.share * gravity * (sin(angle) - resistance * d.equal / d.arm * cos(angle));
        printf("dumbbell%s: acceleration %.9f, expected %.9f m/s^2\n", laws[k], found, expected);
        SCREE_CHECK_INT(d.run.simulation->contacts.num_contacts, 2);
        // moment of inertia and volume are right to 1e-9
        SCREE_CHECK_CLOSE(found, expected, 1e-8 * gravity);
        scene_run_end(&d.run);
    }
}

/// Below the limit the springs hold it: their moments balance that of the weight.
static void test_springs_hold_a_dumbbell(void)
{
    dumbbell d;
    start_dumbbell(&d, 0.09,
                   ", rolling_resistance: spring, rolling_friction_coefficient: 0.1, rolling_damping_ratio: 0.3");
    if (d.run.simulation == NULL) return;
    scene_run_until(&d.run, 0.5);
    const double angle = atan(0.09), mass = (double)d.run.simulation->particles.mass[0];
    const scree_vec3 *moment = d.run.simulation->contacts.moment;
    printf("held: speed %.2e m/s\n", speed_of(&d));
    SCREE_CHECK(fabs(speed_of(&d)) < 1e-9);
    SCREE_CHECK_CLOSE((double)(moment[0].y + moment[1].y), -mass * gravity * sin(angle) * d.arm,
                      1e-6 * mass * gravity * d.arm);
    scene_run_end(&d.run);
}

/// Change of the angular momentum of a roller of 120 flat sides that spins about its axis on a plate without friction,
/// and what rolling resistance takes: the moment is mu_r R F_n and the impulse of F_n is that of the weight, so
/// mu_r R (m g T + m dv).
typedef struct roller
{
    double change, start, expected;
} roller;

static roller spin_roller(const char *kind)
{
    const double radius = 0.02, half = 0.015, spin = 60, resistance = 0.05, end = 0.2;
    char law[100], text[2000];
    snprintf(law, sizeof law, "rolling_resistance: %s, rolling_friction_coefficient: %g", kind, resistance);
    snprintf(text, sizeof text,
             "time: {end: 1, step: 1e-5}\n"
             "materials: [{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"
             "contact_laws: [{materials: [stone, stone], friction_coefficient: 0, damping_ratio: 0.2,\n"
             "  contact_moments: false, %s}]\n"
             "shapes: [{name: plate, source: box, size: [2, 2, 0.2]}, {name: roller, source: turned, segments: 120,\n"
             "  profile: [{radius: 0, height: %g}, {radius: %g, height: %g}, {radius: %g, height: %g},\n"
             "  {radius: 0, height: %g}]}]\n"
             "particles: [{name: one, shape: roller, material: stone, bodies: [{position: [0, 0, %g],\n"
             "  orientation: [1, 1, 0, 0], angular_velocity: [0, %g, 0]}]}]\n"
             "walls: [{name: floor, shape: plate, material: stone, position: [0, 0, -0.1]}]\n",
             strcmp(kind, "none") == 0 ? "rolling_resistance: none" : law, -half, radius, -half, radius, half, half,
             radius, spin);
    roller r = {NAN, 0, 0};
    scene_run run;
    scene_run_start(&run, text);
    if (run.simulation == NULL) return r;
    const scree_particles *p = &run.simulation->particles;
    scene_run_until(&run, 0.05); // the plate has taken it up
    const double v = (double)p->velocity[0].z;
    r.start = (double)p->angular_momentum[0].y;
    scene_run_until(&run, 0.05 + end);
    const double mass = (double)p->mass[0], equal = cbrt(mass / 2500 * 3 / (4 * M_PI));
    r.change = (double)p->angular_momentum[0].y - r.start;
    r.expected = -resistance * equal * mass * (gravity * end + (double)p->velocity[0].z - v);
    scene_run_end(&run);
    return r;
}

static void test_a_roller_of_flat_sides(void)
{
    // the sides bounce on the plate, whose damping slows the roller down a little too
    const roller free = spin_roller("none");
    static const char *const kinds[] = {"constant", "spring"};
    for (int k = 0; k < 2; ++k)
    {
        const roller r = spin_roller(kinds[k]);
        printf("roller, %s: angular momentum %.6g of %.6g; resistance %.6g, by the sides %.3g\n", kinds[k], r.change,
               r.start, r.expected, free.change);
        SCREE_CHECK(fabs(free.change) < 0.01 * fabs(r.expected));
        SCREE_CHECK_CLOSE(r.change, r.expected, 2 * fabs(free.change));
        SCREE_CHECK(fabs(r.change) > 0.15 * fabs(r.start));
    }
}

int main(void)
{
    SCREE_RUN(test_a_dumbbell_rolls_down);
    SCREE_RUN(test_springs_hold_a_dumbbell);
    SCREE_RUN(test_a_roller_of_flat_sides);
    return SCREE_TEST_END();
}
