// What a run cannot start from is refused, with the particle or wall, the place and the remedy.
#include "scree/scene.h"
#include "scree/simulation.h"

#include "harness.h"

#include <stdlib.h>
#include <unistd.h>

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

/// A closed drum, hollow: inside is right, everywhere else is not, with or without gravity or a floor. What is full, or
/// hollow but open, stands in nobody's way.
static void test_outside_of_a_closed_drum(void)
{
    static const char *const shapes =
        "  - {name: drum, source: turned, segments: 32, profile: [{radius: 0, height: -0.2}, {radius: 0.2, height: "
        "-0.2},\n"
        "     {radius: 0.2, height: 0.2}, {radius: 0, height: 0.2}, {radius: 0, height: 0.19}, {radius: 0.19, height: "
        "0.19},\n"
        "     {radius: 0.19, height: -0.19}, {radius: 0, height: -0.19}]}\n"
        "  - {name: cup, source: turned, segments: 32, profile: [{radius: 0, height: -0.2}, {radius: 0.2, height: "
        "-0.2},\n"
        "     {radius: 0.2, height: 0.2}, {radius: 0.19, height: 0.2}, {radius: 0.19, height: -0.19}, {radius: 0, "
        "height: -0.19}]}\n";
    static const struct
    {
        const char *wall, *place, *gravity;
        bool is_refused;
    } cases[] = {
        {"drum", "[0, 0, 1]", "[0, 0, 0]", false},          {"drum", "[0.1, 0, 1.15]", "[0, 0, 0]", false},
        {"drum", "[0.25, 0, 1]", "[0, 0, 0]", true},        {"drum", "[0.19, 0.19, 1]", "[0, 0, 0]", true},
        {"drum", "[0, 0, 1.3]", "[0, 0, -9.81]", true},     {"drum", "[0, 0, 0.5]", "[0, 0, -9.81]", true},
        {"cup", "[0, 0, 1.3]", "[0, 0, -9.81]", false},     {"cup", "[0.25, 0, 1]", "[0, 0, 0]", false},
        {"block", "[0.1, 0, 1.3]", "[0, 0, -9.81]", false},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k)
    {
        char text[3000];
        snprintf(text, sizeof text,
                 "gravity: %s\n" HEAD "%s" BALLS "      - {position: %s}\n" FLOOR
                 "  - {name: vessel, shape: %s, material: glass, position: [0, 0, 1]}\n",
                 cases[k].gravity, shapes, cases[k].place, cases[k].wall);
        char *messages = messages_of(text, cases[k].is_refused ? SCREE_INVALID_INPUT : SCREE_OK);
        if (cases[k].is_refused)
            SCREE_CHECK_CONTAINS(messages,
                                 "is outside of the closed wall \"vessel\", which is hollow to hold particles; "
                                 "move it inside, or, if the wall is in their way, take away its inner "
                                 "surface");
        else SCREE_CHECK(strstr(messages, "outside") == NULL);
        free(messages);
    }
}

/// A drum with a lifter that hangs free in its void, in one mesh, made of two vessels in each other: the surface that
/// is nearest to a ball in the void is one that faces outwards.
static void test_island_in_a_vessel(void)
{
    char folder[] = "/tmp/scree_test_XXXXXX", path[64], text[2000];
    SCREE_CHECK(mkdtemp(folder) != NULL);
    snprintf(path, sizeof path, "%s/island.obj", folder);
    FILE *file = fopen(path, "w");
    if (file == NULL) exit(EXIT_FAILURE);
    const double half[3] = {0.5, 0.45, 0.1};
    for (int box = 0; box < 3; ++box)
    {
        static const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
        for (int v = 0; v < 8; ++v)
            fprintf(file, "v %g %g %g\n", v & 1 ? half[box] : -half[box], v & 2 ? half[box] : -half[box],
                    v & 4 ? half[box] : -half[box]);
        for (int q = 0; q < 6; ++q)
        {
            const int *c = quads[q], first = 8 * box + 1, is_void = box == 1;
            fprintf(file, "f %d %d %d\nf %d %d %d\n", first + c[0], first + c[is_void ? 2 : 1],
                    first + c[is_void ? 1 : 2], first + c[0], first + c[is_void ? 3 : 2], first + c[is_void ? 2 : 3]);
        }
    }
    fclose(file);
    for (int k = 0; k < 2; ++k)
    {
        snprintf(text, sizeof text,
                 "gravity: [0, 0, 0]\n" HEAD "  - {name: room, source: file, file: %s}\n" BALLS
                 "      - {position: [%g, 0, 0]}\n"
                 "walls:\n  - {name: room, shape: room, material: glass}\n",
                 path, k == 0 ? 0.15 : 0.55);
        char *messages = messages_of(text, k == 0 ? SCREE_OK : SCREE_INVALID_INPUT);
        SCREE_CHECK((strstr(messages, "outside of the closed wall \"room\"") != NULL) == (k == 1));
        free(messages);
    }
    unlink(path);
    rmdir(folder);
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
    check_motion(turn, ", motion: {kind: translate, velocity: [0, 0, 1], opens: true}", 0.3, false);
    check_motion(turn, faster, 0.5, false);
    check_motion(later, gone, 0.3, false);
}

/// Messages of a block that touches, or reaches into, the floor and moves.
static void check_parting(const char *motion, double height, const char *expected)
{
    char text[2048];
    snprintf(text, sizeof text,
             HEAD BALLS "      - {position: [0, 0, %g]}\n" FLOOR
                        "  - {name: gate, shape: block, material: glass, position: [0, 0, %g]%s}\n",
             height + 0.21, height, motion);
    char *messages = messages_of(text, SCREE_OK);
    if (expected != NULL) SCREE_CHECK_CONTAINS(messages, expected);
    else SCREE_CHECK(strstr(messages, "part") == NULL);
    free(messages);
}

/// What slides or turns along a wall that stands still, or is lifted from it, may part from it: the run goes on, and is
/// told when.
static void test_walls_that_part(void)
{
    static const char *const aside = ", motion: {kind: translate, velocity: [1, 0, 0], start: 0.1}";
    static const char *const shortly = ", motion: {kind: translate, velocity: [1, 0, 0], start: 0.1, end: 0.4}";
    static const char *const gone = ", removed_at: 0.4, motion: {kind: translate, velocity: [1, 0, 0], start: 0.1}";
    static const char *const up = ", motion: {kind: translate, velocity: [0, 0, 0.5], start: 0.25}";
    static const char *const late = ", motion: {kind: translate, velocity: [0, 0, 0.5], start: 2}";
    static const char *const opening = ", motion: {kind: translate, velocity: [0, 0, 0.5], start: 0.25, opens: true}";
    static const char *const round = ", motion: {kind: rotate, axis: [0, 0, 1], angular_velocity: 3}";
    // 0.4 m wide, at 1 m/s from 0.1 s on: off it at 0.5 s
    check_parting(aside, 0.2,
                  "walls \"floor\" and \"gate\" touch at the start and part at 0.5 s; if one is meant to "
                  "open, as a door or a lid, set opens of its motion to true, or else give both the same "
                  "motion");
    check_parting(aside, 0.19, "walls \"floor\" and \"gate\" reach into each other at the start and part at 0.5 s");
    check_parting(shortly, 0.2, NULL);
    check_parting(gone, 0.2, NULL);
    check_parting(up, 0.2, "touch at the start and part at 0.25 s");
    check_parting(up, 0.19, "part at 0.27 s");
    check_parting(up, 0.21, NULL); // apart from the beginning
    check_parting(late, 0.2, NULL);
    check_parting(opening, 0.2, NULL);
    check_parting(round, 0.2, NULL);
}

int main(void)
{
    SCREE_RUN(test_refused);
    SCREE_RUN(test_outside_of_the_walls);
    SCREE_RUN(test_outside_of_a_closed_drum);
    SCREE_RUN(test_island_in_a_vessel);
    SCREE_RUN(test_motions_that_tear_walls_apart);
    SCREE_RUN(test_walls_that_part);
    return SCREE_TEST_END();
}
