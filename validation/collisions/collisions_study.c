// Many isolated pairs of equal bodies of 0.2 m that fly into each other with 5 m/s each, elastic and without friction,
// for the study of collisions: one line of output, a JSON object. See README.md.
//
// Usage: collisions_study SHAPE MODULUS LAW PAIRS STEPS OFFSET TIME [FILE]
//   SHAPE    sphere, or sphere:N, rock:N with N triangles, cube
//   MODULUS  Young's modulus [Pa]
//   LAW      keys of the contact law, like "model: hertz_mindlin"
//   PAIRS    number of pairs, each of two random orientations
//   STEPS    time steps in a central impact of two spheres after Hertz
//   OFFSET   largest distance of the lines of flight over the radius, at random
//   TIME     end of the run, in contact times after Hertz, from where spheres would touch
//   FILE     kinetic energy over that at the start, as doubles: of all pairs, time by time, and then 1 for each pair
//            that is in contact at the end, else 0
#include "scene_run.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

#define RADIUS 0.1
#define SPEED 5.0
#define DENSITY 2500.0
#define POISSON_RATIO 0.25
#define MAX_SAMPLES 160

static double contact_time(double modulus)
{
    const double effective = modulus / (2 * (1 - POISSON_RATIO * POISSON_RATIO));
    const double mass = 4.0 / 3.0 * M_PI * RADIUS * RADIUS * RADIUS * DENSITY / 2;
    const double deepest = pow(15 * mass * 4 * SPEED * SPEED / (16 * effective * sqrt(RADIUS / 2)), 0.4);
    return 2.94328 * deepest / (2 * SPEED);
}

/// Distance of the centres at the start over the radius: beyond the corners of the shape.
static double start_distance(const char *shape) { return strncmp(shape, "sphere", 6) == 0 ? 2.6 : 4; }

static void put_shape(FILE *text, const char *shape)
{
    const char *colon = strchr(shape, ':');
    const int triangles = colon != NULL ? atoi(colon + 1) : 0;
    if (strncmp(shape, "cube", 4) == 0) fprintf(text, "shapes: [{name: body, source: box, size: %g}]\n", 2 * RADIUS);
    else
        fprintf(text, "shapes: [{name: body, source: %.*s, size: %g, triangles: %d, seed: 3}]\n",
                (int)(colon != NULL ? colon - shape : (long)strlen(shape)), shape, 2 * RADIUS, triangles);
}

static void put_body(FILE *text, double x, double y, double z, double speed, uint64_t *state)
{
    double q[4], length;
    do {
        length = 0;
        for (int k = 0; k < 4; ++k)
        {
            q[k] = 2 * scree_test_random(state) - 1;
            length += q[k] * q[k];
        }
    } while (length > 1 || length < 0.01); // evenly over all orientations
    fprintf(
        text,
        "      - {position: [%.17g, %.17g, %.17g], velocity: [%g, 0, 0], orientation: [%.17g, %.17g, %.17g, %.17g]}\n",
        x, y, z, speed, q[0], q[1], q[2], q[3]);
}

/// The scene as text, to be freed. Pairs stand on a lattice wide enough that they never meet others.
static char *make_scene(char **argv, int num_pairs, double time_step, double end)
{
    char *buffer = NULL;
    size_t size = 0;
    FILE *text = open_memstream(&buffer, &size);
    fprintf(text, "gravity: [0, 0, 0]\ntime: {end: %.17g, step: %.17g}\n", end, time_step);
    fprintf(text, "materials: [{name: stone, density: %g, youngs_modulus: %s, poisson_ratio: %g}]\n", DENSITY, argv[2],
            POISSON_RATIO);
    fprintf(text,
            "contact_laws: [{materials: [stone, stone], friction_coefficient: 0, damping_ratio: 0, "
            "contact_moments: false, %s}]\n",
            argv[3]);
    put_shape(text, argv[1]);
    fprintf(text, "particles:\n  - name: pairs\n    shape: body\n    material: stone\n    bodies:\n");
    const double largest = atof(argv[6]) * RADIUS;
    uint64_t state = 20201101;
    for (int k = 0; k < num_pairs; ++k)
    {
        const double start = start_distance(argv[1]) * RADIUS, cell = 2 * (start + 2 * SPEED * end);
        const double x = cell * (k % 32), y = cell * (k / 32 % 32), z = cell * (k / 1024);
        // evenly over the disc
        const double distance = largest * sqrt(scree_test_random(&state)), angle = 2 * M_PI * scree_test_random(&state);
        put_body(text, x - start / 2, y, z, SPEED, &state);
        put_body(text, x + start / 2, y + distance * cos(angle), z + distance * sin(angle), -SPEED, &state);
    }
    fclose(text);
    return buffer;
}

/// Kinetic energy of a pair, of translation and rotation, over that at the start.
static double energy_of_pair(const scree_particles *p, int pair)
{
    double energy = 0, start = 0;
    for (int64_t i = 2 * pair; i < 2 * pair + 2; ++i)
    {
        const scree_vec3 w = scree_angular_velocity(p->angular_momentum[i], p->inertia[i], p->orientation[i]);
        energy += (double)p->mass[i] * (double)scree_vec3_dot(p->velocity[i], p->velocity[i]) +
                  (double)scree_vec3_dot(w, p->angular_momentum[i]);
        start += (double)p->mass[i] * SPEED * SPEED;
    }
    return energy / start;
}

/// Appends a double for each pair.
static void put_pairs(FILE *file, const double *values, int num_pairs)
{
    if (file != NULL) SCREE_CHECK_INT(fwrite(values, sizeof *values, (size_t)num_pairs, file), num_pairs);
}

static void put_touching(FILE *file, const scree_contact_list *contacts, double *touches, int num_pairs)
{
    for (int k = 0; k < num_pairs; ++k) touches[k] = 0;
    for (int64_t c = 0; c < contacts->num_contacts; ++c) touches[contacts->bodies[c].i / 2] = 1;
    put_pairs(file, touches, num_pairs);
}

static void put_list(const char *name, const double *values, int num)
{
    printf("\"%s\": [", name);
    for (int k = 0; k < num; ++k) printf("%s%.8g", k > 0 ? ", " : "", values[k]);
    printf("], ");
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(int argc, char **argv)
{
    if (argc != 8 && argc != 9) return 2;
    const int num_pairs = atoi(argv[4]);
    const double period = contact_time(atof(argv[2])), time_step = period / atof(argv[5]);
    const double end = (start_distance(argv[1]) - 2) * RADIUS / (2 * SPEED) + atof(argv[7]) * period;
    char *text = make_scene(argv, num_pairs, time_step, end);
    scene_run run;
    scene_run_start(&run, text);
    free(text);
    if (run.simulation == NULL) return 1;
    static double times[MAX_SAMPLES], mean[MAX_SAMPLES], deviation[MAX_SAMPLES];
    double *ratio = malloc((size_t)num_pairs * sizeof *ratio);
    FILE *file = argc == 9 ? fopen(argv[8], "wb") : NULL;
    if (ratio == NULL || (argc == 9 && file == NULL)) return 1;
    const int64_t num_steps = scree_simulation_num_steps(run.simulation);
    int num = 0;
    for (int64_t step = 0; step <= num_steps; ++step)
    {
        if (step > 0) SCREE_CHECK_INT(scree_simulation_step(run.simulation, &run.report), SCREE_OK);
        if (step != num_steps && step * (MAX_SAMPLES - 1) / num_steps < num) continue;
        double sum = 0, squares = 0;
        for (int k = 0; k < num_pairs; ++k)
        {
            ratio[k] = energy_of_pair(&run.simulation->particles, k);
            sum += ratio[k];
        }
        for (int k = 0; k < num_pairs; ++k) squares += (ratio[k] - sum / num_pairs) * (ratio[k] - sum / num_pairs);
        put_pairs(file, ratio, num_pairs);
        times[num] = scree_simulation_time(run.simulation);
        mean[num] = sum / num_pairs;
        deviation[num++] = sqrt(squares / fmax(1, num_pairs - 1));
    }
    qsort(ratio, (size_t)num_pairs, sizeof *ratio, compare);
    double squares = 0;
    for (int k = 0; k < num_pairs; ++k) squares += (ratio[k] - 1) * (ratio[k] - 1);
    const scree_simulation *s = run.simulation;
    printf("{\"shape\": \"%s\", \"triangles\": %d, \"modulus\": %s, \"law\": \"%s\", \"pairs\": %d, \"steps\": %s, ",
           argv[1], (int)s->shape_views[0].num_triangles, argv[2], argv[3], num_pairs, argv[5]);
    printf("\"offset\": %s, \"contact_time\": %.8g, \"time_step\": %.8g, \"still_touching\": %d, ", argv[6], period,
           time_step, (int)s->contacts.num_contacts);
    put_list("time", times, num);
    put_list("mean", mean, num);
    put_list("deviation", deviation, num);
    printf("\"seconds\": %.3g, ", (double)clock() / CLOCKS_PER_SEC);
    printf("\"ratio\": {\"min\": %.10g, \"low\": %.10g, \"median\": %.10g, \"high\": %.10g, \"max\": %.10g, \"rms\": "
           "%.6g}, \"indentation\": %.6g}\n",
           ratio[0], ratio[num_pairs / 20], ratio[num_pairs / 2], ratio[num_pairs - 1 - num_pairs / 20],
           ratio[num_pairs - 1], sqrt(squares / num_pairs), s->counters.largest_indentation);
    if (file != NULL) put_touching(file, &s->contacts, ratio, num_pairs);
    SCREE_CHECK(file == NULL || fclose(file) == 0);
    free(ratio);
    scene_run_end(&run);
    return scree_test_num_failed > 0;
}
