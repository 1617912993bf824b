/// \file fields_vtkhdf.c
/// fields.vtkhdf: means over whole periods as ImageData of the VTKHDF format, and the energies of collisions. Written
/// anew, under a temporary name, whenever a period is complete. The format is docs/format_hdf5.md.
#define _POSIX_C_SOURCE 200809L
#include "io/hdf5_file.h"
#include "io/run_folder.h"

#include <math.h>
#include <stdlib.h>

static const scree_field cell_fields[] = {
    {"solid_fraction", "1", "volume of particles over volume of the cell", SCREE_FIELD_DOUBLE, 1, 0},
    {"velocity", "m/s", "momentum over mass", SCREE_FIELD_DOUBLE, 3, 0},
    {"speed", "m/s", "mean speed, by mass", SCREE_FIELD_DOUBLE, 1, 0},
    {"granular_temperature", "m^2/s^2", "a third of the mean square of the deviation from velocity, by mass",
     SCREE_FIELD_DOUBLE, 1, 0},
};
enum
{
    SOLID_FRACTION,
    VELOCITY,
    SPEED,
    TEMPERATURE,
    NUM_CELL_FIELDS
};

/// The mean of one cell; none where no particle has been.
static void cell_mean(const scree_averages *averages, int field, int64_t cell, double *value)
{
    const scree_grid_sums *sums = &averages->grid_total;
    const double *size = averages->cell_size;
    const double num_samples = (double)(averages->num_periods * averages->samples), mass = sums->mass[cell];
    const double *momentum = sums->momentum + 3 * cell;
    double squared = 0;
    for (int k = 0; k < 3; ++k) squared += momentum[k] / mass * (momentum[k] / mass);
    switch (field)
    {
    case SOLID_FRACTION:
        *value = sums->volume[cell] / (num_samples * size[0] * size[1] * size[2]);
        break;
    case VELOCITY:
        for (int k = 0; k < 3; ++k) value[k] = momentum[k] / mass;
        break;
    case SPEED:
        *value = sums->speed[cell] / mass;
        break;
    default:
        *value = fmax(sums->square[cell] / mass - squared, 0) / 3;
        if (!(mass > 0)) *value = (double)NAN;
        break;
    }
}

static bool put_image_array(hid_t group, const scree_averages *averages, int field)
{
    const int num_components = cell_fields[field].num_components;
    const int64_t num_cells = averages->grid_total.num_cells;
    double *values = malloc(((size_t)num_cells * (size_t)num_components + 1) * sizeof *values);
    if (values == NULL) return false;
    for (int64_t c = 0; c < num_cells; ++c) cell_mean(averages, field, c, values + c * num_components);
    // z first, as VTK has it
    const hsize_t size[4] = {(hsize_t)averages->num_cells[2], (hsize_t)averages->num_cells[1],
                             (hsize_t)averages->num_cells[0], (hsize_t)num_components};
    const hid_t space = H5Screate_simple(num_components > 1 ? 4 : 3, size, NULL);
    const hid_t properties = scree_hdf5_properties(H5P_DATASET_CREATE);
    const hid_t dataset =
        H5Dcreate2(group, cell_fields[field].name, H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    H5Sclose(space);
    const bool is_done = dataset >= 0 && scree_hdf5_describe(dataset, cell_fields + field) &&
                         H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
    free(values);
    // left open on failure: closing would clear the reason
    return is_done && H5Dclose(dataset) >= 0;
}

static bool put_numbers(hid_t object, const char *name, hid_t file_type, hid_t memory_type, hsize_t num,
                        const void *values)
{
    const hid_t space = H5Screate_simple(1, &num, NULL);
    const hid_t attribute = H5Acreate2(object, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT);
    const bool is_written = attribute >= 0 && H5Awrite(attribute, memory_type, values) >= 0;
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    return is_written;
}

static hid_t make_group(hid_t parent, const char *name)
{
    const hid_t properties = scree_hdf5_properties(H5P_GROUP_CREATE);
    const hid_t group = H5Gcreate2(parent, name, H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    return group;
}

static bool put_image(hid_t file, const scree_simulation *simulation)
{
    const scree_averages *averages = &simulation->averages;
    const int64_t version[2] = {1, 0};
    const int64_t extent[6] = {0, averages->num_cells[0], 0, averages->num_cells[1], 0, averages->num_cells[2]};
    const double direction[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const hid_t root = make_group(file, "VTKHDF");
    if (root < 0) return false;
    bool is_done =
        scree_hdf5_put_text(root, "Type", "ImageData") &&
        put_numbers(root, "Version", H5T_STD_I64LE, H5T_NATIVE_INT64, 2, version) &&
        put_numbers(root, "WholeExtent", H5T_STD_I64LE, H5T_NATIVE_INT64, 6, extent) &&
        put_numbers(root, "Origin", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3, simulation->scene->fields.region.min) &&
        put_numbers(root, "Spacing", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3, averages->cell_size) &&
        put_numbers(root, "Direction", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 9, direction);
    const hid_t cells = is_done ? make_group(root, "CellData") : -1;
    is_done = cells >= 0;
    for (int k = 0; k < NUM_CELL_FIELDS && is_done; ++k) is_done = put_image_array(cells, averages, k);
    if (is_done) H5Gclose(cells);
    if (is_done) H5Gclose(root);
    return is_done;
}

/// What was averaged over, and the mean power and torque of the walls.
static bool put_averages(hid_t file, const scree_simulation *simulation)
{
    static const scree_field wall_fields[2] = {
        {"power", "W", "mean power of each wall over the periods", SCREE_FIELD_DOUBLE, 1, 0},
        {"torque", "N m", "mean torque of each wall along its turning, while it turned in the periods",
         SCREE_FIELD_DOUBLE, 1, 0},
    };
    const scree_averages *averages = &simulation->averages;
    const int64_t num_walls = averages->works.num_walls;
    const hid_t group = make_group(file, "averages");
    double *values = calloc((size_t)num_walls + 1, sizeof *values);
    bool is_done = group >= 0 && values != NULL &&
                   scree_hdf5_put_number(group, "num_periods", SCREE_FIELD_INT64, &averages->num_periods) &&
                   scree_hdf5_put_number(group, "samples", SCREE_FIELD_INT64, &averages->samples) &&
                   scree_hdf5_put_number(group, "period", SCREE_FIELD_DOUBLE, &averages->period) &&
                   scree_hdf5_put_number(group, "from", SCREE_FIELD_DOUBLE, &averages->from);
    for (int k = 0; k < 2 && is_done; ++k)
    {
        for (int32_t w = 0; w < num_walls; ++w)
            values[w] = k == 0 ? scree_mean_power(simulation, w) : scree_mean_torque(simulation, w);
        is_done = scree_hdf5_put_array(group, wall_fields + k, values, num_walls);
    }
    free(values);
    if (is_done) H5Gclose(group);
    return is_done;
}

/// Edges of the bins and, for collisions of particles and with walls, the rows of the spectrum.
static bool put_collisions(hid_t file, const scree_averages *averages)
{
    static const scree_field edge_field = {
        "bin_edges",        "J", "rows below: under the first edge, between edges, from the last one on",
        SCREE_FIELD_DOUBLE, 1,   0};
    static const char *const names[] = {"collisions_of_particles", "collisions_with_walls"};
    if (averages->num_bins == 0) return true;
    bool is_done = true;
    for (int kind = 0; kind < 2 && is_done; ++kind)
    {
        const hid_t group = make_group(file, names[kind]);
        int num_fields;
        const scree_field *fields = scree_spectrum_fields(&num_fields);
        const int64_t num_rows = averages->num_bins + 2;
        is_done = group >= 0 && scree_hdf5_put_array(group, &edge_field, averages->bin_edges, averages->num_bins + 1);
        for (int k = 0; k < num_fields && is_done; ++k)
        {
            const char *array = scree_field_array(fields + k, &averages->spectrum_total);
            const size_t offset = (size_t)(kind * num_rows) * scree_field_size(fields + k);
            is_done = scree_hdf5_put_array(group, fields + k, array + offset, num_rows);
        }
        if (is_done) H5Gclose(group);
    }
    return is_done;
}

static bool put_everything(hid_t file, const scree_simulation *simulation)
{
    return put_image(file, simulation) && put_averages(file, simulation) && put_collisions(file, &simulation->averages);
}

scree_status scree_fields_save(const scree_simulation *simulation, const char *path, scree_report *report)
{
    return scree_hdf5_save(path, put_everything, simulation, report);
}
