/// \file schema_tables.h
/// What the tables of keys are written with.
#ifndef SCREE_SCHEMA_TABLES_H
#define SCREE_SCHEMA_TABLES_H

#include "io/scene_schema.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof((array)[0])))
#define FORCE (CYAML_FLAG_DEFAULT | CYAML_FLAG_STRICT)

/// Largest magnitudes: beyond them a double loses what a simulation needs, or a value is a slip of the unit.
#define MAX_POSITION 1e6
#define MAX_VELOCITY 1e6
#define MAX_TIME 1e9
#define MAX_INTEGER 9007199254740992.0 // 2^53: every integer up to here is a double

static const cyaml_schema_value_t number_value = {CYAML_VALUE_FLOAT(FORCE, double)};
static const cyaml_schema_value_t name_value = {CYAML_VALUE_STRING(CYAML_FLAG_POINTER, char *, 1, CYAML_UNLIMITED)};

#define NUMBER(type, member) CYAML_FIELD_FLOAT(#member, FORCE, type, member)
#define INTEGER(type, member) CYAML_FIELD_INT(#member, FORCE, type, member)
#define TRUTH(type, member) CYAML_FIELD_BOOL(#member, FORCE, type, member)
#define TEXT(type, member) CYAML_FIELD_STRING_PTR(#member, CYAML_FLAG_POINTER, type, member, 0, CYAML_UNLIMITED)
#define WORD(type, member, words) CYAML_FIELD_ENUM(#member, FORCE, type, member, words, CYAML_ARRAY_LEN(words))
#define NUMBERS(type, member, count) \
    CYAML_FIELD_SEQUENCE_FIXED(#member, CYAML_FLAG_DEFAULT, type, member, &number_value, count)
#define SECTION(type, member, fields) CYAML_FIELD_MAPPING(#member, CYAML_FLAG_DEFAULT, type, member, fields)
#define LIST(type, member, entry) \
    CYAML_FIELD_SEQUENCE_COUNT(#member, CYAML_FLAG_POINTER, type, member, num_##member, entry, 0, CYAML_UNLIMITED)

/// Shapes have a file of their own.
extern const scree_scene_section scree_scene_shape_section;
extern const cyaml_schema_value_t scree_scene_shape_value;

#endif
