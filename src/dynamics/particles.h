/// \file particles.h
/// State of all particles in SoA form; the index of a particle is its id, or during steps its place, see places.h.
#ifndef SCREE_PARTICLES_H
#define SCREE_PARTICLES_H

#include "core/device.h"
#include "core/vec.h"
#include "scree/base.h"

/// Owns its arrays, all (num_particles).
typedef struct scree_particles
{
    int64_t num_particles;

    // moving
    scree_vec3 *position;         ///< [m] centroid
    scree_quat *orientation;      ///< body frame (principal axes) to world
    scree_vec3 *velocity;         ///< [m/s]
    scree_vec3 *angular_momentum; ///< [kg m^2/s] world axes, about the centroid
    scree_vec3 *force;            ///< [N] of contacts and gravity
    scree_vec3 *torque;           ///< [N m] of contacts

    // constant
    scree_real *scale;   ///< [1] size over the size of the shape
    scree_real *mass;    ///< [kg]
    scree_vec3 *inertia; ///< [kg m^2] principal moments
    int32_t *shape;      ///< index of the particle shape
    int32_t *material;   ///< index of the material
    int32_t *group;      ///< index of the particle group of the scene
} scree_particles;

scree_status scree_particles_create(scree_particles *particles, int64_t num_particles);
void scree_particles_destroy(scree_particles *particles);
/// *to: the same particles on a GPU. SCREE_OUT_OF_MEMORY.
scree_status scree_particles_copy(scree_device *device, scree_particles *to, const scree_particles *from);
/// The moving arrays back from there.
void scree_particles_read(scree_device *device, scree_particles *to, const scree_particles *from);
/// Particle order[k] to place k; `scratch` has room for one of their arrays.
void scree_particles_permute(scree_device *device, scree_particles *particles, const int32_t *order, void *scratch);
void scree_particles_free(scree_device *device, scree_particles *particles);

/// Spheres and cubes turn like this: about the angular momentum, whatever their orientation.
SCREE_FN bool scree_is_isotropic(scree_vec3 inertia) { return inertia.x == inertia.y && inertia.x == inertia.z; }

/// [rad/s] world axes: R I^-1 R^T L.
SCREE_FN scree_vec3 scree_angular_velocity(scree_vec3 angular_momentum, scree_vec3 inertia, scree_quat orientation)
{
    if (scree_is_isotropic(inertia)) return scree_vec3_scale(angular_momentum, 1 / inertia.x);
    const scree_mat3 rotation = scree_mat3_from_quat(orientation);
    const scree_vec3 body = scree_mat3_apply_transposed(rotation, angular_momentum);
    return scree_mat3_apply(rotation, scree_vec3_make(body.x / inertia.x, body.y / inertia.y, body.z / inertia.z));
}

#endif
