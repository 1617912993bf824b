// Two sphere meshes pressed together: overlap and force converge to those of true spheres as the meshes are refined.
#include "contact/overlap.h"
#include "forces/contact_law_kernel.h"
#include "harness.h"
#include "polyhedra/generate.h"

static scree_quat random_orientation(uint64_t *seed)
{
    double q[4], squared;
    do {
        squared = 0;
        for (int k = 0; k < 4; ++k)
        {
            q[k] = 2 * scree_test_random(seed) - 1;
            squared += q[k] * q[k];
        }
    } while (squared > 1 || squared < 0.01);
    return scree_quat_normalize(scree_quat_make(q[0], q[1], q[2], q[3]));
}

/// Root mean square over orientations of the relative errors of volume and force against true spheres of radius 1.
static void measure(int32_t num_triangles, double indentation, double *volume_error, double *force_error)
{
    const int num_orientations = 200;
    scree_mesh mesh = {0};
    scree_shape shape = {0};
    SCREE_CHECK_INT(scree_generate_sphere(&mesh, 1, num_triangles), SCREE_OK);
    SCREE_CHECK_INT(scree_shape_create(&shape, &mesh, SCREE_FRAME_PRINCIPAL), SCREE_OK);
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    const double s = 2 - indentation;
    const double lens = M_PI * (2 - s) * (2 - s) * (s * s + 4 * s) / (12 * s);
    const double hertz = 4.0 / 3.0 * sqrt(0.5) * indentation * sqrt(indentation);

    scree_force_law law = {0};
    law.effective_modulus = 1;
    law.stiffness_factor = 0.7522527780636751;
    const scree_overlap_options options = {SCREE_OVERLAP_FILTERED, false, true};
    double sum_volume = 0, sum_force = 0;
    uint64_t seed = 5;
    for (int k = 0; k < num_orientations; ++k)
    {
        const scree_pose a = {{0, 0, 0}, random_orientation(&seed), 1};
        const scree_pose b = {{0, 0, (scree_real)s}, random_orientation(&seed), 1};
        scree_overlap_result result;
        while (scree_overlap_compute(&shape.view, &a, &shape.view, &b, &options, workspace, &result, 1) == 1 &&
               result.status == SCREE_OVERLAP_WORKSPACE_FULL)
            if (scree_overlap_workspace_grow(workspace) != SCREE_OK) break;
        scree_contact_force force = {0};
        if (result.status == SCREE_OVERLAP_TOUCHING)
        {
            scree_contact_kinematics kinematics = {0};
            kinematics.volume = result.volume;
            kinematics.indentation = result.indentation;
            kinematics.normal = scree_vec3_negate(result.normal);
            kinematics.effective_mass = 1;
            scree_contact_law(&law, &kinematics, &force);
            sum_volume += pow((double)result.volume / lens - 1, 2);
            sum_force += pow(-(double)force.normal_force.z / hertz - 1, 2);
        }
        else
        {
            sum_volume += 1;
            sum_force += 1;
        }
    }
    *volume_error = sqrt(sum_volume / num_orientations);
    *force_error = sqrt(sum_force / num_orientations);
    scree_overlap_workspace_destroy(workspace);
    scree_shape_destroy(&shape);
    scree_mesh_destroy(&mesh);
}

static void test_spheres_converge_to_hertz(void)
{
    const double indentation = 0.05;
    const int32_t sizes[] = {80, 320, 1280, 5120};
    double volume[4], force[4];
    for (int k = 0; k < 4; ++k)
    {
        measure(sizes[k], indentation, volume + k, force + k);
        printf("%5d triangles: volume error %.4f, force error %.4f\n", sizes[k], volume[k], force[k]);
    }
    // the sagitta of the facets falls by four with each refinement; once it is small against the indentation so does
    // the error of the volume
    SCREE_CHECK(volume[1] < 0.6 * volume[0] && volume[2] < 0.4 * volume[1] && volume[3] < 0.4 * volume[2]);
    // Hertz itself takes V = pi R* d^2; at d = 0.05 R the true lens is smaller by d/(6 R) to first order, the force by
    // half
    SCREE_CHECK(force[3] < 0.02);
    SCREE_CHECK(force[1] < force[0] && force[2] < force[1]);
}

int main(void)
{
    SCREE_RUN(test_spheres_converge_to_hertz);
    return SCREE_TEST_END();
}
