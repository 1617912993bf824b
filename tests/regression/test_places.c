// Where particles lie in memory changes no bit: runs in which they change places again and again, at random, are those
// in which they stay; whoever looks finds ids. And particles that are mixed do change places.
#include "scene_run.h"
#include "test_folder.h"

#include "dynamics/places.h"
#include "dynamics/step_buffers.h"
#include "io/run_folder.h"
#include "scree/io.h"

#include <float.h>
#include <math.h>
#include <omp.h>
#include <unistd.h>

#define HEAD                                                                                             \
    "materials:\n"                                                                                       \
    "  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}\n"                       \
    "  - {name: steel, density: 7800, youngs_modulus: 1e8, poisson_ratio: 0.3}\n"                        \
    "contact_laws:\n"                                                                                    \
    "  - {materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}\n"                   \
    "  - {materials: [stone, steel], friction_coefficient: 0.3, damping_ratio: 0.2}\n"                   \
    "shapes:\n"                                                                                          \
    "  - {name: ball, source: sphere, size: 0.016}\n"                                                    \
    "  - {name: rock, source: rock, triangles: 40, seed: 3}\n"                                           \
    "  - {name: schoenhardt, source: schoenhardt, size: 0.02}\n"                                         \
    "  - {name: trio, source: clump, spheres: [{position: [0, 0, 0], radius: 0.007},\n"                  \
    "     {position: [0.006, 0, 0], radius: 0.006}, {position: [0, 0.007, 0], radius: 0.005}]}\n"        \
    "  - {name: floor, source: box, size: [0.3, 0.3, 0.02]}\n"                                           \
    "  - {name: paddle, source: box, size: [0.06, 0.004, 0.016]}\n"                                      \
    "walls:\n"                                                                                           \
    "  - {name: floor, shape: floor, material: steel, position: [0, 0, -0.01],\n"                        \
    "     motion: {kind: translate, velocity: [0, 0, 0.4], start: 0.002, end: 0.02}}\n"                  \
    "  - {name: paddle, shape: paddle, material: steel, position: [0.02, 0, 0.009],\n"                   \
    "     motion: {kind: rotate, axis: [0, 0, 1], centre: [0, 0, 0], angular_velocity: 40}}\n"           \
    "  - {name: gate, shape: paddle, material: steel, position: [0, -0.05, 0.009], removed_at: 0.004}\n" \
    "fields: {measure: true, from: 0.001, period: 0.003, samples: 5, cells: [3, 3, 4],\n"                \
    "  region: {min: [-0.05, -0.05, 0], max: [0.05, 0.05, 0.1]}, energy_bins: 2, energy_min: 1e-7,\n"    \
    "  energy_max: 1e-3}\n"

/// All contacts act in points.
static const char spheres_text[] =
    "name: spheres\ntime: {end: 0.012, step: 5e-5}\n" HEAD "particles:\n"
    "  - {name: balls, shape: ball, material: stone, count: 170, seed: 4, velocity: [0, 0, -4], spacing: 1.02,\n"
    "     size: {distribution: uniform, min: 0.008, max: 0.012},\n"
    "     region: {min: [-0.05, -0.05, 0.018], max: [0.05, 0.05, 0.3]}}\n";

static const char mixed_text[] =
    "name: mixed\ntime: {end: 0.012, step: 5e-5}\n" HEAD "particles:\n"
    "  - {name: trios, shape: trio, material: stone, count: 8, seed: 5, velocity: [0, 0, -16],\n"
    "     region: {min: [-0.03, -0.03, 0.25], max: [0.03, 0.03, 0.4]}}\n"
    "  - {name: rocks, shape: rock, material: stone, count: 12, seed: 1, velocity: [0, 0, -4], spacing: 1,\n"
    "     size: {distribution: uniform, min: 0.015, max: 0.02},\n"
    "     region: {min: [-0.04, -0.04, 0.018], max: [0.04, 0.04, 0.3]}}\n"
    "  - {name: twisted, shape: schoenhardt, material: stone, count: 12, seed: 2, velocity: [0, 0, -7], spacing: 1,\n"
    "     region: {min: [-0.04, -0.04, 0.115], max: [0.04, 0.04, 0.14]}}\n"
    "  - {name: balls, shape: ball, material: stone, count: 25, seed: 2, velocity: [0, 0, -9], spacing: 1.02,\n"
    "     region: {min: [-0.04, -0.04, 0.14], max: [0.04, 0.04, 0.24]}}\n";

enum
{
    NUM_STEPS = 240,
    LOOK_EVERY = 30,
    MAX_PARTICLES = 4096
};

/// All particles to places drawn at random.
static void shuffle(scree_simulation *s, uint64_t *state)
{
    int32_t order[MAX_PARTICLES];
    const int32_t num = (int32_t)s->particles.num_particles;
    for (int32_t k = 0; k < num; ++k) order[k] = k;
    for (int32_t k = num - 1; k > 0; --k)
    {
        const int32_t other = (int32_t)(scree_test_random(state) * (k + 1)), kept = order[k];
        order[k] = order[other];
        order[other] = kept;
    }
    SCREE_CHECK_INT(scree_ask_for_places(s, order), SCREE_OK);
}

static bool are_same(const void *a, const void *b, int64_t num, size_t size)
{
    return memcmp(a, b, (size_t)num * size) == 0;
}

/// Everything that can be asked of the two is the same.
static void check_same(scree_simulation *a, scree_simulation *b)
{
    SCREE_CHECK_INT(scree_simulation_observe(b, NULL), SCREE_OK);
    SCREE_CHECK(scree_simulation_hash(a) == scree_simulation_hash(b));
    const scree_energies energies[2] = {scree_simulation_energies(a), scree_simulation_energies(b)};
    SCREE_CHECK(are_same(energies, energies + 1, 1, sizeof *energies));
    const scree_counters x = a->counters, y = b->counters;
    SCREE_CHECK(x.largest_indentation == y.largest_indentation && x.worst_residual == y.worst_residual &&
                x.smallest_critical_step == y.smallest_critical_step && x.num_fallbacks == y.num_fallbacks &&
                x.num_contacts == y.num_contacts);
    for (int32_t w = 0; w < a->num_walls; ++w)
    {
        const scree_wall_load loads[2] = {scree_simulation_wall_load(a, w), scree_simulation_wall_load(b, w)};
        SCREE_CHECK(are_same(loads, loads + 1, 1, sizeof *loads));
    }
    const scree_contact_list *c = &a->contacts, *d = &b->contacts;
    const int64_t n = c->num_contacts;
    if (d->num_contacts != n) return;
    SCREE_CHECK(are_same(c->patch, d->patch, n, sizeof *c->patch) && are_same(c->arm, d->arm, n, sizeof *c->arm) &&
                are_same(c->normal_force, d->normal_force, n, sizeof *c->normal_force) &&
                are_same(c->is_slipping, d->is_slipping, n, sizeof *c->is_slipping) &&
                are_same(c->elastic_energy, d->elastic_energy, n, sizeof *c->elastic_energy));
    const scree_averages *p = &a->averages, *q = &b->averages;
    SCREE_CHECK_INT(p->num_periods, q->num_periods);
    SCREE_CHECK(are_same(p->grid_total.momentum, q->grid_total.momentum, 3 * p->grid.num_cells, sizeof(double)));
    SCREE_CHECK(are_same(p->spectrum.energy_normal, q->spectrum.energy_normal, p->spectrum.num_rows, sizeof(double)) &&
                are_same(p->spectrum_total.energy_tangential, q->spectrum_total.energy_tangential, p->spectrum.num_rows,
                         sizeof(double)) &&
                are_same(p->spectrum_total.count_normal, q->spectrum_total.count_normal, p->spectrum.num_rows,
                         sizeof(int64_t)));
    SCREE_CHECK(are_same(p->collisions.normal, q->collisions.normal, n, sizeof(double)));
}

static void step(scene_run *run) { SCREE_CHECK_INT(scree_simulation_step(run->simulation, &run->report), SCREE_OK); }

/// A run that stays beside one whose particles change places every so many steps.
static void check_shuffled(const char *text, int shuffle_every, const char *solver)
{
    scene_run still, moving;
    const char *override[] = {solver};
    scene_run_start_with(&still, text, override, solver != NULL);
    scene_run_start_with(&moving, text, override, solver != NULL);
    if (still.simulation == NULL || moving.simulation == NULL) return;
    uint64_t state = 5;
    int64_t num_away = 0, most_contacts = 0, num_ended = 0;
    for (int k = 1; k <= NUM_STEPS; ++k)
    {
        if (k % shuffle_every == 0) shuffle(moving.simulation, &state);
        omp_set_num_threads(1);
        step(&still);
        omp_set_num_threads(1 + k % 2);
        step(&moving);
        num_away += !moving.simulation->buffers->places.are_ids;
        SCREE_CHECK(still.simulation->buffers->places.are_ids);
        if (k % LOOK_EVERY == 0) check_same(still.simulation, moving.simulation);
        const int64_t num = still.simulation->contacts.num_contacts;
        most_contacts = num > most_contacts ? num : most_contacts;
    }
    const scree_averages *averages = &still.simulation->averages;
    for (int64_t r = 0; r < averages->spectrum.num_rows; ++r) num_ended += averages->spectrum_total.count_normal[r];
    printf("%s, %s: up to %lld contacts, %lld collisions counted, away from home in %lld steps\n",
           still.file.scene.name, solver != NULL ? solver : "", (long long)most_contacts, (long long)num_ended,
           (long long)num_away);
    printf("hash %s_%d %016llx\n", still.file.scene.name, shuffle_every,
           (unsigned long long)scree_simulation_hash(moving.simulation));
    SCREE_CHECK(most_contacts > 40 && num_ended > 40 && num_away > NUM_STEPS / 3);
    scene_run_end(&moving);
    scene_run_end(&still);
}

static void test_places_change_no_bit(void)
{
    check_shuffled(spheres_text, 7, NULL);
    check_shuffled(mixed_text, 7, NULL);
    check_shuffled(mixed_text, 1, NULL);
    check_shuffled(spheres_text, 11, "solver.reuse_pairs=false");
    check_shuffled(mixed_text, 5, "solver={separate_patches: true, skin: 0.02}");
    check_shuffled(mixed_text, 3, "solver={find_separation: false, compare_spheres: false}");
}

/// A run that is shuffled, saved, loaded and shuffled again is the unbroken one that stays.
static void test_places_and_checkpoints(void)
{
    char path[500];
    snprintf(path, sizeof path, "%s/checkpoint.h5", scree_test_folder());
    scene_run still, moving;
    scene_run_start(&still, mixed_text);
    uint64_t state = 9;
    for (int part = 0; part < 3; ++part)
    {
        scene_run_start(&moving, mixed_text);
        if (part > 0)
        {
            // what is loaded comes home even where particles lie elsewhere
            for (int k = 0; k < 5; ++k)
            {
                shuffle(moving.simulation, &state);
                step(&moving);
            }
            SCREE_CHECK_INT(scree_checkpoint_load(moving.simulation, path, NULL), SCREE_OK);
        }
        for (int k = 0; k < 60; ++k)
        {
            if (k % 9 == 4) shuffle(moving.simulation, &state);
            step(&still);
            step(&moving);
        }
        check_same(still.simulation, moving.simulation);
        SCREE_CHECK_INT(scree_checkpoint_save(moving.simulation, path, NULL), SCREE_OK);
        scene_run_end(&moving);
    }
    scene_run_end(&still);
}

/// Who has left the range of numbers is told by his id.
static void test_unstable_particle_has_its_id(void)
{
    scene_run run;
    scene_run_start(&run, spheres_text);
    uint64_t state = 3;
    shuffle(run.simulation, &state);
    step(&run);
    SCREE_CHECK_INT(scree_simulation_observe(run.simulation, NULL), SCREE_OK);
    run.simulation->particles.velocity[123].x = NAN;
    shuffle(run.simulation, &state);
    SCREE_CHECK_INT(scree_simulation_step(run.simulation, &run.report), SCREE_UNSTABLE);
    const int last = run.report.num_messages - 1;
    SCREE_CHECK(last >= 0 && strstr(run.report.messages[last], "particle 123 ") != NULL);
    scene_run_end(&run);
}

/// A block of spheres whose ids are drawn at random.
static void mix(scree_simulation *s, uint64_t *state)
{
    for (int64_t k = s->particles.num_particles - 1; k > 0; --k)
    {
        const int64_t other = (int64_t)(scree_test_random(state) * (double)(k + 1));
        const scree_vec3 kept = s->particles.position[k];
        s->particles.position[k] = s->particles.position[other];
        s->particles.position[other] = kept;
    }
    SCREE_CHECK_INT(scree_simulation_restored(s, NULL), SCREE_OK);
}

static const char block_text[] =
    "name: block\ntime: {end: 1, step: 2e-5}\n" HEAD "particles:\n"
    "  - {name: balls, shape: ball, material: stone, count: 3000, seed: 4, velocity: [0, 0, -1], spacing: 1,\n"
    "     size: {distribution: fixed, mean: 0.008},\n"
    "     region: {min: [-0.12, -0.12, 0.02], max: [0.12, 0.12, 0.6]}}\n";

/// Particles that are in the order of a lattice stay; once mixed, they change places, unless the scene has them stay or
/// somebody looks all the time.
static void test_mixed_particles_change_places(void)
{
    uint64_t hash[4];
    for (int k = 0; k < 4; ++k)
    {
        scene_run run;
        // samples of fields are looks, too
        const char *override[] = {"fields.measure=false", "solver.reorder_particles=false"};
        scene_run_start_with(&run, block_text, override, k == 2 ? 2 : 1);
        if (run.simulation == NULL) return;
        scree_places *places = &run.simulation->buffers->places;
        places->few = 1000;
        uint64_t state = 17;
        if (k > 0) mix(run.simulation, &state);
        int64_t num_away = 0;
        for (int n = 0; n < 250; ++n)
        {
            step(&run);
            num_away += !places->are_ids;
            if (k == 3 && n % 10 == 9) SCREE_CHECK_INT(scree_simulation_observe(run.simulation, NULL), SCREE_OK);
        }
        SCREE_CHECK_INT(scree_simulation_observe(run.simulation, NULL), SCREE_OK);
        hash[k] = scree_simulation_hash(run.simulation);
        printf("run %d: away from home in %lld of 250 steps, %lld contacts, %lld searches\n", k, (long long)num_away,
               (long long)run.simulation->contacts.num_contacts, (long long)run.simulation->counters.num_rebuilds);
        SCREE_CHECK(run.simulation->contacts.num_contacts > 1000);
        SCREE_CHECK(k == 0 || k == 2 ? num_away == 0 : k == 1 ? num_away > 240 : num_away > 0 && num_away < 25);
        scene_run_end(&run);
    }
    SCREE_CHECK(hash[1] == hash[2] && hash[1] == hash[3] && hash[0] != hash[1]);
}

static const char dust_text[] =
    "name: dust\ntime: {end: 1, step: 2e-5}\ngravity: [0, 0, 0]\n" HEAD "particles:\n"
    "  - {name: balls, shape: ball, material: stone, count: 2000, seed: 4, velocity: [0, 0, -1], spacing: 20,\n"
    "     size: {distribution: fixed, mean: 0.002},\n"
    "     region: {min: [-0.12, -0.12, 0.02], max: [0.12, 0.12, 3]}}\n";

/// Where all neighbours are far away no order brings them near, and none is tried again and again.
static void test_dust_stays(void)
{
    scene_run run;
    const char *override[] = {"fields.measure=false"};
    scene_run_start_with(&run, dust_text, override, 1);
    if (run.simulation == NULL) return;
    scree_places *places = &run.simulation->buffers->places;
    places->few = 1000;
    int64_t num_away = 0;
    for (int n = 0; n < 200; ++n)
    {
        step(&run);
        num_away += !places->are_ids;
    }
    const int64_t num_searches = run.simulation->counters.num_rebuilds;
    printf("dust: away from home in %lld of 200 steps, %lld searches\n", (long long)num_away, (long long)num_searches);
    SCREE_CHECK(num_away == 0 && num_searches < 50);
    scene_run_end(&run);
}

/// The energies of a moment, which are shown while a run goes on, do not ask for all to come home.
static void test_energies_away_from_home(void)
{
    scene_run run;
    const char *override[] = {"fields.measure=false"};
    scene_run_start_with(&run, mixed_text, override, 1);
    if (run.simulation == NULL) return;
    uint64_t state = 11;
    for (int n = 0; n < 150; ++n)
    {
        if (n == 100) shuffle(run.simulation, &state);
        step(&run);
    }
    SCREE_CHECK(!run.simulation->buffers->places.are_ids && run.simulation->contacts.num_contacts > 20);
    const scree_energies away = scree_simulation_energies(run.simulation);
    SCREE_CHECK_INT(scree_simulation_observe(run.simulation, NULL), SCREE_OK);
    const scree_energies home = scree_simulation_energies(run.simulation);
    // sums of less than 200 terms of one sign in another order
    SCREE_CHECK_CLOSE(away.kinetic, home.kinetic, 200 * DBL_EPSILON * home.kinetic);
    SCREE_CHECK_CLOSE(away.rotational, home.rotational, 200 * DBL_EPSILON * home.rotational);
    SCREE_CHECK_CLOSE(away.elastic_normal, home.elastic_normal, 200 * DBL_EPSILON * home.elastic_normal);
    SCREE_CHECK(home.kinetic > 0 && home.rotational > 0 && home.elastic_normal > 0);
    scene_run_end(&run);
}

int main(void)
{
    SCREE_RUN(test_places_change_no_bit);
    SCREE_RUN(test_places_and_checkpoints);
    SCREE_RUN(test_unstable_particle_has_its_id);
    SCREE_RUN(test_mixed_particles_change_places);
    SCREE_RUN(test_dust_stays);
    SCREE_RUN(test_energies_away_from_home);
    return SCREE_TEST_END();
}
