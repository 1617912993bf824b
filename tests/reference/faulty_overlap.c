#include "faulty_overlap.h"

#include "contact/overlap_hierarchy_kernel.h"
#include "contact/overlap_signs_kernel.h"

faulty_state faulty;

/// The answer to one question about a crossing, spoilt if it is its turn.
static int32_t spoil_crossing(int32_t sign, const scree_line *edge, scree_vec3 *point)
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

static int32_t spoil_count(int32_t count)
{
    if (count == 0) return faulty.num_uncounted++ == faulty.place && faulty.kind == FAULTY_INSIDE_INVENTED ? 1 : 0;
    return faulty.num_counted++ == faulty.place && faulty.kind == FAULTY_INSIDE_MISSED ? 0 : count;
}

static scree_sign_verdict faulty_edge_sign(const scree_line *edge, scree_real size, const scree_face *g,
                                           scree_real tolerance, scree_vec3 *point)
{
    const scree_sign_verdict verdict = scree_edge_sign(edge, size, g, tolerance, point);
    if (verdict == SCREE_SIGN_UNSURE) return verdict; // the hierarchy decides
    return (scree_sign_verdict)spoil_crossing((int32_t)verdict, edge, point);
}

static int32_t faulty_edge_a_crosses(const scree_line *edge_a, const scree_face *face_b, scree_vec3 *point)
{
    return spoil_crossing(scree_edge_a_crosses(edge_a, face_b, point), edge_a, point);
}

static int32_t faulty_edge_b_crosses(const scree_face *face_a, const scree_line *edge_b, scree_vec3 *point)
{
    return spoil_crossing(scree_edge_b_crosses(face_a, edge_b, point), edge_b, point);
}

static int32_t faulty_vertex_sign(scree_vec3 v, const scree_face *g, bool is_a, scree_real tolerance)
{
    const int32_t count = scree_vertex_sign(v, g, is_a, tolerance);
    return count == SCREE_SIGN_UNSURE ? count : spoil_count(count);
}

static int32_t faulty_vertex_a_above(scree_vec3 a, const scree_face *face_b)
{
    return spoil_count(scree_vertex_a_above(a, face_b));
}

static int32_t faulty_vertex_b_below(scree_vec3 b, const scree_face *face_a)
{
    return spoil_count(scree_vertex_b_below(b, face_a));
}

// the kernels and the entry once more, under other names
#define scree_edge_sign faulty_edge_sign
#define scree_edge_a_crosses faulty_edge_a_crosses
#define scree_edge_b_crosses faulty_edge_b_crosses
#define scree_vertex_sign faulty_vertex_sign
#define scree_vertex_a_above faulty_vertex_a_above
#define scree_vertex_b_below faulty_vertex_b_below
#define scree_overlap_compute faulty_overlap_compute
#define scree_overlap_workspace_create faulty_workspace_create
#define scree_overlap_workspace_grow faulty_workspace_grow
#define scree_overlap_workspace_destroy faulty_workspace_destroy
#include "../../src/contact/overlap.c"
