/// \file yaml_parse.c
/// A YAML text to a tree through libyaml, whose marks give the lines. What libyaml says of broken syntax is completed
/// by what to do about it.
#include "io/yaml_tree.h"

#include <stdio.h>
#include <string.h>
#include <yaml.h>

/// Scenes are shallow; what is deeper is an alias inside its own anchor, or no scene.
#define MAX_DEPTH 32
/// Aliases of lists of aliases can ask for any number of values, an alias of a long text for any number of bytes. So
/// many values are allowed, and two for each byte of text, which no text without aliases needs; a value that is a long
/// text counts for several.
#define MAX_VALUES 100000

typedef struct tree_reader
{
    scree_yaml_tree *tree;
    const scree_yaml_text *text;
    yaml_document_t *document;
    scree_report *report;
    int64_t num_values;  ///< so far
    scree_status status; ///< the first thing that went wrong
} tree_reader;

/// What to do about a fault of libyaml; the texts are those of libyaml 0.2.
static const char *remedy_for(const char *problem, bool is_after_tab)
{
    static const struct
    {
        const char *problem, *remedy;
    } remedies[] = {
        {"mapping values are not allowed", "check the indentation, and put texts that hold \": \" in quotes"},
        {"did not find expected node content", "a value or a closing bracket is missing"},
        {"did not find expected key", "check the indentation and the brackets before it"},
        {"did not find expected '-' indicator", "list items of one list start in the same column, each with \"- \""},
        {"did not find expected ',' or ']'", "close the list with ]"},
        {"did not find expected ',' or '}'", "close the section with }"},
        {"could not find expected ':'", "write \"key: value\" with a space behind the colon"},
        {"found undefined alias", "an alias *x needs an anchor &x before it"},
        {"found unexpected end of stream", "close the quotes"},
        {"did not find expected <document start>", "indent all keys of the scene alike"},
        {"control characters are not allowed", "a scene is a plain text in UTF-8"},
        {"tab character", "indent with spaces, not with tabs"},
        {"UTF-8", "a scene is a plain text in UTF-8"},
        {"UTF-16", "a scene is a plain text in UTF-8"},
    };
    if (strstr(problem, "cannot start any token") != NULL)
        return is_after_tab ? "indent with spaces, not with tabs" : "put the text in quotes";
    for (size_t k = 0; k < sizeof remedies / sizeof remedies[0]; ++k)
        if (strstr(problem, remedies[k].problem) != NULL) return remedies[k].remedy;
    return "compare with the scenes that come with scree";
}

static int64_t line_of_offset(const scree_yaml_text *text, size_t offset)
{
    int64_t line = 1;
    for (size_t k = 0; k < offset && k < text->length; ++k) line += text->text[k] == '\n';
    return line;
}

static bool is_indented_by_tab(const scree_yaml_text *text, size_t line)
{
    size_t k = 0;
    for (; line > 0 && k < text->length; ++k) line -= text->text[k] == '\n';
    while (k < text->length && text->text[k] == ' ') ++k;
    return k < text->length && text->text[k] == '\t';
}

/// Tells what libyaml found.
static scree_status tell_syntax(const yaml_parser_t *parser, const scree_yaml_text *text, scree_report *report)
{
    const char *problem = parser->problem;
    // libyaml leaves some of its own allocation failures without a text
    if (parser->error == YAML_MEMORY_ERROR || parser->problem == NULL) return SCREE_OUT_OF_MEMORY;
    if (parser->error == YAML_READER_ERROR)
    {
        scree_report_add(report, "%s:%lld: byte %zu: %s; %s", text->name,
                         (long long)line_of_offset(text, parser->problem_offset), parser->problem_offset, problem,
                         remedy_for(problem, false));
        return SCREE_INVALID_INPUT;
    }
    const yaml_mark_t at = parser->problem_mark;
    char context[200] = "";
    if (parser->context != NULL)
        snprintf(context, sizeof context, " %s that starts in line %zu", parser->context,
                 parser->context_mark.line + 1);
    scree_report_add(report, "%s:%zu:%zu: %s%s; %s", text->name, at.line + 1, at.column + 1, problem, context,
                     remedy_for(problem, is_indented_by_tab(text, at.line)));
    return SCREE_INVALID_INPUT;
}

static scree_yaml_node *read_node(tree_reader *reader, int id, int depth);

/// Keys and values, or items, of a collection.
static void read_items(tree_reader *reader, const yaml_node_t *from, scree_yaml_node *node, int depth)
{
    const bool is_section = node->kind == SCREE_YAML_SECTION;
    const int64_t num = is_section ? from->data.mapping.pairs.top - from->data.mapping.pairs.start
                                   : from->data.sequence.items.top - from->data.sequence.items.start;
    const size_t size = ((size_t)num + 1) * sizeof(scree_yaml_node *);
    node->items = scree_yaml_allocate(reader->tree, size);
    node->keys = is_section ? scree_yaml_allocate(reader->tree, size) : NULL;
    if (node->items == NULL || (is_section && node->keys == NULL)) reader->status = SCREE_OUT_OF_MEMORY;
    for (int64_t k = 0; k < num && reader->status == SCREE_OK; ++k)
    {
        if (is_section)
        {
            node->keys[k] = read_node(reader, from->data.mapping.pairs.start[k].key, depth + 1);
            if (reader->status == SCREE_OK)
                node->items[k] = read_node(reader, from->data.mapping.pairs.start[k].value, depth + 1);
        }
        else node->items[k] = read_node(reader, from->data.sequence.items.start[k], depth + 1);
        node->num_items = k + 1;
    }
}

/// A node and all below it; on a fault the status of the reader says so.
static scree_yaml_node *read_node(tree_reader *reader, int id, int depth)
{
    const yaml_node_t *from = yaml_document_get_node(reader->document, id);
    const int64_t line = from == NULL ? 0 : (int64_t)from->start_mark.line + 1;
    if (depth > MAX_DEPTH || reader->num_values > MAX_VALUES + 2 * (int64_t)reader->text->length)
    {
        const char *name = reader->text->name;
        if (depth > MAX_DEPTH)
            scree_report_add(reader->report,
                             "%s:%lld: more than %d levels inside each other; is an alias inside its own anchor?", name,
                             (long long)line, MAX_DEPTH);
        else
            scree_report_add(reader->report, "%s:%lld: aliases make more than %lld values of this text; use fewer",
                             name, (long long)line, (long long)reader->num_values - 1);
        reader->status = SCREE_INVALID_INPUT;
        return NULL;
    }
    const bool is_scalar = from == NULL || from->type == YAML_SCALAR_NODE;
    const scree_yaml_kind kind = is_scalar                          ? SCREE_YAML_SCALAR
                                 : from->type == YAML_SEQUENCE_NODE ? SCREE_YAML_LIST
                                                                    : SCREE_YAML_SECTION;
    const char *value = is_scalar && from != NULL ? (const char *)from->data.scalar.value : "";
    reader->num_values += 1 + (int64_t)(strlen(value) / 8);
    scree_yaml_node *node = scree_yaml_add(reader->tree, kind, value);
    if (node == NULL)
    {
        reader->status = SCREE_OUT_OF_MEMORY;
        return NULL;
    }
    node->line = line;
    node->source = reader->text->source;
    if (!is_scalar) read_items(reader, from, node, depth);
    else if (from != NULL)
    {
        node->is_quoted = from->data.scalar.style != YAML_PLAIN_SCALAR_STYLE;
        if (strlen(value) == from->data.scalar.length) return node;
        scree_report_add(reader->report, "%s:%lld: a text holds a character zero; remove it", reader->text->name,
                         (long long)line);
        reader->status = SCREE_INVALID_INPUT;
    }
    return node;
}

/// One document after the other: the first is the scene, a second must not follow.
static scree_status read_documents(yaml_parser_t *parser, const scree_yaml_text *text, scree_yaml_tree *tree,
                                   scree_yaml_node **root, scree_report *report)
{
    yaml_document_t document;
    if (yaml_parser_load(parser, &document) == 0) return tell_syntax(parser, text, report);
    if (yaml_document_get_root_node(&document) == NULL)
    {
        yaml_document_delete(&document);
        return SCREE_OK;
    }
    tree_reader reader = {tree, text, &document, report, 0, SCREE_OK};
    *root = read_node(&reader, 1, 0);
    yaml_document_delete(&document);
    if (reader.status != SCREE_OK) return reader.status;

    if (yaml_parser_load(parser, &document) == 0) return tell_syntax(parser, text, report);
    const yaml_node_t *second = yaml_document_get_root_node(&document);
    const int64_t line = second == NULL ? 0 : (int64_t)second->start_mark.line + 1;
    yaml_document_delete(&document);
    if (line == 0) return SCREE_OK;
    scree_report_add(report, "%s:%lld: a second document starts here; a file holds one scene, so remove the \"---\"",
                     text->name, (long long)line);
    return SCREE_INVALID_INPUT;
}

scree_status scree_yaml_parse(scree_yaml_tree *tree, const scree_yaml_text *text, scree_yaml_node **root,
                              scree_report *report)
{
    yaml_parser_t parser;
    *root = NULL;
    if (yaml_parser_initialize(&parser) == 0) return SCREE_OUT_OF_MEMORY;
    yaml_parser_set_input_string(&parser, (const unsigned char *)text->text, text->length);
    const scree_status status = read_documents(&parser, text, tree, root, report);
    yaml_parser_delete(&parser);
    if (status != SCREE_OK) *root = NULL;
    return status;
}
