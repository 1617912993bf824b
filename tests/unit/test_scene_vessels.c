// Keys of turned shapes, copies and regions: values in the structures, and what is said of faults.
#include "scene_run.h"
#include "test_folder.h"

#define HEAD                                                                                       \
    "name: vessels\ntime: {end: 1, step: 1e-5}\n"                                                  \
    "materials: [{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"        \
    "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]\n" \
    "particles: [{name: one, shape: cube, material: stone, bodies: [{position: [0, 0, 0]}]}]\n"

static void test_keys_reach_their_fields(void)
{
    scene_run run;
    scene_run_start(&run, HEAD
                    "shapes:\n"
                    "  - {name: cube, source: box, size: 0.1}\n"
                    "  - name: tube\n    source: turned\n    segments: 20\n"
                    "    profile: [{radius: 0.5, height: -1}, {radius: 0.6, height: -1}, {radius: 0.6, height: 1}]\n"
                    "  - {name: lifters, source: box, size: [0.1, 0.05, 1], offset: [0.4, 0, 0.25], copies: 6}\n"
                    "walls:\n  - {name: tube, shape: tube, material: stone}\n"
                    "  - {name: lifters, shape: lifters, material: stone}\n");
    if (run.simulation == NULL) return;
    const scree_shape_def *tube = run.file.scene.shapes + 1, *lifters = run.file.scene.shapes + 2;
    SCREE_CHECK(tube->source == SCREE_SHAPE_TURNED && tube->num_profile == 3 && tube->segments == 20);
    SCREE_CHECK(tube->profile[1].radius == 0.6 && tube->profile[2].height == 1 && tube->copies == 1);
    SCREE_CHECK(lifters->copies == 6 && lifters->offset[0] == 0.4 && lifters->offset[2] == 0.25);
    SCREE_CHECK_INT(run.simulation->wall_shapes[1].mesh.num_triangles, 120);
    SCREE_CHECK_INT(run.simulation->wall_shapes[2].mesh.num_triangles, 72);
    SCREE_CHECK_CLOSE(run.simulation->wall_shapes[2].view.box.upper.z, 0.75, 1e-6);
    SCREE_CHECK_INT(run.report.num_messages, 0);
    scene_run_end(&run);
}

/// A box of 20 x 30 x 50 in a file, in mm, as a particle and as a wall.
static void test_scale_of_a_file(void)
{
    static const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    char path[512], text[2048];
    snprintf(path, sizeof path, "%s/box.obj", scree_test_folder());
    FILE *file = fopen(path, "w");
    if (file == NULL) exit(EXIT_FAILURE);
    for (int v = 0; v < 8; ++v) fprintf(file, "v %d %d %d\n", v & 1 ? 20 : 0, v & 2 ? 30 : 0, v & 4 ? 50 : 0);
    for (int q = 0; q < 6; ++q)
        fprintf(file, "f %d %d %d %d\n", quads[q][0] + 1, quads[q][1] + 1, quads[q][2] + 1, quads[q][3] + 1);
    fclose(file);
    snprintf(text, sizeof text,
             HEAD "shapes:\n  - {name: cube, source: file, file: \"%s\", scale: 0.001}\n"
                  "walls: [{name: box, shape: cube, material: stone, position: [0, 0, -0.1]}]\n",
             path);
    scene_run run;
    scene_run_start(&run, text);
    if (run.simulation == NULL) return;
    SCREE_CHECK_CLOSE(run.simulation->particles.mass[0], 2500 * 0.02 * 0.03 * 0.05, 1e-8);
    const scree_box box = run.simulation->wall_shapes[0].view.box;
    SCREE_CHECK_CLOSE(box.lower.x, 0, 1e-9);
    SCREE_CHECK_CLOSE(box.upper.x, 0.02, 1e-9);
    SCREE_CHECK_CLOSE(box.upper.z, 0.05, 1e-9);
    scene_run_end(&run);
}

static void test_faults(void)
{
    static const struct
    {
        const char *shape, *message;
    } cases[] = {
        {"source: turned", "test.yaml:7: profile of shapes.0 has 0 corners; a source turned needs 3 or more"},
        {"source: turned, profile: [{radius: 0, height: 0}, {radius: 1, height: 1}, {radius: 2, height: 2}]",
         "profile of shapes.0 has no area"},
        {"source: turned, profile: [{radius: -1, height: 0}]", "radius of shapes.0.profile.0 is -1; it must be"},
        {"source: turned, profile: [{radius: 1}]", "height of shapes.0.profile.0 is missing"},
        {"source: turned, segments: 2", "segments of shapes.0 is 2; it must be an integer in [3, 4096]"},
        {"source: turned, profile: [{radius: 0.1, height: 0}, {radius: 0.2, height: 0.1}, {radius: 0.2, height: 0}, "
         "{radius: 0.1, height: 0.3}]",
         "shape \"odd\": the sides of its profile must not touch or cross each other"},
        {"source: box, copies: 9, offset: [0.5, 0, 0]", "shape \"odd\": its copies must not touch"},
        {"source: file, file: a.obj, scale: -1", "scale of shapes.0 is -1; it must be a number in [1e-09, 1e+09]"},
        {"source: box, scale: 2", "scale of shapes.0 is not used: the source is not file"},
        {"source: box, copies: 0", "copies of shapes.0 is 0; it must be an integer in [1, 1000]"},
        {"source: box, segments: 5", "segments of shapes.0 is not used: the source is not turned"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k)
    {
        char text[2048];
        snprintf(text, sizeof text,
                 HEAD "shapes:\n  - {name: odd, %s}\n  - {name: cube, source: box, size: 0.1}\n"
                      "walls: [{name: odd, shape: odd, material: stone, position: [0, 0, -3]}]\n",
                 cases[k].shape);
        SCREE_CHECK_CONTAINS(scene_run_messages(text), cases[k].message);
    }
}

int main(void)
{
    SCREE_RUN(test_keys_reach_their_fields);
    SCREE_RUN(test_scale_of_a_file);
    SCREE_RUN(test_faults);
    return SCREE_TEST_END();
}
