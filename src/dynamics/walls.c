#include "dynamics/walls.h"

#include <math.h>

/// Seconds of motion done at `time`, and whether the wall moves right now.
static double moved_seconds(const scree_motion_def *motion, double time, bool *is_moving)
{
    *is_moving = time >= motion->start && time < motion->end;
    if (time <= motion->start) return 0;
    return (time < motion->end ? time : motion->end) - motion->start;
}

static scree_vec3 vec3_from(const double v[3])
{
    return scree_vec3_make((scree_real)v[0], (scree_real)v[1], (scree_real)v[2]);
}

void scree_wall_state_at(const scree_wall_def *def, double time, scree_wall_state *state)
{
    const scree_motion_def *motion = &def->motion;
    bool is_moving = false;
    const double seconds = motion->kind == SCREE_MOTION_FIXED ? 0 : moved_seconds(motion, time, &is_moving);
    const scree_quat start_orientation =
        scree_quat_normalize(scree_quat_make((scree_real)def->orientation[0], (scree_real)def->orientation[1],
                                             (scree_real)def->orientation[2], (scree_real)def->orientation[3]));
    state->is_present = time < def->removed_at;
    state->pose.position = vec3_from(def->position);
    state->pose.orientation = start_orientation;
    state->pose.scale = 1;
    state->velocity = scree_vec3_zero();
    state->angular_velocity = scree_vec3_zero();
    state->centre = state->pose.position;

    if (motion->kind == SCREE_MOTION_TRANSLATE)
    {
        for (int k = 0; k < 3; ++k)
        {
            scree_real *x = k == 0   ? &state->pose.position.x
                            : k == 1 ? &state->pose.position.y
                                     : &state->pose.position.z;
            *x = (scree_real)(def->position[k] + motion->velocity[k] * seconds);
        }
        if (is_moving) state->velocity = vec3_from(motion->velocity);
        state->centre = state->pose.position;
    }
    else if (motion->kind == SCREE_MOTION_ROTATE)
    {
        const double length = sqrt(motion->axis[0] * motion->axis[0] + motion->axis[1] * motion->axis[1] +
                                   motion->axis[2] * motion->axis[2]);
        const double half = 0.5 * motion->angular_velocity * seconds;
        const double s = sin(half) / length;
        const scree_quat turn = scree_quat_make((scree_real)cos(half), (scree_real)(s * motion->axis[0]),
                                                (scree_real)(s * motion->axis[1]), (scree_real)(s * motion->axis[2]));
        const scree_vec3 centre = vec3_from(motion->centre);
        const scree_vec3 offset = scree_vec3_sub(state->pose.position, centre);
        state->pose.position = scree_vec3_add(centre, scree_mat3_apply(scree_mat3_from_quat(turn), offset));
        state->pose.orientation = scree_quat_multiply(turn, start_orientation);
        state->centre = centre;
        if (is_moving)
            state->angular_velocity =
                scree_vec3_make((scree_real)(motion->angular_velocity * motion->axis[0] / length),
                                (scree_real)(motion->angular_velocity * motion->axis[1] / length),
                                (scree_real)(motion->angular_velocity * motion->axis[2] / length));
    }
}
