/// \file mesh_validate.c
/// Decides whether a mesh can be a body. All decisions on shape are exact; slivers and empty pieces alone have a
/// tolerance. Several pieces are one rigid body: a piece that lies within an odd number of others is a cavity and must
/// be oriented inwards, every other piece outwards. Pieces must not touch.
/// Indices in messages count from 0. Of each kind of fault the first few are told, then their number.
#include "bvh/lbvh.h"
#include "core/exact_arith.h"
#include "polyhedra/mesh.h"
#include "polyhedra/mesh_edges.h"
#include "polyhedra/triangle_intersection.h"

#include <stdlib.h>
#include <string.h>

/// Faults of one kind that are described one by one.
#define MAX_TOLD 5

/// Height over longest side below which a triangle is refused: its plane would be known to seven digits or fewer.
#define SLIVER_RATIO 1e-8

typedef enum fault_kind
{
    FAULT_NUMBER,
    FAULT_INDEX,
    FAULT_TRIANGLE,
    FAULT_REPEATED,
    FAULT_EDGE,
    FAULT_VERTEX,
    FAULT_INTERSECTION,
    FAULT_PIECE,
    NUM_FAULT_KINDS
} fault_kind;

static const char *const fault_names[NUM_FAULT_KINDS] = {
    "unusable coordinates", "wrong indices",   "degenerate triangles",   "repeated triangles",
    "faulty edges",         "faulty vertices", "intersecting triangles", "wrongly oriented pieces"};

/// One validation under way.
typedef struct checker
{
    const scree_mesh *mesh;
    const char *name;
    scree_report *report;
    scree_mesh_side *sides; ///< sorted
    int32_t *neighbours;    ///< (num_triangles, 3)
    int32_t *scratch;       ///< (3 num_triangles + num_vertices)
    bool *is_degenerate;    ///< (num_triangles)
    int64_t num_faults[NUM_FAULT_KINDS];
} checker;

/// Counts a fault; true if it is still to be described.
static bool is_told(checker *c, fault_kind kind) { return ++c->num_faults[kind] <= MAX_TOLD; }

static scree_vec3 vertex(const checker *c, int32_t i) { return c->mesh->vertices[i]; }

#define POINT_FORMAT "(%.9g, %.9g, %.9g)"
#define POINT(p) (double)(p).x, (double)(p).y, (double)(p).z

static bool is_usable(double x) { return x == 0.0 || (fabs(x) >= SCREE_EXACT_MIN && fabs(x) <= SCREE_EXACT_MAX); }

static void check_numbers(checker *c)
{
    for (int32_t i = 0; i < c->mesh->num_vertices; ++i)
    {
        const scree_vec3 p = vertex(c, i);
        if (is_usable((double)p.x) && is_usable((double)p.y) && is_usable((double)p.z)) continue;
        if (is_told(c, FAULT_NUMBER))
            scree_report_add(c->report,
                             "%s: vertex %d is at " POINT_FORMAT
                             "; coordinates must be finite, and 0 or between %g and %g in magnitude",
                             c->name, i, POINT(p), SCREE_EXACT_MIN, SCREE_EXACT_MAX);
    }
    for (int32_t i = 0; i < c->mesh->num_triangles; ++i)
    {
        const int32_t *v = c->mesh->triangles[i].v;
        for (int k = 0; k < 3; ++k)
        {
            if (v[k] >= 0 && v[k] < c->mesh->num_vertices) continue;
            if (is_told(c, FAULT_INDEX))
                scree_report_add(c->report, "%s: triangle %d refers to vertex %d; there are vertices 0 to %d", c->name,
                                 i, v[k], c->mesh->num_vertices - 1);
        }
    }
}

/// Height over the longest side, of a triangle of any size.
static double height_ratio(scree_vec3 a, scree_vec3 b, scree_vec3 c)
{
    double ab[3] = {(double)b.x - (double)a.x, (double)b.y - (double)a.y, (double)b.z - (double)a.z};
    double ac[3] = {(double)c.x - (double)a.x, (double)c.y - (double)a.y, (double)c.z - (double)a.z};
    double largest = 0.0;
    for (int i = 0; i < 3; ++i)
    {
        if (fabs(ab[i]) > largest) largest = fabs(ab[i]);
        if (fabs(ac[i]) > largest) largest = fabs(ac[i]);
    }
    double squares[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < 3; ++i)
    {
        ab[i] /= largest;
        ac[i] /= largest;
        squares[0] += ab[i] * ab[i];
        squares[1] += ac[i] * ac[i];
        squares[2] += (ac[i] - ab[i]) * (ac[i] - ab[i]);
    }
    double area = 0.0;
    double longest = squares[0];
    for (int i = 0; i < 3; ++i)
    {
        const int j = (i + 1) % 3;
        const double n = ab[i] * ac[j] - ab[j] * ac[i];
        area += n * n;
        if (squares[i] > longest) longest = squares[i];
    }
    return sqrt(area) / longest;
}

static void check_triangles(checker *c)
{
    for (int32_t i = 0; i < c->mesh->num_triangles; ++i)
    {
        const int32_t *v = c->mesh->triangles[i].v;
        const scree_vec3 p[3] = {vertex(c, v[0]), vertex(c, v[1]), vertex(c, v[2])};
        const bool has_twice = v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
        c->is_degenerate[i] = has_twice || scree_triangle_is_degenerate(p[0], p[1], p[2]);
        if (!c->is_degenerate[i] && height_ratio(p[0], p[1], p[2]) >= SLIVER_RATIO) continue;
        if (!is_told(c, FAULT_TRIANGLE)) continue;
        if (has_twice)
            scree_report_add(c->report, "%s: triangle %d has a vertex twice: %d, %d, %d at " POINT_FORMAT, c->name, i,
                             v[0], v[1], v[2], POINT(p[0]));
        else
            scree_report_add(c->report,
                             "%s: triangle %d (vertices %d, %d, %d at " POINT_FORMAT
                             ") %s; remove it and join its neighbours",
                             c->name, i, v[0], v[1], v[2], POINT(p[0]),
                             c->is_degenerate[i] ? "has no area" : "is a sliver: its height is below 1e-8 of its side");
    }
}

/// A triangle by its vertices in ascending order.
typedef struct triangle_key
{
    int32_t v[3];
    int32_t triangle;
} triangle_key;

static int compare_keys(const void *left, const void *right)
{
    const triangle_key *a = left;
    const triangle_key *b = right;
    for (int k = 0; k < 3; ++k)
        if (a->v[k] != b->v[k]) return a->v[k] < b->v[k] ? -1 : 1;
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

static void swap_if_greater(int32_t *a, int32_t *b)
{
    const int32_t old = *a;
    if (old <= *b) return;
    *a = *b;
    *b = old;
}

static scree_status check_repeated(checker *c)
{
    const int32_t num = c->mesh->num_triangles;
    triangle_key *keys = malloc((size_t)num * sizeof *keys);
    if (keys == NULL) return SCREE_OUT_OF_MEMORY;
    for (int32_t i = 0; i < num; ++i)
    {
        memcpy(keys[i].v, c->mesh->triangles[i].v, sizeof keys[i].v);
        keys[i].triangle = i;
        swap_if_greater(keys[i].v, keys[i].v + 1);
        swap_if_greater(keys[i].v + 1, keys[i].v + 2);
        swap_if_greater(keys[i].v, keys[i].v + 1);
    }
    qsort(keys, (size_t)num, sizeof *keys, compare_keys);
    for (int32_t i = 1; i < num; ++i)
    {
        if (memcmp(keys[i].v, keys[i - 1].v, sizeof keys[i].v) != 0 || !is_told(c, FAULT_REPEATED)) continue;
        scree_report_add(c->report, "%s: triangles %d and %d have the same vertices %d, %d, %d at " POINT_FORMAT,
                         c->name, keys[i - 1].triangle, keys[i].triangle, keys[i].v[0], keys[i].v[1], keys[i].v[2],
                         POINT(vertex(c, keys[i].v[0])));
    }
    free(keys);
    return SCREE_OK;
}

static void tell_edge(checker *c, const scree_mesh_side *side, int64_t num)
{
    const scree_vec3 p = vertex(c, side->low);
    const scree_vec3 q = vertex(c, side->high);
    if (num == 1)
        scree_report_add(c->report,
                         "%s: the edge of vertices %d " POINT_FORMAT " and %d " POINT_FORMAT
                         " has triangle %d on one side and none on the other: the surface has a hole there; close it",
                         c->name, side->low, POINT(p), side->high, POINT(q), side->triangle);
    else if (num == 2)
        scree_report_add(c->report,
                         "%s: triangles %d and %d run along their edge of vertices %d " POINT_FORMAT
                         " and %d " POINT_FORMAT " in the same direction: one of them is turned over",
                         c->name, side[0].triangle, side[1].triangle, side->low, POINT(p), side->high, POINT(q));
    else
        scree_report_add(c->report,
                         "%s: %lld triangles (%d, %d, %d, ...) share the edge of vertices %d " POINT_FORMAT
                         " and %d " POINT_FORMAT "; an edge must have two",
                         c->name, (long long)num, side[0].triangle, side[1].triangle, side[2].triangle, side->low,
                         POINT(p), side->high, POINT(q));
}

static void check_edges(checker *c)
{
    const int64_t num_sides = 3 * (int64_t)c->mesh->num_triangles;
    for (int64_t begin = 0, num; begin < num_sides; begin += num)
    {
        const scree_mesh_side *side = c->sides + begin;
        num = scree_mesh_side_group(c->sides, num_sides, begin);
        const bool is_closed = num == 2 && side[0].is_backward != side[1].is_backward;
        // the side of a triangle with a vertex twice has been told already
        if (is_closed || side->low == side->high) continue;
        if (is_told(c, FAULT_EDGE)) tell_edge(c, side, num);
    }
}

/// Walks around a vertex from one triangle, over neighbours. Returns the number of triangles of the fan, 0 if open.
static int32_t fan_size(const checker *c, int32_t triangle, int corner)
{
    const int32_t v = c->mesh->triangles[triangle].v[corner];
    int32_t i = triangle;
    int32_t size = 0;
    do {
        const int32_t *w = c->mesh->triangles[i].v;
        const int k = w[0] == v ? 0 : w[1] == v ? 1 : 2;
        i = c->neighbours[3 * (int64_t)i + k];
        ++size;
    } while (i >= 0 && i != triangle && size <= c->mesh->num_triangles);
    return i == triangle ? size : 0;
}

/// Each vertex must have exactly one closed fan: its size must be the number of triangles that use the vertex.
static void check_fans(checker *c)
{
    int32_t *num_uses = c->scratch;
    memset(num_uses, 0, (size_t)c->mesh->num_vertices * sizeof *num_uses);
    for (int32_t i = 0; i < c->mesh->num_triangles; ++i)
        for (int k = 0; k < 3; ++k) ++num_uses[c->mesh->triangles[i].v[k]];
    for (int32_t i = 0; i < c->mesh->num_vertices; ++i)
        if (num_uses[i] == 0 && is_told(c, FAULT_VERTEX))
            scree_report_add(c->report, "%s: vertex %d " POINT_FORMAT " belongs to no triangle; remove it", c->name, i,
                             POINT(vertex(c, i)));
    for (int32_t i = 0; i < c->mesh->num_triangles; ++i)
    {
        for (int k = 0; k < 3; ++k)
        {
            const int32_t v = c->mesh->triangles[i].v[k];
            if (num_uses[v] == 0) continue;
            const int32_t size = fan_size(c, i, k);
            // open fans have been told with their edges
            if (size > 0 && size != num_uses[v] && is_told(c, FAULT_VERTEX))
                scree_report_add(c->report,
                                 "%s: vertex %d " POINT_FORMAT " joins parts of the surface that meet in this point "
                                 "alone (%d of its %d triangles are around triangle %d); part them or join their edges",
                                 c->name, v, POINT(vertex(c, v)), size, num_uses[v], i);
            num_uses[v] = 0;
        }
    }
}

static scree_status check_coincident(checker *c)
{
    scree_mesh_place *places = scree_mesh_places_create(c->mesh);
    if (places == NULL) return SCREE_OUT_OF_MEMORY;
    for (int32_t i = 1; i < c->mesh->num_vertices; ++i)
    {
        if (!scree_mesh_places_coincide(places + i - 1, places + i) || !is_told(c, FAULT_VERTEX)) continue;
        scree_report_add(c->report, "%s: vertices %d and %d coincide at " POINT_FORMAT "; join them", c->name,
                         places[i - 1].vertex, places[i].vertex, POINT(places[i].point));
    }
    free(places);
    return SCREE_OK;
}

static scree_box triangle_box(const checker *c, int32_t i)
{
    scree_box box = scree_box_empty();
    for (int k = 0; k < 3; ++k) box = scree_box_with_point(box, vertex(c, c->mesh->triangles[i].v[k]));
    return box;
}

static void tell_intersection(checker *c, int32_t i, int32_t j, const scree_box *boxes)
{
    const scree_vec3 lower = scree_vec3_max(boxes[i].lower, boxes[j].lower);
    const scree_vec3 upper = scree_vec3_min(boxes[i].upper, boxes[j].upper);
    const scree_vec3 middle = scree_vec3_scale(scree_vec3_add(lower, upper), (scree_real)0.5);
    scree_report_add(c->report, "%s: triangles %d and %d touch or pass through each other near " POINT_FORMAT, c->name,
                     i, j, POINT(middle));
}

static scree_status check_intersections(checker *c)
{
    const int32_t num = c->mesh->num_triangles;
    scree_lbvh tree = {0};
    scree_box *boxes = malloc((size_t)num * sizeof *boxes);
    if (boxes == NULL) return SCREE_OUT_OF_MEMORY;
    for (int32_t i = 0; i < num; ++i) boxes[i] = triangle_box(c, i);
    const scree_status status = scree_lbvh_build(&tree, boxes, num);
    for (int32_t i = 0; status == SCREE_OK && i < num; ++i)
    {
        if (c->is_degenerate[i]) continue;
        int32_t next = tree.view.root;
        for (int32_t j; (j = scree_lbvh_next_overlap(tree.view, boxes[i], next, &next)) >= 0;)
        {
            if (j <= i || c->is_degenerate[j] || !scree_mesh_triangles_meet(c->mesh, i, j)) continue;
            if (is_told(c, FAULT_INTERSECTION)) tell_intersection(c, i, j, boxes);
        }
    }
    scree_lbvh_destroy(&tree);
    free(boxes);
    return status;
}

/// Winding of the projection of triangle v around p in the plane of x and y, with p moved by an infinitesimal step
/// along x, so that ties are decided consistently: 1, 0 or -1.
static int32_t winding_in_xy(const checker *c, const int32_t v[3], scree_vec3 p)
{
    const scree_exact_point2 q = scree_exact_point2_make((double)p.x, (double)p.y);
    int32_t winding = 0;
    for (int k = 0; k < 3; ++k)
    {
        const scree_vec3 a3 = vertex(c, v[k]);
        const scree_vec3 b3 = vertex(c, v[(k + 1) % 3]);
        const scree_exact_point2 a = scree_exact_point2_make((double)a3.x, (double)a3.y);
        const scree_exact_point2 b = scree_exact_point2_make((double)b3.x, (double)b3.y);
        if (a.y <= q.y && q.y < b.y) winding += scree_orient2d(a, b, q) > 0;
        else if (b.y <= q.y && q.y < a.y) winding -= scree_orient2d(a, b, q) < 0;
    }
    return winding;
}

/// True if p lies inside piece `piece`: the ray along +z leaves it once more than it enters, or the reverse.
static bool is_inside_piece(const checker *c, const int32_t *piece_of, int32_t piece, scree_vec3 p)
{
    int32_t winding = 0;
    for (int32_t i = 0; i < c->mesh->num_triangles; ++i)
    {
        if (piece_of[i] != piece) continue;
        const int32_t *v = c->mesh->triangles[i].v;
        const int32_t turn = winding_in_xy(c, v, p);
        if (turn == 0) continue;
        const int32_t side = scree_orient3d(vertex(c, v[0]), vertex(c, v[1]), vertex(c, v[2]), p);
        if (side * turn < 0) winding += turn;
    }
    return winding != 0;
}

/// A part of the surface that hangs together over edges.
typedef struct mesh_piece
{
    scree_box box;
    double volume;
    int32_t first; ///< its first triangle
    int32_t num_triangles;
} mesh_piece;

/// One piece against what its nesting wants. `depth` is the number of other pieces around it.
static void check_piece(checker *c, const mesh_piece *piece, int32_t depth)
{
    const double length = scree_box_diagonal(piece->box);
    // each of the determinants is wrong by less than 8 roundoffs of length^3, and adding them loses as much again
    const double noise = 16.0 * SCREE_ROUNDOFF * (double)piece->num_triangles * length * length * length;
    const bool is_cavity = depth % 2 == 1;
    const bool is_empty = fabs(piece->volume) <= noise;
    if (!is_empty && (piece->volume < 0.0) == is_cavity) return;
    if (!is_told(c, FAULT_PIECE)) return;
    const char *problem = "is inside out; turn its triangles round";
    if (is_empty) problem = "encloses no volume";
    else if (is_cavity)
        problem = "lies inside another piece but is oriented outwards; turn it inside out to make it a cavity, or "
                  "remove it";
    scree_report_add(c->report, "%s: the piece of triangle %d at " POINT_FORMAT " (%d triangles, volume %g) %s",
                     c->name, piece->first, POINT(vertex(c, c->mesh->triangles[piece->first].v[0])),
                     piece->num_triangles, piece->volume, problem);
}

static void measure_pieces(const checker *c, const int32_t *piece_of, mesh_piece *pieces, int32_t num_pieces)
{
    for (int32_t i = 0; i < num_pieces; ++i) pieces[i] = (mesh_piece){.box = scree_box_empty(), .first = -1};
    for (int32_t i = 0; i < c->mesh->num_triangles; ++i)
    {
        mesh_piece *piece = pieces + piece_of[i];
        if (piece->first < 0) piece->first = i;
        ++piece->num_triangles;
        piece->box = scree_box_union(piece->box, triangle_box(c, i));
        piece->volume += scree_mesh_six_volume(c->mesh, i, c->mesh->triangles[piece->first].v[0]) / 6.0;
    }
}

/// Orientation of every piece of a mesh without open edges. Nesting is known only if nothing intersects.
static scree_status check_pieces(checker *c)
{
    int32_t *piece_of = c->scratch;
    const int32_t num = scree_mesh_label_pieces(c->mesh, c->neighbours, piece_of, c->scratch + c->mesh->num_triangles);
    if (num > 1 && c->num_faults[FAULT_INTERSECTION] > 0) return SCREE_OK;
    mesh_piece *pieces = malloc((size_t)num * sizeof *pieces);
    if (pieces == NULL) return SCREE_OUT_OF_MEMORY;
    measure_pieces(c, piece_of, pieces, num);
    for (int32_t i = 0; i < num; ++i)
    {
        const scree_vec3 p = vertex(c, c->mesh->triangles[pieces[i].first].v[0]);
        const scree_box point = {p, p};
        int32_t depth = 0;
        for (int32_t j = 0; j < num; ++j)
            if (j != i && scree_box_overlaps(pieces[j].box, point)) depth += is_inside_piece(c, piece_of, j, p);
        check_piece(c, pieces + i, depth);
    }
    free(pieces);
    return SCREE_OK;
}

/// All checks that need indices in range.
static scree_status check_surface(checker *c)
{
    check_triangles(c);
    scree_status status = check_repeated(c);
    if (status != SCREE_OK) return status;
    check_edges(c);
    const int64_t num_open = scree_mesh_link(c->mesh, c->sides, c->neighbours);
    check_fans(c);
    status = check_coincident(c);
    if (status == SCREE_OK) status = check_intersections(c);
    if (status == SCREE_OK && num_open == 0) status = check_pieces(c);
    return status;
}

static scree_status finish(checker *c)
{
    int64_t num = 0;
    for (int kind = 0; kind < NUM_FAULT_KINDS; ++kind)
    {
        num += c->num_faults[kind];
        if (c->num_faults[kind] > MAX_TOLD)
            scree_report_add(c->report, "%s: %s: %lld more", c->name, fault_names[kind],
                             (long long)(c->num_faults[kind] - MAX_TOLD));
    }
    return num == 0 ? SCREE_OK : SCREE_BAD_MESH;
}

scree_status scree_mesh_validate(const scree_mesh *mesh, const char *name, scree_report *report)
{
    checker c = {.mesh = mesh, .name = name, .report = report};
    if (mesh->num_triangles <= 0 || mesh->num_vertices <= 0)
    {
        scree_report_add(report, "%s: the mesh is empty: %d vertices, %d triangles", name, mesh->num_vertices,
                         mesh->num_triangles);
        return SCREE_BAD_MESH;
    }
    check_numbers(&c);
    if (c.num_faults[FAULT_NUMBER] > 0 || c.num_faults[FAULT_INDEX] > 0) return finish(&c);
    const size_t num = (size_t)mesh->num_triangles;
    c.sides = scree_mesh_sides_create(mesh);
    c.neighbours = malloc(3 * num * sizeof *c.neighbours);
    c.scratch = malloc((3 * num + (size_t)mesh->num_vertices) * sizeof *c.scratch);
    c.is_degenerate = calloc(num, sizeof *c.is_degenerate);
    scree_status status = SCREE_OUT_OF_MEMORY;
    if (c.sides != NULL && c.neighbours != NULL && c.scratch != NULL && c.is_degenerate != NULL)
        status = check_surface(&c);
    free(c.sides);
    free(c.neighbours);
    free(c.scratch);
    free(c.is_degenerate);
    return status == SCREE_OK ? finish(&c) : status;
}
