/// \file frames_vtkhdf.c
/// Pictures of the state for ParaView and VTK: surfaces of the polyhedra (frames.vtkhdf) and of the walls
/// (walls.vtkhdf), true spheres and those of clumps as points with a radius (spheres.vtkhdf), contacts as lines from
/// centre to centre through the contact point (contacts.vtkhdf). There is no file of what a scene has none of.
///
/// Particles keep their connectivity, so it is written once and each frame adds points alone. Walls are written anew
/// only in frames where one of them has moved or gone.
#define _POSIX_C_SOURCE 200809L
#include "io/run_folder.h"
#include "io/vtkhdf_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Points, or ids, that are gathered before they are written.
#define BLOCK_ITEMS ((int64_t)1 << 18)

/// Columns of the arrays, in the order of the definitions below.
enum
{
    PARTICLE_ID = SCREE_VTKHDF_ARRAYS,
    PARTICLE_GROUP,
    PARTICLE_SPEED,
    SPHERE_ID = SCREE_VTKHDF_ARRAYS,
    SPHERE_GROUP,
    SPHERE_RADIUS,
    SPHERE_SPEED,
    SPHERE_VELOCITY,
    WALL_ID = SCREE_VTKHDF_ARRAYS,
    CONTACT_I = SCREE_VTKHDF_ARRAYS,
    CONTACT_J,
    CONTACT_NORMAL_FORCE,
    CONTACT_TANGENTIAL_FORCE,
    CONTACT_INDENTATION,
    CONTACT_VOLUME,
    CONTACT_SLIPPING
};

struct scree_frames
{
    scree_vtkhdf_file *particles, *spheres, *walls, *contacts; ///< NULL if there are none, contacts apart
    int64_t *first_vertex;                                     ///< (num_particles + 1)
    int64_t num_spheres;
    int32_t *sphere_ids;             ///< (num_spheres) ids of the particles that are, or have, spheres
    int32_t *sphere_parts;           ///< (num_spheres) which sphere of the particle
    scree_vtkhdf_step particle_step; ///< that all frames share, but for time and points
    scree_vtkhdf_step sphere_step;   ///< likewise
    scree_vtkhdf_step wall_step;     ///< of the walls as they were last written
    scree_wall_state *written_walls; ///< (num_walls) as they were then
    bool has_written_walls;
    void *block; ///< (BLOCK_ITEMS, or what one body needs) of 3 floats
};

static const scree_shape_view *particle_shape(const scree_simulation *simulation, int64_t i)
{
    return simulation->shape_views + simulation->particles.shape[i];
}

static const scree_shape_view *wall_shape(const scree_simulation *simulation, int32_t w)
{
    return simulation->shape_views + simulation->num_shapes + simulation->walls[w].shape;
}

/// Points of a body in world axes.
static void place_points(const scree_shape_view *shape, scree_pose pose, float *points)
{
    const scree_mat3 rotation = scree_mat3_from_quat(pose.orientation);
    for (int32_t v = 0; v < shape->num_vertices; ++v)
    {
        const scree_vec3 x =
            scree_vec3_add(pose.position, scree_mat3_apply(rotation, scree_vec3_scale(shape->vertices[v], pose.scale)));
        points[3 * v + 0] = (float)x.x;
        points[3 * v + 1] = (float)x.y;
        points[3 * v + 2] = (float)x.z;
    }
}

/// Point ids of a body whose first point is `first`.
static void number_triangles(const scree_shape_view *shape, int64_t first, int32_t *ids)
{
    for (int32_t t = 0; t < shape->num_triangles; ++t)
        for (int k = 0; k < 3; ++k) ids[3 * t + k] = (int32_t)(first + shape->triangles[t].v[k]);
}

static scree_pose particle_pose(const scree_particles *particles, int64_t i)
{
    const scree_pose pose = {particles->position[i], particles->orientation[i], particles->scale[i]};
    return pose;
}

// ---- particles

/// The particles first .. last - 1 that follow `first` and whose `size`s together fit the block; one at least.
static int64_t end_of_block(const scree_simulation *simulation, int64_t first, bool by_triangles)
{
    int64_t num = 0, i = first;
    for (; i < simulation->particles.num_particles; ++i)
    {
        const scree_shape_view *shape = particle_shape(simulation, i);
        num += by_triangles ? shape->num_triangles : shape->num_vertices;
        if (num > BLOCK_ITEMS && i > first) break;
    }
    return i;
}

/// Connectivity and offsets of all triangles behind the rows in use; returns the number of triangles in *num_triangles.
static scree_status write_triangles(scree_frames *frames, const scree_simulation *simulation, int64_t *num_triangles,
                                    scree_report *report)
{
    scree_vtkhdf_file *file = frames->particles;
    const int64_t id_row = scree_vtkhdf_num_rows(file, SCREE_VTKHDF_IDS);
    const int64_t offset_row =
        scree_vtkhdf_num_rows(file, SCREE_VTKHDF_CELLS) + scree_vtkhdf_num_rows(file, SCREE_VTKHDF_PARTS);
    int32_t *block = frames->block;
    scree_status status = SCREE_OK;
    int64_t done = 0;
    for (int64_t first = 0, last; first < simulation->particles.num_particles && status == SCREE_OK; first = last)
    {
        last = end_of_block(simulation, first, true);
        int64_t num = 0;
        for (int64_t i = first; i < last; ++i)
        {
            const scree_shape_view *shape = particle_shape(simulation, i);
            number_triangles(shape, frames->first_vertex[i], block + 3 * num);
            num += shape->num_triangles;
        }
        status = scree_vtkhdf_write(file, SCREE_VTKHDF_CONNECTIVITY, (scree_vtkhdf_rows){id_row + 3 * done, 3 * num},
                                    block, report);
        for (int64_t t = 0; t <= num; ++t) block[t] = (int32_t)(3 * (done + t));
        if (status == SCREE_OK)
            status = scree_vtkhdf_write(file, SCREE_VTKHDF_OFFSETS, (scree_vtkhdf_rows){offset_row + done, num + 1},
                                        block, report);
        done += num;
    }
    *num_triangles = done;
    return status;
}

/// Point data that never changes: id or group of the particle.
static scree_status write_labels(scree_frames *frames, const scree_simulation *simulation, int column,
                                 scree_report *report)
{
    int32_t *block = frames->block;
    scree_status status = SCREE_OK;
    for (int64_t first = 0, last; first < simulation->particles.num_particles && status == SCREE_OK; first = last)
    {
        last = end_of_block(simulation, first, false);
        const int64_t row = frames->first_vertex[first], num = frames->first_vertex[last] - row;
        for (int64_t i = first; i < last; ++i)
            for (int64_t v = frames->first_vertex[i]; v < frames->first_vertex[i + 1]; ++v)
                block[v - row] = column == PARTICLE_ID ? (int32_t)i : simulation->particles.group[i];
        status = scree_vtkhdf_write(frames->particles, column, (scree_vtkhdf_rows){row, num}, block, report);
    }
    return status;
}

/// All that frames share, once.
static scree_status write_topology(scree_frames *frames, const scree_simulation *simulation, scree_report *report)
{
    int64_t num_triangles = 0;
    scree_status status = write_triangles(frames, simulation, &num_triangles, report);
    if (status == SCREE_OK) status = write_labels(frames, simulation, PARTICLE_ID, report);
    if (status == SCREE_OK) status = write_labels(frames, simulation, PARTICLE_GROUP, report);
    if (status != SCREE_OK) return status;
    int64_t num[SCREE_VTKHDF_NUM_EXTENTS] = {0};
    num[SCREE_VTKHDF_POINTS] = frames->first_vertex[simulation->particles.num_particles];
    num[SCREE_VTKHDF_CELLS] = num_triangles;
    num[SCREE_VTKHDF_IDS] = 3 * num_triangles;
    return scree_vtkhdf_add_part(frames->particles, num, &frames->particle_step, report);
}

static scree_status write_particles(scree_frames *frames, const scree_simulation *simulation, scree_report *report)
{
    scree_vtkhdf_file *file = frames->particles;
    const scree_particles *particles = &simulation->particles;
    const int64_t *first_vertex = frames->first_vertex;
    scree_vtkhdf_step *step = &frames->particle_step;
    scree_status status = SCREE_OK;
    if (scree_vtkhdf_num_rows(file, SCREE_VTKHDF_POINTS) == 0) status = write_topology(frames, simulation, report);
    const bool is_first = scree_vtkhdf_num_steps(file) == 0;
    step->time = scree_simulation_time(simulation);
    step->point_offset = is_first ? 0 : scree_vtkhdf_num_rows(file, SCREE_VTKHDF_POINTS);

    float *block = frames->block;
    for (int64_t first = 0, last; first < particles->num_particles && status == SCREE_OK; first = last)
    {
        last = end_of_block(simulation, first, false);
        const int64_t row = first_vertex[first], num = first_vertex[last] - row;
#pragma omp parallel for schedule(static) if (num >= 16384)
        for (int64_t i = first; i < last; ++i)
            place_points(particle_shape(simulation, i), particle_pose(particles, i),
                         block + 3 * (first_vertex[i] - row));
        status = scree_vtkhdf_write(file, SCREE_VTKHDF_POINT_COORDINATES,
                                    (scree_vtkhdf_rows){step->point_offset + row, num}, block, report);
        for (int64_t i = first; i < last; ++i)
            for (int64_t v = first_vertex[i]; v < first_vertex[i + 1]; ++v)
                block[v - row] = (float)scree_vec3_length(particles->velocity[i]);
        if (status == SCREE_OK)
            status = scree_vtkhdf_write(file, PARTICLE_SPEED, (scree_vtkhdf_rows){step->point_offset + row, num}, block,
                                        report);
    }
    if (status == SCREE_OK) status = scree_vtkhdf_add_step(file, step, report);
    if (status == SCREE_OK && !is_first) scree_vtkhdf_add_points(file, first_vertex[particles->num_particles]);
    return status;
}

// ---- spheres

/// Sphere k of particle i in the world.
static scree_sphere place_sphere(const scree_simulation *simulation, int64_t i, int32_t k)
{
    const scree_particles *particles = &simulation->particles;
    const scree_mat3 rotation = scree_mat3_from_quat(particles->orientation[i]);
    scree_sphere sphere = scree_shape_sphere(particle_shape(simulation, i), k);
    sphere.centre =
        scree_vec3_add_scaled(particles->position[i], scree_mat3_apply(rotation, sphere.centre), particles->scale[i]);
    sphere.radius = sphere.radius * particles->scale[i];
    return sphere;
}

/// One item of a column for the spheres first .. first + num - 1, to the block.
static void fill_sphere_column(const scree_frames *frames, const scree_simulation *simulation, int column,
                               scree_vtkhdf_rows rows)
{
    const scree_particles *particles = &simulation->particles;
    float *numbers = frames->block;
    int32_t *ids = frames->block;
    for (int64_t k = 0; k < rows.num; ++k)
    {
        const int32_t i = frames->sphere_ids[rows.first + k];
        const bool is_point = column == SCREE_VTKHDF_POINT_COORDINATES;
        const scree_sphere sphere = place_sphere(simulation, i, frames->sphere_parts[rows.first + k]);
        const scree_vec3 v = is_point ? sphere.centre : particles->velocity[i];
        if (column == SPHERE_ID) ids[k] = i;
        else if (column == SPHERE_GROUP) ids[k] = particles->group[i];
        else if (column == SCREE_VTKHDF_CONNECTIVITY || column == SCREE_VTKHDF_OFFSETS)
            ids[k] = (int32_t)(rows.first + k);
        else if (column == SPHERE_RADIUS) numbers[k] = (float)sphere.radius;
        else if (column == SPHERE_SPEED) numbers[k] = (float)scree_vec3_length(v);
        else
        {
            numbers[3 * k + 0] = (float)v.x;
            numbers[3 * k + 1] = (float)v.y;
            numbers[3 * k + 2] = (float)v.z;
        }
    }
}

/// A column of all spheres to the rows from `row` on.
static scree_status write_sphere_column(scree_frames *frames, const scree_simulation *simulation, int column,
                                        int64_t row, scree_report *report)
{
    scree_status status = SCREE_OK;
    for (int64_t first = 0; first < frames->num_spheres && status == SCREE_OK; first += BLOCK_ITEMS)
    {
        const int64_t left = frames->num_spheres - first, num = left < BLOCK_ITEMS ? left : BLOCK_ITEMS;
        fill_sphere_column(frames, simulation, column, (scree_vtkhdf_rows){first, num});
        status =
            scree_vtkhdf_write(frames->spheres, column, (scree_vtkhdf_rows){row + first, num}, frames->block, report);
    }
    return status;
}

/// All that frames share, once: each sphere a vertex, ids, groups, radii.
static scree_status write_sphere_topology(scree_frames *frames, const scree_simulation *simulation,
                                          scree_report *report)
{
    scree_vtkhdf_file *file = frames->spheres;
    const int64_t id_row = scree_vtkhdf_num_rows(file, SCREE_VTKHDF_IDS), num_spheres = frames->num_spheres;
    const int64_t offset_row =
        scree_vtkhdf_num_rows(file, SCREE_VTKHDF_CELLS) + scree_vtkhdf_num_rows(file, SCREE_VTKHDF_PARTS);
    const int32_t end = (int32_t)num_spheres;
    scree_status status = write_sphere_column(frames, simulation, SCREE_VTKHDF_CONNECTIVITY, id_row, report);
    if (status == SCREE_OK) status = write_sphere_column(frames, simulation, SCREE_VTKHDF_OFFSETS, offset_row, report);
    if (status == SCREE_OK)
        status = scree_vtkhdf_write(file, SCREE_VTKHDF_OFFSETS, (scree_vtkhdf_rows){offset_row + num_spheres, 1}, &end,
                                    report);
    for (int column = SPHERE_ID; column <= SPHERE_RADIUS && status == SCREE_OK; ++column)
        status = write_sphere_column(frames, simulation, column, 0, report);
    if (status != SCREE_OK) return status;
    int64_t num[SCREE_VTKHDF_NUM_EXTENTS] = {0};
    num[SCREE_VTKHDF_POINTS] = num[SCREE_VTKHDF_CELLS] = num[SCREE_VTKHDF_IDS] = num_spheres;
    return scree_vtkhdf_add_part(file, num, &frames->sphere_step, report);
}

static scree_status write_spheres(scree_frames *frames, const scree_simulation *simulation, scree_report *report)
{
    static const int columns[] = {SCREE_VTKHDF_POINT_COORDINATES, SPHERE_SPEED, SPHERE_VELOCITY};
    scree_vtkhdf_file *file = frames->spheres;
    scree_vtkhdf_step *step = &frames->sphere_step;
    scree_status status = SCREE_OK;
    if (scree_vtkhdf_num_rows(file, SCREE_VTKHDF_POINTS) == 0)
        status = write_sphere_topology(frames, simulation, report);
    const bool is_first = scree_vtkhdf_num_steps(file) == 0;
    step->time = scree_simulation_time(simulation);
    step->point_offset = is_first ? 0 : scree_vtkhdf_num_rows(file, SCREE_VTKHDF_POINTS);
    for (int k = 0; k < 3 && status == SCREE_OK; ++k)
        status = write_sphere_column(frames, simulation, columns[k], step->point_offset, report);
    if (status == SCREE_OK) status = scree_vtkhdf_add_step(file, step, report);
    if (status == SCREE_OK && !is_first) scree_vtkhdf_add_points(file, frames->num_spheres);
    return status;
}

// ---- walls

static bool is_same_place(const scree_wall_state *a, const scree_wall_state *b)
{
    const scree_vec3 x = a->pose.position, y = b->pose.position;
    const scree_quat q = a->pose.orientation, r = b->pose.orientation;
    if (!a->is_present || !b->is_present) return a->is_present == b->is_present;
    return x.x == y.x && x.y == y.y && x.z == y.z && q.w == r.w && q.x == r.x && q.y == r.y && q.z == r.z;
}

/// True if the walls look as they were last written.
static bool are_walls_written(const scree_frames *frames, const scree_simulation *simulation)
{
    bool is_same = frames->has_written_walls;
    for (int32_t w = 0; w < simulation->num_walls && is_same; ++w)
        is_same = is_same_place(simulation->walls + w, frames->written_walls + w);
    return is_same;
}

/// Points, triangles and indices of one wall behind those in `num`.
static scree_status write_wall(scree_frames *frames, const scree_simulation *simulation, int32_t w,
                               int64_t num[SCREE_VTKHDF_NUM_EXTENTS], scree_report *report)
{
    scree_vtkhdf_file *file = frames->walls;
    const scree_shape_view *shape = wall_shape(simulation, w);
    const int64_t num_triangles = shape->num_triangles;
    const int64_t point_row = scree_vtkhdf_num_rows(file, SCREE_VTKHDF_POINTS) + num[SCREE_VTKHDF_POINTS];
    const int64_t id_row = scree_vtkhdf_num_rows(file, SCREE_VTKHDF_IDS) + num[SCREE_VTKHDF_IDS];
    const int64_t offset_row = scree_vtkhdf_num_rows(file, SCREE_VTKHDF_CELLS) +
                               scree_vtkhdf_num_rows(file, SCREE_VTKHDF_PARTS) + num[SCREE_VTKHDF_CELLS];
    float *points = frames->block;
    place_points(shape, simulation->walls[w].pose, points);
    scree_status status = scree_vtkhdf_write(file, SCREE_VTKHDF_POINT_COORDINATES,
                                             (scree_vtkhdf_rows){point_row, shape->num_vertices}, points, report);
    int32_t *ids = frames->block;
    for (int32_t v = 0; v < shape->num_vertices; ++v) ids[v] = w;
    if (status == SCREE_OK)
        status = scree_vtkhdf_write(file, WALL_ID, (scree_vtkhdf_rows){point_row, shape->num_vertices}, ids, report);
    number_triangles(shape, num[SCREE_VTKHDF_POINTS], ids);
    if (status == SCREE_OK)
        status = scree_vtkhdf_write(file, SCREE_VTKHDF_CONNECTIVITY, (scree_vtkhdf_rows){id_row, 3 * num_triangles},
                                    ids, report);
    for (int64_t t = 0; t <= num_triangles; ++t) ids[t] = (int32_t)(num[SCREE_VTKHDF_IDS] + 3 * t);
    if (status == SCREE_OK)
        status = scree_vtkhdf_write(file, SCREE_VTKHDF_OFFSETS, (scree_vtkhdf_rows){offset_row, num_triangles + 1}, ids,
                                    report);
    num[SCREE_VTKHDF_POINTS] += shape->num_vertices;
    num[SCREE_VTKHDF_CELLS] += num_triangles;
    num[SCREE_VTKHDF_IDS] += 3 * num_triangles;
    return status;
}

static scree_status write_walls(scree_frames *frames, const scree_simulation *simulation, scree_report *report)
{
    scree_vtkhdf_step *step = &frames->wall_step;
    scree_status status = SCREE_OK;
    if (!are_walls_written(frames, simulation))
    {
        frames->has_written_walls = false;
        int64_t num[SCREE_VTKHDF_NUM_EXTENTS] = {0};
        for (int32_t w = 0; w < simulation->num_walls && status == SCREE_OK; ++w)
            if (simulation->walls[w].is_present) status = write_wall(frames, simulation, w, num, report);
        *step = (scree_vtkhdf_step){0, SCREE_VTKHDF_EMPTY_PART, 0, 0, 0};
        if (status == SCREE_OK && num[SCREE_VTKHDF_CELLS] > 0)
            status = scree_vtkhdf_add_part(frames->walls, num, step, report);
        if (status != SCREE_OK) return status;
        memcpy(frames->written_walls, simulation->walls, (size_t)simulation->num_walls * sizeof *simulation->walls);
        frames->has_written_walls = true;
    }
    step->time = scree_simulation_time(simulation);
    return scree_vtkhdf_add_step(frames->walls, step, report);
}

// ---- contacts

typedef struct contact_line
{
    scree_vec3 points[3];
    int num_points; ///< 2 at a wall, which has no centre
} contact_line;

static contact_line make_contact_line(const scree_simulation *simulation, int64_t c)
{
    const scree_contact_list *contacts = &simulation->contacts;
    const scree_particles *particles = &simulation->particles;
    const scree_candidate_pair pair = contacts->bodies[c];
    contact_line line;
    line.num_points = pair.j < particles->num_particles ? 3 : 2;
    line.points[0] = particles->position[pair.i];
    line.points[1] = scree_vec3_add(line.points[0], contacts->arm[c]);
    line.points[2] = line.num_points == 3 ? particles->position[pair.j] : line.points[1];
    return line;
}

/// Lines of `count` further contacts; `num` counts what this frame has so far.
static scree_status write_contact_lines(scree_frames *frames, const scree_simulation *simulation, int64_t count,
                                        int64_t num[SCREE_VTKHDF_NUM_EXTENTS], scree_report *report)
{
    scree_vtkhdf_file *file = frames->contacts;
    const int64_t first = num[SCREE_VTKHDF_CELLS], first_point = num[SCREE_VTKHDF_POINTS];
    const int64_t point_row = scree_vtkhdf_num_rows(file, SCREE_VTKHDF_POINTS) + first_point;
    const int64_t id_row = scree_vtkhdf_num_rows(file, SCREE_VTKHDF_IDS) + first_point;
    const int64_t offset_row =
        scree_vtkhdf_num_rows(file, SCREE_VTKHDF_CELLS) + scree_vtkhdf_num_rows(file, SCREE_VTKHDF_PARTS) + first;
    float *points = frames->block;
    int64_t num_points = 0;
    for (int64_t c = first; c < first + count; ++c)
    {
        const contact_line line = make_contact_line(simulation, c);
        for (int k = 0; k < line.num_points; ++k, ++num_points)
        {
            points[3 * num_points + 0] = (float)line.points[k].x;
            points[3 * num_points + 1] = (float)line.points[k].y;
            points[3 * num_points + 2] = (float)line.points[k].z;
        }
    }
    scree_status status = scree_vtkhdf_write(file, SCREE_VTKHDF_POINT_COORDINATES,
                                             (scree_vtkhdf_rows){point_row, num_points}, points, report);
    int32_t *ids = frames->block;
    for (int64_t k = 0; k < num_points; ++k) ids[k] = (int32_t)(first_point + k);
    if (status == SCREE_OK)
        status =
            scree_vtkhdf_write(file, SCREE_VTKHDF_CONNECTIVITY, (scree_vtkhdf_rows){id_row, num_points}, ids, report);
    ids[0] = (int32_t)first_point;
    for (int64_t c = 0; c < count; ++c) ids[c + 1] = ids[c] + make_contact_line(simulation, first + c).num_points;
    if (status == SCREE_OK)
        status =
            scree_vtkhdf_write(file, SCREE_VTKHDF_OFFSETS, (scree_vtkhdf_rows){offset_row, count + 1}, ids, report);
    num[SCREE_VTKHDF_CELLS] += count;
    num[SCREE_VTKHDF_POINTS] += num_points;
    num[SCREE_VTKHDF_IDS] += num_points;
    return status;
}

static float contact_number(const scree_contact_list *contacts, int64_t c, int column)
{
    switch (column)
    {
    case CONTACT_NORMAL_FORCE:
        return (float)scree_vec3_dot(contacts->normal_force[c], contacts->normal[c]);
    case CONTACT_TANGENTIAL_FORCE:
        return (float)scree_vec3_length(contacts->tangential_force[c]);
    case CONTACT_INDENTATION:
        return (float)contacts->indentation[c];
    default:
        return (float)contacts->volume[c];
    }
}

/// One column of cell data for the contacts first .. last - 1, to the block.
static void fill_contact_column(const scree_contact_list *contacts, int column, int64_t first, int64_t last,
                                void *block)
{
    int32_t *ids = block;
    uint8_t *marks = block;
    float *numbers = block;
    for (int64_t c = first; c < last; ++c)
    {
        if (column == CONTACT_I) ids[c - first] = contacts->bodies[c].i;
        else if (column == CONTACT_J) ids[c - first] = contacts->bodies[c].j;
        else if (column == CONTACT_SLIPPING) marks[c - first] = contacts->is_slipping[c];
        else numbers[c - first] = contact_number(contacts, c, column);
    }
}

static scree_status write_contacts(scree_frames *frames, const scree_simulation *simulation, scree_report *report)
{
    scree_vtkhdf_file *file = frames->contacts;
    const int64_t num_contacts = simulation->contacts.num_contacts, num_in_block = BLOCK_ITEMS / 3;
    const int64_t cell_row = scree_vtkhdf_num_rows(file, SCREE_VTKHDF_CELLS);
    int64_t num[SCREE_VTKHDF_NUM_EXTENTS] = {0};
    scree_status status = SCREE_OK;
    for (int64_t first = 0; first < num_contacts && status == SCREE_OK; first += num_in_block)
    {
        const int64_t left = num_contacts - first, count = left < num_in_block ? left : num_in_block;
        status = write_contact_lines(frames, simulation, count, num, report);
        for (int column = CONTACT_I; column <= CONTACT_SLIPPING && status == SCREE_OK; ++column)
        {
            fill_contact_column(&simulation->contacts, column, first, first + count, frames->block);
            status =
                scree_vtkhdf_write(file, column, (scree_vtkhdf_rows){cell_row + first, count}, frames->block, report);
        }
    }
    scree_vtkhdf_step step = {0, SCREE_VTKHDF_EMPTY_PART, 0, 0, 0};
    if (status == SCREE_OK && num_contacts > 0) status = scree_vtkhdf_add_part(file, num, &step, report);
    step.time = scree_simulation_time(simulation);
    return status == SCREE_OK ? scree_vtkhdf_add_step(file, &step, report) : status;
}

// ---- all of them

/// Frames that the scene asks for, first and last included.
static int64_t expected_frames(const scree_simulation *simulation)
{
    const double interval = simulation->scene->output.frames, end = simulation->scene->time.end;
    const double num = interval > 0 ? ceil(end / interval) + 2 : 1;
    return num < 1e6 ? (int64_t)num : 1000000;
}

/// Numbers of vertices and triangles of all particles; the block that fits any body.
static scree_status measure(scree_frames *frames, const scree_simulation *simulation, int64_t *num_triangles,
                            scree_report *report)
{
    const int64_t num_particles = simulation->particles.num_particles;
    int64_t largest = BLOCK_ITEMS;
    *num_triangles = 0;
    frames->first_vertex = malloc((size_t)(num_particles + 1) * sizeof *frames->first_vertex);
    frames->written_walls = malloc((size_t)(simulation->num_walls + 1) * sizeof *frames->written_walls);
    int64_t num_spheres = 0;
    for (int64_t i = 0; i < num_particles; ++i) num_spheres += particle_shape(simulation, i)->num_spheres;
    frames->sphere_ids = malloc((size_t)(num_spheres + 1) * sizeof *frames->sphere_ids);
    frames->sphere_parts = malloc((size_t)(num_spheres + 1) * sizeof *frames->sphere_parts);
    if (frames->first_vertex == NULL || frames->written_walls == NULL || frames->sphere_ids == NULL ||
        frames->sphere_parts == NULL)
        return SCREE_OUT_OF_MEMORY;
    frames->first_vertex[0] = 0;
    for (int64_t i = 0; i < num_particles; ++i)
    {
        frames->first_vertex[i + 1] = frames->first_vertex[i] + particle_shape(simulation, i)->num_vertices;
        *num_triangles += particle_shape(simulation, i)->num_triangles;
        for (int32_t k = 0; k < particle_shape(simulation, i)->num_spheres; ++k)
        {
            frames->sphere_ids[frames->num_spheres] = (int32_t)i;
            frames->sphere_parts[frames->num_spheres++] = k;
        }
    }
    for (int32_t k = 0; k < 2 * simulation->num_shapes; ++k)
    {
        const scree_shape_view *shape = simulation->shape_views + k;
        if (shape->num_triangles > largest) largest = shape->num_triangles;
        if (shape->num_vertices > largest) largest = shape->num_vertices;
    }
    frames->block = malloc((size_t)(largest + 1) * 3 * sizeof(float));
    if (frames->block == NULL) return SCREE_OUT_OF_MEMORY;
    if (num_spheres > INT32_MAX)
        scree_report_add(report, "%lld spheres are more than spheres.vtkhdf can number; set output.frames to 0",
                         (long long)num_spheres);
    else if (3 * *num_triangles <= INT32_MAX && frames->first_vertex[num_particles] <= INT32_MAX) return SCREE_OK;
    if (num_spheres > INT32_MAX) return SCREE_TOO_MANY;
    scree_report_add(report, "%lld triangles are more than frames.vtkhdf can number; set output.frames to 0",
                     (long long)*num_triangles);
    return SCREE_TOO_MANY;
}

/// The files, in the order of their definitions.
enum
{
    PARTICLES_FILE,
    SPHERES_FILE,
    WALLS_FILE,
    CONTACTS_FILE,
    NUM_FILES
};

static const char *const file_names[NUM_FILES] = {"frames.vtkhdf", "spheres.vtkhdf", "walls.vtkhdf", "contacts.vtkhdf"};

static void define(const scree_frames *frames, const scree_simulation *simulation, int64_t num_triangles,
                   scree_vtkhdf_def defs[NUM_FILES])
{
    const int64_t num_frames = expected_frames(simulation), num_particles = simulation->particles.num_particles;
    const int64_t num_points = frames->first_vertex[num_particles];
    int64_t wall_triangles = 0;
    for (int32_t w = 0; w < simulation->num_walls; ++w) wall_triangles += wall_shape(simulation, w)->num_triangles;
    const scree_vtkhdf_def particles = {
        SCREE_VTKHDF_POLYGONS,
        3,
        {{&scree_frame_particle, SCREE_VTKHDF_FIXED_POINTS},
         {&scree_frame_group, SCREE_VTKHDF_FIXED_POINTS},
         {&scree_frame_speed, SCREE_VTKHDF_POINTS}},
        {num_frames, 3, num_frames * num_points, num_triangles + 1, 3 * num_triangles, num_points}};
    const scree_vtkhdf_def spheres = {SCREE_VTKHDF_VERTICES,
                                      5,
                                      {{&scree_frame_particle, SCREE_VTKHDF_FIXED_POINTS},
                                       {&scree_frame_group, SCREE_VTKHDF_FIXED_POINTS},
                                       {&scree_frame_radius, SCREE_VTKHDF_FIXED_POINTS},
                                       {&scree_frame_speed, SCREE_VTKHDF_POINTS},
                                       {&scree_frame_velocity, SCREE_VTKHDF_POINTS}},
                                      {num_frames, 3, num_frames * frames->num_spheres, frames->num_spheres + 1,
                                       frames->num_spheres, frames->num_spheres}};
    const scree_vtkhdf_def walls = {SCREE_VTKHDF_POLYGONS,
                                    1,
                                    {{&scree_frame_wall, SCREE_VTKHDF_POINTS}},
                                    {num_frames, 16, 4 * wall_triangles, 4 * wall_triangles, 12 * wall_triangles, 0}};
    const scree_vtkhdf_def contacts = {
        SCREE_VTKHDF_LINES,
        7,
        {{&scree_frame_i, SCREE_VTKHDF_CELLS},
         {&scree_frame_j, SCREE_VTKHDF_CELLS},
         {&scree_frame_normal_force, SCREE_VTKHDF_CELLS},
         {&scree_frame_tangential_force, SCREE_VTKHDF_CELLS},
         {&scree_frame_indentation, SCREE_VTKHDF_CELLS},
         {&scree_frame_volume, SCREE_VTKHDF_CELLS},
         {&scree_frame_slipping, SCREE_VTKHDF_CELLS}},
        {num_frames, num_frames + 2, 12 * num_particles, 4 * num_particles, 12 * num_particles, 0}};
    defs[PARTICLES_FILE] = particles;
    defs[SPHERES_FILE] = spheres;
    defs[WALLS_FILE] = walls;
    defs[CONTACTS_FILE] = contacts;
}

/// Opens the files, going on with what they hold up to last_time if that is not negative.
static scree_status open_all(scree_frames *frames, const char *folder, const scree_simulation *simulation,
                             double last_time, scree_report *report)
{
    scree_vtkhdf_file **const files[NUM_FILES] = {&frames->particles, &frames->spheres, &frames->walls,
                                                  &frames->contacts};
    scree_vtkhdf_def defs[NUM_FILES];
    int64_t num_triangles;
    scree_status status = measure(frames, simulation, &num_triangles, report);
    if (status == SCREE_OK) define(frames, simulation, num_triangles, defs);
    const bool is_empty[NUM_FILES] = {num_triangles == 0 && frames->num_spheres > 0, frames->num_spheres == 0,
                                      simulation->num_walls == 0, false};
    for (int k = 0; k < NUM_FILES && status == SCREE_OK; ++k)
    {
        if (is_empty[k]) continue;
        char *path = scree_path_join(folder, file_names[k]);
        if (path == NULL) status = SCREE_OUT_OF_MEMORY;
        else if (last_time >= 0) status = scree_vtkhdf_reopen(files[k], path, defs + k, last_time, report);
        else status = scree_vtkhdf_create(files[k], path, defs + k, report);
        free(path);
    }
    return status;
}

scree_status scree_frames_open(scree_frames **frames, const char *folder, const scree_simulation *simulation,
                               bool is_restart, scree_report *report)
{
    *frames = NULL;
    scree_frames *f = calloc(1, sizeof *f);
    if (f == NULL) return SCREE_OUT_OF_MEMORY;
    const scree_status status =
        open_all(f, folder, simulation, is_restart ? scree_simulation_time(simulation) : -1, report);
    if (status != SCREE_OK)
    {
        scree_frames_close(f, NULL);
        return status;
    }
    if (f->particles != NULL && scree_vtkhdf_num_steps(f->particles) > 0)
        f->particle_step = scree_vtkhdf_last_step(f->particles);
    if (f->spheres != NULL && scree_vtkhdf_num_steps(f->spheres) > 0)
        f->sphere_step = scree_vtkhdf_last_step(f->spheres);
    *frames = f;
    return SCREE_OK;
}

scree_status scree_frames_write(scree_frames *frames, const scree_simulation *simulation, scree_report *report)
{
    const double time = scree_simulation_time(simulation);
    scree_status status = SCREE_OK;
    if (frames->walls != NULL && scree_vtkhdf_last_time(frames->walls) < time)
        status = write_walls(frames, simulation, report);
    if (status == SCREE_OK && scree_vtkhdf_last_time(frames->contacts) < time)
        status = write_contacts(frames, simulation, report);
    if (status == SCREE_OK && frames->spheres != NULL && scree_vtkhdf_last_time(frames->spheres) < time)
        status = write_spheres(frames, simulation, report);
    if (status == SCREE_OK && frames->particles != NULL && scree_vtkhdf_last_time(frames->particles) < time)
        status = write_particles(frames, simulation, report);
    return status;
}

scree_status scree_frames_close(scree_frames *frames, scree_report *report)
{
    if (frames == NULL) return SCREE_OK;
    scree_vtkhdf_file *const files[NUM_FILES] = {frames->particles, frames->spheres, frames->walls, frames->contacts};
    scree_status worst = SCREE_OK;
    for (int k = 0; k < NUM_FILES; ++k)
    {
        const scree_status status = scree_vtkhdf_close(files[k], report);
        if (worst == SCREE_OK) worst = status;
    }
    free(frames->first_vertex);
    free(frames->sphere_ids);
    free(frames->sphere_parts);
    free(frames->written_walls);
    free(frames->block);
    free(frames);
    return worst;
}
