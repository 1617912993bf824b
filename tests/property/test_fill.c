// Random mixtures of up to four groups in random boxes and cylinders: no two bounding spheres meet, all are inside, and
// as many as asked for; where the region is refused, one that is as much higher as the message tells holds them.
#include "scene_run.h"

#include <stdlib.h>

#define SCENES 300
#define TEXT_SIZE 4096

/// A region and the number of particles of each group.
typedef struct mixture
{
    double lower[3], upper[3];
    int axis; ///< of the cylinder; 3: none
    int num_groups, count[4];
} mixture;

static mixture draw_mixture(uint64_t *state)
{
    mixture m = {.axis = (int)(4 * scree_test_random(state))};
    m.num_groups = 1 + (int)(4 * scree_test_random(state));
    for (int k = 0; k < 3; ++k)
    {
        m.lower[k] = 2 * scree_test_random(state) - 1;
        m.upper[k] = m.lower[k] + 0.15 + 0.6 * scree_test_random(state);
    }
    for (int g = 0; g < m.num_groups; ++g) m.count[g] = 1 + (int)(80 * scree_test_random(state));
    return m;
}

/// The scene, with shapes, sizes and seeds from `state`.
static void write_scene(const mixture *m, uint64_t state, char *text)
{
    static const char *const shapes[] = {"ball", "rock", "cube", "trio"};
    int length = snprintf(text, TEXT_SIZE,
                          "name: fill\ntime: {end: 1, step: 1e-5}\ngravity: [0, 0, 0]\n"
                          "materials: [{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"
                          "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]\n"
                          "shapes:\n  - {name: ball, source: sphere, size: 0.05}\n"
                          "  - {name: rock, source: rock, triangles: 40, seed: 3}\n"
                          "  - {name: cube, source: box, size: 0.05}\n"
                          "  - {name: trio, source: clump, spheres: [{position: [0, 0, 0], radius: 0.02},\n"
                          "     {position: [0.02, 0, 0], radius: 0.01}, {position: [0, 0.02, 0], radius: 0.015}]}\n"
                          "particles:\n");
    for (int g = 0; g < m->num_groups; ++g)
    {
        // one after the other: the order of arguments is up to the compiler
        const double share = scree_test_random(&state), size = 0.005 + 0.06 * share * share;
        const char *shape = shapes[(int)(4 * scree_test_random(&state))];
        const int seed = (int)(9 * scree_test_random(&state));
        const double spacing = 1 + scree_test_random(&state);
        const double wider = size * (1 + scree_test_random(&state));
        length += snprintf(text + length, (size_t)(TEXT_SIZE - length),
                           "  - {name: group_%d, shape: %s, material: stone, count: %d, seed: %d, spacing: %.17g,\n"
                           "     size: {distribution: uniform, min: %.17g, max: %.17g},\n"
                           "     region: {min: [%.17g, %.17g, %.17g], max: [%.17g, %.17g, %.17g]%s%c}}\n",
                           g, shape, m->count[g], seed, spacing, size, wider, m->lower[0], m->lower[1], m->lower[2],
                           m->upper[0], m->upper[1], m->upper[2], m->axis < 3 ? ", cylinder: " : "",
                           m->axis < 3 ? "xyz"[m->axis] : ' ');
    }
}

/// How far particle i of the simulation is inside the region with its bounding sphere at the least.
static double depth_inside(const mixture *m, const double x[3], double radius)
{
    double least = INFINITY, narrowest = INFINITY, squared = 0;
    for (int k = 0; k < 3; ++k)
    {
        least = fmin(least, fmin(x[k] - m->lower[k], m->upper[k] - x[k]));
        if (m->axis == 3 || k == m->axis) continue;
        const double off = x[k] - 0.5 * (m->lower[k] + m->upper[k]);
        narrowest = fmin(narrowest, m->upper[k] - m->lower[k]);
        squared += off * off;
    }
    return (m->axis < 3 ? fmin(least, 0.5 * narrowest - sqrt(squared)) : least) - radius;
}

static void check_filled(const mixture *m, const scree_simulation *s)
{
    const scree_particles *p = &s->particles;
    int count[4] = {0}, num_outside = 0, num_meeting = 0;
    for (int64_t i = 0; i < p->num_particles; ++i)
    {
        const double x[3] = {(double)p->position[i].x, (double)p->position[i].y, (double)p->position[i].z};
        const double radius = (double)p->scale[i] * s->particle_shapes[p->shape[i]].properties.bounding_radius;
        ++count[p->group[i]];
        num_outside += depth_inside(m, x, radius) < -1e-12;
        for (int64_t j = 0; j < i; ++j)
        {
            const double other = (double)p->scale[j] * s->particle_shapes[p->shape[j]].properties.bounding_radius;
            const double distance = (double)scree_vec3_length(scree_vec3_sub(p->position[i], p->position[j]));
            num_meeting += distance < radius + other - 1e-12;
        }
    }
    SCREE_CHECK_INT(num_outside, 0);
    SCREE_CHECK_INT(num_meeting, 0);
    for (int g = 0; g < m->num_groups; ++g) SCREE_CHECK_INT(count[g], m->count[g]);
}

/// Makes the scene. True if it is accepted; otherwise how many of the particles fit, as told, to *fitting.
static bool fill(const mixture *m, const char *text, double *fitting)
{
    scree_scene_file file = {0};
    scree_report report = {0};
    scree_simulation *simulation = NULL;
    SCREE_CHECK_INT(scree_scene_parse(&file, text, "test.yaml", NULL, 0, &report), SCREE_OK);
    const bool is_accepted = scree_simulation_create(&simulation, &file.scene, ".", &report) == SCREE_OK;
    if (is_accepted) check_filled(m, simulation);
    else
    {
        SCREE_CHECK_INT(scree_report_num_faults(&report), 1);
        const char *words = m->num_groups == 1 ? "the region holds " : "which holds about ";
        *fitting = (double)NAN;
        for (int k = 0; k < report.num_messages; ++k)
        {
            const char *found = strstr(report.messages[k], words);
            if (found != NULL) *fitting = strtod(found + strlen(words), NULL);
        }
        SCREE_CHECK(*fitting >= 0);
    }
    scree_simulation_destroy(simulation);
    scree_scene_close(&file);
    scree_report_clear(&report);
    return is_accepted;
}

static void test_random_mixtures(void)
{
    uint64_t state = 20;
    int num_accepted = 0, num_refused = 0;
    for (int n = 0; n < SCENES; ++n)
    {
        const int num_failed = scree_test_num_failed;
        mixture m = draw_mixture(&state);
        const uint64_t seed = scree_test_random_bits(&state);
        char text[TEXT_SIZE];
        double fitting = 0, all = 0;
        for (int g = 0; g < m.num_groups; ++g) all += m.count[g];
        write_scene(&m, seed, text);
        const bool is_accepted = fill(&m, text, &fitting);
        num_accepted += is_accepted;
        num_refused += !is_accepted;
        SCREE_CHECK(is_accepted || fitting < all);
        if (!is_accepted && fitting > 0 && m.axis >= 2)
        {
            // a layer may be cut off above, and one more be begun
            const double height = m.upper[2] - m.lower[2];
            m.upper[2] = m.lower[2] + height * (all / fitting + 1) * 2;
            write_scene(&m, seed, text);
            SCREE_CHECK(fill(&m, text, &fitting));
        }
        if (scree_test_num_failed > num_failed) printf("scene %d:\n%s\n", n, text);
    }
    printf("%d mixtures fit, %d do not\n", num_accepted, num_refused);
    SCREE_CHECK(num_accepted > SCENES / 5 && num_refused > SCENES / 5);
}

int main(void)
{
    SCREE_RUN(test_random_mixtures);
    return SCREE_TEST_END();
}
