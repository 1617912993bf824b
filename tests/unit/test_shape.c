// Body frames, measures, neighbours and trees of shapes.
#include "mesh_tools.h"
#include "polyhedra/generate.h"
#include "polyhedra/shape.h"

#define EPS ((double)SCREE_REAL_EPSILON)

static scree_mesh turned_rock(uint64_t seed, uint64_t *state)
{
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_rock(&mesh, seed, 200, 0), SCREE_OK);
    scree_test_mesh_rotate(&mesh, scree_test_random_rotation(state));
    scree_test_mesh_shift(&mesh, 2.0, -1.0, 0.5);
    return mesh;
}

static scree_quat quat_of(const double q[4])
{
    return scree_quat_make((scree_real)q[0], (scree_real)q[1], (scree_real)q[2], (scree_real)q[3]);
}

static void body_frames_are_centred_and_principal(void)
{
    uint64_t state = 1;
    for (uint64_t seed = 1; seed <= 20; ++seed)
    {
        scree_mesh mesh = turned_rock(seed, &state);
        scree_mass_properties source;
        scree_shape shape;
        scree_mass_properties_compute(&mesh, &source);
        SCREE_CHECK_INT(scree_shape_create(&shape, &mesh, SCREE_FRAME_PRINCIPAL), SCREE_OK);
        const scree_mass_properties *p = &shape.properties;
        // shifting coordinates of size 3 and turning them leaves a few roundings in each
        const double noise = 64 * EPS;
        SCREE_CHECK_CLOSE(p->volume, source.volume, noise);
        SCREE_CHECK(p->principal_axes[0] == 1.0 && p->principal_axes[3] == 0.0);
        for (int k = 0; k < 3; ++k)
        {
            SCREE_CHECK_CLOSE(p->centroid[k], 0.0, noise);
            SCREE_CHECK_CLOSE(p->inertia[k][(k + 1) % 3], 0.0, noise * source.principal[2]);
            SCREE_CHECK_CLOSE(p->principal[k], source.principal[k], noise);
            SCREE_CHECK(p->principal[k] == p->inertia[k][k]);
            SCREE_CHECK_CLOSE(shape.frame_position[k], source.centroid[k], noise);
        }
        scree_shape_destroy(&shape);
        scree_mesh_destroy(&mesh);
    }
}

static void frame_leads_back_to_the_source(void)
{
    uint64_t state = 2;
    for (uint64_t seed = 1; seed <= 10; ++seed)
    {
        scree_mesh mesh = turned_rock(seed, &state);
        scree_shape shape;
        SCREE_CHECK_INT(scree_shape_create(&shape, &mesh, SCREE_FRAME_PRINCIPAL), SCREE_OK);
        const scree_mat3 turn = scree_mat3_from_quat(quat_of(shape.frame_orientation));
        double farthest = 0.0;
        for (int32_t i = 0; i < mesh.num_vertices; ++i)
        {
            scree_vec3 p = scree_mat3_apply(turn, shape.mesh.vertices[i]);
            p = scree_vec3_add(p,
                               scree_vec3_make((scree_real)shape.frame_position[0], (scree_real)shape.frame_position[1],
                                               (scree_real)shape.frame_position[2]));
            const double off = (double)scree_vec3_length(scree_vec3_sub(p, mesh.vertices[i]));
            if (off > farthest) farthest = off;
        }
        SCREE_CHECK_CLOSE(farthest, 0.0, 32 * EPS);
        scree_shape_destroy(&shape);
        scree_mesh_destroy(&mesh);
    }
}

static void symmetric_bodies_keep_their_coordinates(void)
{
    const double size[3] = {0.3, 0.7, 0.5};
    scree_mesh mesh;
    scree_shape shape;
    SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
    SCREE_CHECK_INT(scree_shape_create(&shape, &mesh, SCREE_FRAME_PRINCIPAL), SCREE_OK);
    SCREE_CHECK(memcmp(shape.mesh.vertices, mesh.vertices, 8 * sizeof *mesh.vertices) == 0);
    SCREE_CHECK(shape.frame_orientation[0] == 1.0 && shape.frame_position[0] == 0.0);
    SCREE_CHECK_CLOSE(shape.middle_size, 0.5, EPS);
    SCREE_CHECK(shape.view.is_convex);
    scree_shape_destroy(&shape);

    // off its centroid it is only shifted
    scree_test_mesh_shift(&mesh, 4.0, 0.0, 0.0);
    SCREE_CHECK_INT(scree_shape_create(&shape, &mesh, SCREE_FRAME_PRINCIPAL), SCREE_OK);
    SCREE_CHECK_CLOSE(shape.frame_position[0], 4.0, 16 * EPS);
    SCREE_CHECK(shape.frame_orientation[0] == 1.0);
    SCREE_CHECK_CLOSE(shape.middle_size, 0.5, 16 * EPS);
    scree_shape_destroy(&shape);
    scree_mesh_destroy(&mesh);
}

static void source_frames_leave_the_mesh_alone(void)
{
    uint64_t state = 3;
    scree_mesh mesh = turned_rock(4, &state);
    scree_shape shape;
    SCREE_CHECK_INT(scree_shape_create(&shape, &mesh, SCREE_FRAME_SOURCE), SCREE_OK);
    SCREE_CHECK(memcmp(shape.mesh.vertices, mesh.vertices, (size_t)mesh.num_vertices * sizeof *mesh.vertices) == 0);
    SCREE_CHECK(shape.frame_orientation[0] == 1.0 && shape.frame_position[2] == 0.0);
    SCREE_CHECK_CLOSE(shape.properties.centroid[0], 2.0, 0.5);
    scree_shape_destroy(&shape);
    scree_mesh_destroy(&mesh);
}

static void view_shows_the_shape(void)
{
    uint64_t state = 4;
    scree_mesh mesh = turned_rock(5, &state);
    scree_shape shape;
    SCREE_CHECK_INT(scree_shape_create(&shape, &mesh, SCREE_FRAME_PRINCIPAL), SCREE_OK);
    const scree_shape_view *view = &shape.view;
    SCREE_CHECK(view->vertices == shape.mesh.vertices && view->triangles == shape.mesh.triangles);
    SCREE_CHECK_INT(view->num_vertices, mesh.num_vertices);
    SCREE_CHECK_INT(view->num_triangles, mesh.num_triangles);
    SCREE_CHECK(!view->is_convex);
    scree_real farthest = 0;
    for (int32_t i = 0; i < view->num_vertices; ++i)
    {
        const scree_vec3 p = view->vertices[i];
        farthest = scree_max(farthest, scree_vec3_length(p));
        SCREE_CHECK(scree_vec3_length(p) <= view->bounding_radius);
        SCREE_CHECK(p.x >= view->box.lower.x && p.y >= view->box.lower.y && p.z >= view->box.lower.z);
        SCREE_CHECK(p.x <= view->box.upper.x && p.y <= view->box.upper.y && p.z <= view->box.upper.z);
    }
    SCREE_CHECK_CLOSE(view->bounding_radius, farthest, 8 * EPS);
    // the tree holds the boxes of the triangles
    scree_box *boxes = malloc((size_t)view->num_triangles * sizeof *boxes);
    for (int32_t i = 0; i < view->num_triangles; ++i)
    {
        boxes[i] = scree_box_empty();
        for (int k = 0; k < 3; ++k) boxes[i] = scree_box_with_point(boxes[i], view->vertices[view->triangles[i].v[k]]);
    }
    SCREE_CHECK_INT(view->tree.num_leaves, view->num_triangles);
    SCREE_CHECK(view->tree.nodes == shape.tree.view.nodes);
    SCREE_CHECK(scree_lbvh_validate(&shape.tree, boxes, view->num_triangles, NULL));
    free(boxes);
    // neighbours are mutual
    for (int32_t i = 0; i < view->num_triangles; ++i)
    {
        for (int k = 0; k < 3; ++k)
        {
            const int32_t *back = view->neighbours + 3 * (size_t)view->neighbours[3 * i + k];
            SCREE_CHECK(back[0] == i || back[1] == i || back[2] == i);
        }
    }
    scree_shape_destroy(&shape);
    SCREE_CHECK(shape.mesh.vertices == NULL && shape.neighbours == NULL);
    scree_mesh_destroy(&mesh);
}

static void middle_size_is_the_middle_one(void)
{
    static const double sizes[6][3] = {{1, 2, 3}, {1, 3, 2}, {2, 1, 3}, {2, 3, 1}, {3, 1, 2}, {3, 2, 1}};
    for (int i = 0; i < 6; ++i)
    {
        scree_mesh mesh;
        scree_shape shape;
        SCREE_CHECK_INT(scree_generate_box(&mesh, sizes[i]), SCREE_OK);
        SCREE_CHECK_INT(scree_shape_create(&shape, &mesh, SCREE_FRAME_PRINCIPAL), SCREE_OK);
        SCREE_CHECK(shape.middle_size == 2.0);
        scree_shape_destroy(&shape);
        scree_mesh_destroy(&mesh);
    }
}

static void convex_bodies_stay_convex_in_their_frame(void)
{
    // flat faces of turned boxes are flat to rounding only; what counts is the mesh as given
    uint64_t state = 8;
    for (int i = 0; i < 20; ++i)
    {
        static const double vertices[6][3] = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2}, {4, 0, 2}, {0, 3, 2}};
        static const int32_t triangles[8][3] = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                                                {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
        scree_mesh mesh = scree_test_mesh(vertices, 6, triangles, 8);
        scree_shape shape;
        scree_test_mesh_shift(&mesh, floor(8.0 * scree_test_random(&state)), 0.0, 1.0);
        SCREE_CHECK_INT(scree_shape_create(&shape, &mesh, SCREE_FRAME_PRINCIPAL), SCREE_OK);
        SCREE_CHECK(shape.frame_orientation[0] != 1.0);
        SCREE_CHECK(shape.view.is_convex);
        scree_shape_destroy(&shape);
        scree_mesh_destroy(&mesh);
    }
}

int main(void)
{
    SCREE_RUN(body_frames_are_centred_and_principal);
    SCREE_RUN(frame_leads_back_to_the_source);
    SCREE_RUN(symmetric_bodies_keep_their_coordinates);
    SCREE_RUN(source_frames_leave_the_mesh_alone);
    SCREE_RUN(view_shows_the_shape);
    SCREE_RUN(middle_size_is_the_middle_one);
    SCREE_RUN(convex_bodies_stay_convex_in_their_frame);
    return SCREE_TEST_END();
}
