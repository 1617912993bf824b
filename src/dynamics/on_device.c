#include "dynamics/on_device.h"

#include "contact/overlap_pairs_kernel.h"
#include "dynamics/plan.h"
#include "dynamics/step_buffers.h"
#include "polyhedra/shape_copy.h"

#include <stdlib.h>
#include <string.h>

/// What a GPU is expected to hold at least: a dense bed.
enum
{
    BED_PAIRS = 8,    ///< candidates per particle
    BED_CONTACTS = 4, ///< contacts per particle
    MAX_PIECES = 64,  ///< of an overlap, to begin with
    MAX_SHAPE = 1024
};

/// Arrays grow by a quarter.
#define SLACK 1.25

// ---- memory

/// Classes that pairs of its shapes may be of.
static scree_work_classes classes_of(const scree_simulation *here)
{
    int32_t least = INT32_MAX / 2, most = 0;
    for (int32_t k = 0; k < here->num_shapes; ++k)
    {
        const scree_shape_view *shape = here->shape_views + k;
        if (shape->kind != SCREE_KIND_MESH) continue;
        if (shape->num_triangles < least) least = shape->num_triangles;
        if (shape->num_triangles > most) most = shape->num_triangles;
    }
    const scree_work_classes none = {0, 0};
    const scree_work_classes classes = {scree_work_class(2 * least), scree_work_class(2 * most)};
    return most > 0 ? classes : none;
}

/// Most triangles of a shape of particles or walls.
static int32_t largest_shape(const scree_simulation *here)
{
    int32_t largest = 8;
    for (int32_t k = 0; k < 2 * here->num_shapes; ++k)
        if (here->shape_views[k].num_triangles > largest) largest = here->shape_views[k].num_triangles;
    return largest;
}

/// Room of an overlap that most pairs of these shapes get along with; more is made where it is needed.
static scree_overlap_room choose_room(int32_t largest)
{
    // shapes that are gone through as a whole need one more than they have triangles
    const int32_t max_pieces = largest < MAX_PIECES ? largest + 1 : MAX_PIECES;
    const scree_overlap_room room = {max_pieces, largest < MAX_SHAPE ? largest : MAX_SHAPE, max_pieces};
    return room;
}

/// Memory [bytes] that overlaps will work in; 0 if there are no meshes among the particles.
static int64_t overlap_bytes(const scree_simulation *here, scree_device *device)
{
    bool has_meshes = false;
    for (int32_t k = 0; k < here->num_shapes; ++k) has_meshes |= here->shape_views[k].kind == SCREE_KIND_MESH;
    if (!has_meshes) return 0;
    const scree_narrow_phase there = {.device = device,
                                      .room = choose_room(largest_shape(here)),
                                      .classes = classes_of(here),
                                      .options = here->narrow_phase.options};
    return scree_narrow_phase_overlap_bytes(&there);
}

scree_device_memory scree_device_memory_of(const scree_simulation *simulation)
{
    scree_device_memory memory;
    const int64_t num = simulation->particles.num_particles, num_pairs = simulation->counters.num_pairs,
                  num_contacts = simulation->counters.num_contacts;
    memory.num_pairs = num_pairs > BED_PAIRS * num ? num_pairs : BED_PAIRS * num;
    memory.num_contacts = num_contacts > BED_CONTACTS * num ? num_contacts : BED_CONTACTS * num;
    const scree_plan_bytes bytes =
        scree_plan_added_up(scree_simulation_plan_bytes(simulation), num, memory.num_pairs, memory.num_contacts);
    // a list of active pairs for each class after the first
    const scree_work_classes classes = classes_of(simulation);
    const size_t lists = (size_t)(classes.last - classes.first) * sizeof(int32_t);
    memory.per_particle = (int64_t)(bytes.state + bytes.search);
    memory.per_pair = (int64_t)(SLACK * (double)((size_t)scree_plan_largest_pair(&bytes) + lists));
    // accounts of collisions now and in the step before, places and what comes to the host of those that have ended
    const size_t collision =
        simulation->averages.num_bins > 0 ? 4 * sizeof(double) + sizeof(int64_t) + sizeof(scree_ended_collision) : 0;
    memory.per_contact = (int64_t)(SLACK * (double)(bytes.contact + 2 * sizeof(scree_contact_side) + collision));
    memory.shapes = bytes.shapes;
    memory.total = memory.shapes + memory.per_particle * num + memory.per_pair * memory.num_pairs +
                   memory.per_contact * memory.num_contacts;
    return memory;
}

int64_t scree_num_that_fit(const scree_device_memory *memory, int64_t num_particles, int64_t num_free)
{
    const double left = (double)(num_free - memory->shapes);
    return left > 0 ? (int64_t)((double)num_particles * left / (double)(memory->total - memory->shapes)) : 0;
}

// ---- to the device

/// A copy of `num` items on the device; NULL: out of memory.
static void *copy(scree_device *device, const void *from, int64_t num, size_t size)
{
    void *to = scree_device_alloc(device, num > 0 ? num : 1, size);
    if (to != NULL) scree_device_write(device, to, from, (size_t)num * size);
    return to;
}

/// Shapes of particles and walls; the trees of the walls to the search.
static scree_status copy_shapes(scree_simulation *there, const scree_simulation *here)
{
    const int32_t num = 2 * here->num_shapes;
    scree_shape_view *views = calloc((size_t)num + 1, sizeof *views);
    if (views == NULL) return SCREE_OUT_OF_MEMORY;
    there->views_here = views;
    scree_status status = SCREE_OK;
    for (int32_t k = 0; k < num && status == SCREE_OK; ++k)
        status = scree_shape_view_copy(there->device, views + k, here->shape_views + k);
    if (status != SCREE_OK) return status;
    there->shape_views = copy(there->device, views, num, sizeof *views);
    return there->shape_views != NULL ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

/// The arrays over bodies.
static scree_status copy_buffers(scree_simulation *there, const scree_simulation *here)
{
    const scree_step_buffers *from = here->buffers;
    const int64_t num_particles = here->particles.num_particles, num_walls = here->num_walls;
    const int64_t num_bodies = num_particles + num_walls;
    scree_device *device = there->device;
    scree_step_buffers *b = calloc(1, sizeof *b);
    if (b == NULL) return SCREE_OUT_OF_MEMORY;
    there->buffers = b;
    b->device = device;
    b->has_travel = from->has_travel;
    b->skin = from->skin;
    b->mean_radius = from->mean_radius;
    scree_places_start(there);
    b->places.few = from->places.few;
    b->first_unstable = -1;
    bool is_complete = true;
#define SCREE_COPY(array, num)                                   \
    b->array = copy(device, from->array, num, sizeof *b->array); \
    is_complete = is_complete && b->array != NULL;
    SCREE_COPY(pose, num_bodies)
    SCREE_COPY(moving, num_bodies)
    SCREE_COPY(inverse_radius, num_bodies)
    SCREE_COPY(shape, num_bodies)
    SCREE_COPY(searched_pose, num_bodies)
    SCREE_COPY(travel, num_bodies)
    SCREE_COPY(old_groups, 2 * num_bodies)
#undef SCREE_COPY
    b->broad_phase_walls = scree_device_alloc(device, num_walls + 1, sizeof *b->broad_phase_walls);
    b->wall_input = calloc((size_t)num_walls + 1, sizeof *b->wall_input);
    if (!is_complete || b->broad_phase_walls == NULL || b->wall_input == NULL ||
        scree_step_board_create(b, num_particles, num_walls) != SCREE_OK)
        return SCREE_OUT_OF_MEMORY;
    for (int64_t w = 0; w < num_walls; ++w)
        b->wall_input[w].tree = there->views_here[from->shape[num_particles + w]].tree;
    return scree_wall_axes_create(there);
}

static scree_status move(scree_simulation *there, scree_simulation *here)
{
    scree_device *device = there->device;
    there->contacts.device = there->old_contacts.device = there->scratch.device = device;
    there->old_contacts.is_history = true;
    scree_contact_list_share_uses(&there->old_contacts, &here->contacts);
    there->broad_phase.device = there->narrow_phase.device = there->clock.device = device;
    there->clock.times = here->clock.times;
    there->narrow_phase.options = here->narrow_phase.options;
    there->narrow_phase.separation = here->narrow_phase.separation;
    there->narrow_phase.room = choose_room(largest_shape(here));
    there->narrow_phase.classes = classes_of(here);
    scree_status status = scree_particles_copy(device, &there->particles, &here->particles);
    if (status == SCREE_OK) status = copy_shapes(there, here);
    if (status == SCREE_OK) status = copy_buffers(there, here);
    if (status == SCREE_OK) there->narrow_phase.tally = &there->buffers->board->pairs;
    if (status == SCREE_OK) status = scree_contact_list_copy(&there->contacts, &here->contacts);
    if (status == SCREE_OK)
    {
        const int64_t num_laws = (int64_t)here->num_materials * here->num_materials;
        there->laws = copy(device, here->laws, num_laws, sizeof *here->laws);
        if (there->laws == NULL) status = SCREE_OUT_OF_MEMORY;
    }
    there->averages.collisions.device = there->averages.old_collisions.device = device;
    if (status == SCREE_OK && here->averages.num_bins > 0)
        status = scree_collisions_copy(&there->averages.collisions, &here->averages.collisions);
    return status;
}

/// Refused if it is clear beforehand that memory will not do; otherwise it is taken now.
static scree_status take_memory(const scree_simulation *s, scree_device *device, scree_report *report)
{
    const scree_device_memory memory = scree_device_memory_of(s);
    const int64_t num_free = scree_device_free_memory(device);
    if (memory.total <= num_free)
    {
        // buffers of overlaps get along with what is left
        const int64_t left = num_free - memory.total, overlaps = overlap_bytes(s, device);
        if (scree_device_take(device, memory.total + (overlaps < left ? overlaps : left))) return SCREE_OK;
    }
    scree_report_add(
        report,
        "GPU \"%s\" has %.0f MB of free memory, the scene needs about %.0f MB (%lld particles of %lld "
        "bytes, %lld candidate pairs of %lld, %lld contacts of %lld, shapes of %.0f MB): take fewer particles (about "
        "%lld would fit), another GPU, or run on the CPU",
        scree_device_name(device), (double)num_free / 1e6, (double)memory.total / 1e6,
        (long long)s->particles.num_particles, (long long)memory.per_particle, (long long)memory.num_pairs,
        (long long)memory.per_pair, (long long)memory.num_contacts, (long long)memory.per_contact,
        (double)memory.shapes / 1e6, (long long)scree_num_that_fit(&memory, s->particles.num_particles, num_free));
    return SCREE_OUT_OF_MEMORY;
}

scree_status scree_simulation_use_device(scree_simulation *simulation, scree_device *device, scree_report *report)
{
    if (device == NULL || simulation->there != NULL) return SCREE_INVALID_INPUT;
    scree_status status = scree_bring_home(simulation);
    if (status == SCREE_OK) status = take_memory(simulation, device, report);
    if (status != SCREE_OK) return status;
    scree_simulation *there = calloc(1, sizeof *there);
    if (there == NULL) return SCREE_OUT_OF_MEMORY;
    // numbers, and what stays on the host; the arrays are replaced one after the other
    there->device = device;
    there->scene = simulation->scene;
    there->num_shapes = simulation->num_shapes;
    there->num_materials = simulation->num_materials;
    there->num_walls = simulation->num_walls;
    there->time_step = simulation->time_step;
    there->step = simulation->step;
    there->walls = simulation->walls;
    there->wall_loads = simulation->wall_loads;
    there->energies = simulation->energies;
    there->counters = simulation->counters;
    simulation->there = there;
    status = move(there, simulation);
    const scree_status state_of_device = scree_device_status(device, report);
    if (state_of_device != SCREE_OK) status = state_of_device;
    if (status != SCREE_OK)
    {
        if (status == SCREE_OUT_OF_MEMORY)
            scree_report_add(report,
                             "GPU \"%s\" has no memory for the state: take fewer particles, another GPU, or run "
                             "on the CPU",
                             scree_device_name(device));
        scree_leave_device(simulation);
        return status;
    }
    // the step's own arrays are not needed here any more
    scree_places_destroy(&simulation->buffers->places, NULL);
    scree_contact_list_destroy(&simulation->old_contacts);
    scree_broad_phase_destroy(&simulation->broad_phase);
    const scree_narrow_phase kept = simulation->narrow_phase;
    scree_narrow_phase_destroy(&simulation->narrow_phase);
    simulation->narrow_phase.options = kept.options;
    simulation->narrow_phase.separation = kept.separation;
    simulation->observed_step = simulation->step;
    return SCREE_OK;
}

// ---- from the device

void scree_take_from_device(scree_simulation *simulation)
{
    const scree_simulation *there = simulation->there;
    simulation->step = there->step;
    simulation->energies = there->energies;
    simulation->counters = there->counters;
}

scree_status scree_simulation_observe(scree_simulation *simulation, scree_report *report)
{
    scree_simulation *there = scree_simulation_there(simulation);
    scree_status status = scree_bring_home(there);
    if (status != SCREE_OK) scree_report_add(report, "there is no memory to look at the state of a step");
    if (status != SCREE_OK || simulation->there == NULL || simulation->observed_step == simulation->step) return status;
    scree_particles_read(there->device, &simulation->particles, &there->particles);
    status = scree_contact_list_copy(&simulation->contacts, &there->contacts);
    if (status == SCREE_OK && simulation->averages.num_bins > 0)
        status = scree_collisions_copy(&simulation->averages.collisions, &there->averages.collisions);
    const scree_status state_of_device = scree_device_status(there->device, report);
    if (state_of_device != SCREE_OK) return state_of_device;
    if (status == SCREE_OK) simulation->observed_step = simulation->step;
    return status;
}

void scree_leave_device(scree_simulation *simulation)
{
    scree_simulation *there = simulation->there;
    if (there == NULL) return;
    scree_device *device = there->device;
    scree_step_buffers_destroy(there);
    scree_particles_free(device, &there->particles);
    scree_contact_list_destroy(&there->contacts);
    scree_contact_list_destroy(&there->old_contacts);
    scree_broad_phase_destroy(&there->broad_phase);
    scree_narrow_phase_destroy(&there->narrow_phase);
    scree_scratch_destroy(&there->scratch);
    scree_collisions_destroy(&there->averages.collisions);
    scree_destroy_collision_scratch(&there->averages, device);
    for (int32_t k = 0; there->views_here != NULL && k < 2 * there->num_shapes; ++k)
        scree_shape_view_destroy(device, there->views_here + k);
    free(there->views_here);
    scree_device_free(device, there->shape_views);
    scree_device_free(device, there->laws);
    free(there);
    simulation->there = NULL;
}
