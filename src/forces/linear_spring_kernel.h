/// \file linear_spring_kernel.h
/// Elastic normal force of a linear spring, F = k_n d (Cundall & Strack 1979). With the dashpot 2 g sqrt(m* k_n) v_n a
/// contact lasts pi sqrt(m*/k_n)/sqrt(1 - g^2) if it may attract, whatever the speed.
#ifndef SCREE_LINEAR_SPRING_KERNEL_H
#define SCREE_LINEAR_SPRING_KERNEL_H

#include "forces/contact_kinematics.h"

SCREE_FN void scree_linear_spring(const scree_force_law *law, const scree_contact_kinematics *k, scree_contact_force *f)
{
    f->normal_stiffness = law->normal_stiffness;
    f->tangential_stiffness = law->tangential_over_normal * f->normal_stiffness;
    f->elastic_force = law->normal_stiffness * k->indentation;
    f->elastic_energy = (scree_real)0.5 * f->elastic_force * k->indentation;
}

#endif
