/// \file yaml_tree.h
/// A YAML text as a tree that can be changed: libyaml finds the values and their lines, aliases are expanded into
/// copies of their own. All memory of a tree is given back at once.
#ifndef SCREE_YAML_TREE_H
#define SCREE_YAML_TREE_H

#include "scree/base.h"

typedef enum scree_yaml_kind
{
    SCREE_YAML_SCALAR,
    SCREE_YAML_LIST,
    SCREE_YAML_SECTION ///< keys and values
} scree_yaml_kind;

typedef struct scree_yaml_node
{
    scree_yaml_kind kind;
    int32_t source;                 ///< which text it came from; see scree_yaml_text
    int64_t line;                   ///< from 1
    const char *text;               ///< of a scalar
    const char *number_text;        ///< what stands for the text where only numbers can be read; NULL: the text itself
    double number;                  ///< value of a checked number
    struct scree_yaml_node **keys;  ///< (num_items) of a section, scalars; NULL in a list
    struct scree_yaml_node **items; ///< (num_items) values; NULL entries are left out when written
    int64_t num_items;
    bool is_quoted;  ///< written in quotes or as a block, so never empty or a number by accident
    bool is_default; ///< filled in
    bool is_refused; ///< a fault has been told: do not look at it again
} scree_yaml_node;

/// Owns all nodes and their texts. Start from {0}; free with scree_yaml_tree_destroy().
typedef struct scree_yaml_tree
{
    struct scree_yaml_block *blocks;
} scree_yaml_tree;

/// A text to read.
typedef struct scree_yaml_text
{
    const char *name; ///< in front of the messages, "scene.yaml"
    const char *text; ///< need not end with zero
    size_t length;
    int32_t source; ///< stored in the nodes
} scree_yaml_text;

void scree_yaml_tree_destroy(scree_yaml_tree *tree);
/// Memory that lives as long as the tree; NULL if there is none. Not zeroed.
void *scree_yaml_allocate(scree_yaml_tree *tree, size_t size);
/// A fresh scalar with a copy of the text, or an empty list or section. NULL: no memory.
scree_yaml_node *scree_yaml_add(scree_yaml_tree *tree, scree_yaml_kind kind, const char *text);
/// Adds a value under a key. SCREE_OUT_OF_MEMORY.
scree_status scree_yaml_add_item(scree_yaml_tree *tree, scree_yaml_node *section, const char *key,
                                 scree_yaml_node *value);
/// Value of a key; NULL if there is none or the node is no section. The first one if the key is there twice.
scree_yaml_node *scree_yaml_find(const scree_yaml_node *section, const char *key);
/// A scalar without a value: nothing, ~ or null.
bool scree_yaml_is_null(const scree_yaml_node *node);

/// Reads one document. *root is NULL if it holds nothing. SCREE_INVALID_INPUT (told with line, column and what was
/// expected), SCREE_OUT_OF_MEMORY.
scree_status scree_yaml_parse(scree_yaml_tree *tree, const scree_yaml_text *text, scree_yaml_node **root,
                              scree_report *report);

/// Writes the tree as YAML; *out is freed by the caller with free(). With `numbers_only` each number_text stands in
/// for its text. SCREE_OUT_OF_MEMORY.
scree_status scree_yaml_write(const scree_yaml_node *root, bool numbers_only, char **out, size_t *length);

#endif
