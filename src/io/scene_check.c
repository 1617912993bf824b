/// \file scene_check.c
/// Walks the file's tree and the tables of keys together: unknown and doubled keys, missing ones, wrong types, values
/// out of range. Everything is looked at, so that all faults are told at once. Defaults are filled in on the way.
#include "io/nearest_name.h"
#include "io/scene_reader.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#define MESSAGE_SIZE 2048

/// "scene.yaml:12" or "--set time.end=-1".
static void show_place(const scree_scene_reader *reader, const scree_yaml_node *at, char *text, size_t size)
{
    if (at != NULL && at->source > 0) snprintf(text, size, "--set %.200s", reader->overrides[at->source - 1]);
    else if (at != NULL && at->line > 0) snprintf(text, size, "%.600s:%lld", reader->path, (long long)at->line);
    else snprintf(text, size, "%.600s", reader->path);
}

void scree_scene_fault(scree_scene_reader *reader, const scree_yaml_node *at, const char *format, ...)
{
    if (++reader->num_faults > SCREE_SCENE_MAX_TOLD) return;
    char place[700], text[MESSAGE_SIZE];
    show_place(reader, at, place, sizeof place);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    scree_report_add(reader->report, "%s: %s", place, text);
}

void scree_scene_warn(scree_scene_reader *reader, const scree_yaml_node *at, const char *format, ...)
{
    if (reader->report == NULL || reader->report->num_warnings >= SCREE_SCENE_MAX_TOLD) return;
    char place[700], text[MESSAGE_SIZE];
    show_place(reader, at, place, sizeof place);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    scree_report_warn(reader->report, "%s: %s", place, text);
}

void scree_scene_show(const scree_yaml_node *node, char *text, size_t size)
{
    enum
    {
        MAX_SHOWN = 60
    };
    if (node->kind == SCREE_YAML_LIST) snprintf(text, size, "a list of %lld", (long long)node->num_items);
    else if (node->kind == SCREE_YAML_SECTION) snprintf(text, size, "a section");
    else if (scree_yaml_is_null(node)) snprintf(text, size, "nothing");
    else
    {
        char shown[MAX_SHOWN + 4];
        size_t length = strlen(node->text);
        const bool is_long = length > MAX_SHOWN;
        // a character of several bytes is left whole
        if (is_long)
            for (length = MAX_SHOWN; length > 0 && ((unsigned char)node->text[length] & 0xc0) == 0x80;) --length;
        for (size_t k = 0; k < length; ++k)
            shown[k] = (unsigned char)node->text[k] < 0x20 || node->text[k] == 0x7f ? '?' : node->text[k];
        memcpy(shown + length, is_long ? "..." : "", is_long ? 4 : 1);
        const char *quote = scree_scene_is_number(node->text) ? "" : "\"";
        snprintf(text, size, "%s%s%s", quote, shown, quote);
    }
}

int scree_scene_key_index(const scree_scene_section *section, const char *name)
{
    for (int k = 0; k < section->num_keys; ++k)
        if (strcmp(section->keys[k].name, name) == 0) return k;
    return -1;
}

void scree_scene_suggest_key(const scree_scene_section *section, const char *name, char *text, size_t size)
{
    const char *names[32];
    for (int k = 0; k < section->num_keys; ++k) names[k] = section->keys[k].name;
    const char *nearest = scree_nearest_name(name, names, section->num_keys);
    if (strcmp(name, "<<") == 0) snprintf(text, size, "merge keys are not supported, write the keys out");
    else if (nearest != NULL) snprintf(text, size, "did you mean \"%s\"?", nearest);
    else
    {
        size_t length = (size_t)snprintf(text, size, "known are ");
        for (int k = 0; k < section->num_keys && length < size; ++k)
            length += (size_t)snprintf(text + length, size - length, "%s%s", k > 0 ? ", " : "", names[k]);
    }
}

bool scree_scene_is_number(const char *text)
{
    const char *c = text + (*text == '+' || *text == '-');
    int num_digits = 0;
    for (; *c >= '0' && *c <= '9'; ++c) ++num_digits;
    if (*c == '.')
        for (++c; *c >= '0' && *c <= '9'; ++c) ++num_digits;
    if (num_digits == 0) return false;
    if (*c == 'e' || *c == 'E')
    {
        c += c[1] == '+' || c[1] == '-' ? 2 : 1;
        if (*c == '\0') return false;
        for (; *c >= '0' && *c <= '9';) ++c;
    }
    return *c == '\0';
}

/// A value with everything that is needed to judge it.
typedef struct checked_value
{
    const scree_scene_section *section;
    int key;
    const char *path; ///< of the section the key is in: "materials.0"; "" for the scene
    scree_yaml_node *node;
    int64_t item; ///< number in a list of numbers or names; -1: the whole value
} checked_value;

/// "density of materials.0", "position.2 of particles.0.bodies.1"
typedef struct value_label
{
    char text[SCREE_SCENE_PATH_SIZE + 100];
} value_label;

static value_label label_of(checked_value v)
{
    value_label label;
    char item[24] = "";
    if (v.item >= 0) snprintf(item, sizeof item, ".%lld", (long long)v.item);
    snprintf(label.text, sizeof label.text, "%s%s%s%.319s", v.section->keys[v.key].name, item,
             v.path[0] == '\0' ? "" : " of ", v.path);
    return label;
}

/// Is it a number with a unit, where a number is wanted?
static bool has_unit(checked_value v)
{
    if (v.section->keys[v.key].unit == NULL || v.node->kind != SCREE_YAML_SCALAR) return false;
    char *end;
    strtod(v.node->text, &end);
    const char *unit = end + strspn(end, " ");
    return end != v.node->text && isalpha((unsigned char)*unit);
}

/// "LABEL is VALUE; it must be WHAT"
static void refuse(scree_scene_reader *reader, checked_value v)
{
    char shown[100], allowed[800];
    scree_scene_show(v.node, shown, sizeof shown);
    if (v.item >= 0) scree_scene_describe_item(v.section, v.key, allowed, sizeof allowed);
    else scree_scene_describe(v.section, v.key, allowed, sizeof allowed);
    const bool has_default = v.section->keys[v.key].default_text != NULL && v.item < 0;
    if (scree_yaml_is_null(v.node))
        scree_scene_fault(reader, v.node, "%s has no value; it must be %s%s", label_of(v).text, allowed,
                          has_default ? ", or the key be left out" : "");
    else
        scree_scene_fault(reader, v.node, "%s is %s; it must be %s%s", label_of(v).text, shown, allowed,
                          has_unit(v) ? ", written without its unit" : "");
    v.node->is_refused = true;
}

static bool is_allowed_special(const scree_scene_key *key, const scree_yaml_node *node)
{
    return key->special != NULL && node->kind == SCREE_YAML_SCALAR && strcmp(node->text, key->special) == 0;
}

static void check_number(scree_scene_reader *reader, checked_value v)
{
    const scree_scene_key *key = v.section->keys + v.key;
    if (is_allowed_special(key, v.node))
    {
        const bool is_never = strcmp(key->special, "never") == 0;
        v.node->number = is_never ? INFINITY : NAN;
        v.node->number_text = is_never ? "inf" : "nan";
        return;
    }
    if (v.node->kind == SCREE_YAML_SCALAR && scree_scene_is_number(v.node->text))
    {
        v.node->number = strtod(v.node->text, NULL);
        if (v.node->number >= key->min && v.node->number <= key->max) return;
    }
    refuse(reader, v);
}

/// Integers may be written like 1e6; they are written out for libcyaml, which would read 010 as eight.
static void check_integer(scree_scene_reader *reader, checked_value v)
{
    const scree_scene_key *key = v.section->keys + v.key;
    if (v.node->kind == SCREE_YAML_SCALAR && scree_scene_is_number(v.node->text))
    {
        const double number = strtod(v.node->text, NULL);
        if (number >= key->min && number <= key->max && number == floor(number))
        {
            char *digits = scree_yaml_allocate(&reader->tree, 24);
            if (digits == NULL) reader->is_exhausted = true;
            else snprintf(digits, 24, "%.0f", number == 0 ? 0.0 : number);
            v.node->number = number;
            v.node->text = digits != NULL ? digits : v.node->text;
            return;
        }
    }
    refuse(reader, v);
}

/// Refuses a word and names the nearest one that is allowed.
static void refuse_word(scree_scene_reader *reader, checked_value v)
{
    const char *words[32];
    int num = 0;
    for (; num < 32 && scree_scene_word(v.section, v.key, num) != NULL; ++num)
        words[num] = scree_scene_word(v.section, v.key, num);
    const char *nearest = v.node->kind == SCREE_YAML_SCALAR ? scree_nearest_name(v.node->text, words, num) : NULL;
    if (nearest == NULL)
    {
        refuse(reader, v);
        return;
    }
    char shown[100], allowed[800];
    scree_scene_show(v.node, shown, sizeof shown);
    scree_scene_describe(v.section, v.key, allowed, sizeof allowed);
    scree_scene_fault(reader, v.node, "%s is %s; it must be %s; did you mean \"%s\"?", label_of(v).text, shown, allowed,
                      nearest);
    v.node->is_refused = true;
}

static void check_word(scree_scene_reader *reader, checked_value v)
{
    for (int k = 0; v.node->kind == SCREE_YAML_SCALAR && scree_scene_word(v.section, v.key, k) != NULL; ++k)
        if (strcmp(v.node->text, scree_scene_word(v.section, v.key, k)) == 0) return;
    refuse_word(reader, v);
}

static void check_truth(scree_scene_reader *reader, checked_value v)
{
    const bool is_scalar = v.node->kind == SCREE_YAML_SCALAR;
    if (!is_scalar || (strcmp(v.node->text, "true") != 0 && strcmp(v.node->text, "false") != 0)) refuse(reader, v);
}

static bool is_name(const char *text)
{
    bool has_other = false;
    size_t length = 0;
    for (; text[length] != '\0'; ++length)
    {
        const char c = text[length];
        const bool is_digit = c >= '0' && c <= '9';
        if (!is_digit && !(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && c != '_' && c != '-') return false;
        has_other |= !is_digit;
    }
    return has_other && length <= 255;
}

static bool is_printable(const char *text)
{
    const size_t length = strlen(text);
    for (size_t k = 0; k < length; ++k)
        if ((unsigned char)text[k] < 0x20 || text[k] == 0x7f) return false;
    return length >= 1 && length <= 255;
}

static void check_text(scree_scene_reader *reader, checked_value v)
{
    if (v.section->keys[v.key].rule == SCREE_TEXT_WORD)
    {
        check_word(reader, v);
        return;
    }
    bool is_right = v.node->kind == SCREE_YAML_SCALAR && !scree_yaml_is_null(v.node);
    if (is_right && v.section->keys[v.key].rule == SCREE_TEXT_NAME) is_right = is_name(v.node->text);
    if (is_right && v.section->keys[v.key].rule == SCREE_TEXT_OPTIONAL_NAME)
        is_right = v.node->text[0] == '\0' || is_name(v.node->text);
    if (is_right && v.section->keys[v.key].rule == SCREE_TEXT_FREE) is_right = is_printable(v.node->text);
    if (!is_right) refuse(reader, v);
}

/// One number where a list of the same number is meant.
static void repeat_number(scree_scene_reader *reader, scree_yaml_node *node, int64_t num)
{
    scree_yaml_node *one = scree_yaml_add(&reader->tree, SCREE_YAML_SCALAR, node->text);
    node->items = scree_yaml_allocate(&reader->tree, (size_t)num * sizeof(scree_yaml_node *));
    if (one == NULL || node->items == NULL)
    {
        reader->is_exhausted = true;
        return;
    }
    one->line = node->line;
    one->source = node->source;
    node->kind = SCREE_YAML_LIST;
    node->num_items = num;
    for (int64_t k = 0; k < num; ++k) node->items[k] = one;
}

/// Numbers or names of fixed count.
static void check_fixed_list(scree_scene_reader *reader, checked_value v)
{
    const cyaml_schema_value_t *value = &v.section->fields[v.key].value;
    const bool is_size_of_shape = strcmp(v.section->title, "shapes[]") == 0;
    if (is_size_of_shape && v.node->kind == SCREE_YAML_SCALAR && scree_scene_is_number(v.node->text))
        repeat_number(reader, v.node, (int64_t)value->sequence.max);
    if (v.node->kind != SCREE_YAML_LIST || v.node->num_items != (int64_t)value->sequence.max)
    {
        refuse(reader, v);
        return;
    }
    for (int64_t k = 0; k < v.node->num_items; ++k)
    {
        checked_value item = v;
        item.node = v.node->items[k];
        item.item = k;
        if (value->sequence.entry->type == CYAML_STRING) check_text(reader, item);
        else check_number(reader, item);
        v.node->is_refused |= item.node->is_refused;
    }
}

/// The entry of the shared nodes of a section; NULL: no memory.
static scree_scene_shared_nodes *shared_nodes(scree_scene_reader *reader, const scree_scene_section *section)
{
    for (int k = 0; k < reader->num_shared; ++k)
        if (reader->shared[k].section == section) return reader->shared + k;
    const size_t size = (size_t)section->num_keys * sizeof(scree_yaml_node *);
    scree_scene_shared_nodes *shared = reader->shared + reader->num_shared;
    shared->section = section;
    shared->keys = scree_yaml_allocate(&reader->tree, size);
    shared->defaults = scree_yaml_allocate(&reader->tree, size);
    bool is_complete =
        reader->num_shared < SCREE_SCENE_MAX_SECTIONS && shared->keys != NULL && shared->defaults != NULL;
    for (int k = 0; is_complete && k < section->num_keys; ++k)
    {
        shared->defaults[k] = NULL;
        shared->keys[k] = scree_yaml_add(&reader->tree, SCREE_YAML_SCALAR, section->keys[k].name);
        is_complete = shared->keys[k] != NULL;
    }
    reader->is_exhausted |= !is_complete;
    if (is_complete) ++reader->num_shared;
    return is_complete ? shared : NULL;
}

/// "[0, 0, 1]" to a list of scalars.
static bool split_list(scree_scene_reader *reader, const char *text, scree_yaml_node *list)
{
    list->items = scree_yaml_allocate(&reader->tree, 4 * sizeof(scree_yaml_node *));
    for (const char *from = text + 1; list->items != NULL && *from != '\0' && list->num_items < 4;)
    {
        char one[32] = "";
        const size_t length = strcspn(from, ",]");
        memcpy(one, from, length < sizeof one ? length : sizeof one - 1);
        scree_yaml_node *item = scree_yaml_add(&reader->tree, SCREE_YAML_SCALAR, one);
        if (item == NULL) return false;
        list->items[list->num_items++] = item;
        from += length;
        from += strspn(from, ",] ");
    }
    return list->items != NULL;
}

scree_yaml_node *scree_scene_default(scree_scene_reader *reader, const scree_scene_section *section, int key)
{
    const enum cyaml_type type = section->fields[key].value.type;
    const char *text = section->keys[key].default_text;
    const scree_yaml_kind kind = type == CYAML_MAPPING                                    ? SCREE_YAML_SECTION
                                 : type == CYAML_SEQUENCE || type == CYAML_SEQUENCE_FIXED ? SCREE_YAML_LIST
                                                                                          : SCREE_YAML_SCALAR;
    const bool is_empty_text = kind == SCREE_YAML_SCALAR && strcmp(text, "\"\"") == 0;
    scree_yaml_node *node = scree_yaml_add(&reader->tree, kind, is_empty_text ? "" : text);
    if (node == NULL || (type == CYAML_SEQUENCE_FIXED && !split_list(reader, text, node)))
    {
        reader->is_exhausted = true;
        return NULL;
    }
    node->is_quoted = is_empty_text;
    node->is_default = true;
    return node;
}

/// New value for a key that was left out; NULL if it must be given, or there is no memory.
static scree_yaml_node *fill_in(scree_scene_reader *reader, checked_value v, scree_scene_shared_nodes *shared)
{
    const scree_scene_key *key = v.section->keys + v.key;
    if (key->default_text == NULL)
    {
        char allowed[800];
        scree_scene_describe(v.section, v.key, allowed, sizeof allowed);
        scree_scene_fault(reader, v.node, "%s is missing; it must be %s", label_of(v).text, allowed);
        return NULL;
    }
    scree_yaml_node *node = scree_scene_default(reader, v.section, v.key);
    if (node == NULL) return NULL;
    node->line = v.node->line;
    node->source = v.node->source;
    // sections and lists of sections are filled in further, so each gets its own
    const enum cyaml_type type = v.section->fields[v.key].value.type;
    if (type != CYAML_MAPPING && type != CYAML_SEQUENCE) shared->defaults[v.key] = node;
    return node;
}

static void check_section(scree_scene_reader *reader, scree_yaml_node *node, const scree_scene_section *section,
                          const char *path);

/// A list of sections.
static void check_list(scree_scene_reader *reader, checked_value v)
{
    const scree_scene_key *key = v.section->keys + v.key;
    if (v.node->kind != SCREE_YAML_LIST)
    {
        refuse(reader, v);
        return;
    }
    if ((double)v.node->num_items > key->max)
    {
        scree_scene_fault(reader, v.node, "%s has %lld items; at most %.17g are possible", label_of(v).text,
                          (long long)v.node->num_items, key->max);
        v.node->is_refused = true;
        return;
    }
    for (int64_t k = 0; k < v.node->num_items && !reader->is_exhausted; ++k)
    {
        char item_path[SCREE_SCENE_PATH_SIZE];
        snprintf(item_path, sizeof item_path, "%.200s%s%s.%lld", v.path, v.path[0] == '\0' ? "" : ".", key->name,
                 (long long)k);
        check_section(reader, v.node->items[k], key->section, item_path);
    }
}

static void check_value(scree_scene_reader *reader, checked_value v)
{
    char path[SCREE_SCENE_PATH_SIZE];
    switch (v.section->fields[v.key].value.type)
    {
    case CYAML_FLOAT:
        check_number(reader, v);
        break;
    case CYAML_INT:
        check_integer(reader, v);
        break;
    case CYAML_BOOL:
        check_truth(reader, v);
        break;
    case CYAML_ENUM:
        check_word(reader, v);
        break;
    case CYAML_STRING:
        check_text(reader, v);
        break;
    case CYAML_SEQUENCE_FIXED:
        check_fixed_list(reader, v);
        break;
    case CYAML_MAPPING:
        snprintf(path, sizeof path, "%.250s%s%s", v.path, v.path[0] == '\0' ? "" : ".", v.section->keys[v.key].name);
        check_section(reader, v.node, v.section->keys[v.key].section, path);
        break;
    default:
        check_list(reader, v);
        break;
    }
}

/// Sorts the values of a section by the table: values[k] is that of key k. Tells unknown and doubled keys.
static void sort_keys(scree_scene_reader *reader, const scree_yaml_node *node, const scree_scene_section *section,
                      const char *path, scree_yaml_node **values)
{
    for (int64_t i = 0; i < node->num_items; ++i)
    {
        const scree_yaml_node *name = node->keys[i];
        char shown[100], remedy[400];
        scree_scene_show(name, shown, sizeof shown);
        const bool is_scalar = name->kind == SCREE_YAML_SCALAR;
        const int key = is_scalar ? scree_scene_key_index(section, name->text) : -1;
        const char *where = path[0] == '\0' ? "the scene" : path;
        if (key < 0)
        {
            scree_scene_suggest_key(section, is_scalar ? name->text : "", remedy, sizeof remedy);
            scree_scene_fault(reader, name, "%s is no key of %s; %s", shown, where, remedy);
        }
        else if (values[key] != NULL)
            scree_scene_fault(reader, name, "%s is there twice in %s, first in line %lld; remove one", shown, where,
                              (long long)values[key]->line);
        else values[key] = node->items[i];
    }
}

/// Marks a value that is what it would be had it been left out: it is not worth a warning then, and so the text with
/// all defaults reads like the file it was made from.
static void mark_default(scree_yaml_node *node, const scree_scene_key *key)
{
    if (key->default_text == NULL || node->is_refused) return;
    if (node->kind == SCREE_YAML_SCALAR)
        node->is_default = strcmp(node->text, strcmp(key->default_text, "\"\"") == 0 ? "" : key->default_text) == 0;
    else if (node->kind == SCREE_YAML_SECTION)
    {
        node->is_default = true;
        for (int64_t k = 0; k < node->num_items; ++k)
            node->is_default &= node->items[k] != NULL && node->items[k]->is_default;
    }
    else
    {
        char text[64] = "[";
        for (int64_t k = 0; k < node->num_items; ++k)
        {
            const scree_yaml_node *item = node->items[k];
            const size_t length = strlen(text);
            if (item->kind != SCREE_YAML_SCALAR || length + strlen(item->text) + 4 > sizeof text) return;
            snprintf(text + length, sizeof text - length, "%s%s", k > 0 ? ", " : "", item->text);
        }
        strcat(text, "]");
        node->is_default = strcmp(text, key->default_text) == 0;
    }
}

static void check_section(scree_scene_reader *reader, scree_yaml_node *node, const scree_scene_section *section,
                          const char *path)
{
    if (node->kind != SCREE_YAML_SECTION)
    {
        char shown[100];
        scree_scene_show(node, shown, sizeof shown);
        scree_scene_fault(reader, node, "%s is %s; it must be a section with keys, like %s: ...",
                          path[0] == '\0' ? "the scene" : path, shown, section->keys[0].name);
        node->is_refused = true;
        return;
    }
    scree_scene_shared_nodes *shared = shared_nodes(reader, section);
    scree_yaml_node **values =
        scree_yaml_allocate(&reader->tree, (size_t)section->num_keys * sizeof(scree_yaml_node *));
    if (shared == NULL || values == NULL)
    {
        reader->is_exhausted = true;
        return;
    }
    for (int k = 0; k < section->num_keys; ++k) values[k] = NULL;
    sort_keys(reader, node, section, path, values);
    for (int k = 0; k < section->num_keys && !reader->is_exhausted; ++k)
    {
        if (values[k] == NULL && shared->defaults[k] != NULL)
        {
            values[k] = shared->defaults[k]; // was checked when it was made
            continue;
        }
        if (values[k] == NULL) values[k] = fill_in(reader, (checked_value){section, k, path, node, -1}, shared);
        if (values[k] == NULL) continue;
        check_value(reader, (checked_value){section, k, path, values[k], -1});
        mark_default(values[k], section->keys + k);
    }
    node->keys = shared->keys;
    node->items = values;
    node->num_items = section->num_keys;
}

void scree_scene_check(scree_scene_reader *reader) { check_section(reader, reader->root, scree_scene_root(), ""); }
