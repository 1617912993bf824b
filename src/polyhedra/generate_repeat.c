#include "polyhedra/generate.h"

#include <math.h>

#define PI 3.14159265358979323846

scree_status scree_mesh_repeat(scree_mesh *mesh, const double offset[3], int32_t num_copies)
{
    if (num_copies < 1 || (int64_t)num_copies * mesh->num_triangles > INT32_MAX / 3) return SCREE_INVALID_INPUT;
    scree_mesh all;
    const int32_t num_vertices = mesh->num_vertices, num_triangles = mesh->num_triangles;
    const scree_status status = scree_mesh_create(&all, num_copies * num_vertices, num_copies * num_triangles);
    if (status != SCREE_OK) return status;
    for (int32_t k = 0; k < num_copies; ++k)
    {
        const double angle = 2.0 * PI * k / num_copies, c = cos(angle), s = sin(angle);
        for (int32_t v = 0; v < num_vertices; ++v)
        {
            const scree_vec3 p = mesh->vertices[v];
            const double x = (double)p.x + offset[0], y = (double)p.y + offset[1], z = (double)p.z + offset[2];
            all.vertices[k * num_vertices + v] =
                scree_vec3_make((scree_real)(c * x - s * y), (scree_real)(s * x + c * y), (scree_real)z);
        }
        for (int32_t t = 0; t < num_triangles; ++t)
            for (int corner = 0; corner < 3; ++corner)
                all.triangles[k * num_triangles + t].v[corner] = mesh->triangles[t].v[corner] + k * num_vertices;
    }
    scree_mesh_destroy(mesh);
    *mesh = all;
    return SCREE_OK;
}
