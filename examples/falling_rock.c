// A rock falls on a plate: a scene from a text, step by step, energies printed. Build: cmake --build build/release
// --target falling_rock
#include "scree/scene.h"
#include "scree/simulation.h"

#include <stdio.h>

static const char scene_text[] =
    "name: falling_rock\n"
    "time: {end: 0.3}\n"
    "materials: [{name: stone, density: 2700, youngs_modulus: 2e7, poisson_ratio: 0.25}]\n"
    "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, restitution_coefficient: 0.5}]\n"
    "shapes:\n"
    "  - {name: rock, source: rock, triangles: 60, seed: 2}\n"
    "  - {name: plate, source: box, size: [0.2, 0.2, 0.01]}\n"
    "particles: [{name: one, shape: rock, material: stone, bodies: [{position: [0, 0, 0.1], size: 0.02}]}]\n"
    "walls: [{name: plate, shape: plate, material: stone, position: [0, 0, -0.005]}]\n";

int main(void)
{
    scree_report report = {0};
    scree_scene_file file = {0};
    scree_simulation *simulation = NULL;
    scree_status status = scree_scene_parse(&file, scene_text, "falling_rock.yaml", NULL, 0, &report);
    if (status == SCREE_OK) status = scree_simulation_create(&simulation, &file.scene, file.folder, &report);

    const int64_t num_steps = status == SCREE_OK ? scree_simulation_num_steps(simulation) : 0;
    for (int64_t k = 0; k <= num_steps && status == SCREE_OK; ++k)
    {
        if (k % (num_steps / 10) == 0)
        {
            const scree_energies e = scree_simulation_energies(simulation);
            printf("t = %.3f s  kinetic %.3e J  dissipated %.3e J  balance %.12e J\n",
                   scree_simulation_time(simulation), e.kinetic + e.rotational, e.damping + e.friction,
                   scree_energies_balance(&e));
        }
        if (k < num_steps) status = scree_simulation_step(simulation, &report);
    }
    for (int k = 0; k < report.num_messages; ++k) fprintf(stderr, "%s\n", report.messages[k]);
    scree_simulation_destroy(simulation);
    scree_scene_close(&file);
    scree_report_clear(&report);
    return status == SCREE_OK ? 0 : 1;
}
