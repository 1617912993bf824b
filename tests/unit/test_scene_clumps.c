// Keys of clumps: values in the structures, sizes and filling, the plan, and what is said of faults.
#include "scene_run.h"

#include "scree/simulation.h"

#include <stdlib.h>

#define HEAD                                                                                       \
    "name: clumps\ntime: {end: 1, step: 1e-5}\n"                                                   \
    "materials: [{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"        \
    "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]\n" \
    "walls: [{name: floor, shape: floor, material: stone, position: [0, 0, -0.05]}]\n"             \
    "shapes:\n  - {name: floor, source: box, size: [2, 2, 0.1]}\n"
#define TRIO                                                                           \
    "  - {name: trio, source: clump, spheres: [{position: [0, 0, 0], radius: 0.02},\n" \
    "     {position: [0.03, 0, 0], radius: 0.015}, {position: [0, 0.02, 0], radius: 0.01}]}\n"
#define ONE "particles: [{name: one, shape: trio, material: stone, bodies: [{position: [0, 0, 0.1]}]}]\n"

static void test_keys_reach_their_fields(void)
{
    scene_run run;
    scene_run_start(&run, HEAD TRIO ONE);
    if (run.simulation == NULL) return;
    const scree_shape_def *trio = run.file.scene.shapes + 1;
    SCREE_CHECK(trio->source == SCREE_SHAPE_CLUMP && trio->num_spheres == 3);
    SCREE_CHECK(trio->spheres[1].position[0] == 0.03 && trio->spheres[2].radius == 0.01);
    SCREE_CHECK_INT(run.simulation->shape_views[1].num_spheres, 3);
    SCREE_CHECK_INT(run.report.num_messages, 0);

    char *plan = NULL;
    size_t size;
    FILE *stream = open_memstream(&plan, &size);
    scree_simulation_print_plan(run.simulation, stream);
    fclose(stream);
    SCREE_CHECK_CONTAINS(plan, "spheres and those of clumps on meshes");
    SCREE_CHECK_CONTAINS(plan, "clumps: closed form of their spheres");
    SCREE_CHECK(strstr(plan, "polyhedra") == NULL && strstr(plan, "spheres with each other") == NULL);
    free(plan);
    scene_run_end(&run);
}

/// A region is filled without a contact, and size is the middle extent.
static void test_filled_without_contact(void)
{
    scene_run run;
    scene_run_start(&run, HEAD TRIO
                    "particles: [{name: many, shape: trio, material: stone, count: 200, seed: 1, spacing: 1,\n"
                    "  size: {distribution: uniform, min: 0.01, max: 0.03},\n"
                    "  region: {min: [-0.3, -0.3, 0], max: [0.3, 0.3, 1]}}]\n");
    if (run.simulation == NULL) return;
    const scree_simulation *s = run.simulation;
    SCREE_CHECK_INT(s->contacts.num_contacts, 0);
    SCREE_CHECK(s->time_step > 0);
    for (int64_t i = 0; i < s->particles.num_particles; ++i)
    {
        const double size = (double)s->particles.scale[i] * s->particle_shapes[1].middle_size;
        SCREE_CHECK(size > 0.01 - 1e-9 && size < 0.03 + 1e-9);
    }
    scene_run_end(&run);
}

/// Standing on four balls at once is four times as stiff: the step is half as long as that of a sphere of this mass.
static void test_time_step(void)
{
    double steps[2];
    static const char *const shapes[] = {
        "source: clump, spheres: [{position: [0, 0, 0], radius: 0.01}, {position: [0.002, 0, 0], radius: 0.01},\n"
        "  {position: [0, 0.002, 0], radius: 0.01}, {position: [0.002, 0.002, 0], radius: 0.01}]",
        "source: sphere, size: 0.02"};
    double masses[2];
    for (int k = 0; k < 2; ++k)
    {
        char text[2000];
        snprintf(text, sizeof text,
                 "name: step\ntime: {end: 1}\n"
                 "materials: [{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"
                 "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]\n"
                 "shapes: [{name: body, %s}]\n"
                 "particles: [{name: one, shape: body, material: stone, count: 2, region: {min: [0, 0, 0], "
                 "max: [0.1, 0.1, 0.1]}}]\n",
                 shapes[k]);
        scene_run run;
        scene_run_start(&run, text);
        if (run.simulation == NULL) return;
        steps[k] = run.simulation->time_step;
        masses[k] = (double)run.simulation->particles.mass[0];
        scene_run_end(&run);
    }
    SCREE_CHECK_CLOSE(steps[0] / sqrt(masses[0]), steps[1] / sqrt(masses[1]) / 2, 1e-6 * steps[1] / sqrt(masses[1]));
}

static void test_faults(void)
{
    static const struct
    {
        const char *shape, *message;
    } cases[] = {
        {"source: clump", "test.yaml:8: spheres of shapes.1 is empty; a source clump needs 1 or more, each like"},
        {"source: clump, spheres: []", "spheres of shapes.1 is empty"},
        {"source: clump, spheres: [{position: [0, 0, 0], radius: 0.1}, {position: [0.3, 0, 0], radius: 0.1}]",
         "test.yaml:8: spheres of shapes.1 is not connected: number 1 is 0.1 m from number 0, the nearest of the "
         "others; move them together until they overlap, or make two shapes"},
        {"source: clump, spheres: [{position: [0, 0, 0], radius: 0.1}, {position: [0, 0, 0], radius: 0.1}]",
         "spheres of shapes.1 has number 1 wholly inside number 0; remove it"},
        {"source: clump, spheres: [{position: [0, 0, 0], radius: 0}]",
         "radius of shapes.1.spheres.0 is 0; it must be a number in [1e-12, 1e+06]"},
        {"source: clump, spheres: [{position: [0, 0, 0]}]", "radius of shapes.1.spheres.0 is missing"},
        {"source: clump, spheres: [{radius: 1}]", "position of shapes.1.spheres.0 is missing"},
        {"source: clump, copies: 2, spheres: [{position: [0, 0, 0], radius: 0.1}]",
         "copies of shapes.1 is 2, but a clump cannot be repeated"},
        {"source: clump, size: 2, spheres: [{position: [0, 0, 0], radius: 0.01}]",
         "size of shapes.1 is not used: the spheres have the lengths"},
        {"source: box, size: 0.01, spheres: [{position: [0, 0, 0], radius: 0.1}]",
         "spheres of shapes.1 is not used: the source is not clump"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k)
    {
        char text[2048];
        snprintf(text, sizeof text, HEAD "  - {name: trio, %s}\n" ONE, cases[k].shape);
        SCREE_CHECK_CONTAINS(scene_run_messages(text), cases[k].message);
    }
    static char many[20000];
    int length = snprintf(many, sizeof many, HEAD "  - {name: trio, source: clump, spheres: [");
    for (int k = 0; k < 257; ++k)
        length +=
            snprintf(many + length, sizeof many - (size_t)length, "{position: [%g, 0, 0], radius: 0.1},", 0.1 * k);
    snprintf(many + length, sizeof many - (size_t)length, "]}\n" ONE);
    SCREE_CHECK_CONTAINS(scene_run_messages(many), "spheres of shapes.1 has 257 items");
    SCREE_CHECK_CONTAINS(
        scene_run_messages(
            "name: wall\ntime: {end: 1}\n"
            "materials: [{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"
            "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]\n"
            "walls: [{name: floor, shape: trio, material: stone}]\nshapes:\n" TRIO ONE),
        "shape of walls.0 is \"trio\", a clump, but walls are meshes; give it a shape of its own");
}

/// A cube, a ball and a rock filled: the largest sphere first, all inside, the more the fuller.
static void test_filled_meshes(void)
{
    static const char *const meshes[] = {"source: box, size: 0.1", "source: sphere, size: 0.1, triangles: 320",
                                         "source: rock, size: 0.1, triangles: 60, seed: 3"};
    for (int m = 0; m < 3; ++m)
    {
        double last = 0;
        for (int num = 1; num <= 64; num *= 8)
        {
            char text[2000];
            snprintf(text, sizeof text,
                     HEAD
                     "  - {name: mesh, %s}\n  - {name: trio, source: clump, fill: {shape: mesh, spheres: %d}}\n"
                     "particles:\n  - {name: one, shape: trio, material: stone, bodies: [{position: [0, 0, 0.2]}]}\n"
                     "  - {name: two, shape: mesh, material: stone, bodies: [{position: [0.3, 0, 0.2]}]}\n",
                     meshes[m], num);
            scene_run run;
            scene_run_start(&run, text);
            if (run.simulation == NULL) return;
            const scree_particles *p = &run.simulation->particles;
            const double share = (double)p->mass[0] / (double)p->mass[1];
            printf("%d spheres in %.30s: %.4f of the volume\n", num, meshes[m], share);
            SCREE_CHECK_INT(run.simulation->shape_views[2].num_spheres, num);
            SCREE_CHECK(share > last && share < 1);
            if (m == 0 && num == 1) SCREE_CHECK_CLOSE(share, M_PI / 6, 1e-6);
            last = share;
            scene_run_end(&run);
        }
    }
    SCREE_CHECK_CONTAINS(
        scene_run_messages(HEAD TRIO "  - {name: other, source: clump, fill: {shape: trio, spheres: 4}}\n" ONE),
        "fill.shape of shapes.2 is \"trio\", which has no mesh to fill");
    SCREE_CHECK_CONTAINS(
        scene_run_messages(HEAD "  - {name: trio, source: clump, fill: {shape: flor, spheres: 4}}\n" ONE),
        "fill.shape of shapes.1 is \"flor\"");
    SCREE_CHECK_CONTAINS(
        scene_run_messages(HEAD "  - {name: trio, source: clump, fill: {shape: floor, spheres: 999}}\n" ONE),
        "spheres of shapes.1.fill is 999; it must be an integer in [1, 256]");
    SCREE_CHECK_CONTAINS(
        scene_run_messages(HEAD "  - {name: trio, source: clump, fill: {shape: floor}, spheres: [{position: "
                                "[0, 0, 0], radius: 0.1}]}\n" ONE),
        "spheres of shapes.1 are given, but so is fill; remove one of them");
    SCREE_CHECK_CONTAINS(scene_run_messages(HEAD "  - {name: trio, source: box, fill: {shape: floor}}\n" ONE),
                         "fill of shapes.1 is not used: the source is not clump");
}

int main(void)
{
    SCREE_RUN(test_filled_meshes);
    SCREE_RUN(test_keys_reach_their_fields);
    SCREE_RUN(test_filled_without_contact);
    SCREE_RUN(test_time_step);
    SCREE_RUN(test_faults);
    return SCREE_TEST_END();
}
