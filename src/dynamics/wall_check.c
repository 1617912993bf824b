/// \file wall_check.c
/// Walls that would be torn apart: two that reach into each other at the start belong together and must move as one, be
/// one of them at rest or not, unless the scene says that they may part or slide along each other, or nothing opens
/// by that: a shaft turns in an end plate, a drum and its lifters between plates, a piston slides in its cylinder.
/// Where two that touch at the start part later, a door or a lid is opened, or a mistake made: that is told, unless the
/// scene says that it opens.
#include "contact/mesh_gap_kernel.h"
#include "contact/overlap.h"
#include "dynamics/start_check.h"
#include "dynamics/walls.h"

#include <math.h>

enum
{
    NUM_POINTS = 16384, ///< spread over the box that two walls have in common
    NUM_MOVES = 7       ///< places that they are moved to
};

/// [rad] not a share of a whole turn, so that no even division of a wheel turns into itself.
#define TURN 0.897

/// Share of the distance from the axis by which the flat sides of a round wall may miss the circle.
#define ROUND_TOLERANCE 0.05

/// Cosine, or one less the cosine, of the angle between a surface's normal and a direction that it lies in, or faces.
#define EVEN_TOLERANCE 0.1

/// Share of the size below which a common volume is rounding: of sides that lie flush.
#define REACH_TOLERANCE 1e-9

/// Share of the size below which walls touch.
#define TOUCH_TOLERANCE 1e-5

/// Lengths and directions that differ by less than this share are the same.
#define SAME_TOLERANCE 1e-9

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int k = 0; k < 3; ++k) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double length(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/// Is `v` zero beside numbers of size `scale`?
static bool is_nothing(const double v[3], double scale) { return length(v) <= SAME_TOLERANCE * scale; }

/// The same axis of rotation, in either sense.
static bool is_same_axis(const scree_motion_def *a, const scree_motion_def *b)
{
    double offset[3], across[3], apart[3];
    for (int k = 0; k < 3; ++k) offset[k] = b->centre[k] - a->centre[k];
    cross(a->axis, b->axis, apart);
    cross(offset, a->axis, across);
    return is_nothing(apart, length(a->axis) * length(b->axis)) &&
           is_nothing(across, length(a->axis) * (length(a->centre) + length(b->centre) + length(offset)));
}

static bool is_same_motion(const scree_motion_def *a, const scree_motion_def *b)
{
    if (a->kind != b->kind || a->start != b->start || a->end != b->end) return false;
    if (a->kind == SCREE_MOTION_TRANSLATE)
    {
        const double d[3] = {a->velocity[0] - b->velocity[0], a->velocity[1] - b->velocity[1],
                             a->velocity[2] - b->velocity[2]};
        return is_nothing(d, length(a->velocity));
    }
    const double length_a = length(a->axis), length_b = length(b->axis);
    double difference[3];
    for (int k = 0; k < 3; ++k)
        difference[k] = a->angular_velocity * a->axis[k] / length_a - b->angular_velocity * b->axis[k] / length_b;
    return is_nothing(difference, fabs(a->angular_velocity)) && is_same_axis(a, b);
}

/// Does one move that is not said to open, while both are there and before the end, and do they not move as one?
static bool are_moved_apart(const scree_wall_def *a, const scree_wall_def *b, double end)
{
    const scree_motion_def *x = &a->motion, *y = &b->motion;
    const double first =
        fmin(x->kind != SCREE_MOTION_FIXED ? x->start : INFINITY, y->kind != SCREE_MOTION_FIXED ? y->start : INFINITY);
    if (x->opens || y->opens || !(first < fmin(end, fmin(a->removed_at, b->removed_at)))) return false;
    return !(x->kind == SCREE_MOTION_FIXED && y->kind == SCREE_MOTION_FIXED) && !is_same_motion(x, y);
}

/// Two walls, in the order of the scene.
typedef struct wall_pair
{
    const scree_simulation *s;
    int32_t wall[2];
    const scree_shape_view *shape[2];
    scree_overlap_workspace *workspace;
    double size; ///< [m] bounding radius of the smaller one
} wall_pair;

typedef enum nearness
{
    APART,
    TOUCHING,
    REACHING ///< into each other
} nearness;

/// How near the walls are to each other at a time. SCREE_OUT_OF_MEMORY.
static scree_status find_nearness(const wall_pair *pair, double time, nearness *found)
{
    scree_wall_state state[2];
    for (int k = 0; k < 2; ++k) scree_wall_state_at(pair->s->scene->walls + pair->wall[k], time, state + k);
    scree_status status = SCREE_OK;
    scree_overlap_result result;
    do {
        scree_overlap_compute(pair->shape[0], &state[0].pose, pair->shape[1], &state[1].pose,
                              &pair->s->narrow_phase.options, pair->workspace, &result, 1);
        if (result.status == SCREE_OVERLAP_WORKSPACE_FULL) status = scree_overlap_workspace_grow(pair->workspace);
    } while (result.status == SCREE_OVERLAP_WORKSPACE_FULL && status == SCREE_OK);
    const double size = pair->size, most = TOUCH_TOLERANCE * size;
    *found = REACHING;
    if (result.status != SCREE_OVERLAP_NONE && (double)result.volume > REACH_TOLERANCE * size * size * size)
        return status;
    const int large = pair->shape[0]->num_triangles >= pair->shape[1]->num_triangles ? 0 : 1;
    const double gap = (double)scree_mesh_gap(pair->shape[large], &state[large].pose, pair->shape[1 - large],
                                              &state[1 - large].pose, (scree_real)most);
    *found = gap > most ? APART : TOUCHING;
    return status;
}

/// [s] when two walls that touch at the start part; INFINITY: not while both are there. Looked for at many times, then
/// by halves. SCREE_OUT_OF_MEMORY.
static scree_status find_parting(const wall_pair *pair, double *time)
{
    const scree_wall_def *a = pair->s->scene->walls + pair->wall[0], *b = pair->s->scene->walls + pair->wall[1];
    double first = INFINITY, last = 0;
    for (int k = 0; k < 2; ++k)
    {
        const scree_motion_def *motion = k == 0 ? &a->motion : &b->motion;
        if (motion->kind == SCREE_MOTION_FIXED) continue;
        first = fmin(first, motion->start);
        last = fmax(last, motion->end);
    }
    last = fmin(fmin(last, pair->s->scene->time.end), fmin(a->removed_at, b->removed_at));
    *time = INFINITY;
    if (!(first < last)) return SCREE_OK;
    // walls of very many triangles take long
    const int most = 20000000 / (pair->shape[0]->num_triangles + 1);
    const int num = most < 16 ? 16 : most > 251 ? 251 : most;
    nearness found = TOUCHING;
    double together = first, parted = first;
    scree_status status = SCREE_OK;
    for (int k = 1; k <= num && found != APART && status == SCREE_OK; ++k)
    {
        together = parted;
        parted = first + (last - first) * k / num;
        status = find_nearness(pair, parted, &found);
    }
    if (found != APART || status != SCREE_OK) return status;
    for (int k = 0; k < 20 && status == SCREE_OK; ++k)
    {
        const double middle = 0.5 * (together + parted);
        status = find_nearness(pair, middle, &found);
        *(found == APART ? &parted : &together) = middle;
    }
    *time = parted;
    return status;
}

/// How wall 0 of a pair moves against wall 1.
typedef struct relative_motion
{
    bool is_turning;
    double direction[3]; ///< unit: of the axis, or of the way
    double centre[3];    ///< [m] a point of the axis
    double way;          ///< [m]
} relative_motion;

/// Two walls of which one rests, or that turn about one axis: otherwise false.
static bool find_relative_motion(const wall_pair *pair, relative_motion *found)
{
    const scree_wall_def *a = pair->s->scene->walls + pair->wall[0], *b = pair->s->scene->walls + pair->wall[1];
    const bool is_first = a->motion.kind != SCREE_MOTION_FIXED;
    const scree_motion_def *motion = is_first ? &a->motion : &b->motion;
    const bool is_other_moving = is_first && b->motion.kind != SCREE_MOTION_FIXED;
    found->is_turning = motion->kind == SCREE_MOTION_ROTATE;
    if (is_other_moving &&
        (!found->is_turning || b->motion.kind != SCREE_MOTION_ROTATE || !is_same_axis(&a->motion, &b->motion)))
        return false;
    const double *along = found->is_turning ? motion->axis : motion->velocity;
    const double last = fmin(fmin(pair->s->scene->time.end, motion->end), fmin(a->removed_at, b->removed_at));
    found->way = (is_first ? 1 : -1) * (last - motion->start) * length(along);
    for (int k = 0; k < 3; ++k)
    {
        found->direction[k] = along[k] / length(along);
        found->centre[k] = motion->centre[k];
    }
    return true;
}

/// Where a point of the other wall comes to in wall k, in step 1 to NUM_MOVES; `margin`: how far outside it counts.
static scree_vec3 moved_point(const relative_motion *motion, int k, scree_vec3 point, int step, double *margin)
{
    const double *axis = motion->direction, *centre = motion->centre;
    const double from[3] = {(double)point.x - centre[0], (double)point.y - centre[1], (double)point.z - centre[2]};
    const double along = from[0] * axis[0] + from[1] * axis[1] + from[2] * axis[2];
    const double shift = (k == 0 ? -1 : 1) * motion->way * step / NUM_MOVES;
    const double c = cos(TURN * step), s = sin(TURN * step);
    double radius[3], side[3], moved[3];
    for (int m = 0; m < 3; ++m) radius[m] = from[m] - along * axis[m];
    cross(axis, radius, side);
    *margin = motion->is_turning ? ROUND_TOLERANCE * length(radius) : 0;
    for (int m = 0; m < 3; ++m)
        moved[m] = motion->is_turning ? centre[m] + along * axis[m] + c * radius[m] + s * side[m]
                                      : centre[m] + from[m] + shift * axis[m];
    return scree_vec3_make((scree_real)moved[0], (scree_real)moved[1], (scree_real)moved[2]);
}

static scree_box box_of_wall(const wall_pair *pair, int k)
{
    const scree_pose pose = pair->s->walls[pair->wall[k]].pose;
    const scree_mat3 rotation = scree_mat3_from_quat(pose.orientation);
    scree_box box = scree_box_empty();
    for (int32_t v = 0; v < pair->shape[k]->num_vertices; ++v)
        box = scree_box_with_point(
            box, scree_vec3_add(pose.position, scree_mat3_apply(rotation, pair->shape[k]->vertices[v])));
    return box;
}

/// What a wall is to the other that moves in it, as far as points tell that are in both.
typedef struct bearing
{
    bool holds;   ///< moved with the other they stay in the wall
    bool is_even; ///< the surface nearest to them faces along the axis, as that of an end plate, or across the way
} bearing;

/// Takes a point into account.
static void look_at_bearing(const wall_pair *pair, int k, const relative_motion *motion, scree_vec3 point,
                            bearing *found)
{
    const int64_t body = pair->s->particles.num_particles + pair->wall[k];
    const double *d = motion->direction;
    scree_vec3 normal;
    scree_depth_in_mesh(pair->s, body, point, 0, &normal);
    const double facing = fabs((double)normal.x * d[0] + (double)normal.y * d[1] + (double)normal.z * d[2]);
    found->is_even = found->is_even && (motion->is_turning ? facing > 1 - EVEN_TOLERANCE : facing < EVEN_TOLERANCE);
    for (int step = 1; step <= NUM_MOVES && found->holds; ++step)
    {
        double margin;
        const scree_vec3 moved = moved_point(motion, k, point, step, &margin);
        found->holds = scree_depth_in_mesh(pair->s, body, moved, margin, NULL) > -margin;
    }
}

/// Does nothing open, because one wall bears the other: a plate across the axis, on which anything may turn, a face
/// along the way, on which anything may slide, or because both are round where they meet, as a shaft in its plate?
/// Looked at in points.
static bool does_stay_closed(const wall_pair *pair)
{
    relative_motion motion;
    if (!find_relative_motion(pair, &motion)) return false;
    const scree_box a = box_of_wall(pair, 0), b = box_of_wall(pair, 1);
    const scree_vec3 lower = scree_vec3_max(a.lower, b.lower);
    const scree_vec3 side = scree_vec3_sub(scree_vec3_min(a.upper, b.upper), lower);
    const int64_t first = pair->s->particles.num_particles;
    bearing found[2] = {{true, true}, {true, true}};
    int num = 0;
    for (int n = 1; n <= NUM_POINTS; ++n)
    {
        // evenly, and on no lattice: multiples of powers of the root of x^4 = x + 1
        const double at[3] = {fmod(n * 0.8191725133961644, 1), fmod(n * 0.6710436067037893, 1),
                              fmod(n * 0.5497004779019703, 1)};
        const scree_vec3 point = scree_vec3_add(
            lower, scree_vec3_make((scree_real)at[0] * side.x, (scree_real)at[1] * side.y, (scree_real)at[2] * side.z));
        if (!(scree_depth_in_mesh(pair->s, first + pair->wall[0], point, 0, NULL) > 0) ||
            !(scree_depth_in_mesh(pair->s, first + pair->wall[1], point, 0, NULL) > 0))
            continue;
        for (int k = 0; k < 2; ++k) look_at_bearing(pair, k, &motion, point, found + k);
        ++num;
    }
    const bool is_borne = (found[0].holds && found[0].is_even) || (found[1].holds && found[1].is_even);
    return num > 0 && (is_borne || (motion.is_turning && found[0].holds && found[1].holds));
}

/// Refuses or warns of two walls that do not move as one. SCREE_INVALID_INPUT, SCREE_OUT_OF_MEMORY.
static scree_status check_pair(const wall_pair *pair, scree_report *report)
{
    const scree_wall_def *a = pair->s->scene->walls + pair->wall[0], *b = pair->s->scene->walls + pair->wall[1];
    nearness found;
    double time = INFINITY;
    scree_status status = find_nearness(pair, 0, &found);
    if (status != SCREE_OK || found == APART || (found == REACHING && does_stay_closed(pair))) return status;
    if (found == REACHING)
    {
        scree_report_add(
            report,
            "walls \"%s\" and \"%s\" reach into each other, but move differently and so would be torn apart; give both "
            "the same motion (kind, rate, axis, centre, start and end), leave a gap between them, or set opens of a "
            "motion that is meant to part them, as a door, or to slide through",
            a->name, b->name);
        return SCREE_INVALID_INPUT;
    }
    status = find_parting(pair, &time);
    if (time < INFINITY)
        scree_report_warn(report,
                          "walls \"%s\" and \"%s\" touch at the start and part at %.3g s; if one is meant to open, as "
                          "a door or a lid, set opens of its motion to true, or else give both the same motion",
                          a->name, b->name, time);
    return status;
}

scree_status scree_check_walls(const scree_simulation *simulation, scree_report *report)
{
    const scree_wall_def *walls = simulation->scene->walls;
    scree_status worst = SCREE_OK;
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    if (workspace == NULL) return SCREE_OUT_OF_MEMORY;
    for (int32_t w = 1; w < simulation->num_walls; ++w)
        for (int32_t v = 0; v < w && worst != SCREE_OUT_OF_MEMORY; ++v)
        {
            if (!are_moved_apart(walls + v, walls + w, simulation->scene->time.end)) continue;
            const scree_shape_view *views = simulation->shape_views + simulation->num_shapes;
            wall_pair pair = {simulation,
                              {v, w},
                              {views + simulation->walls[v].shape, views + simulation->walls[w].shape},
                              workspace,
                              0};
            pair.size = (double)scree_min(pair.shape[0]->bounding_radius, pair.shape[1]->bounding_radius);
            const scree_status status = check_pair(&pair, report);
            if (status != SCREE_OK) worst = status;
        }
    scree_overlap_workspace_destroy(workspace);
    return worst;
}
