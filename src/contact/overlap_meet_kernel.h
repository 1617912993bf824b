/// \file overlap_meet_kernel.h
/// Where two triangles meet, from the signs of ten determinants: the heights of the corners of each over the plane of
/// the other, and the order of the four sides that pass the planes along the line in which these cut each other
/// (after Guigue & Devillers 2003). Every sign must clear its margin of 64 eps L; otherwise the pair is unsure and
/// decided side by side.
#ifndef SCREE_OVERLAP_MEET_KERNEL_H
#define SCREE_OVERLAP_MEET_KERNEL_H

#include "contact/overlap_parts.h"
#include "core/bits.h"

/// What the signs say about two triangles.
typedef enum scree_meet_verdict
{
    SCREE_MEET_APART,
    SCREE_MEET_SEGMENT, ///< they meet in the segment p to q
    SCREE_MEET_UNSURE
} scree_meet_verdict;

/// A triangle cut by a plane: one corner is alone on its side of it. The two sides from there pass the plane, one where
/// the cut starts, one where it ends, along the line normal_a x normal_b.
typedef struct scree_cut
{
    int32_t lone;                       ///< this corner
    int32_t first, last;                ///< the corners at the far ends of the two sides
    bool is_up;                         ///< the lone corner is above the plane
    scree_vec3 along_first, along_last; ///< from the lone corner
} scree_cut;

/// `ups`: bit k is set if corner k is above the plane, neither all nor none. `is_of_b`: the face is of B, against which
/// the line runs the other way round.
SCREE_FN scree_cut scree_cut_make(const scree_face *face, int32_t ups, bool is_of_b)
{
    scree_cut cut;
    cut.lone = scree_lone_corner(ups);
    cut.is_up = (ups >> cut.lone & 1) != 0;
    // what is left of a face after the part above the plane is cut off has the cut on its boundary, counter-clockwise;
    // found by counting, since no branch could be foreseen here
    const int32_t first = cut.lone + 2 - (int32_t)(cut.is_up == is_of_b);
    cut.first = first - 3 * (int32_t)(first > 2);
    cut.last = 3 - cut.lone - cut.first;
    cut.along_first = scree_vec3_sub(face->p[cut.first], face->p[cut.lone]);
    cut.along_last = scree_vec3_sub(face->p[cut.last], face->p[cut.lone]);
    return cut;
}

SCREE_FN void scree_segment_end_set(scree_segment_end *end, int32_t is_of_b, int32_t lone, int32_t other,
                                    const scree_real *height)
{
    end->is_of_b = is_of_b;
    end->side = scree_next_corner(lone) == other ? lone : other;
    end->corner[0] = lone;
    end->corner[1] = other;
    end->height[0] = SCREE_PICK3(height, lone);
    end->height[1] = SCREE_PICK3(height, other);
    end->has_point = false;
}

/// Where the side passes the plane: from the nearer end.
SCREE_FN scree_vec3 scree_segment_end_point(const scree_segment_end *end, const scree_face *own)
{
    if (end->has_point) return end->point;
    const scree_real h0 = end->height[0];
    const scree_real h1 = end->height[1];
    const int32_t nearer = scree_abs(h0) <= scree_abs(h1) ? 0 : 1;
    const scree_vec3 start = own->p[SCREE_PICK2(end->corner, nearer)];
    const scree_vec3 along = scree_vec3_sub(own->p[SCREE_PICK2(end->corner, 1 - nearer)], start);
    const scree_real part = nearer == 0 ? h0 / (h0 - h1) : h1 / (h1 - h0);
    return scree_vec3_add_scaled(start, along, part);
}

/// Heights of the corners of one face over the plane of another.
typedef struct scree_corner_heights
{
    scree_real h[3];
    scree_real least, most;
} scree_corner_heights;

SCREE_FN scree_corner_heights scree_corner_heights_over(const scree_face *plane, const scree_face *face)
{
    scree_corner_heights heights;
    heights.h[0] = scree_face_height(plane, face->p[0]);
    heights.h[1] = scree_face_height(plane, face->p[1]);
    heights.h[2] = scree_face_height(plane, face->p[2]);
    heights.least = scree_min(scree_min(heights.h[0], heights.h[1]), heights.h[2]);
    heights.most = scree_max(scree_max(heights.h[0], heights.h[1]), heights.h[2]);
    return heights;
}

/// Is a height too small to be certain of its sign?
SCREE_FN bool scree_corner_heights_unsure(const scree_corner_heights *heights, scree_real margin)
{
    return scree_min(scree_min(scree_abs(heights->h[0]), scree_abs(heights->h[1])), scree_abs(heights->h[2])) <= margin;
}

SCREE_FN int32_t scree_corner_heights_ups(const scree_corner_heights *heights)
{
    return (int32_t)(heights->h[0] > 0) | (int32_t)(heights->h[1] > 0) << 1 | (int32_t)(heights->h[2] > 0) << 2;
}

/// Triangle f of A against triangle g of B; p and q are set if they meet. `tolerance` is 64 eps L.
SCREE_FN scree_meet_verdict scree_faces_meet(const scree_face *f, const scree_face *g, scree_real tolerance,
                                             scree_segment_end *p, scree_segment_end *q)
{
    const scree_corner_heights of_f = scree_corner_heights_over(g, f);
    const scree_real margin_g = tolerance * (g->size * g->size);
    if ((int32_t)(of_f.least > margin_g) | (int32_t)(of_f.most < -margin_g)) return SCREE_MEET_APART;
    const scree_corner_heights of_g = scree_corner_heights_over(f, g);
    const scree_real margin_f = tolerance * (f->size * f->size);
    if ((int32_t)(of_g.least > margin_f) | (int32_t)(of_g.most < -margin_f)) return SCREE_MEET_APART;
    if (scree_corner_heights_unsure(&of_f, margin_g) || scree_corner_heights_unsure(&of_g, margin_f))
        return SCREE_MEET_UNSURE;

    // order of the sides of f and g along the line: > 0 if that of g comes after that of f
    const scree_cut cut_f = scree_cut_make(f, scree_corner_heights_ups(&of_f), false);
    const scree_cut cut_g = scree_cut_make(g, scree_corner_heights_ups(&of_g), true);
    const scree_real sense = 1 - 2 * (scree_real)(cut_f.is_up != cut_g.is_up);
    const scree_vec3 between = scree_vec3_scale(scree_vec3_sub(g->p[cut_g.lone], f->p[cut_f.lone]), sense);
    const scree_vec3 normal_first = scree_vec3_cross(between, cut_g.along_first);
    const scree_vec3 normal_last = scree_vec3_cross(between, cut_g.along_last);
    const scree_real first_to_last = scree_vec3_dot(cut_f.along_first, normal_last);
    const scree_real last_to_first = scree_vec3_dot(cut_f.along_last, normal_first);
    const scree_real margin = tolerance * (f->size * g->size);
    if ((int32_t)(first_to_last < -margin) | (int32_t)(last_to_first > margin)) return SCREE_MEET_APART;
    const scree_real first = scree_vec3_dot(cut_f.along_first, normal_first);
    const scree_real last = scree_vec3_dot(cut_f.along_last, normal_last);
    if ((int32_t)(first_to_last <= margin) | (int32_t)(last_to_first >= -margin) |
        (int32_t)(scree_abs(first) <= margin) | (int32_t)(scree_abs(last) <= margin))
        return SCREE_MEET_UNSURE;

    // the later of the two starts, the earlier of the two ends
    if (first > 0) scree_segment_end_set(p, 1, cut_g.lone, cut_g.first, of_g.h);
    else scree_segment_end_set(p, 0, cut_f.lone, cut_f.first, of_f.h);
    if (last < 0) scree_segment_end_set(q, 1, cut_g.lone, cut_g.last, of_g.h);
    else scree_segment_end_set(q, 0, cut_f.lone, cut_f.last, of_f.h);
    return SCREE_MEET_SEGMENT;
}

#endif
