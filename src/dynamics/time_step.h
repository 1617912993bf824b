/// \file time_step.h
/// The automatic time step.
#ifndef SCREE_TIME_STEP_H
#define SCREE_TIME_STEP_H

#include "dynamics/state.h"

/// Smallest sqrt(m_eff/k) [s] to expect: over all particles and all materials they can meet, with the largest stiffness
/// of their law on a flat contact of half the bounding radius, for spheres twice one at an indentation of R/50 (a =
/// 0.28 R), and the rotation of the particle taken into account by m_eff = m/3.5, the value of a sphere hit
/// tangentially by a wall. A run counts the true one; see scree_counters.
double scree_time_step_critical(const scree_simulation *simulation);

/// Energy [J] that a contact of particle i takes up, about, before it is as deep as the particle's radius, by the
/// softest law of its material; INFINITY without any.
double scree_impact_capacity(const scree_simulation *simulation, int64_t i);

#endif
