// Overlap of random pairs of generated shapes at random poses and scales: what holds for any two bodies.
#include "contact/overlap_kernel.h"
#include "mesh_tools.h"
#include "polyhedra/generate.h"

#define EPS ((double)SCREE_REAL_EPSILON)

enum
{
    NUM_SHAPES = 7
};

typedef struct body
{
    const scree_shape *shape;
    scree_pose pose;
} body;

static void make_shapes(scree_shape *shapes)
{
    const double size[3] = {1, 0.6, 0.3};
    const scree_profile_point tube[] = {{0.3, -0.25}, {0.6, -0.25}, {0.6, 0.25}, {0.3, 0.25}};
    for (int k = 0; k < NUM_SHAPES; ++k)
    {
        scree_mesh mesh;
        const scree_status status = k == 0   ? scree_generate_box(&mesh, size)
                                    : k == 1 ? scree_generate_tetrahedron(&mesh, 0.7)
                                    : k == 2 ? scree_generate_schoenhardt(&mesh, 0.7)
                                    : k == 3 ? scree_generate_turned(&mesh, tube, 4, 9)
                                    : k == 4 ? scree_generate_sphere(&mesh, 0.5, 200)
                                    : k == 5 ? scree_generate_rock(&mesh, 5, 40, 0)
                                             : scree_generate_rock(&mesh, 6, 300, 0);
        SCREE_CHECK_INT(status, SCREE_OK);
        SCREE_CHECK_INT(scree_shape_create(shapes + k, &mesh, SCREE_FRAME_PRINCIPAL), SCREE_OK);
        scree_mesh_destroy(&mesh);
    }
}

static double volume_of(const body *b) { return b->shape->properties.volume * pow((double)b->pose.scale, 3); }

static double area_of(const body *b) { return b->shape->properties.area * pow((double)b->pose.scale, 2); }

static double extent_of(const body *b)
{
    const scree_vec3 e = scree_vec3_sub(b->shape->view.box.upper, b->shape->view.box.lower);
    return fmax((double)e.x, fmax((double)e.y, (double)e.z)) * (double)b->pose.scale;
}

static double radius_of(const body *b) { return (double)(b->shape->view.bounding_radius * b->pose.scale); }

/// What two computed volumes may differ by: 10 eps L l^2 each, and a layer over the surfaces of both, because the
/// vertices lie elsewhere in another working frame, by 24 eps of their distance at most (four roundings of a pose,
/// three of a product, of each coordinate, twice).
static double tolerance(const body *a, const body *b)
{
    const double larger = fmax(extent_of(a), extent_of(b)), smaller = fmin(extent_of(a), extent_of(b));
    const double distance = (double)scree_vec3_length(a->pose.position) + (double)scree_vec3_length(b->pose.position);
    const double layer = 2 * 24 * EPS * (radius_of(a) + radius_of(b) + distance);
    return 20 * EPS * larger * smaller * smaller + layer * (area_of(a) + area_of(b));
}

static double overlap(const body *a, const body *b, scree_overlap_scheme scheme, scree_overlap_workspace *workspace)
{
    scree_overlap_options options = {0};
    options.scheme = scheme;
    scree_overlap_result result = {0};
    for (;;)
    {
        scree_overlap_compute(&a->shape->view, &a->pose, &b->shape->view, &b->pose, &options, workspace, &result, 1);
        if (result.status != SCREE_OVERLAP_WORKSPACE_FULL) return (double)result.volume;
        if (scree_overlap_workspace_grow(workspace) != SCREE_OK) return NAN;
    }
}

static scree_vec3 random_direction(uint64_t *state)
{
    return scree_mat3_apply(scree_mat3_from_quat(scree_test_random_rotation(state)), scree_vec3_make(0, 0, 1));
}

static body random_body(const scree_shape *shapes, double size, uint64_t *state)
{
    body b;
    b.shape = shapes + scree_test_random_bits(state) % NUM_SHAPES;
    b.pose.orientation = scree_test_random_rotation(state);
    b.pose.scale = (scree_real)size;
    b.pose.position = scree_vec3_scale(random_direction(state), (scree_real)(3 * size * scree_test_random(state)));
    return b;
}

/// The same body after a motion of everything.
static body moved(const body *b, scree_quat turn, scree_vec3 shift)
{
    body result = *b;
    result.pose.orientation = scree_quat_normalize(scree_quat_multiply(turn, b->pose.orientation));
    result.pose.position = scree_vec3_add(scree_mat3_apply(scree_mat3_from_quat(turn), b->pose.position), shift);
    return result;
}

static void print_body(const char *name, const body *b, const scree_shape *shapes)
{
    const scree_pose *p = &b->pose;
    printf("  %s: shape %d, position (%.17g, %.17g, %.17g), orientation (%.17g, %.17g, %.17g, %.17g), scale %.17g\n",
           name, (int)(b->shape - shapes), (double)p->position.x, (double)p->position.y, (double)p->position.z,
           (double)p->orientation.w, (double)p->orientation.x, (double)p->orientation.y, (double)p->orientation.z,
           (double)p->scale);
}

static scree_overlap_result overlap_along(const body *a, const body *b, scree_vec3 direction,
                                          scree_overlap_workspace *workspace)
{
    const scree_overlap_options options = {0};
    const scree_overlap_pair pair = {{&a->shape->view, &b->shape->view}, {&a->pose, &b->pose}};
    // a workspace begins with its buffers
    scree_overlap_slice *slice = (scree_overlap_slice *)workspace;
    slice->setup.known = direction;
    scree_overlap_result result = {0};
    for (;;)
    {
        scree_overlap_pair_compute(&pair, &options, slice, &result, 1);
        if (result.status != SCREE_OVERLAP_WORKSPACE_FULL || scree_overlap_workspace_grow(workspace) != SCREE_OK)
            return result;
    }
}

static bool are_same(scree_vec3 a, scree_vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/// Whatever direction is said to be known, the result has the same bits.
static void check_directions(const body *a, const body *b, uint64_t *state, scree_overlap_workspace *workspace)
{
    const scree_overlap_result without = overlap_along(a, b, scree_vec3_zero(), workspace);
    for (int k = 0; k < 4; ++k)
    {
        const scree_vec3 direction = k == 0 ? without.normal : random_direction(state);
        const scree_overlap_result with = overlap_along(a, b, direction, workspace);
        SCREE_CHECK(with.status == without.status && with.used_fallback == without.used_fallback);
        SCREE_CHECK(with.volume == without.volume && with.indentation == without.indentation);
        SCREE_CHECK(with.radius == without.radius && with.residual == without.residual);
        SCREE_CHECK(are_same(with.normal, without.normal) && are_same(with.arm, without.arm));
        SCREE_CHECK(are_same(with.area_vector, without.area_vector));
        SCREE_CHECK(are_same(with.torque_vector, without.torque_vector));
    }
}

/// All that must hold of one pair. Returns its volume over that of the smaller body.
static double check_pair(const body *a, const body *b, uint64_t *state, scree_overlap_workspace *workspace)
{
    const double volume = overlap(a, b, SCREE_OVERLAP_FILTERED, workspace), allowed = tolerance(a, b);
    const double smaller = fmin(volume_of(a), volume_of(b));
    SCREE_CHECK(volume >= -allowed);
    SCREE_CHECK(volume <= smaller + allowed);
    SCREE_CHECK_CLOSE(overlap(b, a, SCREE_OVERLAP_FILTERED, workspace), volume, allowed);
    SCREE_CHECK_CLOSE(overlap(a, b, SCREE_OVERLAP_HIERARCHY, workspace), volume, allowed);
    SCREE_CHECK_CLOSE(overlap(b, a, SCREE_OVERLAP_HIERARCHY, workspace), volume, allowed);
    check_directions(a, b, state, workspace);

    const scree_quat turn = scree_test_random_rotation(state);
    const scree_vec3 shift = scree_vec3_scale(random_direction(state), (scree_real)(4 * extent_of(a)));
    const body moved_a = moved(a, turn, shift), moved_b = moved(b, turn, shift);
    SCREE_CHECK_CLOSE(overlap(&moved_a, &moved_b, SCREE_OVERLAP_FILTERED, workspace), volume,
                      allowed + tolerance(&moved_a, &moved_b));
    return volume / smaller;
}

static void test_pairs(void)
{
    scree_shape shapes[NUM_SHAPES];
    make_shapes(shapes);
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    const uint64_t seed = 31;
    uint64_t state = seed;
    int num_touching = 0, num_deep = 0;
    for (int n = 0; n < 4000; ++n)
    {
        const double size = pow(10, 6 * (scree_test_random(&state) - 0.5));
        const body a = random_body(shapes, size, &state);
        body b = random_body(shapes, size * pow(3, 2 * scree_test_random(&state) - 1), &state);
        const double distance = (radius_of(&a) + radius_of(&b)) * scree_test_random(&state);
        b.pose.position = scree_vec3_add_scaled(a.pose.position, random_direction(&state), (scree_real)distance);
        const int num_failed = scree_test_num_failed;
        const double share = check_pair(&a, &b, &state, workspace);
        num_touching += share > 0;
        num_deep += share > 0.1;
        if (scree_test_num_failed == num_failed) continue;
        printf("seed %llu, pair %d\n", (unsigned long long)seed, n);
        print_body("A", &a, shapes);
        print_body("B", &b, shapes);
    }
    printf("%d of 4000 pairs overlap, %d by more than a tenth of the smaller\n", num_touching, num_deep);
    SCREE_CHECK(num_touching > 1000);
    SCREE_CHECK(num_deep > 100);
    scree_overlap_workspace_destroy(workspace);
    for (int k = 0; k < NUM_SHAPES; ++k) scree_shape_destroy(shapes + k);
}

/// Every face lies in one of the other body, but for rounding.
static void test_body_with_itself(void)
{
    scree_shape shapes[NUM_SHAPES];
    make_shapes(shapes);
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    const uint64_t seed = 32;
    uint64_t state = seed;
    for (int n = 0; n < 200; ++n)
    {
        const body a = random_body(shapes, pow(10, 6 * (scree_test_random(&state) - 0.5)), &state);
        const int num_failed = scree_test_num_failed;
        for (int scheme = 0; scheme < 2; ++scheme)
            SCREE_CHECK_CLOSE(overlap(&a, &a, (scree_overlap_scheme)scheme, workspace), volume_of(&a),
                              tolerance(&a, &a));
        if (scree_test_num_failed == num_failed) continue;
        printf("seed %llu, body %d\n", (unsigned long long)seed, n);
        print_body("A", &a, shapes);
    }
    scree_overlap_workspace_destroy(workspace);
    for (int k = 0; k < NUM_SHAPES; ++k) scree_shape_destroy(shapes + k);
}

enum
{
    CELLS = 24, ///< along each edge of the fine box
    CORNERS = CELLS + 1
};

/// A box of this size whose faces are cut into CELLS x CELLS x 2 triangles.
static scree_mesh fine_box(const double size[3])
{
    static double vertices[CORNERS * CORNERS * CORNERS][3];
    static int32_t triangles[12 * CELLS * CELLS][3], id[CORNERS][CORNERS][CORNERS];
    int32_t num_vertices = 0, num_triangles = 0;
    for (int i = 0; i < CORNERS; ++i)
        for (int j = 0; j < CORNERS; ++j)
            for (int k = 0; k < CORNERS; ++k)
            {
                const int at[3] = {i, j, k};
                bool is_on_face = false;
                for (int c = 0; c < 3; ++c) is_on_face |= at[c] == 0 || at[c] == CELLS;
                if (!is_on_face) continue;
                for (int c = 0; c < 3; ++c) vertices[num_vertices][c] = size[c] * ((double)at[c] / CELLS - 0.5);
                id[i][j][k] = num_vertices++;
            }
    for (int face = 0; face < 6; ++face)
        for (int u = 0; u < CELLS; ++u)
            for (int v = 0; v < CELLS; ++v)
            {
                int32_t corner[4];
                for (int n = 0; n < 4; ++n)
                {
                    int at[3];
                    at[face % 3] = face < 3 ? 0 : CELLS;
                    at[(face + 1) % 3] = u + (n == 1 || n == 2);
                    at[(face + 2) % 3] = v + (n >= 2);
                    corner[n] = id[at[0]][at[1]][at[2]];
                }
                const int way = face < 3 ? 1 : 0; // outwards
                const int32_t first[3] = {corner[0], corner[1 + way], corner[2 - way]};
                const int32_t second[3] = {corner[0], corner[2 + way], corner[3 - way]};
                memcpy(triangles[num_triangles++], first, sizeof first);
                memcpy(triangles[num_triangles++], second, sizeof second);
            }
    return scree_test_mesh(vertices, num_vertices, triangles, num_triangles);
}

/// On a wall of thousands of triangles a small body overlaps as much as on the same wall of twelve.
static void test_small_body_on_fine_wall(void)
{
    scree_shape shapes[NUM_SHAPES], walls[2];
    make_shapes(shapes);
    const double size[3] = {2, 1.4, 0.7};
    for (int k = 0; k < 2; ++k)
    {
        scree_mesh mesh = {0};
        if (k == 0) SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
        else mesh = fine_box(size);
        SCREE_CHECK_INT(scree_shape_create(walls + k, &mesh, SCREE_FRAME_SOURCE), SCREE_OK);
        scree_mesh_destroy(&mesh);
    }
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    const uint64_t seed = 33;
    uint64_t state = seed;
    int num_touching = 0, num_deep = 0;
    for (int n = 0; n < 600; ++n)
    {
        const double scale = 0.04 * pow(5, scree_test_random(&state));
        body a = random_body(shapes, scale, &state);
        const body coarse = {walls, {{0, 0, 0}, scree_test_random_rotation(&state), 1}};
        body fine = coarse;
        fine.shape = walls + 1;
        // about a place on one of the faces
        const int face = (int)(scree_test_random_bits(&state) % 6);
        double place[3];
        for (int c = 0; c < 3; ++c) place[c] = size[c] * (scree_test_random(&state) - 0.5);
        place[face % 3] = (face < 3 ? -0.5 : 0.5) * size[face % 3];
        const scree_vec3 on_face = scree_vec3_make((scree_real)place[0], (scree_real)place[1], (scree_real)place[2]);
        a.pose.position =
            scree_vec3_add_scaled(scree_mat3_apply(scree_mat3_from_quat(coarse.pose.orientation), on_face),
                                  random_direction(&state), (scree_real)(radius_of(&a) * scree_test_random(&state)));
        const int num_failed = scree_test_num_failed;
        const double share = check_pair(&a, &fine, &state, workspace);
        SCREE_CHECK_CLOSE(share * volume_of(&a), overlap(&a, &coarse, SCREE_OVERLAP_FILTERED, workspace),
                          tolerance(&a, &coarse));
        num_touching += share > 0;
        num_deep += share > 0.1;
        if (scree_test_num_failed == num_failed) continue;
        printf("seed %llu, pair %d\n", (unsigned long long)seed, n);
        print_body("A", &a, shapes);
    }
    printf("%d of 600 bodies overlap the wall, %d by more than a tenth\n", num_touching, num_deep);
    SCREE_CHECK(num_touching > 400 && num_deep > 200);
    scree_overlap_workspace_destroy(workspace);
    for (int k = 0; k < NUM_SHAPES; ++k) scree_shape_destroy(shapes + k);
    for (int k = 0; k < 2; ++k) scree_shape_destroy(walls + k);
}

int main(void)
{
    SCREE_RUN(test_pairs);
    SCREE_RUN(test_body_with_itself);
    SCREE_RUN(test_small_body_on_fine_wall);
    return SCREE_TEST_END();
}
