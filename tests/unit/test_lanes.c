/// Groups of lanes: what is turned in registers against item by item, and launches of a bed of spheres on the CPU
/// against the bodies of their kernels, one after the other, bit for bit.
#include "contact/history.h"
#include "contact/sphere_pairs.h"
#include "core/lanes.h"
#include "dynamics/dynamics.h"
#include "dynamics/step_buffers.h"
#include "scene_run.h"

#include <stdlib.h>

static void test_turning(void)
{
    // two numbers between the items, which must stay
    enum
    {
        GAP = 2,
        SIZE = 4 + GAP,
        NUM = 20
    };
    scree_real memory[NUM][SIZE], back[SCREE_LANES][SIZE];
    scree_vec3 vectors[SCREE_LANES], vectors_back[SCREE_LANES];
    for (int i = 0; i < NUM; ++i)
        for (int k = 0; k < SIZE; ++k) memory[i][k] = (scree_real)(100 * i + k);
    for (int l = 0; l < SCREE_LANES; ++l)
        vectors[l] = scree_vec3_make((scree_real)l, (scree_real)(l + 20), (scree_real)(l + 40));
    scree_lanes_vec3 lanes;
    scree_real fourth[SCREE_LANES];
    scree_lanes_load(&lanes, vectors);
    for (int l = 0; l < SCREE_LANES; ++l)
        SCREE_CHECK(lanes.x[l] == vectors[l].x && lanes.y[l] == vectors[l].y && lanes.z[l] == vectors[l].z);
    scree_lanes_store(vectors_back, &lanes);
    SCREE_CHECK(memcmp(vectors, vectors_back, sizeof vectors) == 0);

    const int32_t index[SCREE_LANES] = {3, 19, 0, 3, 7, 18, 1, 12};
    scree_lanes_gather(&lanes, fourth, memory, sizeof *memory, index);
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        const scree_real *item = memory[index[l]];
        SCREE_CHECK(lanes.x[l] == item[0] && lanes.y[l] == item[1] && lanes.z[l] == item[2] && fourth[l] == item[3]);
    }
    for (int l = 0; l < SCREE_LANES; ++l)
        for (int k = 0; k < SIZE; ++k) back[l][k] = -1;
    scree_lanes_scatter(back, sizeof *back, &lanes, fourth);
    for (int l = 0; l < SCREE_LANES; ++l)
    {
        SCREE_CHECK(memcmp(back[l], memory[index[l]], 4 * sizeof(scree_real)) == 0);
        SCREE_CHECK(back[l][4] == -1 && back[l][5] == -1);
    }
}

/// Spheres of two materials pour into a box whose floor moves: contacts begin and end, stick and slip.
static const char scene_text[] =
    "name: bed\n"
    "time: {end: 1, step: 2e-5}\n"
    "materials:\n"
    "  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}\n"
    "  - {name: steel, density: 7800, youngs_modulus: 1e8, poisson_ratio: 0.3}\n"
    "contact_laws:\n"
    "  - {materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}\n"
    "  - {materials: [stone, steel], friction_coefficient: 0.3, damping_ratio: 0.2}\n"
    "  - {materials: [steel, steel], friction_coefficient: 0.1, damping_ratio: 0.1}\n"
    "shapes:\n"
    "  - {name: ball, source: sphere, size: [0.016, 0, 0]}\n"
    "  - {name: floor, source: box, size: [0.3, 0.3, 0.02]}\n"
    "particles:\n"
    "  - {name: balls, shape: ball, material: stone, count: 300, seed: 4, velocity: [0, 0, -3],\n"
    "     region: {min: [-0.05, -0.05, 0.001], max: [0.05, 0.05, 0.3]}}\n"
    "  - {name: shots, shape: ball, material: steel, count: 41, seed: 2, velocity: [0, 0, -6],\n"
    "     size: {distribution: uniform, min: 0.01, max: 0.02},\n"
    "     region: {min: [-0.05, -0.05, 0.31], max: [0.05, 0.05, 0.4]}}\n"
    "walls:\n"
    "  - {name: floor, shape: floor, material: steel, position: [0, 0, -0.01],\n"
    "     motion: {kind: translate, velocity: [0, 0, 0.2], start: 0.0, end: 0.2}}\n"
    "  - {name: right, shape: floor, material: stone, position: [0.07, 0, 0.1], orientation: [1, 0, 1, 0]}\n"
    "  - {name: left, shape: floor, material: stone, position: [-0.07, 0, 0.1], orientation: [1, 0, 1, 0]}\n"
    "  - {name: front, shape: floor, material: stone, position: [0, -0.07, 0.1], orientation: [1, 1, 0, 0]}\n"
    "  - {name: rear, shape: floor, material: stone, position: [0, 0.07, 0.1], orientation: [1, 1, 0, 0]}\n";

static scene_run run;
static scree_simulation *s;

/// An output array: kept after the launch, spoilt, and compared after the bodies.
typedef struct output
{
    void *array;
    size_t num_bytes;
    void *before, *launched;
} output;

static output output_of(void *array, int64_t num, size_t size)
{
    const output out = {array, (size_t)num * size, malloc((size_t)num * size), malloc((size_t)num * size)};
    memcpy(out.before, array, out.num_bytes);
    return out;
}

/// After the launch: the arrays as they were before it.
static void take_outputs(output *outputs, int num)
{
    for (int k = 0; k < num; ++k)
    {
        memcpy(outputs[k].launched, outputs[k].array, outputs[k].num_bytes);
        memcpy(outputs[k].array, outputs[k].before, outputs[k].num_bytes);
    }
}

/// After the bodies.
static void check_outputs(const char *kernel, output *outputs, int num)
{
    for (int k = 0; k < num; ++k)
    {
        const bool is_same = memcmp(outputs[k].launched, outputs[k].array, outputs[k].num_bytes) == 0;
        if (!is_same) printf("%s: array %d differs\n", kernel, k);
        SCREE_CHECK(is_same);
        free(outputs[k].before);
        free(outputs[k].launched);
    }
}

#define OUTPUT(array, num) output_of(array, num, sizeof *(array))
#define COMPARE(name, args, num, outputs)                                       \
    do {                                                                        \
        const int num_outputs = (int)(sizeof(outputs) / sizeof(outputs)[0]);    \
        name##_launch(args, num);                                               \
        take_outputs(outputs, num_outputs);                                     \
        for (int64_t index = 0; index < (num); ++index) name##_at(args, index); \
        check_outputs(#name, outputs, num_outputs);                             \
    } while (0)

static void test_motion(void)
{
    const scree_particles *p = &s->particles;
    const int64_t n = p->num_particles, num_bodies = n + s->num_walls;
    const scree_step_buffers *b = s->buffers;
    scree_predict_args predict;
    predict.particles = *p;
    predict.time_step = (scree_real)1e-5;
    predict.ways = scree_step_ways(s);
    predict.ways.travel = b->travel;
    predict.pose = b->pose;
    predict.moving = b->moving;
    output predicted[] = {
        OUTPUT(p->position, n), OUTPUT(p->orientation, n), OUTPUT(p->velocity, n), OUTPUT(p->angular_momentum, n),
        OUTPUT(b->pose, n),     OUTPUT(b->moving, n),      OUTPUT(b->travel, n)};
    COMPARE(scree_predict, predict, n, predicted);

    scree_travel_args travel;
    memset(&travel, 0, sizeof travel);
    travel.shapes = s->shape_views;
    travel.shape = b->shape;
    travel.pose = b->pose;
    travel.searched_pose = b->searched_pose;
    travel.num_particles = n;
    travel.particles_moved = &b->tally->particles_moved;
    travel.walls_moved = &b->tally->walls_moved;
    memset(b->tally, 0, sizeof *b->tally);
    output travelled[] = {OUTPUT(b->tally, 1)};
    COMPARE(scree_travel, travel, num_bodies, travelled);
    SCREE_CHECK(scree_maximum_value(b->tally->particles_moved) > 0);

    scree_correct_args correct;
    correct.particles = *p;
    correct.time_step = (scree_real)1e-5;
    correct.moving = b->moving;
    correct.ids = NULL;
    correct.tally = b->tally;
    for (int k = 0; k < 2; ++k)
    {
        // in the second round two particles are lost
        if (k == 1) p->position[37].x = p->angular_momentum[120].y = NAN;
        memset(b->tally, 0, sizeof *b->tally);
        output corrected[] = {OUTPUT(p->velocity, n), OUTPUT(p->angular_momentum, n), OUTPUT(b->moving, n),
                              OUTPUT(b->tally, 1)};
        COMPARE(scree_correct, correct, n, corrected);
        SCREE_CHECK(scree_maximum_value(b->tally->num_from_unstable) == (k == 1 ? (double)(n - 37) : 0));
    }
}

static scree_contact_force_args force_args(void)
{
    scree_contact_force_args force;
    force.contacts = scree_contact_list_view(&s->contacts);
    force.old_contacts = scree_contact_list_view(&s->old_contacts);
    force.old_of_contact = s->buffers->old_of_contact;
    force.bodies = scree_step_body_motion(s->buffers);
    force.laws = s->laws;
    force.num_materials = s->num_materials;
    force.time_step = (scree_real)s->time_step;
    force.sides = NULL;
    force.max_sides = 0;
    return force;
}

static void test_forces(void)
{
    const scree_contact_list *c = &s->contacts;
    const int64_t n = c->num_contacts;
    const scree_contact_force_args force = force_args();
    SCREE_CHECK(c->acts_in_points && n > 300);
    output forces[] = {OUTPUT(c->normal_force, n),   OUTPUT(c->tangential_force, n), OUTPUT(c->elastic_force, n),
                       OUTPUT(c->is_slipping, n),    OUTPUT(c->spring_force, n),     OUTPUT(c->tangential_stiffness, n),
                       OUTPUT(c->elastic_energy, n), OUTPUT(c->elastic_work, n),     OUTPUT(c->spring_energy, n),
                       OUTPUT(c->spring_work, n)};
    COMPARE(scree_contact_force, force, n, forces);
    int64_t num_slipping = 0, num_new = 0, num_of_walls = 0;
    for (int64_t k = 0; k < n; ++k)
    {
        num_slipping += c->is_slipping[k];
        num_new += force.old_of_contact[k] < 0;
        num_of_walls += c->bodies[k].j >= s->particles.num_particles;
    }
    SCREE_CHECK(num_slipping > 0 && num_slipping < n && num_of_walls > 0);
    printf("%lld contacts, %lld slipping, %lld new, %lld with walls\n", (long long)n, (long long)num_slipping,
           (long long)num_new, (long long)num_of_walls);
}

static void test_sums(void)
{
    const scree_particles *p = &s->particles;
    const scree_contact_force_args force = force_args();
    scree_gather_args gather;
    gather.contacts = force.contacts;
    gather.sides = NULL;
    gather.max_sides = 0;
    gather.own_begin = s->broad_phase.own_begin;
    gather.row_begin = s->broad_phase.row_begin;
    gather.row_pairs = s->broad_phase.row_pairs;
    gather.pose = s->buffers->pose;
    gather.mass = p->mass;
    gather.gravity = scree_vec3_make(0, (scree_real)0.5, (scree_real)-9.81);
    gather.force = p->force;
    gather.torque = p->torque;
    // contact after contact, and along rows
    for (int k = 0; k < 2; ++k)
    {
        gather.are_ids = k == 0;
        output gathered[] = {OUTPUT(p->force, p->num_particles), OUTPUT(p->torque, p->num_particles)};
        COMPARE(scree_gather, gather, p->num_particles, gathered);
    }

    scree_work_args work;
    work.contacts = force.contacts;
    work.own_begin = s->broad_phase.own_begin;
    const scree_step_buffers *b = s->buffers;
    work.old = (scree_old_contacts){s->old_contacts.elastic_energy,
                                    s->old_contacts.spring_energy,
                                    b->is_continued,
                                    b->has_old_groups ? NULL : s->old_contacts.first_of_pair,
                                    b->old_groups,
                                    b->old_groups + p->num_particles + s->num_walls};
    work.bodies = force.bodies;
    work.inertia = p->inertia;
    work.laws = s->laws;
    work.num_materials = s->num_materials;
    work.num_particles = (int32_t)p->num_particles;
    work.time_step = force.time_step;
    work.sums = s->buffers->work_sums;
    const int64_t num_blocks = scree_count_blocks(p->num_particles, SCREE_WORK_BLOCK);
    int32_t reversed[400];
    scree_real of_bodies[4 * 400];
    for (int32_t k = 0; k < p->num_particles; ++k) reversed[k] = (int32_t)p->num_particles - 1 - k;
    work.ids = work.places = NULL;
    work.of_bodies = of_bodies;
    output sums[] = {OUTPUT(work.sums, num_blocks)};
    COMPARE(scree_work, work, num_blocks, sums);

    // with other ids; then the smallest step may stand in any block
    scree_work_sums launched[2], smallest = work.sums[0];
    SCREE_CHECK_INT(num_blocks, 2);
    work.ids = work.places = reversed;
    scree_work_launch(work, num_blocks);
    memcpy(launched, work.sums, sizeof launched);
    for (int64_t k = 0; k < num_blocks; ++k) scree_work_at(work, k);
    for (int k = 0; k < 2; ++k)
        SCREE_CHECK(launched[k].damping == work.sums[k].damping && launched[k].friction == work.sums[k].friction &&
                    launched[k].hysteresis == work.sums[k].hysteresis && launched[k].input == work.sums[k].input);
    SCREE_CHECK(launched[0].damping != smallest.damping && launched[1].input != 0);
    for (int k = 0; k < 2; ++k)
        smallest.smallest_step_squared = scree_min(smallest.smallest_step_squared, work.sums[k].smallest_step_squared);
    SCREE_CHECK(smallest.smallest_step_squared ==
                scree_min(launched[0].smallest_step_squared, launched[1].smallest_step_squared));
}

static void test_history(void)
{
    const scree_step_buffers *b = s->buffers;
    const scree_contact_list *now = &s->contacts, *old = &s->old_contacts;
    const size_t num_bodies = (size_t)(s->particles.num_particles + s->num_walls);
    scree_history_match_args match;
    match.pairs = s->broad_phase.pairs;
    match.first_of_pair = now->first_of_pair;
    match.old_first_of_pair = old->first_of_pair;
    match.old_groups = (scree_pair_groups){&old->bodies->i, &old->bodies->j,           NULL, 2, old->num_contacts,
                                           b->old_groups,   b->old_groups + num_bodies};
    memset(b->old_groups, 0, 2 * num_bodies * sizeof *b->old_groups);
    scree_group_bounds_launch(match.old_groups, old->num_contacts);
    match.patch = now->patch;
    match.old_patch = old->patch;
    match.arm = now->arm;
    match.old_arm = old->arm;
    match.old_of_contact = b->old_of_contact;
    match.is_continued = b->is_continued;
    for (int k = 0; k < 2; ++k)
    {
        if (k == 1) match.old_first_of_pair = NULL;
        memset(b->is_continued, 0, (size_t)old->num_contacts);
        output matched[] = {OUTPUT(b->old_of_contact, now->num_contacts), OUTPUT(b->is_continued, old->num_contacts)};
        COMPARE(scree_history_match, match, s->broad_phase.num_pairs, matched);
    }
}

int main(void)
{
    SCREE_RUN(test_turning);
    scene_run_start(&run, scene_text);
    s = run.simulation;
    if (s != NULL)
    {
        // a step whose candidate pairs are those of the step before
        scene_run_until(&run, 0.06);
        while (s->buffers->searched_step == s->step) scene_run_until(&run, (double)(s->step + 1) * s->time_step);
        SCREE_RUN(test_history);
        SCREE_RUN(test_forces);
        SCREE_RUN(test_sums);
        SCREE_RUN(test_motion);
    }
    scene_run_end(&run);
    return SCREE_TEST_END();
}
