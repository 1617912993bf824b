/// \file force_model.h
/// Registry of force laws: name, text, parameters; and the constants of a law for one pair of materials.
#ifndef SCREE_FORCE_MODEL_H
#define SCREE_FORCE_MODEL_H

#include "core/vec.h"
#include "scree/types.h"

/// Constants of a law for two materials, computed once on the host.
typedef struct scree_force_law
{
    scree_real effective_modulus;       ///< [Pa] E*
    scree_real effective_shear_modulus; ///< [Pa] G*
    scree_real stiffness_factor;        ///< [1] 4/(3 sqrt(pi)) by default
    scree_real damping_ratio;           ///< [1] g
    scree_real friction_coefficient;    ///< [1]
    int32_t model;                      ///< index in the registry
    bool has_tangential_spring;
    bool has_moments;    ///< springs and dashpots are spread over the contact area
    bool has_attraction; ///< total normal force may be attractive
} scree_force_law;

typedef struct scree_force_model
{
    const char *name;
    const char *text;   ///< one line
    const char *source; ///< paper
} scree_force_model;

/// The table of models, (*num_models).
const scree_force_model *scree_force_models(int32_t *num_models);

/// Constants of `def` for materials a and b. The definition has been checked before. SCREE_NOT_FOUND: no such model.
scree_status scree_force_law_make(const scree_contact_law_def *def, const scree_material_def *a,
                                  const scree_material_def *b, scree_force_law *law);

/// Damping ratio g for a restitution coefficient e: sqrt(5/6) b with attraction, Thornton's fit without
/// (Thornton, Cummins & Cleary 2013).
double scree_damping_ratio_from_restitution(double restitution_coefficient, bool has_attraction);

#endif
