/// \file collisions.c
/// Energies of collisions: an account for each present contact, a histogram of those that have ended.
#include "dynamics/averages.h"

#include "core/buffer.h"
#include "core/permute.h"
#include "dynamics/on_device.h"
#include "dynamics/step_buffers.h"

#include <stdlib.h>

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

/// Room for so many contacts; what is known of those that there are stays.
static scree_status grow(scree_collisions *collisions, int64_t max_contacts)
{
    scree_device *device = collisions->device;
    if (max_contacts <= collisions->max_contacts && collisions->normal != NULL) return SCREE_OK;
    double *normal = scree_device_alloc(device, max_contacts, sizeof *normal);
    double *tangential = scree_device_alloc(device, max_contacts, sizeof *tangential);
    if (normal == NULL || tangential == NULL)
    {
        scree_device_free(device, normal);
        scree_device_free(device, tangential);
        return SCREE_OUT_OF_MEMORY;
    }
    const size_t num_bytes = (size_t)collisions->num_contacts * sizeof *normal;
    scree_device_copy(device, normal, collisions->normal, num_bytes);
    scree_device_copy(device, tangential, collisions->tangential, num_bytes);
    scree_device_free(device, collisions->normal);
    scree_device_free(device, collisions->tangential);
    collisions->max_contacts = max_contacts;
    collisions->normal = normal;
    collisions->tangential = tangential;
    return SCREE_OK;
}

scree_status scree_collisions_reserve(scree_collisions *collisions, int64_t num_contacts)
{
    scree_device *device = collisions->device;
    if (num_contacts > collisions->max_contacts || collisions->normal == NULL)
    {
        const scree_status status = grow(collisions, scree_buffer_grown(num_contacts));
        if (status != SCREE_OK) return status;
    }
    collisions->num_contacts = num_contacts;
    scree_device_zero(device, collisions->normal, (size_t)num_contacts * sizeof *collisions->normal);
    scree_device_zero(device, collisions->tangential, (size_t)num_contacts * sizeof *collisions->tangential);
    return SCREE_OK;
}

scree_status scree_collisions_copy(scree_collisions *to, const scree_collisions *from)
{
    const scree_status status = scree_collisions_reserve(to, from->num_contacts);
    if (status != SCREE_OK) return status;
    const size_t num_bytes = (size_t)from->num_contacts * sizeof(double);
    if (to->device != NULL)
    {
        scree_device_write(to->device, to->normal, from->normal, num_bytes);
        scree_device_write(to->device, to->tangential, from->tangential, num_bytes);
        return SCREE_OK;
    }
    scree_device_read(from->device, to->normal, from->normal, num_bytes);
    scree_device_read(from->device, to->tangential, from->tangential, num_bytes);
    return SCREE_OK;
}

void scree_collisions_permute(scree_collisions *collisions, const int32_t *order, void *scratch)
{
    const int64_t num = collisions->num_contacts;
    scree_permute(collisions->device, collisions->normal, sizeof *collisions->normal, order, num, scratch);
    scree_permute(collisions->device, collisions->tangential, sizeof *collisions->tangential, order, num, scratch);
}

void scree_collisions_destroy(scree_collisions *collisions)
{
    scree_device_free(collisions->device, collisions->normal);
    scree_device_free(collisions->device, collisions->tangential);
    *collisions = (scree_collisions){.device = collisions->device};
}

void scree_destroy_collision_scratch(scree_averages *averages, scree_device *device)
{
    scree_collisions_destroy(&averages->old_collisions);
    scree_scan_destroy(&averages->scan);
    scree_device_free(device, averages->ended_places);
    scree_device_free(device, averages->ended);
    free(averages->ended_here);
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

/// One collision to the histogram.
static void count(const scree_averages *averages, scree_spectrum *spectrum, const scree_ended_collision *collision)
{
    const int64_t first = collision->is_with_wall ? averages->num_bins + 2 : 0;
    const int64_t normal = first + bin_of(averages, collision->normal);
    const int64_t tangential = first + bin_of(averages, collision->tangential);
    ++spectrum->count_normal[normal];
    ++spectrum->count_tangential[tangential];
    spectrum->energy_normal[normal] += collision->normal;
    spectrum->energy_tangential[tangential] += collision->tangential;
}

/// Room for as many contacts as the lists have, which grow at searches only.
static scree_status make_room(scree_averages *averages, scree_device *device, int64_t max_contacts)
{
    averages->scan.device = device;
    scree_status status = grow(&averages->collisions, max_contacts);
    if (status == SCREE_OK) status = grow(&averages->old_collisions, max_contacts);
    if (status == SCREE_OK) status = scree_scan_reserve(&averages->scan, max_contacts);
    if (status == SCREE_OK)
        status = scree_device_reserve_only(device, &averages->ended_places, &averages->max_places, max_contacts + 1,
                                           sizeof *averages->ended_places);
    if (status == SCREE_OK)
        status = scree_device_reserve_only(device, &averages->ended, &averages->max_ended, max_contacts,
                                           sizeof *averages->ended);
    if (status == SCREE_OK && device != NULL)
        status = scree_device_reserve_only(NULL, &averages->ended_here, &averages->max_ended_here, max_contacts,
                                           sizeof *averages->ended_here);
    return status;
}

/// Order by the ids of the bodies.
static int compare_ended(const void *a, const void *b)
{
    const scree_ended_collision *x = a, *y = b;
    if (x->first != y->first) return x->first < y->first ? -1 : 1;
    if (x->second != y->second) return x->second < y->second ? -1 : 1;
    return (x->patch > y->patch) - (x->patch < y->patch);
}

/// The collisions that this step found ended are put together and come to the host: there are few. One thread counts
/// them, in the order of contacts between bodies that are home.
static void count_ended(scree_simulation *simulation, scree_simulation *there)
{
    scree_averages *scratch = &there->averages;
    const scree_collisions *old = &scratch->old_collisions;
    const int64_t num_old = old->num_contacts;
    scree_device *device = there->device;
    scree_ended_collisions_args args;
    args.bodies = there->old_contacts.bodies;
    args.patch = there->old_contacts.is_one_per_pair ? NULL : there->old_contacts.patch;
    args.ids = scree_ids(there);
    args.is_continued = there->buffers->is_continued;
    args.normal = old->normal;
    args.tangential = old->tangential;
    args.num_particles = (int32_t)there->particles.num_particles;
    args.places = scratch->ended_places;
    args.ended = NULL;
    scree_ended_flag_launch_on(device, args, num_old);
    scree_scan_on(&scratch->scan, args.places, num_old);
    int32_t num = 0;
    scree_device_read(device, &num, args.places + num_old, sizeof num);
    if (num == 0) return;
    args.ended = scratch->ended;
    scree_ended_collisions_launch_on(device, args, num_old);
    scree_ended_collision *here = device != NULL ? scratch->ended_here : scratch->ended;
    if (device != NULL) scree_device_read(device, here, scratch->ended, (size_t)num * sizeof *here);
    if (args.ids != NULL) qsort(here, (size_t)num, sizeof *here, compare_ended);
    for (int32_t k = 0; k < num; ++k) count(&simulation->averages, &simulation->averages.spectrum, here + k);
}

scree_status scree_update_collisions(scree_simulation *simulation)
{
    if (simulation->averages.num_bins == 0) return SCREE_OK;
    scree_simulation *there = scree_simulation_there(simulation);
    scree_averages *averages = &there->averages;
    const int64_t num_contacts = there->contacts.num_contacts;
    scree_status status = make_room(averages, there->device, there->contacts.max_contacts);
    if (status != SCREE_OK) return status;
    const scree_collisions last = averages->collisions;
    averages->collisions = averages->old_collisions;
    averages->old_collisions = last;
    status = scree_collisions_reserve(&averages->collisions, num_contacts);
    if (status != SCREE_OK) return status;

    scree_collision_args args;
    args.contacts = scree_contact_list_view(&there->contacts);
    args.bodies = scree_step_body_motion(there->buffers);
    args.old_of_contact = there->buffers->old_of_contact;
    args.old_normal = last.normal;
    args.old_tangential = last.tangential;
    args.time_step = there->time_step;
    args.normal = averages->collisions.normal;
    args.tangential = averages->collisions.tangential;
    scree_collision_launch_on(there->device, args, num_contacts);
    count_ended(simulation, there);
    return SCREE_OK;
}
