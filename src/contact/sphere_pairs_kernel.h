/// \file sphere_pairs_kernel.h
/// Candidate pairs of spheres to contacts. Two passes: how many contacts each pair has, then, with the places in the
/// list known, the contacts. Two spheres are simply looked at again in the second pass; what was found on a mesh waits
/// in an array of its own.
#ifndef SCREE_SPHERE_PAIRS_KERNEL_H
#define SCREE_SPHERE_PAIRS_KERNEL_H

#include "contact/contact_list.h"
#include "contact/narrow_phase.h"
#include "contact/sphere_contact_kernel.h"

/// A body as spheres see it: where it is, and how large if it is one.
typedef struct scree_sphere
{
    scree_vec3 centre; ///< [m]
    scree_real radius; ///< [m]; 0: not a sphere
} scree_sphere;

typedef struct scree_place_spheres_args
{
    const scree_shape_view *shapes;
    const int32_t *shape;   ///< (num_bodies)
    const scree_pose *pose; ///< (num_bodies)
    scree_sphere *spheres;  ///< (num_bodies) out
} scree_place_spheres_args;

/// Body i; what the pairs need of it, in half a cache line.
SCREE_FN void scree_place_spheres_at(scree_place_spheres_args a, int64_t i)
{
    const scree_shape_view *shape = a.shapes + a.shape[i];
    a.spheres[i].centre = a.pose[i].position;
    a.spheres[i].radius = shape->kind == SCREE_KIND_SPHERE ? shape->bounding_radius * a.pose[i].scale : 0;
}

typedef struct scree_sphere_pairs_args
{
    const scree_sphere *spheres;       ///< (num_bodies)
    const scree_shape_view *shapes;    ///< of all bodies
    const int32_t *shape;              ///< (num_bodies)
    const scree_pose *pose;            ///< (num_bodies)
    const scree_candidate_pair *pairs; ///< (num_pairs) all candidate pairs
    const int32_t *batch;              ///< (num) indices of those that this launch is for
    int32_t *num_contacts;             ///< (num_pairs) of each pair; written by the first pass, read by the second
    scree_contact_list list;           ///< second pass: first_of_pair read, geometry written

    // spheres on meshes
    scree_sphere_contact *found; ///< (num, max_found)
    uint8_t *is_inside;          ///< (num) out: the centre is inside the solid
    int32_t max_found;
} scree_sphere_pairs_args;

typedef scree_sphere_pairs_args scree_sphere_sphere_count_args;
typedef scree_sphere_pairs_args scree_sphere_sphere_write_args;
typedef scree_sphere_pairs_args scree_sphere_mesh_count_args;
typedef scree_sphere_pairs_args scree_sphere_mesh_write_args;

// The address of a part of the arguments is never taken: compilers would then copy all of them for each pair.

SCREE_FN void scree_sphere_sphere_count_at(scree_sphere_sphere_count_args a, int64_t b)
{
    const int32_t p = a.batch[b];
    const scree_sphere i = a.spheres[a.pairs[p].i], j = a.spheres[a.pairs[p].j];
    a.num_contacts[p] = scree_spheres_touch(scree_vec3_sub(i.centre, j.centre), i.radius + j.radius);
}

/// Volume of a sphere's contact; R* is `effective_radius`.
SCREE_FN scree_real scree_sphere_contact_volume(scree_real effective_radius, scree_real indentation, scree_real weight)
{
    const scree_real pi = (scree_real)3.14159265358979323846;
    return pi * effective_radius * (indentation * indentation) * (weight * weight);
}

/// Marks contact c as one that acts in a point.
SCREE_FN void scree_write_point(scree_contact_list list, int64_t c)
{
    if (list.acts_in_points) return;
    list.radius[c] = 0;
    list.area_vector[c] = scree_vec3_zero();
    list.torque_vector[c] = scree_vec3_zero();
}

SCREE_FN void scree_sphere_sphere_write_at(scree_sphere_sphere_write_args a, int64_t b)
{
    const int32_t p = a.batch[b];
    const scree_candidate_pair pair = a.pairs[p];
    const scree_sphere i = a.spheres[pair.i], j = a.spheres[pair.j];
    scree_sphere_contact contact;
    if (!scree_sphere_sphere_contact(scree_vec3_sub(i.centre, j.centre), i.radius + j.radius, &contact)) return;
    const int64_t c = a.list.first_of_pair[p];
    const scree_real effective_radius = i.radius * j.radius / (i.radius + j.radius);
    a.list.bodies[c] = pair;
    a.list.patch[c] = 0;
    a.list.volume[c] = scree_sphere_contact_volume(effective_radius, contact.indentation, 1);
    a.list.indentation[c] = contact.indentation;
    a.list.normal[c] = contact.normal;
    a.list.arm[c] = scree_vec3_scale(contact.normal, contact.indentation / 2 - i.radius);
    scree_write_point(a.list, c);
}

SCREE_FN void scree_sphere_mesh_count_at(scree_sphere_mesh_count_args a, int64_t b)
{
    const scree_candidate_pair pair = a.pairs[a.batch[b]];
    const bool is_first = a.spheres[pair.i].radius > 0; // is the sphere
    const scree_sphere sphere = a.spheres[is_first ? pair.i : pair.j];
    const int32_t mesh = is_first ? pair.j : pair.i;
    bool is_inside;
    a.num_contacts[a.batch[b]] = scree_sphere_mesh_contacts(
        a.shapes + a.shape[mesh], scree_sphere_to_mesh(sphere.centre, sphere.radius, a.pose + mesh),
        a.found + b * a.max_found, a.max_found, &is_inside);
    a.is_inside[b] = is_inside ? 1 : 0;
}

SCREE_FN void scree_sphere_mesh_write_at(scree_sphere_mesh_write_args a, int64_t b)
{
    const int32_t p = a.batch[b];
    const scree_candidate_pair pair = a.pairs[p];
    const bool is_first = a.spheres[pair.i].radius > 0;
    const scree_sphere sphere = a.spheres[is_first ? pair.i : pair.j];
    for (int32_t k = 0; k < a.num_contacts[p]; ++k)
    {
        const int64_t c = a.list.first_of_pair[p] + k;
        const scree_sphere_contact contact = a.found[b * a.max_found + k];
        const scree_vec3 arm = scree_vec3_scale(contact.normal, contact.indentation / 2 - sphere.radius);
        const scree_vec3 to_sphere = scree_vec3_sub(sphere.centre, a.spheres[pair.i].centre);
        const scree_vec3 normal = is_first ? contact.normal : scree_vec3_negate(contact.normal);
        a.list.bodies[c] = pair;
        a.list.patch[c] = k;
        a.list.volume[c] = scree_sphere_contact_volume(sphere.radius, contact.indentation, contact.weight);
        a.list.indentation[c] = contact.indentation;
        a.list.normal[c] = normal;
        a.list.arm[c] = is_first ? arm : scree_vec3_add(to_sphere, arm);
        scree_write_point(a.list, c);
    }
}

#endif
