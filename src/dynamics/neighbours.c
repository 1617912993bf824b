/// \file neighbours.c
/// When to search candidate pairs, and the search. Every box holds its body as long as no point of it has moved by more
/// than the skin; so a pair can only touch while it is among the pairs of the last search.
#include "dynamics/dynamics.h"
#include "dynamics/skin.h"
#include "dynamics/step_buffers.h"

#include <string.h>

/// Largest displacement of bodies begin .. end - 1 since the last search. A maximum does not depend on the order.
static scree_real largest_displacement(const scree_simulation *s, int64_t begin, int64_t end)
{
    const scree_step_buffers *b = s->buffers;
    scree_real largest = 0;
#pragma omp parallel for schedule(static) reduction(max : largest) if (end - begin >= 1024)
    for (int64_t i = begin; i < end; ++i)
    {
        const scree_real moved = scree_displacement(s->shape_views + b->shape[i], b->searched_pose + i, b->pose + i);
        if (!(moved <= largest)) largest = moved;
    }
    return largest;
}

static bool is_search_due(const scree_simulation *s)
{
    scree_step_buffers *b = s->buffers;
    if (!b->has_pairs || !s->scene->solver.reuse_pairs) return true;
    for (int32_t w = 0; w < s->num_walls; ++w)
        if (s->walls[w].is_present != b->broad_phase_walls[w].is_present) return true;
    const int64_t num = s->particles.num_particles;
    b->moved = largest_displacement(s, 0, num) + largest_displacement(s, num, num + s->num_walls);
    return !(b->moved <= b->skin);
}

/// Adds the way of this step to the travels of all bodies.
static void add_travel(scree_simulation *s)
{
    scree_step_buffers *b = s->buffers;
    const int64_t num_bodies = s->particles.num_particles + s->num_walls;
#pragma omp parallel for schedule(static) if (num_bodies >= 1024)
    for (int64_t i = 0; i < num_bodies; ++i)
    {
        b->travel[i] += scree_displacement(s->shape_views + b->shape[i], b->last_pose + i, b->pose + i);
        b->last_pose[i] = b->pose[i];
    }
}

scree_status scree_update_neighbours(scree_simulation *simulation)
{
    scree_step_buffers *b = simulation->buffers;
    if (b->has_travel) add_travel(simulation);
    const bool is_due = is_search_due(simulation);
    scree_stage_end(&simulation->clock, SCREE_STAGE_TRAVEL);
    if (!is_due) return SCREE_OK;
    scree_skin_adapt(simulation);
    const int64_t num_particles = simulation->particles.num_particles;

    scree_boxes_args boxes;
    boxes.shapes = simulation->shape_views;
    boxes.shape = b->shape;
    boxes.pose = b->pose;
    boxes.skin = b->skin;
    boxes.boxes = b->boxes;
    boxes.centres = b->centres;
    boxes.radii = b->radii;
    scree_boxes_launch(boxes, num_particles);

    for (int32_t w = 0; w < simulation->num_walls; ++w)
    {
        b->broad_phase_walls[w].tree = simulation->shape_views[b->shape[num_particles + w]].tree;
        b->broad_phase_walls[w].pose = simulation->walls[w].pose;
        b->broad_phase_walls[w].is_present = simulation->walls[w].is_present;
    }

    scree_broad_phase_input input;
    input.boxes = b->boxes;
    input.centres = b->centres;
    input.radii = b->radii;
    input.compares_spheres = simulation->scene->solver.compare_spheres;
    input.walls = b->broad_phase_walls;
    input.num_particles = num_particles;
    input.num_walls = simulation->num_walls;
    const scree_status status = scree_broad_phase_find(&simulation->broad_phase, &input);
    if (status != SCREE_OK) return status;

    scree_narrow_phase_forget(&simulation->narrow_phase);
    memset(b->travel, 0, (size_t)(num_particles + simulation->num_walls) * sizeof *b->travel);
    memcpy(b->searched_pose, b->pose, (size_t)(num_particles + simulation->num_walls) * sizeof *b->pose);
    b->has_pairs = true;
    b->searched_step = simulation->step;
    b->is_old_list_of_same_pairs = false;
    ++simulation->counters.num_rebuilds;
    simulation->counters.num_pairs = simulation->broad_phase.num_pairs;
    scree_stage_end(&simulation->clock, SCREE_STAGE_SEARCH);
    return SCREE_OK;
}
