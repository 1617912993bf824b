// Separate patches in a simulation: a U stands on its two legs, each a contact of its own with its own history.
#include "scene_run.h"

#include "io/run_folder.h"
#include "made_simulation.h"
#include "test_folder.h"

#include <omp.h>

/// A U of size 0.1 m falls on its legs from half a millimetre; gravity is tilted along the line between its
/// legs, too little for it to slip: tan = 0.2 < 0.5.
static void start(scene_run *run, bool separate_patches)
{
    const char *folder = getenv("SCREE_SOURCE_DIR");
    char text[2048];
    snprintf(text, sizeof text,
             "name: legs\ngravity: [1.9238, 0, -9.6192]\ntime: {end: 0.2, step: 2e-5}\n"
             "solver: {separate_patches: %s}\n"
             "materials:\n"
             "  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}\n"
             "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.5, restitution_coefficient: 0.3}]\n"
             "shapes:\n"
             "  - {name: u, source: file, file: %s/models/u_shape.obj}\n"
             "  - {name: plate, source: box, size: [4, 4, 0.2]}\n"
             "particles:\n"
             "  - name: one\n    shape: u\n    material: stone\n"
             "    bodies: [{size: 0.1, position: [0, 0, 0.056], orientation: [0.7071067811865476, -0.7071067811865476, "
             "0, 0]}]\n"
             "walls:\n  - {name: floor, shape: plate, material: stone, position: [0, 0, -0.1]}\n",
             separate_patches ? "true" : "false", folder != NULL ? folder : ".");
    scene_run_start(run, text);
}

/// Contact of the leg at arm.x > 0 or < 0, or -1.
static int64_t contact_of_leg(const scree_contact_list *contacts, bool is_right)
{
    for (int64_t c = 0; c < contacts->num_contacts; ++c)
        if ((contacts->arm[c].x > 0) == is_right) return c;
    return -1;
}

/// Forces and torques of the contacts against those of gravity, once the U is at rest: at a restitution of 0.3 more
/// than half of its swing is gone in every 0.01 s, which leaves 2^-18 = 4e-6 of it 0.18 s after the second leg has
/// landed.
static void check_equilibrium(const scree_simulation *s)
{
    const scree_contact_list *contacts = &s->contacts;
    const double weight = (double)s->particles.mass[0] * 9.6192, push = (double)s->particles.mass[0] * 1.9238;
    double along = 0, up = 0, turning = 0;
    for (int64_t c = 0; c < contacts->num_contacts; ++c)
    {
        const scree_vec3 force = scree_vec3_add(contacts->normal_force[c], contacts->tangential_force[c]);
        along += (double)force.x;
        up += (double)force.z;
        turning += (double)(scree_vec3_cross(contacts->arm[c], force).y + contacts->moment[c].y);
    }
    SCREE_CHECK_CLOSE(up, weight, 1e-5 * weight);
    SCREE_CHECK_CLOSE(along, -push, 1e-5 * weight);
    SCREE_CHECK_CLOSE(turning, 0, 1e-5 * weight * 0.1);
}

/// While it stands, each leg keeps its own spring: one still pulls the way in which it landed. A spring that went to
/// the other leg, or was lost, would jump by the difference of the two, in one step of thousands in which it hardly
/// changes.
static void test_each_leg_keeps_its_history(void)
{
    scene_run run;
    start(&run, true);
    scene_run_until(&run, 0.05);
    scree_vec3 before[2] = {{0, 0, 0}, {0, 0, 0}};
    double largest_change = 0;
    for (int step = 0; run.simulation != NULL && step < 7500; ++step)
    {
        SCREE_CHECK_INT(scree_simulation_step(run.simulation, &run.report), SCREE_OK);
        const scree_contact_list *contacts = &run.simulation->contacts;
        SCREE_CHECK_INT(contacts->num_contacts, 2);
        if (contacts->num_contacts != 2) break;
        SCREE_CHECK_INT(contacts->patch[0], 0);
        SCREE_CHECK_INT(contacts->patch[1], 1);
        for (int leg = 0; leg < 2; ++leg)
        {
            const int64_t c = contact_of_leg(contacts, leg == 1);
            SCREE_CHECK(c >= 0);
            if (c < 0) continue;
            const scree_vec3 spring = contacts->spring_force[c];
            const double change = (double)scree_vec3_length(scree_vec3_sub(spring, before[leg]));
            if (step > 0) largest_change = fmax(largest_change, change);
            before[leg] = spring;
            SCREE_CHECK(contacts->is_slipping[c] == 0);
            // gravity pushes towards +x
            if (leg == 1) SCREE_CHECK(spring.x < 0);
        }
    }
    if (run.simulation != NULL)
    {
        const double difference = fabs((double)(before[1].x - before[0].x));
        printf("springs %.6g and %.6g N, largest change in a step %.3g N\n", (double)before[0].x, (double)before[1].x,
               largest_change);
        SCREE_CHECK(difference > 0.1);
        SCREE_CHECK(largest_change < 0.05 * difference);
        check_equilibrium(run.simulation);
    }
    scene_run_end(&run);
}

/// Merged, both legs are one contact with the same sum of forces; rocking, which its one spring hardly resists, dies
/// out more slowly.
static void test_merged(void)
{
    scene_run run;
    start(&run, false);
    scene_run_until(&run, 1.0);
    if (run.simulation != NULL)
    {
        SCREE_CHECK_INT(run.simulation->contacts.num_contacts, 1);
        check_equilibrium(run.simulation);
    }
    scene_run_end(&run);
}

static uint64_t hash_with_threads(int num_threads)
{
    omp_set_num_threads(num_threads);
    scene_run run;
    start(&run, true);
    scene_run_until(&run, 0.06);
    const uint64_t hash = run.simulation != NULL ? scree_simulation_hash(run.simulation) : 0;
    scene_run_end(&run);
    omp_set_num_threads(1);
    return hash;
}

static void test_same_bits(void)
{
    const uint64_t one = hash_with_threads(1);
    SCREE_CHECK(one != 0);
    SCREE_CHECK(hash_with_threads(2) == one);
    SCREE_CHECK(hash_with_threads(7) == one);

    // stopped in the middle, while it swings on both legs, and gone on from the file
    char path[512];
    snprintf(path, sizeof path, "%s/checkpoint.h5", scree_test_folder());
    scene_run first, second;
    start(&first, true);
    scene_run_until(&first, 0.03);
    start(&second, true);
    if (first.simulation != NULL && second.simulation != NULL)
    {
        SCREE_CHECK_INT(first.simulation->contacts.num_contacts, 2);
        SCREE_CHECK_INT(scree_checkpoint_save(first.simulation, path, &first.report), SCREE_OK);
        SCREE_CHECK_INT(scree_checkpoint_load(second.simulation, path, &second.report), SCREE_OK);
        scene_run_until(&second, 0.06);
        SCREE_CHECK(scree_simulation_hash(second.simulation) == one);
    }
    scene_run_end(&first);
    scene_run_end(&second);
}

int main(void)
{
    SCREE_RUN(test_each_leg_keeps_its_history);
    SCREE_RUN(test_merged);
    SCREE_RUN(test_same_bits);
    return SCREE_TEST_END();
}
