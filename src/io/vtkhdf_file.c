/// \file vtkhdf_file.c
/// VTKHDF specification 2.0, sections PolyData and Temporal data; the layout is explained in the header.
#define _POSIX_C_SOURCE 200809L
#include "io/vtkhdf_file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// Columns that are not the writer's.
enum
{
    COLUMN_NUM_POINTS = SCREE_VTKHDF_OFFSETS + 1,
    COLUMN_NUM_CELLS,
    COLUMN_NUM_IDS,
    COLUMN_PARTS_SHOWN,
    COLUMN_PART_OFFSETS,
    COLUMN_POINT_OFFSETS,
    COLUMN_CELL_OFFSETS,
    COLUMN_ID_OFFSETS,
    NUM_FIXED_COLUMNS,
    COLUMN_ARRAY_OFFSETS = SCREE_VTKHDF_ARRAYS + SCREE_VTKHDF_MAX_ARRAYS,
    NUM_COLUMNS = COLUMN_ARRAY_OFFSETS + SCREE_VTKHDF_MAX_ARRAYS,
    NUM_TOPOLOGIES = 4,
    COPY_BYTES = 1 << 22
};

/// Vertices, Lines, Polygons, Strips: their order in CellOffsets and ConnectivityIdOffsets.
static const char *const topology_names[NUM_TOPOLOGIES] = {"Vertices", "Lines", "Polygons", "Strips"};

typedef struct column_def
{
    const char *group; ///< NULL: that of the topology
    const char *name;
    scree_field_type type;
    int num_components;
    scree_vtkhdf_extent extent;
} column_def;

static const column_def fixed_columns[NUM_FIXED_COLUMNS] = {
    {"/VTKHDF", "Points", SCREE_FIELD_FLOAT, 3, SCREE_VTKHDF_POINTS},
    {NULL, "Connectivity", SCREE_FIELD_INT32, 1, SCREE_VTKHDF_IDS},
    {NULL, "Offsets", SCREE_FIELD_INT32, 1, SCREE_VTKHDF_CELLS},
    {"/VTKHDF", "NumberOfPoints", SCREE_FIELD_INT64, 1, SCREE_VTKHDF_PARTS},
    {NULL, "NumberOfCells", SCREE_FIELD_INT64, 1, SCREE_VTKHDF_PARTS},
    {NULL, "NumberOfConnectivityIds", SCREE_FIELD_INT64, 1, SCREE_VTKHDF_PARTS},
    {"/VTKHDF/Steps", "NumberOfParts", SCREE_FIELD_INT64, 1, SCREE_VTKHDF_STEPS},
    {"/VTKHDF/Steps", "PartOffsets", SCREE_FIELD_INT64, 1, SCREE_VTKHDF_STEPS},
    {"/VTKHDF/Steps", "PointOffsets", SCREE_FIELD_INT64, 1, SCREE_VTKHDF_STEPS},
    {"/VTKHDF/Steps", "CellOffsets", SCREE_FIELD_INT64, NUM_TOPOLOGIES, SCREE_VTKHDF_STEPS},
    {"/VTKHDF/Steps", "ConnectivityIdOffsets", SCREE_FIELD_INT64, NUM_TOPOLOGIES, SCREE_VTKHDF_STEPS},
};

typedef struct column
{
    column_def def;
    hid_t dataset;       ///< 0: no such column
    int64_t num_written; ///< rows to keep when the file is copied, in use or not yet
} column;

struct scree_vtkhdf_file
{
    char *path;
    char *new_path; ///< until the first step
    scree_vtkhdf_def def;
    int64_t capacity[SCREE_VTKHDF_NUM_EXTENTS];
    int64_t num_used[SCREE_VTKHDF_NUM_EXTENTS];
    hid_t file;
    hid_t values;
    hid_t num_steps;  ///< attribute
    bool is_lost;     ///< a write has failed
    double last_time; ///< [s] of the last step; -infinity if there is none
    column columns[NUM_COLUMNS];
};

// ---- datasets

static int topology_index(const scree_vtkhdf_file *file) { return (int)file->def.topology; }

static const char *current_path(const scree_vtkhdf_file *file)
{
    return file->num_used[SCREE_VTKHDF_STEPS] > 0 ? file->path : file->new_path;
}

/// The columns of the definition, without datasets yet.
static void list_columns(scree_vtkhdf_file *file)
{
    memset(file->columns, 0, sizeof file->columns);
    for (int k = 0; k < NUM_FIXED_COLUMNS; ++k) file->columns[k].def = fixed_columns[k];
    for (int k = 0; k < file->def.num_arrays; ++k)
    {
        const scree_vtkhdf_array *array = file->def.arrays + k;
        const bool is_cell_data = array->extent == SCREE_VTKHDF_CELLS;
        const column_def data = {is_cell_data ? "/VTKHDF/CellData" : "/VTKHDF/PointData", array->field->name,
                                 array->field->type, array->field->num_components, array->extent};
        const column_def offsets = {is_cell_data ? "/VTKHDF/Steps/CellDataOffsets" : "/VTKHDF/Steps/PointDataOffsets",
                                    array->field->name, SCREE_FIELD_INT64, 1, SCREE_VTKHDF_STEPS};
        file->columns[SCREE_VTKHDF_ARRAYS + k].def = data;
        file->columns[COLUMN_ARRAY_OFFSETS + k].def = offsets;
    }
}

static void column_path(const scree_vtkhdf_file *file, const column_def *def, char *path, size_t size)
{
    if (def->group != NULL) snprintf(path, size, "%s/%s", def->group, def->name);
    else snprintf(path, size, "/VTKHDF/%s/%s", topology_names[topology_index(file)], def->name);
}

/// Rows that the column has room for.
static int64_t column_capacity(const scree_vtkhdf_file *file, int k)
{
    const int64_t extent = file->capacity[file->columns[k].def.extent];
    return k == SCREE_VTKHDF_OFFSETS ? extent + file->capacity[SCREE_VTKHDF_PARTS] : extent;
}

static size_t row_size(const column_def *def)
{
    const scree_field field = {NULL, NULL, NULL, def->type, def->num_components, 0};
    return scree_field_size(&field);
}

/// A dataset in one piece whose place in the file is fixed from now on. Unwritten rows read as zero.
static hid_t create_dataset(hid_t file, const char *path, scree_field_type type, int64_t num_rows, int num_components)
{
    const hsize_t size[2] = {(hsize_t)num_rows, (hsize_t)num_components};
    const hid_t space = H5Screate_simple(num_components > 1 ? 2 : 1, size, NULL);
    const hid_t properties = scree_hdf5_properties(H5P_DATASET_CREATE);
    H5Pset_alloc_time(properties, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(properties, H5D_FILL_TIME_NEVER);
    const hid_t dataset =
        H5Dcreate2(file, path, scree_hdf5_file_type(type), space, H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    H5Sclose(space);
    return dataset;
}

/// Reads or writes rows; `buffer` is const when writing.
static bool transfer(const column *column, bool is_writing, int64_t first, int64_t num, void *buffer)
{
    if (num == 0) return true;
    const hsize_t start[2] = {(hsize_t)first, 0};
    const hsize_t count[2] = {(hsize_t)num, (hsize_t)column->def.num_components};
    const int rank = column->def.num_components > 1 ? 2 : 1;
    const hid_t space = H5Dget_space(column->dataset), memory = H5Screate_simple(rank, count, NULL);
    const hid_t type = scree_hdf5_memory_type(column->def.type);
    bool is_done = H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) >= 0;
    if (is_done && is_writing) is_done = H5Dwrite(column->dataset, type, memory, space, H5P_DEFAULT, buffer) >= 0;
    else if (is_done) is_done = H5Dread(column->dataset, type, memory, space, H5P_DEFAULT, buffer) >= 0;
    if (is_done)
    {
        // on failure these two calls would clear the reason
        H5Sclose(memory);
        H5Sclose(space);
    }
    return is_done;
}

static bool write_rows(scree_vtkhdf_file *file, int k, int64_t first, int64_t num, const void *data)
{
    column *column = file->columns + k;
    if (!transfer(column, true, first, num, (void *)data)) return false;
    if (first + num > column->num_written) column->num_written = first + num;
    return true;
}

static void close_datasets(scree_vtkhdf_file *file)
{
    for (int k = 0; k < NUM_COLUMNS; ++k)
        if (file->columns[k].dataset > 0) H5Dclose(file->columns[k].dataset);
    if (file->values > 0) H5Dclose(file->values);
    if (file->num_steps > 0) H5Aclose(file->num_steps);
    file->values = file->num_steps = 0;
}

/// Tells why the last call failed; the file on the disk stays as it is.
static scree_status write_fault(scree_vtkhdf_file *file, scree_report *report)
{
    scree_hdf5_fault(report, file->path, "written");
    scree_hdf5_cut_off(file->file);
    file->is_lost = true;
    return SCREE_WRITE_FAILED;
}

// ---- creation

static bool create_group(hid_t file, const char *path)
{
    const hid_t properties = scree_hdf5_properties(H5P_GROUP_CREATE);
    const hid_t group = H5Gcreate2(file, path, H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    return group >= 0 && H5Gclose(group) >= 0;
}

/// Groups, and the topologies without cells: counts and offsets that stay zero.
static bool create_skeleton(const scree_vtkhdf_file *file)
{
    static const char *const groups[] = {"/VTKHDF",
                                         "/VTKHDF/PointData",
                                         "/VTKHDF/CellData",
                                         "/VTKHDF/Steps",
                                         "/VTKHDF/Steps/PointDataOffsets",
                                         "/VTKHDF/Steps/CellDataOffsets"};
    static const char *const names[] = {"NumberOfCells", "NumberOfConnectivityIds", "Connectivity", "Offsets"};
    bool is_done = true;
    for (size_t k = 0; k < sizeof groups / sizeof groups[0]; ++k)
        is_done = is_done && create_group(file->file, groups[k]);
    for (int t = 0; t < NUM_TOPOLOGIES; ++t)
    {
        char path[64];
        snprintf(path, sizeof path, "/VTKHDF/%s", topology_names[t]);
        is_done = is_done && create_group(file->file, path);
        for (size_t k = 0; k < sizeof names / sizeof names[0] && t != topology_index(file); ++k)
        {
            snprintf(path, sizeof path, "/VTKHDF/%s/%s", topology_names[t], names[k]);
            const scree_field_type type = k < 2 ? SCREE_FIELD_INT64 : SCREE_FIELD_INT32;
            const hid_t dataset = create_dataset(file->file, path, type, file->capacity[SCREE_VTKHDF_PARTS], 1);
            is_done = is_done && dataset >= 0 && H5Dclose(dataset) >= 0;
        }
    }
    const hid_t root = is_done ? H5Gopen2(file->file, "/VTKHDF", H5P_DEFAULT) : -1;
    if (root < 0) return false;
    static const int64_t version[2] = {2, 0};
    const hsize_t two = 2;
    const hid_t space = H5Screate_simple(1, &two, NULL);
    const hid_t attribute = H5Acreate2(root, "Version", H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT);
    is_done = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_INT64, version) >= 0 &&
              scree_hdf5_put_text(root, "Type", "PolyData");
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    H5Gclose(root);
    return is_done;
}

static const char steps_text[] = "steps of time: a step shows one part, from the offsets given";

/// NSteps and Values, one right after the other: what changes in the file's structure with a step lies in one place.
static bool create_times(scree_vtkhdf_file *file)
{
    const int64_t no_steps = 0;
    const hsize_t none = 0, room = (hsize_t)file->capacity[SCREE_VTKHDF_STEPS];
    const hid_t steps = H5Gopen2(file->file, "/VTKHDF/Steps", H5P_DEFAULT);
    const hid_t space = H5Screate_simple(1, &none, &room), properties = scree_hdf5_properties(H5P_DATASET_CREATE);
    H5Pset_chunk(properties, 1, &room);
    H5Pset_alloc_time(properties, H5D_ALLOC_TIME_EARLY);
    // the text fills the head of the group, so that NSteps gets a block of its own at the end, next to Values
    bool is_done = steps >= 0 && scree_hdf5_put_text(steps, "description", steps_text) &&
                   scree_hdf5_put_number(steps, "NSteps", SCREE_FIELD_INT64, &no_steps);
    file->values = H5Dcreate2(steps, "Values", H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    file->num_steps = H5Aopen(steps, "NSteps", H5P_DEFAULT);
    is_done = is_done && file->values >= 0 && file->num_steps >= 0;
    H5Pclose(properties);
    H5Sclose(space);
    if (steps >= 0) H5Gclose(steps);
    return is_done;
}

static bool create_columns(scree_vtkhdf_file *file)
{
    list_columns(file);
    for (int k = 0; k < NUM_COLUMNS; ++k)
    {
        column *column = file->columns + k;
        if (column->def.name == NULL) continue;
        char path[128];
        column_path(file, &column->def, path, sizeof path);
        column->dataset =
            create_dataset(file->file, path, column->def.type, column_capacity(file, k), column->def.num_components);
        if (column->dataset < 0) return false;
        const int array = k - SCREE_VTKHDF_ARRAYS;
        if (array >= 0 && array < file->def.num_arrays &&
            !scree_hdf5_describe(column->dataset, file->def.arrays[array].field))
            return false;
    }
    return true;
}

/// Makes the file `path` with room for `capacity`, no rows written.
static scree_status create_file(scree_vtkhdf_file *file, const char *path, scree_report *report)
{
    file->values = file->num_steps = 0;
    memset(file->columns, 0, sizeof file->columns);
    file->file = scree_hdf5_create(path, report);
    if (file->file < 0) return SCREE_WRITE_FAILED;
    if (!create_skeleton(file) || !create_columns(file) || !create_times(file)) return write_fault(file, report);
    if (scree_hdf5_reserve(file->file, false, path, report)) return SCREE_OK;
    scree_hdf5_cut_off(file->file);
    return SCREE_WRITE_FAILED;
}

/// The part without cells and the one that is never shown, whose cell has no points.
static bool write_first_parts(scree_vtkhdf_file *file)
{
    static const int64_t none[2] = {0, 0}, cells[2] = {0, 1};
    static const int32_t offsets[3] = {0, 0, 0};
    file->num_used[SCREE_VTKHDF_PARTS] = 2;
    file->num_used[SCREE_VTKHDF_CELLS] = 1;
    return write_rows(file, COLUMN_NUM_POINTS, 0, 2, none) && write_rows(file, COLUMN_NUM_CELLS, 0, 2, cells) &&
           write_rows(file, COLUMN_NUM_IDS, 0, 2, none) && write_rows(file, SCREE_VTKHDF_OFFSETS, 0, 3, offsets);
}

static char *path_with(const char *path, const char *ending)
{
    const size_t size = strlen(path) + strlen(ending) + 1;
    char *text = malloc(size);
    if (text != NULL) snprintf(text, size, "%s%s", path, ending);
    return text;
}

/// The object alone, without a file behind it.
static scree_vtkhdf_file *allocate(const char *path, const scree_vtkhdf_def *def)
{
    scree_vtkhdf_file *file = calloc(1, sizeof *file);
    if (file == NULL) return NULL;
    file->path = path_with(path, "");
    file->new_path = path_with(path, ".tmp");
    file->def = *def;
    file->file = -1;
    file->last_time = -INFINITY;
    if (file->path != NULL && file->new_path != NULL) return file;
    free(file->path);
    free(file->new_path);
    free(file);
    return NULL;
}

static scree_status discard(scree_vtkhdf_file *file, scree_status status)
{
    close_datasets(file);
    if (file->file >= 0) H5Fclose(file->file);
    free(file->path);
    free(file->new_path);
    free(file);
    return status;
}

scree_status scree_vtkhdf_create(scree_vtkhdf_file **file, const char *path, const scree_vtkhdf_def *def,
                                 scree_report *report)
{
    *file = NULL;
    scree_vtkhdf_file *f = allocate(path, def);
    if (f == NULL) return SCREE_OUT_OF_MEMORY;
    static const int64_t least[SCREE_VTKHDF_NUM_EXTENTS] = {8, 8, 1, 8, 8, 1};
    for (int k = 0; k < SCREE_VTKHDF_NUM_EXTENTS; ++k)
        f->capacity[k] = def->num_rows[k] > least[k] ? def->num_rows[k] : least[k];

    const scree_hdf5_printing printing = scree_hdf5_silence();
    scree_status status = create_file(f, f->new_path, report);
    if (status == SCREE_OK && !write_first_parts(f)) status = write_fault(f, report);
    if (status == SCREE_OK) *file = f;
    else
    {
        unlink(f->new_path);
        discard(f, status);
    }
    scree_hdf5_restore(printing);
    return status;
}

// ---- growth

static scree_status rename_file(const char *from, const char *to, scree_report *report)
{
    if (rename(from, to) == 0) return SCREE_OK;
    scree_report_add(report, "%s could not be renamed to %s: %s", from, to, strerror(errno));
    return SCREE_WRITE_FAILED;
}

static bool copy_column(const column *from, column *to, void *buffer)
{
    const int64_t num_rows = COPY_BYTES / (int64_t)row_size(&from->def);
    for (int64_t first = 0; first < from->num_written; first += num_rows)
    {
        const int64_t left = from->num_written - first, num = left < num_rows ? left : num_rows;
        if (!transfer(from, false, first, num, buffer) || !transfer(to, true, first, num, buffer)) return false;
    }
    to->num_written = from->num_written;
    return true;
}

/// Times and number of steps to the file on the disk: the write that makes a step visible.
static bool publish(scree_vtkhdf_file *file, int64_t num_steps, const double *times, int64_t num_times)
{
    const hsize_t size = (hsize_t)num_steps, start = (hsize_t)(num_steps - num_times), count = (hsize_t)num_times;
    if (H5Dset_extent(file->values, &size) < 0) return false;
    const hid_t space = H5Dget_space(file->values), memory = H5Screate_simple(1, &count, NULL);
    const bool is_written =
        num_times == 0 || (H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, NULL, &count, NULL) >= 0 &&
                           H5Dwrite(file->values, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, times) >= 0);
    H5Sclose(memory);
    H5Sclose(space);
    return is_written && H5Awrite(file->num_steps, H5T_NATIVE_INT64, &num_steps) >= 0 &&
           H5Fflush(file->file, H5F_SCOPE_LOCAL) >= 0;
}

static bool copy_contents(const scree_vtkhdf_file *from, scree_vtkhdf_file *to)
{
    const int64_t num_steps = from->num_used[SCREE_VTKHDF_STEPS];
    void *buffer = malloc(COPY_BYTES);
    double *times = malloc((size_t)(num_steps + 1) * sizeof *times);
    bool is_done = buffer != NULL && times != NULL;
    for (int k = 0; k < NUM_COLUMNS && is_done; ++k)
        if (from->columns[k].dataset > 0) is_done = copy_column(from->columns + k, to->columns + k, buffer);
    if (is_done && num_steps > 0)
        is_done = H5Dread(from->values, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, times) >= 0 &&
                  H5Fflush(to->file, H5F_SCOPE_LOCAL) >= 0 && publish(to, num_steps, times, num_steps);
    free(times);
    free(buffer);
    return is_done;
}

/// Room for num_rows of the extent, in a larger file that takes the place of this one.
static scree_status grow(scree_vtkhdf_file *file, scree_vtkhdf_extent extent, int64_t num_rows, scree_report *report)
{
    char *path = path_with(file->path, ".grow");
    if (path == NULL) return SCREE_OUT_OF_MEMORY;
    scree_vtkhdf_file larger = *file;
    larger.capacity[extent] = num_rows > 2 * file->capacity[extent] ? num_rows : 2 * file->capacity[extent];
    scree_status status = create_file(&larger, path, report);
    if (status == SCREE_OK && !copy_contents(file, &larger)) status = write_fault(&larger, report);
    if (status == SCREE_OK) status = rename_file(path, current_path(file), report);
    scree_vtkhdf_file *lost = status == SCREE_OK ? file : &larger;
    close_datasets(lost);
    if (lost->file >= 0) H5Fclose(lost->file);
    if (status == SCREE_OK) *file = larger;
    else unlink(path);
    free(path);
    return status;
}

// ---- steps

static scree_status check_alive(const scree_vtkhdf_file *file, scree_report *report)
{
    if (!file->is_lost) return SCREE_OK;
    scree_report_add(report, "%s is not written to any more since a write has failed", file->path);
    return SCREE_WRITE_FAILED;
}

scree_status scree_vtkhdf_write(scree_vtkhdf_file *file, int column, scree_vtkhdf_rows rows, const void *data,
                                scree_report *report)
{
    const scree_hdf5_printing printing = scree_hdf5_silence();
    scree_status status = check_alive(file, report);
    if (status == SCREE_OK && rows.first + rows.num > column_capacity(file, column))
        status = grow(file, file->columns[column].def.extent, rows.first + rows.num, report);
    if (status == SCREE_OK && !write_rows(file, column, rows.first, rows.num, data)) status = write_fault(file, report);
    scree_hdf5_restore(printing);
    return status;
}

scree_status scree_vtkhdf_add_part(scree_vtkhdf_file *file, const int64_t num[SCREE_VTKHDF_NUM_EXTENTS],
                                   scree_vtkhdf_step *step, scree_report *report)
{
    step->part = file->num_used[SCREE_VTKHDF_PARTS];
    step->point_offset = file->num_used[SCREE_VTKHDF_POINTS];
    step->cell_offset = file->num_used[SCREE_VTKHDF_CELLS];
    step->id_offset = file->num_used[SCREE_VTKHDF_IDS];
    static const int columns[3] = {COLUMN_NUM_POINTS, COLUMN_NUM_CELLS, COLUMN_NUM_IDS};
    static const scree_vtkhdf_extent extents[3] = {SCREE_VTKHDF_POINTS, SCREE_VTKHDF_CELLS, SCREE_VTKHDF_IDS};
    scree_status status = SCREE_OK;
    for (int k = 0; k < 3 && status == SCREE_OK; ++k)
        status = scree_vtkhdf_write(file, columns[k], (scree_vtkhdf_rows){step->part, 1}, num + extents[k], report);
    if (status != SCREE_OK) return status;
    ++file->num_used[SCREE_VTKHDF_PARTS];
    for (int k = 0; k < 3; ++k) file->num_used[extents[k]] += num[extents[k]];
    return SCREE_OK;
}

void scree_vtkhdf_add_points(scree_vtkhdf_file *file, int64_t num_points)
{
    file->num_used[SCREE_VTKHDF_POINTS] += num_points;
}

/// Row `row` of the columns of /VTKHDF/Steps.
static bool write_step_rows(scree_vtkhdf_file *file, const scree_vtkhdf_step *step, int64_t row)
{
    const int64_t one = 1, zero = 0;
    int64_t cells[NUM_TOPOLOGIES] = {0}, ids[NUM_TOPOLOGIES] = {0};
    cells[topology_index(file)] = step->cell_offset;
    ids[topology_index(file)] = step->id_offset;
    bool is_done = write_rows(file, COLUMN_PARTS_SHOWN, row, 1, &one) &&
                   write_rows(file, COLUMN_PART_OFFSETS, row, 1, &step->part) &&
                   write_rows(file, COLUMN_POINT_OFFSETS, row, 1, &step->point_offset) &&
                   write_rows(file, COLUMN_CELL_OFFSETS, row, 1, cells) &&
                   write_rows(file, COLUMN_ID_OFFSETS, row, 1, ids);
    for (int k = 0; k < file->def.num_arrays && is_done; ++k)
    {
        const scree_vtkhdf_extent extent = file->def.arrays[k].extent;
        const int64_t *offset = &zero;
        if (extent == SCREE_VTKHDF_CELLS) offset = &step->cell_offset;
        else if (extent == SCREE_VTKHDF_POINTS) offset = &step->point_offset;
        is_done = write_rows(file, COLUMN_ARRAY_OFFSETS + k, row, 1, offset);
    }
    return is_done;
}

scree_status scree_vtkhdf_add_step(scree_vtkhdf_file *file, const scree_vtkhdf_step *step, scree_report *report)
{
    const scree_hdf5_printing printing = scree_hdf5_silence();
    const int64_t row = file->num_used[SCREE_VTKHDF_STEPS];
    scree_status status = check_alive(file, report);
    if (status == SCREE_OK && row + 1 > file->capacity[SCREE_VTKHDF_STEPS])
        status = grow(file, SCREE_VTKHDF_STEPS, row + 1, report);
    // first all that the step refers to, then the step
    if (status == SCREE_OK && (!write_step_rows(file, step, row) || H5Fflush(file->file, H5F_SCOPE_LOCAL) < 0 ||
                               !publish(file, row + 1, &step->time, 1)))
        status = write_fault(file, report);
    if (status == SCREE_OK && row == 0) status = rename_file(file->new_path, file->path, report);
    if (status == SCREE_OK)
    {
        ++file->num_used[SCREE_VTKHDF_STEPS];
        file->last_time = step->time;
    }
    scree_hdf5_restore(printing);
    return status;
}

int64_t scree_vtkhdf_num_steps(const scree_vtkhdf_file *file) { return file->num_used[SCREE_VTKHDF_STEPS]; }

double scree_vtkhdf_last_time(const scree_vtkhdf_file *file) { return file->last_time; }

int64_t scree_vtkhdf_num_rows(const scree_vtkhdf_file *file, scree_vtkhdf_extent extent)
{
    return file->num_used[extent];
}

static bool read_step(const scree_vtkhdf_file *file, int64_t row, scree_vtkhdf_step *step)
{
    int64_t cells[NUM_TOPOLOGIES], ids[NUM_TOPOLOGIES];
    const bool is_done = transfer(file->columns + COLUMN_PART_OFFSETS, false, row, 1, &step->part) &&
                         transfer(file->columns + COLUMN_POINT_OFFSETS, false, row, 1, &step->point_offset) &&
                         transfer(file->columns + COLUMN_CELL_OFFSETS, false, row, 1, cells) &&
                         transfer(file->columns + COLUMN_ID_OFFSETS, false, row, 1, ids);
    step->cell_offset = is_done ? cells[topology_index(file)] : 0;
    step->id_offset = is_done ? ids[topology_index(file)] : 0;
    return is_done;
}

scree_vtkhdf_step scree_vtkhdf_last_step(const scree_vtkhdf_file *file)
{
    scree_vtkhdf_step step = {file->last_time, 0, 0, 0, 0};
    const scree_hdf5_printing printing = scree_hdf5_silence();
    read_step(file, file->num_used[SCREE_VTKHDF_STEPS] - 1, &step);
    scree_hdf5_restore(printing);
    return step;
}

scree_status scree_vtkhdf_close(scree_vtkhdf_file *file, scree_report *report)
{
    if (file == NULL) return SCREE_OK;
    const scree_hdf5_printing printing = scree_hdf5_silence();
    scree_status status = SCREE_OK;
    if (file->num_used[SCREE_VTKHDF_STEPS] == 0)
    {
        unlink(file->new_path);
        scree_hdf5_cut_off(file->file);
    }
    else if (!file->is_lost && H5Fflush(file->file, H5F_SCOPE_LOCAL) < 0) status = write_fault(file, report);
    discard(file, status);
    scree_hdf5_restore(printing);
    return status;
}

// ---- going on

/// Opens the datasets of the definition; the capacity is what they have.
static bool open_columns(scree_vtkhdf_file *file)
{
    list_columns(file);
    for (int k = 0; k < NUM_COLUMNS; ++k)
    {
        column *column = file->columns + k;
        if (column->def.name == NULL) continue;
        char path[128];
        column_path(file, &column->def, path, sizeof path);
        column->dataset = H5Dopen2(file->file, path, H5P_DEFAULT);
        if (column->dataset < 0) return false;
        const hid_t space = H5Dget_space(column->dataset);
        hsize_t size[2] = {0, 1};
        const bool is_fit = H5Sget_simple_extent_ndims(space) == (column->def.num_components > 1 ? 2 : 1) &&
                            H5Sget_simple_extent_dims(space, size, NULL) >= 0 &&
                            size[1] == (hsize_t)column->def.num_components;
        H5Sclose(space);
        if (!is_fit) return false;
        if (k != SCREE_VTKHDF_OFFSETS) file->capacity[column->def.extent] = (int64_t)size[0];
    }
    // offsets are one more than cells in each part
    const hid_t space = H5Dget_space(file->columns[SCREE_VTKHDF_OFFSETS].dataset);
    file->capacity[SCREE_VTKHDF_CELLS] =
        (int64_t)H5Sget_simple_extent_npoints(space) - file->capacity[SCREE_VTKHDF_PARTS];
    H5Sclose(space);
    const int64_t fixed = file->def.num_rows[SCREE_VTKHDF_FIXED_POINTS];
    const hid_t steps = H5Gopen2(file->file, "/VTKHDF/Steps", H5P_DEFAULT);
    if (steps < 0 || (fixed > 0 && fixed != file->capacity[SCREE_VTKHDF_FIXED_POINTS])) return false;
    file->values = H5Dopen2(steps, "Values", H5P_DEFAULT);
    file->num_steps = H5Aopen(steps, "NSteps", H5P_DEFAULT);
    H5Gclose(steps);
    return file->values >= 0 && file->num_steps >= 0;
}

/// Number of steps up to last_time; -1 on failure.
static int64_t count_steps(scree_vtkhdf_file *file, double last_time)
{
    const hid_t space = H5Dget_space(file->values);
    const int64_t num_values = (int64_t)H5Sget_simple_extent_npoints(space);
    H5Sclose(space);
    int64_t num_steps = 0, num_kept = -1;
    double *times = malloc((size_t)(num_values < 0 ? 1 : num_values + 1) * sizeof *times);
    if (times != NULL && num_values >= 0 && H5Aread(file->num_steps, H5T_NATIVE_INT64, &num_steps) >= 0 &&
        (num_values == 0 || H5Dread(file->values, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, times) >= 0))
    {
        num_kept = 0;
        while (num_kept < num_steps && num_kept < num_values && times[num_kept] <= last_time)
            file->last_time = times[num_kept++];
    }
    free(times);
    return num_kept;
}

static void keep_larger(int64_t *value, int64_t other)
{
    if (other > *value) *value = other;
}

/// Rows that the kept steps refer to.
static bool count_rows(scree_vtkhdf_file *file, int64_t num_steps)
{
    int64_t *used = file->num_used;
    used[SCREE_VTKHDF_PARTS] = 2;
    used[SCREE_VTKHDF_CELLS] = 1;
    for (int64_t k = 0; k < num_steps; ++k)
    {
        scree_vtkhdf_step step;
        int64_t points, cells, ids;
        if (!read_step(file, k, &step) || step.part < 0 || step.part >= file->capacity[SCREE_VTKHDF_PARTS] ||
            !transfer(file->columns + COLUMN_NUM_POINTS, false, step.part, 1, &points) ||
            !transfer(file->columns + COLUMN_NUM_CELLS, false, step.part, 1, &cells) ||
            !transfer(file->columns + COLUMN_NUM_IDS, false, step.part, 1, &ids))
            return false;
        keep_larger(used + SCREE_VTKHDF_PARTS, step.part + 1);
        keep_larger(used + SCREE_VTKHDF_POINTS, step.point_offset + points);
        keep_larger(used + SCREE_VTKHDF_CELLS, step.cell_offset + cells);
        keep_larger(used + SCREE_VTKHDF_IDS, step.id_offset + ids);
    }
    used[SCREE_VTKHDF_STEPS] = num_steps;
    used[SCREE_VTKHDF_FIXED_POINTS] = file->capacity[SCREE_VTKHDF_FIXED_POINTS];
    for (int k = 0; k < NUM_COLUMNS; ++k)
    {
        column *column = file->columns + k;
        if (column->dataset <= 0) continue;
        column->num_written = used[column->def.extent] + (k == SCREE_VTKHDF_OFFSETS ? used[SCREE_VTKHDF_PARTS] : 0);
        if (column->num_written > column_capacity(file, k)) return false;
    }
    return true;
}

scree_status scree_vtkhdf_reopen(scree_vtkhdf_file **file, const char *path, const scree_vtkhdf_def *def,
                                 double last_time, scree_report *report)
{
    *file = NULL;
    if (access(path, F_OK) != 0) return scree_vtkhdf_create(file, path, def, report);
    scree_vtkhdf_file *f = allocate(path, def);
    if (f == NULL) return SCREE_OUT_OF_MEMORY;
    const scree_hdf5_printing printing = scree_hdf5_silence();
    f->file = scree_hdf5_open(path, true, report);
    scree_status status = SCREE_READ_FAILED;
    int64_t num_steps = -1;
    if (f->file >= 0 && open_columns(f)) num_steps = count_steps(f, last_time);
    if (num_steps > 0 && count_rows(f, num_steps) && publish(f, num_steps, NULL, 0)) status = SCREE_OK;
    if (status == SCREE_OK) *file = f;
    else discard(f, status);
    scree_hdf5_restore(printing);
    if (num_steps == 0) return scree_vtkhdf_create(file, path, def, report);
    if (status != SCREE_OK)
        scree_report_add(report, "%s is not the file of this run, or it is damaged; move it away to go on without it",
                         path);
    return status;
}
