#include "contact/narrow_phase.h"

#include "contact/separating_direction_kernel.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

/// What is remembered of a candidate pair from step to step.
typedef struct pair_memory
{
    scree_vec3 direction;   ///< that separated it last time, or zero
    scree_real apart_until; ///< [m] sum of the travels of both bodies up to which it cannot touch
    bool was_touching;      ///< at the last look
} pair_memory;

/// Results of the pairs before they are compacted into the list.
struct scree_narrow_phase_buffers
{
    scree_overlap_workspace **workspaces; ///< (num_workspaces) one per thread
    scree_narrow_phase_counts *counts;    ///< (num_workspaces)
    int num_workspaces;
    scree_overlap_result *results; ///< (max_pairs, max_results)
    int32_t *num_results;          ///< (max_pairs) as computed, may exceed max_results
    pair_memory *memory;           ///< (max_pairs)
    int64_t num_remembered;        ///< pairs whose memory holds; 0: none
    int64_t max_pairs;
    int32_t max_results; ///< per pair
};

void scree_narrow_phase_destroy(scree_narrow_phase *narrow_phase)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    if (b != NULL)
    {
        for (int t = 0; t < b->num_workspaces; ++t) scree_overlap_workspace_destroy(b->workspaces[t]);
        free(b->workspaces);
        free(b->counts);
        free(b->results);
        free(b->num_results);
        free(b->memory);
        free(b);
    }
    *narrow_phase = (scree_narrow_phase){0};
}

/// One workspace per thread.
static scree_status reserve_workspaces(struct scree_narrow_phase_buffers *b, int num_threads)
{
    if (b->num_workspaces >= num_threads) return SCREE_OK;
    scree_overlap_workspace **workspaces = realloc(b->workspaces, (size_t)num_threads * sizeof *workspaces);
    if (workspaces == NULL) return SCREE_OUT_OF_MEMORY;
    b->workspaces = workspaces;
    scree_narrow_phase_counts *counts = realloc(b->counts, (size_t)num_threads * sizeof *counts);
    if (counts == NULL) return SCREE_OUT_OF_MEMORY;
    b->counts = counts;
    while (b->num_workspaces < num_threads)
    {
        workspaces[b->num_workspaces] = scree_overlap_workspace_create();
        if (workspaces[b->num_workspaces] == NULL) return SCREE_OUT_OF_MEMORY;
        ++b->num_workspaces;
    }
    return SCREE_OK;
}

static scree_status reserve_results(struct scree_narrow_phase_buffers *b, int64_t num_pairs, int32_t max_results)
{
    if (num_pairs <= b->max_pairs && max_results <= b->max_results) return SCREE_OK;
    const int64_t max_pairs = num_pairs > b->max_pairs ? num_pairs + num_pairs / 2 + 16 : b->max_pairs;
    if (max_results < b->max_results) max_results = b->max_results;
    scree_overlap_result *results = malloc((size_t)max_pairs * (size_t)max_results * sizeof *results);
    int32_t *num_results = malloc((size_t)max_pairs * sizeof *num_results);
    pair_memory *memory = malloc((size_t)max_pairs * sizeof *memory);
    if (results == NULL || num_results == NULL || memory == NULL)
    {
        free(results);
        free(num_results);
        free(memory);
        return SCREE_OUT_OF_MEMORY;
    }
    free(b->results);
    free(b->num_results);
    free(b->memory);
    b->results = results;
    b->num_results = num_results;
    b->memory = memory;
    b->num_remembered = 0;
    b->max_pairs = max_pairs;
    b->max_results = max_results;
    return SCREE_OK;
}

/// Is the pair known to be apart, or found to be so now? The answer is proven, never a guess.
static bool is_apart(const scree_bodies *bodies, scree_candidate_pair pair, pair_memory *memory)
{
    const scree_real travelled = bodies->travel[pair.i] + bodies->travel[pair.j];
    if (travelled < memory->apart_until) return true;
    // contacts mostly last; the search would be in vain
    if (memory->was_touching) return false;
    const scree_real gap =
        scree_separation_search(bodies->shapes + bodies->shape[pair.i], bodies->pose + pair.i,
                                bodies->shapes + bodies->shape[pair.j], bodies->pose + pair.j, &memory->direction);
    // a hair less, for the rounding of the travels
    memory->apart_until = travelled + gap * (scree_real)0.999;
    return gap > 0;
}

/// One candidate pair: overlap, as often as the workspace has to grow, and the counts of this thread.
static scree_status find_pair(scree_narrow_phase *narrow_phase, const scree_bodies *bodies, scree_candidate_pair pair,
                              int64_t p, int thread)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    scree_overlap_result *results = b->results + p * b->max_results;
    b->num_results[p] = 0;
    if (is_apart(bodies, pair, b->memory + p)) return SCREE_OK;
    const scree_shape_view *shape_i = bodies->shapes + bodies->shape[pair.i];
    const scree_shape_view *shape_j = bodies->shapes + bodies->shape[pair.j];
    int32_t num;
    for (;;)
    {
        num = scree_overlap_compute(shape_i, bodies->pose + pair.i, shape_j, bodies->pose + pair.j,
                                    &narrow_phase->options, b->workspaces[thread], results, b->max_results);
        if (num == 0 || results[0].status != SCREE_OVERLAP_WORKSPACE_FULL) break;
        if (scree_overlap_workspace_grow(b->workspaces[thread]) != SCREE_OK) return SCREE_OUT_OF_MEMORY;
    }
    scree_narrow_phase_counts *counts = b->counts + thread;
    b->num_results[p] = num;
    b->memory[p].was_touching = num > 0 && results[0].status != SCREE_OVERLAP_NONE;
    for (int32_t r = 0; r < num && r < b->max_results; ++r)
    {
        counts->num_without_normal += results[r].status == SCREE_OVERLAP_NO_NORMAL;
        if (results[r].status != SCREE_OVERLAP_TOUCHING) continue;
        counts->num_fallbacks += results[r].used_fallback;
        counts->worst_residual = scree_max(counts->worst_residual, results[r].residual);
        counts->largest_indentation = scree_max(counts->largest_indentation, results[r].indentation);
    }
    return SCREE_OK;
}

void scree_narrow_phase_forget(scree_narrow_phase *narrow_phase)
{
    if (narrow_phase->buffers != NULL) narrow_phase->buffers->num_remembered = -1;
}

static scree_status find_all(scree_narrow_phase *narrow_phase, const scree_bodies *bodies,
                             const scree_candidate_pair *pairs, int64_t num_pairs)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    for (int t = 0; t < b->num_workspaces; ++t) b->counts[t] = (scree_narrow_phase_counts){0};
    if (b->num_remembered != num_pairs) memset(b->memory, 0, (size_t)num_pairs * sizeof *b->memory);
    b->num_remembered = num_pairs;
    int has_failed = 0;
#pragma omp parallel for schedule(dynamic, 8) reduction(| : has_failed) if (num_pairs >= 16)
    for (int64_t p = 0; p < num_pairs; ++p)
        has_failed |= find_pair(narrow_phase, bodies, pairs[p], p, omp_get_thread_num()) != SCREE_OK;

    // sums of integers and maxima do not depend on which thread met what
    scree_narrow_phase_counts total = {0};
    for (int t = 0; t < b->num_workspaces; ++t)
    {
        total.num_without_normal += b->counts[t].num_without_normal;
        total.num_fallbacks += b->counts[t].num_fallbacks;
        total.worst_residual = scree_max(total.worst_residual, b->counts[t].worst_residual);
        total.largest_indentation = scree_max(total.largest_indentation, b->counts[t].largest_indentation);
    }
    narrow_phase->counts = total;
    return has_failed ? SCREE_OUT_OF_MEMORY : SCREE_OK;
}

/// Touching results of the pairs to the list, in the order of the pairs.
static scree_status compact(const struct scree_narrow_phase_buffers *b, const scree_candidate_pair *pairs,
                            int64_t num_pairs, scree_contact_list *list)
{
    scree_status status = scree_contact_list_reserve(list, 0, num_pairs);
    if (status != SCREE_OK) return status;
    int64_t num_contacts = 0;
    for (int64_t p = 0; p < num_pairs; ++p)
    {
        list->first_of_pair[p] = num_contacts;
        for (int32_t r = 0; r < b->num_results[p]; ++r)
            num_contacts += b->results[p * b->max_results + r].status == SCREE_OVERLAP_TOUCHING;
    }
    list->first_of_pair[num_pairs] = num_contacts;
    status = scree_contact_list_reserve(list, num_contacts, num_pairs);
    if (status != SCREE_OK) return status;
    list->num_contacts = num_contacts;

#pragma omp parallel for schedule(static) if (num_pairs >= 1024)
    for (int64_t p = 0; p < num_pairs; ++p)
    {
        int64_t c = list->first_of_pair[p];
        for (int32_t r = 0; r < b->num_results[p]; ++r)
        {
            const scree_overlap_result *result = b->results + p * b->max_results + r;
            if (result->status != SCREE_OVERLAP_TOUCHING) continue;
            list->bodies[c] = pairs[p];
            list->patch[c] = (int32_t)(c - list->first_of_pair[p]);
            list->volume[c] = result->volume;
            list->indentation[c] = result->indentation;
            list->radius[c] = result->radius;
            list->normal[c] = scree_vec3_negate(result->normal);
            list->area_vector[c] = result->area_vector;
            list->arm[c] = result->arm;
            ++c;
        }
    }
    return SCREE_OK;
}

scree_status scree_narrow_phase_find(scree_narrow_phase *narrow_phase, const scree_bodies *bodies,
                                     const scree_candidate_pair *pairs, int64_t num_pairs, scree_contact_list *list)
{
    if (narrow_phase->buffers == NULL)
    {
        narrow_phase->buffers = calloc(1, sizeof *narrow_phase->buffers);
        if (narrow_phase->buffers == NULL) return SCREE_OUT_OF_MEMORY;
    }
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    scree_status status = reserve_workspaces(b, omp_get_max_threads());
    int32_t max_results = narrow_phase->options.separate_patches ? 4 : 1;
    for (bool is_complete = false; !is_complete;)
    {
        if (status == SCREE_OK) status = reserve_results(b, num_pairs, max_results);
        if (status == SCREE_OK) status = find_all(narrow_phase, bodies, pairs, num_pairs);
        if (status != SCREE_OK) return status;
        // a pair with more patches than there was room for asks for a second, roomier search
        for (int64_t p = 0; p < num_pairs; ++p)
            if (b->num_results[p] > max_results) max_results = b->num_results[p];
        is_complete = max_results <= b->max_results;
    }
    return compact(b, pairs, num_pairs, list);
}
