// The files of a run folder: what is in them, what a restart keeps, and that a kill, a full disk or a second run at any
// moment leaves them readable. Everything is read back with plain HDF5 and C, not with the code that wrote it.
#define _XOPEN_SOURCE 700
#include "made_simulation.h"
#include "test_folder.h"

#include "scree/io.h"

#include <errno.h>
#include <hdf5.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const scree_scene_file scene_file = {.text = (char *)"name: made\n"};

// ---- reading back

static char *in_folder(const char *folder, const char *name)
{
    static char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

/// The whole file with a final zero; the caller frees it. NULL if there is no such file.
static char *read_text(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) return NULL;
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(*size + 1);
    if (text != NULL) text[fread(text, 1, *size, file)] = '\0';
    fclose(file);
    return text;
}

/// All numbers of a dataset of a file as double, and how many there are; the caller frees them.
static double *read_numbers(const char *path, const char *dataset_name, int64_t *num)
{
    *num = -1;
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) return NULL;
    double *numbers = NULL;
    const hid_t dataset = H5Dopen2(file, dataset_name, H5P_DEFAULT);
    if (dataset >= 0)
    {
        const hid_t space = H5Dget_space(dataset);
        *num = (int64_t)H5Sget_simple_extent_npoints(space);
        numbers = malloc((size_t)(*num + 1) * sizeof *numbers);
        if (numbers != NULL && H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) < 0)
            *num = -1;
        H5Sclose(space);
        H5Dclose(dataset);
    }
    H5Fclose(file);
    return numbers;
}

static double read_number(const char *path, const char *dataset, int64_t k)
{
    int64_t num;
    double *numbers = read_numbers(path, dataset, &num);
    const double value = k < num ? numbers[k] : (double)NAN;
    free(numbers);
    return value;
}

/// NSteps, or -1 if the file cannot be read or its times are not as many.
static int64_t read_num_steps(const char *path)
{
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) return -1;
    int64_t num_steps = -1, num_times = 0;
    const hid_t attribute = H5Aopen_by_name(file, "/VTKHDF/Steps", "NSteps", H5P_DEFAULT, H5P_DEFAULT);
    if (attribute >= 0)
    {
        H5Aread(attribute, H5T_NATIVE_INT64, &num_steps);
        H5Aclose(attribute);
    }
    H5Fclose(file);
    free(read_numbers(path, "/VTKHDF/Steps/Values", &num_times));
    return num_steps == num_times ? num_steps : -1;
}

/// NSteps of a file that this process is writing, which HDF5 does not open twice: of a copy.
static int64_t read_num_steps_of_copy(const char *path)
{
    size_t size = 0;
    char *text = read_text(path, &size), copy[600];
    snprintf(copy, sizeof copy, "%s.copy", path);
    FILE *file = fopen(copy, "wb");
    SCREE_CHECK(file != NULL && text != NULL && fwrite(text, 1, size, file) == size);
    if (file != NULL) fclose(file);
    free(text);
    return read_num_steps(copy);
}

/// The point `row` of /VTKHDF/Points.
static scree_vec3 read_point(const char *path, int64_t row)
{
    int64_t num;
    double *points = read_numbers(path, "/VTKHDF/Points", &num);
    scree_vec3 point = scree_vec3_make((scree_real)NAN, 0, 0);
    if (3 * row + 2 < num)
        point = scree_vec3_make((scree_real)points[3 * row], (scree_real)points[3 * row + 1],
                                (scree_real)points[3 * row + 2]);
    free(points);
    return point;
}

// ---- writing

static scree_run_folder *open_folder(const char *path, const made_simulation *made, bool replace, bool restart)
{
    scree_run_folder *folder = NULL;
    const scree_run_folder_def def = {path, &scene_file, replace, restart};
    SCREE_CHECK_INT(scree_run_folder_open(&folder, &def, &made->simulation, NULL), SCREE_OK);
    return folder;
}

/// Contacts at a step: none at all in every third.
static int64_t contacts_at(int64_t step) { return step % 3 == 0 ? 0 : step % 5 + 1; }

/// Moves on to `step`: wall 1 moves from step 4 on and is gone from step 8 on.
static void go_to(made_simulation *made, int64_t step)
{
    made_simulation_set_step(made, step);
    made_simulation_set_contacts(made, contacts_at(step));
    if (step > 4) made->walls[1].pose.position.z = (scree_real)(step - 4);
    made->walls[1].is_present = step < 8;
}

/// Rows and frames of the steps first .. last.
static void write_steps(scree_run_folder *folder, made_simulation *made, int64_t first, int64_t last)
{
    for (int64_t step = first; step <= last; ++step)
    {
        go_to(made, step);
        SCREE_CHECK_INT(scree_run_folder_write_series(folder, &made->simulation, NULL), SCREE_OK);
        SCREE_CHECK_INT(scree_run_folder_write_frame(folder, &made->simulation, NULL), SCREE_OK);
    }
}

/// A whole run of the steps 0 .. last in a new folder below `base`; the path is in `folder`.
static void write_run(const char *base, const char *name, int64_t last, char folder[400])
{
    made_simulation made;
    made_simulation_create(&made);
    snprintf(folder, 400, "%s/%s", base, name);
    scree_run_folder *run = open_folder(folder, &made, false, false);
    write_steps(run, &made, 0, last);
    SCREE_CHECK_INT(scree_run_folder_close(run, NULL), SCREE_OK);
    made_simulation_destroy(&made);
}

static bool is_same_file(const char *first, const char *second, const char *name)
{
    size_t sizes[2] = {0, 1};
    char *texts[2];
    texts[0] = read_text(in_folder(first, name), sizes);
    texts[1] = read_text(in_folder(second, name), sizes + 1);
    const bool is_same =
        texts[0] != NULL && texts[1] != NULL && sizes[0] == sizes[1] && memcmp(texts[0], texts[1], sizes[0]) == 0;
    free(texts[0]);
    free(texts[1]);
    return is_same;
}

// ---- series

static void test_series_has_a_header_and_a_row_per_time(void)
{
    char folder[400];
    write_run(scree_test_folder(), "run", 3, folder);
    size_t size;
    char *text = read_text(in_folder(folder, "series.csv"), &size);
    SCREE_CHECK(text != NULL);
    if (text == NULL) return;
    SCREE_CHECK(strncmp(text, "time [s],step [1],kinetic [J],", 30) == 0);
    int num_lines = 0;
    const char *last = text;
    for (const char *c = text; *c != '\0'; ++c)
        if (*c == '\n' && ++num_lines == 4) last = c + 1;
    SCREE_CHECK_INT(num_lines, 5);
    // step 3: speeds 3*3, 4*3, masses 2 + 3 + 4: 1/2 * 9 * 15^2; friction 0.25 * 3
    double time, step, kinetic, unused[5], friction;
    SCREE_CHECK_INT(sscanf(last, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &time, &step, &kinetic, unused, unused + 1,
                           unused + 2, unused + 3, unused + 4, &friction),
                    9);
    SCREE_CHECK(time == 3 * 0.01 && step == 3 && friction == 0.75);
    SCREE_CHECK_CLOSE(kinetic, 1012.5, 1e-10);
    free(text);
}

/// Steps 0 .. 9 in one go, against 0 .. 7, a partial line as a kill leaves it, and a restart from step 5.
static void test_series_after_a_restart_is_the_unbroken_one(void)
{
    const char *base = scree_test_folder();
    char whole[400], broken[400];
    write_run(base, "whole", 9, whole);
    write_run(base, "broken", 7, broken);
    FILE *file = fopen(in_folder(broken, "series.csv"), "ab");
    fputs("0.08,8,1.5", file);
    fclose(file);

    made_simulation made;
    made_simulation_create(&made);
    go_to(&made, 5);
    scree_run_folder *run = open_folder(broken, &made, false, true);
    // the largest energy of the rows that are kept, which is that of step 5
    double kept = scree_run_folder_energy_turned_over(run);
    const scree_energies e = scree_simulation_energies(&made.simulation);
    SCREE_CHECK_CLOSE(kept, e.kinetic + e.rotational + e.elastic_normal + e.elastic_tangential + e.friction,
                      1e-12 * kept);
    write_steps(run, &made, 5, 9);
    SCREE_CHECK_INT(scree_run_folder_close(run, NULL), SCREE_OK);
    SCREE_CHECK(is_same_file(whole, broken, "series.csv"));
    made_simulation_destroy(&made);
}

// ---- frames

/// Where point `v` of particle i is, by the formula of the rotation by a quaternion.
static void expected_point(const scree_particles *p, int i, scree_vec3 body, double x[3])
{
    const double w = (double)p->orientation[i].w,
                 a[3] = {(double)p->orientation[i].x, (double)p->orientation[i].y, (double)p->orientation[i].z};
    const double s = (double)p->scale[i], v[3] = {s * (double)body.x, s * (double)body.y, s * (double)body.z};
    const double t[3] = {2 * (a[1] * v[2] - a[2] * v[1]), 2 * (a[2] * v[0] - a[0] * v[2]),
                         2 * (a[0] * v[1] - a[1] * v[0])};
    const double c[3] = {(double)p->position[i].x, (double)p->position[i].y, (double)p->position[i].z};
    for (int k = 0; k < 3; ++k)
        x[k] = c[k] + v[k] + w * t[k] + a[(k + 1) % 3] * t[(k + 2) % 3] - a[(k + 2) % 3] * t[(k + 1) % 3];
}

static void check_particle_frame(const char *path, made_simulation *made, int64_t frame)
{
    go_to(made, frame);
    int64_t num;
    double *points = read_numbers(path, "/VTKHDF/Points", &num);
    const int64_t offset = (int64_t)read_number(path, "/VTKHDF/Steps/PointOffsets", frame);
    SCREE_CHECK(points != NULL && num >= 3 * (offset + MADE_VERTICES));
    if (points == NULL) return;
    double worst = 0;
    const double *point = points + 3 * offset;
    for (int i = 0; i < MADE_PARTICLES; ++i)
    {
        const scree_shape_view *shape = made->views + made->simulation.particles.shape[i];
        for (int v = 0; v < shape->num_vertices; ++v, point += 3)
        {
            double x[3];
            expected_point(&made->simulation.particles, i, shape->vertices[v], x);
            for (int k = 0; k < 3; ++k) worst = fmax(worst, fabs(point[k] - x[k]));
        }
    }
    SCREE_CHECK_CLOSE(worst, 0, 30 * (double)FLT_EPSILON); // coordinates up to 30 m, stored as float
    // speeds are 5 per step
    SCREE_CHECK(read_number(path, "/VTKHDF/PointData/speed", offset) == 5 * (double)frame);
    free(points);
}

static void test_particle_frames_hold_the_placed_surfaces(void)
{
    char folder[400];
    write_run(scree_test_folder(), "run", 9, folder);
    made_simulation made;
    made_simulation_create(&made);
    const char *path = in_folder(folder, "frames.vtkhdf");
    SCREE_CHECK_INT(read_num_steps(path), 10);
    for (int64_t frame = 0; frame < 10; ++frame)
    {
        SCREE_CHECK(read_number(path, "/VTKHDF/Steps/Values", frame) == 0.01 * (double)frame);
        check_particle_frame(path, &made, frame);
    }
    // one set of triangles for all steps: the part of all is the same
    int64_t num;
    double *parts = read_numbers(path, "/VTKHDF/Steps/PartOffsets", &num);
    for (int64_t k = 0; parts != NULL && k < 10; ++k) SCREE_CHECK(parts[k] == parts[0]);
    SCREE_CHECK(parts != NULL &&
                read_number(path, "/VTKHDF/Polygons/NumberOfCells", (int64_t)parts[0]) == MADE_TRIANGLES);
    // the box is the second particle: its first triangle is 0 2 1, its first vertex number 4
    const int64_t row = (int64_t)read_number(path, "/VTKHDF/Steps/ConnectivityIdOffsets", 2) + 3 * 4;
    SCREE_CHECK(read_number(path, "/VTKHDF/Polygons/Connectivity", row + 0) == 4);
    SCREE_CHECK(read_number(path, "/VTKHDF/Polygons/Connectivity", row + 1) == 6);
    SCREE_CHECK(read_number(path, "/VTKHDF/Polygons/Connectivity", row + 2) == 5);
    SCREE_CHECK(read_number(path, "/VTKHDF/PointData/particle", 3) == 0);
    SCREE_CHECK(read_number(path, "/VTKHDF/PointData/particle", 4) == 1);
    SCREE_CHECK(read_number(path, "/VTKHDF/PointData/group", 12) == 1);
    free(parts);
    made_simulation_destroy(&made);
}

static void test_walls_are_written_when_they_change(void)
{
    char folder[400];
    write_run(scree_test_folder(), "run", 9, folder);
    const char *path = in_folder(folder, "walls.vtkhdf");
    SCREE_CHECK_INT(read_num_steps(path), 10);
    int64_t num;
    double *parts = read_numbers(path, "/VTKHDF/Steps/PartOffsets", &num);
    SCREE_CHECK(parts != NULL && num >= 10);
    if (parts == NULL) return;
    // at rest until step 4, moving until 7, then one wall less and at rest again
    for (int k = 0; k < 10; ++k)
    {
        const int changes = k <= 4 ? 0 : (k <= 8 ? k - 4 : 4);
        SCREE_CHECK_INT(parts[k] - parts[0], changes);
        SCREE_CHECK_INT(read_number(path, "/VTKHDF/Polygons/NumberOfCells", (int64_t)parts[k]), k < 8 ? 24 : 12);
    }
    const int64_t offset = (int64_t)read_number(path, "/VTKHDF/Steps/PointOffsets", 6);
    SCREE_CHECK(read_point(path, offset + 8).z == 2);
    SCREE_CHECK(read_number(path, "/VTKHDF/PointData/wall", offset + 7) == 0);
    SCREE_CHECK(read_number(path, "/VTKHDF/PointData/wall", offset + 8) == 1);
    free(parts);
}

/// Lines of one frame of contacts.vtkhdf against the contact list.
static void check_contact_frame(const char *path, made_simulation *made, int64_t frame)
{
    go_to(made, frame);
    const scree_contact_list *contacts = &made->simulation.contacts;
    const int64_t part = (int64_t)read_number(path, "/VTKHDF/Steps/PartOffsets", frame);
    SCREE_CHECK_INT(read_number(path, "/VTKHDF/Lines/NumberOfCells", part), contacts->num_contacts);
    const int64_t cell = (int64_t)read_number(path, "/VTKHDF/Steps/CellOffsets", 4 * frame + 1);
    const int64_t id = (int64_t)read_number(path, "/VTKHDF/Steps/ConnectivityIdOffsets", 4 * frame + 1);
    const int64_t point = (int64_t)read_number(path, "/VTKHDF/Steps/PointOffsets", frame);
    int64_t first = 0;
    for (int64_t c = 0; c < contacts->num_contacts; ++c)
    {
        // VTK: the offsets of part p begin at (cells before it) + p
        SCREE_CHECK_INT(read_number(path, "/VTKHDF/Lines/Offsets", cell + part + c), first);
        const int64_t num = (int64_t)read_number(path, "/VTKHDF/Lines/Offsets", cell + part + c + 1) - first;
        SCREE_CHECK_INT(num, contacts->bodies[c].j < MADE_PARTICLES ? 3 : 2);
        for (int64_t k = 0; k < num; ++k)
            SCREE_CHECK_INT(read_number(path, "/VTKHDF/Lines/Connectivity", id + first + k), first + k);
        const scree_vec3 centre = made->simulation.particles.position[contacts->bodies[c].i];
        const scree_vec3 place = scree_vec3_add(centre, contacts->arm[c]);
        SCREE_CHECK_CLOSE(read_point(path, point + first).y, centre.y, 1e-6 * (1 + fabs((double)centre.y)));
        SCREE_CHECK_CLOSE(read_point(path, point + first + 1).x, place.x, 1e-6 * (1 + fabs((double)place.x)));
        const double x = 1 + (double)c / 7;
        SCREE_CHECK_CLOSE(read_number(path, "/VTKHDF/CellData/normal_force", cell + c), 10 * x, 1e-5);
        SCREE_CHECK_CLOSE(read_number(path, "/VTKHDF/CellData/tangential_force", cell + c), 5 * x, 1e-5);
        SCREE_CHECK_INT(read_number(path, "/VTKHDF/CellData/j", cell + c), contacts->bodies[c].j);
        SCREE_CHECK_INT(read_number(path, "/VTKHDF/CellData/slipping", cell + c), contacts->is_slipping[c]);
        first += num;
    }
}

static void test_contact_frames_hold_the_contacts(void)
{
    char folder[400];
    write_run(scree_test_folder(), "run", 9, folder);
    made_simulation made;
    made_simulation_create(&made);
    const char *path = in_folder(folder, "contacts.vtkhdf");
    SCREE_CHECK_INT(read_num_steps(path), 10);
    for (int64_t frame = 0; frame < 10; ++frame) check_contact_frame(path, &made, frame);
    made_simulation_destroy(&made);
}

/// More frames than the scene announces (12) and more contacts than there was room for: the files are copied into
/// larger ones several times.
static void test_files_grow_beyond_what_was_expected(void)
{
    char folder[400];
    write_run(scree_test_folder(), "run", 60, folder);
    made_simulation made;
    made_simulation_create(&made);
    SCREE_CHECK_INT(read_num_steps(in_folder(folder, "frames.vtkhdf")), 61);
    SCREE_CHECK_INT(read_num_steps(in_folder(folder, "walls.vtkhdf")), 61);
    SCREE_CHECK_INT(read_num_steps(in_folder(folder, "contacts.vtkhdf")), 61);
    for (int64_t frame = 0; frame <= 60; frame += 10)
    {
        check_particle_frame(in_folder(folder, "frames.vtkhdf"), &made, frame);
        check_contact_frame(in_folder(folder, "contacts.vtkhdf"), &made, frame);
    }
    SCREE_CHECK(access(in_folder(folder, "contacts.vtkhdf.grow"), F_OK) != 0);
    made_simulation_destroy(&made);
}

static void test_frames_after_a_restart_are_the_unbroken_ones(void)
{
    const char *base = scree_test_folder();
    char broken[400];
    write_run(base, "broken", 7, broken);
    made_simulation made;
    made_simulation_create(&made);
    go_to(&made, 5);
    scree_run_folder *run = open_folder(broken, &made, false, true);
    // dropped at once: frames 6 and 7 belong to the run that was lost
    SCREE_CHECK_INT(read_num_steps_of_copy(in_folder(broken, "frames.vtkhdf")), 6);
    SCREE_CHECK_INT(read_num_steps_of_copy(in_folder(broken, "contacts.vtkhdf")), 6);
    write_steps(run, &made, 5, 40);
    SCREE_CHECK_INT(scree_run_folder_close(run, NULL), SCREE_OK);
    SCREE_CHECK_INT(read_num_steps(in_folder(broken, "walls.vtkhdf")), 41);
    SCREE_CHECK_INT(read_num_steps(in_folder(broken, "frames.vtkhdf")), 41);
    for (int64_t frame = 0; frame <= 40; frame += 4)
    {
        check_particle_frame(in_folder(broken, "frames.vtkhdf"), &made, frame);
        check_contact_frame(in_folder(broken, "contacts.vtkhdf"), &made, frame);
    }
    made_simulation_destroy(&made);
}

/// What changes in the structure of the file from one frame to the next are the number of steps and the length of the
/// times, next to each other and in one page: that is what makes a step appear at once or not at all.
static void test_a_step_appears_in_one_place(void)
{
    static const char *const names[] = {"frames.vtkhdf", "walls.vtkhdf", "contacts.vtkhdf"};
    char folder[400];
    snprintf(folder, sizeof folder, "%s/run", scree_test_folder());
    made_simulation made;
    made_simulation_create(&made);
    scree_run_folder *run = open_folder(folder, &made, false, false);
    made_simulation_set_contacts(&made, 2);
    SCREE_CHECK_INT(scree_run_folder_write_frame(run, &made.simulation, NULL), SCREE_OK);
    for (int k = 0; k < 3; ++k)
    {
        size_t before_size, after_size;
        char *before = read_text(in_folder(folder, names[k]), &before_size);
        made_simulation_set_step(&made, k + 1);
        SCREE_CHECK_INT(scree_run_folder_write_frame(run, &made.simulation, NULL), SCREE_OK);
        char *after = read_text(in_folder(folder, names[k]), &after_size);
        SCREE_CHECK_INT(before_size, after_size);
        // the library keeps the structure in the first 64 KiB, the numbers behind them
        size_t first = 65536, last = 0;
        int num = 0;
        for (size_t i = 0; before != NULL && after != NULL && i < 65536; ++i)
            if (before[i] != after[i])
            {
                if (i < first) first = i;
                last = i;
                ++num;
            }
        SCREE_CHECK_INT(num, 2);
        SCREE_CHECK(last - first < 64);
        SCREE_CHECK_INT(first / 4096, last / 4096);
        free(before);
        free(after);
    }
    scree_run_folder_close(run, NULL);
    made_simulation_destroy(&made);
}

// ---- accidents

/// In a child: frames as fast as possible, until it is killed.
static void write_until_killed(const char *path)
{
    made_simulation made;
    made_simulation_create(&made);
    const scree_run_folder_def def = {path, &scene_file, true, false};
    scree_run_folder *folder = NULL;
    if (scree_run_folder_open(&folder, &def, &made.simulation, NULL) != SCREE_OK) _exit(1);
    for (int64_t step = 0; step < 1000000; ++step)
    {
        go_to(&made, step);
        if (scree_run_folder_write_series(folder, &made.simulation, NULL) != SCREE_OK) _exit(1);
        if (scree_run_folder_write_frame(folder, &made.simulation, NULL) != SCREE_OK) _exit(1);
    }
    _exit(0);
}

static void sleep_microseconds(long microseconds)
{
    const struct timespec time = {microseconds / 1000000, microseconds % 1000000 * 1000};
    nanosleep(&time, NULL);
}

/// Kills a run so many microseconds after its first frame, or after its start if that is sooner; returns the frames it
/// leaves, or -1 if a file cannot be read.
static int64_t killed_run(const char *folder, bool from_start, long microseconds)
{
    unlink(in_folder(folder, "frames.vtkhdf"));
    const pid_t child = fork();
    if (child < 0) exit(EXIT_FAILURE); // kill(-1) would end everything
    if (child == 0) write_until_killed(folder);
    for (int k = 0; k < 20000 && !from_start && access(in_folder(folder, "frames.vtkhdf"), F_OK) != 0; ++k)
        sleep_microseconds(200);
    sleep_microseconds(microseconds);
    kill(child, SIGKILL);
    int state;
    waitpid(child, &state, 0);
    SCREE_CHECK(WIFSIGNALED(state));
    if (access(in_folder(folder, "frames.vtkhdf"), F_OK) != 0) return 0;
    const int64_t num_frames = read_num_steps(in_folder(folder, "frames.vtkhdf"));
    const int64_t num_walls = read_num_steps(in_folder(folder, "walls.vtkhdf"));
    const int64_t num_contacts = read_num_steps(in_folder(folder, "contacts.vtkhdf"));
    // walls first, particles last: a file may be one frame ahead of the next
    SCREE_CHECK(num_contacts >= num_frames && num_contacts <= num_frames + 1);
    SCREE_CHECK(num_walls >= num_contacts && num_walls <= num_contacts + 1);
    return num_frames;
}

static void test_a_killed_run_leaves_readable_files(void)
{
    char folder[400];
    snprintf(folder, sizeof folder, "%s/run", scree_test_folder());
    made_simulation made;
    made_simulation_create(&made);
    uint64_t random = 11;
    int num_long = 0;
    for (int trial = 0; trial < 60; ++trial)
    {
        const long wait = (long)(scree_test_random(&random) * 20000);
        const int64_t num_frames = killed_run(folder, trial % 4 == 0, wait);
        SCREE_CHECK(num_frames >= 0);
        if (num_frames < 2) continue;
        ++num_long;
        check_particle_frame(in_folder(folder, "frames.vtkhdf"), &made, num_frames - 1);
        check_contact_frame(in_folder(folder, "contacts.vtkhdf"), &made, num_frames - 1);
        check_contact_frame(in_folder(folder, "contacts.vtkhdf"), &made, num_frames / 2);
        // and it can be gone on with
        go_to(&made, num_frames - 1);
        scree_run_folder *run = open_folder(folder, &made, false, true);
        write_steps(run, &made, num_frames, num_frames);
        SCREE_CHECK_INT(scree_run_folder_close(run, NULL), SCREE_OK);
        SCREE_CHECK_INT(read_num_steps(in_folder(folder, "frames.vtkhdf")), num_frames + 1);
    }
    SCREE_CHECK(num_long > 30);
    made_simulation_destroy(&made);
}

/// Exit code of a function run in a child process with files limited to `max_size` bytes: a write beyond fails as on a
/// full disk.
static int in_limited_child(int (*function)(const char *), const char *folder, size_t max_size)
{
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0)
    {
        const struct rlimit limit = {max_size, max_size};
        signal(SIGXFSZ, SIG_IGN);
        if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(99);
        _exit(function(folder));
    }
    int state;
    waitpid(child, &state, 0);
    return WIFEXITED(state) ? WEXITSTATUS(state) : -1;
}

/// Writes until something does not fit; 0 if that was told properly.
static int write_until_full(const char *path)
{
    made_simulation made;
    made_simulation_create(&made);
    scree_report report = {0};
    scree_run_folder *folder = NULL;
    const scree_run_folder_def def = {path, &scene_file, true, false};
    scree_status status = scree_run_folder_open(&folder, &def, &made.simulation, &report);
    if (status != SCREE_OK) return 1;
    for (int64_t step = 0; step < 100000 && status == SCREE_OK; ++step)
    {
        go_to(&made, step);
        status = scree_run_folder_write_series(folder, &made.simulation, &report);
        if (status == SCREE_OK) status = scree_run_folder_write_frame(folder, &made.simulation, &report);
    }
    if (status != SCREE_WRITE_FAILED || report.num_messages != 1) return 2;
    if (strstr(report.messages[0], "File too large") == NULL) return 3;
    return strstr(report.messages[0], path) != NULL ? 0 : 4;
}

static void test_a_full_disk_is_told_and_keeps_the_frames(void)
{
    char folder[400];
    snprintf(folder, sizeof folder, "%s/run", scree_test_folder());
    SCREE_CHECK_INT(in_limited_child(write_until_full, folder, 100000), 0);
    made_simulation made;
    made_simulation_create(&made);
    const int64_t num_frames = read_num_steps(in_folder(folder, "frames.vtkhdf"));
    SCREE_CHECK(num_frames > 5 && read_num_steps(in_folder(folder, "contacts.vtkhdf")) >= num_frames);
    if (num_frames > 0) check_particle_frame(in_folder(folder, "frames.vtkhdf"), &made, num_frames - 1);
    SCREE_CHECK(access(in_folder(folder, "contacts.vtkhdf.grow"), F_OK) != 0);
    // the series ends with a whole line
    size_t size;
    char *text = read_text(in_folder(folder, "series.csv"), &size);
    SCREE_CHECK(text != NULL && size > 0 && text[size - 1] == '\n');
    free(text);
    made_simulation_destroy(&made);
}

/// Rows alone until the file is full.
static int write_rows_until_full(const char *path)
{
    made_simulation made;
    made_simulation_create(&made);
    scree_run_folder *folder = NULL;
    const scree_run_folder_def def = {path, &scene_file, true, false};
    scree_status status = scree_run_folder_open(&folder, &def, &made.simulation, NULL);
    for (int64_t step = 0; step < 100000 && status == SCREE_OK; ++step)
    {
        go_to(&made, step);
        status = scree_run_folder_write_series(folder, &made.simulation, NULL);
    }
    return status == SCREE_WRITE_FAILED ? 0 : 1;
}

static void test_a_row_is_written_whole_or_not(void)
{
    char folder[400];
    snprintf(folder, sizeof folder, "%s/run", scree_test_folder());
    SCREE_CHECK_INT(in_limited_child(write_rows_until_full, folder, 5000), 0);
    size_t size = 0;
    char *text = read_text(in_folder(folder, "series.csv"), &size);
    SCREE_CHECK(text != NULL && size > 4000 && size < 5000 && text[size - 1] == '\n');
    free(text);
}

// ---- the folder

static scree_status try_open(const char *path, const made_simulation *made, bool replace, scree_report *report)
{
    scree_run_folder *folder = NULL;
    const scree_run_folder_def def = {path, &scene_file, replace, false};
    const scree_status status = scree_run_folder_open(&folder, &def, &made->simulation, report);
    scree_run_folder_close(folder, NULL);
    return status;
}

static void test_an_old_run_is_guarded(void)
{
    char folder[400];
    write_run(scree_test_folder(), "below/run", 2, folder);
    made_simulation made;
    made_simulation_create(&made);
    scree_report report = {0};
    SCREE_CHECK_INT(try_open(folder, &made, false, &report), SCREE_INVALID_INPUT);
    SCREE_CHECK_INT(report.num_messages, 1);
    if (report.num_messages > 0) SCREE_CHECK_CONTAINS(report.messages[0], "--restart");
    SCREE_CHECK_INT(read_num_steps(in_folder(folder, "frames.vtkhdf")), 3);
    scree_report_clear(&report);

    FILE *file = fopen(in_folder(folder, "notes.txt"), "w");
    fclose(file);
    SCREE_CHECK_INT(try_open(folder, &made, true, &report), SCREE_OK);
    SCREE_CHECK(access(in_folder(folder, "frames.vtkhdf"), F_OK) != 0);
    SCREE_CHECK(access(in_folder(folder, "scene.yaml"), F_OK) == 0);
    SCREE_CHECK(access(in_folder(folder, "notes.txt"), F_OK) == 0);
    SCREE_CHECK_INT(try_open(in_folder(folder, "notes.txt"), &made, false, &report), SCREE_WRITE_FAILED);
    scree_report_clear(&report);
    made_simulation_destroy(&made);
}

static int open_while_open(const char *path)
{
    made_simulation made;
    made_simulation_create(&made);
    scree_report report = {0};
    if (try_open(path, &made, true, &report) != SCREE_INVALID_INPUT) return 1;
    return strstr(report.messages[0], "another run") != NULL ? 0 : 2;
}

static void test_two_runs_do_not_share_a_folder(void)
{
    char folder[400];
    snprintf(folder, sizeof folder, "%s/run", scree_test_folder());
    made_simulation made;
    made_simulation_create(&made);
    scree_run_folder *run = open_folder(folder, &made, false, false);
    write_steps(run, &made, 0, 3);
    SCREE_CHECK_INT(in_limited_child(open_while_open, folder, 1 << 30), 0);
    write_steps(run, &made, 4, 5);
    SCREE_CHECK_INT(scree_run_folder_close(run, NULL), SCREE_OK);
    SCREE_CHECK_INT(read_num_steps(in_folder(folder, "frames.vtkhdf")), 6);
    SCREE_CHECK_INT(in_limited_child(open_while_open, folder, 1 << 30), 1);
    made_simulation_destroy(&made);
}

static void test_summary_has_null_where_there_is_no_number(void)
{
    char folder[400];
    snprintf(folder, sizeof folder, "%s/run", scree_test_folder());
    made_simulation made;
    made_simulation_create(&made);
    char name[] = "a \"b\" \\ \t\xff";
    made.scene.name = name;
    go_to(&made, 4);
    scree_run_folder *run = open_folder(folder, &made, false, false);
    const scree_run_result result = {"finished", 2.0, 3.5, INFINITY, NAN, 100, 1};
    SCREE_CHECK_INT(scree_run_folder_write_summary(run, &made.simulation, &result, NULL), SCREE_OK);
    scree_run_folder_close(run, NULL);
    size_t size;
    char *text = read_text(in_folder(folder, "summary.json"), &size);
    SCREE_CHECK(text != NULL);
    if (text == NULL) return;
    SCREE_CHECK_CONTAINS(text, "\"initial_energy\": null");
    SCREE_CHECK_CONTAINS(text, "\"energy_error\": null");
    SCREE_CHECK_CONTAINS(text, "\"repose_angle_degrees\": null");
    SCREE_CHECK_CONTAINS(text, "\"smallest_critical_step\": null");
    SCREE_CHECK_CONTAINS(text, "\"scene\": \"a \\\"b\\\" \\\\ \\u0009?\"");
    SCREE_CHECK_CONTAINS(text, "\"mass\": 9,");
    SCREE_CHECK_CONTAINS(text, "\"particle_steps_per_second\": 150,");
    SCREE_CHECK_CONTAINS(text, "\"processor_seconds\": 3.5,");
    SCREE_CHECK(strstr(text, "nan") == NULL && strstr(text, "inf") == NULL);
    free(text);
    made_simulation_destroy(&made);
}

int main(void)
{
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    SCREE_RUN(test_series_has_a_header_and_a_row_per_time);
    SCREE_RUN(test_series_after_a_restart_is_the_unbroken_one);
    SCREE_RUN(test_particle_frames_hold_the_placed_surfaces);
    SCREE_RUN(test_walls_are_written_when_they_change);
    SCREE_RUN(test_contact_frames_hold_the_contacts);
    SCREE_RUN(test_files_grow_beyond_what_was_expected);
    SCREE_RUN(test_frames_after_a_restart_are_the_unbroken_ones);
    SCREE_RUN(test_a_step_appears_in_one_place);
    SCREE_RUN(test_a_killed_run_leaves_readable_files);
    SCREE_RUN(test_a_full_disk_is_told_and_keeps_the_frames);
    SCREE_RUN(test_a_row_is_written_whole_or_not);
    SCREE_RUN(test_an_old_run_is_guarded);
    SCREE_RUN(test_two_runs_do_not_share_a_folder);
    SCREE_RUN(test_summary_has_null_where_there_is_no_number);
    return SCREE_TEST_END();
}
