/// \file hdf5_file.h
/// The little that scree needs around HDF5: silence, the reason of a failure, types, attributes.
#ifndef SCREE_HDF5_FILE_H
#define SCREE_HDF5_FILE_H

#include "io/fields.h"

#include <hdf5.h>

/// The error printing of the process as it was before scree_hdf5_silence().
typedef struct scree_hdf5_printing
{
    H5E_auto2_t function;
    void *data;
} scree_hdf5_printing;

/// HDF5 prints to stderr by itself: every public function of io is bracketed by these two.
scree_hdf5_printing scree_hdf5_silence(void);
void scree_hdf5_restore(scree_hdf5_printing printing);

/// Why the last call failed, from the bottom of HDF5's error stack ("No space left on device"); call at once.
void scree_hdf5_reason(char *text, size_t size);
/// Adds "<path> could not be <verb>: <reason>" to the report.
void scree_hdf5_fault(scree_report *report, const char *path, const char *verb);

hid_t scree_hdf5_memory_type(scree_field_type type);
/// Little-endian type in the file, the same on every machine.
hid_t scree_hdf5_file_type(scree_field_type type);

/// New file without time stamps, so that equal contents are equal bytes. Not locked: others may read while scree
/// writes. Negative on failure, as all hid_t; the reason goes to the report.
hid_t scree_hdf5_create(const char *path, scree_report *report);
/// Writes the contents of a file; false on failure.
typedef bool (*scree_hdf5_put)(hid_t file, const scree_simulation *simulation);
/// A whole file through a temporary name, path.tmp, which is renamed once all is on the disk; silent.
/// SCREE_WRITE_FAILED, SCREE_OUT_OF_MEMORY: what was at path is still there; the reason goes to the report.
scree_status scree_hdf5_save(const char *path, scree_hdf5_put put, const scree_simulation *simulation,
                             scree_report *report);
/// Existing file. Negative on failure; the reason goes to the report.
hid_t scree_hdf5_open(const char *path, bool is_writable, scree_report *report);
/// Makes sure of the disk space of the file's structure (`is_all`: of all it holds) before it is first flushed, since
/// HDF5 1.10 does not survive a failure there. False if there is none; the reason goes to the report.
bool scree_hdf5_reserve(hid_t file, bool is_all, const char *path, scree_report *report);
/// After a failed write: leaves the file on the disk as it is, whatever is written or closed later. HDF5 1.10 cannot
/// close a file whose last bytes do not find room: it fails, and crashes when the program ends.
void scree_hdf5_cut_off(hid_t file);
/// Property list for groups or datasets (cls as for H5Pcreate) without time stamps.
hid_t scree_hdf5_properties(hid_t cls);

/// Attributes of one number, or a short fixed text. False on failure.
bool scree_hdf5_put_text(hid_t object, const char *name, const char *text);
bool scree_hdf5_put_number(hid_t object, const char *name, scree_field_type type, const void *value);
/// Reads an attribute of one number in the given type. False if it is missing or no single number.
bool scree_hdf5_get_number(hid_t object, const char *name, scree_field_type type, void *value);
/// Reads an attribute with a text of fewer than `size` characters.
bool scree_hdf5_get_text(hid_t object, const char *name, char *text, size_t size);
/// An array of num items, described by its field.
bool scree_hdf5_put_array(hid_t group, const scree_field *field, const void *array, int64_t num);
/// Reads it back; false if its type, shape or number is another.
bool scree_hdf5_get_array(hid_t group, const scree_field *field, void *array, int64_t num);
/// All arrays of a structure as a group; the number of items is the first member of the structure, an int64_t.
bool scree_hdf5_put_arrays(hid_t file, const char *name, const scree_field *fields, int num_fields,
                           const void *structure);
bool scree_hdf5_get_arrays(hid_t file, const char *name, const scree_field *fields, int num_fields,
                           const void *structure);
/// unit and description of a field as attributes of its dataset.
bool scree_hdf5_describe(hid_t dataset, const scree_field *field);

#endif
