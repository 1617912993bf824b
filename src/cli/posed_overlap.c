#include "cli/posed_overlap.h"

#include <string.h>

scree_posed_mesh scree_posed_mesh_default(const scree_mesh *mesh)
{
    const scree_posed_mesh posed = {mesh, 1, {0, 0, 0}, {1, 0, 0, 0}};
    return posed;
}

scree_status scree_posed_mesh_place(const scree_posed_mesh *posed, scree_mesh *world)
{
    const scree_status status = scree_mesh_copy(world, posed->mesh);
    if (status != SCREE_OK) return status;
    const double *q = posed->orientation, *t = posed->position;
    const scree_mat3 rotation =
        scree_mat3_from_quat(scree_quat_make((scree_real)q[0], (scree_real)q[1], (scree_real)q[2], (scree_real)q[3]));
    const scree_vec3 shift = scree_vec3_make((scree_real)t[0], (scree_real)t[1], (scree_real)t[2]);
    for (int32_t v = 0; v < world->num_vertices; ++v)
    {
        const scree_vec3 scaled = scree_vec3_scale(world->vertices[v], (scree_real)posed->scale);
        world->vertices[v] = scree_vec3_add(scree_mat3_apply(rotation, scaled), shift);
    }
    return SCREE_OK;
}

scree_status scree_overlap_of_meshes(const scree_mesh *a, const scree_mesh *b, const scree_overlap_options *options,
                                     scree_overlap_workspace *workspace, scree_overlap_result *results,
                                     int32_t *num_results)
{
    scree_shape shapes[2];
    memset(shapes, 0, sizeof shapes);
    const scree_pose identity = {{0, 0, 0}, {1, 0, 0, 0}, 1};
    scree_status status = scree_shape_create(&shapes[0], a, SCREE_FRAME_SOURCE);
    if (status == SCREE_OK) status = scree_shape_create(&shapes[1], b, SCREE_FRAME_SOURCE);
    while (status == SCREE_OK)
    {
        *num_results = scree_overlap_compute(&shapes[0].view, &identity, &shapes[1].view, &identity, options, workspace,
                                             results, SCREE_MAX_PATCHES);
        if (*num_results < 1 || results[0].status != SCREE_OVERLAP_WORKSPACE_FULL) break;
        status = scree_overlap_workspace_grow(workspace);
    }
    if (*num_results > SCREE_MAX_PATCHES) *num_results = SCREE_MAX_PATCHES;
    scree_shape_destroy(&shapes[0]);
    scree_shape_destroy(&shapes[1]);
    return status;
}

const char *scree_overlap_status_text(scree_overlap_status status)
{
    return status == SCREE_OVERLAP_TOUCHING ? "touching" : status == SCREE_OVERLAP_NO_NORMAL ? "no_normal" : "none";
}
