/// \file contact_law_kernel.h
/// Force law of one contact: the elastic normal force of the model, then what all models share.
///
///     F_n = F + 2 g sqrt(m* k_n) v_n, never attractive unless the law allows it      v_n: speed of approach
///     k_t = r k_n, r = 4 G*/E* (k_n = 2 E* a and k_t = 8 G* a on a contact of radius a) or as given
///
/// then friction, and where the law has them the moments of the contact area and rolling resistance.
#ifndef SCREE_CONTACT_LAW_KERNEL_H
#define SCREE_CONTACT_LAW_KERNEL_H

#include "forces/contact_moment_kernel.h"
#include "forces/energy_conserving_kernel.h"
#include "forces/friction_kernel.h"
#include "forces/hertz_mindlin_kernel.h"
#include "forces/linear_spring_kernel.h"
#include "forces/rolling_kernel.h"

/// All but what follows from the Coulomb limit. Returns the normal force.
SCREE_FN scree_real scree_contact_law_without_limit(const scree_force_law *law, const scree_contact_kinematics *k,
                                                    scree_contact_force *f)
{
    if (law->model == SCREE_MODEL_LINEAR_SPRING) scree_linear_spring(law, k, f);
    else if (law->model == SCREE_MODEL_ENERGY_CONSERVING) scree_energy_conserving(law, k, f);
    else scree_hertz_mindlin(law, k, f);

    // of approach, and dV/dt over |S| where the normal force has a lever
    scree_real approach = -scree_vec3_dot(k->normal, k->relative_velocity);
    if (law->model == SCREE_MODEL_ENERGY_CONSERVING) approach += scree_vec3_dot(k->lever, k->relative_rotation);
    const scree_real damping = 2 * law->damping_ratio * scree_sqrt(k->effective_mass * f->normal_stiffness);
    const scree_real total = f->elastic_force + damping * approach;
    const scree_real normal_force = total < 0 && !law->has_attraction ? 0 : total;
    f->normal_force = scree_vec3_scale(k->normal, normal_force);
    scree_friction_without_limit(law, k, f);
    return normal_force;
}

/// mu F_n; nothing while the contact pulls.
SCREE_FN scree_real scree_coulomb_limit(const scree_force_law *law, scree_real normal_force)
{
    return law->friction_coefficient * scree_max(normal_force, 0);
}

SCREE_FN void scree_contact_law(const scree_force_law *law, const scree_contact_kinematics *k, scree_contact_force *f)
{
    const scree_real normal_force = scree_contact_law_without_limit(law, k, f);
    scree_friction_limit(scree_coulomb_limit(law, normal_force), f);
    f->spring_energy = scree_spring_energy(f->spring_force, f->tangential_stiffness);

    const scree_real pressing = scree_max(normal_force, 0);
    f->moment = scree_vec3_scale(k->lever, -normal_force);
    f->torsion = 0;
    f->rolling_moment = scree_vec3_zero();
    f->is_turning = false;
    if (law->has_moments && k->radius > 0) scree_contact_moment(law, k, pressing, f);
    if (law->rolling != SCREE_ROLLING_NONE) scree_rolling_resistance(law, k, pressing, f);
}

#endif
