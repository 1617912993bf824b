/// \file start_check.h
/// Is the state at time 0 one that a run can start from?
#ifndef SCREE_START_CHECK_H
#define SCREE_START_CHECK_H

#include "dynamics/state.h"

/// Call with bodies placed and contacts found. Refused: particles too deep in others or wholly inside the solid of a
/// wall, spheres with the same centre, particles at rest that would fall past all walls.
scree_status scree_check_start(const scree_simulation *simulation, scree_report *report);

/// Refused: walls that reach into each other and move differently. Call with walls placed.
scree_status scree_check_walls(const scree_simulation *simulation, scree_report *report);

#endif
