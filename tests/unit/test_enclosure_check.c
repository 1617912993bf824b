// Vessels that several walls close together: particles outside of them are refused; nothing is said of open ones.
#include "scene_run.h"

#include <math.h>

/// Balls of radius 0.1 at places; several walls.
#define HEAD                                                                                \
    "name: enclosures\ntime: {end: 1, step: 1e-5}\ngravity: [0, 0, 0]\n"                    \
    "materials: [{name: glass, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n" \
    "contact_laws: [{materials: [glass, glass], friction_coefficient: 0.4, damping_ratio: 0.3}]\n"

/// A box of six plates with an inside of 1 m, turned and moved as a whole. The lid leaves a slit along one side.
static void write_box(char *text, size_t size, scree_pose pose, double slit, const char *lid_keys)
{
    int length = snprintf(text, size,
                          "shapes:\n  - {name: ball, source: sphere, size: 0.2}\n"
                          "  - {name: x, source: box, size: [0.1, 1.2, 1.2]}\n"
                          "  - {name: y, source: box, size: [1.2, 0.1, 1.2]}\n"
                          "  - {name: z, source: box, size: [1.2, 1.2, 0.1]}\n"
                          "  - {name: lid, source: box, size: [%.17g, 1.2, 0.1]}\nwalls:\n",
                          slit > 0 ? 1.1 - slit : 1.2);
    for (int k = 0; k < 6; ++k)
    {
        const scree_real out = k % 2 ? (scree_real)0.55 : (scree_real)-0.55;
        scree_vec3 place = scree_vec3_make(k / 2 == 0 ? out : 0, k / 2 == 1 ? out : 0, k / 2 == 2 ? out : 0);
        // the side at x = 0.5 stays where it is
        if (k == 5 && slit > 0) place.x = (scree_real)(-0.05 - 0.5 * slit);
        place = scree_vec3_add(pose.position, scree_mat3_apply(scree_mat3_from_quat(pose.orientation), place));
        length += snprintf(text + length, size - (size_t)length,
                           "  - {name: side%d, shape: %s, material: glass, position: [%.17g, %.17g, %.17g], "
                           "orientation: [%.17g, %.17g, %.17g, %.17g]%s}\n",
                           k,
                           k == 5       ? "lid"
                           : k / 2 == 0 ? "x"
                           : k / 2 == 1 ? "y"
                                        : "z",
                           (double)place.x, (double)place.y, (double)place.z, (double)pose.orientation.w,
                           (double)pose.orientation.x, (double)pose.orientation.y, (double)pose.orientation.z,
                           k == 5 ? lid_keys : "");
    }
}

/// Two balls in the box and `num_outside` beside it; the messages.
static const char *check_box(scree_pose pose, double slit, const char *lid_keys, int num_outside)
{
    static const double places[4][3] = {{0.2, 0.1, -0.3}, {-0.3, -0.3, 0.1}, {0.9, 0, 0.3}, {-0.8, 0.9, 0}};
    char box[3000], text[5000];
    write_box(box, sizeof box, pose, slit, lid_keys);
    int length = snprintf(text, sizeof text,
                          HEAD "%sparticles:\n  - name: balls\n    shape: ball\n    material: glass\n"
                               "    bodies:\n",
                          box);
    for (int k = 0; k < 2 + num_outside; ++k)
    {
        const scree_vec3 place =
            scree_vec3_make((scree_real)places[k][0], (scree_real)places[k][1], (scree_real)places[k][2]);
        const scree_vec3 x =
            scree_vec3_add(pose.position, scree_mat3_apply(scree_mat3_from_quat(pose.orientation), place));
        length += snprintf(text + length, sizeof text - (size_t)length, "      - {position: [%.17g, %.17g, %.17g]}\n",
                           (double)x.x, (double)x.y, (double)x.z);
    }
    return scene_run_messages(text);
}

static const scree_pose upright = {{0, 0, 0}, {1, 0, 0, 0}, 1};

static void test_box_of_plates(void)
{
    SCREE_CHECK_CONTAINS(check_box(upright, 0, "", 1),
                         "particle 2 of \"balls\" at (0.9, 0, 0.3) is outside of what the walls \"side0\", \"side1\", "
                         "\"side2\", \"side3\", \"side4\" and 1 more close together, which holds 2 of 3 particles and "
                         "has no hole as wide as the smallest one; move it inside, or, if it belongs there, let a wall "
                         "open (motion.opens) or give it a time to go (removed_at, which may lie after the end)");
    SCREE_CHECK(check_box(upright, 0, "", 0)[0] == '\0');
    // half of the particles inside is enough
    SCREE_CHECK_CONTAINS(check_box(upright, 0, "", 2), "holds 2 of 4 particles");
    // a lid that goes, or that is never there
    SCREE_CHECK(check_box(upright, 0, ", removed_at: 2", 1)[0] == '\0');
    SCREE_CHECK(check_box(upright, 0, ", removed_at: 0", 1)[0] == '\0');
    SCREE_CHECK(check_box(upright, 0, ", motion: {kind: translate, velocity: [0, 0, 1], opens: true}", 1)[0] == '\0');
    SCREE_CHECK(check_box(upright, 0, ", motion: {kind: rotate, axis: [0, 1, 0], angular_velocity: 1, opens: true}",
                          1)[0] == '\0');
}

/// However the box lies in the grid: closed, it is seen as closed; with a slit through which a ball fits, as open.
static void test_boxes_at_random(void)
{
    uint64_t state = 9;
    for (int k = 0; k < 60; ++k)
    {
        scree_quat q = {(scree_real)(scree_test_random(&state) - 0.5), (scree_real)(scree_test_random(&state) - 0.5),
                        (scree_real)(scree_test_random(&state) - 0.5), (scree_real)(scree_test_random(&state) - 0.5)};
        const scree_real length = scree_sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
        scree_pose pose = upright;
        pose.orientation = (scree_quat){q.w / length, q.x / length, q.y / length, q.z / length};
        pose.position =
            scree_vec3_make((scree_real)scree_test_random(&state), (scree_real)scree_test_random(&state), 3);
        SCREE_CHECK_CONTAINS(check_box(pose, 0, "", 1), "holds 2 of 3 particles");
        SCREE_CHECK(check_box(pose, 0.201, "", 1)[0] == '\0');
        SCREE_CHECK(check_box(pose, 0.3, "", 1)[0] == '\0');
    }
}

/// A ball in a vessel of turned walls about z and one beside it.
static const char *check_turned(const char *shapes_and_walls)
{
    char text[4000];
    snprintf(text, sizeof text,
             HEAD "particles:\n  - {name: balls, shape: ball, material: glass, bodies: [{position: [0, 0, 0.2]}, "
                  "{position: [0.95, 0, 0.2]}]}\nshapes:\n  - {name: ball, source: sphere, size: 0.2}\n%s",
             shapes_and_walls);
    return scene_run_messages(text);
}

/// Shell and end plates; the shell turns.
static void test_drum(void)
{
    static const char *const drum =
        "  - {name: plate, source: box, size: [1.8, 1.8, 0.1]}\n"
        "  - {name: shell, source: turned, segments: 48, profile: [{radius: 0.7, height: -0.5}, {radius: 0.8, height: "
        "-0.5}, {radius: 0.8, height: 0.5}, {radius: 0.7, height: 0.5}]}\n"
        "walls:\n  - {name: shell, shape: shell, material: glass, motion: {kind: rotate, axis: [0, 0, 1], "
        "angular_velocity: 2}}\n"
        "  - {name: bottom, shape: plate, material: glass, position: [0, 0, -0.55]}\n";
    char text[2000];
    SCREE_CHECK(check_turned(drum)[0] == '\0'); // open above
    snprintf(text, sizeof text, "%s  - {name: top, shape: plate, material: glass, position: [0, 0, 0.55]}\n", drum);
    SCREE_CHECK_CONTAINS(check_turned(text), "particle 1 of \"balls\" at (0.95, 0, 0.2) is outside of what the walls "
                                             "\"shell\", \"bottom\" and \"top\" close together, which holds 1 of 2");
    // a gap all round that no ball fits through, and one that it does
    snprintf(text, sizeof text, "%s  - {name: top, shape: plate, material: glass, position: [0, 0, 0.6]}\n", drum);
    SCREE_CHECK_CONTAINS(check_turned(text), "is outside of what");
    snprintf(text, sizeof text, "%s  - {name: top, shape: plate, material: glass, position: [0, 0, 0.76]}\n", drum);
    SCREE_CHECK(check_turned(text)[0] == '\0');
}

/// Cylinder, cone, floor and lid; with an orifice in the floor.
static void test_silo(void)
{
    static const double orifices[] = {0, 0.05, 0.101, 0.2};
    for (int k = 0; k < 4; ++k)
    {
        char text[2500];
        snprintf(text, sizeof text,
                 "  - {name: lid, source: box, size: [1.8, 1.8, 0.1]}\n"
                 "  - {name: cylinder, source: turned, segments: 40, profile: [{radius: 0.7, height: 0}, {radius: 0.8, "
                 "height: 0}, {radius: 0.8, height: 0.5}, {radius: 0.7, height: 0.5}]}\n"
                 "  - {name: cone, source: turned, segments: 40, profile: [{radius: 0.4, height: -0.5}, {radius: 0.5, "
                 "height: -0.5}, {radius: 0.8, height: 0}, {radius: 0.7, height: 0}]}\n"
                 "  - {name: floor, source: turned, segments: 40, profile: [{radius: %g, height: -0.6}, {radius: 0.6, "
                 "height: -0.6}, {radius: 0.6, height: -0.5}, {radius: %g, height: -0.5}]}\n"
                 "walls:\n  - {name: cylinder, shape: cylinder, material: glass}\n"
                 "  - {name: cone, shape: cone, material: glass}\n  - {name: floor, shape: floor, material: glass}\n"
                 "  - {name: lid, shape: lid, material: glass, position: [0, 0, 0.55]}\n",
                 orifices[k], orifices[k]);
        const char *messages = check_turned(text);
        if (orifices[k] < 0.1) SCREE_CHECK_CONTAINS(messages, "\"cylinder\", \"cone\", \"floor\" and \"lid\" close");
        else SCREE_CHECK(messages[0] == '\0');
    }
}

int main(void)
{
    SCREE_RUN(test_box_of_plates);
    SCREE_RUN(test_boxes_at_random);
    SCREE_RUN(test_drum);
    SCREE_RUN(test_silo);
    return SCREE_TEST_END();
}
