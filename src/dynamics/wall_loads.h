/// \file wall_loads.h
/// Torque or force of moving walls along their motion, and the work they have done.
#ifndef SCREE_WALL_LOADS_H
#define SCREE_WALL_LOADS_H

#include "core/vec.h"
#include "scree/simulation.h"

/// Owns its arrays, all (num_walls), zero for walls that never move. Part of the moving state.
typedef struct scree_wall_loads
{
    int64_t num_walls;
    double *load;             ///< [N m] or [N] now, on the particles, along the motion
    double *work;             ///< [J] done on the particles so far
    double *marked_work;      ///< [J] work at the last whole revolution, or at the start of the motion
    int64_t *marked_step;     ///< step of that moment
    double *revolution_power; ///< [W] mean over the last whole revolution; 0 before the first
} scree_wall_loads;

scree_status scree_wall_loads_create(scree_wall_loads *loads, int64_t num_walls);
void scree_wall_loads_destroy(scree_wall_loads *loads);

/// Whole revolutions that a wall has made at `time`; 0 if it does not rotate.
int64_t scree_wall_revolutions(const scree_wall_def *def, double time);

/// Work of the step just done, by the present loads.
void scree_account_wall_loads(scree_simulation *simulation);

#endif
