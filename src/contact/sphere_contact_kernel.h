/// \file sphere_contact_kernel.h
/// Contacts of true spheres: with each other and with meshes.
///
/// A sphere contact has an indentation d and a normal n through the sphere's centre; its point lies in the middle of
/// the overlap, and its volume is pi R* d^2, the limit of the overlap volume for small d, so that hertz_mindlin is what
/// its name says. On a mesh R* is the sphere's radius, as on a plane.
///
/// A mesh is touched where the distance from the centre over its surface has a local minimum below the radius: in a
/// face, on an edge or in a vertex, each once, however the surface is cut into triangles; a groove or a corner is
/// touched two or three times. Minima seen from inside the solid do not count, unless one is the nearest of all: then
/// the centre is inside, and d = r + distance leads on continuously from d = r - distance and pushes it out.
///
/// In a shallow groove the two caps that its sides cut off the sphere overlap, and as the angle goes to zero they
/// become one. Such contacts share: if the two planes meet at the depth s > 0 below the sphere's surface and the caps
/// reach p_i = d_i - s deeper, then contact i has the weight p_i (p_i + p_j + s)/(p_i (p_i + p_j + s) + s p_j), which
/// is 1 while s = 0, 0 where its cap is about to vanish in the other, and 1/2 for both in a plane. Force and stiffness
/// go with the weight (the volume with its square), so they are continuous as the sphere rolls over any groove.
#ifndef SCREE_SPHERE_CONTACT_KERNEL_H
#define SCREE_SPHERE_CONTACT_KERNEL_H

#include "contact/closest_point_kernel.h"

/// One contact of a sphere.
typedef struct scree_sphere_contact
{
    scree_vec3 normal;      ///< [1] unit, towards the centre of the sphere
    scree_real indentation; ///< [m]
    scree_real weight;      ///< [1] in (0, 1]; below 1 where contacts share
    int32_t rank;           ///< on a mesh: 0 in a face, 1 on an edge, 2 in a vertex
    int32_t sphere;         ///< of the clump
} scree_sphere_contact;

/// Two spheres; `between` leads from the other centre to the one that the normal points to. False: apart, or centres
/// in one point, where no direction is better than another.
SCREE_FN bool scree_spheres_touch(scree_vec3 between, scree_real sum_of_radii)
{
    // without branches: which pairs touch cannot be foreseen
    const scree_real squared = scree_vec3_dot(between, between);
    return (sum_of_radii - scree_sqrt(squared) > 0) & (squared > 0);
}

/// Contact of two spheres that touch.
SCREE_FN scree_sphere_contact scree_touching_spheres_contact(scree_vec3 between, scree_real sum_of_radii)
{
    const scree_real distance = scree_vec3_length(between);
    scree_sphere_contact contact;
    contact.normal = scree_vec3_scale(between, 1 / distance);
    contact.indentation = sum_of_radii - distance;
    contact.weight = 1;
    contact.rank = 0;
    contact.sphere = 0;
    return contact;
}

SCREE_FN bool scree_sphere_sphere_contact(scree_vec3 between, scree_real sum_of_radii, scree_sphere_contact *contact)
{
    if (!scree_spheres_touch(between, sum_of_radii)) return false;
    *contact = scree_touching_spheres_contact(between, sum_of_radii);
    return true;
}

/// Nearer than this share of the radius two contact points are one: wide enough that the depths between contacts that
/// are kept apart, about its square of the radius, stand above rounding (cube root of epsilon).
#ifdef SCREE_SINGLE
#define SCREE_SPHERE_ONE_POINT ((scree_real)4.9e-3)
#else
#define SCREE_SPHERE_ONE_POINT ((scree_real)6.1e-6)
#endif

/// Vector from the centre to the touched point.
SCREE_FN scree_vec3 scree_contact_reach(const scree_sphere_contact *contact, scree_real radius)
{
    return scree_vec3_scale(contact->normal, contact->indentation - radius);
}

/// Adds a contact unless its point is there already. Of two that are one the face's stays, whose normal does not depend
/// on how near the point is to a seam, else the deeper one. Returns the new number, which counts on beyond
/// max_contacts.
SCREE_FN int32_t scree_add_sphere_contact(scree_sphere_contact *contacts, int32_t num, int32_t max_contacts,
                                          scree_real radius, scree_approach approach)
{
    const scree_real tolerance = SCREE_SPHERE_ONE_POINT * radius;
    scree_sphere_contact added;
    added.normal = approach.normal;
    added.indentation = radius - approach.height;
    added.weight = 1;
    added.rank = approach.rank;
    added.sphere = 0;
    for (int32_t k = 0; k < num && k < max_contacts; ++k)
    {
        const scree_vec3 d =
            scree_vec3_sub(scree_contact_reach(contacts + k, radius), scree_contact_reach(&added, radius));
        if (scree_vec3_dot(d, d) > tolerance * tolerance) continue;
        const bool is_deeper = added.indentation > contacts[k].indentation;
        if (added.rank < contacts[k].rank || (added.rank == contacts[k].rank && is_deeper)) contacts[k] = added;
        return num;
    }
    if (num < max_contacts) contacts[num] = added;
    return num + 1;
}

/// What contact i loses to contact j: (1 - w)/w of the weight w in the head of this file.
SCREE_FN scree_real scree_share_lost(const scree_sphere_contact *i, const scree_sphere_contact *j, scree_real radius)
{
    // the planes through both points meet at the distance |p_i - p_j|/sin(angle) from the centre
    const scree_vec3 d = scree_vec3_sub(scree_contact_reach(i, radius), scree_contact_reach(j, radius));
    const scree_vec3 cross = scree_vec3_cross(i->normal, j->normal);
    const scree_real sine = scree_vec3_length(cross);
    const scree_real shared = sine > 0 ? radius - scree_vec3_length(d) / sine : 0;
    if (!(shared > 0)) return 0;
    const scree_real deeper_i = i->indentation - shared, deeper_j = j->indentation - shared;
    if (!(deeper_j > 0)) return 0;
    if (!(deeper_i > 0)) return SCREE_REAL_MAX;
    return shared * deeper_j / (deeper_i * (deeper_i + deeper_j + shared));
}

/// Weights of the contacts of one sphere with one mesh; those that have none left are removed.
SCREE_FN int32_t scree_share_sphere_contacts(scree_sphere_contact *contacts, int32_t num, scree_real radius)
{
    if (num < 2) return num; // with the weight 1
    for (int32_t i = 0; i < num; ++i)
    {
        scree_real lost = 0;
        for (int32_t j = 0; j < num; ++j)
            if (j != i) lost += scree_share_lost(contacts + i, contacts + j, radius);
        contacts[i].weight = 1 / (1 + lost);
    }
    int32_t num_kept = 0;
    for (int32_t i = 0; i < num; ++i)
        if (contacts[i].weight > SCREE_REAL_EPSILON) contacts[num_kept++] = contacts[i];
    return num_kept;
}

/// A sphere as a mesh sees it.
typedef struct scree_sphere_on_mesh
{
    scree_vec3 centre;   ///< in the mesh's body frame, unscaled
    scree_real radius;   ///< likewise
    scree_mat3 rotation; ///< body frame to world
    scree_real scale;
} scree_sphere_on_mesh;

SCREE_FN scree_sphere_on_mesh scree_sphere_to_mesh(scree_vec3 centre, scree_real radius, const scree_pose *mesh)
{
    scree_sphere_on_mesh sphere;
    sphere.rotation = scree_mat3_from_quat(mesh->orientation);
    sphere.scale = mesh->scale;
    const scree_vec3 t = scree_mat3_apply_transposed(sphere.rotation, scree_vec3_sub(centre, mesh->position));
    sphere.centre = t;
    sphere.radius = radius;
    if (mesh->scale == 1) return sphere; // walls
    sphere.centre = scree_vec3_make(t.x / mesh->scale, t.y / mesh->scale, t.z / mesh->scale);
    sphere.radius = radius / mesh->scale;
    return sphere;
}

/// Contacts of a sphere with a mesh while the triangles are gone through.
typedef struct scree_mesh_search
{
    scree_sphere_contact *contacts; ///< (max_contacts)
    int32_t num, max_contacts;
    scree_real outside, inside; ///< [m^2] to the nearest points seen from outside and from inside, unscaled
    scree_approach deepest;     ///< that of the latter
} scree_mesh_search;

SCREE_FN scree_mesh_search scree_mesh_search_start(scree_sphere_on_mesh sphere, scree_sphere_contact *contacts,
                                                   int32_t max_contacts)
{
    scree_mesh_search search;
    search.contacts = contacts;
    search.num = 0;
    search.max_contacts = max_contacts;
    search.outside = search.inside = sphere.radius * sphere.radius;
    search.deepest.normal = scree_vec3_zero();
    search.deepest.height = 0;
    search.deepest.rank = 0;
    return search;
}

/// Takes up a local minimum below the radius.
SCREE_FN void scree_mesh_search_meet(scree_mesh_search *search, const scree_shape_view *mesh, scree_real radius,
                                     const scree_closest_point *closest)
{
    const scree_approach approach = scree_approach_of(mesh, closest);
    if (approach.height > 0)
    {
        search->outside = scree_min(search->outside, closest->squared);
        search->num = scree_add_sphere_contact(search->contacts, search->num, search->max_contacts, radius, approach);
    }
    else if (closest->squared < search->inside)
    {
        search->inside = closest->squared;
        search->deepest = approach;
    }
}

/// Returns the number of contacts; if that exceeds max_contacts, what is written is useless: search again with more
/// room. *is_inside: the centre is inside the mesh's solid.
SCREE_FN int32_t scree_mesh_search_end(scree_mesh_search *search, const scree_sphere_on_mesh *sphere, bool *is_inside)
{
    scree_sphere_contact *contacts = search->contacts;
    int32_t num = search->num;
    *is_inside = search->inside < search->outside;
    if (*is_inside)
        num = scree_add_sphere_contact(contacts, num, search->max_contacts, sphere->radius, search->deepest);
    if (num > search->max_contacts) return num;
    num = scree_share_sphere_contacts(contacts, num, sphere->radius);
    for (int32_t c = 0; c < num; ++c)
    {
        contacts[c].normal = scree_mat3_apply(sphere->rotation, contacts[c].normal);
        contacts[c].indentation = contacts[c].indentation * sphere->scale;
    }
    return num;
}

/// Contacts of a sphere with a posed mesh, of which what lies below these nodes of its tree, in its order, can be met;
/// the root is enough. Returns what scree_mesh_search_end() does.
SCREE_FN int32_t scree_sphere_mesh_contacts(const scree_shape_view *mesh, scree_sphere_on_mesh sphere,
                                            const int32_t *nodes, int32_t num_nodes, scree_sphere_contact *contacts,
                                            int32_t max_contacts, bool *is_inside)
{
    const scree_real squared_radius = sphere.radius * sphere.radius;
    scree_mesh_search search = scree_mesh_search_start(sphere, contacts, max_contacts);
    int32_t n = 0, k = SCREE_LBVH_END, end = SCREE_LBVH_END;
    while (k != end || n < num_nodes)
    {
        if (k == end)
        {
            k = nodes[n++];
            end = mesh->tree.nodes[k].escape;
        }
        const scree_lbvh_node *node = mesh->tree.nodes + k;
        const bool is_met = scree_box_distance_squared(node->box, sphere.centre) < squared_radius;
        k = is_met && node->first_child >= 0 ? node->first_child : node->escape;
        if (!is_met || node->first_child >= 0) continue;
        const scree_closest_point closest = scree_closest_on_triangle(mesh, -1 - node->first_child, sphere.centre);
        if (closest.squared < squared_radius && scree_is_local_minimum(mesh, sphere.centre, closest))
            scree_mesh_search_meet(&search, mesh, sphere.radius, &closest);
    }
    return scree_mesh_search_end(&search, &sphere, is_inside);
}

#endif
