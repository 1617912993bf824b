#include "faulty_overlap.h"

#include "contact/overlap_hierarchy_kernel.h"
#include "contact/overlap_meet_kernel.h"
#include "contact/overlap_signs_kernel.h"
#include "contact/triangle_filter_kernel.h"

#include <string.h>

faulty_state faulty;

/// The answer to one question about a crossing, spoilt if it is its turn.
static int32_t spoil_answer(int32_t sign, const scree_line *edge, scree_vec3 *point)
{
    if (sign == 0)
    {
        if (faulty.num_misses++ != faulty.place || faulty.kind != FAULTY_INVENTED) return 0;
        *point = scree_vec3_scale(scree_vec3_add(edge->p[0], edge->p[1]), (scree_real)0.5);
        return 1;
    }
    if (faulty.num_crossings++ != faulty.place) return sign;
    if (faulty.kind == FAULTY_MISSED) return 0;
    if (faulty.kind == FAULTY_FLIPPED) return -sign;
    if (faulty.kind == FAULTY_SHIFTED)
        *point = scree_vec3_add_scaled(*point, scree_vec3_sub(edge->p[1], edge->p[0]), (scree_real)0.01);
    return sign;
}

/// The same, and wrong in the same way whenever the question comes again: from the other triangle of the edge.
static int32_t spoil_crossing(int32_t sign, const scree_line *edge, const scree_face *face, scree_vec3 *point)
{
    scree_vec3 key[5];
    memcpy(key, edge->p, sizeof edge->p);
    memcpy(key + 2, face->p, sizeof face->p);
    if (faulty.has_key && memcmp(key, faulty.key, sizeof key) == 0)
    {
        *point = faulty.given_point;
        return faulty.given;
    }
    const scree_vec3 right = *point;
    const int32_t answer = spoil_answer(sign, edge, point);
    const bool is_moved = answer != 0 && memcmp(&right, point, sizeof right) != 0;
    if (answer != sign || is_moved)
    {
        faulty.has_key = true;
        memcpy(faulty.key, key, sizeof key);
        faulty.given = answer;
        faulty.given_point = *point;
    }
    return answer;
}

static scree_sign_verdict faulty_edge_sign(const scree_line *edge, scree_real size, const scree_face *g,
                                           scree_real tolerance, scree_vec3 *point)
{
    const scree_sign_verdict verdict = scree_edge_sign(edge, size, g, tolerance, point);
    if (verdict == SCREE_SIGN_UNSURE) return verdict; // the hierarchy decides
    return (scree_sign_verdict)spoil_crossing((int32_t)verdict, edge, g, point);
}

static int32_t faulty_edge_a_crosses(scree_levels *levels, const scree_line *edge_a, const scree_face *face_b,
                                     scree_vec3 *point)
{
    return spoil_crossing(scree_edge_a_crosses(levels, edge_a, face_b, point), edge_a, face_b, point);
}

static int32_t faulty_edge_b_crosses(scree_levels *levels, const scree_face *face_a, const scree_line *edge_b,
                                     scree_vec3 *point)
{
    return spoil_crossing(scree_edge_b_crosses(levels, face_a, edge_b, point), edge_b, face_a, point);
}

/// A pair of triangles that is decided as a whole is spoilt as a whole.
static scree_meet_verdict faulty_faces_meet(const scree_face *f, const scree_face *g, scree_real tolerance,
                                            scree_segment_end *p, scree_segment_end *q)
{
    const scree_meet_verdict verdict = scree_faces_meet(f, g, tolerance, p, q);
    if (verdict == SCREE_MEET_UNSURE) return verdict;
    if (verdict == SCREE_MEET_APART)
    {
        if (faulty.num_misses++ != faulty.place || faulty.kind != FAULTY_INVENTED) return verdict;
        const scree_real height[3] = {1, -1, -1};
        scree_segment_end_set(p, 0, 0, 1, height);
        scree_segment_end_set(q, 1, 0, 1, height);
        return SCREE_MEET_SEGMENT;
    }
    if (faulty.num_crossings++ != faulty.place) return verdict;
    if (faulty.kind == FAULTY_MISSED) return SCREE_MEET_APART;
    if (faulty.kind == FAULTY_FLIPPED)
    {
        p->point = scree_vec3_zero();
        q->point = scree_vec3_zero();
        const scree_segment_end end = *p;
        *p = *q;
        *q = end;
    }
    if (faulty.kind == FAULTY_SHIFTED)
    {
        const scree_face *own = p->is_of_b ? g : f;
        const scree_vec3 along = scree_vec3_sub(own->p[p->corner[1]], own->p[p->corner[0]]);
        p->point = scree_vec3_add_scaled(scree_segment_end_point(p, own), along, (scree_real)0.01);
        p->has_point = true;
    }
    return verdict;
}

static bool faulty_is_outside(const scree_overlap_body *body, bool is_of_a, const scree_overlap_vertex *vertex)
{
    if (scree_filter_is_outside(body, is_of_a, vertex)) return true;
    return faulty.num_not_outside++ == faulty.place && faulty.kind == FAULTY_OUTSIDE;
}

// the kernels and the entry once more, under other names
#define scree_edge_sign faulty_edge_sign
#define scree_edge_a_crosses faulty_edge_a_crosses
#define scree_edge_b_crosses faulty_edge_b_crosses
#define scree_faces_meet faulty_faces_meet
#define scree_filter_is_outside faulty_is_outside
#define scree_overlap_compute faulty_overlap_compute
#define scree_overlap_workspace_create faulty_workspace_create
#define scree_overlap_workspace_grow faulty_workspace_grow
#define scree_overlap_workspace_destroy faulty_workspace_destroy
#include "../../src/contact/overlap.c"
