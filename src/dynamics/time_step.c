#include "dynamics/time_step.h"

#include <math.h>

/// Contact radius of a sphere to expect, over its radius: 2 sqrt(1/50), a contact with a plane at an indentation of a
/// fiftieth of the radius on each of two sides, for in a packing a sphere is held from all sides at once. Half of the
/// critical step is then 0.18 of the Rayleigh time. At 0.31 of it, a = R/10, a column of soft spheres gained energy as
/// it collapsed.
#define SPHERE_CONTACT_RADIUS 0.283

/// Radius that a contact to expect goes by: of a clump that of its largest sphere. It may stand on several of them,
/// whose stiffnesses add up.
static double touching_radius(const scree_shape *shape)
{
    if (shape->view.kind != SCREE_KIND_CLUMP) return shape->properties.bounding_radius;
    double largest = 0;
    for (int32_t k = 0; k < shape->view.num_spheres; ++k) largest = fmax(largest, (double)shape->spheres[k].radius);
    return largest;
}

double scree_time_step_critical(const scree_simulation *simulation)
{
    const scree_particles *p = &simulation->particles;
    double smallest_squared = INFINITY;
    for (int64_t i = 0; i < p->num_particles; ++i)
    {
        const scree_shape *shape = simulation->particle_shapes + p->shape[i];
        const double share = shape->view.kind == SCREE_KIND_MESH ? 0.5 : SPHERE_CONTACT_RADIUS;
        const double radius = touching_radius(shape) * (double)p->scale[i];
        double stiffness = 0;
        for (int32_t m = 0; m < simulation->num_materials; ++m)
        {
            // a pair of materials that cannot meet has no law, and so no stiffness
            const scree_force_law *law = simulation->laws + p->material[i] * simulation->num_materials + m;
            stiffness = fmax(stiffness, scree_force_law_largest_stiffness(law, share * radius, radius));
        }
        if (shape->view.kind == SCREE_KIND_CLUMP) stiffness *= shape->num_supports;
        smallest_squared = fmin(smallest_squared, (double)p->mass[i] / (3.5 * stiffness));
    }
    return sqrt(smallest_squared);
}

double scree_impact_capacity(const scree_simulation *simulation, int64_t i)
{
    const scree_particles *p = &simulation->particles;
    const double radius = touching_radius(simulation->particle_shapes + p->shape[i]) * (double)p->scale[i];
    double softest = INFINITY;
    for (int32_t m = 0; m < simulation->num_materials; ++m)
    {
        const scree_force_law *law = simulation->laws + p->material[i] * simulation->num_materials + m;
        const double stiffness = scree_force_law_largest_stiffness(law, radius, radius);
        if (stiffness > 0) softest = fmin(softest, stiffness);
    }
    return 0.5 * softest * radius * radius;
}
