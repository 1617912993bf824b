// What a run cannot start from is refused, with the particle or wall, the place and the remedy.
#include "dynamics/state.h"
#include "scree/scene.h"
#include "scree/simulation.h"

#include "harness.h"
#include "test_folder.h"

#include <stdlib.h>
#include <unistd.h>

#define HEAD                                                                                                         \
    "name: start\ntime: {end: 1}\n"                                                                                  \
    "materials: [{name: glass, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"                          \
    "contact_laws: [{materials: [glass, glass], friction_coefficient: 0.5, damping_ratio: 0}]\n"                     \
    "shapes:\n  - {name: ball, source: sphere, size: 0.02}\n  - {name: block, source: box, size: [0.4, 0.4, 0.4]}\n" \
    "  - {name: dice, source: box, size: 0.02}\n"
#define FLOOR "walls:\n  - {name: floor, shape: block, material: glass, position: [0, 0, -0.2]}\n"
#define BODY(name, shape, place) \
    "{name: " name ", shape: " shape ", material: glass, bodies: [{position: " place "}]}\n"
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
         "particle 0 of \"balls\" at (0, 0, 0.01) starts 0.002 m inside particle 1 of \"balls\" at (0.018, 0, 0.01), "
         "more than 0.05 of the smaller one's half width of 0.01 m; move one of them"},
        {HEAD BALLS "      - {position: [0, 0, 0.01]}\n      - {position: [0, 0, 0.01]}\n" FLOOR,
         "particle 0 of \"balls\" at (0, 0, 0.01) has the centre of particle 1 of \"balls\" at (0, 0, 0.01); move one "
         "of "
         "them"},
        {HEAD BALLS "      - {position: [0, 0, 0.009]}\n" FLOOR, "starts 0.001 m inside wall \"floor\""},
        // the centre below the surface by half a radius, then by more than a radius
        {HEAD BALLS "      - {position: [0, 0, -0.005]}\n" FLOOR, "starts 0.015 m inside wall \"floor\""},
        {HEAD BALLS "      - {position: [0, 0, -0.05]}\n" FLOOR,
         "particle 0 of \"balls\" at (0, 0, -0.05) starts inside the solid of wall \"floor\", 0.05 m below its "
         "surface"},
        // nearer to the surface than its corners are to its centre
        {HEAD "particles:\n  - " BODY("dice", "dice", "[0, 0, -0.0125]") FLOOR,
         "of \"dice\" at (0, 0, -0.0125) starts inside the solid of wall \"floor\", 0.0025 m below its surface"},
        {HEAD "particles:\n  - name: dice\n    shape: dice\n    material: glass\n    bodies: [{position: [0, 0, "
              "-0.1]}]\n" FLOOR,
         "of \"dice\" at (0, 0, -0.1) starts inside the solid of wall \"floor\", 0.09 m below its surface"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k)
    {
        char *messages = messages_of(cases[k].text, SCREE_INVALID_INPUT);
        SCREE_CHECK_CONTAINS(messages, cases[k].message);
        free(messages);
    }
}

/// Two bodies, in both orders of their ids: what is refused of them is refused of both, with both names.
static void check_two_bodies(const char *first, const char *second, const char *expected)
{
    for (int order = 0; order < 2; ++order)
    {
        char text[6000];
        snprintf(text, sizeof text,
                 "gravity: [0, 0, 0]\n" HEAD
                 "  - {name: large_ball, source: sphere, size: 0.2}\n  - {name: crumb, source: sphere, size: 0.004}\n"
                 "  - {name: plate, source: box, size: [0.4, 0.4, 0.004]}\n"
                 "  - {name: ring, source: turned, segments: 16, profile: [{radius: 0.08, height: -0.01},\n"
                 "     {radius: 0.1, height: -0.01}, {radius: 0.1, height: 0.01}, {radius: 0.08, height: 0.01}]}\n"
                 "  - {name: needle, source: box, size: [0.01, 0.01, 0.9]}\n"
                 "  - {name: pair, source: clump, spheres: [{position: [-0.009, 0, 0], radius: 0.01}, "
                 "{position: [0.009, 0, 0], radius: 0.01}]}\n"
                 "particles:\n  - %s  - %s",
                 order == 0 ? first : second, order == 0 ? second : first);
        char *messages = messages_of(text, expected != NULL ? SCREE_INVALID_INPUT : SCREE_OK);
        if (expected != NULL)
        {
            SCREE_CHECK_CONTAINS(messages, expected);
            SCREE_CHECK_CONTAINS(messages, "of \"a\" at (");
            SCREE_CHECK_CONTAINS(messages, "of \"b\" at (");
            SCREE_CHECK_CONTAINS(messages, "move one of them");
        }
        else SCREE_CHECK(strstr(messages, "of \"a\"") == NULL);
        free(messages);
    }
}

static void test_bodies_in_each_other(void)
{
    const char *const large = BODY("a", "large_ball", "[0, 0, 0]"), *const cube = BODY("a", "block", "[0, 0, 0]");
    // wholly inside, close below the surface, then half way down; the deepest that is allowed; apart
    check_two_bodies(large, BODY("b", "crumb", "[0.0975, 0, 0]"), "starts 0.0045 m inside particle");
    check_two_bodies(large, BODY("b", "crumb", "[0, 0.05, 0]"), "of the smaller one's half width of 0.002 m");
    check_two_bodies(large, BODY("b", "crumb", "[0, 0, 0]"), "has the centre of particle");
    check_two_bodies(large, BODY("b", "crumb", "[0.10188, 0, 0]"), "starts 0.00012 m inside");
    check_two_bodies(large, BODY("b", "crumb", "[0.10192, 0, 0]"), NULL);
    // balls and clumps in a cube
    check_two_bodies(cube, BODY("b", "ball", "[0.02, 0, 0]"), "of \"a\" at (0, 0, 0), 0.18 m below its surface");
    check_two_bodies(cube, BODY("b", "ball", "[0, 0, 0.195]"), "starts 0.015 m inside");
    check_two_bodies(cube, BODY("b", "ball", "[0.2096, 0, 0]"), NULL);
    check_two_bodies(cube, BODY("b", "pair", "[0, 0, 0]"), "starts inside particle");
    // a cube in a ball, a cube in a cube: in its middle, beside it, by a corner
    check_two_bodies(large, BODY("b", "dice", "[0.03, 0, 0]"), "half width of 0.01 m");
    check_two_bodies(cube, BODY("b", "dice", "[0, 0, 0]"), "starts inside particle");
    check_two_bodies(cube, BODY("b", "dice", "[0.1, 0.17, 0.05]"), "of \"a\" at (0, 0, 0), 0.02 m below its surface");
    check_two_bodies(cube, BODY("b", "dice", "[0.2, 0, 0]"), "half width of 0.01 m");
    check_two_bodies(cube, BODY("b", "dice", "[0.2104, 0, 0]"), NULL);
    // plates across each other; a needle through a cube, into it, through a plate
    check_two_bodies(BODY("a", "plate", "[0, 0, 0]"), BODY("b", "plate", "[0.1, 0.1, 0.0037]"),
                     "half width of 0.002 m");
    check_two_bodies(cube, BODY("b", "needle", "[0, 0, 0]"), "start in each other, and no direction leads apart");
    check_two_bodies(cube, BODY("b", "needle", "[0, 0, 0.3]"), "half width of 0.005 m");
    check_two_bodies(BODY("a", "plate", "[0.1, 0, 0]"), BODY("b", "needle", "[0, 0, 0.1]"),
                     "start in each other, and no direction leads apart");
    // links of a chain: the centre of each is in the other's solid, but nothing of them
    check_two_bodies(BODY("a", "ring", "[0, 0, 0]"),
                     "{name: b, shape: ring, material: glass, bodies: [{position: [0.09, 0, 0], orientation: [1, 1, 0, "
                     "0]}]}\n",
                     NULL);
    // clumps: by the sphere that touches
    check_two_bodies(BODY("a", "pair", "[0, 0, 0]"), BODY("b", "pair", "[0, 0.0193, 0]"), "half width of 0.01 m");
    check_two_bodies(BODY("a", "pair", "[0, 0, 0]"), BODY("b", "pair", "[0.018, 0, 0]"), "has the centre of particle");
    check_two_bodies(BODY("a", "pair", "[0, 0, 0]"), BODY("b", "pair", "[0, 0.0197, 0]"), NULL);
}

/// A row of twenty balls and the same row beside it: each contact is a third of a ball deep, little against the row.
static void test_clumps_in_each_other(void)
{
    char row[2000] = "", text[5000];
    for (int k = 0; k < 20; ++k)
        snprintf(row + strlen(row), sizeof row - strlen(row), "%s{position: [%g, 0, 0], radius: 0.001}",
                 k > 0 ? ", " : "", 0.0019 * k);
    snprintf(text, sizeof text,
             "gravity: [0, 0, 0]\n" HEAD "  - {name: row, source: clump, spheres: [%s]}\n"
             "particles:\n  - " BODY("a", "row", "[0, 0, 0]") "  - " BODY("b", "row", "[0, 0.0013, 0]"),
             row);
    char *messages = messages_of(text, SCREE_INVALID_INPUT);
    SCREE_CHECK_CONTAINS(messages, "starts 0.0007 m inside particle 1 of \"b\"");
    SCREE_CHECK_CONTAINS(messages, "half width of 0.001 m");
    free(messages);
}

/// Against a wall the whole body counts, be it a clump or a mesh: the row is as wide as a ball of it.
static void test_clumps_in_walls(void)
{
    static const double depths[2] = {0.00045, 0.00055};
    for (int k = 0; k < 4; ++k)
    {
        char text[3000];
        snprintf(text, sizeof text,
                 "gravity: [0, 0, 0]\n" HEAD
                 "  - {name: pair, source: clump, spheres: [{position: [-0.009, 0, 0], radius: 0.01}, "
                 "{position: [0.009, 0, 0], radius: 0.01}]}\n"
                 "  - {name: brick, source: box, size: [0.03, 0.06, 0.02]}\n"
                 "particles:\n  - {name: a, shape: %s, material: glass, bodies: [{position: [0, 0, %.17g]}]}\n" FLOOR,
                 k < 2 ? "pair" : "brick", 0.01 - depths[k % 2]);
        char *messages = messages_of(text, k % 2 == 0 ? SCREE_OK : SCREE_INVALID_INPUT);
        if (k % 2 == 1)
            SCREE_CHECK_CONTAINS(messages,
                                 "starts 0.00055 m inside wall \"floor\", more than 0.05 of its half width of "
                                 "0.01 m");
        free(messages);
    }
}

/// Messages about balls over a floor of 0.4 m, in any gravity, and what is expected of them; NULL: nothing.
static void check_flight(const char *gravity, const char *bodies, const char *walls, const char *expected)
{
    char text[3000];
    snprintf(text, sizeof text, "gravity: %s\n" HEAD BALLS "%s" FLOOR "%s", gravity, bodies, walls);
    char *messages = messages_of(text, expected != NULL ? SCREE_INVALID_INPUT : SCREE_OK);
    if (expected != NULL) SCREE_CHECK_CONTAINS(messages, expected);
    else SCREE_CHECK(strstr(messages, "outside") == NULL);
    free(messages);
}

/// A ball that never meets a wall is outside of them, however it starts.
static void test_outside_of_the_walls(void)
{
    static const char *const down = "[0, 0, -9.81]", *const none = "[0, 0, 0]", *const aside = "[3, 0, -4]";
    static const char *const out = "is outside of the walls: it meets none of them, nor another particle, and would";
    char *messages = messages_of(HEAD BALLS "      - {position: [0, 0, 0.01]}\n      - {position: [0.22, 0, 0.01]}\n"
                                            "      - {position: [0, 0, -0.5]}\n" FLOOR,
                                 SCREE_INVALID_INPUT);
    SCREE_CHECK_CONTAINS(
        messages, "particle 1 of \"balls\" at (0.22, 0, 0.01) is outside of the walls: it meets none of them, nor "
                  "another particle, and would fall for ever; move it, or make the walls reach below it");
    SCREE_CHECK_CONTAINS(messages, "particle 2 of \"balls\" at (0, 0, -0.5) is outside of the walls");
    SCREE_CHECK(strstr(messages, "particle 0") == NULL);
    free(messages);
    // the rim may still be hit
    check_flight(down, "      - {position: [0.205, 0, 0.01]}\n", "", NULL);
    // thrown: onto the floor, short of it, over it, away from it, up under it
    check_flight(down, "      - {position: [0.3, 0, 0.01], velocity: [-1, 0, 0]}\n", "", NULL);
    check_flight(down, "      - {position: [2, 0, 0.5], velocity: [-5.7, 0, 0]}\n", "", NULL);
    check_flight(down, "      - {position: [2, 0, 0.5], velocity: [-3.3, 0, 0]}\n", "", out);
    check_flight(down, "      - {position: [2, 0, 0.5], velocity: [-9, 0, 0]}\n", "", out);
    check_flight(down, "      - {position: [2, 0, 0.3], velocity: [1e-9, 0, 0]}\n", "", out);
    check_flight(down, "      - {position: [0, 0, -0.5], velocity: [0, 0, -1]}\n", "", out);
    check_flight(down, "      - {position: [0, 0, -0.5], velocity: [0, 0, 1]}\n", "", out);
    check_flight(down, "      - {position: [0, 0, -0.5], velocity: [0, 0, 2]}\n", "", NULL);
    // gravity along no axis: from (2, 0, h) with no speed in x it comes back never; thrown against it, it does
    check_flight(aside, "      - {position: [2, 0, 1], velocity: [-1, 0, 0]}\n", "", out);
    check_flight(aside, "      - {position: [-1.5, 0, 2], velocity: [0, 0, 0]}\n", "", NULL);
    // without gravity straight on; what rests stays
    check_flight(none, "      - {position: [2, 0, 0.3], velocity: [0, 0, 1e-3]}\n", "", "would fly for ever");
    check_flight(none, "      - {position: [2, 0, 0.3], velocity: [-1, 0, -0.2]}\n", "", NULL);
    check_flight(none, "      - {position: [2, 0, 0.3]}\n", "", NULL);
    // towards another ball, in its flight or where it stays
    check_flight(none, "      - {position: [2, 0, 0.3], velocity: [0, 0, 1]}\n      - {position: [2, 0, 1]}\n", "",
                 NULL);
    check_flight(down, "      - {position: [2, 0, 0.4], velocity: [-10, 0, 0]}\n      - {position: [0, 0, 0.21]}\n", "",
                 NULL);
    check_flight(down, "      - {position: [2, 0, 0.4], velocity: [-10, 0, 0]}\n      - {position: [0, 0, 0.1]}\n", "",
                 out);
    // where a wall comes to on its way, and round its axis
    static const char *const cart =
        "  - {name: cart, shape: block, material: glass, position: [1, 0, -1], motion: {kind: translate, velocity: [1, "
        "0, 0]}}\n";
    static const char *const mill =
        "  - {name: arm, shape: block, material: glass, position: [1, 0, -1], motion: {kind: rotate, axis: [0, 0, 2], "
        "angular_velocity: 1}}\n";
    check_flight(down, "      - {position: [2, 0, 0.3]}\n", cart, NULL);
    check_flight(down, "      - {position: [2.3, 0, 0.3]}\n", cart, out);
    check_flight(down, "      - {position: [0, 1.1, 0.3]}\n", mill, NULL);
    check_flight(down, "      - {position: [0, 1.3, 0.3]}\n", mill, out);
    messages = messages_of(HEAD BALLS "      - {position: [0.3, 0, 0.01]}\n", SCREE_OK);
    SCREE_CHECK(strstr(messages, "outside") == NULL);
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
    char path[512], text[2000];
    snprintf(path, sizeof path, "%s/island.obj", scree_test_folder());
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
    static const char *const opening = ", motion: {kind: translate, velocity: [0, 0, 1], opens: true}";
    static const char *const after = ", motion: {kind: translate, velocity: [0, 0, 1], start: 1.5}";
    check_motion(turn, same, 0.3, false);
    check_motion(turn, faster, 0.3, true);
    check_motion(turn, elsewhere, 0.3, true);
    check_motion(turn, later, 0.3, true);
    check_motion(turn, away, 0.3, true);
    check_motion(turn, "", 0.3, true);
    check_motion("", turn, 0.3, true);
    check_motion(away, "", 0.3, true);
    check_motion("", away, 0.3, true);
    check_motion("", opening, 0.3, false);
    check_motion(opening, "", 0.3, false);
    check_motion("", after, 0.3, false);    // the run is over before
    check_motion(turn, faster, 0.4, false); // flush
    check_motion(turn, ", motion: {kind: translate, velocity: [0, 0, 1], opens: true}", 0.3, false);
    check_motion(turn, faster, 0.5, false);
    check_motion(later, gone, 0.3, false);
}

/// Walls that reach into each other, one at rest: refused, in both orders, unless what they share turns into itself.
static void check_turning(const char *moving, const char *resting, const char *motion, bool is_refused)
{
    for (int order = 0; order < 2; ++order)
        for (int which = 0; which < 2; ++which)
        {
            char text[6000], walls[2][600];
            snprintf(walls[which], sizeof walls[which], "  - {name: first, %s, material: glass%s}\n", moving, motion);
            snprintf(walls[1 - which], sizeof walls[1 - which], "  - {name: second, %s, material: glass}\n", resting);
            // `order` changes the order of the walls, `which` also the one that moves
            snprintf(
                text, sizeof text,
                "gravity: [0, 0, 0]\n" HEAD
                "  - {name: shaft, source: turned, segments: 16, profile: [{radius: 0, height: -1}, {radius: "
                "0.03, height: -1},\n     {radius: 0.03, height: 1}, {radius: 0, height: 1}]}\n"
                "  - {name: shell, source: turned, segments: 24, profile: [{radius: 0.2, height: -0.2}, "
                "{radius: 0.21, height: -0.2},\n     {radius: 0.21, height: 0.2}, {radius: 0.2, height: "
                "0.2}]}\n"
                "  - {name: closed, source: turned, segments: 24, profile: [{radius: 0, height: -0.2}, "
                "{radius: 0.21, height: -0.2},\n     {radius: 0.21, height: 0.2}, {radius: 0, height: 0.2}, "
                "{radius: 0, height: 0.19},\n     {radius: 0.2, height: 0.19}, {radius: 0.2, height: -0.19}, "
                "{radius: 0, height: -0.19}]}\n"
                "  - {name: plate, source: box, size: [0.5, 0.5, 0.02], offset: [0, 0, 0.2]}\n"
                "  - {name: piston, source: turned, segments: 24, profile: [{radius: 0, height: -0.05}, {radius: "
                "0.205, "
                "height: -0.05},\n     {radius: 0.205, height: 0.05}, {radius: 0, height: 0.05}]}\n"
                "  - {name: wheel, source: box, size: [0.06, 0.02, 0.1], offset: [0.05, 0, 0.2], copies: 5}\n"
                "  - {name: lifters, source: box, size: [0.03, 0.02, 0.3], offset: [0.19, 0, 0], copies: 8}\n" BALLS
                "      - {position: [0.1, 0, 0.1]}\nwalls:\n%s%s",
                walls[order], walls[1 - order]);
            char *messages = messages_of(text, is_refused ? SCREE_INVALID_INPUT : SCREE_OK);
            SCREE_CHECK((strstr(messages, "reach into each other, but move differently") != NULL) == is_refused);
            SCREE_CHECK(strstr(messages, "part at") == NULL);
            free(messages);
        }
}

static void test_walls_that_turn_in_others(void)
{
#define TURNING(axis, centre) \
    ", motion: {kind: rotate, axis: " axis ", centre: " centre ", angular_velocity: 3, start: 0.1}"
#define SLIDING(velocity) ", motion: {kind: translate, velocity: " velocity "}"
    static const char *const about = TURNING("[0, 0, 1]", "[0, 0, 0.5]"), *const other =
                                                                              TURNING("[0, 0.3, 1]", "[0, 0, 0]");
    static const char *const beside = TURNING("[0, 0, 1]", "[0.01, 0, 0]");
    // a shaft in a plate, and a drum in a plate
    check_turning("shape: shaft", "shape: plate", about, false);
    check_turning("shape: shell", "shape: plate", about, false);
    check_turning("shape: closed", "shape: plate", about, false);
    check_turning("shape: shaft", "shape: plate", beside, false);
    check_turning("shape: shaft", "shape: shell, position: [0.2, 0, 0]", about, true);
    check_turning("shape: shaft", "shape: plate", other, true);
    // along its axis, until it leaves the plate, and across
    check_turning("shape: shaft", "shape: plate", SLIDING("[0, 0, 0.1]"), false);
    check_turning("shape: shaft", "shape: plate", SLIDING("[0, 0, 2]"), true);
    check_turning("shape: shaft", "shape: plate", SLIDING("[0, 0.1, 0]"), false);
    check_turning("shape: shaft", "shape: plate", SLIDING("[0, 0.5, 0]"), true);
    check_turning("shape: plate", "shape: shaft", SLIDING("[0, 0, 0.1]"), false);
    check_turning("shape: plate", "shape: shaft", SLIDING("[0, 0, 2]"), true);
    // a plate as a piston in a shell that reaches into it, and one that leaves it
    check_turning("shape: piston", "shape: shell", SLIDING("[0, 0, 0.1]"), false);
    check_turning("shape: piston", "shape: shell", SLIDING("[0, 0, 0.3]"), true);
    check_turning("shape: piston", "shape: shell", SLIDING("[0.01, 0, 0]"), true);
    check_turning("shape: piston", "shape: shell", ", motion: {kind: translate, velocity: [0, 0, 0.3], opens: true}",
                  false);
    // a wheel that is not round, on a plate, on one that begins beside the axis, and on a shaft
    check_turning("shape: wheel", "shape: plate", about, false);
    check_turning("shape: wheel", "shape: plate, position: [0.27, 0, 0]", about, true);
    check_turning("shape: shaft", "shape: wheel", about, true);
    // the lifters of a drum, open or closed
    check_turning("shape: shell", "shape: lifters", about, true);
    check_turning("shape: closed", "shape: lifters", about, true);
}

/// Messages of a block that touches the floor and moves.
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
    check_parting(shortly, 0.2, NULL);
    check_parting(gone, 0.2, NULL);
    check_parting(up, 0.2, "touch at the start and part at 0.25 s");
    check_parting(up, 0.21, NULL); // apart from the beginning
    check_parting(late, 0.2, NULL);
    check_parting(opening, 0.2, NULL);
    check_parting(round, 0.2, NULL);
}

/// A ball that falls by a metre on a floor: the warning comes where its centre does come below the surface.
static void test_contacts_that_are_too_soft(void)
{
    static const double moduli[] = {1e3, 1e6};
    for (int k = 0; k < 2; ++k)
    {
        char text[1500];
        snprintf(text, sizeof text,
                 "name: soft\ntime: {end: 0.6}\n"
                 "materials: [{name: jelly, density: 1000, youngs_modulus: %g, poisson_ratio: 0.25}]\n"
                 "contact_laws: [{materials: [jelly, jelly], friction_coefficient: 0, damping_ratio: 0}]\n"
                 "shapes:\n  - {name: ball, source: sphere, size: 0.02}\n"
                 "  - {name: block, source: box, size: [0.4, 0.4, 0.4]}\n"
                 "particles:\n  - {name: balls, shape: ball, material: jelly, bodies: [{position: [0, 0, 1]}]}\n"
                 "walls:\n  - {name: floor, shape: block, material: jelly, position: [0, 0, -0.2]}\n",
                 moduli[k]);
        char *messages = messages_of(text, SCREE_OK);
        const bool is_warned = strstr(messages, "contacts of \"jelly\" are too soft for it") != NULL;
        free(messages);
        scree_scene_file file = {0};
        scree_report report = {0};
        scree_simulation *simulation = NULL;
        SCREE_CHECK_INT(scree_scene_parse(&file, text, "test.yaml", NULL, 0, &report), SCREE_OK);
        SCREE_CHECK_INT(scree_simulation_create(&simulation, &file.scene, ".", &report), SCREE_OK);
        bool is_inside = false;
        for (int64_t n = scree_simulation_num_steps(simulation); n > 0; --n)
        {
            SCREE_CHECK_INT(scree_simulation_step(simulation, &report), SCREE_OK);
            is_inside |= simulation->particles.position[0].z < 0;
        }
        SCREE_CHECK_INT(is_inside, k == 0);
        SCREE_CHECK_INT(is_warned, is_inside);
        scree_simulation_destroy(simulation);
        scree_scene_close(&file);
        scree_report_clear(&report);
    }
}

int main(void)
{
    SCREE_RUN(test_refused);
    SCREE_RUN(test_bodies_in_each_other);
    SCREE_RUN(test_clumps_in_each_other);
    SCREE_RUN(test_clumps_in_walls);
    SCREE_RUN(test_outside_of_the_walls);
    SCREE_RUN(test_outside_of_a_closed_drum);
    SCREE_RUN(test_island_in_a_vessel);
    SCREE_RUN(test_motions_that_tear_walls_apart);
    SCREE_RUN(test_walls_that_turn_in_others);
    SCREE_RUN(test_walls_that_part);
    SCREE_RUN(test_contacts_that_are_too_soft);
    return SCREE_TEST_END();
}
