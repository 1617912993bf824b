// Random meshes with random faults: validation finds every one, and finds none in sound meshes. Intersections of
// triangles are compared with a second method in whole numbers.
#include "mesh_tools.h"
#include "polyhedra/generate.h"
#include "polyhedra/simplify.h"
#include "polyhedra/triangle_intersection.h"

static uint64_t state = 20240611;

static int64_t random_below(int64_t limit) { return (int64_t)(scree_test_random(&state) * (double)limit); }

// --- intersection of triangles in whole numbers ---

typedef struct whole
{
    int64_t x, y, z;
} whole;

static whole minus(whole a, whole b) { return (whole){a.x - b.x, a.y - b.y, a.z - b.z}; }
static whole cross(whole a, whole b)
{
    return (whole){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static int64_t dot(whole a, whole b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static bool is_same(whole a, whole b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
static whole normal_of(const whole t[3]) { return cross(minus(t[1], t[0]), minus(t[2], t[0])); }

/// Triangles of one plane with normal n: apart if a side of one has the whole other beyond it, or at it if
/// `is_touch_allowed`.
static bool has_separating_side(const whole s[3], const whole t[3], whole n, bool is_touch_allowed)
{
    for (int k = 0; k < 3; ++k)
    {
        // outward in the plane; n is the normal of s itself
        const whole out = cross(minus(s[(k + 1) % 3], s[k]), n);
        bool is_beyond = true;
        for (int l = 0; l < 3; ++l)
        {
            const int64_t side = dot(out, minus(t[l], s[k]));
            is_beyond = is_beyond && (is_touch_allowed ? side >= 0 : side > 0);
        }
        if (is_beyond) return true;
    }
    return false;
}

/// Triangles with one shared corner in one plane meet elsewhere if a side of one at that corner lies in the other's
/// angle there.
static bool angles_overlap(whole corner, const whole a[2], const whole b[2], whole n)
{
    for (int k = 0; k < 2; ++k)
    {
        // is side k of one between both sides of the other?
        const whole *pairs[2][2] = {{a, b + k}, {b, a + k}};
        for (int p = 0; p < 2; ++p)
        {
            const whole u = minus(pairs[p][0][0], corner), v = minus(pairs[p][0][1], corner);
            const whole w = minus(*pairs[p][1], corner);
            const int64_t sense = dot(cross(u, v), n) > 0 ? 1 : -1;
            if (sense * dot(cross(u, w), n) >= 0 && sense * dot(cross(w, v), n) >= 0) return true;
        }
    }
    return false;
}

/// Interval of parameters (numerator over denominator, along d) that the line of the two planes has inside triangle t,
/// given the signed distances of its corners from the other plane; not all zero, not all of one sign.
typedef struct fraction
{
    __int128 num, den;
} fraction;

static bool is_less(fraction a, fraction b) { return a.num * b.den < b.num * a.den; }

static void interval_on_line(const whole t[3], const int64_t distance[3], whole d, fraction range[2])
{
    bool is_first = true;
    for (int k = 0; k < 3; ++k)
    {
        const int l = (k + 1) % 3;
        // where side k crosses or touches the other plane
        fraction found[2];
        int num = 0;
        if (distance[k] == 0) found[num++] = (fraction){dot(d, t[k]), 1};
        if ((distance[k] > 0 && distance[l] < 0) || (distance[k] < 0 && distance[l] > 0))
        {
            fraction f = {(__int128)dot(d, t[k]) * distance[l] - (__int128)dot(d, t[l]) * distance[k],
                          (__int128)distance[l] - distance[k]};
            if (f.den < 0) f = (fraction){-f.num, -f.den};
            found[num++] = f;
        }
        for (int i = 0; i < num; ++i)
        {
            if (is_first || is_less(found[i], range[0])) range[0] = found[i];
            if (is_first || is_less(range[1], found[i])) range[1] = found[i];
            is_first = false;
        }
    }
}

/// Second opinion, after Moeller (1997): the line common to both planes, and the intervals in which it runs through
/// each triangle. `num_shared` corners at the start of both are the same.
static bool whole_triangles_meet(const whole s[3], const whole t[3], int num_shared)
{
    const whole n = normal_of(s), m = normal_of(t);
    const whole d = cross(n, m);
    int64_t of_t[3], of_s[3];
    for (int k = 0; k < 3; ++k)
    {
        of_t[k] = dot(n, minus(t[k], s[0]));
        of_s[k] = dot(m, minus(s[k], t[0]));
    }
    const bool is_one_plane = of_t[0] == 0 && of_t[1] == 0 && of_t[2] == 0;
    if (is_one_plane)
    {
        if (num_shared == 1) return angles_overlap(s[0], s + 1, t + 1, n);
        const bool is_touch_allowed = num_shared == 2;
        return !has_separating_side(s, t, n, is_touch_allowed) && !has_separating_side(t, s, m, is_touch_allowed);
    }
    if (num_shared == 2) return false;
    for (int sign = -1; sign <= 1; sign += 2)
    {
        if (sign * of_t[0] > 0 && sign * of_t[1] > 0 && sign * of_t[2] > 0) return false;
        if (sign * of_s[0] > 0 && sign * of_s[1] > 0 && sign * of_s[2] > 0) return false;
    }
    // two parallel planes that are not one have been left by the signs
    fraction p[2], q[2];
    interval_on_line(s, of_s, d, p);
    interval_on_line(t, of_t, d, q);
    const fraction low = is_less(p[0], q[0]) ? q[0] : p[0];
    const fraction high = is_less(p[1], q[1]) ? p[1] : q[1];
    // the shared corner is common to both; more than that one point is not allowed
    return num_shared == 1 ? is_less(low, high) : !is_less(high, low);
}

/// A point of a small grid, so that touching, coplanar and collinear cases are frequent.
static whole random_grid_point(int64_t size)
{
    return (whole){random_below(size), random_below(size), random_below(size)};
}

static void triangle_pairs_are_decided_as_in_whole_numbers(void)
{
    int num_meeting = 0, num_pairs = 0, num_coplanar = 0;
    for (int trial = 0; trial < 400000; ++trial)
    {
        const int num_shared = trial % 3;
        const int64_t size = trial % 7 == 0 ? 1000 : 2 + trial % 5;
        whole s[3], t[3];
        for (int k = 0; k < 3; ++k) s[k] = random_grid_point(size);
        for (int k = 0; k < 3; ++k) t[k] = k < num_shared ? s[k] : random_grid_point(size);
        // coinciding corners without a common index are a fault of another kind
        bool is_bad = false;
        for (int k = 0; k < 3; ++k)
            for (int l = 0; l < 3; ++l)
                is_bad = is_bad || (k < l && (is_same(s[k], s[l]) || is_same(t[k], t[l]))) ||
                         (is_same(s[k], t[l]) && !(k == l && k < num_shared));
        const whole n = normal_of(s), m = normal_of(t);
        if (is_bad || dot(n, n) == 0 || dot(m, m) == 0) continue;
        // common corners get one index; the corners of each triangle start anywhere and run either way
        scree_vec3 vertices[6];
        scree_triangle triangles[2];
        const int turn_s = (int)random_below(3), turn_t = (int)random_below(3);
        for (int k = 0; k < 3; ++k)
        {
            vertices[k] = scree_vec3_make((scree_real)s[k].x, (scree_real)s[k].y, (scree_real)s[k].z);
            vertices[3 + k] = scree_vec3_make((scree_real)t[k].x, (scree_real)t[k].y, (scree_real)t[k].z);
            triangles[0].v[(k + turn_s) % 3] = k;
            triangles[1].v[(3 - k + turn_t) % 3] = k < num_shared ? k : 3 + k;
        }
        const scree_mesh mesh = {vertices, triangles, 6, 2};
        const bool expected = whole_triangles_meet(s, t, num_shared);
        const bool found = scree_mesh_triangles_meet(&mesh, 0, 1);
        SCREE_CHECK(found == expected && scree_mesh_triangles_meet(&mesh, 1, 0) == expected);
        if (found != expected)
            for (int k = 0; k < 3; ++k)
                printf("  shared %d: s (%d %d %d) t (%d %d %d)\n", num_shared, (int)s[k].x, (int)s[k].y, (int)s[k].z,
                       (int)t[k].x, (int)t[k].y, (int)t[k].z);
        ++num_pairs;
        num_meeting += expected;
        num_coplanar += dot(n, minus(t[2], s[0])) == 0 && dot(n, minus(t[1], s[0])) == 0;
    }
    // both answers and the awkward cases have been seen often
    SCREE_CHECK(num_pairs > 200000 && num_meeting > 20000 && num_pairs - num_meeting > 20000 && num_coplanar > 5000);
}

// --- faults put into sound meshes ---

static scree_mesh random_sound_mesh(void)
{
    scree_mesh mesh = {0};
    const int kind = (int)random_below(4);
    const int32_t num = 20 + 2 * (int32_t)random_below(100);
    scree_status status = SCREE_OK;
    if (kind == 0) status = scree_generate_sphere(&mesh, 1.0, num);
    else if (kind == 1) status = scree_generate_rock(&mesh, 1 + (uint64_t)random_below(1000), num, 300);
    else if (kind == 2) status = scree_generate_rock(&mesh, 1 + (uint64_t)random_below(1000), 300, 300);
    else status = scree_generate_schoenhardt(&mesh, 1.0);
    SCREE_CHECK_INT(status, SCREE_OK);
    return mesh;
}

typedef void (*fault_maker)(scree_mesh *mesh);

static int32_t any_triangle(const scree_mesh *mesh) { return (int32_t)random_below(mesh->num_triangles); }

static void remove_triangle(scree_mesh *mesh)
{
    mesh->triangles[any_triangle(mesh)] = mesh->triangles[mesh->num_triangles - 1];
    --mesh->num_triangles;
}

static void turn_triangle(scree_mesh *mesh)
{
    int32_t *v = mesh->triangles[any_triangle(mesh)].v;
    const int32_t old = v[0];
    v[0] = v[1];
    v[1] = old;
}

static void repeat_triangle(scree_mesh *mesh)
{
    const int32_t i = any_triangle(mesh);
    mesh->triangles[(i + 1 + random_below(mesh->num_triangles - 1)) % mesh->num_triangles] = mesh->triangles[i];
}

static void repeat_corner(scree_mesh *mesh)
{
    int32_t *v = mesh->triangles[any_triangle(mesh)].v;
    v[1] = v[0];
}

/// The three corners of a triangle on one line: its first moved to the middle of the others.
static void flatten_triangle(scree_mesh *mesh)
{
    const int32_t *v = mesh->triangles[any_triangle(mesh)].v;
    // the middle of numbers without their last digits is exact
    for (int k = 1; k < 3; ++k)
    {
        scree_vec3 *p = mesh->vertices + v[k];
        *p = scree_vec3_make((scree_real)floor((double)p->x * 4096.0) / 4096,
                             (scree_real)floor((double)p->y * 4096.0) / 4096,
                             (scree_real)floor((double)p->z * 4096.0) / 4096);
    }
    mesh->vertices[v[0]] =
        scree_vec3_scale(scree_vec3_add(mesh->vertices[v[1]], mesh->vertices[v[2]]), (scree_real)0.5);
}

static void put_vertex_on_another(scree_mesh *mesh)
{
    const int32_t i = (int32_t)random_below(mesh->num_vertices);
    mesh->vertices[(i + 1 + random_below(mesh->num_vertices - 1)) % mesh->num_vertices] = mesh->vertices[i];
}

/// A vertex dragged far out through the opposite side.
static void pull_vertex_through(scree_mesh *mesh)
{
    scree_vec3 *p = mesh->vertices + random_below(mesh->num_vertices);
    *p = scree_vec3_scale(*p, -3);
}

static void spoil_number(scree_mesh *mesh)
{
    static const double numbers[] = {NAN, INFINITY, -INFINITY};
    scree_vec3 *p = mesh->vertices + random_below(mesh->num_vertices);
    const scree_real x = (scree_real)numbers[random_below(3)];
    switch (random_below(3))
    {
    case 0:
        p->x = x;
        break;
    case 1:
        p->y = x;
        break;
    default:
        p->z = x;
        break;
    }
}

static void spoil_index(scree_mesh *mesh)
{
    mesh->triangles[any_triangle(mesh)].v[random_below(3)] =
        random_below(2) == 0 ? -1 - (int32_t)random_below(1000) : mesh->num_vertices + (int32_t)random_below(1000);
}

static void turn_inside_out(scree_mesh *mesh) { scree_test_mesh_turn_inside_out(mesh); }

/// The same body once more, small, inside of itself.
static void add_core(scree_mesh *mesh)
{
    scree_mesh core;
    SCREE_CHECK_INT(scree_mesh_copy(&core, mesh), SCREE_OK);
    scree_test_mesh_scale(&core, 0.05, 0.05, 0.05);
    scree_test_mesh_append(mesh, &core);
    scree_mesh_destroy(&core);
}

/// The same body once more, shifted by less than its size.
static void add_overlapping_piece(scree_mesh *mesh)
{
    scree_mesh piece;
    SCREE_CHECK_INT(scree_mesh_copy(&piece, mesh), SCREE_OK);
    scree_test_mesh_shift(&piece, 0.1 * scree_test_random(&state), 0.1 * scree_test_random(&state), 0.1);
    scree_test_mesh_append(mesh, &piece);
    scree_mesh_destroy(&piece);
}

/// Two triangles far apart get a corner in common: the surface is pinched there.
static void pinch(scree_mesh *mesh)
{
    const int32_t keep = (int32_t)random_below(mesh->num_vertices);
    int32_t gone = keep;
    double farthest = 0.0;
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
    {
        const scree_vec3 d = scree_vec3_sub(mesh->vertices[i], mesh->vertices[keep]);
        if ((double)scree_vec3_dot(d, d) <= farthest) continue;
        farthest = (double)scree_vec3_dot(d, d);
        gone = i;
    }
    for (int32_t t = 0; t < mesh->num_triangles; ++t)
        for (int k = 0; k < 3; ++k)
            if (mesh->triangles[t].v[k] == gone) mesh->triangles[t].v[k] = keep;
}

typedef struct fault
{
    const char *name;
    fault_maker make;
    const char *says; ///< part of a message that must be among those told
} fault;

static const fault faults[] = {{"remove_triangle", remove_triangle, "the surface has a hole there"},
                               {"turn_triangle", turn_triangle, "one of them is turned over"},
                               {"repeat_triangle", repeat_triangle, "have the same vertices"},
                               {"repeat_corner", repeat_corner, "has a vertex twice"},
                               {"flatten_triangle", flatten_triangle, "has no area"},
                               {"put_vertex_on_another", put_vertex_on_another, "coincide at"},
                               {"pull_vertex_through", pull_vertex_through, "touch or pass through each other"},
                               {"spoil_number", spoil_number, "coordinates must be finite"},
                               {"spoil_index", spoil_index, "there are vertices 0 to"},
                               {"turn_inside_out", turn_inside_out, "is inside out"},
                               {"add_core", add_core, "lies inside another piece"},
                               {"add_overlapping_piece", add_overlapping_piece, "touch or pass through each other"},
                               {"pinch", pinch, "belongs to no triangle"}};

static void every_fault_is_found(void)
{
    for (int trial = 0; trial < 650; ++trial)
    {
        const fault *f = faults + trial % (int)(sizeof faults / sizeof faults[0]);
        const uint64_t state_before = state;
        scree_mesh mesh = random_sound_mesh();
        SCREE_CHECK(scree_test_is_valid(&mesh, "sound mesh"));
        scree_report report = {0};
        f->make(&mesh);
        const scree_status status = scree_mesh_validate(&mesh, "mesh", &report);
        SCREE_CHECK_INT(status, SCREE_BAD_MESH);
        const bool is_told = scree_test_report_says(&report, f->says);
        SCREE_CHECK(is_told);
        if (status != SCREE_BAD_MESH || !is_told)
            printf("  fault %s, state %llu\n", f->name, (unsigned long long)state_before);
        scree_report_clear(&report);
        scree_mesh_destroy(&mesh);
    }
}

static void sound_meshes_stay_sound_under_motion_and_mending(void)
{
    for (int trial = 0; trial < 150; ++trial)
    {
        scree_mesh mesh = random_sound_mesh();
        const double scale = ldexp(1.0 + scree_test_random(&state), (int)random_below(40) - 30);
        scree_test_mesh_rotate(&mesh, scree_test_random_rotation(&state));
        scree_test_mesh_scale(&mesh, scale, scale, scale);
        scree_test_mesh_shift(&mesh, 10.0 * scale * scree_test_random(&state), -scale, 3.0 * scale);
        SCREE_CHECK(scree_test_is_valid(&mesh, "moved mesh"));
        scree_report report = {0};
        const int32_t num_vertices = mesh.num_vertices, num_triangles = mesh.num_triangles;
        SCREE_CHECK_INT(scree_mesh_mend(&mesh, 1e-9, "moved mesh", &report), SCREE_OK);
        SCREE_CHECK(report.num_messages == 0 && mesh.num_vertices == num_vertices &&
                    mesh.num_triangles == num_triangles);
        scree_report_clear(&report);
        scree_mesh_destroy(&mesh);
    }
}

/// Mending a soup of loose triangles gives back a body of the same counts.
static void loose_triangles_become_a_body_again(void)
{
    for (int trial = 0; trial < 60; ++trial)
    {
        scree_mesh mesh = random_sound_mesh();
        scree_mesh soup;
        if (scree_mesh_create(&soup, 3 * mesh.num_triangles, mesh.num_triangles) != SCREE_OK) exit(EXIT_FAILURE);
        // shaken by far less than the distance of vertices
        for (int32_t i = 0; i < 3 * mesh.num_triangles; ++i)
        {
            const double shake = trial % 2 == 0 ? 0.0 : 1e-6;
            scree_vec3 p = mesh.vertices[mesh.triangles[i / 3].v[i % 3]];
            p.x += (scree_real)(shake * scree_test_random(&state));
            p.y += (scree_real)(shake * scree_test_random(&state));
            soup.vertices[i] = p;
            soup.triangles[i / 3].v[i % 3] = i;
        }
        SCREE_CHECK_INT(scree_mesh_mend(&soup, 2e-6, "soup", NULL), SCREE_OK);
        SCREE_CHECK_INT(soup.num_vertices, mesh.num_vertices);
        SCREE_CHECK_INT(soup.num_triangles, mesh.num_triangles);
        SCREE_CHECK(scree_test_is_valid(&soup, "soup"));
        scree_mesh_destroy(&soup);
        scree_mesh_destroy(&mesh);
    }
}

/// Number of intersecting pairs that a report tells of.
static int64_t num_told(const scree_report *report)
{
    int64_t num = 0;
    for (int i = 0; i < report->num_messages; ++i)
    {
        long long more = 0;
        num += strstr(report->messages[i], "touch or pass through each other") != NULL;
        if (sscanf(report->messages[i], "mesh: intersecting triangles: %lld more", &more) == 1) num += more;
    }
    return num;
}

/// The tree of the validation misses no pair: all pairs tried one by one give the same number.
static void no_pair_is_missed(void)
{
    for (int trial = 0; trial < 40; ++trial)
    {
        scree_mesh mesh = random_sound_mesh();
        scree_report report = {0};
        for (int k = 0; k < 1 + trial % 3; ++k)
        {
            scree_vec3 *p = mesh.vertices + random_below(mesh.num_vertices);
            *p = scree_vec3_scale(*p, (scree_real)(-1.5 * scree_test_random(&state)));
        }
        int64_t num = 0;
        for (int32_t i = 0; i < mesh.num_triangles; ++i)
            for (int32_t j = i + 1; j < mesh.num_triangles; ++j) num += scree_mesh_triangles_meet(&mesh, i, j);
        scree_mesh_validate(&mesh, "mesh", &report);
        SCREE_CHECK_INT(num_told(&report), num);
        scree_report_clear(&report);
        scree_mesh_destroy(&mesh);
    }
}

/// Grains at all points of a lattice in and around an L whose corners, edges and diagonals lie on the lattice: every
/// tie of the inside test occurs.
static void inside_is_decided_on_edges_and_diagonals(void)
{
    static const double outline[12][3] = {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 2, 0}, {2, 4, 0}, {0, 4, 0},
                                          {0, 0, 4}, {4, 0, 4}, {4, 2, 4}, {2, 2, 4}, {2, 4, 4}, {0, 4, 4}};
    static const int32_t triangles[20][3] = {{0, 2, 1},  {0, 3, 2},  {0, 4, 3},   {0, 5, 4}, {6, 7, 8},
                                             {6, 8, 9},  {6, 9, 10}, {6, 10, 11}, {0, 1, 7}, {0, 7, 6},
                                             {1, 2, 8},  {1, 8, 7},  {2, 3, 9},   {2, 9, 8}, {3, 4, 10},
                                             {3, 10, 9}, {4, 5, 11}, {4, 11, 10}, {5, 0, 6}, {5, 6, 11}};
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int trial = 0; trial < 6 * 11 * 11 * 11; ++trial)
    {
        // half steps from -0.5 to 4.5
        const double p[3] = {0.5 * (trial / 6 % 11) - 0.5, 0.5 * (trial / 66 % 11) - 0.5, 0.5 * (trial / 726) - 0.5};
        const bool is_in_l =
            p[0] > 0 && p[1] > 0 && p[2] > 0 && p[0] < 4 && p[1] < 4 && p[2] < 4 && (p[0] < 2 || p[1] < 2);
        const bool is_in_closed_l =
            p[0] >= 0 && p[1] >= 0 && p[2] >= 0 && p[0] <= 4 && p[1] <= 4 && p[2] <= 4 && (p[0] <= 2 || p[1] <= 2);
        if (is_in_l != is_in_closed_l) continue;
        // axes permuted, so that edges along all axes stand above the grain
        double turned[12][3], grain[4][3];
        const int *order = orders[trial % 6];
        for (int i = 0; i < 12; ++i)
            for (int k = 0; k < 3; ++k) turned[i][k] = outline[i][order[k]];
        for (int i = 0; i < 4; ++i)
            for (int k = 0; k < 3; ++k) grain[i][k] = p[order[k]] + (i == k + 1 ? 0.125 : 0.0);
        static const int32_t grain_triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        scree_mesh mesh = scree_test_mesh(turned, 12, triangles, 20);
        scree_mesh part = scree_test_mesh(grain, 4, grain_triangles, 4);
        if (trial % 6 > 2) scree_test_mesh_turn_inside_out(&mesh);
        if (is_in_l) scree_test_mesh_turn_inside_out(&part);
        scree_test_mesh_append(&mesh, &part);
        SCREE_CHECK(scree_test_is_valid(&mesh, "L and grain"));
        scree_mesh_destroy(&part);
        scree_mesh_destroy(&mesh);
    }
}

/// Boxes in boxes, and beside them, in random order: valid if and only if each piece's sense fits the number of boxes
/// around it.
static void nested_pieces_must_alternate(void)
{
    for (int trial = 0; trial < 200; ++trial)
    {
        scree_mesh mesh = {0};
        bool is_expected_valid = true;
        const int num_towers = 1 + (int)random_below(3);
        for (int tower = 0; tower < num_towers; ++tower)
        {
            const int depth = 1 + (int)random_below(4);
            const scree_quat turn = scree_test_random_rotation(&state);
            for (int level = 0; level < depth; ++level)
            {
                const double size[3] = {1.0 - 0.2 * level, 1.0 - 0.2 * level, 1.0 - 0.2 * level};
                scree_mesh part;
                const bool is_turned = random_below(8) == 0 ? level % 2 == 0 : level % 2 == 1;
                SCREE_CHECK_INT(scree_generate_box(&part, size), SCREE_OK);
                scree_test_mesh_rotate(&part, turn);
                scree_test_mesh_shift(&part, 2.0 * tower, 0.0, 0.0);
                if (is_turned) scree_test_mesh_turn_inside_out(&part);
                is_expected_valid = is_expected_valid && is_turned == (level % 2 == 1);
                scree_test_mesh_append(&mesh, &part);
                scree_mesh_destroy(&part);
            }
        }
        SCREE_CHECK_INT(scree_mesh_validate(&mesh, "towers", NULL), is_expected_valid ? SCREE_OK : SCREE_BAD_MESH);
        scree_mesh_destroy(&mesh);
    }
}

/// A rock of every seed comes down to every size that studies use.
static void rocks_of_all_seeds_simplify_to_all_sizes(void)
{
    static const int32_t counts[] = {10, 20, 28, 40, 60, 70, 84, 100, 150, 300};
    for (uint64_t seed = 1; seed <= 50; ++seed)
    {
        scree_mesh rock;
        SCREE_CHECK_INT(scree_generate_rock(&rock, seed, 1000, 0), SCREE_OK);
        for (size_t i = 0; i < sizeof counts / sizeof counts[0]; ++i)
        {
            scree_mesh mesh;
            SCREE_CHECK_INT(scree_mesh_copy(&mesh, &rock), SCREE_OK);
            const scree_status status = scree_mesh_simplify(&mesh, counts[i], 0.0, NULL);
            SCREE_CHECK_INT(status, SCREE_OK);
            if (status != SCREE_OK) printf("  seed %d, %d triangles\n", (int)seed, counts[i]);
            SCREE_CHECK(abs(mesh.num_triangles - counts[i]) <= 6);
            SCREE_CHECK(scree_test_is_valid(&mesh, "simplified rock"));
            scree_mesh_destroy(&mesh);
        }
        scree_mesh_destroy(&rock);
    }
}

int main(void)
{
    SCREE_RUN(triangle_pairs_are_decided_as_in_whole_numbers);
    SCREE_RUN(every_fault_is_found);
    SCREE_RUN(sound_meshes_stay_sound_under_motion_and_mending);
    SCREE_RUN(loose_triangles_become_a_body_again);
    SCREE_RUN(no_pair_is_missed);
    SCREE_RUN(inside_is_decided_on_edges_and_diagonals);
    SCREE_RUN(nested_pieces_must_alternate);
    SCREE_RUN(rocks_of_all_seeds_simplify_to_all_sizes);
    return SCREE_TEST_END();
}
