/// \file moving_body.h
/// What forces need of a body beside its pose, in one record: contacts meet bodies in no order that a cache knows.
#ifndef SCREE_MOVING_BODY_H
#define SCREE_MOVING_BODY_H

#include "core/vec.h"

/// One cache line of 64 bytes in double precision, half of one in single. Each vector stands with the number behind it
/// where four numbers are read at once.
typedef struct scree_moving_body
{
    scree_vec3 velocity;         ///< [m/s] at the position of the pose
    scree_real inverse_mass;     ///< [1/kg]; 0 for walls
    scree_vec3 angular_velocity; ///< [rad/s] world axes
    int32_t material;
} scree_moving_body;

#endif
