// The whole step on the device, emulated or real, with every law of contact and every switch of the solver: state,
// energies, counters and loads of the CPU, bit for bit. That a law or a switch acts is seen on the CPU: a law gives
// another state than the plain one, a switch that only saves work the same.
#define _XOPEN_SOURCE 700
#include "device_run.cuh"

/// What differs from the plain scene.
struct variant
{
    const char *name;
    const char *law;      ///< keys of the contact laws
    const char *material; ///< keys of the materials
    const char *solver;
};

/// Rocks, twisted bodies, clumps, spheres and a U on its two legs, thrown together onto a floor that rises.
static std::string scene_of(const variant &v)
{
    const char *folder = std::getenv("SCREE_SOURCE_DIR");
    const std::string law = v.law, material = v.material;
    return std::string("name: ") + v.name + "\ntime: {end: 1, step: 1e-4}\nsolver: {" + v.solver +
           "}\n"
           "materials:\n"
           "  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25" +
           material +
           "}\n"
           "  - {name: steel, density: 7800, youngs_modulus: 1e8, poisson_ratio: 0.3" +
           material +
           "}\n"
           "contact_laws:\n"
           "  - {materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3" +
           law +
           "}\n"
           "  - {materials: [stone, steel], friction_coefficient: 0.3, damping_ratio: 0.2" +
           law +
           "}\n"
           "shapes:\n"
           "  - {name: rock, source: rock, triangles: 40, seed: 3}\n"
           "  - {name: schoenhardt, source: schoenhardt, size: 0.02}\n"
           "  - {name: ball, source: sphere, size: 0.012}\n"
           "  - {name: trio, source: clump, spheres: [{position: [0, 0, 0], radius: 0.007},\n"
           "     {position: [0.006, 0, 0], radius: 0.006}, {position: [0, 0.007, 0], radius: 0.005}]}\n"
           "  - {name: u, source: file, file: " +
           (folder != nullptr ? folder : ".") +
           "/models/u_shape.obj}\n"
           "  - {name: floor, source: box, size: [0.3, 0.3, 0.02]}\n"
           "particles:\n"
           "  - {name: rocks, shape: rock, material: stone, count: 5, seed: 1, velocity: [0, 0, -5], spacing: 1,\n"
           "     size: {distribution: fixed, mean: 0.016},\n"
           "     region: {min: [-0.025, -0.025, 0.005], max: [0.025, 0.025, 0.056]}}\n"
           "  - {name: twisted, shape: schoenhardt, material: stone, count: 4, seed: 2, velocity: [0, 0, -11],\n"
           "     spacing: 1, region: {min: [-0.022, -0.022, 0.057], max: [0.022, 0.022, 0.1]}}\n"
           "  - {name: trios, shape: trio, material: stone, count: 3, seed: 5, velocity: [0, 0, -18],\n"
           "     region: {min: [-0.025, -0.025, 0.1], max: [0.025, 0.025, 0.125]}}\n"
           "  - {name: balls, shape: ball, material: stone, count: 5, seed: 2, velocity: [0, 0, -24],\n"
           "     region: {min: [-0.02, -0.02, 0.125], max: [0.02, 0.02, 0.2]}}\n"
           "  - name: legs\n    shape: u\n    material: stone\n    bodies:\n"
           "      - {size: 0.04, position: [0.08, 0, 0.03], velocity: [0, 0, -2],\n"
           "         orientation: [0.7071067811865476, -0.7071067811865476, 0, 0]}\n"
           "walls:\n"
           "  - {name: floor, shape: floor, material: steel, position: [0, 0, -0.01],\n"
           "     motion: {kind: translate, velocity: [0.3, 0, 0.4], start: 0.001, end: 0.02}}\n";
}

static constexpr int64_t num_steps = 48;

/// Contacts of one kind of pair at the end of the plain scene.
enum
{
    OF_MESHES,
    OF_SPHERES,
    OF_BOTH,
    WITH_WALLS,
    NUM_KINDS
};

static void count_contacts(const scree_simulation *s, int64_t num[NUM_KINDS])
{
    for (int64_t c = 0; c < s->contacts.num_contacts; ++c)
    {
        const scree_candidate_pair pair = s->contacts.bodies[c];
        const bool is_mesh_i = s->shape_views[s->particles.shape[pair.i]].kind == SCREE_KIND_MESH;
        if (pair.j >= s->particles.num_particles)
        {
            ++num[WITH_WALLS];
            continue;
        }
        const bool is_mesh_j = s->shape_views[s->particles.shape[pair.j]].kind == SCREE_KIND_MESH;
        ++num[is_mesh_i != is_mesh_j ? OF_BOTH : is_mesh_i ? OF_MESHES : OF_SPHERES];
    }
}

/// The state on the CPU at the end; on the device it is the same, all the way.
static uint64_t hash_of(const variant &v, int64_t num[NUM_KINDS])
{
    const std::string text = scene_of(v);
    scene_run here, there;
    scene_run_start(&here, text.c_str());
    scene_run_start(&there, text.c_str());
    if (here.simulation == nullptr || there.simulation == nullptr) return 0;
    scree_device *device = open_device(64);
    move(there.simulation, device);
    for (int part = 0; part < 3; ++part)
    {
        steps(here.simulation, num_steps / 3);
        steps(there.simulation, num_steps / 3);
        check_same(here.simulation, there.simulation);
        count_contacts(here.simulation, num);
    }
    const uint64_t hash = scree_simulation_hash(here.simulation);
    printf("%s: %016llx, %lld contacts\n", v.name, (unsigned long long)hash,
           (long long)here.simulation->contacts.num_contacts);
    scene_run_end(&there);
    SCREE_CHECK_INT(scree_device_status(device, NULL), SCREE_OK);
    scree_device_close(device);
    scene_run_end(&here);
    return hash;
}

static uint64_t plain;

static void test_plain()
{
    int64_t num[NUM_KINDS] = {};
    plain = hash_of({"plain", "", "", ""}, num);
    SCREE_CHECK(plain != 0);
    for (int kind = 0; kind < NUM_KINDS; ++kind) SCREE_CHECK(num[kind] > 3);
}

static void test_laws()
{
    static const variant variants[] = {
        {"linear spring, tangential", ", model: linear_spring, normal_stiffness: 4e4, tangential_stiffness: 2e4", "",
         ""},
        {"energy conserving", ", model: energy_conserving", "", ""},
        {"energy conserving, patches", ", model: energy_conserving, energy_exponent: 2", "", "separate_patches: true"},
        {"constant rolling", ", rolling_resistance: constant, rolling_friction_coefficient: 0.2", "", ""},
        {"rolling spring",
         ", rolling_resistance: spring, rolling_friction_coefficient: 0.2, rolling_damping_ratio: 0.3", "", ""},
        {"attraction", ", attraction: true", "", ""},
        {"no tangential spring", ", tangential_spring: 0", "", ""},
        {"no moments", ", contact_moments: false", "", ""},
        {"factors", ", stiffness_factor: 0.5, tangential_damping_ratio: 0.1", "", ""},
        {"shear", ", shear_mixing: bilock", ", shear_modulus: 2e6", ""},
        {"patches", "", "", "separate_patches: true"},
        {"hierarchy", "", "", "overlap_scheme: hierarchy"},
    };
    for (const variant &v : variants)
    {
        int64_t num[NUM_KINDS] = {};
        SCREE_CHECK(hash_of(v, num) != plain);
    }
}

static void test_switches()
{
    static const variant variants[] = {
        {"pairs anew", "", "", "reuse_pairs: false"},
        {"places kept", "", "", "reorder_particles: false"},
        {"boxes only", "", "", "compare_spheres: false"},
        {"no planes", "", "", "find_separation: false"},
        {"nothing remembered", "", "", "remember_separation: false"},
        {"no bounds", "", "", "bound_separation: false"},
        {"nothing saved", "", "",
         "reuse_pairs: false, compare_spheres: false, find_separation: false, remember_separation: false, "
         "bound_separation: false"},
    };
    for (const variant &v : variants)
    {
        int64_t num[NUM_KINDS] = {};
        SCREE_CHECK(hash_of(v, num) == plain);
    }
}

int main()
{
    if (is_without_device()) return SKIPPED;
    SCREE_RUN(test_plain);
    SCREE_RUN(test_laws);
    SCREE_RUN(test_switches);
    return SCREE_TEST_END();
}
