#include "io/averages_hdf5.h"
#include "core/hash.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum
{
    NUM_PARTS = 6,
    HASH_TEXT = 17
};

/// A group of arrays; the number of items is the first member of the structure.
typedef struct averages_part
{
    const char *name;
    const scree_field *fields;
    int num_fields;
    const void *structure;
} averages_part;

static void list_parts(const scree_averages *averages, averages_part parts[NUM_PARTS])
{
    parts[0] = (averages_part){.name = "grid", .structure = &averages->grid};
    parts[1] = (averages_part){.name = "grid_total", .structure = &averages->grid_total};
    parts[2] = (averages_part){.name = "spectrum", .structure = &averages->spectrum};
    parts[3] = (averages_part){.name = "spectrum_total", .structure = &averages->spectrum_total};
    parts[4] = (averages_part){.name = "works", .structure = &averages->works};
    parts[5] = (averages_part){.name = "collisions", .structure = &averages->collisions};
    for (int k = 0; k < NUM_PARTS; ++k)
        parts[k].fields = k < 2    ? scree_grid_fields(&parts[k].num_fields)
                          : k < 4  ? scree_spectrum_fields(&parts[k].num_fields)
                          : k == 4 ? scree_period_work_fields(&parts[k].num_fields)
                                   : scree_collision_fields(&parts[k].num_fields);
}

static uint64_t hash_numbers(uint64_t hash, const double *numbers, int num)
{
    return scree_hash_bytes(hash, numbers, (size_t)num * sizeof *numbers);
}

/// Of the section of the scene: averages of another one cannot be gone on with.
static uint64_t section_hash(const scree_simulation *s)
{
    const scree_averages *averages = &s->averages;
    const scree_fields_def *def = &s->scene->fields;
    const double times[] = {averages->from, averages->period, (double)averages->samples};
    const double bins[] = {(double)averages->num_bins, def->energy_min, def->energy_max};
    uint64_t hash = hash_numbers(0, def->region.min, 3);
    hash = hash_numbers(hash, def->region.max, 3);
    hash = hash_numbers(hash, def->cells, 3);
    hash = hash_numbers(hash, times, 3);
    return hash_numbers(hash, bins, averages->num_bins > 0 ? 3 : 1);
}

static uint64_t contents_hash(const scree_averages *averages)
{
    averages_part parts[NUM_PARTS];
    list_parts(averages, parts);
    uint64_t hash = scree_hash_bytes(0, &averages->num_samples, sizeof averages->num_samples);
    hash = scree_hash_bytes(hash, &averages->num_periods, sizeof averages->num_periods);
    for (int k = 0; k < NUM_PARTS; ++k)
    {
        int64_t num;
        memcpy(&num, parts[k].structure, sizeof num);
        for (int f = 0; f < parts[k].num_fields && num > 0; ++f)
            hash = scree_hash_bytes(hash, scree_field_array(parts[k].fields + f, parts[k].structure),
                                    (size_t)num * scree_field_size(parts[k].fields + f));
    }
    return hash;
}

static bool put_hash(hid_t object, const char *name, uint64_t hash)
{
    char text[HASH_TEXT];
    snprintf(text, sizeof text, "%016" PRIx64, hash);
    return scree_hdf5_put_text(object, name, text);
}

static bool get_hash(hid_t object, const char *name, uint64_t *hash)
{
    char text[HASH_TEXT];
    return scree_hdf5_get_text(object, name, text, sizeof text) && sscanf(text, "%16" SCNx64, hash) == 1;
}

bool scree_averages_put(hid_t file, const scree_simulation *simulation)
{
    const scree_averages *averages = &simulation->averages;
    if (!averages->is_on) return true;
    const hid_t properties = scree_hdf5_properties(H5P_GROUP_CREATE);
    const hid_t group = H5Gcreate2(file, "/averages", H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    if (group < 0) return false;
    averages_part parts[NUM_PARTS];
    list_parts(averages, parts);
    bool is_done = scree_hdf5_put_number(group, "num_samples", SCREE_FIELD_INT64, &averages->num_samples) &&
                   scree_hdf5_put_number(group, "num_periods", SCREE_FIELD_INT64, &averages->num_periods) &&
                   put_hash(group, "section_hash", section_hash(simulation)) &&
                   put_hash(group, "contents_hash", contents_hash(averages));
    for (int k = 0; k < NUM_PARTS && is_done; ++k)
        is_done = scree_hdf5_put_arrays(group, parts[k].name, parts[k].fields, parts[k].num_fields, parts[k].structure);
    if (is_done) H5Gclose(group);
    return is_done;
}

static bool read_parts(hid_t group, scree_averages *averages)
{
    averages_part parts[NUM_PARTS];
    list_parts(averages, parts);
    uint64_t hash = 0;
    bool is_done = scree_hdf5_get_number(group, "num_samples", SCREE_FIELD_INT64, &averages->num_samples) &&
                   scree_hdf5_get_number(group, "num_periods", SCREE_FIELD_INT64, &averages->num_periods) &&
                   get_hash(group, "contents_hash", &hash);
    for (int k = 0; k < NUM_PARTS && is_done; ++k)
        is_done = scree_hdf5_get_arrays(group, parts[k].name, parts[k].fields, parts[k].num_fields, parts[k].structure);
    return is_done && hash == contents_hash(averages);
}

/// The group of the averages if it is of the scene's section; negative if there is none.
static hid_t open_group(hid_t file, const scree_simulation *simulation)
{
    if (H5Lexists(file, "/averages", H5P_DEFAULT) <= 0) return -1;
    const hid_t group = H5Gopen2(file, "/averages", H5P_DEFAULT);
    uint64_t hash = 0;
    if (group < 0 || (get_hash(group, "section_hash", &hash) && hash == section_hash(simulation))) return group;
    H5Gclose(group);
    return -1;
}

scree_status scree_averages_get(hid_t file, scree_simulation *simulation, int64_t num_contacts, bool *is_read,
                                scree_report *report)
{
    scree_averages *averages = &simulation->averages;
    *is_read = false;
    if (!averages->is_on) return SCREE_OK;
    const hid_t group = open_group(file, simulation);
    if (group < 0)
    {
        scree_report_warn(report, "the checkpoint has no averages of these fields: they start anew, with the first "
                                  "whole period from here");
        return SCREE_OK;
    }
    scree_status status = SCREE_OK;
    if (averages->num_bins > 0) status = scree_collisions_reserve(&averages->collisions, num_contacts);
    *is_read = status == SCREE_OK && read_parts(group, averages);
    H5Gclose(group);
    if (*is_read || status != SCREE_OK) return status;
    scree_averages_restart(simulation);
    scree_report_add(report, "the checkpoint is damaged: its averages are not what was written");
    return SCREE_READ_FAILED;
}
