// The volumetric law of one contact against Hertz, Coulomb and its own definition.
#include "forces/forces.h"
#include "harness.h"

static scree_force_law make_law(double friction, double damping)
{
    scree_force_law law = {0};
    law.effective_modulus = 1e7;
    law.effective_shear_modulus = 4e6;
    law.stiffness_factor = 0.7522527780636751;
    law.damping_ratio = damping;
    law.friction_coefficient = friction;
    law.has_tangential_spring = true;
    return law;
}

/// Two spheres of effective radius R at indentation d, in the limit of small d: V = pi R d^2.
static scree_contact_kinematics make_sphere_contact(double radius, double d)
{
    scree_contact_kinematics k = {0};
    k.volume = M_PI * radius * d * d;
    k.indentation = d;
    k.normal = scree_vec3_make(0, 0, 1);
    k.effective_mass = 0.01;
    k.time_step = 1e-6;
    return k;
}

static void test_sphere_volume_gives_hertz(void)
{
    const scree_force_law law = make_law(0.5, 0);
    for (double d = 1e-9; d < 1e-3; d *= 10)
    {
        const scree_contact_kinematics k = make_sphere_contact(0.01, d);
        scree_contact_force f;
        scree_volumetric_force(&law, &k, &f);
        const double hertz = 4.0 / 3.0 * 1e7 * sqrt(0.01) * d * sqrt(d);
        SCREE_CHECK_CLOSE(f.normal_force.z, hertz, 1e-14 * hertz);
        SCREE_CHECK_CLOSE(f.normal_stiffness, 2e7 * sqrt(0.01 * d), 1e-14 * 2e7 * sqrt(0.01 * d));
        SCREE_CHECK_CLOSE(f.tangential_stiffness, 8 * 4e6 * sqrt(0.01 * d), 1e-14 * 8 * 4e6 * sqrt(0.01 * d));
    }
}

static void test_damping_and_no_attraction(void)
{
    scree_force_law law = make_law(0.5, 0.3);
    scree_contact_kinematics k = make_sphere_contact(0.01, 1e-5);
    scree_contact_force still, closing, leaving;
    scree_volumetric_force(&law, &k, &still);
    k.relative_velocity.z = -0.1;
    scree_volumetric_force(&law, &k, &closing);
    const double expected = 2 * 0.3 * sqrt(0.01 * (double)still.normal_stiffness) * 0.1;
    SCREE_CHECK_CLOSE(closing.normal_force.z - still.normal_force.z, expected, 1e-14 * expected);
    k.relative_velocity.z = 10;
    scree_volumetric_force(&law, &k, &leaving);
    SCREE_CHECK(leaving.normal_force.z == 0);
    law.has_attraction = true;
    scree_volumetric_force(&law, &k, &leaving);
    SCREE_CHECK(leaving.normal_force.z < 0);
}

static void test_coulomb_limit_and_spring(void)
{
    const scree_force_law law = make_law(0.5, 0);
    scree_contact_kinematics k = make_sphere_contact(0.01, 1e-5);
    scree_contact_force f;
    k.relative_velocity.x = 1e-3; // small: sticks, F_t = -k_t dx
    scree_volumetric_force(&law, &k, &f);
    SCREE_CHECK(!f.is_slipping);
    SCREE_CHECK_CLOSE(f.tangential_force.x, -f.tangential_stiffness * 1e-9, 1e-14 * f.tangential_stiffness * 1e-9);
    for (int step = 0; step < 100000 && !f.is_slipping; ++step)
    {
        k.spring_force = f.spring_force;
        k.tangential_stiffness = f.tangential_stiffness;
        scree_volumetric_force(&law, &k, &f);
    }
    SCREE_CHECK(f.is_slipping);
    SCREE_CHECK_CLOSE(f.tangential_force.x, -0.5 * f.normal_force.z, 1e-14 * f.normal_force.z);
}

/// A spring that is carried round with its contact keeps its length and stays in the tangent plane.
static void test_history_turns_with_the_contact(void)
{
    uint64_t seed = 11;
    for (int k = 0; k < 1000; ++k)
    {
        const double phi = 2 * M_PI * scree_test_random(&seed), height = 2 * scree_test_random(&seed) - 1;
        const double radius = sqrt(1 - height * height);
        const scree_vec3 n = scree_vec3_make(radius * cos(phi), radius * sin(phi), height);
        const scree_vec3 force = scree_vec3_make(scree_test_random(&seed), scree_test_random(&seed), 3);
        const scree_vec3 turned = scree_rotate_into_plane(force, n);
        SCREE_CHECK_CLOSE(scree_vec3_dot(turned, n), 0, 1e-12);
        SCREE_CHECK_CLOSE(scree_vec3_length(turned), scree_vec3_length(force), 1e-12);
    }
    const scree_vec3 none = scree_rotate_into_plane(scree_vec3_make(0, 0, 2), scree_vec3_make(0, 0, 1));
    SCREE_CHECK(none.x == 0 && none.y == 0 && none.z == 0);
}

/// Unloading takes the spring back in proportion to the stiffness, loading leaves it.
static void test_unloading_rescales_the_spring(void)
{
    const scree_force_law law = make_law(10, 0);
    scree_contact_kinematics k = make_sphere_contact(0.01, 1e-5);
    scree_contact_force f;
    scree_volumetric_force(&law, &k, &f);
    const double k_t = (double)f.tangential_stiffness;
    k.spring_force = scree_vec3_make(1e-3, 0, 0);
    k.tangential_stiffness = 2 * k_t;
    scree_volumetric_force(&law, &k, &f);
    SCREE_CHECK_CLOSE(f.spring_force.x, 0.5e-3, 1e-17);
    k.tangential_stiffness = 0.5 * k_t;
    scree_volumetric_force(&law, &k, &f);
    SCREE_CHECK_CLOSE(f.spring_force.x, 1e-3, 1e-17);
}

/// Integrates the sphere law from impact to separation and compares e with what the damping ratio was made for.
static double measured_restitution(double restitution, bool has_attraction)
{
    scree_force_law law = make_law(0, scree_damping_ratio_from_restitution(restitution, has_attraction));
    law.has_attraction = has_attraction;
    const double mass = 0.01, speed = 1, dt = 2e-8;
    double d = 0, v = speed;
    scree_real force = 0;
    do {
        v -= 0.5 * dt * (double)force / mass;
        d += dt * v;
        if (d <= 0) break;
        scree_contact_kinematics k = make_sphere_contact(0.01, d);
        k.effective_mass = mass;
        k.relative_velocity.z = -v;
        scree_contact_force f;
        scree_volumetric_force(&law, &k, &f);
        force = f.normal_force.z;
        v -= 0.5 * dt * (double)force / mass;
        // without attraction nothing changes once the force has gone; with it the contact ends at d = 0
    } while (has_attraction || v > 0 || force > 0);
    return -v / speed;
}

static void test_restitution_of_both_conventions(void)
{
    const double values[] = {0.2, 0.4, 0.5, 0.66, 0.8, 0.9};
    for (int k = 0; k < 6; ++k)
    {
        SCREE_CHECK_CLOSE(measured_restitution(values[k], true), values[k], 1e-3);
        SCREE_CHECK_CLOSE(measured_restitution(values[k], false), values[k], 1e-3);
    }
    SCREE_CHECK_CLOSE(measured_restitution(1, false), 1, 1e-6);
}

static void test_mixing_rules(void)
{
    const scree_material_def a = {NULL, 1, 1e9, 0.25, NAN}, b = {NULL, 1, 3e9, 0.4, 2e9};
    scree_contact_law_def def = {0};
    char model[] = "volumetric_hertz_mindlin";
    def.model = model;
    def.damping_ratio = 0.1;
    def.tangential_spring = 1;
    def.stiffness_factor = 0.75;
    scree_force_law law;
    SCREE_CHECK_INT(scree_force_law_make(&def, &a, &b, &law), SCREE_OK);
    SCREE_CHECK_CLOSE(law.effective_modulus, 1 / (0.9375e-9 + 0.84 / 3e9), 1);
    SCREE_CHECK_CLOSE(law.effective_shear_modulus, 1 / (1.75 / 4e8 + 1.6 / 2e9), 1);
    def.shear_mixing = SCREE_SHEAR_BILOCK;
    SCREE_CHECK_INT(scree_force_law_make(&def, &a, &b, &law), SCREE_OK);
    SCREE_CHECK_CLOSE(law.effective_shear_modulus, 1 / (0.9375 / 4e8 + 0.84 / 2e9), 1);
    char unknown[] = "no_such_law";
    def.model = unknown;
    SCREE_CHECK_INT(scree_force_law_make(&def, &a, &b, &law), SCREE_NOT_FOUND);
}

int main(void)
{
    SCREE_RUN(test_sphere_volume_gives_hertz);
    SCREE_RUN(test_damping_and_no_attraction);
    SCREE_RUN(test_coulomb_limit_and_spring);
    SCREE_RUN(test_history_turns_with_the_contact);
    SCREE_RUN(test_unloading_rescales_the_spring);
    SCREE_RUN(test_restitution_of_both_conventions);
    SCREE_RUN(test_mixing_rules);
    return SCREE_TEST_END();
}
