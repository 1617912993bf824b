/// \file repose.c
/// Angle of repose (Bilock 2020, 6.3): the largest height of a vertex, or of the top of a sphere, above the plate in
/// each bin along x, fitted with the sigmoid h(x) = c/(1 + exp(a (x - b))); the angle is that of its steepest slope,
/// |a| c/4, at x = b.
#include "dynamics/step_buffers.h"

#include <math.h>

/// Raises the height of the bin that x is in.
static void raise_bin(const scree_repose_def *def, scree_vec3 x, scree_repose *repose)
{
    const double bin = floor(((double)x.x - def->from) / ((def->to - def->from) / (double)def->bins));
    if (!(bin >= 0 && bin < (double)def->bins)) return;
    double *height = repose->bin_height + (int64_t)bin;
    *height = fmax(*height, (double)x.z - def->base);
}

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
        if ((double)s->particles.position[i].z > def->top) continue;
        const scree_shape_view *shape = s->shape_views + s->particles.shape[i];
        const scree_mat3 rotation = scree_mat3_from_quat(s->particles.orientation[i]);
        for (int32_t k = 0; k < shape->num_spheres; ++k)
        {
            const scree_sphere sphere = scree_shape_sphere(shape, k);
            const scree_vec3 top =
                scree_vec3_add(scree_mat3_apply(rotation, sphere.centre), scree_vec3_make(0, 0, sphere.radius));
            raise_bin(def, scree_vec3_add_scaled(s->particles.position[i], top, s->particles.scale[i]), repose);
        }
        for (int32_t v = 0; v < shape->num_vertices; ++v)
            raise_bin(def,
                      scree_vec3_add_scaled(s->particles.position[i], scree_mat3_apply(rotation, shape->vertices[v]),
                                            s->particles.scale[i]),
                      repose);
    }
    for (int64_t k = 0; k < def->bins; ++k) num_filled += repose->bin_height[k] > 0;
    return num_filled;
}

/// Parameters of the sigmoid: height c, steepness a, middle b.
enum
{
    HEIGHT,
    STEEPNESS,
    MIDDLE,
    NUM_PARAMETERS
};

/// Sum of squared errors; with `normal` also the normal equations J^T J and -J^T r as rows of four.
static double sum_squares(const scree_repose *repose, const double p[NUM_PARAMETERS], double normal[3][4])
{
    double sum = 0;
    if (normal != NULL)
        for (int k = 0; k < 12; ++k) normal[k / 4][k % 4] = 0;
    for (int64_t k = 0; k < repose->num_bins; ++k)
    {
        const double along = repose->bin_x[k] - p[MIDDLE];
        const double g = 1 / (1 + exp(p[STEEPNESS] * along)), slope = -p[HEIGHT] * g * (1 - g);
        const double jacobian[3] = {g, slope * along, -slope * p[STEEPNESS]};
        const double error = p[HEIGHT] * g - repose->bin_height[k];
        sum += error * error;
        for (int row = 0; normal != NULL && row < 3; ++row)
        {
            for (int column = 0; column < 3; ++column) normal[row][column] += jacobian[row] * jacobian[column];
            normal[row][3] -= jacobian[row] * error;
        }
    }
    return sum;
}

/// Solves three equations in rows of four by elimination with row exchange. False if they are singular.
static bool solve(double m[3][4], double x[3])
{
    for (int k = 0; k < 3; ++k)
    {
        int pivot = k;
        for (int row = k + 1; row < 3; ++row)
            if (fabs(m[row][k]) > fabs(m[pivot][k])) pivot = row;
        if (!(fabs(m[pivot][k]) > 0)) return false;
        for (int c = 0; c < 4; ++c)
        {
            const double kept = m[k][c];
            m[k][c] = m[pivot][c];
            m[pivot][c] = kept;
        }
        for (int row = k + 1; row < 3; ++row)
        {
            const double factor = m[row][k] / m[k][k];
            for (int c = k; c < 4; ++c) m[row][c] -= factor * m[k][c];
        }
    }
    for (int k = 2; k >= 0; --k)
    {
        x[k] = m[k][3];
        for (int c = k + 1; c < 3; ++c) x[k] -= m[k][c] * x[c];
        x[k] /= m[k][k];
    }
    return true;
}

/// Improves p until it no longer gets better (Levenberg 1944, Marquardt 1963). The middle stays where there are bins: a
/// steepest slope outside of them would be extrapolated. Returns the sum of squares.
static double improve(const scree_repose *repose, double p[NUM_PARAMETERS], double from, double to)
{
    double damping = 1e-3, best = sum_squares(repose, p, NULL);
    for (int round = 0; round < 200 && damping < 1e12; ++round)
    {
        double normal[3][4], change[3], next[3];
        sum_squares(repose, p, normal);
        for (int k = 0; k < 3; ++k) normal[k][k] *= 1 + damping;
        if (!solve(normal, change)) break;
        for (int k = 0; k < 3; ++k) next[k] = p[k] + change[k];
        next[MIDDLE] = fmin(fmax(next[MIDDLE], from), to);
        const double sum = sum_squares(repose, next, NULL);
        if (sum < best)
        {
            best = sum;
            damping *= 0.1;
            for (int k = 0; k < 3; ++k) p[k] = next[k];
        }
        else damping *= 10;
    }
    return best;
}

/// Best of several starts: heaps to the left and to the right, steep and flat.
static double fit_sigmoid(scree_repose *repose, double from, double to)
{
    double highest = 0, best = INFINITY;
    for (int64_t k = 0; k < repose->num_bins; ++k) highest = fmax(highest, repose->bin_height[k]);
    for (int start = 0; start < 18; ++start)
    {
        const double steepness[] = {-40, -12, -4, 4, 12, 40};
        double p[] = {highest, steepness[start % 6] / (to - from), from + (to - from) * (0.25 + 0.25 * (start / 6))};
        const double sum = improve(repose, p, from, to);
        if (!(sum < best)) continue;
        best = sum;
        repose->height = p[HEIGHT];
        repose->steepness = p[STEEPNESS];
        repose->middle = p[MIDDLE];
    }
    return best;
}

scree_status scree_simulation_repose(const scree_simulation *simulation, scree_repose *repose)
{
    const scree_repose_def *def = &simulation->scene->repose;
    *repose = (scree_repose){0};
    if (!def->measure || def->bins < 4 || def->bins > 256 || !(def->to > def->from)) return SCREE_INVALID_INPUT;
    if (measure_heights(simulation, repose) < 4) return SCREE_INVALID_INPUT;
    const double sum = fit_sigmoid(repose, def->from, def->to);
    repose->residual = sqrt(sum / (double)repose->num_bins);
    repose->angle_degrees = atan(fabs(repose->steepness * repose->height) / 4) * 180 / 3.14159265358979323846;
    return SCREE_OK;
}
