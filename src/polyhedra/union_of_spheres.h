/// \file union_of_spheres.h
/// Volume, area, centroid and inertia of the union of overlapping spheres.
#ifndef SCREE_UNION_OF_SPHERES_H
#define SCREE_UNION_OF_SPHERES_H

#include "polyhedra/mass_properties.h"
#include "polyhedra/shape.h"

/// Each part of space counts once, however many spheres cover it. *error: estimate of the largest relative error of
/// volume and moments; 1e-9 at most unless more than some dozen spheres overlap each other. The area is good to 1e-5.
/// Precondition: num > 0, all radii > 0. SCREE_OUT_OF_MEMORY.
scree_status scree_union_of_spheres_properties(const scree_sphere *spheres, int32_t num,
                                               scree_mass_properties *properties, double *error);

#endif
