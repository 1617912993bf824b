/// \file scene_bodies.c
/// Rules of shapes, groups of particles and walls.
#include "io/scene_rules.h"
#include "polyhedra/clump.h"

#include <math.h>
#include <string.h>

/// Warns of keys that are given but not used.
static void warn_unused_key(scree_scene_reader *reader, const scree_yaml_node *section, const char *key, const char *of,
                            const char *why)
{
    if (scree_rules_is_given(section, key))
        scree_scene_warn(reader, scree_yaml_find(section, key), "%s of %s is not used: %s", key, of, why);
}

static void check_orientation(scree_scene_reader *reader, const scree_yaml_node *section, const char *of)
{
    double q[4];
    if (!scree_rules_numbers(section, "orientation", q, 4)) return;
    if (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] >= 1e-12) return;
    scree_scene_fault(
        reader, scree_rules_place(section, "orientation"),
        "orientation of %s is [%g, %g, %g, %g], which is no rotation; [1, 0, 0, 0] leaves a body as it is", of, q[0],
        q[1], q[2], q[3]);
}

// ------------------------------------------------------------------------------------------------------------- shapes

static void check_shape_size(scree_scene_reader *reader, const scree_yaml_node *shape, const char *of, bool is_box)
{
    double size[3];
    if (!scree_rules_numbers(shape, "size", size, 3)) return;
    for (int k = 0; k < (is_box ? 3 : 1); ++k)
        if (size[k] < 1e-12)
            scree_scene_fault(reader, scree_rules_place(shape, "size"), "size.%d of %s is %g; it must be above 0", k,
                              of, size[k]);
}

/// A polygon: three corners, and some area between them and the axis.
static void check_profile(scree_scene_reader *reader, const scree_yaml_node *shape, const char *of)
{
    const scree_yaml_node *profile = scree_yaml_find(shape, "profile");
    if (profile == NULL || profile->is_refused) return;
    const int64_t num = scree_rules_num_items(profile);
    double twice_area = 0;
    for (int64_t k = 0; k < num; ++k)
    {
        const scree_yaml_node *a = profile->items[k], *b = profile->items[(k + 1) % num];
        double r_a, z_a, r_b, z_b;
        if (!scree_rules_number(a, "radius", &r_a) || !scree_rules_number(a, "height", &z_a) ||
            !scree_rules_number(b, "radius", &r_b) || !scree_rules_number(b, "height", &z_b))
            return;
        twice_area += r_a * z_b - r_b * z_a;
    }
    if (num < 3)
        scree_scene_fault(reader, scree_rules_place(shape, "profile"),
                          "profile of %s has %lld corners; a source turned needs 3 or more, each like {radius: 0.1, "
                          "height: 0}",
                          of, (long long)num);
    else if (twice_area == 0)
        scree_scene_fault(reader, profile, "profile of %s has no area; its corners must not lie on one line", of);
}

/// Without triangles, a true sphere: no mesh that could be shifted and repeated.
static void check_sphere(scree_scene_reader *reader, const scree_yaml_node *shape, const char *of)
{
    double triangles, copies;
    if (!scree_rules_number(shape, "triangles", &triangles)) return;
    if (triangles > 0 && triangles < 4)
        scree_scene_fault(reader, scree_rules_place(shape, "triangles"),
                          "triangles of %s is %g; it must be 0 for a true sphere, or from 4 on for a mesh", of,
                          triangles);
    if (triangles > 0) return;
    if (scree_rules_number(shape, "copies", &copies) && copies > 1)
        scree_scene_fault(reader, scree_rules_place(shape, "copies"),
                          "copies of %s is %g, but a true sphere (triangles: 0) cannot be repeated; give it triangles",
                          of, copies);
    warn_unused_key(reader, shape, "offset", of, "a true sphere is centred");
}

/// A clump: its spheres hang together, and it is no mesh that could be shifted and repeated.
static void check_clump(scree_scene_reader *reader, const scree_yaml_node *shape, const char *of, bool is_filled)
{
    scree_clump_sphere spheres[SCREE_CLUMP_MAX_SPHERES];
    const scree_yaml_node *list = scree_yaml_find(shape, "spheres");
    const int64_t num = scree_rules_num_items(list);
    if (is_filled && num > 0)
        scree_scene_fault(reader, list, "spheres of %s are given, but so is fill; remove one of them", of);
    bool is_known = !is_filled && list != NULL && !list->is_refused && num <= SCREE_CLUMP_MAX_SPHERES;
    for (int64_t k = 0; k < num && is_known; ++k)
        is_known = scree_rules_numbers(list->items[k], "position", spheres[k].position, 3) &&
                   scree_rules_number(list->items[k], "radius", &spheres[k].radius);
    if (is_known)
    {
        const scree_clump_fault fault = scree_clump_check(spheres, (int32_t)num);
        char text[256];
        scree_clump_describe_fault(&fault, text, sizeof text);
        const bool has_place = num > 0 && fault.kind != SCREE_CLUMP_TOO_MANY;
        if (fault.kind != SCREE_CLUMP_GOOD)
            scree_scene_fault(reader, has_place ? list->items[fault.first] : scree_rules_place(shape, "spheres"),
                              "spheres of %s %s", of, text);
    }
    double copies;
    if (scree_rules_number(shape, "copies", &copies) && copies > 1)
        scree_scene_fault(reader, scree_rules_place(shape, "copies"),
                          "copies of %s is %g, but a clump cannot be repeated; list all its spheres", of, copies);
    warn_unused_key(reader, shape, "offset", of, "a clump is centred");
    warn_unused_key(reader, shape, "size", of, "the spheres have the lengths");
}

/// The shape that a clump fills: a mesh, by its name. True if there is one.
static bool check_fill(scree_scene_reader *reader, scree_rules_names *shapes, const scree_yaml_node *shape,
                       const char *of)
{
    const scree_yaml_node *fill = scree_yaml_find(shape, "fill");
    const char *name = scree_rules_text(fill, "shape");
    if (name == NULL || name[0] == '\0') return false;
    char label[80];
    snprintf(label, sizeof label, "fill.shape of %s", of);
    const int64_t index = scree_rules_resolve(reader, shapes, scree_yaml_find(fill, "shape"), label);
    if (index < 0) return true;
    const scree_yaml_node *node = scree_yaml_find(reader->root, "shapes")->items[index];
    const char *source = scree_rules_text(node, "source");
    double triangles = 1;
    if (source != NULL && strcmp(source, "sphere") == 0) scree_rules_number(node, "triangles", &triangles);
    if (source == NULL || (strcmp(source, "clump") != 0 && triangles > 0)) return true;
    scree_scene_fault(reader, scree_rules_place(fill, "shape"),
                      "fill.shape of %s is \"%.255s\", which has no mesh to fill; name a shape that has one", of, name);
    return true;
}

static void check_shape(scree_scene_reader *reader, scree_rules_names *shapes, const scree_yaml_node *shape,
                        const char *of)
{
    const char *source = scree_rules_text(shape, "source"), *file = scree_rules_text(shape, "file");
    if (source == NULL) return;
    const bool is_file = strcmp(source, "file") == 0, is_box = strcmp(source, "box") == 0;
    const bool is_rock = strcmp(source, "rock") == 0, is_sphere = strcmp(source, "sphere") == 0;
    if (is_file && file != NULL && file[0] == '\0')
        scree_scene_fault(reader, shape, "file of %s is missing; it must be the path of a mesh", of);
    const bool is_turned = strcmp(source, "turned") == 0, is_clump = strcmp(source, "clump") == 0;
    if (!is_file && !is_turned && !is_clump) check_shape_size(reader, shape, of, is_box);
    if (is_turned) check_profile(reader, shape, of);
    if (is_clump) check_clump(reader, shape, of, check_fill(reader, shapes, shape, of));
    else warn_unused_key(reader, shape, "spheres", of, "the source is not clump");
    if (!is_clump) warn_unused_key(reader, shape, "fill", of, "the source is not clump");

    double triangles;
    const bool has_triangles = scree_rules_number(shape, "triangles", &triangles);
    if (is_rock && has_triangles && triangles < 4)
        scree_scene_fault(reader, scree_rules_place(shape, "triangles"),
                          "triangles of %s is %g; a rock needs a number from 4 on, like 40", of, triangles);
    if (is_sphere) check_sphere(reader, shape, of);
    if (is_file && has_triangles && triangles > 0 && triangles < 4)
        scree_scene_fault(reader, scree_rules_place(shape, "triangles"),
                          "triangles of %s is %g; it must be 0 for the file as it is, or from 4 on", of, triangles);

    if (!is_file) warn_unused_key(reader, shape, "file", of, "the source is not file");
    if (!is_file) warn_unused_key(reader, shape, "scale", of, "the source is not file");
    if (is_file) warn_unused_key(reader, shape, "size", of, "a file brings its own size, which scale changes");
    if (is_turned) warn_unused_key(reader, shape, "size", of, "the profile has the lengths");
    if (!is_turned) warn_unused_key(reader, shape, "profile", of, "the source is not turned");
    if (!is_turned) warn_unused_key(reader, shape, "segments", of, "the source is not turned");
    if (!is_file && !is_rock && !is_sphere)
        warn_unused_key(reader, shape, "triangles", of, "the source fixes the number");
    if (is_sphere && has_triangles && triangles == 0)
    {
        warn_unused_key(reader, shape, "offset", of, "a true sphere is no mesh");
        warn_unused_key(reader, shape, "copies", of, "a true sphere is no mesh");
    }
    if (!is_rock) warn_unused_key(reader, shape, "seed", of, "only rocks are drawn at random");
}

void scree_rules_check_shapes(scree_scene_reader *reader, scree_rules_names *names)
{
    const scree_yaml_node *shapes = scree_yaml_find(reader->root, "shapes");
    for (int64_t k = 0; k < scree_rules_num_items(shapes); ++k)
    {
        char of[40];
        snprintf(of, sizeof of, "shapes.%lld", (long long)k);
        check_shape(reader, names, shapes->items[k], of);
    }
}

// ---------------------------------------------------------------------------------------------------------- particles

/// Tells a size that a distribution needs above zero.
static void require_size(scree_scene_reader *reader, const scree_yaml_node *size, const char *key, const char *of)
{
    double number;
    if (scree_rules_number(size, key, &number) && number < 1e-12)
        scree_scene_fault(reader, scree_rules_place(size, key), "%s of %s is %g m; it must be above 0 for %s", key, of,
                          number, scree_rules_text(size, "distribution"));
}

static void check_size(scree_scene_reader *reader, const scree_yaml_node *group, const char *group_name)
{
    const scree_yaml_node *size = scree_yaml_find(group, "size");
    const char *kind = scree_rules_text(size, "distribution");
    if (kind == NULL) return;
    char of[64], why[64];
    snprintf(of, sizeof of, "%s.size", group_name);
    snprintf(why, sizeof why, "the distribution is %s", kind);
    const bool is_normal = strcmp(kind, "normal") == 0, is_uniform = strcmp(kind, "uniform") == 0;
    const bool has_mean = is_normal || strcmp(kind, "fixed") == 0, has_range = is_normal || is_uniform;
    if (has_mean) require_size(reader, size, "mean", of);
    else warn_unused_key(reader, size, "mean", of, why);
    if (is_normal) require_size(reader, size, "deviation", of);
    else warn_unused_key(reader, size, "deviation", of, why);
    if (!has_range)
    {
        warn_unused_key(reader, size, "min", of, why);
        warn_unused_key(reader, size, "max", of, why);
        return;
    }
    require_size(reader, size, "min", of);
    require_size(reader, size, "max", of);
    double min, max;
    if (scree_rules_number(size, "min", &min) && scree_rules_number(size, "max", &max) && max > 0 && min > max)
        scree_scene_fault(reader, scree_rules_place(size, "min"), "min of %s is %g m, above max of %g m; swap them", of,
                          min, max);
}

/// A group that is filled into its region.
static void check_filled(scree_scene_reader *reader, const scree_yaml_node *group, const char *of)
{
    double count = 0, mass = 0, low[3], high[3];
    const bool has_both = scree_rules_number(group, "count", &count) && scree_rules_number(group, "mass", &mass);
    if (has_both && (count > 0) == (mass > 0))
        scree_scene_fault(reader, group,
                          count > 0 ? "%s has both count and mass; remove one"
                                    : "%s has neither count, mass nor bodies; give one of them, above 0",
                          of);
    const scree_yaml_node *region = scree_yaml_find(group, "region");
    if (!scree_rules_is_given(group, "region"))
    {
        scree_scene_fault(reader, group,
                          "region of %s is missing; particles that are filled in need one, like {min: [0, 0, 0], max: "
                          "[1, 1, 1]}",
                          of);
        return;
    }
    if (!scree_rules_numbers(region, "min", low, 3) || !scree_rules_numbers(region, "max", high, 3)) return;
    for (int k = 0; k < 3; ++k)
        if (!(low[k] < high[k]))
            scree_scene_fault(reader, region,
                              "region of %s is empty: along %c it goes from %g to %g m; min must be below max", of,
                              "xyz"[k], low[k], high[k]);
}

/// A group that is listed.
static void check_listed(scree_scene_reader *reader, const scree_yaml_node *group, const char *of)
{
    static const char *const keys[] = {"count", "mass", "region", "spacing", "velocity"};
    for (int k = 0; k < 5; ++k)
    {
        if (k >= 2) warn_unused_key(reader, group, keys[k], of, "bodies have positions and velocities of their own");
        else if (scree_rules_is_given(group, keys[k]))
            scree_scene_fault(reader, scree_yaml_find(group, keys[k]),
                              "%s of %s is given, but so are bodies; remove one of them", keys[k], of);
    }
    const scree_yaml_node *bodies = scree_yaml_find(group, "bodies");
    for (int64_t k = 0; k < scree_rules_num_items(bodies); ++k)
    {
        char body[80];
        snprintf(body, sizeof body, "%s.bodies.%lld", of, (long long)k);
        check_orientation(reader, bodies->items[k], body);
    }
}

void scree_rules_check_groups(scree_scene_reader *reader, scree_rules_scene *scene)
{
    const scree_yaml_node *groups = scree_yaml_find(reader->root, "particles");
    scene->num_groups = scree_rules_num_items(groups);
    scene->group_material = scree_yaml_allocate(&reader->tree, ((size_t)scene->num_groups + 1) * sizeof(int64_t));
    scene->is_group_of_many = scree_yaml_allocate(&reader->tree, (size_t)scene->num_groups + 1);
    if (scene->group_material == NULL || scene->is_group_of_many == NULL)
    {
        reader->is_exhausted = true;
        return;
    }
    for (int64_t k = 0; k < scene->num_groups; ++k)
    {
        const scree_yaml_node *group = groups->items[k];
        const scree_yaml_node *bodies = scree_yaml_find(group, "bodies");
        char of[48], label[80];
        snprintf(of, sizeof of, "particles.%lld", (long long)k);
        snprintf(label, sizeof label, "shape of %s", of);
        scree_rules_resolve(reader, scene->shapes, scree_yaml_find(group, "shape"), label);
        snprintf(label, sizeof label, "material of %s", of);
        scene->group_material[k] =
            scree_rules_resolve(reader, scene->materials, scree_yaml_find(group, "material"), label);

        double count = 0;
        scree_rules_number(group, "count", &count);
        const int64_t num_bodies = scree_rules_num_items(bodies);
        scene->is_group_of_many[k] = num_bodies != 1 && count != 1;
        check_size(reader, group, of);
        if (num_bodies > 0) check_listed(reader, group, of);
        else if (bodies != NULL && !bodies->is_refused) check_filled(reader, group, of);
    }
}

// -------------------------------------------------------------------------------------------------------------- walls

static void check_motion(scree_scene_reader *reader, const scree_yaml_node *wall, const char *wall_name)
{
    const scree_yaml_node *motion = scree_yaml_find(wall, "motion");
    const char *kind = scree_rules_text(motion, "kind");
    if (kind == NULL) return;
    char of[64], why[64];
    snprintf(of, sizeof of, "%s.motion", wall_name);
    snprintf(why, sizeof why, "the kind of motion is %s", kind);
    const bool is_rotating = strcmp(kind, "rotate") == 0, is_translating = strcmp(kind, "translate") == 0;
    double v[3], rate, start, end;
    if (is_translating && scree_rules_numbers(motion, "velocity", v, 3) && v[0] == 0 && v[1] == 0 && v[2] == 0)
        scree_scene_fault(reader, scree_rules_place(motion, "velocity"),
                          "velocity of %s is zero; give one, or take kind fixed", of);
    if (is_rotating && scree_rules_numbers(motion, "axis", v, 3) && !(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] >= 1e-20))
        scree_scene_fault(reader, scree_rules_place(motion, "axis"),
                          "axis of %s is zero; give its direction, like [0, 1, 0]", of);
    if (is_rotating && scree_rules_number(motion, "angular_velocity", &rate) && rate == 0)
        scree_scene_fault(reader, scree_rules_place(motion, "angular_velocity"),
                          "angular_velocity of %s is zero; give one, or take kind fixed", of);
    if (scree_rules_number(motion, "start", &start) && scree_rules_number(motion, "end", &end) && !(start < end))
        scree_scene_fault(reader, scree_rules_place(motion, "end"), "%s ends at %g s, but starts at %g s", of, end,
                          start);

    if (!is_translating) warn_unused_key(reader, motion, "velocity", of, why);
    static const char *const of_rotation[] = {"axis", "centre", "angular_velocity"};
    for (int k = 0; !is_rotating && k < 3; ++k) warn_unused_key(reader, motion, of_rotation[k], of, why);
}

/// A true sphere or a clump cannot be a wall: walls are meshes.
static void check_wall_shape(scree_scene_reader *reader, const scree_yaml_node *wall, int64_t shape, const char *of)
{
    if (shape < 0) return;
    const scree_yaml_node *node = scree_yaml_find(reader->root, "shapes")->items[shape];
    const char *source = scree_rules_text(node, "source"), *name = scree_rules_text(node, "name");
    double triangles;
    if (source != NULL && strcmp(source, "clump") == 0)
        scree_scene_fault(
            reader, scree_rules_place(wall, "shape"),
            "shape of %s is \"%.255s\", a clump, but walls are meshes; give it a shape of its own, a box or "
            "a file for instance",
            of, name);
    if (source == NULL || strcmp(source, "sphere") != 0 || !scree_rules_number(node, "triangles", &triangles) ||
        triangles > 0)
        return;
    scree_scene_fault(
        reader, scree_rules_place(wall, "shape"),
        "shape of %s is \"%.255s\", a true sphere (triangles: 0), but walls are meshes; give it a shape of "
        "its own, for instance source: sphere with triangles: 1280",
        of, name);
}

void scree_rules_check_walls(scree_scene_reader *reader, scree_rules_scene *scene)
{
    const scree_yaml_node *walls = scree_yaml_find(reader->root, "walls");
    scene->num_walls = scree_rules_num_items(walls);
    scene->wall_material = scree_yaml_allocate(&reader->tree, ((size_t)scene->num_walls + 1) * sizeof(int64_t));
    if (scene->wall_material == NULL)
    {
        reader->is_exhausted = true;
        return;
    }
    for (int64_t k = 0; k < scene->num_walls; ++k)
    {
        const scree_yaml_node *wall = walls->items[k];
        char of[48], label[80];
        snprintf(of, sizeof of, "walls.%lld", (long long)k);
        snprintf(label, sizeof label, "shape of %s", of);
        const int64_t shape = scree_rules_resolve(reader, scene->shapes, scree_yaml_find(wall, "shape"), label);
        check_wall_shape(reader, wall, shape, of);
        snprintf(label, sizeof label, "material of %s", of);
        scene->wall_material[k] =
            scree_rules_resolve(reader, scene->materials, scree_yaml_find(wall, "material"), label);
        check_orientation(reader, wall, of);
        check_motion(reader, wall, of);
    }
}
