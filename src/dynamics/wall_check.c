/// \file wall_check.c
/// Walls that would be torn apart: two that reach into each other at the start belong together, and if both move, they
/// must move as one. A wall that stands still may be moved in: a piston in its cylinder, a door in its frame.
#include "contact/overlap.h"
#include "dynamics/start_check.h"

#include <math.h>

/// Share of the size below which a common volume is rounding: of sides that lie flush.
#define REACH_TOLERANCE 1e-9

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

/// Do the solids of two walls have a part in common? SCREE_OUT_OF_MEMORY.
static scree_status reach_into_each_other(const scree_simulation *s, int32_t v, int32_t w, bool *do_reach)
{
    const scree_wall_state *a = s->walls + v, *b = s->walls + w;
    const scree_shape_view *shape_a = s->shape_views + s->num_shapes + a->shape;
    const scree_shape_view *shape_b = s->shape_views + s->num_shapes + b->shape;
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    if (workspace == NULL) return SCREE_OUT_OF_MEMORY;
    scree_status status = SCREE_OK;
    scree_overlap_result result;
    do {
        scree_overlap_compute(shape_a, &a->pose, shape_b, &b->pose, &s->narrow_phase.options, workspace, &result, 1);
        if (result.status == SCREE_OVERLAP_WORKSPACE_FULL) status = scree_overlap_workspace_grow(workspace);
    } while (result.status == SCREE_OVERLAP_WORKSPACE_FULL && status == SCREE_OK);
    scree_overlap_workspace_destroy(workspace);
    const double size = (double)scree_min(shape_a->bounding_radius, shape_b->bounding_radius);
    *do_reach = result.status != SCREE_OVERLAP_NONE && (double)result.volume > REACH_TOLERANCE * size * size * size;
    return status;
}

scree_status scree_check_walls(const scree_simulation *simulation, scree_report *report)
{
    const scree_wall_def *walls = simulation->scene->walls;
    scree_status worst = SCREE_OK;
    for (int32_t w = 1; w < simulation->num_walls; ++w)
        for (int32_t v = 0; v < w; ++v)
        {
            if (!are_both_moving(walls + v, walls + w) || is_same_motion(&walls[v].motion, &walls[w].motion)) continue;
            bool do_reach = false;
            const scree_status status = reach_into_each_other(simulation, v, w, &do_reach);
            if (status != SCREE_OK) return status;
            if (!do_reach) continue;
            scree_report_add(
                report,
                "walls \"%s\" and \"%s\" reach into each other, but move differently and so would be torn "
                "apart; give both the same motion (kind, rate, axis, centre, start and end), or leave a gap "
                "between them",
                walls[v].name, walls[w].name);
            worst = SCREE_INVALID_INPUT;
        }
    return worst;
}
