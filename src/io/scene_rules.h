/// \file scene_rules.h
/// Shared by the rules between keys: values of checked sections, names and what they stand for.
#ifndef SCREE_SCENE_RULES_H
#define SCREE_SCENE_RULES_H

#include "io/scene_reader.h"

/// Values of a checked section. False or NULL if the value was refused, is missing or is of another kind.
bool scree_rules_number(const scree_yaml_node *section, const char *key, double *number);
bool scree_rules_numbers(const scree_yaml_node *section, const char *key, double *numbers, int num);
const char *scree_rules_text(const scree_yaml_node *section, const char *key);
/// True if the key stands in the file, whatever its value.
bool scree_rules_is_given(const scree_yaml_node *section, const char *key);
/// Where a message about a key points to: its value, or the section if it was filled in.
const scree_yaml_node *scree_rules_place(const scree_yaml_node *section, const char *key);
/// 0 if it is not a list.
int64_t scree_rules_num_items(const scree_yaml_node *list);

typedef struct scree_rules_name
{
    const char *name;
    int64_t index; ///< of the item in its list
    bool is_used;
} scree_rules_name;

/// Names of the items of one list, sorted.
typedef struct scree_rules_names
{
    const char *list_name;
    scree_rules_name *names; ///< (num)
    int64_t num;
    bool is_incomplete; ///< some item has no valid name
} scree_rules_names;

/// Collects the names of a list of the scene and tells those that are there twice.
scree_rules_names scree_rules_collect(scree_scene_reader *reader, const char *list_name);
/// Index of the item of this name; -1 if there is none. Marks it as used.
int64_t scree_rules_find(scree_rules_names *names, const char *name);
/// The same for a value; tells a name that is not there.
int64_t scree_rules_resolve(scree_scene_reader *reader, scree_rules_names *names, const scree_yaml_node *at,
                            const char *label);
void scree_rules_warn_unused(scree_scene_reader *reader, const scree_rules_names *names);

/// What groups and walls are made of.
typedef struct scree_rules_scene
{
    scree_rules_names *materials, *shapes;
    int64_t *group_material; ///< (num_groups) -1: not known
    bool *is_group_of_many;  ///< (num_groups) has more than one particle
    int64_t num_groups;
    int64_t *wall_material; ///< (num_walls) -1: not known
    int64_t num_walls;
} scree_rules_scene;

void scree_rules_check_shapes(scree_scene_reader *reader, scree_rules_names *names);
void scree_rules_check_groups(scree_scene_reader *reader, scree_rules_scene *scene);
void scree_rules_check_walls(scree_scene_reader *reader, scree_rules_scene *scene);

#endif
