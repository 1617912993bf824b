#include "polyhedra/support_map.h"

/// Support of the vertices along a direction, rounded up to float.
static float support(const scree_vec3 *vertices, int32_t num_vertices, scree_vec3 direction)
{
    scree_real most = -SCREE_REAL_MAX;
    for (int32_t v = 0; v < num_vertices; ++v) most = scree_max(most, scree_vec3_dot(direction, vertices[v]));
    // products and sums lose at most three roundings of less than a float's
    return (float)most + ((float)most < 0 ? -(float)most : (float)most) * FLT_EPSILON + FLT_MIN;
}

void scree_support_map_fill(float *map, const scree_vec3 *vertices, int32_t num_vertices)
{
    for (int32_t face = 0; face < 6; ++face)
    {
        for (int32_t i = 0; i < SCREE_SUPPORT_CORNERS; ++i)
        {
            for (int32_t j = 0; j < SCREE_SUPPORT_CORNERS; ++j)
            {
                const scree_real along = face % 2 == 0 ? 1 : -1;
                const scree_real next = (scree_real)(2 * i) / SCREE_SUPPORT_CELLS - 1;
                const scree_real last = (scree_real)(2 * j) / SCREE_SUPPORT_CELLS - 1;
                const scree_vec3 direction = face / 2 == 0   ? scree_vec3_make(along, next, last)
                                             : face / 2 == 1 ? scree_vec3_make(last, along, next)
                                                             : scree_vec3_make(next, last, along);
                map[(face * SCREE_SUPPORT_CORNERS + i) * SCREE_SUPPORT_CORNERS + j] =
                    support(vertices, num_vertices, direction);
            }
        }
    }
}
