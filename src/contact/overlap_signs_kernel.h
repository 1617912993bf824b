/// \file overlap_signs_kernel.h
/// Crossings decided by plain orientation signs where every sign that matters clears a margin of 64 eps L, far above
/// its rounding error. Whatever is certain here is certain in the hierarchy too, so the two may be mixed freely, one
/// edge against one triangle at a time.
#ifndef SCREE_OVERLAP_SIGNS_KERNEL_H
#define SCREE_OVERLAP_SIGNS_KERNEL_H

#include "contact/overlap_hierarchy_kernel.h"

/// Margin of certainty over eps L, L the largest coordinate in play.
#define SCREE_SIGN_MARGIN 64

/// What the signs say about one edge and one triangle.
typedef enum scree_sign_verdict
{
    SCREE_SIGN_APART = 0,
    SCREE_SIGN_ENTERS = 1,  ///< the edge, lower id first, goes from the outer side of the triangle to the inner
    SCREE_SIGN_LEAVES = -1, ///< and the other way round
    SCREE_SIGN_UNSURE = 2
} scree_sign_verdict;

/// Height of a point over the plane of a face, times twice the face's area.
SCREE_FN scree_real scree_face_height(const scree_face *face, scree_vec3 p)
{
    return scree_vec3_dot(face->normal, p) - face->offset;
}

/// Six times the volume of the tetrahedron of a line and side p q of a face: > 0 for all three sides if the line goes
/// against the normal through the face.
SCREE_FN scree_real scree_line_orientation(scree_vec3 start, scree_vec3 direction, scree_vec3 p, scree_vec3 q)
{
    return scree_vec3_dot(scree_vec3_sub(p, start), scree_vec3_cross(direction, scree_vec3_sub(q, p)));
}

/// Does the edge, of length at most `size`, pass through the triangle? `tolerance` is 64 eps L. Sets the point if so.
SCREE_FN scree_sign_verdict scree_edge_sign(const scree_line *edge, scree_real size, const scree_face *g,
                                            scree_real tolerance, scree_vec3 *point)
{
    // heights of the ends above the plane
    const scree_real plane_margin = tolerance * g->size * g->size;
    const scree_real h0 = scree_face_height(g, edge->p[0]);
    const scree_real h1 = scree_face_height(g, edge->p[1]);
    const scree_real lower = scree_min(h0, h1);
    const scree_real upper = scree_max(h0, h1);
    if ((int32_t)(lower > plane_margin) | (int32_t)(upper < -plane_margin)) return SCREE_SIGN_APART;
    if ((int32_t)(lower >= -plane_margin) | (int32_t)(upper <= plane_margin)) return SCREE_SIGN_UNSURE;

    // the line must pass all three sides on their inner side
    const bool is_entering = h0 > h1;
    const scree_vec3 direction = scree_vec3_sub(edge->p[1], edge->p[0]);
    const scree_real turn0 = scree_line_orientation(edge->p[0], direction, g->p[0], g->p[1]);
    const scree_real turn1 = scree_line_orientation(edge->p[0], direction, g->p[1], g->p[2]);
    const scree_real turn2 = scree_line_orientation(edge->p[0], direction, g->p[2], g->p[0]);
    const scree_real inward =
        is_entering ? scree_min(scree_min(turn0, turn1), turn2) : -scree_max(scree_max(turn0, turn1), turn2);
    const scree_real side_margin = tolerance * size * g->size;
    if (inward < -side_margin) return SCREE_SIGN_APART;
    if (inward <= side_margin) return SCREE_SIGN_UNSURE;

    // from the nearer end
    if (scree_abs(h0) <= scree_abs(h1)) *point = scree_vec3_add_scaled(edge->p[0], direction, h0 / (h0 - h1));
    else *point = scree_vec3_add_scaled(edge->p[1], direction, h1 / (h0 - h1));
    return is_entering ? SCREE_SIGN_ENTERS : SCREE_SIGN_LEAVES;
}

/// Which count a vertex gets from one triangle, seen from outside the hierarchy: s02 of a vertex of A with the triangle
/// of B, or -s20 of a vertex of B with the triangle of A: SCREE_SIGN_UNSURE if any sign is not certain.
SCREE_FN int32_t scree_vertex_sign(scree_vec3 v, const scree_face *g, bool is_a, scree_real tolerance)
{
    // turn of the vertex against each side in the plane
    const scree_real margin = tolerance * g->size;
    int32_t num_left = 0;
    int32_t num_right = 0;
    for (int32_t k = 0; k < 3; ++k)
    {
        const scree_vec3 p = g->p[k];
        const scree_vec3 q = g->p[k == 2 ? 0 : k + 1];
        const scree_real turn = (q.x - p.x) * (v.y - p.y) - (q.y - p.y) * (v.x - p.x);
        num_left += turn > margin;
        num_right += turn < -margin;
    }
    if (num_left > 0 && num_right > 0) return 0;
    if (num_left < 3 && num_right < 3) return SCREE_SIGN_UNSURE;

    const scree_real height = scree_vec3_dot(g->normal, scree_vec3_sub(v, g->p[0]));
    const scree_real plane_margin = margin * g->size;
    if (scree_abs(height) <= plane_margin) return SCREE_SIGN_UNSURE;
    const bool is_upward = num_left == 3;
    const bool is_above = (height > 0) == is_upward;
    if (is_a) return !is_above ? 0 : is_upward ? -1 : 1;
    return is_above ? 0 : is_upward ? 1 : -1;
}

#endif
