/// \file skin.h
/// How wide the skin is. A wide one makes searches rare and candidate pairs many. No result depends on it.
#ifndef SCREE_SKIN_H
#define SCREE_SKIN_H

#include "dynamics/state.h"

/// What a skin is chosen from. All but the moved distance are counts, so the choice is the same on every machine and
/// for any number of threads.
typedef struct scree_skin_input
{
    double skin;          ///< [m] of the last search
    double mean_radius;   ///< [m] of the bounding spheres
    double moved;         ///< [m] the way of the fastest bodies since the last search
    int64_t num_steps;    ///< since then, > 0
    double num_particles; ///< > 0
    double num_pairs;     ///< candidates that the last search found
    bool has_meshes;      ///< candidates are mostly pairs of meshes
} scree_skin_input;

/// The skin [m] that should cost least per step if things go on as they did.
double scree_skin_of_least_cost(const scree_skin_input *input);

/// [m] for the first search: what the scene says, or a tenth of the mean bounding radius.
scree_real scree_skin_at_start(const scree_simulation *simulation);

/// A search is about to be made: chooses its skin if that is automatic.
void scree_skin_adapt(scree_simulation *simulation);

#endif
