/// \file simplify.c
/// Edge collapses by meshoptimizer (quadric errors after Garland & Heckbert 1997), which keep the topology but not the
/// absence of self-intersection. Each result is validated; where it fails, other ways to the same number of triangles
/// and then neighbouring numbers are tried, in a fixed order. Vertices are a subset of the old ones, scaled about the
/// centroid at the end.
#include "polyhedra/simplify.h"
#include "polyhedra/generate_internal.h"
#include "polyhedra/mass_properties.h"
#include "polyhedra/mesh_edges.h"

#include <float.h>
#include <meshoptimizer.h>
#include <stdlib.h>
#include <string.h>

/// One way to fewer triangles: the number to end with, relative to the wanted one, and the share of it to stop at
/// once before.
typedef struct simplify_attempt
{
    int32_t offset;
    double detour; ///< [1] over the wanted number; 0: none
} simplify_attempt;

static const simplify_attempt attempts[] = {{0, 0.0},  {0, 2.0}, {0, 1.3},  {0, 4.0}, {-2, 0.0}, {2, 0.0},
                                            {-2, 2.0}, {2, 2.0}, {0, 1.1},  {0, 8.0}, {-4, 0.0}, {4, 0.0},
                                            {-4, 2.0}, {4, 2.0}, {-6, 0.0}, {6, 0.0}};

enum
{
    NUM_ATTEMPTS = sizeof attempts / sizeof attempts[0]
};

/// Vertices in single precision as meshoptimizer wants them, from the corner of the box in units of its diagonal.
static float *single_positions(const scree_mesh *mesh)
{
    const scree_box box = scree_mesh_box(mesh);
    const double size = scree_box_diagonal(box);
    float *positions = malloc(3 * (size_t)mesh->num_vertices * sizeof *positions);
    for (int32_t i = 0; positions != NULL && i < mesh->num_vertices; ++i)
    {
        const scree_vec3 p = mesh->vertices[i];
        positions[3 * (size_t)i] = (float)(((double)p.x - (double)box.lower.x) / size);
        positions[3 * (size_t)i + 1] = (float)(((double)p.y - (double)box.lower.y) / size);
        positions[3 * (size_t)i + 2] = (float)(((double)p.z - (double)box.lower.z) / size);
    }
    return positions;
}

/// The triangles and the vertices that they use, as a mesh of its own.
static scree_status compact(scree_mesh *result, const scree_mesh *mesh, const unsigned int *indices, size_t num_indices)
{
    *result = (scree_mesh){0};
    int32_t *new_index = malloc((size_t)mesh->num_vertices * sizeof *new_index);
    if (new_index == NULL) return SCREE_OUT_OF_MEMORY;
    int32_t num_vertices = 0;
    for (int32_t i = 0; i < mesh->num_vertices; ++i) new_index[i] = -1;
    for (size_t i = 0; i < num_indices; ++i) new_index[indices[i]] = 0;
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
        if (new_index[i] == 0) new_index[i] = num_vertices++;
    const scree_status status = scree_mesh_create(result, num_vertices, (int32_t)(num_indices / 3));
    if (status == SCREE_OK)
    {
        for (int32_t i = 0; i < mesh->num_vertices; ++i)
            if (new_index[i] >= 0) result->vertices[new_index[i]] = mesh->vertices[i];
        for (size_t i = 0; i < num_indices; ++i) result->triangles[i / 3].v[i % 3] = new_index[indices[i]];
    }
    free(new_index);
    return status;
}

/// Buffers of all attempts.
typedef struct simplifier
{
    const scree_mesh *mesh;
    float *positions;
    unsigned int *all;     ///< indices of the mesh
    unsigned int *between; ///< after the detour
    unsigned int *indices; ///< in the end
    size_t num_indices;
} simplifier;

static void run_attempt(simplifier *s, int32_t num_triangles, double detour)
{
    const size_t num_vertices = (size_t)s->mesh->num_vertices;
    const size_t stride = 3 * sizeof(float);
    const unsigned int *from = s->all;
    size_t num = 3 * (size_t)s->mesh->num_triangles;
    const double stop = detour * (double)num_triangles;
    if (stop > 0.0 && stop < (double)s->mesh->num_triangles)
    {
        num = meshopt_simplify(s->between, from, num, s->positions, num_vertices, stride, 3 * (size_t)stop, FLT_MAX, 0,
                               NULL);
        from = s->between;
    }
    // a detour may end below the target, where meshoptimizer must not be asked
    s->num_indices = num;
    if (num > 3 * (size_t)num_triangles)
        s->num_indices = meshopt_simplify(s->indices, from, num, s->positions, num_vertices, stride,
                                          3 * (size_t)num_triangles, FLT_MAX, 0, NULL);
    else memcpy(s->indices, from, num * sizeof *from);
}

/// Scales the mesh about its centroid.
static void restore_volume(scree_mesh *mesh, double volume)
{
    scree_mass_properties properties;
    scree_mass_properties_compute(mesh, &properties);
    const double scale = scree_cube_root(volume / properties.volume);
    const double *c = properties.centroid;
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
    {
        const scree_vec3 p = mesh->vertices[i];
        mesh->vertices[i] = scree_vec3_make((scree_real)(c[0] + scale * ((double)p.x - c[0])),
                                            (scree_real)(c[1] + scale * ((double)p.y - c[1])),
                                            (scree_real)(c[2] + scale * ((double)p.z - c[2])));
    }
}

static bool is_near(int32_t num, int32_t wanted)
{
    const int32_t allowed = wanted / 20 > 6 ? wanted / 20 : 6;
    return num >= wanted - allowed && num <= wanted + allowed;
}

/// The first attempt that ends near the wanted number in a valid mesh of the wanted volume.
static scree_status try_all(simplifier *s, int32_t num_triangles, double volume, scree_mesh *result,
                            scree_report *report)
{
    scree_report faults = {0};
    int32_t num_reached = 0;
    for (int i = 0; i < NUM_ATTEMPTS; ++i)
    {
        const int32_t target = num_triangles + attempts[i].offset;
        if (target < 4) continue;
        run_attempt(s, target, attempts[i].detour);
        num_reached = (int32_t)(s->num_indices / 3);
        if (!is_near(num_reached, num_triangles)) continue;
        scree_status status = compact(result, s->mesh, s->indices, s->num_indices);
        if (status != SCREE_OK) return status;
        scree_report_clear(&faults);
        // once on the old coordinates, so that there is a volume to restore, and once on what is handed out
        status = scree_mesh_validate(result, "the simplified mesh", &faults);
        if (status == SCREE_OK)
        {
            restore_volume(result, volume);
            status = scree_mesh_validate(result, "the simplified mesh", &faults);
        }
        if (status == SCREE_OK) return status;
        scree_mesh_destroy(result);
        if (status != SCREE_BAD_MESH) return status;
    }
    if (faults.num_messages > 0)
        scree_report_add(report,
                         "no way was found to %d triangles without damage, the last one: %s; ask for more triangles",
                         num_triangles, faults.messages[0]);
    else
        scree_report_add(report, "the mesh cannot be simplified to %d triangles, only to %d; ask for more",
                         num_triangles, num_reached);
    scree_report_clear(&faults);
    return SCREE_BAD_MESH;
}

static scree_status simplify_to(const scree_mesh *mesh, int32_t num_triangles, double volume, scree_mesh *result,
                                scree_report *report)
{
    const size_t num_indices = 3 * (size_t)mesh->num_triangles;
    simplifier s = {.mesh = mesh};
    s.positions = single_positions(mesh);
    s.all = malloc(num_indices * sizeof *s.all);
    s.between = malloc(num_indices * sizeof *s.between);
    s.indices = malloc(num_indices * sizeof *s.indices);
    scree_status status = SCREE_OUT_OF_MEMORY;
    if (s.positions != NULL && s.all != NULL && s.between != NULL && s.indices != NULL)
    {
        for (size_t i = 0; i < num_indices; ++i) s.all[i] = (unsigned int)mesh->triangles[i / 3].v[i % 3];
        status = try_all(&s, num_triangles, volume, result, report);
    }
    free(s.positions);
    free(s.all);
    free(s.between);
    free(s.indices);
    return status;
}

scree_status scree_mesh_simplify(scree_mesh *mesh, int32_t num_triangles, double volume, scree_report *report)
{
    if (num_triangles < 4 || !(volume >= 0.0 && volume <= DBL_MAX))
    {
        scree_report_add(report, "triangles is %d and volume is %g; they must be at least 4, and 0 (keep) or more",
                         num_triangles, volume);
        return SCREE_INVALID_INPUT;
    }
    scree_mass_properties properties;
    scree_mass_properties_compute(mesh, &properties);
    const double wanted_volume = volume > 0.0 ? volume : properties.volume;
    if (!(wanted_volume > 0.0))
    {
        scree_report_add(report, "the mesh has volume %g; it must be valid before it is simplified", properties.volume);
        return SCREE_BAD_MESH;
    }
    if (num_triangles >= mesh->num_triangles)
    {
        if (volume > 0.0) restore_volume(mesh, volume);
        return SCREE_OK;
    }
    scree_mesh result = {0};
    const scree_status status = simplify_to(mesh, num_triangles, wanted_volume, &result, report);
    if (status != SCREE_OK) return status;
    scree_mesh_destroy(mesh);
    *mesh = result;
    return SCREE_OK;
}
