/// \file force_model.h
/// Registry of force laws: name, text, parameters; and the constants of a law for one pair of materials.
#ifndef SCREE_FORCE_MODEL_H
#define SCREE_FORCE_MODEL_H

#include "core/vec.h"
#include "forces/force_parameters.h"
#include "scree/types.h"

/// Constants of a law for two materials, computed once on the host.
typedef struct scree_force_law
{
    scree_real effective_modulus;            ///< [Pa] E*
    scree_real stiffness_factor;             ///< [1] of E* in the model
    scree_real normal_stiffness;             ///< [N/m] of linear_spring
    scree_real tangential_over_normal;       ///< [1] k_t/k_n
    scree_real damping_ratio;                ///< [1] g
    scree_real tangential_damping_ratio;     ///< [1]
    scree_real friction_coefficient;         ///< [1]
    scree_real rolling_friction_coefficient; ///< [1]
    scree_real rolling_damping_ratio;        ///< [1]
    int32_t model;                           ///< SCREE_MODEL_*
    int32_t exponent_quarters;               ///< 4 (p - 1) of energy_conserving
    int32_t rolling;                         ///< scree_rolling_resistance_kind
    bool has_tangential_spring;
    bool has_moments;    ///< springs and dashpots are spread over the contact area
    bool has_attraction; ///< total normal force may be attractive
} scree_force_law;

typedef struct scree_force_model
{
    const char *name;
    double exponent;    ///< n of F ~ d^n between spheres, of energy_conserving with its default p
    const char *text;   ///< one line
    const char *source; ///< paper
} scree_force_model;

/// A number of a contact law.
typedef struct scree_force_parameter
{
    const char *name;
    int32_t used_by;   ///< set of models: bit SCREE_MODEL_*
    int32_t needed_by; ///< set of models that cannot do without
} scree_force_parameter;

/// The table of models, (SCREE_NUM_FORCE_MODELS).
const scree_force_model *scree_force_models(void);
/// The table of parameters, (*num_parameters).
const scree_force_parameter *scree_force_parameters(int32_t *num_parameters);
/// SCREE_MODEL_* of a name; -1: there is none.
int32_t scree_force_model_find(const char *name);

/// Constants of `def` for materials a and b. The definition has been checked before. SCREE_NOT_FOUND: no such model.
scree_status scree_force_law_make(const scree_contact_law_def *def, const scree_material_def *a,
                                  const scree_material_def *b, scree_force_law *law);

/// Damping ratio g of 2 g sqrt(m* k_n) v for a restitution coefficient e between spheres whose elastic force goes as
/// d^exponent; exact. With u = sqrt(2/(n + 1)) d^((n+1)/2) as coordinate and time stretched to suit, every n becomes
/// the linear oscillator u'' + 2 z u' + u = 0 with z = g sqrt(2n/(n + 1)). It separates at u = 0 if it may attract: e =
/// exp(-pi z/sqrt(1 - z^2)); otherwise where its force has gone: e = exp(-2 z acos(z)/sqrt(1 - z^2)) (n = 1: Schwager &
/// Poeschel 2007). Thornton, Cummins & Cleary (2013) fit the second for n = 3/2; the fit is off by 4e-4 from e = 0.2 to
/// 0.9 and by 8e-3 at 0.98.
double scree_damping_ratio_from_restitution(double restitution_coefficient, double exponent, bool has_attraction);

/// Stiffness [N/m] that the contacts of a body against a fixed one are not expected to exceed: the larger of k_n and
/// k_t. On a contact of radius a of a body of radius R: of hertz_mindlin 2 E* a, of energy_conserving the same for p =
/// 5/4; of linear_spring twice the spring, as a partner of the same mass makes it. 0 for a pair of materials without a
/// law.
double scree_force_law_largest_stiffness(const scree_force_law *law, double contact_radius, double radius);

#endif
