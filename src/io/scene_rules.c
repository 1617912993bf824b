/// \file scene_rules.c
/// What the tables of keys cannot say: names that must exist and be there once, pairs of materials that can meet and
/// need a law, keys that belong together or exclude each other. Values that were refused before are not looked at.
#include "io/scene_rules.h"
#include "io/nearest_name.h"

#include "forces/force_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Densities [kg/m^3] below are told; those in g/cm^3 are up to 23.
#define LIGHT 25.0

bool scree_rules_number(const scree_yaml_node *section, const char *key, double *number)
{
    const scree_yaml_node *node = scree_yaml_find(section, key);
    if (node == NULL || node->is_refused || node->kind != SCREE_YAML_SCALAR) return false;
    *number = node->number;
    return true;
}

bool scree_rules_numbers(const scree_yaml_node *section, const char *key, double *numbers, int num)
{
    const scree_yaml_node *node = scree_yaml_find(section, key);
    if (node == NULL || node->is_refused || node->kind != SCREE_YAML_LIST || node->num_items != num) return false;
    for (int k = 0; k < num; ++k) numbers[k] = node->items[k]->number;
    return true;
}

const char *scree_rules_text(const scree_yaml_node *section, const char *key)
{
    const scree_yaml_node *node = scree_yaml_find(section, key);
    return node == NULL || node->is_refused || node->kind != SCREE_YAML_SCALAR ? NULL : node->text;
}

bool scree_rules_is_given(const scree_yaml_node *section, const char *key)
{
    const scree_yaml_node *node = scree_yaml_find(section, key);
    return node != NULL && !node->is_default;
}

const scree_yaml_node *scree_rules_place(const scree_yaml_node *section, const char *key)
{
    const scree_yaml_node *node = scree_yaml_find(section, key);
    return node == NULL || node->is_default ? section : node;
}

int64_t scree_rules_num_items(const scree_yaml_node *list)
{
    return list == NULL || list->is_refused || list->kind != SCREE_YAML_LIST ? 0 : list->num_items;
}

// -------------------------------------------------------------------------------------------------------------- names

static int compare_names(const void *a, const void *b)
{
    const scree_rules_name *x = a, *y = b;
    const int order = strcmp(x->name, y->name);
    return order != 0 ? order : (x->index > y->index) - (x->index < y->index);
}

scree_rules_names scree_rules_collect(scree_scene_reader *reader, const char *list_name)
{
    scree_rules_names names = {.list_name = list_name};
    const scree_yaml_node *list = scree_yaml_find(reader->root, list_name);
    const int64_t num = scree_rules_num_items(list);
    names.names = scree_yaml_allocate(&reader->tree, ((size_t)num + 1) * sizeof *names.names);
    if (names.names == NULL)
    {
        reader->is_exhausted = true;
        return names;
    }
    for (int64_t k = 0; k < num; ++k)
    {
        const char *name = scree_rules_text(list->items[k], "name");
        if (name == NULL) names.is_incomplete = true;
        else names.names[names.num++] = (scree_rules_name){name, k, false};
    }
    qsort(names.names, (size_t)names.num, sizeof *names.names, compare_names);
    for (int64_t k = 1; k < names.num; ++k)
    {
        const scree_rules_name *first = names.names + k - 1, *second = names.names + k;
        if (strcmp(first->name, second->name) != 0) continue;
        scree_scene_fault(reader, scree_yaml_find(list->items[second->index], "name"),
                          "name of %s.%lld is \"%.255s\", which %s.%lld is called already; choose another one",
                          list_name, (long long)second->index, second->name, list_name, (long long)first->index);
    }
    return names;
}

int64_t scree_rules_find(scree_rules_names *names, const char *name)
{
    int64_t low = 0, high = names->num;
    while (low < high)
    {
        const int64_t middle = (low + high) / 2;
        if (strcmp(names->names[middle].name, name) < 0) low = middle + 1;
        else high = middle;
    }
    if (low == names->num || strcmp(names->names[low].name, name) != 0) return -1;
    names->names[low].is_used = true;
    return names->names[low].index;
}

int64_t scree_rules_resolve(scree_scene_reader *reader, scree_rules_names *names, const scree_yaml_node *at,
                            const char *label)
{
    if (at == NULL || at->is_refused || at->kind != SCREE_YAML_SCALAR) return -1;
    const int64_t index = scree_rules_find(names, at->text);
    if (index >= 0) return index;
    // an item whose own name was refused may be the one that is meant
    if (names->is_incomplete) return -1;

    const char *nearest = NULL;
    for (int64_t k = 0; k < names->num && nearest == NULL; ++k)
        if (scree_name_is_near(at->text, names->names[k].name)) nearest = names->names[k].name;
    if (nearest != NULL)
        scree_scene_fault(reader, at, "%s is \"%.255s\", which is not among the %s; did you mean \"%.255s\"?", label,
                          at->text, names->list_name, nearest);
    else if (names->num == 0)
        scree_scene_fault(reader, at, "%s is \"%.255s\", but there are no %s; add one of this name", label, at->text,
                          names->list_name);
    else
        scree_scene_fault(reader, at,
                          "%s is \"%.255s\", which is not among the %s; add it, or take one like \"%.255s\"", label,
                          at->text, names->list_name, names->names[0].name);
    return -1;
}

void scree_rules_warn_unused(scree_scene_reader *reader, const scree_rules_names *names)
{
    const scree_yaml_node *list = scree_yaml_find(reader->root, names->list_name);
    for (int64_t k = 0; k < names->num; ++k)
        if (!names->names[k].is_used)
            scree_scene_warn(reader, list->items[names->names[k].index], "%s.%lld, \"%.255s\", is not used",
                             names->list_name, (long long)names->names[k].index, names->names[k].name);
}

// ------------------------------------------------------------------------------------------------------- contact laws

/// Parameters that the model has no use for, or cannot do without.
static void check_model(scree_scene_reader *reader, const scree_yaml_node *law, int64_t index)
{
    const char *name = scree_rules_text(law, "model");
    const int32_t model = name != NULL ? scree_force_model_find(name) : -1;
    if (model < 0) return;
    int32_t num_parameters;
    const scree_force_parameter *parameters = scree_force_parameters(&num_parameters);
    for (int32_t k = 0; k < num_parameters; ++k)
    {
        const char *key = parameters[k].name;
        double value = 0;
        const bool is_known = scree_rules_number(law, key, &value);
        if ((parameters[k].used_by >> model & 1) == 0 && is_known && !isnan(value))
            scree_scene_fault(reader, scree_rules_place(law, key),
                              "%s of contact_laws.%lld has no effect with model %s; remove it, or choose a model that "
                              "uses it",
                              key, (long long)index, name);
        if ((parameters[k].needed_by >> model & 1) != 0 && is_known && isnan(value))
            scree_scene_fault(reader, scree_rules_place(law, key),
                              "contact_laws.%lld has no %s, which model %s needs; add it", (long long)index, key, name);
    }
}

/// A rolling resistance has its coefficients, and only then.
static void check_rolling(scree_scene_reader *reader, const scree_yaml_node *law, int64_t index)
{
    const char *kind = scree_rules_text(law, "rolling_resistance");
    double coefficient, damping;
    if (kind == NULL || !scree_rules_number(law, "rolling_friction_coefficient", &coefficient)) return;
    const bool is_none = strcmp(kind, "none") == 0;
    if (is_none != isnan(coefficient))
        scree_scene_fault(reader, scree_rules_place(law, "rolling_friction_coefficient"),
                          is_none ? "contact_laws.%lld has a rolling_friction_coefficient, but no rolling_resistance; "
                                    "set it to constant or spring, or remove the coefficient"
                                  : "contact_laws.%lld has a rolling_resistance, but no rolling_friction_coefficient; "
                                    "add it",
                          (long long)index);
    if (strcmp(kind, "spring") != 0 && scree_rules_number(law, "rolling_damping_ratio", &damping) && damping != 0)
        scree_scene_fault(reader, scree_rules_place(law, "rolling_damping_ratio"),
                          "rolling_damping_ratio of contact_laws.%lld has no effect with rolling_resistance %s; remove "
                          "it, or choose spring",
                          (long long)index, kind);
}

/// Damping by one of two keys, a switch that is 0 or 1, parameters of the model.
static void check_law(scree_scene_reader *reader, const scree_yaml_node *law, int64_t index)
{
    double restitution, damping, spring, exponent;
    if (scree_rules_number(law, "restitution_coefficient", &restitution) &&
        scree_rules_number(law, "damping_ratio", &damping) && isnan(restitution) == isnan(damping))
        scree_scene_fault(reader, law,
                          isnan(damping)
                              ? "contact_laws.%lld has neither restitution_coefficient nor damping_ratio; give one of "
                                "them, damping_ratio: 0 for no damping"
                              : "contact_laws.%lld has both restitution_coefficient and damping_ratio; remove one",
                          (long long)index);
    if (scree_rules_number(law, "tangential_spring", &spring) && spring != 0 && spring != 1)
        scree_scene_fault(reader, scree_rules_place(law, "tangential_spring"),
                          "tangential_spring of contact_laws.%lld is %g; it must be 0 or 1", (long long)index, spring);

    if (scree_rules_number(law, "energy_exponent", &exponent) && !isnan(exponent) &&
        4 * exponent != floor(4 * exponent))
        scree_scene_fault(reader, scree_rules_place(law, "energy_exponent"),
                          "energy_exponent of contact_laws.%lld is %g; it must be 1, 1.25, 1.5, 1.75 or 2",
                          (long long)index, exponent);
    check_rolling(reader, law, index);
    check_model(reader, law, index);
}

/// Pairs of materials as a square of flags.
typedef struct material_pairs
{
    int64_t *law_of; ///< (num, num) 1 + number of the law; 0: none
    int64_t num;
    bool is_incomplete; ///< a law or a material was refused, so a missing pair may not be missing
} material_pairs;

static void check_laws(scree_scene_reader *reader, scree_rules_names *materials, material_pairs *pairs)
{
    const scree_yaml_node *laws = scree_yaml_find(reader->root, "contact_laws");
    pairs->is_incomplete |= laws == NULL || laws->is_refused || materials->is_incomplete;
    for (int64_t k = 0; k < scree_rules_num_items(laws); ++k)
    {
        const scree_yaml_node *law = laws->items[k], *both = scree_yaml_find(law, "materials");
        check_law(reader, law, k);
        int64_t index[2] = {-1, -1};
        const bool has_names = both != NULL && both->kind == SCREE_YAML_LIST && both->num_items == 2;
        for (int m = 0; has_names && m < 2; ++m)
        {
            char label[80];
            snprintf(label, sizeof label, "materials.%d of contact_laws.%lld", m, (long long)k);
            index[m] = scree_rules_resolve(reader, materials, both->items[m], label);
        }
        if (index[0] < 0 || index[1] < 0)
        {
            pairs->is_incomplete = true;
            continue;
        }
        int64_t *first = pairs->law_of + index[0] * pairs->num + index[1];
        if (*first > 0)
            scree_scene_fault(reader, law,
                              "contact_laws.%lld is for \"%.255s\" and \"%.255s\", and so is contact_laws.%lld; remove "
                              "one",
                              (long long)k, both->items[0]->text, both->items[1]->text, (long long)*first - 1);
        else *first = pairs->law_of[index[1] * pairs->num + index[0]] = k + 1;
    }
}

/// A group of particles or a wall, as far as contacts go.
typedef struct meeting_body
{
    int64_t material; ///< -1: not known
    bool is_many;     ///< meets its like
    const char *list;
    int64_t index;
} meeting_body;

static void require_law(scree_scene_reader *reader, material_pairs *pairs, const meeting_body *a, const meeting_body *b)
{
    if (a->material < 0 || b->material < 0) return;
    int64_t *law = pairs->law_of + a->material * pairs->num + b->material;
    if (*law != 0) return;
    const scree_yaml_node *materials = scree_yaml_find(reader->root, "materials");
    const char *name_a = scree_rules_text(materials->items[a->material], "name");
    const char *name_b = scree_rules_text(materials->items[b->material], "name");
    scree_scene_fault(reader, scree_rules_place(reader->root, "contact_laws"),
                      "contact_laws has none for \"%.255s\" and \"%.255s\", which can meet in %s.%lld and %s.%lld; add "
                      "- {materials: [%.255s, %.255s], friction_coefficient: ..., restitution_coefficient: ...}",
                      name_a, name_b, a->list, (long long)a->index, b->list, (long long)b->index, name_a, name_b);
    *law = pairs->law_of[b->material * pairs->num + a->material] = -1; // told once
}

/// The first body of each material stands for all of them, so the work is that of the pairs of materials.
static void check_meetings(scree_scene_reader *reader, material_pairs *pairs, const scree_rules_scene *scene)
{
    meeting_body *groups = scree_yaml_allocate(&reader->tree, ((size_t)pairs->num + 1) * sizeof *groups);
    meeting_body *walls = scree_yaml_allocate(&reader->tree, ((size_t)pairs->num + 1) * sizeof *walls);
    if (groups == NULL || walls == NULL)
    {
        reader->is_exhausted = true;
        return;
    }
    for (int64_t m = 0; m < pairs->num; ++m) groups[m] = walls[m] = (meeting_body){.material = -1};
    for (int64_t g = 0; g < scene->num_groups; ++g)
    {
        const int64_t m = scene->group_material[g];
        if (m < 0) continue;
        const bool is_second = groups[m].material >= 0;
        const bool is_many = is_second || groups[m].is_many || scene->is_group_of_many[g];
        if (!is_second) groups[m] = (meeting_body){m, is_many, "particles", g};
        groups[m].is_many = is_many;
    }
    for (int64_t w = 0; w < scene->num_walls; ++w)
    {
        const int64_t m = scene->wall_material[w];
        if (m >= 0 && walls[m].material < 0) walls[m] = (meeting_body){m, false, "walls", w};
    }
    for (int64_t a = 0; a < pairs->num; ++a)
        for (int64_t b = 0; b < pairs->num && groups[a].material >= 0; ++b)
        {
            if (b > a || (b == a && groups[a].is_many)) require_law(reader, pairs, groups + a, groups + b);
            require_law(reader, pairs, groups + a, walls + b);
        }
}

// --------------------------------------------------------------------------------------------------------- whole scene

static void check_time(scree_scene_reader *reader)
{
    const scree_yaml_node *time = scree_yaml_find(reader->root, "time");
    double end, step;
    if (!scree_rules_number(time, "end", &end) || !scree_rules_number(time, "step", &step)) return;
    if (!isnan(step) && end / step > 1e15)
        scree_scene_fault(reader, scree_rules_place(time, "step"),
                          "time.end of %g s takes %g steps of %g s; at most 1e15 are possible", end, end / step, step);
}

/// Times of output that are left to scree.
static void fill_output(scree_scene_reader *reader)
{
    static const struct
    {
        const char *key;
        double share;
    } intervals[] = {{"series", 1.0 / 200}, {"frames", 1.0 / 50}, {"checkpoint", 1.0 / 10}};
    double end = 0;
    if (!scree_rules_number(scree_yaml_find(reader->root, "time"), "end", &end)) return;
    for (int k = 0; k < 3; ++k)
    {
        scree_yaml_node *node = scree_yaml_find(scree_yaml_find(reader->root, "output"), intervals[k].key);
        if (node == NULL || node->is_refused || !isnan(node->number)) continue;
        char *text = scree_yaml_allocate(&reader->tree, 32);
        if (text == NULL) reader->is_exhausted = true;
        else snprintf(text, 32, "%.17g", end * intervals[k].share);
        node->number_text = text;
    }
}

static void check_repose(scree_scene_reader *reader)
{
    const scree_yaml_node *repose = scree_yaml_find(reader->root, "repose");
    const char *measure = scree_rules_text(repose, "measure");
    double from, to;
    if (measure == NULL || strcmp(measure, "true") != 0 || !scree_rules_number(repose, "from", &from) ||
        !scree_rules_number(repose, "to", &to) || to > from)
        return;
    scree_scene_fault(reader, repose,
                      "repose.measure is true, but the range of x from %g to %g is empty; set from < to", from, to);
}

/// A box with cells, a period from one of two sources, a range of energies.
static void check_fields(scree_scene_reader *reader, scree_rules_names *walls)
{
    const scree_yaml_node *fields = scree_yaml_find(reader->root, "fields");
    const char *measure = scree_rules_text(fields, "measure"), *wall = scree_rules_text(fields, "wall");
    if (measure == NULL || strcmp(measure, "true") != 0) return;
    const scree_yaml_node *region = scree_yaml_find(fields, "region");
    double low[3], high[3], cells[3], period, bins, energy_min, energy_max;
    if (scree_rules_numbers(region, "min", low, 3) && scree_rules_numbers(region, "max", high, 3))
        for (int k = 0; k < 3; ++k)
            if (!(low[k] < high[k]))
                scree_scene_fault(reader, scree_rules_place(fields, "region"),
                                  "region of fields is empty: along %c it goes from %g to %g m; min must be below max",
                                  "xyz"[k], low[k], high[k]);
    if (scree_rules_numbers(fields, "cells", cells, 3))
    {
        const bool is_whole = cells[0] == floor(cells[0]) && cells[1] == floor(cells[1]) && cells[2] == floor(cells[2]);
        if (!is_whole || cells[0] * cells[1] * cells[2] > 1e7)
            scree_scene_fault(reader, scree_rules_place(fields, "cells"),
                              "cells of fields is [%g, %g, %g]; they must be whole numbers, at most 1e7 in all",
                              cells[0], cells[1], cells[2]);
    }
    if (wall != NULL && scree_rules_number(fields, "period", &period) && (wall[0] == '\0') == isnan(period))
        scree_scene_fault(reader, fields,
                          isnan(period) ? "fields has neither period nor wall; give one of them"
                                        : "fields has both period and wall; remove one");
    if (wall != NULL && wall[0] != '\0')
    {
        const int64_t index = scree_rules_resolve(reader, walls, scree_yaml_find(fields, "wall"), "wall of fields");
        const scree_yaml_node *list = scree_yaml_find(reader->root, "walls");
        const char *kind = index >= 0 ? scree_rules_text(scree_yaml_find(list->items[index], "motion"), "kind") : NULL;
        if (kind != NULL && strcmp(kind, "rotate") != 0)
            scree_scene_fault(reader, scree_yaml_find(fields, "wall"),
                              "wall of fields is \"%.255s\", whose motion is %s; name one that rotates, or give period",
                              wall, kind);
    }
    if (scree_rules_number(fields, "energy_bins", &bins) && bins > 0 &&
        scree_rules_number(fields, "energy_min", &energy_min) &&
        scree_rules_number(fields, "energy_max", &energy_max) && !(energy_min < energy_max))
        scree_scene_fault(reader, scree_rules_place(fields, "energy_min"),
                          "energy_min of fields is %g J, energy_max %g J; set energy_min < energy_max", energy_min,
                          energy_max);
}

/// Warns of particles that are so light that the density is a slip of the unit, or a foam.
static void warn_of_densities(scree_scene_reader *reader, const scree_rules_scene *scene)
{
    const scree_yaml_node *materials = scree_yaml_find(reader->root, "materials");
    for (int64_t m = 0; m < scree_rules_num_items(materials); ++m)
    {
        double density = INFINITY;
        bool is_used = false;
        for (int64_t k = 0; k < scene->num_groups; ++k) is_used |= scene->group_material[k] == m;
        if (!is_used || !scree_rules_number(materials->items[m], "density", &density) || density >= LIGHT) continue;
        scree_scene_warn(reader, scree_yaml_find(materials->items[m], "density"),
                         "density of materials.%lld is %g kg/m^3, that of a foam; 1 g/cm^3 is 1000 kg/m^3",
                         (long long)m, density);
    }
}

void scree_scene_check_rules(scree_scene_reader *reader)
{
    if (reader->root->kind != SCREE_YAML_SECTION || reader->is_exhausted) return;
    scree_rules_names materials = scree_rules_collect(reader, "materials");
    scree_rules_names shapes = scree_rules_collect(reader, "shapes");
    scree_rules_collect(reader, "particles");
    scree_rules_names walls = scree_rules_collect(reader, "walls");
    if (reader->is_exhausted) return;

    material_pairs pairs = {.num = scree_rules_num_items(scree_yaml_find(reader->root, "materials"))};
    pairs.law_of = calloc((size_t)(pairs.num * pairs.num) + 1, sizeof *pairs.law_of);
    if (pairs.law_of == NULL)
    {
        reader->is_exhausted = true;
        return;
    }
    scree_rules_scene scene = {.materials = &materials, .shapes = &shapes};
    check_laws(reader, &materials, &pairs);
    for (int64_t k = 0; k < materials.num; ++k) materials.names[k].is_used = false; // a law alone is no use
    scree_rules_check_shapes(reader, &shapes);
    scree_rules_check_groups(reader, &scene);
    scree_rules_check_walls(reader, &scene);
    if (!reader->is_exhausted && !pairs.is_incomplete) check_meetings(reader, &pairs, &scene);
    free(pairs.law_of);
    check_time(reader);
    fill_output(reader);
    check_repose(reader);
    check_fields(reader, &walls);
    if (reader->num_faults > 0 || reader->is_exhausted) return;
    scree_rules_warn_unused(reader, &materials);
    scree_rules_warn_unused(reader, &shapes);
    warn_of_densities(reader, &scene);
    if (scene.num_groups == 0) scree_scene_warn(reader, NULL, "there are no particles, so nothing will move");
}
