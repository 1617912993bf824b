/// \file contact_kinematics.h
/// What the force law of one contact reads and gives, the same for all laws.
#ifndef SCREE_CONTACT_KINEMATICS_H
#define SCREE_CONTACT_KINEMATICS_H

#include "forces/force_model.h"

/// What the law of a contact reads. Vectors in world axes.
typedef struct scree_contact_kinematics
{
    scree_real volume;               ///< [m^3] > 0
    scree_real indentation;          ///< [m] > 0
    scree_real radius;               ///< [m] of the contact across the normal
    scree_real radius_before;        ///< [m] of the step before, 0 for a new contact
    scree_vec3 normal;               ///< [1] unit, from j towards i
    scree_real area;                 ///< [m^2] length of the area vector; set if the law asks for it
    scree_vec3 lever;                ///< [m] of the normal force; set if the law has one, 0 otherwise
    scree_vec3 relative_velocity;    ///< [m/s] of i against j at the contact point
    scree_vec3 relative_rotation;    ///< [rad/s] angular velocity of i minus that of j
    scree_real effective_mass;       ///< [kg]
    scree_real effective_radius;     ///< [m] R* of the spheres of equal volume; set if the law asks for it
    scree_real rolling_inertia;      ///< [kg m^2] of both about the contact point; set if the law asks for it
    scree_real time_step;            ///< [s]
    scree_vec3 spring_force;         ///< [N] of the step before, 0 for a new contact
    scree_real torsion;              ///< [N m] of the step before, 0 for a new contact
    scree_vec3 rolling_moment;       ///< [N m] of the step before, 0 for a new contact
    scree_real tangential_stiffness; ///< [N/m] of the step before, 0 for a new contact
} scree_contact_kinematics;

/// What it gives. Forces act on i.
typedef struct scree_contact_force
{
    scree_vec3 normal_force;         ///< [N]
    scree_vec3 tangential_force;     ///< [N]
    scree_vec3 spring_force;         ///< [N] elastic part of the tangential force
    scree_vec3 moment;               ///< [N m] torsion, rocking and rolling resistance
    scree_real torsion;              ///< [N m] elastic part of the moment about the normal
    scree_vec3 rolling_moment;       ///< [N m] elastic part of the rolling resistance
    scree_real elastic_force;        ///< [N] elastic part of the normal force
    scree_real elastic_energy;       ///< [J] of the normal force
    scree_real spring_energy;        ///< [J] of the tangential, the torsion and the rolling spring
    scree_real normal_stiffness;     ///< [N/m] k_n
    scree_real tangential_stiffness; ///< [N/m] k_t
    bool is_slipping;
    bool is_turning; ///< a moment is at its limit
} scree_contact_force;

/// The normal part of the wrench on i is F n and -F lever: the gradient of the overlap volume has a moment M/|S| about
/// the contact point that goes with the normal S/|S|. Only the law that is made from that gradient takes it along.
SCREE_FN scree_vec3 scree_normal_lever(scree_vec3 area_vector, scree_vec3 torque_vector)
{
    const scree_real area = scree_vec3_length(area_vector);
    return area > 0 ? scree_vec3_scale(torque_vector, 1 / area) : scree_vec3_zero();
}

/// By how much a spring shrinks while its contact is unloaded; 1 while it is loaded.
SCREE_FN scree_real scree_unloading_ratio(const scree_contact_kinematics *k, const scree_contact_force *f)
{
    const scree_real ratio = f->tangential_stiffness / k->tangential_stiffness;
    return f->tangential_stiffness < k->tangential_stiffness ? ratio : 1;
}

/// The vector, or one of length `limit` in its direction if it is longer.
SCREE_FN scree_vec3 scree_cut_to_length(scree_vec3 v, scree_real limit)
{
    const scree_real squared = scree_vec3_dot(v, v);
    return scree_vec3_select(squared > limit * limit, scree_vec3_scale(v, limit / scree_sqrt(squared)), v);
}

/// History turned into the present tangent plane, keeping its length.
SCREE_FN scree_vec3 scree_rotate_into_plane(scree_vec3 force, scree_vec3 normal)
{
    const scree_real squared = scree_vec3_dot(force, force);
    const scree_vec3 in_plane = scree_vec3_add_scaled(force, normal, -scree_vec3_dot(force, normal));
    const scree_real squared_in_plane = scree_vec3_dot(in_plane, in_plane);
    const scree_vec3 turned = scree_vec3_scale(in_plane, scree_sqrt(squared / squared_in_plane));
    return scree_vec3_select(squared_in_plane > 0, turned, scree_vec3_zero());
}

#endif
