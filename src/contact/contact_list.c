#include "contact/contact_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

scree_status scree_contact_list_reserve(scree_contact_list *list, int64_t num_contacts, int64_t num_pairs)
{
    if (num_pairs > list->max_pairs || list->first_of_pair == NULL)
    {
        const int64_t max_pairs = num_pairs + num_pairs / 2 + 16;
        int64_t *first = realloc(list->first_of_pair, (size_t)(max_pairs + 1) * sizeof *first);
        if (first == NULL) return SCREE_OUT_OF_MEMORY;
        if (list->first_of_pair == NULL) first[0] = 0;
        list->first_of_pair = first;
        list->max_pairs = max_pairs;
    }
    if (num_contacts <= list->max_contacts) return SCREE_OK;
    const int64_t max_contacts = num_contacts + num_contacts / 2 + 16;
#define SCREE_GROW(array)                                                               \
    {                                                                                   \
        void *grown = realloc(list->array, (size_t)max_contacts * sizeof *list->array); \
        if (grown == NULL) return SCREE_OUT_OF_MEMORY;                                  \
        list->array = grown;                                                            \
    }
    SCREE_CONTACT_ARRAYS(SCREE_GROW)
#undef SCREE_GROW
#define SCREE_ZERO(array) \
    memset(list->array + list->max_contacts, 0, (size_t)(max_contacts - list->max_contacts) * sizeof *list->array);
    if (list->acts_in_points)
    {
        SCREE_UNTOUCHED_ARRAYS(SCREE_ZERO)
    }
#undef SCREE_ZERO
    list->max_contacts = max_contacts;
    return SCREE_OK;
}

void scree_contact_list_destroy(scree_contact_list *list)
{
#define SCREE_FREE(array) free(list->array);
    SCREE_CONTACT_ARRAYS(SCREE_FREE)
#undef SCREE_FREE
    free(list->first_of_pair);
    *list = (scree_contact_list){0};
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
