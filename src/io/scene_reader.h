/// \file scene_reader.h
/// What the stages of the scene reader share: overrides, check against the tables, rules between keys.
#ifndef SCREE_SCENE_READER_H
#define SCREE_SCENE_READER_H

#include "io/scene_schema.h"
#include "io/yaml_tree.h"

#define SCREE_SCENE_MAX_SECTIONS 32
#define SCREE_SCENE_PATH_SIZE 320
/// Faults that are told one by one; the rest is counted.
#define SCREE_SCENE_MAX_TOLD 100

/// Nodes that all sections of one kind share.
typedef struct scree_scene_shared_nodes
{
    const scree_scene_section *section;
    scree_yaml_node **keys;     ///< (num_keys)
    scree_yaml_node **defaults; ///< (num_keys) NULL for sections and lists, which each get their own
} scree_scene_shared_nodes;

typedef struct scree_scene_reader
{
    const char *path;             ///< of the file, for messages
    const char *const *overrides; ///< nodes with source k > 0 came from overrides[k - 1]
    scree_report *report;         ///< may be NULL
    scree_yaml_tree tree;
    scree_yaml_node *root;
    int num_faults;    ///< also those that were not told
    bool is_exhausted; ///< no memory
    scree_scene_shared_nodes shared[SCREE_SCENE_MAX_SECTIONS];
    int num_shared;
} scree_scene_reader;

/// Tells a fault at a node: file and line, or the override it came from. After a hundred they are only counted.
void scree_scene_fault(scree_scene_reader *reader, const scree_yaml_node *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void scree_scene_warn(scree_scene_reader *reader, const scree_yaml_node *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/// Value of a node for a message: short, printable, texts in quotes.
void scree_scene_show(const scree_yaml_node *node, char *text, size_t size);

/// Puts the value of overrides[number] into the tree.
void scree_scene_override(scree_scene_reader *reader, int number);
/// Checks the tree against the tables, fills in defaults and puts the keys in order.
void scree_scene_check(scree_scene_reader *reader);
/// Checks what the tables cannot say: names, pairs of materials, keys that belong together; fills in times of output.
void scree_scene_check_rules(scree_scene_reader *reader);

/// Index of a key in the table; -1 if it has none of this name.
int scree_scene_key_index(const scree_scene_section *section, const char *name);
/// " did you mean X?" or the list of keys: what to do about an unknown key.
void scree_scene_suggest_key(const scree_scene_section *section, const char *name, char *text, size_t size);
/// A number as YAML and C write it in plain decimals.
bool scree_scene_is_number(const char *text);
/// Default of a key as a node; NULL: no memory.
scree_yaml_node *scree_scene_default(scree_scene_reader *reader, const scree_scene_section *section, int key);

#endif
