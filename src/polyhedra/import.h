/// \file import.h
/// Meshes from files through assimp, and to OBJ files.
#ifndef SCREE_IMPORT_H
#define SCREE_IMPORT_H

#include "polyhedra/mesh.h"

/// Reads OBJ, STL, PLY or OFF, welds, mends what is safe, validates. Everything said goes to the report, faults with
/// their place: coordinates, and numbers that count from 0 in the order of the file's faces and their first corners.
/// SCREE_NOT_FOUND, SCREE_READ_FAILED, SCREE_BAD_MESH.
scree_status scree_mesh_import(scree_mesh *mesh, const char *path, scree_report *report);
/// Largest amount by which the importer may have rounded a coordinate of this mesh, which it keeps in single precision
/// [m].
double scree_mesh_import_rounding(const scree_mesh *mesh);
/// Writes an OBJ with 17 digits, to a temporary name first, then renamed. SCREE_WRITE_FAILED.
scree_status scree_mesh_export_obj(const scree_mesh *mesh, const char *path, scree_report *report);

#endif
