/// \file broad_phase.h
/// Boxes with skin to sorted, unique candidate pairs. When to rebuild is the simulation's decision.
#ifndef SCREE_BROAD_PHASE_H
#define SCREE_BROAD_PHASE_H

#include "bvh/lbvh.h"

/// Two bodies that may touch, by their places in the arrays over bodies: particles from 0 to num_particles - 1, then
/// the walls. The id of i is the smaller one. A body's id is its place, unless a search is given other ids.
typedef struct scree_candidate_pair
{
    int32_t i, j;
} scree_candidate_pair;

/// One wall as the broad phase sees it: its tree of triangles in its own frame, and where that frame is now.
typedef struct scree_broad_phase_wall
{
    scree_lbvh_view tree; ///< unscaled body frame
    scree_pose pose;
    bool is_present; ///< a removed wall makes no pairs
} scree_broad_phase_wall;

/// Input of one search, all of it where the broad phase is. Boxes and spheres already contain the skin.
typedef struct scree_broad_phase_input
{
    const scree_box *boxes;              ///< (num_particles) world boxes with skin
    const scree_vec3 *centres;           ///< (num_particles) centres of bounding spheres
    const scree_real *radii;             ///< (num_particles) radii of bounding spheres with skin
    const scree_broad_phase_wall *walls; ///< (num_walls)
    int64_t num_particles;
    int64_t num_walls;
    bool compares_spheres; ///< particles make a pair only if their bounding spheres overlap too
    const int32_t *ids;    ///< (num_bodies) of the body in each place; walls keep theirs. NULL: places are ids
    const int32_t *places; ///< (num_bodies) of the body of each id; NULL with ids
} scree_broad_phase_input;

/// Owns the particle tree, the pairs and all scratch. Start from {0}, or from {.device = ...} for a search on a GPU.
typedef struct scree_broad_phase
{
    scree_device *device;   ///< where all arrays lie, NULL: the CPU
    scree_scratch *scratch; ///< borrowed: the tree and keys are taken there, in the caller's stage; NULL: its own
    scree_lbvh tree;
    scree_candidate_pair *pairs; ///< (num_pairs) sorted by the place of i, then the id of j, each once
    int64_t num_pairs;
    int32_t *own_begin; ///< (num_bodies + 1) first pair in which a body is the first one
    int32_t *row_begin; ///< (num_bodies + 1) start of each body's row in row_pairs
    int32_t *row_pairs; ///< (num_pairs) pairs in which a body is the second one, by the first's id
    struct scree_broad_phase_buffers *buffers; ///< internal
} scree_broad_phase;

/// Finds all pairs of particles whose boxes overlap (and bounding spheres, if asked for), and all pairs (particle,
/// wall) where a particle's sphere meets the box of one of the wall's triangles. Parallel, same pairs for any number of
/// threads and on a GPU. What a GPU has found is complete when scree_device_status() says so.
scree_status scree_broad_phase_find(scree_broad_phase *broad_phase, const scree_broad_phase_input *input);
/// On the CPU, if places are ids: pairs sorted and unique, i < j, rows complete; compared with all pairs by brute force
/// if num_particles <= 2000.
bool scree_broad_phase_validate(const scree_broad_phase *broad_phase, const scree_broad_phase_input *input,
                                scree_report *report);
void scree_broad_phase_destroy(scree_broad_phase *broad_phase);

#endif
