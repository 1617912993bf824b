/// \file broad_phase.c
/// Order of a search: tree over the boxes, pairs of particles, pairs with walls, sort, rows.
#include "bvh/broad_phase.h"

#include "bvh/bvh_launch.h"
#include "core/buffer.h"
#include "core/scan.h"
#include "core/sort.h"

#include <stdlib.h>

enum
{
    BLOCK_PARTICLES = 64,  ///< that look for walls in one call
    MAX_BRUTE_FORCE = 2000 ///< particles that are compared with all others when validating
};

struct scree_broad_phase_buffers
{
    scree_scratch scratch;   ///< unless it is borrowed
    scree_sort_buffers sort; ///< keys of pairs
    scree_scan_scratch scan; ///< of own pairs
    int64_t max_keys;
    int64_t *num_keys; ///< counts the pairs of a search
    int64_t max_pairs;
    int64_t max_bodies;
    int64_t num_bodies; ///< of the last search
};

void scree_broad_phase_destroy(scree_broad_phase *broad_phase)
{
    scree_device *device = broad_phase->device;
    scree_lbvh_destroy(&broad_phase->tree);
    if (broad_phase->buffers != NULL)
    {
        scree_scratch_destroy(&broad_phase->buffers->scratch);
        scree_scan_destroy(&broad_phase->buffers->scan);
        scree_device_free(device, broad_phase->buffers->num_keys);
        scree_device_free(device, broad_phase->own_begin);
        free(broad_phase->buffers);
    }
    scree_device_free(device, broad_phase->pairs);
    scree_device_free(device, broad_phase->row_begin);
    scree_device_free(device, broad_phase->row_pairs);
    *broad_phase = (scree_broad_phase){.device = device, .scratch = broad_phase->scratch};
}

/// What belongs to the first search, and memory of this one.
static scree_status start(scree_broad_phase *broad_phase)
{
    if (broad_phase->buffers == NULL) broad_phase->buffers = calloc(1, sizeof *broad_phase->buffers);
    struct scree_broad_phase_buffers *b = broad_phase->buffers;
    if (b == NULL) return SCREE_OUT_OF_MEMORY;
    scree_device *device = broad_phase->device;
    if (b->num_keys == NULL) b->num_keys = scree_device_alloc(device, 1, sizeof *b->num_keys);
    if (b->num_keys == NULL) return SCREE_OUT_OF_MEMORY;
    scree_scratch *scratch = broad_phase->scratch != NULL ? broad_phase->scratch : &b->scratch;
    b->scratch.device = b->scan.device = broad_phase->tree.device = device;
    broad_phase->tree.scratch = scratch;
    b->sort = (scree_sort_buffers){.device = device, .scratch = scratch};
    return scratch == &b->scratch ? scree_scratch_begin(scratch, 0) : SCREE_OK;
}

/// Room for arrays of one entry per body.
static scree_status reserve_bodies(scree_broad_phase *broad_phase, int64_t num_bodies)
{
    struct scree_broad_phase_buffers *b = broad_phase->buffers;
    scree_device *device = broad_phase->device;
    if (num_bodies <= b->max_bodies && broad_phase->row_begin != NULL) return SCREE_OK;
    const int64_t max_bodies = scree_buffer_grown(num_bodies);
    int32_t *own_begin = scree_device_alloc(device, max_bodies + 1, sizeof *own_begin);
    int32_t *row_begin = scree_device_alloc(device, max_bodies + 1, sizeof *row_begin);
    if (own_begin == NULL || row_begin == NULL)
    {
        scree_device_free(device, own_begin);
        scree_device_free(device, row_begin);
        return SCREE_OUT_OF_MEMORY;
    }
    // the rows of the last search stay readable until this one is complete
    const size_t num_bytes = (size_t)(b->num_bodies + 1) * sizeof *row_begin;
    if (broad_phase->row_begin != NULL)
    {
        scree_device_copy(device, own_begin, broad_phase->own_begin, num_bytes);
        scree_device_copy(device, row_begin, broad_phase->row_begin, num_bytes);
    }
    else
    {
        scree_device_zero(device, own_begin, num_bytes);
        scree_device_zero(device, row_begin, num_bytes);
    }
    scree_device_free(device, broad_phase->own_begin);
    scree_device_free(device, broad_phase->row_begin);
    broad_phase->own_begin = own_begin;
    broad_phase->row_begin = row_begin;
    b->max_bodies = max_bodies;
    return SCREE_OK;
}

/// Room for arrays of one entry per pair. Called when the number is known and before anything is written.
static scree_status reserve_pairs(scree_broad_phase *broad_phase, int64_t num_pairs)
{
    struct scree_broad_phase_buffers *b = broad_phase->buffers;
    scree_device *device = broad_phase->device;
    if (num_pairs <= b->max_pairs) return SCREE_OK;
    const int64_t max_pairs = scree_buffer_grown(num_pairs);
    scree_candidate_pair *pairs = scree_device_alloc(device, max_pairs, sizeof *pairs);
    int32_t *row_pairs = scree_device_alloc(device, max_pairs, sizeof *row_pairs);
    if (pairs == NULL || row_pairs == NULL)
    {
        scree_device_free(device, pairs);
        scree_device_free(device, row_pairs);
        return SCREE_OUT_OF_MEMORY;
    }
    scree_device_free(device, broad_phase->pairs);
    scree_device_free(device, broad_phase->row_pairs);
    broad_phase->pairs = pairs;
    broad_phase->row_pairs = row_pairs;
    b->max_pairs = max_pairs;
    return SCREE_OK;
}

static int32_t count_bits(int64_t number)
{
    int32_t num_bits = 1;
    while (number >> num_bits != 0) ++num_bits;
    return num_bits;
}

/// One try: appends the keys of all pairs to the list, as far as it has room; returns how many there are.
static int64_t find_keys(scree_broad_phase *broad_phase, const scree_broad_phase_input *input)
{
    struct scree_broad_phase_buffers *b = broad_phase->buffers;
    scree_device *device = broad_phase->device;
    scree_device_zero(device, b->num_keys, sizeof *b->num_keys);
    const scree_pair_list list = {b->sort.keys, b->num_keys, b->sort.max_items, input->ids,
                                  count_bits(input->num_particles + input->num_walls)};
    const scree_particle_pairs_args particle_args = {broad_phase->tree.view, list,
                                                     input->compares_spheres ? input->centres : NULL, input->radii};
    if (device == NULL) scree_particle_pairs_find(particle_args);
    else scree_particle_pairs_launch_on(device, particle_args, 2 * input->num_particles - 1);
    const scree_wall_pairs_args wall_args = {input->centres,   input->radii,    input->walls, input->num_particles,
                                             input->num_walls, BLOCK_PARTICLES, list};
    if (input->num_walls > 0)
        scree_wall_pairs_launch_on(device, wall_args, (input->num_particles + BLOCK_PARTICLES - 1) / BLOCK_PARTICLES);
    int64_t num_keys = 0;
    scree_device_read(device, &num_keys, b->num_keys, sizeof num_keys);
    return num_keys;
}

/// Sorted keys to pairs, and keys by second bodies.
static void fill_pairs(struct scree_broad_phase_buffers *b, scree_device *device, scree_pair_rows_args args)
{
    if (args.num_pairs == 0)
    {
        scree_device_zero(device, args.own_begin, (size_t)(args.num_bodies + 1) * sizeof *args.own_begin);
        scree_device_zero(device, args.row_begin, (size_t)(args.num_bodies + 1) * sizeof *args.row_begin);
    }
    scree_pair_unpack_launch_on(device, args, args.num_pairs);
    if (args.ids != NULL)
    {
        scree_pair_own_launch_on(device, args, args.num_bodies);
        scree_scan_on(&b->scan, args.own_before, args.num_bodies);
    }
    scree_pair_second_keys_launch_on(device, args, args.num_pairs);
}

/// Sorted keys to pairs and rows.
static void fill_pairs_and_rows(scree_broad_phase *broad_phase, const scree_broad_phase_input *input, int64_t num_pairs)
{
    struct scree_broad_phase_buffers *b = broad_phase->buffers;
    scree_device *device = broad_phase->device;
    const int64_t num_bodies = input->num_particles + input->num_walls;
    scree_pair_rows_args args = {.keys = b->sort.keys,
                                 .second_keys = b->sort.spare_keys,
                                 .pairs = broad_phase->pairs,
                                 .own_begin = broad_phase->own_begin,
                                 .own_before = broad_phase->row_begin, // it is filled afterwards
                                 .row_begin = broad_phase->row_begin,
                                 .row_pairs = broad_phase->row_pairs,
                                 .ids = input->ids,
                                 .places = input->places,
                                 .num_pairs = num_pairs,
                                 .num_bodies = num_bodies,
                                 .id_bits = count_bits(num_bodies)};
    fill_pairs(b, device, args);

    // by second body; the pairs of one stay in order
    uint64_t *keys = b->sort.keys;
    b->sort.keys = b->sort.spare_keys;
    b->sort.spare_keys = keys;
    scree_sort(&b->sort, num_pairs, 32);
    args.second_keys = b->sort.keys;
    scree_pair_rows_launch_on(device, args, num_pairs);
    broad_phase->num_pairs = num_pairs;
    b->num_bodies = num_bodies;
}

scree_status scree_broad_phase_find(scree_broad_phase *broad_phase, const scree_broad_phase_input *input)
{
    const int64_t num_bodies = input->num_particles + input->num_walls;
    if (num_bodies >= INT32_MAX) return SCREE_TOO_MANY;
    scree_status status = start(broad_phase);
    if (status == SCREE_OK) status = reserve_bodies(broad_phase, num_bodies);
    if (status == SCREE_OK && input->ids != NULL) status = scree_scan_reserve(&broad_phase->buffers->scan, num_bodies);
    if (status == SCREE_OK) status = scree_lbvh_build(&broad_phase->tree, input->boxes, input->num_particles);

    struct scree_broad_phase_buffers *b = broad_phase->buffers;
    if (status == SCREE_OK && b->max_keys > 0) status = scree_sort_reserve(&b->sort, b->max_keys, false);

    // a list that was too short has still counted all pairs, so the second try has room
    int64_t num_pairs = 0;
    for (bool is_complete = false; !is_complete && status == SCREE_OK;)
    {
        num_pairs = find_keys(broad_phase, input);
        is_complete = num_pairs <= b->sort.max_items;
        if (num_pairs > INT32_MAX) status = SCREE_TOO_MANY;
        else if (!is_complete) status = scree_sort_reserve(&b->sort, num_pairs + num_pairs / 16 + 16, false);
    }
    if (status == SCREE_OK) b->max_keys = b->sort.max_items;
    if (status == SCREE_OK) status = reserve_pairs(broad_phase, num_pairs);
    if (status != SCREE_OK) return status;
    scree_sort(&b->sort, num_pairs, 0);
    fill_pairs_and_rows(broad_phase, input, num_pairs);
    return SCREE_OK;
}

/// Pairs in range, i < j, ascending and therefore unique.
static bool check_order(const scree_broad_phase *broad_phase, const scree_broad_phase_input *input,
                        scree_report *report)
{
    const int64_t num_bodies = input->num_particles + input->num_walls;
    for (int64_t p = 0; p < broad_phase->num_pairs; ++p)
    {
        const scree_candidate_pair pair = broad_phase->pairs[p];
        const bool is_pair = pair.i >= 0 && pair.i < pair.j && pair.i < input->num_particles && pair.j < num_bodies;
        const scree_candidate_pair before = p > 0 ? broad_phase->pairs[p - 1] : (scree_candidate_pair){-1, -1};
        const bool is_after = pair.i > before.i || (pair.i == before.i && pair.j > before.j);
        if (is_pair && is_after) continue;
        scree_report_add(report, "candidate pair %lld (%d, %d) %s", (long long)p, pair.i, pair.j,
                         is_pair ? "is not after the one before it" : "is not a pair of a particle and a later body");
        return false;
    }
    return true;
}

/// Each row ascends and holds pairs of its body alone; as many entries as pairs make them complete.
static bool check_rows(const scree_broad_phase *broad_phase, int64_t num_bodies, scree_report *report)
{
    const int32_t *begin = broad_phase->row_begin;
    if (begin[0] != 0 || begin[num_bodies] != broad_phase->num_pairs)
    {
        scree_report_add(report, "rows of candidate pairs: from %lld to %lld for %lld pairs", (long long)begin[0],
                         (long long)begin[num_bodies], (long long)broad_phase->num_pairs);
        return false;
    }
    for (int64_t body = 0; body < num_bodies; ++body)
    {
        bool is_valid = begin[body] <= begin[body + 1];
        for (int64_t k = begin[body]; k < begin[body + 1] && is_valid; ++k)
        {
            const int64_t p = broad_phase->row_pairs[k], before = k > begin[body] ? broad_phase->row_pairs[k - 1] : -1;
            is_valid = p > before && p < broad_phase->num_pairs && broad_phase->pairs[p].j == body;
        }
        if (is_valid) continue;
        scree_report_add(report, "row of body %lld: not ascending, or with a pair of other bodies", (long long)body);
        return false;
    }
    return true;
}

/// What the search should say of two bodies, without the tree's hierarchy.
static bool are_candidates(const scree_broad_phase_input *input, int64_t i, int64_t j)
{
    if (j < input->num_particles)
        return scree_box_overlaps(input->boxes[i], input->boxes[j]) &&
               scree_spheres_overlap(input->compares_spheres ? input->centres : NULL, input->radii, (int32_t)i,
                                     (int32_t)j);
    const scree_broad_phase_wall *wall = input->walls + (j - input->num_particles);
    if (!wall->is_present) return false;
    scree_vec3 centre = input->centres[i];
    const scree_real radius = scree_sphere_to_wall(&centre, input->radii[i], wall->pose);
    for (int64_t k = 0; k < 2 * (int64_t)wall->tree.num_leaves - 1; ++k)
    {
        const scree_lbvh_node *node = wall->tree.nodes + k;
        if (node->first_child < 0 && scree_box_distance_squared(node->box, centre) <= radius * radius) return true;
    }
    return false;
}

static bool check_against_all(const scree_broad_phase *broad_phase, const scree_broad_phase_input *input,
                              scree_report *report)
{
    int64_t p = 0;
    for (int64_t i = 0; i < input->num_particles; ++i)
    {
        for (int64_t j = i + 1; j < input->num_particles + input->num_walls; ++j)
        {
            const bool is_listed =
                p < broad_phase->num_pairs && broad_phase->pairs[p].i == i && broad_phase->pairs[p].j == j;
            p += is_listed;
            if (is_listed == are_candidates(input, i, j)) continue;
            scree_report_add(report, "candidate pair (%lld, %lld) is %s", (long long)i, (long long)j,
                             is_listed ? "listed, but does not meet" : "missing");
            return false;
        }
    }
    return true;
}

bool scree_broad_phase_validate(const scree_broad_phase *broad_phase, const scree_broad_phase_input *input,
                                scree_report *report)
{
    const int64_t num_bodies = input->num_particles + input->num_walls;
    if (broad_phase->row_begin == NULL || broad_phase->buffers->num_bodies != num_bodies)
    {
        scree_report_add(report, "candidate pairs: not those of %lld particles and %lld walls",
                         (long long)input->num_particles, (long long)input->num_walls);
        return false;
    }
    return check_order(broad_phase, input, report) && check_rows(broad_phase, num_bodies, report) &&
           (input->num_particles > MAX_BRUTE_FORCE || check_against_all(broad_phase, input, report));
}
