/// \file import.c
/// Meshes from files through assimp, and to OBJ files.
/// assimp keeps coordinates in single precision, whatever the file has. A number without exponent is rounded once, by
/// 2^-24 of its size; one with an exponent is multiplied by a rounded power of ten, and loses up to 2^-22: six to seven
/// digits stay. A closed mesh stays closed, because equal numbers are rounded equally. All meshes of a file form
/// one body; vertices that single precision cannot tell apart are joined. Polygons are cut and vertices joined here:
/// assimp's own steps cut concave polygons wrong and join whatever is within 1e-5, however small the mesh.
#define _POSIX_C_SOURCE 200809L
#include "polyhedra/import.h"
#include "polyhedra/mesh_edges.h"
#include "polyhedra/polygon.h"

#include <assimp/cimport.h>
#include <assimp/scene.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static bool has_suffix(const char *path, const char *suffix)
{
    const char *dot = strrchr(path, '.');
    return dot != NULL && strcasecmp(dot, suffix) == 0;
}

static bool has_known_suffix(const char *path)
{
    return has_suffix(path, ".obj") || has_suffix(path, ".stl") || has_suffix(path, ".ply") || has_suffix(path, ".off");
}

/// True if the lines of the header are all of a PLY file's kinds, up to the last one. assimp reads on without end where
/// that is missing or garbled.
static bool has_ply_header(FILE *file)
{
    static const char *const keywords[] = {"ply", "format ", "comment", "obj_info", "element ", "property "};
    char line[1024];
    while (fgets(line, sizeof line, file) != NULL)
    {
        line[strcspn(line, "\r\n")] = '\0';
        if (strcmp(line, "end_header") == 0) return true;
        bool is_known = false;
        for (size_t i = 0; i < sizeof keywords / sizeof keywords[0]; ++i)
            is_known = is_known || strncmp(line, keywords[i], strlen(keywords[i])) == 0;
        if (!is_known) return false;
    }
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
    const bool is_empty = fgetc(file) == EOF;
    rewind(file);
    const bool is_complete = !has_suffix(path, ".ply") || has_ply_header(file);
    fclose(file);
    if (is_empty)
    {
        scree_report_add(report, "%s: is empty or not a file", path);
        return SCREE_READ_FAILED;
    }
    if (!is_complete)
    {
        scree_report_add(report, "%s: cannot be read: its header is damaged or has no line end_header", path);
        return SCREE_READ_FAILED;
    }
    if (has_known_suffix(path)) return SCREE_OK;
    scree_report_add(report, "%s: the name must end in .obj, .stl, .ply or .off", path);
    return SCREE_READ_FAILED;
}

/// What the scene holds in all its meshes.
typedef struct scene_counts
{
    uint64_t num_vertices;
    uint64_t num_triangles; ///< after cutting the polygons
    uint64_t num_others;    ///< points and lines
    uint32_t max_corners;   ///< of one polygon
} scene_counts;

static scene_counts count(const struct aiScene *scene)
{
    scene_counts counts = {0};
    for (unsigned int m = 0; m < scene->mNumMeshes; ++m)
    {
        const struct aiMesh *part = scene->mMeshes[m];
        counts.num_vertices += part->mNumVertices;
        for (unsigned int i = 0; i < part->mNumFaces; ++i)
        {
            const uint32_t num = part->mFaces[i].mNumIndices;
            if (num < 3) ++counts.num_others;
            else counts.num_triangles += num - 2;
            if (num > counts.max_corners) counts.max_corners = num;
        }
    }
    return counts;
}

/// assimp hands on the corners of damaged files as they are.
static bool has_corners_in_range(const struct aiScene *scene, const char *path, scree_report *report)
{
    for (unsigned int m = 0; m < scene->mNumMeshes; ++m)
    {
        const struct aiMesh *part = scene->mMeshes[m];
        for (unsigned int i = 0; i < part->mNumFaces; ++i)
        {
            const struct aiFace *face = part->mFaces + i;
            for (unsigned int k = 0; k < face->mNumIndices; ++k)
            {
                if (face->mIndices[k] < part->mNumVertices) continue;
                scree_report_add(report, "%s: face %u refers to vertex %u; there are %u vertices", path, i,
                                 face->mIndices[k], part->mNumVertices);
                return false;
            }
        }
    }
    return true;
}

/// Room for cutting one polygon.
typedef struct polygon_buffers
{
    scree_vec3 *corners;
    int32_t (*triangles)[3];
    int32_t *scratch;
} polygon_buffers;

static bool reserve_polygon(polygon_buffers *buffers, uint32_t max_corners)
{
    const size_t num = (size_t)max_corners + 1;
    buffers->corners = malloc(num * sizeof *buffers->corners);
    buffers->triangles = malloc(num * sizeof *buffers->triangles);
    buffers->scratch = malloc(num * sizeof *buffers->scratch);
    return buffers->corners != NULL && buffers->triangles != NULL && buffers->scratch != NULL;
}

static void destroy_polygon(polygon_buffers *buffers)
{
    free(buffers->corners);
    free(buffers->triangles);
    free(buffers->scratch);
}

/// The triangles of one face, from triangle number `first` on; its vertices are in the mesh from `offset` on.
static int32_t append_face(scree_mesh *mesh, const struct aiFace *face, int32_t offset, int32_t first,
                           const polygon_buffers *buffers)
{
    const int32_t num = (int32_t)face->mNumIndices;
    for (int32_t k = 0; k < num; ++k) buffers->corners[k] = mesh->vertices[offset + (int32_t)face->mIndices[k]];
    scree_polygon_triangulate(buffers->corners, num, buffers->triangles, buffers->scratch);
    for (int32_t t = 0; t < num - 2; ++t)
        for (int k = 0; k < 3; ++k)
            mesh->triangles[first + t].v[k] = offset + (int32_t)face->mIndices[buffers->triangles[t][k]];
    return num - 2;
}

static void append_meshes(scree_mesh *mesh, const struct aiScene *scene, const polygon_buffers *buffers)
{
    int32_t num_vertices = 0;
    int32_t num_triangles = 0;
    for (unsigned int m = 0; m < scene->mNumMeshes; ++m)
    {
        const struct aiMesh *part = scene->mMeshes[m];
        const int32_t offset = num_vertices;
        for (unsigned int i = 0; i < part->mNumVertices; ++i)
        {
            const struct aiVector3D p = part->mVertices[i];
            mesh->vertices[num_vertices++] = scree_vec3_make((scree_real)p.x, (scree_real)p.y, (scree_real)p.z);
        }
        for (unsigned int i = 0; i < part->mNumFaces; ++i)
            if (part->mFaces[i].mNumIndices >= 3)
                num_triangles += append_face(mesh, part->mFaces + i, offset, num_triangles, buffers);
    }
}

static scree_status take_scene(scree_mesh *mesh, const struct aiScene *scene, const char *path, scree_report *report)
{
    const scene_counts counts = count(scene);
    if (!has_corners_in_range(scene, path, report)) return SCREE_BAD_MESH;
    if (counts.num_vertices >= INT32_MAX || counts.num_triangles >= INT32_MAX / 3)
    {
        scree_report_add(report, "%s: has %" PRIu64 " vertices and %" PRIu64 " triangles; simplify it first", path,
                         counts.num_vertices, counts.num_triangles);
        return SCREE_TOO_MANY;
    }
    if (counts.num_others > 0)
        scree_report_warn(report, "%s: %" PRIu64 " points and lines were left out", path, counts.num_others);
    polygon_buffers buffers = {0};
    scree_status status = SCREE_OUT_OF_MEMORY;
    if (reserve_polygon(&buffers, counts.max_corners))
        status = scree_mesh_create(mesh, (int32_t)counts.num_vertices, (int32_t)counts.num_triangles);
    if (status == SCREE_OK) append_meshes(mesh, scene, &buffers);
    destroy_polygon(&buffers);
    return status;
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

double scree_mesh_import_rounding(const scree_mesh *mesh) { return 0x1p-22 * largest_coordinate(mesh); }

static scree_status read_scene(scree_mesh *mesh, const char *path, scree_report *report)
{
    // no steps of assimp's: each corner of each face comes by itself, polygons come whole
    const struct aiScene *scene = aiImportFile(path, 0);
    if (scene == NULL)
    {
        scree_report_add(report, "%s: cannot be read: %s", path, aiGetErrorString());
        return SCREE_READ_FAILED;
    }
    const scree_status status = take_scene(mesh, scene, path, report);
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
    // whoever wrote the file may have written one vertex in two ways, and each is read to within the rounding
    const double size = scree_box_diagonal(scree_mesh_box(mesh));
    const double tolerance = size > 0.0 ? 2.0 * scree_mesh_import_rounding(mesh) / size : 0.0;
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
