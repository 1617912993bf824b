// Contacts of true spheres: with each other, and with faces, edges, vertices, seams, grooves and corners of meshes.
#include "contact/sphere_pairs_kernel.h"
#include "harness.h"
#include "mesh_tools.h"
#include "polyhedra/generate.h"
#include "voxel_mesh.h"

#define EPS ((double)SCREE_REAL_EPSILON)

static const scree_pose at_origin = {{0, 0, 0}, {1, 0, 0, 0}, 1};

/// Contacts of a sphere with a shape in its own frame.
static int32_t touch(const scree_shape *shape, double x, double y, double z, double radius,
                     scree_sphere_contact contacts[8], bool *is_inside)
{
    const scree_vec3 centre = scree_vec3_make((scree_real)x, (scree_real)y, (scree_real)z);
    return scree_sphere_mesh_contacts(&shape->view, scree_sphere_to_mesh(centre, (scree_real)radius, &at_origin),
                                      &shape->view.tree.root, 1, contacts, 8, is_inside);
}

static void make_shape(scree_shape *shape, scree_mesh *mesh)
{
    SCREE_CHECK(scree_test_is_valid(mesh, "test"));
    SCREE_CHECK_INT(scree_shape_create(shape, mesh, SCREE_FRAME_SOURCE), SCREE_OK);
    scree_mesh_destroy(mesh);
}

static void check_contact(scree_sphere_contact c, double nx, double ny, double nz, double indentation)
{
    // a few roundings of numbers around 1
    SCREE_CHECK_CLOSE(c.normal.x, nx, 16 * EPS);
    SCREE_CHECK_CLOSE(c.normal.y, ny, 16 * EPS);
    SCREE_CHECK_CLOSE(c.normal.z, nz, 16 * EPS);
    SCREE_CHECK_CLOSE(c.indentation, indentation, 16 * EPS);
    SCREE_CHECK_CLOSE(c.weight, 1, 0);
}

static void test_two_spheres(void)
{
    scree_sphere_contact c;
    SCREE_CHECK(scree_sphere_sphere_contact(scree_vec3_make(0, 3, 4), 6, &c));
    check_contact(c, 0, 0.6, 0.8, 1);
    SCREE_CHECK(!scree_sphere_sphere_contact(scree_vec3_make(0, 3, 4), 5, &c)); // touching without depth
    SCREE_CHECK(!scree_sphere_sphere_contact(scree_vec3_make(0, 0, 0), 5, &c)); // no direction
}

/// Face, edge and vertex of a box [-1, 1]^3, from outside and, for a face, from inside.
static void test_box_regions(void)
{
    scree_mesh mesh;
    scree_shape box;
    scree_sphere_contact c[8];
    bool is_inside;
    const double size[3] = {2, 2, 2};
    SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
    make_shape(&box, &mesh);
    // in the middle of a face lies the diagonal, a seam
    SCREE_CHECK_INT(touch(&box, 0, 0, 1.4, 0.5, c, &is_inside), 1);
    check_contact(c[0], 0, 0, 1, 0.1);
    SCREE_CHECK(!is_inside);
    SCREE_CHECK_INT(touch(&box, 0.3, -1.4, 0.1, 0.5, c, &is_inside), 1);
    check_contact(c[0], 0, -1, 0, 0.1);
    SCREE_CHECK_INT(touch(&box, 1.3, 0.2, 1.4, 0.6, c, &is_inside), 1);
    check_contact(c[0], 0.6, 0, 0.8, 0.1);
    const double third = 1 / sqrt(3.0);
    SCREE_CHECK_INT(touch(&box, 1 + 0.4 * third, -1 - 0.4 * third, 1 + 0.4 * third, 0.5, c, &is_inside), 1);
    check_contact(c[0], third, -third, third, 0.1);
    SCREE_CHECK_INT(touch(&box, 1.3, 0.2, 1.4, 0.49, c, &is_inside), 0);
    // the centre has gone through the face: out again where it came in, deeper than the radius
    SCREE_CHECK_INT(touch(&box, 0.2, 0.1, 0.9, 0.5, c, &is_inside), 1);
    check_contact(c[0], 0, 0, 1, 0.6);
    SCREE_CHECK(is_inside);
    SCREE_CHECK_INT(touch(&box, 0.2, 0.1, 1, 0.5, c, &is_inside), 1);
    check_contact(c[0], 0, 0, 1, 0.5);
    // below an edge, nearer to one of its faces
    SCREE_CHECK_INT(touch(&box, 0.8, 0.1, 0.9, 0.5, c, &is_inside), 1);
    check_contact(c[0], 0, 0, 1, 0.6);
    scree_shape_destroy(&box);
}

/// A corner between three faces is touched three times, a groove twice, whatever the seams.
static void test_corner_and_groove(void)
{
    scree_voxels voxels = {.num = {3, 3, 3}};
    for (int i = 0; i < 27; ++i) voxels.is_full[i % 3][i / 3 % 3][i / 9] = i % 3 == 0 || i / 3 % 3 == 0 || i / 9 == 0;
    scree_mesh mesh = scree_voxel_mesh(&voxels);
    scree_shape shape;
    make_shape(&shape, &mesh);
    scree_sphere_contact c[8];
    bool is_inside;
    SCREE_CHECK_INT(touch(&shape, 1.4, 1.45, 1.45, 0.5, c, &is_inside), 3);
    for (int k = 0; k < 3; ++k)
    {
        const bool is_x = c[k].normal.x > 0.5, is_y = c[k].normal.y > 0.5;
        check_contact(c[k], is_x, is_y, !is_x && !is_y, is_x ? 0.1 : 0.05);
    }
    SCREE_CHECK_INT(touch(&shape, 2, 1.4, 1.45, 0.5, c, &is_inside), 2);
    SCREE_CHECK_INT(touch(&shape, 2, 2, 1.45, 0.5, c, &is_inside), 1);
    // on the rim: two edges at right angles, that the ball bridges, do not exist here, so one contact
    SCREE_CHECK_INT(touch(&shape, 0.7, 2.5, 3.4, 0.5, c, &is_inside), 1);
    check_contact(c[0], 0, 0, 1, 0.1);
    scree_shape_destroy(&shape);
}

/// Over a plane that is cut into many triangles: one contact with the plane's normal and depth, above faces, seams,
/// crossings of seams, and within a few last digits of them.
static void test_seams_of_a_plane(void)
{
    scree_voxels voxels = {.num = {9, 7, 1}};
    for (int i = 0; i < 63; ++i) voxels.is_full[i % 9][i / 9][0] = true;
    scree_mesh mesh = scree_voxel_mesh(&voxels);
    scree_shape shape;
    make_shape(&shape, &mesh);
    uint64_t seed = 1;
    double worst = 0;
    int num_wrong = 0;
    for (int k = 0; k < 200000; ++k)
    {
        double x = 2 + floor(5 * scree_test_random(&seed)), y = 2 + floor(3 * scree_test_random(&seed));
        const double along = scree_test_random(&seed), scale = pow(10, -16 * scree_test_random(&seed));
        const int kind = k % 4;
        x += kind == 1 ? along : kind == 2 ? 0 : kind == 3 ? along : 0;
        y += kind == 2 ? along : kind == 3 ? along : 0; // 0: crossing, 1 and 2: seams, 3: diagonal
        x += scale * (scree_test_random(&seed) - 0.5);
        y += scale * (scree_test_random(&seed) - 0.5);
        const double radius = 1.2, depth = 0.3 * scree_test_random(&seed) + 1e-3;
        scree_sphere_contact c[8];
        bool is_inside;
        const int32_t num = touch(&shape, x, y, 1 + radius - depth, radius, c, &is_inside);
        num_wrong += num != 1 || is_inside;
        if (num < 1) continue;
        worst = fmax(worst, fabs((double)c[0].indentation - depth) + fabs((double)c[0].normal.x) +
                                fabs((double)c[0].normal.y) + fabs((double)c[0].weight - 1));
    }
    SCREE_CHECK_INT(num_wrong, 0);
    // an edge or vertex taken for the face beside it: the offset is then tilted by rounding of the position over radius
    SCREE_CHECK(worst <= 32 * EPS);
    scree_shape_destroy(&shape);
}

/// Distance and side of random points against the closed form of unions of boxes.
static void test_distance_and_side(void)
{
    scree_voxels voxels = {.num = {4, 4, 3}};
    const char *const layers[3] = {"#####..#########", "##..#...#..#####", "##..#......#...#"};
    for (int i = 0; i < 48; ++i) voxels.is_full[i % 4][i / 4 % 4][i / 16] = layers[i / 16][i % 16] == '#';
    scree_mesh mesh = scree_voxel_mesh(&voxels);
    scree_shape shape;
    make_shape(&shape, &mesh);
    uint64_t seed = 2;
    int num_inside = 0;
    for (int k = 0; k < 20000; ++k)
    {
        const scree_vec3 p = scree_vec3_make((scree_real)(6 * scree_test_random(&seed) - 1),
                                             (scree_real)(6 * scree_test_random(&seed) - 1),
                                             (scree_real)(5 * scree_test_random(&seed) - 1));
        const scree_closest_point closest = scree_closest_on_mesh(&shape.view, p);
        const double height = (double)scree_approach_of(&shape.view, &closest).height;
        SCREE_CHECK_CLOSE(height, scree_voxel_distance(&voxels, p), 64 * EPS);
        num_inside += height < 0;
    }
    SCREE_CHECK(num_inside > 1000 && num_inside < 19000);
    scree_shape_destroy(&shape);
}

/// A slab with a groove along y, whose sides rise with the slope on both sides of x = 0.
static void make_groove(scree_shape *shape, double slope)
{
    const double h = 2 * slope;
    const double vertices[12][3] = {{-2, -2, h},  {0, -2, 0},  {2, -2, h},  {-2, 2, h},  {0, 2, 0},  {2, 2, h},
                                    {-2, -2, -1}, {0, -2, -1}, {2, -2, -1}, {-2, 2, -1}, {0, 2, -1}, {2, 2, -1}};
    const int32_t quads[10][4] = {{0, 1, 4, 3}, {1, 2, 5, 4},  {6, 9, 10, 7},  {7, 10, 11, 8}, {0, 6, 7, 1},
                                  {1, 7, 8, 2}, {3, 4, 10, 9}, {4, 5, 11, 10}, {0, 3, 9, 6},   {2, 8, 11, 5}};
    int32_t triangles[20][3];
    for (int q = 0; q < 10; ++q)
        for (int k = 0; k < 2; ++k)
            for (int m = 0; m < 3; ++m) triangles[2 * q + k][m] = quads[q][m == 0 ? 0 : m + k];
    scree_mesh mesh = scree_test_mesh(vertices, 12, triangles, 20);
    make_shape(shape, &mesh);
}

/// Sum of the forces w d^(3/2) n of a sphere of radius 1 at (x, z).
static scree_vec3 force_at(const scree_shape *shape, double x, double z, int32_t *num)
{
    scree_sphere_contact c[8];
    bool is_inside;
    *num = touch(shape, x, 0.1, z, 1, c, &is_inside);
    scree_vec3 sum = scree_vec3_zero();
    for (int32_t k = 0; k < *num; ++k)
        sum = scree_vec3_add_scaled(sum, c[k].normal, c[k].weight * c[k].indentation * scree_sqrt(c[k].indentation));
    return sum;
}

/// The force on a sphere that is moved across a groove at one height has no jumps, and as the groove gets shallower it
/// becomes that of a plane.
static void test_grooves_are_crossed_smoothly(void)
{
    const double slopes[] = {0.5, 0.1, 0.02, 1e-3, 1e-5};
    for (int s = 0; s < 5; ++s)
    {
        scree_shape shape;
        make_groove(&shape, slopes[s]);
        const double depth = 0.02, z = sqrt(1 + slopes[s] * slopes[s]) * (1 - depth);
        // two planes of this slope are left and right: in the middle both are touched
        int32_t num;
        double jump = 0;
        const double step = 1e-5, width = fmin(3 * slopes[s], depth / slopes[s]) + 20 * step;
        scree_vec3 before = force_at(&shape, -width / 2, z, &num);
        for (double x = -width / 2; x < width / 2; x += step)
        {
            const scree_vec3 force = force_at(&shape, x, z, &num);
            jump = fmax(jump, (double)scree_vec3_length(scree_vec3_sub(force, before)));
            before = force;
        }
        const scree_vec3 middle = force_at(&shape, 0, z, &num);
        const double plane = depth * sqrt(depth);
        printf("slope %-6g: force in the middle %.4f of a plane's, largest jump per 1e-5 of way %.2e of it\n",
               slopes[s], (double)middle.z / plane, jump / plane);
        // while the ball goes by half its depth up or down a side, at most twice the depth comes in: the force of one
        // side changes by 3/2 sqrt(2) slope step/depth; contacts that share hand it over within the width of the
        // groove's bottom, 2 slope, together with the tilt: a few forces of a plane per width
        const double bound = step * (2 * 1.5 * sqrt(2) * slopes[s] / depth + 8 / fmax(slopes[s], 4 * step));
        SCREE_CHECK(jump < bound * plane);
        if (s == 0)
            SCREE_CHECK_CLOSE(middle.z / plane, 2 / sqrt(1.25), 64 * EPS / depth); // steep: two contacts in full
        if (s == 4) SCREE_CHECK_CLOSE(middle.z / plane, 1, 1e-4);
        scree_shape_destroy(&shape);
    }
}

/// Pose and scale of the mesh come back in world axes.
static void test_posed_mesh(void)
{
    scree_mesh mesh;
    scree_shape box;
    const double size[3] = {2, 2, 2};
    SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
    make_shape(&box, &mesh);
    uint64_t seed = 5;
    for (int k = 0; k < 100; ++k)
    {
        const scree_pose pose = {{3, -2, 1}, scree_test_random_rotation(&seed), (scree_real)0.25};
        const scree_mat3 r = scree_mat3_from_quat(pose.orientation);
        const scree_vec3 n = scree_mat3_apply(r, scree_vec3_make(0, 1, 0));
        const scree_vec3 centre = scree_vec3_add_scaled(pose.position, n, (scree_real)(0.25 + 0.09));
        scree_sphere_contact c[3];
        bool is_inside;
        SCREE_CHECK_INT(scree_sphere_mesh_contacts(&box.view, scree_sphere_to_mesh(centre, (scree_real)0.1, &pose),
                                                   &box.view.tree.root, 1, c, 3, &is_inside),
                        1);
        check_contact(c[0], (double)n.x, (double)n.y, (double)n.z, 0.01);
    }
    scree_shape_destroy(&box);
}

static scree_vec3 random_direction(uint64_t *state)
{
    scree_vec3 v = scree_vec3_zero();
    while (!(scree_vec3_length(v) > (scree_real)0.1 && scree_vec3_length(v) < 1))
    {
        v.x = (scree_real)(2 * scree_test_random(state) - 1);
        v.y = (scree_real)(2 * scree_test_random(state) - 1);
        v.z = (scree_real)(2 * scree_test_random(state) - 1);
    }
    return scree_vec3_scale(v, 1 / scree_vec3_length(v));
}

/// Which triangles are near a sphere is found at one place; when it and the mesh have moved within their reach it has
/// the contacts on these that it has on all of them. Returns how many triangles are near; one more than are listed:
/// many.
static int32_t check_near(const scree_shape *shape, scree_pose pose, scree_vec3 centre, scree_real radius,
                          uint64_t *state, int *num_touching)
{
    const scree_real reach = radius / 3;
    const scree_vec3 way = random_direction(state);
    scree_near_nodes near;
    scree_find_near_nodes(&near, &shape->view, scree_sphere_to_mesh(centre, radius, &pose), reach);
    const bool is_list = near.num != 1 || shape->view.tree.nodes[near.node[0]].first_child < 0;

    centre = scree_vec3_add_scaled(centre, way, reach / 2);
    pose.position = scree_vec3_add_scaled(pose.position, way, -reach / 2);
    const scree_sphere_on_mesh sphere = scree_sphere_to_mesh(centre, radius, &pose);
    scree_sphere_contact from_root[8] = {{{0, 0, 0}, 0, 0, 0, 0}}, from_near[8] = {{{0, 0, 0}, 0, 0, 0, 0}};
    bool is_inside[2];
    const int32_t num =
        scree_sphere_mesh_contacts(&shape->view, sphere, &shape->view.tree.root, 1, from_root, 8, is_inside);
    SCREE_CHECK_INT(scree_sphere_mesh_contacts(&shape->view, sphere, near.node, near.num, from_near, 8, is_inside + 1),
                    num);
    SCREE_CHECK(memcmp(from_root, from_near, sizeof from_root) == 0 && is_inside[0] == is_inside[1]);
    *num_touching += num > 0;
    return is_list ? near.num : SCREE_NEAR_NODES + 1;
}

static void check_near_counts(const char *where, const int num[SCREE_NEAR_NODES + 2], int num_touching)
{
    printf("%s: ", where);
    for (int k = 0; k < SCREE_NEAR_NODES + 2; ++k) printf("%d ", num[k]);
    printf("have 0, 1, ... triangles near, the last ones more; %d touch\n", num_touching);
    int num_listed = 0;
    for (int k = 1; k <= SCREE_NEAR_NODES; ++k) num_listed += num[k];
    SCREE_CHECK(num[0] > 20 && num_listed > 1000 && num[SCREE_NEAR_NODES + 1] > 20 && num_touching > 500);
}

/// About a ball of triangles that is three times as large as it is stored.
static void test_near_a_ball(void)
{
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_sphere(&mesh, 0.5, 320), SCREE_OK);
    scree_shape shape;
    make_shape(&shape, &mesh);
    uint64_t state = 5;
    int num[SCREE_NEAR_NODES + 2] = {0}, num_touching = 0;
    for (int k = 0; k < 4000; ++k)
    {
        const scree_pose pose = {{2, 0, 1}, {1, 0, 0, 0}, 3};
        const scree_real radius = (scree_real)(0.02 + 0.3 * scree_test_random(&state) * scree_test_random(&state));
        const double distance = 1.5 + 1.5 * (double)radius * (2 * scree_test_random(&state) - 0.9);
        const scree_vec3 centre = scree_vec3_add_scaled(pose.position, random_direction(&state), (scree_real)distance);
        ++num[check_near(&shape, pose, centre, radius, &state, &num_touching)];
    }
    check_near_counts("about a ball", num, num_touching);
    scree_shape_destroy(&shape);
}

/// On a disc of slivers from its centre to the rim, turned and moved: where they are thin, what is found of them has
/// lost digits.
static void test_near_slivers(void)
{
    const scree_profile_point profile[] = {{0, -0.1}, {1, -0.1}, {1, 0}, {0, 0}};
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_turned(&mesh, profile, 4, 2000), SCREE_OK);
    scree_shape shape;
    make_shape(&shape, &mesh);
    const scree_pose pose = {{1, 2, 3}, {(scree_real)0.8, 0, (scree_real)0.6, 0}, 1};
    const scree_mat3 rotation = scree_mat3_from_quat(pose.orientation);
    uint64_t state = 6;
    int num[SCREE_NEAR_NODES + 2] = {0}, num_touching = 0;
    for (int k = 0; k < 4000; ++k)
    {
        const scree_real radius = (scree_real)(0.001 + 0.004 * scree_test_random(&state));
        const double from_axis = scree_test_random(&state), x = 2 * scree_test_random(&state) - 1;
        const double y = (k % 2 ? 1 : -1) * sqrt(1 - x * x), height = (double)radius * 1.5 * scree_test_random(&state);
        const scree_vec3 place =
            scree_vec3_make((scree_real)(from_axis * x), (scree_real)(from_axis * y), (scree_real)height);
        const scree_vec3 centre = scree_vec3_add(pose.position, scree_mat3_apply(rotation, place));
        ++num[check_near(&shape, pose, centre, radius, &state, &num_touching)];
    }
    check_near_counts("on slivers", num, num_touching);
    scree_shape_destroy(&shape);
}

int main(void)
{
    SCREE_RUN(test_two_spheres);
    SCREE_RUN(test_box_regions);
    SCREE_RUN(test_corner_and_groove);
    SCREE_RUN(test_seams_of_a_plane);
    SCREE_RUN(test_distance_and_side);
    SCREE_RUN(test_grooves_are_crossed_smoothly);
    SCREE_RUN(test_posed_mesh);
    SCREE_RUN(test_near_a_ball);
    SCREE_RUN(test_near_slivers);
    return SCREE_TEST_END();
}
