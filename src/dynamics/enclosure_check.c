/// \file enclosure_check.c
/// Vessels that several walls close together: a shell and its end plates, a box of planes.
///
/// Space is cut into cubic cells of half the radius of the smallest particle. Those that a wall's surface comes into or
/// touches, within their circumscribed spheres, are closed, and from outside of all walls the others are flooded
/// through their faces. What the flood does not reach is enclosed: a hole through which the smallest particle fits is
/// wider than the closed cells at its rim, so the flood finds it. Only walls count that stay: none that is removed,
/// moved away or said to open. Where there would be too many cells nothing is said.
#include "contact/closest_point_kernel.h"
#include "dynamics/start_check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Cells that are worth their memory, a byte each.
#define MAX_CELLS ((int64_t)1 << 26)

typedef enum cell_mark
{
    CELL_NEW,
    CELL_CLOSED,
    CELL_OUTSIDE
} cell_mark;

/// Cell (x, y, z) is marks[(z num[1] + y) num[0] + x]; the outermost layers are free.
typedef struct cell_grid
{
    double origin[3], size; ///< [m]
    int64_t num[3];
    uint8_t *marks;
} cell_grid;

bool scree_wall_stays(const scree_simulation *s, int32_t w)
{
    const scree_wall_def *def = s->scene->walls + w;
    return s->walls[w].is_present && !(def->removed_at < INFINITY) && !def->motion.opens &&
           def->motion.kind != SCREE_MOTION_TRANSLATE;
}

static scree_triangle_place triangle_in_world(const scree_shape_view *shape, int32_t t, scree_pose pose)
{
    const scree_mat3 rotation = scree_mat3_from_quat(pose.orientation);
    scree_triangle_place place = scree_place_of_triangle(shape, t);
    place.a = scree_vec3_add(pose.position, scree_mat3_apply(rotation, place.a));
    place.b = scree_vec3_add(pose.position, scree_mat3_apply(rotation, place.b));
    place.c = scree_vec3_add(pose.position, scree_mat3_apply(rotation, place.c));
    place.normal = scree_mat3_apply(rotation, place.normal);
    return place;
}

static scree_box box_of_triangle(scree_triangle_place place)
{
    return scree_box_with_point(scree_box_with_point(scree_box_with_point(scree_box_empty(), place.a), place.b),
                                place.c);
}

/// Half the least extent of any particle.
static double smallest_radius(const scree_simulation *s)
{
    double least = INFINITY;
    for (int64_t i = 0; i < s->particles.num_particles; ++i)
    {
        const scree_box box = s->particle_shapes[s->particles.shape[i]].view.box;
        const scree_vec3 e = scree_vec3_sub(box.upper, box.lower);
        least = fmin(least, 0.5 * (double)s->particles.scale[i] * (double)scree_min(e.x, scree_min(e.y, e.z)));
    }
    return least;
}

/// The grid around the walls that stay. False: too many cells, or nothing to look at.
static bool place_grid(const scree_simulation *s, cell_grid *grid)
{
    scree_box box = scree_box_empty();
    int32_t num_walls = 0;
    for (int32_t w = 0; w < s->num_walls; ++w)
    {
        if (!scree_wall_stays(s, w)) continue;
        const scree_shape_view *shape = s->shape_views + s->num_shapes + s->walls[w].shape;
        for (int32_t t = 0; t < shape->num_triangles; ++t)
            box = scree_box_union(box, box_of_triangle(triangle_in_world(shape, t, s->walls[w].pose)));
        ++num_walls;
    }
    grid->size = 0.5 * smallest_radius(s);
    if (num_walls < 2 || !(grid->size > 0) || !(grid->size < INFINITY)) return false;
    const double lower[3] = {(double)box.lower.x, (double)box.lower.y, (double)box.lower.z};
    const double upper[3] = {(double)box.upper.x, (double)box.upper.y, (double)box.upper.z};
    double num_cells = 1;
    for (int k = 0; k < 3; ++k)
    {
        // two layers that no wall closes
        const double num = ceil((upper[k] - lower[k]) / grid->size) + 6;
        num_cells *= num;
        if (!(num_cells <= (double)MAX_CELLS)) return false;
        grid->num[k] = (int64_t)num;
        grid->origin[k] = lower[k] - 3 * grid->size;
    }
    return true;
}

/// Closes the cells of the cube of `width` cells at `first` that the triangle comes near, by halves.
static void close_cells(const cell_grid *grid, scree_triangle_place place, const int64_t first[3], int64_t width)
{
    double c[3];
    for (int k = 0; k < 3; ++k)
    {
        if (first[k] >= grid->num[k]) return;
        c[k] = grid->origin[k] + grid->size * ((double)first[k] + 0.5 * (double)width);
    }
    const scree_vec3 centre = scree_vec3_make((scree_real)c[0], (scree_real)c[1], (scree_real)c[2]);
    const double radius = 0.5001 * sqrt(3.0) * grid->size * (double)width;
    if ((double)scree_closest_part(place, centre).squared > radius * radius) return;
    if (width == 1)
    {
        grid->marks[(first[2] * grid->num[1] + first[1]) * grid->num[0] + first[0]] = CELL_CLOSED;
        return;
    }
    for (int k = 0; k < 8; ++k)
    {
        const int64_t half = width / 2;
        const int64_t part[3] = {first[0] + (k & 1) * half, first[1] + (k >> 1 & 1) * half, first[2] + (k >> 2) * half};
        close_cells(grid, place, part, half);
    }
}

static void close_walls(const scree_simulation *s, const cell_grid *grid)
{
    for (int32_t w = 0; w < s->num_walls; ++w)
    {
        if (!scree_wall_stays(s, w)) continue;
        const scree_shape_view *shape = s->shape_views + s->num_shapes + s->walls[w].shape;
        for (int32_t t = 0; t < shape->num_triangles; ++t)
        {
            const scree_triangle_place place = triangle_in_world(shape, t, s->walls[w].pose);
            const scree_box box = box_of_triangle(place);
            const double lower[3] = {(double)box.lower.x, (double)box.lower.y, (double)box.lower.z};
            const double upper[3] = {(double)box.upper.x, (double)box.upper.y, (double)box.upper.z};
            int64_t first[3], width = 1;
            for (int k = 0; k < 3; ++k)
            {
                first[k] = (int64_t)((lower[k] - grid->origin[k]) / grid->size) - 1;
                while ((double)width * grid->size < upper[k] - lower[k] + 4 * grid->size) width *= 2;
            }
            close_cells(grid, place, first, width);
        }
    }
}

/// Rows of cells that are still to be gone along.
typedef struct row_stack
{
    int64_t *cells;
    int64_t num, max;
} row_stack;

static bool push(row_stack *stack, int64_t cell)
{
    if (stack->num == stack->max)
    {
        const int64_t max = 2 * stack->max + 1024;
        int64_t *cells = realloc(stack->cells, (size_t)max * sizeof *cells);
        if (cells == NULL) return false;
        stack->cells = cells;
        stack->max = max;
    }
    stack->cells[stack->num++] = cell;
    return true;
}

/// Where a stretch of new cells begins in the row beside cells begin .. end - 1.
static bool push_beside(row_stack *stack, const uint8_t *marks, int64_t begin, int64_t end, int64_t step)
{
    bool is_complete = true;
    for (int64_t c = begin + step; c < end + step && is_complete; ++c)
        if (marks[c] == CELL_NEW && (c == begin + step || marks[c - 1] != CELL_NEW)) is_complete = push(stack, c);
    return is_complete;
}

/// Floods the grid from its first cell, row by row. False: out of memory.
static bool flood(const cell_grid *grid)
{
    const int64_t row = grid->num[0], layer = row * grid->num[1], num = layer * grid->num[2];
    uint8_t *marks = grid->marks;
    row_stack stack = {0};
    bool is_complete = push(&stack, 0);
    while (stack.num > 0 && is_complete)
    {
        const int64_t cell = stack.cells[--stack.num], row_begin = cell - cell % row;
        if (marks[cell] != CELL_NEW) continue;
        int64_t begin = cell, end = cell;
        while (begin > row_begin && marks[begin - 1] == CELL_NEW) --begin;
        while (end < row_begin + row && marks[end] == CELL_NEW) marks[end++] = CELL_OUTSIDE;
        memset(marks + begin, CELL_OUTSIDE, (size_t)(cell - begin));
        const int64_t y = cell % layer / row;
        if (y > 0) is_complete &= push_beside(&stack, marks, begin, end, -row);
        if (y + 1 < grid->num[1]) is_complete &= push_beside(&stack, marks, begin, end, row);
        if (cell >= layer) is_complete &= push_beside(&stack, marks, begin, end, -layer);
        if (cell + layer < num) is_complete &= push_beside(&stack, marks, begin, end, layer);
    }
    free(stack.cells);
    return is_complete;
}

/// Mark of the cell that holds a point.
static cell_mark mark_at(const cell_grid *grid, scree_vec3 point)
{
    const double x[3] = {(double)point.x, (double)point.y, (double)point.z};
    int64_t at[3];
    for (int k = 0; k < 3; ++k)
    {
        const double place = (x[k] - grid->origin[k]) / grid->size;
        if (!(place >= 0 && place < (double)grid->num[k])) return CELL_OUTSIDE;
        at[k] = (int64_t)place;
    }
    return (cell_mark)grid->marks[(at[2] * grid->num[1] + at[1]) * grid->num[0] + at[0]];
}

scree_status scree_find_outside_of_walls(const scree_simulation *s, int64_t *num_inside, bool *is_outside)
{
    const int64_t num_particles = s->particles.num_particles;
    cell_grid grid;
    *num_inside = 0;
    if (!place_grid(s, &grid)) return SCREE_OK;
    grid.marks = calloc((size_t)(grid.num[0] * grid.num[1] * grid.num[2]), 1);
    if (grid.marks == NULL) return SCREE_OUT_OF_MEMORY;
    close_walls(s, &grid);
    const bool is_complete = flood(&grid);
    for (int64_t i = 0; i < num_particles && is_complete; ++i)
    {
        const cell_mark mark = mark_at(&grid, s->particles.position[i]);
        is_outside[i] = mark == CELL_OUTSIDE;
        *num_inside += mark == CELL_NEW;
    }
    free(grid.marks);
    return is_complete ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}
