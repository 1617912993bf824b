/// \file import.c
/// Meshes from files through assimp, and to OBJ files.
/// assimp keeps coordinates in single precision, whatever the file has: 2^-24 of the largest coordinate is lost, about
/// seven digits stay. A closed mesh stays closed, because equal numbers are rounded equally. All meshes of a file form
/// one body; vertices that single precision cannot tell apart are joined.
#define _POSIX_C_SOURCE 200809L
#include "polyhedra/import.h"
#include "polyhedra/mesh_edges.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static bool has_known_suffix(const char *path)
{
    static const char *const suffixes[] = {".obj", ".stl", ".ply", ".off"};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot != NULL && i < sizeof suffixes / sizeof suffixes[0]; ++i)
        if (strcasecmp(dot, suffixes[i]) == 0) return true;
    return false;
}

/// Refuses what assimp need not see.
static scree_status check_file(const char *path, scree_report *report)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL)
    {
        const int cause = errno;
        scree_report_add(report, "%s: cannot be opened: %s", path, strerror(cause));
        return cause == ENOENT ? SCREE_NOT_FOUND : SCREE_READ_FAILED;
    }
    const int first = fgetc(file);
    fclose(file);
    if (first == EOF)
    {
        scree_report_add(report, "%s: is empty or not a file", path);
        return SCREE_READ_FAILED;
    }
    if (has_known_suffix(path)) return SCREE_OK;
    scree_report_add(report, "%s: the name must end in .obj, .stl, .ply or .off", path);
    return SCREE_READ_FAILED;
}

/// Room for all meshes of the scene, each with its own vertices.
static scree_status reserve(scree_mesh *mesh, const struct aiScene *scene, const char *path, scree_report *report)
{
    uint64_t num_vertices = 0;
    uint64_t num_triangles = 0;
    for (unsigned int m = 0; m < scene->mNumMeshes; ++m)
    {
        num_vertices += scene->mMeshes[m]->mNumVertices;
        num_triangles += scene->mMeshes[m]->mNumFaces;
    }
    if (num_vertices >= INT32_MAX || num_triangles >= INT32_MAX / 3)
    {
        scree_report_add(report, "%s: has %" PRIu64 " vertices and %" PRIu64 " triangles; simplify it first", path,
                         num_vertices, num_triangles);
        return SCREE_TOO_MANY;
    }
    return scree_mesh_create(mesh, (int32_t)num_vertices, (int32_t)num_triangles);
}

/// Points and lines are left out; returns how many.
static int64_t append_meshes(scree_mesh *mesh, const struct aiScene *scene)
{
    int32_t num_vertices = 0;
    int32_t num_triangles = 0;
    int64_t num_others = 0;
    for (unsigned int m = 0; m < scene->mNumMeshes; ++m)
    {
        const struct aiMesh *part = scene->mMeshes[m];
        for (unsigned int i = 0; i < part->mNumFaces; ++i)
        {
            const struct aiFace *face = part->mFaces + i;
            if (face->mNumIndices != 3)
            {
                ++num_others;
                continue;
            }
            for (int k = 0; k < 3; ++k) mesh->triangles[num_triangles].v[k] = num_vertices + (int32_t)face->mIndices[k];
            ++num_triangles;
        }
        for (unsigned int i = 0; i < part->mNumVertices; ++i)
        {
            const struct aiVector3D p = part->mVertices[i];
            mesh->vertices[num_vertices++] = scree_vec3_make((scree_real)p.x, (scree_real)p.y, (scree_real)p.z);
        }
    }
    mesh->num_triangles = num_triangles;
    return num_others;
}

static double largest_coordinate(const scree_mesh *mesh)
{
    scree_real largest = 0;
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
    {
        const scree_vec3 p = mesh->vertices[i];
        largest = scree_max(largest, scree_max(scree_abs(p.x), scree_max(scree_abs(p.y), scree_abs(p.z))));
    }
    return (double)largest;
}

double scree_mesh_import_rounding(const scree_mesh *mesh) { return 0x1p-24 * largest_coordinate(mesh); }

static scree_status read_scene(scree_mesh *mesh, const char *path, scree_report *report)
{
    // assimp hands out each corner of each face by itself; its own joining takes vertices within 1e-5 for one whatever
    // the size of the mesh, so ours is used
    const struct aiScene *scene = aiImportFile(path, aiProcess_Triangulate);
    if (scene == NULL)
    {
        scree_report_add(report, "%s: cannot be read: %s", path, aiGetErrorString());
        return SCREE_READ_FAILED;
    }
    const scree_status status = reserve(mesh, scene, path, report);
    if (status == SCREE_OK)
    {
        const int64_t num_others = append_meshes(mesh, scene);
        if (num_others > 0)
            scree_report_warn(report, "%s: %" PRId64 " points and lines were left out", path, num_others);
    }
    aiReleaseImport(scene);
    return status;
}

/// Corners in the same place become one vertex without a word; what else is mended is told.
static scree_status join_corners(scree_mesh *mesh, const char *path, scree_report *report)
{
    // otherwise left for the validation to refuse
    if (!scree_mesh_is_computable(mesh)) return SCREE_OK;
    const scree_status status = scree_mesh_weld(mesh, 0.0, path, NULL);
    if (status != SCREE_OK || mesh->num_vertices == 0) return status;
    // whoever wrote the file may have computed one vertex twice, to within a rounding on either side of it, and reading
    // adds as much again
    const scree_box box = scree_mesh_box(mesh);
    const double size = (double)scree_vec3_length(scree_vec3_sub(box.upper, box.lower));
    const double tolerance = size > 0.0 ? 4.0 * scree_mesh_import_rounding(mesh) / size : 0.0;
    return scree_mesh_mend(mesh, tolerance, path, report);
}

scree_status scree_mesh_import(scree_mesh *mesh, const char *path, scree_report *report)
{
    *mesh = (scree_mesh){0};
    scree_status status = check_file(path, report);
    if (status == SCREE_OK) status = read_scene(mesh, path, report);
    if (status != SCREE_OK) return status;
    status = join_corners(mesh, path, report);
    if (status == SCREE_OK) status = scree_mesh_validate(mesh, path, report);
    if (status != SCREE_OK) scree_mesh_destroy(mesh);
    return status;
}

static bool write_obj(const scree_mesh *mesh, FILE *file)
{
    fprintf(file, "# %d vertices, %d triangles; written by scree %s\n", mesh->num_vertices, mesh->num_triangles,
            SCREE_VERSION);
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
    {
        const scree_vec3 p = mesh->vertices[i];
        fprintf(file, "v %.17g %.17g %.17g\n", (double)p.x, (double)p.y, (double)p.z);
    }
    for (int32_t i = 0; i < mesh->num_triangles; ++i)
    {
        const int32_t *v = mesh->triangles[i].v;
        fprintf(file, "f %d %d %d\n", v[0] + 1, v[1] + 1, v[2] + 1);
    }
    return !ferror(file);
}

scree_status scree_mesh_export_obj(const scree_mesh *mesh, const char *path, scree_report *report)
{
    const size_t length = strlen(path) + 32;
    char *temporary = malloc(length);
    if (temporary == NULL) return SCREE_OUT_OF_MEMORY;
    snprintf(temporary, length, "%s.%ld.tmp", path, (long)getpid());
    FILE *file = fopen(temporary, "w");
    int cause = errno;
    bool is_written = file != NULL;
    if (file != NULL)
    {
        is_written = write_obj(mesh, file);
        is_written = fclose(file) == 0 && is_written;
        is_written = is_written && rename(temporary, path) == 0;
        cause = errno;
    }
    if (!is_written)
    {
        scree_report_add(report, "%s: cannot be written: %s", path, strerror(cause));
        if (file != NULL) remove(temporary);
    }
    free(temporary);
    return is_written ? SCREE_OK : SCREE_WRITE_FAILED;
}
