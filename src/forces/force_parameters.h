/// \file force_parameters.h
/// The force models and the numbers they take, once: from these lists come the fields of scree_contact_law_def that a
/// scene file fills, its ranges and messages, `--help scene` and docs/scenes.md.
#ifndef SCREE_FORCE_PARAMETERS_H
#define SCREE_FORCE_PARAMETERS_H

/// X(enumerator, name, exponent n of F ~ d^n between spheres, what it is, source)
#define SCREE_FORCE_MODELS(X)                                                                                        \
    X(HERTZ_MINDLIN, "hertz_mindlin", 1.5,                                                                           \
      "F = c E* sqrt(V d), V the overlap volume; a sphere contact has V = pi R* d^2, and F is Hertz's 4/3 E* "       \
      "sqrt(R*) d^(3/2)",                                                                                            \
      "Hertz; Mindlin; Nassauer & Kuna (2013), Granular Matter 15, 349; Bilock (2020), eqs. 4.5-4.9 and 4.16-4.18")  \
    X(LINEAR_SPRING, "linear_spring", 1.0, "F = k_n d, linear spring and dashpot",                                   \
      "Cundall & Strack (1979), Geotechnique 29, 47")                                                                \
    X(ENERGY_CONSERVING, "energy_conserving", 1.5,                                                                   \
      "gradient of the energy w = c E* V (V/R*^3)^(p-1), force and moment; elastic impacts of any shape keep their " \
      "kinetic energy",                                                                                              \
      "Feng (2021), CMAME 373, 113454")

enum
{
#define SCREE_MODEL_ENUMERATOR(model, name, exponent, text, source) SCREE_MODEL_##model,
    SCREE_FORCE_MODELS(SCREE_MODEL_ENUMERATOR)
#undef SCREE_MODEL_ENUMERATOR
        SCREE_NUM_FORCE_MODELS
};

/// Sets of models.
#define SCREE_BY_HERTZ_MINDLIN (1 << SCREE_MODEL_HERTZ_MINDLIN)
#define SCREE_BY_LINEAR_SPRING (1 << SCREE_MODEL_LINEAR_SPRING)
#define SCREE_BY_ENERGY_CONSERVING (1 << SCREE_MODEL_ENERGY_CONSERVING)
#define SCREE_BY_ALL ((1 << SCREE_NUM_FORCE_MODELS) - 1)

/// X(name, unit, default, word that may stand for the number, min, max, models that use it, that need it, meaning)
#define SCREE_FORCE_PARAMETERS(X)                                                                                      \
    X(friction_coefficient, "1", NULL, NULL, 0, 10, SCREE_BY_ALL, 0,                                                   \
      "largest tangential over normal force; 0: no friction")                                                          \
    X(restitution_coefficient, "1", "auto", "auto", 0.01, 1, SCREE_BY_ALL, 0,                                          \
      "speed after over speed before a central impact of spheres; give this or damping_ratio")                         \
    X(damping_ratio, "1", "auto", "auto", 0, 10, SCREE_BY_ALL, 0,                                                      \
      "damping coefficient g of normal and tangential forces; auto: from restitution_coefficient")                     \
    X(tangential_damping_ratio, "1", "auto", "auto", 0, 10, SCREE_BY_ALL, 0,                                           \
      "g of the tangential force alone; auto: damping_ratio")                                                          \
    X(stiffness_factor, "1", "auto", "auto", 1e-6, 1e3, SCREE_BY_HERTZ_MINDLIN | SCREE_BY_ENERGY_CONSERVING, 0,        \
      "factor c of E* in hertz_mindlin and energy_conserving; auto: Hertz's between spheres, 4/(3 sqrt(pi)) = 0.7523 " \
      "and 8/15 pi^(-5/4) = 0.1275. Nassauer & Kuna (2013) report 0.62 for polyhedra in hertz_mindlin")                \
    X(energy_exponent, "1", "auto", "auto", 1, 2, SCREE_BY_ENERGY_CONSERVING, 0,                                       \
      "p of energy_conserving: 1, 1.25, 1.5, 1.75 or 2; between spheres F goes as d^(2p-1); auto: 1.25, as Hertz; "    \
      "bodies "                                                                                                        \
      "that rest on flat faces want 2, where F goes as d")                                                             \
    X(normal_stiffness, "N/m", "auto", "auto", 1e-9, 1e15, SCREE_BY_LINEAR_SPRING, SCREE_BY_LINEAR_SPRING,             \
      "k_n of linear_spring, which must have one")                                                                     \
    X(tangential_stiffness, "N/m", "auto", "auto", 1e-9, 1e15, SCREE_BY_LINEAR_SPRING, 0,                              \
      "k_t of linear_spring; auto: normal_stiffness 4 G*/E*, the ratio after Mindlin")                                 \
    X(tangential_spring, "1", "1", NULL, 0, 1, SCREE_BY_ALL, 0,                                                        \
      "1: tangential spring with history, 0: tangential damping alone")                                                \
    X(rolling_friction_coefficient, "1", "auto", "auto", 0, 10, SCREE_BY_ALL, 0,                                       \
      "largest moment of rolling_resistance over R* times normal force: the tangent of the slope on which a "          \
      "sphere stays")                                                                                                  \
    X(rolling_damping_ratio, "1", "0", NULL, 0, 10, SCREE_BY_ALL, 0,                                                   \
      "share of the critical damping of rolling_resistance spring, below its limit")

#endif
