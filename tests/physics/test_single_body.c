// One body: free fall, block on an incline, cubes coming to rest, a tower.
#include "scene_run.h"

#define MATERIALS                                                                  \
    "materials:\n"                                                                 \
    "  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}\n" \
    "shapes:\n"                                                                    \
    "  - {name: cube, source: box, size: [0.1, 0.1, 0.1]}\n"                       \
    "  - {name: plate, source: box, size: [4, 4, 0.2]}\n"

static void test_free_fall_is_a_parabola(void)
{
    for (double dt = 1e-3; dt > 1e-4; dt /= 4)
    {
        char text[1024];
        snprintf(text, sizeof text,
                 "name: fall\ntime: {end: 1, step: %g}\n" MATERIALS
                 "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.5, "
                 "restitution_coefficient: 0.5}]\n"
                 "particles:\n"
                 "  - name: one\n    shape: cube\n    material: stone\n"
                 "    bodies: [{position: [1, 2, 3], velocity: [0.5, 0, 2], angular_velocity: [0, 0, 3]}]\n",
                 dt);
        scene_run run;
        scene_run_start(&run, text);
        scene_run_until(&run, 1.0);
        if (run.simulation == NULL) return;
        const scree_particles *p = &run.simulation->particles;
        // constant force: velocity Verlet is exact at any step, rounding of 1000 and 4000 steps remains
        SCREE_CHECK_CLOSE(p->position[0].x, 1.5, 1e-12);
        SCREE_CHECK_CLOSE(p->position[0].z, 3 + 2 - 0.5 * 9.81, 1e-11);
        SCREE_CHECK_CLOSE(p->velocity[0].z, 2 - 9.81, 1e-11);
        // a cube turns like a ball: 4 atan(w dt/4) a step, behind by w^3 dt^2/48 in a second, of second order
        const double angle = 2 * atan2((double)p->orientation[0].z, (double)p->orientation[0].w);
        SCREE_CHECK_CLOSE(angle, 4 / dt * atan(3 * dt / 4), 1e-11);
        SCREE_CHECK_CLOSE(3 - angle, 27 * dt * dt / 48, 1e-11);
        const scree_energies e = scree_simulation_energies(run.simulation);
        const double mass = 2500 * 1e-3;
        SCREE_CHECK_CLOSE(e.kinetic, 0.5 * mass * (0.25 + 7.81 * 7.81), 1e-9);
        SCREE_CHECK_CLOSE(e.rotational, 0.5 * mass * 0.01 / 6 * 9, 1e-12);
        scene_run_end(&run);
    }
}

/// Block on a plate under gravity tilted by `angle`: the same as an incline. Returns speed and distance along x.
static void slide(double tangent, double friction, double time_step, double seconds, double *speed, double *distance)
{
    const double angle = atan(tangent);
    char text[2048];
    snprintf(text, sizeof text,
             "name: incline\ngravity: [%.17g, 0, %.17g]\ntime: {end: 1, step: %g}\n" MATERIALS
             "contact_laws: [{materials: [stone, stone], friction_coefficient: %g, restitution_coefficient: 0.3}]\n"
             "particles:\n  - name: block\n    shape: cube\n    material: stone\n"
             "    bodies: [{position: [0, 0, 0.05]}]\n"
             "walls:\n  - {name: incline, shape: plate, material: stone, position: [0, 0, -0.1]}\n",
             9.81 * sin(angle), -9.81 * cos(angle), time_step, friction);
    scene_run run;
    scene_run_start(&run, text);
    scene_run_until(&run, seconds);
    *speed = *distance = NAN;
    if (run.simulation != NULL)
    {
        *speed = (double)run.simulation->particles.velocity[0].x;
        *distance = (double)run.simulation->particles.position[0].x;
    }
    scene_run_end(&run);
}

static void test_block_sticks_below_the_angle_of_friction(void)
{
    for (double dt = 1e-4; dt > 2e-5; dt /= 4)
    {
        double speed, early, late;
        slide(0.4 * 0.98, 0.4, dt, 0.8, &speed, &early);
        slide(0.4 * 0.98, 0.4, dt, 1.0, &speed, &late);
        printf("dt = %g s: speed %.1e m/s, %.1e m in the last 0.2 s\n", dt, speed, late - early);
        // so near the limit it slips while it settles; then its last swing dies out and it does not creep
        SCREE_CHECK(fabs(speed) < 1e-7);
        SCREE_CHECK(fabs(late - early) < 1e-8);
    }
}

/// Mean acceleration of a block that slides on its face against g (sin - mu cos): exact at any step once it has
/// settled.
static void check_acceleration(double tangent, double friction)
{
    const double angle = atan(tangent), expected = 9.81 * (sin(angle) - friction * cos(angle));
    for (double dt = 1e-4; dt > 2e-5; dt /= 4)
    {
        double early, late, distance;
        slide(tangent, friction, dt, 0.2, &early, &distance);
        slide(tangent, friction, dt, 0.7, &late, &distance);
        printf("tan %.2f, mu %.2f, dt %g: acceleration - expected %.1e m/s^2\n", tangent, friction, dt,
               (late - early) / 0.5 - expected);
        SCREE_CHECK_CLOSE((late - early) / 0.5, expected, 1e-6 * 9.81);
    }
}

static void test_block_slips_above_the_angle_of_friction(void)
{
    check_acceleration(0.4 * 1.05, 0.4);
    check_acceleration(0.8, 0.4);
    check_acceleration(1.0, 0.3);
}

/// A cube dropped from a small height with the given orientation; checks that it lies flat and still at the end.
static void drop(const char *name, double height, const char *orientation)
{
    char text[2048];
    snprintf(text, sizeof text,
             "name: drop\ntime: {end: 3, step: 1e-4}\n" MATERIALS
             "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.5, restitution_coefficient: 0.3}]\n"
             "particles:\n  - name: block\n    shape: cube\n    material: stone\n"
             "    bodies: [{position: [0, 0, %g], orientation: %s}]\n"
             "walls:\n  - {name: floor, shape: plate, material: stone, position: [0, 0, -0.1]}\n",
             height, orientation);
    scene_run run;
    scene_run_start(&run, text);
    scene_run_until(&run, 3.0);
    if (run.simulation != NULL)
    {
        const scree_particles *p = &run.simulation->particles;
        const scree_energies e = scree_simulation_energies(run.simulation);
        const scree_mat3 r = scree_mat3_from_quat(p->orientation[0]);
        // one of the cube's axes stands upright
        const double upright = fmax(fabs((double)r.row[2].x), fmax(fabs((double)r.row[2].y), fabs((double)r.row[2].z)));
        printf("%s: height %.6f m, kinetic %.3g J, upright %.9f\n", name, (double)p->position[0].z,
               e.kinetic + e.rotational, upright);
        SCREE_CHECK(e.kinetic + e.rotational < 1e-9);
        SCREE_CHECK(upright > 1 - 1e-6);
        // the weight m g = c E* sqrt(A d d) gives the indentation d = m g/(c E* a)
        const double modulus = 1e7 / (2 * 0.9375), depth = 2.5 * 9.81 / (0.7522527780636751 * modulus * 0.1);
        SCREE_CHECK_CLOSE(p->position[0].z, 0.05 - depth, 1e-3 * depth + 1e-9);
        // mechanical energy went down and the balance closed
        SCREE_CHECK_CLOSE(scree_energies_balance(&e), 2.5 * 9.81 * height, 1e-3 * 2.5 * 9.81 * height);
    }
    scene_run_end(&run);
}

static void test_cube_dropped_flat_comes_to_rest(void) { drop("flat", 0.06, "[1, 0, 0, 0]"); }
static void test_cube_dropped_on_an_edge_comes_to_rest(void) { drop("edge", 0.09, "[0.93, 0.36755, 0, 0]"); }
static void test_cube_dropped_on_a_corner_comes_to_rest(void) { drop("corner", 0.1, "[0.9, 0.3, 0.28, 0.1]"); }

/// Ten cubes on a plate, each `shift` times (2 (k mod 3), k mod 2) beside the axis; largest kinetic energy from 0.5 to
/// 1 s and from 1.5 to 2 s.
static void build_tower(scene_run *run, double shift, double kinetic[2])
{
    char bodies[2048] = "";
    for (int k = 0; k < 10; ++k)
    {
        char one[128];
        snprintf(one, sizeof one, "%s{position: [%g, %g, %g]}", k > 0 ? ", " : "", shift * 2 * (k % 3), shift * (k % 2),
                 0.05 + 0.1 * k);
        strcat(bodies, one);
    }
    char text[4096];
    snprintf(text, sizeof text,
             "name: tower\ntime: {end: 2, step: 1e-4}\n"
             "materials:\n"
             "  - {name: stone, density: 2500, youngs_modulus: 1e8, poisson_ratio: 0.25}\n"
             "shapes:\n"
             "  - {name: cube, source: box, size: [0.1, 0.1, 0.1]}\n"
             "  - {name: plate, source: box, size: [4, 4, 0.2]}\n"
             "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.5, restitution_coefficient: 0.3}]\n"
             "particles:\n  - name: cubes\n    shape: cube\n    material: stone\n    bodies: [%s]\n"
             "walls:\n  - {name: floor, shape: plate, material: stone, position: [0, 0, -0.1]}\n",
             bodies);
    scene_run_start(run, text);
    kinetic[0] = kinetic[1] = 0;
    for (int k = 10; k <= 40 && run->simulation != NULL; ++k)
    {
        scene_run_until(run, 0.05 * k);
        const scree_energies e = scree_simulation_energies(run->simulation);
        if (k <= 20) kinetic[0] = fmax(kinetic[0], e.kinetic + e.rotational);
        if (k >= 30) kinetic[1] = fmax(kinetic[1], e.kinetic + e.rotational);
    }
}

static void test_straight_tower_of_ten_cubes_comes_to_rest(void)
{
    scene_run run;
    double kinetic[2], sag = 0;
    build_tower(&run, 0, kinetic);
    if (run.simulation == NULL) return;
    printf("straight tower: kinetic %.3g J up to 1 s, %.3g J up to 2 s\n", kinetic[0], kinetic[1]);
    SCREE_CHECK(kinetic[1] < 1e-8);
    for (int k = 0; k < 10; ++k)
    {
        // Contact k carries 10 - k cubes: their weight is c E* sqrt(V d), V = a^2 h, and h what it gives way. On the
        // plate d = h. Between two cubes the strips of their common side faces turn the area vector by h/a about both
        // axes, and the extent of the flat overlap along that normal is d = h + 2 (h/a) a = 3 h.
        const scree_vec3 x = run.simulation->particles.position[k];
        const double stiffness = 0.7522527780636751 * 1e8 / (2 * 0.9375) * 0.1 * (k == 0 ? 1 : sqrt(3));
        sag += (10 - k) * 2.5 * 9.81 / stiffness;
        SCREE_CHECK_CLOSE(x.x, 0, 1e-6);
        SCREE_CHECK_CLOSE(x.z, 0.05 + 0.1 * k - sag, 0.01 * sag);
    }
    scene_run_end(&run);
}

/// Staggered, it sways about its foot; the swaying stays small and does not grow.
static void test_staggered_tower_of_ten_cubes_stands(void)
{
    scene_run run;
    double kinetic[2];
    build_tower(&run, 0.001, kinetic);
    if (run.simulation == NULL) return;
    printf("staggered tower: kinetic %.3g J up to 1 s, %.3g J up to 2 s\n", kinetic[0], kinetic[1]);
    SCREE_CHECK(kinetic[1] < kinetic[0]);
    SCREE_CHECK(kinetic[1] < 0.5 * 25 * 2e-3 * 2e-3);
    for (int k = 0; k < 10; ++k)
    {
        const scree_vec3 x = run.simulation->particles.position[k];
        SCREE_CHECK_CLOSE(x.x, 0.002 * (k % 3), 5e-4);
        SCREE_CHECK_CLOSE(x.y, 0.001 * (k % 2), 5e-4);
        SCREE_CHECK_CLOSE(x.z, 0.05 + 0.1 * k, 5e-4);
    }
    scene_run_end(&run);
}

int main(void)
{
    SCREE_RUN(test_free_fall_is_a_parabola);
    SCREE_RUN(test_block_sticks_below_the_angle_of_friction);
    SCREE_RUN(test_block_slips_above_the_angle_of_friction);
    SCREE_RUN(test_cube_dropped_flat_comes_to_rest);
    SCREE_RUN(test_cube_dropped_on_an_edge_comes_to_rest);
    SCREE_RUN(test_cube_dropped_on_a_corner_comes_to_rest);
    SCREE_RUN(test_straight_tower_of_ten_cubes_comes_to_rest);
    SCREE_RUN(test_staggered_tower_of_ten_cubes_stands);
    return SCREE_TEST_END();
}
