#include "contact/contact_list.h"

#include "core/buffer.h"

#include <math.h>

/// Every array of one entry per contact, by name.
#define SCREE_CONTACT_ARRAYS(X) \
    X(bodies)                   \
    X(patch)                    \
    X(volume)                   \
    X(indentation)              \
    X(radius)                   \
    X(normal)                   \
    X(area_vector)              \
    X(torque_vector)            \
    X(arm)                      \
    X(normal_force)             \
    X(tangential_force)         \
    X(elastic_force)            \
    X(moment)                   \
    X(elastic_work)             \
    X(spring_work)              \
    X(is_slipping)              \
    X(is_turning)               \
    X(spring_force)             \
    X(tangential_stiffness)     \
    X(torsion)                  \
    X(rolling_moment)           \
    X(spring_energy)            \
    X(elastic_energy)

/// Those that stay zero where all contacts act in points.
#define SCREE_UNTOUCHED_ARRAYS(X) \
    X(radius)                     \
    X(area_vector)                \
    X(torque_vector)              \
    X(moment)                     \
    X(is_turning)                 \
    X(torsion)                    \
    X(rolling_moment)

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

scree_status scree_contact_list_reserve(scree_contact_list *list, int64_t num_contacts, int64_t num_pairs)
{
    scree_device *device = list->device;
    if (num_pairs > list->max_pairs || list->first_of_pair == NULL)
    {
        const int64_t max_pairs = scree_buffer_grown(num_pairs);
        const bool is_new = list->first_of_pair == NULL;
        if (!grow(device, &list->first_of_pair, list->max_pairs + 1, max_pairs + 1, sizeof *list->first_of_pair))
            return SCREE_OUT_OF_MEMORY;
        if (is_new) scree_device_zero(device, list->first_of_pair, sizeof *list->first_of_pair);
        list->max_pairs = max_pairs;
    }
    if (num_contacts <= list->max_contacts) return SCREE_OK;
    const int64_t max_contacts = scree_buffer_grown(num_contacts);
#define SCREE_GROW(array) \
    if (!grow(device, &list->array, list->max_contacts, max_contacts, sizeof *list->array)) return SCREE_OUT_OF_MEMORY;
    SCREE_CONTACT_ARRAYS(SCREE_GROW)
#undef SCREE_GROW
#define SCREE_ZERO(array)                                       \
    scree_device_zero(device, list->array + list->max_contacts, \
                      (size_t)(max_contacts - list->max_contacts) * sizeof *list->array);
    if (list->acts_in_points)
    {
        SCREE_UNTOUCHED_ARRAYS(SCREE_ZERO)
    }
#undef SCREE_ZERO
    list->max_contacts = max_contacts;
    return SCREE_OK;
}

scree_status scree_contact_list_copy(scree_contact_list *to, const scree_contact_list *from)
{
    to->acts_in_points = from->acts_in_points;
    const scree_status status = scree_contact_list_reserve(to, from->num_contacts, 0);
    if (status != SCREE_OK) return status;
    to->num_contacts = from->num_contacts;
    const size_t num = (size_t)from->num_contacts;
#define SCREE_COPY(array)                                                                                     \
    if (to->device == NULL) scree_device_read(from->device, to->array, from->array, num * sizeof *to->array); \
    else scree_device_write(to->device, to->array, from->array, num * sizeof *to->array);
    SCREE_CONTACT_ARRAYS(SCREE_COPY)
#undef SCREE_COPY
    return SCREE_OK;
}

void scree_contact_list_destroy(scree_contact_list *list)
{
    scree_device *device = list->device;
#define SCREE_FREE(array) scree_device_free(device, list->array);
    SCREE_CONTACT_ARRAYS(SCREE_FREE)
#undef SCREE_FREE
    scree_device_free(device, list->first_of_pair);
    *list = (scree_contact_list){.device = device};
}

/// Order of contacts a and b by (i, j, patch): negative, zero or positive.
static int compare_contacts(const scree_contact_list *list, int64_t a, int64_t b)
{
    const scree_candidate_pair p = list->bodies[a], q = list->bodies[b];
    if (p.i != q.i) return p.i < q.i ? -1 : 1;
    if (p.j != q.j) return p.j < q.j ? -1 : 1;
    return (list->patch[a] > list->patch[b]) - (list->patch[a] < list->patch[b]);
}

bool scree_contact_list_validate(const scree_contact_list *list, scree_report *report)
{
    bool is_valid = true;
    for (int64_t c = 0; c < list->num_contacts && is_valid; ++c)
    {
        const scree_candidate_pair pair = list->bodies[c];
        const double length = (double)scree_vec3_length(list->normal[c]);
        if (c > 0 && compare_contacts(list, c - 1, c) >= 0)
        {
            scree_report_add(report, "contact %lld of bodies %d and %d is out of order", (long long)c, pair.i, pair.j);
            is_valid = false;
        }
        if (!(pair.i >= 0 && pair.i < pair.j))
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
