/// \file overlap_parts.h
/// What the steps of one overlap share: the kept pieces of the two bodies, the crossings and segments found, and the
/// buffers that hold them. All coordinates are in the working frame (overlap_frame_kernel.h).
#ifndef SCREE_OVERLAP_PARTS_H
#define SCREE_OVERLAP_PARTS_H

#include "contact/overlap.h"
#include "contact/overlap_frame_kernel.h"
#include "contact/overlap_signs_kernel.h"

/// A triangle that can take part. Its corners are vertices of the same body.
typedef struct scree_overlap_triangle
{
    scree_face face;
    int32_t v[3];
    int32_t id;          ///< in the shape
    int32_t crossing[3]; ///< first crossing along each side that runs up its vertex ids here, or -1
    scree_vec3 foot;     ///< of the contact's middle on the plane, relative to the middle; once has_foot
    scree_vec3 boundary; ///< sum of p x q over the boundary of the part inside the other body: twice its area vector
    bool has_foot;
} scree_overlap_triangle;

/// A vertex of a kept triangle.
typedef struct scree_overlap_vertex
{
    scree_vec3 point;
    uint64_t above;   ///< planes of the other body that it is above of, on the convex path
    scree_real depth; ///< in the other's half-space; < 0: beyond it
    int32_t id;       ///< in the shape
    int32_t inside;   ///< how often it lies inside the other body: 0 or 1
    int32_t patch;    ///< of an inside vertex, once patches are told apart
} scree_overlap_vertex;

/// A triangle that passed the filter.
typedef struct scree_kept_triangle
{
    int32_t v[3];     ///< among the body's vertices here
    int32_t id;       ///< in the shape
    int32_t face;     ///< place of the triangle that stands for its flat face; itself, but on the convex path
    bool is_finished; ///< its scree_overlap_triangle is there
} scree_kept_triangle;

/// An edge that may join an inside vertex to the rest: how the inside count changes from its first end to its second.
typedef struct scree_overlap_link
{
    int32_t v[2];
    int32_t change;
} scree_overlap_link;

/// Kept pieces of one body.
typedef struct scree_overlap_body
{
    scree_overlap_vertex *vertices;    ///< (max_vertices)
    scree_kept_triangle *kept;         ///< (max_triangles)
    scree_overlap_triangle *triangles; ///< (max_triangles) the same with all that tests and sums need, once finished
    scree_box *triangle_boxes; ///< (max_triangles) of what of them lies in the other's half-space, with a margin
    scree_overlap_link *links; ///< (2 max_triangles)
    int32_t *vertex_slot;      ///< (max_shape_vertices) place of a kept vertex of the shape, else anything
    int32_t *triangle_slot;    ///< (max_shape_triangles) the same for triangles
    scree_box box;             ///< of the boxes of the kept triangles
    scree_box region;          ///< nothing of the body inside the other is outside of this
    int32_t num_vertices, max_vertices;
    int32_t num_triangles, max_triangles;
    int32_t num_inside; ///< vertices inside the other body
    int32_t max_shape_vertices, max_shape_triangles;
} scree_overlap_body;

/// An edge of one body passes through a triangle of the other.
typedef struct scree_overlap_crossing
{
    scree_vec3 point;
    int32_t triangle; ///< of the same body, in which the edge runs up its vertex ids
    int32_t side;     ///< of that triangle
    int32_t through;  ///< triangle of the other body
    int32_t sign;     ///< +1 where the edge, running up its vertex ids, enters the other body, -1 where it leaves
    int32_t next;     ///< next crossing along the same edge, or -1
    int32_t is_of_b;  ///< 1: the edge is of B
    int32_t patch;    ///< once patches are told apart
} scree_overlap_crossing;

/// Two triangles meet between the points of two crossings, from end 0 to end 1 along normal_a x normal_b.
typedef struct scree_overlap_segment
{
    int32_t triangle_a, triangle_b;
    int32_t end[2]; ///< crossings; while < 0, ~(side + 4 is_of_b): entered from the other triangle of its edge
} scree_overlap_segment;

/// The planes of a body's kept faces; one bit of a word for each.
#define SCREE_MAX_PLANES 64
typedef struct scree_convex_planes
{
    scree_vec3 normal[SCREE_MAX_PLANES];
    scree_real offset[SCREE_MAX_PLANES];
    scree_real margin[SCREE_MAX_PLANES]; ///< heights above this are certain
    int32_t triangle[SCREE_MAX_PLANES];  ///< kept triangle that stands for the face
    int32_t num;
} scree_convex_planes;

/// The sums over the edges of the overlap solid, see overlap_sums_kernel.h.
typedef struct scree_overlap_sums
{
    scree_vec3 middle; ///< C
    scree_box box;     ///< of all collected points
    scree_real six_volume;
    scree_real lost;        ///< what rounding has taken from six_volume so far, until it is added at the end
    scree_vec3 moment;      ///< 24 times the first moment about C
    scree_vec3 area_vector; ///< twice S
    scree_vec3 torque;      ///< -6 times the integral of x cross n over the part of A's surface, x from C
    scree_real residual;
    scree_real area; ///< of the overlap's surface
} scree_overlap_sums;

/// A side of one of two triangles that passes through the other: where their segment starts or ends.
typedef struct scree_segment_end
{
    int32_t is_of_b; ///< 1: a side of the triangle of B
    int32_t side;
    int32_t corner[2];
    scree_real height[2]; ///< of these corners over the other plane; unless the point is there
    scree_vec3 point;
    bool has_point;
} scree_segment_end;

/// Which capacity was too small.
typedef enum scree_overlap_lack
{
    SCREE_LACK_NOTHING,
    SCREE_LACK_PIECES,    ///< kept vertices, triangles, links
    SCREE_LACK_SHAPE,     ///< slots per vertex or triangle of a shape
    SCREE_LACK_CROSSINGS, ///< crossings and segments
} scree_overlap_lack;

/// What a triangle must reach into: a box, and the half-space direction . v <= reach.
typedef struct scree_filter_region
{
    scree_box box;
    scree_vec3 direction;
    scree_real reach;
    bool is_of_a; ///< of a body below the other: the box does not bound it from above, else not from below
} scree_filter_region;

/// A shape seen from the working frame.
typedef struct scree_posed_shape
{
    const scree_shape_view *shape;
    scree_mat3 rows;
    scree_vec3 offset;
} scree_posed_shape;

/// What is known of a pair once its frame is chosen.
typedef struct scree_overlap_setup
{
    scree_relative_pose pose; ///< of B to A
    scree_real size;          ///< largest coordinate of both, in the body frame of A
    scree_overlap_frame frame;
    scree_posed_shape posed[2];
    scree_vec3 direction;  ///< out of A into B, along the working axes, any length
    scree_vec3 known;      ///< world, out of A into B, by the caller: along it they overlap little; zero: not known
    scree_box box[2];      ///< of the whole bodies; A's exact, B's from outside
    scree_real extents[2]; ///< largest side of each body's own box, in units of A
} scree_overlap_setup;

/// Where a walk along one edge is: crossings and ends of it that may still start or end an interval.
typedef struct scree_interval_walk
{
    int32_t v[2];        ///< the edge's first and last vertex
    int32_t num_left[2]; ///< how often each of them counts: 0 or 1
    int32_t crossing[2]; ///< the next that may enter, the next that may leave; -1: none
} scree_interval_walk;

/// Walks over the edges of the solid: segments, intervals of A, intervals of B.
typedef struct scree_edge_walk
{
    int32_t part, next, side; ///< of the segments or triangles
    bool is_on_edge;          ///< the interval walk below goes on
    scree_interval_walk intervals;
} scree_edge_walk;

/// An edge of the solid with its two faces, which are of the same body for an interval.
typedef struct scree_solid_edge
{
    scree_vec3 point[2];
    int32_t corner[2];            ///< by number
    int32_t body_left, face_left; ///< runs from point 0 to point 1 with the face on its left
    int32_t body_right, face_right;
} scree_solid_edge;

/// Everything one overlap works on: borrowed buffers of one thread.
typedef struct scree_overlap_slice
{
    scree_overlap_body body[2];        ///< A and B
    scree_overlap_crossing *crossings; ///< (max_crossings)
    scree_overlap_segment *segments;   ///< (max_crossings)
    scree_vec3 *corners;               ///< (max_corners) of the overlap solid, or of one patch of it
    int32_t num_crossings, max_crossings;
    int32_t num_corners, max_corners;
    int32_t num_segments;
    int32_t num_patches; ///< 1: all is one patch, nothing is labelled
    bool is_closed;      ///< every crossing has its partners
    scree_overlap_lack lack;
    bool used_fallback;               ///< the certificate of the filtered scheme was not good enough
    scree_box common;                 ///< of the two boxes of kept triangles
    scree_real tolerance;             ///< 64 eps L, L the largest coordinate in play
    scree_real sign_tolerance;        ///< the same, or 0: hierarchy throughout
    const scree_shape_view *shape[2]; ///< of A and B
    scree_overlap_setup setup;
    scree_filter_region region[2]; ///< what triangles of A, of B must reach into
    scree_overlap_sums sums;
    scree_segment_end ends[2][6];   ///< of two triangles decided side by side: first ends, last ends
    scree_convex_planes planes[2];  ///< of the convex path
    scree_edge_walk edge_walk[2];   ///< of patches
    scree_solid_edge solid_edge[2]; ///< where these are
    scree_overlap_sums patch_sums;  ///< while patches are told apart
    scree_wide_walk walk;           ///< over a tree
    scree_levels levels;            ///< of the hierarchy
} scree_overlap_slice;

#endif
