// The whole step on the device, emulated or real: the state, energies, counters and loads of the CPU, bit for bit,
// after hundreds of steps; and a run that changes sides at its checkpoints.
#define _XOPEN_SOURCE 700
#include "device_run.cuh"
#include "test_folder.h"

extern "C"
{
#include "scree/io.h"

#include "io/run_folder.h"
}

/// Materials and shapes of all scenes; walls of some.
static const char head[] = "materials:\n"
                           "  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}\n"
                           "  - {name: steel, density: 7800, youngs_modulus: 1e8, poisson_ratio: 0.3}\n"
                           "contact_laws:\n"
                           "  - {materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}\n"
                           "  - {materials: [stone, steel], friction_coefficient: 0.3, damping_ratio: 0.2}\n";

static const char moving_walls[] =
    "walls:\n"
    "  - {name: floor, shape: floor, material: steel, position: [0, 0, -0.01],\n"
    "     motion: {kind: translate, velocity: [0, 0, 0.4], start: 0.002, end: 0.02}}\n"
    "  - {name: paddle, shape: paddle, material: steel, position: [0.02, 0, 0.009],\n"
    "     motion: {kind: rotate, axis: [0, 0, 1], centre: [0, 0, 0], angular_velocity: 40}}\n"
    "  - {name: gate, shape: paddle, material: steel, position: [0, -0.05, 0.009], removed_at: 0.004}\n";

static const char wall_shapes[] = "  - {name: floor, source: box, size: [0.3, 0.3, 0.02]}\n"
                                  "  - {name: paddle, source: box, size: [0.06, 0.004, 0.016]}\n";

static std::string spheres()
{
    return std::string("name: spheres\ntime: {end: 0.012, step: 5e-5}\n") + head +
           "shapes:\n  - {name: ball, source: sphere, size: 0.016}\n" + wall_shapes +
           "particles:\n"
           "  - {name: balls, shape: ball, material: stone, count: 70, seed: 4, velocity: [0, 0, -4], spacing: 1.02,\n"
           "     size: {distribution: uniform, min: 0.01, max: 0.016},\n"
           "     region: {min: [-0.05, -0.05, 0.018], max: [0.05, 0.05, 0.3]}}\n" +
           moving_walls;
}

static std::string polyhedra()
{
    return std::string("name: polyhedra\ntime: {end: 0.012, step: 5e-5}\n") + head +
           "shapes:\n"
           "  - {name: rock, source: rock, triangles: 40, seed: 3}\n"
           "  - {name: fine, source: rock, triangles: 300, seed: 5}\n"
           "  - {name: schoenhardt, source: schoenhardt, size: 0.02}\n" +
           wall_shapes +
           "particles:\n"
           "  - {name: rocks, shape: rock, material: stone, count: 14, seed: 1, velocity: [0, 0, -4], spacing: 1,\n"
           "     size: {distribution: uniform, min: 0.015, max: 0.02},\n"
           "     region: {min: [-0.04, -0.04, 0.018], max: [0.04, 0.04, 0.3]}}\n"
           "  - {name: twisted, shape: schoenhardt, material: stone, count: 14, seed: 2, velocity: [0, 0, -7],\n"
           "     spacing: 1, region: {min: [-0.04, -0.04, 0.145], max: [0.04, 0.04, 0.3]}}\n"
           "  - name: fine\n    shape: fine\n    material: stone\n    bodies:\n"
           "      - {size: 0.03, position: [0, 0, 0.25], velocity: [0, 0, -16]}\n"
           "      - {size: 0.03, position: [0, 0, 0.285], velocity: [0, 0, -22]}\n" +
           moving_walls;
}

/// Spheres and clumps among rocks, with averages of fields and collisions.
static std::string mixed()
{
    return std::string("name: mixed\ntime: {end: 0.012, step: 5e-5}\n") + head +
           "shapes:\n"
           "  - {name: rock, source: rock, triangles: 40, seed: 3}\n"
           "  - {name: ball, source: sphere, size: 0.016}\n"
           "  - {name: trio, source: clump, spheres: [{position: [0, 0, 0], radius: 0.007},\n"
           "     {position: [0.006, 0, 0], radius: 0.006}, {position: [0, 0.007, 0], radius: 0.005}]}\n" +
           wall_shapes +
           "particles:\n"
           "  - {name: trios, shape: trio, material: stone, count: 8, seed: 5, velocity: [0, 0, -16],\n"
           "     region: {min: [-0.03, -0.03, 0.25], max: [0.03, 0.03, 0.4]}}\n"
           "  - {name: rocks, shape: rock, material: stone, count: 12, seed: 1, velocity: [0, 0, -4], spacing: 1,\n"
           "     size: {distribution: uniform, min: 0.015, max: 0.02},\n"
           "     region: {min: [-0.04, -0.04, 0.018], max: [0.04, 0.04, 0.3]}}\n"
           "  - {name: balls, shape: ball, material: stone, count: 25, seed: 2, velocity: [0, 0, -7], spacing: 1.02,\n"
           "     region: {min: [-0.04, -0.04, 0.115], max: [0.04, 0.04, 0.3]}}\n" +
           moving_walls +
           "fields: {measure: true, from: 0.001, period: 0.003, samples: 5, cells: [3, 3, 4],\n"
           "  region: {min: [-0.05, -0.05, 0], max: [0.05, 0.05, 0.1]}, energy_bins: 12, energy_min: 1e-9,\n"
           "  energy_max: 1e-2}\n";
}

/// A U that lands on its two legs, each a contact of its own.
static std::string patches()
{
    const char *folder = std::getenv("SCREE_SOURCE_DIR");
    return std::string("name: patches\ntime: {end: 0.012, step: 5e-5}\nsolver: {separate_patches: true}\n") + head +
           "shapes:\n  - {name: u, source: file, file: " + (folder != nullptr ? folder : ".") +
           "/models/u_shape.obj}\n" + wall_shapes +
           "particles:\n  - name: one\n    shape: u\n    material: stone\n    bodies:\n"
           "      - {size: 0.1, position: [0, 0, 0.056], velocity: [0, 0, -1],\n"
           "         orientation: [0.7071067811865476, -0.7071067811865476, 0, 0]}\n"
           "walls:\n  - {name: floor, shape: floor, material: steel, position: [0, 0, -0.01]}\n";
}

/// Balls that land one after the other, all within one skin: more contacts than the recorded steps have room for.
static std::string landing()
{
    std::string text = std::string("name: landing\ntime: {end: 0.012, step: 5e-5}\nsolver: {skin: 1.5}\n") + head +
                       "shapes:\n  - {name: ball, source: sphere, size: 0.016}\n" + wall_shapes +
                       "particles:\n  - name: balls\n    shape: ball\n    material: stone\n    bodies:\n";
    for (int k = 0; k < 64; ++k)
    {
        char body[128];
        snprintf(body, sizeof body, "      - {size: 0.016, position: [%g, %g, %g], velocity: [0, 0, -0.4]}\n",
                 0.02 * (k % 8) - 0.07, 0.02 * (k / 8) - 0.07, 0.0081 + 2e-5 * (k * 29 % 64));
        text += body;
    }
    return text + "walls:\n  - {name: floor, shape: floor, material: steel, position: [0, 0, -0.01]}\n";
}

/// Classes of pairs of meshes in the last scene that was checked.
static scree_work_classes classes;

/// Steps of it that found no room while they were played.
static int64_t num_halts_for_room;

/// All steps of a scene on both sides. `work_class`: all pairs of meshes go to teams of its size; -1: each to its own.
static void check_scene(const std::string &text, int32_t block, int64_t least_contacts, int32_t work_class = -1,
                        bool records = true)
{
    scene_run here, there;
    scene_run_start(&here, text.c_str());
    scene_run_start(&there, text.c_str());
    if (here.simulation == nullptr || there.simulation == nullptr) return;
    scree_device *device = open_device(block, records);
    move(there.simulation, device);
    classes = there.simulation->there->narrow_phase.classes;
    if (work_class >= 0) there.simulation->there->narrow_phase.classes = {work_class, work_class};
    check_same(here.simulation, there.simulation);
    int64_t most_contacts = 0;
    for (int part = 0; part < 4; ++part)
    {
        steps(here.simulation, 60);
        steps(there.simulation, 60);
        check_same(here.simulation, there.simulation);
        const int64_t num = here.simulation->contacts.num_contacts;
        most_contacts = num > most_contacts ? num : most_contacts;
    }
    const int64_t *num_halts = there.simulation->there->buffers->num_halts;
    printf("%s: up to %lld contacts, %lld searches; %lld steps played, %lld halted for a search, %lld for room\n",
           here.file.scene.name, (long long)most_contacts,
           (long long)scree_simulation_counters(there.simulation).num_rebuilds, (long long)num_halts[SCREE_HALT_NONE],
           (long long)num_halts[SCREE_HALT_SEARCH], (long long)num_halts[SCREE_HALT_ROOM]);
    SCREE_CHECK(records ? num_halts[SCREE_HALT_NONE] > 100 : num_halts[SCREE_HALT_NONE] == 0);
    num_halts_for_room = num_halts[SCREE_HALT_ROOM];
    SCREE_CHECK(most_contacts >= least_contacts);
    scene_run_end(&there);
    SCREE_CHECK_INT(scree_device_status(device, NULL), SCREE_OK);
    scree_device_close(device);
    scene_run_end(&here);
}

static void test_spheres() { check_scene(spheres(), 128, 40); }
static void test_polyhedra()
{
    check_scene(polyhedra(), 32, 12);
    SCREE_CHECK(classes.first == 0 && classes.last == SCREE_NUM_WORK_CLASSES - 1);
}
static void test_teams_of_one_size()
{
    for (int32_t work_class = 0; work_class < SCREE_NUM_WORK_CLASSES; work_class += 2)
        check_scene(polyhedra(), 128, 12, work_class);
}
static void test_mixed() { check_scene(mixed(), 50, 20); }
static void test_no_room()
{
    check_scene(landing(), 128, 40);
    SCREE_CHECK(num_halts_for_room > 0);
}
/// Nothing is recorded, or it cannot be: the same.
static void test_call_by_call()
{
    check_scene(mixed(), 128, 20, -1, false);
#ifdef CUDA_ON_CPU
    cuda_on_cpu::refuse_graphs(true);
    scene_run run;
    scene_run_start(&run, spheres().c_str());
    scree_device *device = open_device(128);
    move(run.simulation, device);
    steps(run.simulation, 5);
    SCREE_CHECK(!scree_device_records(device));
    cuda_on_cpu::refuse_graphs(false);
    scene_run_end(&run);
    SCREE_CHECK_INT(scree_device_status(device, NULL), SCREE_OK);
    scree_device_close(device);
#endif
}
/// Particles change places on the device every few steps, and come home when somebody looks.
static void check_places(const std::string &text)
{
    scene_run here, there;
    scene_run_start(&here, text.c_str());
    scene_run_start(&there, text.c_str());
    scree_device *device = open_device(128);
    move(there.simulation, device);
    scree_simulation *s = there.simulation->there;
    const int64_t num = s->particles.num_particles;
    int32_t *order = (int32_t *)scree_device_alloc(device, num, sizeof *order);
    uint64_t state = 23;
    int64_t num_away = 0;
    for (int k = 1; k <= 120; ++k)
    {
        if (k % 10 == 0)
        {
            std::vector<int32_t> places;
            for (int32_t p = 0; p < num; ++p) places.push_back(p);
            for (size_t p = places.size() - 1; p > 0; --p)
                std::swap(places[p], places[(size_t)(scree_test_random(&state) * (double)(p + 1))]);
            scree_device_write(device, order, places.data(), (size_t)num * sizeof *order);
            SCREE_CHECK_INT(scree_ask_for_places(s, order), SCREE_OK);
        }
        steps(here.simulation, 1);
        steps(there.simulation, 1);
        num_away += s->buffers->places.are_ids ? 0 : 1;
        if (k % 40 == 0) check_same(here.simulation, there.simulation);
    }
    printf("%s: away from home in %lld steps, %lld steps played\n", here.file.scene.name, (long long)num_away,
           (long long)s->buffers->num_halts[SCREE_HALT_NONE]);
    SCREE_CHECK(num_away >= 50 && s->buffers->num_halts[SCREE_HALT_NONE] > 60);
    scree_device_free(device, order);
    scene_run_end(&there);
    SCREE_CHECK_INT(scree_device_status(device, NULL), SCREE_OK);
    scree_device_close(device);
    scene_run_end(&here);
}
static void test_places()
{
    check_places(spheres());
    check_places(mixed());
}
static void test_patches() { check_scene(patches(), 128, 2); }

/// From a checkpoint of the CPU on the device, and from one of the device on the CPU: the unbroken run.
static void test_sides_change_at_checkpoints()
{
    const std::string text = mixed();
    const std::string path = std::string(scree_test_folder()) + "/checkpoint.h5";
    scene_run unbroken, run;
    scene_run_start(&unbroken, text.c_str());
    if (unbroken.simulation == nullptr) return;
    steps(unbroken.simulation, 180);

    scree_device *device = open_device(128);
    for (int part = 0; part < 3; ++part)
    {
        scene_run_start(&run, text.c_str());
        if (part > 0) SCREE_CHECK_INT(scree_checkpoint_load(run.simulation, path.c_str(), NULL), SCREE_OK);
        if (part == 1) move(run.simulation, device);
        steps(run.simulation, 60);
        if (part == 2) break;
        SCREE_CHECK_INT(scree_simulation_observe(run.simulation, NULL), SCREE_OK);
        SCREE_CHECK_INT(scree_checkpoint_save(run.simulation, path.c_str(), NULL), SCREE_OK);
        scene_run_end(&run);
    }
    check_same(unbroken.simulation, run.simulation);
    scene_run_end(&run);
    scene_run_end(&unbroken);
    scree_device_close(device);
}

#if defined(CUDA_ON_CPU) && !defined(CUDA_ON_CPU_RACES)
#define TEST_MEMORY 1
/// A cube of bodies that touch or nearly do.
static std::string cube(const char *shape, double spacing)
{
    std::string text = std::string("name: cube\ntime: {end: 0.012, step: 1e-5}\n") + head +
                       "shapes:\n  - {name: ball, source: sphere, size: 0.016}\n  - {name: rock, source: rock, "
                       "triangles: 40, seed: 3}\n" +
                       wall_shapes + "particles:\n  - name: bodies\n    shape: " + shape +
                       "\n    material: stone\n    bodies:\n";
    for (int k = 0; k < 512; ++k)
    {
        char body[128];
        snprintf(body, sizeof body, "      - {size: 0.016, position: [%g, %g, %g]}\n", spacing * (k % 8 - 3.5),
                 spacing * (k / 8 % 8 - 3.5), spacing * (k / 64 + 0.5));
        text += body;
    }
    return text + "walls:\n  - {name: floor, shape: floor, material: steel, position: [0, 0, -0.01]}\n";
}

/// The arena of the start does for all steps, and the plan tells what they take.
static void check_taken_up_front(const char *shape, double spacing, bool has_overlaps)
{
    scene_run run;
    scene_run_start(&run, cube(shape, spacing).c_str());
    scree_device *device = open_device(128, true, 1 << 18);
    move(run.simulation, device);
    const long num_before = cuda_on_cpu::num_allocations();
    steps(run.simulation, 10);
    SCREE_CHECK_INT(cuda_on_cpu::num_allocations(), num_before);
    scene_run_end(&run);
    scree_device_close(device);

    scene_run_start(&run, cube(shape, spacing).c_str());
    device = open_device(128, true, 0);
    const int64_t num_free = scree_device_free_memory(device);
    move(run.simulation, device);
    steps(run.simulation, 10);
    const scree_device_memory plan = scree_device_memory_of(run.simulation);
    const scree_counters counters = scree_simulation_counters(run.simulation);
    const int64_t planned = plan.shapes + plan.per_particle * run.simulation->particles.num_particles +
                            plan.per_pair * counters.num_pairs + plan.per_contact * counters.num_contacts;
    const int64_t taken = num_free - scree_device_free_memory(device);
    printf("%s: %lld pairs, %lld contacts; planned for them %lld bytes, taken %lld\n", shape,
           (long long)counters.num_pairs, (long long)counters.num_contacts, (long long)planned, (long long)taken);
    // buffers of overlaps come on top
    if (!has_overlaps) SCREE_CHECK(taken <= planned && taken > planned / 2);
    scene_run_end(&run);
    scree_device_close(device);
}
static void test_memory_up_front()
{
    check_taken_up_front("ball", 0.0159, false);
    check_taken_up_front("rock", 0.0222, true);
}

/// Contacts become more and more: arrays are taken in steps that search, and in no other.
static void check_taken_at_searches(const std::string &text, bool records)
{
    scene_run run;
    scene_run_start(&run, text.c_str());
    scree_device *device = open_device(128, records, 0);
    move(run.simulation, device);
    const scree_simulation *there = run.simulation->there;
    int64_t num_growing = 0;
    for (int k = 0; k < 240; ++k)
    {
        const long num_before = cuda_on_cpu::num_allocations();
        const int64_t searches = there->counters.num_rebuilds, room = there->contacts.max_contacts;
        steps(run.simulation, 1);
        if (there->counters.num_rebuilds == searches) SCREE_CHECK_INT(cuda_on_cpu::num_allocations(), num_before);
        num_growing += k > 0 && there->contacts.max_contacts > room;
        SCREE_CHECK(there->counters.num_rebuilds <= searches + 1);
    }
    printf("%s: room for contacts grew in %lld of 240 steps\n", run.file.scene.name, (long long)num_growing);
    SCREE_CHECK(num_growing > 0);
    scene_run_end(&run);
    scree_device_close(device);
}
static void test_memory_is_taken_at_searches()
{
    for (int records = 0; records < 2; ++records)
    {
        check_taken_at_searches(landing(), records != 0);
        check_taken_at_searches(mixed(), records != 0);
    }
}

/// Memory ends at every one of the allocations of a run in turn: it is told, the state before is still the CPU's,
/// nothing is lost but the step, and the device can be used again.
static void test_memory_ends()
{
    const std::string text = mixed();
    int64_t num_refused = 0, num_broken = 0, num_whole = 0;
    for (long num = 0; num_whole == 0; ++num)
    {
        scene_run run;
        scene_run_start(&run, text.c_str());
        scree_device_def def = scree_default_device_def();
        def.arena_bytes = 0;
        scree_device *device = nullptr;
        SCREE_CHECK_INT(scree_device_open(&device, &def, &run.report), SCREE_OK);
        const uint64_t before = scree_simulation_hash(run.simulation);
        cuda_on_cpu::allow_allocations(num);
        scree_status status = scree_simulation_use_device(run.simulation, device, &run.report);
        if (status != SCREE_OK)
        {
            ++num_refused;
            // and the run goes on without it
            SCREE_CHECK(scree_simulation_hash(run.simulation) == before);
            steps(run.simulation, 1);
        }
        for (int k = 0; k < 120 && status == SCREE_OK; ++k) status = scree_simulation_step(run.simulation, &run.report);
        num_broken += run.simulation->step > 1 && status != SCREE_OK;
        num_whole += status == SCREE_OK;
        SCREE_CHECK(status == SCREE_OK || status == SCREE_OUT_OF_MEMORY);
        SCREE_CHECK(status == SCREE_OK || scree_report_num_faults(&run.report) > 0);
        SCREE_CHECK_INT(scree_device_status(device, NULL), SCREE_OK);
        cuda_on_cpu::allow_allocations(-1);
        scene_run_end(&run);
        scree_device_close(device);
    }
    printf("%lld refused, %lld broken off\n", (long long)num_refused, (long long)num_broken);
    SCREE_CHECK(num_refused > 10 && num_broken > 10);
}

/// Where there is no memory for other places particles stay, and change places once there is. Coming home takes none.
static void test_no_memory_for_places()
{
    std::string text = std::string("name: tower\ntime: {end: 0.012, step: 1e-5}\n") + head +
                       "shapes:\n  - {name: ball, source: sphere, size: 0.016}\n" + wall_shapes +
                       "particles:\n  - name: bodies\n    shape: ball\n    material: stone\n    bodies:\n";
    for (int k = 0; k < 200; ++k)
    {
        char body[96];
        snprintf(body, sizeof body, "      - {size: 0.016, position: [0, 0, %g]}\n", 0.008 + 0.0159 * (k * 37 % 200));
        text += body;
    }
    text += "walls:\n  - {name: floor, shape: floor, material: steel, position: [0, 0, -0.01]}\n";
    scene_run here, run;
    scene_run_start(&here, text.c_str());
    scene_run_start(&run, text.c_str());
    scree_device *device = open_device(128, true, 0);
    move(run.simulation, device);
    scree_step_buffers *b = run.simulation->there->buffers;
    const auto search = [&](int num_steps)
    {
        for (int k = 0; k < num_steps; ++k)
        {
            b->is_search_asked = true;
            steps(run.simulation, 1);
            steps(here.simulation, 1);
        }
    };
    search(3);
    b->places.few = 100;
    cuda_on_cpu::allow_allocations(0);
    search(3);
    SCREE_CHECK(b->places.are_ids && !b->places.is_due);
    cuda_on_cpu::allow_allocations(-1);
    search(2);
    SCREE_CHECK(!b->places.are_ids);
    cuda_on_cpu::allow_allocations(0);
    check_same(here.simulation, run.simulation);
    SCREE_CHECK(b->places.are_ids && here.simulation->contacts.num_contacts >= 199);
    cuda_on_cpu::allow_allocations(-1);
    scene_run_end(&run);
    scree_device_close(device);
    scene_run_end(&here);
}
#endif

int main()
{
    if (is_without_device()) return SKIPPED;
    SCREE_RUN(test_spheres);
    SCREE_RUN(test_polyhedra);
    SCREE_RUN(test_teams_of_one_size);
    SCREE_RUN(test_mixed);
    SCREE_RUN(test_patches);
    SCREE_RUN(test_places);
    SCREE_RUN(test_no_room);
    SCREE_RUN(test_call_by_call);
    SCREE_RUN(test_sides_change_at_checkpoints);
#ifdef TEST_MEMORY
    SCREE_RUN(test_memory_up_front);
    SCREE_RUN(test_memory_is_taken_at_searches);
    SCREE_RUN(test_memory_ends);
    SCREE_RUN(test_no_memory_for_places);
#endif
    return SCREE_TEST_END();
}
