/// \file skin.c
/// The cost of a step over the skin s, in nanoseconds of one core. Candidates grow with the volume around a particle,
/// P(s) = P (R + s)^3 / (R + s0)^3 with the mean bounding radius R, and a search is needed every s/u steps, u being the
/// way of the fastest bodies in one step. A search costs so much per particle and candidate, and every step looks at
/// each candidate. These costs were measured beforehand and are the same everywhere, so that a run searches at the same
/// steps on every machine; the minimum is flat, so they need not be those of the machine.
#include "dynamics/skin.h"

#include "dynamics/step_buffers.h"

#include <math.h>

/// Costs [ns] on one core, measured once and rounded; benchmarks/NOTES.md.
enum
{
    SEARCH_PER_PARTICLE = 400,
    SEARCH_PER_PAIR = 100,
    STEP_PER_MESH_PAIR = 15,
    STEP_PER_SPHERE_PAIR = 8
};

double scree_skin_of_least_cost(const scree_skin_input *input)
{
    const double radius = input->mean_radius, way = input->moved / (double)input->num_steps;
    const double step_per_pair = input->has_meshes ? STEP_PER_MESH_PAIR : STEP_PER_SPHERE_PAIR;
    const double before = radius + input->skin;
    double best = input->skin, least = INFINITY;
    // from a thousandth of the radius to twice it
    for (double skin = 1e-3 * radius; skin <= 2 * radius; skin *= 17.0 / 16)
    {
        const double around = radius + skin;
        const double num_pairs = input->num_pairs * (around * around * around) / (before * before * before);
        const double search = SEARCH_PER_PARTICLE * input->num_particles + SEARCH_PER_PAIR * num_pairs;
        const double steps_between = fmax(skin / way, 1);
        const double cost = search / steps_between + step_per_pair * num_pairs;
        if (cost < least)
        {
            least = cost;
            best = skin;
        }
    }
    return best;
}

scree_real scree_skin_at_start(const scree_simulation *simulation)
{
    const double wanted = simulation->scene->solver.skin;
    return (scree_real)((isnan(wanted) ? 0.1 : wanted) * simulation->buffers->mean_radius);
}

void scree_skin_adapt(scree_simulation *simulation)
{
    scree_step_buffers *b = simulation->buffers;
    const int64_t num_steps = simulation->step - b->searched_step;
    const bool is_automatic = isnan(simulation->scene->solver.skin) && simulation->scene->solver.reuse_pairs;
    // the first search, or one that the skin did not ask for, teaches nothing
    if (!is_automatic || !b->has_pairs || num_steps <= 0 || !(b->moved > b->skin)) return;
    const scree_skin_input input = {.skin = (double)b->skin,
                                    .mean_radius = b->mean_radius,
                                    .moved = (double)b->moved,
                                    .num_steps = num_steps,
                                    .num_particles = (double)simulation->particles.num_particles,
                                    .num_pairs = (double)simulation->broad_phase.num_pairs,
                                    .has_meshes = b->has_travel};
    b->skin = (scree_real)scree_skin_of_least_cost(&input);
}
