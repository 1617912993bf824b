/// \file generate.h
/// Meshes made by rule. All are closed, oriented outwards and centred on the origin unless stated otherwise.
#ifndef SCREE_GENERATE_H
#define SCREE_GENERATE_H

#include "polyhedra/mesh.h"
#include "scree/types.h"

/// Box of edge lengths `size` [m], 12 triangles.
scree_status scree_generate_box(scree_mesh *mesh, const double size[3]);
/// Regular tetrahedron in a sphere of the given radius, 4 triangles.
scree_status scree_generate_tetrahedron(scree_mesh *mesh, double radius);
/// Schoenhardt polyhedron (twisted octahedron, 8 triangles, three concave edges) in a sphere of the given radius.
scree_status scree_generate_schoenhardt(scree_mesh *mesh, double radius);
/// Near-uniform triangulation of a sphere with `num_triangles` (even, >= 4) triangles or the nearest count there is;
/// scaled so that its volume is that of the sphere. SCREE_INVALID_INPUT above two million triangles.
scree_status scree_generate_sphere(scree_mesh *mesh, double radius, int32_t num_triangles);
/// Irregular rock with small concavities: a fine noisy, faceted and dented sphere of `detail` triangles (1000 if 0),
/// simplified to about num_triangles with its volume kept. Same seed, same rock. In its body frame; middle box size 1
/// before it is simplified, so that coarse and fine rocks of a seed have one volume, not one box.
scree_status scree_generate_rock(scree_mesh *mesh, uint64_t seed, int32_t num_triangles, int32_t detail);

enum
{
    SCREE_PROFILE_MAX_POINTS = 256,
    SCREE_MAX_SEGMENTS = 4096
};
/// Solid of revolution about z: `profile` is (num_points) the corners of a closed polygon, in either sense, that does
/// not cross itself; corners on the axis have radius 0. Cross-sections are regular polygons of num_segments sides with
/// the area of the circle. The mesh is where the profile puts it, not centred; a profile that crosses or touches itself
/// gives a mesh that scree_mesh_validate() refuses. SCREE_INVALID_INPUT: fewer than 3 or more than
/// SCREE_PROFILE_MAX_POINTS corners, a negative radius, no area, segments not in [3, SCREE_MAX_SEGMENTS].
scree_status scree_generate_turned(scree_mesh *mesh, const scree_profile_point *profile, int32_t num_points,
                                   int32_t num_segments);

/// Shifts a mesh by `offset` and puts num_copies of it, turned evenly about z, in its place: one body of many pieces,
/// which is valid if the copies do not touch. SCREE_INVALID_INPUT, SCREE_OUT_OF_MEMORY leave the mesh as it was.
scree_status scree_mesh_repeat(scree_mesh *mesh, const double offset[3], int32_t num_copies);

#endif
