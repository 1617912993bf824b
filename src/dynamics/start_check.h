/// \file start_check.h
/// Is the state at time 0 one that a run can start from?
#ifndef SCREE_START_CHECK_H
#define SCREE_START_CHECK_H

#include "dynamics/state.h"

/// Call with bodies placed and contacts found. Refused: particles too deep in others or wholly inside the solid of a
/// wall, spheres with the same centre, particles outside of a closed vessel, of one wall or of several that hold most
/// particles, or at rest where they would fall past all walls.
scree_status scree_check_start(const scree_simulation *simulation, scree_report *report);

/// Refused: walls that reach into each other and move differently. Told: walls that touch at the start and part later.
/// Call with walls placed.
scree_status scree_check_walls(const scree_simulation *simulation, scree_report *report);

/// Which particles are in no closed vessel: is_outside (num_particles), not touched if no wall is one. `vessel` gets
/// the last wall that is, or -1. SCREE_OUT_OF_MEMORY.
scree_status scree_find_outside_of_vessels(const scree_simulation *simulation, int32_t *vessel, bool *is_outside);

/// Does the wall stay where it is, or turn there, and is there to the end? Others close no vessel.
bool scree_wall_stays(const scree_simulation *simulation, int32_t w);
/// Which particles could leave all walls that stay: is_outside (num_particles), of use if *num_inside > 0, the number
/// of particles that could not. 0 too where nothing can be told. SCREE_OUT_OF_MEMORY.
scree_status scree_find_outside_of_walls(const scree_simulation *simulation, int64_t *num_inside, bool *is_outside);

#endif
