// Particles from a scene: numbers, masses, sizes, places; regions that are too small and bodies inside each other.
#include "scene_run.h"

#include <omp.h>

#define HEAD                                                                                       \
    "name: populate\ntime: {end: 1, step: 1e-5}\n"                                                 \
    "materials: [{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"        \
    "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]\n" \
    "shapes:\n  - {name: rock, source: rock, triangles: 40, seed: 3}\n"                            \
    "  - {name: cube, source: box, size: [0.1, 0.1, 0.1]}\n"

static void test_sizes_follow_the_truncated_normal(void)
{
    scene_run run;
    scene_run_start(&run,
                    HEAD "particles:\n"
                         "  - {name: fill, shape: rock, material: stone, count: 4000, seed: 5,\n"
                         "     size: {distribution: normal, mean: 0.010, deviation: 0.005, min: 0.005, max: 0.010},\n"
                         "     region: {min: [0, 0, 0], max: [1, 1, 1]}}\n");
    if (run.simulation == NULL) return;
    const scree_particles *p = &run.simulation->particles;
    SCREE_CHECK_INT(p->num_particles, 4000);
    const double middle = run.simulation->particle_shapes[p->shape[0]].middle_size;
    double sum = 0;
    for (int64_t i = 0; i < p->num_particles; ++i)
    {
        const double size = (double)p->scale[i] * middle;
        SCREE_CHECK(size >= 0.005 * (1 - 1e-12) && size <= 0.010 * (1 + 1e-12));
        sum += size;
    }
    // mean of a normal truncated to [m - s, m]: m - s (phi(0) - phi(1))/(Phi(0) - Phi(-1)); deviation of the mean 2e-5
    const double phi_0 = 0.3989422804014327, phi_1 = 0.24197072451914337, mass = 0.3413447460685429;
    SCREE_CHECK_CLOSE(sum / 4000, 0.010 - 0.005 * (phi_0 - phi_1) / mass, 1e-4);
    scene_run_end(&run);
}

static void test_total_mass_is_reached_by_the_last_particle(void)
{
    scene_run run;
    scene_run_start(&run, HEAD "particles:\n"
                               "  - {name: fill, shape: rock, material: stone, mass: 1.0, seed: 5,\n"
                               "     size: {distribution: uniform, min: 0.005, max: 0.010},\n"
                               "     region: {min: [0, 0, 0], max: [0.3, 0.3, 1]}}\n");
    if (run.simulation == NULL) return;
    const scree_particles *p = &run.simulation->particles;
    double mass = 0;
    for (int64_t i = 0; i < p->num_particles; ++i) mass += (double)p->mass[i];
    SCREE_CHECK(mass >= 1.0 && mass - (double)p->mass[p->num_particles - 1] < 1.0);
    SCREE_CHECK_INT(run.simulation->contacts.num_contacts, 0);
    scene_run_end(&run);
}

/// A quarter of all orientations turns each body axis up; the mean of each component of R vanishes.
static void test_orientations_are_uniform(void)
{
    scene_run run;
    scene_run_start(&run, HEAD "particles:\n"
                               "  - {name: fill, shape: cube, material: stone, count: 5000, seed: 9,\n"
                               "     region: {min: [0, 0, 0], max: [4, 4, 4]}}\n");
    if (run.simulation == NULL) return;
    const scree_particles *p = &run.simulation->particles;
    double mean[3] = {0}, square[3] = {0};
    for (int64_t i = 0; i < p->num_particles; ++i)
    {
        const scree_mat3 r = scree_mat3_from_quat(p->orientation[i]);
        const double z[3] = {(double)r.row[2].x, (double)r.row[2].y, (double)r.row[2].z};
        for (int k = 0; k < 3; ++k)
        {
            mean[k] += z[k] / 5000;
            square[k] += z[k] * z[k] / 5000;
        }
    }
    // z is uniform in [-1, 1]: deviation of the mean sqrt(1/3/5000), of the mean square sqrt(4/45/5000); five of them
    for (int k = 0; k < 3; ++k)
    {
        SCREE_CHECK_CLOSE(mean[k], 0, 5 * sqrt(1.0 / 3 / 5000));
        SCREE_CHECK_CLOSE(square[k], 1.0 / 3, 5 * sqrt(4.0 / 45 / 5000));
    }
    scene_run_end(&run);
}

/// Creates a simulation that must be refused; returns the messages in one text.
static void refuse(const char *text, char *messages, size_t size)
{
    scree_scene_file file = {0};
    scree_report report = {0};
    scree_simulation *simulation = NULL;
    messages[0] = 0;
    SCREE_CHECK_INT(scree_scene_parse(&file, text, "test.yaml", NULL, 0, &report), SCREE_OK);
    SCREE_CHECK_INT(scree_simulation_create(&simulation, &file.scene, file.folder, &report), SCREE_INVALID_INPUT);
    SCREE_CHECK(simulation == NULL);
    for (int k = 0; k < report.num_messages; ++k)
        snprintf(messages + strlen(messages), size - strlen(messages), "%s\n", report.messages[k]);
    scree_scene_close(&file);
    scree_report_clear(&report);
}

static void test_regions_that_are_too_small_are_told_together(void)
{
    char messages[4096];
    refuse(HEAD
           "particles:\n"
           "  - {name: first, shape: cube, material: stone, count: 100, region: {min: [0, 0, 0], max: [1, 0.2, 0.2]}}\n"
           "  - {name: second, shape: cube, material: stone, count: 7, region: {min: [0, 0, 5], max: [0.1, 1, 6]}}\n",
           messages, sizeof messages);
    SCREE_CHECK_CONTAINS(messages, "particles \"first\": the region holds 5 particles");
    SCREE_CHECK_CONTAINS(messages, "particles \"second\": the region holds 0 particles");
    SCREE_CHECK_CONTAINS(messages, "it is narrower than a cell: make it wider");
}

/// Every vertex inside the cylinder, along each axis; as many as the cross-section has room for.
static void test_cylinders_are_filled(void)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        char text[2048];
        snprintf(text, sizeof text,
                 HEAD "particles:\n  - {name: fill, shape: cube, material: stone, count: 500, seed: 4, spacing: 1.2,\n"
                      "     region: {min: [%g, %g, %g], max: [3, 3, 3], cylinder: %c}}\n",
                 axis == 0 ? -3.0 : 1.0, axis == 1 ? -3.0 : 1.0, axis == 2 ? -3.0 : 1.0, "xyz"[axis]);
        scene_run run;
        scene_run_start(&run, text);
        if (run.simulation == NULL) return;
        const scree_particles *p = &run.simulation->particles;
        const double bound = run.simulation->particle_shapes[p->shape[0]].properties.bounding_radius;
        double farthest = 0;
        for (int64_t i = 0; i < p->num_particles; ++i)
        {
            const double x[3] = {(double)p->position[i].x, (double)p->position[i].y, (double)p->position[i].z};
            double squared = 0;
            for (int k = 0; k < 3; ++k) squared += k == axis ? 0 : (x[k] - 2) * (x[k] - 2);
            farthest = fmax(farthest, sqrt(squared));
            SCREE_CHECK(x[axis] > -3 && x[axis] < 3);
        }
        SCREE_CHECK(farthest + bound <= 1);
        SCREE_CHECK(farthest + bound > 0.8); // the rim is used
        SCREE_CHECK_INT(run.simulation->contacts.num_contacts, 0);
        scene_run_end(&run);
    }
    char messages[4096];
    refuse(HEAD "particles:\n"
                "  - {name: thin, shape: cube, material: stone, count: 1,\n"
                "     region: {min: [0, 0, 0], max: [9, 0.1, 9], cylinder: x}}\n"
                "  - {name: short, shape: cube, material: stone, count: 99,\n"
                "     region: {min: [0, 0, 4], max: [1, 1, 4.2], cylinder: z}}\n",
           messages, sizeof messages);
    SCREE_CHECK_CONTAINS(messages, "particles \"thin\": the region holds 0 particles");
    // middles at 0, 0.1819, 0.3637 from the axis; those within 0.5 - 0.0866 - 0.0061 count: all but the four corners
    SCREE_CHECK_CONTAINS(messages, "particles \"short\": the region holds 21 particles");
    SCREE_CHECK_CONTAINS(messages, "those in the cylinder");
}

#define MIXED                                                                                                     \
    HEAD "  - {name: ball, source: sphere, size: 0.04}\n"                                                         \
         "  - {name: pair, source: clump, spheres: [{position: [-0.02, 0, 0], radius: 0.02},\n"                   \
         "     {position: [0.02, 0, 0], radius: 0.03}]}\n"                                                        \
         "particles:\n"                                                                                           \
         "  - {name: rocks, shape: rock, material: stone, count: 300, seed: 1, velocity: [1, 0, 0],\n"            \
         "     size: {distribution: uniform, min: 0.03, max: 0.06}, region: " REGION "}\n"                        \
         "  - {name: above, shape: ball, material: stone, count: 3, region: {min: [0, 0, 9], max: [1, 1, 10]}}\n" \
         "  - {name: balls, shape: ball, material: stone, mass: 1.0, seed: 1,\n"                                  \
         "     size: {distribution: normal, mean: 0.02, deviation: 0.01, min: 0.01, max: 0.03},\n"                \
         "     region: " REGION "}\n"                                                                             \
         "  - {name: clumps, shape: pair, material: stone, count: 100, spacing: 1.2, region: " REGION "}\n"

/// Number of the group, or -1.
static int64_t group_named(const scree_simulation *s, const char *name)
{
    for (uint32_t g = 0; g < s->scene->num_particles; ++g)
        if (strcmp(s->scene->particles[g].name, name) == 0) return g;
    return -1;
}

/// Number of particles of the group, their mean along z and how far it may be from that of all of them: five deviations
/// of the mean of n out of N values that are drawn without putting back.
static int64_t mean_height(const scree_simulation *s, int64_t group, double *mean, double *allowed)
{
    const scree_particles *p = &s->particles;
    double sum = 0, sum_all = 0, square_all = 0;
    int64_t num = 0, num_all = 0;
    for (int64_t i = 0; i < p->num_particles; ++i)
    {
        const double z = (double)p->position[i].z;
        if (z > 8) continue; // those above
        ++num_all;
        sum_all += z;
        square_all += z * z;
        if (p->group[i] != group) continue;
        ++num;
        sum += z;
    }
    const double n = (double)num, all = (double)num_all;
    const double variance = square_all / all - sum_all * sum_all / all / all;
    *mean = sum / n - sum_all / all;
    *allowed = 5 * sqrt(variance / n * (all - n) / (all - 1));
    return num;
}

/// Rocks, balls and clumps of different sizes in one box and in one cylinder: apart, inside, as many as asked for, and
/// none of the groups above the others.
static void test_groups_of_one_region_are_mixed(void)
{
    static const char *const names[] = {"rocks", "balls", "clumps"}, *const cylinders[] = {"none", "z"};
    for (int c = 0; c < 2; ++c)
    {
        char overrides[3][64];
        const char *all[3];
        for (int k = 0; k < 3; ++k)
        {
            snprintf(overrides[k], sizeof overrides[k], "particles.%s.region.cylinder=%s", names[k], cylinders[c]);
            all[k] = overrides[k];
        }
        scene_run run;
#define REGION "{min: [-0.5, -0.4, 1], max: [0.5, 0.4, 5]}"
        scene_run_start_with(&run, MIXED, all, 3);
        if (run.simulation == NULL) return;
        const scree_particles *p = &run.simulation->particles;
        SCREE_CHECK_INT(run.simulation->contacts.num_contacts, 0);
        int64_t num_inside = 0;
        double farthest = 0, mass = 0;
        for (int64_t i = 0; i < p->num_particles; ++i)
        {
            if (p->group[i] == group_named(run.simulation, "above")) continue;
            const double x = (double)p->position[i].x, y = (double)p->position[i].y, z = (double)p->position[i].z;
            const double r =
                (double)p->scale[i] * run.simulation->particle_shapes[p->shape[i]].properties.bounding_radius;
            num_inside += fabs(x) + r <= 0.5 && fabs(y) + r <= 0.4 && z - r >= 1 && z + r <= 5;
            farthest = fmax(farthest, hypot(x, y) + r);
            SCREE_CHECK((p->velocity[i].x == 1) == (p->group[i] == 0));
            if (p->group[i] == group_named(run.simulation, "balls")) mass += (double)p->mass[i];
        }
        SCREE_CHECK_INT(num_inside, p->num_particles - 3);
        SCREE_CHECK(mass >= 1 && mass < 1.04); // the last ball has up to 35 g
        if (c == 1) SCREE_CHECK(farthest <= 0.4 && farthest > 0.34);
        for (int k = 0; k < 3; ++k)
        {
            double mean, allowed;
            const int64_t num = mean_height(run.simulation, group_named(run.simulation, names[k]), &mean, &allowed);
            if (k != 1) SCREE_CHECK_INT(num, k == 0 ? 300 : 100);
            SCREE_CHECK_CLOSE(mean, 0, allowed);
        }
        scene_run_end(&run);
    }
}

static uint64_t hash_of_mixture(int num_threads, const char *override)
{
    scene_run run;
    omp_set_num_threads(num_threads);
    scene_run_start_with(&run, MIXED, &override, 1);
    const uint64_t hash = run.simulation == NULL ? 0 : scree_simulation_hash(run.simulation);
    scene_run_end(&run);
    return hash;
}

/// The seed of any of the groups mixes them anew, and nothing else does.
static void test_mixtures_depend_on_the_seeds_alone(void)
{
    const int num_threads = omp_get_max_threads();
    const uint64_t one = hash_of_mixture(1, "particles.clumps.seed=0");
    SCREE_CHECK(one != 0);
    SCREE_CHECK(hash_of_mixture(2, "particles.clumps.seed=0") == one);
    SCREE_CHECK(hash_of_mixture(7, "particles.clumps.seed=0") == one);
    SCREE_CHECK(hash_of_mixture(1, "particles.clumps.seed=1") != one);
    SCREE_CHECK(hash_of_mixture(1, "particles.rocks.seed=2") != one);
    omp_set_num_threads(num_threads);
}
#undef REGION

#define TIGHT(count)                                                                                        \
    HEAD "  - {name: large, source: sphere, size: 0.2}\n  - {name: small, source: sphere, size: 0.1}\n"     \
         "particles:\n"                                                                                     \
         "  - {name: large, shape: large, material: stone, count: 60, spacing: 1.25, region: " REGION "}\n" \
         "  - {name: small, shape: small, material: stone, count: " count ", spacing: 1.25, region: " REGION "}\n"
#define REGION "{max: [1, 1, 1]}"

/// 64 cells: 60 balls, and 8 of half their size in each of the 4 others.
static void test_small_particles_share_cells(void)
{
    scene_run run;
    scene_run_start(&run, TIGHT("32"));
    if (run.simulation == NULL) return;
    SCREE_CHECK_INT(run.simulation->particles.num_particles, 92);
    SCREE_CHECK_INT(run.simulation->contacts.num_contacts, 0);
    scene_run_end(&run);

    // 65 cells would hold 93
    char messages[4096];
    refuse(TIGHT("33"), messages, sizeof messages);
    SCREE_CHECK_CONTAINS(messages, "particles \"large\" and \"small\" are filled into one region together, which holds "
                                   "about 91 of the 93 that are asked for (cells of 0.25 m, 4 x 4 x 4)");
}
#undef REGION

static void test_other_regions_that_overlap_are_refused(void)
{
    char messages[4096];
    refuse(HEAD "particles:\n"
                "  - {name: a, shape: cube, material: stone, count: 20, region: {min: [0, 0, 0], max: [1, 1, 1]}}\n"
                "  - {name: b, shape: cube, material: stone, count: 20, region: {min: [0, 0, 0], max: [1, 1, 1.1]}}\n",
           messages, sizeof messages);
    SCREE_CHECK_CONTAINS(messages, "give both groups the same region, which fills them in together, or regions that "
                                   "are apart");
}

static void test_bodies_inside_each_other_are_refused(void)
{
    char messages[4096];
    refuse(HEAD "particles:\n"
                "  - name: block\n    shape: cube\n    material: stone\n"
                "    bodies: [{position: [0, 0, 0]}, {position: [0.08, 0.01, 0.02]}]\n"
                "walls:\n  - {name: obstacle, shape: cube, material: stone, position: [0, 0, -0.08]}\n",
           messages, sizeof messages);
    SCREE_CHECK_CONTAINS(messages, "inside particle 1");
    SCREE_CHECK_CONTAINS(messages, "inside wall \"obstacle\"");
}

/// Cubes whose tops lie on a sigmoid: the fit must find it.
static void test_repose_angle_of_a_known_profile(void)
{
    const double c = 0.5, a = 6, b = 0.55;
    char bodies[4096] = "";
    for (int k = 0; k < 10; ++k)
    {
        const double x = 0.05 + 0.1 * k, height = c / (1 + exp(a * (x - b)));
        char one[96];
        snprintf(one, sizeof one, "%s{position: [%g, %g, %.15g]}", k > 0 ? ", " : "", x, 0.2 * (k % 2), height - 0.05);
        strcat(bodies, one);
    }
    char text[8192];
    snprintf(text, sizeof text,
             HEAD
             "repose: {measure: true, from: 0, to: 1, base: 0, top: 2, bins: 10}\n"
             "particles:\n  - name: block\n    shape: cube\n    material: stone\n    size: {distribution: fixed, mean: "
             "0.0999}\n    bodies: [%s]\n",
             bodies);
    scene_run run;
    scene_run_start(&run, text);
    scree_repose repose;
    if (run.simulation == NULL) return;
    SCREE_CHECK_INT(scree_simulation_repose(run.simulation, &repose), SCREE_OK);
    const double angle = atan(a * c / 4) * 180 / M_PI;
    printf("angle %.6f, expected %.6f degrees, residual %.3g m\n", repose.angle_degrees, angle, repose.residual);
    // the cubes are 0.05 mm lower than the profile
    SCREE_CHECK_CLOSE(repose.angle_degrees, angle, 0.05);
    SCREE_CHECK_CLOSE(repose.middle, b, 1e-3);
    SCREE_CHECK(repose.residual < 1e-4);
    scene_run_end(&run);
}

int main(void)
{
    SCREE_RUN(test_sizes_follow_the_truncated_normal);
    SCREE_RUN(test_total_mass_is_reached_by_the_last_particle);
    SCREE_RUN(test_orientations_are_uniform);
    SCREE_RUN(test_regions_that_are_too_small_are_told_together);
    SCREE_RUN(test_cylinders_are_filled);
    SCREE_RUN(test_groups_of_one_region_are_mixed);
    SCREE_RUN(test_mixtures_depend_on_the_seeds_alone);
    SCREE_RUN(test_small_particles_share_cells);
    SCREE_RUN(test_other_regions_that_overlap_are_refused);
    SCREE_RUN(test_bodies_inside_each_other_are_refused);
    SCREE_RUN(test_repose_angle_of_a_known_profile);
    return SCREE_TEST_END();
}
