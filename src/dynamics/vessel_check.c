/// \file vessel_check.c
/// Closed vessels: walls whose mesh has an inner surface of its own, around a void that is most of the wall. Particles
/// belong into such a void. Vessels that several walls make together: enclosure_check.c.
///
/// The surface of a mesh falls into parts that no edge joins; around a void the triangles face inwards, so that the
/// signed volume of the part is negative. A point outside of the solid whose nearest triangle belongs to such a part is
/// in its void; of another point the solid angle of these parts tells (van Oosterom & Strackee 1983).
#include "contact/closest_point_kernel.h"
#include "dynamics/start_check.h"

#include <math.h>
#include <stdlib.h>

/// Share of what the outer surface holds that has to be void.
#define VESSEL_SHARE 0.5

static scree_vec3 corner(const scree_shape_view *shape, int32_t t, int k)
{
    return shape->vertices[shape->triangles[t].v[k]];
}

static double six_volume(const scree_shape_view *shape, int32_t t)
{
    return (double)scree_vec3_dot(corner(shape, t, 0), scree_vec3_cross(corner(shape, t, 1), corner(shape, t, 2)));
}

/// Marks the triangles that can be reached from `first` by `mark`; the signed volume of that part, six times.
static double mark_part(const scree_shape_view *shape, int32_t first, int8_t mark, int8_t *marks, int32_t *stack)
{
    int32_t num = 1;
    double volume = 0;
    stack[0] = first;
    marks[first] = mark;
    while (num > 0)
    {
        const int32_t t = stack[--num];
        volume += six_volume(shape, t);
        for (int k = 0; k < 3; ++k)
        {
            const int32_t other = shape->neighbours[3 * t + k];
            if (marks[other] == mark) continue;
            marks[other] = mark;
            stack[num++] = other;
        }
    }
    return volume;
}

/// Which triangles face a void: (num_triangles), 1 or 0. NULL if the wall is no vessel, or without memory.
static int8_t *find_voids(const scree_shape_view *shape, bool *is_out_of_memory)
{
    enum
    {
        NEW = -1,
        SEEN = 2
    };
    const int32_t num = shape->num_triangles;
    int8_t *marks = malloc((size_t)num + 1);
    int32_t *stack = malloc(((size_t)num + 1) * sizeof *stack);
    double outer = 0, voids = 0;
    *is_out_of_memory = marks == NULL || stack == NULL;
    for (int32_t t = 0; t < num && !*is_out_of_memory; ++t) marks[t] = NEW;
    for (int32_t t = 0; t < num && !*is_out_of_memory; ++t)
    {
        if (marks[t] != NEW) continue;
        const double volume = mark_part(shape, t, SEEN, marks, stack);
        mark_part(shape, t, volume < 0, marks, stack);
        *(volume < 0 ? &voids : &outer) += fabs(volume);
    }
    free(stack);
    if (!*is_out_of_memory && voids > VESSEL_SHARE * outer) return marks;
    free(marks);
    return NULL;
}

/// Does the solid angle of the surfaces around voids tell that the point is in one?
static bool is_in_void(const scree_shape_view *shape, const int8_t *voids, scree_vec3 point)
{
    double angle = 0;
    for (int32_t t = 0; t < shape->num_triangles; ++t)
    {
        if (voids[t] == 0) continue;
        const scree_vec3 a = scree_vec3_sub(corner(shape, t, 0), point), b = scree_vec3_sub(corner(shape, t, 1), point);
        const scree_vec3 c = scree_vec3_sub(corner(shape, t, 2), point);
        const double u = (double)scree_vec3_length(a), v = (double)scree_vec3_length(b);
        const double w = (double)scree_vec3_length(c);
        const double below = u * v * w + (double)scree_vec3_dot(a, b) * w + (double)scree_vec3_dot(b, c) * u +
                             (double)scree_vec3_dot(c, a) * v;
        angle += 2 * atan2((double)scree_vec3_dot(a, scree_vec3_cross(b, c)), below);
    }
    return fabs(angle) > 2 * 3.141592653589793;
}

/// Is a point in a void of the wall, or in its solid, where other checks find it? The answer is true of all points of
/// the ball *clear.
static bool is_held(const scree_simulation *s, int32_t w, const int8_t *voids, scree_vec3 point,
                    scree_clear_ball *clear)
{
    const scree_shape_view *shape = s->shape_views + s->num_shapes + s->walls[w].shape;
    const scree_pose pose = s->walls[w].pose;
    const scree_vec3 p =
        scree_mat3_apply_transposed(scree_mat3_from_quat(pose.orientation), scree_vec3_sub(point, pose.position));
    *clear = (scree_clear_ball){point, sqrt((double)scree_box_distance_squared(shape->box, p))};
    if (clear->radius > 0) return false;
    const scree_closest_point closest = scree_closest_on_mesh(shape, p);
    clear->radius = sqrt((double)closest.squared);
    if (voids[closest.triangle] != 0 || (double)scree_approach_of(shape, &closest).height < 0) return true;
    return is_in_void(shape, voids, p);
}

scree_status scree_find_outside_of_vessels(const scree_simulation *s, int32_t *vessel, bool *is_outside)
{
    const int64_t num_particles = s->particles.num_particles;
    *vessel = -1;
    for (int32_t w = 0; w < s->num_walls; ++w)
    {
        if (!s->walls[w].is_present) continue;
        bool is_out_of_memory;
        int8_t *voids = find_voids(s->shape_views + s->num_shapes + s->walls[w].shape, &is_out_of_memory);
        if (is_out_of_memory) return SCREE_OUT_OF_MEMORY;
        if (voids == NULL) continue;
        scree_clear_ball clear = {0};
        bool is_in = false;
        for (int64_t i = 0; i < num_particles; ++i)
        {
            const scree_vec3 point = s->particles.position[i];
            if (!scree_is_in_clear_ball(&clear, point, 0)) is_in = is_held(s, w, voids, point, &clear);
            is_outside[i] = (*vessel < 0 || is_outside[i]) && !is_in;
        }
        free(voids);
        *vessel = w;
    }
    return SCREE_OK;
}
