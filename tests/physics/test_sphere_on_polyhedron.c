// A true sphere on a face, an edge and a vertex of a cube against the same sphere as a fine mesh under the volumetric
// law, and both against closed forms. On faces they agree; on edges and vertices the sphere's contact, Hertz on a
// plane, is stiffer, as docs/theory/forces.md says.
#include "contact/overlap.h"
#include "contact/sphere_contact_kernel.h"
#include "harness.h"
#include "mesh_tools.h"
#include "polyhedra/generate.h"

typedef struct fixture
{
    scree_shape cube, ball; ///< of edge 2, of radius 1
    scree_overlap_workspace *workspace;
} fixture;

/// Volume of the overlap of the mesh of the ball with the cube, mean over orientations of the ball. The scheme of exact
/// arithmetic would give the same; see tests/reference.
static double mesh_volume(fixture *f, scree_vec3 centre, double *indentation)
{
    const int num_orientations = 8;
    const scree_overlap_options options = {.scheme = SCREE_OVERLAP_FILTERED};
    const scree_pose at_origin = {{0, 0, 0}, {1, 0, 0, 0}, 1};
    uint64_t seed = 3;
    double volume = 0;
    *indentation = 0;
    for (int k = 0; k < num_orientations; ++k)
    {
        const scree_pose pose = {centre, scree_test_random_rotation(&seed), 1};
        scree_overlap_result result = {0};
        while (scree_overlap_compute(&f->ball.view, &pose, &f->cube.view, &at_origin, &options, f->workspace, &result,
                                     1) == 1 &&
               result.status == SCREE_OVERLAP_WORKSPACE_FULL)
            if (scree_overlap_workspace_grow(f->workspace) != SCREE_OK) exit(EXIT_FAILURE);
        volume += (double)result.volume / num_orientations;
        *indentation += (double)result.indentation / num_orientations;
    }
    return volume;
}

/// Ratio of the volumetric force of the mesh, sqrt(V d), to that of the true sphere, both at depth d below the point of
/// the cube that the ball is over in `direction`.
static double force_ratio(fixture *f, scree_vec3 point, scree_vec3 direction, double depth)
{
    const scree_vec3 centre = scree_vec3_add_scaled(point, direction, (scree_real)(1 - depth));
    const scree_pose at_origin = {{0, 0, 0}, {1, 0, 0, 0}, 1};
    scree_sphere_contact contact[3];
    bool is_inside;
    SCREE_CHECK_INT(scree_sphere_mesh_contacts(&f->cube.view, scree_sphere_to_mesh(centre, 1, &at_origin),
                                               &f->cube.view.tree.root, 1, contact, 3, &is_inside),
                    1);
    SCREE_CHECK_CLOSE(contact[0].indentation, depth, 16 * SCREE_REAL_EPSILON);
    double indentation;
    const double volume = mesh_volume(f, centre, &indentation);
    return sqrt(volume * indentation / (M_PI * depth * depth * depth));
}

static void test_face_edge_and_vertex(void)
{
    fixture f = {.workspace = scree_overlap_workspace_create()};
    scree_mesh mesh;
    const double size[3] = {2, 2, 2};
    SCREE_CHECK_INT(scree_generate_box(&mesh, size), SCREE_OK);
    SCREE_CHECK_INT(scree_shape_create(&f.cube, &mesh, SCREE_FRAME_SOURCE), SCREE_OK);
    scree_mesh_destroy(&mesh);
    SCREE_CHECK_INT(scree_generate_sphere(&mesh, 1, 20480), SCREE_OK);
    SCREE_CHECK_INT(scree_shape_create(&f.ball, &mesh, SCREE_FRAME_SOURCE), SCREE_OK);
    scree_mesh_destroy(&mesh);

    const scree_real half = (scree_real)0.70710678118654752, third = (scree_real)0.57735026918962576;
    const scree_vec3 up = scree_vec3_make(0, 0, 1), between = scree_vec3_make(half, 0, half);
    const scree_vec3 diagonal = scree_vec3_make(third, third, third);
    const double depths[] = {0.005, 0.02, 0.05};
    for (int k = 0; k < 3; ++k)
    {
        const double d = depths[k];
        const double face = force_ratio(&f, scree_vec3_make((scree_real)0.1, (scree_real)0.2, 1), up, d);
        const double edge = force_ratio(&f, scree_vec3_make(1, (scree_real)0.1, 1), between, d);
        const double vertex = force_ratio(&f, scree_vec3_make(1, 1, 1), diagonal, d);
        printf("depth %.3f: volumetric over sphere contact, face %.3f, edge %.3f (%.3f), vertex %.4f (%.4f)\n", d, face,
               edge, sqrt(16 * sqrt(2) / (15 * M_PI)) * pow(d, 0.25), vertex, sqrt(sqrt(3) / (2 * M_PI) * d));
        // The mesh has the sphere's volume, so its facets lie up to 1.6e-4 outside and inside of the sphere (edge^2/12,
        // edge 0.038): so much of d, and of V in proportion to its power of d
        const double facets = 1.6e-4 / d;
        // cap of the ball: V = pi d^2 (1 - d/3), to first order in the facets' depth 3/2 of them in sqrt(V d)
        SCREE_CHECK_CLOSE(face, sqrt(1 - d / 3), 1.5 * facets);
        // wedge of 90 degrees, small d: V = 16/15 sqrt(2) d^(5/2); the rounding of the ball across it, of order sqrt(d)
        SCREE_CHECK_CLOSE(edge / (sqrt(16 * sqrt(2) / (15 * M_PI)) * pow(d, 0.25)), 1, 0.5 * sqrt(d) + 1.75 * facets);
        // corner of a cube, small d: V = sqrt(3)/2 d^3
        SCREE_CHECK_CLOSE(vertex / sqrt(sqrt(3) / (2 * M_PI) * d), 1, 0.5 * sqrt(d) + 2 * facets);
    }
    scree_overlap_workspace_destroy(f.workspace);
    scree_shape_destroy(&f.cube);
    scree_shape_destroy(&f.ball);
}

int main(void)
{
    SCREE_RUN(test_face_edge_and_vertex);
    return SCREE_TEST_END();
}
