// Torque, force and work of moving walls against conservation laws.
#include "scene_run.h"

#include <omp.h>
#include <stdlib.h>

#define HEAD                                                                                \
    "materials: [{name: stone, density: 2500, youngs_modulus: 1e6, poisson_ratio: 0.25}]\n" \
    "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]\n"

#define CUBE "{name: cube, source: box, size: [0.008, 0.007, 0.006]}"
#define BALL "{name: cube, source: sphere, size: 0.008}             "

// a drum about y with four lifters, a third full; it starts after a while and stops before the end
static const char drum_text[] =
    "name: drum\ntime: {end: 0.5, step: 5e-5}\n" HEAD "shapes:\n"
    "  - " CUBE "\n"
    "  - name: drum\n    source: turned\n    segments: 24\n"
    "    profile: [{radius: 0, height: -0.03}, {radius: 0.06, height: -0.03}, {radius: 0.06, height: 0.03},\n"
    "      {radius: 0, height: 0.03}, {radius: 0, height: 0.02}, {radius: 0.05, height: 0.02},\n"
    "      {radius: 0.05, height: -0.02}, {radius: 0, height: -0.02}]\n"
    "  - {name: lifters, source: box, size: [0.016, 0.01, 0.04], offset: [0.05, 0, 0], copies: 4}\n"
    "particles:\n"
    "  - {name: fill, shape: cube, material: stone, count: 30, seed: 3,\n"
    "     region: {min: [-0.035, -0.02, -0.035], max: [0.035, 0.02, 0.035], cylinder: y}}\n"
    "walls:\n"
    "  - {name: drum, shape: drum, material: stone, orientation: [0.7071067811865476, -0.7071067811865476, 0, 0],\n"
    "     motion: {kind: rotate, axis: [0, 3, 0], angular_velocity: -20, start: 0.02, end: 0.45}}\n"
    "  - {name: lifters, shape: lifters, material: stone, orientation: [0.7071067811865476, -0.7071067811865476, 0, "
    "0],\n"
    "     motion: {kind: rotate, axis: [0, 1, 0], angular_velocity: -20, start: 0.02, end: 0.45}}\n"
    "output: {series: 0, frames: 0, checkpoint: 0}\n";

/// Angular momentum of the particles about the y axis through the origin.
static double angular_momentum(const scree_particles *p)
{
    double sum = 0;
    for (int64_t i = 0; i < p->num_particles; ++i)
    {
        const scree_vec3 x = p->position[i], v = p->velocity[i];
        sum += (double)p->mass[i] * ((double)x.z * (double)v.x - (double)x.x * (double)v.z) +
               (double)p->angular_momentum[i].y;
    }
    return sum;
}

/// Torque of gravity about the y axis: z F_x - x F_z.
static double gravity_torque(const scree_particles *p)
{
    double sum = 0;
    for (int64_t i = 0; i < p->num_particles; ++i) sum += (double)p->mass[i] * 9.81 * (double)p->position[i].x;
    return sum;
}

/// Velocity Verlet changes x cross m v by exactly the trapezoids of the torque, so the angular momentum of the
/// particles is the sum of the torques of walls and gravity but for rounding.
static void check_torque(const char *text)
{
    scene_run run;
    scene_run_start(&run, text);
    if (run.simulation == NULL) return;
    scree_simulation *s = run.simulation;
    const double dt = scree_simulation_time_step(s), start = angular_momentum(&s->particles);
    double impulse = 0, magnitude = fabs(start), largest_error = 0;
    double last = gravity_torque(&s->particles);
    for (int w = 0; w < 2; ++w) last += scree_simulation_wall_load(s, w).load;
    double marked_work = 0, revolution_work = 0;
    int64_t marked_step = 400, revolution_steps = 0; // the motion starts at step 400
    int64_t num_revolutions = 0;
    for (int64_t step = 1; step <= scree_simulation_num_steps(s); ++step)
    {
        if (scree_simulation_step(s, &run.report) != SCREE_OK) break;
        double torque = gravity_torque(&s->particles), work = 0;
        for (int w = 0; w < 2; ++w)
        {
            torque += scree_simulation_wall_load(s, w).load;
            work += scree_simulation_wall_load(s, w).work;
        }
        impulse += 0.5 * dt * (last + torque);
        magnitude += 0.5 * dt * (fabs(last) + fabs(torque));
        last = torque;
        largest_error = fmax(largest_error, fabs(angular_momentum(&s->particles) - start - impulse));
        // the works of the walls are the energy that came in
        const double input = scree_simulation_energies(s).input;
        SCREE_CHECK_CLOSE(work, input, 1e-13 * (double)step * fabs(input));
        const int64_t revolutions = scree_simulation_wall_load(s, 0).num_revolutions;
        if (revolutions > num_revolutions)
        {
            const double now = scree_simulation_wall_load(s, 0).work;
            revolution_work = now - marked_work;
            revolution_steps = step - marked_step;
            marked_work = now;
            marked_step = step;
            num_revolutions = revolutions;
        }
    }
    printf("input %.4g J, error of the angular momentum %.2g of %.2g N m s\n", scree_simulation_energies(s).input,
           largest_error, magnitude);
    // each of 10 000 steps rounds position, velocity and momentum of 30 particles, which are of the size of the sum
    SCREE_CHECK(largest_error <= 1e4 * 30 * 4 * 2.3e-16 * magnitude);
    SCREE_CHECK(scree_simulation_energies(s).input > 0);
    // 20 rad/s for 0.43 s
    SCREE_CHECK_INT(num_revolutions, 1);
    SCREE_CHECK_INT(revolution_steps, (int64_t)ceil(2 * 3.14159265358979 / 20 / dt));
    SCREE_CHECK_CLOSE(scree_simulation_wall_load(s, 0).revolution_power, revolution_work / (revolution_steps * dt),
                      1e-12 * fabs(revolution_work));
    SCREE_CHECK(scree_simulation_wall_load(s, 1).revolution_power != 0);
    scene_run_end(&run);
}

static void test_torque_is_what_the_angular_momentum_says(void) { check_torque(drum_text); }

static void test_torque_of_true_spheres(void)
{
    char text[sizeof drum_text];
    strcpy(text, drum_text);
    memcpy(strstr(text, CUBE), BALL, strlen(BALL));
    check_torque(text);
}

/// A block put on a belt: the belt gives it the momentum m v, so it works m v^2, half of which ends as heat.
static void test_belt_works_twice_the_energy_it_gives(void)
{
    scene_run run;
    scene_run_start(&run,
                    "name: belt\ntime: {end: 0.5, step: 5e-5}\n" HEAD "shapes:\n"
                    "  - {name: block, source: box, size: [0.1, 0.1, 0.04]}\n"
                    "  - {name: belt, source: box, size: [4, 1, 0.1]}\n"
                    "  - {name: far, source: box, size: 0.1}\n"
                    "particles: [{name: block, shape: block, material: stone, bodies: [{position: [0, 0, 0.0199]}]}]\n"
                    "walls:\n"
                    "  - {name: far, shape: far, material: stone, position: [9, 9, 9]}\n"
                    "  - {name: belt, shape: belt, material: stone, position: [0, 0, -0.05],\n"
                    "     motion: {kind: translate, velocity: [0.5, 0, 0]}}\n"
                    "output: {series: 0, frames: 0, checkpoint: 0}\n");
    if (run.simulation == NULL) return;
    scree_simulation *s = run.simulation;
    const double dt = scree_simulation_time_step(s), v = 0.5, mass = (double)s->particles.mass[0];
    const double first = scree_simulation_wall_load(s, 1).load;
    scene_run_until(&run, 0.5);
    const scree_wall_load belt = scree_simulation_wall_load(s, 1), far = scree_simulation_wall_load(s, 0);
    const double reached = (double)s->particles.velocity[0].x;
    // work = v times the sum of the forces; the momentum is that of the trapezoids
    SCREE_CHECK_CLOSE(belt.work, v * (mass * reached + 0.5 * dt * (belt.load - first)), 1e-11 * mass * v * v);
    // it slips for v/(mu g) = 0.13 s and sticks from then on
    SCREE_CHECK_CLOSE(reached, v, 1e-6 * v);
    SCREE_CHECK_CLOSE(belt.work, mass * v * v, 0.5 * dt * v * (fabs(belt.load) + fabs(first)) + 1e-6 * mass * v * v);
    SCREE_CHECK(belt.num_revolutions == 0 && far.work == 0 && far.load == 0);
    scene_run_end(&run);
}

static void test_same_bits_for_any_number_of_threads(void)
{
    double work[2][2], load[2][2];
    const int before = omp_get_max_threads();
    for (int k = 0; k < 2; ++k)
    {
        omp_set_num_threads(k == 0 ? 1 : 3);
        scene_run run;
        scene_run_start(&run, drum_text);
        scene_run_until(&run, 0.12);
        for (int w = 0; w < 2; ++w)
        {
            work[k][w] = scree_simulation_wall_load(run.simulation, w).work;
            load[k][w] = scree_simulation_wall_load(run.simulation, w).load;
        }
        scene_run_end(&run);
    }
    omp_set_num_threads(before);
    for (int w = 0; w < 2; ++w)
    {
        SCREE_CHECK(work[0][w] == work[1][w] && load[0][w] == load[1][w]);
        SCREE_CHECK(work[0][0] != 0);
    }
}

int main(void)
{
    SCREE_RUN(test_torque_is_what_the_angular_momentum_says);
    SCREE_RUN(test_torque_of_true_spheres);
    SCREE_RUN(test_belt_works_twice_the_energy_it_gives);
    SCREE_RUN(test_same_bits_for_any_number_of_threads);
    return SCREE_TEST_END();
}
