/// \file support_map.h
/// Bounds from above of a shape's support function h(d) = max d . v, by table: h on a grid over the six faces of a
/// cube, interpolated. h is convex and h(s d) = s h(d) for s > 0, so what is interpolated between its values is never
/// less than h; the excess is about 1e-3 of the size.
#ifndef SCREE_SUPPORT_MAP_H
#define SCREE_SUPPORT_MAP_H

#include "core/vec.h"
#include "scree/base.h"

#define SCREE_SUPPORT_CELLS 16
#define SCREE_SUPPORT_CORNERS (SCREE_SUPPORT_CELLS + 1)
#define SCREE_SUPPORT_VALUES (6 * SCREE_SUPPORT_CORNERS * SCREE_SUPPORT_CORNERS)

/// Place of a component of the direction, over the largest one, on the grid: cell and fraction.
SCREE_FN int32_t scree_support_cell(scree_real component, scree_real *fraction)
{
    const scree_real place = (component + 1) * ((scree_real)0.5 * SCREE_SUPPORT_CELLS);
    int32_t cell = (int32_t)place;
    cell = cell < 0 ? 0 : cell > SCREE_SUPPORT_CELLS - 1 ? SCREE_SUPPORT_CELLS - 1 : cell;
    *fraction = place - (scree_real)cell;
    return cell;
}

/// At least h(direction); `radius` bounds the distance of the vertices from the origin. `map` is
/// (SCREE_SUPPORT_VALUES).
SCREE_FN scree_real scree_support_bound(const float *map, scree_vec3 direction, scree_real radius)
{
    const scree_real x = scree_abs(direction.x);
    const scree_real y = scree_abs(direction.y);
    const scree_real z = scree_abs(direction.z);
    const int32_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    const scree_real along = axis == 0 ? direction.x : axis == 1 ? direction.y : direction.z;
    const scree_real next = axis == 0 ? direction.y : axis == 1 ? direction.z : direction.x;
    const scree_real last = axis == 0 ? direction.z : axis == 1 ? direction.x : direction.y;
    const scree_real length = scree_abs(along);
    if (!(length > 0)) return 0;
    scree_real u, v;
    const int32_t i = scree_support_cell(next / length, &u);
    const int32_t j = scree_support_cell(last / length, &v);
    const int32_t face = 2 * axis + (along < 0 ? 1 : 0);
    const float *corner = map + (face * SCREE_SUPPORT_CORNERS + i) * SCREE_SUPPORT_CORNERS + j;
    const scree_real low = (scree_real)corner[0] + v * ((scree_real)corner[1] - (scree_real)corner[0]);
    const scree_real high =
        (scree_real)corner[SCREE_SUPPORT_CORNERS] +
        v * ((scree_real)corner[SCREE_SUPPORT_CORNERS + 1] - (scree_real)corner[SCREE_SUPPORT_CORNERS]);
    return length * (low + u * (high - low) + 8 * SCREE_REAL_EPSILON * radius);
}

/// Fills `map` (SCREE_SUPPORT_VALUES) for `vertices` (num_vertices).
void scree_support_map_fill(float *map, const scree_vec3 *vertices, int32_t num_vertices);

#endif
