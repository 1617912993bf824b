/// \file grid_sums.c
/// Particles to the cells of a grid. A particle is spread over the cells by the cube of its volume around its centroid,
/// along the axes of the grid: the shares are products of lengths, exact for any shape, and add up to one.
#include "dynamics/averages.h"

#include "core/launch_cpu.h"
#include "dynamics/state.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

scree_status scree_grid_sums_create(scree_grid_sums *sums, int64_t num_cells)
{
    const size_t num = (size_t)num_cells + 1;
    *sums = (scree_grid_sums){.num_cells = num_cells};
    sums->volume = calloc(num, sizeof *sums->volume);
    sums->mass = calloc(num, sizeof *sums->mass);
    sums->momentum = calloc(3 * num, sizeof *sums->momentum);
    sums->speed = calloc(num, sizeof *sums->speed);
    sums->square = calloc(num, sizeof *sums->square);
    const bool is_complete = sums->volume != NULL && sums->mass != NULL && sums->momentum != NULL &&
                             sums->speed != NULL && sums->square != NULL;
    if (!is_complete) scree_grid_sums_destroy(sums);
    return is_complete ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

void scree_grid_sums_destroy(scree_grid_sums *sums)
{
    free(sums->volume);
    free(sums->mass);
    free(sums->momentum);
    free(sums->speed);
    free(sums->square);
    *sums = (scree_grid_sums){0};
}

/// The cells along one axis that a cube reaches into.
typedef struct cube_range
{
    double low, high; ///< of the cube, in cells
    int64_t first, last;
} cube_range;

static cube_range range_of(const scree_averages *averages, double from, int axis, double centre, double size)
{
    cube_range range;
    const double cell = averages->cell_size[axis];
    range.low = (centre - 0.5 * size - from) / cell;
    range.high = (centre + 0.5 * size - from) / cell;
    // clamped before the conversion: a particle may be anywhere
    const double end = (double)averages->num_cells[axis];
    range.first = (int64_t)floor(fmin(fmax(range.low, 0), end));
    range.last = (int64_t)floor(fmin(fmax(range.high, -1), end - 0.5));
    return range;
}

/// Share of the cube that lies in cell k of the range.
static double share_of(cube_range range, int64_t k)
{
    const double low = fmax(range.low, (double)k), high = fmin(range.high, (double)(k + 1));
    return high > low ? (high - low) / (range.high - range.low) : 0;
}

/// What a particle brings to the cells.
typedef struct particle_sample
{
    double volume, mass, velocity[3], squared_speed;
} particle_sample;

static void add_share(scree_grid_sums *sums, int64_t cell, const particle_sample *sample, double share)
{
    const double mass = sample->mass * share;
    sums->volume[cell] += sample->volume * share;
    sums->mass[cell] += mass;
    for (int k = 0; k < 3; ++k) sums->momentum[3 * cell + k] += mass * sample->velocity[k];
    sums->speed[cell] += mass * sqrt(sample->squared_speed);
    sums->square[cell] += mass * sample->squared_speed;
}

/// What the particle brings to the cells of a layer: those from layer[0] to below layer[1] along the axis.
static void add_particle(const scree_simulation *simulation, int64_t i, int axis, const int64_t layer[2],
                         scree_grid_sums *sums)
{
    const scree_averages *averages = &simulation->averages;
    const scree_particles *p = &simulation->particles;
    const double *from = simulation->scene->fields.region.min;
    const double position[3] = {(double)p->position[i].x, (double)p->position[i].y, (double)p->position[i].z};
    const double size = averages->cube_size[p->shape[i]] * (double)p->scale[i];
    cube_range range[3];
    range[axis] = range_of(averages, from[axis], axis, position[axis], size);
    if (range[axis].first < layer[0]) range[axis].first = layer[0];
    if (range[axis].last >= layer[1]) range[axis].last = layer[1] - 1;
    if (range[axis].first > range[axis].last) return;
    for (int k = 0; k < 3; ++k)
        if (k != axis) range[k] = range_of(averages, from[k], k, position[k], size);

    const scree_vec3 v = p->velocity[i];
    particle_sample sample;
    sample.mass = (double)p->mass[i];
    sample.volume = sample.mass / simulation->scene->materials[p->material[i]].density;
    sample.velocity[0] = (double)v.x;
    sample.velocity[1] = (double)v.y;
    sample.velocity[2] = (double)v.z;
    sample.squared_speed = sample.velocity[0] * sample.velocity[0] + sample.velocity[1] * sample.velocity[1] +
                           sample.velocity[2] * sample.velocity[2];
    for (int64_t z = range[2].first; z <= range[2].last; ++z)
        for (int64_t y = range[1].first; y <= range[1].last; ++y)
            for (int64_t x = range[0].first; x <= range[0].last; ++x)
            {
                const double share = share_of(range[0], x) * share_of(range[1], y) * share_of(range[2], z);
                if (share == 0) continue;
                add_share(sums, (z * averages->num_cells[1] + y) * averages->num_cells[0] + x, &sample, share);
            }
}

void scree_grid_add_sample(const scree_simulation *simulation, scree_grid_sums *sums)
{
    // the grid is cut into layers across its longest side; each thread goes through all particles for its own, so that
    // a cell takes them in their order whatever the number of threads
    const int64_t *num_cells = simulation->averages.num_cells, num = simulation->particles.num_particles;
    int axis = num_cells[1] > num_cells[0] ? 1 : 0;
    if (num_cells[2] > num_cells[axis]) axis = 2;
    const int64_t max_layers = num >= SCREE_LAUNCH_MIN && omp_get_max_threads() > 1 ? 2 * omp_get_max_threads() : 1;
    const int64_t num_layers = num_cells[axis] < max_layers ? num_cells[axis] : max_layers;
#pragma omp parallel for schedule(dynamic, 1) if (num_layers > 1)
    for (int64_t n = 0; n < num_layers; ++n)
    {
        const int64_t layer[2] = {num_cells[axis] * n / num_layers, num_cells[axis] * (n + 1) / num_layers};
        for (int64_t i = 0; i < num; ++i) add_particle(simulation, i, axis, layer, sums);
    }
}
