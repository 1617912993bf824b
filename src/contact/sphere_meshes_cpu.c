/// \file sphere_meshes_cpu.c
/// Spheres and clumps on meshes on the CPU: the triangles near the spheres of many pairs are gathered, and their
/// nearest points found in groups of lanes (lanes.h), where no branch depends on which part of a triangle is the
/// nearest. What follows for each sphere takes them from there, those of the neighbours of an edge too.
#include "contact/sphere_pairs.h"
#include "core/lanes.h"

SCREE_DEFINE_LAUNCH_ON(scree_sphere_mesh_count)

enum
{
    BLOCK_PAIRS = 64, ///< that a thread takes at once
    MAX_SPHERES = 32, ///< gathered before their nearest points are found
    MAX_GROUPS = MAX_SPHERES * SCREE_NEAR_NODES / SCREE_LANES
};

/// Triangles and centres side by side, and the nearest points.
typedef struct triangle_group
{
    scree_lanes_vec3 a, b, c, normal, centre;
    scree_lanes_vec3 offset;
    scree_real squared[SCREE_LANES];
    scree_real part[SCREE_LANES];
    int32_t triangle[SCREE_LANES];
} triangle_group;

/// A sphere of a pair, and which of the gathered triangles are its own.
typedef struct gathered_sphere
{
    scree_sphere_on_mesh on_mesh;
    const scree_shape_view *mesh;
    int64_t b; ///< place of the pair in the batch
    int32_t k; ///< of the clump
    int32_t first, end;
} gathered_sphere;

typedef struct gathered_spheres
{
    gathered_sphere spheres[MAX_SPHERES];
    triangle_group groups[MAX_GROUPS];
    int32_t num_spheres, num_triangles;
    int64_t inside; ///< last pair that was counted as one with a centre inside
} gathered_spheres;

SCREE_LANES_FUNCTION static void find_nearest(triangle_group *restrict g)
{
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_triangle_place place = {scree_lanes_get(&g->a, l), scree_lanes_get(&g->b, l),
                                            scree_lanes_get(&g->c, l), scree_lanes_get(&g->normal, l)};
        const scree_nearest_part closest = scree_closest_part(place, scree_lanes_get(&g->centre, l));
        scree_lanes_set(&g->offset, l, closest.offset);
        g->squared[l] = closest.squared;
        g->part[l] = closest.part;
    }
}

static void gather_triangle(gathered_spheres *gathered, const scree_shape_view *mesh, int32_t t, scree_vec3 centre)
{
    triangle_group *g = gathered->groups + gathered->num_triangles / SCREE_LANES;
    const int lane = gathered->num_triangles++ % SCREE_LANES;
    const scree_triangle_place place = scree_place_of_triangle(mesh, t);
    scree_lanes_set(&g->a, lane, place.a);
    scree_lanes_set(&g->b, lane, place.b);
    scree_lanes_set(&g->c, lane, place.c);
    scree_lanes_set(&g->normal, lane, place.normal);
    scree_lanes_set(&g->centre, lane, centre);
    g->triangle[lane] = t;
}

static scree_closest_point nearest_of(const gathered_spheres *gathered, int32_t n)
{
    const triangle_group *g = gathered->groups + n / SCREE_LANES;
    const int lane = n % SCREE_LANES;
    const scree_closest_point closest = {scree_lanes_get(&g->offset, lane), g->squared[lane], g->triangle[lane],
                                         (int32_t)g->part[lane]};
    return closest;
}

/// scree_is_local_minimum(), with the answer of the triangle across an edge taken from the gathered ones.
static bool is_local_minimum(const gathered_spheres *gathered, const gathered_sphere *sphere,
                             const scree_closest_point *closest)
{
    if (closest->part == SCREE_PART_FACE) return true;
    if (closest->part >= SCREE_PART_VERTEX)
        return scree_is_local_minimum(sphere->mesh, sphere->on_mesh.centre, *closest);
    const int32_t t = sphere->mesh->neighbours[3 * closest->triangle + closest->part - SCREE_PART_EDGE];
    for (int32_t n = sphere->first; n < sphere->end; ++n)
    {
        const triangle_group *g = gathered->groups + n / SCREE_LANES;
        const int lane = n % SCREE_LANES;
        if (g->triangle[lane] != t) continue;
        return !(g->squared[lane] < closest->squared ||
                 (g->squared[lane] == closest->squared && t < closest->triangle));
    }
    return scree_is_local_minimum(sphere->mesh, sphere->on_mesh.centre, *closest);
}

/// Contacts of a gathered sphere, added to those of its pair.
static void add_contacts(const scree_sphere_pairs_args *a, gathered_spheres *gathered, const gathered_sphere *sphere)
{
    int32_t *num = a->list.first_of_pair + scree_pair_of_batch(a->batch, sphere->b);
    const int32_t first = *num < a->max_found ? *num : a->max_found;
    scree_sphere_contact *found = a->found + sphere->b * a->max_found + first;
    const scree_real radius = sphere->on_mesh.radius;
    scree_mesh_search search = scree_mesh_search_start(sphere->on_mesh, found, a->max_found - first);
    for (int32_t n = sphere->first; n < sphere->end; ++n)
    {
        const scree_closest_point closest = nearest_of(gathered, n);
        if (closest.squared < radius * radius && is_local_minimum(gathered, sphere, &closest))
            scree_mesh_search_meet(&search, sphere->mesh, radius, &closest);
    }
    bool is_inside;
    const int32_t added = scree_mesh_search_end(&search, &sphere->on_mesh, &is_inside);
    for (int32_t f = 0; f < added && first + f < a->max_found; ++f) found[f].sphere = sphere->k;
    *num += added;
    if (is_inside && gathered->inside != sphere->b)
    {
        gathered->inside = sphere->b;
        scree_atomic_count(&a->tally->num_inside, 1);
    }
    if (*num > a->max_found) scree_atomic_max(&a->tally->most_found, (scree_real)*num);
}

static void add_all(const scree_sphere_pairs_args *a, gathered_spheres *gathered)
{
    for (int32_t g = 0; g * SCREE_LANES < gathered->num_triangles; ++g) find_nearest(gathered->groups + g);
    for (int32_t s = 0; s < gathered->num_spheres; ++s) add_contacts(a, gathered, gathered->spheres + s);
    gathered->num_spheres = gathered->num_triangles = 0;
}

/// Entry b of the batch.
static void gather_pair(const scree_sphere_pairs_args *a, gathered_spheres *gathered, int64_t b)
{
    const scree_candidate_pair pair = a->pairs[scree_pair_of_batch(a->batch, b)];
    const bool is_first = a->shapes[a->shape[pair.i]].kind != SCREE_KIND_MESH;
    const int32_t body = is_first ? pair.i : pair.j, mesh = is_first ? pair.j : pair.i;
    const scree_shape_view *shape = a->shapes + a->shape[mesh];
    const scree_near_nodes *near = a->near + b;
    a->list.first_of_pair[scree_pair_of_batch(a->batch, b)] = 0;
    if (near->num == 0) return;
    if (shape->tree.nodes[near->node[0]].first_child >= 0)
    {
        scree_sphere_mesh_count_at(*a, b);
        return;
    }
    for (int32_t k = 0; k < a->shapes[a->shape[body]].num_spheres; ++k)
    {
        if (gathered->num_spheres == MAX_SPHERES) add_all(a, gathered);
        gathered_sphere *sphere = gathered->spheres + gathered->num_spheres++;
        const scree_sphere turned = scree_turned_sphere(a->shapes + a->shape[body], a->pose + body, k);
        sphere->on_mesh =
            scree_sphere_to_mesh(scree_vec3_add(a->pose[body].position, turned.centre), turned.radius, a->pose + mesh);
        sphere->mesh = shape;
        sphere->b = b;
        sphere->k = k;
        sphere->first = gathered->num_triangles;
        const scree_vec3 centre = sphere->on_mesh.centre;
        for (int32_t n = 0; n < near->num; ++n)
        {
            const scree_lbvh_node *leaf = shape->tree.nodes + near->node[n];
            if (scree_box_distance_squared(leaf->box, centre) < sphere->on_mesh.radius * sphere->on_mesh.radius)
                gather_triangle(gathered, shape, -1 - leaf->first_child, centre);
        }
        sphere->end = gathered->num_triangles;
    }
}

void scree_sphere_mesh_count_launch(scree_sphere_mesh_count_args args, int64_t num)
{
    const int64_t num_blocks = (num + BLOCK_PAIRS - 1) / BLOCK_PAIRS;
#pragma omp parallel for schedule(dynamic) if (num >= SCREE_LAUNCH_MIN)
    for (int64_t block = 0; block < num_blocks; ++block)
    {
        const int64_t begin = block * BLOCK_PAIRS, end = begin + BLOCK_PAIRS < num ? begin + BLOCK_PAIRS : num;
        gathered_spheres gathered;
        gathered.num_spheres = gathered.num_triangles = 0;
        gathered.inside = -1;
        for (int64_t b = begin; b < end; ++b) gather_pair(&args, &gathered, b);
        add_all(&args, &gathered);
    }
}
