// Simplification: count, validity, volume, and refusals that leave the mesh alone.
#include "mesh_tools.h"
#include "polyhedra/generate.h"
#include "polyhedra/mass_properties.h"
#include "polyhedra/shape.h"
#include "polyhedra/simplify.h"

#define EPS ((double)SCREE_REAL_EPSILON)

static scree_mass_properties properties_of(const scree_mesh *mesh)
{
    scree_mass_properties p;
    scree_mass_properties_compute(mesh, &p);
    return p;
}

static void counts_are_met_and_volumes_kept(void)
{
    static const int32_t counts[] = {4, 6, 10, 20, 40, 70, 100, 300, 700, 998};
    scree_mesh rock;
    SCREE_CHECK_INT(scree_generate_rock(&rock, 21, 1000, 0), SCREE_OK);
    scree_test_mesh_shift(&rock, 0.0, 0.5, 0.25);
    const scree_mass_properties before = properties_of(&rock);
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; ++i)
    {
        scree_mesh mesh;
        scree_report report = {0};
        SCREE_CHECK_INT(scree_mesh_copy(&mesh, &rock), SCREE_OK);
        SCREE_CHECK_INT(scree_mesh_simplify(&mesh, counts[i], 0.0, &report), SCREE_OK);
        SCREE_CHECK(abs(mesh.num_triangles - counts[i]) <= 2);
        SCREE_CHECK_INT(report.num_messages, 0);
        SCREE_CHECK(scree_test_is_valid(&mesh, "simplified rock"));
        const scree_mass_properties after = properties_of(&mesh);
        SCREE_CHECK_CLOSE(after.volume, before.volume, counts[i] * EPS + 64 * EPS);
        // the same body, seen from afar: the centroid within a tenth of the size, half of that from 40 triangles on
        for (int k = 0; k < 3; ++k)
            SCREE_CHECK_CLOSE(after.centroid[k], before.centroid[k],
                              counts[i] < 10   ? 0.3
                              : counts[i] < 40 ? 0.1
                                               : 0.05);
        scree_mesh_destroy(&mesh);
    }
    scree_mesh_destroy(&rock);
}

static void finer_is_nearer(void)
{
    // moments of inertia at equal volume approach those of the fine mesh: fewer than 3 percent off with 300 triangles
    scree_mesh rock;
    SCREE_CHECK_INT(scree_generate_rock(&rock, 22, 1000, 0), SCREE_OK);
    const scree_mass_properties before = properties_of(&rock);
    double off[3];
    static const int32_t counts[] = {10, 60, 300};
    for (int i = 0; i < 3; ++i)
    {
        scree_mesh mesh;
        SCREE_CHECK_INT(scree_mesh_copy(&mesh, &rock), SCREE_OK);
        SCREE_CHECK_INT(scree_mesh_simplify(&mesh, counts[i], 0.0, NULL), SCREE_OK);
        const scree_mass_properties after = properties_of(&mesh);
        off[i] = 0.0;
        for (int k = 0; k < 3; ++k) off[i] += fabs(after.principal[k] / before.principal[k] - 1.0);
        scree_mesh_destroy(&mesh);
    }
    SCREE_CHECK(off[0] > off[1] && off[1] > off[2] && off[2] < 0.03);
    scree_mesh_destroy(&rock);
}

static void volume_is_set_about_the_centroid(void)
{
    const double size[3] = {1.0, 2.0, 3.0};
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
    scree_test_mesh_shift(&mesh, 5.0, 0.0, 0.0);
    // no fewer triangles wanted than there are: scaled by 2, nothing else
    SCREE_CHECK_INT(scree_mesh_simplify(&mesh, 12, 48.0, NULL), SCREE_OK);
    SCREE_CHECK_INT(mesh.num_triangles, 12);
    const scree_mass_properties p = properties_of(&mesh);
    SCREE_CHECK_CLOSE(p.volume, 48.0, 48.0 * 64 * EPS);
    SCREE_CHECK_CLOSE(p.centroid[0], 5.0, 64 * EPS);
    const scree_box box = scree_mesh_box(&mesh);
    SCREE_CHECK_CLOSE(box.lower.x, 4.0, 64 * EPS);
    SCREE_CHECK_CLOSE(box.upper.z, 3.0, 64 * EPS);
    // and kept as it is with volume 0
    const scree_vec3 corner = mesh.vertices[3];
    SCREE_CHECK_INT(scree_mesh_simplify(&mesh, 100, 0.0, NULL), SCREE_OK);
    SCREE_CHECK(memcmp(&corner, mesh.vertices + 3, sizeof corner) == 0);
    scree_mesh_destroy(&mesh);

    SCREE_CHECK_INT(scree_generate_rock(&mesh, 23, 1000, 0), SCREE_OK);
    SCREE_CHECK_INT(scree_mesh_simplify(&mesh, 50, 1e-9, NULL), SCREE_OK);
    SCREE_CHECK_CLOSE(properties_of(&mesh).volume, 1e-9, 1e-9 * 256 * EPS);
    SCREE_CHECK(scree_test_is_valid(&mesh, "grain"));
    scree_mesh_destroy(&mesh);
}

static void size_and_place_do_not_matter(void)
{
    // the same triangles are kept for a rock of a micrometre and one far away
    scree_mesh rock, other;
    SCREE_CHECK_INT(scree_generate_rock(&rock, 24, 1000, 0), SCREE_OK);
    SCREE_CHECK_INT(scree_mesh_copy(&other, &rock), SCREE_OK);
    scree_test_mesh_scale(&other, 0x1p-20, 0x1p-20, 0x1p-20);
#ifndef SCREE_SINGLE
    scree_test_mesh_shift(&other, 0x1p-2, 0.0, -0x1p-1);
#endif
    SCREE_CHECK_INT(scree_mesh_simplify(&rock, 80, 0.0, NULL), SCREE_OK);
    SCREE_CHECK_INT(scree_mesh_simplify(&other, 80, 0.0, NULL), SCREE_OK);
    SCREE_CHECK_INT(other.num_triangles, rock.num_triangles);
    SCREE_CHECK(memcmp(other.triangles, rock.triangles, (size_t)rock.num_triangles * sizeof *rock.triangles) == 0);
    scree_mesh_destroy(&rock);
    scree_mesh_destroy(&other);
}

/// A ring of square section: `num` segments.
static scree_mesh ring(int32_t num)
{
    scree_mesh mesh;
    if (scree_mesh_create(&mesh, 4 * num, 8 * num) != SCREE_OK) exit(EXIT_FAILURE);
    for (int32_t i = 0; i < num; ++i)
    {
        const double angle = 6.283185307179586 * i / num;
        for (int32_t k = 0; k < 4; ++k)
        {
            const double radius = k < 2 ? 1.0 : 0.5;
            const double z = k == 1 || k == 2 ? 0.25 : -0.25;
            mesh.vertices[4 * i + k] =
                scree_vec3_make((scree_real)(radius * cos(angle)), (scree_real)(radius * sin(angle)), (scree_real)z);
            const int32_t j = (i + 1) % num, l = (k + 1) % 4;
            mesh.triangles[8 * i + 2 * k] = (scree_triangle){{4 * i + k, 4 * j + k, 4 * j + l}};
            mesh.triangles[8 * i + 2 * k + 1] = (scree_triangle){{4 * i + k, 4 * j + l, 4 * i + l}};
        }
    }
    return mesh;
}

static void impossible_wishes_are_refused_and_change_nothing(void)
{
    // a handle needs 14 triangles at least (Csaszar polyhedron): four are out of reach, sixty are not
    scree_mesh mesh = ring(20);
    scree_mesh copy;
    scree_report report = {0};
    SCREE_CHECK(scree_test_is_valid(&mesh, "ring"));
    SCREE_CHECK_INT(scree_mesh_copy(&copy, &mesh), SCREE_OK);
    SCREE_CHECK_INT(scree_mesh_simplify(&mesh, 4, 0.0, &report), SCREE_BAD_MESH);
    SCREE_CHECK(scree_test_report_says(&report, "ask for more"));
    SCREE_CHECK_INT(mesh.num_triangles, copy.num_triangles);
    SCREE_CHECK(memcmp(mesh.vertices, copy.vertices, (size_t)copy.num_vertices * sizeof *copy.vertices) == 0);
    SCREE_CHECK(memcmp(mesh.triangles, copy.triangles, (size_t)copy.num_triangles * sizeof *copy.triangles) == 0);
    scree_report_clear(&report);
    SCREE_CHECK_INT(scree_mesh_simplify(&mesh, 60, 0.0, &report), SCREE_OK);
    SCREE_CHECK(abs(mesh.num_triangles - 60) <= 6);
    SCREE_CHECK(scree_test_is_valid(&mesh, "coarse ring"));
    SCREE_CHECK_INT(mesh.num_vertices - mesh.num_triangles / 2, 0); // still one handle: V - E + F = 0
    scree_report_clear(&report);

    SCREE_CHECK_INT(scree_mesh_simplify(&mesh, 3, 0.0, &report), SCREE_INVALID_INPUT);
    SCREE_CHECK(scree_test_report_says(&report, "triangles is 3"));
    scree_report_clear(&report);
    SCREE_CHECK_INT(scree_mesh_simplify(&mesh, 20, -1.0, &report), SCREE_INVALID_INPUT);
    SCREE_CHECK_INT(scree_mesh_simplify(&mesh, 20, NAN, &report), SCREE_INVALID_INPUT);
    scree_report_clear(&report);
    scree_test_mesh_turn_inside_out(&mesh);
    SCREE_CHECK_INT(scree_mesh_simplify(&mesh, 20, 0.0, &report), SCREE_BAD_MESH);
    SCREE_CHECK(scree_test_report_says(&report, "must be valid before"));
    scree_report_clear(&report);
    scree_mesh_destroy(&mesh);
    scree_mesh_destroy(&copy);
}

static void fine_meshes_come_down_in_one_go(void)
{
    scree_mesh mesh;
    SCREE_CHECK_INT(scree_generate_rock(&mesh, 25, 40000, 0), SCREE_OK);
    const double volume = properties_of(&mesh).volume;
    SCREE_CHECK_INT(scree_mesh_simplify(&mesh, 60, 0.0, NULL), SCREE_OK);
    SCREE_CHECK(abs(mesh.num_triangles - 60) <= 4);
    SCREE_CHECK(scree_test_is_valid(&mesh, "fine rock"));
    SCREE_CHECK_CLOSE(properties_of(&mesh).volume, volume, 40000 * EPS);
    scree_mesh_destroy(&mesh);
}

int main(void)
{
    SCREE_RUN(counts_are_met_and_volumes_kept);
    SCREE_RUN(finer_is_nearer);
    SCREE_RUN(volume_is_set_about_the_centroid);
    SCREE_RUN(size_and_place_do_not_matter);
    SCREE_RUN(impossible_wishes_are_refused_and_change_nothing);
    SCREE_RUN(fine_meshes_come_down_in_one_go);
    return SCREE_TEST_END();
}
