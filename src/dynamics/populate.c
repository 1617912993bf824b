#include "dynamics/populate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/// Sizes of one group, as scales of its shape.
typedef struct drawn_group
{
    double *scale; ///< (num)
    int64_t num;
    double largest_scale;
    int32_t shape, material;
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

/// Lattice of the group's region: cells of the largest bounding diameter times the spacing, numbered from the bottom
/// up.
typedef struct fill_lattice
{
    double lower[3], cell;
    int64_t num[3];
    double slack; ///< half the room around the largest particle in its cell
    scree_axis cylinder;
    double middle[3];        ///< [m] of the region
    double largest_distance; ///< [m] from the cylinder's axis, of the middle of a cell that can be used
} fill_lattice;

static void cell_middle(const fill_lattice *lattice, int64_t k, double middle[3])
{
    const int64_t cell[3] = {k % lattice->num[0], k / lattice->num[0] % lattice->num[1],
                             k / lattice->num[0] / lattice->num[1]};
    for (int d = 0; d < 3; ++d) middle[d] = lattice->lower[d] + ((double)cell[d] + 0.5) * lattice->cell;
}

/// Is direction k across the axis of the cylinder?
static bool is_across(const fill_lattice *lattice, int k)
{
    return lattice->cylinder != SCREE_AXIS_NONE && k != (int)lattice->cylinder - SCREE_AXIS_X;
}

/// Does the particle stay inside the region wherever it is put in cell k?
static bool is_usable_cell(const fill_lattice *lattice, int64_t k)
{
    if (lattice->cylinder == SCREE_AXIS_NONE) return true;
    double middle[3], squared = 0;
    cell_middle(lattice, k, middle);
    for (int d = 0; d < 3; ++d)
        if (is_across(lattice, d)) squared += (middle[d] - lattice->middle[d]) * (middle[d] - lattice->middle[d]);
    return squared <= lattice->largest_distance * lattice->largest_distance;
}

/// Number of cells that can be used, counted no further than `enough`.
static int64_t count_cells(const fill_lattice *lattice, int64_t enough)
{
    const double all = (double)lattice->num[0] * (double)lattice->num[1] * (double)lattice->num[2];
    if (lattice->cylinder == SCREE_AXIS_NONE) return all > (double)enough ? enough : (int64_t)all;
    int64_t num = 0;
    if (lattice->largest_distance < 0) return 0;
    for (int64_t k = 0; (double)k < all && num < enough; ++k) num += is_usable_cell(lattice, k);
    return num;
}

static scree_status make_lattice(const scree_simulation *s, const scree_particle_group_def *def,
                                 const drawn_group *group, fill_lattice *lattice, scree_report *report)
{
    const double diameter = 2 * s->particle_shapes[group->shape].properties.bounding_radius * group->largest_scale;
    lattice->cell = diameter * def->spacing;
    lattice->slack = 0.5 * (lattice->cell - diameter);
    lattice->cylinder = def->region.cylinder;
    double narrowest = INFINITY;
    for (int k = 0; k < 3; ++k)
        if (is_across(lattice, k)) narrowest = fmin(narrowest, def->region.max[k] - def->region.min[k]);
    for (int k = 0; k < 3; ++k)
    {
        double extent = def->region.max[k] - def->region.min[k];
        lattice->lower[k] = def->region.min[k];
        lattice->middle[k] = 0.5 * (def->region.min[k] + def->region.max[k]);
        if (is_across(lattice, k)) extent = narrowest;
        lattice->num[k] = (int64_t)fmin(extent / lattice->cell * (1 + 1e-12), 1e6);
        if (is_across(lattice, k))
            lattice->lower[k] = lattice->middle[k] - 0.5 * (double)lattice->num[k] * lattice->cell;
    }
    // the particle anywhere in its room, which reaches farthest along the diagonal across the axis
    lattice->largest_distance = 0.5 * narrowest - 0.5 * diameter - lattice->slack * sqrt(2.0);
    const int64_t fits = count_cells(lattice, group->num);
    if (fits >= group->num) return SCREE_OK;
    scree_report_add(report,
                     "particles \"%s\": the region holds %lld particles of up to %g m (cells of %g m, %lld x %lld x "
                     "%lld%s), but %lld are asked for; make the region larger, for instance higher",
                     def->name, (long long)fits, diameter, lattice->cell, (long long)lattice->num[0],
                     (long long)lattice->num[1], (long long)lattice->num[2],
                     lattice->cylinder == SCREE_AXIS_NONE ? "" : ", those in the cylinder", (long long)group->num);
    return SCREE_INVALID_INPUT;
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

/// Particle i of a filled group into cell k, jittered by the room that is left, turned at random.
static void place_filled(scree_simulation *s, const scree_particle_group_def *def, const fill_lattice *lattice,
                         int64_t k, uint64_t *state, int64_t i)
{
    scree_particles *p = &s->particles;
    double position[3];
    cell_middle(lattice, k, position);
    for (int d = 0; d < 3; ++d) position[d] += lattice->slack * (2 * random_unit(state) - 1);
    p->position[i] = vec3_from(position);
    p->orientation[i] = random_orientation(state);
    p->velocity[i] = vec3_from(def->velocity);
}

static scree_status place_group(scree_simulation *s, int32_t g, const drawn_group *group, int64_t first,
                                scree_report *report)
{
    const scree_particle_group_def *def = s->scene->particles + g;
    fill_lattice lattice = {0};
    if (def->num_bodies == 0)
    {
        const scree_status status = make_lattice(s, def, group, &lattice, report);
        if (status != SCREE_OK) return status;
    }
    uint64_t state = (uint64_t)def->seed * 2 + 2;
    int64_t cell = 0;
    for (int64_t k = 0; k < group->num; ++k)
    {
        const int64_t i = first + k;
        s->particles.scale[i] = (scree_real)group->scale[k];
        s->particles.shape[i] = group->shape;
        s->particles.material[i] = group->material;
        s->particles.group[i] = g;
        set_inertia(s, i);
        if (def->num_bodies > 0) place_listed(s, def->bodies + k, i);
        else
        {
            while (!is_usable_cell(&lattice, cell)) ++cell;
            place_filled(s, def, &lattice, cell++, &state, i);
        }
    }
    return SCREE_OK;
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
        num += groups[g].num;
        if (status == SCREE_OK && num > INT32_MAX / 2) status = SCREE_TOO_MANY;
        if (status == SCREE_TOO_MANY)
            scree_report_add(report, "particles \"%s\": more than %d particles in all; ask for fewer or larger ones",
                             scene->particles[g].name, INT32_MAX / 2);
    }
    if (status == SCREE_OK) status = scree_particles_create(&simulation->particles, num);

    // every group is tried, so that all regions that are too small are told at once
    int64_t first = 0;
    scree_status placed = SCREE_OK;
    for (uint32_t g = 0; g < scene->num_particles && status == SCREE_OK; ++g)
    {
        const scree_status one = place_group(simulation, (int32_t)g, groups + g, first, report);
        if (one != SCREE_OK) placed = one;
        first += groups[g].num;
    }
    for (uint32_t g = 0; groups != NULL && g < scene->num_particles; ++g) free(groups[g].scale);
    free(groups);
    return status != SCREE_OK ? status : placed;
}
