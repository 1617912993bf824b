#include "dynamics/start_check.h"

#include "contact/closest_point_kernel.h"
#include "dynamics/step_buffers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum
{
    MAX_TOLD = 5 ///< particles of one fault that are named; the others are counted
};

/// Bodies that start deeper inside each other than any contact law is meant for.
#define MAX_INDENTATION 0.05

static double bounding_radius(const scree_simulation *s, int64_t i)
{
    return (double)s->particle_shapes[s->particles.shape[i]].view.bounding_radius * (double)s->particles.scale[i];
}

/// "particle 3 of "fill" at (1, 2, 3)"
typedef struct particle_text
{
    char text[400];
} particle_text;

static particle_text describe(const scree_simulation *s, int64_t i)
{
    const scree_vec3 x = s->particles.position[i];
    particle_text p;
    snprintf(p.text, sizeof p.text, "particle %lld of \"%.200s\" at (%g, %g, %g)", (long long)i,
             s->scene->particles[s->particles.group[i]].name, (double)x.x, (double)x.y, (double)x.z);
    return p;
}

static particle_text describe_body(const scree_simulation *s, int64_t body)
{
    const int64_t num_particles = s->particles.num_particles;
    particle_text p;
    if (body < num_particles) snprintf(p.text, sizeof p.text, "particle %lld", (long long)body);
    else snprintf(p.text, sizeof p.text, "wall \"%.200s\"", s->scene->walls[body - num_particles].name);
    return p;
}

static void tell_more(scree_report *report, int64_t num, const char *what)
{
    if (num > MAX_TOLD) scree_report_add(report, "%lld more particles %s", (long long)(num - MAX_TOLD), what);
}

/// Contacts that are too deep. Returns their number.
static int64_t check_contacts(const scree_simulation *s, scree_report *report)
{
    const scree_contact_list *contacts = &s->contacts;
    int64_t num = 0;
    for (int64_t c = 0; c < contacts->num_contacts; ++c)
    {
        const scree_candidate_pair pair = contacts->bodies[c];
        if ((double)contacts->indentation[c] <= MAX_INDENTATION * bounding_radius(s, pair.i)) continue;
        if (++num > MAX_TOLD) continue;
        scree_report_add(
            report,
            "%s starts %g m inside %s, more than %g of its bounding radius; move one of them or the region "
            "of the particles",
            describe(s, pair.i).text, (double)contacts->indentation[c], describe_body(s, pair.j).text, MAX_INDENTATION);
    }
    tell_more(report, num, "start inside others");
    return num;
}

/// Spheres with one centre: there is no direction to push them apart.
static int64_t check_centres(const scree_simulation *s, scree_report *report)
{
    const scree_broad_phase *broad_phase = &s->broad_phase;
    int64_t num = 0;
    for (int64_t p = 0; p < broad_phase->num_pairs; ++p)
    {
        const scree_candidate_pair pair = broad_phase->pairs[p];
        if (pair.j >= s->particles.num_particles) continue;
        const scree_vec3 d = scree_vec3_sub(s->particles.position[pair.i], s->particles.position[pair.j]);
        if (scree_vec3_dot(d, d) > 0 || s->shape_views[s->particles.shape[pair.i]].kind != SCREE_KIND_SPHERE ||
            s->shape_views[s->particles.shape[pair.j]].kind != SCREE_KIND_SPHERE)
            continue;
        if (++num <= MAX_TOLD)
            scree_report_add(report, "%s has the centre of particle %d; move one of them", describe(s, pair.i).text,
                             pair.j);
    }
    tell_more(report, num, "share a centre");
    return num;
}

/// How far below the surface of a wall's solid a point is [m]; negative outside.
static double depth_in_wall(const scree_simulation *s, int32_t w, scree_vec3 point)
{
    const scree_shape_view *shape = s->shape_views + s->num_shapes + s->walls[w].shape;
    const scree_pose pose = s->walls[w].pose;
    const scree_vec3 p =
        scree_mat3_apply_transposed(scree_mat3_from_quat(pose.orientation), scree_vec3_sub(point, pose.position));
    if (scree_box_distance_squared(shape->box, p) > 0) return -1;
    const scree_closest_point closest = scree_closest_on_mesh(shape, p);
    return -(double)scree_approach_of(shape, &closest).height;
}

/// Particles wholly inside the solid of a wall: no surface is near to push them out.
static int64_t check_solids(const scree_simulation *s, scree_report *report)
{
    const int64_t num_particles = s->particles.num_particles;
    int64_t num = 0;
    for (int32_t w = 0; w < s->num_walls; ++w)
    {
        if (!s->walls[w].is_present) continue;
        for (int64_t i = 0; i < num_particles; ++i)
        {
            const double depth = depth_in_wall(s, w, s->particles.position[i]);
            if (!(depth >= bounding_radius(s, i)) || ++num > MAX_TOLD) continue;
            scree_report_add(report,
                             "%s starts inside the solid of %s, %g m below its surface; walls are closed solids: move "
                             "the particles out, or make a hollow wall of plates or of its shell",
                             describe(s, i).text, describe_body(s, num_particles + w).text, depth);
        }
    }
    tell_more(report, num, "start inside the solid of a wall");
    return num;
}

/// World boxes of the walls; NULL: out of memory.
static scree_box *make_wall_boxes(const scree_simulation *s)
{
    scree_box *boxes = malloc((size_t)(s->num_walls + 1) * sizeof *boxes);
    for (int32_t w = 0; boxes != NULL && w < s->num_walls; ++w)
    {
        const scree_shape_view *shape = s->shape_views + s->num_shapes + s->walls[w].shape;
        const scree_pose pose = s->walls[w].pose;
        const scree_mat3 rotation = scree_mat3_from_quat(pose.orientation);
        boxes[w] = scree_box_empty();
        for (int32_t v = 0; v < shape->num_vertices; ++v)
            boxes[w] = scree_box_with_point(
                boxes[w], scree_vec3_add(pose.position, scree_mat3_apply(rotation, shape->vertices[v])));
    }
    return boxes;
}

/// Does the ball come into the box on its way from `start` along `way`?
static bool falls_into(scree_box box, scree_vec3 start, double radius, const double way[3])
{
    const double from[3] = {(double)start.x, (double)start.y, (double)start.z};
    const double lower[3] = {(double)box.lower.x, (double)box.lower.y, (double)box.lower.z};
    const double upper[3] = {(double)box.upper.x, (double)box.upper.y, (double)box.upper.z};
    double begin = 0, end = INFINITY;
    for (int k = 0; k < 3; ++k)
    {
        const double low = lower[k] - radius - from[k], high = upper[k] + radius - from[k];
        if (way[k] == 0 && (low > 0 || high < 0)) return false;
        if (way[k] == 0) continue;
        begin = fmax(begin, fmin(low / way[k], high / way[k]));
        end = fmin(end, fmax(low / way[k], high / way[k]));
    }
    return begin <= end;
}

/// Particles at rest that nothing is below: outside of the walls. Where walls are carried along, they may still come.
/// Returns their number.
static int64_t check_lost(const scree_simulation *s, scree_report *report)
{
    const double *gravity = s->scene->gravity;
    bool is_known = s->num_walls > 0 && (gravity[0] != 0 || gravity[1] != 0 || gravity[2] != 0);
    for (int32_t w = 0; w < s->num_walls; ++w) is_known &= s->scene->walls[w].motion.kind != SCREE_MOTION_TRANSLATE;
    scree_box *boxes = is_known ? make_wall_boxes(s) : NULL;
    int64_t num = 0;
    for (int64_t i = 0; boxes != NULL && i < s->particles.num_particles; ++i)
    {
        const scree_vec3 v = s->particles.velocity[i];
        bool is_lost = scree_vec3_dot(v, v) == 0;
        for (int32_t w = 0; w < s->num_walls && is_lost; ++w)
            is_lost = !falls_into(boxes[w], s->particles.position[i], bounding_radius(s, i), gravity);
        if (!is_lost || ++num > MAX_TOLD) continue;
        scree_report_add(
            report,
            "%s is outside of the walls: none is below it, and it would fall for ever; move it, or make the "
            "walls reach below it",
            describe(s, i).text);
    }
    free(boxes);
    tell_more(report, num, "are outside of the walls");
    return num;
}

/// Particles outside of a vessel of one wall. Returns their number.
static int64_t tell_outside_of_wall(const scree_simulation *s, const bool *is_outside, int32_t vessel,
                                    scree_report *report)
{
    const int64_t num_particles = s->particles.num_particles;
    int64_t num = 0;
    for (int64_t i = 0; i < num_particles; ++i)
    {
        if (!is_outside[i] || ++num > MAX_TOLD) continue;
        scree_report_add(
            report,
            "%s is outside of the closed %s, which is hollow to hold particles; move it inside, or, if the "
            "wall is in their way, take away its inner surface",
            describe(s, i).text, describe_body(s, num_particles + vessel).text);
    }
    tell_more(report, num, "are outside of the closed wall");
    return num;
}

/// "walls "shell", "front" and "rear"", those that stay.
static void name_walls(const scree_simulation *s, char *text, size_t size)
{
    int32_t num = 0, k = 0;
    for (int32_t w = 0; w < s->num_walls; ++w) num += scree_wall_stays(s, w);
    int length = snprintf(text, size, "walls");
    for (int32_t w = 0; w < s->num_walls && k < MAX_TOLD; ++w)
    {
        if (!scree_wall_stays(s, w)) continue;
        ++k;
        length += snprintf(text + length, size - (size_t)length, "%s \"%.60s\"",
                           k == 1     ? ""
                           : k == num ? " and"
                                      : ",",
                           s->scene->walls[w].name);
    }
    if (num > k) snprintf(text + length, size - (size_t)length, " and %d more", num - k);
}

/// Particles outside of walls that enclose most of them. Returns their number.
static int64_t tell_outside_of_walls(const scree_simulation *s, const bool *is_outside, int64_t num_inside,
                                     scree_report *report)
{
    const int64_t num_particles = s->particles.num_particles;
    char names[80 * (MAX_TOLD + 1)];
    name_walls(s, names, sizeof names);
    int64_t num = 0;
    for (int64_t i = 0; i < num_particles; ++i)
    {
        if (!is_outside[i] || ++num > MAX_TOLD) continue;
        scree_report_add(report,
                         "%s is outside of what the %s close together, which holds %lld of %lld particles and has no "
                         "hole as wide as the smallest one; move it inside, or, if it belongs there, let a wall open "
                         "(motion.opens) or give it a time to go (removed_at, which may lie after the end)",
                         describe(s, i).text, names, (long long)num_inside, (long long)num_particles);
    }
    tell_more(report, num, "are outside of these walls");
    return num;
}

/// Particles outside of a closed vessel, or, if there is none, that fall past all walls. Returns their number.
static int64_t check_outside(const scree_simulation *s, scree_report *report, scree_status *status)
{
    bool *is_outside = malloc((size_t)s->particles.num_particles + 1);
    int32_t vessel = -1;
    int64_t num_inside = 0, num = 0;
    *status = is_outside != NULL ? scree_find_outside_of_vessels(s, &vessel, is_outside) : SCREE_OUT_OF_MEMORY;
    if (*status == SCREE_OK && vessel < 0) *status = scree_find_outside_of_walls(s, &num_inside, is_outside);
    if (*status == SCREE_OK && vessel >= 0) num = tell_outside_of_wall(s, is_outside, vessel, report);
    else if (*status == SCREE_OK && num_inside > 0 && 2 * num_inside >= s->particles.num_particles)
        num = tell_outside_of_walls(s, is_outside, num_inside, report);
    else if (*status == SCREE_OK) num = check_lost(s, report);
    free(is_outside);
    return num;
}

scree_status scree_check_start(const scree_simulation *simulation, scree_report *report)
{
    scree_status status = SCREE_OK;
    const int64_t num_faults = check_contacts(simulation, report) + check_centres(simulation, report) +
                               check_solids(simulation, report) + check_outside(simulation, report, &status);
    if (status != SCREE_OK) return status;
    return num_faults > 0 ? SCREE_INVALID_INPUT : SCREE_OK;
}
