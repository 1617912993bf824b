/// \file yaml_write.c
/// A tree to YAML text through libyaml's emitter: sections in block style, lists of scalars on one line.
#include "io/yaml_tree.h"

#include <stdlib.h>
#include <string.h>
#include <yaml.h>

typedef struct tree_writer
{
    yaml_emitter_t emitter;
    bool numbers_only;
    bool is_complete; ///< false: no memory
    char *text;
    size_t length, size;
} tree_writer;

static int take_bytes(void *data, unsigned char *bytes, size_t num)
{
    tree_writer *writer = data;
    if (writer->size - writer->length <= num)
    {
        if (num > SIZE_MAX / 4 || writer->size > SIZE_MAX / 4) return 0;
        const size_t size = 2 * (writer->size + num) + 1024;
        char *grown = realloc(writer->text, size);
        if (grown == NULL) return 0;
        writer->text = grown;
        writer->size = size;
    }
    memcpy(writer->text + writer->length, bytes, num);
    writer->length += num;
    writer->text[writer->length] = '\0';
    return 1;
}

static void emit(tree_writer *writer, yaml_event_t *event, int is_made)
{
    if (is_made == 0 || (writer->is_complete && yaml_emitter_emit(&writer->emitter, event) == 0))
        writer->is_complete = false;
    else if (!writer->is_complete) yaml_event_delete(event);
}

static void write_scalar(tree_writer *writer, const scree_yaml_node *node)
{
    const char *text = writer->numbers_only && node->number_text != NULL ? node->number_text : node->text;
    const yaml_scalar_style_t style = node->is_quoted ? YAML_DOUBLE_QUOTED_SCALAR_STYLE : YAML_PLAIN_SCALAR_STYLE;
    yaml_event_t event;
    emit(writer, &event,
         yaml_scalar_event_initialize(&event, NULL, NULL, (const yaml_char_t *)text, (int)strlen(text), 1, 1, style));
}

static void write_node(tree_writer *writer, const scree_yaml_node *node)
{
    if (node->kind == SCREE_YAML_SCALAR)
    {
        write_scalar(writer, node);
        return;
    }
    const bool is_section = node->kind == SCREE_YAML_SECTION;
    bool is_flat = !is_section;
    for (int64_t k = 0; is_flat && k < node->num_items; ++k) is_flat = node->items[k]->kind == SCREE_YAML_SCALAR;
    yaml_event_t event;
    if (is_section)
        emit(writer, &event, yaml_mapping_start_event_initialize(&event, NULL, NULL, 1, YAML_BLOCK_MAPPING_STYLE));
    else
        emit(writer, &event,
             yaml_sequence_start_event_initialize(&event, NULL, NULL, 1,
                                                  is_flat ? YAML_FLOW_SEQUENCE_STYLE : YAML_BLOCK_SEQUENCE_STYLE));
    for (int64_t k = 0; k < node->num_items && writer->is_complete; ++k)
    {
        if (node->items[k] == NULL) continue;
        if (is_section) write_scalar(writer, node->keys[k]);
        write_node(writer, node->items[k]);
    }
    emit(writer, &event,
         is_section ? yaml_mapping_end_event_initialize(&event) : yaml_sequence_end_event_initialize(&event));
}

scree_status scree_yaml_write(const scree_yaml_node *root, bool numbers_only, char **out, size_t *length)
{
    tree_writer writer = {.numbers_only = numbers_only, .is_complete = true};
    *out = NULL;
    *length = 0;
    if (yaml_emitter_initialize(&writer.emitter) == 0) return SCREE_OUT_OF_MEMORY;
    yaml_emitter_set_output(&writer.emitter, take_bytes, &writer);
    yaml_emitter_set_unicode(&writer.emitter, 1);
    yaml_emitter_set_width(&writer.emitter, -1);
    yaml_event_t event;
    emit(&writer, &event, yaml_stream_start_event_initialize(&event, YAML_UTF8_ENCODING));
    emit(&writer, &event, yaml_document_start_event_initialize(&event, NULL, NULL, NULL, 1));
    write_node(&writer, root);
    emit(&writer, &event, yaml_document_end_event_initialize(&event, 1));
    emit(&writer, &event, yaml_stream_end_event_initialize(&event));
    yaml_emitter_delete(&writer.emitter);
    if (!writer.is_complete || writer.text == NULL)
    {
        free(writer.text);
        return SCREE_OUT_OF_MEMORY;
    }
    *out = writer.text;
    *length = writer.length;
    return SCREE_OK;
}
