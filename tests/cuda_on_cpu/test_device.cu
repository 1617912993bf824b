// The host side on the emulated device: trees and candidate pairs of random boxes with walls, the bits of the CPU;
// memory in one arena or array by array; and machines that have no GPU, too old a one, too little memory, or one that
// fails. Without arguments the program also runs itself on those machines; with one it is that case.
extern "C"
{
#include "bvh/broad_phase.h"
#include "core/sort.h"
#include "harness.h"
}
#include "device_array.cuh"

#include <string>
#include <sys/wait.h>

/// Particles and walls of one search, in host memory.
struct bodies
{
    std::vector<scree_box> boxes;
    std::vector<scree_vec3> centres;
    std::vector<scree_real> radii;
    std::vector<scree_broad_phase_wall> walls;
    std::vector<scree_lbvh> wall_trees;
};

static scree_real random_real(uint64_t *state, double low, double high)
{
    return (scree_real)(low + (high - low) * scree_test_random(state));
}

static scree_vec3 random_point(uint64_t *state)
{
    const scree_real x = random_real(state, -1, 1), y = random_real(state, -1, 1), z = random_real(state, -1, 1);
    return scree_vec3_make(x, y, z);
}

static scree_box box_around(scree_vec3 middle, scree_real half)
{
    scree_box box;
    box.lower = scree_vec3_sub(middle, scree_vec3_make(half, half, half));
    box.upper = scree_vec3_add(middle, scree_vec3_make(half, half, half));
    return box;
}

/// A wall of random boxes, its tree on the device or on the host.
static scree_broad_phase_wall make_wall(scree_lbvh *tree, scree_device *device, uint64_t *state)
{
    std::vector<scree_box> boxes;
    for (int k = 0; k < 30; ++k) boxes.push_back(box_around(random_point(state), random_real(state, 0.01, 0.2)));
    scree_box *where = (scree_box *)scree_device_alloc(device, 30, sizeof(scree_box));
    scree_device_write(device, where, boxes.data(), 30 * sizeof(scree_box));
    *tree = scree_lbvh{};
    tree->device = device;
    SCREE_CHECK_INT(scree_lbvh_build(tree, where, 30), SCREE_OK);
    scree_device_free(device, where);
    scree_broad_phase_wall wall = {};
    wall.tree = tree->view;
    wall.pose.orientation = scree_quat_identity();
    wall.pose.position = random_point(state);
    wall.pose.scale = 1;
    wall.is_present = true;
    return wall;
}

static bodies make_bodies(scree_device *device, int64_t num_particles, int num_walls)
{
    bodies b;
    uint64_t state = 7;
    for (int64_t i = 0; i < num_particles; ++i)
    {
        b.centres.push_back(random_point(&state));
        b.radii.push_back(random_real(&state, 0.02, 0.2));
        b.boxes.push_back(box_around(b.centres.back(), b.radii.back()));
    }
    b.wall_trees.resize((size_t)num_walls);
    for (int w = 0; w < num_walls; ++w) b.walls.push_back(make_wall(&b.wall_trees[(size_t)w], device, &state));
    if (num_walls > 1) b.walls[1].is_present = false;
    return b;
}

template <class T> static T *copy_to(scree_device *device, const std::vector<T> &values)
{
    T *array = (T *)scree_device_alloc(device, (int64_t)values.size(), sizeof(T));
    scree_device_write(device, array, values.data(), values.size() * sizeof(T));
    return array;
}

template <class T>
static void append(std::vector<unsigned char> *bytes, scree_device *device, const T *array, int64_t num)
{
    std::vector<unsigned char> read((size_t)num * sizeof(T));
    scree_device_read(device, read.data(), array, read.size());
    bytes->insert(bytes->end(), read.begin(), read.end());
}

/// Everything that a broad phase has found.
static std::vector<unsigned char> found_by(const scree_broad_phase *broad_phase, int64_t num_particles,
                                           int64_t num_bodies)
{
    std::vector<unsigned char> bytes;
    scree_device *device = broad_phase->device;
    if (num_particles > 0) append(&bytes, device, broad_phase->tree.view.nodes, 2 * num_particles - 1);
    append(&bytes, device, broad_phase->pairs, broad_phase->num_pairs);
    append(&bytes, device, broad_phase->own_begin, num_bodies + 1);
    append(&bytes, device, broad_phase->row_begin, num_bodies + 1);
    append(&bytes, device, broad_phase->row_pairs, broad_phase->num_pairs);
    return bytes;
}

/// Searches of growing and shrinking systems with the same buffers, one after the other.
static std::vector<unsigned char> search(scree_device *device, int64_t *num_pairs)
{
    scree_broad_phase broad_phase = {};
    broad_phase.device = device;
    std::vector<unsigned char> bytes;
    for (const int64_t num_particles : {0, 1, 2, 40, 300, 7})
    {
        bodies b = make_bodies(device, num_particles, num_particles > 2 ? 3 : 0);
        scree_broad_phase_input input = {};
        scree_box *boxes = copy_to(device, b.boxes);
        scree_vec3 *centres = copy_to(device, b.centres);
        scree_real *radii = copy_to(device, b.radii);
        scree_broad_phase_wall *walls = copy_to(device, b.walls);
        input.boxes = boxes;
        input.centres = centres;
        input.radii = radii;
        input.walls = walls;
        input.num_particles = num_particles;
        input.compares_spheres = num_particles == 40;
        input.num_walls = (int64_t)b.walls.size();
        SCREE_CHECK_INT(scree_broad_phase_find(&broad_phase, &input), SCREE_OK);
        const auto found = found_by(&broad_phase, num_particles, num_particles + input.num_walls);
        bytes.insert(bytes.end(), found.begin(), found.end());
        if (num_particles == 300) *num_pairs = broad_phase.num_pairs;
        scree_device_free(device, boxes);
        scree_device_free(device, centres);
        scree_device_free(device, radii);
        scree_device_free(device, walls);
        for (scree_lbvh &tree : b.wall_trees) scree_lbvh_destroy(&tree);
    }
    SCREE_CHECK_INT(scree_device_status(device, NULL), SCREE_OK);
    scree_broad_phase_destroy(&broad_phase);
    return bytes;
}

static scree_device *open_device(int32_t block, int64_t arena_bytes)
{
    scree_device *device = nullptr;
    scree_device_def def = scree_default_device_def();
    def.block = block;
    def.arena_bytes = arena_bytes;
    scree_report report = {};
    SCREE_CHECK_INT(scree_device_open(&device, &def, &report), SCREE_OK);
    for (int k = 0; k < report.num_messages; ++k) printf("%s\n", report.messages[k]);
    scree_report_clear(&report);
    if (device == nullptr) exit(EXIT_FAILURE);
    return device;
}

static void test_search()
{
    int64_t num_pairs = 0, num_here = 0;
    const std::vector<unsigned char> here = search(NULL, &num_here);
    SCREE_CHECK(num_here > 500);
    for (const int32_t block : {1, 33, 128})
    {
        // array by array, so that the sanitizers see their ends; then in an arena, first too small, then large enough
        for (const int64_t arena_bytes : {0, 4096, 16 << 20})
        {
            scree_device *device = open_device(block, arena_bytes);
            SCREE_CHECK(search(device, &num_pairs) == here);
            SCREE_CHECK_INT(num_pairs, num_here);
            scree_device_close(device);
#ifdef CUDA_ON_CPU
            size_t num_free, num_total;
            MUST_CUDA(cudaMemGetInfo(&num_free, &num_total));
            SCREE_CHECK_INT(num_free, num_total); // elsewhere others take memory too
#endif
        }
    }
}

static void test_refit()
{
    scree_device *device = open_device(128, 1 << 20);
    const bodies b = make_bodies(NULL, 200, 0);
    std::vector<scree_box> moved = b.boxes;
    for (scree_box &box : moved) box.upper.x += (scree_real)0.1;
    scree_lbvh here = {}, there = {};
    there.device = device;
    scree_box *boxes = copy_to(device, b.boxes), *moved_boxes = copy_to(device, moved);
    SCREE_CHECK_INT(scree_lbvh_build(&here, b.boxes.data(), 200), SCREE_OK);
    SCREE_CHECK_INT(scree_lbvh_build(&there, boxes, 200), SCREE_OK);
    scree_lbvh_refit(&here, moved.data());
    scree_lbvh_refit(&there, moved_boxes);
    std::vector<unsigned char> here_bytes, there_bytes;
    append(&here_bytes, NULL, here.view.nodes, 399);
    append(&there_bytes, device, there.view.nodes, 399);
    SCREE_CHECK(here_bytes == there_bytes);
    scree_lbvh_destroy(&here);
    scree_lbvh_destroy(&there);
    scree_device_close(device);
}

static void test_sort()
{
    scree_device *device = open_device(128, 1 << 20);
    for (const bool has_values : {false, true})
    {
        scree_sort_buffers here = {}, there = {};
        there.device = device;
        std::vector<uint64_t> keys;
        std::vector<int32_t> values;
        uint64_t state = 3;
        for (int32_t i = 0; i < 5000; ++i)
        {
            keys.push_back(scree_test_random_bits(&state) % 100 << 20 | scree_test_random_bits(&state) % 1000);
            values.push_back(i);
        }
        for (scree_sort_buffers *buffers : {&here, &there})
        {
            SCREE_CHECK_INT(scree_sort_reserve(buffers, 5000, has_values), SCREE_OK);
            scree_device_write(buffers->device, buffers->keys, keys.data(), 5000 * sizeof(uint64_t));
            if (has_values) scree_device_write(buffers->device, buffers->values, values.data(), 5000 * sizeof(int32_t));
            scree_sort(buffers, 5000, 20);
        }
        std::vector<unsigned char> here_bytes, there_bytes;
        append(&here_bytes, NULL, here.keys, 5000);
        append(&there_bytes, device, there.keys, 5000);
        if (has_values) append(&here_bytes, NULL, here.values, 5000);
        if (has_values) append(&there_bytes, device, there.values, 5000);
        SCREE_CHECK(here_bytes == there_bytes);
        scree_sort_destroy(&here);
        scree_sort_destroy(&there);
    }
    scree_device_close(device);
}

#ifdef CUDA_ON_CPU
/// Opens the default device of a faulty machine, searches, and prints how that ends.
static int run_on_faulty_machine(int32_t number)
{
    scree_device *device = nullptr;
    scree_device_def def = scree_default_device_def();
    def.number = number;
    scree_report report = {};
    scree_status status = scree_device_open(&device, &def, &report);
    if (status == SCREE_OK)
    {
        const bodies b = make_bodies(NULL, 300, 0);
        scree_broad_phase broad_phase = {};
        broad_phase.device = device;
        scree_broad_phase_input input = {};
        scree_box *boxes = copy_to(device, b.boxes);
        input.boxes = boxes;
        input.num_particles = 300;
        status = scree_broad_phase_find(&broad_phase, &input);
        if (status == SCREE_OK) status = scree_device_status(device, &report);
        scree_broad_phase_destroy(&broad_phase);
    }
    scree_device_close(device);
    printf("%s\n", scree_status_text(status));
    for (int k = 0; k < report.num_messages; ++k) printf("%s\n", report.messages[k]);
    scree_report_clear(&report);
    return 0;
}

struct faulty_machine
{
    const char *environment;
    const char *number;
    scree_status status;
    const char *text;
};

static const faulty_machine machines[] = {
    {"CUDA_ON_CPU_DEVICES=1", "0", SCREE_OK, "done"},
    {"CUDA_ON_CPU_DEVICES=0", "0", SCREE_NO_DEVICE, "there is no NVIDIA GPU here"},
    {"CUDA_ON_CPU_DEVICES=2", "2", SCREE_NO_DEVICE, "there is no GPU 2: this machine has 2, counted from 0"},
    {"CUDA_ON_CPU_DRIVER=12040", "0", SCREE_NO_DEVICE,
     "the NVIDIA driver offers CUDA 12.4, this build of scree needs 13.0"},
    {"CUDA_ON_CPU_DRIVER=0", "0", SCREE_NO_DEVICE, "no NVIDIA driver is installed here"},
    {"CUDA_ON_CPU_CAPABILITY=75", "0", SCREE_NO_DEVICE, "has compute capability 7.5; scree needs 8.0"},
    {"CUDA_ON_CPU_CODE=80 CUDA_ON_CPU_CAPABILITY=89", "0", SCREE_OK, "done"},
    {"CUDA_ON_CPU_CODE=90 CUDA_ON_CPU_CAPABILITY=103", "0", SCREE_NO_DEVICE,
     "of compute capability 10.3: configure it with -DCMAKE_CUDA_ARCHITECTURES=103 and build it again"},
    {"CUDA_ON_CPU_CODE=89 CUDA_ON_CPU_CAPABILITY=86", "0", SCREE_NO_DEVICE, "this program was not built for GPU 0"},
    {"CUDA_ON_CPU_MEMORY=100000000", "0", SCREE_OUT_OF_MEMORY, "has no 256 MB of free memory to start with"},
    {"CUDA_ON_CPU_FAULT_AT=1", "0", SCREE_DEVICE_FAILED, "has failed: an illegal memory access"},
    {"CUDA_ON_CPU_FAULT_AT=5", "0", SCREE_DEVICE_FAILED, "start again from the last checkpoint"},
};

static const char *program;

static void test_faulty_machines()
{
    for (const faulty_machine &machine : machines)
    {
        const std::string command = std::string(machine.environment) + " '" + program + "' " + machine.number + " 2>&1";
        FILE *pipe = popen(command.c_str(), "r");
        SCREE_CHECK(pipe != nullptr);
        if (pipe == nullptr) return;
        std::string text;
        char buffer[4096];
        for (size_t num; (num = fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, num);
        const int status = pclose(pipe);
        SCREE_CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        SCREE_CHECK_CONTAINS(text.c_str(), scree_status_text(machine.status));
        SCREE_CHECK_CONTAINS(text.c_str(), machine.text);
    }
}

#endif

/// An array that does not fit is refused, and the device goes on.
static void test_too_large()
{
    scree_device *device = open_device(128, 1 << 20);
    SCREE_CHECK(scree_device_alloc(device, INT64_MAX, 8) == NULL);
    SCREE_CHECK(scree_device_alloc(device, (int64_t)1 << 40, 1) == NULL);
    void *small = scree_device_alloc(device, 100, 8);
    SCREE_CHECK(small != NULL);
    SCREE_CHECK_INT(scree_device_status(device, NULL), SCREE_OK);
    scree_device_close(device);
}

int main(int argc, char **argv)
{
#ifdef CUDA_ON_CPU
    if (argc > 1) return run_on_faulty_machine(atoi(argv[1]));
    program = argv[0];
    SCREE_RUN(test_faulty_machines);
#else
    (void)argc;
    (void)argv;
#endif
    if (is_without_device()) return SKIPPED;
    SCREE_RUN(test_sort);
    SCREE_RUN(test_search);
    SCREE_RUN(test_refit);
    SCREE_RUN(test_too_large);
    return SCREE_TEST_END();
}
