/// \file closest_point_kernel.h
/// The points of a mesh's surface that are nearest to a given point: on one triangle, on the whole mesh, and which of
/// the triangles' nearest points are local minima of the distance over the surface, seen from outside or from inside.
///
/// On one triangle: Ericson (2005), Real-Time Collision Detection, 5.1.5. The distance to a triangle is a convex
/// function, so a point of the surface is a local minimum exactly if it is the nearest point of every triangle that
/// holds it. Where rounding lets triangles disagree about a shared edge or vertex, the nearest of their answers always
/// stands.
#ifndef SCREE_CLOSEST_POINT_KERNEL_H
#define SCREE_CLOSEST_POINT_KERNEL_H

#include "polyhedra/shape.h"

/// Part of a triangle: its inside, edge k from v[k] to v[k + 1], or vertex k.
typedef enum scree_triangle_part
{
    SCREE_PART_FACE,
    SCREE_PART_EDGE,                        ///< + k
    SCREE_PART_VERTEX = SCREE_PART_EDGE + 3 ///< + k
} scree_triangle_part;

/// The point of a triangle nearest to a centre.
typedef struct scree_closest_point
{
    scree_vec3 offset;  ///< from the point to the centre
    scree_real squared; ///< length of the offset, squared
    int32_t triangle;
    int32_t part; ///< scree_triangle_part
} scree_closest_point;

/// A triangle with its unit normal.
typedef struct scree_triangle_place
{
    scree_vec3 a, b, c, normal;
} scree_triangle_place;

/// The nearest point without the triangle, all numbers of one kind for lanes.
typedef struct scree_nearest_part
{
    scree_vec3 offset;
    scree_real squared;
    scree_real part; ///< scree_triangle_part
} scree_nearest_part;

SCREE_FN scree_triangle_place scree_place_of_triangle(const scree_shape_view *mesh, int32_t t)
{
    const int32_t *v = mesh->triangles[t].v;
    scree_triangle_place place;
    place.a = mesh->vertices[v[0]];
    place.b = mesh->vertices[v[1]];
    place.c = mesh->vertices[v[2]];
    place.normal = mesh->normals[t];
    return place;
}

/// Where the nearest point lies if it does not lie in the face: `start` less `along`/`whole` of `edge`.
typedef struct scree_nearest_choice
{
    scree_vec3 start, edge;
    scree_real along, whole, part;
} scree_nearest_choice;

/// The one or the other choice, number by number, so that lanes can choose.
SCREE_FN scree_nearest_choice scree_choose(bool is_chosen, int32_t part, scree_vec3 start, scree_vec3 edge,
                                           scree_real along, scree_real whole, scree_nearest_choice other)
{
    scree_nearest_choice c;
    c.start.x = is_chosen ? start.x : other.start.x;
    c.start.y = is_chosen ? start.y : other.start.y;
    c.start.z = is_chosen ? start.z : other.start.z;
    c.edge.x = is_chosen ? edge.x : other.edge.x;
    c.edge.y = is_chosen ? edge.y : other.edge.y;
    c.edge.z = is_chosen ? edge.z : other.edge.z;
    c.along = is_chosen ? along : other.along;
    c.whole = is_chosen ? whole : other.whole;
    c.part = is_chosen ? (scree_real)part : other.part;
    return c;
}

/// The nearest point of a triangle, its part decided by the projections on its edges. Exactly above an edge or a vertex
/// the face counts. Without branches, for lanes: which part it is cannot be foreseen.
SCREE_FN scree_nearest_part scree_closest_part(scree_triangle_place place, scree_vec3 centre)
{
    const scree_vec3 ab = scree_vec3_sub(place.b, place.a), ac = scree_vec3_sub(place.c, place.a);
    const scree_vec3 bc = scree_vec3_sub(place.c, place.b);
    const scree_vec3 from_a = scree_vec3_sub(centre, place.a);
    const scree_vec3 from_b = scree_vec3_sub(centre, place.b);
    const scree_vec3 from_c = scree_vec3_sub(centre, place.c);
    const scree_real d1 = scree_vec3_dot(ab, from_a), d2 = scree_vec3_dot(ac, from_a);
    const scree_real d3 = scree_vec3_dot(ab, from_b), d4 = scree_vec3_dot(ac, from_b);
    const scree_real d5 = scree_vec3_dot(ab, from_c), d6 = scree_vec3_dot(ac, from_c);
    const bool is_a = (d1 <= 0) & (d2 <= 0) & (d1 + d2 < 0);
    const bool is_b = (d3 >= 0) & (d4 <= d3) & ((d3 > 0) | (d4 < 0));
    const bool is_ab = (d1 * d4 - d3 * d2 < 0) & (d1 >= 0) & (d3 <= 0);
    const bool is_c = (d6 >= 0) & (d5 <= d6) & ((d6 > 0) | (d5 < 0));
    const bool is_ac = (d5 * d2 - d1 * d6 < 0) & (d2 >= 0) & (d6 <= 0);
    const bool is_bc = (d3 * d6 - d5 * d4 < 0) & (d4 - d3 >= 0) & (d5 - d6 >= 0);
    // through the height over the plane: nothing is lost far from the corners
    const scree_vec3 above = scree_vec3_scale(place.normal, scree_vec3_dot(place.normal, from_a));
    // the last choice stands
    scree_nearest_choice c = {above, ab, 0, 1, SCREE_PART_FACE};
    c = scree_choose(is_bc, SCREE_PART_EDGE + 1, from_b, bc, d4 - d3, (d4 - d3) + (d5 - d6), c);
    c = scree_choose(is_ac, SCREE_PART_EDGE + 2, from_a, ac, d2, d2 - d6, c);
    c = scree_choose(is_c, SCREE_PART_VERTEX + 2, from_c, ac, 0, 1, c);
    c = scree_choose(is_ab, SCREE_PART_EDGE, from_a, ab, d1, d1 - d3, c);
    c = scree_choose(is_b, SCREE_PART_VERTEX + 1, from_b, ab, 0, 1, c);
    c = scree_choose(is_a, SCREE_PART_VERTEX, from_a, ab, 0, 1, c);
    scree_nearest_part nearest;
    nearest.offset = scree_vec3_add_scaled(c.start, c.edge, -(c.along / c.whole));
    nearest.squared = scree_vec3_dot(nearest.offset, nearest.offset);
    nearest.part = c.part;
    return nearest;
}

SCREE_FN scree_closest_point scree_closest_on_triangle(const scree_shape_view *mesh, int32_t t, scree_vec3 centre)
{
    const scree_nearest_part nearest = scree_closest_part(scree_place_of_triangle(mesh, t), centre);
    scree_closest_point closest;
    closest.offset = nearest.offset;
    closest.squared = nearest.squared;
    closest.triangle = t;
    closest.part = (int32_t)nearest.part;
    return closest;
}

/// Bound of what rounding does to the distance of a centre that is found for a triangle. Its normal and the sides of
/// its edges come from the difference of products of lengths over the area, which makes slivers the worst.
SCREE_FN scree_real scree_closest_rounding(scree_triangle_place place, scree_vec3 centre)
{
    const scree_vec3 ab = scree_vec3_sub(place.b, place.a), ac = scree_vec3_sub(place.c, place.a);
    const scree_vec3 from_a = scree_vec3_sub(centre, place.a);
    const scree_real squares = scree_vec3_dot(ab, ab) + scree_vec3_dot(ac, ac) + scree_vec3_dot(from_a, from_a);
    const scree_real double_area = scree_vec3_length(scree_vec3_cross(ab, ac));
    return 64 * SCREE_REAL_EPSILON * scree_sqrt(squares) * (squares / double_area);
}

/// A surface that is approached: where the nearest point lies, seen from the centre.
typedef struct scree_approach
{
    scree_vec3 normal; ///< unit, out of the mesh's solid
    scree_real height; ///< of the centre above the point along the normal; negative where it is seen from inside
    int32_t rank;      ///< 0: in a face, 1: on an edge, 2: in a vertex
} scree_approach;

/// Outward side of an edge or vertex: the sum of the normals of the two triangles at the edge nearest to the centre.
/// No great circle between that edge and the direction of the centre meets the surface, so the edge's side is the
/// centre's side; for a vertex it does what weighting by angles does (Baerentzen & Aanaes 2005) without angles.
SCREE_FN scree_approach scree_approach_of_edge(const scree_closest_point *closest, scree_vec3 outward)
{
    scree_approach approach;
    const scree_real length = scree_sqrt(closest->squared);
    approach.rank = closest->part < SCREE_PART_VERTEX ? 1 : 2;
    approach.height = scree_vec3_dot(outward, closest->offset) > 0 ? length : -length;
    approach.normal = length > 0 ? scree_vec3_scale(closest->offset, 1 / approach.height)
                                 : scree_vec3_scale(outward, 1 / scree_vec3_length(outward));
    return approach;
}

SCREE_FN scree_vec3 scree_edge_outward(const scree_shape_view *mesh, int32_t t, int32_t k)
{
    return scree_vec3_add(mesh->normals[t], mesh->normals[mesh->neighbours[3 * t + k]]);
}

/// Position of vertex v in triangle t.
SCREE_FN int32_t scree_corner_of(const scree_shape_view *mesh, int32_t t, int32_t v)
{
    const int32_t *of = mesh->triangles[t].v;
    return of[0] == v ? 0 : of[1] == v ? 1 : 2;
}

/// The edge at a vertex (part of `closest`) that makes the smallest angle with the offset: goes round its triangles.
SCREE_FN scree_vec3 scree_vertex_outward(const scree_shape_view *mesh, const scree_closest_point *closest)
{
    const int32_t v = mesh->triangles[closest->triangle].v[closest->part - SCREE_PART_VERTEX];
    int32_t t = closest->triangle, best = t;
    scree_real most = -SCREE_REAL_MAX;
    do {
        const int32_t k = scree_corner_of(mesh, t, v);
        const scree_vec3 edge = scree_vec3_sub(mesh->vertices[mesh->triangles[t].v[(k + 1) % 3]], mesh->vertices[v]);
        const scree_real along = scree_vec3_dot(edge, closest->offset) / scree_vec3_length(edge);
        if (along > most)
        {
            most = along;
            best = t;
        }
        t = mesh->neighbours[3 * t + k];
    } while (t != closest->triangle);
    return scree_edge_outward(mesh, best, scree_corner_of(mesh, best, v));
}

/// Normal and height of a nearest point.
SCREE_FN scree_approach scree_approach_of(const scree_shape_view *mesh, const scree_closest_point *closest)
{
    if (closest->part == SCREE_PART_FACE)
    {
        scree_approach approach;
        approach.normal = mesh->normals[closest->triangle];
        approach.height = scree_vec3_dot(approach.normal, closest->offset);
        approach.rank = 0;
        return approach;
    }
    if (closest->part < SCREE_PART_VERTEX)
        return scree_approach_of_edge(closest,
                                      scree_edge_outward(mesh, closest->triangle, closest->part - SCREE_PART_EDGE));
    return scree_approach_of_edge(closest, scree_vertex_outward(mesh, closest));
}

/// Does triangle t come nearer than the point, or as near with a smaller index?
SCREE_FN bool scree_is_nearer(const scree_shape_view *mesh, int32_t t, scree_vec3 centre, scree_closest_point than)
{
    const scree_closest_point other = scree_closest_on_triangle(mesh, t, centre);
    return other.squared < than.squared || (other.squared == than.squared && t < than.triangle);
}

/// Is the nearest point of one triangle a local minimum over the surface? Of those that tie, one triangle's says yes.
SCREE_FN bool scree_is_local_minimum(const scree_shape_view *mesh, scree_vec3 centre, scree_closest_point closest)
{
    if (closest.part == SCREE_PART_FACE) return true;
    if (closest.part < SCREE_PART_VERTEX)
        return !scree_is_nearer(mesh, mesh->neighbours[3 * closest.triangle + closest.part - SCREE_PART_EDGE], centre,
                                closest);
    const int32_t v = mesh->triangles[closest.triangle].v[closest.part - SCREE_PART_VERTEX];
    int32_t t = mesh->neighbours[3 * closest.triangle + closest.part - SCREE_PART_VERTEX];
    while (t != closest.triangle)
    {
        if (scree_is_nearer(mesh, t, centre, closest)) return false;
        t = mesh->neighbours[3 * t + scree_corner_of(mesh, t, v)];
    }
    return true;
}

/// Leaves of the mesh's tree whose triangles are nearer than `radius`, or would be found nearer within rounding, in the
/// order of the tree. Returns how
/// many there are; no more than max_leaves of them are written.
SCREE_FN int32_t scree_leaves_within(const scree_shape_view *mesh, scree_vec3 centre, scree_real radius,
                                     int32_t *leaves, int32_t max_leaves)
{
    int32_t num = 0, k = mesh->tree.root;
    while (k != SCREE_LBVH_END)
    {
        const scree_lbvh_node *node = mesh->tree.nodes + k;
        const int32_t here = k;
        const bool is_met = scree_box_distance_squared(node->box, centre) <= radius * radius;
        k = is_met && node->first_child >= 0 ? node->first_child : node->escape;
        if (!is_met || node->first_child >= 0) continue;
        const scree_triangle_place place = scree_place_of_triangle(mesh, -1 - node->first_child);
        const scree_real within = radius + scree_closest_rounding(place, centre);
        if (scree_closest_part(place, centre).squared > within * within) continue;
        if (num < max_leaves) leaves[num] = here;
        ++num;
    }
    return num;
}

/// The nearest point of the whole surface; the mesh must have triangles.
SCREE_FN scree_closest_point scree_closest_on_mesh(const scree_shape_view *mesh, scree_vec3 centre)
{
    scree_closest_point nearest = scree_closest_on_triangle(mesh, 0, centre);
    int32_t k = mesh->tree.root;
    while (k != SCREE_LBVH_END)
    {
        const scree_lbvh_node *node = mesh->tree.nodes + k;
        const bool is_entered = scree_box_distance_squared(node->box, centre) <= nearest.squared;
        if (is_entered && node->first_child < 0)
        {
            const scree_closest_point other = scree_closest_on_triangle(mesh, -1 - node->first_child, centre);
            if (other.squared < nearest.squared) nearest = other;
        }
        k = is_entered && node->first_child >= 0 ? node->first_child : node->escape;
    }
    return nearest;
}

#endif
