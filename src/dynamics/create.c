/// \file create.c
/// A scene to a simulation at time 0. The scene's own faults (ranges, names) have been refused by its reader; what only
/// shows with meshes and particles in place is refused here.
#include "contact/clump_fill.h"
#include "dynamics/on_device.h"
#include "dynamics/populate.h"
#include "dynamics/skin.h"
#include "dynamics/start_check.h"
#include "dynamics/step_buffers.h"
#include "dynamics/time_step.h"
#include "polyhedra/generate.h"
#include "polyhedra/import.h"
#include "polyhedra/simplify.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int32_t find_material(const scree_scene *scene, const char *name)
{
    for (uint32_t k = 0; k < scene->num_materials; ++k)
        if (strcmp(scene->materials[k].name, name) == 0) return (int32_t)k;
    return -1;
}

static int32_t find_shape(const scree_scene *scene, const char *name)
{
    for (uint32_t k = 0; k < scene->num_shapes; ++k)
        if (strcmp(scene->shapes[k].name, name) == 0) return (int32_t)k;
    return -1;
}

/// Names that the scene's reader has resolved already; checked again so that a scene made in C cannot crash.
static scree_status check_names(const scree_scene *scene, scree_report *report)
{
    const int before = scree_report_num_faults(report);
    bool is_complete = true;
    for (uint32_t g = 0; g < scene->num_particles; ++g)
    {
        const scree_particle_group_def *def = scene->particles + g;
        if (find_shape(scene, def->shape) >= 0 && find_material(scene, def->material) >= 0) continue;
        scree_report_add(report, "particles \"%s\": no shape \"%s\" or no material \"%s\" in the scene", def->name,
                         def->shape, def->material);
        is_complete = false;
    }
    for (uint32_t w = 0; w < scene->num_walls; ++w)
    {
        const scree_wall_def *def = scene->walls + w;
        if (find_shape(scene, def->shape) >= 0 && find_material(scene, def->material) >= 0) continue;
        scree_report_add(report, "wall \"%s\": no shape \"%s\" or no material \"%s\" in the scene", def->name,
                         def->shape, def->material);
        is_complete = false;
    }
    return is_complete && scree_report_num_faults(report) == before ? SCREE_OK : SCREE_INVALID_INPUT;
}

/// True spheres and clumps of them.
static bool is_without_mesh(const scree_shape_def *def)
{
    return def->source == SCREE_SHAPE_CLUMP || (def->source == SCREE_SHAPE_SPHERE && def->triangles == 0);
}

/// Mesh of a shape definition, in its source frame, before it is shifted and repeated.
static scree_status make_one_mesh(scree_mesh *mesh, const scree_shape_def *def, const char *folder,
                                  scree_report *report)
{
    const double diameter = def->size[0];
    scree_status status = SCREE_INVALID_INPUT;
    switch (def->source)
    {
    case SCREE_SHAPE_BOX:
        return scree_generate_box(mesh, def->size);
    case SCREE_SHAPE_TETRAHEDRON:
        return scree_generate_tetrahedron(mesh, 0.5 * diameter);
    case SCREE_SHAPE_SCHOENHARDT:
        return scree_generate_schoenhardt(mesh, 0.5 * diameter);
    case SCREE_SHAPE_SPHERE:
        return scree_generate_sphere(mesh, 0.5 * diameter, (int32_t)def->triangles);
    case SCREE_SHAPE_ROCK:
        status = scree_generate_rock(mesh, (uint64_t)def->seed, (int32_t)def->triangles, 0);
        for (int32_t v = 0; v < mesh->num_vertices; ++v)
            mesh->vertices[v] = scree_vec3_scale(mesh->vertices[v], (scree_real)diameter);
        return status;
    case SCREE_SHAPE_TURNED:
        return scree_generate_turned(mesh, def->profile, (int32_t)def->num_profile, (int32_t)def->segments);
    case SCREE_SHAPE_CLUMP:
        return SCREE_INVALID_INPUT; // has no mesh
    case SCREE_SHAPE_FILE:
        break;
    }
    char path[4096];
    const bool is_absolute = def->file[0] == '/';
    const int length =
        snprintf(path, sizeof path, "%s%s%s", is_absolute ? "" : folder, is_absolute ? "" : "/", def->file);
    if (length < 0 || (size_t)length >= sizeof path)
    {
        scree_report_add(report, "shape \"%s\": the path of its file has more than %zu characters", def->name,
                         sizeof path - 1);
        return SCREE_INVALID_INPUT;
    }
    status = scree_mesh_import(mesh, path, report);
    for (int32_t v = 0; v < mesh->num_vertices && def->scale != 1; ++v)
        mesh->vertices[v] = scree_vec3_scale(mesh->vertices[v], (scree_real)def->scale);
    // rounding must not have closed a narrow gap
    if (status == SCREE_OK && def->scale != 1) status = scree_mesh_validate(mesh, path, report);
    if (status == SCREE_OK && def->triangles > 0 && def->triangles < mesh->num_triangles)
        status = scree_mesh_simplify(mesh, (int32_t)def->triangles, 0, report);
    return status;
}

/// Mesh of a shape definition. What a scene can put together wrongly is checked.
static scree_status make_mesh(scree_mesh *mesh, const scree_shape_def *def, const char *folder, scree_report *report)
{
    scree_status status = make_one_mesh(mesh, def, folder, report);
    const bool is_shifted = def->offset[0] != 0 || def->offset[1] != 0 || def->offset[2] != 0;
    const bool is_repeated = def->copies > 1;
    if (status == SCREE_OK && (is_shifted || is_repeated))
        status = scree_mesh_repeat(mesh, def->offset, (int32_t)def->copies);
    if (status != SCREE_OK || (def->source != SCREE_SHAPE_TURNED && !is_repeated)) return status;
    status = scree_mesh_validate(mesh, def->name, report);
    if (status == SCREE_BAD_MESH)
        scree_report_add(report, "shape \"%s\": %s must not touch or cross each other; see scree --help scene",
                         def->name, is_repeated ? "its copies" : "the sides of its profile");
    return status;
}

/// Spheres that fill the mesh of another shape, to `spheres`.
static scree_status fill_mesh(const scree_scene *scene, const scree_shape_def *def, const char *folder,
                              scree_clump_sphere *spheres, scree_report *report)
{
    const int32_t wanted = (int32_t)def->fill.spheres, filled = find_shape(scene, def->fill.shape);
    scree_mesh mesh = {0};
    int32_t num_made = 0;
    if (filled < 0 || is_without_mesh(scene->shapes + filled) || wanted < 1 || wanted > SCREE_CLUMP_MAX_SPHERES)
    {
        scree_report_add(report, "shape \"%s\" fills \"%s\" with %d spheres; name a shape that has a mesh, and 1 to %d",
                         def->name, def->fill.shape, wanted, SCREE_CLUMP_MAX_SPHERES);
        return SCREE_INVALID_INPUT;
    }
    scree_status status = make_mesh(&mesh, scene->shapes + filled, folder, report);
    if (status == SCREE_OK) status = scree_clump_fill(&mesh, wanted, spheres, &num_made);
    scree_mesh_destroy(&mesh);
    if (status != SCREE_OK || num_made == wanted) return status;
    scree_report_add(report, "shape \"%s\": only %d spheres fit into \"%s\" that show and hang together; ask for fewer",
                     def->name, num_made, def->fill.shape);
    return SCREE_INVALID_INPUT;
}

static scree_status make_clump(scree_simulation *s, int32_t k, const char *folder, scree_report *report)
{
    const scree_shape_def *def = s->scene->shapes + k;
    const bool is_filled = def->fill.shape != NULL && def->fill.shape[0] != '\0';
    scree_clump_sphere filled[SCREE_CLUMP_MAX_SPHERES];
    const scree_status status = is_filled ? fill_mesh(s->scene, def, folder, filled, report) : SCREE_OK;
    if (status != SCREE_OK) return status;
    const scree_clump_sphere *spheres = is_filled ? filled : def->spheres;
    const int32_t num = is_filled ? (int32_t)def->fill.spheres : (int32_t)def->num_spheres;
    const scree_clump_fault fault = scree_clump_check(spheres, num);
    if (fault.kind == SCREE_CLUMP_GOOD) return scree_shape_create_clump(s->particle_shapes + k, spheres, num);
    char text[256];
    scree_clump_describe_fault(&fault, text, sizeof text);
    scree_report_add(report, "spheres of shape \"%s\" %s", def->name, text);
    return SCREE_INVALID_INPUT;
}

/// A true sphere or a clump needs no mesh, but it cannot be a wall.
static scree_status make_spheres(scree_simulation *s, int32_t k, bool is_wall, const char *folder, scree_report *report)
{
    const scree_shape_def *def = s->scene->shapes + k;
    const bool is_clump = def->source == SCREE_SHAPE_CLUMP;
    if (is_wall)
    {
        scree_report_add(
            report,
            "shape \"%s\" is a %s, but a wall is made of it, and walls are meshes; %sgive the wall a shape "
            "of its own",
            def->name, is_clump ? "clump" : "true sphere (triangles is 0)",
            is_clump ? "" : "set triangles of it, for instance 1280, or ");
        return SCREE_INVALID_INPUT;
    }
    scree_status status = SCREE_OK;
    if (is_clump) status = make_clump(s, k, folder, report);
    else scree_shape_create_sphere(s->particle_shapes + k, 0.5 * def->size[0]);
    s->shape_views[k] = s->particle_shapes[k].view;
    return status;
}

/// Shapes in the frames they are used in: principal for particles, source for walls.
static scree_status make_shapes(scree_simulation *s, const char *folder, scree_report *report)
{
    const scree_scene *scene = s->scene;
    scree_status worst = SCREE_OK;
    for (int32_t k = 0; k < s->num_shapes; ++k)
    {
        bool is_particle = false, is_wall = false;
        for (uint32_t g = 0; g < scene->num_particles; ++g)
            is_particle |= find_shape(scene, scene->particles[g].shape) == k;
        for (uint32_t w = 0; w < scene->num_walls; ++w) is_wall |= find_shape(scene, scene->walls[w].shape) == k;
        if (!is_particle && !is_wall) continue;
        if (is_without_mesh(scene->shapes + k))
        {
            const scree_status made = make_spheres(s, k, is_wall, folder, report);
            if (made != SCREE_OK) worst = made;
            continue;
        }

        scree_mesh mesh = {0};
        const int num_before = scree_report_num_faults(report);
        scree_status status = make_mesh(&mesh, scene->shapes + k, folder, report);
        if (status == SCREE_OK && is_particle)
            status = scree_shape_create(s->particle_shapes + k, &mesh, SCREE_FRAME_PRINCIPAL);
        if (status == SCREE_OK && is_wall) status = scree_shape_create(s->wall_shapes + k, &mesh, SCREE_FRAME_SOURCE);
        scree_mesh_destroy(&mesh);
        if (status != SCREE_OK && scree_report_num_faults(report) == num_before)
            scree_report_add(report, "shape \"%s\" could not be made: %s", scene->shapes[k].name,
                             scree_status_text(status));
        if (status != SCREE_OK) worst = status;
        s->shape_views[k] = s->particle_shapes[k].view;
        s->shape_views[s->num_shapes + k] = s->wall_shapes[k].view;
    }
    return worst;
}

/// Laws of all pairs of materials that the scene gives one.
static scree_status make_laws(scree_simulation *s, scree_report *report)
{
    const scree_scene *scene = s->scene;
    for (uint32_t k = 0; k < scene->num_contact_laws; ++k)
    {
        const scree_contact_law_def *def = scene->contact_laws + k;
        const int32_t a = find_material(scene, def->materials[0]), b = find_material(scene, def->materials[1]);
        scree_force_law law;
        if (a < 0 || b < 0 || scree_force_law_make(def, scene->materials + a, scene->materials + b, &law) != SCREE_OK)
        {
            scree_report_add(report, "contact_laws.%u: no material \"%s\" or \"%s\", or no force model \"%s\"", k,
                             def->materials[0], def->materials[1], def->model);
            return SCREE_INVALID_INPUT;
        }
        s->laws[a * s->num_materials + b] = law;
        s->laws[b * s->num_materials + a] = law;
    }
    return SCREE_OK;
}

static scree_status allocate(scree_simulation *s)
{
    const scree_scene *scene = s->scene;
    s->num_shapes = (int32_t)scene->num_shapes;
    s->num_materials = (int32_t)scene->num_materials;
    s->num_walls = (int32_t)scene->num_walls;
    s->particle_shapes = calloc(scene->num_shapes + 1, sizeof *s->particle_shapes);
    s->wall_shapes = calloc(scene->num_shapes + 1, sizeof *s->wall_shapes);
    s->shape_views = calloc(2 * (size_t)scene->num_shapes + 1, sizeof *s->shape_views);
    s->laws = calloc((size_t)scene->num_materials * scene->num_materials + 1, sizeof *s->laws);
    s->walls = calloc((size_t)scene->num_walls + 1, sizeof *s->walls);
    for (uint32_t w = 0; s->walls != NULL && w < scene->num_walls; ++w)
    {
        s->walls[w].shape = find_shape(scene, scene->walls[w].shape);
        s->walls[w].material = find_material(scene, scene->walls[w].material);
    }
    const bool is_complete = s->particle_shapes != NULL && s->wall_shapes != NULL && s->shape_views != NULL &&
                             s->laws != NULL && s->walls != NULL;
    return is_complete ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}

/// Several contacts of a pair are those of the spheres of clumps, of a sphere on a mesh, and of patches told apart.
static bool has_one_contact_per_pair(const scree_simulation *s)
{
    bool has[SCREE_NUM_SHAPE_KINDS] = {false};
    for (int64_t i = 0; i < s->particles.num_particles; ++i) has[s->shape_views[s->particles.shape[i]].kind] = true;
    const bool has_meshes = has[SCREE_KIND_MESH];
    return !has[SCREE_KIND_CLUMP] && !(has[SCREE_KIND_SPHERE] && (has_meshes || s->num_walls > 0)) &&
           !(has_meshes && s->scene->solver.separate_patches);
}

/// What the contacts of the scene have no use for. Every contact acts in a point if all particles are spheres, and no
/// law has a moment of its own for them.
static void choose_contact_arrays(scree_simulation *s)
{
    bool has_extent = s->particles.num_particles == 0, has_levers = false, has_rolling = false;
    for (int64_t i = 0; i < s->particles.num_particles && !has_extent; ++i)
        has_extent = s->shape_views[s->particles.shape[i]].kind != SCREE_KIND_SPHERE;
    for (int32_t k = 0; k < s->num_materials * s->num_materials; ++k)
    {
        has_rolling |= s->laws[k].rolling != SCREE_ROLLING_NONE;
        has_levers |= s->laws[k].model == SCREE_MODEL_ENERGY_CONSERVING;
    }
    s->contacts.acts_in_points = !has_extent && !has_rolling;
    s->contacts.has_no_levers = !has_levers;
    s->contacts.has_no_rolling = !has_rolling;
    s->contacts.is_one_per_pair = has_one_contact_per_pair(s);
    s->old_contacts.is_history = true;
    scree_contact_list_share_uses(&s->old_contacts, &s->contacts);
}

/// Contacts and forces of time 0.
static scree_status start(scree_simulation *s, scree_report *report)
{
    s->buffers->skin = scree_skin_at_start(s);
    choose_contact_arrays(s);
    s->counters.smallest_critical_step = INFINITY;
    s->narrow_phase.options.scheme =
        strcmp(s->scene->solver.overlap_scheme, "hierarchy") == 0 ? SCREE_OVERLAP_HIERARCHY : SCREE_OVERLAP_FILTERED;
    s->narrow_phase.options.separate_patches = s->scene->solver.separate_patches;
    s->narrow_phase.options.use_convex_path = true;
    s->narrow_phase.separation.finds = s->scene->solver.find_separation;
    s->narrow_phase.separation.remembers = s->scene->solver.remember_separation;
    s->narrow_phase.separation.bounds = s->scene->solver.bound_separation;
    s->narrow_phase.tally = &s->buffers->board->pairs;
    scree_move_walls(s, 0);
    scree_place_walls(s);
    scree_place_particles(s);
    scree_status status = scree_check_walls(s, report);
    if (status == SCREE_OK) status = scree_search_neighbours(s);
    if (status == SCREE_OK) status = scree_update_contacts(s);
    if (status == SCREE_OK) status = scree_check_start(s, report);
    if (status != SCREE_OK) return status;
    scree_update_forces(s);
    scree_gather_forces(s);
    scree_fetch_board(s);
    scree_take_board(s);
    return SCREE_OK;
}

static scree_status choose_time_step(scree_simulation *s, scree_report *report)
{
    const scree_time_def *time = &s->scene->time;
    const double critical = scree_time_step_critical(s);
    s->time_step = isnan(time->step) ? time->step_fraction * critical : time->step;
    if (isfinite(s->time_step) && s->time_step > 0)
    {
        if (s->time_step > critical)
            scree_report_warn(report,
                              "time.step of %g s exceeds the critical step of %g s that the stiffest contact to "
                              "expect allows; choose a smaller one, or auto",
                              s->time_step, critical);
        return SCREE_OK;
    }
    scree_report_add(report,
                     "time.step is auto, but there are no particles whose contacts could give it; set time.step");
    return SCREE_INVALID_INPUT;
}

scree_status scree_simulation_create(scree_simulation **simulation, const scree_scene *scene, const char *folder,
                                     scree_report *report)
{
    *simulation = NULL;
    scree_status status = check_names(scene, report);
    if (status != SCREE_OK) return status;
    scree_simulation *s = calloc(1, sizeof *s);
    if (s == NULL) return SCREE_OUT_OF_MEMORY;
    s->scene = scene;
    status = allocate(s);
    if (status == SCREE_OK) status = make_laws(s, report);
    if (status == SCREE_OK) status = make_shapes(s, folder, report);
    if (status == SCREE_OK) status = scree_populate(s, report);
    if (status == SCREE_OK) status = choose_time_step(s, report);
    if (status == SCREE_OK) status = scree_step_buffers_create(s);
    if (status == SCREE_OK) status = scree_wall_axes_create(s);
    if (status == SCREE_OK) status = scree_wall_loads_create(&s->wall_loads, s->num_walls);
    if (status == SCREE_OK) status = scree_averages_create(s, report);
    if (status == SCREE_OK) status = start(s, report);
    if (status == SCREE_OK) status = scree_averages_restart(s);
    if (status != SCREE_OK)
    {
        if (scree_report_num_faults(report) == 0) scree_report_add(report, "%s", scree_status_text(status));
        scree_simulation_destroy(s);
        return status;
    }
    *simulation = s;
    return SCREE_OK;
}

scree_status scree_simulation_restored(scree_simulation *simulation, scree_report *report)
{
    // the contacts that were read become the old list; the next step finds its own and their history by key
    scree_move_walls(simulation, scree_simulation_time(simulation));
    scree_place_walls(simulation);
    scree_place_particles(simulation);
    simulation->buffers->has_pairs = false;
    simulation->buffers->places.is_due = false;
    simulation->buffers->is_old_list_of_same_pairs = false;
    return scree_contact_list_validate(&simulation->contacts, NULL, report) ? SCREE_OK : SCREE_INVALID_INPUT;
}

void scree_simulation_destroy(scree_simulation *simulation)
{
    if (simulation == NULL) return;
    scree_leave_device(simulation);
    for (int32_t k = 0; k < simulation->num_shapes; ++k)
    {
        if (simulation->particle_shapes != NULL) scree_shape_destroy(simulation->particle_shapes + k);
        if (simulation->wall_shapes != NULL) scree_shape_destroy(simulation->wall_shapes + k);
    }
    scree_step_buffers_destroy(simulation);
    scree_particles_destroy(&simulation->particles);
    scree_wall_loads_destroy(&simulation->wall_loads);
    scree_averages_destroy(&simulation->averages);
    scree_contact_list_destroy(&simulation->contacts);
    scree_contact_list_destroy(&simulation->old_contacts);
    scree_broad_phase_destroy(&simulation->broad_phase);
    scree_narrow_phase_destroy(&simulation->narrow_phase);
    scree_scratch_destroy(&simulation->scratch);
    free(simulation->particle_shapes);
    free(simulation->wall_shapes);
    free(simulation->shape_views);
    free(simulation->laws);
    free(simulation->walls);
    free(simulation);
}
