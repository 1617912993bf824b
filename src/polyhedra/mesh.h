/// \file mesh.h
/// Closed triangle mesh: storage, edges, and the checks that decide whether it can be a body.
#ifndef SCREE_MESH_H
#define SCREE_MESH_H

#include "core/vec.h"
#include "scree/base.h"

/// Three vertex indices, counter-clockwise seen from outside.
typedef struct scree_triangle
{
    int32_t v[3];
} scree_triangle;

/// Owns its arrays. Start from {0}. Coordinates in metres (or in the units of a shape that is scaled later).
typedef struct scree_mesh
{
    scree_vec3 *vertices;      ///< (num_vertices)
    scree_triangle *triangles; ///< (num_triangles)
    int32_t num_vertices;
    int32_t num_triangles;
} scree_mesh;

/// SCREE_OUT_OF_MEMORY leaves the mesh empty.
scree_status scree_mesh_create(scree_mesh *mesh, int32_t num_vertices, int32_t num_triangles);
scree_status scree_mesh_copy(scree_mesh *copy, const scree_mesh *mesh);
void scree_mesh_destroy(scree_mesh *mesh);

/// Closed, manifold, consistently oriented outwards, no sliver or repeated face, no self-intersection, finite.
/// Every fault goes to the report with its place (triangle, vertex, coordinates). SCREE_OK or SCREE_BAD_MESH.
scree_status scree_mesh_validate(const scree_mesh *mesh, const char *name, scree_report *report);

/// Repairs what is safe, saying what was done as warnings: welds vertices closer than `tolerance` times the size of
/// the box, drops degenerate and repeated faces and unused vertices, turns an inverted mesh inside out.
scree_status scree_mesh_mend(scree_mesh *mesh, double tolerance, const char *name, scree_report *report);

/// Triangle on the other side of each edge (v[k], v[k+1]): neighbours is (num_triangles, 3). The mesh must be valid.
scree_status scree_mesh_neighbours(const scree_mesh *mesh, int32_t *neighbours);

/// True if no edge is concave: decided exactly by the sign of the orientation of the four vertices of each edge,
/// and by the Euler characteristic (one piece, no handle).
bool scree_mesh_is_convex(const scree_mesh *mesh);

scree_box scree_mesh_box(const scree_mesh *mesh);

#endif
