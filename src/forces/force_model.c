#define _DEFAULT_SOURCE /* M_PI */
#include "forces/force_model.h"

#include <math.h>
#include <string.h>

static const scree_force_model models[] = {
    {"volumetric_hertz_mindlin",
     "Hertz-Mindlin on the overlap volume: F = 4/(3 sqrt(pi)) E* sqrt(V d), damping, tangential spring, Coulomb limit",
     "Nassauer & Kuna (2013), Granular Matter 15, 349; Bilock (2020), eqs. 4.16-4.18"},
};

const scree_force_model *scree_force_models(int32_t *num_models)
{
    *num_models = (int32_t)(sizeof models / sizeof models[0]);
    return models;
}

double scree_damping_ratio_from_restitution(double restitution_coefficient, bool has_attraction)
{
    const double e = restitution_coefficient;
    if (e >= 1) return 0;
    if (has_attraction)
    {
        const double log_e = log(e);
        return sqrt(5.0 / 6.0) * -log_e / sqrt(M_PI * M_PI + log_e * log_e);
    }
    // Thornton, Cummins & Cleary (2013): fit for a normal force that is never attractive
    static const double h[] = {-6.918798, -16.41105, 146.8049,  -796.4559, 2928.711,
                               -7206.864, 11494.29,  -11342.18, 6276.757,  -1489.915};
    double a = 0;
    for (int k = 9; k >= 0; --k) a = e * (h[k] + a);
    return sqrt(1 / (1 - (1 + e) * (1 + e) * exp(a)) - 1);
}

/// Shear modulus as given, or from E and nu.
static double shear_modulus(const scree_material_def *material)
{
    if (!isnan(material->shear_modulus)) return material->shear_modulus;
    return material->youngs_modulus / (2 * (1 + material->poisson_ratio));
}

/// The part that one material adds to 1/G*.
static double shear_compliance(const scree_material_def *material, scree_shear_mixing mixing)
{
    const double nu = material->poisson_ratio;
    return (mixing == SCREE_SHEAR_MINDLIN ? 2 - nu : 1 - nu * nu) / shear_modulus(material);
}

static double normal_compliance(const scree_material_def *material)
{
    return (1 - material->poisson_ratio * material->poisson_ratio) / material->youngs_modulus;
}

scree_status scree_force_law_make(const scree_contact_law_def *def, const scree_material_def *a,
                                  const scree_material_def *b, scree_force_law *law)
{
    int32_t num_models, model = 0;
    scree_force_models(&num_models);
    while (model < num_models && strcmp(models[model].name, def->model) != 0) ++model;
    if (model == num_models) return SCREE_NOT_FOUND;

    const double damping_ratio =
        isnan(def->damping_ratio) ? scree_damping_ratio_from_restitution(def->restitution_coefficient, def->attraction)
                                  : def->damping_ratio;
    law->model = model;
    law->effective_modulus = (scree_real)(1 / (normal_compliance(a) + normal_compliance(b)));
    law->effective_shear_modulus =
        (scree_real)(1 / (shear_compliance(a, def->shear_mixing) + shear_compliance(b, def->shear_mixing)));
    law->stiffness_factor = (scree_real)def->stiffness_factor;
    law->damping_ratio = (scree_real)damping_ratio;
    law->friction_coefficient = (scree_real)def->friction_coefficient;
    law->has_tangential_spring = def->tangential_spring != 0;
    law->has_moments = def->contact_moments;
    law->has_attraction = def->attraction;
    return SCREE_OK;
}
