/// \file sphere_impact.h
/// One impact of a sphere on a plane or of two spheres, along z, through a scene: what it did, and Hertz's closed
/// forms. Needs _XOPEN_SOURCE 700 before the first include (M_PI).
#ifndef SCREE_SPHERE_IMPACT_H
#define SCREE_SPHERE_IMPACT_H

#include "scene_run.h"

typedef struct impact_body
{
    double radius;      ///< [m]; 0: a plane that does not move
    double velocity[3]; ///< [m/s]
    double spin[3];     ///< [rad/s]
} impact_body;

typedef struct impact_def
{
    double youngs_modulus, poisson_ratio, density; ///< of the solid; a plane is rigid
    impact_body body[2];                           ///< the first comes from above
    double friction, restitution;
    const char *law; ///< more of the contact law: ", model: linear_spring, ..."
    double time_step;
    double (
        *history)[2]; ///< (max_history) indentation [m] and normal force [N] of each step are put there; may be NULL
    int max_history;
} impact_def;

typedef struct impact_result
{
    double deepest, largest_force, contact_time; ///< [m] [N] [s]
    double velocity[2][3], spin[2][3];           ///< after
    double kinetic_before, kinetic_after;        ///< [J] of translation and rotation
    double balance_before, balance_after;        ///< [J] see simulation.h
    int num_history;
} impact_result;

/// E* of the pair [Pa].
static inline double impact_modulus(const impact_def *def)
{
    const double one = def->youngs_modulus / (1 - def->poisson_ratio * def->poisson_ratio);
    return def->body[1].radius > 0 ? one / 2 : one;
}
static inline double impact_mass(const impact_def *def, int k)
{
    return def->density * 4 / 3 * M_PI * pow(def->body[k].radius, 3);
}
/// m* and R*; the partner's only if it is no plane.
static inline double impact_effective_mass(const impact_def *def)
{
    const double m = impact_mass(def, 0), partner = impact_mass(def, 1);
    return partner > 0 ? m * partner / (m + partner) : m;
}
static inline double impact_effective_radius(const impact_def *def)
{
    const double r = def->body[0].radius, partner = def->body[1].radius;
    return partner > 0 ? r * partner / (r + partner) : r;
}
/// Speed of approach [m/s].
static inline double impact_approach(const impact_def *def)
{
    return def->body[1].velocity[2] - def->body[0].velocity[2];
}

/// Johnson (1985), 11.1: elastic impact of spheres.
static inline double hertz_deepest(const impact_def *def)
{
    const double v = impact_approach(def);
    return pow(
        15 * impact_effective_mass(def) * v * v / (16 * impact_modulus(def) * sqrt(impact_effective_radius(def))), 0.4);
}
/// 2.9432751 is 2 int_0^1 dx/sqrt(1 - x^(5/2)).
static inline double hertz_contact_time(const impact_def *def)
{
    return 2.9432751 * hertz_deepest(def) / impact_approach(def);
}
static inline double hertz_largest_force(const impact_def *def)
{
    return 4.0 / 3.0 * impact_modulus(def) * sqrt(impact_effective_radius(def)) * pow(hertz_deepest(def), 1.5);
}

static inline void impact_start(scene_run *run, const impact_def *def)
{
    const impact_body *a = def->body, *b = def->body + 1;
    // Each of two equal solids gives half of the compliance; with twice the moduli they are together as stiff as one
    // on a rigid plane: 1/E* = (1 - nu^2)/E and 1/G* = (2 - nu)/G.
    const double modulus = b->radius > 0 ? def->youngs_modulus : 2 * def->youngs_modulus;
    char partner[500], text[3000];
    if (b->radius > 0)
        snprintf(partner, sizeof partner,
                 "  - {name: lower, shape: ball, material: solid, bodies: [{position: [0, 0, %.17g], size: %.17g, "
                 "velocity: [%.17g, %.17g, %.17g], angular_velocity: [%.17g, %.17g, %.17g]}]}\n",
                 -b->radius, 2 * b->radius, b->velocity[0], b->velocity[1], b->velocity[2], b->spin[0], b->spin[1],
                 b->spin[2]);
    else
        snprintf(partner, sizeof partner,
                 "walls:\n  - {name: plane, shape: plate, material: solid, position: [0, 0, %.17g]}\n", -2 * a->radius);
    snprintf(
        text, sizeof text,
        "gravity: [0, 0, 0]\ntime: {end: 1, step: %.17g}\n"
        "materials: [{name: solid, density: %.17g, youngs_modulus: %.17g, poisson_ratio: %.17g}]\n"
        "contact_laws: [{materials: [solid, solid], friction_coefficient: %.17g, "
        "restitution_coefficient: %.17g%s}]\n"
        "shapes: [{name: ball, source: sphere, size: 1}, {name: plate, source: box, size: [%.17g, %.17g, %.17g]}]\n"
        "particles:\n"
        "  - {name: upper, shape: ball, material: solid, bodies: [{position: [0, 0, %.17g], size: %.17g, "
        "velocity: [%.17g, %.17g, %.17g], angular_velocity: [%.17g, %.17g, %.17g]}]}\n%s",
        def->time_step, def->density, modulus, def->poisson_ratio, def->friction, def->restitution,
        def->law != NULL ? def->law : "", 400 * a->radius, 400 * a->radius, 4 * a->radius, a->radius, 2 * a->radius,
        a->velocity[0], a->velocity[1], a->velocity[2], a->spin[0], a->spin[1], a->spin[2], partner);
    scene_run_start(run, text);
}

/// Height of the top of the parabola through three equidistant values.
static inline double impact_top(const double *y)
{
    const double curve = y[0] - 2 * y[1] + y[2], slope = 0.5 * (y[2] - y[0]);
    return curve < 0 ? y[1] - 0.5 * slope * slope / curve : y[1];
}

/// Bodies touch at the start; steps until they are apart again. The forces of an elastic contact begin and end with
/// zero, so that a straight line finds the end to second order.
static inline impact_result impact_run(const impact_def *def)
{
    impact_result result = {.contact_time = NAN};
    scene_run run;
    impact_start(&run, def);
    if (run.simulation == NULL) return result;
    const scree_particles *p = &run.simulation->particles;
    scree_energies e = scree_simulation_energies(run.simulation);
    result.kinetic_before = e.kinetic + e.rotational;
    result.balance_before = scree_energies_balance(&e);
    const int num = def->body[1].radius > 0 ? 2 : 1;
    double depth[3] = {0}, force[3] = {0}, last_gap = 0;
    for (int step = 0; step < 100000 && isnan(result.contact_time); ++step)
    {
        SCREE_CHECK_INT(scree_simulation_step(run.simulation, &run.report), SCREE_OK);
        const scree_contact_list *contacts = &run.simulation->contacts;
        const double gap = (double)p->position[0].z - def->body[0].radius -
                           (num > 1 ? (double)p->position[1].z + def->body[1].radius : 0);
        for (int k = 0; k < 2; ++k)
        {
            depth[k] = depth[k + 1];
            force[k] = force[k + 1];
        }
        depth[2] = -gap;
        force[2] = contacts->num_contacts > 0 ? (double)contacts->elastic_force[0] : 0;
        if (step < def->max_history && contacts->num_contacts > 0)
        {
            def->history[step][0] = -gap;
            def->history[step][1] = (double)scree_vec3_dot(contacts->normal_force[0], contacts->normal[0]);
            result.num_history = step + 1;
        }
        if (depth[1] > depth[0] && depth[1] >= depth[2]) result.deepest = impact_top(depth);
        if (force[1] > force[0] && force[1] >= force[2]) result.largest_force = impact_top(force);
        if (gap >= 0)
            result.contact_time = scree_simulation_time(run.simulation) - def->time_step * gap / (gap - last_gap);
        last_gap = gap;
    }
    e = scree_simulation_energies(run.simulation);
    result.kinetic_after = e.kinetic + e.rotational;
    result.balance_after = scree_energies_balance(&e);
    for (int k = 0; k < num; ++k)
    {
        const double inertia = (double)p->inertia[k].x;
        const double v[3] = {(double)p->velocity[k].x, (double)p->velocity[k].y, (double)p->velocity[k].z};
        const double l[3] = {(double)p->angular_momentum[k].x, (double)p->angular_momentum[k].y,
                             (double)p->angular_momentum[k].z};
        for (int c = 0; c < 3; ++c)
        {
            result.velocity[k][c] = v[c];
            result.spin[k][c] = l[c] / inertia;
        }
    }
    scene_run_end(&run);
    return result;
}

#endif
