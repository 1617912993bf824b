/// \file voxel_mesh.h
/// Closed meshes from cells of a unit grid that are full or empty: surfaces with many seams, concave edges and corners,
/// and with a distance that is known in closed form, that to the nearest box.
#ifndef SCREE_VOXEL_MESH_H
#define SCREE_VOXEL_MESH_H

#include "harness.h"
#include "polyhedra/mesh.h"

#include <stdlib.h>

enum
{
    MAX_VOXELS = 32
};

/// Cell (x, y, z) has its lower corner at (x, y, z). No two full cells may touch in an edge or corner alone.
typedef struct scree_voxels
{
    int num[3];
    bool is_full[MAX_VOXELS][MAX_VOXELS][4];
} scree_voxels;

static inline bool scree_voxel_at(const scree_voxels *voxels, const int at[3])
{
    for (int k = 0; k < 3; ++k)
        if (at[k] < 0 || at[k] >= voxels->num[k]) return false;
    return voxels->is_full[at[0]][at[1]][at[2]];
}

/// Two triangles per face between full and empty; the diagonals change direction from cell to cell.
static inline scree_mesh scree_voxel_mesh(const scree_voxels *voxels)
{
    const int nx = voxels->num[0] + 1, ny = voxels->num[1] + 1, nz = voxels->num[2] + 1;
    int32_t *vertex = malloc((size_t)(nx * ny * nz) * sizeof *vertex);
    scree_mesh mesh;
    const int32_t max_triangles = 12 * voxels->num[0] * voxels->num[1] * voxels->num[2];
    if (vertex == NULL || scree_mesh_create(&mesh, nx * ny * nz, max_triangles) != SCREE_OK) exit(EXIT_FAILURE);
    for (int k = 0; k < nx * ny * nz; ++k) vertex[k] = -1;
    mesh.num_vertices = mesh.num_triangles = 0;
    for (int cell = 0; cell < voxels->num[0] * voxels->num[1] * voxels->num[2]; ++cell)
        for (int face = 0; face < 6; ++face)
        {
            const int axis = face / 2, side = face % 2;
            const int at[3] = {cell % voxels->num[0], cell / voxels->num[0] % voxels->num[1],
                               cell / voxels->num[0] / voxels->num[1]};
            int beyond[3] = {at[0], at[1], at[2]};
            beyond[axis] += side ? 1 : -1;
            if (!scree_voxel_at(voxels, at) || scree_voxel_at(voxels, beyond)) continue;
            int32_t corner[4];
            for (int c = 0; c < 4; ++c)
            {
                // around the face, counter-clockwise seen from outside
                const int u = c == 1 || c == 2, v = c >= 2;
                int x[3] = {at[0], at[1], at[2]};
                x[axis] += side;
                x[(axis + 1) % 3] += side ? u : v;
                x[(axis + 2) % 3] += side ? v : u;
                int32_t *known = vertex + (x[2] * ny + x[1]) * nx + x[0];
                if (*known < 0)
                {
                    *known = mesh.num_vertices;
                    mesh.vertices[mesh.num_vertices++] =
                        scree_vec3_make((scree_real)x[0], (scree_real)x[1], (scree_real)x[2]);
                }
                corner[c] = *known;
            }
            const int turn = (at[0] + at[1] + at[2]) % 2;
            const scree_triangle first = {{corner[turn], corner[1 + turn], corner[2 + turn]}};
            const scree_triangle second = {{corner[turn], corner[2 + turn], corner[(3 + turn) % 4]}};
            mesh.triangles[mesh.num_triangles++] = first;
            mesh.triangles[mesh.num_triangles++] = second;
        }
    free(vertex);
    return mesh;
}

/// Distance of a point to the surface: positive outside, negative inside.
static inline double scree_voxel_distance(const scree_voxels *voxels, scree_vec3 p)
{
    const double x[3] = {(double)p.x, (double)p.y, (double)p.z};
    int own[3];
    for (int k = 0; k < 3; ++k) own[k] = (int)floor(x[k]);
    const bool is_inside = scree_voxel_at(voxels, own);
    double nearest = INFINITY;
    // empty cells count from one cell around the grid on: enough for a point inside
    for (int i = -1; i <= voxels->num[0]; ++i)
        for (int j = -1; j <= voxels->num[1]; ++j)
            for (int k = -1; k <= voxels->num[2]; ++k)
            {
                const int at[3] = {i, j, k};
                if (scree_voxel_at(voxels, at) == is_inside) continue;
                double squared = 0;
                for (int d = 0; d < 3; ++d)
                {
                    const double beyond = fmax(fmax(at[d] - x[d], x[d] - at[d] - 1), 0);
                    squared += beyond * beyond;
                }
                nearest = fmin(nearest, squared);
            }
    return is_inside ? -sqrt(nearest) : sqrt(nearest);
}

#endif
