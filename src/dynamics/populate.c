/// \file populate.c
/// Particles placed one by one, or filled in: one to a cell of a lattice, jittered and turned at random, so that none
/// touch however they are turned. Groups with the same region share its lattice and are dealt to its cells at random.
#include "dynamics/populate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Particles along the edge of a cell at the most.
#define MAX_SPLIT 1000

/// Groups of a region that are named in a message; the others are counted.
#define MAX_NAMED 5

/// splitmix64 (Steele, Lea & Flood 2014): small, seedable, the same everywhere.
static uint64_t random_bits(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/// In [0, 1).
static double random_unit(uint64_t *state) { return (double)(random_bits(state) >> 11) * 0x1p-53; }

/// Uniform rotation: four numbers uniform in the ball, made a unit quaternion (Marsaglia 1972 by rejection).
static scree_quat random_orientation(uint64_t *state)
{
    for (;;)
    {
        double q[4], squared = 0;
        for (int k = 0; k < 4; ++k)
        {
            q[k] = 2 * random_unit(state) - 1;
            squared += q[k] * q[k];
        }
        if (squared > 1 || squared < 0.01) continue;
        return scree_quat_normalize(
            scree_quat_make((scree_real)q[0], (scree_real)q[1], (scree_real)q[2], (scree_real)q[3]));
    }
}

/// One size [m], or NAN for the shape's own. The truncated normal is drawn by rejection from the uniform: the numbers
/// themselves then do not depend on the mathematics library.
static double draw_size(const scree_size_def *size, uint64_t *state)
{
    switch (size->distribution)
    {
    case SCREE_SIZE_AS_SHAPE:
        return NAN;
    case SCREE_SIZE_FIXED:
        return size->mean;
    case SCREE_SIZE_UNIFORM:
        return size->min + (size->max - size->min) * random_unit(state);
    case SCREE_SIZE_NORMAL:
        break;
    }
    // the mode of the truncated density, so that the acceptance stays high wherever the mean lies
    const double mode = fmin(fmax(size->mean, size->min), size->max);
    const double z_mode = (mode - size->mean) / size->deviation;
    for (;;)
    {
        const double x = size->min + (size->max - size->min) * random_unit(state);
        const double z = (x - size->mean) / size->deviation;
        if (random_unit(state) < exp(0.5 * (z_mode * z_mode - z * z))) return x;
    }
}

/// Sizes of one group, as scales of its shape, and how it is filled in.
typedef struct drawn_group
{
    double *scale; ///< (num)
    int64_t num;
    double largest_scale;
    int32_t shape, material;
    int64_t first;     ///< of its particles, which follow each other
    int64_t num_done;  ///< of them have their place
    double diameter;   ///< [m] of the sphere around the largest one
    int64_t max_split; ///< how many times the room of the largest one fits along the edge of a cell
} drawn_group;

static int32_t find_shape(const scree_scene *scene, const char *name)
{
    for (uint32_t k = 0; k < scene->num_shapes; ++k)
        if (strcmp(scene->shapes[k].name, name) == 0) return (int32_t)k;
    return -1;
}

static int32_t find_material(const scree_scene *scene, const char *name)
{
    for (uint32_t k = 0; k < scene->num_materials; ++k)
        if (strcmp(scene->materials[k].name, name) == 0) return (int32_t)k;
    return -1;
}

/// Draws sizes until the count or the mass of the group is reached; bodies placed by hand bring their own.
static scree_status draw_group(const scree_simulation *s, const scree_particle_group_def *def, drawn_group *group)
{
    group->shape = find_shape(s->scene, def->shape);
    group->material = find_material(s->scene, def->material);
    const scree_shape *shape = s->particle_shapes + group->shape;
    const double density = s->scene->materials[group->material].density;
    uint64_t state = (uint64_t)def->seed * 2 + 1;
    double mass = 0;
    int64_t max = 0;
    const bool is_listed = def->num_bodies > 0;
    for (;;)
    {
        if (is_listed ? group->num == (int64_t)def->num_bodies
                      : (def->count > 0 ? group->num == def->count : mass >= def->mass))
            return SCREE_OK;
        if (group->num == max)
        {
            max = max * 2 + 64;
            double *grown = realloc(group->scale, (size_t)max * sizeof *grown);
            if (grown == NULL) return SCREE_OUT_OF_MEMORY;
            group->scale = grown;
        }
        const double size = is_listed && !isnan(def->bodies[group->num].size) ? def->bodies[group->num].size
                                                                              : draw_size(&def->size, &state);
        const double scale = isnan(size) ? 1 : size / shape->middle_size;
        mass += density * shape->properties.volume * scale * scale * scale;
        group->largest_scale = fmax(group->largest_scale, scale);
        group->scale[group->num++] = scale;
        if (group->num > INT32_MAX / 2) return SCREE_TOO_MANY;
    }
}

/// Groups with the same region, which are filled into it together. Each cell of the lattice holds the largest particle
/// of all, and is numbered from the bottom up.
typedef struct region_fill
{
    drawn_group *groups;    ///< of the scene
    const int32_t *members; ///< (num_members) which of them
    int32_t num_members;
    int64_t num_particles, max_split; ///< of all members; of a cell along its edge
    double lower[3], cell;
    int64_t num[3];
    scree_axis cylinder;
    double middle[3];        ///< [m] of the region
    double largest_distance; ///< [m] from the cylinder's axis, of the middle of a cell that can be used
} region_fill;

/// Parts of a cell, along its edge, when it is given to this group.
static int64_t split_of(const region_fill *fill, const drawn_group *group)
{
    return group->max_split < fill->max_split ? group->max_split : fill->max_split;
}

/// Middle of part k of a cell that is split along its edge.
static void part_middle(const region_fill *fill, int64_t cell, int64_t split, int64_t k, double middle[3])
{
    const int64_t cells[3] = {cell % fill->num[0], cell / fill->num[0] % fill->num[1],
                              cell / fill->num[0] / fill->num[1]};
    const int64_t parts[3] = {k % split, k / split % split, k / split / split};
    for (int d = 0; d < 3; ++d)
        middle[d] = fill->lower[d] + ((double)(cells[d] * split + parts[d]) + 0.5) * (fill->cell / (double)split);
}

/// Is direction k across the axis of the cylinder?
static bool is_across(const region_fill *fill, int k)
{
    return fill->cylinder != SCREE_AXIS_NONE && k != (int)fill->cylinder - SCREE_AXIS_X;
}

/// Does a particle stay inside the region wherever it is put in the cell?
static bool is_usable_cell(const region_fill *fill, int64_t cell)
{
    if (fill->cylinder == SCREE_AXIS_NONE) return true;
    double middle[3], squared = 0;
    part_middle(fill, cell, 1, 0, middle);
    for (int d = 0; d < 3; ++d)
        if (is_across(fill, d)) squared += (middle[d] - fill->middle[d]) * (middle[d] - fill->middle[d]);
    return squared <= fill->largest_distance * fill->largest_distance;
}

/// Number of cells that can be used, counted no further than `enough`.
static int64_t count_cells(const region_fill *fill, int64_t enough)
{
    const double all = (double)fill->num[0] * (double)fill->num[1] * (double)fill->num[2];
    if (fill->cylinder == SCREE_AXIS_NONE) return all > (double)enough ? enough : (int64_t)all;
    int64_t num = 0;
    if (fill->largest_distance < 0) return 0;
    for (int64_t k = 0; (double)k < all && num < enough; ++k) num += is_usable_cell(fill, k);
    return num;
}

/// Cells that the group fills, the last one perhaps in part.
static int64_t num_cells_of(const region_fill *fill, const drawn_group *group)
{
    const int64_t split = split_of(fill, group), in_one = split * split * split;
    return (group->num + in_one - 1) / in_one;
}

static int64_t num_cells_needed(const region_fill *fill)
{
    int64_t num = 0;
    for (int32_t m = 0; m < fill->num_members; ++m) num += num_cells_of(fill, fill->groups + fill->members[m]);
    return num;
}

/// The lattice over the region, with cells as wide as the widest room that a member needs.
static void make_lattice(const scree_scene *scene, region_fill *fill)
{
    const scree_region_def *region = &scene->particles[fill->members[0]].region;
    double narrowest = INFINITY;
    fill->cylinder = region->cylinder;
    for (int32_t m = 0; m < fill->num_members; ++m)
        fill->cell =
            fmax(fill->cell, fill->groups[fill->members[m]].diameter * scene->particles[fill->members[m]].spacing);
    for (int k = 0; k < 3; ++k)
        if (is_across(fill, k)) narrowest = fmin(narrowest, region->max[k] - region->min[k]);
    for (int k = 0; k < 3; ++k)
    {
        double extent = region->max[k] - region->min[k];
        fill->lower[k] = region->min[k];
        fill->middle[k] = 0.5 * (region->min[k] + region->max[k]);
        if (is_across(fill, k)) extent = narrowest;
        fill->num[k] = (int64_t)fmin(extent / fill->cell * (1 + 1e-12), 1e6);
        if (is_across(fill, k)) fill->lower[k] = fill->middle[k] - 0.5 * (double)fill->num[k] * fill->cell;
    }
    // a particle anywhere in its cell, split or not: it reaches farthest along the diagonal across the axis
    fill->largest_distance = INFINITY;
    for (int32_t m = 0; m < fill->num_members; ++m)
    {
        drawn_group *group = fill->groups + fill->members[m];
        const double room = group->diameter * scene->particles[fill->members[m]].spacing;
        const double slack = 0.5 * (fill->cell - group->diameter);
        fill->largest_distance =
            fmin(fill->largest_distance, 0.5 * narrowest - 0.5 * group->diameter - slack * sqrt(2.0));
        group->max_split = (int64_t)fmin(fill->cell / room * (1 + 1e-12), MAX_SPLIT);
        fill->num_particles += group->num;
    }
}

/// Says that the region is too small.
static void tell_too_small(const scree_scene *scene, const region_fill *fill, int64_t num_cells, scree_report *report)
{
    char cells[128], names[6 * 64] = "";
    const bool is_narrow = fill->num[0] * fill->num[1] * fill->num[2] == 0;
    const char *remedy = is_narrow ? "it is narrower than a cell: make it wider, or the particles smaller; all lengths "
                                     "are in metres"
                                   : "make the region larger, for instance higher";
    snprintf(cells, sizeof cells, "cells of %g m, %lld x %lld x %lld%s", fill->cell, (long long)fill->num[0],
             (long long)fill->num[1], (long long)fill->num[2],
             fill->cylinder == SCREE_AXIS_NONE ? "" : ", those in the cylinder");
    if (fill->num_members == 1)
    {
        const drawn_group *group = fill->groups + fill->members[0];
        scree_report_add(
            report,
            "particles \"%s\": the region holds %lld particles of up to %g m (%s), but %lld are asked for; "
            "%s",
            scene->particles[fill->members[0]].name, (long long)num_cells, group->diameter, cells,
            (long long)group->num, remedy);
        return;
    }
    for (int32_t m = 0; m < fill->num_members && m < MAX_NAMED; ++m)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s\"%.50s\"",
                 m == 0                       ? ""
                 : m == fill->num_members - 1 ? " and "
                                              : ", ",
                 scene->particles[fill->members[m]].name);
    if (fill->num_members > MAX_NAMED)
        snprintf(names + strlen(names), sizeof names - strlen(names), " and %d more", fill->num_members - MAX_NAMED);
    const double share = (double)num_cells / (double)num_cells_needed(fill);
    scree_report_add(report,
                     "particles %s are filled into one region together, which holds about %lld of the %lld that are "
                     "asked for (%s); %s",
                     names, (long long)(share * (double)fill->num_particles), (long long)fill->num_particles, cells,
                     remedy);
}

/// Mass and moments of particle i from shape, scale and density.
static void set_inertia(scree_simulation *s, int64_t i)
{
    scree_particles *p = &s->particles;
    const scree_mass_properties *properties = &s->particle_shapes[p->shape[i]].properties;
    const double density = s->scene->materials[p->material[i]].density, scale = (double)p->scale[i];
    const double cube = density * scale * scale * scale;
    p->mass[i] = (scree_real)(cube * properties->volume);
    p->inertia[i] = scree_vec3_make((scree_real)(cube * scale * scale * properties->inertia[0][0]),
                                    (scree_real)(cube * scale * scale * properties->inertia[1][1]),
                                    (scree_real)(cube * scale * scale * properties->inertia[2][2]));
}

static scree_vec3 vec3_from(const double v[3])
{
    return scree_vec3_make((scree_real)v[0], (scree_real)v[1], (scree_real)v[2]);
}

/// Particle i as its body definition says.
static void place_listed(scree_simulation *s, const scree_body_def *body, int64_t i)
{
    scree_particles *p = &s->particles;
    const double *frame = s->particle_shapes[p->shape[i]].frame_orientation;
    const scree_quat given = scree_quat_make((scree_real)body->orientation[0], (scree_real)body->orientation[1],
                                             (scree_real)body->orientation[2], (scree_real)body->orientation[3]);
    const scree_quat to_source =
        scree_quat_make((scree_real)frame[0], (scree_real)frame[1], (scree_real)frame[2], (scree_real)frame[3]);
    p->position[i] = vec3_from(body->position);
    p->orientation[i] = scree_quat_normalize(scree_quat_multiply(scree_quat_normalize(given), to_source));
    p->velocity[i] = vec3_from(body->velocity);

    // L = R I R^T w
    const scree_mat3 rotation = scree_mat3_from_quat(p->orientation[i]);
    const scree_vec3 w = scree_mat3_apply_transposed(rotation, vec3_from(body->angular_velocity));
    const scree_vec3 inertia = p->inertia[i];
    p->angular_momentum[i] =
        scree_mat3_apply(rotation, scree_vec3_make(inertia.x * w.x, inertia.y * w.y, inertia.z * w.z));
}

/// Puts the next particle of group g to `middle`, jittered by the room that is left, turned at random.
static void place_filled(scree_simulation *s, drawn_group *group, int32_t g, const double middle[3], double slack,
                         uint64_t *state)
{
    scree_particles *p = &s->particles;
    const int64_t i = group->first + group->num_done++;
    double position[3];
    for (int d = 0; d < 3; ++d) position[d] = middle[d] + slack * (2 * random_unit(state) - 1);
    p->position[i] = vec3_from(position);
    p->orientation[i] = random_orientation(state);
    p->velocity[i] = vec3_from(s->scene->particles[g].velocity);
}

/// Which member gets which of the cells: (num_cells_needed). Every order is as likely (Fisher & Yates; Durstenfeld
/// 1964). NULL: out of memory.
static int32_t *deal_cells(const region_fill *fill, uint64_t *state)
{
    int64_t num = num_cells_needed(fill), k = 0;
    int32_t *dealt = malloc((size_t)(num + 1) * sizeof *dealt);
    if (dealt == NULL) return NULL;
    for (int32_t m = 0; m < fill->num_members; ++m)
        for (int64_t n = num_cells_of(fill, fill->groups + fill->members[m]); n > 0; --n) dealt[k++] = fill->members[m];
    for (; fill->num_members > 1 && num > 1; --num)
    {
        const int64_t other = (int64_t)(random_bits(state) % (uint64_t)num);
        const int32_t moved = dealt[num - 1];
        dealt[num - 1] = dealt[other];
        dealt[other] = moved;
    }
    return dealt;
}

/// Fills the members into their region. Cells are split for small particles no further than all need to fit: whole
/// ones mix better.
static scree_status fill_region(scree_simulation *s, region_fill *fill, scree_report *report)
{
    make_lattice(s->scene, fill);
    const int64_t num_cells = count_cells(fill, fill->num_particles);
    fill->max_split = 1;
    while (num_cells_needed(fill) > num_cells && fill->max_split < MAX_SPLIT) ++fill->max_split;
    if (num_cells_needed(fill) > num_cells)
    {
        tell_too_small(s->scene, fill, num_cells, report);
        return SCREE_INVALID_INPUT;
    }

    uint64_t state = (uint64_t)s->scene->particles[fill->members[0]].seed * 2 + 2;
    for (int32_t m = 1; m < fill->num_members; ++m)
        state = random_bits(&state) ^ ((uint64_t)s->scene->particles[fill->members[m]].seed * 2 + 2);
    int32_t *dealt = deal_cells(fill, &state);
    if (dealt == NULL) return SCREE_OUT_OF_MEMORY;
    const int64_t num_dealt = num_cells_needed(fill);
    int64_t cell = 0;
    for (int64_t n = 0; n < num_dealt; ++n, ++cell)
    {
        while (!is_usable_cell(fill, cell)) ++cell;
        drawn_group *group = fill->groups + dealt[n];
        const int64_t split = split_of(fill, group);
        const double slack = 0.5 * (fill->cell / (double)split - group->diameter);
        for (int64_t k = 0; k < split * split * split && group->num_done < group->num; ++k)
        {
            double middle[3];
            part_middle(fill, cell, split, k, middle);
            place_filled(s, group, dealt[n], middle, slack, &state);
        }
    }
    free(dealt);
    return SCREE_OK;
}

/// What all particles of a group have, wherever they are.
static void set_group(scree_simulation *s, int32_t g, const drawn_group *group)
{
    for (int64_t k = 0; k < group->num; ++k)
    {
        const int64_t i = group->first + k;
        s->particles.scale[i] = (scree_real)group->scale[k];
        s->particles.shape[i] = group->shape;
        s->particles.material[i] = group->material;
        s->particles.group[i] = g;
        set_inertia(s, i);
    }
}

static bool have_same_region(const scree_region_def *a, const scree_region_def *b)
{
    for (int k = 0; k < 3; ++k)
        if (a->min[k] != b->min[k] || a->max[k] != b->max[k]) return false;
    return a->cylinder == b->cylinder;
}

/// Group g and those after it with the same region, to members; none if one before it has that region.
static int32_t find_members(const scree_scene *scene, uint32_t g, int32_t *members)
{
    int32_t num = 0;
    for (uint32_t k = 0; k < scene->num_particles; ++k)
    {
        const scree_particle_group_def *def = scene->particles + k;
        if (def->num_bodies > 0 || !have_same_region(&def->region, &scene->particles[g].region)) continue;
        if (k < g) return 0;
        members[num++] = (int32_t)k;
    }
    return num;
}

/// Every region is tried, so that all that are too small are told at once. SCREE_INVALID_INPUT, SCREE_OUT_OF_MEMORY.
static scree_status place_groups(scree_simulation *s, drawn_group *groups, scree_report *report)
{
    const scree_scene *scene = s->scene;
    int32_t *members = malloc((scene->num_particles + 1) * sizeof *members);
    scree_status status = members == NULL ? SCREE_OUT_OF_MEMORY : SCREE_OK;
    for (uint32_t g = 0; g < scene->num_particles && status != SCREE_OUT_OF_MEMORY; ++g)
    {
        const scree_particle_group_def *def = scene->particles + g;
        set_group(s, (int32_t)g, groups + g);
        for (uint32_t k = 0; k < def->num_bodies; ++k) place_listed(s, def->bodies + k, groups[g].first + k);
        region_fill fill = {.groups = groups, .members = members};
        if (def->num_bodies == 0) fill.num_members = find_members(scene, g, members);
        const scree_status filled = fill.num_members > 0 ? fill_region(s, &fill, report) : SCREE_OK;
        if (filled != SCREE_OK) status = filled;
    }
    free(members);
    return status;
}

scree_status scree_populate(scree_simulation *simulation, scree_report *report)
{
    const scree_scene *scene = simulation->scene;
    drawn_group *groups = calloc(scene->num_particles + 1, sizeof *groups);
    scree_status status = groups == NULL ? SCREE_OUT_OF_MEMORY : SCREE_OK;
    int64_t num = 0;
    for (uint32_t g = 0; g < scene->num_particles && status == SCREE_OK; ++g)
    {
        status = draw_group(simulation, scene->particles + g, groups + g);
        groups[g].first = num;
        groups[g].diameter =
            2 * simulation->particle_shapes[groups[g].shape].properties.bounding_radius * groups[g].largest_scale;
        num += groups[g].num;
        if (status == SCREE_OK && num > INT32_MAX / 2) status = SCREE_TOO_MANY;
        if (status == SCREE_TOO_MANY)
            scree_report_add(report, "particles \"%s\": more than %d particles in all; ask for fewer or larger ones",
                             scene->particles[g].name, INT32_MAX / 2);
    }
    if (status == SCREE_OK) status = scree_particles_create(&simulation->particles, num);
    if (status == SCREE_OK) status = place_groups(simulation, groups, report);
    for (uint32_t g = 0; groups != NULL && g < scene->num_particles; ++g) free(groups[g].scale);
    free(groups);
    return status;
}
