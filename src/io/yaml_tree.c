/// \file yaml_tree.c
/// Nodes of a YAML text and their memory: blocks that are only freed together.
#include "io/yaml_tree.h"

#include <stdlib.h>
#include <string.h>

typedef struct scree_yaml_block
{
    struct scree_yaml_block *next;
    size_t used, size; ///< bytes behind this header
} scree_yaml_block;

static const size_t block_size = 1 << 16;

void scree_yaml_tree_destroy(scree_yaml_tree *tree)
{
    for (scree_yaml_block *block = tree->blocks; block != NULL;)
    {
        scree_yaml_block *next = block->next;
        free(block);
        block = next;
    }
    *tree = (scree_yaml_tree){0};
}

void *scree_yaml_allocate(scree_yaml_tree *tree, size_t size)
{
    const size_t alignment = _Alignof(max_align_t);
    const size_t header = (sizeof(scree_yaml_block) + alignment - 1) / alignment * alignment;
    if (size > SIZE_MAX / 2) return NULL;
    size = (size + alignment - 1) / alignment * alignment;
    if (tree->blocks == NULL || tree->blocks->size - tree->blocks->used < size)
    {
        const size_t room = size > block_size ? size : block_size;
        scree_yaml_block *block = malloc(header + room);
        if (block == NULL) return NULL;
        *block = (scree_yaml_block){.next = tree->blocks, .used = 0, .size = room};
        tree->blocks = block;
    }
    char *place = (char *)tree->blocks + header + tree->blocks->used;
    tree->blocks->used += size;
    return place;
}

scree_yaml_node *scree_yaml_add(scree_yaml_tree *tree, scree_yaml_kind kind, const char *text)
{
    scree_yaml_node *node = scree_yaml_allocate(tree, sizeof *node);
    if (node == NULL) return NULL;
    *node = (scree_yaml_node){.kind = kind};
    if (kind == SCREE_YAML_SCALAR)
    {
        const size_t size = strlen(text) + 1;
        char *copy = scree_yaml_allocate(tree, size);
        if (copy == NULL) return NULL;
        memcpy(copy, text, size);
        node->text = copy;
    }
    return node;
}

scree_status scree_yaml_add_item(scree_yaml_tree *tree, scree_yaml_node *section, const char *key,
                                 scree_yaml_node *value)
{
    // sections are small and rarely added to, so the arrays grow by one
    const size_t num = (size_t)section->num_items;
    scree_yaml_node **keys = scree_yaml_allocate(tree, (num + 1) * sizeof(scree_yaml_node *));
    scree_yaml_node **items = scree_yaml_allocate(tree, (num + 1) * sizeof(scree_yaml_node *));
    scree_yaml_node *name = scree_yaml_add(tree, SCREE_YAML_SCALAR, key);
    if (keys == NULL || items == NULL || name == NULL) return SCREE_OUT_OF_MEMORY;
    name->line = value->line;
    name->source = value->source;
    if (num > 0)
    {
        memcpy(keys, section->keys, num * sizeof(scree_yaml_node *));
        memcpy(items, section->items, num * sizeof(scree_yaml_node *));
    }
    keys[num] = name;
    items[num] = value;
    section->keys = keys;
    section->items = items;
    ++section->num_items;
    return SCREE_OK;
}

scree_yaml_node *scree_yaml_find(const scree_yaml_node *section, const char *key)
{
    if (section == NULL || section->kind != SCREE_YAML_SECTION) return NULL;
    for (int64_t k = 0; k < section->num_items; ++k)
        if (section->keys[k]->kind == SCREE_YAML_SCALAR && strcmp(section->keys[k]->text, key) == 0)
            return section->items[k];
    return NULL;
}

bool scree_yaml_is_null(const scree_yaml_node *node)
{
    if (node->kind != SCREE_YAML_SCALAR || node->is_quoted) return false;
    return node->text[0] == '\0' || strcmp(node->text, "~") == 0 || strcmp(node->text, "null") == 0;
}
