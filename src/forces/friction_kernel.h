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

/// Fills the tangential fields of *f.
SCREE_FN void scree_friction(const scree_force_law *law, const scree_contact_kinematics *k, scree_real normal_force,
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
    const scree_vec3 force = scree_vec3_add_scaled(spring, v_t, -damping);

    const scree_real limit = law->friction_coefficient * normal_force;
    f->is_slipping = scree_vec3_dot(force, force) > limit * limit;
    f->tangential_force = scree_cut_to_length(force, limit);
    spring = scree_cut_to_length(spring, limit);
    f->spring_force = spring;
    const scree_real energy = scree_vec3_dot(spring, spring) / (2 * k_t);
    f->spring_energy = k_t > 0 ? energy : 0;
}

#endif
