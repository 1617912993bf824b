// Contact list and history: growth keeps what is there, history follows pairs through new neighbour lists.
#include "contact/history.h"
#include "harness.h"

#include <stdlib.h>
#include <string.h>

static void fill(scree_contact_list *list, const scree_candidate_pair *bodies, int64_t num)
{
    SCREE_CHECK_INT(scree_contact_list_reserve(list, num, num), SCREE_OK);
    list->num_contacts = num;
    for (int64_t c = 0; c < num; ++c)
    {
        list->bodies[c] = bodies[c];
        list->patch[c] = 0;
        list->volume[c] = 1;
        list->indentation[c] = 1;
        list->normal[c] = scree_vec3_make(0, 0, 1);
        list->arm[c] = scree_vec3_make(0, 0, 0);
        list->first_of_pair[c] = (int32_t)c;
    }
    list->first_of_pair[num] = (int32_t)num;
}

static void test_growth_keeps_contents(void)
{
    scree_contact_list list = {0};
    const scree_candidate_pair bodies[] = {{0, 1}, {0, 2}};
    fill(&list, bodies, 2);
    SCREE_CHECK_INT(scree_contact_list_reserve(&list, 100000, 50000), SCREE_OK);
    SCREE_CHECK(list.bodies[1].i == 0 && list.bodies[1].j == 2 && list.first_of_pair[2] == 2);
    scree_contact_list_destroy(&list);
}

/// Over several steps with more and fewer contacts: each finds the history of the one before, and room for itself.
static void test_history_is_what_the_last_step_had(void)
{
    enum
    {
        MAX = 1000
    };
    static const int64_t nums[] = {3, 500, 2, MAX, 0, 7};
    scree_contact_list present = {.has_no_levers = true, .has_no_rolling = true}, history = {.is_history = true};
    scree_contact_list_share_uses(&history, &present);
    static scree_candidate_pair bodies[MAX];
    for (int32_t c = 0; c < MAX; ++c) bodies[c] = (scree_candidate_pair){c, c + 1};
    for (int32_t step = 0; step < 6; ++step)
    {
        scree_contact_list_pass_on(&present, &history);
        SCREE_CHECK_INT(history.num_contacts, step > 0 ? nums[step - 1] : 0);
        fill(&present, bodies, nums[step]);
        for (int64_t c = 0; c < history.num_contacts; ++c)
            SCREE_CHECK(history.spring_energy[c] == (scree_real)(100 * step - 100) + (scree_real)c &&
                        history.bodies[c].j == c + 1 && history.first_of_pair[c] == c);
        for (int64_t c = 0; c < present.num_contacts; ++c)
        {
            present.spring_energy[c] = (scree_real)(100 * step) + (scree_real)c;
            SCREE_CHECK(scree_vec3_length(present.rolling_moment[c]) == 0 &&
                        scree_vec3_length(present.area_vector[c]) == 0);
        }
    }
    SCREE_CHECK(history.normal_force == NULL && history.volume == NULL && present.max_contacts >= MAX);
    // of a contact once more what goes on to the next step: ids, patch, radius, arm, spring, stiffness, torsion,
    // energies
    const int64_t once = 8 + 4 + 2 + (int64_t)sizeof(scree_real) * (10 + 18),
                  carried = 8 + 4 + (int64_t)sizeof(scree_real) * (5 + 6);
    SCREE_CHECK_INT(scree_contact_list_bytes(&present), once + carried);
    scree_contact_list_destroy(&present);
    scree_contact_list_destroy(&history);
}

static void test_validate_finds_faults(void)
{
    scree_contact_list list = {0};
    const scree_candidate_pair bodies[] = {{0, 1}, {0, 2}, {1, 2}};
    fill(&list, bodies, 3);
    SCREE_CHECK(scree_contact_list_validate(&list, NULL, NULL));
    list.bodies[1].j = 1;
    SCREE_CHECK(!scree_contact_list_validate(&list, NULL, NULL));
    list.bodies[1].j = 2;
    list.volume[2] = 0;
    SCREE_CHECK(!scree_contact_list_validate(&list, NULL, NULL));
    list.volume[2] = NAN;
    SCREE_CHECK(!scree_contact_list_validate(&list, NULL, NULL));
    list.volume[2] = 1;
    list.normal[0].z = 1.001;
    SCREE_CHECK(!scree_contact_list_validate(&list, NULL, NULL));
    list.normal[0].z = 1;
    list.bodies[0].i = 7;
    SCREE_CHECK(!scree_contact_list_validate(&list, NULL, NULL));
    scree_contact_list_destroy(&list);
}

/// How the contacts of `now` continue those of `old`; `bounds` (2, num_bodies): room, zeroed, if the pairs have
/// changed.
static scree_history_match_args match_of(const scree_contact_list *now, const scree_contact_list *old,
                                         const scree_candidate_pair *pairs, int32_t *bounds, int64_t num_bodies,
                                         int32_t *old_of_contact, uint8_t *is_continued)
{
    scree_history_match_args args = {pairs,       now->first_of_pair, bounds == NULL ? old->first_of_pair : NULL,
                                     {0},         now->patch,         old->patch,
                                     now->arm,    old->arm,           old_of_contact,
                                     is_continued};
    if (bounds == NULL || old->num_contacts == 0) return args;
    args.old_groups =
        (scree_pair_groups){&old->bodies->i, &old->bodies->j, NULL, 2, old->num_contacts, bounds, bounds + num_bodies};
    scree_group_bounds_launch(args.old_groups, old->num_contacts);
    return args;
}

/// Where no pair has several contacts, points and patches are not carried, and history follows the pairs all the same.
static void test_one_contact_per_pair(void)
{
    scree_contact_list present = {.is_one_per_pair = true}, history = {.is_history = true}, usual = {0};
    scree_contact_list_share_uses(&history, &present);
    const scree_candidate_pair bodies[] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}};
    const int32_t first[2][5] = {{0, 1, 1, 2, 3}, {0, 1, 2, 2, 3}}, expected[3] = {0, -1, 2};
    for (int step = 0; step < 2; ++step)
    {
        scree_contact_list_pass_on(&present, &history);
        fill(&present, bodies, 4);
        present.num_contacts = 3;
        memcpy(present.first_of_pair, first[step], sizeof first[step]);
    }
    SCREE_CHECK(history.patch == NULL && history.arm == NULL && history.spring_force != NULL && present.arm != NULL);
    int32_t old_of_contact[3];
    uint8_t is_continued[3] = {0};
    const scree_history_match_args args = match_of(&present, &history, bodies, NULL, 0, old_of_contact, is_continued);
    scree_history_match_launch(args, 4);
    for (int c = 0; c < 3; ++c) SCREE_CHECK_INT(old_of_contact[c], expected[c]);
    SCREE_CHECK(is_continued[0] == 1 && is_continued[1] == 0 && is_continued[2] == 1);
    SCREE_CHECK_INT(scree_contact_list_bytes(&usual) - scree_contact_list_bytes(&present),
                    (int64_t)(sizeof(int32_t) + sizeof(scree_vec3)));
    scree_contact_list_destroy(&present);
    scree_contact_list_destroy(&history);
}

/// The block of a list is lent to a search and taken anew from the same memory; what goes on to the next step stays.
static void test_block_is_lent(void)
{
    scree_contact_list list = {0};
    scree_scratch scratch = {0};
    const scree_candidate_pair bodies[] = {{0, 1}, {0, 2}};
    fill(&list, bodies, 2);
    list.spring_energy[1] = 7;
    scree_contact_list_lend(&list, &scratch);
    SCREE_CHECK(list.normal == NULL && list.normal_force == NULL && list.max_contacts == 0);
    SCREE_CHECK_INT(scree_scratch_begin(&scratch, 0), SCREE_OK);
    char *search = scree_scratch_take(&scratch, 100000, 1);
    memset(search, 1, 100000);
    SCREE_CHECK_INT(scree_contact_list_reserve(&list, 2, 2), SCREE_OK);
    SCREE_CHECK((char *)list.normal_force == search && list.max_contacts >= 2 && scratch.num_blocks == 1);
    SCREE_CHECK(list.spring_energy[1] == 7 && list.bodies[1].j == 2 && list.first_of_pair[2] == 2);
    // overlaps are kept where the forces will be
    const int64_t num_spare = list.max_contacts * (int64_t)scree_contact_list_spare_bytes(&list);
    SCREE_CHECK((char *)scree_contact_list_spare(&list) + num_spare <= (char *)list.elastic_force &&
                (char *)list.elastic_force < (char *)list.normal &&
                list.normal + 2 <= (scree_vec3 *)(void *)(search + 100000));
    scree_contact_list_destroy(&list);
    scree_scratch_destroy(&scratch);
}

/// Random old and new lists, each in an order of its own: the history found is the one that a search through all finds.
static void test_history_follows_pairs(void)
{
    enum
    {
        MAX = 400,
        BODIES = 20
    };
    uint64_t seed = 3;
    for (int round = 0; round < 200; ++round)
    {
        scree_contact_list lists[2] = {{0}, {0}};
        for (int k = 0; k < 2; ++k)
        {
            scree_candidate_pair bodies[MAX];
            int64_t num = 0;
            // 3 and 7 have no factor in common with 20
            for (int32_t n = 0; n < BODIES; ++n)
                for (int32_t i = round % 2 == 0 ? n : (n + 1) * (k == 0 ? 3 : 7) % BODIES, j = i + 1; j < BODIES; ++j)
                    if (scree_test_random(&seed) < 0.3) bodies[num++] = (scree_candidate_pair){i, j};
            fill(&lists[k], bodies, num);
        }
        int32_t old_of_contact[MAX];
        uint8_t is_continued[MAX] = {0};
        int32_t bounds[2 * BODIES] = {0};
        const scree_history_match_args args =
            match_of(lists + 1, lists, lists[1].bodies, bounds, BODIES, old_of_contact, is_continued);
        scree_history_match_launch(args, lists[1].num_contacts);
        int64_t num_continued = 0;
        for (int64_t c = 0; c < lists[1].num_contacts; ++c)
        {
            int64_t expected = -1;
            for (int64_t o = 0; o < lists[0].num_contacts; ++o)
                if (lists[0].bodies[o].i == lists[1].bodies[c].i && lists[0].bodies[o].j == lists[1].bodies[c].j)
                    expected = o;
            SCREE_CHECK_INT(old_of_contact[c], expected);
            num_continued += expected >= 0;
        }
        for (int64_t o = 0; o < lists[0].num_contacts; ++o) num_continued -= is_continued[o];
        SCREE_CHECK_INT(num_continued, 0);
        scree_contact_list_destroy(&lists[0]);
        scree_contact_list_destroy(&lists[1]);
    }
}

/// Two patches of one pair keep their histories when their order in the list changes.
static void test_patches_find_the_nearest(void)
{
    scree_contact_list now = {0}, old = {0};
    const scree_candidate_pair bodies[] = {{0, 1}, {0, 1}};
    fill(&now, bodies, 2);
    fill(&old, bodies, 2);
    now.first_of_pair[0] = old.first_of_pair[0] = 0;
    now.first_of_pair[1] = old.first_of_pair[1] = 2;
    old.arm[0].x = 1;
    old.arm[1].x = -1;
    now.arm[0].x = -1.01;
    now.arm[1].x = 1.02;
    int32_t old_of_contact[2];
    uint8_t is_continued[2] = {0, 0};
    const scree_history_match_args args = match_of(&now, &old, bodies, NULL, 0, old_of_contact, is_continued);
    scree_history_match_launch(args, 1);
    SCREE_CHECK_INT(old_of_contact[0], 1);
    SCREE_CHECK_INT(old_of_contact[1], 0);

    // between different spheres of a clump nothing is handed over, however near their contacts are
    is_continued[0] = is_continued[1] = 0;
    old.patch[0] = now.patch[0] = 3 << SCREE_PATCH_BITS;
    old.patch[1] = now.patch[1] = 4 << SCREE_PATCH_BITS;
    scree_history_match_launch(args, 1);
    SCREE_CHECK_INT(old_of_contact[0], 0);
    SCREE_CHECK_INT(old_of_contact[1], 1);
    is_continued[0] = is_continued[1] = 0;
    now.patch[1] = 5 << SCREE_PATCH_BITS;
    scree_history_match_launch(args, 1);
    SCREE_CHECK_INT(old_of_contact[1], -1);
    SCREE_CHECK_INT(is_continued[1], 0);
    // nor where each has but one
    is_continued[0] = is_continued[1] = 0;
    now.first_of_pair[1] = old.first_of_pair[1] = 1;
    old.patch[0] = 4 << SCREE_PATCH_BITS;
    scree_history_match_launch(args, 1);
    SCREE_CHECK_INT(old_of_contact[0], -1);
    scree_contact_list_destroy(&now);
    scree_contact_list_destroy(&old);
}

int main(void)
{
    SCREE_RUN(test_growth_keeps_contents);
    SCREE_RUN(test_history_is_what_the_last_step_had);
    SCREE_RUN(test_validate_finds_faults);
    SCREE_RUN(test_one_contact_per_pair);
    SCREE_RUN(test_block_is_lent);
    SCREE_RUN(test_history_follows_pairs);
    SCREE_RUN(test_patches_find_the_nearest);
    return SCREE_TEST_END();
}
