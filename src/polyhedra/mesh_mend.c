/// \file mesh_mend.c
/// Repairs that cannot change the body beyond the given tolerance; each is told as a warning.
#include "bvh/lbvh.h"
#include "core/exact_arith.h"
#include "polyhedra/mesh.h"
#include "polyhedra/mesh_edges.h"

#include <stdlib.h>
#include <string.h>

static double distance_squared(scree_vec3 p, scree_vec3 q)
{
    const double x = (double)p.x - (double)q.x, y = (double)p.y - (double)q.y, z = (double)p.z - (double)q.z;
    return x * x + y * y + z * z;
}

/// For each vertex the first one in the same place.
static scree_status join_coincident(const scree_mesh *mesh, int32_t *representative)
{
    scree_mesh_place *places = scree_mesh_places_create(mesh);
    if (places == NULL) return SCREE_OUT_OF_MEMORY;
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
    {
        const bool is_again = i > 0 && scree_mesh_places_coincide(places + i - 1, places + i);
        representative[places[i].vertex] = is_again ? representative[places[i - 1].vertex] : places[i].vertex;
    }
    free(places);
    return SCREE_OK;
}

/// Lets representatives within `distance` of one with a lower number be represented by the lowest such.
static scree_status join_near(const scree_mesh *mesh, double distance, int32_t *representative)
{
    // a little more than the distance, which a float may round down
    const scree_real reach = (scree_real)(distance * (1.0 + (double)SCREE_REAL_EPSILON));
    const scree_vec3 margin = scree_vec3_make(reach, reach, reach);
    scree_lbvh tree = {0};
    scree_box *boxes = malloc(((size_t)mesh->num_vertices + 1) * sizeof *boxes);
    int32_t *vertex_of = malloc(((size_t)mesh->num_vertices + 1) * sizeof *vertex_of);
    scree_status status = boxes != NULL && vertex_of != NULL ? SCREE_OK : SCREE_OUT_OF_MEMORY;
    int32_t num = 0;
    for (int32_t i = 0; status == SCREE_OK && i < mesh->num_vertices; ++i)
    {
        if (representative[i] != i) continue;
        vertex_of[num] = i;
        boxes[num++] = (scree_box){mesh->vertices[i], mesh->vertices[i]};
    }
    if (status == SCREE_OK) status = scree_lbvh_build(&tree, boxes, num);
    for (int32_t k = 0; status == SCREE_OK && k < num; ++k)
    {
        const int32_t i = vertex_of[k];
        const scree_vec3 p = mesh->vertices[i];
        const scree_box query = {scree_vec3_sub(p, margin), scree_vec3_add(p, margin)};
        int32_t next = tree.view.root;
        for (int32_t l; (l = scree_lbvh_next_overlap(tree.view, query, next, &next)) >= 0;)
        {
            const int32_t j = vertex_of[l];
            if (j >= representative[i] || representative[j] != j) continue;
            if (distance_squared(p, mesh->vertices[j]) <= distance * distance) representative[i] = j;
        }
    }
    scree_lbvh_destroy(&tree);
    free(boxes);
    free(vertex_of);
    return status;
}

/// For each vertex the one that stands for it.
static scree_status find_representatives(const scree_mesh *mesh, double distance, int32_t *representative)
{
    scree_status status = join_coincident(mesh, representative);
    if (status == SCREE_OK && distance > 0.0) status = join_near(mesh, distance, representative);
    // those that stood for others may now be represented themselves, by one of lower number, which is final
    for (int32_t i = 0; status == SCREE_OK && i < mesh->num_vertices; ++i)
        representative[i] = representative[representative[i]];
    return status;
}

static scree_status drop_unused_vertices(scree_mesh *mesh)
{
    int32_t *new_index = malloc(((size_t)mesh->num_vertices + 1) * sizeof *new_index);
    if (new_index == NULL) return SCREE_OUT_OF_MEMORY;
    for (int32_t i = 0; i < mesh->num_vertices; ++i) new_index[i] = -1;
    for (int32_t i = 0; i < mesh->num_triangles; ++i)
        for (int k = 0; k < 3; ++k) new_index[mesh->triangles[i].v[k]] = 0;
    int32_t num_kept = 0;
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
    {
        if (new_index[i] < 0) continue;
        mesh->vertices[num_kept] = mesh->vertices[i];
        new_index[i] = num_kept++;
    }
    for (int32_t i = 0; i < mesh->num_triangles; ++i)
        for (int k = 0; k < 3; ++k) mesh->triangles[i].v[k] = new_index[mesh->triangles[i].v[k]];
    mesh->num_vertices = num_kept;
    free(new_index);
    return SCREE_OK;
}

/// What became one, and how far it went.
static void tell_weld(const scree_mesh *mesh, const int32_t *representative, const char *name, scree_report *report)
{
    int32_t num_welded = 0;
    double farthest = 0.0;
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
    {
        num_welded += representative[i] != i;
        const double square = distance_squared(mesh->vertices[i], mesh->vertices[representative[i]]);
        if (square > farthest) farthest = square;
    }
    if (num_welded == 0) return;
    if (farthest > 0.0)
        scree_report_warn(report, "%s: %d of %d vertices were joined with others, at most %.3g away", name, num_welded,
                          mesh->num_vertices, sqrt(farthest));
    else
        scree_report_warn(report, "%s: %d of %d vertices were joined with others in the same place", name, num_welded,
                          mesh->num_vertices);
}

scree_status scree_mesh_weld(scree_mesh *mesh, double tolerance, const char *name, scree_report *report)
{
    const double size = scree_box_diagonal(scree_mesh_box(mesh));
    int32_t *representative = malloc(((size_t)mesh->num_vertices + 1) * sizeof *representative);
    if (representative == NULL) return SCREE_OUT_OF_MEMORY;
    scree_status status = find_representatives(mesh, tolerance * size, representative);
    if (status == SCREE_OK)
    {
        for (int32_t i = 0; i < mesh->num_triangles; ++i)
            for (int k = 0; k < 3; ++k) mesh->triangles[i].v[k] = representative[mesh->triangles[i].v[k]];
        tell_weld(mesh, representative, name, report);
        status = drop_unused_vertices(mesh);
    }
    free(representative);
    return status;
}

static void drop_degenerate(scree_mesh *mesh, const char *name, scree_report *report)
{
    int32_t num_kept = 0;
    for (int32_t i = 0; i < mesh->num_triangles; ++i)
    {
        const scree_triangle t = mesh->triangles[i];
        if (t.v[0] != t.v[1] && t.v[1] != t.v[2] && t.v[2] != t.v[0]) mesh->triangles[num_kept++] = t;
    }
    if (num_kept < mesh->num_triangles)
        scree_report_warn(report, "%s: %d triangles with a vertex twice were removed", name,
                          mesh->num_triangles - num_kept);
    mesh->num_triangles = num_kept;
}

/// A triangle turned so that its lowest vertex comes first; odd if the two others descend.
typedef struct turned_triangle
{
    int32_t low, middle, high;
    int32_t triangle;
    bool is_odd;
} turned_triangle;

static int compare_turned(const void *left, const void *right)
{
    const turned_triangle *a = left;
    const turned_triangle *b = right;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    if (a->middle != b->middle) return a->middle < b->middle ? -1 : 1;
    if (a->high != b->high) return a->high < b->high ? -1 : 1;
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

static turned_triangle turn(const scree_mesh *mesh, int32_t i)
{
    const int32_t *v = mesh->triangles[i].v;
    const int k = v[0] < v[1] ? (v[0] < v[2] ? 0 : 2) : (v[1] < v[2] ? 1 : 2);
    const int32_t a = v[(k + 1) % 3];
    const int32_t b = v[(k + 2) % 3];
    return (turned_triangle){v[k], a < b ? a : b, a < b ? b : a, i, a > b};
}

/// Of equal triangles the first stays; triangles that lie back to back enclose nothing and both go.
static scree_status drop_repeated(scree_mesh *mesh, const char *name, scree_report *report)
{
    const int32_t num = mesh->num_triangles;
    turned_triangle *turned = malloc(((size_t)num + 1) * sizeof *turned);
    bool *is_dropped = calloc((size_t)num + 1, sizeof *is_dropped);
    if (turned == NULL || is_dropped == NULL)
    {
        free(turned);
        free(is_dropped);
        return SCREE_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < num; ++i) turned[i] = turn(mesh, i);
    qsort(turned, (size_t)num, sizeof *turned, compare_turned);
    for (int32_t begin = 0, end; begin < num; begin = end)
    {
        bool has[2] = {false, false};
        for (end = begin; end < num; ++end)
        {
            const turned_triangle *t = turned + end;
            if (t->low != turned[begin].low || t->middle != turned[begin].middle || t->high != turned[begin].high)
                break;
            is_dropped[t->triangle] = has[t->is_odd];
            has[t->is_odd] = true;
        }
        for (int32_t i = begin; has[0] && has[1] && i < end; ++i) is_dropped[turned[i].triangle] = true;
    }
    int32_t num_kept = 0;
    for (int32_t i = 0; i < num; ++i)
        if (!is_dropped[i]) mesh->triangles[num_kept++] = mesh->triangles[i];
    mesh->num_triangles = num_kept;
    if (num_kept < num)
        scree_report_warn(report, "%s: %d repeated or back to back triangles were removed", name, num - num_kept);
    free(turned);
    free(is_dropped);
    return SCREE_OK;
}

/// A closed, consistently oriented mesh of negative volume is turned round as a whole.
static scree_status turn_outwards(scree_mesh *mesh, const char *name, scree_report *report)
{
    scree_mesh_side *sides = scree_mesh_sides_create(mesh);
    int32_t *neighbours = malloc((3 * (size_t)mesh->num_triangles + 1) * sizeof *neighbours);
    scree_status status = SCREE_OUT_OF_MEMORY;
    if (sides != NULL && neighbours != NULL)
    {
        status = SCREE_OK;
        const bool is_closed = scree_mesh_link(mesh, sides, neighbours) == 0;
        double six_volume = 0.0;
        for (int32_t i = 0; i < mesh->num_triangles; ++i)
            six_volume += scree_mesh_six_volume(mesh, i, mesh->triangles[0].v[0]);
        if (is_closed && six_volume < 0.0)
        {
            for (int32_t i = 0; i < mesh->num_triangles; ++i)
            {
                int32_t *v = mesh->triangles[i].v;
                const int32_t old = v[1];
                v[1] = v[2];
                v[2] = old;
            }
            scree_report_warn(report, "%s: the surface was inside out and was turned", name);
        }
    }
    free(sides);
    free(neighbours);
    return status;
}

static bool is_within(scree_real x) { return (double)scree_abs(x) <= SCREE_EXACT_MAX; }

bool scree_mesh_is_computable(const scree_mesh *mesh)
{
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
        if (!is_within(mesh->vertices[i].x) || !is_within(mesh->vertices[i].y) || !is_within(mesh->vertices[i].z))
            return false;
    for (int32_t i = 0; i < mesh->num_triangles; ++i)
        for (int k = 0; k < 3; ++k)
            if (mesh->triangles[i].v[k] < 0 || mesh->triangles[i].v[k] >= mesh->num_vertices) return false;
    return true;
}

scree_status scree_mesh_mend(scree_mesh *mesh, double tolerance, const char *name, scree_report *report)
{
    // otherwise left for the validation to refuse
    if (!scree_mesh_is_computable(mesh)) return SCREE_OK;
    scree_status status = scree_mesh_weld(mesh, tolerance, name, report);
    if (status != SCREE_OK) return status;
    drop_degenerate(mesh, name, report);
    status = drop_repeated(mesh, name, report);
    if (status == SCREE_OK) status = drop_unused_vertices(mesh);
    if (status == SCREE_OK && mesh->num_triangles > 0) status = turn_outwards(mesh, name, report);
    return status;
}
