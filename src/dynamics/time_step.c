#include "dynamics/time_step.h"

#include <math.h>

/// Depth of a sphere's contact with a plane to expect, over its radius. Half of the critical step is then about 0.3 of
/// the Rayleigh time, and still below the critical step at sixteen times this depth.
#define SPHERE_INDENTATION 0.01

double scree_time_step_critical(const scree_simulation *simulation)
{
    const scree_particles *p = &simulation->particles;
    double smallest_squared = INFINITY;
    for (int64_t i = 0; i < p->num_particles; ++i)
    {
        const scree_shape *shape = simulation->particle_shapes + p->shape[i];
        const double share = shape->view.kind == SCREE_KIND_SPHERE ? sqrt(SPHERE_INDENTATION) : 0.5;
        const double radius = shape->properties.bounding_radius * (double)p->scale[i];
        double stiffness = 0;
        for (int32_t m = 0; m < simulation->num_materials; ++m)
        {
            // a pair of materials that cannot meet has no law, and so no stiffness
            const scree_force_law *law = simulation->laws + p->material[i] * simulation->num_materials + m;
            stiffness = fmax(stiffness, scree_force_law_largest_stiffness(law, share * radius, radius));
        }
        smallest_squared = fmin(smallest_squared, (double)p->mass[i] / (3.5 * stiffness));
    }
    return sqrt(smallest_squared);
}
