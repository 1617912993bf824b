/// \file energy_conserving_kernel.h
/// Elastic wrench that is the gradient of an energy of the overlap volume (Feng 2021, CMAME 373, 113454, for w(V); the
/// constants here are chosen so that spheres of p = 5/4 are Hertz's):
///
///     w(V) = c E* V (V/R*^3)^(p-1),   p = 1, 5/4, 3/2, 7/4 or 2
///
/// A small motion u + t x x of body i changes V by u.S + t.M, S and M the integrals of n and of x x n over i's surface
/// inside j, x from the contact point. So the force on i is -w'(V) S and the moment -w'(V) M: along the unit normal n =
/// -S/|S| with F = w'|S|, and -F M/|S| about the contact point. The part of M across S says where the line of action
/// lies, x_c = (S x M)/|S|^2; the part along S is a moment that no shift of the line can replace.
///
/// k_n = w'' |S|^2 + w' |S|/d, the slope of F where |S| grows with d: between spheres exactly, on flat contacts |S|
/// does not grow and F goes as d^(p-1). There the slope has no bound at d = 0 for p < 2; what a step cannot resolve is
/// left out, k_n <= m*/dt^2. k_t = r 2 pi R* (2p - 1) w', with k_n as between spheres: it grows with the contact
/// whatever its shape.
#ifndef SCREE_ENERGY_CONSERVING_KERNEL_H
#define SCREE_ENERGY_CONSERVING_KERNEL_H

#include "forces/contact_kinematics.h"

SCREE_FN void scree_energy_conserving(const scree_force_law *law, const scree_contact_kinematics *k,
                                      scree_contact_force *f)
{
    const scree_real radius = k->effective_radius;
    const scree_real root = scree_sqrt(scree_sqrt(k->volume / (radius * radius * radius)));
    scree_real power = 1;
    for (int32_t n = 0; n < law->exponent_quarters; ++n) power = power * root;

    const scree_real pressure = law->stiffness_factor * law->effective_modulus * power; // w/V
    const scree_real exponent = 1 + (scree_real)0.25 * (scree_real)law->exponent_quarters;
    const scree_real slope = exponent * pressure; // w'
    const scree_real two_pi = (scree_real)6.2831853071795864769;
    f->elastic_energy = pressure * k->volume;
    f->elastic_force = slope * k->area;
    const scree_real normal_stiffness = slope * k->area * ((exponent - 1) * k->area / k->volume + 1 / k->indentation);
    f->normal_stiffness = scree_min(normal_stiffness, k->effective_mass / (k->time_step * k->time_step));
    f->tangential_stiffness = law->tangential_over_normal * (two_pi * radius * (2 * exponent - 1) * slope);
}

#endif
