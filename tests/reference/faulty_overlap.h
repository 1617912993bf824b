/// \file faulty_overlap.h
/// scree's overlap with one decision spoilt on purpose: faulty_overlap.c compiles the kernels a second time with the
/// functions that decide replaced by these. Shows what the certificate notices.
#ifndef SCREE_FAULTY_OVERLAP_H
#define SCREE_FAULTY_OVERLAP_H

#include "contact/overlap.h"

typedef enum faulty_kind
{
    FAULTY_NONE,
    FAULTY_MISSED,   ///< an edge passes through a triangle, but is said not to
    FAULTY_FLIPPED,  ///< it enters and is said to leave, or the other way round
    FAULTY_INVENTED, ///< it misses the triangle, but is said to pass in its middle
    FAULTY_SHIFTED,  ///< the point of a crossing is off by a hundredth of the edge
    FAULTY_OUTSIDE   ///< a vertex that may be inside is said to be outside
} faulty_kind;

typedef struct faulty_state
{
    faulty_kind kind;
    int64_t place;                     ///< which of the decisions that the kind applies to
    int64_t num_crossings, num_misses; ///< decisions met, by their true answer
    int64_t num_not_outside;
    bool has_key;           ///< a decision about an edge and a triangle has been spoilt:
    scree_vec3 key[5];      ///< the ends of the edge and the corners of the triangle,
    int32_t given;          ///< the answer that was given
    scree_vec3 given_point; ///< and will be given to the same question again
} faulty_state;

extern faulty_state faulty; ///< one thread only

int32_t faulty_overlap_compute(const scree_shape_view *a, const scree_pose *pose_a, const scree_shape_view *b,
                               const scree_pose *pose_b, const scree_overlap_options *options,
                               scree_overlap_workspace *workspace, scree_overlap_result *results, int32_t max_results);
scree_overlap_workspace *faulty_workspace_create(void);
scree_status faulty_workspace_grow(scree_overlap_workspace *workspace);
void faulty_workspace_destroy(scree_overlap_workspace *workspace);

#endif
