// The reference itself: closed forms, identities, and Nef polyhedra of CGAL, another algorithm on another number type.
#include "cgal_overlap.hpp"
#include "check.hpp"
#include "harness.h"

#include <cmath>

using namespace reference;

namespace
{

double difference(const Long &a, const Long &b) { return std::fabs((a.high - b.high) + (a.low - b.low)); }

void test_closed_forms()
{
    const Mesh cube_mesh = box({0, 0, 0}, {1, 1, 1});
    const Overlap shifted_boxes = exact_overlap(cube_mesh, shifted(cube_mesh, {0.25, 0.5, 0.125}));
    SCREE_CHECK_CLOSE(shifted_boxes.volume.high, 0.75 * 0.5 * 0.875, 0);
    SCREE_CHECK_CLOSE(shifted_boxes.centroid[0].high, 0.625, 0);
    SCREE_CHECK_CLOSE(shifted_boxes.centroid[1].high, 0.75, 0);
    SCREE_CHECK_CLOSE(shifted_boxes.area_inner[0], 0.5 * 0.875, 0);
    SCREE_CHECK_CLOSE(shifted_boxes.area_outer[1], 0.75 * 0.875, 0);
    SCREE_CHECK_CLOSE(shifted_boxes.coplanar_area, 0, 0);
    SCREE_CHECK_CLOSE(extent_along(shifted_boxes.points, {0, 0, 2}), 0.875, 0);

    // stacked: no volume, but all of the common face is coplanar, seen from inside not at all
    const Overlap stacked = exact_overlap(cube_mesh, shifted(cube_mesh, {0, 0, 1}));
    SCREE_CHECK_CLOSE(stacked.volume.high, 0, 0);
    SCREE_CHECK_CLOSE(stacked.area_inner[2], 0, 0);
    SCREE_CHECK_CLOSE(stacked.area_outer[2], 1, 0);
    SCREE_CHECK_CLOSE(stacked.coplanar_area, 1, 0);

    // two regular tetrahedra: the octahedron between them has half the volume of one
    const Mesh t = mesh_of_cells({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2, 3}});
    const Mesh other = moved(t, lattice_rotation(3), {0, 0, 0});
    const double volume = exact_overlap(t, other).volume.high;
    SCREE_CHECK(volume == 4.0 / 3 || volume == 8.0 / 3); // index 3 may turn it onto itself
    const Mesh dual = moved(t, {Vector{0, 1, 0}, Vector{-1, 0, 0}, Vector{0, 0, 1}}, {0, 0, 0});
    SCREE_CHECK_CLOSE(exact_overlap(t, dual).volume.high, 4.0 / 3, 0);
    // cube with an octahedron of radius 1.5 half-edges: eight corners of the cube are cut off, six tips stick out
    SCREE_CHECK_CLOSE(exact_overlap(cube(2), octahedron(1.5)).volume.high, 4.5 - 6 * (0.5 * 0.5 * 0.5 * 2 / 3), 1e-15);
}

void test_shapes()
{
    Random random(1);
    for (int i = 0; i < num_shapes(); ++i)
    {
        const Mesh mesh = shape(i, random);
        SCREE_CHECK(exact_volume(mesh).high > 0);
        if (!mesh.cells.empty()) SCREE_CHECK(cells_fill_mesh(mesh));
        const Overlap self = exact_overlap(mesh, mesh);
        SCREE_CHECK(difference(self.volume, exact_volume(mesh)) <= 1e-30);
        SCREE_CHECK(self.closure_error <= 1e-150);
    }
}

/// Every body that the other tests use is one that scree accepts: closed, oriented, without self-intersection.
void test_poses_are_valid()
{
    Random random(2);
    for (int kind = 0; kind < num_hard_kinds(); ++kind)
    {
        for (int i = 0; i < 3; ++i)
        {
            const Pose pose = hard_pose(kind, i, random);
            for (const Mesh *mesh : {&pose.a, &pose.b})
            {
                scree_report report{};
                scree_mesh view{};
                SCREE_CHECK(scree_mesh_create(&view, int32_t(mesh->vertices.size()), int32_t(mesh->triangles.size())) ==
                            SCREE_OK);
                for (size_t k = 0; k < mesh->vertices.size(); ++k)
                    view.vertices[k] =
                        scree_vec3_make(mesh->vertices[k][0], mesh->vertices[k][1], mesh->vertices[k][2]);
                for (size_t k = 0; k < mesh->triangles.size(); ++k)
                {
                    for (size_t c = 0; c < 3; ++c) view.triangles[k].v[c] = mesh->triangles[k][c];
                }
                scree_mesh_validate(&view, pose.kind.c_str(), &report);
                SCREE_CHECK_INT(scree_report_num_faults(&report), 0);
                for (int k = 0; k < report.num_messages && k < 2; ++k) std::printf("%s\n", report.messages[k]);
                scree_report_clear(&report);
                scree_mesh_destroy(&view);
            }
        }
    }
}

void compare(const Pose &pose, bool has_area, int &num_with_volume)
{
    const Overlap mine = exact_overlap(pose.a, pose.b);
    const NefOverlap nef = nef_overlap(pose.a, pose.b);
    const double size = std::max(extent(pose.a), extent(pose.b));
    SCREE_CHECK(difference(mine.volume, nef.volume) <= 1e-30 * size * size * size);
    SCREE_CHECK(mine.closure_error <= 1e-150);
    SCREE_CHECK((mine.volume.high > 0) == (nef.num_patches > 0));
    if (mine.volume.high <= 0) return;
    ++num_with_volume;
    // rounded to two doubles each, of coordinates that may be far from the origin
    for (size_t k = 0; k < 3; ++k)
    {
        const double magnitude = size + std::fabs(nef.centroid[k].high);
        SCREE_CHECK(difference(mine.centroid[k], nef.centroid[k]) <= 1e-30 * magnitude);
        if (has_area) SCREE_CHECK_CLOSE(mine.area_inner[k], nef.area[k], 1e-15 * mine.area);
    }
}

void test_against_nef()
{
    Random random(3);
    int num_with_volume = 0, num_poses = 0;
    for (int i = 0; i < 60; ++i, ++num_poses) // shapes up to 80 triangles
        compare(ordinary_pose(random.integer(0, 8), random.integer(0, 8), random), true, num_with_volume);
    for (int kind = 0; kind < num_hard_kinds(); ++kind)
    {
        for (int i = 0; i < 3; ++i)
        {
            const Pose pose = hard_pose(kind, i, random);
            if (pose.a.triangles.size() + pose.b.triangles.size() > 250) continue;
            compare(pose, false, num_with_volume);
            ++num_poses;
        }
    }
    for (int i = 0; i < 150; ++i, ++num_poses)
    {
        bool is_exact = false;
        const Pose pose = lattice_pose(random, is_exact);
        compare(pose, false, num_with_volume);
    }
    std::printf("%d poses compared with Nef polyhedra, %d with volume\n", num_poses, num_with_volume);
    SCREE_CHECK(num_with_volume > num_poses / 3);
}

} // namespace

int main(void)
{
    SCREE_RUN(test_closed_forms);
    SCREE_RUN(test_shapes);
    SCREE_RUN(test_poses_are_valid);
    SCREE_RUN(test_against_nef);
    return SCREE_TEST_END();
}
