/// \file mesh_tools.h
/// What several tests of meshes need: building, moving and joining them.
#ifndef SCREE_MESH_TOOLS_H
#define SCREE_MESH_TOOLS_H

#include "harness.h"
#include "polyhedra/mesh.h"

#include <stdlib.h>

/// A mesh from plain arrays; the caller destroys it.
static inline scree_mesh scree_test_mesh(const double (*vertices)[3], int32_t num_vertices,
                                         const int32_t (*triangles)[3], int32_t num_triangles)
{
    scree_mesh mesh;
    if (scree_mesh_create(&mesh, num_vertices, num_triangles) != SCREE_OK) exit(EXIT_FAILURE);
    for (int32_t i = 0; i < num_vertices; ++i)
        mesh.vertices[i] =
            scree_vec3_make((scree_real)vertices[i][0], (scree_real)vertices[i][1], (scree_real)vertices[i][2]);
    for (int32_t i = 0; i < num_triangles; ++i)
        for (int k = 0; k < 3; ++k) mesh.triangles[i].v[k] = triangles[i][k];
    return mesh;
}

static inline void scree_test_mesh_shift(scree_mesh *mesh, double x, double y, double z)
{
    const scree_vec3 d = scree_vec3_make((scree_real)x, (scree_real)y, (scree_real)z);
    for (int32_t i = 0; i < mesh->num_vertices; ++i) mesh->vertices[i] = scree_vec3_add(mesh->vertices[i], d);
}

static inline void scree_test_mesh_scale(scree_mesh *mesh, double x, double y, double z)
{
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
    {
        mesh->vertices[i].x *= (scree_real)x;
        mesh->vertices[i].y *= (scree_real)y;
        mesh->vertices[i].z *= (scree_real)z;
    }
}

static inline void scree_test_mesh_rotate(scree_mesh *mesh, scree_quat q)
{
    const scree_mat3 m = scree_mat3_from_quat(q);
    for (int32_t i = 0; i < mesh->num_vertices; ++i) mesh->vertices[i] = scree_mat3_apply(m, mesh->vertices[i]);
}

static inline void scree_test_mesh_turn_inside_out(scree_mesh *mesh)
{
    for (int32_t i = 0; i < mesh->num_triangles; ++i)
    {
        const int32_t old = mesh->triangles[i].v[1];
        mesh->triangles[i].v[1] = mesh->triangles[i].v[2];
        mesh->triangles[i].v[2] = old;
    }
}

/// Adds the pieces of `part` to `mesh`.
static inline void scree_test_mesh_append(scree_mesh *mesh, const scree_mesh *part)
{
    scree_mesh both;
    if (scree_mesh_create(&both, mesh->num_vertices + part->num_vertices, mesh->num_triangles + part->num_triangles) !=
        SCREE_OK)
        exit(EXIT_FAILURE);
    for (int32_t i = 0; i < both.num_vertices; ++i)
        both.vertices[i] = i < mesh->num_vertices ? mesh->vertices[i] : part->vertices[i - mesh->num_vertices];
    for (int32_t i = 0; i < both.num_triangles; ++i)
    {
        const bool is_new = i >= mesh->num_triangles;
        const scree_triangle t = is_new ? part->triangles[i - mesh->num_triangles] : mesh->triangles[i];
        for (int k = 0; k < 3; ++k) both.triangles[i].v[k] = t.v[k] + (is_new ? mesh->num_vertices : 0);
    }
    scree_mesh_destroy(mesh);
    *mesh = both;
}

/// Uniform over all rotations: a point of the 4-ball, normalised.
static inline scree_quat scree_test_random_rotation(uint64_t *state)
{
    for (;;)
    {
        const double w = 2.0 * scree_test_random(state) - 1.0, x = 2.0 * scree_test_random(state) - 1.0;
        const double y = 2.0 * scree_test_random(state) - 1.0, z = 2.0 * scree_test_random(state) - 1.0;
        const double square = w * w + x * x + y * y + z * z;
        if (square > 1.0 || square < 0.01) continue;
        return scree_quat_normalize(scree_quat_make((scree_real)w, (scree_real)x, (scree_real)y, (scree_real)z));
    }
}

/// True if a message of the report contains the text; prints the messages otherwise.
static inline bool scree_test_report_says(const scree_report *report, const char *text)
{
    for (int i = 0; i < report->num_messages; ++i)
        if (strstr(report->messages[i], text) != NULL) return true;
    printf("no message contains \"%s\":\n", text);
    for (int i = 0; i < report->num_messages; ++i) printf("  %s\n", report->messages[i]);
    return false;
}

/// The mesh is valid; its faults are printed if not.
static inline bool scree_test_is_valid(const scree_mesh *mesh, const char *name)
{
    scree_report report = {0};
    const scree_status status = scree_mesh_validate(mesh, name, &report);
    for (int i = 0; i < report.num_messages; ++i) printf("  %s\n", report.messages[i]);
    const bool is_silent = report.num_messages == 0;
    scree_report_clear(&report);
    return status == SCREE_OK && is_silent;
}

#endif
