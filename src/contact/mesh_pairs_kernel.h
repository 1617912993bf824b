/// \file mesh_pairs_kernel.h
/// Candidate pairs of two meshes to contacts: which may touch at all, what came of their overlaps, and the contacts to
/// the list. The overlaps themselves are computed in overlap_pairs_kernel.h.
#ifndef SCREE_MESH_PAIRS_KERNEL_H
#define SCREE_MESH_PAIRS_KERNEL_H

#include "contact/narrow_phase.h"
#include "contact/pair_tally.h"
#include "contact/separating_direction_kernel.h"

/// What is remembered of a candidate pair from step to step.
typedef struct scree_pair_memory
{
    scree_vec3 direction;   ///< that separated it last time, or zero
    scree_real apart_until; ///< [m] sum of the travels of both bodies up to which it cannot touch
    bool was_touching;      ///< at the last look
} scree_pair_memory;

typedef struct scree_mesh_pairs_args
{
    scree_bodies bodies;
    const scree_candidate_pair *pairs; ///< (num_pairs) all candidate pairs
    const int32_t *batch;              ///< (num in batch) indices of those of two meshes
    scree_pair_memory *memory;         ///< (num in batch)
    int32_t *active;                   ///< (num in batch) entries that may touch, in any order
    scree_overlap_result *results;     ///< (num in batch, max_results)
    int32_t *num_results;              ///< (num in batch) as computed, may exceed max_results
    int32_t max_results;
    scree_contact_list list; ///< number of contacts to first_of_pair; geometry by the last kernel
    scree_pair_tally *tally;
    scree_separation_use use;
} scree_mesh_pairs_args;

typedef scree_mesh_pairs_args scree_mesh_apart_args;
typedef scree_mesh_pairs_args scree_mesh_write_args;

/// Is the pair known to be apart, or found to be so now? The answer is proven, never a guess.
SCREE_FN bool scree_pair_is_apart(const scree_bodies *bodies, scree_candidate_pair pair, scree_pair_memory *memory,
                                  scree_separation_use use)
{
    if (!use.finds) return false;
    const scree_real travelled = bodies->travel[pair.i] + bodies->travel[pair.j];
    if (use.bounds && travelled < memory->apart_until) return true;
    if (!use.remembers) memory->direction = scree_vec3_zero();
    // contacts mostly last; the search would be in vain
    else if (memory->was_touching) return false;
    const scree_real gap =
        scree_separation_search(bodies->shapes + bodies->shape[pair.i], bodies->pose + pair.i,
                                bodies->shapes + bodies->shape[pair.j], bodies->pose + pair.j, &memory->direction);
    // a hair less, for the rounding of the travels
    memory->apart_until = travelled + gap * (scree_real)0.999;
    return gap > 0;
}

/// Entry m of the batch: no contacts, or among those to be looked at.
SCREE_FN void scree_mesh_apart_at(scree_mesh_apart_args a, int64_t m)
{
    const int32_t p = a.batch[m];
    a.num_results[m] = 0;
    a.list.first_of_pair[p] = 0;
    if (scree_pair_is_apart(&a.bodies, a.pairs[p], a.memory + m, a.use)) return;
    a.active[scree_atomic_count(&a.tally->num_active, 1)] = (int32_t)m;
}

/// Notes the `num` results of entry m.
SCREE_FN void scree_mesh_pair_note(const scree_mesh_pairs_args *a, int32_t m, int32_t num)
{
    const scree_overlap_result *results = a->results + (int64_t)m * a->max_results;
    if (num > a->max_results) scree_atomic_max(&a->tally->most_results, (scree_real)num);
    a->num_results[m] = num;
    a->memory[m].was_touching = results[0].status != SCREE_OVERLAP_NONE;
    int64_t num_contacts = 0;
    for (int32_t r = 0; r < num && r < a->max_results; ++r)
    {
        if (results[r].status == SCREE_OVERLAP_NO_NORMAL) scree_atomic_count(&a->tally->num_without_normal, 1);
        if (results[r].status != SCREE_OVERLAP_TOUCHING) continue;
        ++num_contacts;
        if (results[r].used_fallback) scree_atomic_count(&a->tally->num_fallbacks, 1);
        scree_atomic_max(&a->tally->worst_residual, results[r].residual);
    }
    a->list.first_of_pair[a->batch[m]] = num_contacts;
}

/// Touching results of entry m to the list.
SCREE_FN void scree_mesh_write_at(scree_mesh_write_args a, int64_t m)
{
    const int32_t p = a.batch[m];
    const int64_t begin = a.list.first_of_pair[p];
    int64_t c = begin;
    for (int32_t r = 0; r < a.num_results[m]; ++r)
    {
        const scree_overlap_result *result = a.results + m * a.max_results + r;
        if (result->status != SCREE_OVERLAP_TOUCHING) continue;
        a.list.bodies[c] = a.pairs[p];
        a.list.patch[c] = (int32_t)(c - begin);
        a.list.volume[c] = result->volume;
        a.list.indentation[c] = result->indentation;
        a.list.radius[c] = result->radius;
        a.list.normal[c] = scree_vec3_negate(result->normal);
        a.list.area_vector[c] = result->area_vector;
        a.list.torque_vector[c] = result->torque_vector;
        a.list.arm[c] = result->arm;
        ++c;
    }
}

#endif
