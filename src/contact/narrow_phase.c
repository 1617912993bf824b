#include "contact/narrow_phase.h"

#include "contact/separating_direction_kernel.h"
#include "contact/sphere_pairs.h"
#include "core/buffer.h"

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

/// How the contacts of a pair are found, by the kinds of its shapes.
typedef enum pair_kind
{
    MESH_MESH,
    SPHERE_MESH, // or clump
    SPHERE_SPHERE,
    CLUMP_CLUMP, // or one of them a sphere
    NUM_PAIR_KINDS
} pair_kind;

static const pair_kind kind_of_pair[SCREE_NUM_SHAPE_KINDS][SCREE_NUM_SHAPE_KINDS] = {
    [SCREE_KIND_MESH] = {MESH_MESH, SPHERE_MESH, SPHERE_MESH},
    [SCREE_KIND_SPHERE] = {SPHERE_MESH, SPHERE_SPHERE, CLUMP_CLUMP},
    [SCREE_KIND_CLUMP] = {SPHERE_MESH, CLUMP_CLUMP, CLUMP_CLUMP}};

/// The pairs of one kind, in ascending order.
typedef struct pair_batch
{
    int32_t *pairs; ///< (num) indices of candidate pairs
    int64_t num, max;
} pair_batch;

/// Results of the pairs before they are compacted into the list. Nothing is kept for two spheres.
struct scree_narrow_phase_buffers
{
    int32_t *num_contacts; ///< (max_pairs) of each candidate pair
    int64_t max_pairs;
    int64_t num_sorted; ///< candidate pairs that the batches are made of; -1: they have changed
    pair_batch batches[NUM_PAIR_KINDS];

    // two meshes
    scree_overlap_workspace **workspaces; ///< (num_workspaces) one per thread
    scree_narrow_phase_counts *counts;    ///< (num_workspaces)
    int num_workspaces;
    scree_overlap_result *results; ///< (num in batch, max_results)
    int32_t *num_results;          ///< (num in batch) as computed, may exceed max_results
    pair_memory *memory;           ///< (num in batch)
    int64_t max_mesh_pairs;
    int32_t max_results; ///< per pair

    scree_sphere *spheres; ///< (max_bodies)
    int64_t max_bodies;

    // a sphere and a mesh
    scree_sphere_contact *found; ///< (num in batch, max_found)
    uint8_t *is_inside;          ///< (num in batch)
    int64_t max_sphere_mesh_pairs;
    int32_t max_found; ///< per pair
};

void scree_narrow_phase_destroy(scree_narrow_phase *narrow_phase)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    if (b != NULL)
    {
        for (int t = 0; t < b->num_workspaces; ++t) scree_overlap_workspace_destroy(b->workspaces[t]);
        for (int k = 0; k < NUM_PAIR_KINDS; ++k) free(b->batches[k].pairs);
        free(b->num_contacts);
        free(b->workspaces);
        free(b->counts);
        free(b->results);
        free(b->num_results);
        free(b->memory);
        free(b->spheres);
        free(b->found);
        free(b->is_inside);
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

/// Room for the results of `num` pairs of meshes. Growing forgets what is known of the pairs.
static scree_status reserve_results(struct scree_narrow_phase_buffers *b, int64_t num, int32_t max_results)
{
    if (num <= b->max_mesh_pairs && max_results <= b->max_results) return SCREE_OK;
    const int64_t max_pairs = num > b->max_mesh_pairs ? num + num / 2 + 16 : b->max_mesh_pairs;
    if (max_results < b->max_results) max_results = b->max_results;
    scree_overlap_result *results = malloc((size_t)max_pairs * (size_t)max_results * sizeof *results);
    int32_t *num_results = malloc((size_t)max_pairs * sizeof *num_results);
    pair_memory *memory = calloc((size_t)max_pairs, sizeof *memory);
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
    b->max_mesh_pairs = max_pairs;
    b->max_results = max_results;
    return SCREE_OK;
}

/// Room for what is found between `num` spheres and meshes.
static scree_status reserve_found(struct scree_narrow_phase_buffers *b, int64_t num, int32_t max_found)
{
    if (num <= b->max_sphere_mesh_pairs && max_found <= b->max_found) return SCREE_OK;
    const int64_t max_pairs = num > b->max_sphere_mesh_pairs ? num + num / 2 + 16 : b->max_sphere_mesh_pairs;
    if (max_found < b->max_found) max_found = b->max_found;
    scree_sphere_contact *found = malloc((size_t)max_pairs * (size_t)max_found * sizeof *found);
    uint8_t *is_inside = malloc((size_t)max_pairs);
    if (found == NULL || is_inside == NULL)
    {
        free(found);
        free(is_inside);
        return SCREE_OUT_OF_MEMORY;
    }
    free(b->found);
    free(b->is_inside);
    b->found = found;
    b->is_inside = is_inside;
    b->max_sphere_mesh_pairs = max_pairs;
    b->max_found = max_found;
    return SCREE_OK;
}

/// Candidate pairs to batches, after they have changed.
static scree_status sort_pairs(struct scree_narrow_phase_buffers *b, const scree_bodies *bodies,
                               const scree_candidate_pair *pairs, int64_t num_pairs)
{
    if (b->num_sorted == num_pairs) return SCREE_OK;
    b->num_sorted = -1;
    if (num_pairs > b->max_pairs || b->num_contacts == NULL)
    {
        free(b->num_contacts);
        b->max_pairs = num_pairs + num_pairs / 2 + 16;
        b->num_contacts = malloc((size_t)b->max_pairs * sizeof *b->num_contacts);
        if (b->num_contacts == NULL) return SCREE_OUT_OF_MEMORY;
    }
    int64_t num[NUM_PAIR_KINDS] = {0};
    for (int pass = 0; pass < 2; ++pass)
    {
        for (int k = 0; k < NUM_PAIR_KINDS; ++k)
        {
            pair_batch *batch = b->batches + k;
            if (pass == 1 && num[k] > batch->max)
            {
                free(batch->pairs);
                batch->max = num[k] + num[k] / 2 + 16;
                batch->pairs = malloc((size_t)batch->max * sizeof *batch->pairs);
                if (batch->pairs == NULL) return SCREE_OUT_OF_MEMORY;
            }
            batch->num = num[k];
            num[k] = 0;
        }
        for (int64_t p = 0; p < num_pairs; ++p)
        {
            const int32_t i = bodies->shape[pairs[p].i], j = bodies->shape[pairs[p].j];
            const pair_kind kind = kind_of_pair[bodies->shapes[i].kind][bodies->shapes[j].kind];
            if (pass == 1) b->batches[kind].pairs[num[kind]] = (int32_t)p;
            ++num[kind];
        }
    }
    if (b->memory != NULL) memset(b->memory, 0, (size_t)b->max_mesh_pairs * sizeof *b->memory);
    b->num_sorted = num_pairs;
    return SCREE_OK;
}

/// Is the pair known to be apart, or found to be so now? The answer is proven, never a guess.
static bool is_apart(const scree_narrow_phase *narrow_phase, const scree_bodies *bodies, scree_candidate_pair pair,
                     pair_memory *memory)
{
    if (!narrow_phase->finds_separation) return false;
    const scree_real travelled = bodies->travel[pair.i] + bodies->travel[pair.j];
    if (narrow_phase->bounds_separation && travelled < memory->apart_until) return true;
    if (!narrow_phase->remembers_separation) memory->direction = scree_vec3_make(0, 0, 0);
    // contacts mostly last; the search would be in vain
    else if (memory->was_touching) return false;
    const scree_real gap =
        scree_separation_search(bodies->shapes + bodies->shape[pair.i], bodies->pose + pair.i,
                                bodies->shapes + bodies->shape[pair.j], bodies->pose + pair.j, &memory->direction);
    // a hair less, for the rounding of the travels
    memory->apart_until = travelled + gap * (scree_real)0.999;
    return gap > 0;
}

/// Entry m of the batch of meshes, the pair p: overlap, as often as the workspace has to grow, and the counts of this
/// thread.
static scree_status find_overlap(scree_narrow_phase *narrow_phase, const scree_bodies *bodies,
                                 const scree_candidate_pair *pairs, int64_t m, int thread)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    const int32_t p = b->batches[MESH_MESH].pairs[m];
    const scree_candidate_pair pair = pairs[p];
    scree_overlap_result *results = b->results + m * b->max_results;
    b->num_results[m] = b->num_contacts[p] = 0;
    if (is_apart(narrow_phase, bodies, pair, b->memory + m)) return SCREE_OK;
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
    b->num_results[m] = num;
    b->memory[m].was_touching = num > 0 && results[0].status != SCREE_OVERLAP_NONE;
    for (int32_t r = 0; r < num && r < b->max_results; ++r)
    {
        counts->num_without_normal += results[r].status == SCREE_OVERLAP_NO_NORMAL;
        if (results[r].status != SCREE_OVERLAP_TOUCHING) continue;
        ++b->num_contacts[p];
        counts->num_fallbacks += results[r].used_fallback;
        counts->worst_residual = scree_max(counts->worst_residual, results[r].residual);
    }
    return SCREE_OK;
}

void scree_narrow_phase_forget(scree_narrow_phase *narrow_phase)
{
    if (narrow_phase->buffers != NULL) narrow_phase->buffers->num_sorted = -1;
}

/// The batch of meshes, with room for max_results per pair.
static scree_status find_overlaps_once(scree_narrow_phase *narrow_phase, const scree_bodies *bodies,
                                       const scree_candidate_pair *pairs)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    const int64_t num = b->batches[MESH_MESH].num;
    for (int t = 0; t < b->num_workspaces; ++t) b->counts[t] = (scree_narrow_phase_counts){0};
    int has_failed = 0;
#pragma omp parallel for schedule(dynamic, 8) reduction(| : has_failed) if (num >= 16)
    for (int64_t m = 0; m < num; ++m)
        has_failed |= find_overlap(narrow_phase, bodies, pairs, m, omp_get_thread_num()) != SCREE_OK;

    // sums of integers and maxima do not depend on which thread met what
    scree_narrow_phase_counts total = {0};
    for (int t = 0; t < b->num_workspaces; ++t)
    {
        total.num_without_normal += b->counts[t].num_without_normal;
        total.num_fallbacks += b->counts[t].num_fallbacks;
        total.worst_residual = scree_max(total.worst_residual, b->counts[t].worst_residual);
    }
    narrow_phase->counts = total;
    return has_failed ? SCREE_OUT_OF_MEMORY : SCREE_OK;
}

static scree_status find_overlaps(scree_narrow_phase *narrow_phase, const scree_bodies *bodies,
                                  const scree_candidate_pair *pairs)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    const int64_t num = b->batches[MESH_MESH].num;
    narrow_phase->counts = (scree_narrow_phase_counts){0};
    if (num == 0) return SCREE_OK;
    scree_status status = reserve_workspaces(b, omp_get_max_threads());
    int32_t max_results = narrow_phase->options.separate_patches ? 4 : 1;
    for (bool is_complete = false; !is_complete;)
    {
        if (status == SCREE_OK) status = reserve_results(b, num, max_results);
        if (status == SCREE_OK) status = find_overlaps_once(narrow_phase, bodies, pairs);
        if (status != SCREE_OK) return status;
        // a pair with more patches than there was room for asks for a second, roomier search
        for (int64_t m = 0; m < num; ++m)
            if (b->num_results[m] > max_results) max_results = b->num_results[m];
        is_complete = max_results <= b->max_results;
    }
    return SCREE_OK;
}

/// All bodies as spheres, if two of them may meet.
static scree_status place_spheres(struct scree_narrow_phase_buffers *b, const scree_bodies *bodies)
{
    if (b->batches[SPHERE_SPHERE].num == 0) return SCREE_OK;
    if (bodies->num_bodies > b->max_bodies)
    {
        free(b->spheres);
        b->max_bodies = bodies->num_bodies;
        b->spheres = scree_buffer_alloc(b->max_bodies, sizeof *b->spheres);
        if (b->spheres == NULL) return SCREE_OUT_OF_MEMORY;
    }
    const scree_place_spheres_args args = {bodies->shapes, bodies->shape, bodies->pose, b->spheres};
    scree_place_spheres_launch(args, bodies->num_bodies);
    return SCREE_OK;
}

static scree_status find_on_meshes(struct scree_narrow_phase_buffers *b, scree_sphere_pairs_args args)
{
    const pair_batch *batch = b->batches + SPHERE_MESH;
    int32_t max_found = 3;
    for (bool is_complete = batch->num == 0; !is_complete;)
    {
        const scree_status status = reserve_found(b, batch->num, max_found);
        if (status != SCREE_OK) return status;
        args.batch = batch->pairs;
        args.found = b->found;
        args.is_inside = b->is_inside;
        args.max_found = b->max_found;
        scree_sphere_mesh_count_launch(args, batch->num);
        // as above
        for (int64_t m = 0; m < batch->num; ++m)
            if (b->num_contacts[batch->pairs[m]] > max_found) max_found = b->num_contacts[batch->pairs[m]];
        if (max_found >> SCREE_PATCH_BITS > 0) return SCREE_TOO_MANY;
        is_complete = max_found <= b->max_found;
    }
    return SCREE_OK;
}

/// Touching results of the meshes to the list.
static void write_overlaps(const struct scree_narrow_phase_buffers *b, const scree_candidate_pair *pairs,
                           scree_contact_list *list)
{
    const pair_batch *batch = b->batches + MESH_MESH;
#pragma omp parallel for schedule(static) if (batch->num >= 1024)
    for (int64_t m = 0; m < batch->num; ++m)
    {
        const int32_t p = batch->pairs[m];
        int64_t c = list->first_of_pair[p];
        for (int32_t r = 0; r < b->num_results[m]; ++r)
        {
            const scree_overlap_result *result = b->results + m * b->max_results + r;
            if (result->status != SCREE_OVERLAP_TOUCHING) continue;
            list->bodies[c] = pairs[p];
            list->patch[c] = (int32_t)(c - list->first_of_pair[p]);
            list->volume[c] = result->volume;
            list->indentation[c] = result->indentation;
            list->radius[c] = result->radius;
            list->normal[c] = scree_vec3_negate(result->normal);
            list->area_vector[c] = result->area_vector;
            list->torque_vector[c] = result->torque_vector;
            list->arm[c] = result->arm;
            ++c;
        }
    }
}

/// Contacts of all pairs to the list, in the order of the pairs.
static scree_status compact(const struct scree_narrow_phase_buffers *b, scree_sphere_pairs_args args, int64_t num_pairs,
                            scree_contact_list *list)
{
    scree_status status = scree_contact_list_reserve(list, 0, num_pairs);
    if (status != SCREE_OK) return status;
    int64_t num_contacts = 0;
    for (int64_t p = 0; p < num_pairs; ++p)
    {
        list->first_of_pair[p] = num_contacts;
        num_contacts += b->num_contacts[p];
    }
    list->first_of_pair[num_pairs] = num_contacts;
    status = scree_contact_list_reserve(list, num_contacts, num_pairs);
    if (status != SCREE_OK) return status;
    list->num_contacts = num_contacts;

    write_overlaps(b, args.pairs, list);
    args.list = *list;
    args.batch = b->batches[SPHERE_SPHERE].pairs;
    scree_sphere_sphere_write_launch(args, b->batches[SPHERE_SPHERE].num);
    args.batch = b->batches[CLUMP_CLUMP].pairs;
    scree_clump_clump_write_launch(args, b->batches[CLUMP_CLUMP].num);
    args.batch = b->batches[SPHERE_MESH].pairs;
    args.found = b->found;
    args.max_found = b->max_found;
    scree_sphere_mesh_write_launch(args, b->batches[SPHERE_MESH].num);
    return SCREE_OK;
}

scree_status scree_narrow_phase_find(scree_narrow_phase *narrow_phase, const scree_bodies *bodies,
                                     const scree_candidate_pair *pairs, int64_t num_pairs, scree_contact_list *list)
{
    if (narrow_phase->buffers == NULL)
    {
        narrow_phase->buffers = calloc(1, sizeof *narrow_phase->buffers);
        if (narrow_phase->buffers == NULL) return SCREE_OUT_OF_MEMORY;
        narrow_phase->buffers->num_sorted = -1;
    }
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    scree_sphere_pairs_args args = {0};
    args.shapes = bodies->shapes;
    args.shape = bodies->shape;
    args.pose = bodies->pose;
    args.pairs = pairs;
    scree_status status = sort_pairs(b, bodies, pairs, num_pairs);
    if (status == SCREE_OK) status = place_spheres(b, bodies);
    args.num_contacts = b->num_contacts;
    args.spheres = b->spheres;
    if (status == SCREE_OK) status = find_overlaps(narrow_phase, bodies, pairs);
    if (status == SCREE_OK) status = find_on_meshes(b, args);
    if (status != SCREE_OK) return status;
    args.batch = b->batches[SPHERE_SPHERE].pairs;
    scree_sphere_sphere_count_launch(args, b->batches[SPHERE_SPHERE].num);
    args.batch = b->batches[CLUMP_CLUMP].pairs;
    scree_clump_clump_count_launch(args, b->batches[CLUMP_CLUMP].num);
    status = compact(b, args, num_pairs, list);
    if (status != SCREE_OK) return status;

    scree_real largest = 0;
    for (int64_t c = 0; c < list->num_contacts; ++c) largest = scree_max(largest, list->indentation[c]);
    narrow_phase->counts.largest_indentation = largest;
    for (int64_t m = 0; m < b->batches[SPHERE_MESH].num; ++m) narrow_phase->counts.num_inside += b->is_inside[m];
    return SCREE_OK;
}
