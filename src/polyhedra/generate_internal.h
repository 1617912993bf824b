/// \file generate_internal.h
/// What the generators and the simplification share.
#ifndef SCREE_GENERATE_INTERNAL_H
#define SCREE_GENERATE_INTERNAL_H

#include "polyhedra/mesh.h"

/// Cube root of x > 0 to a few last digits, by + - * / alone: cbrt() differs between libraries.
double scree_cube_root(double x);

/// Near-uniform triangulation of the unit sphere, vertices on it; an odd num_triangles counts as the next even number.
scree_status scree_generate_unit_sphere(scree_mesh *mesh, int32_t num_triangles);

#endif
