/// \file clump_fill.h
/// Spheres that fill a mesh from inside.
#ifndef SCREE_CLUMP_FILL_H
#define SCREE_CLUMP_FILL_H

#include "polyhedra/clump.h"

/// Up to `num` spheres inside the mesh that hang together, in its own frame: the largest one, then one after the other
/// what sticks out most of those before. *num_made may be smaller where the mesh is too thin for more.
/// Preconditions: a valid mesh, 1 <= num <= SCREE_CLUMP_MAX_SPHERES. SCREE_OUT_OF_MEMORY.
scree_status scree_clump_fill(const scree_mesh *mesh, int32_t num, scree_clump_sphere *spheres, int32_t *num_made);

#endif
