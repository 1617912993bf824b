#include "contact/contact_list.h"

#include "core/buffer.h"
#include "core/permute.h"

#include <math.h>
#include <stdlib.h>

/// Every array of one entry per contact: X(name, carried to the next step?, does the list have a use for it?). Those
/// that are not carried stand in the block in this order, the forces that are written last and as a whole first.
#define SCREE_CONTACT_ARRAYS(X)                                             \
    X(normal_force, false, true)                                            \
    X(tangential_force, false, true)                                        \
    X(moment, false, !list->acts_in_points)                                 \
    X(elastic_force, false, true)                                           \
    X(elastic_work, false, true)                                            \
    X(spring_work, false, true)                                             \
    X(is_slipping, false, true)                                             \
    X(is_turning, false, !list->acts_in_points)                             \
    X(volume, false, true)                                                  \
    X(indentation, false, true)                                             \
    X(normal, false, true)                                                  \
    X(area_vector, false, !list->acts_in_points && !list->has_no_levers)    \
    X(torque_vector, false, !list->acts_in_points && !list->has_no_levers)  \
    X(bodies, true, true)                                                   \
    X(patch, !list->is_one_per_pair, true)                                  \
    X(radius, true, !list->acts_in_points)                                  \
    X(arm, !list->is_one_per_pair, true)                                    \
    X(spring_force, true, true)                                             \
    X(tangential_stiffness, true, true)                                     \
    X(torsion, true, !list->acts_in_points)                                 \
    X(rolling_moment, true, !list->acts_in_points && !list->has_no_rolling) \
    X(spring_energy, true, true)                                            \
    X(elastic_energy, true, true)

/// A larger array in place of *array, of which the first num_kept items are kept.
static bool grow(scree_device *device, void *array, int64_t num_kept, int64_t num_items, size_t item_size)
{
    void **items = array;
    void *grown = scree_device_alloc(device, num_items, item_size);
    if (grown == NULL) return false;
    if (*items != NULL) scree_device_copy(device, grown, *items, (size_t)num_kept * item_size);
    scree_device_free(device, *items);
    *items = grown;
    return true;
}

/// Zeros in place of *array that nobody writes: memory that is never touched is not taken. None on a GPU.
static bool grow_zeros(scree_device *device, void *array, int64_t num_items, size_t item_size)
{
    void **items = array;
    if (device != NULL) return true;
    void *zeros = calloc((size_t)num_items, item_size);
    if (zeros == NULL) return false;
    free(*items);
    *items = zeros;
    return true;
}

static scree_status reserve_pairs(scree_contact_list *list, int64_t num_pairs)
{
    scree_device *device = list->device;
    if (num_pairs <= list->max_pairs && list->first_of_pair != NULL) return SCREE_OK;
    const int64_t max_pairs = scree_buffer_grown(num_pairs);
    const bool is_new = list->first_of_pair == NULL;
    if (!grow(device, &list->first_of_pair, list->max_pairs + 1, max_pairs + 1, sizeof *list->first_of_pair))
        return SCREE_OUT_OF_MEMORY;
    if (is_new) scree_device_zero(device, list->first_of_pair, sizeof *list->first_of_pair);
    list->max_pairs = max_pairs;
    return SCREE_OK;
}

/// A new block for max_contacts: all arrays that are not carried.
static scree_status renew_block(scree_contact_list *list, int64_t max_contacts)
{
    int64_t num_bytes = 0;
#define SCREE_ADD(array, is_carried, is_used) \
    num_bytes += !(is_carried) && (is_used) ? scree_scratch_bytes(max_contacts, sizeof *list->array) : 0;
    SCREE_CONTACT_ARRAYS(SCREE_ADD)
#undef SCREE_ADD
    list->max_contacts = 0;
    if (list->scratch == NULL)
    {
        scree_device_free(list->device, list->block);
        list->block = scree_device_alloc(list->device, num_bytes, 1);
    }
    else
    {
        const scree_status status = scree_scratch_begin(list->scratch, num_bytes);
        list->block = status == SCREE_OK ? scree_scratch_take(list->scratch, num_bytes, 1) : NULL;
    }
    if (list->block == NULL) return SCREE_OUT_OF_MEMORY;
    char *place = list->block;
#define SCREE_PLACE(array, is_carried, is_used)                                                                     \
    if (!(is_carried) && (is_used))                                                                                 \
    {                                                                                                               \
        list->array = (void *)place;                                                                                \
        place += scree_scratch_bytes(max_contacts, sizeof *list->array);                                            \
    }                                                                                                               \
    else if (!(is_carried) && max_contacts > list->most_contacts)                                                   \
    {                                                                                                               \
        if (!grow_zeros(list->device, &list->array, max_contacts, sizeof *list->array)) return SCREE_OUT_OF_MEMORY; \
    }
    SCREE_CONTACT_ARRAYS(SCREE_PLACE)
#undef SCREE_PLACE
    if (max_contacts > list->most_contacts) list->most_contacts = max_contacts;
    list->max_contacts = max_contacts;
    return SCREE_OK;
}

static scree_status reserve_carried(scree_contact_list *list, int64_t num_contacts)
{
    if (num_contacts <= list->max_carried) return SCREE_OK;
    const int64_t max = scree_buffer_grown(num_contacts), num_kept = list->max_carried;
#define SCREE_GROW(array, is_carried, is_used)                                                             \
    if ((is_carried) && !((is_used) ? grow(list->device, &list->array, num_kept, max, sizeof *list->array) \
                                    : grow_zeros(list->device, &list->array, max, sizeof *list->array)))   \
        return SCREE_OUT_OF_MEMORY;
    SCREE_CONTACT_ARRAYS(SCREE_GROW)
#undef SCREE_GROW
    list->max_carried = max;
    return SCREE_OK;
}

scree_status scree_contact_list_reserve(scree_contact_list *list, int64_t num_contacts, int64_t num_pairs)
{
    scree_status status = reserve_pairs(list, num_pairs);
    if (status == SCREE_OK) status = reserve_carried(list, num_contacts);
    const bool has_room = list->is_history || num_contacts <= list->max_contacts;
    if (status != SCREE_OK || has_room) return status;
    return renew_block(list, num_contacts > list->most_contacts ? num_contacts : list->most_contacts);
}

void scree_contact_list_lend(scree_contact_list *list, scree_scratch *scratch)
{
    if (list->scratch == NULL) scree_device_free(list->device, list->block);
    list->scratch = scratch;
    list->block = NULL;
    list->max_contacts = 0;
#define SCREE_FORGET(array, is_carried, is_used) \
    if (!(is_carried) && (is_used)) list->array = NULL;
    SCREE_CONTACT_ARRAYS(SCREE_FORGET)
#undef SCREE_FORGET
}

int64_t scree_contact_list_wanted(int64_t num_contacts) { return num_contacts + num_contacts / 16 + 16; }

void *scree_contact_list_spare(const scree_contact_list *list) { return list->normal_force; }

size_t scree_contact_list_spare_bytes(const scree_contact_list *list)
{
    return list->acts_in_points ? 0
                                : sizeof *list->normal_force + sizeof *list->tangential_force + sizeof *list->moment;
}

int64_t scree_contact_list_room(const scree_contact_list *list)
{
    return list->is_history || list->max_carried < list->max_contacts ? list->max_carried : list->max_contacts;
}

void scree_contact_list_pass_on(scree_contact_list *present, scree_contact_list *history)
{
    const scree_contact_list was = *present, *list = &was;
#define SCREE_EXCHANGE(array, is_carried, is_used) \
    if (is_carried)                                \
    {                                              \
        present->array = history->array;           \
        history->array = was.array;                \
    }
    SCREE_CONTACT_ARRAYS(SCREE_EXCHANGE)
#undef SCREE_EXCHANGE
    present->first_of_pair = history->first_of_pair;
    present->max_pairs = history->max_pairs;
    present->max_carried = history->max_carried;
    present->num_contacts = 0;
    history->first_of_pair = was.first_of_pair;
    history->max_pairs = was.max_pairs;
    history->max_carried = was.max_carried;
    history->num_contacts = was.num_contacts;
}

void scree_contact_list_share_uses(scree_contact_list *to, const scree_contact_list *from)
{
    to->acts_in_points = from->acts_in_points;
    to->has_no_levers = from->has_no_levers;
    to->has_no_rolling = from->has_no_rolling;
    to->is_one_per_pair = from->is_one_per_pair;
}

scree_status scree_contact_list_copy(scree_contact_list *to, const scree_contact_list *from)
{
    scree_contact_list *list = to;
    scree_contact_list_share_uses(to, from);
    const scree_status status = scree_contact_list_reserve(to, from->num_contacts, 0);
    if (status != SCREE_OK) return status;
    to->num_contacts = from->num_contacts;
    const size_t num = (size_t)from->num_contacts;
#define SCREE_COPY(array, is_carried, is_used)                                            \
    if ((is_used) && to->device == NULL)                                                  \
        scree_device_read(from->device, to->array, from->array, num * sizeof *to->array); \
    else if (is_used) scree_device_write(to->device, to->array, from->array, num * sizeof *to->array);
    SCREE_CONTACT_ARRAYS(SCREE_COPY)
#undef SCREE_COPY
    return SCREE_OK;
}

void scree_contact_list_permute(scree_contact_list *list, const int32_t *order, void *scratch)
{
#define SCREE_PERMUTE(array, is_carried, is_used) \
    if (is_used) scree_permute(list->device, list->array, sizeof *list->array, order, list->num_contacts, scratch);
    SCREE_CONTACT_ARRAYS(SCREE_PERMUTE)
#undef SCREE_PERMUTE
}

int64_t scree_contact_list_block_bytes(const scree_contact_list *list)
{
    size_t num_bytes = 0;
#define SCREE_ADD(array, is_carried, is_used) num_bytes += !(is_carried) && (is_used) ? sizeof *list->array : 0;
    SCREE_CONTACT_ARRAYS(SCREE_ADD)
#undef SCREE_ADD
    return (int64_t)num_bytes;
}

int64_t scree_contact_list_bytes(const scree_contact_list *list)
{
    size_t num_bytes = 0;
#define SCREE_ADD(array, is_carried, is_used) num_bytes += (is_carried) && (is_used) ? 2 * sizeof *list->array : 0;
    SCREE_CONTACT_ARRAYS(SCREE_ADD)
#undef SCREE_ADD
    return (int64_t)num_bytes + scree_contact_list_block_bytes(list);
}

void scree_contact_list_destroy(scree_contact_list *list)
{
    scree_device *device = list->device;
#define SCREE_FREE(array, is_carried, is_used) \
    if ((is_carried) || !(is_used)) scree_device_free(device, list->array);
    SCREE_CONTACT_ARRAYS(SCREE_FREE)
#undef SCREE_FREE
    if (list->scratch == NULL) scree_device_free(device, list->block);
    scree_device_free(device, list->first_of_pair);
    scree_contact_list empty = {.device = device, .is_history = list->is_history};
    scree_contact_list_share_uses(&empty, list);
    *list = empty;
}

static int32_t id_of(const int32_t *ids, int32_t body) { return ids != NULL ? ids[body] : body; }

/// Order of contacts a and b: negative, zero or positive.
static int compare_contacts(const scree_contact_list *list, const int32_t *ids, int64_t a, int64_t b)
{
    const scree_candidate_pair p = list->bodies[a], q = list->bodies[b];
    if (p.i != q.i) return p.i < q.i ? -1 : 1;
    if (p.j != q.j) return id_of(ids, p.j) < id_of(ids, q.j) ? -1 : 1;
    return (list->patch[a] > list->patch[b]) - (list->patch[a] < list->patch[b]);
}

bool scree_contact_list_validate(const scree_contact_list *list, const int32_t *ids, scree_report *report)
{
    bool is_valid = true;
    for (int64_t c = 0; c < list->num_contacts && is_valid; ++c)
    {
        const scree_candidate_pair pair = list->bodies[c];
        const double length = (double)scree_vec3_length(list->normal[c]);
        if (c > 0 && compare_contacts(list, ids, c - 1, c) >= 0)
        {
            scree_report_add(report, "contact %lld of bodies %d and %d is out of order", (long long)c, pair.i, pair.j);
            is_valid = false;
        }
        if (!(pair.i >= 0 && pair.j >= 0 && id_of(ids, pair.i) < id_of(ids, pair.j)))
        {
            scree_report_add(report, "contact %lld joins bodies %d and %d; the first id must be the smaller one",
                             (long long)c, pair.i, pair.j);
            is_valid = false;
        }
        if (!(list->volume[c] > 0) || !(list->indentation[c] > 0) ||
            !(fabs(length - 1) < 16 * (double)SCREE_REAL_EPSILON))
        {
            scree_report_add(report, "contact of bodies %d and %d: volume %g m^3, indentation %g m, |normal| %.17g",
                             pair.i, pair.j, (double)list->volume[c], (double)list->indentation[c], length);
            is_valid = false;
        }
    }
    return is_valid;
}
