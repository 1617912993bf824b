/// \file mesh.c
/// Storage of meshes, their edges and neighbours, convexity.
#include "polyhedra/mesh.h"
#include "core/exact_arith.h"
#include "polyhedra/mesh_edges.h"

#include <stdlib.h>
#include <string.h>

scree_status scree_mesh_create(scree_mesh *mesh, int32_t num_vertices, int32_t num_triangles)
{
    *mesh = (scree_mesh){0};
    // one more than needed, so that an empty mesh is not mistaken for a failed allocation
    mesh->vertices = calloc((size_t)num_vertices + 1, sizeof *mesh->vertices);
    mesh->triangles = calloc((size_t)num_triangles + 1, sizeof *mesh->triangles);
    if (mesh->vertices == NULL || mesh->triangles == NULL)
    {
        scree_mesh_destroy(mesh);
        return SCREE_OUT_OF_MEMORY;
    }
    mesh->num_vertices = num_vertices;
    mesh->num_triangles = num_triangles;
    return SCREE_OK;
}

scree_status scree_mesh_copy(scree_mesh *copy, const scree_mesh *mesh)
{
    const scree_status status = scree_mesh_create(copy, mesh->num_vertices, mesh->num_triangles);
    if (status != SCREE_OK) return status;
    if (mesh->num_vertices > 0)
        memcpy(copy->vertices, mesh->vertices, (size_t)mesh->num_vertices * sizeof *mesh->vertices);
    if (mesh->num_triangles > 0)
        memcpy(copy->triangles, mesh->triangles, (size_t)mesh->num_triangles * sizeof *mesh->triangles);
    return SCREE_OK;
}

void scree_mesh_destroy(scree_mesh *mesh)
{
    free(mesh->vertices);
    free(mesh->triangles);
    *mesh = (scree_mesh){0};
}

scree_box scree_mesh_box(const scree_mesh *mesh)
{
    scree_box box = scree_box_empty();
    for (int32_t i = 0; i < mesh->num_vertices; ++i) box = scree_box_with_point(box, mesh->vertices[i]);
    return box;
}

double scree_box_diagonal(scree_box box)
{
    const double x = (double)box.upper.x - (double)box.lower.x;
    const double y = (double)box.upper.y - (double)box.lower.y;
    const double z = (double)box.upper.z - (double)box.lower.z;
    return sqrt(x * x + y * y + z * z);
}

static int compare_sides(const void *left, const void *right)
{
    const scree_mesh_side *a = left;
    const scree_mesh_side *b = right;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    if (a->high != b->high) return a->high < b->high ? -1 : 1;
    if (a->triangle != b->triangle) return a->triangle < b->triangle ? -1 : 1;
    return (a->corner > b->corner) - (a->corner < b->corner);
}

scree_mesh_side *scree_mesh_sides_create(const scree_mesh *mesh)
{
    const size_t num_sides = 3 * (size_t)mesh->num_triangles;
    scree_mesh_side *sides = calloc(num_sides + 1, sizeof *sides);
    if (sides == NULL) return NULL;
    for (int32_t i = 0; i < mesh->num_triangles; ++i)
    {
        for (int16_t k = 0; k < 3; ++k)
        {
            const int32_t from = mesh->triangles[i].v[k];
            const int32_t to = mesh->triangles[i].v[(k + 1) % 3];
            scree_mesh_side *side = sides + 3 * (size_t)i + (size_t)k;
            side->low = from < to ? from : to;
            side->high = from < to ? to : from;
            side->triangle = i;
            side->corner = k;
            side->is_backward = from > to;
        }
    }
    qsort(sides, num_sides, sizeof *sides, compare_sides);
    return sides;
}

static int compare_places(const void *left, const void *right)
{
    const scree_mesh_place *a = left;
    const scree_mesh_place *b = right;
    if (a->point.x != b->point.x) return a->point.x < b->point.x ? -1 : 1;
    if (a->point.y != b->point.y) return a->point.y < b->point.y ? -1 : 1;
    if (a->point.z != b->point.z) return a->point.z < b->point.z ? -1 : 1;
    return (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

scree_mesh_place *scree_mesh_places_create(const scree_mesh *mesh)
{
    scree_mesh_place *places = malloc(((size_t)mesh->num_vertices + 1) * sizeof *places);
    if (places == NULL) return NULL;
    for (int32_t i = 0; i < mesh->num_vertices; ++i) places[i] = (scree_mesh_place){mesh->vertices[i], i};
    qsort(places, (size_t)mesh->num_vertices, sizeof *places, compare_places);
    return places;
}

bool scree_mesh_places_coincide(const scree_mesh_place *a, const scree_mesh_place *b)
{
    return a->point.x == b->point.x && a->point.y == b->point.y && a->point.z == b->point.z;
}

int64_t scree_mesh_side_group(const scree_mesh_side *sides, int64_t num_sides, int64_t begin)
{
    int64_t end = begin + 1;
    while (end < num_sides && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    return end - begin;
}

int64_t scree_mesh_link(const scree_mesh *mesh, const scree_mesh_side *sides, int32_t *neighbours)
{
    const int64_t num_sides = 3 * (int64_t)mesh->num_triangles;
    int64_t num_open = num_sides;
    for (int64_t i = 0; i < num_sides; ++i) neighbours[i] = -1;
    for (int64_t begin = 0, num; begin < num_sides; begin += num)
    {
        num = scree_mesh_side_group(sides, num_sides, begin);
        const scree_mesh_side *a = sides + begin;
        const scree_mesh_side *b = a + 1;
        if (num != 2 || a->is_backward == b->is_backward || a->low == a->high) continue;
        neighbours[3 * (int64_t)a->triangle + a->corner] = b->triangle;
        neighbours[3 * (int64_t)b->triangle + b->corner] = a->triangle;
        num_open -= 2;
    }
    return num_open;
}

int32_t scree_mesh_label_pieces(const scree_mesh *mesh, const int32_t *neighbours, int32_t *piece_of, int32_t *stack)
{
    int32_t num_pieces = 0;
    for (int32_t i = 0; i < mesh->num_triangles; ++i) piece_of[i] = -1;
    for (int32_t first = 0; first < mesh->num_triangles; ++first)
    {
        if (piece_of[first] >= 0) continue;
        // flood over the edges from the first triangle that has no label yet
        int32_t num_stacked = 0;
        piece_of[first] = num_pieces;
        stack[num_stacked++] = first;
        while (num_stacked > 0)
        {
            const int32_t i = stack[--num_stacked];
            for (int64_t k = 0; k < 3; ++k)
            {
                const int32_t next = neighbours[3 * (int64_t)i + k];
                if (next < 0 || piece_of[next] >= 0) continue;
                piece_of[next] = num_pieces;
                stack[num_stacked++] = next;
            }
        }
        ++num_pieces;
    }
    return num_pieces;
}

double scree_mesh_six_volume(const scree_mesh *mesh, int32_t triangle, int32_t about)
{
    const scree_vec3 o = mesh->vertices[about];
    double r[3][3];
    for (int k = 0; k < 3; ++k)
    {
        const scree_vec3 p = mesh->vertices[mesh->triangles[triangle].v[k]];
        r[k][0] = (double)p.x - (double)o.x;
        r[k][1] = (double)p.y - (double)o.y;
        r[k][2] = (double)p.z - (double)o.z;
    }
    return r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) + r[0][1] * (r[1][2] * r[2][0] - r[1][0] * r[2][2]) +
           r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
}

scree_status scree_mesh_neighbours(const scree_mesh *mesh, int32_t *neighbours)
{
    scree_mesh_side *sides = scree_mesh_sides_create(mesh);
    if (sides == NULL) return SCREE_OUT_OF_MEMORY;
    const int64_t num_open = scree_mesh_link(mesh, sides, neighbours);
    free(sides);
    return num_open == 0 ? SCREE_OK : SCREE_BAD_MESH;
}

bool scree_mesh_is_convex(const scree_mesh *mesh)
{
    if (mesh->num_triangles < 4) return false;
    scree_mesh_side *sides = scree_mesh_sides_create(mesh);
    if (sides == NULL) return false;
    const int64_t num_sides = 3 * (int64_t)mesh->num_triangles;
    // a closed mesh without concave edges and with V - E + F = 2 is one ball: two pieces would have 4, and a handle
    // cannot do without concave edges
    bool is_convex = (int64_t)mesh->num_vertices - num_sides / 2 + mesh->num_triangles == 2;
    for (int64_t i = 0; is_convex && i < num_sides; i += 2)
    {
        const bool is_pair = scree_mesh_side_group(sides, num_sides, i) == 2;
        if (!is_pair)
        {
            is_convex = false;
            break;
        }
        // the far corner of the neighbour must not stand out of the triangle's plane
        const int32_t *v = mesh->triangles[sides[i].triangle].v;
        const int32_t far = mesh->triangles[sides[i + 1].triangle].v[(sides[i + 1].corner + 2) % 3];
        is_convex =
            scree_orient3d(mesh->vertices[v[0]], mesh->vertices[v[1]], mesh->vertices[v[2]], mesh->vertices[far]) <= 0;
    }
    free(sides);
    return is_convex;
}
