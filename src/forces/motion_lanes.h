/// \file motion_lanes.h
/// How the bodies of a group of contacts move, in lanes.
#ifndef SCREE_MOTION_LANES_H
#define SCREE_MOTION_LANES_H

#include "core/lanes.h"
#include "forces/contact_force_kernel.h"

/// Of the first or of the second bodies.
typedef struct scree_motion_lanes
{
    int32_t body[SCREE_LANES];
    scree_lanes_vec3 position, velocity, angular_velocity;
    scree_real inverse_mass[SCREE_LANES];
    scree_real unused[SCREE_LANES]; ///< what stands behind the other vectors
} scree_motion_lanes;

static inline void scree_load_motion(scree_motion_lanes *lanes, const scree_body_motion *bodies)
{
    const int64_t size = sizeof *bodies->moving;
    scree_lanes_gather(&lanes->position, lanes->unused, bodies->pose, sizeof *bodies->pose, lanes->body);
    scree_lanes_gather(&lanes->velocity, lanes->inverse_mass, bodies->moving, size, lanes->body);
    scree_lanes_gather(&lanes->angular_velocity, lanes->unused, &bodies->moving->angular_velocity, size, lanes->body);
}

/// Of the bodies of the contacts `pairs` and following.
static inline void scree_load_motions(scree_motion_lanes *i, scree_motion_lanes *j, const scree_body_motion *bodies,
                                      const scree_candidate_pair *pairs)
{
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        i->body[l] = pairs[l].i;
        j->body[l] = pairs[l].j;
    }
    scree_load_motion(i, bodies);
    scree_load_motion(j, bodies);
}

/// Velocity of i against j at the contact of a lane.
static inline scree_vec3 scree_velocity_of_lane(const scree_motion_lanes *i, const scree_motion_lanes *j,
                                                scree_vec3 arm, int lane)
{
    const scree_motion first = {scree_lanes_get(&i->position, lane), scree_lanes_get(&i->velocity, lane),
                                scree_lanes_get(&i->angular_velocity, lane)};
    const scree_motion second = {scree_lanes_get(&j->position, lane), scree_lanes_get(&j->velocity, lane),
                                 scree_lanes_get(&j->angular_velocity, lane)};
    return scree_velocity_between(&first, &second, arm);
}

#endif
