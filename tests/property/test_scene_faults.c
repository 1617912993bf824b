// Scenes broken at random: whatever is done to a text, the reader neither crashes nor leaks (the checked build looks),
// it refuses exactly when it has told a fault, what it accepts reads the same again from its own text, and of several
// values made impossible at once every one is told, with its line.
#include "harness.h"
#include "io/scene_schema.h"
#include "scree/scene.h"

#include <stdlib.h>

static const char base_text[] =
    "name: base # a comment\n"
    "gravity: [0, 0, -9.81]\n"
    "time:\n"
    "  end: 2.4\n"
    "  step: 1e-5\n"
    "materials:\n"
    "  - {name: rock, density: 2700, youngs_modulus: 2e7, poisson_ratio: 0.25, shear_modulus: auto}\n"
    "  - {name: plate, density: 7850, youngs_modulus: 1e8, poisson_ratio: 0.25}\n"
    "contact_laws:\n"
    "  - {materials: [rock, rock], friction_coefficient: 0.39, damping_ratio: 0.45}\n"
    "  - {materials: [rock, plate], friction_coefficient: 0.35, restitution_coefficient: 0.5, attraction: true}\n"
    "shapes:\n"
    "  - {name: rock, source: rock, triangles: 40, seed: 7}\n"
    "  - {name: slab, source: box, size: &size [0.5, 0.1, 0.01]}\n"
    "  - {name: other, source: box, size: *size}\n"
    "particles:\n"
    "  - name: fill\n"
    "    shape: \"rock\"\n"
    "    material: rock\n"
    "    size: {distribution: normal, mean: 0.010, deviation: 0.005, min: 0.005, max: 0.010}\n"
    "    mass: 1.0\n"
    "    region: {min: [0.1, 0, 0.5], max: [0.3, 0.1, 0.9]}\n"
    "  - name: one\n"
    "    shape: other\n"
    "    material: rock\n"
    "    bodies:\n"
    "    - position: [0, 0, 1]\n"
    "      angular_velocity: [1, 2, 3]\n"
    "walls:\n"
    "  - name: door\n"
    "    shape: slab\n"
    "    material: plate\n"
    "    motion: {kind: rotate, axis: [0, 1, 0], angular_velocity: 8, start: 0.5, end: never}\n"
    "    removed_at: never\n"
    "solver: {skin: 0.1, overlap_scheme: filtered}\n"
    "output: {series: 0.01, frames: auto}\n"
    "repose: {measure: true, from: 0, to: 0.3, bins: 20}\n";

static uint64_t random_state;

static int64_t pick(int64_t num) { return (int64_t)(scree_test_random(&random_state) * (double)num); }

/// Reads a text and checks what must hold for any. Returns the status.
static scree_status judge(const char *text, const char *override)
{
    scree_scene_file file;
    scree_report report = {0};
    const scree_status status =
        scree_scene_parse(&file, text, "base.yaml", &override, override != NULL ? 1 : 0, &report);
    const int num_faults = scree_report_num_faults(&report);
    bool is_right = status == SCREE_OK || status == SCREE_INVALID_INPUT;
    is_right &= (status == SCREE_OK) == (num_faults == 0) && (status == SCREE_OK) == (file.owned != NULL);
    is_right &= (status == SCREE_OK) == (file.text != NULL);
    for (int k = 0; k < report.num_messages; ++k)
    {
        const char *message = report.messages[k];
        if (strncmp(message, "warning: ", 9) == 0) message += 9;
        // where, and without raw control characters
        is_right &= strncmp(message, "base.yaml", 9) == 0 || strncmp(message, "--set ", 6) == 0;
        if (override == NULL)
            for (; *message != '\0'; ++message) is_right &= (unsigned char)*message >= 0x20;
    }
    if (status == SCREE_OK)
    {
        scree_scene_file again;
        scree_report second = {0};
        is_right &= scree_scene_parse(&again, file.text, "base.yaml", NULL, 0, &second) == SCREE_OK;
        is_right &= again.text != NULL && strcmp(again.text, file.text) == 0;
        is_right &= second.num_messages <= report.num_messages;
        scree_scene_close(&again);
        scree_report_clear(&second);
    }
    if (!is_right)
    {
        printf("status %d, override %s, messages:\n", (int)status, override != NULL ? override : "none");
        for (int k = 0; k < report.num_messages; ++k) printf("  %s\n", report.messages[k]);
        printf("%s\n", text);
    }
    SCREE_CHECK(is_right);
    scree_scene_close(&file);
    scree_report_clear(&report);
    return status;
}

static void test_base_is_right(void) { SCREE_CHECK_INT(judge(base_text, NULL), SCREE_OK); }

static void test_every_beginning_of_a_file(void)
{
    char text[sizeof base_text];
    for (size_t length = 0; length < sizeof base_text; ++length)
    {
        memcpy(text, base_text, length);
        text[length] = '\0';
        judge(text, NULL);
    }
}

/// Bytes are changed, removed, doubled, moved; most of what comes out is not even YAML.
static void test_random_bytes(void)
{
    static const char bytes[] = "{}[]:,-#&*!|>'\"%@`\t\n ~.0123456789eE+abyz\x01\x7f\x80\xc3\xa4\xff<=?";
    const int64_t length = (int64_t)sizeof base_text - 1;
    int num_accepted = 0;
    random_state = 11;
    for (int trial = 0; trial < 4000; ++trial)
    {
        char text[2 * sizeof base_text];
        strcpy(text, base_text);
        for (int64_t change = pick(4) == 0 ? 2 : 0; change >= 0; --change)
        {
            const int64_t at = pick(length - 60), size = 1 + pick(20);
            switch (pick(5))
            {
            case 0:
                text[at] = bytes[pick((int64_t)sizeof bytes - 1)];
                break;
            case 1:
                text[at] = (char)('0' + pick(10));
                break;
            case 2:
                memmove(text + at, text + at + size, strlen(text + at + size) + 1);
                break;
            case 3:
                memmove(text + at + size, text + at, strlen(text + at) + 1);
                break;
            default:
                memmove(text + at, text + pick(length - 60), (size_t)size);
                break;
            }
        }
        num_accepted += judge(text, NULL) == SCREE_OK;
    }
    printf("%d of 4000 texts accepted\n", num_accepted);
    // both answers must be among those seen, or the test says nothing
    SCREE_CHECK(num_accepted > 100 && num_accepted < 3500);
}

/// The path of a random key: "particles.1.bodies.0.position.2".
static void random_path(char *path, size_t size)
{
    static const char *const items[] = {"0", "1", "2", "rock", "one", "x", ""};
    const scree_scene_section *section = scree_scene_root();
    size_t length = 0;
    path[0] = '\0';
    while (section != NULL && length + 100 < size)
    {
        const int key = (int)pick(section->num_keys);
        const bool is_list = section->fields[key].value.type == CYAML_SEQUENCE ||
                             section->fields[key].value.type == CYAML_SEQUENCE_FIXED;
        length +=
            (size_t)snprintf(path + length, size - length, "%s%s", length > 0 ? "." : "", section->keys[key].name);
        if (is_list && pick(4) > 0) length += (size_t)snprintf(path + length, size - length, ".%s", items[pick(7)]);
        section = pick(8) > 0 ? section->keys[key].section : NULL;
    }
}

static void test_random_overrides(void)
{
    static const char *const values[] = {
        "1",    "0",        "-1",        "1e300",  "auto", "never", "nan",       "true",        "",  "~",
        "[]",   "{}",       "[1, 2, 3]", "[a, b]", "rock", "fixed", "{name: 3}", "[1, [2], 3]", "'", "1e-400",
        "\x01", "[{}, {}]", "0.5",       "rotate", "box",  "*size", "&a [*a]",   "- 1"};
    int num_accepted = 0;
    random_state = 12;
    for (int trial = 0; trial < 4000; ++trial)
    {
        char override[600];
        random_path(override, 500);
        strcat(strcat(override, "="), values[pick((int64_t)(sizeof values / sizeof values[0]))]);
        num_accepted += judge(base_text, override) == SCREE_OK;
    }
    printf("%d of 4000 overrides accepted\n", num_accepted);
    SCREE_CHECK(num_accepted > 200 && num_accepted < 3500);
}

/// A value of the base scene that has a line to itself in the messages, and something it cannot be.
typedef struct sabotage
{
    const char *good, *bad;
    const char *key; ///< must stand in the message
} sabotage;

static const sabotage sabotages[] = {
    {"-9.81", "down", "gravity.2"},
    {"2.4", "-2.4", "end of time"},
    {"1e-5", "0", "step of time"},
    {"2700", "0", "density of materials.0"},
    {"7850", "heavy", "density of materials.1"},
    {"0.39", "-0.39", "friction_coefficient of contact_laws.0"},
    {"restitution_coefficient: 0.5", "restitution_coefficient: 1.5", "restitution_coefficient of contact_laws.1"},
    {"triangles: 40", "triangles: 2", "triangles of shapes.0"},
    {"[0.5, 0.1, 0.01]", "[0.5, 0.1]", "size of shapes.1"},
    {"\"rock\"", "\"brick\"", "shape of particles.0"},
    {"deviation: 0.005", "deviation: -1", "deviation of particles.0.size"},
    {"mass: 1.0", "mass: 1 kg", "mass of particles.0"},
    {"max: [0.3, 0.1, 0.9]", "max: [0.3, 0.1, 0.1]", "region of particles.0"},
    {"position: [0, 0, 1]", "place: [0, 0, 1]", "position of particles.1.bodies.0"},
    {"axis: [0, 1, 0]", "axis: [0, 0, 0]", "axis of walls.0.motion"},
    {"skin: 0.1", "skin: thick", "skin of solver"},
    {"frames: auto", "frames: never", "frames of output"},
    {"bins: 20", "bins: 1000", "bins of repose"},
};
enum
{
    NUM_SABOTAGES = sizeof sabotages / sizeof sabotages[0]
};

static void replace(char *text, const char *good, const char *bad)
{
    char *at = strstr(text, good);
    SCREE_CHECK(at != NULL);
    if (at == NULL) return;
    memmove(at + strlen(bad), at + strlen(good), strlen(at + strlen(good)) + 1);
    memcpy(at, bad, strlen(bad));
}

static int line_of(const char *part)
{
    int line = 1;
    for (const char *c = base_text; c < strstr(base_text, part); ++c) line += *c == '\n';
    return line;
}

/// True if some message is about this fault in this line.
static bool is_told(const scree_report *report, const sabotage *fault)
{
    char place[40];
    snprintf(place, sizeof place, "base.yaml:%d: ", line_of(fault->good));
    // a missing key is told where its section starts, which for this one is the same line
    for (int k = 0; k < report->num_messages; ++k)
        if (strncmp(report->messages[k], place, strlen(place)) == 0 && strstr(report->messages[k], fault->key) != NULL)
            return true;
    return false;
}

static void test_all_faults_at_once(void)
{
    random_state = 13;
    for (int trial = 0; trial < 1000; ++trial)
    {
        char text[2 * sizeof base_text];
        strcpy(text, base_text);
        bool is_chosen[NUM_SABOTAGES];
        int num_chosen = 0;
        for (int k = 0; k < NUM_SABOTAGES; ++k)
        {
            // each alone once, all together once, random choices for the rest
            is_chosen[k] = trial < NUM_SABOTAGES ? k == trial : trial == NUM_SABOTAGES || pick(3) == 0;
            num_chosen += is_chosen[k];
            if (is_chosen[k]) replace(text, sabotages[k].good, sabotages[k].bad);
        }
        scree_scene_file file;
        scree_report report = {0};
        const scree_status status = scree_scene_parse(&file, text, "base.yaml", NULL, 0, &report);
        SCREE_CHECK_INT(status, num_chosen > 0 ? SCREE_INVALID_INPUT : SCREE_OK);
        int num_told = 0;
        for (int k = 0; k < NUM_SABOTAGES; ++k)
        {
            const bool told = is_told(&report, sabotages + k);
            if (told != is_chosen[k]) printf("trial %d: %s told %d\n", trial, sabotages[k].key, told);
            SCREE_CHECK(told == is_chosen[k]);
            num_told += told;
        }
        // nothing else may be said but the size that is an alias and the key that became unknown
        const int allowed = num_told + is_chosen[8] + is_chosen[13];
        if (scree_report_num_faults(&report) > allowed)
            for (int k = 0; k < report.num_messages; ++k) printf("trial %d: %s\n", trial, report.messages[k]);
        SCREE_CHECK(scree_report_num_faults(&report) <= allowed);
        scree_report_clear(&report);
        scree_scene_close(&file);
    }
}

int main(void)
{
    SCREE_RUN(test_base_is_right);
    SCREE_RUN(test_every_beginning_of_a_file);
    SCREE_RUN(test_random_bytes);
    SCREE_RUN(test_random_overrides);
    SCREE_RUN(test_all_faults_at_once);
    return SCREE_TEST_END();
}
