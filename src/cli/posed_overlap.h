/// \file posed_overlap.h
/// Overlap of two meshes given in world coordinates, for scree overlap: exactly these coordinates decide.
#ifndef SCREE_POSED_OVERLAP_H
#define SCREE_POSED_OVERLAP_H

#include "contact/overlap.h"

/// Contacts told of one pair at most.
#define SCREE_MAX_PATCHES 64

/// A mesh and where it is put: world = R(orientation) (scale * vertex) + position.
typedef struct scree_posed_mesh
{
    const scree_mesh *mesh; ///< borrowed
    double scale;
    double position[3];
    double orientation[4]; ///< (w, x, y, z), used as given
} scree_posed_mesh;

/// scale 1, no turn, no shift.
scree_posed_mesh scree_posed_mesh_default(const scree_mesh *mesh);

/// Copy of the mesh with its world vertices, each ((R0 x + R1 y) + R2 z) + t in plain doubles, x, y, z already scaled.
/// An identity pose leaves every bit as it is.
scree_status scree_posed_mesh_place(const scree_posed_mesh *posed, scree_mesh *world);

/// Overlap of two meshes in world coordinates; results is (SCREE_MAX_PATCHES), arms are from the world's origin.
scree_status scree_overlap_of_meshes(const scree_mesh *a, const scree_mesh *b, const scree_overlap_options *options,
                                     scree_overlap_workspace *workspace, scree_overlap_result *results,
                                     int32_t *num_results);

/// "touching", "none" or "no_normal".
const char *scree_overlap_status_text(scree_overlap_status status);

#endif
