// Same bits: for 1, 2 and 7 threads, for a search at every step, and the golden hash of a scene, which other compilers
// must reproduce. Printed as "hash NAME VALUE" for comparison between builds.
#include "scene_run.h"

#include <omp.h>

static const char polyhedra_text[] =
    "name: determinism\n"
    "time: {end: 0.16, step: 5e-5}\n"
    "materials:\n"
    "  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}\n"
    "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]\n"
    "shapes:\n"
    "  - {name: rock, source: rock, triangles: 40, seed: 3}\n"
    "  - {name: schoenhardt, source: schoenhardt, size: [0.02, 0, 0]}\n"
    "  - {name: floor, source: box, size: [0.3, 0.3, 0.02]}\n"
    "particles:\n"
    "  - {name: rocks, shape: rock, material: stone, count: 60, seed: 1, velocity: [0, 0, -2],\n"
    "     size: {distribution: uniform, min: 0.01, max: 0.02},\n"
    "     region: {min: [-0.07, -0.07, 0.001], max: [0.07, 0.07, 0.4]}}\n"
    "  - {name: twisted, shape: schoenhardt, material: stone, count: 40, seed: 2, velocity: [0, 0, -5],\n"
    "     region: {min: [-0.07, -0.07, 0.4], max: [0.07, 0.07, 0.8]}}\n"
    "walls:\n"
    "  - {name: floor, shape: floor, material: stone, position: [0, 0, -0.01],\n"
    "     motion: {kind: translate, velocity: [0, 0, 0.2], start: 0.02, end: 0.05}}\n";

/// Spheres of all sizes, clumps and rocks that are thrown into a corner with a step.
static const char spheres_text[] =
    "name: spheres\n"
    "time: {end: 0.06, step: 5e-5}\n"
    "materials:\n"
    "  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}\n"
    "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]\n"
    "shapes:\n"
    "  - {name: ball, source: sphere, size: 0.02}\n"
    "  - {name: rock, source: rock, triangles: 40, seed: 3}\n"
    "  - {name: floor, source: box, size: [0.3, 0.3, 0.02]}\n"
    "  - {name: wall, source: box, size: [0.02, 0.3, 0.3]}\n"
    "  - {name: trio, source: clump, spheres: [{position: [0, 0, 0], radius: 0.007},\n"
    "     {position: [0.006, 0, 0], radius: 0.006}, {position: [0, 0.007, 0], radius: 0.005}]}\n"
    "particles:\n"
    "  - {name: trios, shape: trio, material: stone, count: 40, seed: 3, velocity: [1, 0, -5],\n"
    "     region: {min: [-0.07, -0.07, 0.4], max: [0.07, 0.07, 0.5]}}\n"
    "  - {name: balls, shape: ball, material: stone, count: 150, seed: 1, velocity: [1, 0, -2],\n"
    "     size: {distribution: uniform, min: 0.005, max: 0.02},\n"
    "     region: {min: [-0.07, -0.07, 0.001], max: [0.07, 0.07, 0.4]}}\n"
    "  - {name: rocks, shape: rock, material: stone, count: 20, seed: 1, velocity: [1, 0, -4],\n"
    "     size: {distribution: uniform, min: 0.01, max: 0.02},\n"
    "     region: {min: [-0.07, -0.07, 0.2], max: [0.07, 0.07, 0.4]}}\n"
    "walls:\n"
    "  - {name: floor, shape: floor, material: stone, position: [0, 0, -0.01]}\n"
    "  - {name: step, shape: floor, material: stone, position: [0.225, 0, -0.002]}\n"
    "  - {name: side, shape: wall, material: stone, position: [0.16, 0, 0.1], orientation: [0.97, 0.1, 0.2, 0.05]}\n";

/// Hash after the scene's end with so many threads and one or two keys of the scene replaced, or NULL.
static uint64_t run_hash(const char *scene_text, int num_threads, const char *override, const char *other)
{
    omp_set_num_threads(num_threads);
    scene_run run;
    const char *overrides[] = {override, other};
    scene_run_start_with(&run, scene_text, overrides, (override != NULL) + (other != NULL));
    uint64_t hash = 0;
    if (run.simulation != NULL)
    {
        for (int64_t k = scree_simulation_num_steps(run.simulation); k > 0; --k)
            SCREE_CHECK_INT(scree_simulation_step(run.simulation, &run.report), SCREE_OK);
        printf("%d threads, %s: %d contacts at the end, %d searches\n", num_threads, override != NULL ? override : "",
               (int)run.simulation->contacts.num_contacts, (int)run.simulation->counters.num_rebuilds);
        SCREE_CHECK(run.simulation->contacts.num_contacts > 30);
        hash = scree_simulation_hash(run.simulation);
    }
    scene_run_end(&run);
    return hash;
}

static void check_same_bits(const char *scene_text, const char *name)
{
    const uint64_t one = run_hash(scene_text, 1, NULL, NULL);
    printf("hash %s %016llx\n", name, (unsigned long long)one);
    SCREE_CHECK(run_hash(scene_text, 2, NULL, NULL) == one);
    SCREE_CHECK(run_hash(scene_text, 7, NULL, NULL) == one);
    SCREE_CHECK(run_hash(scene_text, 2, "solver.reuse_pairs=false", NULL) == one);
}

/// Each piece of work that is avoided, done after all; and skins of all widths.
static void check_savings(const char *scene_text, const char *end)
{
    static const char *const keys[] = {"solver.reorder_particles=false",
                                       "solver.compare_spheres=false",
                                       "solver.find_separation=false",
                                       "solver.remember_separation=false",
                                       "solver.bound_separation=false",
                                       "solver.skin=0.002",
                                       "solver.skin=0.3",
                                       "solver.skin=2"};
    const uint64_t all = run_hash(scene_text, 1, end, NULL);
    for (size_t k = 0; k < sizeof keys / sizeof *keys; ++k)
        for (int num_threads = 1; num_threads <= 2; ++num_threads)
            SCREE_CHECK(run_hash(scene_text, num_threads, keys[k], end) == all);
    // all of them together: a search of all pairs of boxes in each step, and the overlap of each
    static const char nothing_avoided[] =
        "solver={skin: 0.1, reuse_pairs: false, compare_spheres: false, "
        "find_separation: false, remember_separation: false, bound_separation: false}";
    SCREE_CHECK(run_hash(scene_text, 2, nothing_avoided, end) == all);
}

static void test_avoided_work_changes_no_bit(void)
{
    check_savings(polyhedra_text, "time.end=0.08");
    check_savings(spheres_text, "time.end=0.03");
}

static void test_same_bits_however_it_is_run(void) { check_same_bits(polyhedra_text, "rocks_and_schoenhardt"); }

static void test_same_bits_of_spheres(void) { check_same_bits(spheres_text, "spheres_clumps_and_rocks"); }

int main(void)
{
    SCREE_RUN(test_same_bits_however_it_is_run);
    SCREE_RUN(test_same_bits_of_spheres);
    SCREE_RUN(test_avoided_work_changes_no_bit);
    return SCREE_TEST_END();
}
