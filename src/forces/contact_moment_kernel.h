/// \file contact_moment_kernel.h
/// Moments of a contact that has an extent: springs and dashpots are spread evenly over a disc of the contact's radius
/// a across the normal,
///
///     M_n += -k_t a^2/2 w_n dt;  M_n - 2 g sqrt(m* k_t) a^2/2 w_n is capped at 2/3 a mu F_n     Marshall (2009);
///     M_n itself too, and it falls with k_t a^2/2, as the tangential spring does with k_t
///     rocking M_t  = -2 g sqrt(m* k_n) a^2/4 w_t, capped at a/4 F_n (beyond it part of the disc would pull)
///
/// Contacts of true spheres have none: a = 0. Without them a body that lies flat on one contact spins on for ever: at
/// the contact point it does not slide.
#ifndef SCREE_CONTACT_MOMENT_KERNEL_H
#define SCREE_CONTACT_MOMENT_KERNEL_H

#include "forces/contact_kinematics.h"

/// Torsion and rocking of the contact area. Adds to the moment and the spring energy of *f.
SCREE_FN void scree_contact_moment(const scree_force_law *law, const scree_contact_kinematics *k,
                                   scree_real normal_force, scree_contact_force *f)
{
    const scree_real a = k->radius, half_square = a * a / 2;
    const scree_real twist = scree_vec3_dot(k->relative_rotation, k->normal);
    const scree_vec3 rocking = scree_vec3_add_scaled(k->relative_rotation, k->normal, -twist);

    const scree_real twist_damping =
        2 * law->tangential_damping_ratio * scree_sqrt(k->effective_mass * f->tangential_stiffness);
    const scree_real stiffness = f->tangential_stiffness * half_square;
    scree_real torsion = 0;
    if (law->has_tangential_spring)
    {
        const scree_real before = k->tangential_stiffness * (k->radius_before * k->radius_before / 2);
        torsion =
            (stiffness < before ? k->torsion * (stiffness / before) : k->torsion) - stiffness * twist * k->time_step;
    }
    const scree_real limit = (scree_real)(2.0 / 3.0) * a * law->friction_coefficient * normal_force;
    scree_real moment = torsion - twist_damping * half_square * twist;
    f->is_turning = scree_abs(moment) > limit;
    moment = scree_max(-limit, scree_min(limit, moment));
    torsion = scree_max(-limit, scree_min(limit, torsion));
    f->torsion = torsion;
    if (stiffness > 0) f->spring_energy += torsion * torsion / (2 * stiffness);

    // rocking: dashpots alone, the elastic part is in the way the contact point moves
    const scree_real rocking_damping =
        2 * law->damping_ratio * scree_sqrt(k->effective_mass * f->normal_stiffness) * half_square / 2;
    const scree_real rocking_limit = a / 4 * normal_force;
    const scree_real rate = scree_vec3_length(rocking);
    const scree_real wanted = rocking_damping * rate;
    const scree_real factor = wanted > rocking_limit ? rocking_limit / rate : rocking_damping;
    f->moment = scree_vec3_add_scaled(scree_vec3_add_scaled(f->moment, k->normal, moment), rocking, -factor);
}

#endif
