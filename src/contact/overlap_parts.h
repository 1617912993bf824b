/// \file overlap_parts.h
/// What the steps of one overlap share: the kept pieces of the two bodies, the crossings and segments found, and the
/// buffers that hold them. All coordinates are in the working frame (overlap_frame_kernel.h).
#ifndef SCREE_OVERLAP_PARTS_H
#define SCREE_OVERLAP_PARTS_H

#include "contact/overlap.h"
#include "contact/overlap_signs_kernel.h"

/// A triangle that can take part. Its corners are vertices of the same body.
typedef struct scree_overlap_triangle
{
    scree_face face;
    int32_t v[3];
    int32_t id;          ///< in the shape
    scree_vec3 foot;     ///< of the contact's middle on the plane, relative to the middle; once has_foot
    scree_vec3 boundary; ///< sum of p x q over the boundary of the part inside the other body: twice its area vector
    bool has_foot;
} scree_overlap_triangle;

/// An edge between two kept triangles that may cross something or ends inside; no other does.
typedef struct scree_overlap_edge
{
    scree_line line; ///< lower vertex id first: every interpolation runs this way
    int32_t v[2];
    int32_t left;    ///< triangle in which the edge runs v[0] to v[1]
    int32_t right;   ///< the other one
    scree_real size; ///< bound from above on its length
    scree_vec3 foot; ///< point of the edge nearest to the contact's middle, relative to the middle; once has_foot
    bool has_foot;
} scree_overlap_edge;

/// A triangle that passed the filter.
typedef struct scree_kept_triangle
{
    scree_box box;
    int32_t v[3]; ///< among the body's vertices here
    int32_t id;   ///< in the shape
} scree_kept_triangle;

/// Kept pieces of one body.
typedef struct scree_overlap_body
{
    scree_vec3 *points;                ///< (max_vertices)
    int32_t *vertex_id;                ///< (max_vertices) in the shape
    scree_real *along;                 ///< (max_vertices) along the direction that the other's half-space looks in
    int32_t *outcode;                  ///< (max_vertices) sides of the region on which the vertex is outside
    int32_t *inside;                   ///< (max_vertices) how often the vertex lies inside the other body: 0 or 1
    scree_kept_triangle *kept;         ///< (max_triangles)
    scree_overlap_triangle *triangles; ///< (max_triangles) the same, those near the other body first
    scree_box *triangle_boxes;         ///< (max_triangles)
    uint64_t *rows;                    ///< (max_triangles) bit t: may meet triangle t of the other's present block
    scree_overlap_edge *edges;         ///< (max_edges)
    int32_t *vertex_slot;              ///< (max_shape_vertices) place of a kept vertex of the shape, else anything
    int32_t *triangle_slot;            ///< (max_shape_triangles) the same for triangles
    scree_box box;                     ///< of the kept triangles
    int32_t num_vertices, max_vertices;
    int32_t num_triangles, max_triangles;
    int32_t num_near_triangles; ///< can meet triangles of the other body; the rest are only for the rays
    int32_t num_edges, max_edges;
    int32_t num_inside; ///< vertices inside the other body
    int32_t max_shape_vertices, max_shape_triangles;
} scree_overlap_body;

/// An edge of one body passes through a triangle of the other.
typedef struct scree_overlap_crossing
{
    scree_vec3 point;
    int32_t edge;
    int32_t triangle;
    int32_t sign;    ///< x12 or x21: +1 where an edge of A enters B, -1 where an edge of B enters A
    int32_t is_of_b; ///< 1: the edge is of B, the triangle of A
} scree_overlap_crossing;

/// The two triangles meet between the points of two crossings, p to q. While it is being paired, `next` chains the
/// open ends of one pair of triangles.
typedef struct scree_overlap_segment
{
    int32_t triangle_a, triangle_b;
    int32_t p, q; ///< crossings; -1 while open
    int32_t next;
} scree_overlap_segment;

/// Which capacity was too small.
typedef enum scree_overlap_lack
{
    SCREE_LACK_NOTHING,
    SCREE_LACK_PIECES,    ///< kept vertices, triangles, edges
    SCREE_LACK_SHAPE,     ///< slots per vertex or triangle of a shape
    SCREE_LACK_CROSSINGS, ///< crossings, segments and their table
} scree_overlap_lack;

/// Everything one overlap works on: borrowed buffers of one thread.
typedef struct scree_overlap_slice
{
    scree_overlap_body body[2];        ///< A and B
    scree_overlap_crossing *crossings; ///< (max_crossings)
    scree_overlap_segment *segments;   ///< (2 max_crossings)
    int32_t *table;                    ///< (max_table) open ends by pair of triangles
    int32_t num_crossings, max_crossings;
    int32_t num_segments;
    int32_t max_table; ///< a power of two, at least 4 max_crossings
    scree_overlap_lack lack;
    scree_box common;          ///< of the two boxes of kept triangles
    scree_real sign_tolerance; ///< 64 eps L, L the largest coordinate of a kept vertex; 0: hierarchy throughout
} scree_overlap_slice;

#endif
