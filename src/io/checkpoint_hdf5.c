/// \file checkpoint_hdf5.c
/// checkpoint.h5: every number that the next step depends on, as stored. The format is docs/format_hdf5.md.
///
/// Three hashes guard it. scene_hash: of what acts on the particles (laws, meshes, walls, gravity, overlap scheme), so
/// a checkpoint is not taken on with another scene. contents_hash: of all arrays and counters as they were in memory,
/// so a damaged file is refused. state_hash: that of scree_simulation_hash(), for comparison by eye.
#define _POSIX_C_SOURCE 200809L
#include "core/hash.h"
#include "io/averages_hdf5.h"
#include "io/hdf5_file.h"
#include "io/run_folder.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define FORMAT_NAME "scree checkpoint"
enum
{
    FORMAT_VERSION = 2,
    HASH_TEXT = 17
};
/// More than any memory holds: the number in the file is not to be believed.
#define MAX_CONTACTS ((int64_t)1 << 40)

_Static_assert(offsetof(scree_particles, num_particles) == 0, "the number of items is read there");
_Static_assert(offsetof(scree_contact_list, num_contacts) == 0, "the number of items is read there");
_Static_assert(offsetof(scree_wall_loads, num_walls) == 0, "the number of items is read there");

// ---- hashes

static uint64_t hash_number(uint64_t hash, double value)
{
    // every automatic value (NAN) has the same bits here
    const double number = isnan(value) ? (double)NAN : value + 0.0;
    return scree_hash_bytes(hash, &number, sizeof number);
}

static uint64_t hash_numbers(uint64_t hash, const double *values, int num)
{
    for (int k = 0; k < num; ++k) hash = hash_number(hash, values[k]);
    return hash;
}

static uint64_t hash_shape(uint64_t hash, const scree_shape_view *shape)
{
    if (shape->kind == SCREE_KIND_SPHERE) return hash_number(hash, (double)shape->bounding_radius);
    if (shape->kind == SCREE_KIND_CLUMP)
        return scree_hash_bytes(hash, shape->spheres, (size_t)shape->num_spheres * sizeof *shape->spheres);
    hash = scree_hash_bytes(hash, shape->vertices, (size_t)shape->num_vertices * sizeof *shape->vertices);
    return scree_hash_bytes(hash, shape->triangles, (size_t)shape->num_triangles * sizeof *shape->triangles);
}

static uint64_t hash_law(uint64_t hash, const scree_force_law *law)
{
    const double numbers[] = {law->effective_modulus,
                              law->stiffness_factor,
                              law->normal_stiffness,
                              law->tangential_over_normal,
                              law->damping_ratio,
                              law->tangential_damping_ratio,
                              law->friction_coefficient,
                              law->rolling_friction_coefficient,
                              law->rolling_damping_ratio,
                              law->model,
                              law->exponent_quarters,
                              law->rolling,
                              law->has_tangential_spring,
                              law->has_attraction,
                              law->has_moments};
    return hash_numbers(hash, numbers, (int)(sizeof numbers / sizeof numbers[0]));
}

static uint64_t hash_wall(uint64_t hash, const scree_wall_def *def)
{
    const scree_motion_def *motion = &def->motion;
    const double numbers[] = {motion->kind, motion->angular_velocity, motion->start, motion->end, def->removed_at};
    hash = hash_numbers(hash, def->position, 3);
    hash = hash_numbers(hash, def->orientation, 4);
    hash = hash_numbers(hash, motion->velocity, 3);
    hash = hash_numbers(hash, motion->axis, 3);
    hash = hash_numbers(hash, motion->centre, 3);
    return hash_numbers(hash, numbers, (int)(sizeof numbers / sizeof numbers[0]));
}

/// Of all that acts on the particles but their own state.
static uint64_t scene_hash(const scree_simulation *simulation)
{
    const scree_scene *scene = simulation->scene;
    uint64_t hash = hash_numbers(0, scene->gravity, 3);
    hash = hash_number(hash, simulation->time_step);
    const char *scheme = scene->solver.overlap_scheme != NULL ? scene->solver.overlap_scheme : "";
    hash = scree_hash_bytes(hash, scheme, strlen(scheme) + 1);
    hash = hash_number(hash, scene->solver.separate_patches);
    for (int32_t k = 0; k < simulation->num_materials * simulation->num_materials; ++k)
        hash = hash_law(hash, simulation->laws + k);
    for (int32_t k = 0; k < 2 * simulation->num_shapes; ++k) hash = hash_shape(hash, simulation->shape_views + k);
    for (int32_t w = 0; w < simulation->num_walls; ++w)
    {
        hash = hash_wall(hash, scene->walls + w);
        hash = hash_number(hash, simulation->walls[w].shape);
        hash = hash_number(hash, simulation->walls[w].material);
    }
    return hash;
}

static uint64_t hash_arrays(uint64_t hash, const scree_field *fields, int num_fields, const void *structure,
                            int64_t num)
{
    for (int k = 0; k < num_fields && num > 0; ++k)
        hash = scree_hash_bytes(hash, scree_field_array(fields + k, structure),
                                (size_t)num * scree_field_size(fields + k));
    return hash;
}

static uint64_t contents_hash(const scree_series_row *row, const scree_particles *particles,
                              const scree_contact_list *contacts, const scree_wall_loads *walls)
{
    int num_fields;
    const scree_field *fields = scree_series_fields(&num_fields);
    uint64_t hash = 0;
    for (int k = 0; k < num_fields; ++k) hash = hash_number(hash, scree_field_value(fields + k, row));
    fields = scree_particle_fields(&num_fields);
    hash = hash_arrays(hash, fields, num_fields, particles, particles->num_particles);
    fields = scree_contact_fields(&num_fields);
    hash = hash_arrays(hash, fields, num_fields, contacts, contacts->num_contacts);
    fields = scree_wall_fields(&num_fields);
    return hash_arrays(hash, fields, num_fields, walls, walls->num_walls);
}

// ---- writing

static bool put_hash(hid_t object, const char *name, uint64_t hash)
{
    char text[HASH_TEXT];
    snprintf(text, sizeof text, "%016" PRIx64, hash);
    return scree_hdf5_put_text(object, name, text);
}

/// The numbers of a row as attributes, names as in series.csv.
static bool put_row(hid_t file, const scree_series_row *row)
{
    const hid_t properties = scree_hdf5_properties(H5P_GROUP_CREATE);
    const hid_t group = H5Gcreate2(file, "/now", H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    int num_fields;
    const scree_field *fields = scree_series_fields(&num_fields);
    bool is_done = group >= 0;
    for (int k = 0; k < num_fields && is_done; ++k)
        is_done = scree_hdf5_put_number(group, fields[k].name, fields[k].type, (const char *)row + fields[k].offset);
    if (group >= 0) H5Gclose(group);
    return is_done;
}

static bool put_head(hid_t file, const scree_simulation *simulation, const scree_series_row *row)
{
    const int32_t version = FORMAT_VERSION;
    const scree_particles *particles = &simulation->particles;
    const scree_contact_list *contacts = &simulation->contacts;
    const char *name = simulation->scene->name != NULL ? simulation->scene->name : "";
    return scree_hdf5_put_text(file, "format", FORMAT_NAME) &&
           scree_hdf5_put_number(file, "format_version", SCREE_FIELD_INT32, &version) &&
           scree_hdf5_put_text(file, "scree_version", SCREE_VERSION) && scree_hdf5_put_text(file, "scene", name) &&
           scree_hdf5_put_text(file, "precision", sizeof(scree_real) == sizeof(double) ? "double" : "single") &&
           scree_hdf5_put_number(file, "num_particles", SCREE_FIELD_INT64, &particles->num_particles) &&
           scree_hdf5_put_number(file, "num_contacts", SCREE_FIELD_INT64, &contacts->num_contacts) &&
           scree_hdf5_put_number(file, "time_step", SCREE_FIELD_DOUBLE, &simulation->time_step) &&
           put_hash(file, "scene_hash", scene_hash(simulation)) &&
           put_hash(file, "contents_hash", contents_hash(row, particles, contacts, &simulation->wall_loads)) &&
           put_hash(file, "state_hash", scree_simulation_hash(simulation));
}

static bool put_everything(hid_t file, const scree_simulation *simulation)
{
    const scree_series_row row = scree_series_row_of(simulation);
    int num_particle_fields, num_contact_fields, num_wall_fields;
    const scree_field *particle_fields = scree_particle_fields(&num_particle_fields);
    const scree_field *contact_fields = scree_contact_fields(&num_contact_fields);
    const scree_field *wall_fields = scree_wall_fields(&num_wall_fields);
    return put_head(file, simulation, &row) && put_row(file, &row) &&
           scree_hdf5_put_arrays(file, "/particles", particle_fields, num_particle_fields, &simulation->particles) &&
           scree_hdf5_put_arrays(file, "/contacts", contact_fields, num_contact_fields, &simulation->contacts) &&
           scree_hdf5_put_arrays(file, "/walls", wall_fields, num_wall_fields, &simulation->wall_loads) &&
           scree_averages_put(file, simulation);
}

scree_status scree_checkpoint_save(const scree_simulation *simulation, const char *path, scree_report *report)
{
    return scree_hdf5_save(path, put_everything, simulation, report);
}

// ---- reading

/// What was read, before it becomes the state.
typedef struct loaded_state
{
    scree_series_row row;
    scree_particles particles;
    scree_contact_list contacts;
    scree_wall_loads walls;
} loaded_state;

static bool get_hash(hid_t object, const char *name, uint64_t *hash)
{
    char text[HASH_TEXT];
    return scree_hdf5_get_text(object, name, text, sizeof text) && sscanf(text, "%16" SCNx64, hash) == 1;
}

static bool get_row(hid_t file, scree_series_row *row)
{
    const hid_t group = H5Gopen2(file, "/now", H5P_DEFAULT);
    int num_fields;
    const scree_field *fields = scree_series_fields(&num_fields);
    bool is_done = group >= 0;
    for (int k = 0; k < num_fields && is_done; ++k)
        is_done = scree_hdf5_get_number(group, fields[k].name, fields[k].type, (char *)row + fields[k].offset);
    if (group >= 0) H5Gclose(group);
    return is_done;
}

/// Is it a checkpoint that this build can read at all?
static bool check_format(hid_t file, const char *path, scree_report *report)
{
    const char *precision = sizeof(scree_real) == sizeof(double) ? "double" : "single";
    char text[64];
    int32_t version = 0;
    if (!scree_hdf5_get_text(file, "format", text, sizeof text) || strcmp(text, FORMAT_NAME) != 0 ||
        !scree_hdf5_get_number(file, "format_version", SCREE_FIELD_INT32, &version))
    {
        scree_report_add(report, "%s is not a checkpoint of scree", path);
        return false;
    }
    if (version != FORMAT_VERSION)
    {
        scree_report_add(report, "%s has format version %d; this scree reads version %d", path, version,
                         FORMAT_VERSION);
        return false;
    }
    if (!scree_hdf5_get_text(file, "precision", text, sizeof text) || strcmp(text, precision) != 0)
    {
        scree_report_add(report, "%s is not in %s precision, which this scree is built for", path, precision);
        return false;
    }
    return true;
}

/// Is it of this scene?
static bool check_scene(hid_t file, const scree_simulation *simulation, const char *path, scree_report *report)
{
    int64_t num_particles = -1;
    double time_step = 0;
    uint64_t hash = 0;
    bool is_fit = true;
    if (!scree_hdf5_get_number(file, "num_particles", SCREE_FIELD_INT64, &num_particles) ||
        num_particles != simulation->particles.num_particles)
    {
        scree_report_add(report, "%s has %lld particles, the scene has %lld; go on with the scene it was made from",
                         path, (long long)num_particles, (long long)simulation->particles.num_particles);
        is_fit = false;
    }
    if (!scree_hdf5_get_number(file, "time_step", SCREE_FIELD_DOUBLE, &time_step) || time_step != simulation->time_step)
    {
        scree_report_add(report, "%s has a time step of %.17g s, the scene of %.17g s; they must be equal", path,
                         time_step, simulation->time_step);
        is_fit = false;
    }
    else if (!get_hash(file, "scene_hash", &hash) || hash != scene_hash(simulation))
    {
        scree_report_add(report,
                         "%s was made from a scene with other gravity, contact laws, walls, shapes or overlap scheme; "
                         "go on with the scene it was made from (name, end, output and repose may change)",
                         path);
        is_fit = false;
    }
    return is_fit;
}

/// The number of contacts, -1 if the file is not sure of it: nothing is allocated for a number that stands alone.
static int64_t count_contacts(hid_t file)
{
    int64_t num_contacts = -1;
    const hid_t dataset = H5Dopen2(file, "/contacts/bodies", H5P_DEFAULT);
    if (dataset < 0) return -1;
    const hid_t space = H5Dget_space(dataset);
    const int64_t num_ids = (int64_t)H5Sget_simple_extent_npoints(space);
    H5Sclose(space);
    H5Dclose(dataset);
    if (!scree_hdf5_get_number(file, "num_contacts", SCREE_FIELD_INT64, &num_contacts)) return -1;
    return num_contacts >= 0 && num_contacts <= MAX_CONTACTS && num_ids == 2 * num_contacts ? num_contacts : -1;
}

/// Room for what the file holds.
static scree_status allocate_state(hid_t file, const scree_simulation *simulation, loaded_state *state)
{
    const int64_t num_contacts = count_contacts(file);
    if (num_contacts < 0) return SCREE_READ_FAILED;
    scree_status status = scree_particles_create(&state->particles, simulation->particles.num_particles);
    // room for one contact at least, so that there are arrays; what a scene of spheres leaves untouched stays so
    scree_contact_list_share_uses(&state->contacts, &simulation->contacts);
    if (status == SCREE_OK)
        status = scree_contact_list_reserve(&state->contacts, num_contacts > 0 ? num_contacts : 1, 0);
    state->contacts.num_contacts = num_contacts;
    if (status == SCREE_OK) status = scree_wall_loads_create(&state->walls, simulation->wall_loads.num_walls);
    return status;
}

static scree_status read_state(hid_t file, loaded_state *state, const char *path, scree_report *report)
{
    int num_particle_fields, num_contact_fields, num_wall_fields;
    const scree_field *particle_fields = scree_particle_fields(&num_particle_fields);
    const scree_field *contact_fields = scree_contact_fields(&num_contact_fields);
    const scree_field *wall_fields = scree_wall_fields(&num_wall_fields);
    uint64_t hash = 0;
    if (get_row(file, &state->row) &&
        scree_hdf5_get_arrays(file, "/particles", particle_fields, num_particle_fields, &state->particles) &&
        scree_hdf5_get_arrays(file, "/contacts", contact_fields, num_contact_fields, &state->contacts) &&
        scree_hdf5_get_arrays(file, "/walls", wall_fields, num_wall_fields, &state->walls) &&
        get_hash(file, "contents_hash", &hash) &&
        hash == contents_hash(&state->row, &state->particles, &state->contacts, &state->walls))
        return SCREE_OK;
    scree_report_add(report, "%s is damaged: what it holds is not what was written", path);
    return SCREE_READ_FAILED;
}

/// The constant arrays must be those that the scene has made.
static bool check_constants(const scree_simulation *simulation, const loaded_state *state, const char *path,
                            scree_report *report)
{
    int num_fields;
    const scree_field *fields = scree_particle_fields(&num_fields);
    const size_t num = (size_t)simulation->particles.num_particles;
    bool is_fit = true;
    for (int k = scree_num_moving_particle_fields(); k < num_fields; ++k)
    {
        const void *mine = scree_field_array(fields + k, &simulation->particles);
        if (num == 0 ||
            memcmp(mine, scree_field_array(fields + k, &state->particles), num * scree_field_size(fields + k)) == 0)
            continue;
        scree_report_add(report,
                         "%s: the particles have another %s than those of the scene; go on with the scene it "
                         "was made from",
                         path, fields[k].name);
        is_fit = false;
    }
    return is_fit;
}

/// Numbers that are no numbers, or ids that do not exist, cannot have been written by a healthy run.
static bool check_values(const scree_simulation *simulation, const loaded_state *state, const char *path,
                         scree_report *report)
{
    int num_fields;
    const scree_field *fields = scree_particle_fields(&num_fields);
    const int64_t num_particles = state->particles.num_particles;
    for (int k = 0; k < scree_num_moving_particle_fields(); ++k)
    {
        const scree_real *values = scree_field_array(fields + k, &state->particles);
        for (int64_t n = 0; n < num_particles * fields[k].num_components; ++n)
            if (!isfinite(values[n]))
            {
                scree_report_add(report, "%s: %s of particle %lld is not finite", path, fields[k].name,
                                 (long long)(n / fields[k].num_components));
                return false;
            }
    }
    const scree_contact_list *contacts = &state->contacts;
    for (int64_t c = 0; c < contacts->num_contacts; ++c)
        if (contacts->bodies[c].i >= num_particles || contacts->bodies[c].j >= num_particles + simulation->num_walls)
        {
            scree_report_add(report, "%s: contact %lld is of bodies that do not exist", path, (long long)c);
            return false;
        }
    return state->row.step >= 0 && scree_contact_list_validate(contacts, NULL, report);
}

/// Takes the loaded arrays; the old ones are left in `state`.
static void exchange(scree_simulation *simulation, loaded_state *state)
{
    const scree_particles particles = simulation->particles;
    const scree_contact_list contacts = simulation->contacts;
    const scree_wall_loads walls = simulation->wall_loads;
    simulation->particles = state->particles;
    simulation->contacts = state->contacts;
    state->particles = particles;
    state->contacts = contacts;
    simulation->wall_loads = state->walls;
    state->walls = walls;
    simulation->step = state->row.step;
    simulation->energies = state->row.energies;
    simulation->counters = state->row.counters;
}

static scree_status load(scree_simulation *simulation, hid_t file, const char *path, scree_report *report)
{
    if (!check_format(file, path, report)) return SCREE_READ_FAILED;
    if (!check_scene(file, simulation, path, report)) return SCREE_INVALID_INPUT;
    loaded_state state;
    memset(&state, 0, sizeof state);
    scree_status status = allocate_state(file, simulation, &state);
    if (status == SCREE_OK) status = read_state(file, &state, path, report);
    else if (status == SCREE_READ_FAILED) scree_report_add(report, "%s is damaged: its counts disagree", path);
    else scree_report_add(report, "%s could not be read: %s", path, scree_status_text(status));
    if (status == SCREE_OK && !check_constants(simulation, &state, path, report)) status = SCREE_INVALID_INPUT;
    if (status == SCREE_OK && !check_values(simulation, &state, path, report)) status = SCREE_READ_FAILED;
    bool has_averages = false;
    if (status == SCREE_OK)
        status = scree_averages_get(file, simulation, state.contacts.num_contacts, &has_averages, report);
    if (status == SCREE_OK)
    {
        exchange(simulation, &state);
        if (!has_averages) status = scree_averages_restart(simulation);
    }
    scree_particles_destroy(&state.particles);
    scree_contact_list_destroy(&state.contacts);
    scree_wall_loads_destroy(&state.walls);
    return status;
}

scree_status scree_checkpoint_load(scree_simulation *simulation, const char *path, scree_report *report)
{
    if (simulation->there != NULL)
    {
        scree_report_add(report, "%s: a checkpoint is loaded before the steps go to a GPU, not after", path);
        return SCREE_INVALID_INPUT;
    }
    if (access(path, F_OK) != 0)
    {
        scree_report_add(report, "there is no checkpoint %s", path);
        return SCREE_NOT_FOUND;
    }
    // what is read comes to the places of ids
    scree_status status = scree_simulation_observe(simulation, report);
    if (status != SCREE_OK) return status;
    const scree_hdf5_printing printing = scree_hdf5_silence();
    status = SCREE_READ_FAILED;
    const hid_t file = scree_hdf5_open(path, false, report);
    if (file >= 0)
    {
        status = load(simulation, file, path, report);
        H5Fclose(file);
    }
    scree_hdf5_restore(printing);
    return status == SCREE_OK ? scree_simulation_restored(simulation, report) : status;
}
