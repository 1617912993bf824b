/// \file shape.c
/// Puts a mesh into its frame and builds what the narrow phase needs: neighbours, tree, box, measures.
#include "polyhedra/shape.h"

#include "core/exact_arith.h"

#include <stdlib.h>

/// Shift below which the mesh's origin counts as its centroid, over the bounding radius.
#define CENTRED_TOLERANCE (16.0 * (double)SCREE_REAL_EPSILON)

static bool is_identity(const double q[4]) { return q[1] == 0.0 && q[2] == 0.0 && q[3] == 0.0; }

/// Rows: the axes of the body in the source frame.
static void body_axes(const double q[4], double axes[3][3])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) axes[i][j] = m[j][i];
}

/// Every vertex from the source frame into the frame of the shape.
static void move_into_frame(scree_shape *shape)
{
    double axes[3][3];
    const double *o = shape->frame_position;
    const bool is_turned = !is_identity(shape->frame_orientation);
    if (!is_turned && o[0] == 0.0 && o[1] == 0.0 && o[2] == 0.0) return;
    body_axes(shape->frame_orientation, axes);
    for (int32_t i = 0; i < shape->mesh.num_vertices; ++i)
    {
        scree_vec3 *p = shape->mesh.vertices + i;
        const double r[3] = {(double)p->x - o[0], (double)p->y - o[1], (double)p->z - o[2]};
        double b[3] = {r[0], r[1], r[2]};
        for (int k = 0; is_turned && k < 3; ++k) b[k] = axes[k][0] * r[0] + axes[k][1] * r[1] + axes[k][2] * r[2];
        *p = scree_vec3_make((scree_real)b[0], (scree_real)b[1], (scree_real)b[2]);
    }
}

/// Centroid and principal axes of the mesh, as position and orientation of the frame.
static void choose_frame(scree_shape *shape, scree_shape_frame frame)
{
    shape->frame_orientation[0] = 1.0;
    if (frame == SCREE_FRAME_SOURCE) return;
    scree_mass_properties source;
    scree_mass_properties_compute(&shape->mesh, &source);
    const double tolerance = CENTRED_TOLERANCE * source.bounding_radius;
    bool is_centred = true;
    for (int k = 0; k < 3; ++k) is_centred = is_centred && fabs(source.centroid[k]) <= tolerance;
    for (int k = 0; k < 3; ++k) shape->frame_position[k] = is_centred ? 0.0 : source.centroid[k];
    for (int k = 0; k < 4; ++k) shape->frame_orientation[k] = source.principal_axes[k];
}

static double middle_of(double a, double b, double c)
{
    const double low = a < b ? a : b;
    const double high = a < b ? b : a;
    return c < low ? low : c > high ? high : c;
}

/// The corners of the triangles to the wide tree.
static scree_status add_corners(scree_shape *shape)
{
    const scree_mesh *mesh = &shape->mesh;
    scree_vec3 *corners = malloc(3 * (size_t)mesh->num_triangles * sizeof *corners);
    if (corners == NULL) return SCREE_OUT_OF_MEMORY;
    for (int32_t i = 0; i < mesh->num_triangles; ++i)
        for (int k = 0; k < 3; ++k) corners[3 * (int64_t)i + k] = mesh->vertices[mesh->triangles[i].v[k]];
    const scree_status status = scree_wide_tree_add_corners(&shape->wide_tree, corners);
    free(corners);
    return status;
}

/// The trees over the triangles, in the frame of the shape.
static scree_status build_trees(scree_shape *shape)
{
    const scree_mesh *mesh = &shape->mesh;
    scree_box *boxes = malloc(((size_t)mesh->num_triangles + 1) * sizeof *boxes);
    if (boxes == NULL) return SCREE_OUT_OF_MEMORY;
    for (int32_t i = 0; i < mesh->num_triangles; ++i)
    {
        boxes[i] = scree_box_empty();
        for (int k = 0; k < 3; ++k) boxes[i] = scree_box_with_point(boxes[i], mesh->vertices[mesh->triangles[i].v[k]]);
    }
    scree_status status = scree_lbvh_build(&shape->tree, boxes, mesh->num_triangles);
    if (status == SCREE_OK && mesh->num_triangles >= SCREE_LARGE_SHAPE)
        status = scree_wide_tree_build(&shape->wide_tree, &shape->tree, boxes, mesh->num_triangles);
    if (status == SCREE_OK && shape->wide_tree.view.nodes != NULL) status = add_corners(shape);
    free(boxes);
    return status;
}

/// Joins triangles of a convex shape across edges without an angle, exactly, in the mesh as it was given.
static scree_status join_flat_faces(scree_shape *shape, const scree_mesh *mesh)
{
    const int32_t num = mesh->num_triangles;
    int32_t *face = malloc(((size_t)num + 1) * sizeof *face);
    if (face == NULL) return SCREE_OUT_OF_MEMORY;
    for (int32_t t = 0; t < num; ++t) face[t] = t;
    bool has_flat = false;
    for (bool has_changed = true; has_changed;)
    {
        has_changed = false;
        for (int32_t t = 0; t < num; ++t)
        {
            const int32_t *v = mesh->triangles[t].v;
            for (int k = 0; k < 3; ++k)
            {
                const int32_t other = shape->neighbours[3 * t + k];
                if (face[other] >= face[t]) continue;
                bool is_flat = true;
                for (int c = 0; c < 3; ++c)
                    is_flat =
                        is_flat && scree_orient3d(mesh->vertices[v[0]], mesh->vertices[v[1]], mesh->vertices[v[2]],
                                                  mesh->vertices[mesh->triangles[other].v[c]]) == 0;
                if (!is_flat) continue;
                face[t] = face[other];
                has_changed = has_flat = true;
            }
        }
    }
    if (has_flat) shape->flat_faces = face;
    else free(face);
    return SCREE_OK;
}

static scree_status map_support(scree_shape *shape)
{
    shape->support_map = malloc(SCREE_SUPPORT_VALUES * sizeof *shape->support_map);
    if (shape->support_map == NULL) return SCREE_OUT_OF_MEMORY;
    scree_support_map_fill(shape->support_map, shape->mesh.vertices, shape->mesh.num_vertices);
    return SCREE_OK;
}

static scree_status find_normals(scree_shape *shape)
{
    const scree_mesh *mesh = &shape->mesh;
    shape->normals = malloc(((size_t)mesh->num_triangles + 1) * sizeof *shape->normals);
    if (shape->normals == NULL) return SCREE_OUT_OF_MEMORY;
    for (int32_t t = 0; t < mesh->num_triangles; ++t)
    {
        const int32_t *v = mesh->triangles[t].v;
        const scree_vec3 a = mesh->vertices[v[0]];
        const scree_vec3 area =
            scree_vec3_cross(scree_vec3_sub(mesh->vertices[v[1]], a), scree_vec3_sub(mesh->vertices[v[2]], a));
        shape->normals[t] = scree_vec3_scale(area, 1 / scree_vec3_length(area));
    }
    return SCREE_OK;
}

static void fill_view(scree_shape *shape, bool is_convex)
{
    const scree_mesh *mesh = &shape->mesh;
    scree_real farthest = 0;
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
        farthest = scree_max(farthest, scree_vec3_dot(mesh->vertices[i], mesh->vertices[i]));
    shape->view = (scree_shape_view){
        .vertices = mesh->vertices,
        .triangles = mesh->triangles,
        .neighbours = shape->neighbours,
        .normals = shape->normals,
        .tree = shape->tree.view,
        .wide_tree = shape->wide_tree.view,
        .support_map = shape->support_map,
        .flat_faces = shape->flat_faces,
        .num_vertices = mesh->num_vertices,
        .num_triangles = mesh->num_triangles,
        .is_convex = is_convex,
        // rounded outwards: square, sum and root lose at most three roundoffs
        .bounding_radius = scree_sqrt(farthest) * (1 + 4 * SCREE_REAL_EPSILON),
        .box = scree_mesh_box(mesh),
    };
    const scree_vec3 extent = scree_vec3_sub(shape->view.box.upper, shape->view.box.lower);
    shape->middle_size = middle_of((double)extent.x, (double)extent.y, (double)extent.z);
}

scree_status scree_shape_create(scree_shape *shape, const scree_mesh *mesh, scree_shape_frame frame)
{
    *shape = (scree_shape){0};
    scree_status status = scree_mesh_copy(&shape->mesh, mesh);
    if (status != SCREE_OK) return status;
    // decided on the mesh as given: turning it rounds its flat faces to a few last digits, which cannot matter to
    // bodies that are turned in every step anyway
    const bool is_convex = scree_mesh_is_convex(mesh);
    choose_frame(shape, frame);
    move_into_frame(shape);
    scree_mass_properties_compute(&shape->mesh, &shape->properties);
    shape->neighbours = malloc((3 * (size_t)mesh->num_triangles + 1) * sizeof *shape->neighbours);
    if (shape->neighbours == NULL) status = SCREE_OUT_OF_MEMORY;
    if (status == SCREE_OK) status = scree_mesh_neighbours(&shape->mesh, shape->neighbours);
    if (status == SCREE_OK) status = find_normals(shape);
    if (status == SCREE_OK && is_convex) status = join_flat_faces(shape, mesh);
    if (status == SCREE_OK) status = build_trees(shape);
    if (status == SCREE_OK && mesh->num_triangles >= SCREE_LARGE_SHAPE) status = map_support(shape);
    if (status != SCREE_OK)
    {
        scree_shape_destroy(shape);
        return status;
    }
    fill_view(shape, is_convex);
    return SCREE_OK;
}

void scree_shape_create_sphere(scree_shape *shape, double radius)
{
    const double pi = 3.14159265358979323846;
    const scree_real r = (scree_real)radius; // the measures are those of the radius as stored
    const double moment = 8.0 / 15.0 * pi * (double)r * (double)r * (double)r * (double)r * (double)r;
    *shape = (scree_shape){0};
    shape->properties.volume = 4.0 / 3.0 * pi * (double)r * (double)r * (double)r;
    shape->properties.area = 4.0 * pi * (double)r * (double)r;
    shape->properties.principal_axes[0] = 1.0;
    shape->properties.bounding_radius = (double)r;
    for (int k = 0; k < 3; ++k) shape->properties.inertia[k][k] = shape->properties.principal[k] = moment;
    shape->frame_orientation[0] = 1.0;
    shape->middle_size = 2.0 * (double)r;
    shape->view.kind = SCREE_KIND_SPHERE;
    shape->view.num_spheres = 1;
    shape->view.is_convex = true;
    shape->view.bounding_radius = r;
    shape->view.box.lower = scree_vec3_make(-r, -r, -r);
    shape->view.box.upper = scree_vec3_make(r, r, r);
    shape->view.tree.root = SCREE_LBVH_END;
}

void scree_shape_destroy(scree_shape *shape)
{
    scree_mesh_destroy(&shape->mesh);
    free(shape->neighbours);
    free(shape->normals);
    scree_lbvh_destroy(&shape->tree);
    scree_wide_tree_destroy(&shape->wide_tree);
    free(shape->support_map);
    free(shape->flat_faces);
    free(shape->spheres);
    *shape = (scree_shape){0};
}
