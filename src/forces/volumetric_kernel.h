/// \file volumetric_kernel.h
/// Volumetric Hertz-Mindlin law of one contact.
///
///     F_n  = c E* sqrt(V d) + 2 g sqrt(m* k_n) v_n         Nassauer & Kuna (2013); Bilock (2020), eqs. 4.16-4.18
///     k_n  = 2 E* sqrt(V/(pi d)),  k_t = 8 G* sqrt(V/(pi d))
///     F_t += -k_t dx_t, scaled by k_t/k_t_old while unloading; F_t - 2 g sqrt(m* k_t) v_t is capped at mu F_n
///
/// With c = 4/(3 sqrt(pi)) it is Hertz for spheres, where V -> pi R* d^2. V d and V/d are continuous while a contact
/// forms and ends; the law is not the gradient of an energy.
#ifndef SCREE_VOLUMETRIC_KERNEL_H
#define SCREE_VOLUMETRIC_KERNEL_H

#include "forces/force_model.h"

/// What the law of a contact reads. Vectors in world axes.
typedef struct scree_contact_kinematics
{
    scree_real volume;               ///< [m^3] > 0
    scree_real indentation;          ///< [m] > 0
    scree_vec3 normal;               ///< [1] unit, from j towards i
    scree_vec3 relative_velocity;    ///< [m/s] of i against j at the contact point
    scree_real effective_mass;       ///< [kg]
    scree_real time_step;            ///< [s]
    scree_vec3 spring_force;         ///< [N] of the step before, 0 for a new contact
    scree_real tangential_stiffness; ///< [N/m] of the step before, 0 for a new contact
} scree_contact_kinematics;

/// What it gives. Forces act on i.
typedef struct scree_contact_force
{
    scree_vec3 normal_force;         ///< [N]
    scree_vec3 tangential_force;     ///< [N]
    scree_vec3 spring_force;         ///< [N] elastic part of the tangential force
    scree_real elastic_force;        ///< [N] elastic part of the normal force
    scree_real normal_stiffness;     ///< [N/m] k_n
    scree_real tangential_stiffness; ///< [N/m] k_t
    bool is_slipping;
} scree_contact_force;

/// History turned into the present tangent plane, keeping its length.
SCREE_FN scree_vec3 scree_rotate_into_plane(scree_vec3 force, scree_vec3 normal)
{
    const scree_real squared = scree_vec3_dot(force, force);
    const scree_vec3 in_plane = scree_vec3_add_scaled(force, normal, -scree_vec3_dot(force, normal));
    const scree_real squared_in_plane = scree_vec3_dot(in_plane, in_plane);
    if (!(squared_in_plane > 0)) return scree_vec3_zero();
    return scree_vec3_scale(in_plane, scree_sqrt(squared / squared_in_plane));
}

/// The tangential part: spring, damping, Coulomb limit. Fills the tangential fields of *f.
SCREE_FN void scree_tangential_force(const scree_force_law *law, const scree_contact_kinematics *k,
                                     scree_real normal_force, scree_contact_force *f)
{
    const scree_vec3 v = k->relative_velocity;
    const scree_vec3 v_t = scree_vec3_add_scaled(v, k->normal, -scree_vec3_dot(v, k->normal));
    const scree_real k_t = f->tangential_stiffness;
    scree_vec3 spring = scree_vec3_zero();
    if (law->has_tangential_spring)
    {
        spring = scree_rotate_into_plane(k->spring_force, k->normal);
        if (k_t < k->tangential_stiffness) spring = scree_vec3_scale(spring, k_t / k->tangential_stiffness);
        spring = scree_vec3_add_scaled(spring, v_t, -k_t * k->time_step);
    }
    const scree_real damping = 2 * law->damping_ratio * scree_sqrt(k->effective_mass * k_t);
    scree_vec3 force = scree_vec3_add_scaled(spring, v_t, -damping);

    const scree_real limit = law->friction_coefficient * normal_force;
    const scree_real squared = scree_vec3_dot(force, force);
    f->is_slipping = squared > limit * limit;
    if (f->is_slipping)
    {
        force = scree_vec3_scale(force, limit / scree_sqrt(squared));
        if (law->has_tangential_spring) spring = force;
    }
    f->tangential_force = force;
    f->spring_force = spring;
}

SCREE_FN void scree_volumetric_force(const scree_force_law *law, const scree_contact_kinematics *k,
                                     scree_contact_force *f)
{
    const scree_real inverse_pi = (scree_real)0.31830988618379067154;
    const scree_real contact_radius = scree_sqrt(inverse_pi * (k->volume / k->indentation));
    f->normal_stiffness = 2 * law->effective_modulus * contact_radius;
    f->tangential_stiffness = 8 * law->effective_shear_modulus * contact_radius;
    f->elastic_force = law->stiffness_factor * law->effective_modulus * scree_sqrt(k->volume * k->indentation);

    const scree_real approach = -scree_vec3_dot(k->relative_velocity, k->normal);
    const scree_real damping = 2 * law->damping_ratio * scree_sqrt(k->effective_mass * f->normal_stiffness);
    scree_real normal_force = f->elastic_force + damping * approach;
    if (normal_force < 0 && !law->has_attraction) normal_force = 0;
    f->normal_force = scree_vec3_scale(k->normal, normal_force);
    scree_tangential_force(law, k, scree_max(normal_force, 0), f);
}

#endif
