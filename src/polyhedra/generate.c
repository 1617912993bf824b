/// \file generate.c
/// Meshes given by a few coordinates.
#include "polyhedra/generate.h"

#include <math.h>

static bool is_length(double x) { return x > 0.0 && x <= 1e30 && x >= 1e-30; }

static scree_vec3 point(double x, double y, double z)
{
    return scree_vec3_make((scree_real)x, (scree_real)y, (scree_real)z);
}

scree_status scree_generate_box(scree_mesh *mesh, const double size[3])
{
    // two triangles for each face; corner i has the sign of bit k of i along axis k
    static const int32_t faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                         {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    *mesh = (scree_mesh){0};
    if (!is_length(size[0]) || !is_length(size[1]) || !is_length(size[2])) return SCREE_INVALID_INPUT;
    const scree_status status = scree_mesh_create(mesh, 8, 12);
    if (status != SCREE_OK) return status;
    for (int i = 0; i < 8; ++i)
        mesh->vertices[i] =
            point((i & 1 ? 0.5 : -0.5) * size[0], (i & 2 ? 0.5 : -0.5) * size[1], (i & 4 ? 0.5 : -0.5) * size[2]);
    for (int i = 0; i < 12; ++i)
        for (int k = 0; k < 3; ++k) mesh->triangles[i].v[k] = faces[i][k];
    return SCREE_OK;
}

scree_status scree_generate_tetrahedron(scree_mesh *mesh, double radius)
{
    static const int32_t faces[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    *mesh = (scree_mesh){0};
    if (!is_length(radius)) return SCREE_INVALID_INPUT;
    const scree_status status = scree_mesh_create(mesh, 4, 4);
    if (status != SCREE_OK) return status;
    // alternate corners of a cube
    const double s = radius / sqrt(3.0);
    mesh->vertices[0] = point(s, s, s);
    mesh->vertices[1] = point(s, -s, -s);
    mesh->vertices[2] = point(-s, s, -s);
    mesh->vertices[3] = point(-s, -s, s);
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) mesh->triangles[i].v[k] = faces[i][k];
    return SCREE_OK;
}

scree_status scree_generate_schoenhardt(scree_mesh *mesh, double radius)
{
    // bottom and top triangle, and for each side of the prism two triangles about its longer diagonal, which is concave
    static const int32_t faces[8][3] = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                                        {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    *mesh = (scree_mesh){0};
    if (!is_length(radius)) return SCREE_INVALID_INPUT;
    const scree_status status = scree_mesh_create(mesh, 6, 8);
    if (status != SCREE_OK) return status;
    // a prism over an equilateral triangle, as high as the triangle's side, its top turned by 30 degrees; rim radius r
    // and half height r sqrt(3)/2 together reach the sphere
    const double rim = radius / sqrt(1.75);
    const double half_height = 0.5 * sqrt(3.0) * rim;
    const double half = 0.5 * rim;
    const double root = 0.5 * sqrt(3.0) * rim;
    mesh->vertices[0] = point(rim, 0.0, -half_height);
    mesh->vertices[1] = point(-half, root, -half_height);
    mesh->vertices[2] = point(-half, -root, -half_height);
    mesh->vertices[3] = point(root, half, half_height);
    mesh->vertices[4] = point(-root, half, half_height);
    mesh->vertices[5] = point(0.0, -rim, half_height);
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 3; ++k) mesh->triangles[i].v[k] = faces[i][k];
    return SCREE_OK;
}
