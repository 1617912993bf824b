/// \file repose.c
/// Angle of repose (Bilock 2020, 6.3): the largest height of a vertex above the plate in each bin along x, fitted with
/// the sigmoid h(x) = c/(1 + exp(a (x - b))); the angle is that of its steepest slope, |a| c/4.
#include "dynamics/step_buffers.h"

#include <math.h>

/// Heights per bin; bins without particles get 0. Returns the number of bins that hold some.
static int64_t measure_heights(const scree_simulation *s, scree_repose *repose)
{
    const scree_repose_def *def = &s->scene->repose;
    const double width = (def->to - def->from) / (double)def->bins;
    int64_t num_filled = 0;
    repose->num_bins = def->bins;
    for (int64_t k = 0; k < def->bins; ++k)
    {
        repose->bin_x[k] = def->from + ((double)k + 0.5) * width;
        repose->bin_height[k] = 0;
    }
    for (int64_t i = 0; i < s->particles.num_particles; ++i)
    {
        const scree_shape_view *shape = s->shape_views + s->particles.shape[i];
        const scree_mat3 rotation = scree_mat3_from_quat(s->particles.orientation[i]);
        for (int32_t v = 0; v < shape->num_vertices; ++v)
        {
            const scree_vec3 x = scree_vec3_add_scaled(
                s->particles.position[i], scree_mat3_apply(rotation, shape->vertices[v]), s->particles.scale[i]);
            const double bin = floor(((double)x.x - def->from) / width);
            if (!(bin >= 0 && bin < (double)def->bins)) continue;
            double *height = repose->bin_height + (int64_t)bin;
            *height = fmax(*height, (double)x.z - def->base);
        }
    }
    for (int64_t k = 0; k < def->bins; ++k) num_filled += repose->bin_height[k] > 0;
    return num_filled;
}

/// For given a and b the best c is linear; returns the sum of squares with it.
static double fit_height(scree_repose *repose, double steepness, double middle)
{
    double sum_gh = 0, sum_gg = 0, sum = 0;
    for (int64_t k = 0; k < repose->num_bins; ++k)
    {
        const double g = 1 / (1 + exp(steepness * (repose->bin_x[k] - middle)));
        sum_gh += g * repose->bin_height[k];
        sum_gg += g * g;
    }
    const double height = sum_gg > 0 ? sum_gh / sum_gg : 0;
    for (int64_t k = 0; k < repose->num_bins; ++k)
    {
        const double g = 1 / (1 + exp(steepness * (repose->bin_x[k] - middle)));
        const double error = height * g - repose->bin_height[k];
        sum += error * error;
    }
    repose->height = height;
    repose->steepness = steepness;
    repose->middle = middle;
    return sum;
}

/// Best fit over a grid of (a, b), halved around its best point until it no longer moves: no start value to guess.
static double fit_sigmoid(scree_repose *repose, double from, double to)
{
    const double length = to - from;
    double steepness = 0, middle = 0.5 * (from + to), best = fit_height(repose, 0, middle);
    double range_a = 80 / length, range_b = length;
    for (int round = 0; round < 60; ++round)
    {
        const double centre_a = steepness, centre_b = middle;
        for (int p = -8; p <= 8; ++p)
            for (int q = -8; q <= 8; ++q)
            {
                const double a = centre_a + range_a * p / 8, b = centre_b + range_b * q / 8;
                const double sum = fit_height(repose, a, b);
                if (!(sum < best)) continue;
                best = sum;
                steepness = a;
                middle = b;
            }
        range_a *= 0.6;
        range_b *= 0.6;
    }
    return fit_height(repose, steepness, middle);
}

scree_status scree_simulation_repose(const scree_simulation *simulation, scree_repose *repose)
{
    const scree_repose_def *def = &simulation->scene->repose;
    *repose = (scree_repose){0};
    if (!def->measure || def->bins < 4 || def->bins > 256 || !(def->to > def->from)) return SCREE_INVALID_INPUT;
    if (measure_heights(simulation, repose) < 4) return SCREE_INVALID_INPUT;
    const double sum = fit_sigmoid(repose, def->from, def->to);
    repose->residual = sqrt(sum / (double)repose->num_bins);
    repose->angle_degrees = atan(fabs(repose->steepness) * repose->height / 4) * 180 / 3.14159265358979323846;
    return SCREE_OK;
}
