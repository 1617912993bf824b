// A free asymmetric top turned by the step of the engine and by forward Euler: each line of the output is one JSON
// object. See README.md. Usage: rotation_study TURNS, the length of the long runs.
#include "dynamics/integrator_kernel.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define INERTIA \
    {           \
        1, 2, 3 \
    }
// angular velocity in the body frame at the start: nearly about the middle axis, |w| about 1
#define START         \
    {                 \
        0.05, 1, 0.02 \
    }

typedef scree_quat (*rotate_function)(scree_quat q, scree_vec3 angular_momentum, scree_vec3 inertia, scree_real dt);

/// As Bilock (2020): q <- q + dt/2 w q, brought to length 1.
static scree_quat rotate_by_euler(scree_quat q, scree_vec3 angular_momentum, scree_vec3 inertia, scree_real dt)
{
    const scree_vec3 w = scree_angular_velocity(angular_momentum, inertia, q);
    const scree_quat turned = scree_quat_multiply(scree_quat_make(0, w.x, w.y, w.z), q);
    return scree_quat_normalize(scree_quat_make(q.w + dt / 2 * turned.w, q.x + dt / 2 * turned.x,
                                                q.y + dt / 2 * turned.y, q.z + dt / 2 * turned.z));
}

/// The top: orientation and, as they follow from it, angular velocity in the body frame and energy.
typedef struct top
{
    scree_quat orientation;
    scree_vec3 momentum, inertia; ///< momentum in world axes
} top;

static top top_start(void)
{
    const scree_vec3 inertia = INERTIA, w = START;
    top t = {{1, 0, 0, 0}, {inertia.x * w.x, inertia.y * w.y, inertia.z * w.z}, inertia};
    return t;
}

static scree_vec3 top_body_velocity(const top *t)
{
    const scree_vec3 l = scree_mat3_apply_transposed(scree_mat3_from_quat(t->orientation), t->momentum);
    return scree_vec3_make(l.x / t->inertia.x, l.y / t->inertia.y, l.z / t->inertia.z);
}

static double top_energy(const top *t)
{
    const scree_vec3 w = top_body_velocity(t);
    return (double)(t->inertia.x * w.x * w.x + t->inertia.y * w.y * w.y + t->inertia.z * w.z * w.z) / 2;
}

/// Where w.y passes zero between two steps: the root of the cubic through values and slopes (Euler's equations).
static double zero_between(const top *t, scree_vec3 before, scree_vec3 after, double dt)
{
    const double factor = (double)((t->inertia.z - t->inertia.x) / t->inertia.y);
    const double y0 = (double)before.y, y1 = (double)after.y;
    const double s0 = factor * (double)(before.z * before.x) * dt, s1 = factor * (double)(after.z * after.x) * dt;
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k)
    {
        const double u = (low + high) / 2;
        const double y = y0 * (1 + 2 * u) * (1 - u) * (1 - u) + s0 * u * (1 - u) * (1 - u) + y1 * u * u * (3 - 2 * u) +
                         s1 * u * u * (u - 1);
        *((y > 0) == (y0 > 0) ? &low : &high) = u;
    }
    return low * dt;
}

/// Mean time between two flips back and forth, over `num` of them, and the largest error of the energy.
static void measure_period(const char *method, rotate_function rotate, int steps_per_turn, int num)
{
    top t = top_start();
    const double dt = 2 * 3.14159265358979323846 / steps_per_turn, energy = top_energy(&t);
    double first = 0, last = 0, worst = 0;
    int found = 0;
    scree_vec3 before = top_body_velocity(&t);
    for (int64_t step = 0; found <= num && step < (int64_t)1000 * steps_per_turn * num; ++step)
    {
        t.orientation = rotate(t.orientation, t.momentum, t.inertia, (scree_real)dt);
        const scree_vec3 after = top_body_velocity(&t);
        worst = fmax(worst, fabs(top_energy(&t) / energy - 1));
        if (before.y < 0 && after.y >= 0)
        {
            last = (double)step * dt + zero_between(&t, before, after, dt);
            if (found++ == 0) first = last;
        }
        before = after;
    }
    printf("{\"part\": \"period\", \"method\": \"%s\", \"steps_per_turn\": %d, \"period\": %.15g, \"flips\": %d, "
           "\"energy_error\": %.6g}\n",
           method, steps_per_turn, found > 1 ? (last - first) / (found - 1) : 0, found - 1, worst);
}

/// Error of energy and of the length of the angular momentum in the body frame, at times that grow by a factor.
static void run_long(const char *method, rotate_function rotate, int steps_per_turn, double turns)
{
    top t = top_start();
    const scree_vec3 start = t.momentum;
    const double dt = 2 * 3.14159265358979323846 / steps_per_turn, energy = top_energy(&t);
    double next = 1, worst = 0;
    const int64_t last = (int64_t)(turns * steps_per_turn);
    for (int64_t step = 1; step <= last; ++step)
    {
        t.orientation = rotate(t.orientation, t.momentum, t.inertia, (scree_real)dt);
        worst = fmax(worst, fabs(top_energy(&t) / energy - 1));
        if ((double)step < next * steps_per_turn && step < last) continue;
        const scree_vec3 l = scree_mat3_apply_transposed(scree_mat3_from_quat(t.orientation), t.momentum);
        printf("{\"part\": \"long\", \"method\": \"%s\", \"steps_per_turn\": %d, \"turns\": %.10g, \"energy_error\": "
               "%.6g, "
               "\"worst\": %.6g, \"length_error\": %.6g, \"same_momentum\": %s}\n",
               method, steps_per_turn, (double)step / steps_per_turn, top_energy(&t) / energy - 1, worst,
               (double)(scree_vec3_length(l) / scree_vec3_length(start)) - 1,
               t.momentum.x == start.x && t.momentum.y == start.y && t.momentum.z == start.z ? "true" : "false");
        next *= 1.5;
    }
}

int main(int argc, char **argv)
{
    if (argc != 2) return 2;
    for (int steps = 16; steps <= 2048; steps *= 2)
    {
        measure_period("scree", scree_rotate, steps, 4);
        measure_period("forward Euler", rotate_by_euler, steps, 4);
    }
    run_long("scree", scree_rotate, 50, atof(argv[1]));
    run_long("forward Euler", rotate_by_euler, 50, atof(argv[1]) / 1000);
    run_long("forward Euler", rotate_by_euler, 5000, atof(argv[1]) / 1000);
    return 0;
}
