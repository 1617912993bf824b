/// \file shape_copy.h
/// Shapes as kernels see them, with all that they point at: what it takes, and copies on a GPU.
#ifndef SCREE_SHAPE_COPY_H
#define SCREE_SHAPE_COPY_H

#include "polyhedra/shape.h"

/// *to: `from` with arrays of its own on the device. SCREE_OUT_OF_MEMORY; what there is by then is in *to.
scree_status scree_shape_view_copy(scree_device *device, scree_shape_view *to, const scree_shape_view *from);
/// All that it points at.
int64_t scree_shape_view_bytes(const scree_shape_view *view);
void scree_shape_view_destroy(scree_device *device, scree_shape_view *view);

#endif
