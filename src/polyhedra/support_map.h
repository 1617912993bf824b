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

/// Where a direction meets the cube, and what is interpolated there.
typedef struct scree_support_place
{
    int32_t axis;                 ///< of the face: its largest component
    scree_real along, next, last; ///< components along that axis and the two after it
    scree_real length;            ///< |along|
    scree_real value;             ///< h there, where |along| is 1
    scree_real by_next, by_last;  ///< its slopes over next and last, where |along| is 1
} scree_support_place;

/// False if the direction has no length.
SCREE_FN bool scree_support_place_find(const float *map, scree_vec3 direction, scree_support_place *place)
{
    const scree_real x = scree_abs(direction.x);
    const scree_real y = scree_abs(direction.y);
    const scree_real z = scree_abs(direction.z);
    const int32_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    place->axis = axis;
    place->along = axis == 0 ? direction.x : axis == 1 ? direction.y : direction.z;
    place->next = axis == 0 ? direction.y : axis == 1 ? direction.z : direction.x;
    place->last = axis == 0 ? direction.z : axis == 1 ? direction.x : direction.y;
    place->length = scree_abs(place->along);
    if (!(place->length > 0)) return false;
    scree_real u, v;
    const int32_t i = scree_support_cell(place->next / place->length, &u);
    const int32_t j = scree_support_cell(place->last / place->length, &v);
    const int32_t face = 2 * axis + (place->along < 0 ? 1 : 0);
    const float *corner = map + (face * SCREE_SUPPORT_CORNERS + i) * SCREE_SUPPORT_CORNERS + j;
    const scree_real low_rise = (scree_real)corner[1] - (scree_real)corner[0];
    const scree_real high_rise =
        (scree_real)corner[SCREE_SUPPORT_CORNERS + 1] - (scree_real)corner[SCREE_SUPPORT_CORNERS];
    const scree_real low = (scree_real)corner[0] + v * low_rise;
    const scree_real high = (scree_real)corner[SCREE_SUPPORT_CORNERS] + v * high_rise;
    const scree_real cells = (scree_real)0.5 * SCREE_SUPPORT_CELLS;
    place->value = low + u * (high - low);
    place->by_next = cells * (high - low);
    place->by_last = cells * (low_rise + u * (high_rise - low_rise));
    return true;
}

/// At least h(direction); `radius` bounds the distance of the vertices from the origin. `map` is
/// (SCREE_SUPPORT_VALUES).
SCREE_FN scree_real scree_support_bound(const float *map, scree_vec3 direction, scree_real radius)
{
    scree_support_place place;
    if (!scree_support_place_find(map, direction, &place)) return 0;
    return place.length * (place.value + 8 * SCREE_REAL_EPSILON * radius);
}

/// Gradient of what is interpolated: about the point of the shape that lies farthest along the direction.
SCREE_FN scree_vec3 scree_support_map_point(const float *map, scree_vec3 direction)
{
    scree_support_place place;
    if (!scree_support_place_find(map, direction, &place)) return scree_vec3_zero();
    // h(s d) = s h(d): what is not along next and last is along the axis
    const scree_real rest = place.value - (place.next * place.by_next + place.last * place.by_last) / place.length;
    const scree_real by_along = place.along < 0 ? -rest : rest;
    return place.axis == 0   ? scree_vec3_make(by_along, place.by_next, place.by_last)
           : place.axis == 1 ? scree_vec3_make(place.by_last, by_along, place.by_next)
                             : scree_vec3_make(place.by_next, place.by_last, by_along);
}

/// Fills `map` (SCREE_SUPPORT_VALUES) for `vertices` (num_vertices).
void scree_support_map_fill(float *map, const scree_vec3 *vertices, int32_t num_vertices);

#endif
