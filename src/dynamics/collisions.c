/// \file collisions.c
/// Energies of collisions: an account for each present contact, a histogram of those that have ended.
#include "dynamics/averages.h"
#include "dynamics/step_buffers.h"

#include <stdlib.h>
#include <string.h>

scree_status scree_spectrum_create(scree_spectrum *spectrum, int64_t num_rows)
{
    const size_t num = (size_t)num_rows + 1;
    *spectrum = (scree_spectrum){.num_rows = num_rows};
    spectrum->count_normal = calloc(num, sizeof *spectrum->count_normal);
    spectrum->count_tangential = calloc(num, sizeof *spectrum->count_tangential);
    spectrum->energy_normal = calloc(num, sizeof *spectrum->energy_normal);
    spectrum->energy_tangential = calloc(num, sizeof *spectrum->energy_tangential);
    const bool is_complete = spectrum->count_normal != NULL && spectrum->count_tangential != NULL &&
                             spectrum->energy_normal != NULL && spectrum->energy_tangential != NULL;
    if (!is_complete) scree_spectrum_destroy(spectrum);
    return is_complete ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

void scree_spectrum_destroy(scree_spectrum *spectrum)
{
    free(spectrum->count_normal);
    free(spectrum->count_tangential);
    free(spectrum->energy_normal);
    free(spectrum->energy_tangential);
    *spectrum = (scree_spectrum){0};
}

scree_status scree_collisions_reserve(scree_collisions *collisions, int64_t num_contacts)
{
    if (num_contacts > collisions->max_contacts || collisions->normal == NULL)
    {
        const int64_t max = num_contacts + num_contacts / 2 + 16;
        double *normal = malloc((size_t)max * sizeof *normal), *tangential = malloc((size_t)max * sizeof *tangential);
        if (normal == NULL || tangential == NULL)
        {
            free(normal);
            free(tangential);
            return SCREE_OUT_OF_MEMORY;
        }
        free(collisions->normal);
        free(collisions->tangential);
        *collisions = (scree_collisions){0, max, normal, tangential};
    }
    collisions->num_contacts = num_contacts;
    memset(collisions->normal, 0, (size_t)num_contacts * sizeof *collisions->normal);
    memset(collisions->tangential, 0, (size_t)num_contacts * sizeof *collisions->tangential);
    return SCREE_OK;
}

/// Row of an energy: 0 below the first edge, num_bins + 1 from the last one on.
static int64_t bin_of(const scree_averages *averages, double energy)
{
    int64_t low = 0, high = averages->num_bins + 1;
    while (low < high)
    {
        const int64_t middle = (low + high) / 2;
        if (averages->bin_edges[middle] <= energy) low = middle + 1;
        else high = middle;
    }
    return low;
}

/// Collisions that this step found ended, in the order of the contacts.
static void count_ended(scree_simulation *s)
{
    scree_averages *averages = &s->averages;
    const scree_collisions *old = &averages->old_collisions;
    scree_spectrum *spectrum = &averages->spectrum;
    for (int64_t o = 0; o < old->num_contacts; ++o)
    {
        if (s->buffers->is_continued[o]) continue;
        const bool is_wall = s->old_contacts.bodies[o].j >= s->particles.num_particles;
        const int64_t first = is_wall ? averages->num_bins + 2 : 0;
        const int64_t normal = first + bin_of(averages, old->normal[o]);
        const int64_t tangential = first + bin_of(averages, old->tangential[o]);
        ++spectrum->count_normal[normal];
        ++spectrum->count_tangential[tangential];
        spectrum->energy_normal[normal] += old->normal[o];
        spectrum->energy_tangential[tangential] += old->tangential[o];
    }
}

scree_status scree_update_collisions(scree_simulation *simulation)
{
    scree_averages *averages = &simulation->averages;
    if (averages->num_bins == 0) return SCREE_OK;
    const scree_collisions last = averages->collisions;
    averages->collisions = averages->old_collisions;
    averages->old_collisions = last;
    const int64_t num_contacts = simulation->contacts.num_contacts;
    const scree_status status = scree_collisions_reserve(&averages->collisions, num_contacts);
    if (status != SCREE_OK) return status;

    scree_collision_args args;
    args.contacts = simulation->contacts;
    args.bodies = scree_step_body_motion(simulation->buffers);
    args.old_of_contact = simulation->buffers->old_of_contact;
    args.old_normal = last.normal;
    args.old_tangential = last.tangential;
    args.time_step = simulation->time_step;
    args.normal = averages->collisions.normal;
    args.tangential = averages->collisions.tangential;
    scree_collision_launch(args, num_contacts);
    count_ended(simulation);
    return SCREE_OK;
}
