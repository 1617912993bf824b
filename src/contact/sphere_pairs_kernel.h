/// \file sphere_pairs_kernel.h
/// Candidate pairs of spheres to contacts. Two passes: how many contacts each pair has, then, with the places in the
/// list known, the contacts. Two spheres are simply looked at again in the second pass; what was found on a mesh waits
/// in an array of its own.
#ifndef SCREE_SPHERE_PAIRS_KERNEL_H
#define SCREE_SPHERE_PAIRS_KERNEL_H

#include "contact/contact_list.h"
#include "contact/narrow_phase.h"
#include "contact/sphere_contact_kernel.h"

typedef struct scree_sphere_pairs_args
{
    scree_bodies bodies;
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

SCREE_FN scree_real scree_sphere_radius(const scree_bodies *bodies, int32_t i)
{
    return bodies->shapes[bodies->shape[i]].bounding_radius * bodies->pose[i].scale;
}

/// Entry c of the list. `effective_radius` is R*; the normal leads towards i, the point lies at `arm` from i.
SCREE_FN void scree_write_sphere_contact(const scree_contact_list *list, int64_t c, scree_vec3 normal, scree_vec3 arm,
                                         scree_real effective_radius, const scree_sphere_contact *contact)
{
    const scree_real pi = (scree_real)3.14159265358979323846;
    const scree_real d = contact->indentation, share = contact->weight * contact->weight;
    list->volume[c] = pi * effective_radius * (d * d) * share;
    list->indentation[c] = d;
    list->radius[c] = 0;
    list->normal[c] = normal;
    list->area_vector[c] = scree_vec3_scale(normal, -2 * pi * effective_radius * d * contact->weight);
    list->arm[c] = arm;
}

SCREE_FN bool scree_sphere_pair_contact(const scree_sphere_pairs_args *a, scree_candidate_pair pair,
                                        scree_sphere_contact *contact)
{
    const scree_vec3 between = scree_vec3_sub(a->bodies.pose[pair.i].position, a->bodies.pose[pair.j].position);
    return scree_sphere_sphere_contact(
        between, scree_sphere_radius(&a->bodies, pair.i) + scree_sphere_radius(&a->bodies, pair.j), contact);
}

SCREE_FN void scree_sphere_sphere_count_at(scree_sphere_sphere_count_args a, int64_t b)
{
    scree_sphere_contact contact;
    const int32_t p = a.batch[b];
    a.num_contacts[p] = scree_sphere_pair_contact(&a, a.pairs[p], &contact) ? 1 : 0;
}

SCREE_FN void scree_sphere_sphere_write_at(scree_sphere_sphere_write_args a, int64_t b)
{
    const int32_t p = a.batch[b];
    const scree_candidate_pair pair = a.pairs[p];
    scree_sphere_contact contact;
    if (!scree_sphere_pair_contact(&a, pair, &contact)) return;
    const int64_t c = a.list.first_of_pair[p];
    const scree_real r_i = scree_sphere_radius(&a.bodies, pair.i), r_j = scree_sphere_radius(&a.bodies, pair.j);
    const scree_vec3 arm = scree_vec3_scale(contact.normal, contact.indentation / 2 - r_i);
    a.list.bodies[c] = pair;
    a.list.patch[c] = 0;
    scree_write_sphere_contact(&a.list, c, contact.normal, arm, r_i * r_j / (r_i + r_j), &contact);
}

/// The body of a pair that is the sphere; the other is the mesh.
SCREE_FN bool scree_is_first_the_sphere(const scree_bodies *bodies, scree_candidate_pair pair)
{
    return bodies->shapes[bodies->shape[pair.i]].kind == SCREE_KIND_SPHERE;
}

SCREE_FN void scree_sphere_mesh_count_at(scree_sphere_mesh_count_args a, int64_t b)
{
    const scree_candidate_pair pair = a.pairs[a.batch[b]];
    const bool is_first = scree_is_first_the_sphere(&a.bodies, pair);
    const int32_t sphere = is_first ? pair.i : pair.j, mesh = is_first ? pair.j : pair.i;
    const scree_sphere_on_mesh on_mesh = scree_sphere_to_mesh(
        a.bodies.pose[sphere].position, scree_sphere_radius(&a.bodies, sphere), a.bodies.pose + mesh);
    bool is_inside;
    a.num_contacts[a.batch[b]] = scree_sphere_mesh_contacts(a.bodies.shapes + a.bodies.shape[mesh], on_mesh,
                                                            a.found + b * a.max_found, a.max_found, &is_inside);
    a.is_inside[b] = is_inside ? 1 : 0;
}

SCREE_FN void scree_sphere_mesh_write_at(scree_sphere_mesh_write_args a, int64_t b)
{
    const int32_t p = a.batch[b];
    const scree_candidate_pair pair = a.pairs[p];
    const bool is_first = scree_is_first_the_sphere(&a.bodies, pair);
    const scree_real radius = scree_sphere_radius(&a.bodies, is_first ? pair.i : pair.j);
    for (int32_t k = 0; k < a.num_contacts[p]; ++k)
    {
        const int64_t c = a.list.first_of_pair[p] + k;
        const scree_sphere_contact *contact = a.found + b * a.max_found + k;
        scree_vec3 normal = contact->normal;
        scree_vec3 arm = scree_vec3_scale(normal, contact->indentation / 2 - radius);
        if (!is_first)
        {
            const scree_vec3 centre = a.bodies.pose[pair.j].position;
            arm = scree_vec3_add(scree_vec3_sub(centre, a.bodies.pose[pair.i].position), arm);
            normal = scree_vec3_negate(normal);
        }
        a.list.bodies[c] = pair;
        a.list.patch[c] = k;
        scree_write_sphere_contact(&a.list, c, normal, arm, radius, contact);
    }
}

#endif
