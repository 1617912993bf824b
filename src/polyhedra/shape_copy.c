#include "polyhedra/shape_copy.h"

#ifndef SCREE_SINGLE
_Static_assert(sizeof(scree_shape_view) == 232, "copy the new array, and free it");
#endif

/// Nodes of the trees of a shape: binary; wide, whose last level has one; and those of its lowest level.
static int64_t num_nodes(const scree_shape_view *view)
{
    return view->tree.num_leaves > 0 ? 2 * (int64_t)view->tree.num_leaves - 1 : 0;
}
static int64_t num_wide_nodes(const scree_shape_view *view)
{
    const scree_wide_tree_view *wide = &view->wide_tree;
    return wide->num_levels > 0 ? wide->first_node[wide->num_levels - 1] + 1 : 0;
}
static int64_t num_lowest_nodes(const scree_shape_view *view)
{
    return (view->wide_tree.num_items + SCREE_WIDE_CHILDREN - 1) / SCREE_WIDE_CHILDREN;
}

/// Every array of a shape: X(array, items), of `view`.
#define SCREE_SHAPE_ARRAYS(X)                       \
    X(vertices, view->num_vertices)                 \
    X(triangles, view->num_triangles)               \
    X(neighbours, 3 * (int64_t)view->num_triangles) \
    X(normals, view->num_triangles)                 \
    X(tree.nodes, num_nodes(view))                  \
    X(wide_tree.nodes, num_wide_nodes(view))        \
    X(wide_tree.corners, num_lowest_nodes(view))    \
    X(wide_tree.items, view->wide_tree.num_items)   \
    X(support_map, SCREE_SUPPORT_VALUES)            \
    X(flat_faces, view->num_triangles)              \
    X(spheres, view->num_spheres)

/// A copy of `num` items at `from` on the device; NULL for NULL, or if memory is out.
static void *copy(scree_device *device, const void *from, int64_t num, size_t size, bool *is_complete)
{
    if (from == NULL) return NULL;
    void *to = scree_device_alloc(device, num, size);
    if (to != NULL) scree_device_write(device, to, from, (size_t)num * size);
    else *is_complete = false;
    return to;
}

scree_status scree_shape_view_copy(scree_device *device, scree_shape_view *to, const scree_shape_view *from)
{
    const scree_shape_view *view = from;
    bool is_complete = true;
    *to = *from;
#define SCREE_COPY(array, num) to->array = copy(device, from->array, num, sizeof *from->array, &is_complete);
    SCREE_SHAPE_ARRAYS(SCREE_COPY)
#undef SCREE_COPY
    return is_complete ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

int64_t scree_shape_view_bytes(const scree_shape_view *view)
{
    int64_t num_bytes = 0;
#define SCREE_ADD(array, num) num_bytes += view->array != NULL ? (num) * (int64_t)sizeof *view->array : 0;
    SCREE_SHAPE_ARRAYS(SCREE_ADD)
#undef SCREE_ADD
    return num_bytes;
}

void scree_shape_view_destroy(scree_device *device, scree_shape_view *view)
{
#define SCREE_FREE(array, num) scree_device_free(device, (void *)view->array);
    SCREE_SHAPE_ARRAYS(SCREE_FREE)
#undef SCREE_FREE
    *view = (scree_shape_view){0};
}
