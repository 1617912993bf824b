/// \file plan.h
/// What a simulation's arrays take.
#ifndef SCREE_PLAN_H
#define SCREE_PLAN_H

#include "dynamics/state.h"

/// Bytes of one item in all arrays that a scene needs, without what they have grown ahead; of all shapes.
typedef struct scree_plan_bytes
{
    size_t state;            ///< of a particle
    size_t search;           ///< of a particle: poses, motion, boxes, tree
    size_t pair;             ///< of any candidate pair
    size_t mesh_pair;        ///< more for one of two meshes; 0 if there are none
    size_t sphere_mesh_pair; ///< more for a sphere or clump and a mesh; 0 if there are none
    size_t contact;          ///< with the history of the step before
    int64_t shapes;          ///< of all together: meshes, their trees and tables
    // these take the memory of each other: the larger sum counts
    size_t search_scratch; ///< of a particle: boxes and tree, during a search
    size_t pair_scratch;   ///< of a candidate pair: keys to sort, during a search
    size_t contact_block;  ///< of a contact: between searches
} scree_plan_bytes;

/// Of a pair of the kind that takes the most.
static inline size_t scree_plan_largest_pair(const scree_plan_bytes *bytes)
{
    return bytes->pair + (bytes->mesh_pair > bytes->sphere_mesh_pair ? bytes->mesh_pair : bytes->sphere_mesh_pair);
}

scree_plan_bytes scree_simulation_plan_bytes(const scree_simulation *simulation);
/// The same with the larger part of what is shared, for these numbers, in search, pair and contact: then they add up.
scree_plan_bytes scree_plan_added_up(scree_plan_bytes bytes, int64_t num_particles, int64_t num_pairs,
                                     int64_t num_contacts);

#endif
