/// What is known of pairs of meshes from one search of candidates to the next: packed directions, bounds that never
/// promise more than is left of them, and each pair finds what a comparison of all with all finds.
#include "contact/pair_memory_kernel.h"

#include <stdlib.h>

#include "harness.h"

static double uniform(uint64_t *state) { return (double)(scree_test_random_bits(state) >> 11) * 0x1p-53; }

static void check_direction(scree_vec3 direction)
{
    uint16_t packed[2];
    scree_pack_direction(direction, packed);
    SCREE_CHECK(packed[0] >= 1 && packed[1] >= 1);
    const scree_vec3 back = scree_unpack_direction(packed);
    const scree_vec3 a = scree_vec3_scale(direction, 1 / scree_vec3_length(direction));
    const scree_vec3 b = scree_vec3_scale(back, 1 / scree_vec3_length(back));
    // half a step of the square each way, 1.5e-5, is at most twice as far on the octahedron and thrice on the sphere
    SCREE_CHECK(scree_vec3_length(scree_vec3_sub(a, b)) < (scree_real)1.3e-4);
}

static void test_directions(void)
{
    uint64_t state = 5;
    for (int k = 0; k < 100000; ++k)
        check_direction(scree_vec3_make((scree_real)(uniform(&state) - 0.5), (scree_real)(uniform(&state) - 0.5),
                                        (scree_real)(uniform(&state) - 0.5)));
    // axes, planes between them, and signs of zero
    for (int k = 0; k < 125; ++k)
    {
        const scree_real values[5] = {-1, -(scree_real)0.0, 0, (scree_real)1e-30, 1};
        const scree_vec3 direction = {values[k % 5], values[k / 5 % 5], values[k / 25]};
        if (scree_vec3_length(direction) > (scree_real)0.5) check_direction(direction);
    }
    const uint16_t none[2] = {0, 0};
    SCREE_CHECK(scree_vec3_length(scree_unpack_direction(none)) == 0);
}

enum
{
    NUM_BODIES = 60,
    MAX_PAIRS = NUM_BODIES * NUM_BODIES
};

/// Pairs of which `share` are taken, in groups that follow each other in any order; every fourth one is no pair of
/// meshes.
static int64_t make_pairs(uint64_t *state, double share, scree_candidate_pair *pairs, int32_t *batch,
                          int64_t *num_in_batch)
{
    int64_t num = 0;
    *num_in_batch = 0;
    int32_t order[NUM_BODIES];
    for (int32_t k = 0; k < NUM_BODIES; ++k)
    {
        const int32_t other = (int32_t)(scree_test_random_bits(state) % (uint64_t)(k + 1));
        order[k] = order[other];
        order[other] = k;
    }
    for (int32_t k = 0; k < NUM_BODIES; ++k)
        for (int32_t i = order[k], j = i + 1; j < NUM_BODIES; ++j)
        {
            if (uniform(state) >= share) continue;
            if ((i + j) % 4 != 0) batch[(*num_in_batch)++] = (int32_t)num;
            pairs[num].i = i;
            pairs[num++].j = j;
        }
    return num;
}

static scree_candidate_pair pairs[MAX_PAIRS], new_pairs[MAX_PAIRS];
static int32_t batch[MAX_PAIRS], new_batch[MAX_PAIRS], kept_i[MAX_PAIRS], kept_j[MAX_PAIRS];
static scree_pair_memory memory[MAX_PAIRS], before[MAX_PAIRS], new_memory[MAX_PAIRS];

static void check_lists(uint64_t *state, double old_share, double new_share)
{
    int64_t num_old, num_new;
    make_pairs(state, old_share, pairs, batch, &num_old);
    make_pairs(state, new_share, new_pairs, new_batch, &num_new);
    scree_real travel[NUM_BODIES];
    int32_t shape[NUM_BODIES] = {0};
    scree_pose pose[NUM_BODIES];
    scree_shape_view view = {.bounding_radius = 1};
    for (int b = 0; b < NUM_BODIES; ++b)
    {
        travel[b] = (scree_real)(0.1 * uniform(state));
        pose[b] = (scree_pose){.scale = 1};
    }
    const scree_bodies bodies = {
        .shapes = &view, .shape = shape, .pose = pose, .travel = travel, .num_bodies = NUM_BODIES, .num_steps = 20};
    for (int64_t m = 0; m < num_old; ++m)
    {
        const double kind = uniform(state);
        memory[m] = (scree_pair_memory){{(uint16_t)(m + 1), (uint16_t)(2 * m)}, 0};
        memory[m].apart_until = kind < 0.2 ? SCREE_PAIR_TOUCHED : kind < 0.4 ? 0 : (float)(0.3 * uniform(state));
    }
    memcpy(before, memory, sizeof before);

    const scree_pair_keep_args keep = {bodies, pairs, batch, memory, kept_i, kept_j};
    for (int64_t m = num_old - 1; m >= 0; --m) scree_pair_keep_at(keep, m);
    int32_t begin[NUM_BODIES] = {0}, end[NUM_BODIES] = {0};
    const scree_pair_groups kept = {kept_i, kept_j, NULL, 1, num_old, begin, end};
    for (int64_t k = num_old - 1; k >= 0; --k) scree_group_bounds_at(kept, k);
    const scree_pair_carry_args carry = {new_pairs, new_batch, new_memory, kept, memory};
    for (int64_t m = num_new - 1; m >= 0; --m) scree_pair_carry_at(carry, m);

    for (int64_t m = 0; m < num_new; ++m)
    {
        const scree_candidate_pair pair = new_pairs[new_batch[m]];
        const scree_pair_memory *old = NULL;
        for (int64_t k = 0; k < num_old; ++k)
            if (pairs[batch[k]].i == pair.i && pairs[batch[k]].j == pair.j) old = before + k;
        const uint16_t *direction = new_memory[m].direction;
        const double until = (double)new_memory[m].apart_until;
        SCREE_CHECK(direction[0] == (old ? old->direction[0] : 0) && direction[1] == (old ? old->direction[1] : 0));
        if (old == NULL || old->apart_until <= 0) SCREE_CHECK(until == (old ? (double)old->apart_until : 0));
        if (old == NULL || old->apart_until <= 0) continue;
        const double left = (double)old->apart_until - (double)travel[pair.i] - (double)travel[pair.j];
        // never more than is left, and less by no more than two bodies of size 1.1 may lack in 20 steps, 4 units of
        // single precision and its rounding
        const double lost = 5 * (double)FLT_EPSILON * fabs(left) + 2 * 16 * 20 * 1.1 * (double)SCREE_REAL_EPSILON;
        SCREE_CHECK(until <= fmax(left, 0) && until >= left - lost && until >= 0);
    }
}

static void test_carried_to_the_same_pairs(void)
{
    uint64_t state = 11;
    for (int k = 0; k < 20; ++k) check_lists(&state, uniform(&state), uniform(&state));
    check_lists(&state, 1, 1);
    check_lists(&state, 0, 1);
    check_lists(&state, 1, 0);
    check_lists(&state, 1, 0.002);
}

int main(void)
{
    SCREE_RUN(test_directions);
    SCREE_RUN(test_carried_to_the_same_pairs);
    return SCREE_TEST_END();
}
