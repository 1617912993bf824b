/// \file mesh_edges.h
/// The edges of a mesh as a sorted list of triangle sides, and other common ground of checks, neighbours and mending.
#ifndef SCREE_MESH_EDGES_H
#define SCREE_MESH_EDGES_H

#include "polyhedra/mesh.h"

/// One side of one triangle. A closed oriented edge consists of two: one forward, one backward.
typedef struct scree_mesh_side
{
    int32_t low, high; ///< its vertices, low < high unless the triangle is degenerate
    int32_t triangle;
    int16_t corner;   ///< the side runs from v[corner] to v[(corner + 1) % 3]
    bool is_backward; ///< it runs from high to low
} scree_mesh_side;

/// All 3 num_triangles sides, sorted by (low, high, triangle, corner); owned by the caller, free() it.
/// NULL: out of memory. Indices must be in range.
scree_mesh_side *scree_mesh_sides_create(const scree_mesh *mesh);

/// Number of sides in the group that starts at `begin`: those with the same two vertices.
int64_t scree_mesh_side_group(const scree_mesh_side *sides, int64_t num_sides, int64_t begin);

/// Enters the two triangles of each properly closed edge into each other's `neighbours` (num_triangles, 3); -1 on every
/// other side. Returns the number of sides without a neighbour.
int64_t scree_mesh_link(const scree_mesh *mesh, const scree_mesh_side *sides, int32_t *neighbours);

/// Labels the pieces that hang together over edges: piece_of is (num_triangles), labels count from 0 in the order of
/// their first triangles; stack is scratch (num_triangles). Returns the number of pieces.
int32_t scree_mesh_label_pieces(const scree_mesh *mesh, const int32_t *neighbours, int32_t *piece_of, int32_t *stack);

/// Six times the signed volume of the tetrahedron of one triangle and the vertex `about`. Summed over a closed piece,
/// with a vertex of that piece, it is the piece's volume, with nothing lost far from the origin.
double scree_mesh_six_volume(const scree_mesh *mesh, int32_t triangle, int32_t about);

/// A vertex by its place.
typedef struct scree_mesh_place
{
    scree_vec3 point;
    int32_t vertex;
} scree_mesh_place;

/// All vertices, sorted by x, y, z and then by index; owned by the caller, free() it. NULL: out of memory.
scree_mesh_place *scree_mesh_places_create(const scree_mesh *mesh);
bool scree_mesh_places_coincide(const scree_mesh_place *a, const scree_mesh_place *b);

/// Length of the diagonal of a box, in double, so that nothing overflows or vanishes.
double scree_box_diagonal(scree_box box);

/// True if all coordinates are finite and within SCREE_EXACT_MAX and all indices are in range.
bool scree_mesh_is_computable(const scree_mesh *mesh);

/// Lets vertices closer than `tolerance` times the size of the box be one, the first of them, and drops unused ones.
/// The mesh must be computable.
scree_status scree_mesh_weld(scree_mesh *mesh, double tolerance, const char *name, scree_report *report);

#endif
