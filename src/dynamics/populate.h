/// \file populate.h
/// Particle groups of a scene to particles: sizes drawn, places on a jittered lattice, orientations at random.
#ifndef SCREE_POPULATE_H
#define SCREE_POPULATE_H

#include "dynamics/state.h"

/// Makes simulation->particles from the scene; shapes must be there. Faults: a region that is too small.
scree_status scree_populate(scree_simulation *simulation, scree_report *report);

#endif
