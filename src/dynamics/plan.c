/// \file plan.c
/// The stages that a scene needs, why, and what they cost in memory.
#include "dynamics/plan.h"

#include "contact/mesh_pairs_kernel.h"
#include "contact/sphere_pairs_kernel.h"
#include "dynamics/on_device.h"
#include "dynamics/step_buffers.h"
#include "polyhedra/shape_copy.h"

#include <stdio.h>

scree_plan_bytes scree_simulation_plan_bytes(const scree_simulation *simulation)
{
    const scree_simulation *s = simulation;
    bool has[SCREE_NUM_SHAPE_KINDS] = {false};
    for (int64_t i = 0; i < s->particles.num_particles; ++i) has[s->shape_views[s->particles.shape[i]].kind] = true;
    const bool has_meshes = has[SCREE_KIND_MESH], has_spheres = has[SCREE_KIND_SPHERE];
    scree_plan_bytes bytes = {0};
    bytes.state = 6 * sizeof(scree_vec3) + sizeof(scree_quat) + 2 * sizeof(scree_real) + 3 * sizeof(int32_t);
    const size_t body = 2 * sizeof(scree_pose) + sizeof(scree_moving_body) + 2 * sizeof(scree_real) + sizeof(int32_t) +
                        (has_spheres ? sizeof(scree_sphere) : 0);
    const size_t tree =
        2 * sizeof(scree_lbvh_node) + 3 * sizeof(int32_t) + 1 + 2 * (sizeof(uint64_t) + sizeof(int32_t));
    const size_t rows = 4 * sizeof(int32_t);
    const scree_places *places = &s->buffers->places;
    const bool may_move = !places->are_kept && s->particles.num_particles > places->few;
    bytes.search = body + rows + (may_move ? 5 * sizeof(int32_t) + sizeof(scree_pose) : 0);
    bytes.search_scratch = sizeof(scree_box) + sizeof(scree_vec3) + sizeof(scree_real) + tree;
    // ids, rows, batch unless there is but one, first contact now and in the step before
    const bool is_all = has_meshes + has_spheres + has[SCREE_KIND_CLUMP] == 1 && (has_meshes || s->num_walls == 0);
    bytes.pair = sizeof(scree_candidate_pair) + sizeof(int32_t) + (is_all ? 0 : sizeof(int32_t)) + 2 * sizeof(int32_t);
    bytes.pair_scratch = 2 * sizeof(uint64_t);
    if (has_meshes) bytes.mesh_pair = sizeof(scree_pair_memory) + 2 * sizeof(int32_t);
    if ((has_spheres || has[SCREE_KIND_CLUMP]) && (has_meshes || s->num_walls > 0))
        bytes.sphere_mesh_pair = sizeof(scree_near_nodes) + 3 * sizeof(scree_sphere_contact);
    bytes.contact_block = (size_t)scree_contact_list_block_bytes(&s->contacts);
    bytes.contact = (size_t)scree_contact_list_bytes(&s->contacts) - bytes.contact_block + sizeof(int32_t) + 1;
    if (has_meshes && !s->contacts.has_no_levers) bytes.contact += sizeof(scree_kept_lever);
    for (int32_t k = 0; k < 2 * s->num_shapes; ++k) bytes.shapes += scree_shape_view_bytes(s->shape_views + k);
    return bytes;
}

scree_plan_bytes scree_plan_added_up(scree_plan_bytes bytes, int64_t num_particles, int64_t num_pairs,
                                     int64_t num_contacts)
{
    const double search =
        (double)bytes.search_scratch * (double)num_particles + (double)bytes.pair_scratch * (double)num_pairs;
    if (search > (double)bytes.contact_block * (double)num_contacts)
    {
        bytes.search += bytes.search_scratch;
        bytes.pair += bytes.pair_scratch;
    }
    else bytes.contact += bytes.contact_block;
    bytes.search_scratch = bytes.pair_scratch = bytes.contact_block = 0;
    return bytes;
}

static void print_stage(FILE *out, const char *stage, const char *why, size_t bytes, const char *per)
{
    fprintf(out, "  %-22s %-62s", stage, why);
    if (bytes > 0) fprintf(out, " %4zu B/%s", bytes, per);
    fputc('\n', out);
}

/// How contacts are found, by the kinds of shapes that can meet.
static void print_narrow_phase(const scree_simulation *s, const scree_plan_bytes *bytes, FILE *out)
{
    bool has[SCREE_NUM_SHAPE_KINDS] = {false};
    for (int64_t i = 0; i < s->particles.num_particles; ++i) has[s->shape_views[s->particles.shape[i]].kind] = true;
    const bool has_meshes = has[SCREE_KIND_MESH], has_clumps = has[SCREE_KIND_CLUMP];
    const bool has_spheres = has[SCREE_KIND_SPHERE] || has_clumps;
    const char *stage = "narrow phase";
    char text[96];
    if (has_meshes)
    {
        snprintf(text, sizeof text, "polyhedra: exact overlap, %s scheme, a contact per %s",
                 s->scene->solver.overlap_scheme, s->scene->solver.separate_patches ? "patch" : "pair");
        print_stage(out, stage, text, bytes->mesh_pair, "pair");
        stage = "";
    }
    if (has_spheres && (has_meshes || s->num_walls > 0))
    {
        snprintf(text, sizeof text, "spheres%s on meshes: faces, edges and vertices that are nearest",
                 has_clumps ? " and those of clumps" : "");
        print_stage(out, stage, text, bytes->sphere_mesh_pair, "pair");
        stage = "";
    }
    if (has[SCREE_KIND_SPHERE]) print_stage(out, stage, "spheres with each other: closed form", 0, "");
    if (has_clumps)
        print_stage(out, has[SCREE_KIND_SPHERE] ? "" : stage, "clumps: closed form of their spheres", 0, "");
    print_stage(out, "contacts", "sorted by pair, and the history of the step before",
                bytes->contact + bytes->contact_block, "contact");
}

/// What the laws of the scene bring along.
static void describe_forces(const scree_simulation *s, char *text, size_t size)
{
    bool is_used[SCREE_NUM_FORCE_MODELS] = {false}, has_spring = false, has_damping = false, has_rolling = false;
    for (int32_t k = 0; k < s->num_materials * s->num_materials; ++k)
    {
        const scree_force_law *law = s->laws + k;
        if (!(law->effective_modulus > 0)) continue; // no law for this pair
        is_used[law->model] = true;
        has_spring |= law->has_tangential_spring && law->friction_coefficient > 0;
        has_damping |= law->damping_ratio > 0;
        has_rolling |= law->rolling != SCREE_ROLLING_NONE;
    }
    size_t length = 0;
    for (int32_t m = 0; m < SCREE_NUM_FORCE_MODELS && length < size; ++m)
        if (is_used[m])
            length += (size_t)snprintf(text + length, size - length, "%s%s", length > 0 ? ", " : "",
                                       scree_force_models()[m].name);
    if (length < size)
        snprintf(text + length, size - length, "%s%s%s", has_damping ? ", damping" : "",
                 has_spring ? ", tangential spring" : "", has_rolling ? ", rolling resistance" : "");
}

/// The fields that are measured, if any.
static void print_averages(const scree_simulation *s, FILE *out)
{
    const scree_averages *averages = &s->averages;
    if (!averages->is_on) return;
    char text[96];
    snprintf(text, sizeof text, "%lld samples in periods of %.4g s", (long long)averages->samples, averages->period);
    print_stage(out, "fields", text, 2 * 7 * sizeof(double), "cell");
    if (averages->num_bins > 0)
        print_stage(out, "collisions", "energies of contacts from start to end", 4 * sizeof(double), "contact");
}

void scree_simulation_print_plan(const scree_simulation *simulation, void *stream)
{
    FILE *out = stream;
    const scree_simulation *s = simulation;
    const scree_plan_bytes bytes = scree_simulation_plan_bytes(s);
    bool is_moving = false;
    for (int32_t w = 0; w < s->num_walls; ++w) is_moving |= s->scene->walls[w].motion.kind != SCREE_MOTION_FIXED;
    char text[96];

    fprintf(out, "plan of \"%s\": %lld particles, %d walls, %lld steps of %.4g s\n", s->scene->name,
            (long long)s->particles.num_particles, s->num_walls, (long long)scree_simulation_num_steps(s),
            s->time_step);
    print_stage(out, "predict", "velocity Verlet, implicit midpoint rotation", bytes.state, "particle");
    if (is_moving) print_stage(out, "walls", "some walls move as prescribed", 0, "");
    snprintf(text, sizeof text, "LBVH over boxes with a skin of %.3g m; reused until it is used up",
             (double)s->buffers->skin);
    print_stage(out, "neighbours", text, bytes.search + bytes.search_scratch, "particle");
    print_stage(out, "", "candidate pairs and their rows", bytes.pair + bytes.pair_scratch, "pair");
    print_narrow_phase(s, &bytes, out);
    describe_forces(s, text, sizeof text);
    print_stage(out, "forces", text, 0, "");
    print_stage(out, "gather", "per particle over its row of contacts, in fixed order", 0, "");
    print_stage(out, "correct", "second half kick", 0, "");
    print_stage(out, "work", "energy balance and critical time step", 0, "");
    if (is_moving) print_stage(out, "loads", "torque, force and work of the moving walls", 0, "");
    print_averages(s, out);
    const int64_t num_pairs = s->broad_phase.num_pairs;
    const scree_plan_bytes all = scree_plan_added_up(bytes, s->particles.num_particles, num_pairs, num_pairs);
    const double particles = (double)s->particles.num_particles * (double)(all.state + all.search);
    const double pairs = (double)num_pairs * (double)(scree_plan_largest_pair(&all) + all.contact);
    fprintf(out,
            "  memory now about %.3g MB for %lld candidate pairs, all of them as contacts, and %.3g MB for shapes;\n"
            "  a search of candidates works in that of the contacts\n",
            (particles + pairs) / 1e6, (long long)num_pairs, (double)bytes.shapes / 1e6);
}

void scree_simulation_print_device_memory(const scree_simulation *simulation, scree_device *device, void *stream)
{
    const scree_device_memory memory = scree_device_memory_of(simulation);
    const double num_free = (double)scree_device_free_memory(device);
    FILE *out = stream;
    fprintf(out,
            "  on GPU \"%s\": %lld B/particle, %lld B/pair, %lld B/contact, %.3g MB for shapes; for %lld pairs and "
            "%lld\n",
            scree_device_name(device), (long long)memory.per_particle, (long long)memory.per_pair,
            (long long)memory.per_contact, (double)memory.shapes / 1e6, (long long)memory.num_pairs,
            (long long)memory.num_contacts);
    fprintf(out, "    contacts, as now or in a dense bed, %.3g MB of %.3g MB free: ", (double)memory.total / 1e6,
            num_free / 1e6);
    if ((double)memory.total <= num_free) fprintf(out, "fits\n");
    else
        fprintf(out, "does not fit; about %lld particles would\n",
                (long long)scree_num_that_fit(&memory, simulation->particles.num_particles, (int64_t)num_free));
}
