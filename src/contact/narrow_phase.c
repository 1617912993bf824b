#include "contact/narrow_phase.h"

#include "contact/history.h"
#include "contact/narrow_phase_launch.h"
#include "contact/sphere_pairs.h"
#include "core/buffer.h"
#include "core/scan.h"

#include <stdlib.h>
#include <string.h>

/// The pairs of one kind, in the order of all candidate pairs.
typedef struct pair_batch
{
    int32_t *pairs; ///< (num) indices of candidate pairs, (max) room
    int64_t num, max;
    bool is_all; ///< of all candidate pairs: the indices are not needed
} pair_batch;

/// Results of the pairs before they are compacted into the list. Nothing is kept for two spheres.
struct scree_narrow_phase_buffers
{
    int64_t num_sorted; ///< candidate pairs that the batches are made of; -1: they have changed
    int64_t num_found;  ///< contacts, the last time
    pair_batch batches[SCREE_NUM_PAIR_KINDS];
    scree_scan_scratch scan;
    scree_pair_tally *tally; ///< may be borrowed

    // two meshes
    scree_overlap_pool pool;
    scree_overlap_result *results; ///< (slices of the pool, max_results) of pairs under way
    int64_t num_with_results;      ///< slices
    scree_pair_share *shares;      ///< (num_with_results) on the CPU
    int32_t max_results;           ///< of one pair
    scree_kept_lever *kept_levers; ///< (max_levers) of pairs that touch, or NULL
    int64_t max_levers;
    int32_t *first_kept; ///< (num in batch); during a search of candidates the first body of each pair
    int32_t *active;     ///< (num of classes, max_mesh_pairs); meanwhile the second body
    int64_t max_mesh_pairs;
    scree_pair_memory *memory; ///< (num in batch); during a search of candidates (num_carried) that of the pairs before
    int64_t max_memory;
    int64_t num_carried;   ///< pairs whose memory the next batch takes over
    scree_scratch scratch; ///< for lists that borrow none

    scree_sphere *spheres; ///< (max_bodies)
    int64_t max_bodies;

    // a sphere and a mesh
    scree_near_nodes *near; ///< (max_near) per pair
    int64_t max_near;
    scree_sphere_contact *found; ///< (num in batch, max_found)
    int64_t max_sphere_mesh_pairs;
    int32_t max_found; ///< per pair
};

/// The indices as kernels get them.
static const int32_t *indices_of(const pair_batch *batch) { return batch->is_all ? NULL : batch->pairs; }

void scree_narrow_phase_destroy(scree_narrow_phase *narrow_phase)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    scree_device *device = narrow_phase->device;
    if (b != NULL)
    {
        for (int k = 0; k < SCREE_NUM_PAIR_KINDS; ++k) scree_device_free(device, b->batches[k].pairs);
        scree_scan_destroy(&b->scan);
        scree_overlap_pool_destroy(&b->pool);
        if (narrow_phase->tally == NULL) scree_device_free(device, b->tally);
        scree_device_free(device, b->results);
        scree_device_free(device, b->shares);
        scree_device_free(device, b->kept_levers);
        scree_device_free(device, b->first_kept);
        scree_device_free(device, b->active);
        scree_device_free(device, b->memory);
        scree_scratch_destroy(&b->scratch);
        scree_device_free(device, b->spheres);
        scree_device_free(device, b->found);
        scree_device_free(device, b->near);
        free(b);
    }
    *narrow_phase = (scree_narrow_phase){.device = device, .tally = narrow_phase->tally};
}

void scree_narrow_phase_forget(scree_narrow_phase *narrow_phase)
{
    if (narrow_phase->buffers == NULL) return;
    narrow_phase->buffers->num_sorted = -1;
    narrow_phase->buffers->num_carried = 0;
}

void scree_narrow_phase_carry(scree_narrow_phase *narrow_phase, const scree_bodies *bodies,
                              const scree_candidate_pair *pairs)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    const bool knows_pairs = b != NULL && b->num_sorted >= 0;
    scree_narrow_phase_forget(narrow_phase);
    if (!knows_pairs) return;
    const pair_batch *batch = b->batches + SCREE_PAIR_MESH_MESH;
    scree_pair_keep_args args;
    memset(&args, 0, sizeof args); // the gaps between its members too
    args.bodies = *bodies;
    args.pairs = pairs;
    args.batch = indices_of(batch);
    args.memory = b->memory;
    args.kept_i = b->first_kept;
    args.kept_j = b->active;
    scree_pair_keep_launch_on(narrow_phase->device, args, batch->num);
    b->num_carried = batch->num;
}

/// What belongs to the first search.
static scree_status start(scree_narrow_phase *narrow_phase)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    if (b != NULL && b->tally != NULL) return SCREE_OK;
    if (b == NULL) b = calloc(1, sizeof *b);
    if (b == NULL) return SCREE_OUT_OF_MEMORY;
    narrow_phase->buffers = b;
    b->num_sorted = -1;
    b->scan.device = b->pool.device = b->scratch.device = narrow_phase->device;
    b->tally = narrow_phase->tally;
    if (b->tally == NULL) b->tally = scree_device_alloc(narrow_phase->device, 1, sizeof *b->tally);
    return b->tally != NULL ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

/// A new array in place of *array.
static bool renew(scree_device *device, void *array, int64_t num, size_t size)
{
    void **items = array;
    scree_device_free(device, *items);
    *items = scree_device_alloc(device, num, size);
    return *items != NULL;
}

/// Lanes that work on an overlap together.
static int32_t num_lanes_of(const scree_narrow_phase *narrow_phase, int32_t work_class)
{
    return narrow_phase->device != NULL ? scree_work_num_lanes(work_class) : 1;
}

/// Overlaps of a class that can be under way at once.
static int64_t num_at_once(const scree_narrow_phase *narrow_phase, int32_t work_class)
{
    return scree_device_concurrency(narrow_phase->device) / num_lanes_of(narrow_phase, work_class);
}

static int64_t num_classes(const scree_narrow_phase *narrow_phase)
{
    return narrow_phase->classes.last - narrow_phase->classes.first + 1;
}

/// Room for the pairs of meshes.
static scree_status reserve_mesh_pairs(scree_narrow_phase *narrow_phase)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    scree_device *device = narrow_phase->device;
    const int64_t num = b->batches[SCREE_PAIR_MESH_MESH].num;
    if (num <= b->max_mesh_pairs) return SCREE_OK;
    const int64_t max = scree_buffer_grown(num), num_lists = num_classes(narrow_phase);
    b->max_mesh_pairs = 0;
    const bool is_complete = renew(device, &b->first_kept, max, sizeof *b->first_kept) &&
                             renew(device, &b->active, num_lists * max, sizeof *b->active);
    if (!is_complete) return SCREE_OUT_OF_MEMORY;
    b->max_mesh_pairs = max;
    return SCREE_OK;
}

/// Room for `num` contacts, and for what is kept of them in the memory of their forces.
static scree_status reserve_kept(scree_narrow_phase *narrow_phase, scree_contact_list *list, int64_t num)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    if (num > INT32_MAX) return SCREE_TOO_MANY;
    const scree_status status = scree_contact_list_reserve(list, num, 0);
    if (status != SCREE_OK || list->has_no_levers) return status;
    return scree_device_reserve_only(narrow_phase->device, &b->kept_levers, &b->max_levers, list->max_contacts,
                                     sizeof *b->kept_levers);
}

_Static_assert(sizeof(scree_kept_overlap) <= 3 * sizeof(scree_vec3), "the forces of a contact have room for it");

/// Overlaps that there is room for.
static int64_t max_kept(const scree_narrow_phase *narrow_phase, const scree_contact_list *list)
{
    return narrow_phase->buffers->batches[SCREE_PAIR_MESH_MESH].num > 0 ? list->max_contacts : 0;
}

/// Room for what is found between spheres and meshes.
static scree_status reserve_found(scree_narrow_phase *narrow_phase, int32_t max_found)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    const int64_t num = b->batches[SCREE_PAIR_SPHERE_MESH].num;
    if (num == 0 || (num <= b->max_sphere_mesh_pairs && max_found <= b->max_found)) return SCREE_OK;
    const int64_t max = num > b->max_sphere_mesh_pairs ? scree_buffer_grown(num) : b->max_sphere_mesh_pairs;
    if (max_found > b->max_found) b->max_found = max_found;
    b->max_sphere_mesh_pairs = 0;
    if (!renew(narrow_phase->device, &b->found, max, (size_t)b->max_found * sizeof *b->found))
        return SCREE_OUT_OF_MEMORY;
    b->max_sphere_mesh_pairs = max;
    return SCREE_OK;
}

/// Results of one pair that there is room for to begin with.
static int32_t first_results(const scree_narrow_phase *narrow_phase)
{
    return narrow_phase->options.separate_patches ? 4 : 1;
}

int64_t scree_narrow_phase_overlap_bytes(const scree_narrow_phase *narrow_phase)
{
    const int64_t num = num_at_once(narrow_phase, narrow_phase->classes.first);
    const int64_t results = first_results(narrow_phase) * (int64_t)sizeof(scree_overlap_result);
    return scree_overlap_pool_bytes(narrow_phase->device, num, narrow_phase->room) + num * results;
}

/// Slices for the overlaps, and room for max_results of the pair that each works on.
static scree_status reserve_slices(scree_narrow_phase *narrow_phase, scree_overlap_room room, int32_t max_results)
{
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    if (b->batches[SCREE_PAIR_MESH_MESH].num == 0) return SCREE_OK;
    const int64_t num_slices_wanted = num_at_once(narrow_phase, narrow_phase->classes.first);
    const scree_status status = scree_overlap_pool_reserve(&b->pool, num_slices_wanted, room);
    if (status != SCREE_OK) return status;
    const int64_t num_slices = b->pool.num_slices;
    if (num_slices <= b->num_with_results && max_results <= b->max_results) return SCREE_OK;
    b->num_with_results = 0;
    if (max_results > b->max_results) b->max_results = max_results;
    scree_device *device = narrow_phase->device;
    if (!renew(device, &b->results, num_slices, (size_t)b->max_results * sizeof *b->results) ||
        (device == NULL && !renew(device, &b->shares, num_slices, sizeof *b->shares)))
        return SCREE_OUT_OF_MEMORY;
    b->num_with_results = num_slices;
    return SCREE_OK;
}

/// Room for results: that of one pair in eight to begin with, then for as many as the last time and some more, so that
/// it seldom lacks, and never less than it was.
static scree_status start_results(scree_narrow_phase *narrow_phase, scree_contact_list *list)
{
    const struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    const scree_overlap_room usual = {512, 1024, 128};
    const scree_status status = reserve_slices(
        narrow_phase, narrow_phase->room.max_pieces > 0 ? narrow_phase->room : usual, first_results(narrow_phase));
    const int64_t num = b->batches[SCREE_PAIR_MESH_MESH].num;
    if (status != SCREE_OK || num == 0) return status;
    const int64_t num_wanted = b->num_found > 0 ? scree_contact_list_wanted(b->num_found) : num / 8 + 1;
    return reserve_kept(narrow_phase, list, num_wanted);
}

/// What a search goes over.
typedef struct search
{
    scree_narrow_phase *narrow_phase;
    scree_bodies bodies;
    const scree_candidate_pair *pairs; ///< (num_pairs)
    int64_t num_pairs;
    scree_contact_list *list;
} search;

/// What is known of the pairs of meshes: what was carried, nothing of those that are new.
static scree_status take_memory(const search *s)
{
    struct scree_narrow_phase_buffers *b = s->narrow_phase->buffers;
    scree_device *device = s->narrow_phase->device;
    const pair_batch *batch = b->batches + SCREE_PAIR_MESH_MESH;
    const int64_t num_bodies = s->bodies.num_bodies, num_carried = b->num_carried;
    b->num_carried = 0;
    if (batch->num == 0) return SCREE_OK;
    scree_scratch *scratch = s->list->scratch != NULL ? s->list->scratch : &b->scratch;
    const size_t memory_bytes = (size_t)batch->num * sizeof *b->memory;
    const int64_t num_bytes =
        scree_scratch_bytes(2 * num_bodies, sizeof(int32_t)) + scree_scratch_bytes(batch->num, sizeof *b->memory);
    scree_status status = scree_scratch_begin(scratch, num_bytes);
    if (status != SCREE_OK) return status;
    int32_t *groups = scree_scratch_take(scratch, 2 * num_bodies, sizeof *groups);
    scree_pair_memory *memory = scree_scratch_take(scratch, batch->num, sizeof *memory);
    if (groups == NULL || memory == NULL) return SCREE_OUT_OF_MEMORY;
    const scree_pair_groups kept = {b->first_kept, b->active, s->bodies.ids,      1,
                                    num_carried,   groups,    groups + num_bodies};
    scree_device_zero(device, groups, (size_t)num_bodies * 2 * sizeof *groups);
    scree_group_bounds_launch_on(device, kept, kept.num);
    scree_pair_carry_args args;
    memset(&args, 0, sizeof args); // the gaps between its members too
    args.pairs = s->pairs;
    args.batch = indices_of(batch);
    args.memory = memory;
    args.kept = kept;
    args.old_memory = b->memory;
    scree_pair_carry_launch_on(device, args, batch->num);
    // the old one has been read
    status = scree_device_reserve(device, &b->memory, &b->max_memory, batch->num, sizeof *b->memory);
    if (status == SCREE_OK) scree_device_copy(device, b->memory, memory, memory_bytes);
    return status;
}

static scree_sphere_pairs_args sphere_args(const search *s, scree_pair_kind kind)
{
    const struct scree_narrow_phase_buffers *b = s->narrow_phase->buffers;
    scree_sphere_pairs_args args;
    args.spheres = b->spheres;
    args.shapes = s->bodies.shapes;
    args.shape = s->bodies.shape;
    args.pose = s->bodies.pose;
    args.pairs = s->pairs;
    args.batch = indices_of(b->batches + kind);
    args.list = scree_contact_list_view(s->list);
    args.near = b->near;
    args.reach = s->narrow_phase->separation.bounds ? s->bodies.reach : 0;
    args.found = b->found;
    args.max_found = b->max_found;
    args.tally = b->tally;
    return args;
}

/// Which parts of meshes spheres can meet until the pairs change.
static scree_status find_near(const search *s)
{
    struct scree_narrow_phase_buffers *b = s->narrow_phase->buffers;
    scree_device *device = s->narrow_phase->device;
    const int64_t num = b->batches[SCREE_PAIR_SPHERE_MESH].num;
    if (num == 0) return SCREE_OK;
    const scree_status status = scree_device_reserve(device, &b->near, &b->max_near, num, sizeof *b->near);
    if (status == SCREE_OK) scree_sphere_mesh_near_launch_on(device, sphere_args(s, SCREE_PAIR_SPHERE_MESH), num);
    return status;
}

/// Candidate pairs to batches, after they have changed. The list's array over pairs is not yet in use.
static scree_status sort_pairs(const search *s)
{
    struct scree_narrow_phase_buffers *b = s->narrow_phase->buffers;
    scree_device *device = s->narrow_phase->device;
    scree_status status = scree_scan_reserve(&b->scan, s->num_pairs);
    for (int k = 0; k < SCREE_NUM_PAIR_KINDS && status == SCREE_OK; ++k)
    {
        pair_batch *batch = b->batches + k;
        scree_pair_kinds_args args = {s->bodies, s->pairs, s->list->first_of_pair, NULL, (scree_pair_kind)k};
        scree_pair_flag_launch_on(device, args, s->num_pairs);
        scree_scan_on(&b->scan, args.places, s->num_pairs);
        int32_t num = 0;
        scree_device_read(device, &num, args.places + s->num_pairs, sizeof num);
        batch->num = num;
        batch->is_all = batch->num == s->num_pairs;
        if (batch->num == 0 || batch->is_all) continue;
        status = scree_device_reserve(device, &batch->pairs, &batch->max, batch->num, sizeof *batch->pairs);
        if (status != SCREE_OK) return status;
        args.batch = batch->pairs;
        scree_pair_scatter_launch_on(device, args, s->num_pairs);
    }
    if (status == SCREE_OK) status = take_memory(s);
    if (status != SCREE_OK) return status;
    status = find_near(s);
    if (status != SCREE_OK) return status;
    b->num_sorted = s->num_pairs;
    return SCREE_OK;
}

static scree_mesh_pairs_args mesh_args(const search *s)
{
    const struct scree_narrow_phase_buffers *b = s->narrow_phase->buffers;
    scree_mesh_pairs_args args;
    memset(&args, 0, sizeof args); // the gaps between its members too: a launch passes them on
    args.bodies = s->bodies;
    args.pairs = s->pairs;
    args.batch = indices_of(b->batches + SCREE_PAIR_MESH_MESH);
    args.memory = b->memory;
    args.active = b->active;
    args.max_active = b->max_mesh_pairs;
    args.shares = b->shares;
    args.num_shares = s->narrow_phase->device == NULL ? (int32_t)b->num_with_results : 0;
    args.classes = s->narrow_phase->classes;
    args.kept = scree_contact_list_spare(s->list);
    args.kept_levers = s->list->has_no_levers ? NULL : b->kept_levers;
    args.max_kept = max_kept(s->narrow_phase, s->list);
    args.first_kept = b->first_kept;
    args.list = scree_contact_list_view(s->list);
    args.tally = b->tally;
    args.use = s->narrow_phase->separation;
    return args;
}

/// All bodies as spheres, if two of them may meet.
static scree_status place_spheres(const search *s)
{
    struct scree_narrow_phase_buffers *b = s->narrow_phase->buffers;
    scree_device *device = s->narrow_phase->device;
    if (b->batches[SCREE_PAIR_SPHERE_SPHERE].num == 0) return SCREE_OK;
    const int64_t num = s->bodies.num_bodies;
    const scree_status status = scree_device_reserve(device, &b->spheres, &b->max_bodies, num, sizeof *b->spheres);
    if (status != SCREE_OK) return status;
    const scree_place_spheres_args args = {s->bodies.shapes, s->bodies.shape, s->bodies.pose, b->spheres};
    scree_place_spheres_launch_on(device, args, num);
    return SCREE_OK;
}

/// Overlaps of the pairs of meshes that may touch, class by class.
static void find_overlaps(const search *s)
{
    const struct scree_narrow_phase_buffers *b = s->narrow_phase->buffers;
    scree_device *device = s->narrow_phase->device;
    const int64_t num = b->batches[SCREE_PAIR_MESH_MESH].num;
    if (num == 0) return;
    const scree_mesh_pairs_args args = mesh_args(s);
    scree_mesh_apart_launch_on(device, args, num);
    scree_overlap_pairs_args overlaps;
    memset(&overlaps, 0, sizeof overlaps);
    overlaps.meshes = args;
    overlaps.slices = b->pool.slices;
    overlaps.results = b->results;
    overlaps.max_results = b->max_results;
    overlaps.options = s->narrow_phase->options;
    for (int32_t c = args.classes.first; c <= args.classes.last; ++c)
    {
        overlaps.work_class = c;
        overlaps.num_lanes = num_lanes_of(s->narrow_phase, c);
        const int64_t num_takers =
            scree_min_count(num, scree_min_count(b->pool.num_slices, num_at_once(s->narrow_phase, c)));
        if (overlaps.options.separate_patches) scree_overlap_patches_launch_on(device, overlaps, num_takers);
        else scree_overlap_pairs_launch_on(device, overlaps, num_takers);
    }
}

/// How many contacts each pair has, added up in the list and counted in the tally, but for what was found of a pair
/// that had no room.
static void count_contacts(const search *s)
{
    struct scree_narrow_phase_buffers *b = s->narrow_phase->buffers;
    scree_device *device = s->narrow_phase->device;
    scree_device_zero(device, b->tally, sizeof *b->tally);
    const pair_batch *batches = b->batches;
    scree_device_branch(device, 1);
    scree_sphere_mesh_count_launch_on(device, sphere_args(s, SCREE_PAIR_SPHERE_MESH),
                                      batches[SCREE_PAIR_SPHERE_MESH].num);
    scree_device_branch(device, 2);
    scree_sphere_sphere_count_launch_on(device, sphere_args(s, SCREE_PAIR_SPHERE_SPHERE),
                                        batches[SCREE_PAIR_SPHERE_SPHERE].num);
    scree_clump_clump_count_launch_on(device, sphere_args(s, SCREE_PAIR_CLUMP_CLUMP),
                                      batches[SCREE_PAIR_CLUMP_CLUMP].num);
    scree_device_branch(device, 0);
    find_overlaps(s);
    scree_device_join(device);
    int32_t *first_of_pair = s->list->first_of_pair;
    scree_scan_on(&b->scan, first_of_pair, s->num_pairs);
    scree_device_copy(device, &b->tally->num_contacts, first_of_pair + s->num_pairs, sizeof *first_of_pair);
}

/// More room for what had none.
static scree_status make_room(const search *s, const scree_pair_tally *tally)
{
    const struct scree_narrow_phase_buffers *b = s->narrow_phase->buffers;
    const int32_t most_results = (int32_t)scree_maximum_value(tally->most_results);
    const int32_t most_found = (int32_t)scree_maximum_value(tally->most_found);
    scree_overlap_room room = b->pool.room;
    if (tally->num_lacking[SCREE_LACK_PIECES] > 0) room.max_pieces *= 2;
    if (tally->num_lacking[SCREE_LACK_SHAPE] > 0) room.max_shape *= 2;
    if (tally->num_lacking[SCREE_LACK_CROSSINGS] > 0) room.max_crossings *= 2;
    const int64_t num_lacking = tally->num_lacking[SCREE_LACK_PIECES] + tally->num_lacking[SCREE_LACK_SHAPE] +
                                tally->num_lacking[SCREE_LACK_CROSSINGS];
    if (most_found >> SCREE_PATCH_BITS > 0) return SCREE_TOO_MANY;
    scree_status status = SCREE_OK;
    if (num_lacking > 0 || most_results > 0) status = reserve_slices(s->narrow_phase, room, most_results);
    if (status == SCREE_OK && tally->num_kept > 0 && tally->num_contacts > s->list->max_contacts)
        status = reserve_kept(s->narrow_phase, s->list, scree_contact_list_wanted(tally->num_contacts));
    if (status == SCREE_OK && most_found > 0) status = reserve_found(s->narrow_phase, most_found);
    return status;
}

/// How long pairs of meshes stay apart that no plane was found for. Of no use if they are searched anew in each step.
static void find_gaps(const search *s)
{
    const scree_separation_use use = s->narrow_phase->separation;
    if (use.finds && use.bounds && s->bodies.reach > 0)
        scree_mesh_gap_launch_on(s->narrow_phase->device, mesh_args(s),
                                 s->narrow_phase->buffers->batches[SCREE_PAIR_MESH_MESH].num);
}

/// Contacts of all pairs to the list, in the order of the pairs. It has room for them. Beside that, gaps are looked
/// for.
static void write_contacts(const search *s)
{
    const pair_batch *batches = s->narrow_phase->buffers->batches;
    scree_device *device = s->narrow_phase->device;
    scree_device_branch(device, 1);
    find_gaps(s);
    scree_device_branch(device, 2);
    scree_sphere_mesh_write_launch_on(device, sphere_args(s, SCREE_PAIR_SPHERE_MESH),
                                      batches[SCREE_PAIR_SPHERE_MESH].num);
    scree_device_branch(device, 3);
    scree_sphere_sphere_write_launch_on(device, sphere_args(s, SCREE_PAIR_SPHERE_SPHERE),
                                        batches[SCREE_PAIR_SPHERE_SPHERE].num);
    scree_clump_clump_write_launch_on(device, sphere_args(s, SCREE_PAIR_CLUMP_CLUMP),
                                      batches[SCREE_PAIR_CLUMP_CLUMP].num);
    scree_device_branch(device, 0);
    scree_mesh_write_launch_on(device, mesh_args(s), batches[SCREE_PAIR_MESH_MESH].num);
    scree_device_join(device);
}

/// Candidate pairs have changed: batches of them, and room to begin with.
static scree_status prepare_pairs(const search *s)
{
    scree_narrow_phase *narrow_phase = s->narrow_phase;
    narrow_phase->buffers->num_sorted = -1;
    // its block is taken once more, after others have had the memory
    if (s->list->scratch != NULL) scree_contact_list_lend(s->list, s->list->scratch);
    scree_status status = scree_contact_list_reserve(s->list, 0, s->num_pairs);
    if (status == SCREE_OK) status = sort_pairs(s);
    if (status == SCREE_OK) status = reserve_mesh_pairs(narrow_phase);
    if (status == SCREE_OK) status = reserve_found(narrow_phase, 3);
    if (status == SCREE_OK) status = start_results(narrow_phase, s->list);
    return status;
}

scree_status scree_narrow_phase_find(scree_narrow_phase *narrow_phase, const scree_bodies *bodies,
                                     const scree_candidate_pair *pairs, int64_t num_pairs, scree_contact_list *list)
{
    const search s = {narrow_phase, *bodies, pairs, num_pairs, list};
    scree_status status = start(narrow_phase);
    if (status != SCREE_OK) return status;
    struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    const bool are_new = b->num_sorted != num_pairs;
    if (are_new) status = prepare_pairs(&s);
    if (status == SCREE_OK) status = place_spheres(&s);

    scree_pair_tally tally = {0};
    bool lacks_room = true;
    while (lacks_room && status == SCREE_OK)
    {
        count_contacts(&s);
        scree_device_read(narrow_phase->device, &tally, b->tally, sizeof tally);
        lacks_room = scree_lacks_room(&tally, max_kept(narrow_phase, list));
        if (!are_new) break;
        // a pair that had no room asks for a second, roomier search; so do overlaps if the list must grow, for they
        // lie there
        lacks_room |= tally.num_kept > 0 && tally.num_contacts > list->max_contacts;
        if (tally.num_contacts < 0) status = SCREE_TOO_MANY;
        else if (lacks_room) status = make_room(&s, &tally);
    }
    b->num_found = tally.num_contacts;
    if (status == SCREE_OK && tally.num_contacts < 0) status = SCREE_TOO_MANY;
    // the block stays where overlaps are kept in it
    const int64_t num_wanted = tally.num_kept > 0 ? list->max_contacts : scree_contact_list_wanted(tally.num_contacts);
    if (status == SCREE_OK && are_new) status = scree_contact_list_reserve(list, num_wanted, num_pairs);
    narrow_phase->lacks_room = lacks_room || tally.num_contacts > scree_contact_list_room(list);
    if (status != SCREE_OK || narrow_phase->lacks_room) return status;
    list->num_contacts = tally.num_contacts;
    write_contacts(&s);
    scree_narrow_phase_take_counts(narrow_phase, &tally);
    return SCREE_OK;
}

void scree_narrow_phase_again(scree_narrow_phase *narrow_phase, const scree_bodies *bodies,
                              const scree_candidate_pair *pairs, int64_t num_pairs, scree_contact_list *list,
                              scree_live *live)
{
    const search s = {narrow_phase, *bodies, pairs, num_pairs, list};
    const struct scree_narrow_phase_buffers *b = narrow_phase->buffers;
    place_spheres(&s); // its array is there
    count_contacts(&s);
    const scree_room_args room = {b->tally, max_kept(narrow_phase, list), list->num_contacts, live};
    scree_room_launch_on(narrow_phase->device, room, 1);
    write_contacts(&s);
}

void scree_narrow_phase_take_counts(scree_narrow_phase *narrow_phase, const scree_pair_tally *tally)
{
    scree_narrow_phase_counts *counts = &narrow_phase->counts;
    narrow_phase->buffers->num_found = tally->num_contacts;
    counts->num_without_normal = tally->num_without_normal;
    counts->num_fallbacks = tally->num_fallbacks;
    counts->num_inside = tally->num_inside;
    counts->worst_residual = (scree_real)scree_maximum_value(tally->worst_residual);
}
