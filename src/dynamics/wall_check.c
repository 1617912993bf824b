/// \file wall_check.c
/// Walls that would be torn apart: two that reach into each other at the start belong together, and if both move, they
/// must move as one. A wall that stands still may be moved in or along: a piston in its cylinder, a drum between
/// plates. Where two that touch at the start part later, a door or a lid is opened, or a mistake made: that is told,
/// unless the scene says that it opens.
#include "contact/mesh_gap_kernel.h"
#include "contact/overlap.h"
#include "dynamics/start_check.h"
#include "dynamics/walls.h"

#include <math.h>

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

static bool is_same_motion(const scree_motion_def *a, const scree_motion_def *b)
{
    if (a->kind != b->kind || a->start != b->start || a->end != b->end) return false;
    if (a->kind == SCREE_MOTION_TRANSLATE)
    {
        const double d[3] = {a->velocity[0] - b->velocity[0], a->velocity[1] - b->velocity[1],
                             a->velocity[2] - b->velocity[2]};
        return is_nothing(d, length(a->velocity));
    }
    // the same axis of rotation, in either sense, turned by the same rate
    const double length_a = length(a->axis), length_b = length(b->axis);
    double difference[3], offset[3], across[3];
    for (int k = 0; k < 3; ++k)
    {
        difference[k] = a->angular_velocity * a->axis[k] / length_a - b->angular_velocity * b->axis[k] / length_b;
        offset[k] = b->centre[k] - a->centre[k];
    }
    cross(offset, a->axis, across);
    return is_nothing(difference, fabs(a->angular_velocity)) &&
           length(across) <= SAME_TOLERANCE * length_a * (length(a->centre) + length(b->centre) + length(offset));
}

/// Do both move while both are there?
static bool are_both_moving(const scree_wall_def *a, const scree_wall_def *b)
{
    if (a->motion.kind == SCREE_MOTION_FIXED || b->motion.kind == SCREE_MOTION_FIXED) return false;
    return fmin(a->removed_at, b->removed_at) > fmin(a->motion.start, b->motion.start);
}

/// Does one move that is not said to open, while both are there, and do they not move as one?
static bool are_moved_apart(const scree_wall_def *a, const scree_wall_def *b)
{
    const scree_motion_def *x = &a->motion, *y = &b->motion;
    const double first =
        fmin(x->kind != SCREE_MOTION_FIXED ? x->start : INFINITY, y->kind != SCREE_MOTION_FIXED ? y->start : INFINITY);
    if (x->opens || y->opens || !(first < fmin(a->removed_at, b->removed_at))) return false;
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

/// Refuses or warns of two walls that do not move as one. SCREE_INVALID_INPUT, SCREE_OUT_OF_MEMORY.
static scree_status check_pair(const wall_pair *pair, scree_report *report)
{
    const scree_wall_def *a = pair->s->scene->walls + pair->wall[0], *b = pair->s->scene->walls + pair->wall[1];
    nearness found;
    double time = INFINITY;
    scree_status status = find_nearness(pair, 0, &found);
    if (status != SCREE_OK || found == APART) return status;
    if (found == REACHING && are_both_moving(a, b))
    {
        scree_report_add(
            report,
            "walls \"%s\" and \"%s\" reach into each other, but move differently and so would be torn apart; give both "
            "the same motion (kind, rate, axis, centre, start and end), leave a gap between them, or set opens of a "
            "motion that is meant to open them",
            a->name, b->name);
        return SCREE_INVALID_INPUT;
    }
    status = find_parting(pair, &time);
    if (time < INFINITY)
        scree_report_warn(report,
                          "walls \"%s\" and \"%s\" %s at the start and part at %.3g s; if one is meant to open, as "
                          "a door or a lid, set opens of its motion to true, or else give both the same motion",
                          a->name, b->name, found == REACHING ? "reach into each other" : "touch", time);
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
            if (!are_moved_apart(walls + v, walls + w)) continue;
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
