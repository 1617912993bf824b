#include "dynamics/places.h"

#include "contact/history.h"
#include "core/permute.h"
#include "dynamics/dynamics.h"
#include "dynamics/step_buffers.h"

enum
{
    FEW = 4096,      ///< particles whose data fit into a core's second cache, in whatever order
    FAR_SHARE = 4,   ///< particles may have mixed if the followers of more than one in so many are far away
    GAIN = 2,        ///< and have if these are so many times as many as they were along the curve
    SHORT_STAY = 100 ///< [steps] that changing places, coming home and two searches may cost
};

void scree_places_start(scree_simulation *simulation)
{
    scree_places *p = &simulation->buffers->places;
    p->are_kept = !simulation->scene->solver.reorder_particles;
    p->are_ids = true;
    p->few = FEW;
}

void scree_places_destroy(scree_places *places, scree_device *device)
{
    scree_device_free(device, places->ids);
    scree_device_free(device, places->places);
    scree_device_free(device, places->order);
    scree_device_free(device, places->moved_to);
    scree_device_free(device, places->spare_ids);
    scree_device_free(device, places->num_far);
    scree_device_free(device, places->scratch);
    scree_scan_destroy(&places->scan);
    *places = (scree_places){.are_kept = places->are_kept, .are_ids = true, .few = places->few};
}

const int32_t *scree_ids(const scree_simulation *simulation)
{
    const scree_places *p = &simulation->buffers->places;
    return p->are_ids ? NULL : p->ids;
}

const int32_t *scree_places_of_ids(const scree_simulation *simulation)
{
    const scree_places *p = &simulation->buffers->places;
    return p->are_ids ? NULL : p->places;
}

static int64_t count_bodies(const scree_simulation *s) { return s->particles.num_particles + s->num_walls; }

/// Arrays of the first time, with all bodies home.
static scree_status allocate(const scree_simulation *s)
{
    scree_places *p = &s->buffers->places;
    scree_device *device = s->device;
    if (p->scratch != NULL) return SCREE_OK;
    const int64_t num = count_bodies(s);
    int32_t **const arrays[] = {&p->ids, &p->places, &p->order, &p->moved_to, &p->spare_ids};
    bool is_complete = true;
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k)
    {
        *arrays[k] = scree_device_alloc(device, num, sizeof **arrays[k]);
        is_complete = is_complete && *arrays[k] != NULL;
    }
    p->scan.device = device;
    is_complete = is_complete && scree_scan_reserve(&p->scan, num) == SCREE_OK;
    if (is_complete) p->scratch = scree_device_alloc(device, num, sizeof(scree_pose));
    if (!is_complete || p->scratch == NULL)
    {
        scree_places_destroy(p, device);
        return SCREE_OUT_OF_MEMORY;
    }
    const scree_home_order_args args = {p->ids, p->places, p->order};
    scree_home_order_launch_on(device, args, num);
    return SCREE_OK;
}

scree_status scree_ask_for_places(scree_simulation *simulation, const int32_t *order)
{
    scree_places *p = &simulation->buffers->places;
    const scree_status status = allocate(simulation);
    if (status != SCREE_OK) return status;
    // walls keep theirs
    const size_t num = (size_t)simulation->particles.num_particles;
    scree_device_copy(simulation->device, p->order, order, num * sizeof *p->order);
    p->is_due = simulation->buffers->is_search_asked = true;
    return SCREE_OK;
}

/// Particles that the next one is far from in space: in memory, or in this order.
static int64_t count_far(const scree_simulation *s, const scree_broad_phase_input *input, const int32_t *order)
{
    const int64_t num = s->particles.num_particles;
    int64_t *count = s->buffers->places.num_far, num_far = 0;
    scree_device_zero(s->device, count, sizeof *count);
    const scree_far_followers_args args = {input->centres, input->radii, order, num, count};
    scree_far_followers_launch_on(s->device, args, (num + SCREE_FAR_BLOCK - 1) / SCREE_FAR_BLOCK);
    scree_device_read(s->device, &num_far, count, sizeof num_far);
    return num_far;
}

void scree_compare_places(scree_simulation *simulation, const scree_broad_phase_input *input)
{
    scree_places *p = &simulation->buffers->places;
    const int64_t num = simulation->particles.num_particles;
    if (p->are_kept || p->has_short_stay || num <= p->few) return;
    if (p->num_far == NULL) p->num_far = scree_device_alloc(simulation->device, 1, sizeof *p->num_far);
    if (p->num_far == NULL) return;
    const int64_t num_far = count_far(simulation, input, NULL);
    if (num_far * FAR_SHARE <= num) return;
    // few neighbours are near if there is much space between all
    const int32_t *curve = scree_lbvh_order(&simulation->broad_phase.tree);
    if (count_far(simulation, input, curve) * GAIN > num_far) return;
    // without memory for it they stay where they are
    scree_ask_for_places(simulation, curve);
}

/// The body in place order[k] to place k, for all places; pairs and contacts follow.
static void move_bodies(scree_simulation *s)
{
    scree_step_buffers *b = s->buffers;
    scree_places *p = &b->places;
    scree_device *device = s->device;
    const int64_t num = s->particles.num_particles;
#define SCREE_MOVE(array) scree_permute(device, array, sizeof *(array), p->order, num, p->scratch);
    SCREE_MOVE(b->pose)
    SCREE_MOVE(b->moving)
    SCREE_MOVE(b->inverse_radius)
    SCREE_MOVE(b->shape)
    SCREE_MOVE(b->searched_pose)
    SCREE_MOVE(b->travel)
#undef SCREE_MOVE
    scree_particles_permute(device, &s->particles, p->order, p->scratch);
    const scree_new_places_args args = {p->order, p->ids, p->spare_ids, p->places, p->moved_to};
    scree_new_places_launch_on(device, args, count_bodies(s));
    int32_t *old_ids = p->ids;
    p->ids = p->spare_ids;
    p->spare_ids = old_ids;
    const scree_move_pairs_args pairs = {s->broad_phase.pairs, p->moved_to};
    scree_move_pairs_launch_on(device, pairs, s->broad_phase.num_pairs);
    const scree_move_pairs_args contacts = {s->contacts.bodies, p->moved_to};
    scree_move_pairs_launch_on(device, contacts, s->contacts.num_contacts);
}

void scree_change_places(scree_simulation *simulation)
{
    scree_places *p = &simulation->buffers->places;
    if (!p->is_due) return;
    p->is_due = p->are_ids = false;
    move_bodies(simulation);
}

/// Contacts to the order of their bodies, which are home. Old ones are not needed any more.
static void sort_contacts(scree_simulation *s)
{
    scree_step_buffers *b = s->buffers;
    scree_device *device = s->device;
    scree_contact_list *list = &s->contacts;
    const int64_t num = list->num_contacts, num_bodies = count_bodies(s);
    if (num == 0) return;
    int32_t *order = b->old_of_contact;
    void *scratch = s->old_contacts.spring_force;
    const scree_pair_groups groups = {&list->bodies->i, &list->bodies->j,          NULL, 2, num,
                                      b->old_groups,    b->old_groups + num_bodies};
    scree_device_zero(device, b->old_groups, (size_t)num_bodies * 2 * sizeof *b->old_groups);
    scree_group_bounds_launch_on(device, groups, num);
    // what is known of places is not needed any more
    const scree_sort_groups_args args = {groups.begin, groups.end, b->places.moved_to, order};
    scree_group_sizes_launch_on(device, args, num_bodies);
    scree_scan_on(&b->places.scan, args.first, num_bodies - 1);
    scree_sort_groups_launch_on(device, args, num_bodies);
    scree_contact_list_permute(list, order, scratch);
    scree_collisions_permute(&s->averages.collisions, order, scratch);
}

scree_status scree_bring_home(scree_simulation *simulation)
{
    scree_simulation *s = simulation;
    scree_step_buffers *b = s->buffers;
    if (b == NULL) return SCREE_OK; // nothing has been stepped
    scree_places *p = &b->places;
    if (s->step > p->looked_step) p->has_short_stay = s->step - p->looked_step < SHORT_STAY;
    p->looked_step = s->step;
    p->is_due = false;
    if (p->are_ids) return SCREE_OK;
    // the list of the step before may be the smaller one; all memory comes first, then nothing can fail half-way
    const scree_status status = scree_contact_list_reserve(&s->old_contacts, s->contacts.num_contacts, 0);
    if (status != SCREE_OK) return status;
    scree_device_copy(s->device, p->order, p->places, (size_t)count_bodies(s) * sizeof *p->order);
    move_bodies(s);
    p->are_ids = true;
    b->is_search_asked = true;
    sort_contacts(s);
    return SCREE_OK;
}
