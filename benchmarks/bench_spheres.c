// Time per particle and step in a settled bed of equal true spheres, with history and friction, stage by stage.
//
//     bench_spheres [spheres] [seconds to settle] [measured steps]
//
// A box is filled with spheres on a lattice, which fall and come to rest; then steps are measured. Run with
// OMP_NUM_THREADS=1: processor time is measured.
#define _POSIX_C_SOURCE 200809L
#include "dynamics/dynamics.h"
#include "dynamics/step_buffers.h"
#include "scree/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum
{
    PREDICT,
    NEIGHBOURS,
    CONTACTS,
    FORCES,
    CORRECT,
    WORK,
    NUM_STAGES
};

static const char *const stage_names[NUM_STAGES] = {"predict", "neighbours", "contacts", "forces", "correct", "work"};

static double seconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static const char scene_text[] =
    "name: bed\n"
    "time: {end: 10}\n"
    "materials: [{name: glass, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"
    "contact_laws: [{materials: [glass, glass], friction_coefficient: 0.5, restitution_coefficient: 0.3}]\n"
    "shapes:\n"
    "  - {name: ball, source: sphere, size: 0.01}\n"
    "  - {name: plate, source: box, size: [1, 1, 0.02]}\n"
    "particles:\n"
    "  - {name: bed, shape: ball, material: glass, count: %d, spacing: 1.03,\n"
    "     region: {min: [-0.19, -0.19, 0], max: [0.19, 0.19, 10]}}\n"
    "walls:\n"
    "  - {name: floor, shape: plate, material: glass, position: [0, 0, -0.01]}\n"
    "  - {name: left, shape: plate, material: glass, position: [-0.2, 0, 0], orientation: [0.7071067811865476, 0, "
    "0.7071067811865476, 0]}\n"
    "  - {name: right, shape: plate, material: glass, position: [0.2, 0, 0], orientation: [0.7071067811865476, 0, "
    "0.7071067811865476, 0]}\n"
    "  - {name: front, shape: plate, material: glass, position: [0, -0.2, 0], orientation: [0.7071067811865476, "
    "0.7071067811865476, 0, 0]}\n"
    "  - {name: back, shape: plate, material: glass, position: [0, 0.2, 0], orientation: [0.7071067811865476, "
    "0.7071067811865476, 0, 0]}\n";

/// The step, as scree_simulation_step() has it, with a clock between its stages.
static scree_status measured_step(scree_simulation *s, double seconds[NUM_STAGES])
{
    double clock[NUM_STAGES + 1];
    ++s->step;
    const scree_predict_args predict = {s->particles, (scree_real)s->time_step, s->buffers->pose, s->buffers->velocity,
                                        s->buffers->angular_velocity};
    clock[PREDICT] = seconds_now();
    scree_predict_launch(predict, s->particles.num_particles);
    scree_place_walls(s, (double)s->step * s->time_step);
    clock[NEIGHBOURS] = seconds_now();
    scree_status status = scree_update_neighbours(s);
    clock[CONTACTS] = seconds_now();
    if (status == SCREE_OK) status = scree_update_contacts(s);
    clock[FORCES] = seconds_now();
    if (status == SCREE_OK) status = scree_update_forces(s);
    clock[CORRECT] = seconds_now();
    const scree_correct_args correct = {s->particles, (scree_real)s->time_step, s->buffers->velocity,
                                        s->buffers->angular_velocity};
    scree_correct_launch(correct, s->particles.num_particles);
    clock[WORK] = seconds_now();
    if (status == SCREE_OK) status = scree_account_work(s);
    clock[NUM_STAGES] = seconds_now();
    for (int k = 0; k < NUM_STAGES; ++k) seconds[k] += clock[k + 1] - clock[k];
    return status;
}

static int run(scree_simulation *s, double settle, int num_steps)
{
    double seconds[NUM_STAGES] = {0}, total = 0;
    scree_status status = SCREE_OK;
    while (scree_simulation_time(s) < settle && status == SCREE_OK) status = measured_step(s, seconds);
    memset(seconds, 0, sizeof seconds);
    const int64_t rebuilds = s->counters.num_rebuilds;
    for (int k = 0; k < num_steps && status == SCREE_OK; ++k) status = measured_step(s, seconds);
    if (status != SCREE_OK) return 1;

    const double num = (double)s->particles.num_particles, particle_steps = num * num_steps;
    int64_t num_ends = 0;
    for (int64_t c = 0; c < s->contacts.num_contacts; ++c)
        num_ends += s->contacts.bodies[c].j < s->particles.num_particles ? 2 : 1;
    const scree_energies energies = scree_simulation_energies(s);
    printf(
        "%.0f spheres, %.2f contacts each, %.2f candidate pairs each, %lld searches in %d steps, mean speed %.2g m/s\n",
        num, (double)num_ends / num, 2 * (double)s->broad_phase.num_pairs / num,
        (long long)(s->counters.num_rebuilds - rebuilds), num_steps,
        sqrt(2 * energies.kinetic / (num * (double)s->particles.mass[0])));
    for (int k = 0; k < NUM_STAGES; ++k)
    {
        printf("  %-12s %7.1f ns\n", stage_names[k], 1e9 * seconds[k] / particle_steps);
        total += seconds[k];
    }
    printf("  %-12s %7.1f ns per particle and step\n", "all", 1e9 * total / particle_steps);
    return 0;
}

int main(int argc, char **argv)
{
    const int num_spheres = argc > 1 ? atoi(argv[1]) : 50000, num_steps = argc > 3 ? atoi(argv[3]) : 200;
    const double settle = argc > 2 ? atof(argv[2]) : 0.4;
    char text[sizeof scene_text + 16];
    snprintf(text, sizeof text, scene_text, num_spheres);
    scree_scene_file file = {0};
    scree_report report = {0};
    scree_simulation *simulation = NULL;
    scree_status status = scree_scene_parse(&file, text, "bench.yaml", NULL, 0, &report);
    if (status == SCREE_OK) status = scree_simulation_create(&simulation, &file.scene, ".", &report);
    for (int k = 0; k < report.num_messages; ++k) fprintf(stderr, "%s\n", report.messages[k]);
    const int result = status == SCREE_OK ? run(simulation, settle, num_steps) : 1;
    scree_simulation_destroy(simulation);
    scree_scene_close(&file);
    scree_report_clear(&report);
    return result;
}
