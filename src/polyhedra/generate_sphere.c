/// \file generate_sphere.c
/// Near-uniform triangulations of a sphere with any even number of triangles: points on a spiral of golden angle,
/// evened out by mutual repulsion, and their convex hull (V points have 2 V - 4 triangles). The hull is built point by
/// point with exact orientations. Only + - * / sqrt: the same mesh on every machine.
#include "core/exact_arith.h"
#include "polyhedra/generate.h"
#include "polyhedra/generate_internal.h"
#include "polyhedra/mesh_edges.h"

#include <stdlib.h>
#include <string.h>

#define MAX_TRIANGLES 2000000

double scree_cube_root(double x)
{
    // Newton's iteration from above, monotone; ends where rounding stops it
    double root = x > 1.0 ? x : 1.0;
    for (int i = 0; i < 4096; ++i)
    {
        const double next = root - (root - x / (root * root)) / 3.0;
        if (!(next < root)) break;
        root = next;
    }
    return root;
}

static scree_vec3 normalized(double x, double y, double z)
{
    const double length = sqrt(x * x + y * y + z * z);
    return scree_vec3_make((scree_real)(x / length), (scree_real)(y / length), (scree_real)(z / length));
}

/// Equal slices of the sphere along z, turned from one to the next by the golden angle pi (3 - sqrt(5)).
static void place_on_spiral(scree_vec3 *points, int32_t num)
{
    const double cosine = -0.73736887807831985;
    const double sine = 0.67549029426152364;
    double x = 1.0;
    double y = 0.0;
    for (int32_t i = 0; i < num; ++i)
    {
        const double z = 1.0 - (2.0 * i + 1.0) / num;
        const double rim = sqrt(1.0 - z * z);
        points[i] = normalized(rim * x, rim * y, z);
        const double turned = cosine * x - sine * y;
        y = sine * x + cosine * y;
        x = turned;
        const double length = sqrt(x * x + y * y);
        x /= length;
        y /= length;
    }
}

/// Moves all points along the sum of their repulsions 1/d^2, a fraction of the stiffness of their neighbours' forces.
static void repel(scree_vec3 *points, scree_vec3 *forces, int32_t num)
{
    const double step = 1.5 / ((double)num * sqrt((double)num));
    for (int32_t i = 0; i < num; ++i) forces[i] = scree_vec3_zero();
    for (int32_t i = 0; i < num; ++i)
    {
        for (int32_t j = 0; j < i; ++j)
        {
            const scree_vec3 d = scree_vec3_sub(points[i], points[j]);
            const scree_real square = scree_vec3_dot(d, d);
            const scree_real strength = 1 / (square * scree_sqrt(square));
            forces[i] = scree_vec3_add_scaled(forces[i], d, strength);
            forces[j] = scree_vec3_add_scaled(forces[j], d, -strength);
        }
    }
    for (int32_t i = 0; i < num; ++i)
    {
        const scree_vec3 p = scree_vec3_add_scaled(points[i], forces[i], (scree_real)step);
        points[i] = normalized((double)p.x, (double)p.y, (double)p.z);
    }
}

/// A face of the hull under construction; next_free links the unused ones.
typedef struct hull_face
{
    int32_t v[3];
    int32_t neighbour[3]; ///< across (v[k], v[k + 1])
    bool is_used;
    bool is_visible; ///< from the point being added
} hull_face;

typedef struct hull
{
    const scree_vec3 *points;
    hull_face *faces;        ///< (max_faces)
    int32_t *free_faces;     ///< (num_free) a stack
    int32_t *face_from;      ///< (num_points) new face whose horizon edge starts at a vertex
    int32_t *visible;        ///< (max_faces)
    int32_t *horizon_face;   ///< (max_faces) face beyond each edge of the horizon
    int32_t *horizon_corner; ///< (max_faces) and its side
    int32_t num_free;
    int32_t max_faces;
    int32_t last_face; ///< one of the faces made last
} hull;

static bool sees(const hull *h, int32_t face, int32_t p)
{
    const int32_t *v = h->faces[face].v;
    return scree_orient3d(h->points[v[0]], h->points[v[1]], h->points[v[2]], h->points[p]) > 0;
}

static int32_t new_face(hull *h, int32_t a, int32_t b, int32_t c)
{
    const int32_t i = h->free_faces[--h->num_free];
    h->faces[i] = (hull_face){{a, b, c}, {-1, -1, -1}, true, false};
    return i;
}

/// A face that sees point p, or -1: first among the faces around the point added last, then among all.
static int32_t find_visible(const hull *h, int32_t p)
{
    int32_t i = h->last_face;
    do {
        if (sees(h, i, p)) return i;
        const int32_t *v = h->faces[i].v;
        const int32_t apex = h->faces[h->last_face].v[2];
        i = h->faces[i].neighbour[v[0] == apex ? 0 : v[1] == apex ? 1 : 2];
    } while (i != h->last_face);
    for (i = 0; i < h->max_faces; ++i)
        if (h->faces[i].is_used && sees(h, i, p)) return i;
    return -1;
}

/// Collects the faces that see p and the edges around them. Returns the number of edges.
static int32_t find_horizon(hull *h, int32_t p, int32_t first, int32_t *num_visible)
{
    int32_t num_edges = 0;
    int32_t num = 0;
    h->visible[num++] = first;
    h->faces[first].is_visible = true;
    for (int32_t i = 0; i < num; ++i)
    {
        for (int k = 0; k < 3; ++k)
        {
            const int32_t next = h->faces[h->visible[i]].neighbour[k];
            if (h->faces[next].is_visible) continue;
            if (sees(h, next, p))
            {
                h->faces[next].is_visible = true;
                h->visible[num++] = next;
                continue;
            }
            h->horizon_face[num_edges] = h->visible[i];
            h->horizon_corner[num_edges++] = k;
        }
    }
    *num_visible = num;
    return num_edges;
}

/// Side of `face` that runs from `from` to `to`.
static int side_of(const hull_face *face, int32_t from, int32_t to)
{
    for (int k = 0; k < 3; ++k)
        if (face->v[k] == from && face->v[(k + 1) % 3] == to) return k;
    return 0;
}

/// Joins point p to all edges of its horizon. A point that sees nothing is left out and false returned.
static bool add_point(hull *h, int32_t p)
{
    const int32_t first = find_visible(h, p);
    if (first < 0) return false;
    int32_t num_visible;
    const int32_t num_edges = find_horizon(h, p, first, &num_visible);
    for (int32_t e = 0; e < num_edges; ++e)
    {
        const hull_face old = h->faces[h->horizon_face[e]];
        const int k = h->horizon_corner[e];
        const int32_t a = old.v[k];
        const int32_t b = old.v[(k + 1) % 3];
        const int32_t beyond = old.neighbour[k];
        const int32_t made = new_face(h, a, b, p);
        h->faces[made].neighbour[0] = beyond;
        h->faces[beyond].neighbour[side_of(h->faces + beyond, b, a)] = made;
        h->face_from[a] = made;
        h->last_face = made;
    }
    // around p, the face that starts at b follows the one that ends there
    for (int32_t e = 0; e < num_edges; ++e)
    {
        const hull_face *old = h->faces + h->horizon_face[e];
        const int k = h->horizon_corner[e];
        const int32_t made = h->face_from[old->v[k]];
        const int32_t after = h->face_from[old->v[(k + 1) % 3]];
        h->faces[made].neighbour[1] = after;
        h->faces[after].neighbour[2] = made;
    }
    for (int32_t i = 0; i < num_visible; ++i)
    {
        h->faces[h->visible[i]].is_used = false;
        h->faces[h->visible[i]].is_visible = false;
        h->free_faces[h->num_free++] = h->visible[i];
    }
    return true;
}

static void start_hull(hull *h)
{
    static const int32_t faces[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    // face k lies across the edges of the three others
    static const int32_t neighbours[4][3] = {{1, 3, 2}, {2, 3, 0}, {0, 3, 1}, {1, 2, 0}};
    // the faces point outwards if the fourth point is behind the first face
    const bool is_turned = scree_orient3d(h->points[0], h->points[1], h->points[2], h->points[3]) > 0;
    for (int32_t i = h->max_faces; i-- > 0;) h->free_faces[h->num_free++] = i;
    for (int i = 0; i < 4; ++i)
    {
        const int32_t made = new_face(h, faces[i][0], faces[i][1], faces[i][2]);
        for (int k = 0; k < 3; ++k) h->faces[made].neighbour[k] = neighbours[i][k];
        if (!is_turned) continue;
        h->faces[made].v[1] = faces[i][2];
        h->faces[made].v[2] = faces[i][1];
        h->faces[made].neighbour[0] = neighbours[i][2];
        h->faces[made].neighbour[2] = neighbours[i][0];
    }
    h->last_face = 0;
}

static bool reserve_hull(hull *h, int32_t num_points)
{
    // faces of the whole hull, and those that one point makes before the old ones are given back
    h->max_faces = 4 * num_points + 8;
    const size_t num = (size_t)h->max_faces;
    h->faces = calloc(num, sizeof *h->faces);
    h->free_faces = calloc(num, sizeof *h->free_faces);
    h->face_from = calloc((size_t)num_points, sizeof *h->face_from);
    h->visible = calloc(num, sizeof *h->visible);
    h->horizon_face = calloc(num, sizeof *h->horizon_face);
    h->horizon_corner = calloc(num, sizeof *h->horizon_corner);
    return h->faces != NULL && h->free_faces != NULL && h->face_from != NULL && h->visible != NULL &&
           h->horizon_face != NULL && h->horizon_corner != NULL;
}

static void destroy_hull(hull *h)
{
    free(h->faces);
    free(h->free_faces);
    free(h->face_from);
    free(h->visible);
    free(h->horizon_face);
    free(h->horizon_corner);
}

/// Convex hull of the vertices of `mesh`, which are on a sphere, into its triangles (2 num_vertices - 4).
static scree_status triangulate(scree_mesh *mesh)
{
    hull h = {.points = mesh->vertices};
    scree_status status = reserve_hull(&h, mesh->num_vertices) ? SCREE_OK : SCREE_OUT_OF_MEMORY;
    if (status == SCREE_OK)
    {
        start_hull(&h);
        bool is_complete = true;
        for (int32_t p = 4; is_complete && p < mesh->num_vertices; ++p) is_complete = add_point(&h, p);
        int32_t num = 0;
        for (int32_t i = 0; i < h.max_faces; ++i)
        {
            if (!h.faces[i].is_used || num == mesh->num_triangles) continue;
            memcpy(mesh->triangles[num++].v, h.faces[i].v, sizeof h.faces[i].v);
        }
        if (!is_complete || num != mesh->num_triangles) status = SCREE_BAD_MESH;
    }
    destroy_hull(&h);
    return status;
}

scree_status scree_generate_unit_sphere(scree_mesh *mesh, int32_t num_triangles)
{
    *mesh = (scree_mesh){0};
    if (num_triangles < 4 || num_triangles > MAX_TRIANGLES) return SCREE_INVALID_INPUT;
    const int32_t num_points = (num_triangles + 1) / 2 + 2;
    scree_status status = scree_mesh_create(mesh, num_points, 2 * num_points - 4);
    if (status != SCREE_OK) return status;
    scree_vec3 *forces = malloc((size_t)num_points * sizeof *forces);
    if (forces != NULL)
    {
        // as many rounds as a million pairs allow: all that a coarse sphere needs, none for a very fine one, which
        // the spiral serves well
        const int64_t num_pairs = (int64_t)num_points * num_points;
        const int64_t affordable = 1000000 / num_pairs;
        const int64_t num_rounds = affordable > 200 ? 200 : affordable;
        place_on_spiral(mesh->vertices, num_points);
        for (int64_t i = 0; i < num_rounds; ++i) repel(mesh->vertices, forces, num_points);
        status = triangulate(mesh);
    }
    else status = SCREE_OUT_OF_MEMORY;
    free(forces);
    if (status != SCREE_OK) scree_mesh_destroy(mesh);
    return status;
}

scree_status scree_generate_sphere(scree_mesh *mesh, double radius, int32_t num_triangles)
{
    *mesh = (scree_mesh){0};
    if (!(radius >= 1e-30 && radius <= 1e30)) return SCREE_INVALID_INPUT;
    const scree_status status = scree_generate_unit_sphere(mesh, num_triangles);
    if (status != SCREE_OK) return status;
    double six_volume = 0.0;
    for (int32_t i = 0; i < mesh->num_triangles; ++i) six_volume += scree_mesh_six_volume(mesh, i, 0);
    const double eight_pi = 25.132741228718345;
    const scree_real scale = (scree_real)(radius * scree_cube_root(eight_pi / six_volume));
    for (int32_t i = 0; i < mesh->num_vertices; ++i) mesh->vertices[i] = scree_vec3_scale(mesh->vertices[i], scale);
    return SCREE_OK;
}
