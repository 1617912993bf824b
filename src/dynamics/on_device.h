/// \file on_device.h
/// A simulation whose step is done on a GPU. The simulation on the host then is a mirror of it: its counters, energies
/// and walls are always up to date, its particles and contacts once they have been observed.
#ifndef SCREE_ON_DEVICE_H
#define SCREE_ON_DEVICE_H

#include "dynamics/state.h"

/// The simulation that the step works on.
static inline scree_simulation *scree_simulation_there(scree_simulation *simulation)
{
    return simulation->there != NULL ? simulation->there : simulation;
}

/// After a step there: what the host needs of it without asking the device.
void scree_take_from_device(scree_simulation *simulation);
/// Frees what lies on the device.
void scree_leave_device(scree_simulation *simulation);

/// Memory of a GPU that the simulation takes, by what it depends on.
typedef struct scree_device_memory
{
    int64_t per_particle, per_pair, per_contact; ///< [bytes]
    int64_t num_pairs, num_contacts;             ///< expected: those of now, or of a dense bed
    int64_t shapes;                              ///< [bytes] of all of them
    int64_t total;                               ///< [bytes] of these, without the buffers of overlaps
} scree_device_memory;

scree_device_memory scree_device_memory_of(const scree_simulation *simulation);
/// Particles of a scene like it that have room in num_free bytes.
int64_t scree_num_that_fit(const scree_device_memory *memory, int64_t num_particles, int64_t num_free);
/// Prints it against what the device has. `stream` is a FILE *.
void scree_simulation_print_device_memory(const scree_simulation *simulation, scree_device *device, void *stream);

#endif
