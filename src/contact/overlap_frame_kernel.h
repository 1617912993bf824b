/// \file overlap_frame_kernel.h
/// The working frame of one overlap: the body frame of A, unscaled, its axes permuted so that z is the one nearest to
/// a given direction out of A into B, and shifted to the middle of the overlap of the two boxes. A's vertices are only
/// permuted, negated and shifted; B's are rotated and scaled as well. Bodies whose poses are the identity are taken
/// exactly as stored, up to the one rounded subtraction of the shift.
#ifndef SCREE_OVERLAP_FRAME_KERNEL_H
#define SCREE_OVERLAP_FRAME_KERNEL_H

#include "core/bits.h"

/// working = rows body + offset, for A (0) and B (1).
typedef struct scree_overlap_frame
{
    scree_mat3 rows[2];
    scree_vec3 offset[2];
    scree_vec3 shift; ///< of the working origin, along the working axes, before it is subtracted
    int32_t axis;     ///< body axis of A that became z
    scree_real sign;  ///< of that axis; x changes sign along with z
} scree_overlap_frame;

/// Pose of B in the unscaled body frame of A: a = rotation b + translation, the scale included in the rotation.
typedef struct scree_relative_pose
{
    scree_mat3 rotation;
    scree_vec3 translation;
} scree_relative_pose;

SCREE_FN scree_relative_pose scree_relative_pose_make(const scree_pose *pose_a, const scree_pose *pose_b)
{
    scree_relative_pose pose;
    const scree_quat turn = scree_quat_multiply(scree_quat_conjugate(pose_a->orientation), pose_b->orientation);
    const scree_real ratio = pose_b->scale / pose_a->scale;
    pose.rotation = scree_mat3_from_quat(turn);
    for (int32_t i = 0; i < 3; ++i) pose.rotation.row[i] = scree_vec3_scale(pose.rotation.row[i], ratio);
    const scree_vec3 between = scree_vec3_sub(pose_b->position, pose_a->position);
    const scree_vec3 turned = scree_mat3_apply_transposed(scree_mat3_from_quat(pose_a->orientation), between);
    pose.translation = scree_vec3_scale(turned, 1 / pose_a->scale);
    return pose;
}

/// m v + t
SCREE_FN scree_vec3 scree_affine(const scree_mat3 *m, scree_vec3 v, scree_vec3 t)
{
    return scree_vec3_add(scree_mat3_apply(*m, v), t);
}

/// |m| h: half extents of a box with half extents h, turned by m.
SCREE_FN scree_vec3 scree_turned_extents(const scree_mat3 *m, scree_vec3 h)
{
    return scree_vec3_make(scree_abs(m->row[0].x) * h.x + scree_abs(m->row[0].y) * h.y + scree_abs(m->row[0].z) * h.z,
                           scree_abs(m->row[1].x) * h.x + scree_abs(m->row[1].y) * h.y + scree_abs(m->row[1].z) * h.z,
                           scree_abs(m->row[2].x) * h.x + scree_abs(m->row[2].y) * h.y + scree_abs(m->row[2].z) * h.z);
}

SCREE_FN scree_vec3 scree_box_middle(scree_box box)
{
    return scree_vec3_make(box.lower.x + (box.upper.x - box.lower.x) / 2, box.lower.y + (box.upper.y - box.lower.y) / 2,
                           box.lower.z + (box.upper.z - box.lower.z) / 2);
}
SCREE_FN scree_vec3 scree_box_half(scree_box box)
{
    return scree_vec3_scale(scree_vec3_sub(box.upper, box.lower), (scree_real)0.5);
}

/// Largest coordinate in magnitude.
SCREE_FN scree_real scree_box_reach(scree_box box)
{
    const scree_vec3 l = box.lower;
    const scree_vec3 u = box.upper;
    return scree_max(scree_max(scree_max(scree_abs(l.x), scree_abs(u.x)), scree_max(scree_abs(l.y), scree_abs(u.y))),
                     scree_max(scree_abs(l.z), scree_abs(u.z)));
}

/// Components of v along the working axes, v in body axes of A: a cyclic permutation, then z and x change sign
/// together.
SCREE_FN scree_vec3 scree_frame_turn(const scree_overlap_frame *frame, scree_vec3 v)
{
    const scree_real s = frame->sign;
    if (frame->axis == 0) return scree_vec3_make(s * v.y, v.z, s * v.x);
    if (frame->axis == 1) return scree_vec3_make(s * v.z, v.x, s * v.y);
    return scree_vec3_make(s * v.x, v.y, s * v.z);
}
/// And back.
SCREE_FN scree_vec3 scree_frame_turn_back(const scree_overlap_frame *frame, scree_vec3 v)
{
    const scree_real s = frame->sign;
    if (frame->axis == 0) return scree_vec3_make(s * v.z, s * v.x, v.y);
    if (frame->axis == 1) return scree_vec3_make(v.y, s * v.z, s * v.x);
    return scree_vec3_make(s * v.x, v.y, s * v.z);
}

/// Rows of the working axes, for a matrix whose rows are the body axes of A.
SCREE_FN scree_mat3 scree_frame_turn_rows(const scree_overlap_frame *frame, const scree_mat3 *m)
{
    const int32_t x = frame->axis == 2 ? 0 : frame->axis + 1;
    const int32_t y = frame->axis == 0 ? 2 : frame->axis - 1;
    scree_mat3 turned;
    turned.row[0] = scree_vec3_scale(SCREE_PICK3(m->row, x), frame->sign);
    turned.row[1] = SCREE_PICK3(m->row, y);
    turned.row[2] = scree_vec3_scale(SCREE_PICK3(m->row, frame->axis), frame->sign);
    return turned;
}

/// Frame with z nearest to `direction` and the origin at `origin`, both in the body frame of A.
SCREE_FN scree_overlap_frame scree_overlap_frame_make(const scree_relative_pose *pose, scree_vec3 direction,
                                                      scree_vec3 origin)
{
    scree_overlap_frame frame;
    const scree_real x = scree_abs(direction.x);
    const scree_real y = scree_abs(direction.y);
    const scree_real z = scree_abs(direction.z);
    frame.axis = x > y && x > z ? 0 : y > z ? 1 : 2;
    const scree_real along = frame.axis == 0 ? direction.x : frame.axis == 1 ? direction.y : direction.z;
    frame.sign = along < 0 ? (scree_real)-1 : (scree_real)1;

    scree_mat3 identity;
    identity.row[0] = scree_vec3_make(1, 0, 0);
    identity.row[1] = scree_vec3_make(0, 1, 0);
    identity.row[2] = scree_vec3_make(0, 0, 1);
    frame.shift = scree_frame_turn(&frame, origin);
    frame.rows[0] = scree_frame_turn_rows(&frame, &identity);
    frame.offset[0] = scree_vec3_negate(frame.shift);
    frame.rows[1] = scree_frame_turn_rows(&frame, &pose->rotation);
    frame.offset[1] = scree_vec3_sub(scree_frame_turn(&frame, pose->translation), frame.shift);
    return frame;
}

#endif
