/// \file fields.h
/// Name, unit and meaning of everything that is written: one table per file. Headers of columns, HDF5 attributes and
/// summary.json are made from these tables.
#ifndef SCREE_FIELDS_H
#define SCREE_FIELDS_H

#include "dynamics/state.h"

typedef enum scree_field_type
{
    SCREE_FIELD_REAL, ///< scree_real
    SCREE_FIELD_DOUBLE,
    SCREE_FIELD_FLOAT,
    SCREE_FIELD_INT32,
    SCREE_FIELD_INT64,
    SCREE_FIELD_UINT8
} scree_field_type;

typedef struct scree_field
{
    const char *name;
    const char *unit; ///< "1" if dimensionless
    const char *text; ///< meaning, one line
    scree_field_type type;
    int num_components;
    size_t offset; ///< of the value, or of the pointer to the array, in the structure the table is for
} scree_field;

/// One row of series.csv.
typedef struct scree_series_row
{
    double time;
    int64_t step;
    scree_energies energies;
    double balance;
    scree_counters counters;
    double coordination_number; ///< mean number of contacts per particle, walls counted
} scree_series_row;

scree_series_row scree_series_row_of(const scree_simulation *simulation);

/// The tables. (*num_fields) entries; offsets are into scree_series_row, scree_particles, scree_contact_list and
/// scree_wall_loads.
const scree_field *scree_series_fields(int *num_fields);
const scree_field *scree_particle_fields(int *num_fields);
/// How many of the first particle fields are the moving state; the others are constant.
int scree_num_moving_particle_fields(void);
const scree_field *scree_contact_fields(int *num_fields);
const scree_field *scree_wall_fields(int *num_fields);
/// Parts of the averages: scree_grid_sums, scree_spectrum, scree_collisions, scree_period_works.
const scree_field *scree_grid_fields(int *num_fields);
const scree_field *scree_spectrum_fields(int *num_fields);
const scree_field *scree_collision_fields(int *num_fields);
const scree_field *scree_period_work_fields(int *num_fields);
/// Arrays of frames.vtkhdf, spheres.vtkhdf, walls.vtkhdf and contacts.vtkhdf; offsets unused.
extern const scree_field scree_frame_particle, scree_frame_group, scree_frame_speed;
extern const scree_field scree_frame_radius, scree_frame_velocity;
extern const scree_field scree_frame_wall;
extern const scree_field scree_frame_i, scree_frame_j, scree_frame_normal_force, scree_frame_tangential_force,
    scree_frame_indentation, scree_frame_volume, scree_frame_slipping;

/// Bytes of one item (all components).
size_t scree_field_size(const scree_field *field);
/// The array that `field` names in `structure`.
void *scree_field_array(const scree_field *field, const void *structure);
/// The number that `field` names in `structure`.
double scree_field_value(const scree_field *field, const void *structure);

#endif
