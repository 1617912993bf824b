#include "dynamics/averages.h"
#include "dynamics/step_buffers.h"
#include "polyhedra/generate_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

/// The wall that the section names; -1 if it names none.
static int32_t find_wall(const scree_scene *scene)
{
    const char *name = scene->fields.wall;
    for (uint32_t w = 0; name != NULL && name[0] != '\0' && w < scene->num_walls; ++w)
        if (strcmp(scene->walls[w].name, name) == 0) return (int32_t)w;
    return -1;
}

/// Period and samples; false, with messages, if they do not fit.
static bool choose_times(scree_simulation *s, scree_report *report)
{
    const scree_fields_def *def = &s->scene->fields;
    scree_averages *averages = &s->averages;
    const int32_t wall = find_wall(s->scene);
    averages->from = def->from;
    averages->samples = def->samples;
    averages->period = wall >= 0 ? 2 * PI / fabs(s->scene->walls[wall].motion.angular_velocity) : def->period;
    if (!(averages->period > 0) || !isfinite(averages->period))
    {
        scree_report_add(report, "fields: no period, and no wall whose revolutions could give it; set fields.period");
        return false;
    }
    if (averages->period / (double)averages->samples >= s->time_step) return true;
    scree_report_add(report,
                     "fields: %lld samples in a period of %g s are closer than the time steps of %g s; set "
                     "fields.samples to %.0f or less",
                     (long long)averages->samples, averages->period, s->time_step,
                     floor(averages->period / s->time_step));
    return false;
}

/// Edges of the bins, each a constant factor above the last.
static scree_status make_bins(scree_averages *averages, const scree_fields_def *def)
{
    averages->num_bins = def->energy_bins;
    averages->bin_edges = calloc((size_t)def->energy_bins + 1, sizeof *averages->bin_edges);
    if (averages->bin_edges == NULL) return SCREE_OUT_OF_MEMORY;
    const double factor =
        def->energy_bins > 0 ? pow(def->energy_max / def->energy_min, 1.0 / (double)def->energy_bins) : 1;
    averages->bin_edges[0] = def->energy_min;
    for (int64_t k = 1; k <= def->energy_bins; ++k) averages->bin_edges[k] = averages->bin_edges[k - 1] * factor;
    return SCREE_OK;
}

static scree_status allocate(scree_simulation *s)
{
    scree_averages *averages = &s->averages;
    const int64_t num_cells = averages->num_cells[0] * averages->num_cells[1] * averages->num_cells[2];
    const int64_t num_rows = averages->num_bins > 0 ? 2 * (averages->num_bins + 2) : 0;
    averages->works.num_walls = s->num_walls;
    averages->works.start = calloc((size_t)s->num_walls + 1, sizeof *averages->works.start);
    averages->works.total = calloc((size_t)s->num_walls + 1, sizeof *averages->works.total);
    averages->cube_size = calloc((size_t)s->num_shapes + 1, sizeof *averages->cube_size);
    if (averages->works.start == NULL || averages->works.total == NULL || averages->cube_size == NULL)
        return SCREE_OUT_OF_MEMORY;
    for (int32_t k = 0; k < s->num_shapes; ++k)
        if (s->particle_shapes[k].properties.volume > 0)
            averages->cube_size[k] = scree_cube_root(s->particle_shapes[k].properties.volume);
    scree_status status = scree_grid_sums_create(&averages->grid, num_cells);
    if (status == SCREE_OK) status = scree_grid_sums_create(&averages->grid_total, num_cells);
    if (status == SCREE_OK) status = scree_spectrum_create(&averages->spectrum, num_rows);
    if (status == SCREE_OK) status = scree_spectrum_create(&averages->spectrum_total, num_rows);
    return status;
}

scree_status scree_averages_create(scree_simulation *simulation, scree_report *report)
{
    const scree_fields_def *def = &simulation->scene->fields;
    scree_averages *averages = &simulation->averages;
    if (!def->measure) return SCREE_OK;
    averages->is_on = true;
    if (!choose_times(simulation, report)) return SCREE_INVALID_INPUT;
    for (int k = 0; k < 3; ++k)
    {
        averages->num_cells[k] = (int64_t)def->cells[k];
        averages->cell_size[k] = (def->region.max[k] - def->region.min[k]) / def->cells[k];
    }
    scree_status status = make_bins(averages, def);
    if (status == SCREE_OK) status = allocate(simulation);
    return status;
}

void scree_averages_destroy(scree_averages *averages)
{
    scree_grid_sums_destroy(&averages->grid);
    scree_grid_sums_destroy(&averages->grid_total);
    scree_spectrum_destroy(&averages->spectrum);
    scree_spectrum_destroy(&averages->spectrum_total);
    free(averages->works.start);
    free(averages->works.total);
    scree_collisions_destroy(&averages->collisions);
    scree_destroy_collision_scratch(averages, NULL);
    free(averages->cube_size);
    free(averages->bin_edges);
    *averages = (scree_averages){0};
}

// ---- a period

static void clear_grid(scree_grid_sums *sums)
{
    const size_t size = (size_t)sums->num_cells * sizeof(double);
    memset(sums->volume, 0, size);
    memset(sums->mass, 0, size);
    memset(sums->momentum, 0, 3 * size);
    memset(sums->speed, 0, size);
    memset(sums->square, 0, size);
}

static void clear_spectrum(scree_spectrum *spectrum)
{
    const size_t num = (size_t)spectrum->num_rows;
    memset(spectrum->count_normal, 0, num * sizeof *spectrum->count_normal);
    memset(spectrum->count_tangential, 0, num * sizeof *spectrum->count_tangential);
    memset(spectrum->energy_normal, 0, num * sizeof *spectrum->energy_normal);
    memset(spectrum->energy_tangential, 0, num * sizeof *spectrum->energy_tangential);
}

static void note_works(scree_simulation *s)
{
    for (int64_t w = 0; w < s->averages.works.num_walls; ++w) s->averages.works.start[w] = s->wall_loads.work[w];
}

static void begin_period(scree_simulation *s)
{
    s->averages.num_samples = 0;
    clear_grid(&s->averages.grid);
    clear_spectrum(&s->averages.spectrum);
    note_works(s);
}

static void add(double *total, const double *part, int64_t num)
{
    for (int64_t k = 0; k < num; ++k) total[k] += part[k];
}

/// The period just ended to the total.
static void add_period(scree_simulation *s)
{
    scree_averages *averages = &s->averages;
    const scree_grid_sums *grid = &averages->grid;
    const scree_spectrum *spectrum = &averages->spectrum;
    add(averages->grid_total.volume, grid->volume, grid->num_cells);
    add(averages->grid_total.mass, grid->mass, grid->num_cells);
    add(averages->grid_total.momentum, grid->momentum, 3 * grid->num_cells);
    add(averages->grid_total.speed, grid->speed, grid->num_cells);
    add(averages->grid_total.square, grid->square, grid->num_cells);
    add(averages->spectrum_total.energy_normal, spectrum->energy_normal, spectrum->num_rows);
    add(averages->spectrum_total.energy_tangential, spectrum->energy_tangential, spectrum->num_rows);
    for (int64_t k = 0; k < spectrum->num_rows; ++k)
    {
        averages->spectrum_total.count_normal[k] += spectrum->count_normal[k];
        averages->spectrum_total.count_tangential[k] += spectrum->count_tangential[k];
    }
    for (int64_t w = 0; w < averages->works.num_walls; ++w)
        averages->works.total[w] += s->wall_loads.work[w] - averages->works.start[w];
    ++averages->num_periods;
}

/// How many instants of sampling there have been at `step`; they follow `from` at equal distances.
static int64_t num_due(const scree_averages *averages, double time_step, int64_t step)
{
    const double passed = (double)step * time_step - averages->from;
    if (passed <= 0) return 0;
    // a step that meets an instant up to rounding counts
    return (int64_t)floor(passed / (averages->period / (double)averages->samples) * (1 + 1e-12));
}

double scree_mean_power(const scree_simulation *simulation, int32_t wall)
{
    const scree_averages *averages = &simulation->averages;
    return averages->num_periods > 0 ? averages->works.total[wall] / ((double)averages->num_periods * averages->period)
                                     : (double)NAN;
}

double scree_mean_torque(const scree_simulation *simulation, int32_t wall)
{
    const scree_averages *averages = &simulation->averages;
    const scree_motion_def *motion = &simulation->scene->walls[wall].motion;
    if (motion->kind != SCREE_MOTION_ROTATE || averages->num_periods == 0) return (double)NAN;
    // the whole periods are the last ones
    const int64_t last = num_due(averages, simulation->time_step, simulation->step) / averages->samples;
    const double end = averages->from + (double)last * averages->period;
    const double begin = end - (double)averages->num_periods * averages->period;
    const double angle = motion->angular_velocity * (fmin(end, motion->end) - fmax(begin, motion->start));
    return angle * motion->angular_velocity > 0 ? averages->works.total[wall] / angle : (double)NAN;
}

scree_status scree_averages_restart(scree_simulation *simulation)
{
    scree_averages *averages = &simulation->averages;
    if (!averages->is_on) return SCREE_OK;
    begin_period(simulation);
    clear_grid(&averages->grid_total);
    clear_spectrum(&averages->spectrum_total);
    memset(averages->works.total, 0, (size_t)averages->works.num_walls * sizeof *averages->works.total);
    averages->num_periods = 0;
    return averages->num_bins > 0 ? scree_collisions_reserve(&averages->collisions, simulation->contacts.num_contacts)
                                  : SCREE_OK;
}

scree_status scree_update_averages(scree_simulation *simulation, scree_report *report)
{
    scree_averages *averages = &simulation->averages;
    if (!averages->is_on) return SCREE_OK;
    scree_status status = scree_update_collisions(simulation);
    if (status != SCREE_OK) return status;
    const int64_t due = num_due(averages, simulation->time_step, simulation->step);
    if ((double)simulation->step * simulation->time_step <= averages->from)
    {
        // nothing counts yet
        clear_spectrum(&averages->spectrum);
        note_works(simulation);
    }
    if (due == 0 || due == num_due(averages, simulation->time_step, simulation->step - 1)) return SCREE_OK;
    status = scree_simulation_observe(simulation, report);
    if (status != SCREE_OK) return status;
    scree_grid_add_sample(simulation, &averages->grid);
    ++averages->num_samples;
    if (due % averages->samples != 0) return SCREE_OK;
    // a period that was entered in its middle, after a restart with another section, does not count
    if (averages->num_samples == averages->samples) add_period(simulation);
    begin_period(simulation);
    return SCREE_OK;
}
