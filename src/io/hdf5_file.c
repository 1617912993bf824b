/// \file hdf5_file.c
#define _POSIX_C_SOURCE 200809L
#include "io/hdf5_file.h"

#include "io/run_folder.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum
{
    METADATA_BYTES = 65536,
    HEAD_BYTES = 4096
};

scree_hdf5_printing scree_hdf5_silence(void)
{
    scree_hdf5_printing printing = {NULL, NULL};
    H5Eget_auto2(H5E_DEFAULT, &printing.function, &printing.data);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    return printing;
}

void scree_hdf5_restore(scree_hdf5_printing printing) { H5Eset_auto2(H5E_DEFAULT, printing.function, printing.data); }

typedef struct reason_text
{
    char *text;
    size_t size;
} reason_text;

/// Keeps the first, deepest entry; of a failed system call only what the system said.
static herr_t keep_first(unsigned n, const H5E_error2_t *error, void *data)
{
    const reason_text *reason = data;
    if (n > 0 || error->desc == NULL) return 0;
    static const char mark[] = "error message = '";
    const char *said = strstr(error->desc, mark);
    if (said == NULL)
    {
        snprintf(reason->text, reason->size, "%s", error->desc);
        return 0;
    }
    said += sizeof mark - 1;
    snprintf(reason->text, reason->size, "%.*s", (int)strcspn(said, "'"), said);
    return 0;
}

void scree_hdf5_reason(char *text, size_t size)
{
    snprintf(text, size, "unknown reason");
    const reason_text reason = {text, size};
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, (void *)&reason);
}

void scree_hdf5_fault(scree_report *report, const char *path, const char *verb)
{
    char reason[512];
    scree_hdf5_reason(reason, sizeof reason);
    scree_report_add(report, "%s could not be %s: %s", path, verb, reason);
}

hid_t scree_hdf5_memory_type(scree_field_type type)
{
    switch (type)
    {
    case SCREE_FIELD_REAL:
        return sizeof(scree_real) == sizeof(double) ? H5T_NATIVE_DOUBLE : H5T_NATIVE_FLOAT;
    case SCREE_FIELD_DOUBLE:
        return H5T_NATIVE_DOUBLE;
    case SCREE_FIELD_FLOAT:
        return H5T_NATIVE_FLOAT;
    case SCREE_FIELD_INT32:
        return H5T_NATIVE_INT32;
    case SCREE_FIELD_INT64:
        return H5T_NATIVE_INT64;
    case SCREE_FIELD_UINT8:
        return H5T_NATIVE_UINT8;
    }
    return -1;
}

hid_t scree_hdf5_file_type(scree_field_type type)
{
    switch (type)
    {
    case SCREE_FIELD_REAL:
        return sizeof(scree_real) == sizeof(double) ? H5T_IEEE_F64LE : H5T_IEEE_F32LE;
    case SCREE_FIELD_DOUBLE:
        return H5T_IEEE_F64LE;
    case SCREE_FIELD_FLOAT:
        return H5T_IEEE_F32LE;
    case SCREE_FIELD_INT32:
        return H5T_STD_I32LE;
    case SCREE_FIELD_INT64:
        return H5T_STD_I64LE;
    case SCREE_FIELD_UINT8:
        return H5T_STD_U8LE;
    }
    return -1;
}

/// Access without locks: a viewer may have the file open.
static hid_t access_properties(void)
{
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_file_locking(access, false, true);
    // closing a file closes what a failure left open in it
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    // metadata of a file close together, in few writes
    H5Pset_meta_block_size(access, METADATA_BYTES);
    return access;
}

/// True if there is room for a small file. HDF5 1.10 must not learn otherwise while it makes one: it would crash when
/// the program ends.
static bool has_room(const char *path, scree_report *report)
{
    const int file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0666);
    const int error = file < 0 ? errno : posix_fallocate(file, 0, HEAD_BYTES);
    if (file >= 0) close(file);
    if (error == 0) return true;
    scree_report_add(report, "%s could not be made: %s", path, strerror(error));
    if (file >= 0) unlink(path);
    return false;
}

hid_t scree_hdf5_create(const char *path, scree_report *report)
{
    if (!has_room(path, report)) return -1;
    const hid_t access = access_properties(), properties = scree_hdf5_properties(H5P_FILE_CREATE);
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, properties, access);
    if (file < 0) scree_hdf5_fault(report, path, "made");
    H5Pclose(properties);
    H5Pclose(access);
    return file;
}

hid_t scree_hdf5_open(const char *path, bool is_writable, scree_report *report)
{
    const hid_t access = access_properties();
    const hid_t file = H5Fopen(path, is_writable ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access);
    if (file < 0) scree_hdf5_fault(report, path, "opened");
    H5Pclose(access);
    return file;
}

bool scree_hdf5_reserve(hid_t file, bool is_all, const char *path, scree_report *report)
{
    void *handle = NULL;
    hsize_t size = 0;
    int error = EIO;
    // the driver of these files keeps its file descriptor there
    if (H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) >= 0 && H5Fget_filesize(file, &size) >= 0)
    {
        const off_t num_reserved = is_all || size < METADATA_BYTES ? (off_t)size : METADATA_BYTES;
        error = ftruncate(*(int *)handle, (off_t)size) != 0 ? errno : 0;
        if (error == 0 && num_reserved > 0) error = posix_fallocate(*(int *)handle, 0, num_reserved);
    }
    if (error != 0) scree_report_add(report, "%s could not be written: %s", path, strerror(error));
    return error == 0;
}

/// A file in memory that has no name.
static int open_nowhere(void)
{
    char name[64];
    snprintf(name, sizeof name, "/scree_%ld", (long)getpid());
    const int nowhere = shm_open(name, O_RDWR | O_CREAT | O_EXCL, 0600);
    if (nowhere < 0) return open("/dev/null", O_RDWR);
    shm_unlink(name);
    return nowhere;
}

/// The structure of the file as far as it is on the disk, which HDF5 may still read, and its length.
static void copy_structure(int from, int to)
{
    struct stat info;
    if (fstat(from, &info) == 0 && ftruncate(to, info.st_size) != 0) return;
    char block[4096];
    for (off_t place = 0; place < 2 * METADATA_BYTES; place += (off_t)sizeof block)
    {
        const ssize_t num = pread(from, block, sizeof block, place);
        if (num <= 0 || pwrite(to, block, (size_t)num, place) != num) return;
    }
}

void scree_hdf5_cut_off(hid_t file)
{
    void *handle = NULL;
    const int nowhere = open_nowhere();
    if (nowhere >= 0 && H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) >= 0)
    {
        copy_structure(*(int *)handle, nowhere);
        dup2(nowhere, *(int *)handle);
    }
    if (nowhere >= 0) close(nowhere);
}

hid_t scree_hdf5_properties(hid_t cls)
{
    const hid_t properties = H5Pcreate(cls);
    H5Pset_obj_track_times(properties, false);
    return properties;
}

bool scree_hdf5_put_text(hid_t object, const char *name, const char *text)
{
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen(text) > 0 ? strlen(text) : 1);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const bool is_written = attribute >= 0 && H5Awrite(attribute, type, text) >= 0;
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
    return is_written;
}

bool scree_hdf5_put_number(hid_t object, const char *name, scree_field_type type, const void *value)
{
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(object, name, scree_hdf5_file_type(type), space, H5P_DEFAULT, H5P_DEFAULT);
    const bool is_written = attribute >= 0 && H5Awrite(attribute, scree_hdf5_memory_type(type), value) >= 0;
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    return is_written;
}

bool scree_hdf5_get_number(hid_t object, const char *name, scree_field_type type, void *value)
{
    const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    if (attribute < 0) return false;
    const hid_t space = H5Aget_space(attribute);
    const bool is_read =
        H5Sget_simple_extent_npoints(space) == 1 && H5Aread(attribute, scree_hdf5_memory_type(type), value) >= 0;
    H5Sclose(space);
    H5Aclose(attribute);
    return is_read;
}

bool scree_hdf5_get_text(hid_t object, const char *name, char *text, size_t size)
{
    const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    if (attribute < 0) return false;
    memset(text, 0, size);
    const hid_t type = H5Aget_type(attribute);
    const bool is_read =
        H5Tget_class(type) == H5T_STRING && H5Tget_size(type) < size && H5Aread(attribute, type, text) >= 0;
    H5Tclose(type);
    H5Aclose(attribute);
    return is_read;
}

bool scree_hdf5_describe(hid_t dataset, const scree_field *field)
{
    return scree_hdf5_put_text(dataset, "unit", field->unit) &&
           scree_hdf5_put_text(dataset, "description", field->text);
}

bool scree_hdf5_put_array(hid_t group, const scree_field *field, const void *array, int64_t num)
{
    const hsize_t size[2] = {(hsize_t)num, (hsize_t)field->num_components};
    const hid_t space = H5Screate_simple(field->num_components > 1 ? 2 : 1, size, NULL);
    const hid_t properties = scree_hdf5_properties(H5P_DATASET_CREATE);
    const hid_t dataset =
        H5Dcreate2(group, field->name, scree_hdf5_file_type(field->type), space, H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    H5Sclose(space);
    if (dataset < 0 || !scree_hdf5_describe(dataset, field)) return false;
    const hid_t type = scree_hdf5_memory_type(field->type);
    // left open on failure: closing would clear the reason
    if (num > 0 && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, array) < 0) return false;
    return H5Dclose(dataset) >= 0;
}

bool scree_hdf5_put_arrays(hid_t file, const char *name, const scree_field *fields, int num_fields,
                           const void *structure)
{
    int64_t num;
    memcpy(&num, structure, sizeof num);
    const hid_t properties = scree_hdf5_properties(H5P_GROUP_CREATE);
    const hid_t group = H5Gcreate2(file, name, H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    bool is_done = group >= 0;
    for (int k = 0; k < num_fields && is_done; ++k)
        is_done = scree_hdf5_put_array(group, fields + k, scree_field_array(fields + k, structure), num);
    if (is_done) H5Gclose(group);
    return is_done;
}

bool scree_hdf5_get_array(hid_t group, const scree_field *field, void *array, int64_t num)
{
    const hid_t dataset = H5Dopen2(group, field->name, H5P_DEFAULT);
    if (dataset < 0) return false;
    const hid_t space = H5Dget_space(dataset);
    hsize_t size[2] = {0, 1};
    bool is_done = H5Sget_simple_extent_ndims(space) == (field->num_components > 1 ? 2 : 1) &&
                   H5Sget_simple_extent_dims(space, size, NULL) >= 0 && size[0] == (hsize_t)num &&
                   size[1] == (hsize_t)field->num_components;
    H5Sclose(space);
    if (is_done && num > 0)
        is_done = H5Dread(dataset, scree_hdf5_memory_type(field->type), H5S_ALL, H5S_ALL, H5P_DEFAULT, array) >= 0;
    H5Dclose(dataset);
    return is_done;
}

bool scree_hdf5_get_arrays(hid_t file, const char *name, const scree_field *fields, int num_fields,
                           const void *structure)
{
    int64_t num;
    memcpy(&num, structure, sizeof num);
    const hid_t group = H5Gopen2(file, name, H5P_DEFAULT);
    bool is_done = group >= 0;
    for (int k = 0; k < num_fields && is_done; ++k)
        is_done = scree_hdf5_get_array(group, fields + k, scree_field_array(fields + k, structure), num);
    if (group >= 0) H5Gclose(group);
    return is_done;
}

static scree_status write_all(const char *temporary, scree_hdf5_put put, const scree_simulation *simulation,
                              scree_report *report)
{
    const hid_t file = scree_hdf5_create(temporary, report);
    if (file < 0) return SCREE_WRITE_FAILED;
    bool is_written = put(file, simulation);
    if (!is_written) scree_hdf5_fault(report, temporary, "written");
    is_written = is_written && scree_hdf5_reserve(file, true, temporary, report);
    if (!is_written) scree_hdf5_cut_off(file);
    const bool is_closed = H5Fclose(file) >= 0;
    if (is_written && !is_closed) scree_hdf5_fault(report, temporary, "closed");
    return is_written && is_closed ? SCREE_OK : SCREE_WRITE_FAILED;
}

scree_status scree_hdf5_save(const char *path, scree_hdf5_put put, const scree_simulation *simulation,
                             scree_report *report)
{
    const size_t length = strlen(path) + 5;
    char *temporary = malloc(length);
    if (temporary == NULL) return SCREE_OUT_OF_MEMORY;
    snprintf(temporary, length, "%s.tmp", path);
    const scree_hdf5_printing printing = scree_hdf5_silence();
    scree_status status = write_all(temporary, put, simulation, report);
    scree_hdf5_restore(printing);
    if (status == SCREE_OK) status = scree_put_in_place(temporary, path, report);
    if (status != SCREE_OK) unlink(temporary);
    free(temporary);
    return status;
}
