/// \file sphere_pairs_kernel.h
/// Candidate pairs of spheres and of clumps of them to contacts. Two passes: how many contacts each pair has, then,
/// with the places in the list known, the contacts. Two spheres are simply looked at again in the second pass; what was
/// found on a mesh waits in an array of its own.
///
/// A clump touches wherever one of its spheres does, each a contact of its own with a patch that says which sphere it
/// was. A sphere is a clump of one; only where two of them meet is there a way of its own, the short one.
#ifndef SCREE_SPHERE_PAIRS_KERNEL_H
#define SCREE_SPHERE_PAIRS_KERNEL_H

#include "contact/contact_list.h"
#include "contact/pair_tally.h"
#include "contact/sphere_contact_kernel.h"

typedef struct scree_place_spheres_args
{
    const scree_shape_view *shapes;
    const int32_t *shape;   ///< (num_bodies)
    const scree_pose *pose; ///< (num_bodies)
    scree_sphere *spheres;  ///< (num_bodies) out; radius 0: not a sphere
} scree_place_spheres_args;

/// Body i; what the pairs need of it, in half a cache line.
SCREE_FN void scree_place_spheres_at(scree_place_spheres_args a, int64_t i)
{
    const scree_shape_view *shape = a.shapes + a.shape[i];
    a.spheres[i].centre = a.pose[i].position;
    a.spheres[i].radius = shape->kind == SCREE_KIND_SPHERE ? shape->bounding_radius * a.pose[i].scale : 0;
}

/// Nodes of a mesh's tree below which lies all that a sphere or clump can meet until the next search of pairs, in the
/// order of the tree: the leaves of the triangles if there are few.
enum
{
    SCREE_NEAR_NODES = 7
};
typedef struct scree_near_nodes
{
    int32_t num;
    int32_t node[SCREE_NEAR_NODES];
} scree_near_nodes;

typedef struct scree_sphere_pairs_args
{
    const scree_sphere *spheres;       ///< (num_bodies) of pairs of two spheres
    const scree_shape_view *shapes;    ///< of all bodies
    const int32_t *shape;              ///< (num_bodies)
    const scree_pose *pose;            ///< (num_bodies)
    const scree_candidate_pair *pairs; ///< (num_pairs) all candidate pairs
    const int32_t *batch;              ///< (num) indices of those that this launch is for; NULL: all
    scree_contact_list list;           ///< first pass: number of contacts to first_of_pair; second: geometry written

    // spheres and clumps on meshes
    scree_near_nodes *near;      ///< (num) found after a search of pairs
    scree_real reach;            ///< [m] two bodies come closer by no more than this until the next one; 0: not known
    scree_sphere_contact *found; ///< (num, max_found)
    int32_t max_found;
    scree_pair_tally *tally; ///< centres inside the solid are counted, and the largest number found on one mesh noted
} scree_sphere_pairs_args;

typedef scree_sphere_pairs_args scree_sphere_sphere_count_args;
typedef scree_sphere_pairs_args scree_sphere_sphere_write_args;
typedef scree_sphere_pairs_args scree_sphere_mesh_near_args;
typedef scree_sphere_pairs_args scree_sphere_mesh_count_args;
typedef scree_sphere_pairs_args scree_sphere_mesh_write_args;
typedef scree_sphere_pairs_args scree_clump_clump_count_args;
typedef scree_sphere_pairs_args scree_clump_clump_write_args;

// The address of a part of the arguments is never taken: compilers would then copy all of them for each pair.

SCREE_FN void scree_sphere_sphere_count_at(scree_sphere_sphere_count_args a, int64_t b)
{
    const int32_t p = scree_pair_of_batch(a.batch, b);
    const scree_sphere i = a.spheres[a.pairs[p].i], j = a.spheres[a.pairs[p].j];
    a.list.first_of_pair[p] = scree_spheres_touch(scree_vec3_sub(i.centre, j.centre), i.radius + j.radius) ? 1 : 0;
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
    if (list.has_no_levers) return;
    list.area_vector[c] = scree_vec3_zero();
    list.torque_vector[c] = scree_vec3_zero();
}

/// Geometry of the contact of two spheres that touch.
typedef struct scree_sphere_pair_geometry
{
    scree_vec3 normal, arm;
    scree_real volume, indentation;
} scree_sphere_pair_geometry;

SCREE_FN scree_sphere_pair_geometry scree_touching_pair(scree_sphere i, scree_sphere j)
{
    const scree_sphere_contact contact =
        scree_touching_spheres_contact(scree_vec3_sub(i.centre, j.centre), i.radius + j.radius);
    const scree_real effective_radius = i.radius * j.radius / (i.radius + j.radius);
    scree_sphere_pair_geometry g;
    g.normal = contact.normal;
    g.arm = scree_vec3_scale(contact.normal, contact.indentation / 2 - i.radius);
    g.volume = scree_sphere_contact_volume(effective_radius, contact.indentation, 1);
    g.indentation = contact.indentation;
    return g;
}

/// To the place of candidate pair p.
SCREE_FN void scree_write_sphere_pair(scree_contact_list list, int32_t p, scree_candidate_pair pair,
                                      scree_sphere_pair_geometry g)
{
    const int64_t c = list.first_of_pair[p];
    list.bodies[c] = pair;
    list.patch[c] = 0;
    list.volume[c] = g.volume;
    list.indentation[c] = g.indentation;
    list.normal[c] = g.normal;
    list.arm[c] = g.arm;
    scree_write_point(list, c);
}

SCREE_FN void scree_sphere_sphere_write_at(scree_sphere_sphere_write_args a, int64_t b)
{
    const int32_t p = scree_pair_of_batch(a.batch, b);
    if (a.list.first_of_pair[p + 1] == a.list.first_of_pair[p]) return;
    const scree_candidate_pair pair = a.pairs[p];
    scree_write_sphere_pair(a.list, p, pair, scree_touching_pair(a.spheres[pair.i], a.spheres[pair.j]));
}

/// Sphere k of a posed body, its centre measured from the body's position along the world axes. The rotation is made
/// anew for each: kept, it would cost more registers than it saves time.
SCREE_FN scree_sphere scree_turned_sphere(const scree_shape_view *shape, const scree_pose *pose, int32_t k)
{
    scree_sphere sphere = scree_shape_sphere(shape, k);
    if (shape->spheres)
    {
        const scree_mat3 rotation = scree_mat3_from_quat(pose->orientation);
        sphere.centre = scree_vec3_scale(scree_mat3_apply(rotation, sphere.centre), pose->scale);
    }
    sphere.radius = sphere.radius * pose->scale;
    return sphere;
}

/// What a sphere can meet of the mesh until it has come closer by `reach`.
SCREE_FN void scree_find_near_nodes(scree_near_nodes *near, const scree_shape_view *mesh, scree_sphere_on_mesh sphere,
                                    scree_real reach)
{
    const scree_vec3 c = sphere.centre;
    scree_real radius = sphere.radius + reach / sphere.scale;
    // the roundings of both ways to the mesh's frame, at both times
    radius += 64 * SCREE_REAL_EPSILON * (radius + scree_abs(c.x) + scree_abs(c.y) + scree_abs(c.z));
    near->num = scree_leaves_within(mesh, c, radius, near->node, SCREE_NEAR_NODES);
    if (near->num <= SCREE_NEAR_NODES) return;
    near->num = 1;
    near->node[0] = scree_lbvh_node_around(mesh->tree, c, radius);
}

/// After a search of pairs. A clump stays within its bounding sphere, however it turns.
SCREE_FN void scree_sphere_mesh_near_at(scree_sphere_mesh_near_args a, int64_t b)
{
    const scree_candidate_pair pair = a.pairs[scree_pair_of_batch(a.batch, b)];
    const bool is_first = a.shapes[a.shape[pair.i]].kind != SCREE_KIND_MESH;
    const int32_t body = is_first ? pair.i : pair.j, mesh = is_first ? pair.j : pair.i;
    const scree_shape_view *shape = a.shapes + a.shape[mesh];
    if (a.reach > 0)
    {
        const scree_real radius = a.shapes[a.shape[body]].bounding_radius * a.pose[body].scale;
        const scree_sphere_on_mesh sphere = scree_sphere_to_mesh(a.pose[body].position, radius, a.pose + mesh);
        scree_find_near_nodes(a.near + b, shape, sphere, a.reach);
        return;
    }
    a.near[b].num = 1;
    a.near[b].node[0] = shape->tree.root;
}

SCREE_FN void scree_sphere_mesh_count_at(scree_sphere_mesh_count_args a, int64_t b)
{
    const scree_candidate_pair pair = a.pairs[scree_pair_of_batch(a.batch, b)];
    const bool is_first = a.shapes[a.shape[pair.i]].kind != SCREE_KIND_MESH; // is the sphere or clump
    const int32_t body = is_first ? pair.i : pair.j, mesh = is_first ? pair.j : pair.i;
    // sums are kept in memory, for the search on the mesh needs all registers
    int32_t *num = a.list.first_of_pair + scree_pair_of_batch(a.batch, b);
    bool is_any_inside = false;
    *num = 0;
    if (a.near[b].num == 0) return;
    for (int32_t k = 0; k < a.shapes[a.shape[body]].num_spheres; ++k)
    {
        const scree_sphere sphere = scree_turned_sphere(a.shapes + a.shape[body], a.pose + body, k);
        const int32_t first = *num < a.max_found ? *num : a.max_found;
        scree_sphere_contact *found = a.found + b * a.max_found + first;
        bool is_inside;
        const scree_sphere_on_mesh on_mesh =
            scree_sphere_to_mesh(scree_vec3_add(a.pose[body].position, sphere.centre), sphere.radius, a.pose + mesh);
        const int32_t added = scree_sphere_mesh_contacts(a.shapes + a.shape[mesh], on_mesh, a.near[b].node,
                                                         a.near[b].num, found, a.max_found - first, &is_inside);
        for (int32_t f = 0; f < added && first + f < a.max_found; ++f) found[f].sphere = k;
        *num += added;
        is_any_inside |= is_inside;
    }
    if (is_any_inside) scree_atomic_count(&a.tally->num_inside, 1);
    if (*num > a.max_found) scree_atomic_max(&a.tally->most_found, (scree_real)*num);
}

SCREE_FN void scree_sphere_mesh_write_at(scree_sphere_mesh_write_args a, int64_t b)
{
    const int32_t p = scree_pair_of_batch(a.batch, b);
    const int32_t begin = a.list.first_of_pair[p];
    const int32_t num = a.list.first_of_pair[p + 1] - begin;
    if (num == 0) return;
    const scree_candidate_pair pair = a.pairs[p];
    const bool is_first = a.shapes[a.shape[pair.i]].kind != SCREE_KIND_MESH;
    const int32_t body = is_first ? pair.i : pair.j;
    const scree_vec3 to_body = scree_vec3_sub(a.pose[body].position, a.pose[pair.i].position);
    int32_t in_part = 0;
    for (int32_t k = 0; k < num; ++k)
    {
        const int64_t c = begin + k;
        const scree_sphere_contact contact = a.found[b * a.max_found + k];
        const scree_sphere sphere = scree_turned_sphere(a.shapes + a.shape[body], a.pose + body, contact.sphere);
        in_part = k > 0 && a.found[b * a.max_found + k - 1].sphere == contact.sphere ? in_part + 1 : 0;
        const scree_vec3 arm =
            scree_vec3_add(sphere.centre, scree_vec3_scale(contact.normal, contact.indentation / 2 - sphere.radius));
        a.list.bodies[c] = pair;
        a.list.patch[c] = (contact.sphere << SCREE_PATCH_BITS) + in_part;
        a.list.volume[c] = scree_sphere_contact_volume(sphere.radius, contact.indentation, contact.weight);
        a.list.indentation[c] = contact.indentation;
        a.list.normal[c] = is_first ? contact.normal : scree_vec3_negate(contact.normal);
        a.list.arm[c] = is_first ? arm : scree_vec3_add(to_body, arm);
        scree_write_point(a.list, c);
    }
}

/// All pairs of spheres of the clumps of candidate pair p. Returns the number of contacts, which are only written on
/// demand.
SCREE_FN int32_t scree_clump_clump_contacts(scree_sphere_pairs_args a, int32_t p, bool is_written)
{
    const scree_candidate_pair pair = a.pairs[p];
    const scree_shape_view *shape_i = a.shapes + a.shape[pair.i], *shape_j = a.shapes + a.shape[pair.j];
    const scree_vec3 between = scree_vec3_sub(a.pose[pair.i].position, a.pose[pair.j].position);
    const scree_real scale_j = a.pose[pair.j].scale, reach = shape_j->bounding_radius * scale_j;
    int32_t num = 0;
    for (int32_t k = 0; k < shape_i->num_spheres; ++k)
    {
        const scree_sphere mine = scree_turned_sphere(shape_i, a.pose + pair.i, k);
        const scree_vec3 from_j = scree_vec3_add(between, mine.centre);
        if (scree_vec3_dot(from_j, from_j) > (reach + mine.radius) * (reach + mine.radius)) continue;
        // the other's spheres stay as stored, only mine are turned
        const scree_mat3 rotation_j = scree_mat3_from_quat(a.pose[pair.j].orientation);
        const scree_vec3 seen = scree_mat3_apply_transposed(rotation_j, from_j);
        for (int32_t m = 0; m < shape_j->num_spheres; ++m)
        {
            const scree_sphere other = scree_shape_sphere(shape_j, m);
            const scree_real radius = other.radius * scale_j;
            const scree_vec3 to_mine = scree_vec3_add_scaled(seen, other.centre, -scale_j);
            if (!scree_spheres_touch(to_mine, mine.radius + radius)) continue;
            ++num;
            if (!is_written) continue;
            const int64_t c = a.list.first_of_pair[p] + num - 1;
            const scree_sphere_contact contact = scree_touching_spheres_contact(to_mine, mine.radius + radius);
            const scree_vec3 normal = scree_mat3_apply(rotation_j, contact.normal);
            a.list.bodies[c] = pair;
            a.list.patch[c] = (k * shape_j->num_spheres + m) << SCREE_PATCH_BITS;
            a.list.volume[c] =
                scree_sphere_contact_volume(mine.radius * radius / (mine.radius + radius), contact.indentation, 1);
            a.list.indentation[c] = contact.indentation;
            a.list.normal[c] = normal;
            a.list.arm[c] = scree_vec3_add_scaled(mine.centre, normal, contact.indentation / 2 - mine.radius);
            scree_write_point(a.list, c);
        }
    }
    return num;
}

SCREE_FN void scree_clump_clump_count_at(scree_clump_clump_count_args a, int64_t b)
{
    const int32_t p = scree_pair_of_batch(a.batch, b);
    a.list.first_of_pair[p] = scree_clump_clump_contacts(a, p, false);
}

SCREE_FN void scree_clump_clump_write_at(scree_clump_clump_write_args a, int64_t b)
{
    const int32_t p = scree_pair_of_batch(a.batch, b);
    if (a.list.first_of_pair[p + 1] > a.list.first_of_pair[p]) scree_clump_clump_contacts(a, p, true);
}

#endif
