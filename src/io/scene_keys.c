/// \file scene_keys.c
/// The reference of all keys, as Markdown, and what a key takes in words.
#include "forces/force_model.h"
#include "io/scene_schema.h"
#include "scree/scene.h"

#include <stdarg.h>
#include <string.h>

/// Text that is put together piece by piece in a buffer; what does not fit is left out.
typedef struct short_text
{
    char *text;
    size_t size, length;
} short_text;

__attribute__((format(printf, 2, 3))) static void append(short_text *to, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(to->text + to->length, to->size - to->length, format, arguments);
    va_end(arguments);
    if (length > 0) to->length += (size_t)length;
    if (to->length >= to->size) to->length = to->size - 1;
}

const char *scree_scene_word(const scree_scene_section *section, int key, int word)
{
    const cyaml_schema_value_t *value = &section->fields[key].value;
    if (value->type == CYAML_ENUM)
        return word < (int)value->enumeration.count ? value->enumeration.strings[word].str : NULL;
    return word < section->keys[key].num_words ? section->keys[key].words[word] : NULL;
}

static void append_words(short_text *to, const scree_scene_section *section, int key)
{
    for (int k = 0; scree_scene_word(section, key, k) != NULL; ++k)
        append(to, "%s%s",
               k == 0                                          ? ""
               : scree_scene_word(section, key, k + 1) == NULL ? " or "
                                                               : ", ",
               scree_scene_word(section, key, k));
}

static void append_range(short_text *to, const scree_scene_key *key, bool is_integer)
{
    if (is_integer) append(to, "[%.17g, %.17g]", key->min, key->max);
    else append(to, "[%g, %g]", key->min, key->max);
}

static bool has_unit(const scree_scene_key *key) { return key->unit != NULL && strcmp(key->unit, "1") != 0; }

/// "a section with the keys ..."
static void append_keys(short_text *to, const scree_scene_section *section)
{
    for (int k = 0; k < section->num_keys; ++k) append(to, "%s%s", k > 0 ? ", " : "", section->keys[k].name);
}

static void append_text_rule(short_text *to, const scree_scene_section *section, int key)
{
    switch (section->keys[key].rule)
    {
    case SCREE_TEXT_FREE:
        append(to, "a text of 1 to 255 characters on one line");
        break;
    case SCREE_TEXT_NAME:
        append(to, "a name of letters, digits, _ and -, not of digits alone");
        break;
    case SCREE_TEXT_PATH:
        append(to, "the path of a file");
        break;
    case SCREE_TEXT_OPTIONAL_NAME:
        append(to, "a name, or \"\" for none");
        break;
    case SCREE_TEXT_WORD:
        append_words(to, section, key);
        break;
    }
}

/// "a number in [0.1, 1] kg or auto"
static void append_number(short_text *to, const scree_scene_key *key, bool is_integer)
{
    append(to, is_integer ? "an integer in " : "a number in ");
    append_range(to, key, is_integer);
    if (has_unit(key)) append(to, " %s", key->unit);
    if (key->special != NULL) append(to, " or %s", key->special);
}

void scree_scene_describe_item(const scree_scene_section *section, int key, char *text, size_t size)
{
    short_text to = {text, size, 0};
    text[0] = '\0';
    if (section->fields[key].value.sequence.entry->type == CYAML_STRING) append_text_rule(&to, section, key);
    else append_number(&to, section->keys + key, false);
}

void scree_scene_describe(const scree_scene_section *section, int key, char *text, size_t size)
{
    const cyaml_schema_value_t *value = &section->fields[key].value;
    const scree_scene_key *k = section->keys + key;
    short_text to = {text, size, 0};
    text[0] = '\0';
    switch (value->type)
    {
    case CYAML_FLOAT:
    case CYAML_INT:
        append_number(&to, k, value->type == CYAML_INT);
        break;
    case CYAML_BOOL:
        append(&to, "true or false");
        break;
    case CYAML_ENUM:
        append_words(&to, section, key);
        break;
    case CYAML_STRING:
        append_text_rule(&to, section, key);
        break;
    case CYAML_SEQUENCE_FIXED:
        append(&to, "a list of %u ", value->sequence.max);
        if (value->sequence.entry->type == CYAML_STRING)
        {
            append(&to, "names");
            break;
        }
        append(&to, "numbers in ");
        append_range(&to, k, false);
        if (has_unit(k)) append(&to, " %s", k->unit);
        break;
    case CYAML_MAPPING:
        append(&to, "a section with the keys ");
        append_keys(&to, k->section);
        break;
    default:
        append(&to, "a list, each item \"- \" and the keys ");
        append_keys(&to, k->section);
        break;
    }
}

/// Column "range" of the reference.
static void describe_range(const scree_scene_section *section, int key, char *text, size_t size)
{
    const cyaml_schema_value_t *value = &section->fields[key].value;
    const scree_scene_key *k = section->keys + key;
    short_text to = {text, size, 0};
    text[0] = '\0';
    switch (value->type)
    {
    case CYAML_FLOAT:
    case CYAML_INT:
        append_range(&to, k, value->type == CYAML_INT);
        if (k->special != NULL) append(&to, ", %s", k->special);
        break;
    case CYAML_SEQUENCE_FIXED:
        append(&to, "%u ", value->sequence.max);
        if (value->sequence.entry->type == CYAML_STRING) append(&to, "names");
        else append(&to, "numbers, each in "), append_range(&to, k, false);
        break;
    case CYAML_MAPPING:
        append(&to, "section");
        break;
    case CYAML_SEQUENCE:
        append(&to, "list of up to %.17g", k->max);
        break;
    case CYAML_STRING:
        if (k->rule == SCREE_TEXT_NAME || k->rule == SCREE_TEXT_OPTIONAL_NAME) append(&to, "name");
        else if (k->rule == SCREE_TEXT_PATH) append(&to, "path");
        else if (k->rule == SCREE_TEXT_FREE) append(&to, "text");
        else append_words(&to, section, key);
        break;
    default:
        scree_scene_describe(section, key, text, size);
        break;
    }
}

/// True if the section cannot be left out: one of its keys has no default.
static bool must_be_given(const scree_scene_section *section, int key)
{
    if (section->keys[key].default_text == NULL) return true;
    const scree_scene_section *inner = section->keys[key].section;
    const bool is_section = section->fields[key].value.type == CYAML_MAPPING;
    for (int k = 0; is_section && k < inner->num_keys; ++k)
        if (must_be_given(inner, k)) return true;
    return false;
}

/// The force models, below the keys of contact laws.
static void print_models(FILE *out)
{
    const scree_force_model *models = scree_force_models();
    fprintf(out, "\n| model | normal force | source |\n|---|---|---|\n");
    for (int32_t k = 0; k < SCREE_NUM_FORCE_MODELS; ++k)
        fprintf(out, "| `%s` | %s | %s |\n", models[k].name, models[k].text, models[k].source);
}

static void print_section(FILE *out, const scree_scene_section *section)
{
    fprintf(out, "\n## %s\n\n%s\n\n| key | unit | default | range | meaning |\n|---|---|---|---|---|\n", section->title,
            section->text);
    for (int k = 0; k < section->num_keys; ++k)
    {
        const scree_scene_key *key = section->keys + k;
        const bool is_free = !must_be_given(section, k);
        char range[400];
        describe_range(section, k, range, sizeof range);
        fprintf(out, "| `%s` | %s | %s%s%s | %s | %s |\n", key->name, key->unit != NULL ? key->unit : "",
                is_free ? "`" : "", is_free ? key->default_text : "must be given", is_free ? "`" : "", range,
                key->meaning);
    }
    if (section == scree_scene_law_section()) print_models(out);
    for (int k = 0; k < section->num_keys; ++k)
        if (section->keys[k].section != NULL) print_section(out, section->keys[k].section);
}

static const char introduction[] =
    "# Scenes\n\n"
    "A scene is a YAML file that says everything a run is made from, in SI units. This page is made from the tables\n"
    "that the reader checks scenes by: `scree --help scene` prints it. A cube that falls on a plate:\n\n"
    "```yaml\n"
    "name: drop\n"
    "time: {end: 1, step: 1e-4}\n"
    "materials:\n"
    "  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}\n"
    "contact_laws:\n"
    "  - {materials: [stone, stone], friction_coefficient: 0.5, restitution_coefficient: 0.3}\n"
    "shapes:\n"
    "  - {name: cube, source: box, size: 0.1}\n"
    "  - {name: plate, source: box, size: [1, 1, 0.1]}\n"
    "particles:\n"
    "  - {name: cubes, shape: cube, material: stone, bodies: [{position: [0, 0, 0.3]}]}\n"
    "walls:\n"
    "  - {name: floor, shape: plate, material: stone, position: [0, 0, -0.05]}\n"
    "```\n\n"
    "- Keys that are left out take their default. `scree check --print SCENE` shows a scene with all of them filled\n"
    "  in; a run keeps that text in its folder.\n"
    "- Numbers are written plainly, `0.01` or `1e-5`, without units. A range `[a, b]` contains its ends. `auto` and\n"
    "  `never` stand where the range names them.\n"
    "- All faults of a file are told at once, each with line, key, value, what is allowed and what to do. A name\n"
    "  that is not known is answered with the nearest one.\n"
    "- `--set PATH=VALUE` replaces a value, or adds one, before the scene is checked: `time.end=2`,\n"
    "  `particles.cubes.count=500`, `gravity.2=-1.62`, `walls=[]`. Items of lists are addressed by their number\n"
    "  from 0 or by their name; values are YAML.\n"
    "- A mixture is several groups of particles with the same region: `region: &box {...}` in the first, `region: "
    "*box`\n"
    "  in the others, each with its count or mass (`scenes/mixture.yaml`).\n"
    "- Aliases (`&a`, `*a`) work, merge keys (`<<`) do not. A file has up to 64 MB.\n"
    "- Mesh files are looked for from the folder of the scene. Their numbers are metres, unless the shape has a "
    "scale.\n";

void scree_scene_print_keys(void *stream)
{
    FILE *out = stream;
    fputs(introduction, out);
    print_section(out, scree_scene_root());
}
