// Storage, neighbours, convexity, each fault of validation with its place, each repair.
#include "mesh_tools.h"
#include "polyhedra/generate.h"

static scree_mesh box(double x, double y, double z)
{
    const double size[3] = {x, y, z};
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
    return mesh;
}

static void copies_are_equal_and_apart(void)
{
    scree_mesh mesh = box(1, 2, 3);
    scree_mesh copy;
    SCREE_CHECK_INT(scree_mesh_copy(&copy, &mesh), SCREE_OK);
    SCREE_CHECK_INT(copy.num_vertices, 8);
    SCREE_CHECK_INT(copy.num_triangles, 12);
    SCREE_CHECK(memcmp(copy.vertices, mesh.vertices, 8 * sizeof *mesh.vertices) == 0);
    SCREE_CHECK(memcmp(copy.triangles, mesh.triangles, 12 * sizeof *mesh.triangles) == 0);
    copy.vertices[0].x = 7;
    SCREE_CHECK(mesh.vertices[0].x == (scree_real)-0.5);
    const scree_box bounds = scree_mesh_box(&mesh);
    SCREE_CHECK(bounds.lower.x == (scree_real)-0.5 && bounds.lower.y == -1 && bounds.upper.z == (scree_real)1.5);
    scree_mesh_destroy(&mesh);
    scree_mesh_destroy(&copy);
    SCREE_CHECK(mesh.vertices == NULL && mesh.num_triangles == 0);
    scree_mesh_destroy(&mesh);
}

static void neighbours_share_the_edge_in_opposite_directions(void)
{
    scree_mesh mesh;
    int32_t neighbours[3 * 500];
    SCREE_CHECK_INT(scree_generate_sphere(&mesh, 1.0, 500), SCREE_OK);
    SCREE_CHECK_INT(scree_mesh_neighbours(&mesh, neighbours), SCREE_OK);
    for (int32_t i = 0; i < mesh.num_triangles; ++i)
    {
        for (int k = 0; k < 3; ++k)
        {
            const int32_t from = mesh.triangles[i].v[k], to = mesh.triangles[i].v[(k + 1) % 3];
            const int32_t j = neighbours[3 * i + k];
            int num_found = 0;
            for (int l = 0; l < 3; ++l)
                num_found += mesh.triangles[j].v[l] == to && mesh.triangles[j].v[(l + 1) % 3] == from;
            SCREE_CHECK(j != i && num_found == 1);
        }
    }
    mesh.num_triangles -= 1;
    SCREE_CHECK_INT(scree_mesh_neighbours(&mesh, neighbours), SCREE_BAD_MESH);
    scree_mesh_destroy(&mesh);
}

static scree_mesh l_prism(void)
{
    static const double vertices[12][3] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0},
                                           {0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {1, 1, 1}, {1, 2, 1}, {0, 2, 1}};
    static const int32_t triangles[20][3] = {{0, 2, 1},  {0, 3, 2},  {0, 4, 3},   {0, 5, 4}, {6, 7, 8},
                                             {6, 8, 9},  {6, 9, 10}, {6, 10, 11}, {0, 1, 7}, {0, 7, 6},
                                             {1, 2, 8},  {1, 8, 7},  {2, 3, 9},   {2, 9, 8}, {3, 4, 10},
                                             {3, 10, 9}, {4, 5, 11}, {4, 11, 10}, {5, 0, 6}, {5, 6, 11}};
    return scree_test_mesh(vertices, 12, triangles, 20);
}

static void convexity_is_decided_to_the_last_digit(void)
{
    scree_mesh mesh = box(1, 1, 1);
    SCREE_CHECK(scree_mesh_is_convex(&mesh));
    // the corner of a cube is the far end of a flat face: one digit out of the face makes its diagonal concave
    const scree_real old = mesh.vertices[7].x;
#ifdef SCREE_SINGLE
    mesh.vertices[7].x = nextafterf(old, 1);
#else
    mesh.vertices[7].x = nextafter(old, 1);
#endif
    SCREE_CHECK(scree_test_is_valid(&mesh, "cube with a corner out"));
    SCREE_CHECK(!scree_mesh_is_convex(&mesh));
    mesh.vertices[7].x = old;
    SCREE_CHECK(scree_mesh_is_convex(&mesh));

    scree_mesh second = box(1, 1, 1);
    scree_test_mesh_shift(&second, 3, 0, 0);
    scree_test_mesh_append(&mesh, &second);
    SCREE_CHECK(scree_test_is_valid(&mesh, "two cubes"));
    SCREE_CHECK(!scree_mesh_is_convex(&mesh));
    scree_mesh_destroy(&mesh);
    scree_mesh_destroy(&second);

    mesh = l_prism();
    SCREE_CHECK(scree_test_is_valid(&mesh, "L"));
    SCREE_CHECK(!scree_mesh_is_convex(&mesh));
    scree_mesh_destroy(&mesh);
    SCREE_CHECK_INT(scree_generate_schoenhardt(&mesh, 1.0), SCREE_OK);
    SCREE_CHECK(!scree_mesh_is_convex(&mesh));
    scree_mesh_destroy(&mesh);
    SCREE_CHECK_INT(scree_generate_tetrahedron(&mesh, 1.0), SCREE_OK);
    SCREE_CHECK(scree_mesh_is_convex(&mesh));
    scree_mesh_destroy(&mesh);
}

/// Validation refuses the mesh and says `text`. Destroys it.
static void refuses(scree_mesh mesh, const char *text)
{
    scree_report report = {0};
    SCREE_CHECK_INT(scree_mesh_validate(&mesh, "this", &report), SCREE_BAD_MESH);
    SCREE_CHECK(scree_test_report_says(&report, text));
    SCREE_CHECK(report.num_messages > 0 && strncmp(report.messages[0], "this: ", 6) == 0);
    SCREE_CHECK_INT(scree_report_num_faults(&report), report.num_messages);
    scree_report_clear(&report);
    // without a report the verdict is the same
    SCREE_CHECK_INT(scree_mesh_validate(&mesh, "this", NULL), SCREE_BAD_MESH);
    scree_mesh_destroy(&mesh);
}

static void numbers_and_indices_are_checked_first(void)
{
    refuses((scree_mesh){0}, "the mesh is empty: 0 vertices, 0 triangles");
    scree_mesh mesh = box(1, 1, 1);
    mesh.vertices[3].y = NAN;
    mesh.vertices[5].z = -INFINITY;
    refuses(mesh, "vertex 3 is at (0.5, nan, -0.5)");
#ifndef SCREE_SINGLE
    mesh = box(1, 1, 1);
    mesh.vertices[2].x = 1e200;
    refuses(mesh, "vertex 2 is at (1e+200, 0.5, -0.5)");
    mesh = box(1, 1, 1);
    mesh.vertices[2].x = 1e-200;
    refuses(mesh, "vertex 2 is at (1e-200");
#endif
    mesh = box(1, 1, 1);
    mesh.triangles[4].v[1] = 8;
    mesh.triangles[5].v[1] = -1;
    refuses(mesh, "triangle 4 refers to vertex 8; there are vertices 0 to 7");
}

static void holes_turned_triangles_and_branches_are_found(void)
{
    scree_mesh mesh = box(1, 1, 1);
    mesh.triangles[0] = mesh.triangles[--mesh.num_triangles];
    refuses(mesh, "and none on the other: the surface has a hole there");

    mesh = box(1, 1, 1);
    const int32_t old = mesh.triangles[6].v[0];
    mesh.triangles[6].v[0] = mesh.triangles[6].v[1];
    mesh.triangles[6].v[1] = old;
    refuses(mesh, "in the same direction: one of them is turned over");

    // two boxes with a common edge
    mesh = box(1, 1, 1);
    scree_mesh second = box(1, 1, 1);
    scree_test_mesh_shift(&second, 1, 1, 0);
    scree_test_mesh_append(&mesh, &second);
    scree_mesh_destroy(&second);
    SCREE_CHECK_INT(scree_mesh_mend(&mesh, 0.0, "this", NULL), SCREE_OK);
    SCREE_CHECK_INT(mesh.num_vertices, 14);
    refuses(mesh, "4 triangles (");
}

static void pinched_vertices_are_found(void)
{
    // two boxes that share a corner
    scree_mesh mesh = box(1, 1, 1);
    scree_mesh second = box(1, 1, 1);
    scree_test_mesh_shift(&second, 1, 1, 1);
    scree_test_mesh_append(&mesh, &second);
    scree_mesh_destroy(&second);
    scree_mesh copy;
    SCREE_CHECK_INT(scree_mesh_copy(&copy, &mesh), SCREE_OK);
    refuses(copy, "vertices 7 and 8 coincide at (0.5, 0.5, 0.5)");
    SCREE_CHECK_INT(scree_mesh_mend(&mesh, 0.0, "this", NULL), SCREE_OK);
    refuses(mesh, "vertex 7 (0.5, 0.5, 0.5) joins parts of the surface that meet in this point alone");
}

static void degenerate_and_repeated_triangles_are_found(void)
{
    scree_mesh mesh = box(1, 1, 1);
    mesh.triangles[2].v[2] = mesh.triangles[2].v[0];
    refuses(mesh, "triangle 2 has a vertex twice: 4, 5, 4");

    // a corner of the bottom moved onto the diagonal 1, 2 opposite of it
    mesh = box(1, 1, 1);
    mesh.vertices[0] = scree_vec3_make(0, 0, (scree_real)-0.5);
    refuses(mesh, "has no area; remove it");

    mesh = box(1, 1, 1);
    mesh.vertices[0] = scree_vec3_make((scree_real)-1e-10, (scree_real)-1e-10, (scree_real)-0.5);
    refuses(mesh, "is a sliver");

    mesh = box(1, 1, 1);
    mesh.triangles[11] = mesh.triangles[10];
    refuses(mesh, "triangles 10 and 11 have the same vertices 1, 3, 5");

    mesh = box(1, 1, 1);
    mesh.vertices[6] = mesh.vertices[7];
    refuses(mesh, "vertices 6 and 7 coincide at (0.5, 0.5, 0.5)");

    mesh = box(1, 1, 1);
    scree_mesh more;
    SCREE_CHECK_INT(scree_mesh_create(&more, 9, 12), SCREE_OK);
    memcpy(more.vertices, mesh.vertices, 8 * sizeof *mesh.vertices);
    memcpy(more.triangles, mesh.triangles, 12 * sizeof *mesh.triangles);
    more.vertices[8] = scree_vec3_make(5, 6, 7);
    scree_mesh_destroy(&mesh);
    refuses(more, "vertex 8 (5, 6, 7) belongs to no triangle");
}

static void self_intersections_are_found(void)
{
    // a corner pulled through the opposite side
    scree_mesh mesh = box(1, 1, 1);
    mesh.vertices[7] = scree_vec3_make((scree_real)-0.75, (scree_real)-0.75, (scree_real)-0.75);
    refuses(mesh, "touch or pass through each other near (");

    // only just: the corner touches the face from inside, and stays off it by one digit
    mesh = box(1, 1, 1);
    mesh.vertices[7] = scree_vec3_make((scree_real)-0.5, (scree_real)0.25, (scree_real)0.125);
    refuses(mesh, "touch or pass through each other near (");
    mesh = box(1, 1, 1);
    mesh.vertices[7] =
        scree_vec3_make((scree_real)-0.5 * (1 - SCREE_REAL_EPSILON), (scree_real)0.25, (scree_real)0.125);
    SCREE_CHECK(scree_test_is_valid(&mesh, "deeply dented box"));
    scree_mesh_destroy(&mesh);

    // two boxes that touch with parts of their faces, share no vertex
    mesh = box(1, 1, 1);
    scree_mesh second = box(1, 1, 1);
    scree_test_mesh_shift(&second, 1, 0.25, 0.25);
    scree_test_mesh_append(&mesh, &second);
    scree_mesh_destroy(&second);
    refuses(mesh, "touch or pass through each other near (");
}

static void pieces_are_oriented_by_their_nesting(void)
{
    // 3 in 2 in 1, from the outside: body, cavity, core
    for (int code = 0; code < 8; ++code)
    {
        scree_mesh mesh = {0};
        for (int depth = 0; depth < 3; ++depth)
        {
            scree_mesh part = box(3 - depth, 3 - depth, 3 - depth);
            if (code >> depth & 1) scree_test_mesh_turn_inside_out(&part);
            scree_test_mesh_append(&mesh, &part);
            scree_mesh_destroy(&part);
        }
        if (code == 2)
        {
            SCREE_CHECK(scree_test_is_valid(&mesh, "nested boxes"));
            scree_mesh_destroy(&mesh);
        }
        else refuses(mesh, code & 5 ? "is inside out; turn its triangles round" : "lies inside another piece");
    }
    // without volume: a flat bag of two faces would share its vertices, so a tetrahedron far thinner than its rounding
    static const double vertices[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1e-18}};
    static const int32_t triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    refuses(scree_test_mesh(vertices, 4, triangles, 4), "encloses no volume");
}

static void all_faults_are_told_at_once_but_not_without_end(void)
{
    scree_mesh mesh;
    scree_report report = {0};
    SCREE_CHECK_INT(scree_generate_sphere(&mesh, 1.0, 100), SCREE_OK);
    mesh.num_triangles = 90; // a hole of ten triangles, wherever they were
    mesh.triangles[20].v[0] = mesh.triangles[20].v[1];
    mesh.triangles[30] = mesh.triangles[31];
    SCREE_CHECK_INT(scree_mesh_validate(&mesh, "sphere", &report), SCREE_BAD_MESH);
    SCREE_CHECK(scree_test_report_says(&report, "triangle 20 has a vertex twice"));
    SCREE_CHECK(scree_test_report_says(&report, "triangles 30 and 31 have the same vertices"));
    SCREE_CHECK(scree_test_report_says(&report, "none on the other"));
    SCREE_CHECK(scree_test_report_says(&report, "sphere: faulty edges: "));
    SCREE_CHECK(report.num_messages < 40);
    scree_report_clear(&report);
    scree_mesh_destroy(&mesh);
}

static void mending_repairs_what_is_safe_and_says_so(void)
{
    // every triangle with its own three vertices, turned inside out, one doubled, a fin, and a stray vertex
    scree_mesh cube = box(1, 1, 1);
    scree_mesh mesh;
    scree_report report = {0};
    SCREE_CHECK_INT(scree_mesh_create(&mesh, 3 * 12 + 4, 15), SCREE_OK);
    for (int32_t i = 0; i < 12; ++i)
    {
        for (int k = 0; k < 3; ++k)
        {
            mesh.vertices[3 * i + k] = cube.vertices[cube.triangles[i].v[2 - k]];
            mesh.triangles[i].v[k] = 3 * i + k;
        }
    }
    mesh.vertices[0].x += (scree_real)1e-5;
    mesh.triangles[12] = mesh.triangles[7];
    for (int k = 0; k < 4; ++k) mesh.vertices[36 + k] = scree_vec3_make(2 + k, (scree_real)(k == 1), 0);
    mesh.triangles[13] = (scree_triangle){{36, 37, 38}};
    mesh.triangles[14] = (scree_triangle){{36, 38, 37}};
    SCREE_CHECK_INT(scree_mesh_validate(&mesh, "soup", NULL), SCREE_BAD_MESH);
    SCREE_CHECK_INT(scree_mesh_mend(&mesh, 1e-4, "soup", &report), SCREE_OK);
    SCREE_CHECK(scree_test_report_says(&report, "of 40 vertices were joined with others, at most 1e-05 away"));
    SCREE_CHECK(scree_test_report_says(&report, "3 repeated or back to back triangles were removed"));
    SCREE_CHECK(scree_test_report_says(&report, "was inside out and was turned"));
    SCREE_CHECK_INT(scree_report_num_faults(&report), 0);
    SCREE_CHECK_INT(mesh.num_vertices, 8);
    SCREE_CHECK_INT(mesh.num_triangles, 12);
    SCREE_CHECK(scree_test_is_valid(&mesh, "mended soup"));
    scree_report_clear(&report);

    // a valid mesh is left alone, without a word
    scree_mesh same;
    SCREE_CHECK_INT(scree_mesh_copy(&same, &cube), SCREE_OK);
    SCREE_CHECK_INT(scree_mesh_mend(&same, 1e-6, "cube", &report), SCREE_OK);
    SCREE_CHECK_INT(report.num_messages, 0);
    SCREE_CHECK(memcmp(same.vertices, cube.vertices, 8 * sizeof *cube.vertices) == 0);
    SCREE_CHECK(memcmp(same.triangles, cube.triangles, 12 * sizeof *cube.triangles) == 0);

    // the tolerance is a distance, not a box: corners 0.283 apart stay, though each coordinate differs by 0.2 at most
    scree_mesh tetrahedron;
    SCREE_CHECK_INT(scree_generate_tetrahedron(&tetrahedron, 0.1 * sqrt(3.0)), SCREE_OK);
    SCREE_CHECK_INT(scree_mesh_mend(&tetrahedron, 2.4 / sqrt(12.0), "tetrahedron", &report), SCREE_OK);
    SCREE_CHECK_INT(tetrahedron.num_vertices, 4);
    SCREE_CHECK_INT(report.num_messages, 0);
    scree_mesh_destroy(&tetrahedron);

    // numbers and indices out of range are left for the validation
    same.vertices[1].z = NAN;
    SCREE_CHECK_INT(scree_mesh_mend(&same, 1e-6, "cube", &report), SCREE_OK);
    same.vertices[1].z = 0;
    same.triangles[3].v[0] = 99;
    SCREE_CHECK_INT(scree_mesh_mend(&same, 1e-6, "cube", &report), SCREE_OK);
    SCREE_CHECK_INT(same.triangles[3].v[0], 99);
    SCREE_CHECK_INT(report.num_messages, 0);
    scree_mesh_destroy(&same);
    scree_mesh_destroy(&mesh);
    scree_mesh_destroy(&cube);
}

static void bodies_of_any_size_are_valid(void)
{
#ifdef SCREE_SINGLE
    static const double scales[] = {1e-25, 1e-10, 1e10, 1e25};
#else
    static const double scales[] = {1e-85, 1e-30, 1e30, 1e85};
#endif
    for (int i = 0; i < 4; ++i)
    {
        scree_mesh mesh;
        SCREE_CHECK_INT(scree_generate_sphere(&mesh, 1.0, 100), SCREE_OK);
        scree_test_mesh_scale(&mesh, scales[i], scales[i], scales[i]);
        SCREE_CHECK(scree_test_is_valid(&mesh, "sphere of any size"));
        SCREE_CHECK_INT(scree_mesh_mend(&mesh, 1e-6, "sphere", NULL), SCREE_OK);
        SCREE_CHECK_INT(mesh.num_vertices, 52);
        scree_mesh_destroy(&mesh);
    }
}

static void large_meshes_are_checked_in_time(void)
{
    // quadratic work would take minutes: 2e5 triangles have 2e10 pairs
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_sphere(&mesh, 1.0, 200000), SCREE_OK);
    SCREE_CHECK(scree_test_is_valid(&mesh, "fine sphere"));
#ifndef SCREE_SINGLE
    SCREE_CHECK(scree_mesh_is_convex(&mesh));
#endif
    mesh.vertices[777] = scree_vec3_scale(mesh.vertices[777], (scree_real)-1.001);
    refuses(mesh, "touch or pass through each other");
}

int main(void)
{
    SCREE_RUN(copies_are_equal_and_apart);
    SCREE_RUN(neighbours_share_the_edge_in_opposite_directions);
    SCREE_RUN(convexity_is_decided_to_the_last_digit);
    SCREE_RUN(numbers_and_indices_are_checked_first);
    SCREE_RUN(holes_turned_triangles_and_branches_are_found);
    SCREE_RUN(pinched_vertices_are_found);
    SCREE_RUN(degenerate_and_repeated_triangles_are_found);
    SCREE_RUN(self_intersections_are_found);
    SCREE_RUN(pieces_are_oriented_by_their_nesting);
    SCREE_RUN(all_faults_are_told_at_once_but_not_without_end);
    SCREE_RUN(mending_repairs_what_is_safe_and_says_so);
    SCREE_RUN(bodies_of_any_size_are_valid);
    SCREE_RUN(large_meshes_are_checked_in_time);
    return SCREE_TEST_END();
}
