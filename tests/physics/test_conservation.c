// A free cloud of colliding rocks: third law, momentum, angular momentum, energy balance.
#include "scene_run.h"

#define CLOUD                                                                                  \
    "gravity: [0, 0, 0]\n"                                                                     \
    "materials:\n  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}\n" \
    "shapes:\n  - {name: rock, source: rock, triangles: 40, seed: 3}\n"

typedef struct momenta
{
    double linear[3], angular[3], scale_linear, scale_angular;
} momenta;

/// Sums in extended precision, so that the test's own rounding stays out.
static momenta measure(const scree_particles *p)
{
    long double linear[3] = {0}, angular[3] = {0}, scale_linear = 0, scale_angular = 0;
    for (int64_t i = 0; i < p->num_particles; ++i)
    {
        const long double m = p->mass[i];
        const long double x[3] = {p->position[i].x, p->position[i].y, p->position[i].z};
        const long double v[3] = {p->velocity[i].x, p->velocity[i].y, p->velocity[i].z};
        const long double l[3] = {p->angular_momentum[i].x, p->angular_momentum[i].y, p->angular_momentum[i].z};
        for (int k = 0; k < 3; ++k)
        {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            linear[k] += m * v[k];
            angular[k] += l[k] + m * (x[a] * v[b] - x[b] * v[a]);
            scale_linear += fabsl(m * v[k]);
            scale_angular += fabsl(m * x[a] * v[b]) + fabsl(m * x[b] * v[a]);
        }
    }
    momenta sums;
    for (int k = 0; k < 3; ++k)
    {
        sums.linear[k] = (double)linear[k];
        sums.angular[k] = (double)angular[k];
    }
    sums.scale_linear = (double)scale_linear;
    sums.scale_angular = (double)scale_angular;
    return sums;
}

/// Rocks flying into each other from both sides.
static void start_cloud(scene_run *run, double time_step)
{
    char text[2048];
    snprintf(text, sizeof text,
             "name: cloud\ntime: {end: 0.1, step: %g}\n" CLOUD
             "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, restitution_coefficient: 0.6}]\n"
             "particles:\n"
             "  - {name: left, shape: rock, material: stone, count: 60, seed: 1, velocity: [2, 0.1, 0],\n"
             "     size: {distribution: uniform, min: 0.01, max: 0.02},\n"
             "     region: {min: [-0.2, 0, 0], max: [-0.05, 0.15, 0.15]}}\n"
             "  - {name: right, shape: rock, material: stone, count: 60, seed: 2, velocity: [-2, 0, 0],\n"
             "     size: {distribution: uniform, min: 0.01, max: 0.02},\n"
             "     region: {min: [0.05, 0, 0], max: [0.2, 0.15, 0.15]}}\n",
             time_step);
    scene_run_start(run, text);
}

/// Kept to rounding at any step.
static void test_momenta_of_a_free_cloud(void)
{
    for (double dt = 2e-5; dt > 4e-6; dt /= 4)
    {
        scene_run run;
        start_cloud(&run, dt);
        if (run.simulation == NULL) return;
        const momenta before = measure(&run.simulation->particles);
        scene_run_until(&run, 0.1);
        const momenta after = measure(&run.simulation->particles);
        const scree_energies e = scree_simulation_energies(run.simulation);
        printf("dt = %g s: %d contacts now, damped %.3g J, rubbed off %.3g J\n", dt,
               (int)run.simulation->contacts.num_contacts, e.damping, e.friction);
        SCREE_CHECK(e.damping > 0 && e.friction > 0);
        for (int k = 0; k < 3; ++k)
        {
            // each of 5000 or 20000 steps rounds each particle's momentum by half an eps of it at most
            SCREE_CHECK_CLOSE(after.linear[k], before.linear[k], 0.1 / dt * DBL_EPSILON * before.scale_linear);
            SCREE_CHECK_CLOSE(after.angular[k], before.angular[k], 1e-10 * before.scale_angular);
        }
        scene_run_end(&run);
    }
}

static void test_forces_are_exact_opposites(void)
{
    scene_run run;
    start_cloud(&run, 2e-5);
    int64_t num_seen = 0;
    for (int round = 0; round < 200 && run.simulation != NULL; ++round)
    {
        scene_run_until(&run, 0.03 + round * 2e-4);
        const scree_contact_list *contacts = &run.simulation->contacts;
        const scree_particles *p = &run.simulation->particles;
        // a particle with a single contact whose partner has no other either: the sums are the forces themselves
        for (int64_t c = 0; c < contacts->num_contacts; ++c)
        {
            const scree_candidate_pair pair = contacts->bodies[c];
            int num_touching = 0;
            for (int64_t o = 0; o < contacts->num_contacts; ++o)
                num_touching += contacts->bodies[o].i == pair.i || contacts->bodies[o].j == pair.i ||
                                contacts->bodies[o].i == pair.j || contacts->bodies[o].j == pair.j;
            if (num_touching != 1) continue;
            ++num_seen;
            const scree_vec3 f = p->force[pair.i], g = p->force[pair.j];
            SCREE_CHECK(f.x == -g.x && f.y == -g.y && f.z == -g.z);
        }
    }
    SCREE_CHECK(num_seen > 100);
    scene_run_end(&run);
}

/// The books close: kinetic + elastic + dissipated stays what it was, better with smaller steps.
static double balance_error(double step)
{
    char text[2048];
    snprintf(text, sizeof text,
             "name: cloud\ntime: {end: 0.1, step: %g}\n" CLOUD
             "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, restitution_coefficient: 0.6}]\n"
             "particles:\n"
             "  - {name: left, shape: rock, material: stone, count: 27, seed: 1, velocity: [2, 0.1, 0],\n"
             "     size: {distribution: fixed, mean: 0.02}, region: {min: [-0.2, 0, 0], max: [-0.05, 0.15, 0.15]}}\n"
             "  - {name: right, shape: rock, material: stone, count: 27, seed: 2, velocity: [-2, 0, 0],\n"
             "     size: {distribution: fixed, mean: 0.02}, region: {min: [0.05, 0, 0], max: [0.2, 0.15, 0.15]}}\n",
             step);
    scene_run run;
    scene_run_start(&run, text);
    double error = NAN;
    if (run.simulation != NULL)
    {
        const scree_energies before = scree_simulation_energies(run.simulation);
        double worst = 0;
        for (int k = 1; k <= 20; ++k)
        {
            scene_run_until(&run, 0.005 * k);
            const scree_energies now = scree_simulation_energies(run.simulation);
            worst = fmax(worst, fabs(scree_energies_balance(&now) - scree_energies_balance(&before)));
        }
        error = worst / before.kinetic;
    }
    scene_run_end(&run);
    return error;
}

static void test_energy_balance_closes(void)
{
    const double coarse = balance_error(2e-5), fine = balance_error(5e-6);
    printf("balance error %.3g at 20 us, %.3g at 5 us\n", coarse, fine);
    SCREE_CHECK(coarse < 2e-3);
    SCREE_CHECK(fine < 0.5 * coarse);
}

int main(void)
{
    SCREE_RUN(test_momenta_of_a_free_cloud);
    SCREE_RUN(test_forces_are_exact_opposites);
    SCREE_RUN(test_energy_balance_closes);
    return SCREE_TEST_END();
}
