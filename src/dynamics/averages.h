/// \file averages.h
/// Averages over time that a run keeps while it goes on: fields on a grid, energies of collisions, work of walls. Whole
/// periods alone count: a period is summed up for itself and then added to the total. Part of the moving state.
/// Theory: docs/theory/fields.md.
#ifndef SCREE_AVERAGES_H
#define SCREE_AVERAGES_H

#include "core/scan.h"
#include "forces/collision_kernel.h"
#include "scree/simulation.h"

/// Sums over samples for each cell, x fastest, then y, then z. Owns its arrays.
typedef struct scree_grid_sums
{
    int64_t num_cells;
    double *volume;   ///< [m^3] of particles (num_cells)
    double *mass;     ///< [kg] (num_cells)
    double *momentum; ///< [kg m/s] (num_cells, 3)
    double *speed;    ///< [kg m/s] mass times speed (num_cells)
    double *square;   ///< [kg m^2/s^2] mass times speed squared (num_cells)
} scree_grid_sums;

/// Collisions that have ended, by the energy that they lost: those of particles first, then those with walls, each in
/// bins from below energy_min to above energy_max. Owns its arrays.
typedef struct scree_spectrum
{
    int64_t num_rows;          ///< 2 (energy_bins + 2)
    int64_t *count_normal;     ///< collisions by their normal energy (num_rows)
    int64_t *count_tangential; ///< the same collisions by their tangential energy (num_rows)
    double *energy_normal;     ///< [J] lost by the collisions of count_normal (num_rows)
    double *energy_tangential; ///< [J] (num_rows)
} scree_spectrum;

/// What the present contacts have cost so far, in the order of the contact list. Owns its arrays.
typedef struct scree_collisions
{
    int64_t num_contacts;
    int64_t max_contacts;
    double *normal;       ///< [J] work against the normal forces (num_contacts)
    double *tangential;   ///< [J] against tangential forces and moments (num_contacts)
    scree_device *device; ///< where the arrays lie, NULL: the CPU
} scree_collisions;

/// Work of the walls. Owns its arrays.
typedef struct scree_period_works
{
    int64_t num_walls;
    double *start; ///< [J] at the start of the period under way (num_walls)
    double *total; ///< [J] in all whole periods (num_walls)
} scree_period_works;

typedef struct scree_averages
{
    // constant: set by scree_averages_create()
    bool is_on;           ///< the scene has a section "fields" that measures
    double from, period;  ///< [s]
    int64_t samples;      ///< per period
    int64_t num_cells[3]; ///< along x, y, z
    double cell_size[3];  ///< [m]
    double *cube_size;    ///< [m] (num_shapes) edge of the cube of a particle's volume, at scale 1
    double *bin_edges;    ///< [J] (energy_bins + 1), ascending
    int64_t num_bins;     ///< energy_bins; 0: no collisions

    // moving
    int64_t num_samples; ///< in the period under way
    int64_t num_periods; ///< whole ones in the total
    scree_grid_sums grid, grid_total;
    scree_spectrum spectrum, spectrum_total;
    scree_period_works works;
    scree_collisions collisions;

    // scratch
    scree_collisions old_collisions;
    scree_scan_scratch scan;
    int32_t *ended_places; ///< (max_places)
    int64_t max_places;
    scree_ended_collision *ended; ///< (max_ended)
    int64_t max_ended;
    scree_ended_collision *ended_here; ///< (max_ended_here) the same on the CPU, if they lie on a GPU
    int64_t max_ended_here;
} scree_averages;

/// Makes simulation->averages from the scene; particles and walls must be there, the time step known. Faults: a wall
/// without a period, samples closer than time steps.
scree_status scree_averages_create(scree_simulation *simulation, scree_report *report);
void scree_averages_destroy(scree_averages *averages);
/// Starts anew for the contacts that there are, as at time 0; their collisions count from now on.
scree_status scree_averages_restart(scree_simulation *simulation);
/// After a step: collisions and, if one is due, a sample.
scree_status scree_update_averages(scree_simulation *simulation, scree_report *report);

/// [W] mean power of a wall over the whole periods; NaN before the first is over.
double scree_mean_power(const scree_simulation *simulation, int32_t wall);
/// [N m] mean torque of a wall along its turning while it turned in the whole periods: work over angle. NaN if it has
/// not turned in them.
double scree_mean_torque(const scree_simulation *simulation, int32_t wall);

/// Room for a spectrum or grid of this size, zeroed. SCREE_OUT_OF_MEMORY leaves it empty.
scree_status scree_grid_sums_create(scree_grid_sums *sums, int64_t num_cells);
void scree_grid_sums_destroy(scree_grid_sums *sums);
scree_status scree_spectrum_create(scree_spectrum *spectrum, int64_t num_rows);
void scree_spectrum_destroy(scree_spectrum *spectrum);
/// Room for num_contacts, zeroed.
scree_status scree_collisions_reserve(scree_collisions *collisions, int64_t num_contacts);
/// The same numbers, where *to lies; one of the two is on the CPU.
scree_status scree_collisions_copy(scree_collisions *to, const scree_collisions *from);
/// That of contact order[c] to place c; `scratch` has room for a double of each.
void scree_collisions_permute(scree_collisions *collisions, const int32_t *order, void *scratch);
void scree_collisions_destroy(scree_collisions *collisions);

/// Adds the particles as they are now to the sums.
void scree_grid_add_sample(const scree_simulation *simulation, scree_grid_sums *sums);
/// Frees what scree_update_collisions() works with.
void scree_destroy_collision_scratch(scree_averages *averages, scree_device *device);
/// Works of the present contacts over the step just done; those that have ended go to the spectrum.
scree_status scree_update_collisions(scree_simulation *simulation);

#endif
