/// \file chung_ooi_solids.h
/// The solids of Chung & Ooi (2011), Granular Matter 13, 643, for tests and the study of elementary cases.
#ifndef SCREE_CHUNG_OOI_SOLIDS_H
#define SCREE_CHUNG_OOI_SOLIDS_H

#include "sphere_impact.h"

typedef struct solid
{
    const char *name;
    double youngs_modulus, poisson_ratio, density;
} solid;

static const solid glass = {"glass", 48e9, 0.2, 2800}, limestone = {"limestone", 20e9, 0.25, 2500},
                   al_alloy = {"Al alloy", 70e9, 0.3, 2699}, mg_alloy = {"Mg alloy", 40e9, 0.35, 1800},
                   al_oxide = {"Al oxide", 380e9, 0.23, 4000}, cast_iron = {"cast iron", 100e9, 0.25, 7000},
                   steel = {"steel", 208e9, 0.3, 7850}, polyethylene = {"polyethylene", 1e9, 0.4, 1400},
                   nylon = {"nylon", 2.5e9, 0.4, 1000}, copper = {"copper", 120e9, 0.35, 8900};

/// Elastic, frictionless impact of a sphere [m] on what is below it [m/s].
static inline impact_def define(solid of, double radius, double speed)
{
    impact_def def = {of.youngs_modulus, of.poisson_ratio, of.density, .restitution = 1};
    def.body[0].radius = radius;
    def.body[0].velocity[2] = -speed;
    return def;
}

#endif
