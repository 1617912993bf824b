// A run that is stopped and gone on with is the unbroken run, bit for bit; a checkpoint that does not fit or is damaged
// is refused with the state untouched; a kill or a full disk while one is written keeps the one before.
#define _XOPEN_SOURCE 700
#include "made_simulation.h"
#include "scene_run.h"
#include "test_folder.h"

#include "dynamics/step_buffers.h"
#include "io/run_folder.h"

#include <hdf5.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>

/// Two kinds of non-convex particles on a floor that moves, a wall that goes, patches apart: all that a state can have.
static const char scene_text[] =
    "name: checkpoint\n"
    "time: {end: 0.02, step: 5e-5}\n"
    "materials:\n"
    "  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}\n"
    "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]\n"
    "shapes:\n"
    "  - {name: rock, source: rock, triangles: 40, seed: 3}\n"
    "  - {name: schoenhardt, source: schoenhardt, size: [0.02, 0, 0]}\n"
    "  - {name: floor, source: box, size: [0.3, 0.3, 0.02]}\n"
    "  - {name: trio, source: clump, spheres: [{position: [0, 0, 0], radius: 0.007},\n"
    "     {position: [0.006, 0, 0], radius: 0.006}, {position: [0, 0.007, 0], radius: 0.005}]}\n"
    "particles:\n"
    "  - {name: trios, shape: trio, material: stone, count: 8, seed: 3, velocity: [0, 0, -9],\n"
    "     region: {min: [-0.05, -0.05, 0.2], max: [0.05, 0.05, 0.28]}}\n"
    "  - {name: rocks, shape: rock, material: stone, count: 16, seed: 1, velocity: [0, 0, -4],\n"
    "     size: {distribution: uniform, min: 0.01, max: 0.02},\n"
    "     region: {min: [-0.05, -0.05, 0.001], max: [0.05, 0.05, 0.08]}}\n"
    "  - {name: twisted, shape: schoenhardt, material: stone, count: 12, seed: 2, velocity: [0, 0, -8],\n"
    "     region: {min: [-0.05, -0.05, 0.08], max: [0.05, 0.05, 0.2]}}\n"
    "walls:\n"
    "  - {name: floor, shape: floor, material: stone, position: [0, 0, -0.01],\n"
    "     motion: {kind: rotate, axis: [0, 0, 1], angular_velocity: 5, start: 0.003, end: 0.012}}\n"
    "  - {name: lid, shape: floor, material: stone, position: [0, 0, 0.6], removed_at: 0.01}\n";

static const char *path_in(const char *folder, const char *name)
{
    static char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

/// Hash of everything that a checkpoint holds: more than scree_simulation_hash() takes in.
static uint64_t hash_all(const scree_simulation *simulation)
{
    uint64_t hash = scree_simulation_hash(simulation);
    const scree_energies energies = scree_simulation_energies(simulation);
    const unsigned char *bytes = (const unsigned char *)&energies;
    for (size_t k = 0; k < sizeof energies; ++k) hash = (hash ^ bytes[k]) * 0x100000001b3u;
    int num_fields;
    const scree_field *fields = scree_contact_fields(&num_fields);
    for (int f = 0; f < num_fields; ++f)
    {
        bytes = scree_field_array(fields + f, &simulation->contacts);
        const size_t size = (size_t)simulation->contacts.num_contacts * scree_field_size(fields + f);
        for (size_t k = 0; k < size; ++k) hash = (hash ^ bytes[k]) * 0x100000001b3u;
    }
    return hash;
}

// ---- restart

/// The scene stopped after `stop` steps, made anew, loaded and run to the end; against the unbroken run's hashes.
static void check_restart(int64_t stop, const uint64_t *hashes, int64_t num_steps)
{
    const char *path = path_in(scree_test_folder(), "checkpoint.h5");
    scene_run first, second;
    scene_run_start(&first, scene_text);
    scene_run_until(&first, (double)stop * 5e-5);
    SCREE_CHECK_INT(scree_checkpoint_save(first.simulation, path, &first.report), SCREE_OK);
    scene_run_start(&second, scene_text);
    SCREE_CHECK_INT(scree_checkpoint_load(second.simulation, path, &second.report), SCREE_OK);
    SCREE_CHECK_INT(second.simulation->step, stop);
    SCREE_CHECK(hash_all(second.simulation) == hash_all(first.simulation));
    const scree_counters a = scree_simulation_counters(first.simulation),
                         b = scree_simulation_counters(second.simulation);
    SCREE_CHECK(memcmp(&a, &b, sizeof a) == 0);
    bool is_same = true;
    for (int64_t step = stop; step < num_steps && is_same; ++step)
    {
        is_same = hashes[step] == hash_all(second.simulation) &&
                  scree_simulation_step(second.simulation, &second.report) == SCREE_OK;
        if (!is_same) printf("stopped after step %lld, other bits at step %lld\n", (long long)stop, (long long)step);
    }
    SCREE_CHECK(is_same && hashes[num_steps] == hash_all(second.simulation));
    scene_run_end(&second);
    scene_run_end(&first);
}

static void test_a_restart_is_the_unbroken_run(void)
{
    enum
    {
        NUM_STEPS = 400
    };
    static uint64_t hashes[NUM_STEPS + 1];
    scene_run run;
    scene_run_start(&run, scene_text);
    int64_t most_contacts = 0;
    for (int64_t step = 0; step <= NUM_STEPS && run.simulation != NULL; ++step)
    {
        hashes[step] = hash_all(run.simulation);
        if (run.simulation->contacts.num_contacts > most_contacts)
            most_contacts = run.simulation->contacts.num_contacts;
        SCREE_CHECK_INT(scree_simulation_step(run.simulation, &run.report), SCREE_OK);
    }
    scene_run_end(&run);
    SCREE_CHECK(most_contacts > 10); // or nothing is tested
    static const int64_t stops[] = {0, 1, 199, 200, 201, 330, 399, 400};
    for (size_t k = 0; k < sizeof stops / sizeof stops[0]; ++k) check_restart(stops[k], hashes, NUM_STEPS);
}

static void test_equal_states_are_equal_files(void)
{
    made_simulation made;
    made_simulation_create(&made);
    made_simulation_set_step(&made, 7);
    made_simulation_set_contacts(&made, 5);
    char paths[2][512];
    char *texts[2];
    size_t sizes[2];
    const char *folder = scree_test_folder();
    for (int k = 0; k < 2; ++k)
    {
        snprintf(paths[k], sizeof paths[k], "%s/%d.h5", folder, k);
        SCREE_CHECK_INT(scree_checkpoint_save(&made.simulation, paths[k], NULL), SCREE_OK);
        FILE *file = fopen(paths[k], "rb");
        texts[k] = calloc(1, 1 << 20);
        sizes[k] = fread(texts[k], 1, 1 << 20, file);
        fclose(file);
    }
    SCREE_CHECK(sizes[0] > 1000 && sizes[0] == sizes[1] && memcmp(texts[0], texts[1], sizes[0]) == 0);
    free(texts[0]);
    free(texts[1]);
    made_simulation_destroy(&made);
}

// ---- refusals

typedef struct refusal
{
    const char *what;
    scree_status status;
    const char *message; ///< part of it
    void (*change)(made_simulation *made);
} refusal;

static void change_gravity(made_simulation *made) { made->scene.gravity[0] = 1; }
static void change_law(made_simulation *made) { made->law.friction_coefficient = (scree_real)0.5; }
static void change_wall(made_simulation *made) { made->wall_defs[1].motion.end = 3; }
static void change_mesh(made_simulation *made) { made->views[3] = made->views[0]; }
static void change_scheme(made_simulation *made)
{
    static char scheme[] = "hierarchy";
    made->scene.solver.overlap_scheme = scheme;
}
static void change_time_step(made_simulation *made) { made->simulation.time_step *= 1 + DBL_EPSILON; }
static void change_mass(made_simulation *made) { made->simulation.particles.mass[1] *= 1 + SCREE_REAL_EPSILON; }
static void change_shape(made_simulation *made) { made->simulation.particles.shape[0] = 1; }
static void change_number(made_simulation *made) { made->simulation.particles.num_particles = 2; }

static const refusal refusals[] = {
    {"gravity", SCREE_INVALID_INPUT, "gravity", change_gravity},
    {"law", SCREE_INVALID_INPUT, "contact laws", change_law},
    {"wall", SCREE_INVALID_INPUT, "walls", change_wall},
    {"mesh", SCREE_INVALID_INPUT, "shapes", change_mesh},
    {"scheme", SCREE_INVALID_INPUT, "overlap scheme", change_scheme},
    {"time step", SCREE_INVALID_INPUT, "time step of 0.01 s", change_time_step},
    {"mass", SCREE_INVALID_INPUT, "another mass", change_mass},
    {"shape", SCREE_INVALID_INPUT, "another shape", change_shape},
    {"number", SCREE_INVALID_INPUT, "has 3 particles, the scene has 2", change_number},
};

/// Loading must fail like this and leave the simulation alone.
static void check_refused(made_simulation *made, const char *path, scree_status status, const char *message)
{
    const uint64_t before = hash_all(&made->simulation);
    scree_report report = {0};
    SCREE_CHECK_INT(scree_checkpoint_load(&made->simulation, path, &report), status);
    SCREE_CHECK(hash_all(&made->simulation) == before);
    SCREE_CHECK(report.num_messages >= 1);
    if (report.num_messages > 0) SCREE_CHECK_CONTAINS(report.messages[0], message);
    scree_report_clear(&report);
    SCREE_CHECK_INT(scree_checkpoint_load(&made->simulation, path, NULL), status);
}

static void write_checkpoint(const char *path)
{
    made_simulation made;
    made_simulation_create(&made);
    made_simulation_set_step(&made, 7);
    made_simulation_set_contacts(&made, 5);
    SCREE_CHECK_INT(scree_checkpoint_save(&made.simulation, path, NULL), SCREE_OK);
    made_simulation_destroy(&made);
}

/// The state of write_checkpoint(), in a simulation that can be loaded into.
static void make_loadable(made_simulation *made)
{
    made_simulation_create(made);
    made_simulation_set_step(made, 7);
    made_simulation_set_contacts(made, 5);
    SCREE_CHECK_INT(scree_step_buffers_create(&made->simulation), SCREE_OK);
}

static void test_another_scene_is_refused(void)
{
    const char *path = path_in(scree_test_folder(), "checkpoint.h5");
    write_checkpoint(path);
    for (size_t k = 0; k < sizeof refusals / sizeof refusals[0]; ++k)
    {
        made_simulation made;
        made_simulation_create(&made);
        refusals[k].change(&made);
        check_refused(&made, path, refusals[k].status, refusals[k].message);
        made_simulation_destroy(&made);
    }
}

/// What does not act on the particles may be another.
static void test_end_and_output_may_change(void)
{
    char path[512], text[sizeof scene_text + 64];
    snprintf(path, sizeof path, "%s/checkpoint.h5", scree_test_folder());
    scene_run first, second;
    scene_run_start(&first, scene_text);
    scene_run_until(&first, 0.001);
    SCREE_CHECK_INT(scree_checkpoint_save(first.simulation, path, NULL), SCREE_OK);
    snprintf(text, sizeof text, "%soutput: {frames: 0.001}\n", scene_text);
    memcpy(strstr(text, "0.02"), "9.99", 4);
    memcpy(strstr(text, "name: checkpoint"), "name: other_name", 16);
    scene_run_start(&second, text);
    SCREE_CHECK_INT(scree_checkpoint_load(second.simulation, path, &second.report), SCREE_OK);
    SCREE_CHECK(hash_all(second.simulation) == hash_all(first.simulation));
    scene_run_end(&second);
    scene_run_end(&first);
}

// ---- damage

/// Writes `value` over item 0 of a dataset.
static void overwrite(const char *path, const char *dataset_name, double value)
{
    const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT), dataset = H5Dopen2(file, dataset_name, H5P_DEFAULT);
    const hid_t space = H5Dget_space(dataset), one = H5Screate(H5S_SCALAR);
    const hsize_t start[2] = {0, 0}, count[2] = {1, 1};
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL);
    SCREE_CHECK(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, one, space, H5P_DEFAULT, &value) >= 0);
    H5Sclose(one);
    H5Sclose(space);
    H5Dclose(dataset);
    H5Fclose(file);
}

/// Deletes a link or an attribute ("@name") of the root.
static void take_out(const char *path, const char *name)
{
    const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    SCREE_CHECK((name[0] == '@' ? H5Adelete(file, name + 1) : H5Ldelete(file, name, H5P_DEFAULT)) >= 0);
    H5Fclose(file);
}

static void test_changed_contents_are_refused(void)
{
    const char *path = path_in(scree_test_folder(), "checkpoint.h5");
    made_simulation made;
    made_simulation_create(&made);
    int num_fields;
    const scree_field *fields = scree_particle_fields(&num_fields);
    for (int k = 0; k < num_fields; ++k)
    {
        char name[64];
        snprintf(name, sizeof name, "/particles/%s", fields[k].name);
        write_checkpoint(path);
        overwrite(path, name, 7.25);
        check_refused(&made, path, SCREE_READ_FAILED, "damaged");
        write_checkpoint(path);
        take_out(path, name);
        check_refused(&made, path, SCREE_READ_FAILED, "damaged");
    }
    fields = scree_contact_fields(&num_fields);
    for (int k = 0; k < num_fields; ++k)
    {
        char name[64];
        snprintf(name, sizeof name, "/contacts/%s", fields[k].name);
        write_checkpoint(path);
        overwrite(path, name, 77);
        check_refused(&made, path, SCREE_READ_FAILED, "damaged");
    }
    static const char *const parts[] = {"/now", "/contacts", "@contents_hash"};
    for (size_t k = 0; k < sizeof parts / sizeof parts[0]; ++k)
    {
        write_checkpoint(path);
        take_out(path, parts[k]);
        check_refused(&made, path, SCREE_READ_FAILED, "damaged");
    }
    made_simulation_destroy(&made);
}

/// A file that holds such a state cannot have come from a healthy run, even if its hashes are right.
static void test_numbers_out_of_range_are_refused(void)
{
    const char *path = path_in(scree_test_folder(), "checkpoint.h5");
    made_simulation sick, made;
    made_simulation_create(&sick);
    made_simulation_create(&made);
    made_simulation_set_contacts(&sick, 4);
    const scree_vec3 velocity = sick.simulation.particles.velocity[1];
    sick.simulation.particles.velocity[1].y = (scree_real)NAN;
    SCREE_CHECK_INT(scree_checkpoint_save(&sick.simulation, path, NULL), SCREE_OK);
    check_refused(&made, path, SCREE_READ_FAILED, "velocity of particle 1 is not finite");
    sick.simulation.particles.velocity[1] = velocity;

    sick.simulation.contacts.bodies[3].j = MADE_PARTICLES + MADE_WALLS;
    SCREE_CHECK_INT(scree_checkpoint_save(&sick.simulation, path, NULL), SCREE_OK);
    check_refused(&made, path, SCREE_READ_FAILED, "bodies that do not exist");
    sick.simulation.contacts.bodies[3] = sick.simulation.contacts.bodies[0];
    SCREE_CHECK_INT(scree_checkpoint_save(&sick.simulation, path, NULL), SCREE_OK);
    check_refused(&made, path, SCREE_READ_FAILED, "out of order");
    made_simulation_destroy(&sick);
    made_simulation_destroy(&made);
}

static void test_other_files_are_refused(void)
{
    char path[512];
    snprintf(path, sizeof path, "%s/checkpoint.h5", scree_test_folder());
    made_simulation made;
    made_simulation_create(&made);
    check_refused(&made, path, SCREE_NOT_FOUND, "there is no checkpoint");
    FILE *file = fopen(path, "w");
    fputs("not HDF5", file);
    fclose(file);
    check_refused(&made, path, SCREE_READ_FAILED, "could not be opened");
    H5Fclose(H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
    check_refused(&made, path, SCREE_READ_FAILED, "is not a checkpoint of scree");
    made_simulation_destroy(&made);
}

/// Cut short anywhere: refused, or whole because only padding was cut off.
static void test_short_files_are_refused(void)
{
    char path[512];
    snprintf(path, sizeof path, "%s/checkpoint.h5", scree_test_folder());
    write_checkpoint(path);
    made_simulation made, other;
    make_loadable(&made);
    made_simulation_create(&other);
    const uint64_t right = hash_all(&made.simulation), before = hash_all(&other.simulation);
    struct stat info;
    SCREE_CHECK(stat(path, &info) == 0);
    int num_refused = 0;
    for (off_t size = info.st_size - 1; size > 0; size -= 1 + size / 40)
    {
        SCREE_CHECK(truncate(path, size) == 0);
        const scree_status status = scree_checkpoint_load(&made.simulation, path, NULL);
        SCREE_CHECK(status == SCREE_OK || status == SCREE_READ_FAILED);
        SCREE_CHECK(hash_all(&made.simulation) == right);
        if (status == SCREE_OK) continue;
        ++num_refused;
        SCREE_CHECK_INT(scree_checkpoint_load(&other.simulation, path, NULL), SCREE_READ_FAILED);
        SCREE_CHECK(hash_all(&other.simulation) == before);
    }
    SCREE_CHECK(num_refused > 100);
    scree_step_buffers_destroy(&made.simulation);
    made_simulation_destroy(&made);
    made_simulation_destroy(&other);
}

/// Random bytes anywhere: loaded unchanged (the byte was not part of the state) or refused, never half of each.
static void test_random_damage_is_never_half_loaded(void)
{
    char path[512];
    snprintf(path, sizeof path, "%s/checkpoint.h5", scree_test_folder());
    write_checkpoint(path);
    made_simulation original;
    make_loadable(&original);
    const uint64_t right = hash_all(&original.simulation);
    char *text = calloc(1, 1 << 20);
    FILE *file = fopen(path, "rb");
    const size_t size = fread(text, 1, 1 << 20, file);
    fclose(file);
    uint64_t random = 5;
    int num_refused = 0;
    for (int trial = 0; trial < 150; ++trial)
    {
        const size_t place = (size_t)(scree_test_random(&random) * (double)size);
        const char byte = text[place];
        text[place] = (char)scree_test_random_bits(&random);
        file = fopen(path, "wb");
        fwrite(text, 1, size, file);
        fclose(file);
        const scree_status status = scree_checkpoint_load(&original.simulation, path, NULL);
        if (status != SCREE_OK) ++num_refused;
        if (hash_all(&original.simulation) != right)
            printf("byte %zu of %zu, trial %d, status %d\n", place, size, trial, status);
        SCREE_CHECK(hash_all(&original.simulation) == right);
        text[place] = byte;
    }
    SCREE_CHECK(num_refused > 5);
    free(text);
    scree_step_buffers_destroy(&original.simulation);
    made_simulation_destroy(&original);
}

// ---- accidents

/// In a child: checkpoints of steps 1, 2, 3, ... as fast as possible.
static void save_until_killed(const char *path)
{
    made_simulation made;
    made_simulation_create(&made);
    for (int64_t step = 1;; ++step)
    {
        made_simulation_set_step(&made, step);
        made_simulation_set_contacts(&made, step % 5);
        if (scree_checkpoint_save(&made.simulation, path, NULL) != SCREE_OK) _exit(1);
    }
}

static void test_a_kill_keeps_the_checkpoint_before(void)
{
    char path[512];
    snprintf(path, sizeof path, "%s/checkpoint.h5", scree_test_folder());
    write_checkpoint(path);
    uint64_t random = 3;
    int num_new = 0;
    for (int trial = 0; trial < 40; ++trial)
    {
        fflush(stdout);
        const pid_t child = fork();
        if (child < 0) exit(EXIT_FAILURE); // kill(-1) would end everything
        if (child == 0) save_until_killed(path);
        const struct timespec wait = {0, (long)(scree_test_random(&random) * 2e7)};
        nanosleep(&wait, NULL);
        kill(child, SIGKILL);
        int state;
        waitpid(child, &state, 0);
        SCREE_CHECK(WIFSIGNALED(state));
        made_simulation made, expected;
        made_simulation_create(&made);
        made_simulation_create(&expected);
        SCREE_CHECK_INT(scree_step_buffers_create(&made.simulation), SCREE_OK);
        SCREE_CHECK_INT(scree_checkpoint_load(&made.simulation, path, NULL), SCREE_OK);
        made_simulation_set_step(&expected, made.simulation.step);
        made_simulation_set_contacts(&expected, made.simulation.step == 7 ? 5 : made.simulation.step % 5);
        if (made.simulation.step != 7)
        {
            ++num_new;
            SCREE_CHECK(hash_all(&made.simulation) == hash_all(&expected.simulation));
        }
        scree_step_buffers_destroy(&made.simulation);
        made_simulation_destroy(&made);
        made_simulation_destroy(&expected);
    }
    SCREE_CHECK(num_new > 5);
}

/// Writes a checkpoint that does not fit; 0 if that is told properly.
static int save_beyond_limit(const char *path)
{
    made_simulation made;
    made_simulation_create(&made);
    made_simulation_set_contacts(&made, 100);
    scree_report report = {0};
    if (scree_checkpoint_save(&made.simulation, path, &report) != SCREE_WRITE_FAILED) return 1;
    if (report.num_messages != 1) return 2;
    return strstr(report.messages[0], "File too large") != NULL ? 0 : 3;
}

static void test_a_full_disk_keeps_the_checkpoint_before(void)
{
    char path[512], temporary[520];
    snprintf(path, sizeof path, "%s/checkpoint.h5", scree_test_folder());
    snprintf(temporary, sizeof temporary, "%s.tmp", path);
    write_checkpoint(path);
    static const size_t limits[] = {1, 500, 3000, 20000, 70000, 80000, 90000};
    for (size_t k = 0; k < sizeof limits / sizeof limits[0]; ++k)
    {
        fflush(stdout);
        const pid_t child = fork();
        if (child == 0)
        {
            const struct rlimit limit = {limits[k], limits[k]};
            signal(SIGXFSZ, SIG_IGN);
            if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(99);
            _exit(save_beyond_limit(path));
        }
        int state;
        waitpid(child, &state, 0);
        SCREE_CHECK(WIFEXITED(state));
        SCREE_CHECK_INT(WEXITSTATUS(state), 0);
        SCREE_CHECK(access(temporary, F_OK) != 0);
        made_simulation made;
        made_simulation_create(&made);
        SCREE_CHECK_INT(scree_step_buffers_create(&made.simulation), SCREE_OK);
        SCREE_CHECK_INT(scree_checkpoint_load(&made.simulation, path, NULL), SCREE_OK);
        SCREE_CHECK_INT(made.simulation.step, 7);
        scree_step_buffers_destroy(&made.simulation);
        made_simulation_destroy(&made);
    }
}

int main(void)
{
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    SCREE_RUN(test_a_restart_is_the_unbroken_run);
    SCREE_RUN(test_equal_states_are_equal_files);
    SCREE_RUN(test_another_scene_is_refused);
    SCREE_RUN(test_end_and_output_may_change);
    SCREE_RUN(test_changed_contents_are_refused);
    SCREE_RUN(test_numbers_out_of_range_are_refused);
    SCREE_RUN(test_other_files_are_refused);
    SCREE_RUN(test_short_files_are_refused);
    SCREE_RUN(test_random_damage_is_never_half_loaded);
    SCREE_RUN(test_a_kill_keeps_the_checkpoint_before);
    SCREE_RUN(test_a_full_disk_keeps_the_checkpoint_before);
    return SCREE_TEST_END();
}
