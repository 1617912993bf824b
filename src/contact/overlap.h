/// \file overlap.h
/// Exact overlap of two posed meshes: volume, area vector, centroid, indentation, and a certificate.
#ifndef SCREE_OVERLAP_H
#define SCREE_OVERLAP_H

#include "polyhedra/shape.h"

/// What came of one overlap.
typedef enum scree_overlap_status
{
    SCREE_OVERLAP_NONE,          ///< no common volume
    SCREE_OVERLAP_TOUCHING,      ///< volume > 0 and a normal
    SCREE_OVERLAP_NO_NORMAL,     ///< volume > 0, normal undefined: below the noise level, or one body inside the other
    SCREE_OVERLAP_WORKSPACE_FULL ///< nothing computed: grow the workspace and call again
} scree_overlap_status;

/// How crossings are decided.
typedef enum scree_overlap_scheme
{
    SCREE_OVERLAP_FILTERED, ///< orientation signs where they are certain, hierarchy otherwise: the default
    SCREE_OVERLAP_HIERARCHY ///< dimension-by-dimension hierarchy throughout
} scree_overlap_scheme;

typedef struct scree_overlap_options
{
    scree_overlap_scheme scheme;
    bool separate_patches; ///< connected pieces of the overlap as contacts of their own, instead of one for all
    bool use_convex_path;  ///< two convex shapes are clipped by planes where every sign is certain: the same, sooner
} scree_overlap_options;

/// One contact between bodies A and B, in world axes.
typedef struct scree_overlap_result
{
    scree_real volume;        ///< [m^3]
    scree_vec3 area_vector;   ///< [m^2] sum of area times outward normal over the part of A's surface inside B
    scree_vec3 torque_vector; ///< [m^3] integral of x cross n over the same part of A's surface, x from the centroid
    scree_vec3 arm;           ///< [m] centroid of the overlap minus the position of A
    scree_vec3 normal;        ///< [1] area vector over its length: out of A, into B
    scree_real indentation;   ///< [m] extent of the overlap along the normal
    scree_real radius;        ///< [m] largest distance of a point of the overlap from the centroid, across the normal
    scree_real residual;      ///< [1] certificate: |S_A + S_B| over the area, from the faces' own normals;
                              ///< 1 if the crossings do not close
    scree_overlap_status status;
    bool used_fallback; ///< the certificate made the filtered scheme repeat with the hierarchy
} scree_overlap_result;

/// Have two bodies of these bounding radii a common volume that stands above rounding, and yet no normal? One is inside
/// the other, or goes through it: no force parts them.
SCREE_FN bool scree_overlap_is_lost(const scree_overlap_result *result, scree_real radius_a, scree_real radius_b)
{
    const scree_real larger = scree_max(radius_a, radius_b), smaller = scree_min(radius_a, radius_b);
    // 1000 eps L times the area is noise, and no common area is larger than that of the smaller sphere
    return result->status == SCREE_OVERLAP_NO_NORMAL &&
           result->volume > 13000 * SCREE_REAL_EPSILON * larger * smaller * smaller;
}

/// Buffers of one thread; grows when told. Start from {0}.
typedef struct scree_overlap_workspace scree_overlap_workspace;
scree_overlap_workspace *scree_overlap_workspace_create(void); ///< NULL: out of memory
/// Doubles the capacity that was too small at the last call.
scree_status scree_overlap_workspace_grow(scree_overlap_workspace *workspace);
void scree_overlap_workspace_destroy(scree_overlap_workspace *workspace);

/// Overlap of body A (a at pose_a) and body B. `results` is (max_results); returns the number of results, at least 1
/// unless max_results is 0: one, with status NONE where nothing overlaps, or with separate patches one per piece, of
/// which the first max_results are written. A and B may be swapped: area, torque and normal change sign, nothing else
/// changes beyond rounding, except the order of patches.
int32_t scree_overlap_compute(const scree_shape_view *a, const scree_pose *pose_a, const scree_shape_view *b,
                              const scree_pose *pose_b, const scree_overlap_options *options,
                              scree_overlap_workspace *workspace, scree_overlap_result *results, int32_t max_results);

#endif
