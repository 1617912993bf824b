// Elastic collisions without friction: energy_conserving keeps the kinetic energy to the order of the integrator,
// whatever the shapes; hertz_mindlin on the overlap volume does not.
#include "scene_run.h"

/// Two bodies at random orientations fly into each other off centre, at t = 0 apart and at the end apart again. Returns
/// the kinetic energy after over before, minus 1, and the greatest elastic energy on the way over the kinetic one.
static double collide(const char *shape, const char *law, int seed, double time_step, double *stored, double *balance)
{
    uint64_t state = (uint64_t)seed;
    double q[8], offset[2];
    for (int k = 0; k < 8; ++k) q[k] = 2 * scree_test_random(&state) - 1;
    for (int k = 0; k < 2; ++k) offset[k] = 0.04 * (scree_test_random(&state) - 0.5);
    char text[2000];
    snprintf(
        text, sizeof text,
        "gravity: [0, 0, 0]\ntime: {end: 0.05, step: %.17g}\n"
        "materials: [{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"
        "contact_laws: [{materials: [stone, stone], friction_coefficient: 0, damping_ratio: 0, contact_moments: "
        "false, %s}]\n"
        "shapes:\n  - {name: body, %s}\n"
        "particles:\n  - name: two\n    shape: body\n    material: stone\n    bodies:\n"
        "      - {position: [-0.09, 0, 0], velocity: [2, 0, 0], orientation: [%.17g, %.17g, %.17g, %.17g]}\n"
        "      - {position: [0.09, %.17g, %.17g], velocity: [-2, 0, 0], orientation: [%.17g, %.17g, %.17g, %.17g]}\n",
        time_step, law, shape, q[0], q[1], q[2], q[3], offset[0], offset[1], q[4], q[5], q[6], q[7]);
    scene_run run;
    scene_run_start(&run, text);
    if (run.simulation == NULL) return NAN;
    const scree_energies before = scree_simulation_energies(run.simulation);
    *stored = 0;
    for (int64_t step = 0; step < scree_simulation_num_steps(run.simulation); ++step)
    {
        SCREE_CHECK_INT(scree_simulation_step(run.simulation, &run.report), SCREE_OK);
        if (run.simulation->contacts.num_contacts > 0)
            *stored = fmax(*stored, scree_simulation_energies(run.simulation).elastic_normal / before.kinetic);
    }
    const scree_energies after = scree_simulation_energies(run.simulation);
    *balance = (scree_energies_balance(&after) - scree_energies_balance(&before)) / before.kinetic;
    scene_run_end(&run);
    return (after.kinetic + after.rotational) / before.kinetic - 1;
}

/// Root mean square of the changes of kinetic energy over collisions that stored some of it, at steps of 1e-4 s over
/// 4^k.
static void measure(const char *name, const char *shape, const char *law, int num_steps, double *error)
{
    for (int k = 0; k < num_steps; ++k)
    {
        double sum = 0, worst_balance = 0;
        const double dt = 1e-4 / (1 << 2 * k);
        int num = 0;
        for (int seed = 1; seed <= 6; ++seed)
        {
            double stored, balance;
            const double change = collide(shape, law, seed, dt, &stored, &balance);
            if (!(stored > 0.05)) continue;
            sum += change * change;
            worst_balance = fmax(worst_balance, fabs(balance));
            ++num;
        }
        error[k] = sqrt(sum / num);
        printf("%s, %s, dt = %g s: kinetic energy changed by %.2e in %d collisions, balance by %.1e at most\n", name,
               law, dt, error[k], num, worst_balance);
        SCREE_CHECK(num >= 5);
    }
}

/// A collision lasts some 50 of the longest steps, so that an integrator of second order may err by (pi/50)^2/4 = 1e-3
/// in between. That it keeps more in the end is the nature of velocity Verlet; second order asks for a factor of 16
/// from step to step, at least 8 shows it.
static void check_conserving(const char *name, const char *shape)
{
    const char *laws[2] = {"model: energy_conserving",
                           "model: energy_conserving, energy_exponent: 1, stiffness_factor: 0.03"};
    for (int l = 0; l < 2; ++l)
    {
        double error[3];
        measure(name, shape, laws[l], 3, error);
        SCREE_CHECK(error[0] < 1e-3 && error[1] < error[0] / 8 && error[2] < error[1] / 8);
    }
    // what the other law gives and takes does not depend on the step
    double error[2];
    measure(name, shape, "model: hertz_mindlin", 2, error);
    SCREE_CHECK(error[0] > 0.01 && fabs(error[1] / error[0] - 1) < 0.01);
}

static void test_cubes(void) { check_conserving("cubes", "source: box, size: 0.1"); }
static void test_rocks(void) { check_conserving("rocks", "source: rock, size: 0.1, triangles: 40, seed: 3"); }

/// With p = 2 a cube on its face stands on a spring: w = c E* V^2/R^3, V = a^2 d, R that of the sphere of its volume.
/// Dropped flat, damped, it comes to rest at the depth that carries it, and what the spring took it gave back.
static void test_cube_rests_on_its_face(void)
{
    scene_run run;
    scene_run_start(&run,
                    "time: {end: 1, step: 1e-4}\n"
                    "materials: [{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"
                    "contact_laws: [{materials: [stone, stone], model: energy_conserving, energy_exponent: 2, "
                    "friction_coefficient: 0.5, restitution_coefficient: 0.3}]\n"
                    "shapes: [{name: cube, source: box, size: 0.1}, {name: plate, source: box, size: [1, 1, 0.2]}]\n"
                    "particles: [{name: one, shape: cube, material: stone, bodies: [{position: [0, 0, 0.051]}]}]\n"
                    "walls: [{name: floor, shape: plate, material: stone, position: [0, 0, -0.1]}]\n");
    if (run.simulation == NULL) return;
    scene_run_until(&run, 1);
    const scree_energies e = scree_simulation_energies(run.simulation);
    const double modulus = 1e7 / (2 * 0.9375), cube_of_radius = 3 * 1e-3 / (4 * M_PI), weight = 2.5 * 9.81;
    const double stiffness = 2 * 8.0 / 15.0 * pow(M_PI, -1.25) * modulus * 1e-4 / cube_of_radius;
    const double depth = weight / stiffness, found = 0.05 - (double)run.simulation->particles.position[0].z;
    printf("cube on its face: depth %.9g m, expected %.9g; hysteresis %.2g J of %.2g J\n", found, depth, e.hysteresis,
           weight * 1e-3);
    SCREE_CHECK_CLOSE(found, depth, 1e-9 * depth);
    SCREE_CHECK(e.kinetic + e.rotational < 1e-20);
    // what is left over is of second order in w dt = sqrt(k/m) dt
    SCREE_CHECK_CLOSE(e.hysteresis, 0, stiffness / 2.5 * 1e-8 * weight * 1e-3);
    scene_run_end(&run);
}

int main(void)
{
    SCREE_RUN(test_cubes);
    SCREE_RUN(test_rocks);
    SCREE_RUN(test_cube_rests_on_its_face);
    return SCREE_TEST_END();
}
