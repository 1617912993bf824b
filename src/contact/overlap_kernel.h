/// \file overlap_kernel.h
/// Overlap of two posed meshes, from cheap exits to results: frame, filter, crossings, sums.
#ifndef SCREE_OVERLAP_KERNEL_H
#define SCREE_OVERLAP_KERNEL_H

#include "contact/overlap_convex_kernel.h"
#include "contact/overlap_crossings_kernel.h"
#include "contact/overlap_direction_kernel.h"
#include "contact/overlap_patches_kernel.h"
#include "contact/overlap_sums_kernel.h"
#include "contact/separation_kernel.h"
#include "contact/triangle_filter_kernel.h"

/// Certificates above this make the filtered scheme repeat with the hierarchy. Good results in single precision have
/// residuals up to 5e-6.
#ifdef SCREE_SINGLE
#define SCREE_RESIDUAL_LIMIT ((scree_real)1e-4)
#else
#define SCREE_RESIDUAL_LIMIT ((scree_real)1e-6)
#endif

/// Two bodies to be compared.
typedef struct scree_overlap_pair
{
    const scree_shape_view *shape[2];
    const scree_pose *pose[2];
} scree_overlap_pair;

/// Are the bounding spheres apart?
SCREE_FN bool scree_overlap_spheres_apart(const scree_overlap_pair *pair)
{
    const scree_vec3 between = scree_vec3_sub(pair->pose[1]->position, pair->pose[0]->position);
    const scree_real reach =
        pair->pose[0]->scale * pair->shape[0]->bounding_radius + pair->pose[1]->scale * pair->shape[1]->bounding_radius;
    return scree_vec3_dot(between, between) * (1 - 8 * SCREE_REAL_EPSILON) > reach * reach;
}

/// Box of a body in the working frame; `rounding` widens it.
SCREE_FN scree_box scree_overlap_body_box(const scree_posed_shape *posed, scree_real rounding)
{
    const scree_vec3 middle = scree_affine(&posed->rows, scree_box_middle(posed->shape->box), posed->offset);
    const scree_vec3 half = scree_vec3_add(scree_turned_extents(&posed->rows, scree_box_half(posed->shape->box)),
                                           scree_vec3_make(rounding, rounding, rounding));
    scree_box box;
    box.lower = scree_vec3_sub(middle, half);
    box.upper = scree_vec3_add(middle, half);
    return box;
}

/// Poses and boxes. False if the boxes are apart.
SCREE_FN_APART bool scree_overlap_set_up_boxes(scree_overlap_pair bodies, scree_overlap_setup *setup)
{
    const scree_overlap_pair *pair = &bodies;
    setup->pose = scree_relative_pose_make(pair->pose[0], pair->pose[1]);
    const scree_box box_a = pair->shape[0]->box;
    setup->posed[0].shape = pair->shape[0];
    setup->posed[1].shape = pair->shape[1];
    setup->posed[1].rows = setup->pose.rotation;
    setup->posed[1].offset = setup->pose.translation;
    const scree_real size =
        scree_max(scree_box_reach(box_a), scree_box_reach(scree_overlap_body_box(setup->posed + 1, 0)));
    const scree_box box_b = scree_overlap_body_box(setup->posed + 1, 16 * SCREE_REAL_EPSILON * size);
    setup->size = size;
    // what they share
    setup->box[0].lower = scree_vec3_max(box_a.lower, box_b.lower);
    setup->box[0].upper = scree_vec3_min(box_a.upper, box_b.upper);
    setup->extents[0] = scree_box_extent(box_a);
    setup->extents[1] = scree_box_extent(pair->shape[1]->box) * (pair->pose[1]->scale / pair->pose[0]->scale);
    return scree_box_overlaps(box_a, box_b);
}

/// The frame, and both boxes turned and shifted to the middle of what they share.
SCREE_FN_APART void scree_overlap_set_up_frame(scree_overlap_setup *setup, scree_vec3 direction)
{
    setup->frame = scree_overlap_frame_make(&setup->pose, direction, scree_box_middle(setup->box[0]));
    setup->direction = scree_frame_turn(&setup->frame, direction);
    for (int32_t side = 0; side < 2; ++side)
    {
        setup->posed[side].rows = setup->frame.rows[side];
        setup->posed[side].offset = setup->frame.offset[side];
        setup->box[side] = scree_overlap_body_box(setup->posed + side, 32 * SCREE_REAL_EPSILON * setup->size);
    }
}

/// Fewer triangles than this of both bodies together are kept anyway.
#define SCREE_TURN_FROM 24

/// Half-spaces along the direction that is known, if it is within 70 degrees of z. What a half-space drops counts zero,
/// and so few triangles are gone through in their order whichever are kept, so no result depends on it. Shapes with a
/// tree may keep more than SCREE_INDEX_MAX, and have a direction that was searched for.
SCREE_FN_APART void scree_overlap_turn_half_spaces(scree_overlap_setup *setup, const scree_pose *pose_a)
{
    const scree_shape_view *a = setup->posed[0].shape, *b = setup->posed[1].shape;
    if (scree_filter_uses_tree(a) || scree_filter_uses_tree(b) || a->num_triangles + b->num_triangles < SCREE_TURN_FROM)
        return;
    const scree_mat3 rotation = scree_mat3_from_quat(pose_a->orientation);
    const scree_vec3 own = scree_mat3_apply_transposed(rotation, setup->known);
    const scree_vec3 turned = scree_frame_turn(&setup->frame, own);
    if (turned.z > 0 && turned.z * turned.z > (scree_real)0.12 * scree_vec3_dot(turned, turned))
        setup->direction = turned;
}

/// Frame and boxes. False if the boxes are apart.
SCREE_FN bool scree_overlap_set_up(const scree_overlap_pair *pair, scree_overlap_setup *setup)
{
    if (!scree_overlap_set_up_boxes(*pair, setup)) return false;
    const scree_vec3 direction = scree_overlap_direction(pair->shape[0], pair->shape[1], &setup->pose);
    scree_overlap_set_up_frame(setup, direction);
    scree_overlap_turn_half_spaces(setup, pair->pose[0]);
    return true;
}

/// How far a body reaches along a direction, or a little more; loads its vertices unless it uses its tree.
SCREE_FN scree_real scree_overlap_load(const scree_team *team, scree_overlap_body *body, const scree_posed_shape *posed,
                                       scree_vec3 direction)
{
    if (!scree_filter_uses_tree(posed->shape)) return scree_filter_load_all(*team, body, posed, direction);
    const scree_vec3 turned = scree_mat3_apply_transposed(posed->rows, direction);
    const scree_real reach = scree_support_bound(posed->shape->support_map, turned, posed->shape->bounding_radius);
    return reach + scree_vec3_dot(direction, posed->offset);
}

/// Half-spaces: how far A reaches along the direction, and how far B reaches back. False if they are apart.
SCREE_FN bool scree_overlap_half_spaces(const scree_team *team, scree_overlap_slice *slice)
{
    const scree_overlap_setup *setup = &slice->setup;
    const scree_vec3 d = setup->direction;
    const scree_real size = scree_max(scree_box_reach(setup->box[0]), scree_box_reach(setup->box[1]));
    const scree_real rounding = 64 * SCREE_REAL_EPSILON * size * (scree_abs(d.x) + scree_abs(d.y) + scree_abs(d.z));
    scree_real both = 0;
    for (int32_t side = 0; side < 2; ++side)
    {
        const int32_t other = 1 - side;
        const scree_vec3 direction = side == 0 ? scree_vec3_negate(d) : d;
        const scree_real reach =
            scree_overlap_load(team, slice->body + other, setup->posed + other, direction) + rounding;
        both += reach;
        if (!scree_team_leads(team)) continue;
        slice->region[side].direction = direction;
        slice->region[side].is_of_a = side == 0;
        slice->region[side].reach = reach;
    }
    if (scree_team_leads(team)) slice->tolerance = SCREE_SIGN_MARGIN * SCREE_REAL_EPSILON * size;
    return both >= 0;
}

/// Keeps the triangles of one body that reach into its region, of which the box is that of the other body. False: none,
/// or slice->lack is set.
SCREE_FN bool scree_overlap_keep(const scree_team *team, scree_overlap_slice *slice, int32_t side, const scree_box *box)
{
    scree_overlap_body *body = slice->body + side;
    const scree_posed_shape *posed = slice->setup.posed + side;
    scree_filter_region *region = slice->region + side;
    scree_team_sync(team);
    if (scree_team_leads(team)) region->box = *box;
    scree_team_sync(team);
    if (!scree_filter_uses_tree(posed->shape)) scree_filter_all(*team, body, posed->shape, region->reach);
    else
    {
        // places of vertices are given as they are found: one lane
        bool has_room = true;
        if (scree_team_leads(team))
            has_room = scree_filter_tree(body, posed, region, slice->setup.box[side], &slice->walk);
        if (scree_team_any(team, !has_room))
        {
            if (scree_team_leads(team)) slice->lack = SCREE_LACK_PIECES;
            scree_team_sync(team);
            return false;
        }
        scree_team_sync(team);
    }
    scree_filter_clip(*team, body, region, slice->tolerance);
    return body->num_triangles > 0;
}

/// Kept triangles of both, once slice->setup is there. False: none of one body, or slice->lack is set.
SCREE_FN bool scree_overlap_filter(const scree_team *team, scree_overlap_slice *slice)
{
    if (scree_team_leads(team))
        for (int32_t side = 0; side < 2; ++side) scree_filter_check_room(slice, side, slice->setup.posed[side].shape);
    scree_team_sync(team);
    if (slice->lack != SCREE_LACK_NOTHING || !scree_overlap_half_spaces(team, slice)) return false;

    // B against A's box, A against what was kept of B, and B again against what was kept of A
    if (!scree_overlap_keep(team, slice, 1, slice->setup.box)) return false;
    if (!scree_overlap_keep(team, slice, 0, &slice->body[1].box)) return false;
    if (scree_team_leads(team)) slice->region[1].box = slice->body[0].box;
    scree_team_sync(team);
    scree_filter_again(*team, slice->body + 1, slice->region + 1);
    return slice->body[1].num_triangles > 0;
}

/// Triangles ready for the tests of a scheme.
SCREE_FN void scree_overlap_prepare(const scree_team *team, scree_overlap_slice *slice, scree_overlap_scheme scheme)
{
    if (scree_team_leads(team))
    {
        slice->sign_tolerance = scheme == SCREE_OVERLAP_FILTERED ? slice->tolerance : 0;
        const scree_box a = slice->body[0].box;
        const scree_box b = slice->body[1].box;
        slice->common.lower = scree_vec3_max(a.lower, b.lower);
        slice->common.upper = scree_vec3_min(a.upper, b.upper);
    }
    for (int32_t side = 0; side < 2; ++side) scree_filter_enter(team, slice->body + side);
}

SCREE_FN scree_overlap_result scree_overlap_nothing(scree_overlap_status status)
{
    scree_overlap_result result;
    result.volume = 0;
    result.area_vector = scree_vec3_zero();
    result.torque_vector = scree_vec3_zero();
    result.arm = scree_vec3_zero();
    result.normal = scree_vec3_zero();
    result.indentation = 0;
    result.radius = 0;
    result.residual = 0;
    result.status = status;
    result.used_fallback = false;
    return result;
}

/// Below this volume, in units of A, the normal means nothing: 10 eps L l^2, or less for an overlap of small area.
SCREE_FN bool scree_overlap_has_normal(const scree_overlap_setup *setup, const scree_overlap_sums *sums)
{
    const scree_real larger = scree_max(setup->extents[0], setup->extents[1]);
    const scree_real smaller = scree_min(setup->extents[0], setup->extents[1]);
    const scree_real volume = sums->six_volume / 6;
    const scree_real unit = SCREE_REAL_EPSILON * larger;
    if (volume <= 10 * unit * smaller * smaller && volume <= 1000 * unit * sums->area) return false;
    return scree_vec3_length(sums->area_vector) / 2 > 64 * unit * smaller &&
           scree_vec3_length(sums->area_vector) / 2 > 64 * SCREE_REAL_EPSILON * sums->area;
}

/// Sums to a result in world axes.
SCREE_FN_APART scree_overlap_result scree_overlap_to_world(const scree_overlap_slice *slice, const scree_pose *pose_a)
{
    const scree_overlap_setup *setup = &slice->setup;
    const scree_overlap_sums *sums = &slice->sums;
    scree_overlap_result result = scree_overlap_nothing(SCREE_OVERLAP_NONE);
    const scree_real scale = pose_a->scale;
    const scree_real volume = sums->six_volume / 6;
    result.residual = sums->residual;
    result.volume = volume * scale * scale * scale;
    if (!(volume > 0)) return result;

    // the centroid lies in the box of the points, whatever noise says
    scree_vec3 centre = scree_vec3_add_scaled(sums->middle, sums->moment, 1 / (4 * sums->six_volume));
    centre = scree_vec3_max(sums->box.lower, scree_vec3_min(sums->box.upper, centre));
    const scree_mat3 rotation = scree_mat3_from_quat(pose_a->orientation);
    const scree_vec3 arm = scree_frame_turn_back(&setup->frame, scree_vec3_add(centre, setup->frame.shift));
    result.arm = scree_vec3_scale(scree_mat3_apply(rotation, arm), scale);
    const scree_vec3 area_vector = scree_mat3_apply(rotation, scree_frame_turn_back(&setup->frame, sums->area_vector));
    result.area_vector = scree_vec3_scale(area_vector, scale * scale / 2);
    const scree_vec3 twice_turned = scree_vec3_cross(scree_vec3_sub(sums->middle, centre), sums->area_vector);
    const scree_vec3 torque =
        scree_vec3_add_scaled(scree_vec3_scale(twice_turned, (scree_real)0.5), sums->torque, (scree_real)(-1.0 / 6));
    result.torque_vector = scree_vec3_scale(scree_mat3_apply(rotation, scree_frame_turn_back(&setup->frame, torque)),
                                            scale * scale * scale);
    result.status = SCREE_OVERLAP_NO_NORMAL;
    if (!scree_overlap_has_normal(setup, sums)) return result;

    const scree_vec3 n = scree_vec3_scale(sums->area_vector, 1 / scree_vec3_length(sums->area_vector));
    result.status = SCREE_OVERLAP_TOUCHING;
    result.normal = scree_vec3_scale(area_vector, 1 / scree_vec3_length(area_vector));
    result.indentation = scale * scree_overlap_extent_along(slice, sums->middle, n);
    result.radius = scale * scree_overlap_radius_about(slice, centre, n);
    return result;
}

/// Kept triangles, crossings and sums of all, by the default scheme and once more by the hierarchy if its certificate
/// says so. The status is TOUCHING if there is something, whatever it is.
SCREE_FN scree_overlap_status scree_overlap_find(const scree_team *team, const scree_overlap_pair *pair,
                                                 const scree_overlap_options *options, scree_overlap_slice *slice)
{
    if (scree_overlap_spheres_apart(pair)) return SCREE_OVERLAP_NONE;
    scree_team_sync(team);
    bool may_touch = true;
    if (scree_team_leads(team))
    {
        slice->lack = SCREE_LACK_NOTHING;
        slice->used_fallback = false;
        for (int32_t side = 0; side < 2; ++side) slice->shape[side] = pair->shape[side];
        may_touch = scree_overlap_set_up(pair, &slice->setup);
    }
    if (scree_team_any(team, !may_touch)) return SCREE_OVERLAP_NONE;
    scree_team_sync(team);
    if (!scree_overlap_filter(team, slice))
        return slice->lack != SCREE_LACK_NOTHING ? SCREE_OVERLAP_WORKSPACE_FULL : SCREE_OVERLAP_NONE;
    scree_overlap_scheme scheme = options->scheme;
    for (;;)
    {
        scree_overlap_prepare(team, slice, scheme);
        bool is_simple = scheme == SCREE_OVERLAP_FILTERED && options->use_convex_path && slice->shape[0]->is_convex &&
                         slice->shape[1]->is_convex;
        if (is_simple)
        {
            if (scree_team_leads(team)) is_simple = scree_convex_collect(slice, slice->shape);
            is_simple = !scree_team_any(team, !is_simple);
            scree_team_sync(team);
            if (!is_simple) scree_overlap_prepare(team, slice, scheme);
        }
        if (!is_simple && !scree_overlap_collect(team, slice, slice->shape)) return SCREE_OVERLAP_WORKSPACE_FULL;
        if (scree_team_leads(team)) slice->num_patches = 1;
        scree_overlap_sum(team, slice, slice->shape, 0, &slice->sums);
        if (scree_team_leads(team) && !slice->is_closed) slice->sums.residual = scree_max(slice->sums.residual, 1);
        scree_team_sync(team);
        if (scheme == SCREE_OVERLAP_HIERARCHY || slice->sums.residual <= SCREE_RESIDUAL_LIMIT)
            return SCREE_OVERLAP_TOUCHING;
        scree_team_sync(team);
        scheme = SCREE_OVERLAP_HIERARCHY;
        if (scree_team_leads(team)) slice->used_fallback = true;
    }
}

/// Results of the patches, one after the other; the first max_results are written. Returns their number. Of one lane.
SCREE_FN_APART int32_t scree_overlap_patch_results(scree_overlap_slice *slice, const scree_pose *pose_a,
                                                   scree_overlap_result *results, int32_t max_results)
{
    const scree_team team = scree_team_alone();
    int32_t num = 0;
    for (int32_t patch = 0; patch < slice->num_patches; ++patch)
    {
        scree_overlap_sum(&team, slice, slice->shape, patch, &slice->sums);
        const scree_overlap_result result = scree_overlap_to_world(slice, pose_a);
        // pieces without volume are noise
        if (result.status == SCREE_OVERLAP_NONE && num + slice->num_patches - patch > 1) continue;
        if (num < max_results) results[num] = result;
        ++num;
    }
    return num;
}

/// Overlap of a pair: one result, or one per patch, of which the first max_results are written. Returns their number,
/// to lane 0. Filter, pairs of triangles and sums over segments are shared among the lanes; the walk over a tree, the
/// convex path, inside counts, sums over edges of one body, patches and results are lane 0's.
SCREE_FN int32_t scree_overlap_team_compute(const scree_team *team, const scree_overlap_pair *pair,
                                            const scree_overlap_options *options, scree_overlap_slice *slice,
                                            scree_overlap_result *results, int32_t max_results)
{
    const scree_overlap_status status = scree_overlap_find(team, pair, options, slice);
    // all have read the sums, which those of patches take the place of
    scree_team_sync(team);
    if (!scree_team_leads(team)) return 1;
    results[0] = scree_overlap_nothing(status);
    if (status != SCREE_OVERLAP_TOUCHING) return 1;
    int32_t num = 1;
    if (options->separate_patches && scree_overlap_find_patches(slice) > 1)
        num = scree_overlap_patch_results(slice, pair->pose[0], results, max_results);
    else results[0] = scree_overlap_to_world(slice, pair->pose[0]);
    for (int32_t i = 0; i < num && i < max_results; ++i) results[i].used_fallback = slice->used_fallback;
    return num;
}

SCREE_FN int32_t scree_overlap_pair_compute(const scree_overlap_pair *pair, const scree_overlap_options *options,
                                            scree_overlap_slice *slice, scree_overlap_result *results,
                                            int32_t max_results)
{
    const scree_team team = scree_team_alone();
    return scree_overlap_team_compute(&team, pair, options, slice, results, max_results);
}

#endif
