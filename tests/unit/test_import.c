// Meshes from files of every format, their mending and refusal; export.
#define _POSIX_C_SOURCE 200809L
#include "mesh_tools.h"
#include "polyhedra/generate.h"
#include "polyhedra/import.h"
#include "polyhedra/mass_properties.h"
#include "test_folder.h"

#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[400];
static char path[800];

/// Path of a file in the folder of this test.
static const char *in_folder(const char *name)
{
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(in_folder(name), "w");
    if (file == NULL) exit(EXIT_FAILURE);
    fputs(text, file);
    fclose(file);
}

static double volume_of(const scree_mesh *mesh)
{
    scree_mass_properties p;
    scree_mass_properties_compute(mesh, &p);
    return p.volume;
}

/// Imports without a word; the caller destroys the mesh.
static scree_mesh imported(const char *name)
{
    scree_mesh mesh;
    scree_report report = {0};
    SCREE_CHECK_INT(scree_mesh_import(&mesh, in_folder(name), &report), SCREE_OK);
    SCREE_CHECK_INT(report.num_messages, 0);
    for (int i = 0; i < report.num_messages; ++i) printf("  %s\n", report.messages[i]);
    scree_report_clear(&report);
    return mesh;
}

static void refused(const char *name, scree_status expected, const char *text)
{
    scree_mesh mesh;
    scree_report report = {0};
    SCREE_CHECK_INT(scree_mesh_import(&mesh, in_folder(name), &report), expected);
    SCREE_CHECK(scree_test_report_says(&report, text));
    SCREE_CHECK(scree_test_report_says(&report, folder));
    SCREE_CHECK(mesh.vertices == NULL && mesh.num_triangles == 0);
    scree_report_clear(&report);
}

static const char cube_of_quads[] = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n"
                                    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

static void quads_are_cut_into_triangles(void)
{
    write_file("cube.obj", cube_of_quads);
    scree_mesh mesh = imported("cube.obj");
    SCREE_CHECK_INT(mesh.num_vertices, 8);
    SCREE_CHECK_INT(mesh.num_triangles, 12);
    SCREE_CHECK_CLOSE(volume_of(&mesh), 8.0, 64 * DBL_EPSILON);
    SCREE_CHECK(scree_mesh_is_convex(&mesh));
    SCREE_CHECK_CLOSE(scree_mesh_import_rounding(&mesh), 0x1p-21, 0.0);
    scree_mesh_destroy(&mesh);
}

static void concave_polygons_are_cut_inside(void)
{
    write_file("l.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
                        "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
                        "f 6 5 4 3 2 1\nf 7 8 9 10 11 12\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\n"
                        "f 5 6 12 11\nf 6 1 7 12\n");
    scree_mesh mesh = imported("l.obj");
    SCREE_CHECK_INT(mesh.num_triangles, 20);
    SCREE_CHECK_CLOSE(volume_of(&mesh), 3.0, 32 * DBL_EPSILON);
    scree_mesh_destroy(&mesh);
}

static void normals_groups_and_materials_do_not_open_the_surface(void)
{
    write_file("groups.obj", "o bottom\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n"
                             "vn 0 0 -1\nvn 0 0 1\nvn 0 -1 0\nvn 1 0 0\nvn 0 1 0\nvn -1 0 0\nvt 0 0\nvt 1 1\n"
                             "usemtl red\nf 1/1/1 4/2/1 3/1/1 2/2/1\no top\nusemtl blue\nf 5//2 6//2 7//2 8//2\n"
                             "g sides\nf 1//3 2//3 6//3 5//3\nf 2//4 3//4 7//4 6//4\nf 3//5 4//5 8//5 7//5\n"
                             "f 4//6 1//6 5//6 8//6\n");
    scree_mesh mesh = imported("groups.obj");
    SCREE_CHECK_INT(mesh.num_vertices, 8);
    SCREE_CHECK_CLOSE(volume_of(&mesh), 8.0, 64 * DBL_EPSILON);
    scree_mesh_destroy(&mesh);
}

static void all_formats_give_the_same_body(void)
{
    static const char stl[] = "solid t\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\n"
                              "endloop\nendfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                              "vertex 0 0 1\nendloop\nendfacet\nfacet normal 0 0 0\nouter loop\nvertex 1 0 0\n"
                              "vertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nfacet normal 0 0 0\nouter loop\n"
                              "vertex 0 1 0\nvertex 0 0 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid t\n";
    static const char ply[] = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
                              "property double z\nelement face 4\nproperty list uchar int vertex_indices\n"
                              "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    static const char off[] = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    static const char *const names[] = {"t.stl", "t.ply", "t.off", "t.OBJ"};
    static const char *const texts[] = {stl, ply, off, obj};
    for (int i = 0; i < 4; ++i)
    {
        write_file(names[i], texts[i]);
        scree_mesh mesh = imported(names[i]);
        SCREE_CHECK_INT(mesh.num_vertices, 4);
        SCREE_CHECK_INT(mesh.num_triangles, 4);
        SCREE_CHECK_CLOSE(volume_of(&mesh), 1.0 / 6.0, 4 * (double)SCREE_REAL_EPSILON);
        scree_mesh_destroy(&mesh);
    }
}

/// Nearest number in single precision. GCC 12 at -O2 drops the plain cast there and back for neighbouring numbers.
static scree_real to_single(scree_real x)
{
    volatile float y = (float)x;
    return y;
}

static void single_precision_comes_back_bit_by_bit(void)
{
    scree_mesh rock;
    SCREE_CHECK_INT(scree_generate_rock(&rock, 31, 1000, 0), SCREE_OK);
    // coordinates that single precision holds and that are written without exponent come back bit by bit
    static const double scales[] = {1.0, 0x1p10, 0x1p40};
    for (int i = 0; i < 3; ++i)
    {
        scree_mesh mesh;
        SCREE_CHECK_INT(scree_mesh_copy(&mesh, &rock), SCREE_OK);
        for (int32_t k = 0; k < mesh.num_vertices; ++k)
        {
            scree_vec3 *p = mesh.vertices + k;
            *p = scree_vec3_make(to_single(p->x), to_single(p->y), to_single(p->z));
        }
        scree_test_mesh_scale(&mesh, scales[i], scales[i], scales[i]);
        SCREE_CHECK_INT(scree_mesh_export_obj(&mesh, in_folder("rock.obj"), NULL), SCREE_OK);
        scree_mesh back = imported("rock.obj");
        SCREE_CHECK_INT(back.num_vertices, mesh.num_vertices);
        SCREE_CHECK_INT(back.num_triangles, mesh.num_triangles);
        // the order of the vertices is that of their first use, so triangles are compared by their corners
        for (int32_t t = 0; t < mesh.num_triangles && t < back.num_triangles; ++t)
            for (int k = 0; k < 3; ++k)
                SCREE_CHECK(memcmp(mesh.vertices + mesh.triangles[t].v[k], back.vertices + back.triangles[t].v[k],
                                   sizeof *back.vertices) == 0);
        scree_mesh_destroy(&mesh);
        scree_mesh_destroy(&back);
    }
    scree_mesh_destroy(&rock);
}

static void rounding_is_as_told_at_all_sizes(void)
{
    static const double scales[] = {1.0, 0x1p-30, 0x1p-60, 0x1p40, 1e9};
    for (int i = 0; i < 5; ++i)
    {
        scree_mesh rock;
        SCREE_CHECK_INT(scree_generate_rock(&rock, 32, 1000, 0), SCREE_OK);
        scree_test_mesh_scale(&rock, scales[i], scales[i], scales[i]);
        SCREE_CHECK_INT(scree_mesh_export_obj(&rock, in_folder("rock.obj"), NULL), SCREE_OK);
        scree_mesh back = imported("rock.obj");
        SCREE_CHECK_INT(back.num_triangles, rock.num_triangles);
        const double rounding = scree_mesh_import_rounding(&back);
        SCREE_CHECK(rounding < 3e-7 * scales[i]);
        double farthest = 0.0;
        for (int32_t t = 0; t < rock.num_triangles && t < back.num_triangles; ++t)
        {
            for (int k = 0; k < 3; ++k)
            {
                const scree_vec3 d =
                    scree_vec3_sub(rock.vertices[rock.triangles[t].v[k]], back.vertices[back.triangles[t].v[k]]);
                farthest = fmax(farthest, fmax(fabs((double)d.x), fmax(fabs((double)d.y), fabs((double)d.z))));
            }
        }
        SCREE_CHECK_CLOSE(farthest, 0.0, rounding);
#ifndef SCREE_SINGLE
        SCREE_CHECK(farthest > 0.0);
#endif
        scree_mesh_destroy(&rock);
        scree_mesh_destroy(&back);
    }
}

static void several_pieces_are_one_body(void)
{
    scree_mesh mesh = {0}, part;
    const double size[3] = {1.0, 1.0, 1.0};
    SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
    SCREE_CHECK_INT(scree_generate_box(&part, size), SCREE_OK);
    scree_test_mesh_shift(&part, 2.0, 0.0, 0.0);
    scree_test_mesh_append(&mesh, &part);
    SCREE_CHECK_INT(scree_mesh_export_obj(&mesh, in_folder("two.obj"), NULL), SCREE_OK);
    scree_mesh_destroy(&mesh);
    mesh = imported("two.obj");
    SCREE_CHECK_INT(mesh.num_triangles, 24);
    SCREE_CHECK_CLOSE(volume_of(&mesh), 2.0, 32 * DBL_EPSILON);
    scree_mesh_destroy(&mesh);
    scree_mesh_destroy(&part);
}

static void mending_is_told(void)
{
    scree_mesh mesh;
    scree_report report = {0};
    // inside out
    write_file("inverted.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n");
    SCREE_CHECK_INT(scree_mesh_import(&mesh, in_folder("inverted.obj"), &report), SCREE_OK);
    SCREE_CHECK(scree_test_report_says(&report, "was inside out and was turned"));
    SCREE_CHECK_INT(scree_report_num_faults(&report), 0);
    SCREE_CHECK(volume_of(&mesh) > 0.0);
    scree_mesh_destroy(&mesh);
    scree_report_clear(&report);
    // one corner written twice with another last digit
    write_file("split.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 1.0000001\nv 9 9 9\n"
                            "f 1 3 2\nf 1 2 4\nf 2 3 5\nf 3 1 4\n");
    SCREE_CHECK_INT(scree_mesh_import(&mesh, in_folder("split.obj"), &report), SCREE_OK);
    SCREE_CHECK(scree_test_report_says(&report, "1 of 5 vertices were joined with others, at most 1.19e-07 away"));
    SCREE_CHECK_INT(mesh.num_vertices, 4);
    scree_mesh_destroy(&mesh);
    scree_report_clear(&report);
    // lines beside the surface
    write_file("lines.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\nl 1 2\n");
    SCREE_CHECK_INT(scree_mesh_import(&mesh, in_folder("lines.obj"), &report), SCREE_OK);
    SCREE_CHECK(scree_test_report_says(&report, "points and lines were left out"));
    scree_mesh_destroy(&mesh);
    scree_report_clear(&report);
}

static void bad_files_are_refused_with_the_reason(void)
{
    refused("missing.obj", SCREE_NOT_FOUND, "cannot be opened");
    write_file("empty.obj", "");
    refused("empty.obj", SCREE_READ_FAILED, "is empty");
    write_file("cube.txt", cube_of_quads);
    refused("cube.txt", SCREE_READ_FAILED, "the name must end in .obj, .stl, .ply or .off");
    write_file("noise.stl", "this is no mesh at all");
    refused("noise.stl", SCREE_READ_FAILED, "cannot be read");
    write_file("short.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n");
    refused("short.ply", SCREE_READ_FAILED, "cannot be read");
    mkdir(in_folder("folder.obj"), 0700);
    refused("folder.obj", SCREE_READ_FAILED, "not a file");
    rmdir(in_folder("folder.obj"));
}

static void bad_meshes_are_refused_with_the_place(void)
{
    write_file("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
    refused("open.obj", SCREE_BAD_MESH, "the surface has a hole there");
    write_file("turned.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    refused("turned.obj", SCREE_BAD_MESH, "turned over");
    write_file("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n");
    refused("points.obj", SCREE_BAD_MESH, "empty");
    write_file("index.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                            "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
                            "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 9 3\n");
    refused("index.ply", SCREE_BAD_MESH, "refers to vertex 9; there are 4 vertices");
    // a needle that single precision makes flat
    write_file("needle.obj", "v 0 0 1\nv 1 0 1\nv 0 1 1\nv 0.25 0.25 1.00000001\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    refused("needle.obj", SCREE_BAD_MESH, "encloses no volume");
}

/// Files cut off or damaged anywhere end in a status, never in a crash or a hang, and valid only if truly valid.
static void damaged_files_do_no_harm(void)
{
    static const char *const names[] = {"t.stl", "t.ply", "t.off", "groups.obj"};
    uint64_t state = 9;
    for (int i = 0; i < 4; ++i)
    {
        char text[2048];
        FILE *file = fopen(in_folder(names[i]), "r");
        if (file == NULL) exit(EXIT_FAILURE);
        const size_t length = fread(text, 1, sizeof text - 1, file);
        fclose(file);
        for (int trial = 0; trial < 24; ++trial)
        {
            char damaged[2048], name[16];
            size_t keep = length;
            memcpy(damaged, text, length);
            if (trial % 2 == 0) keep = (size_t)(scree_test_random(&state) * (double)length);
            else damaged[(size_t)(scree_test_random(&state) * (double)length)] = "x-9 \n"[trial / 2 % 5];
            damaged[keep] = '\0';
            snprintf(name, sizeof name, "damaged%s", strrchr(names[i], '.'));
            write_file(name, damaged);
            scree_mesh mesh;
            scree_report report = {0};
            const scree_status status = scree_mesh_import(&mesh, in_folder(name), &report);
            SCREE_CHECK(status == SCREE_OK ? scree_mesh_validate(&mesh, name, NULL) == SCREE_OK
                                           : scree_report_num_faults(&report) > 0);
            scree_report_clear(&report);
            scree_mesh_destroy(&mesh);
        }
    }
}

static int num_files(void)
{
    int num = 0;
    DIR *entries = opendir(folder);
    while (entries != NULL && readdir(entries) != NULL) ++num;
    if (entries != NULL) closedir(entries);
    return num;
}

static void failed_exports_leave_nothing_behind(void)
{
    scree_mesh mesh;
    scree_report report = {0};
    SCREE_CHECK_INT(scree_generate_tetrahedron(&mesh, 1.0), SCREE_OK);
    SCREE_CHECK_INT(scree_mesh_export_obj(&mesh, in_folder("none/t.obj"), &report), SCREE_WRITE_FAILED);
    SCREE_CHECK(scree_test_report_says(&report, "cannot be written: No such file or directory"));
    scree_report_clear(&report);
    // a folder in the place of the file: the rename fails, the temporary file goes
    mkdir(in_folder("taken.obj"), 0700);
    const int before = num_files();
    SCREE_CHECK_INT(scree_mesh_export_obj(&mesh, in_folder("taken.obj"), &report), SCREE_WRITE_FAILED);
    SCREE_CHECK_INT(num_files(), before);
    SCREE_CHECK_INT(report.num_messages, 1);
    scree_report_clear(&report);
    scree_mesh_destroy(&mesh);
}

int main(void)
{
    snprintf(folder, sizeof folder, "%s", scree_test_folder());
    SCREE_RUN(quads_are_cut_into_triangles);
    SCREE_RUN(concave_polygons_are_cut_inside);
    SCREE_RUN(normals_groups_and_materials_do_not_open_the_surface);
    SCREE_RUN(all_formats_give_the_same_body);
    SCREE_RUN(single_precision_comes_back_bit_by_bit);
    SCREE_RUN(rounding_is_as_told_at_all_sizes);
    SCREE_RUN(several_pieces_are_one_body);
    SCREE_RUN(mending_is_told);
    SCREE_RUN(bad_files_are_refused_with_the_reason);
    SCREE_RUN(bad_meshes_are_refused_with_the_place);
    SCREE_RUN(damaged_files_do_no_harm);
    SCREE_RUN(failed_exports_leave_nothing_behind);
    return SCREE_TEST_END();
}
