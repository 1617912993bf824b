// The force laws of one contact against Hertz, Coulomb, closed forms of impacts and their own definitions.
#include "forces/forces.h"
#include "harness.h"

static scree_force_law make_law(double friction, double damping)
{
    scree_force_law law = {0};
    law.effective_modulus = 1e7;
    law.tangential_over_normal = 4 * 4e6 / 1e7;
    law.stiffness_factor = 0.7522527780636751;
    law.damping_ratio = law.tangential_damping_ratio = damping;
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
        scree_contact_law(&law, &k, &f);
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
    scree_contact_law(&law, &k, &still);
    k.relative_velocity.z = -0.1;
    scree_contact_law(&law, &k, &closing);
    const double expected = 2 * 0.3 * sqrt(0.01 * (double)still.normal_stiffness) * 0.1;
    SCREE_CHECK_CLOSE(closing.normal_force.z - still.normal_force.z, expected, 1e-14 * expected);
    k.relative_velocity.z = 10;
    scree_contact_law(&law, &k, &leaving);
    SCREE_CHECK(leaving.normal_force.z == 0);
    law.has_attraction = true;
    scree_contact_law(&law, &k, &leaving);
    SCREE_CHECK(leaving.normal_force.z < 0);
}

static void test_coulomb_limit_and_spring(void)
{
    const scree_force_law law = make_law(0.5, 0);
    scree_contact_kinematics k = make_sphere_contact(0.01, 1e-5);
    scree_contact_force f;
    k.relative_velocity.x = 1e-3; // small: sticks, F_t = -k_t dx
    scree_contact_law(&law, &k, &f);
    SCREE_CHECK(!f.is_slipping);
    SCREE_CHECK_CLOSE(f.tangential_force.x, -f.tangential_stiffness * 1e-9, 1e-14 * f.tangential_stiffness * 1e-9);
    for (int step = 0; step < 100000 && !f.is_slipping; ++step)
    {
        k.spring_force = f.spring_force;
        k.tangential_stiffness = f.tangential_stiffness;
        scree_contact_law(&law, &k, &f);
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
    scree_contact_law(&law, &k, &f);
    const double k_t = (double)f.tangential_stiffness;
    k.spring_force = scree_vec3_make(1e-3, 0, 0);
    k.tangential_stiffness = 2 * k_t;
    scree_contact_law(&law, &k, &f);
    SCREE_CHECK_CLOSE(f.spring_force.x, 0.5e-3, 1e-17);
    k.tangential_stiffness = 0.5 * k_t;
    scree_contact_law(&law, &k, &f);
    SCREE_CHECK_CLOSE(f.spring_force.x, 1e-3, 1e-17);
}

/// Integrates the impact of a sphere from touch to separation in steps of dt.
static double measured_restitution(const scree_force_law *law, double mass, double dt)
{
    const double speed = 1;
    double d = 0, v = speed;
    scree_real force = 0;
    do {
        v -= 0.5 * dt * (double)force / mass;
        d += dt * v;
        if (d <= 0) break;
        scree_contact_kinematics k = make_sphere_contact(0.01, d);
        k.area = 2 * M_PI * 0.01 * d;
        k.effective_radius = 0.01;
        k.effective_mass = mass;
        k.relative_velocity.z = -v;
        scree_contact_force f;
        scree_contact_law(law, &k, &f);
        force = f.normal_force.z;
        v -= 0.5 * dt * (double)force / mass;
        // without attraction nothing changes once the force has gone; with it the contact ends at d = 0
    } while (law->has_attraction || v > 0 || force > 0);
    return -v / speed;
}

/// The closed form of the damping ratio against integrated impacts, of all models and both ends of a contact. Damping
/// starts with a jump of the force, 2 g w v, w = pi over the contact time; to miss it by half a step at either end
/// changes e by w dt at most (g < 1). Hence the same bound at two steps: the rest is of first order.
static void check_restitution(int32_t model, bool has_attraction)
{
    const double values[] = {0.2, 0.4, 0.5, 0.66, 0.8, 0.9, 0.98, 1}, mass = 0.01;
    const double largest = pow(15 * mass / (16 * 1e7 * sqrt(0.01)), 0.4);
    const double frequency = model == SCREE_MODEL_LINEAR_SPRING ? sqrt(1e4 / mass) : M_PI / (2.94328 * largest);
    for (int k = 0; k < 8; ++k)
    {
        const double exponent = scree_force_models()[model].exponent;
        scree_force_law law = make_law(0, scree_damping_ratio_from_restitution(values[k], exponent, has_attraction));
        law.model = model;
        law.normal_stiffness = 1e4;
        if (model == SCREE_MODEL_ENERGY_CONSERVING) law.stiffness_factor = (scree_real)(8.0 / 15.0 * pow(M_PI, -1.25));
        law.exponent_quarters = 1;
        law.has_attraction = has_attraction;
        for (double dt = 4e-7; dt > 0.5e-7; dt /= 4)
            SCREE_CHECK_CLOSE(measured_restitution(&law, mass, dt), values[k], frequency * dt);
    }
}

static void test_restitution_of_both_conventions(void)
{
    for (int32_t model = 0; model < SCREE_NUM_FORCE_MODELS; ++model)
    {
        check_restitution(model, false);
        check_restitution(model, true);
    }
}

/// A definition as the scene reader makes it, in damping and friction.
static scree_contact_law_def make_definition(char *model)
{
    scree_contact_law_def def = {0};
    def.model = model;
    def.damping_ratio = 0.1;
    def.tangential_damping_ratio = def.normal_stiffness = def.tangential_stiffness = def.energy_exponent = NAN;
    def.tangential_spring = 1;
    def.stiffness_factor = 0.75;
    return def;
}

static void test_mixing_rules(void)
{
    const scree_material_def a = {NULL, 1, 1e9, 0.25, NAN}, b = {NULL, 1, 3e9, 0.4, 2e9};
    char hertz[] = "hertz_mindlin", spring[] = "linear_spring", unknown[] = "no_such_law";
    scree_contact_law_def def = make_definition(hertz);
    scree_force_law law;
    SCREE_CHECK_INT(scree_force_law_make(&def, &a, &b, &law), SCREE_OK);
    const double modulus = 1 / (0.9375e-9 + 0.84 / 3e9);
    const double mindlin = 1 / (1.75 / 4e8 + 1.6 / 2e9), bilock = 1 / (0.9375 / 4e8 + 0.84 / 2e9);
    SCREE_CHECK_CLOSE(law.effective_modulus, modulus, 1e-15 * modulus);
    SCREE_CHECK_CLOSE(law.tangential_over_normal, 4 * mindlin / modulus, 1e-15);
    SCREE_CHECK(law.tangential_damping_ratio == law.damping_ratio && law.stiffness_factor == (scree_real)0.75);
    def.stiffness_factor = NAN;
    SCREE_CHECK_INT(scree_force_law_make(&def, &a, &b, &law), SCREE_OK);
    SCREE_CHECK_CLOSE(law.stiffness_factor, 4.0 / (3.0 * sqrt(M_PI)), 2e-16);
    def.shear_mixing = SCREE_SHEAR_BILOCK;
    def.tangential_damping_ratio = 0.25;
    SCREE_CHECK_INT(scree_force_law_make(&def, &a, &b, &law), SCREE_OK);
    SCREE_CHECK_CLOSE(law.tangential_over_normal, 4 * bilock / modulus, 2e-15);
    SCREE_CHECK(law.tangential_damping_ratio == (scree_real)0.25);

    def = make_definition(spring);
    def.normal_stiffness = 2e5;
    SCREE_CHECK_INT(scree_force_law_make(&def, &a, &b, &law), SCREE_OK);
    SCREE_CHECK_CLOSE(law.tangential_over_normal, 4 * mindlin / modulus, 1e-15);
    def.tangential_stiffness = 5e4;
    SCREE_CHECK_INT(scree_force_law_make(&def, &a, &b, &law), SCREE_OK);
    SCREE_CHECK(law.normal_stiffness == 2e5 && law.tangential_over_normal == 0.25);
    char conserving[] = "energy_conserving";
    def = make_definition(conserving);
    def.stiffness_factor = NAN;
    SCREE_CHECK_INT(scree_force_law_make(&def, &a, &b, &law), SCREE_OK);
    SCREE_CHECK(law.exponent_quarters == 1);
    SCREE_CHECK_CLOSE(law.stiffness_factor, 8.0 / 15.0 * pow(M_PI, -1.25), 1e-16);
    def.energy_exponent = 1.75;
    SCREE_CHECK_INT(scree_force_law_make(&def, &a, &b, &law), SCREE_OK);
    SCREE_CHECK(law.exponent_quarters == 3);
    def = make_definition(unknown);
    SCREE_CHECK_INT(scree_force_law_make(&def, &a, &b, &law), SCREE_NOT_FOUND);
}

/// F = k d, energy k d^2/2, k_t as given, whatever the volume.
static void test_linear_spring(void)
{
    scree_force_law law = make_law(0.5, 0);
    law.model = SCREE_MODEL_LINEAR_SPRING;
    law.normal_stiffness = 3e4;
    law.tangential_over_normal = 0.5;
    scree_contact_kinematics k = make_sphere_contact(0.01, 2e-5);
    scree_contact_force f;
    for (int pass = 0; pass < 2; ++pass)
    {
        scree_contact_law(&law, &k, &f);
        SCREE_CHECK_CLOSE(f.normal_force.z, 0.6, 1e-15);
        SCREE_CHECK_CLOSE(f.elastic_energy, 0.5 * 0.6 * 2e-5, 1e-20);
        SCREE_CHECK(f.normal_stiffness == 3e4 && f.tangential_stiffness == 1.5e4);
        k.volume *= 7;
    }
}

/// Between spheres, |S| = 2 pi R d: with p = 5/4 Hertz to rounding, with p = 1 a spring of 2 pi R c E*; the force is
/// dw/dd.
static void test_energy_conserving_between_spheres(void)
{
    scree_force_law law = make_law(0.5, 0);
    law.model = SCREE_MODEL_ENERGY_CONSERVING;
    law.stiffness_factor = (scree_real)(8.0 / 15.0 * pow(M_PI, -1.25));
    for (law.exponent_quarters = 0; law.exponent_quarters <= 4; ++law.exponent_quarters)
    {
        const double d = 1e-5, h = 1e-8;
        double energy[3];
        scree_contact_force f = {0};
        for (int step = -1; step <= 1; ++step)
        {
            scree_contact_kinematics k = make_sphere_contact(0.01, d + step * h);
            k.area = 2 * M_PI * 0.01 * k.indentation;
            k.effective_radius = 0.01;
            if (step == 0) scree_contact_law(&law, &k, &f);
            scree_contact_force moved;
            scree_contact_law(&law, &k, &moved);
            energy[step + 1] = moved.elastic_energy;
        }
        // central difference of w ~ d^(2p): off by (h/d)^2 at most, and by the rounding of w over h/d
        SCREE_CHECK_CLOSE(f.elastic_force, (energy[2] - energy[0]) / (2 * h), 2e-6 * f.elastic_force);
        SCREE_CHECK_CLOSE(f.normal_stiffness, (1 + 0.5 * law.exponent_quarters) * f.elastic_force / d,
                          1e-14 * f.normal_stiffness);
        if (law.exponent_quarters == 0)
            SCREE_CHECK_CLOSE(f.elastic_force, 2 * M_PI * 0.01 * law.stiffness_factor * 1e7 * d,
                              1e-14 * f.elastic_force);
        if (law.exponent_quarters == 1)
            SCREE_CHECK_CLOSE(f.elastic_force, 4.0 / 3.0 * 1e7 * 0.1 * pow(d, 1.5), 1e-14 * f.elastic_force);
    }
}

/// The damping acts along the gradient of the volume: turning that leaves V alone is not damped, turning that closes
/// is.
static void test_lever_of_the_normal_force(void)
{
    scree_force_law law = make_law(0, 0.3);
    law.model = SCREE_MODEL_ENERGY_CONSERVING;
    law.stiffness_factor = (scree_real)0.1275;
    law.exponent_quarters = 1;
    scree_contact_kinematics k = make_sphere_contact(0.01, 1e-5);
    k.area = 2 * M_PI * 0.01 * 1e-5;
    k.effective_radius = 0.01;
    k.lever = scree_vec3_make((scree_real)1e-3, (scree_real)-2e-3, (scree_real)5e-4);
    scree_contact_force still, closing;
    scree_contact_law(&law, &k, &still);
    SCREE_CHECK_CLOSE(still.moment.x, -1e-3 * still.normal_force.z, 1e-16 * still.normal_force.z);
    k.relative_rotation = scree_vec3_make(2, 1, 0); // across the lever
    scree_contact_law(&law, &k, &closing);
    SCREE_CHECK(closing.normal_force.z == still.normal_force.z);
    k.relative_rotation = scree_vec3_make(0, 0, 100); // dV/dt/|S| = 0.05 m/s
    scree_contact_law(&law, &k, &closing);
    const double damping = 2 * 0.3 * sqrt(0.01 * (double)still.normal_stiffness) * 0.05;
    SCREE_CHECK_CLOSE(closing.normal_force.z - still.normal_force.z, damping, 1e-13 * damping);
    SCREE_CHECK_CLOSE(closing.moment.z, -5e-4 * closing.normal_force.z, 1e-16 * closing.normal_force.z);
}

/// A contact of spheres that roll over each other about y.
static scree_contact_kinematics make_rolling_contact(scree_real rate)
{
    scree_contact_kinematics k = make_sphere_contact(0.01, 1e-5);
    k.effective_radius = (scree_real)0.01;
    k.rolling_inertia = (scree_real)1e-6;
    k.relative_rotation = scree_vec3_make(0, rate, 3); // the twist about z does not roll
    return k;
}

static void test_constant_rolling_resistance(void)
{
    scree_force_law law = make_law(0.5, 0);
    law.rolling = SCREE_ROLLING_CONSTANT;
    law.rolling_friction_coefficient = (scree_real)0.1;
    const double rates[] = {-5, -1e-6, 1e-6, 5};
    for (int n = 0; n < 4; ++n)
    {
        const scree_contact_kinematics k = make_rolling_contact(rates[n]);
        scree_contact_force f;
        scree_contact_law(&law, &k, &f);
        const double limit = 0.1 * 0.01 * (double)f.normal_force.z;
        SCREE_CHECK_CLOSE(f.moment.y, rates[n] > 0 ? -limit : limit, 1e-15 * limit);
        SCREE_CHECK(f.moment.x == 0 && f.moment.z == 0 && f.is_turning);
    }
    const scree_contact_kinematics still = make_rolling_contact(0);
    scree_contact_force f;
    scree_contact_law(&law, &still, &f);
    SCREE_CHECK(f.moment.y == 0);
}

/// The spring grows by k_r w dt, is damped below its limit and ends there, with the energy M^2/(2 k_r).
static void test_rolling_spring(void)
{
    scree_force_law law = make_law(0, 0);
    law.rolling = SCREE_ROLLING_SPRING;
    law.rolling_friction_coefficient = (scree_real)0.1;
    law.rolling_damping_ratio = (scree_real)0.3;
    scree_contact_kinematics k = make_rolling_contact(2);
    scree_contact_force f;
    scree_contact_law(&law, &k, &f);
    const double stiffness = 2.25 * (double)f.normal_stiffness * 1e-6, limit = 1e-3 * (double)f.normal_force.z;
    const double first = -stiffness * 2e-6;
    SCREE_CHECK_CLOSE(f.rolling_moment.y, first, 1e-14 * fabs(first));
    const double damped = -2 * 0.3 * sqrt(1e-6 * stiffness) * 2;
    SCREE_CHECK_CLOSE(f.moment.y, first + damped, 1e-14 * fabs(damped));
    SCREE_CHECK(!f.is_turning);
    SCREE_CHECK_CLOSE(f.spring_energy, first * first / (2 * stiffness), 1e-13 * f.spring_energy);

    const int steps = (int)(limit / -first);
    for (int step = 1; step < steps + 2; ++step)
    {
        SCREE_CHECK_CLOSE(f.rolling_moment.y, step * first, 1e-10 * limit);
        k.rolling_moment = f.rolling_moment;
        k.tangential_stiffness = f.tangential_stiffness;
        scree_contact_law(&law, &k, &f);
        if (f.is_turning) break;
    }
    SCREE_CHECK(f.is_turning);
    SCREE_CHECK_CLOSE(f.moment.y, -limit, 1e-14 * limit);
    SCREE_CHECK(f.rolling_moment.y == f.moment.y);

    // half the stiffness: the spring has gone back to half before it moves on
    k.rolling_moment = scree_vec3_make(0, (scree_real)-1e-9, 0);
    k.tangential_stiffness = 2 * f.tangential_stiffness;
    scree_contact_law(&law, &k, &f);
    SCREE_CHECK_CLOSE(f.rolling_moment.y, -0.5e-9 + first, 1e-14 * fabs(first));
}

/// Whatever a contact of constant or changing depth and width goes through, in no step do its tangential force and its
/// moments give more energy than their springs let go: the law is passive.
static void check_that_nothing_gives_energy(scree_rolling_resistance_kind rolling, uint64_t *seed)
{
    scree_force_law law = make_law(scree_test_random(seed), 0.05 + scree_test_random(seed));
    law.has_moments = true;
    law.rolling = rolling;
    law.rolling_friction_coefficient = (scree_real)0.2;
    law.rolling_damping_ratio = (scree_real)0.3;
    scree_contact_kinematics k = make_sphere_contact(0.01, 1e-5);
    k.effective_radius = (scree_real)0.01;
    k.rolling_inertia = (scree_real)1e-6;
    k.time_step = (scree_real)2e-5;
    double stored = 0, turned_over = 0;
    const double speed = pow(10, 4 * scree_test_random(seed) - 4);
    for (int step = 0; step < 300; ++step)
    {
        const double d = 1e-5 * (1 + 0.9 * sin(0.1 * step));
        k.volume = (scree_real)(M_PI * 0.01 * d * d);
        k.indentation = (scree_real)d;
        k.radius = (scree_real)(1e-3 * (0.2 + scree_test_random(seed)));
        k.relative_velocity = scree_vec3_make((scree_real)(speed * (scree_test_random(seed) - 0.5)),
                                              (scree_real)(speed * (scree_test_random(seed) - 0.5)), 0);
        k.relative_rotation = scree_vec3_make((scree_real)(100 * speed * (scree_test_random(seed) - 0.5)), 0,
                                              (scree_real)(100 * speed * (scree_test_random(seed) - 0.5)));
        scree_contact_force f;
        scree_contact_law(&law, &k, &f);
        const double put_in = -(double)k.time_step * (double)(scree_vec3_dot(f.tangential_force, k.relative_velocity) +
                                                              scree_vec3_dot(f.moment, k.relative_rotation));
        turned_over += fabs(put_in) + (double)f.spring_energy;
        SCREE_CHECK(put_in - ((double)f.spring_energy - stored) >= -1e-13 * turned_over);
        stored = (double)f.spring_energy;
        k.spring_force = f.spring_force;
        k.torsion = f.torsion;
        k.rolling_moment = f.rolling_moment;
        k.tangential_stiffness = f.tangential_stiffness;
        k.radius_before = k.radius;
    }
}

static void test_friction_gives_no_energy(void)
{
    uint64_t seed = 5;
    for (int n = 0; n < 200; ++n)
        check_that_nothing_gives_energy(n % 3 == 0   ? SCREE_ROLLING_NONE
                                        : n % 3 == 1 ? SCREE_ROLLING_CONSTANT
                                                     : SCREE_ROLLING_SPRING,
                                        &seed);
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
    SCREE_RUN(test_linear_spring);
    SCREE_RUN(test_energy_conserving_between_spheres);
    SCREE_RUN(test_lever_of_the_normal_force);
    SCREE_RUN(test_constant_rolling_resistance);
    SCREE_RUN(test_rolling_spring);
    SCREE_RUN(test_friction_gives_no_energy);
    return SCREE_TEST_END();
}
