/// \file volumetric_kernel.h
/// Volumetric Hertz-Mindlin law of one contact.
///
///     F_n  = c E* sqrt(V d) + 2 g sqrt(m* k_n) v_n         Nassauer & Kuna (2013); Bilock (2020), eqs. 4.16-4.18
///     k_n  = 2 E* sqrt(V/(pi d)),  k_t = 8 G* sqrt(V/(pi d))
///     F_t += -k_t dx_t, scaled by k_t/k_t_old while unloading; F_t - 2 g sqrt(m* k_t) v_t is capped at mu F_n
///
/// Moments: springs and dashpots are spread evenly over a disc of the contact's extent a across the normal,
///
///     M_n += -k_t a^2/2 w_n dt;  M_n - 2 g sqrt(m* k_t) a^2/2 w_n is capped at 2/3 a mu F_n     Marshall (2009),
///     twisting M_t  = -2 g sqrt(m* k_n) a^2/4 w_t, capped at a/4 F_n (beyond it part of the disc would pull)
///
/// Contacts of true spheres have none: a = 0. Without them a body that lies flat on one contact spins on for ever: at
/// the contact point it does not slide.
///
/// With c = 4/(3 sqrt(pi)) the normal force is Hertz's for spheres, where V -> pi R* d^2. V d and V/d are continuous
/// while a contact forms and ends; the law is not the gradient of an energy.
#ifndef SCREE_VOLUMETRIC_KERNEL_H
#define SCREE_VOLUMETRIC_KERNEL_H

#include "forces/force_model.h"

/// What the law of a contact reads. Vectors in world axes.
typedef struct scree_contact_kinematics
{
    scree_real volume;               ///< [m^3] > 0
    scree_real indentation;          ///< [m] > 0
    scree_real radius;               ///< [m] of the contact across the normal
    scree_vec3 normal;               ///< [1] unit, from j towards i
    scree_vec3 relative_velocity;    ///< [m/s] of i against j at the contact point
    scree_vec3 relative_rotation;    ///< [rad/s] angular velocity of i minus that of j
    scree_real effective_mass;       ///< [kg]
    scree_real time_step;            ///< [s]
    scree_vec3 spring_force;         ///< [N] of the step before, 0 for a new contact
    scree_real torsion;              ///< [N m] of the step before, 0 for a new contact
    scree_real tangential_stiffness; ///< [N/m] of the step before, 0 for a new contact
} scree_contact_kinematics;

/// What it gives. Forces act on i.
typedef struct scree_contact_force
{
    scree_vec3 normal_force;         ///< [N]
    scree_vec3 tangential_force;     ///< [N]
    scree_vec3 spring_force;         ///< [N] elastic part of the tangential force
    scree_vec3 moment;               ///< [N m] torsion and rocking
    scree_real torsion;              ///< [N m] elastic part of the moment about the normal
    scree_real elastic_force;        ///< [N] elastic part of the normal force
    scree_real elastic_energy;       ///< [J] 2/5 F d, exact for Hertz
    scree_real spring_energy;        ///< [J] of the tangential and the torsion spring
    scree_real normal_stiffness;     ///< [N/m] k_n
    scree_real tangential_stiffness; ///< [N/m] k_t
    bool is_slipping;
    bool is_twisting; ///< the torsion is at its limit
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
    f->spring_energy = k_t > 0 ? scree_vec3_dot(spring, spring) / (2 * k_t) : 0;
}

/// Torsion and rocking of the contact area. Fills the moments of *f.
SCREE_FN void scree_contact_moment(const scree_force_law *law, const scree_contact_kinematics *k,
                                   scree_real normal_force, scree_contact_force *f)
{
    const scree_real a = k->radius, half_square = a * a / 2;
    const scree_real twist = scree_vec3_dot(k->relative_rotation, k->normal);
    const scree_vec3 rocking = scree_vec3_add_scaled(k->relative_rotation, k->normal, -twist);

    const scree_real twist_damping = 2 * law->damping_ratio * scree_sqrt(k->effective_mass * f->tangential_stiffness);
    const scree_real stiffness = f->tangential_stiffness * half_square;
    scree_real torsion = 0;
    if (law->has_tangential_spring)
    {
        torsion = k->torsion;
        const scree_real ratio =
            f->tangential_stiffness < k->tangential_stiffness ? f->tangential_stiffness / k->tangential_stiffness : 1;
        torsion = torsion * ratio - stiffness * twist * k->time_step;
    }
    scree_real moment = torsion - twist_damping * half_square * twist;
    const scree_real limit = (scree_real)(2.0 / 3.0) * a * law->friction_coefficient * normal_force;
    f->is_twisting = scree_abs(moment) > limit;
    if (f->is_twisting)
    {
        moment = moment > 0 ? limit : -limit;
        if (law->has_tangential_spring) torsion = moment;
    }
    f->torsion = torsion;
    if (stiffness > 0) f->spring_energy += torsion * torsion / (2 * stiffness);

    // rocking: dashpots alone, the elastic part is in the way the contact point moves
    const scree_real rocking_damping =
        2 * law->damping_ratio * scree_sqrt(k->effective_mass * f->normal_stiffness) * half_square / 2;
    const scree_real rocking_limit = a / 4 * normal_force;
    const scree_real rate = scree_vec3_length(rocking);
    const scree_real wanted = rocking_damping * rate;
    const scree_real factor = wanted > rocking_limit ? rocking_limit / rate : rocking_damping;
    f->moment = scree_vec3_add_scaled(scree_vec3_scale(k->normal, moment), rocking, -factor);
}

SCREE_FN void scree_volumetric_force(const scree_force_law *law, const scree_contact_kinematics *k,
                                     scree_contact_force *f)
{
    const scree_real inverse_pi = (scree_real)0.31830988618379067154;
    const scree_real contact_radius = scree_sqrt(inverse_pi * (k->volume / k->indentation));
    f->normal_stiffness = 2 * law->effective_modulus * contact_radius;
    f->tangential_stiffness = 8 * law->effective_shear_modulus * contact_radius;
    f->elastic_force = law->stiffness_factor * law->effective_modulus * scree_sqrt(k->volume * k->indentation);

    f->elastic_energy = (scree_real)0.4 * f->elastic_force * k->indentation;
    const scree_real approach = -scree_vec3_dot(k->relative_velocity, k->normal);
    const scree_real damping = 2 * law->damping_ratio * scree_sqrt(k->effective_mass * f->normal_stiffness);
    scree_real normal_force = f->elastic_force + damping * approach;
    if (normal_force < 0 && !law->has_attraction) normal_force = 0;
    f->normal_force = scree_vec3_scale(k->normal, normal_force);
    const scree_real pressing = scree_max(normal_force, 0);
    scree_tangential_force(law, k, pressing, f);
    f->moment = scree_vec3_zero();
    f->torsion = 0;
    f->is_twisting = false;
    if (law->has_moments && k->radius > 0) scree_contact_moment(law, k, pressing, f);
}

#endif
