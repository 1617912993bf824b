// Averages over time: conservation, closed forms, the same bits for any number of threads and after a restart.
#define _XOPEN_SOURCE 700
#include "scene_run.h"
#include "scree/io.h"
#include "test_folder.h"

#include "io/run_folder.h"

#include <omp.h>
#include <stdlib.h>
#include <unistd.h>

#define EPS 2.220446049250313e-16
#define HEAD                                                                                          \
    "materials:\n  - {name: stone, density: 2500, youngs_modulus: 1e6, poisson_ratio: 0.25}\n"        \
    "  - {name: wood, density: 700, youngs_modulus: 1e6, poisson_ratio: 0.25}\n"                      \
    "contact_laws:\n  - {materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}\n" \
    "  - {materials: [stone, wood], friction_coefficient: 0.4, damping_ratio: 0.3}\n"                 \
    "  - {materials: [wood, wood], friction_coefficient: 0.4, damping_ratio: 0.3}\n"                  \
    "output: {series: 0, frames: 0, checkpoint: 0}\n"

static double sum_of(const double *values, int64_t num)
{
    double sum = 0;
    for (int64_t k = 0; k < num; ++k) sum += values[k];
    return sum;
}

/// On more threads each does a layer of the grid: the same bits as a single one.
static void check_threads_sample_alike(const scree_simulation *s, const scree_grid_sums *alone)
{
    static const int num_threads[] = {2, 7};
    const int before = omp_get_max_threads();
    for (int n = 0; n < 2; ++n)
    {
        scree_grid_sums sums;
        SCREE_CHECK_INT(scree_grid_sums_create(&sums, alone->num_cells), SCREE_OK);
        omp_set_num_threads(num_threads[n]);
        scree_grid_add_sample(s, &sums);
        const size_t size = (size_t)sums.num_cells * sizeof(double);
        SCREE_CHECK(memcmp(sums.volume, alone->volume, size) == 0);
        SCREE_CHECK(memcmp(sums.mass, alone->mass, size) == 0);
        SCREE_CHECK(memcmp(sums.momentum, alone->momentum, 3 * size) == 0);
        SCREE_CHECK(memcmp(sums.speed, alone->speed, size) == 0);
        SCREE_CHECK(memcmp(sums.square, alone->square, size) == 0);
        scree_grid_sums_destroy(&sums);
    }
    omp_set_num_threads(before);
}

/// Whatever the sizes of particles and cells, the cells share out the volume, mass and momentum of the particles.
static void test_cells_hold_all_that_the_particles_bring(void)
{
    static const char *const cells[] = {"[1, 1, 1]", "[3, 5, 7]", "[31, 17, 40]", "[200, 1, 3]"};
    for (int n = 0; n < 4; ++n)
    {
        char text[4096];
        snprintf(text, sizeof text,
                 "name: cloud\ngravity: [0, 0, 0]\ntime: {end: 1, step: 1e-3}\n" HEAD
                 "shapes: [{name: rock, source: rock, triangles: 20, seed: 2}]\n"
                 "particles:\n"
                 "  - {name: a, shape: rock, material: stone, count: 300, seed: 1, velocity: [1, 2, -3],\n"
                 "     size: {distribution: uniform, min: 0.01, max: 0.05},\n"
                 "     region: {min: [0, 0, 0], max: [1, 1, 1]}}\n"
                 "  - {name: b, shape: rock, material: wood, count: 100, seed: 1, velocity: [-2, 0.5, 1],\n"
                 "     size: {distribution: uniform, min: 0.01, max: 0.05},\n"
                 "     region: {min: [0, 0, 1], max: [1, 1, 2]}}\n"
                 "fields: {measure: true, region: {min: [-0.1, -0.1, -0.1], max: [1.1, 1.1, 2.1]}, cells: %s,\n"
                 "  period: 1}\n",
                 cells[n]);
        scene_run run;
        scene_run_start(&run, text);
        if (run.simulation == NULL) return;
        scree_grid_sums *sums = &run.simulation->averages.grid;
        const int before = omp_get_max_threads();
        omp_set_num_threads(1);
        scree_grid_add_sample(run.simulation, sums);
        omp_set_num_threads(before);
        check_threads_sample_alike(run.simulation, sums);
        const scree_particles *p = &run.simulation->particles;
        double volume = 0, mass = 0, momentum = 0, square = 0, found = 0;
        for (int64_t i = 0; i < p->num_particles; ++i)
        {
            const double m = (double)p->mass[i];
            volume += m / run.file.scene.materials[p->material[i]].density;
            mass += m;
            momentum += m * (double)p->velocity[i].z;
            square += m * (double)scree_vec3_dot(p->velocity[i], p->velocity[i]);
        }
        for (int64_t c = 0; c < sums->num_cells; ++c) found += sums->momentum[3 * c + 2];
        // the shares of a particle are rounded, then summed over all cells
        const double tolerance = (double)(sums->num_cells + 400 * 8) * EPS;
        SCREE_CHECK_CLOSE(sum_of(sums->volume, sums->num_cells), volume, tolerance * volume);
        SCREE_CHECK_CLOSE(sum_of(sums->mass, sums->num_cells), mass, tolerance * mass);
        SCREE_CHECK_CLOSE(sum_of(sums->square, sums->num_cells), square, tolerance * square);
        SCREE_CHECK_CLOSE(found, momentum, tolerance * 3 * mass);
        for (int64_t c = 0; c < sums->num_cells; ++c) SCREE_CHECK(sums->volume[c] >= 0);
        scene_run_end(&run);
    }
}

/// A cube of 0.2 m that flies through a row of cells of 0.1 m: the mean over time in closed form.
static void test_means_of_free_flight(void)
{
    scene_run run;
    scene_run_start(&run,
                    "name: flight\ngravity: [0, 0, 0]\ntime: {end: 1, step: 1e-3}\n" HEAD
                    "shapes: [{name: cube, source: box, size: 0.2}]\n"
                    "particles:\n  - {name: there, shape: cube, material: stone,\n"
                    "     bodies: [{position: [0.05, 0, 0], velocity: [1, 0, 0]}]}\n"
                    "  - {name: back, shape: cube, material: stone,\n"
                    "     bodies: [{position: [0.95, 0, 5], velocity: [1, 0, 0]},\n"
                    "              {position: [0.95, 0.3, 5], velocity: [-1, 0, 0]}]}\n"
                    "fields: {measure: true, region: {min: [0, -0.5, -0.5], max: [1, 0.5, 5.5]}, cells: [10, 1, 6],\n"
                    "  from: 0.1, period: 0.8, samples: 800}\n");
    if (run.simulation == NULL) return;
    const scree_averages *averages = &run.simulation->averages;
    scene_run_until(&run, 0.899);
    SCREE_CHECK_INT(averages->num_periods, 0);
    SCREE_CHECK_INT(averages->num_samples, 799);
    scene_run_until(&run, 0.95);
    SCREE_CHECK_INT(averages->num_periods, 1);
    SCREE_CHECK_INT(averages->num_samples, 50);
    const double volume = 0.008, mass = 20;
    for (int x = 0; x < 10; ++x)
    {
        // the cube goes from 0.15 to 0.95 in the period: share of the time that its length covers of cell x
        double expected = 0;
        for (int k = 1; k <= 800; ++k)
        {
            const double low = fmax(0.15 + k * 1e-3 - 0.1, 0.1 * x), high = fmin(0.15 + k * 1e-3 + 0.1, 0.1 * (x + 1));
            expected += high > low ? (high - low) / 0.2 * volume : 0;
        }
        SCREE_CHECK_CLOSE(averages->grid_total.volume[x], expected, 1e-9 * expected + 1e-12);
        if (expected > 0)
            SCREE_CHECK_CLOSE(averages->grid_total.momentum[3 * x] / averages->grid_total.mass[x], 1, 1e-12);
    }
    // mean over the row: what of the cube has been inside
    SCREE_CHECK(sum_of(averages->grid_total.volume, 10) < 800 * volume);
    // two that pass each other: no mean velocity over the row, all of it temperature
    const int64_t row = 5 * 10;
    double momentum = 0, moving = 0, square = 0;
    for (int x = 0; x < 10; ++x)
    {
        momentum += averages->grid_total.momentum[3 * (row + x)];
        moving += averages->grid_total.mass[row + x];
        square += averages->grid_total.square[row + x];
    }
    SCREE_CHECK_CLOSE(square, moving, 1e-12 * moving);
    SCREE_CHECK(moving > 100 * mass && fabs(momentum) < moving);
    scene_run_end(&run);
}

#define CUBE "{name: cube, source: box, size: [0.012, 0.011, 0.01]}"
#define BALL "{name: cube, source: sphere, size: 0.0116}           "

// a few cubes in a drum, with collisions
static const char drum_text[] =
    "name: drum\ntime: {end: 0.6, step: 5e-5}\n" HEAD "shapes:\n"
    "  - " CUBE "\n"
    "  - name: drum\n    source: turned\n    segments: 24\n"
    "    profile: [{radius: 0, height: -0.03}, {radius: 0.06, height: -0.03}, {radius: 0.06, height: 0.03},\n"
    "      {radius: 0, height: 0.03}, {radius: 0, height: 0.02}, {radius: 0.05, height: 0.02},\n"
    "      {radius: 0.05, height: -0.02}, {radius: 0, height: -0.02}]\n"
    "particles:\n"
    "  - {name: fill, shape: cube, material: stone, count: 9, seed: 3,\n"
    "     region: {min: [-0.04, -0.02, -0.04], max: [0.04, 0.02, 0.04], cylinder: y}}\n"
    "  - {name: low, shape: cube, material: stone, bodies: [{position: [0, 0, -0.0446]}]}\n"
    "walls:\n"
    "  - {name: drum, shape: drum, material: stone, orientation: [0.7071067811865476, -0.7071067811865476, 0, 0],\n"
    "     motion: {kind: rotate, axis: [0, 1, 0], angular_velocity: -40}}\n"
    "fields: {measure: true, region: {min: [-0.05, -0.02, -0.05], max: [0.05, 0.02, 0.05]}, cells: [10, 2, 10],\n"
    "  wall: drum, samples: 50, energy_bins: 40, energy_min: 1e-9, energy_max: 1e-2}\n";

/// All that collisions have lost, ended or not, is what the balance of energy says is lost or in springs.
static void check_collisions(const char *text)
{
    scene_run run;
    scene_run_start(&run, text);
    if (run.simulation == NULL) return;
    const scree_simulation *s = run.simulation;
    const scree_averages *averages = &s->averages;
    const scree_energies start = scree_simulation_energies(s);
    const double stored = start.elastic_normal + start.elastic_tangential;
    SCREE_CHECK(s->contacts.num_contacts > 0); // some are there from the start
    int64_t num_wall = 0, num_both = 0;
    while (s->step < 8000)
    {
        SCREE_CHECK_INT(scree_simulation_step(run.simulation, &run.report), SCREE_OK);
        if (s->step % 500 != 0) continue;
        const scree_energies e = scree_simulation_energies(s);
        double lost = sum_of(averages->collisions.normal, averages->collisions.num_contacts) +
                      sum_of(averages->collisions.tangential, averages->collisions.num_contacts);
        const scree_spectrum *both[] = {&averages->spectrum, &averages->spectrum_total};
        num_wall = num_both = 0;
        for (int k = 0; k < 2; ++k)
        {
            lost += sum_of(both[k]->energy_normal, both[k]->num_rows);
            lost += sum_of(both[k]->energy_tangential, both[k]->num_rows);
            for (int64_t row = 0; row < both[k]->num_rows; ++row)
            {
                num_wall += row >= 42 ? both[k]->count_normal[row] : 0;
                num_both += both[k]->count_normal[row] - both[k]->count_tangential[row];
            }
        }
        const double expected =
            e.damping + e.friction + e.hysteresis + e.elastic_normal + e.elastic_tangential - stored;
        // sums of some thousand steps, each rounded; magnitudes: what was dissipated
        const double magnitude = e.damping + e.friction + fabs(e.hysteresis) + e.elastic_normal;
        SCREE_CHECK_CLOSE(lost, expected, 4 * (double)s->step * EPS * magnitude);
    }
    SCREE_CHECK_INT(averages->num_periods, 2);
    SCREE_CHECK(num_wall > 10);
    SCREE_CHECK_INT(num_both, 0); // each collision is in both histograms
    // two revolutions from the start: what the wall's own account says of them
    SCREE_CHECK(s->wall_loads.marked_work[0] != 0);
    SCREE_CHECK_CLOSE(averages->works.total[0], s->wall_loads.marked_work[0], 4 * EPS * fabs(averages->works.total[0]));
    scene_run_end(&run);
}

static void test_collisions_lose_what_the_balance_says(void) { check_collisions(drum_text); }

static void test_collisions_of_true_spheres(void)
{
    char text[sizeof drum_text];
    strcpy(text, drum_text);
    memcpy(strstr(text, CUBE), BALL, strlen(BALL));
    check_collisions(text);
}

static bool same_averages(const scree_averages *a, const scree_averages *b)
{
    const scree_grid_sums *grids[2][2] = {{&a->grid, &b->grid}, {&a->grid_total, &b->grid_total}};
    const scree_spectrum *spectra[2][2] = {{&a->spectrum, &b->spectrum}, {&a->spectrum_total, &b->spectrum_total}};
    bool is_same = a->num_samples == b->num_samples && a->num_periods == b->num_periods;
    for (int k = 0; k < 2; ++k)
    {
        const size_t cells = (size_t)grids[k][0]->num_cells * sizeof(double);
        const size_t rows = (size_t)spectra[k][0]->num_rows * sizeof(double);
        is_same = is_same && memcmp(grids[k][0]->volume, grids[k][1]->volume, cells) == 0 &&
                  memcmp(grids[k][0]->momentum, grids[k][1]->momentum, 3 * cells) == 0 &&
                  memcmp(grids[k][0]->square, grids[k][1]->square, cells) == 0 &&
                  memcmp(spectra[k][0]->count_normal, spectra[k][1]->count_normal, rows) == 0 &&
                  memcmp(spectra[k][0]->energy_normal, spectra[k][1]->energy_normal, rows) == 0 &&
                  memcmp(spectra[k][0]->energy_tangential, spectra[k][1]->energy_tangential, rows) == 0;
    }
    const size_t contacts = (size_t)a->collisions.num_contacts * sizeof(double);
    return is_same && a->collisions.num_contacts == b->collisions.num_contacts &&
           memcmp(a->collisions.normal, b->collisions.normal, contacts) == 0 &&
           memcmp(a->collisions.tangential, b->collisions.tangential, contacts) == 0 &&
           memcmp(a->works.total, b->works.total, sizeof(double)) == 0 &&
           memcmp(a->works.start, b->works.start, sizeof(double)) == 0;
}

/// Unbroken with one thread; stopped in the middle of a period and gone on with three.
static void test_restart_and_threads_change_no_bit(void)
{
    char path[512];
    snprintf(path, sizeof path, "%s/checkpoint.h5", scree_test_folder());
    const int before = omp_get_max_threads();
    scene_run whole, first, second;
    omp_set_num_threads(1);
    scene_run_start(&whole, drum_text);
    scene_run_until(&whole, 0.35);
    scene_run_start(&first, drum_text);
    scene_run_until(&first, 0.22);
    SCREE_CHECK_INT(scree_checkpoint_save(first.simulation, path, &first.report), SCREE_OK);
    omp_set_num_threads(3);
    scene_run_start(&second, drum_text);
    SCREE_CHECK_INT(scree_checkpoint_load(second.simulation, path, &second.report), SCREE_OK);
    SCREE_CHECK(same_averages(&first.simulation->averages, &second.simulation->averages));
    scene_run_until(&second, 0.35);
    SCREE_CHECK_INT(second.simulation->averages.num_periods, 2);
    SCREE_CHECK(second.simulation->averages.num_samples > 0);
    SCREE_CHECK(same_averages(&whole.simulation->averages, &second.simulation->averages));
    SCREE_CHECK(!same_averages(&whole.simulation->averages, &first.simulation->averages));
    scene_run_end(&second);

    // with another grid the averages start anew, and the broken period does not count
    char other[sizeof drum_text];
    strcpy(other, drum_text);
    memcpy(strstr(other, "cells: [10, 2, 10]"), "cells: [10, 4, 10]", 18);
    scene_run_start(&second, other);
    const int num_warnings = second.report.num_warnings;
    SCREE_CHECK_INT(scree_checkpoint_load(second.simulation, path, &second.report), SCREE_OK);
    SCREE_CHECK_INT(second.report.num_warnings, num_warnings + 1);
    SCREE_CHECK_INT(second.simulation->averages.num_periods, 0);
    scene_run_until(&second, 0.35);
    SCREE_CHECK_INT(second.simulation->averages.num_periods, 0);
    scene_run_until(&second, 0.48);
    SCREE_CHECK_INT(second.simulation->averages.num_periods, 1);
    scene_run_end(&second);
    scene_run_end(&first);
    scene_run_end(&whole);
    omp_set_num_threads(before);
}

int main(void)
{
    SCREE_RUN(test_cells_hold_all_that_the_particles_bring);
    SCREE_RUN(test_means_of_free_flight);
    SCREE_RUN(test_collisions_lose_what_the_balance_says);
    SCREE_RUN(test_collisions_of_true_spheres);
    SCREE_RUN(test_restart_and_threads_change_no_bit);
    return SCREE_TEST_END();
}
