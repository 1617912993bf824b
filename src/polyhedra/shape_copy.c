#include "polyhedra/shape_copy.h"

#ifndef SCREE_SINGLE
_Static_assert(sizeof(scree_shape_view) == 224, "copy the new array, and free it");
#endif

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
    const scree_wide_tree_view *wide = &from->wide_tree;
    const int64_t num_nodes = from->tree.num_leaves > 0 ? 2 * (int64_t)from->tree.num_leaves - 1 : 0;
    // the last level has one node
    const int64_t num_wide = wide->num_levels > 0 ? wide->first_node[wide->num_levels - 1] + 1 : 0;
    bool is_complete = true;
    *to = *from;
    to->vertices = copy(device, from->vertices, from->num_vertices, sizeof *from->vertices, &is_complete);
    to->triangles = copy(device, from->triangles, from->num_triangles, sizeof *from->triangles, &is_complete);
    to->neighbours =
        copy(device, from->neighbours, 3 * (int64_t)from->num_triangles, sizeof *from->neighbours, &is_complete);
    to->tree.nodes = copy(device, from->tree.nodes, num_nodes, sizeof *from->tree.nodes, &is_complete);
    to->wide_tree.nodes = copy(device, wide->nodes, num_wide, sizeof *wide->nodes, &is_complete);
    const int64_t num_lowest = (wide->num_items + SCREE_WIDE_CHILDREN - 1) / SCREE_WIDE_CHILDREN;
    to->wide_tree.corners = copy(device, wide->corners, num_lowest, sizeof *wide->corners, &is_complete);
    to->wide_tree.items = copy(device, wide->items, wide->num_items, sizeof *wide->items, &is_complete);
    to->support_map = copy(device, from->support_map, SCREE_SUPPORT_VALUES, sizeof *from->support_map, &is_complete);
    to->flat_faces = copy(device, from->flat_faces, from->num_triangles, sizeof *from->flat_faces, &is_complete);
    to->spheres = copy(device, from->spheres, from->num_spheres, sizeof *from->spheres, &is_complete);
    return is_complete ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

void scree_shape_view_destroy(scree_device *device, scree_shape_view *view)
{
    const void *const arrays[] = {view->vertices,          view->triangles,       view->neighbours,  view->tree.nodes,
                                  view->wide_tree.nodes,   view->wide_tree.items, view->support_map, view->flat_faces,
                                  view->wide_tree.corners, view->spheres};
    for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; ++k) scree_device_free(device, (void *)arrays[k]);
    *view = (scree_shape_view){0};
}
