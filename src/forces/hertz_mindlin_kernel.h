/// \file hertz_mindlin_kernel.h
/// Elastic normal force of Hertz on the overlap volume.
///
///     F = c E* sqrt(V d)          Nassauer & Kuna (2013); Bilock (2020), eqs. 4.16-4.18
///     k_n = 2 E* sqrt(V/(pi d))
///
/// A sphere contact brings V = pi R* d^2. With c = 4/(3 sqrt(pi)) this is Hertz: F = 4/3 E* sqrt(R*) d^(3/2), k_n its
/// slope 2 E* sqrt(R* d); Bilock (2020), eqs. 4.5-4.7. V d and V/d are continuous while a contact forms and ends. For
/// other shapes the law is not the gradient of an energy.
#ifndef SCREE_HERTZ_MINDLIN_KERNEL_H
#define SCREE_HERTZ_MINDLIN_KERNEL_H

#include "forces/contact_kinematics.h"

SCREE_FN void scree_hertz_mindlin(const scree_force_law *law, const scree_contact_kinematics *k, scree_contact_force *f)
{
    const scree_real inverse_pi = (scree_real)0.31830988618379067154;
    const scree_real contact_radius = scree_sqrt(inverse_pi * (k->volume / k->indentation));
    f->normal_stiffness = 2 * law->effective_modulus * contact_radius;
    f->tangential_stiffness = law->tangential_over_normal * f->normal_stiffness;
    f->elastic_force = law->stiffness_factor * law->effective_modulus * scree_sqrt(k->volume * k->indentation);
    // the integral of F over d between spheres
    f->elastic_energy = (scree_real)0.4 * f->elastic_force * k->indentation;
}

#endif
