#include "dynamics/particles.h"

#include "core/permute.h"

#include <stdlib.h>

#define SCREE_MOVING_ARRAYS(X) \
    X(position)                \
    X(orientation)             \
    X(velocity)                \
    X(angular_momentum)        \
    X(force)                   \
    X(torque)

#define SCREE_PARTICLE_ARRAYS(X) \
    SCREE_MOVING_ARRAYS(X)       \
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

scree_status scree_particles_copy(scree_device *device, scree_particles *to, const scree_particles *from)
{
    const int64_t num = from->num_particles;
    bool is_complete = true;
    *to = (scree_particles){.num_particles = num};
#define SCREE_COPY(array)                                           \
    to->array = scree_device_alloc(device, num, sizeof *to->array); \
    is_complete = is_complete && to->array != NULL;                 \
    if (is_complete) scree_device_write(device, to->array, from->array, (size_t)num * sizeof *to->array);
    SCREE_PARTICLE_ARRAYS(SCREE_COPY)
#undef SCREE_COPY
    return is_complete ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

void scree_particles_read(scree_device *device, scree_particles *to, const scree_particles *from)
{
    const size_t num = (size_t)from->num_particles;
#define SCREE_READ(array) scree_device_read(device, to->array, from->array, num * sizeof *to->array);
    SCREE_MOVING_ARRAYS(SCREE_READ)
#undef SCREE_READ
}

void scree_particles_permute(scree_device *device, scree_particles *particles, const int32_t *order, void *scratch)
{
#define SCREE_MOVE(array) \
    scree_permute(device, particles->array, sizeof *particles->array, order, particles->num_particles, scratch);
    SCREE_PARTICLE_ARRAYS(SCREE_MOVE)
#undef SCREE_MOVE
}

void scree_particles_free(scree_device *device, scree_particles *particles)
{
#define SCREE_FREE(array) scree_device_free(device, particles->array);
    SCREE_PARTICLE_ARRAYS(SCREE_FREE)
#undef SCREE_FREE
    *particles = (scree_particles){0};
}
