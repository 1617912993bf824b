/// \file wall_load_kernel.h
/// What moving walls exert on the particles along their motion: the torque about the axis of one that rotates, the
/// force along the velocity of one that translates. Particles are summed in blocks of following ids, so the sum does
/// not depend on the number of threads, nor on which candidate pairs there are, nor on the order of the contacts.
#ifndef SCREE_WALL_LOAD_KERNEL_H
#define SCREE_WALL_LOAD_KERNEL_H

#include "contact/contact_list.h"

/// Particles summed by one index; most of them do not touch the wall.
#define SCREE_WALL_LOAD_BLOCK 64

/// The motion that a load is measured along.
typedef struct scree_wall_axis
{
    scree_vec3 direction; ///< [1] unit, of the axis or of the velocity
    scree_vec3 centre;    ///< [m] point of the axis
    int32_t body;         ///< number of the wall among all bodies
    bool is_rotating;
} scree_wall_axis;

typedef struct scree_wall_load_args
{
    scree_contact_list contacts;
    const scree_candidate_pair *pairs; ///< (num_pairs)
    const int32_t *row_begin;          ///< (num_bodies + 1) rows of candidate pairs
    const int32_t *row_pairs;          ///< (num_pairs) that of a wall ascends in the ids of the first bodies
    const int32_t *ids;                ///< (num_bodies) of the bodies, or NULL: each is its own
    const scree_pose *pose;            ///< (num_bodies)
    const scree_wall_axis *axes;       ///< (num_moving)
    int64_t num_moving;
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

/// Id of the first body of entry k of the rows.
SCREE_FN int32_t scree_wall_load_id(const scree_wall_load_args *a, int64_t k)
{
    const int32_t first = a->pairs[a->row_pairs[k]].i;
    return a->ids ? a->ids[first] : first;
}

/// Moving wall k % num_moving of block k / num_moving of SCREE_WALL_LOAD_BLOCK particles.
SCREE_FN void scree_wall_load_at(scree_wall_load_args a, int64_t k)
{
    const scree_wall_axis axis = a.axes[k % a.num_moving];
    const int64_t begin = k / a.num_moving * SCREE_WALL_LOAD_BLOCK, end = a.row_begin[axis.body + 1];
    int64_t low = a.row_begin[axis.body], high = end;
    while (low < high)
    {
        const int64_t middle = low + (high - low) / 2;
        if (scree_wall_load_id(&a, middle) < begin) low = middle + 1;
        else high = middle;
    }
    scree_real sum = 0;
    for (; low < end && scree_wall_load_id(&a, low) < begin + SCREE_WALL_LOAD_BLOCK; ++low)
    {
        const int32_t p = a.row_pairs[low];
        for (int32_t c = a.contacts.first_of_pair[p]; c < a.contacts.first_of_pair[p + 1]; ++c)
            sum += scree_wall_load_of_contact(&a, c, axis);
    }
    a.sums[k] = sum;
}

#endif
