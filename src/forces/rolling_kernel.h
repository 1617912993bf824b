/// \file rolling_kernel.h
/// Rolling resistance after Ai, Chen, Rotter & Ooi (2011), Powder Technology 206, 269: a moment against the relative
/// rotation w_t across the normal, at most mu_r R* F_n.
///
///     constant (type A):  M = -mu_r R* F_n w_t/|w_t|
///     spring (type C):    M_s += -k_r w_t dt, |M_s| <= mu_r R* F_n, k_r = 2.25 k_n (mu_r R*)^2
///                         M = M_s - 2 g_r sqrt(I_r k_r) w_t below the limit, M = M_s at it
///
/// 1/I_r is the sum over both of 1/(I + m R^2), 7/5 m R^2 for a sphere. For other shapes R is the radius of the sphere
/// of the same volume; a wall has none. Departure: while the contact is unloaded M_s falls with k_r, as the tangential
/// spring does, so that unloading makes no energy.
#ifndef SCREE_ROLLING_KERNEL_H
#define SCREE_ROLLING_KERNEL_H

#include "forces/contact_kinematics.h"

/// Adds to the moment and the spring energy of *f.
SCREE_FN void scree_rolling_resistance(const scree_force_law *law, const scree_contact_kinematics *k,
                                       scree_real normal_force, scree_contact_force *f)
{
    const scree_real twist = scree_vec3_dot(k->relative_rotation, k->normal);
    const scree_vec3 rolling = scree_vec3_add_scaled(k->relative_rotation, k->normal, -twist);
    const scree_real arm = law->rolling_friction_coefficient * k->effective_radius;
    const scree_real limit = arm * normal_force;
    if (law->rolling == SCREE_ROLLING_CONSTANT)
    {
        const scree_real rate = scree_vec3_length(rolling);
        if (rate > 0) f->moment = scree_vec3_add_scaled(f->moment, rolling, -limit / rate);
        f->is_turning = true;
        return;
    }
    const scree_real stiffness = (scree_real)2.25 * f->normal_stiffness * arm * arm;
    scree_vec3 spring = scree_rotate_into_plane(k->rolling_moment, k->normal);
    spring = scree_vec3_scale(spring, scree_unloading_ratio(k, f));
    spring = scree_vec3_add_scaled(spring, rolling, -stiffness * k->time_step);
    const scree_real squared = scree_vec3_dot(spring, spring);
    scree_real damping = 2 * law->rolling_damping_ratio * scree_sqrt(k->rolling_inertia * stiffness);
    if (squared > limit * limit)
    {
        spring = scree_vec3_scale(spring, limit / scree_sqrt(squared));
        damping = 0;
        f->is_turning = true;
    }
    f->rolling_moment = spring;
    f->moment = scree_vec3_add_scaled(scree_vec3_add(f->moment, spring), rolling, -damping);
    if (stiffness > 0) f->spring_energy += scree_vec3_dot(spring, spring) / (2 * stiffness);
}

#endif
