/// \file bench_bed.c
/// Dense beds made directly, without a fall: a periodic tile of bodies on a jittered lattice, turned at random, whose
/// overlaps are pushed and turned apart while the tile grows, until their mean indentation is a thousandth of the size
/// and no more pairs touch than wanted; and as many copies of the tile as the bed needs.
#include "bvh/morton_kernel.h"
#include "cli/bench.h"
#include "contact/narrow_phase.h"
#include "dynamics/dynamics.h"
#include "dynamics/step_buffers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum
{
    TILE = 8,          ///< bodies of a tile in a row
    FIRST_ROUNDS = 20, ///< at the density of the start
    MAX_ROUNDS = 300
};

/// Growth of the tile in a round over the mean indentation.
#define EXPANSION 0.05

/// Part of its overlap that a pair is pushed apart by in a round; a body has several.
#define PUSH 0.5
/// Moment of inertia over mass and bounding radius squared, roughly that of all shapes.
#define INERTIA 0.15
#define BODY_SIZE 0.01 /* [m] */

/// A periodic tile, its bodies followed by images of those that lie near its faces.
typedef struct tile
{
    const scree_shape_view *shape;
    int64_t row, num, num_all; ///< bodies in a row, in the tile, with images
    double length;             ///< [m] of the tile
    double wanted_depth;
    scree_pose *pose;        ///< (max)
    int32_t *original;       ///< (max)
    scree_vec3 *push, *turn; ///< (num)
    int32_t *shape_index;    ///< (max) zeros
    scree_real *travel;      ///< (max) zeros
    scree_box *boxes;        ///< (max)
    scree_vec3 *centres;     ///< (max)
    scree_real *radii;       ///< (max)
    int64_t max;
    scree_broad_phase broad_phase;
    scree_narrow_phase narrow_phase;
    scree_contact_list contacts;
    double depth;          ///< mean over the bounding diameter
    double pairs_per_body; ///< that touch
} tile;

static void destroy_tile(tile *t)
{
    free(t->pose);
    free(t->original);
    free(t->push);
    free(t->turn);
    free(t->shape_index);
    free(t->travel);
    free(t->boxes);
    free(t->centres);
    free(t->radii);
    scree_broad_phase_destroy(&t->broad_phase);
    scree_narrow_phase_destroy(&t->narrow_phase);
    scree_contact_list_destroy(&t->contacts);
    *t = (tile){0};
}

/// Uniform rotation.
static scree_quat random_orientation(uint64_t *state)
{
    for (;;)
    {
        double q[4], squared = 0;
        for (int k = 0; k < 4; ++k)
        {
            q[k] = 2 * scree_bench_uniform(state) - 1;
            squared += q[k] * q[k];
        }
        if (squared <= 1 && squared > 0.01)
            return scree_quat_normalize(
                scree_quat_make((scree_real)q[0], (scree_real)q[1], (scree_real)q[2], (scree_real)q[3]));
    }
}

/// Bodies on a lattice of cells of a volume, jittered by a tenth of their distance.
static scree_status create_tile(tile *t, const scree_shape_view *shape, int64_t row, double volume, double wanted_depth)
{
    *t = (tile){.shape = shape, .row = row, .num = row * row * row};
    const double cell = cbrt(volume);
    t->length = cell * (double)row;
    t->wanted_depth = wanted_depth;
    t->max = 27 * t->num;
    t->pose = calloc((size_t)t->max, sizeof *t->pose);
    t->original = calloc((size_t)t->max, sizeof *t->original);
    t->push = calloc((size_t)t->num, sizeof *t->push);
    t->turn = calloc((size_t)t->num, sizeof *t->turn);
    t->shape_index = calloc((size_t)t->max, sizeof *t->shape_index);
    t->travel = calloc((size_t)t->max, sizeof *t->travel);
    t->boxes = calloc((size_t)t->max, sizeof *t->boxes);
    t->centres = calloc((size_t)t->max, sizeof *t->centres);
    t->radii = calloc((size_t)t->max, sizeof *t->radii);
    if (t->pose == NULL || t->original == NULL || t->push == NULL || t->turn == NULL || t->shape_index == NULL ||
        t->travel == NULL || t->boxes == NULL || t->centres == NULL || t->radii == NULL)
    {
        destroy_tile(t);
        return SCREE_OUT_OF_MEMORY;
    }
    t->narrow_phase.options.use_convex_path = true;
    t->narrow_phase.separation.finds = true;
    t->contacts.acts_in_points = shape->kind == SCREE_KIND_SPHERE;
    uint64_t state = 7;
    for (int64_t i = 0; i < t->num; ++i)
    {
        const int64_t place[3] = {i % row, i / row % row, i / row / row};
        double x[3];
        for (int k = 0; k < 3; ++k)
            x[k] = ((double)place[k] + 0.5 + 0.1 * (2 * scree_bench_uniform(&state) - 1)) * cell;
        t->pose[i].position = scree_vec3_make((scree_real)x[0], (scree_real)x[1], (scree_real)x[2]);
        t->pose[i].orientation = random_orientation(&state);
        t->pose[i].scale = 1;
    }
    return SCREE_OK;
}

/// Images of the bodies within a bounding diameter of the faces of the tile.
static void make_images(tile *t)
{
    const double reach = 2.1 * (double)t->shape->bounding_radius;
    t->num_all = t->num;
    for (int64_t i = 0; i < t->num; ++i)
    {
        t->original[i] = (int32_t)i;
        for (int n = 0; n < 27; ++n)
        {
            const double shift[3] = {(n % 3 - 1) * t->length, (n / 3 % 3 - 1) * t->length, (n / 9 - 1) * t->length};
            const scree_vec3 x = scree_vec3_add(
                t->pose[i].position, scree_vec3_make((scree_real)shift[0], (scree_real)shift[1], (scree_real)shift[2]));
            const double low = fmin((double)x.x, fmin((double)x.y, (double)x.z));
            const double high = fmax((double)x.x, fmax((double)x.y, (double)x.z));
            if (n == 13 || low < -reach || high > t->length + reach) continue;
            t->pose[t->num_all] = t->pose[i];
            t->pose[t->num_all].position = x;
            t->original[t->num_all++] = (int32_t)i;
        }
    }
}

static scree_status find_contacts(tile *t)
{
    make_images(t);
    const scree_boxes_args boxes = {t->shape, t->shape_index, t->pose, 0, t->boxes, t->centres, t->radii};
    scree_boxes_launch(boxes, t->num_all);
    const scree_broad_phase_input input = {.boxes = t->boxes,
                                           .centres = t->centres,
                                           .radii = t->radii,
                                           .num_particles = t->num_all,
                                           .compares_spheres = true};
    scree_status status = scree_broad_phase_find(&t->broad_phase, &input);
    const scree_bodies bodies = {
        .shapes = t->shape, .shape = t->shape_index, .pose = t->pose, .travel = t->travel, .num_bodies = t->num_all};
    scree_narrow_phase_forget(&t->narrow_phase);
    if (status == SCREE_OK)
        status = scree_narrow_phase_find(&t->narrow_phase, &bodies, t->broad_phase.pairs, t->broad_phase.num_pairs,
                                         &t->contacts);
    return status;
}

/// Push and turn of one body of contact c: the share of its mobility along the normal, about the arm.
static void push_body(tile *t, int32_t i, scree_vec3 arm, scree_vec3 by)
{
    const scree_real inertia = (scree_real)INERTIA * t->shape->bounding_radius * t->shape->bounding_radius;
    t->push[i] = scree_vec3_add(t->push[i], by);
    t->turn[i] = scree_vec3_add(t->turn[i], scree_vec3_scale(scree_vec3_cross(arm, by), 1 / inertia));
}

/// How far a unit push along the normal at the arm moves the contact point along it.
static scree_real mobility(const tile *t, scree_vec3 arm, scree_vec3 normal)
{
    const scree_real inertia = (scree_real)INERTIA * t->shape->bounding_radius * t->shape->bounding_radius;
    const scree_vec3 lever = scree_vec3_cross(arm, normal);
    return 1 + scree_vec3_dot(lever, lever) / inertia;
}

/// Moves the two bodies of a pair so that their contact, at arms from each, is `by` deeper along the normal. A pair
/// across a face is met with each of its images, so a body takes its own part of every pair it has.
static void push_pair(tile *t, scree_candidate_pair pair, scree_vec3 normal, scree_vec3 arm, scree_real by)
{
    const scree_vec3 between = scree_vec3_sub(t->pose[pair.j].position, t->pose[pair.i].position);
    const scree_vec3 other_arm = scree_vec3_sub(arm, between);
    const scree_vec3 push =
        scree_vec3_scale(normal, (scree_real)-PUSH * by / (mobility(t, arm, normal) + mobility(t, other_arm, normal)));
    if (pair.i < t->num) push_body(t, pair.i, arm, push);
    if (pair.j < t->num) push_body(t, pair.j, other_arm, scree_vec3_negate(push));
}

/// One round: contacts, their mean indentation, and the pushes on the bodies of the tile.
static scree_status push_once(tile *t)
{
    const scree_status status = find_contacts(t);
    if (status != SCREE_OK) return status;
    memset(t->push, 0, (size_t)t->num * sizeof *t->push);
    memset(t->turn, 0, (size_t)t->num * sizeof *t->turn);
    const scree_real wanted = (scree_real)(t->wanted_depth * 2) * t->shape->bounding_radius;
    double sum = 0, num_ends = 0;
    for (int64_t c = 0; c < t->contacts.num_contacts; ++c)
    {
        const scree_candidate_pair pair = t->contacts.bodies[c];
        const int num = (pair.i < t->num) + (pair.j < t->num);
        push_pair(t, pair, t->contacts.normal[c], t->contacts.arm[c], wanted - t->contacts.indentation[c]);
        sum += num * (double)t->contacts.indentation[c];
        num_ends += num;
    }
    t->depth = num_ends > 0 ? sum / num_ends / (2 * (double)t->shape->bounding_radius) : 0;
    t->pairs_per_body = 0.5 * num_ends / (double)t->num;
    return SCREE_OK;
}

/// Moves a body by its push and, approximately, its turn.
static void move_body(tile *t, int64_t i)
{
    const scree_vec3 half = scree_vec3_scale(t->turn[i], (scree_real)0.5);
    const scree_quat turn = scree_quat_normalize(scree_quat_make(1, half.x, half.y, half.z));
    t->pose[i].position = scree_vec3_add(t->pose[i].position, t->push[i]);
    t->pose[i].orientation = scree_quat_normalize(scree_quat_multiply(turn, t->pose[i].orientation));
}

/// Makes the tile larger, with the places of its bodies.
static void expand(tile *t, double factor)
{
    for (int64_t i = 0; i < t->num; ++i)
        t->pose[i].position = scree_vec3_scale(t->pose[i].position, (scree_real)factor);
    t->length *= factor;
}

/// From a tile that is too dense to one whose pairs touch as lightly, and are as few, as wanted.
static scree_status relax(tile *t, double pairs_per_body)
{
    for (int round = 0;; ++round)
    {
        const scree_status status = push_once(t);
        const bool is_light = t->depth <= 1.2 * t->wanted_depth, are_few = t->pairs_per_body <= 1.02 * pairs_per_body;
        if (status != SCREE_OK || (is_light && are_few) || round == MAX_ROUNDS) return status;
        for (int64_t i = 0; i < t->num; ++i) move_body(t, i);
        if (round >= FIRST_ROUNDS) expand(t, 1 + (is_light ? 0.1 * t->wanted_depth : EXPANSION * t->depth));
    }
}

/// Where a body of the bed is: cell of the lattice, and the key by which the bodies are ordered.
typedef struct bed_place
{
    uint64_t key;
    int32_t cell[3];
} bed_place;

static int compare_places(const void *a, const void *b)
{
    const uint64_t x = ((const bed_place *)a)->key, y = ((const bed_place *)b)->key;
    return (x > y) - (x < y);
}

/// Cells of a cube that holds the bed, in the order wanted.
static bed_place *make_places(int64_t num, const char *order)
{
    bed_place *places = malloc((size_t)num * sizeof *places);
    if (places == NULL) return NULL;
    const int64_t row = (int64_t)ceil(cbrt((double)num) - 1e-9);
    uint64_t state = 11;
    for (int64_t i = 0; i < num; ++i)
    {
        const int32_t cell[3] = {(int32_t)(i % row), (int32_t)(i / row % row), (int32_t)(i / row / row)};
        memcpy(places[i].cell, cell, sizeof cell);
        places[i].key = (uint64_t)i;
        if (strcmp(order, "random") == 0)
            places[i].key = (uint64_t)(scree_bench_uniform(&state) * 0x1p31) << 31 | (uint64_t)i;
        if (strcmp(order, "morton") != 0) continue;
        places[i].key = 0;
        for (int bit = 0; bit < 20; ++bit)
            for (int k = 0; k < 3; ++k) places[i].key |= (uint64_t)(cell[k] >> bit & 1) << (3 * bit + k);
    }
    qsort(places, (size_t)num, sizeof *places, compare_places);
    return places;
}

/// The bodies of the simulation to where the tiles have theirs, at rest.
static scree_status lay_tiles(scree_simulation *s, const tile *t, const char *order, scree_report *report)
{
    bed_place *places = make_places(s->particles.num_particles, order);
    if (places == NULL) return SCREE_OUT_OF_MEMORY;
    for (int64_t i = 0; i < s->particles.num_particles; ++i)
    {
        const int32_t *cell = places[i].cell;
        const int64_t row = t->row;
        const scree_pose *from = t->pose + (cell[2] % row * row + cell[1] % row) * row + cell[0] % row;
        const scree_vec3 corner = scree_vec3_make((scree_real)((double)(cell[0] / row) * t->length),
                                                  (scree_real)((double)(cell[1] / row) * t->length),
                                                  (scree_real)((double)(cell[2] / row) * t->length));
        s->particles.position[i] = scree_vec3_add(from->position, corner);
        s->particles.orientation[i] = from->orientation;
        s->particles.velocity[i] = s->particles.angular_momentum[i] = scree_vec3_make(0, 0, 0);
    }
    free(places);
    s->contacts.num_contacts = 0;
    return scree_simulation_restored(s, report);
}

static scree_status make_scene(scree_bench_bodies *bodies, const scree_bench_bed *bed, scree_report *report)
{
    char shape[160], text[1600];
    if (strcmp(bed->shape, "cube") == 0)
        snprintf(shape, sizeof shape, "source: box, size: [%g, %g, %g]", BODY_SIZE, BODY_SIZE, BODY_SIZE);
    else if (strcmp(bed->shape, "rock") == 0)
        snprintf(shape, sizeof shape, "source: rock, seed: 1, triangles: %lld, size: [%g, 0, 0]",
                 (long long)bed->triangles, BODY_SIZE);
    else snprintf(shape, sizeof shape, "source: %s, size: [%g, 0, 0]", bed->shape, BODY_SIZE);
    // bodies are put in their places afterwards; a step so short that nothing moves keeps the bed as it is
    const double extent = 2 * BODY_SIZE * (2 + ceil(cbrt((double)bed->particles)));
    snprintf(text, sizeof text,
             "name: bed\n"
             "time: {end: 1, step: 1e-9}\n"
             "materials: [{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"
             "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.5, restitution_coefficient: 0.3}]\n"
             "shapes: [{name: body, %s}]\n"
             "particles:\n"
             "  - {name: bed, shape: body, material: stone, count: %lld, region: {min: [0, 0, 0], max: [%g, %g, %g]}}\n"
             "solver: {%s}\n",
             shape, (long long)bed->particles, extent, extent, extent, bed->solver);
    scree_status status = scree_scene_parse(&bodies->file, text, "bench.yaml", NULL, 0, report);
    if (status == SCREE_OK) status = scree_simulation_create(&bodies->simulation, &bodies->file.scene, ".", report);
    return status;
}

/// Volume of the bodies over that of the tile at the start, somewhat above what they jam at.
static double first_density(const char *shape) { return strcmp(shape, "cube") == 0 ? 0.8 : 0.62; }

scree_status scree_bench_copy_places(scree_simulation *s, const scree_simulation *from, scree_report *report)
{
    const size_t num = (size_t)s->particles.num_particles;
    memcpy(s->particles.position, from->particles.position, num * sizeof *s->particles.position);
    memcpy(s->particles.orientation, from->particles.orientation, num * sizeof *s->particles.orientation);
    s->contacts.num_contacts = 0;
    return scree_simulation_restored(s, report);
}

scree_status scree_bench_bed_create(scree_bench_bodies *bodies, const scree_bench_bed *bed, scree_report *report)
{
    *bodies = (scree_bench_bodies){0};
    scree_status status = make_scene(bodies, bed, report);
    tile t = {0};
    const int64_t needed = (int64_t)ceil(cbrt((double)bed->particles) - 1e-9);
    const int64_t row = needed < 4 ? 4 : needed < TILE ? needed : TILE;
    if (status == SCREE_OK && bed->like != NULL)
    {
        status = scree_bench_copy_places(bodies->simulation, bed->like, report);
        if (status != SCREE_OK) scree_bench_bed_destroy(bodies);
        return status;
    }
    if (status == SCREE_OK)
        status = create_tile(&t, bodies->simulation->shape_views, row,
                             bodies->simulation->particle_shapes[0].properties.volume / first_density(bed->shape),
                             bed->depth);
    if (status == SCREE_OK) status = relax(&t, bed->pairs_per_particle);
    if (status == SCREE_OK) status = lay_tiles(bodies->simulation, &t, bed->order, report);
    bodies->depth = t.depth;
    destroy_tile(&t);
    if (status != SCREE_OK) scree_bench_bed_destroy(bodies);
    return status;
}

void scree_bench_bed_destroy(scree_bench_bodies *bodies)
{
    scree_simulation_destroy(bodies->simulation);
    scree_scene_close(&bodies->file);
    *bodies = (scree_bench_bodies){0};
}
