/// \file shape.h
/// What a body's shape is to the step: a mesh in the body frame with the tree over its triangles, a sphere, or a clump
/// of spheres; and its measures.
#ifndef SCREE_SHAPE_INTERNAL_H
#define SCREE_SHAPE_INTERNAL_H

#include "bvh/lbvh.h"
#include "bvh/wide_tree.h"
#include "polyhedra/mass_properties.h"
#include "polyhedra/mesh.h"
#include "polyhedra/support_map.h"

/// Shapes of fewer triangles are gone through one triangle after the other.
#define SCREE_LARGE_SHAPE 48

/// What a shape is made of; contacts are found by a table over the kinds of two shapes, see narrow_phase.h.
typedef enum scree_shape_kind
{
    SCREE_KIND_MESH,
    SCREE_KIND_SPHERE, ///< of bounding_radius about the origin; no vertices, triangles or tree
    SCREE_KIND_CLUMP,  ///< rigid union of several spheres; likewise
    SCREE_NUM_SHAPE_KINDS
} scree_shape_kind;

/// A sphere of a clump in the body frame, or any sphere in the world.
typedef struct scree_sphere
{
    scree_vec3 centre; ///< [m]
    scree_real radius; ///< [m]
} scree_sphere;

/// Geometry of one shape as kernels see it: borrowed pointers, body frame, unscaled.
typedef struct scree_shape_view
{
    scree_shape_kind kind;
    const scree_vec3 *vertices;      ///< (num_vertices)
    const scree_triangle *triangles; ///< (num_triangles)
    const int32_t *neighbours;       ///< (num_triangles, 3) triangle across edge (v[k], v[k+1])
    const scree_vec3 *normals;       ///< (num_triangles) unit, outward
    scree_lbvh_view tree;            ///< over the boxes of the triangles
    scree_wide_tree_view wide_tree;  ///< the same for shapes of at least SCREE_LARGE_SHAPE triangles, else empty
    const float *support_map;        ///< (SCREE_SUPPORT_VALUES) of such shapes, else NULL
    const int32_t *flat_faces; ///< (num_triangles) first triangle of the flat face of each; NULL if all are alone or
                               ///< the shape is not convex
    int32_t num_vertices;
    int32_t num_triangles;
    bool is_convex;
    scree_real bounding_radius;  ///< about the origin of the body frame
    scree_box box;               ///< of the vertices, or of the spheres; body frame
    const scree_sphere *spheres; ///< (num_spheres) of a clump, body frame; NULL otherwise
    int32_t num_spheres;         ///< 1: a sphere, which needs no list
} scree_shape_view;

/// Owns its mesh and tree; shared by all bodies of this shape. Start from {0}.
typedef struct scree_shape
{
    scree_mesh mesh; ///< body frame
    int32_t *neighbours;
    scree_vec3 *normals;
    scree_lbvh tree;
    scree_wide_tree wide_tree;
    float *support_map;
    int32_t *flat_faces;
    scree_sphere *spheres;            ///< of a clump
    scree_mass_properties properties; ///< of the mesh as stored, or of the union of the spheres; in the body frame
    scree_shape_view view;
    double frame_position[3];    ///< origin of the body frame in the frame of the source mesh
    double frame_orientation[4]; ///< body frame to source frame, (w, x, y, z)
    double middle_size;          ///< middle one of the three extents of view.box
    int32_t num_supports;        ///< most spheres of a clump that a plane touches at once, see scree_clump_num_supports
} scree_shape;

/// Which frame the body gets.
typedef enum scree_shape_frame
{
    SCREE_FRAME_PRINCIPAL, ///< origin in the centroid, axes along the principal axes: particles
    SCREE_FRAME_SOURCE     ///< as the mesh was given: walls, posed overlaps
} scree_shape_frame;

/// Copies the mesh, which must be valid, moves it into its frame and builds the tree.
scree_status scree_shape_create(scree_shape *shape, const scree_mesh *mesh, scree_shape_frame frame);
/// A true sphere about the origin. radius > 0 [m].
void scree_shape_create_sphere(scree_shape *shape, double radius);
void scree_shape_destroy(scree_shape *shape);

/// Sphere k of a sphere or clump, body frame, unscaled.
SCREE_FN scree_sphere scree_shape_sphere(const scree_shape_view *shape, int32_t k)
{
    if (shape->spheres) return shape->spheres[k];
    scree_sphere sphere;
    sphere.centre = scree_vec3_zero();
    sphere.radius = shape->bounding_radius;
    return sphere;
}

#endif
