/// \file made_simulation.h
/// A simulation made by hand, without the step: two tetrahedra and a box, two walls, contacts between them. For tests
/// of what is written and read.
#ifndef SCREE_MADE_SIMULATION_H
#define SCREE_MADE_SIMULATION_H

#include "harness.h"

#include "dynamics/state.h"

#include <stdlib.h>

static const scree_vec3 made_tetrahedron_vertices[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const scree_triangle made_tetrahedron_triangles[4] = {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}};
static const scree_vec3 made_box_vertices[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                                {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
static const scree_triangle made_box_triangles[12] = {{{0, 2, 1}}, {{0, 3, 2}}, {{4, 5, 6}}, {{4, 6, 7}},
                                                      {{0, 1, 5}}, {{0, 5, 4}}, {{1, 2, 6}}, {{1, 6, 5}},
                                                      {{2, 3, 7}}, {{2, 7, 6}}, {{3, 0, 4}}, {{3, 4, 7}}};

enum
{
    MADE_PARTICLES = 3,
    MADE_WALLS = 2,
    MADE_VERTICES = 4 + 8 + 4,
    MADE_TRIANGLES = 4 + 12 + 4
};

/// Owns everything; the simulation inside borrows the scene.
typedef struct made_simulation
{
    scree_simulation simulation;
    scree_scene scene;
    scree_wall_def wall_defs[MADE_WALLS];
    scree_wall_state walls[MADE_WALLS];
    scree_shape shapes[2];
    scree_shape_view views[4];
    scree_force_law law;
} made_simulation;

static inline scree_shape_view made_view(bool is_box)
{
    scree_shape_view view = {0};
    view.vertices = is_box ? made_box_vertices : made_tetrahedron_vertices;
    view.triangles = is_box ? made_box_triangles : made_tetrahedron_triangles;
    view.num_vertices = is_box ? 8 : 4;
    view.num_triangles = is_box ? 12 : 4;
    return view;
}

/// Contacts between the first particles and of a particle with wall 1, with numbers that tell where they belong.
static inline void made_simulation_set_contacts(made_simulation *made, int64_t num_contacts)
{
    scree_contact_list *c = &made->simulation.contacts;
    SCREE_CHECK_INT(scree_contact_list_reserve(c, num_contacts + 1, 4), SCREE_OK);
    for (int64_t k = 0; k < num_contacts; ++k)
    {
        const double x = 1 + (double)k / 7;
        // many patches of the pair (0, 1), then one contact with wall 1
        const bool is_wall = k > 0 && k + 1 == num_contacts;
        c->bodies[k] = (scree_candidate_pair){is_wall ? 2 : 0, is_wall ? MADE_PARTICLES + 1 : 1};
        c->patch[k] = is_wall ? 0 : (int32_t)k;
        c->volume[k] = (scree_real)(x * 1e-9);
        c->indentation[k] = (scree_real)(x * 1e-4);
        c->radius[k] = (scree_real)(x * 1e-3);
        c->normal[k] = scree_vec3_make(0, 0, 1);
        c->area_vector[k] = scree_vec3_make(0, 0, (scree_real)-x);
        c->torque_vector[k] = scree_vec3_make((scree_real)x, 0, 1);
        c->arm[k] = scree_vec3_make((scree_real)x, 0, -1);
        c->normal_force[k] = scree_vec3_make(0, 0, (scree_real)(10 * x));
        c->tangential_force[k] = scree_vec3_make((scree_real)(3 * x), (scree_real)(4 * x), 0);
        c->elastic_force[k] = (scree_real)(9 * x);
        c->moment[k] = scree_vec3_make(0, (scree_real)x, 2);
        c->elastic_work[k] = (scree_real)(x / 3);
        c->spring_work[k] = (scree_real)(x / 5);
        c->is_slipping[k] = k % 2 == 0;
        c->is_turning[k] = k % 3 == 0;
        c->spring_force[k] = scree_vec3_make((scree_real)(2 * x), 0, 0);
        c->tangential_stiffness[k] = (scree_real)(1e5 * x);
        c->torsion[k] = (scree_real)(x / 9);
        c->rolling_moment[k] = scree_vec3_make(0, (scree_real)(x / 11), 0);
        c->elastic_energy[k] = (scree_real)(x * 1e-3);
        c->spring_energy[k] = (scree_real)(x * 2e-3);
    }
    c->num_contacts = num_contacts;
    made->simulation.counters.num_contacts = num_contacts;
}

/// At `step`, everything moved accordingly.
static inline void made_simulation_set_step(made_simulation *made, int64_t step)
{
    scree_simulation *s = &made->simulation;
    s->step = step;
    for (int k = 0; k < MADE_PARTICLES; ++k)
    {
        const scree_real t = (scree_real)step;
        s->particles.position[k] = scree_vec3_make((scree_real)(10 * k), t, (scree_real)0.1 * t);
        s->particles.orientation[k] = scree_quat_normalize(scree_quat_make(1, (scree_real)0.1 * t, 0, (scree_real)k));
        s->particles.velocity[k] = scree_vec3_make(3 * t, 4 * t, 0);
        s->particles.angular_momentum[k] = scree_vec3_make(0, t, (scree_real)k);
        s->particles.force[k] = scree_vec3_make(t / 3, 0, (scree_real)k);
        s->particles.torque[k] = scree_vec3_make(0, t / 7, (scree_real)k);
    }
    s->energies.friction = 0.25 * (double)step;
    s->counters.num_rebuilds = step / 2;
    s->counters.worst_residual = 1e-12;
}

static inline void made_simulation_create(made_simulation *made)
{
    memset(made, 0, sizeof *made);
    static char name[] = "made", scheme[] = "filtered", first[] = "floor", second[] = "piston";
    made->scene.name = name;
    made->scene.gravity[2] = -9.81;
    made->scene.time.end = 1;
    made->scene.output = (scree_output_def){0.1, 0.1, 0.5};
    made->scene.solver.overlap_scheme = scheme;
    made->wall_defs[0].name = first;
    made->wall_defs[1].name = second;
    for (int w = 0; w < MADE_WALLS; ++w)
    {
        made->wall_defs[w].position[0] = 100 + w;
        made->wall_defs[w].orientation[0] = 1;
        made->wall_defs[w].removed_at = INFINITY;
    }
    made->scene.walls = made->wall_defs;
    made->scene.num_walls = MADE_WALLS;

    scree_simulation *s = &made->simulation;
    s->scene = &made->scene;
    for (int k = 0; k < 4; ++k) made->views[k] = made_view(k % 2 == 1);
    s->shape_views = made->views;
    for (int k = 0; k < 2; ++k) made->shapes[k].properties.volume = k == 0 ? 1.0 / 6 : 1;
    s->particle_shapes = made->shapes;
    s->num_shapes = 2;
    s->num_materials = 1;
    s->laws = &made->law;
    made->law.effective_modulus = (scree_real)1e7;
    s->num_walls = MADE_WALLS;
    s->walls = made->walls;
    for (int w = 0; w < MADE_WALLS; ++w)
    {
        made->walls[w].pose.orientation = scree_quat_identity();
        made->walls[w].pose.position = scree_vec3_make((scree_real)(100 + w), 0, 0);
        made->walls[w].pose.scale = 1;
        made->walls[w].is_present = true;
        made->walls[w].shape = 1;
    }
    s->time_step = 0.01;
    SCREE_CHECK_INT(scree_particles_create(&s->particles, MADE_PARTICLES), SCREE_OK);
    for (int k = 0; k < MADE_PARTICLES; ++k)
    {
        s->particles.shape[k] = k == 1;
        s->particles.scale[k] = (scree_real)(1 + k);
        s->particles.mass[k] = (scree_real)(2 + k);
        s->particles.inertia[k] = scree_vec3_make(1, 2, 3);
        s->particles.group[k] = k / 2;
    }
    s->counters.smallest_critical_step = INFINITY;
    made_simulation_set_step(made, 0);
    made_simulation_set_contacts(made, 0);
}

static inline void made_simulation_destroy(made_simulation *made)
{
    scree_particles_destroy(&made->simulation.particles);
    scree_wall_loads_destroy(&made->simulation.wall_loads);
    scree_contact_list_destroy(&made->simulation.contacts);
}

#endif
