/// \file scene_override.c
/// Values from the command line: "a.b.c=value" goes into the tree before it is checked, so that it is judged, and told
/// about, like a value of the file.
#include "io/nearest_name.h"
#include "io/scene_reader.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/// Where an override has got to.
typedef struct override_walk
{
    scree_scene_reader *reader;
    scree_yaml_node at; ///< stands for the override in messages
    char *path;         ///< what is left of the path; NULL at its end
    scree_yaml_node *value;
} override_walk;

/// Cuts the next name off the path.
static const char *next_name(override_walk *walk)
{
    char *name = walk->path;
    char *dot = strchr(name, '.');
    if (dot != NULL) *dot = '\0';
    walk->path = dot != NULL ? dot + 1 : NULL;
    return name;
}

/// Value of a key that is not in the file yet: its default, or an empty section. NULL: none, told.
static scree_yaml_node *add_default(override_walk *walk, scree_yaml_node *node, const scree_scene_section *section,
                                    int key)
{
    scree_scene_reader *reader = walk->reader;
    const scree_scene_key *k = section->keys + key;
    if (k->default_text == NULL || section->fields[key].value.type == CYAML_SEQUENCE)
    {
        scree_scene_fault(reader, &walk->at, "%s is not in the file; set all of it: %s=...", k->name, k->name);
        return NULL;
    }
    scree_yaml_node *value = scree_scene_default(reader, section, key);
    if (value != NULL)
    {
        value->is_default = false;
        value->source = walk->at.source;
        if (scree_yaml_add_item(&reader->tree, node, k->name, value) != SCREE_OK) reader->is_exhausted = true;
    }
    return value;
}

/// Index of an item by number or name; -1, told, if there is none.
static int64_t find_item(override_walk *walk, const scree_yaml_node *list, const char *list_name, const char *item)
{
    errno = 0;
    char *end;
    const long long index = strtoll(item, &end, 10);
    const bool is_number = item[0] >= '0' && item[0] <= '9' && *end == '\0' && errno == 0;
    if (is_number && index < list->num_items) return index;

    const char *nearest = NULL;
    for (int64_t k = 0; !is_number && k < list->num_items; ++k)
    {
        const scree_yaml_node *name = scree_yaml_find(list->items[k], "name");
        if (name == NULL || name->kind != SCREE_YAML_SCALAR) continue;
        if (strcmp(name->text, item) == 0) return k;
        if (scree_name_is_near(item, name->text)) nearest = name->text;
    }
    if (nearest != NULL)
        scree_scene_fault(walk->reader, &walk->at, "no item \"%.100s\" in %s; did you mean \"%.100s\"?", item,
                          list_name, nearest);
    else if (list->num_items == 0) scree_scene_fault(walk->reader, &walk->at, "%s has no items", list_name);
    else
        scree_scene_fault(walk->reader, &walk->at, "no item \"%.100s\" in %s; take a number from 0 to %lld%s", item,
                          list_name, (long long)list->num_items - 1,
                          scree_yaml_find(list->items[0], "name") != NULL ? " or a name" : "");
    return -1;
}

/// The rest of the path inside a value that is a list. Returns the section to go on in; NULL: done, or told.
static scree_yaml_node *enter_list(override_walk *walk, scree_yaml_node *list, const scree_scene_section *section,
                                   int key)
{
    const char *list_name = section->keys[key].name;
    const bool has_sections = section->fields[key].value.type == CYAML_SEQUENCE;
    if (list->kind != SCREE_YAML_LIST)
    {
        scree_scene_fault(walk->reader, &walk->at, "%s is no list in the file; set all of it: %s=[...]", list_name,
                          list_name);
        return NULL;
    }
    const int64_t index = find_item(walk, list, list_name, next_name(walk));
    if (index < 0) return NULL;
    if (walk->path == NULL)
    {
        list->items[index] = walk->value;
        return NULL;
    }
    if (has_sections && list->items[index]->kind == SCREE_YAML_SECTION) return list->items[index];
    scree_scene_fault(walk->reader, &walk->at, "item %lld of %s has no keys; remove \".%s\" from the path",
                      (long long)index, list_name, walk->path);
    return NULL;
}

/// Puts the value under a key, in place of what is there.
static void set_key(override_walk *walk, scree_yaml_node *node, const char *name)
{
    for (int64_t k = 0; k < node->num_items; ++k)
        if (node->keys[k]->kind == SCREE_YAML_SCALAR && strcmp(node->keys[k]->text, name) == 0)
        {
            node->items[k] = walk->value;
            return;
        }
    if (scree_yaml_add_item(&walk->reader->tree, node, name, walk->value) != SCREE_OK)
        walk->reader->is_exhausted = true;
}

/// Follows the path from the root, section by section.
static void follow_path(override_walk *walk)
{
    scree_scene_reader *reader = walk->reader;
    scree_yaml_node *node = reader->root;
    const scree_scene_section *section = scree_scene_root();
    while (node != NULL && !reader->is_exhausted)
    {
        const char *name = next_name(walk);
        const int key = scree_scene_key_index(section, name);
        if (key < 0)
        {
            char remedy[400];
            scree_scene_suggest_key(section, name, remedy, sizeof remedy);
            scree_scene_fault(reader, &walk->at, "there is no key \"%.100s\" in %s; %s", name, section->title, remedy);
            return;
        }
        if (walk->path == NULL)
        {
            set_key(walk, node, name);
            return;
        }
        const enum cyaml_type type = section->fields[key].value.type;
        if (type != CYAML_MAPPING && type != CYAML_SEQUENCE && type != CYAML_SEQUENCE_FIXED)
        {
            scree_scene_fault(reader, &walk->at, "%s is a single value; remove \".%.100s\" from the path", name,
                              walk->path);
            return;
        }
        scree_yaml_node *child = scree_yaml_find(node, name);
        if (child == NULL) child = add_default(walk, node, section, key);
        if (child == NULL) return;
        if (type == CYAML_MAPPING && child->kind != SCREE_YAML_SECTION)
        {
            scree_scene_fault(reader, &walk->at, "%s is no section in the file; correct the file first", name);
            return;
        }
        node = type == CYAML_MAPPING ? child : enter_list(walk, child, section, key);
        section = section->keys[key].section;
    }
}

void scree_scene_override(scree_scene_reader *reader, int number)
{
    const char *text = reader->overrides[number];
    override_walk walk = {.reader = reader, .at = {.source = number + 1}};
    const char *equals = strchr(text, '=');
    if (equals == NULL || equals == text)
    {
        scree_scene_fault(reader, &walk.at, "an override is written PATH=VALUE, like time.end=2");
        return;
    }
    if (reader->root->kind != SCREE_YAML_SECTION) return;

    // the value is YAML of its own
    char name[300];
    snprintf(name, sizeof name, "--set %.200s", text);
    const scree_yaml_text value = {name, equals + 1, strlen(equals + 1), number + 1};
    const scree_status status = scree_yaml_parse(&reader->tree, &value, &walk.value, reader->report);
    if (status == SCREE_OK && walk.value == NULL)
    {
        walk.value = scree_yaml_add(&reader->tree, SCREE_YAML_SCALAR, "");
        if (walk.value != NULL) walk.value->source = number + 1;
    }
    const size_t length = (size_t)(equals - text);
    walk.path = scree_yaml_allocate(&reader->tree, length + 1);
    if (status == SCREE_OUT_OF_MEMORY || walk.path == NULL || (status == SCREE_OK && walk.value == NULL))
    {
        reader->is_exhausted = true;
        return;
    }
    if (status != SCREE_OK)
    {
        ++reader->num_faults;
        return;
    }
    memcpy(walk.path, text, length);
    walk.path[length] = '\0';
    follow_path(&walk);
}
