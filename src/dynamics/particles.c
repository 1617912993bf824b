#include "dynamics/particles.h"

#include <stdlib.h>

#define SCREE_PARTICLE_ARRAYS(X) \
    X(position)                  \
    X(orientation)               \
    X(velocity)                  \
    X(angular_momentum)          \
    X(force)                     \
    X(torque)                    \
    X(scale)                     \
    X(mass)                      \
    X(inertia)                   \
    X(shape)                     \
    X(material)                  \
    X(group)

scree_status scree_particles_create(scree_particles *particles, int64_t num_particles)
{
    *particles = (scree_particles){0};
    bool is_complete = true;
    const size_t num = num_particles > 0 ? (size_t)num_particles : 1;
#define SCREE_ALLOCATE(array)                                 \
    particles->array = calloc(num, sizeof *particles->array); \
    is_complete = is_complete && particles->array != NULL;
    SCREE_PARTICLE_ARRAYS(SCREE_ALLOCATE)
#undef SCREE_ALLOCATE
    if (!is_complete)
    {
        scree_particles_destroy(particles);
        return SCREE_OUT_OF_MEMORY;
    }
    particles->num_particles = num_particles;
    return SCREE_OK;
}

void scree_particles_destroy(scree_particles *particles)
{
#define SCREE_FREE(array) free(particles->array);
    SCREE_PARTICLE_ARRAYS(SCREE_FREE)
#undef SCREE_FREE
    *particles = (scree_particles){0};
}
