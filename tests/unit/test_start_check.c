// What a run cannot start from is refused, with the particle or wall, the place and the remedy.
#include "scree/scene.h"
#include "scree/simulation.h"

#include "harness.h"

#include <stdlib.h>

#define HEAD                                                                                                         \
    "name: start\ntime: {end: 1}\n"                                                                                  \
    "materials: [{name: glass, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"                          \
    "contact_laws: [{materials: [glass, glass], friction_coefficient: 0.5, damping_ratio: 0}]\n"                     \
    "shapes:\n  - {name: ball, source: sphere, size: 0.02}\n  - {name: block, source: box, size: [0.4, 0.4, 0.4]}\n" \
    "  - {name: dice, source: box, size: 0.02}\n"
#define FLOOR "walls:\n  - {name: floor, shape: block, material: glass, position: [0, 0, -0.2]}\n"
#define BALLS "particles:\n  - name: balls\n    shape: ball\n    material: glass\n    bodies:\n"

/// Messages of making the scene, one after the other; free() them.
static char *messages_of(const char *text, scree_status expected)
{
    scree_scene_file file = {0};
    scree_report report = {0};
    scree_simulation *simulation = NULL;
    SCREE_CHECK_INT(scree_scene_parse(&file, text, "test.yaml", NULL, 0, &report), SCREE_OK);
    SCREE_CHECK_INT(scree_simulation_create(&simulation, &file.scene, ".", &report), expected);
    size_t size = 1;
    for (int k = 0; k < report.num_messages; ++k) size += strlen(report.messages[k]) + 1;
    char *all = calloc(size, 1);
    if (all == NULL) exit(EXIT_FAILURE);
    for (int k = 0; k < report.num_messages; ++k) strcat(strcat(all, report.messages[k]), "\n");
    scree_simulation_destroy(simulation);
    scree_scene_close(&file);
    scree_report_clear(&report);
    return all;
}

static void test_refused(void)
{
    static const struct
    {
        const char *text, *message;
    } cases[] = {
        {HEAD BALLS "      - {position: [0, 0, 0.01]}\n      - {position: [0.018, 0, 0.01]}\n" FLOOR,
         "particle 0 of \"balls\" at (0, 0, 0.01) starts 0.002 m inside particle 1, more than 0.05 of its bounding "
         "radius; move one of them"},
        {HEAD BALLS "      - {position: [0, 0, 0.01]}\n      - {position: [0, 0, 0.01]}\n" FLOOR,
         "particle 0 of \"balls\" at (0, 0, 0.01) has the centre of particle 1; move one of them"},
        {HEAD BALLS "      - {position: [0, 0, 0.009]}\n" FLOOR, "starts 0.001 m inside wall \"floor\""},
        // the centre below the surface by half a radius, then by more than a radius
        {HEAD BALLS "      - {position: [0, 0, -0.005]}\n" FLOOR, "starts 0.015 m inside wall \"floor\""},
        {HEAD BALLS "      - {position: [0, 0, -0.05]}\n" FLOOR,
         "particle 0 of \"balls\" at (0, 0, -0.05) starts inside the solid of wall \"floor\", 0.05 m below its "
         "surface"},
        {HEAD "particles:\n  - name: dice\n    shape: dice\n    material: glass\n    bodies: [{position: [0, 0, "
              "-0.1]}]\n" FLOOR,
         "of \"dice\" at (0, 0, -0.1) starts inside the solid of wall \"floor\", 0.1 m below its surface"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k)
    {
        char *messages = messages_of(cases[k].text, SCREE_INVALID_INPUT);
        SCREE_CHECK_CONTAINS(messages, cases[k].message);
        free(messages);
    }
}

/// A ball outside of the walls, unless the rim may still be hit, a push may lead anywhere, or everything falls.
static void test_outside_of_the_walls(void)
{
    char *messages = messages_of(HEAD BALLS "      - {position: [0, 0, 0.01]}\n      - {position: [0.22, 0, 0.01]}\n"
                                            "      - {position: [0, 0, -0.5]}\n" FLOOR,
                                 SCREE_INVALID_INPUT);
    SCREE_CHECK_CONTAINS(messages,
                         "particle 1 of \"balls\" at (0.22, 0, 0.01) is outside of the walls: none is below it, "
                         "and it would fall for ever; move it, or make the walls reach below it");
    SCREE_CHECK_CONTAINS(messages, "particle 2 of \"balls\" at (0, 0, -0.5) is outside of the walls");
    SCREE_CHECK(strstr(messages, "particle 0") == NULL);
    free(messages);
    messages = messages_of(HEAD BALLS "      - {position: [0.205, 0, 0.01]}\n"
                                      "      - {position: [0.3, 0, 0.01], velocity: [-1, 0, 0]}\n" FLOOR,
                           SCREE_OK);
    SCREE_CHECK(strstr(messages, "below") == NULL);
    free(messages);
    messages = messages_of(HEAD BALLS "      - {position: [0.3, 0, 0.01]}\n", SCREE_OK);
    SCREE_CHECK(strstr(messages, "below") == NULL);
    free(messages);
}

/// A floor with a moving block that reaches into it and a second that moves as said.
static void check_motion(const char *first, const char *second, double distance, bool is_refused)
{
    char text[2048];
    snprintf(text, sizeof text,
             HEAD BALLS "      - {position: [0, 0, 0.01]}\n" FLOOR
                        "  - {name: shell, shape: block, material: glass, position: [1, 0, 0]%s}\n"
                        "  - {name: lifter, shape: block, material: glass, position: [1, 0, %g]%s}\n",
             first, distance, second);
    char *messages = messages_of(text, is_refused ? SCREE_INVALID_INPUT : SCREE_OK);
    if (is_refused)
        SCREE_CHECK_CONTAINS(messages,
                             "walls \"shell\" and \"lifter\" reach into each other, but move differently and so "
                             "would be torn apart; give both the same motion");
    else SCREE_CHECK(strstr(messages, "torn") == NULL);
    free(messages);
}

static void test_motions_that_tear_walls_apart(void)
{
    static const char *const turn = ", motion: {kind: rotate, axis: [0, 1, 0], centre: [1, 0, 0], angular_velocity: 3}";
    static const char *const same =
        ", motion: {kind: rotate, axis: [0, -2, 0], centre: [1, 5, 0], angular_velocity: -3}";
    static const char *const faster =
        ", motion: {kind: rotate, axis: [0, 1, 0], centre: [1, 0, 0], angular_velocity: 3.1}";
    static const char *const elsewhere =
        ", motion: {kind: rotate, axis: [0, 1, 0], centre: [1.01, 0, 0], angular_velocity: 3}";
    static const char *const later =
        ", motion: {kind: rotate, axis: [0, 1, 0], centre: [1, 0, 0], angular_velocity: 3, start: 0.1}";
    static const char *const gone = ", removed_at: 0.05, motion: {kind: translate, velocity: [0, 0, 1], start: 0.1}";
    static const char *const away = ", motion: {kind: translate, velocity: [0, 0, 1]}";
    check_motion(turn, same, 0.3, false);
    check_motion(turn, faster, 0.3, true);
    check_motion(turn, elsewhere, 0.3, true);
    check_motion(turn, later, 0.3, true);
    check_motion(turn, away, 0.3, true);
    check_motion(turn, "", 0.3, false);     // what stands still may be moved in
    check_motion(turn, faster, 0.4, false); // flush
    check_motion(turn, faster, 0.5, false);
    check_motion(later, gone, 0.3, false);
}

int main(void)
{
    SCREE_RUN(test_refused);
    SCREE_RUN(test_outside_of_the_walls);
    SCREE_RUN(test_motions_that_tear_walls_apart);
    return SCREE_TEST_END();
}
