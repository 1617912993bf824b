// Rocks poured into a box: nothing tunnels, the books close, the heap comes to rest and does not creep.
#include "scene_run.h"

static const char scene_text[] =
    "name: pile\n"
    "time: {end: 1, step: 2.5e-5}\n"
    "materials:\n"
    "  - {name: rock, density: 2700, youngs_modulus: 2e7, poisson_ratio: 0.25, shear_modulus: 2e7}\n"
    "  - {name: plate, density: 7850, youngs_modulus: 1e8, poisson_ratio: 0.25, shear_modulus: 2e7}\n"
    "contact_laws:\n"
    "  - {materials: [rock, rock], friction_coefficient: 0.39, damping_ratio: 0.453619}\n"
    "  - {materials: [rock, plate], friction_coefficient: 0.35, damping_ratio: 0.382097}\n"
    "shapes:\n"
    "  - {name: rock, source: rock, triangles: 28, seed: 7}\n"
    "  - {name: floor, source: box, size: [0.1, 0.1, 0.01]}\n"
    "  - {name: side, source: box, size: [0.01, 0.1, 0.2]}\n"
    "  - {name: end, source: box, size: [0.1, 0.01, 0.2]}\n"
    "particles:\n"
    "  - {name: fill, shape: rock, material: rock, count: 24, seed: 4, velocity: [0.1, 0, -0.5],\n"
    "     size: {distribution: uniform, min: 0.006, max: 0.010},\n"
    "     region: {min: [-0.03, -0.03, 0.001], max: [0.03, 0.03, 0.2]}}\n"
    "walls:\n"
    "  - {name: floor, shape: floor, material: plate, position: [0, 0, -0.005]}\n"
    "  - {name: left, shape: side, material: plate, position: [-0.035, 0, 0.1]}\n"
    "  - {name: right, shape: side, material: plate, position: [0.035, 0, 0.1]}\n"
    "  - {name: front, shape: end, material: plate, position: [0, -0.035, 0.1]}\n"
    "  - {name: rear, shape: end, material: plate, position: [0, 0.035, 0.1]}\n";

static bool is_inside(const scree_particles *p)
{
    for (int64_t i = 0; i < p->num_particles; ++i)
    {
        const scree_vec3 x = p->position[i];
        if (!(fabs((double)x.x) < 0.03 && fabs((double)x.y) < 0.03 && x.z > 0 && x.z < 0.2)) return false;
    }
    return true;
}

static void test_poured_rocks_come_to_rest(void)
{
    scene_run run;
    scene_run_start(&run, scene_text);
    if (run.simulation == NULL) return;
    const scree_particles *p = &run.simulation->particles;
    const scree_energies start = scree_simulation_energies(run.simulation);
    double worst = 0, highest_after = 0;
    for (int k = 1; k <= 30; ++k)
    {
        scene_run_until(&run, 0.02 * k);
        const scree_energies e = scree_simulation_energies(run.simulation);
        worst = fmax(worst, fabs(scree_energies_balance(&e) - scree_energies_balance(&start)));
        // no wall moves: what is kinetic, potential and elastic only falls, but for what the law itself gives back
        const double mechanical = e.kinetic + e.rotational + e.potential + e.elastic_normal + e.elastic_tangential;
        if (k > 1) SCREE_CHECK(mechanical + e.hysteresis <= highest_after + 1e-3 * start.kinetic);
        highest_after = mechanical + e.hysteresis;
        SCREE_CHECK(is_inside(p));
    }
    const scree_energies rest = scree_simulation_energies(run.simulation);
    const double turned_over = scree_energies_balance(&start) - rest.potential;
    printf("%d contacts, kinetic %.3g J of %.3g J, balance off by %.3g of what was turned over\n",
           (int)run.simulation->contacts.num_contacts, rest.kinetic + rest.rotational, turned_over,
           worst / turned_over);
    SCREE_CHECK(worst < 2e-3 * turned_over);
    SCREE_CHECK(rest.kinetic + rest.rotational < 1e-6 * turned_over);

    // a heap at rest keeps its shape to a hundredth of a rock; a single rock on the floor may rock on the spot
    scree_vec3 before[64];
    for (int64_t i = 0; i < p->num_particles; ++i) before[i] = p->position[i];
    scene_run_until(&run, 0.8);
    double moved = 0;
    for (int64_t i = 0; i < p->num_particles; ++i)
        moved += (double)scree_vec3_length(scree_vec3_sub(p->position[i], before[i])) / (double)p->num_particles;
    printf("mean way in another 0.2 s: %.3g m\n", moved);
    SCREE_CHECK(moved < 8e-5);
    scene_run_end(&run);
}

int main(void)
{
    SCREE_RUN(test_poured_rocks_come_to_rest);
    return SCREE_TEST_END();
}
