/// \file triangle_intersection.h
/// Exact answers on two triangles of one mesh: do they meet anywhere but in the vertices and the edge that they share?
/// Every touch counts. Built on orient2d and orient3d alone, so right on all input within their limits.
#ifndef SCREE_TRIANGLE_INTERSECTION_H
#define SCREE_TRIANGLE_INTERSECTION_H

#include "polyhedra/mesh.h"

/// True if the three points lie exactly on one line (or coincide).
bool scree_triangle_is_degenerate(scree_vec3 a, scree_vec3 b, scree_vec3 c);

/// True if the segment p, q and the triangle (not degenerate) have a point in common.
bool scree_segment_meets_triangle(scree_vec3 p, scree_vec3 q, const scree_vec3 triangle[3]);

/// True if triangles i and j of the mesh, neither degenerate, meet outside of what they share by index.
bool scree_mesh_triangles_meet(const scree_mesh *mesh, int32_t i, int32_t j);

#endif
