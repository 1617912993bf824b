// The automatic skin: repeated choices settle where the derivative of the cost vanishes, and go the right way.
#include "harness.h"

#include "dynamics/skin.h"

static const scree_skin_input bed = {.skin = 1e-4,
                                     .mean_radius = 1e-3,
                                     .moved = 1e-4,
                                     .num_steps = 100,
                                     .num_particles = 1000,
                                     .num_pairs = 8000,
                                     .has_meshes = true};

/// The same motion and packing seen after a choice: the distance between searches is the new skin.
static scree_skin_input next(scree_skin_input input)
{
    const double skin = scree_skin_of_least_cost(&input), around = input.mean_radius + skin;
    const double before = input.mean_radius + input.skin, way = input.moved / (double)input.num_steps;
    input.num_pairs *= around * around * around / (before * before * before);
    input.num_steps = (int64_t)(1000 * skin / way);
    input.moved = way * (double)input.num_steps;
    input.skin = skin;
    return input;
}

static void test_choices_settle_at_the_minimum(void)
{
    scree_skin_input input = bed;
    for (int k = 0; k < 40; ++k) input = next(input);
    // cost f(s) = (A + B (R + s)^3) u/s + C (R + s)^3 with the candidates of all sizes as in the bed; its derivative
    // times s^2 increases, so it has one root
    const double radius = bed.mean_radius, way = bed.moved / (double)bed.num_steps;
    const double pairs = bed.num_pairs / ((radius + bed.skin) * (radius + bed.skin) * (radius + bed.skin));
    const double a = 400 * bed.num_particles, b = 100 * pairs, c = 15 * pairs;
    double low = 1e-6, high = 2e-3;
    for (int k = 0; k < 60; ++k)
    {
        const double s = 0.5 * (low + high), r = radius + s;
        const double slope = -(a + b * r * r * r) * way + 3 * b * r * r * way * s + 3 * c * r * r * s * s;
        if (slope < 0) low = s;
        else high = s;
    }
    SCREE_CHECK_CLOSE(input.skin, low, 0.07 * low); // steps of a sixteenth
}

static void test_fast_bodies_get_wide_skins(void)
{
    scree_skin_input fast = bed, slow = bed, racing = bed;
    fast.num_steps = 3;
    slow.num_steps = 1000000000;
    racing.num_steps = 1;
    racing.moved = 100 * bed.mean_radius;
    SCREE_CHECK(scree_skin_of_least_cost(&fast) > 2 * scree_skin_of_least_cost(&bed));
    SCREE_CHECK(scree_skin_of_least_cost(&fast) < 2 * bed.mean_radius);
    // below some speed and above some other no skin is worth its candidates
    SCREE_CHECK_CLOSE(scree_skin_of_least_cost(&slow), 1e-3 * bed.mean_radius, 1e-18);
    SCREE_CHECK_CLOSE(scree_skin_of_least_cost(&racing), 1e-3 * bed.mean_radius, 1e-18);
}

int main(void)
{
    SCREE_RUN(test_choices_settle_at_the_minimum);
    SCREE_RUN(test_fast_bodies_get_wide_skins);
    return SCREE_TEST_END();
}
