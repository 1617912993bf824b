/// \file neighbours.c
/// When to search candidate pairs, and the search. Every box holds its body as long as no point of it has moved by more
/// than the skin; so a pair can only touch while it is among the pairs of the last search.
#include "dynamics/dynamics.h"
#include "dynamics/skin.h"
#include "dynamics/step_buffers.h"

static scree_travel_args travel_args(const scree_simulation *s)
{
    const scree_step_buffers *b = s->buffers;
    scree_travel_args args;
    args.shapes = s->shape_views;
    args.shape = b->shape;
    args.pose = b->pose;
    args.searched_pose = b->searched_pose;
    args.num_particles = s->particles.num_particles;
    args.particles_moved = &b->tally->particles_moved;
    args.walls_moved = &b->tally->walls_moved;
    return args;
}

void scree_follow_bodies(const scree_simulation *simulation)
{
    const int64_t num_bodies = simulation->particles.num_particles + simulation->num_walls;
    scree_travel_launch_on(simulation->device, travel_args(simulation), num_bodies);
}

bool scree_have_walls_changed(const scree_simulation *simulation)
{
    for (int32_t w = 0; w < simulation->num_walls; ++w)
        if (simulation->walls[w].is_present != simulation->buffers->wall_input[w].is_present) return true;
    return false;
}

bool scree_is_search_due(scree_simulation *simulation)
{
    scree_step_buffers *b = simulation->buffers;
    if (!b->has_pairs || !simulation->scene->solver.reuse_pairs) return true;
    scree_follow_bodies(simulation);
    if (scree_have_walls_changed(simulation) || b->is_search_asked) return true;
    scree_maximum moved[2] = {{0}, {0}};
    scree_device_read(simulation->device, moved, &b->tally->particles_moved, sizeof moved);
    b->moved = scree_moved_apart(moved[0], moved[1]);
    return scree_leaves_skin(b->moved, b->skin);
}

/// Boxes and bounding spheres of the particles, in the memory that contacts give up for the search.
static scree_status place_boxes(scree_simulation *s, scree_boxes_args *boxes)
{
    const scree_step_buffers *b = s->buffers;
    const int64_t num = s->particles.num_particles;
    scree_contact_list_lend(&s->contacts, &s->scratch);
    s->broad_phase.scratch = &s->scratch;
    const scree_status status = scree_scratch_begin(&s->scratch, 0);
    if (status != SCREE_OK) return status;
    boxes->shapes = s->shape_views;
    boxes->shape = b->shape;
    boxes->pose = b->pose;
    boxes->skin = b->skin;
    boxes->boxes = scree_scratch_take(&s->scratch, num, sizeof *boxes->boxes);
    boxes->centres = scree_scratch_take(&s->scratch, num, sizeof *boxes->centres);
    boxes->radii = scree_scratch_take(&s->scratch, num, sizeof *boxes->radii);
    if (boxes->boxes == NULL || boxes->centres == NULL || boxes->radii == NULL) return SCREE_OUT_OF_MEMORY;
    scree_boxes_launch_on(s->device, *boxes, num);
    return SCREE_OK;
}

scree_status scree_search_neighbours(scree_simulation *simulation)
{
    scree_step_buffers *b = simulation->buffers;
    scree_device *device = simulation->device;
    scree_skin_adapt(simulation);
    const int64_t num_particles = simulation->particles.num_particles;
    const int64_t num_bodies = num_particles + simulation->num_walls;

    scree_boxes_args boxes;
    scree_status status = place_boxes(simulation, &boxes);
    if (status != SCREE_OK) return status;

    for (int32_t w = 0; w < simulation->num_walls; ++w)
    {
        b->wall_input[w].pose = simulation->walls[w].pose;
        b->wall_input[w].is_present = simulation->walls[w].is_present;
    }
    scree_device_write(device, b->broad_phase_walls, b->wall_input,
                       (size_t)simulation->num_walls * sizeof *b->wall_input);

    scree_broad_phase_input input;
    input.boxes = boxes.boxes;
    input.centres = boxes.centres;
    input.radii = boxes.radii;
    input.compares_spheres = simulation->scene->solver.compare_spheres;
    input.walls = b->broad_phase_walls;
    input.num_particles = num_particles;
    input.num_walls = simulation->num_walls;
    input.ids = scree_ids(simulation);
    input.places = scree_places_of_ids(simulation);
    const scree_bodies bodies = scree_step_bodies(simulation);
    if (!b->has_pairs || !simulation->scene->solver.reuse_pairs) scree_narrow_phase_forget(&simulation->narrow_phase);
    else scree_narrow_phase_carry(&simulation->narrow_phase, &bodies, simulation->broad_phase.pairs);
    status = scree_broad_phase_find(&simulation->broad_phase, &input);
    if (status != SCREE_OK) return status;

    scree_device_zero(device, b->travel, (size_t)num_bodies * sizeof *b->travel);
    scree_device_copy(device, b->searched_pose, b->pose, (size_t)num_bodies * sizeof *b->pose);
    b->has_pairs = true;
    b->is_search_asked = false;
    b->searched_step = simulation->step;
    b->is_old_list_of_same_pairs = false;
    ++simulation->counters.num_rebuilds;
    simulation->counters.num_pairs = simulation->broad_phase.num_pairs;
    scree_compare_places(simulation, &input);
    scree_stage_end(&simulation->clock, SCREE_STAGE_SEARCH);
    return SCREE_OK;
}
