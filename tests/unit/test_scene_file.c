// The scene reader: values in the structures, defaults, overrides, and what it says of faults.
#define _POSIX_C_SOURCE 200809L
#include "harness.h"
#include "io/nearest_name.h"
#include "io/scene_schema.h"
#include "scree/scene.h"
#include "test_folder.h"

#include <fcntl.h>
#include <locale.h>
#include <stdlib.h>
#include <unistd.h>

/// Everything that a scene can hold, with no value at its default.
static const char full_text[] =
    "name: everything\n"
    "gravity: [0.5, -1.5, -9.75]\n"
    "time: {end: 2.5, step: 1e-4, step_fraction: 0.25}\n"
    "materials:\n"
    "  - {name: rock, density: 2700, youngs_modulus: 2e7, poisson_ratio: 0.25, shear_modulus: 1.5e7}\n"
    "  - {name: plate, density: 7850, youngs_modulus: 1e8, poisson_ratio: 0.125}\n"
    "contact_laws:\n"
    "  - {materials: [rock, rock], model: linear_spring, friction_coefficient: 0.39, damping_ratio: 0.5, "
    "tangential_damping_ratio: 0.25, normal_stiffness: 2e5, tangential_stiffness: 1e5, rolling_resistance: spring, "
    "rolling_friction_coefficient: 0.125, rolling_damping_ratio: 0.75}\n"
    "  - materials: [plate, rock]\n"
    "    model: hertz_mindlin\n"
    "    friction_coefficient: 0.75\n"
    "    restitution_coefficient: 0.3125\n"
    "    stiffness_factor: 0.62\n"
    "    tangential_spring: 0\n"
    "    attraction: true\n"
    "    shear_mixing: bilock\n"
    "shapes:\n"
    "  - {name: rock, source: rock, size: 0.5, triangles: 40, seed: 7}\n"
    "  - {name: slab, source: box, size: [1, 2, 3]}\n"
    "  - {name: mesh, source: file, file: meshes/a b.obj, scale: 1e-3, triangles: 1e2}\n"
    "  - {name: ball, source: sphere, size: [0.25, 0, 0], triangles: 80}\n"
    "  - {name: tetra, source: tetrahedron}\n"
    "  - {name: twist, source: schoenhardt}\n"
    "particles:\n"
    "  - name: fill\n"
    "    shape: rock\n"
    "    material: rock\n"
    "    size: {distribution: normal, mean: 0.01, deviation: 0.005, min: 0.004, max: 0.02}\n"
    "    mass: 1.5\n"
    "    region: {min: [-1, -2, -3], max: [4, 5, 6]}\n"
    "    spacing: 1.25\n"
    "    seed: 9007199254740992\n"
    "    velocity: [1, 2, 3]\n"
    "  - {name: listed, shape: mesh, material: rock, size: {distribution: fixed, mean: 0.125},\n"
    "     bodies: [{position: [1, 2, 3], orientation: [0, 1, 0, 0], size: 0.5, velocity: [4, 5, 6],\n"
    "               angular_velocity: [7, 8, 9]}]}\n"
    "  - {name: many, shape: ball, material: rock, size: {distribution: uniform, min: 1, max: 2}, count: 12,\n"
    "     region: {max: [1, 1, 1]}}\n"
    "walls:\n"
    "  - {name: floor, shape: slab, material: plate, position: [0, 1, 2], orientation: [0.5, 0.5, -0.5, 0.5]}\n"
    "  - {name: lift, shape: tetra, material: plate, removed_at: 2,\n"
    "     motion: {kind: translate, velocity: [1, 0, -1], start: 0.5, end: 1.5}}\n"
    "  - {name: drum, shape: twist, material: plate,\n"
    "     motion: {kind: rotate, axis: [0, 2, 0], centre: [1, 2, 3], angular_velocity: -8}}\n"
    "solver: {skin: 0.3, overlap_scheme: hierarchy, find_separation: false}\n"
    "output: {series: 0.01, frames: 0.5, checkpoint: 0}\n"
    "repose: {measure: true, from: -0.5, to: 0.25, base: 0.125, bins: 33}\n";

/// A scene without values that could be left out.
static const char small_text[] = "time: {end: 2}\n"
                                 "materials:\n"
                                 "  - {name: rock, density: 2700, youngs_modulus: 2e7, poisson_ratio: 0.25}\n"
                                 "contact_laws:\n"
                                 "  - {materials: [rock, rock], friction_coefficient: 0.4, damping_ratio: 0}\n"
                                 "shapes:\n"
                                 "  - {name: cube, source: box}\n"
                                 "particles:\n"
                                 "  - {name: one, shape: cube, material: rock, bodies: [{position: [0, 0, 1]}]}\n"
                                 "walls:\n"
                                 "  - {name: floor, shape: cube, material: rock}\n";

static scree_status parse(scree_scene_file *file, const char *text, scree_report *report)
{
    return scree_scene_parse(file, text, "folder/test.yaml", NULL, 0, report);
}

/// All messages of a scene with one override (or NULL) in one text, which the caller frees.
static char *messages_of(const char *text, const char *override, scree_status expected)
{
    scree_scene_file file;
    scree_report report = {0};
    SCREE_CHECK_INT(scree_scene_parse(&file, text, "test.yaml", &override, override != NULL ? 1 : 0, &report),
                    expected);
    SCREE_CHECK((expected == SCREE_OK) == (scree_report_num_faults(&report) == 0));
    size_t size = 1;
    for (int k = 0; k < report.num_messages; ++k) size += strlen(report.messages[k]) + 1;
    char *all = calloc(size, 1);
    for (int k = 0; all != NULL && k < report.num_messages; ++k)
    {
        strcat(all, report.messages[k]);
        strcat(all, "\n");
    }
    scree_report_clear(&report);
    scree_scene_close(&file);
    return all;
}

static bool equal3(const double *v, double x, double y, double z) { return v[0] == x && v[1] == y && v[2] == z; }

static void check_full_definitions(const scree_scene *s)
{
    SCREE_CHECK(strcmp(s->name, "everything") == 0);
    SCREE_CHECK(equal3(s->gravity, 0.5, -1.5, -9.75));
    SCREE_CHECK(s->time.end == 2.5 && s->time.step == 1e-4 && s->time.step_fraction == 0.25);
    SCREE_CHECK_INT(s->num_materials, 2);
    SCREE_CHECK(strcmp(s->materials[0].name, "rock") == 0 && s->materials[0].density == 2700);
    SCREE_CHECK(s->materials[0].youngs_modulus == 2e7 && s->materials[0].poisson_ratio == 0.25);
    SCREE_CHECK(s->materials[0].shear_modulus == 1.5e7 && isnan(s->materials[1].shear_modulus));
    SCREE_CHECK_INT(s->num_contact_laws, 2);
    const scree_contact_law_def *law = s->contact_laws + 1;
    SCREE_CHECK(strcmp(law->materials[0], "plate") == 0 && strcmp(law->materials[1], "rock") == 0);
    SCREE_CHECK(strcmp(law->model, "hertz_mindlin") == 0);
    SCREE_CHECK(law->friction_coefficient == 0.75 && law->restitution_coefficient == 0.3125);
    SCREE_CHECK(isnan(law->damping_ratio) && law->stiffness_factor == 0.62 && law->tangential_spring == 0);
    SCREE_CHECK(law->attraction && law->shear_mixing == SCREE_SHEAR_BILOCK);
    --law;
    SCREE_CHECK(strcmp(law->model, "linear_spring") == 0 && law->normal_stiffness == 2e5);
    SCREE_CHECK(law->tangential_stiffness == 1e5 && law->tangential_damping_ratio == 0.25);
    SCREE_CHECK(law->damping_ratio == 0.5 && isnan(law->restitution_coefficient));
    SCREE_CHECK(law->rolling_resistance == SCREE_ROLLING_SPRING && law->rolling_friction_coefficient == 0.125);
    SCREE_CHECK(law->rolling_damping_ratio == 0.75);
    SCREE_CHECK_INT(s->num_shapes, 6);
    SCREE_CHECK(s->shapes[0].source == SCREE_SHAPE_ROCK && equal3(s->shapes[0].size, 0.5, 0.5, 0.5));
    SCREE_CHECK(s->shapes[0].triangles == 40 && s->shapes[0].seed == 7 && s->shapes[0].scale == 1);
    SCREE_CHECK(s->shapes[0].file[0] == '\0');
    SCREE_CHECK(s->shapes[1].source == SCREE_SHAPE_BOX && equal3(s->shapes[1].size, 1, 2, 3));
    SCREE_CHECK(s->shapes[2].source == SCREE_SHAPE_FILE && s->shapes[2].triangles == 100);
    SCREE_CHECK(strcmp(s->shapes[2].file, "meshes/a b.obj") == 0 && s->shapes[2].scale == 0.001);
    SCREE_CHECK(s->shapes[3].source == SCREE_SHAPE_SPHERE && equal3(s->shapes[3].size, 0.25, 0, 0));
    SCREE_CHECK(s->shapes[4].source == SCREE_SHAPE_TETRAHEDRON && s->shapes[5].source == SCREE_SHAPE_SCHOENHARDT);
}

static void check_full_bodies(const scree_scene *s)
{
    SCREE_CHECK_INT(s->num_particles, 3);
    const scree_particle_group_def *fill = s->particles, *listed = s->particles + 1, *many = s->particles + 2;
    SCREE_CHECK(strcmp(fill->name, "fill") == 0 && strcmp(fill->shape, "rock") == 0);
    SCREE_CHECK(strcmp(fill->material, "rock") == 0 && fill->size.distribution == SCREE_SIZE_NORMAL);
    SCREE_CHECK(fill->size.mean == 0.01 && fill->size.deviation == 0.005);
    SCREE_CHECK(fill->size.min == 0.004 && fill->size.max == 0.02);
    SCREE_CHECK(fill->count == 0 && fill->mass == 1.5 && fill->spacing == 1.25 && fill->seed == 9007199254740992);
    SCREE_CHECK(equal3(fill->region.min, -1, -2, -3) && equal3(fill->region.max, 4, 5, 6));
    SCREE_CHECK(equal3(fill->velocity, 1, 2, 3) && fill->num_bodies == 0);
    SCREE_CHECK(listed->size.distribution == SCREE_SIZE_FIXED && listed->size.mean == 0.125);
    SCREE_CHECK_INT(listed->num_bodies, 1);
    const scree_body_def *body = listed->bodies;
    SCREE_CHECK(equal3(body->position, 1, 2, 3) && equal3(body->velocity, 4, 5, 6));
    SCREE_CHECK(equal3(body->angular_velocity, 7, 8, 9) && body->size == 0.5);
    SCREE_CHECK(equal3(body->orientation, 0, 1, 0) && body->orientation[3] == 0);
    SCREE_CHECK(many->size.distribution == SCREE_SIZE_UNIFORM && many->count == 12 && many->mass == 0);
    SCREE_CHECK(equal3(many->region.min, 0, 0, 0) && equal3(many->region.max, 1, 1, 1));
    SCREE_CHECK_INT(s->num_walls, 3);
    const scree_wall_def *floor = s->walls, *lift = s->walls + 1, *drum = s->walls + 2;
    SCREE_CHECK(floor->motion.kind == SCREE_MOTION_FIXED && isinf(floor->removed_at) && floor->removed_at > 0);
    SCREE_CHECK(equal3(floor->position, 0, 1, 2) && equal3(floor->orientation, 0.5, 0.5, -0.5));
    SCREE_CHECK(lift->motion.kind == SCREE_MOTION_TRANSLATE && equal3(lift->motion.velocity, 1, 0, -1));
    SCREE_CHECK(lift->motion.start == 0.5 && lift->motion.end == 1.5 && lift->removed_at == 2);
    SCREE_CHECK(drum->motion.kind == SCREE_MOTION_ROTATE && equal3(drum->motion.axis, 0, 2, 0));
    SCREE_CHECK(equal3(drum->motion.centre, 1, 2, 3) && drum->motion.angular_velocity == -8);
    SCREE_CHECK(drum->motion.start == 0 && isinf(drum->motion.end));
    SCREE_CHECK(s->solver.skin == 0.3 && !s->solver.find_separation && s->solver.reuse_pairs);
    SCREE_CHECK(strcmp(s->solver.overlap_scheme, "hierarchy") == 0);
    SCREE_CHECK(s->output.series == 0.01 && s->output.frames == 0.5 && s->output.checkpoint == 0);
    SCREE_CHECK(s->repose.measure && s->repose.from == -0.5 && s->repose.to == 0.25);
    SCREE_CHECK(s->repose.base == 0.125 && s->repose.bins == 33);
}

static void test_every_key_reaches_its_field(void)
{
    scree_scene_file file;
    scree_report report = {0};
    SCREE_CHECK_INT(parse(&file, full_text, &report), SCREE_OK);
    for (int k = 0; k < report.num_messages; ++k) printf("%s\n", report.messages[k]);
    SCREE_CHECK_INT(report.num_messages, 0);
    if (file.owned != NULL)
    {
        check_full_definitions(&file.scene);
        check_full_bodies(&file.scene);
        SCREE_CHECK(strcmp(file.folder, "folder") == 0);
    }
    scree_scene_close(&file);
    scree_report_clear(&report);
}

static void test_defaults(void)
{
    scree_scene_file file;
    SCREE_CHECK_INT(parse(&file, small_text, NULL), SCREE_OK);
    const scree_scene *s = &file.scene;
    if (file.owned == NULL) return;
    SCREE_CHECK(strcmp(s->name, "scene") == 0 && equal3(s->gravity, 0, 0, -9.81));
    SCREE_CHECK(isnan(s->time.step) && s->time.step_fraction == 0.5);
    SCREE_CHECK(isnan(s->materials[0].shear_modulus));
    const scree_contact_law_def *law = s->contact_laws;
    SCREE_CHECK(strcmp(law->model, "hertz_mindlin") == 0 && isnan(law->restitution_coefficient));
    SCREE_CHECK(isnan(law->stiffness_factor) && isnan(law->normal_stiffness) && isnan(law->tangential_stiffness));
    SCREE_CHECK(law->rolling_resistance == SCREE_ROLLING_NONE && isnan(law->rolling_friction_coefficient));
    SCREE_CHECK(law->tangential_spring == 1 && !law->attraction && law->shear_mixing == SCREE_SHEAR_MINDLIN);
    SCREE_CHECK(equal3(s->shapes[0].size, 1, 1, 1) && s->shapes[0].triangles == 0);
    SCREE_CHECK(s->particles[0].size.distribution == SCREE_SIZE_AS_SHAPE && s->particles[0].spacing == 1.05);
    SCREE_CHECK(isnan(s->particles[0].bodies[0].size) && s->particles[0].bodies[0].orientation[0] == 1);
    SCREE_CHECK(s->walls[0].orientation[0] == 1 && isinf(s->walls[0].motion.end) && isinf(s->walls[0].removed_at));
    SCREE_CHECK(isnan(s->solver.skin) && s->solver.reuse_pairs && s->solver.compare_spheres);
    SCREE_CHECK(s->solver.find_separation && s->solver.remember_separation && s->solver.bound_separation);
    SCREE_CHECK(strcmp(s->solver.overlap_scheme, "filtered") == 0);
    SCREE_CHECK_CLOSE(s->output.series, 2.0 / 200, 1e-16);
    SCREE_CHECK_CLOSE(s->output.frames, 2.0 / 50, 1e-16);
    SCREE_CHECK_CLOSE(s->output.checkpoint, 2.0 / 10, 1e-16);
    SCREE_CHECK(!s->repose.measure && s->repose.bins == 20);
    // automatic values stay so in the text
    SCREE_CHECK_CONTAINS(file.text, "step: auto");
    SCREE_CHECK_CONTAINS(file.text, "series: auto");
    SCREE_CHECK_CONTAINS(file.text, "removed_at: never");
    scree_scene_close(&file);
}

static void test_text_with_defaults_reads_the_same(void)
{
    const char *const texts[] = {full_text, small_text};
    for (int k = 0; k < 2; ++k)
    {
        scree_scene_file first, second;
        scree_report report = {0};
        SCREE_CHECK_INT(parse(&first, texts[k], NULL), SCREE_OK);
        if (first.text == NULL) continue;
        SCREE_CHECK_INT(parse(&second, first.text, &report), SCREE_OK);
        SCREE_CHECK_INT(report.num_messages, 0);
        SCREE_CHECK(second.text != NULL && strcmp(first.text, second.text) == 0);
        if (k == 0 && second.owned != NULL) check_full_definitions(&second.scene), check_full_bodies(&second.scene);
        scree_scene_close(&first);
        scree_scene_close(&second);
        scree_report_clear(&report);
    }
}

static void test_overrides(void)
{
    const char *const overrides[] = {"time.end=3",
                                     "gravity.2=-1.5",
                                     "gravity.0=0.25",
                                     "materials.rock.density=1000",
                                     "materials.0.shear_modulus=1e6",
                                     "contact_laws.0.friction_coefficient=0.75",
                                     "particles.one.bodies.0.position=[1, 2, 3]",
                                     "particles.0.bodies.0.position.1=9",
                                     "particles.one.bodies.0.velocity.2=-4",
                                     "walls.floor.motion.kind=translate",
                                     "walls.floor.motion.velocity=[0, 0, 1]",
                                     "solver={skin: 0.5}",
                                     "name=a = b",
                                     "time.end=4"};
    scree_scene_file file;
    scree_report report = {0};
    const int num = (int)(sizeof overrides / sizeof overrides[0]);
    SCREE_CHECK_INT(scree_scene_parse(&file, small_text, "x.yaml", overrides, num, &report), SCREE_OK);
    for (int k = 0; k < report.num_messages; ++k) printf("%s\n", report.messages[k]);
    const scree_scene *s = &file.scene;
    if (file.owned != NULL)
    {
        SCREE_CHECK(s->time.end == 4); // the last one counts
        SCREE_CHECK(equal3(s->gravity, 0.25, 0, -1.5));
        SCREE_CHECK(s->materials[0].density == 1000 && s->materials[0].shear_modulus == 1e6);
        SCREE_CHECK(s->contact_laws[0].friction_coefficient == 0.75);
        SCREE_CHECK(equal3(s->particles[0].bodies[0].position, 1, 9, 3));
        SCREE_CHECK(equal3(s->particles[0].bodies[0].velocity, 0, 0, -4));
        SCREE_CHECK(s->walls[0].motion.kind == SCREE_MOTION_TRANSLATE && s->walls[0].motion.velocity[2] == 1);
        SCREE_CHECK(s->solver.skin == 0.5);
        SCREE_CHECK(strcmp(s->name, "a = b") == 0);
        SCREE_CHECK(strcmp(file.folder, ".") == 0);
    }
    scree_scene_close(&file);
    scree_report_clear(&report);

    // a scene can be emptied as well
    char *messages = messages_of(small_text, "walls=[]", SCREE_OK);
    SCREE_CHECK(strcmp(messages, "") == 0);
    free(messages);
}

/// A text or an override, and what must be said about it.
typedef struct fault_case
{
    const char *input, *message;
} fault_case;

static void test_faults_of_overrides(void)
{
    static const fault_case cases[] = {
        {"tim.end=3", "--set tim.end=3: there is no key \"tim\" in scene; did you mean \"time\"?"},
        {"time.end=-1", "--set time.end=-1: end of time is -1; it must be a number in [0, 1e+09] s"},
        {"time.end=", "end of time has no value"},
        {"time.end.x=1", "end is a single value; remove \".x\""},
        {"time.end=[1, 2", "--set time.end=[1, 2:2:1: did not find expected"},
        {"time.end", "an override is written PATH=VALUE"},
        {"=3", "an override is written PATH=VALUE"},
        {".=3", "there is no key \"\" in scene"},
        {"materials.rok.density=3", "no item \"rok\" in materials; did you mean \"rock\"?"},
        {"materials.1.density=3", "no item \"1\" in materials; take a number from 0 to 0 or a name"},
        {"materials.99999999999999999999.density=3", "no item \"99999999999999999999\" in materials"},
        {"materials.-1.density=3", "no item \"-1\" in materials"},
        {"gravity.3=1", "no item \"3\" in gravity; take a number from 0 to 2"},
        {"gravity.0.0=1", "item 0 of gravity has no keys; remove \".0\""},
        {"materials.0=5", "materials.0 is 5; it must be a section with keys"},
        {"particles.one.bodies.0.position.0=abc", "position.0 of particles.0.bodies.0 is \"abc\"; it must be a number"},
        {"particles.one.shape=cub", "shape of particles.0 is \"cub\", which is not among the shapes; did you mean"},
        {"contact_laws=[]",
         "contact_laws has none for \"rock\" and \"rock\", which can meet in particles.0 and walls.0"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k)
    {
        char *messages = messages_of(small_text, cases[k].input, SCREE_INVALID_INPUT);
        SCREE_CHECK_CONTAINS(messages, cases[k].message);
        free(messages);
    }
}

/// Replaces one line (from 1) of the full scene.
static char *with_line(int line, const char *replacement)
{
    const char *from = full_text;
    for (int k = 1; k < line; ++k) from = strchr(from, '\n') + 1;
    const char *rest = strchr(from, '\n');
    char *text = malloc(sizeof full_text + strlen(replacement));
    if (text == NULL) exit(1);
    memcpy(text, full_text, (size_t)(from - full_text));
    strcpy(text + (from - full_text), replacement);
    strcat(text, rest);
    return text;
}

static void test_faults_of_contact_laws(void)
{
    static const struct
    {
        int line;
        const char *replacement, *message;
    } cases[] = {
        {8, "  - {materials: [rock, rock], friction_coefficient: 0.39}",
         "test.yaml:8: contact_laws.0 has neither restitution_coefficient nor damping_ratio"},
        {8, "  - {materials: [rock, rock], friction_coefficient: 0, damping_ratio: 0, restitution_coefficient: 1}",
         "contact_laws.0 has both restitution_coefficient and damping_ratio"},
        {8, "  - {materials: [rock, rick], friction_coefficient: 0, damping_ratio: 0}",
         "test.yaml:8: materials.1 of contact_laws.0 is \"rick\", which is not among the materials; did you mean "
         "\"rock\"?"},
        {8, "  - {materials: [rock, plate], friction_coefficient: 0, damping_ratio: 0}",
         "contact_laws.1 is for \"plate\" and \"rock\", and so is contact_laws.0"},
        {8, "", "contact_laws has none for \"rock\" and \"rock\""},
        {8,
         "  - {materials: [rock, rock], model: linear_spring, friction_coefficient: 0, damping_ratio: 0, "
         "stiffness_factor: 1}",
         "test.yaml:8: stiffness_factor of contact_laws.0 has no effect with model linear_spring; remove it"},
        {8, "  - {materials: [rock, rock], model: linear_spring, friction_coefficient: 0, damping_ratio: 0}",
         "test.yaml:8: contact_laws.0 has no normal_stiffness, which model linear_spring needs; add it"},
        {8,
         "  - {materials: [rock, rock], model: energy_conserving, friction_coefficient: 0, damping_ratio: 0, "
         "energy_exponent: 1.3}",
         "test.yaml:8: energy_exponent of contact_laws.0 is 1.3; it must be 1, 1.25, 1.5, 1.75 or 2"},
        {8, "  - {materials: [rock, rock], friction_coefficient: 0, damping_ratio: 0, normal_stiffness: 1e5}",
         "normal_stiffness of contact_laws.0 has no effect with model hertz_mindlin"},
        {8, "  - {materials: [rock, rock], friction_coefficient: 0, damping_ratio: 0, rolling_resistance: constant}",
         "contact_laws.0 has a rolling_resistance, but no rolling_friction_coefficient"},
        {8, "  - {materials: [rock, rock], friction_coefficient: 0, damping_ratio: 0, rolling_friction_coefficient: 1}",
         "contact_laws.0 has a rolling_friction_coefficient, but no rolling_resistance"},
        {8,
         "  - {materials: [rock, rock], friction_coefficient: 0, damping_ratio: 0, rolling_resistance: constant, "
         "rolling_friction_coefficient: 1, rolling_damping_ratio: 1}",
         "rolling_damping_ratio of contact_laws.0 has no effect with rolling_resistance constant"},
        {10, "    model: hook",
         "test.yaml:10: model of contact_laws.1 is \"hook\"; it must be hertz_mindlin, linear_spring or "
         "energy_conserving"},
        {12, "    restitution_coefficient: 1.3",
         "test.yaml:12: restitution_coefficient of contact_laws.1 is 1.3; it must be a number in [0.01, 1] or auto"},
        {14, "    tangential_spring: 0.5", "tangential_spring of contact_laws.1 is 0.5; it must be 0 or 1"},
        {15, "    attraction: yes", "attraction of contact_laws.1 is \"yes\"; it must be true or false"},
        {16, "    shear_mixing: bilok", "it must be mindlin or bilock; did you mean \"bilock\"?"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k)
    {
        char *text = with_line(cases[k].line, cases[k].replacement);
        char *messages = messages_of(text, NULL, SCREE_INVALID_INPUT);
        SCREE_CHECK_CONTAINS(messages, cases[k].message);
        free(messages);
        free(text);
    }
}

static void test_faults_of_values(void)
{
    static const struct
    {
        int line;
        const char *replacement, *message;
    } cases[] = {
        {1, "name: everything\nnme: x", "test.yaml:2: \"nme\" is no key of the scene; did you mean \"name\"?"},
        {1, "name: a\nname: b", "test.yaml:2: \"name\" is there twice in the scene, first in line 1"},
        {1, "name: ''", "test.yaml:1: name is \"\"; it must be a text"},
        {1, "<<: {name: x}", "merge keys are not supported"},
        {2, "gravity: [1, 2]",
         "test.yaml:2: gravity is a list of 2; it must be a list of 3 numbers in [-1e+06, 1e+06]"},
        {2, "gravity: [1, 2, x]", "test.yaml:2: gravity.2 is \"x\"; it must be a number in [-1e+06, 1e+06] m/s^2"},
        {2, "gravity: -9.81", "gravity is -9.81; it must be a list of 3 numbers"},
        {3, "time: {step: 1}", "test.yaml:3: end of time is missing; it must be a number in [0, 1e+09] s"},
        {3, "time: 3", "time is 3; it must be a section with keys, like end: ..."},
        {3, "time: {end: 1, step: never}", "step of time is \"never\"; it must be a number in [1e-15, 1000] s or auto"},
        {3, "time: {end: auto}", "end of time is \"auto\""},
        {3, "time: {end: 1e9, step: 1e-7}", "at most 1e15 are possible"},
        {5, "  - {name: rock, youngs_modulus: 2e7, poisson_ratio: 0.25}",
         "test.yaml:5: density of materials.0 is missing"},
        {6, "  - {name: rock, density: 1, youngs_modulus: 1e8, poisson_ratio: 0.1}",
         "test.yaml:6: name of materials.1 is \"rock\", which materials.0 is called already"},
        {6, "  - {name: 12, density: 1, youngs_modulus: 1e8, poisson_ratio: 0.1}",
         "name of materials.1 is 12; it must be"},
        {6, "  - {name: a.b, density: 1, youngs_modulus: 1e8, poisson_ratio: 0.1}", "name of materials.1 is \"a.b\""},
        {18, "  - {name: rock, source: rock, size: 0.5}", "test.yaml:18: triangles of shapes.0 is 0; a rock needs"},
        {19, "  - {name: slab, source: box, size: 20 mm}",
         "size of shapes.1 is \"20 mm\"; it must be a list of 3 numbers in [0, 1e+06] m, written without its unit"},
        {18, "  - {name: rock, source: rock, triangles: 4.5}", "triangles of shapes.0 is 4.5; it must be an integer"},
        {19, "  - {name: slab, source: box, size: [1, 0, 1]}", "size.1 of shapes.1 is 0; it must be above 0"},
        {20, "  - {name: mesh, source: file}", "test.yaml:20: file of shapes.2 is missing"},
        {27, "    material: wood", "material of particles.0 is \"wood\", which is not among the materials; add it"},
        {28, "    size: {distribution: normal, mean: 0.01, deviation: 0, min: 0.004, max: 0.02}",
         "test.yaml:28: deviation of particles.0.size is 0 m; it must be above 0 for normal"},
        {28, "    size: {distribution: uniform, min: 0.04, max: 0.02}", "min of particles.0.size is 0.04 m, above max"},
        {29, "    mass: 1.5\n    count: 3", "particles.0 has both count and mass"},
        {29, "", "particles.0 has neither count, mass nor bodies"},
        {30, "", "test.yaml:25: region of particles.0 is missing"},
        {30, "    region: {min: [0, 0, 0], max: [1, 0, 1]}",
         "region of particles.0 is empty: along y it goes from 0 to 0"},
        {34, "  - {name: listed, shape: mesh, material: rock, count: 3,",
         "test.yaml:34: count of particles.1 is given, but so are bodies"},
        {35, "     bodies: [{position: [1, 2, 3], orientation: [0, 0, 0, 0], size: 0.5, velocity: [4, 5, 6],",
         "orientation of particles.1.bodies.0 is [0, 0, 0, 0], which is no rotation"},
        {42, "     motion: {kind: translate, start: 0.5}}", "velocity of walls.1.motion is zero"},
        {42, "     motion: {kind: translate, velocity: [1, 0, 0], start: 0.5, end: 0.25}}",
         "test.yaml:42: walls.1.motion ends at 0.25 s, but starts at 0.5 s"},
        {44, "     motion: {kind: rotate, angular_velocity: 3}}", "axis of walls.2.motion is zero"},
        {44, "     motion: {kind: rotate, axis: [0, 0, 1]}}", "angular_velocity of walls.2.motion is zero"},
        {45, "solver: {overlap_scheme: exact}",
         "overlap_scheme of solver is \"exact\"; it must be filtered or hierarchy"},
        {47, "repose: {measure: true}", "the range of x from 0 to 0 is empty"},
        {47, "repose: {bins: 3}", "bins of repose is 3; it must be an integer in [4, 256]"},
        {47, "repose:", "repose is nothing; it must be a section"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k)
    {
        char *text = with_line(cases[k].line, cases[k].replacement);
        char *messages = messages_of(text, NULL, SCREE_INVALID_INPUT);
        SCREE_CHECK_CONTAINS(messages, cases[k].message);
        free(messages);
        free(text);
    }
}

static void test_faults_of_true_spheres(void)
{
    static const struct
    {
        int line;
        const char *replacement, *message;
    } cases[] = {
        {21, "  - {name: ball, source: sphere, triangles: 3}",
         "test.yaml:21: triangles of shapes.3 is 3; it must be 0 for a true sphere, or from 4 on for a mesh"},
        {21, "  - {name: ball, source: sphere, copies: 2}",
         "copies of shapes.3 is 2, but a true sphere (triangles: 0) cannot be repeated"},
        {22, "  - {name: tetra, source: sphere}",
         "shape of walls.1 is \"tetra\", a true sphere (triangles: 0), but walls are meshes"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k)
    {
        char *text = with_line(cases[k].line, cases[k].replacement);
        char *messages = messages_of(text, NULL, SCREE_INVALID_INPUT);
        SCREE_CHECK_CONTAINS(messages, cases[k].message);
        free(messages);
        free(text);
    }
}

static void test_warnings_of_keys_without_effect(void)
{
    static const struct
    {
        int line;
        const char *replacement, *message;
    } cases[] = {
        {19, "  - {name: slab, source: box, size: [1, 2, 3], triangles: 40}",
         "warning: test.yaml:19: triangles of shapes.1 is not used: the source fixes the number"},
        {5, "  - {name: rock, density: 2.7, youngs_modulus: 2e7, poisson_ratio: 0.25, shear_modulus: 1.5e7}",
         "warning: test.yaml:5: density of materials.0 is 2.7 kg/m^3, that of a foam"},
        {28, "    size: {mean: 0.01}", "warning: test.yaml:28: mean of particles.0.size is not used"},
        {40, "  - {name: floor, shape: slab, material: plate, motion: {velocity: [1, 0, 0]}}",
         "velocity of walls.0.motion is not used: the kind of motion is fixed"},

        {23, "  - {name: spare, source: schoenhardt}\n  - {name: twist, source: schoenhardt}",
         "warning: test.yaml:23: shapes.5, \"spare\", is not used"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k)
    {
        char *text = with_line(cases[k].line, cases[k].replacement);
        char *messages = messages_of(text, NULL, SCREE_OK);
        SCREE_CHECK_CONTAINS(messages, cases[k].message);
        free(messages);
        free(text);
    }
}

static void test_faults_of_syntax(void)
{
    static const fault_case cases[] = {
        {"", "test.yaml: there is nothing in it"},
        {"   \n# a comment\n", "there is nothing in it"},
        {"---\n...\n", "there is nothing in it"},
        {"hello", "the scene is \"hello\"; it must be a section"},
        {"- 1\n- 2\n", "the scene is a list of 2"},
        {"name: x\ntime: {end: 1\n", "test.yaml:3:1: did not find expected ',' or '}'"},
        {"time: {end: [1, 2}\n", "test.yaml:1:"},
        {"a: b: c\n", "test.yaml:1:5: mapping values are not allowed in this context; check the indentation"},
        {"time:\n  end: 1\n\tstep: 1\n", "test.yaml:3:1: found a tab character that violates indentation"},
        {"time:\n  end: 1\n\tstep: 1\n", "indent with spaces, not with tabs"},
        {"time: {end: 1}\n\tname: x\n", "test.yaml:2:1: found character that cannot start any token"},
        {"time: {end: 1}\n\tname: x\n", "indent with spaces, not with tabs"},
        {"name: \"abc\n", "close the quotes"},
        {"name: *x\n", "test.yaml:1:7: found undefined alias; an alias *x needs an anchor &x"},
        {"&a [*a]\n", "is an alias inside its own anchor?"},
        {"name: \"a\\0b\"\n", "test.yaml:1: a text holds a character zero"},
        {"time: {end: 1, step: 1}\n---\ntime: 2\n", "test.yaml:3: a second document starts here"},
        {"time: {end: 1, step: 1}\nname: \x01\n", "test.yaml:2: byte 30: control characters are not allowed"},
        {"time: {end: 1, step: 1}\nname: \xff\xfe\n", "a scene is a plain text in UTF-8"},
        {"\x7f"
         "ELF\x02\x01",
         "a scene is a plain text in UTF-8"},
        {"? [a, b]\n: c\ntime: {end: 1}\n", "a list of 2 is no key of the scene"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k)
    {
        char *messages = messages_of(cases[k].input, NULL, SCREE_INVALID_INPUT);
        SCREE_CHECK_CONTAINS(messages, cases[k].message);
        free(messages);
    }
}

static void test_numbers(void)
{
    static const struct
    {
        const char *text;
        double value; ///< NAN: refused
    } cases[] = {{"1", 1},       {"+1", 1},      {".5", 0.5},   {"5.", 5},      {"1e3", 1000},
                 {"1E-2", 0.01}, {"010", 10},    {"'3'", 3},    {"0.1", 0.1},   {"0x10", NAN},
                 {".inf", NAN},  {"inf", NAN},   {"nan", NAN},  {"1_000", NAN}, {"1,5", NAN},
                 {"1e", NAN},    {"1e400", NAN}, {"-0", 0},     {"1 s", NAN},   {"~", NAN},
                 {"true", NAN},  {"1.2.3", NAN}, {"--1", NAN},  {".", NAN},     {"1:30", NAN},
                 {"{}", NAN},    {"[1]", NAN},   {"1e+2", 100}, {"e5", NAN},    {"123456789", 123456789}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k)
    {
        char text[100];
        snprintf(text, sizeof text, "time: {end: %s, step: 1e-3}\n", cases[k].text);
        scree_scene_file file;
        const scree_status status = parse(&file, text, NULL);
        if ((status == SCREE_OK) == isnan(cases[k].value)) printf("with %s\n", cases[k].text);
        SCREE_CHECK_INT(status, isnan(cases[k].value) ? SCREE_INVALID_INPUT : SCREE_OK);
        if (status == SCREE_OK) SCREE_CHECK(file.scene.time.end == cases[k].value);
        scree_scene_close(&file);
    }
}

static void test_integers(void)
{
    static const struct
    {
        const char *text;
        int64_t value; ///< -1: refused
    } cases[] = {{"010", 10}, {"1e2", 100}, {"12.0", 12}, {"12.5", -1}, {"0x20", -1},
                 {"+33", 33}, {"1e30", -1}, {"-4", -1},   {"a", -1},    {"\"64\"", 64}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k)
    {
        char text[100];
        snprintf(text, sizeof text, "time: {end: 1, step: 1e-3}\nrepose: {bins: %s}\n", cases[k].text);
        scree_scene_file file;
        const scree_status status = parse(&file, text, NULL);
        SCREE_CHECK_INT(status, cases[k].value < 0 ? SCREE_INVALID_INPUT : SCREE_OK);
        if (status == SCREE_OK) SCREE_CHECK_INT(file.scene.repose.bins, cases[k].value);
        scree_scene_close(&file);
    }
}

static void test_aliases_are_copies(void)
{
    const char *override = "shapes.0.size.1=7";
    scree_scene_file file;
    SCREE_CHECK_INT(scree_scene_parse(&file,
                                      "time: {end: 1, step: 1}\n"
                                      "shapes:\n"
                                      "  - {name: a, source: box, size: &s [1, 2, 3]}\n"
                                      "  - {name: b, source: box, size: *s}\n",
                                      "x.yaml", &override, 1, NULL),
                    SCREE_OK);
    if (file.owned != NULL)
        SCREE_CHECK(equal3(file.scene.shapes[0].size, 1, 7, 3) && equal3(file.scene.shapes[1].size, 1, 2, 3));
    scree_scene_close(&file);

    // nine levels of ten aliases each ask for 10^9 values: refused before they are all made
    char text[1000] = "n0: &a0 x\n";
    for (int k = 1; k <= 9; ++k)
    {
        char item[40];
        snprintf(item, sizeof item, "n%d: &a%d [*a%d", k, k, k - 1);
        strcat(text, item);
        snprintf(item, sizeof item, ", *a%d", k - 1);
        for (int j = 1; j < 10; ++j) strcat(text, item);
        strcat(text, "]\n");
    }
    char *messages = messages_of(text, NULL, SCREE_INVALID_INPUT);
    SCREE_CHECK_CONTAINS(messages, "aliases make more than 1");
    free(messages);
}

static void test_hundreds_of_faults(void)
{
    char text[20000] = "time: {end: 1, step: 1}\nshapes:\n";
    for (int k = 0; k < 250; ++k) strcat(text, "  - {name: x y, source: box}\n");
    scree_scene_file file;
    scree_report report = {0};
    SCREE_CHECK_INT(parse(&file, text, &report), SCREE_INVALID_INPUT);
    SCREE_CHECK_INT(report.num_messages, 101);
    if (report.num_messages == 101) SCREE_CHECK_CONTAINS(report.messages[100], "150 more faults");
    scree_report_clear(&report);
}

/// Messages of scree_scene_read() for a path.
static void check_file(const char *path, scree_status expected, const char *message)
{
    scree_scene_file file;
    scree_report report = {0};
    SCREE_CHECK_INT(scree_scene_read(&file, path, NULL, 0, &report), expected);
    SCREE_CHECK_INT(report.num_messages, expected == SCREE_OK ? 0 : 1);
    if (report.num_messages > 0) SCREE_CHECK_CONTAINS(report.messages[0], message);
    scree_report_clear(&report);
    scree_scene_close(&file);
}

static void test_files(void)
{
    const char *folder = scree_test_folder();
    char path[512];
    snprintf(path, sizeof path, "%s/scene.yaml", folder);
    const int descriptor = open(path, O_RDWR | O_CREAT | O_EXCL, 0666);
    SCREE_CHECK(descriptor >= 0);
    if (descriptor < 0) return;
    check_file(path, SCREE_INVALID_INPUT, "there is nothing in it");
    check_file(folder, SCREE_READ_FAILED, ": this is a folder");
    check_file("/no/such/scene.yaml", SCREE_NOT_FOUND, "/no/such/scene.yaml: there is no such file");
    check_file("", SCREE_NOT_FOUND, "there is no such file");

    // zeros: first few, then a hundred megabytes that take no room on the disk
    SCREE_CHECK_INT(ftruncate(descriptor, 1000), 0);
    check_file(path, SCREE_INVALID_INPUT, "control characters are not allowed");
    SCREE_CHECK_INT(ftruncate(descriptor, 100000000), 0);
    check_file(path, SCREE_INVALID_INPUT, "the file has more than 64 MB");

    SCREE_CHECK_INT(ftruncate(descriptor, 0), 0);
    SCREE_CHECK(pwrite(descriptor, full_text, sizeof full_text - 1, 0) == (ssize_t)sizeof full_text - 1);
    check_file(path, SCREE_OK, "");
    scree_scene_file file;
    SCREE_CHECK_INT(scree_scene_read(&file, path, NULL, 0, NULL), SCREE_OK);
    SCREE_CHECK(file.folder != NULL && strcmp(file.folder, folder) == 0);
    scree_scene_close(&file);
    close(descriptor);
}

/// Each table agrees with the schema beside it, and its defaults are what it allows.
static void check_table(const scree_scene_section *section)
{
    for (int k = 0; k < section->num_keys; ++k)
    {
        const scree_scene_key *key = section->keys + k;
        SCREE_CHECK(section->fields[k].key != NULL && strcmp(section->fields[k].key, key->name) == 0);
        SCREE_CHECK(key->meaning != NULL && key->min <= key->max);
        const enum cyaml_type type = section->fields[k].value.type;
        SCREE_CHECK((type == CYAML_MAPPING || type == CYAML_SEQUENCE) == (key->section != NULL));
        const bool is_number = type == CYAML_FLOAT || type == CYAML_INT;
        SCREE_CHECK(!is_number || (key->unit != NULL && key->min < key->max));
        if (key->section != NULL) check_table(key->section);
    }
    SCREE_CHECK(section->fields[section->num_keys].key == NULL);
}

static void test_tables(void) { check_table(scree_scene_root()); }

static char *read_all(FILE *stream)
{
    char *text = calloc(1, 200000);
    if (text != NULL && stream != NULL) text[fread(text, 1, 199999, stream)] = '\0';
    return text;
}

static void test_manual_is_up_to_date(void)
{
    const char *folder = getenv("SCREE_SOURCE_DIR");
    char path[1000];
    snprintf(path, sizeof path, "%s/docs/scenes.md", folder != NULL ? folder : ".");
    FILE *manual = fopen(path, "rb"), *printed = tmpfile();
    SCREE_CHECK(manual != NULL && printed != NULL);
    if (manual == NULL || printed == NULL) return;
    scree_scene_print_keys(printed);
    rewind(printed);
    char *expected = read_all(printed), *actual = read_all(manual);
    if (strcmp(expected, actual) != 0) printf("renew it: scree --help scene > docs/scenes.md\n");
    SCREE_CHECK(strcmp(expected, actual) == 0);

    // its example is a scene
    char *example = strstr(actual, "```yaml\n");
    SCREE_CHECK(example != NULL);
    if (example != NULL)
    {
        example += strlen("```yaml\n");
        *strstr(example, "```") = '\0';
        char *messages = messages_of(example, NULL, SCREE_OK);
        SCREE_CHECK(strcmp(messages, "") == 0);
        free(messages);
    }
    free(expected);
    free(actual);
    fclose(manual);
    fclose(printed);
}

static void test_other_languages(void)
{
    // where a comma divides the digits; without one of these languages installed this is a plain repetition
    const char *const names[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE.utf8", "fr_FR.utf8"};
    const char *set = NULL;
    for (int k = 0; k < 4 && set == NULL; ++k) set = setlocale(LC_NUMERIC, names[k]);
    printf("numbers of %s\n", set != NULL ? set : "C only");
    scree_scene_file file;
    SCREE_CHECK_INT(parse(&file, full_text, NULL), SCREE_OK);
    if (file.owned != NULL) check_full_definitions(&file.scene), check_full_bodies(&file.scene);
    scree_scene_close(&file);
    setlocale(LC_NUMERIC, "C");
}

static void test_nearest_names(void)
{
    SCREE_CHECK_INT(scree_name_distance("kitten", "sitting"), 3);
    SCREE_CHECK_INT(scree_name_distance("teh", "the"), 1);
    SCREE_CHECK_INT(scree_name_distance("ca", "abc"), 3); // swapped letters stay together
    SCREE_CHECK_INT(scree_name_distance("", "abc"), 3);
    SCREE_CHECK_INT(scree_name_distance("abc", ""), 3);
    SCREE_CHECK_INT(scree_name_distance("same", "same"), 0);
    const char *const names[] = {"density", "friction_coefficient", "restitution_coefficient"};
    SCREE_CHECK(scree_nearest_name("desnity", names, 3) == names[0]);
    SCREE_CHECK(scree_nearest_name("friction", names, 3) == names[1]);
    SCREE_CHECK(scree_nearest_name("restitution_coeficient", names, 3) == names[2]);
    SCREE_CHECK(scree_nearest_name("x", names, 3) == NULL);
    SCREE_CHECK(scree_nearest_name("colour", names, 3) == NULL);
    // longer than what is compared
    char longer[400];
    memset(longer, 'x', sizeof longer - 1);
    longer[sizeof longer - 1] = '\0';
    SCREE_CHECK(scree_nearest_name(longer, names, 3) == NULL);
}

int main(void)
{
    SCREE_RUN(test_every_key_reaches_its_field);
    SCREE_RUN(test_defaults);
    SCREE_RUN(test_text_with_defaults_reads_the_same);
    SCREE_RUN(test_overrides);
    SCREE_RUN(test_faults_of_overrides);
    SCREE_RUN(test_faults_of_contact_laws);
    SCREE_RUN(test_faults_of_values);
    SCREE_RUN(test_faults_of_true_spheres);
    SCREE_RUN(test_warnings_of_keys_without_effect);
    SCREE_RUN(test_faults_of_syntax);
    SCREE_RUN(test_numbers);
    SCREE_RUN(test_integers);
    SCREE_RUN(test_aliases_are_copies);
    SCREE_RUN(test_hundreds_of_faults);
    SCREE_RUN(test_files);
    SCREE_RUN(test_tables);
    SCREE_RUN(test_manual_is_up_to_date);
    SCREE_RUN(test_other_languages);
    SCREE_RUN(test_nearest_names);
    return SCREE_TEST_END();
}
