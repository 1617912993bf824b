/// \file pair_kinds_kernel.h
/// How the contacts of a pair are found, by the kinds of its two shapes; and candidate pairs to one batch per way.
#ifndef SCREE_PAIR_KINDS_KERNEL_H
#define SCREE_PAIR_KINDS_KERNEL_H

#include "bvh/broad_phase.h"
#include "contact/narrow_phase.h"

typedef enum scree_pair_kind
{
    SCREE_PAIR_MESH_MESH,
    SCREE_PAIR_SPHERE_MESH, ///< or a clump and a mesh
    SCREE_PAIR_SPHERE_SPHERE,
    SCREE_PAIR_CLUMP_CLUMP, ///< or one of them a sphere
    SCREE_NUM_PAIR_KINDS
} scree_pair_kind;

SCREE_FN scree_pair_kind scree_kind_of_pair(scree_shape_kind a, scree_shape_kind b)
{
    if (a == SCREE_KIND_MESH && b == SCREE_KIND_MESH) return SCREE_PAIR_MESH_MESH;
    if (a == SCREE_KIND_MESH || b == SCREE_KIND_MESH) return SCREE_PAIR_SPHERE_MESH;
    return a == SCREE_KIND_SPHERE && b == SCREE_KIND_SPHERE ? SCREE_PAIR_SPHERE_SPHERE : SCREE_PAIR_CLUMP_CLUMP;
}

/// For one kind.
typedef struct scree_pair_kinds_args
{
    scree_bodies bodies;
    const scree_candidate_pair *pairs; ///< (num_pairs)
    int32_t *places;                   ///< (num_pairs + 1) first 1 for each pair of the kind, then the sums before
    int32_t *batch;                    ///< (num of the kind) out: the pairs of the kind, in order
    scree_pair_kind kind;
} scree_pair_kinds_args;

typedef scree_pair_kinds_args scree_pair_flag_args;
typedef scree_pair_kinds_args scree_pair_scatter_args;

SCREE_FN void scree_pair_flag_at(scree_pair_flag_args a, int64_t p)
{
    const int32_t i = a.bodies.shape[a.pairs[p].i], j = a.bodies.shape[a.pairs[p].j];
    a.places[p] = scree_kind_of_pair(a.bodies.shapes[i].kind, a.bodies.shapes[j].kind) == a.kind ? 1 : 0;
}

SCREE_FN void scree_pair_scatter_at(scree_pair_scatter_args a, int64_t p)
{
    if (a.places[p + 1] > a.places[p]) a.batch[a.places[p]] = (int32_t)p;
}

#endif
