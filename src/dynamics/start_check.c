#include "dynamics/start_check.h"
#include "dynamics/time_step.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// Particles that may be outside of the walls and are compared with all others; more are not worth the time.
#define MAX_COMPARED 1000

/// Share of its radius by which a particle that flies by is taken for larger.
#define ROUNDING 0.01

static double bounding_radius(const scree_simulation *s, int64_t i)
{
    return (double)s->particle_shapes[s->particles.shape[i]].view.bounding_radius * (double)s->particles.scale[i];
}

void scree_tell_more(scree_report *report, int64_t num, const char *what)
{
    if (num > SCREE_MAX_TOLD)
        scree_report_add(report, "%lld more particles %s", (long long)(num - SCREE_MAX_TOLD), what);
}

scree_body_text scree_describe_body(const scree_simulation *s, int64_t body)
{
    const int64_t num_particles = s->particles.num_particles;
    scree_body_text p;
    if (body >= num_particles)
    {
        snprintf(p.text, sizeof p.text, "wall \"%.200s\"", s->scene->walls[body - num_particles].name);
        return p;
    }
    const scree_vec3 x = s->particles.position[body];
    snprintf(p.text, sizeof p.text, "particle %lld of \"%.200s\" at (%g, %g, %g)", (long long)body,
             s->scene->particles[s->particles.group[body]].name, (double)x.x, (double)x.y, (double)x.z);
    return p;
}

/// The circle of a point of a wall that turns.
static scree_box with_circle(scree_box box, const scree_motion_def *motion, scree_vec3 point)
{
    const double *a = motion->axis, *c = motion->centre;
    const double from[3] = {(double)point.x - c[0], (double)point.y - c[1], (double)point.z - c[2]};
    const double squared = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
    const double along = (from[0] * a[0] + from[1] * a[1] + from[2] * a[2]) / squared;
    double middle[3], half[3], radius = 0;
    for (int k = 0; k < 3; ++k)
    {
        middle[k] = c[k] + along * a[k];
        radius = hypot(radius, from[k] - along * a[k]);
    }
    for (int k = 0; k < 3; ++k) half[k] = radius * sqrt(fmax(1 - a[k] * a[k] / squared, 0));
    const scree_vec3 m = scree_vec3_make((scree_real)middle[0], (scree_real)middle[1], (scree_real)middle[2]);
    const scree_vec3 h = scree_vec3_make((scree_real)half[0], (scree_real)half[1], (scree_real)half[2]);
    return scree_box_with_point(scree_box_with_point(box, scree_vec3_sub(m, h)), scree_vec3_add(m, h));
}

/// World boxes of all places that the walls come to; NULL: out of memory.
static scree_box *make_wall_boxes(const scree_simulation *s)
{
    scree_box *boxes = malloc((size_t)(s->num_walls + 1) * sizeof *boxes);
    for (int32_t w = 0; boxes != NULL && w < s->num_walls; ++w)
    {
        const scree_shape_view *shape = s->shape_views + s->num_shapes + s->walls[w].shape;
        const scree_wall_def *def = s->scene->walls + w;
        const scree_pose pose = s->walls[w].pose;
        const scree_mat3 rotation = scree_mat3_from_quat(pose.orientation);
        scree_wall_state last;
        scree_wall_state_at(def, s->scene->time.end, &last);
        const scree_vec3 way = scree_vec3_sub(last.pose.position, pose.position);
        boxes[w] = scree_box_empty();
        for (int32_t v = 0; v < shape->num_vertices; ++v)
        {
            const scree_vec3 point = scree_vec3_add(pose.position, scree_mat3_apply(rotation, shape->vertices[v]));
            boxes[w] = scree_box_with_point(boxes[w], point);
            if (def->motion.kind == SCREE_MOTION_ROTATE) boxes[w] = with_circle(boxes[w], &def->motion, point);
            else boxes[w] = scree_box_with_point(boxes[w], scree_vec3_add(point, way));
        }
    }
    return boxes;
}

/// The free flight of a ball from x: x + v t + g t^2/2.
typedef struct flight
{
    double x[3], v[3], g[3], radius;
} flight;

static flight flight_of(const scree_simulation *s, int64_t i)
{
    const scree_vec3 x = s->particles.position[i], v = s->particles.velocity[i];
    const double *g = s->scene->gravity;
    return (flight){{(double)x.x, (double)x.y, (double)x.z},
                    {(double)v.x, (double)v.y, (double)v.z},
                    {g[0], g[1], g[2]},
                    (1 + ROUNDING) * bounding_radius(s, i)};
}

/// Is the ball in the box at time t? Where it comes in through side `skipped`, if not negative, it is on that.
static bool is_in_at(const flight *f, scree_box box, double t, int skipped)
{
    const double lower[3] = {(double)box.lower.x, (double)box.lower.y, (double)box.lower.z};
    const double upper[3] = {(double)box.upper.x, (double)box.upper.y, (double)box.upper.z};
    bool is_in = true;
    for (int k = 0; k < 3; ++k)
    {
        const double x = f->x[k] + t * (f->v[k] + 0.5 * f->g[k] * t);
        is_in &= k == skipped || (x >= lower[k] - f->radius && x <= upper[k] + f->radius);
    }
    return is_in;
}

/// When the flight is at `place` along axis k: 0, 1 or 2 times, of which negative ones are in the past.
static int times_at(const flight *f, int k, double place, double times[2])
{
    const double a = 0.5 * f->g[k], b = f->v[k], c = f->x[k] - place;
    if (a == 0)
    {
        times[0] = -c / b;
        return b != 0;
    }
    const double discriminant = b * b - 4 * a * c;
    if (discriminant < 0) return 0;
    const double q = -0.5 * (b + copysign(sqrt(discriminant), b));
    times[0] = q / a;
    times[1] = q != 0 ? c / q : 0;
    return 2;
}

/// Does the ball ever come into the box? If so it is in it now, or comes in through one of the sides.
static bool comes_into(const flight *f, scree_box box)
{
    const double lower[3] = {(double)box.lower.x, (double)box.lower.y, (double)box.lower.z};
    const double upper[3] = {(double)box.upper.x, (double)box.upper.y, (double)box.upper.z};
    if (is_in_at(f, box, 0, -1)) return true;
    for (int side = 0; side < 6; ++side)
    {
        const int k = side % 3;
        double times[2];
        const int num = times_at(f, k, side < 3 ? lower[k] - f->radius : upper[k] + f->radius, times);
        for (int n = 0; n < num; ++n)
            if (times[n] >= 0 && is_in_at(f, box, times[n], k)) return true;
    }
    return false;
}

/// Do two balls meet if both fly freely? Seen from each other they fly straight on.
static bool do_meet(const flight *a, const flight *b)
{
    double d[3], w[3], along = 0, squared = 0, distance = 0;
    for (int k = 0; k < 3; ++k)
    {
        d[k] = a->x[k] - b->x[k];
        w[k] = a->v[k] - b->v[k];
        along += d[k] * w[k];
        squared += w[k] * w[k];
    }
    const double t = squared > 0 ? fmax(-along / squared, 0) : 0;
    for (int k = 0; k < 3; ++k) distance = hypot(distance, d[k] + t * w[k]);
    return distance <= a->radius + b->radius;
}

/// May particle i meet another one: if both fly, or if one that walls hold up stays where it is?
static bool may_meet_others(const scree_simulation *s, int64_t i, const bool *is_lost)
{
    const flight mine = flight_of(s, i);
    for (int64_t j = 0; j < s->particles.num_particles; ++j)
    {
        if (j == i) continue;
        const flight other = flight_of(s, j);
        const scree_real r = (scree_real)other.radius;
        const scree_vec3 x = s->particles.position[j], reach = scree_vec3_make(r, r, r);
        const scree_box box = {scree_vec3_sub(x, reach), scree_vec3_add(x, reach)};
        if (do_meet(&mine, &other) || (!is_lost[j] && comes_into(&mine, box))) return true;
    }
    return false;
}

/// Particles whose free flight meets no place that a wall comes to, and may meet no other particle. One that nothing
/// moves may be waited for, and without walls all are meant to fly. Returns their number.
static int64_t check_lost(const scree_simulation *s, scree_report *report, scree_status *status)
{
    const int64_t num_particles = s->particles.num_particles;
    const double *g = s->scene->gravity;
    const bool is_pulled = g[0] != 0 || g[1] != 0 || g[2] != 0;
    if (s->num_walls == 0) return 0;
    scree_box *boxes = make_wall_boxes(s);
    bool *is_lost = calloc((size_t)num_particles + 1, sizeof *is_lost);
    int64_t num = 0, num_compared = 0;
    if (boxes == NULL || is_lost == NULL) *status = SCREE_OUT_OF_MEMORY;
    for (int64_t i = 0; *status == SCREE_OK && i < num_particles; ++i)
    {
        const flight f = flight_of(s, i);
        is_lost[i] = is_pulled || f.v[0] != 0 || f.v[1] != 0 || f.v[2] != 0;
        for (int32_t w = 0; w < s->num_walls && is_lost[i]; ++w) is_lost[i] = !comes_into(&f, boxes[w]);
    }
    for (int64_t i = 0; *status == SCREE_OK && i < num_particles && num_compared < MAX_COMPARED; ++i)
    {
        if (!is_lost[i] || (++num_compared > 0 && may_meet_others(s, i, is_lost)) || ++num > SCREE_MAX_TOLD) continue;
        scree_report_add(report,
                         "%s is outside of the walls: it meets none of them, nor another particle, and would %s for "
                         "ever; move it, or make the walls reach %s",
                         scree_describe_body(s, i).text, is_pulled ? "fall" : "fly",
                         is_pulled ? "below it" : "across its way");
    }
    free(boxes);
    free(is_lost);
    scree_tell_more(report, num, "are outside of the walls");
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
        if (!is_outside[i] || ++num > SCREE_MAX_TOLD) continue;
        scree_report_add(
            report,
            "%s is outside of the closed %s, which is hollow to hold particles; move it inside, or, if the "
            "wall is in their way, take away its inner surface",
            scree_describe_body(s, i).text, scree_describe_body(s, num_particles + vessel).text);
    }
    scree_tell_more(report, num, "are outside of the closed wall");
    return num;
}

/// "walls "shell", "front" and "rear"", those that stay.
static void name_walls(const scree_simulation *s, char *text, size_t size)
{
    int32_t num = 0, k = 0;
    for (int32_t w = 0; w < s->num_walls; ++w) num += scree_wall_stays(s, w);
    int length = snprintf(text, size, "walls");
    for (int32_t w = 0; w < s->num_walls && k < SCREE_MAX_TOLD; ++w)
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
    char names[80 * (SCREE_MAX_TOLD + 1)];
    name_walls(s, names, sizeof names);
    int64_t num = 0;
    for (int64_t i = 0; i < num_particles; ++i)
    {
        if (!is_outside[i] || ++num > SCREE_MAX_TOLD) continue;
        scree_report_add(report,
                         "%s is outside of what the %s close together, which holds %lld of %lld particles and has no "
                         "hole as wide as the smallest one; move it inside, or, if it belongs there, let a wall open "
                         "(motion.opens) or give it a time to go (removed_at, which may lie after the end)",
                         scree_describe_body(s, i).text, names, (long long)num_inside, (long long)num_particles);
    }
    scree_tell_more(report, num, "are outside of these walls");
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
    else if (*status == SCREE_OK) num = check_lost(s, report, status);
    free(is_outside);
    return num;
}

/// Warns, of the particle that would go deepest, if contacts are too soft for it: if it fell freely, as deep as the
/// lowest point of any wall, it would go into what it hits by more than its radius.
static void warn_of_soft_contacts(const scree_simulation *s, scree_report *report)
{
    const double *g = s->scene->gravity;
    double lowest = -INFINITY, worst = 1;
    int64_t worst_particle = -1;
    for (int32_t w = 0; w < s->num_walls; ++w)
    {
        const scree_shape_view *shape = s->shape_views + s->num_shapes + s->walls[w].shape;
        const scree_mat3 rotation = scree_mat3_from_quat(s->walls[w].pose.orientation);
        for (int32_t v = 0; v < shape->num_vertices; ++v)
        {
            const scree_vec3 x =
                scree_vec3_add(s->walls[w].pose.position, scree_mat3_apply(rotation, shape->vertices[v]));
            lowest = fmax(lowest, g[0] * (double)x.x + g[1] * (double)x.y + g[2] * (double)x.z);
        }
    }
    for (int64_t i = 0; i < s->particles.num_particles; ++i)
    {
        const scree_vec3 x = s->particles.position[i], v = s->particles.velocity[i];
        const double fall = fmax(lowest - (g[0] * (double)x.x + g[1] * (double)x.y + g[2] * (double)x.z), 0);
        const double energy = (double)s->particles.mass[i] * (0.5 * (double)scree_vec3_dot(v, v) + fall);
        const double share = energy / scree_impact_capacity(s, i);
        if (share > worst) worst_particle = i;
        worst = fmax(worst, share);
    }
    if (worst_particle < 0) return;
    scree_report_warn(
        report,
        "%s can fall onto others or walls with %.2g times the energy that takes a contact as deep as its "
        "radius, and may pass through them: contacts of \"%s\" are too soft for it; raise its youngs_modulus (in Pa) "
        "or normal_stiffness",
        scree_describe_body(s, worst_particle).text, worst,
        s->scene->materials[s->particles.material[worst_particle]].name);
}

scree_status scree_check_start(const scree_simulation *simulation, scree_report *report)
{
    int64_t num_faults;
    scree_status status = scree_check_overlaps(simulation, report, &num_faults);
    if (status == SCREE_OK) num_faults += check_outside(simulation, report, &status);
    if (status != SCREE_OK) return status;
    if (num_faults == 0) warn_of_soft_contacts(simulation, report);
    return num_faults > 0 ? SCREE_INVALID_INPUT : SCREE_OK;
}
