/// \file mass_properties.h
/// Volume, centroid and inertia of a closed mesh, exact for the mesh (Eberly 2002; Mirtich 1996).
#ifndef SCREE_MASS_PROPERTIES_H
#define SCREE_MASS_PROPERTIES_H

#include "polyhedra/mesh.h"

/// At unit density.
typedef struct scree_mass_properties
{
    double volume;            ///< [m^3]
    double area;              ///< [m^2]
    double centroid[3];       ///< [m]
    double inertia[3][3];     ///< [m^5] about the centroid, axes of the mesh
    double principal[3];      ///< [m^5] principal moments, ascending unless the mesh's axes are principal already
    double principal_axes[4]; ///< unit quaternion (w, x, y, z), principal frame to mesh axes; identity if the
                              ///< mesh's axes are principal to rounding, so that a cube keeps its orientation
    double bounding_radius;   ///< [m] largest distance of a vertex from the centroid
} scree_mass_properties;

void scree_mass_properties_compute(const scree_mesh *mesh, scree_mass_properties *properties);
/// Principal moments and axes from the inertia.
void scree_mass_properties_find_principal(scree_mass_properties *properties);

#endif
