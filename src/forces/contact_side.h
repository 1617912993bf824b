/// \file contact_side.h
/// What a contact exerts on one of its two bodies. The forces on the two are exact opposites.
#ifndef SCREE_CONTACT_SIDE_H
#define SCREE_CONTACT_SIDE_H

#include "core/vec.h"

typedef struct scree_contact_side
{
    scree_vec3 force;  ///< [N]
    scree_vec3 torque; ///< [N m] about the body's position, world axes
} scree_contact_side;

/// Where the contact is for one of its bodies.
typedef struct scree_contact_place
{
    scree_vec3 own_arm; ///< [m] contact point minus position of the first body
    scree_vec3 first;   ///< [m] position of the first body
    scree_vec3 body;    ///< [m] position of the body asked for
    bool is_second;     ///< is that the other one?
} scree_contact_place;

/// The side of a body but for the moment; `on_first` is the force on the first body. Which of the two it is cannot be
/// foreseen: no branch.
SCREE_FN scree_contact_side scree_contact_side_make(scree_contact_place place, scree_vec3 on_first)
{
    const scree_vec3 point = scree_vec3_add(place.first, place.own_arm);
    const scree_vec3 arm = scree_vec3_select(place.is_second, scree_vec3_sub(point, place.body), place.own_arm);
    scree_contact_side side;
    side.force = scree_vec3_select(place.is_second, scree_vec3_negate(on_first), on_first);
    side.torque = scree_vec3_cross(arm, side.force);
    return side;
}

/// Adds the moment [N m] that the contact exerts on the first body.
SCREE_FN void scree_contact_side_turn(scree_contact_side *side, bool is_second, scree_vec3 moment)
{
    side->torque = scree_vec3_add(side->torque, scree_vec3_select(is_second, scree_vec3_negate(moment), moment));
}

#endif
