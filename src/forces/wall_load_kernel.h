/// \file wall_load_kernel.h
/// What moving walls exert on the particles along their motion: the torque about the axis of one that rotates, the
/// force along the velocity of one that translates. Contacts are summed in fixed blocks, so the sum does not depend on
/// the number of threads, nor on which candidate pairs there are.
#ifndef SCREE_WALL_LOAD_KERNEL_H
#define SCREE_WALL_LOAD_KERNEL_H

#include "contact/contact_list.h"

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

/// Block b of SCREE_WALL_LOAD_BLOCK contacts.
SCREE_FN void scree_wall_load_at(scree_wall_load_args a, int64_t b)
{
    scree_real *sums = a.sums + b * a.num_moving;
    for (int32_t m = 0; m < a.num_moving; ++m) sums[m] = 0;
    const int64_t begin = b * SCREE_WALL_LOAD_BLOCK;
    int64_t end = begin + SCREE_WALL_LOAD_BLOCK;
    if (end > a.contacts.num_contacts) end = a.contacts.num_contacts;
    for (int64_t c = begin; c < end; ++c)
    {
        const scree_candidate_pair bodies = a.contacts.bodies[c];
        const int32_t m = bodies.j >= a.num_particles ? a.moving[bodies.j - a.num_particles] : -1;
        if (m < 0) continue;
        const scree_wall_axis axis = a.axes[m];
        scree_vec3 along = scree_vec3_add(a.contacts.normal_force[c], a.contacts.tangential_force[c]);
        if (axis.is_rotating)
        {
            const scree_vec3 point = scree_vec3_add(a.pose[bodies.i].position, a.contacts.arm[c]);
            const scree_vec3 arm = scree_vec3_sub(point, axis.centre);
            along = scree_vec3_cross(arm, along);
            if (!a.contacts.acts_in_points) along = scree_vec3_add(along, a.contacts.moment[c]);
        }
        sums[m] += scree_vec3_dot(along, axis.direction);
    }
}

#endif
