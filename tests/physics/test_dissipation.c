// Where the energy of a collapsing bed goes: friction and damping take it, and never give any back, whatever the law.
#include "scene_run.h"

#include "dynamics/step_buffers.h"

/// A column of balls, clumps or cubes that falls apart on a plate.
static void check_collapse(const char *shape, const char *law)
{
    char text[2000];
    snprintf(text, sizeof text,
             "time: {end: 0.25, step: 2e-5}\n"
             "materials: [{name: glass, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"
             "contact_laws: [{materials: [glass, glass], %s}]\n"
             "shapes: [{name: body, %s}, {name: plate, source: box, size: [2, 2, 0.2]}]\n"
             "particles: [{name: column, shape: body, material: glass, count: 120, seed: 2, spacing: 1.2,\n"
             "  region: {min: [-0.04, -0.04, 0], max: [0.04, 0.04, 0.5]}}]\n"
             "walls: [{name: floor, shape: plate, material: glass, position: [0, 0, -0.1]}]\n",
             law, shape);
    scene_run run;
    scene_run_start(&run, text);
    if (run.simulation == NULL) return;
    const scree_energies before = scree_simulation_energies(run.simulation);
    scree_energies last = before;
    double fallen = 0, drop_of_friction = 0, drop_of_damping = 0;
    for (int64_t k = scree_simulation_num_steps(run.simulation); k > 0; --k)
    {
        SCREE_CHECK_INT(scree_simulation_step(run.simulation, &run.report), SCREE_OK);
        const scree_energies now = scree_simulation_energies(run.simulation);
        drop_of_friction += fmax(0, last.friction - now.friction);
        drop_of_damping += fmax(0, last.damping - now.damping);
        last = now;
    }
    fallen = before.potential - last.potential;
    const double error = scree_energies_balance(&last) - scree_energies_balance(&before);
    printf("%-28.28s %-40.40s: of %.4f J friction %.4f, damping %.4f, given back %.2g and %.2g, balance %.2g\n", shape,
           strstr(law, "rest") ? strstr(law, "rest") : law, fallen, last.friction, last.damping, drop_of_friction,
           drop_of_damping, error);
    SCREE_CHECK(last.friction > 0.02 * fallen);
    SCREE_CHECK(last.damping > 0.02 * fallen);
    // The law itself gives nothing for the velocity that it saw (tests/unit/test_contact_law.c); the work is taken at
    // the velocity at the end of the step, which half a step's acceleration has changed.
    SCREE_CHECK(drop_of_friction < 1e-3 * last.friction);
    SCREE_CHECK(drop_of_damping < 1e-3 * last.damping);
    SCREE_CHECK(fabs(error) < 1e-3 * fallen);
    scene_run_end(&run);
}

static void test_collapsing_beds(void)
{
    static const char *const balls = "source: sphere, size: 0.012";
    check_collapse(balls, "friction_coefficient: 0.5, restitution_coefficient: 0.3");
    check_collapse(balls, "friction_coefficient: 0.2, restitution_coefficient: 0.9");
    check_collapse(balls, "friction_coefficient: 0.5, restitution_coefficient: 0.5, tangential_spring: 0");
    check_collapse(balls, "friction_coefficient: 0.5, restitution_coefficient: 0.5, rolling_resistance: spring, "
                          "rolling_friction_coefficient: 0.1, rolling_damping_ratio: 0.3");
    check_collapse("source: clump, spheres: [{position: [0, 0, 0], radius: 0.006}, {position: [0.006, 0, 0], radius: "
                   "0.005}]",
                   "friction_coefficient: 0.5, restitution_coefficient: 0.3");
    check_collapse("source: box, size: 0.01", "friction_coefficient: 0.5, restitution_coefficient: 0.3");
}

int main(void)
{
    SCREE_RUN(test_collapsing_beds);
    return SCREE_TEST_END();
}
