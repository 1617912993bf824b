/// \file simplify.h
/// Fewer triangles through meshoptimizer; stays closed; the volume is restored by scaling about the centroid.
#ifndef SCREE_SIMPLIFY_H
#define SCREE_SIMPLIFY_H

#include "polyhedra/mesh.h"

/// Simplifies `mesh` in place to about num_triangles (>= 4) and scales it to `volume` (0: the volume it had).
/// The result is valid (closed, no self-intersection) or the mesh is left alone and SCREE_BAD_MESH is returned.
scree_status scree_mesh_simplify(scree_mesh *mesh, int32_t num_triangles, double volume, scree_report *report);

#endif
