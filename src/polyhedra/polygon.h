/// \file polygon.h
/// Cuts the polygons of mesh files into triangles.
#ifndef SCREE_POLYGON_H
#define SCREE_POLYGON_H

#include "core/vec.h"

/// Cuts a polygon of `num` >= 3 corners, in any plane, convex or not, into num - 2 triangles of the same sense:
/// `triangles` is (num - 2, 3), indices of corners; `scratch` is (num). Corners need not lie in one plane exactly, but
/// the polygon must not cross itself as seen along its normal. If it does, the triangles still close the surface.
void scree_polygon_triangulate(const scree_vec3 *corners, int32_t num, int32_t (*triangles)[3], int32_t *scratch);

#endif
