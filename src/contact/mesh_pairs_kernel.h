/// \file mesh_pairs_kernel.h
/// Candidate pairs of two meshes to contacts: which may touch at all, what came of their overlaps, and the contacts to
/// the list. The overlaps themselves are computed in overlap_pairs_kernel.h.
#ifndef SCREE_MESH_PAIRS_KERNEL_H
#define SCREE_MESH_PAIRS_KERNEL_H

#include "contact/mesh_gap_kernel.h"
#include "contact/pair_memory_kernel.h"
#include "contact/pair_tally.h"
#include "contact/separating_direction_kernel.h"

/// What the list takes of an overlap, until its place there is known.
typedef struct scree_kept_overlap
{
    scree_vec3 normal, arm;
    scree_real volume, indentation, radius;
} scree_kept_overlap;

/// The same, where a law asks for the shape of the overlap.
typedef struct scree_kept_lever
{
    scree_vec3 area_vector, torque_vector;
} scree_kept_lever;

/// On the CPU: a range of the batch, as many as threads. Each thread begins with its own, so that from step to step it
/// mostly meets the bodies that it had before, and helps the others when that is done. The active entries of a range
/// lie in `active` from its beginning on.
typedef struct scree_pair_share
{
    int64_t begin, end; ///< entries
    int64_t num_looked; ///< of these, looked at by somebody
    int64_t num_active[SCREE_NUM_WORK_CLASSES];
    int64_t num_taken[SCREE_NUM_WORK_CLASSES]; ///< active entries that somebody has taken up
    int64_t between[8];                        ///< a line of the caches
} scree_pair_share;

typedef struct scree_mesh_pairs_args
{
    scree_bodies bodies;
    const scree_candidate_pair *pairs; ///< (num_pairs) all candidate pairs
    const int32_t *batch;              ///< (num in batch) indices of those of two meshes; NULL: all
    scree_pair_memory *memory;         ///< (num in batch)
    int32_t *active; ///< (classes.last - classes.first + 1, max_active) entries that may touch, by class, in any order
    int64_t max_active;
    scree_pair_share *shares; ///< (num_shares) on the CPU
    int32_t num_shares;
    scree_work_classes classes;
    scree_kept_overlap *kept;      ///< (max_kept) overlaps of all entries that touch; of one entry in order
    scree_kept_lever *kept_levers; ///< (max_kept) or NULL if the list has none
    int64_t max_kept;
    int32_t *first_kept;     ///< (num in batch) place of the first one of an entry that touches
    scree_contact_list list; ///< number of contacts to first_of_pair; geometry by the last kernel
    scree_pair_tally *tally;
    scree_separation_use use;
} scree_mesh_pairs_args;

/// A gap costs several looks at its pair. So it must last for some steps to be kept, and is looked for right after a
/// search of candidates, and then only in every eighth step, another one for each pair: bodies that flow past each
/// other use up one gap after the other.
#define SCREE_GAP_LASTS 4
#define SCREE_GAP_EVERY 8

typedef scree_mesh_pairs_args scree_mesh_apart_args;
typedef scree_mesh_pairs_args scree_mesh_gap_args;
typedef scree_mesh_pairs_args scree_mesh_write_args;

/// Class of a pair by the triangles of both bodies together. Few lanes where few triangles are kept, so that more pairs
/// are under way at once; no result depends on it.
SCREE_FN int32_t scree_work_class(int32_t num_triangles)
{
    return num_triangles < 2 * SCREE_LARGE_SHAPE ? 0 : num_triangles < 512 ? 1 : 2;
}
/// Lanes of a team for it.
SCREE_FN int32_t scree_work_num_lanes(int32_t work_class) { return 8 << work_class; }

SCREE_FN int32_t scree_work_class_of_pair(const scree_mesh_pairs_args *a, scree_candidate_pair pair)
{
    if (a->classes.first == a->classes.last) return a->classes.first;
    const int32_t work_class = scree_work_class(a->bodies.shapes[a->bodies.shape[pair.i]].num_triangles +
                                                a->bodies.shapes[a->bodies.shape[pair.j]].num_triangles);
    return work_class < a->classes.first  ? a->classes.first
           : work_class > a->classes.last ? a->classes.last
                                          : work_class;
}

/// Active entries of a class.
SCREE_FN int32_t *scree_active_of_class(const scree_mesh_pairs_args *a, int32_t work_class)
{
    return a->active + (work_class - a->classes.first) * a->max_active;
}

/// Is the pair known to be apart, or found to be so now? The answer is proven, never a guess.
SCREE_FN bool scree_pair_is_apart(const scree_bodies *bodies, scree_candidate_pair pair, scree_pair_memory *memory,
                                  scree_separation_use use)
{
    if (!use.finds) return false;
    const scree_real travelled = bodies->travel[pair.i] + bodies->travel[pair.j];
    if (use.bounds && travelled < (scree_real)memory->apart_until) return true;
    // contacts mostly last; the search would be in vain
    if (use.remembers && memory->apart_until < 0) return false;
    scree_vec3 direction = use.remembers ? scree_unpack_direction(memory->direction) : scree_vec3_zero();
    const scree_real gap =
        scree_separation_search(bodies->shapes + bodies->shape[pair.i], bodies->pose + pair.i,
                                bodies->shapes + bodies->shape[pair.j], bodies->pose + pair.j, &direction);
    if (gap > 0) scree_pack_direction(direction, memory->direction);
    memory->apart_until = gap > 0 ? scree_apart_until(travelled, gap) : 0;
    return gap > 0;
}

/// Entry m of the batch: no contacts and -1, or the class of those to be looked at.
SCREE_FN int32_t scree_class_if_active(const scree_mesh_apart_args *a, int64_t m)
{
    const int32_t p = scree_pair_of_batch(a->batch, m);
    a->list.first_of_pair[p] = 0;
    if (scree_pair_is_apart(&a->bodies, a->pairs[p], a->memory + m, a->use)) return -1;
    return scree_work_class_of_pair(a, a->pairs[p]);
}

/// Entry m to those of its class, if it may touch.
SCREE_FN void scree_mesh_apart_at(scree_mesh_apart_args a, int64_t m)
{
    const int32_t work_class = scree_class_if_active(&a, m);
    if (work_class < 0) return;
    scree_active_of_class(&a, work_class)[scree_atomic_count(a.tally->num_active + work_class, 1)] = (int32_t)m;
}

SCREE_FN void scree_keep_overlap(const scree_mesh_pairs_args *a, int64_t k, const scree_overlap_result *result)
{
    scree_kept_overlap *kept = a->kept + k;
    kept->normal = scree_vec3_negate(result->normal);
    kept->arm = result->arm;
    kept->volume = result->volume;
    kept->indentation = result->indentation;
    kept->radius = result->radius;
    if (!a->kept_levers) return;
    a->kept_levers[k].area_vector = result->area_vector;
    a->kept_levers[k].torque_vector = result->torque_vector;
}

/// Direction out of i into j along which a pair that touched overlapped little, or zero.
SCREE_FN scree_vec3 scree_known_direction(const scree_mesh_pairs_args *a, int32_t m)
{
    const bool is_known = a->use.remembers && a->memory[m].apart_until < 0;
    return is_known ? scree_unpack_direction(a->memory[m].direction) : scree_vec3_zero();
}

SCREE_FN bool scree_is_pair_lost(const scree_mesh_pairs_args *a, int32_t m, const scree_overlap_result *result)
{
    const scree_candidate_pair pair = a->pairs[scree_pair_of_batch(a->batch, m)];
    const scree_bodies *bodies = &a->bodies;
    return scree_overlap_is_lost(result,
                                 bodies->shapes[bodies->shape[pair.i]].bounding_radius * bodies->pose[pair.i].scale,
                                 bodies->shapes[bodies->shape[pair.j]].bounding_radius * bodies->pose[pair.j].scale);
}

/// Notes the `num` results of entry m, and keeps those that touch as far as there is room.
SCREE_FN void scree_mesh_pair_note(const scree_mesh_pairs_args *a, int32_t m, const scree_overlap_result *results,
                                   int32_t num)
{
    int32_t num_contacts = 0;
    for (int32_t r = 0; r < num; ++r)
    {
        if (results[r].status == SCREE_OVERLAP_NO_NORMAL && scree_is_pair_lost(a, m, results + r))
            scree_atomic_count(&a->tally->num_without_normal, 1);
        if (results[r].status != SCREE_OVERLAP_TOUCHING) continue;
        ++num_contacts;
        if (results[r].used_fallback) scree_atomic_count(&a->tally->num_fallbacks, 1);
        scree_atomic_max(&a->tally->worst_residual, results[r].residual);
    }
    a->memory[m].apart_until = results[0].status != SCREE_OVERLAP_NONE ? SCREE_PAIR_TOUCHED : 0;
    if (results[0].status == SCREE_OVERLAP_TOUCHING) scree_pack_direction(results[0].normal, a->memory[m].direction);
    a->list.first_of_pair[scree_pair_of_batch(a->batch, m)] = num_contacts;
    if (num_contacts == 0) return;
    int64_t k = scree_atomic_count(&a->tally->num_kept, num_contacts);
    if (k + num_contacts > a->max_kept) return;
    a->first_kept[m] = (int32_t)k;
    for (int32_t r = 0; r < num; ++r)
        if (results[r].status == SCREE_OVERLAP_TOUCHING) scree_keep_overlap(a, k++, results + r);
}

/// Entry m once its overlap is known: if nothing overlaps and no plane was found between the two, how long it can stay
/// so.
SCREE_FN void scree_mesh_gap_at(scree_mesh_gap_args a, int64_t m)
{
    const int64_t num_steps = a.bodies.num_steps;
    if (a.memory[m].apart_until != 0 || (num_steps > 0 && (num_steps + m) % SCREE_GAP_EVERY != 0)) return;
    const scree_candidate_pair pair = a.pairs[scree_pair_of_batch(a.batch, m)];
    const scree_shape_view *shape_i = a.bodies.shapes + a.bodies.shape[pair.i];
    const scree_shape_view *shape_j = a.bodies.shapes + a.bodies.shape[pair.j];
    const scree_pose *pose_i = a.bodies.pose + pair.i, *pose_j = a.bodies.pose + pair.j;
    const bool is_larger = shape_i->num_triangles > shape_j->num_triangles;
    const scree_real travelled = a.bodies.travel[pair.i] + a.bodies.travel[pair.j];
    const scree_real useful = num_steps > 0 ? travelled / (scree_real)num_steps * SCREE_GAP_LASTS : 0;
    const scree_real gap = is_larger ? scree_mesh_gap(shape_i, pose_i, shape_j, pose_j, useful)
                                     : scree_mesh_gap(shape_j, pose_j, shape_i, pose_i, useful);
    if (gap > 0) a.memory[m].apart_until = scree_apart_until(travelled, gap);
}

/// Touching results of entry m to the list.
SCREE_FN void scree_mesh_write_at(scree_mesh_write_args a, int64_t m)
{
    const int32_t p = scree_pair_of_batch(a.batch, m);
    const int64_t begin = a.list.first_of_pair[p], end = a.list.first_of_pair[p + 1];
    for (int64_t c = begin; c < end; ++c)
    {
        const int64_t k = a.first_kept[m] + (c - begin);
        const scree_kept_overlap kept = a.kept[k];
        a.list.bodies[c] = a.pairs[p];
        a.list.patch[c] = (int32_t)(c - begin);
        a.list.volume[c] = kept.volume;
        a.list.indentation[c] = kept.indentation;
        a.list.radius[c] = kept.radius;
        a.list.normal[c] = kept.normal;
        a.list.arm[c] = kept.arm;
        if (!a.kept_levers) continue;
        a.list.area_vector[c] = a.kept_levers[k].area_vector;
        a.list.torque_vector[c] = a.kept_levers[k].torque_vector;
    }
}

#endif
