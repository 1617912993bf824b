/// \file friction_kernel.h
/// Tangential force: spring with history, dashpot, Coulomb limit. The same for all models.
///
///     F_s += -k_t dx_t, scaled by k_t/k_t_old while unloading; F_t = F_s - 2 g sqrt(m* k_t) v_t; both |F| <= mu F_n
///
/// Bilock (2020), eqs. 4.8 and 4.9. History is turned into the present tangent plane before it is added to. On slip it
/// is cut to the Coulomb value, not set to F_t: where the dashpot alone exceeds the limit, a spring that takes the
/// dashpot's place would hold energy that nothing has put in. As it is, no step of the law gives energy.
///
/// Which contacts slip or unload cannot be foreseen, so both ways are computed and one is taken: without branches,
/// compilers make vectors of contacts.
#ifndef SCREE_FRICTION_KERNEL_H
#define SCREE_FRICTION_KERNEL_H

#include "forces/contact_kinematics.h"

/// Spring and dashpot, not yet limited, to the tangential fields of *f.
SCREE_FN void scree_friction_without_limit(const scree_force_law *law, const scree_contact_kinematics *k,
                                           scree_contact_force *f)
{
    const scree_vec3 v = k->relative_velocity;
    const scree_vec3 v_t = scree_vec3_add_scaled(v, k->normal, -scree_vec3_dot(v, k->normal));
    const scree_real k_t = f->tangential_stiffness;
    scree_vec3 spring = scree_vec3_zero();
    if (law->has_tangential_spring)
    {
        spring = scree_rotate_into_plane(k->spring_force, k->normal);
        spring = scree_vec3_scale(spring, scree_unloading_ratio(k, f));
        spring = scree_vec3_add_scaled(spring, v_t, -k_t * k->time_step);
    }
    const scree_real damping = 2 * law->tangential_damping_ratio * scree_sqrt(k->effective_mass * k_t);
    f->tangential_force = scree_vec3_add_scaled(spring, v_t, -damping);
    f->spring_force = spring;
}

SCREE_FN bool scree_is_longer(scree_vec3 v, scree_real limit) { return scree_vec3_dot(v, v) > limit * limit; }

/// The Coulomb limit.
SCREE_FN void scree_friction_limit(scree_real limit, scree_contact_force *f)
{
    f->is_slipping = scree_is_longer(f->tangential_force, limit);
    f->tangential_force = scree_cut_to_length(f->tangential_force, limit);
    f->spring_force = scree_cut_to_length(f->spring_force, limit);
}

SCREE_FN scree_real scree_spring_energy(scree_vec3 spring, scree_real stiffness)
{
    const scree_real energy = scree_vec3_dot(spring, spring) / (2 * stiffness);
    return stiffness > 0 ? energy : 0;
}

#endif
