#define _DEFAULT_SOURCE /* M_PI */
#include "forces/force_model.h"

#include <math.h>
#include <string.h>

static const scree_force_model models[] = {
#define SCREE_MODEL(model, name, exponent, text, source) {name, exponent, text, source},
    SCREE_FORCE_MODELS(SCREE_MODEL)
#undef SCREE_MODEL
};

static const scree_force_parameter parameters[] = {
#define SCREE_PARAMETER(name, unit, default_text, special, min, max, used_by, needed_by, meaning) \
    {#name, used_by, needed_by},
    SCREE_FORCE_PARAMETERS(SCREE_PARAMETER)
#undef SCREE_PARAMETER
};

const scree_force_model *scree_force_models(void) { return models; }

const scree_force_parameter *scree_force_parameters(int32_t *num_parameters)
{
    *num_parameters = (int32_t)(sizeof parameters / sizeof parameters[0]);
    return parameters;
}

int32_t scree_force_model_find(const char *name)
{
    for (int32_t k = 0; k < SCREE_NUM_FORCE_MODELS; ++k)
        if (strcmp(models[k].name, name) == 0) return k;
    return -1;
}

/// Restitution of the oscillator with damping ratio z when its force is never attractive.
static double restitution_without_attraction(double z)
{
    if (z == 1) return exp(-2);
    const double root = sqrt(fabs(1 - z * z));
    return exp(-2 * z * (z < 1 ? acos(z) : acosh(z)) / root);
}

double scree_damping_ratio_from_restitution(double restitution_coefficient, double exponent, bool has_attraction)
{
    const double e = restitution_coefficient, factor = sqrt((exponent + 1) / (2 * exponent));
    if (e >= 1) return 0;
    if (has_attraction)
    {
        const double log_e = log(e);
        return factor * -log_e / sqrt(M_PI * M_PI + log_e * log_e);
    }
    // e falls with z; 1/(4 z^2) for large z
    double low = 0, high = 1 / sqrt(e);
    for (int k = 0; k < 100; ++k)
    {
        const double middle = 0.5 * (low + high);
        if (restitution_without_attraction(middle) > e) low = middle;
        else high = middle;
    }
    return factor * low;
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
    const int32_t model = scree_force_model_find(def->model);
    if (model < 0) return SCREE_NOT_FOUND;

    const double modulus = 1 / (normal_compliance(a) + normal_compliance(b));
    const double shear_modulus = 1 / (shear_compliance(a, def->shear_mixing) + shear_compliance(b, def->shear_mixing));
    // F ~ d^(2p - 1) between spheres
    const bool is_conserving = model == SCREE_MODEL_ENERGY_CONSERVING && !isnan(def->energy_exponent);
    const double exponent = is_conserving ? 2 * def->energy_exponent - 1 : models[model].exponent;
    const double damping_ratio =
        isnan(def->damping_ratio)
            ? scree_damping_ratio_from_restitution(def->restitution_coefficient, exponent, def->attraction)
            : def->damping_ratio;
    const bool has_tangential_stiffness = model == SCREE_MODEL_LINEAR_SPRING && !isnan(def->tangential_stiffness);
    *law = (scree_force_law){0};
    law->model = model;
    law->effective_modulus = (scree_real)modulus;
    // Hertz's between spheres: 8/15 pi^(-5/4) and 4/(3 sqrt(pi))
    const double hertz = model == SCREE_MODEL_ENERGY_CONSERVING ? 0.12751503283646595 : 0.7522527780636751;
    law->stiffness_factor = (scree_real)(isnan(def->stiffness_factor) ? hertz : def->stiffness_factor);
    if (model == SCREE_MODEL_ENERGY_CONSERVING) law->exponent_quarters = (int32_t)lround(2 * (exponent - 1));
    if (model == SCREE_MODEL_LINEAR_SPRING) law->normal_stiffness = (scree_real)def->normal_stiffness;
    law->tangential_over_normal =
        (scree_real)(has_tangential_stiffness ? def->tangential_stiffness / def->normal_stiffness
                                              : 4 * shear_modulus / modulus);
    law->damping_ratio = (scree_real)damping_ratio;
    law->tangential_damping_ratio =
        (scree_real)(isnan(def->tangential_damping_ratio) ? damping_ratio : def->tangential_damping_ratio);
    law->friction_coefficient = (scree_real)def->friction_coefficient;
    law->rolling = (int32_t)def->rolling_resistance;
    if (law->rolling != SCREE_ROLLING_NONE)
    {
        law->rolling_friction_coefficient = (scree_real)def->rolling_friction_coefficient;
        law->rolling_damping_ratio = (scree_real)def->rolling_damping_ratio;
    }
    law->has_tangential_spring = def->tangential_spring != 0;
    law->has_moments = def->contact_moments;
    law->has_attraction = def->attraction;
    return SCREE_OK;
}

double scree_force_law_largest_stiffness(const scree_force_law *law, double contact_radius, double radius)
{
    const double modulus = (double)law->effective_modulus, p = 1 + 0.25 * law->exponent_quarters;
    double normal = 2 * modulus * contact_radius;
    if (law->model == SCREE_MODEL_LINEAR_SPRING) normal = 2 * (double)law->normal_stiffness;
    // as in energy_conserving_kernel.h with V = pi R d^2, d = a^2/R
    if (law->model == SCREE_MODEL_ENERGY_CONSERVING)
        normal = 2 * M_PI * radius * (2 * p - 1) * p * (double)law->stiffness_factor * modulus *
                 pow(M_PI * pow(contact_radius / radius, 4), p - 1);
    return normal * fmax(1, (double)law->tangential_over_normal);
}
