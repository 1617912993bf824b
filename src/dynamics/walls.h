/// \file walls.h
/// Walls: closed meshes with a prescribed motion. Their pose is a closed form of time, so a restart finds it again.
#ifndef SCREE_WALLS_H
#define SCREE_WALLS_H

#include "core/vec.h"
#include "scree/types.h"

/// Where a wall is and how it moves now.
typedef struct scree_wall_state
{
    scree_pose pose;             ///< of the shape's source frame; scale 1
    scree_vec3 velocity;         ///< [m/s] of the point `centre`
    scree_vec3 angular_velocity; ///< [rad/s]
    scree_vec3 centre;           ///< [m] point of the axis of rotation, or the wall's position
    bool is_present;
    int32_t shape;    ///< index of the wall shape
    int32_t material; ///< index of the material
} scree_wall_state;

/// Pose and velocity of the wall at `time`. Exact for translation; for rotation from the angle, so without drift.
void scree_wall_state_at(const scree_wall_def *def, double time, scree_wall_state *state);

#endif
