/// \file scene_schema.h
/// What a scene may hold: for each section the schema that libcyaml fills the structures of types.h by, and beside it
/// a table of unit, default, range and meaning. The reader, --help and docs/scenes.md are made from these tables.
#ifndef SCREE_SCENE_SCHEMA_H
#define SCREE_SCENE_SCHEMA_H

#include "scree/types.h"

#include <cyaml/cyaml.h>
#include <stdio.h>

/// What the texts of a key may be.
typedef enum scree_text_rule
{
    SCREE_TEXT_FREE,          ///< anything printable
    SCREE_TEXT_NAME,          ///< letters, digits, _ and -, not digits alone: so that --set can address it
    SCREE_TEXT_PATH,          ///< a file
    SCREE_TEXT_OPTIONAL_NAME, ///< a name, or empty for none
    SCREE_TEXT_WORD           ///< one of `words`
} scree_text_rule;

/// One key of a section.
typedef struct scree_scene_key
{
    const char *name;
    const char *unit;         ///< "" if it has none
    const char *default_text; ///< as in a file; NULL: must be given
    const char *meaning;
    double min, max;     ///< of a number or each number of a list; of the items of a list of sections: largest number
    const char *special; ///< word that may stand for the number: "auto", "never", or NULL
    scree_text_rule rule;
    const char *const *words; ///< (num_words) of SCREE_TEXT_WORD
    int num_words;
    const struct scree_scene_section *section; ///< keys of a section or of the items of a list
} scree_scene_key;

typedef struct scree_scene_section
{
    const char *title;                  ///< "materials[]", for the manual
    const char *text;                   ///< what it is for
    const cyaml_schema_field_t *fields; ///< (num_keys), ends with an empty one
    const scree_scene_key *keys;        ///< (num_keys), in the same order
    int num_keys;
} scree_scene_section;

/// The whole scene.
const scree_scene_section *scree_scene_root(void);
/// Contact laws, whose models have a table of their own.
const scree_scene_section *scree_scene_law_section(void);
/// The schema of it for libcyaml.
const cyaml_schema_value_t *scree_scene_root_value(void);

/// "one of fixed, translate, rotate", "a number in [0.01, 1] or auto", ...: what a key takes. Cut off at `size`.
void scree_scene_describe(const scree_scene_section *section, int key, char *text, size_t size);
/// The same of one item of a list of numbers or names.
void scree_scene_describe_item(const scree_scene_section *section, int key, char *text, size_t size);
/// The words that a key takes, one by one from 0; NULL behind the last or if it takes no words.
const char *scree_scene_word(const scree_scene_section *section, int key, int word);

#endif
