/// \file bench_drum.c
/// Beads that lie in a drum of meshes, and the same beads in the same places without it: what walls of meshes cost.
#include "cli/bench.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// [m] of the drum of scenes/tumbling_mill_full.yaml, which is filled as much.
#define RADIUS 0.15
#define LENGTH 0.27
#define SOLID_FRACTION 0.1875

/// [s] until the beads lie still enough: they are thrown down, soft, and lose most of their speed in an impact.
#define SETTLING_TIME 0.1

/// What the walls add to a scene, section by section.
static const char
    wall_material[] = "  - {name: wall, density: 1200, youngs_modulus: 3e5, poisson_ratio: 0.42}\n",
    wall_law[] = "  - {materials: [glass, wall], friction_coefficient: 0.31, restitution_coefficient: 0.2}\n",
    wall_shapes[] = "  - name: drum\n    source: turned\n    segments: 180\n    profile:\n"
                    "      [{radius: 0, height: -0.145}, {radius: 0.16, height: -0.145},\n"
                    "       {radius: 0.16, height: 0.145}, {radius: 0, height: 0.145}, {radius: 0, height: 0.135},\n"
                    "       {radius: 0.15, height: 0.135}, {radius: 0.15, height: -0.135},\n"
                    "       {radius: 0, height: -0.135}]\n"
                    "  - {name: lifters, source: box, size: [0.015, 0.01, 0.28], offset: [0.1475, 0, 0], copies: 8}\n",
    walls[] = "walls:\n"
              "  - {name: drum, shape: drum, material: wall, orientation: [0.7071, -0.7071, 0, 0]}\n"
              "  - {name: lifters, shape: lifters, material: wall, orientation: [0.7071, -0.7071, 0, 0]}\n";

static scree_status make(scree_bench_bodies *bodies, int64_t num_beads, const char *step, bool has_walls,
                         const char *solver, scree_report *report)
{
    const double size = cbrt(6 * SOLID_FRACTION * RADIUS * RADIUS * LENGTH / (double)num_beads);
    char text[2400];
    snprintf(text, sizeof text,
             "name: drum\ntime: {end: %g, step: %s}\n"
             "materials:\n"
             "  - {name: glass, density: 2500, youngs_modulus: 3e5, poisson_ratio: 0.23}\n%s"
             "contact_laws:\n"
             "  - {materials: [glass, glass], friction_coefficient: 0.154, restitution_coefficient: 0.2}\n%s"
             "shapes:\n"
             "  - {name: bead, source: sphere, size: %.17g}\n%s"
             "particles:\n"
             "  - {name: beads, shape: bead, material: glass, count: %lld, spacing: 1.02, velocity: [0, 0, %d],\n"
             "     region: {min: [-0.139, -0.135, -0.139], max: [0.139, 0.135, 0.139], cylinder: y}}\n%s"
             "solver: {%s}\n",
             SETTLING_TIME, step, has_walls ? wall_material : "", has_walls ? wall_law : "", size,
             has_walls ? wall_shapes : "", (long long)num_beads, strcmp(step, "auto") == 0 ? -1 : 0,
             has_walls ? walls : "", solver);
    scree_status status = scree_scene_parse(&bodies->file, text, "bench.yaml", NULL, 0, report);
    if (status == SCREE_OK) status = scree_simulation_create(&bodies->simulation, &bodies->file.scene, ".", report);
    return status;
}

static scree_status settle(scree_simulation *s, scree_report *report)
{
    scree_status status = SCREE_OK;
    const int64_t num_steps = scree_simulation_num_steps(s);
    while (status == SCREE_OK && s->step < num_steps) status = scree_simulation_step(s, report);
    return status;
}

scree_status scree_bench_drum_create(scree_bench_bodies drums[2], int64_t num_beads, scree_report *report)
{
    drums[0] = drums[1] = (scree_bench_bodies){0};
    scree_bench_bodies falling = {0};
    scree_status status = make(&falling, num_beads, "auto", true, "", report);
    if (status == SCREE_OK) status = settle(falling.simulation, report);
    // a step so short that nothing moves: without walls the beads stay where they are
    for (int k = 0; k < 2 && status == SCREE_OK; ++k)
    {
        status = make(drums + k, num_beads, "1e-9", k == 1, "", report);
        if (status == SCREE_OK) status = scree_bench_copy_places(drums[k].simulation, falling.simulation, report);
    }
    scree_bench_bed_destroy(&falling);
    for (int k = 0; k < 2 && status != SCREE_OK; ++k) scree_bench_bed_destroy(drums + k);
    return status;
}

scree_status scree_bench_falling_create(scree_bench_bodies twins[2], int64_t num_beads, scree_report *report)
{
    twins[0] = twins[1] = (scree_bench_bodies){0};
    scree_status status = make(twins, num_beads, "auto", true, "", report);
    if (status == SCREE_OK) status = make(twins + 1, num_beads, "auto", true, "skin: 0.1", report);
    for (int k = 0; k < 2 && status != SCREE_OK; ++k) scree_bench_bed_destroy(twins + k);
    return status;
}
