/// \file vtkhdf_file.h
/// A VTKHDF file (temporal PolyData, version 2.0) that is complete at every moment, even if the process is killed.
///
/// Every dataset but one is laid out in one piece with room for what is to come; unused room is a hole in the file and
/// takes no disk space. A new step fills rows nobody refers to yet and is then brought in by one write, of the number
/// of steps (attribute NSteps) and of the length of Steps/Values, which lie side by side: VTK's reader wants them
/// equal. So nothing that a reader needs is ever half changed. A file that has no room left is copied into a larger
/// one, which is renamed over it.
///
/// Cells come in parts; a step shows one part, and several steps may show the same. Part 0 has no cells and is for
/// steps with nothing to show; part 1 has one without points and is never shown: readers differ in how they count parts
/// without cells (VTK 9.3 counts all, VTK 9.7 not those right before the part it reads), and agree on this arrangement.
#ifndef SCREE_VTKHDF_FILE_H
#define SCREE_VTKHDF_FILE_H

#include "io/hdf5_file.h"

/// What the length of a dataset goes with.
typedef enum scree_vtkhdf_extent
{
    SCREE_VTKHDF_STEPS,
    SCREE_VTKHDF_PARTS,
    SCREE_VTKHDF_POINTS,
    SCREE_VTKHDF_CELLS,
    SCREE_VTKHDF_IDS,          ///< point ids of cells
    SCREE_VTKHDF_FIXED_POINTS, ///< point data written once, the same in all steps
    SCREE_VTKHDF_NUM_EXTENTS
} scree_vtkhdf_extent;

/// In the order of the columns of CellOffsets.
typedef enum scree_vtkhdf_topology
{
    SCREE_VTKHDF_VERTICES,
    SCREE_VTKHDF_LINES,
    SCREE_VTKHDF_POLYGONS
} scree_vtkhdf_topology;

/// One array of point data (extent POINTS or FIXED_POINTS) or cell data (extent CELLS).
typedef struct scree_vtkhdf_array
{
    const scree_field *field;
    scree_vtkhdf_extent extent;
} scree_vtkhdf_array;

enum
{
    SCREE_VTKHDF_MAX_ARRAYS = 8,
    SCREE_VTKHDF_EMPTY_PART = 0
};

typedef struct scree_vtkhdf_def
{
    scree_vtkhdf_topology topology;
    int num_arrays;
    scree_vtkhdf_array arrays[SCREE_VTKHDF_MAX_ARRAYS];
    int64_t num_rows[SCREE_VTKHDF_NUM_EXTENTS]; ///< expected; a file grows when there are more
} scree_vtkhdf_def;

/// Columns that a writer fills; array k of the definition is column SCREE_VTKHDF_ARRAYS + k.
enum
{
    SCREE_VTKHDF_POINT_COORDINATES, ///< float, 3 components
    SCREE_VTKHDF_CONNECTIVITY,      ///< int32, ids count from the first point of the part
    SCREE_VTKHDF_OFFSETS,           ///< int32, (cells + 1) per part
    SCREE_VTKHDF_ARRAYS = 16
};

/// What one step shows. Offsets are rows of the first point, cell and id of the part.
typedef struct scree_vtkhdf_step
{
    double time; ///< [s], later than that of the step before
    int64_t part;
    int64_t point_offset;
    int64_t cell_offset;
    int64_t id_offset;
} scree_vtkhdf_step;

typedef struct scree_vtkhdf_file scree_vtkhdf_file;

/// New file at `path`; appears under that name with its first step, until then as "<path>.tmp".
/// SCREE_OUT_OF_MEMORY, SCREE_WRITE_FAILED.
scree_status scree_vtkhdf_create(scree_vtkhdf_file **file, const char *path, const scree_vtkhdf_def *def,
                                 scree_report *report);
/// Goes on with a file of the same definition, without its steps later than `last_time`. A file that is missing or
/// has no step left is made anew. SCREE_OUT_OF_MEMORY, SCREE_READ_FAILED, SCREE_WRITE_FAILED.
scree_status scree_vtkhdf_reopen(scree_vtkhdf_file **file, const char *path, const scree_vtkhdf_def *def,
                                 double last_time, scree_report *report);
/// Frees the file also if SCREE_WRITE_FAILED is returned. NULL is allowed.
scree_status scree_vtkhdf_close(scree_vtkhdf_file *file, scree_report *report);

int64_t scree_vtkhdf_num_steps(const scree_vtkhdf_file *file);
/// [s] of the last step; -infinity if there is none.
double scree_vtkhdf_last_time(const scree_vtkhdf_file *file);
/// Rows in use.
int64_t scree_vtkhdf_num_rows(const scree_vtkhdf_file *file, scree_vtkhdf_extent extent);
/// The last step; only if there is one.
scree_vtkhdf_step scree_vtkhdf_last_step(const scree_vtkhdf_file *file);

/// Rows first .. first + num - 1.
typedef struct scree_vtkhdf_rows
{
    int64_t first, num;
} scree_vtkhdf_rows;

/// Writes rows of a column, growing the file if they do not fit. SCREE_OUT_OF_MEMORY, SCREE_WRITE_FAILED.
scree_status scree_vtkhdf_write(scree_vtkhdf_file *file, int column, scree_vtkhdf_rows rows, const void *data,
                                scree_report *report);
/// Counts of a new part whose points, cells and ids have been written behind the rows in use. The step that is
/// returned shows it. SCREE_WRITE_FAILED.
scree_status scree_vtkhdf_add_part(scree_vtkhdf_file *file, const int64_t num[SCREE_VTKHDF_NUM_EXTENTS],
                                   scree_vtkhdf_step *step, scree_report *report);
/// Counts further points as in use, for steps that show an old part with new points.
void scree_vtkhdf_add_points(scree_vtkhdf_file *file, int64_t num_points);
/// Brings the step in. SCREE_WRITE_FAILED: the file has the steps it had.
scree_status scree_vtkhdf_add_step(scree_vtkhdf_file *file, const scree_vtkhdf_step *step, scree_report *report);

#endif
