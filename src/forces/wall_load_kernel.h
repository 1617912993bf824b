/// \file wall_load_kernel.h
/// What moving walls exert on the particles along their motion: the torque about the axis of one that rotates, the
/// force along the velocity of one that translates. Contacts are summed in fixed blocks, so the sum does not depend on
/// the number of threads, nor on which candidate pairs there are.
#ifndef SCREE_WALL_LOAD_KERNEL_H
#define SCREE_WALL_LOAD_KERNEL_H

#include "contact/contact_list.h"
#include "core/team_sum.h"

/// Contacts summed by one index.
#define SCREE_WALL_LOAD_BLOCK 1024

/// The motion that a load is measured along.
typedef struct scree_wall_axis
{
    scree_vec3 direction; ///< [1] unit, of the axis or of the velocity
    scree_vec3 centre;    ///< [m] point of the axis
    bool is_rotating;
} scree_wall_axis;

typedef struct scree_wall_load_args
{
    scree_contact_list contacts;
    const scree_pose *pose;      ///< (num_bodies)
    const int32_t *moving;       ///< (num_walls) index of a wall among the moving ones, or -1
    const scree_wall_axis *axes; ///< (num_moving)
    int32_t num_moving;
    int32_t num_particles;
    scree_real *sums; ///< (num_blocks, num_moving) out: [N m] or [N]
} scree_wall_load_args;

/// Load of contact c on a wall that it touches.
SCREE_FN scree_real scree_wall_load_of_contact(const scree_wall_load_args *a, int64_t c, scree_wall_axis axis)
{
    scree_vec3 along = scree_vec3_add(a->contacts.normal_force[c], a->contacts.tangential_force[c]);
    if (axis.is_rotating)
    {
        const scree_vec3 point = scree_vec3_add(a->pose[a->contacts.bodies[c].i].position, a->contacts.arm[c]);
        along = scree_vec3_cross(scree_vec3_sub(point, axis.centre), along);
        if (!a->contacts.acts_in_points) along = scree_vec3_add(along, a->contacts.moment[c]);
    }
    return scree_vec3_dot(along, axis.direction);
}

/// Block b of SCREE_WALL_LOAD_BLOCK contacts, moving wall by moving wall.
SCREE_FN void scree_wall_load_team_at(scree_wall_load_args a, const scree_team *team, int64_t b)
{
    const int64_t begin = b * SCREE_WALL_LOAD_BLOCK;
    int64_t num = a.contacts.num_contacts - begin;
    if (num > SCREE_WALL_LOAD_BLOCK) num = SCREE_WALL_LOAD_BLOCK;
    for (int32_t m = 0; m < a.num_moving; ++m)
    {
        scree_team_real_sum sum;
        scree_team_sum_zero(&sum);
        SCREE_TURN_BY_TURN
        for (int64_t n = scree_team_lane(team); n < num; n += scree_team_size(team))
        {
            const int32_t wall = a.contacts.bodies[begin + n].j - a.num_particles;
            if (wall < 0 || a.moving[wall] != m) continue;
            scree_team_sum_add(&sum, n, scree_wall_load_of_contact(&a, begin + n, a.axes[m]));
        }
        const scree_real total = scree_team_sum_total(team, &sum);
        if (scree_team_leads(team)) a.sums[b * a.num_moving + m] = total;
    }
}

SCREE_FN void scree_wall_load_at(scree_wall_load_args a, int64_t b)
{
    const scree_team team = scree_team_alone();
    scree_wall_load_team_at(a, &team, b);
}

#endif
