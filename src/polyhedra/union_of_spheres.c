/// \file union_of_spheres.c
/// Integrals over the union of spheres, slice by slice: a plane z = const cuts discs, whose union is bounded by arcs,
/// and over an arc Green's theorem gives area and moments in closed form,
///
///     integral of x^p y^q over the slice = sum over arcs of the integral of x^(p + 1)/(p + 1) y^q dy,
///
/// while the area of the surface grows by R dphi dz (Archimedes). Over z: Gauss's rule of eight points on pieces that
/// begin and end where a sphere, or the circle in which two meet, does, with z = m + h (3 t - t^3)/2, which makes a
/// square root at such an end a polynomial in t. The piece with the largest error, estimated by halving it, is halved
/// until all are small. Always in double; uses functions of the mathematics library, once per shape.
#include "polyhedra/union_of_spheres.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define TOLERANCE 1e-9
/// Pairs of discs that are looked at before halving ends: some seconds.
#define MAX_WORK 3e7

enum
{
    NUM_POINTS = 8,
    MAX_PIECES = 6000,
    MAX_WITH_CIRCLES = 24, // spheres; circles, and most ends, of more are left to the halving
    MAX_ENDS = 2 * MAX_WITH_CIRCLES * MAX_WITH_CIRCLES,

    // what is integrated
    ONE = 0,
    X,
    Y,
    Z,
    XX,
    YY,
    ZZ,
    XY,
    XZ,
    YZ,
    SURFACE,
    NUM_INTEGRALS
};

/// Gauss-Legendre, positive half (Abramowitz & Stegun, table 25.4).
static const double gauss_place[NUM_POINTS / 2] = {0.1834346424956498049, 0.5255324099163289858, 0.7966664774136267396,
                                                   0.9602898564975362317};
static const double gauss_weight[NUM_POINTS / 2] = {0.3626837833783619830, 0.3137066458778872873, 0.2223810344533744706,
                                                    0.1012285362903762592};

/// Disc that a plane cuts out of a sphere.
typedef struct disc
{
    double x, y, radius;
} disc;

/// An arc that is covered by another disc, as angles in [0, 2 pi].
typedef struct covered_arc
{
    double begin, end;
} covered_arc;

typedef struct union_sums
{
    double of[NUM_INTEGRALS];
} union_sums;

/// Part of the range of z.
typedef struct z_piece
{
    double middle, half;     ///< [m] of the range between two ends that it belongs to
    double low, high;        ///< of t, in [-1, 1]
    union_sums lower, upper; ///< of its halves
    double error;            ///< of their sum
} z_piece;

typedef struct spheres_integrator
{
    const scree_sphere *spheres;
    int32_t num;
    double origin[3];     ///< everything is measured from there
    disc *discs;          ///< (num) of the present slice
    double *sphere_radii; ///< (num) of the spheres that they are cut from
    covered_arc *covered; ///< (2 num)
    z_piece *pieces;      ///< (MAX_PIECES)
    int32_t num_pieces;
    double scale[SURFACE]; ///< of each integral, for relative errors
    double work;           ///< pairs of discs looked at so far
} spheres_integrator;

/// Sums over the arc of the circle from angle a to b, weighted with dz.
static void add_arc(const disc *d, double sphere_radius, double a, double b, double dz, union_sums *sums)
{
    const double x = d->x, y = d->y, r = d->radius;
    const double ca = cos(a), sa = sin(a), cb = cos(b), sb = sin(b);
    // integrals of cos^p sin^q over the angle
    const double c1 = sb - sa, s2 = (sb * sb - sa * sa) / 2;
    const double double_sine = sb * cb - sa * ca;
    const double c2 = (b - a + double_sine) / 2;
    const double c3 = c1 - (sb * sb * sb - sa * sa * sa) / 3, s2c = (sb * sb * sb - sa * sa * sa) / 3;
    const double sc2 = -(cb * cb * cb - ca * ca * ca) / 3, sc3 = -(cb * cb * cb * cb - ca * ca * ca * ca) / 4;
    const double fourth = sb * cb * (cb * cb - sb * sb) - sa * ca * (ca * ca - sa * sa); // sin 4 phi over 4
    const double c4 = 3 * (b - a) / 8 + double_sine / 2 + fourth / 8, s2c2 = (b - a) / 8 - fourth / 8;
    double *of = sums->of;
    of[ONE] += dz * r * (x * c1 + r * c2);
    of[X] += dz * r / 2 * (x * x * c1 + 2 * x * r * c2 + r * r * c3);
    of[Y] += dz * r * (x * y * c1 + x * r * s2 + y * r * c2 + r * r * sc2);
    of[XX] += dz * r / 3 * (x * x * x * c1 + 3 * x * x * r * c2 + 3 * x * r * r * c3 + r * r * r * c4);
    of[XY] += dz * r / 2 * (x * x * (y * c1 + r * s2) + 2 * x * r * (y * c2 + r * sc2) + r * r * (y * c3 + r * sc3));
    of[YY] +=
        dz * r * (x * (y * y * c1 + 2 * y * r * s2 + r * r * s2c) + r * (y * y * c2 + 2 * y * r * sc2 + r * r * s2c2));
    of[SURFACE] += dz * sphere_radius * (b - a);
}

static int compare_arcs(const void *a, const void *b)
{
    const double x = ((const covered_arc *)a)->begin, y = ((const covered_arc *)b)->begin;
    return (x > y) - (x < y);
}

/// Arcs of disc i that others cover, sorted, to `covered`. Returns their number, or -1 if nothing of it is free.
static int32_t find_covered(const spheres_integrator *s, int32_t num_discs, int32_t i)
{
    const disc d = s->discs[i];
    int32_t num = 0;
    for (int32_t j = 0; j < num_discs; ++j)
    {
        if (j == i) continue;
        const disc e = s->discs[j];
        const double dx = e.x - d.x, dy = e.y - d.y, squared = dx * dx + dy * dy;
        const double difference = e.radius - d.radius, sum = e.radius + d.radius;
        if (squared >= sum * sum) continue;
        if (squared <= difference * difference)
        {
            // of two that are the same the first counts
            if (difference > 0 || (difference == 0 && j < i)) return -1;
            continue;
        }
        const double distance = sqrt(squared);
        const double cosine = (squared + d.radius * d.radius - e.radius * e.radius) / (2 * distance * d.radius);
        const double half = acos(fmin(fmax(cosine, -1), 1));
        double begin = atan2(dy, dx) - half;
        if (begin < 0) begin += 2 * PI;
        const double end = begin + 2 * half;
        s->covered[num++] = (covered_arc){begin, fmin(end, 2 * PI)};
        if (end > 2 * PI) s->covered[num++] = (covered_arc){0, end - 2 * PI};
    }
    qsort(s->covered, (size_t)num, sizeof *s->covered, compare_arcs);
    return num;
}

/// The slice at z, times dz.
static void add_slice(spheres_integrator *s, double z, double dz, union_sums *sums)
{
    int32_t num_discs = 0;
    for (int32_t k = 0; k < s->num; ++k)
    {
        const scree_sphere *sphere = s->spheres + k;
        const double r = (double)sphere->radius, h = z - ((double)sphere->centre.z - s->origin[2]);
        if (!(h * h < r * r)) continue;
        s->discs[num_discs] = (disc){(double)sphere->centre.x - s->origin[0], (double)sphere->centre.y - s->origin[1],
                                     sqrt((r - h) * (r + h))};
        s->sphere_radii[num_discs++] = r;
    }
    union_sums slice = {{0}};
    s->work += (double)num_discs * num_discs;
    for (int32_t i = 0; i < num_discs; ++i)
    {
        const int32_t num = find_covered(s, num_discs, i);
        double free_from = 0;
        for (int32_t k = 0; k < num; ++k)
        {
            if (s->covered[k].begin > free_from)
                add_arc(s->discs + i, s->sphere_radii[i], free_from, s->covered[k].begin, dz, &slice);
            free_from = fmax(free_from, s->covered[k].end);
        }
        if (num >= 0 && free_from < 2 * PI) add_arc(s->discs + i, s->sphere_radii[i], free_from, 2 * PI, dz, &slice);
    }
    slice.of[Z] = z * slice.of[ONE];
    slice.of[ZZ] = z * z * slice.of[ONE];
    slice.of[XZ] = z * slice.of[X];
    slice.of[YZ] = z * slice.of[Y];
    for (int k = 0; k < NUM_INTEGRALS; ++k) sums->of[k] += slice.of[k];
}

/// Gauss's rule on t from low to high.
static union_sums integrate_part(spheres_integrator *s, const z_piece *piece, double low, double high)
{
    union_sums sums = {{0}};
    const double middle = (low + high) / 2, half = (high - low) / 2;
    for (int k = 0; k < NUM_POINTS; ++k)
    {
        const double place = k < NUM_POINTS / 2 ? -gauss_place[k] : gauss_place[k - NUM_POINTS / 2];
        const double t = middle + half * place;
        const double z = piece->middle + piece->half * t * (3 - t * t) / 2;
        add_slice(s, z, gauss_weight[k % (NUM_POINTS / 2)] * half * piece->half * 1.5 * (1 - t * t), &sums);
    }
    return sums;
}

/// Both halves of a piece, and how far they are from the whole. The surface, which no motion depends on, has to do with
/// what the others need: its rate jumps where a circle begins.
static void split(spheres_integrator *s, z_piece *piece, const union_sums *whole)
{
    const double middle = (piece->low + piece->high) / 2;
    piece->lower = integrate_part(s, piece, piece->low, middle);
    piece->upper = integrate_part(s, piece, middle, piece->high);
    piece->error = 0;
    for (int k = 0; k < SURFACE; ++k)
        piece->error = fmax(piece->error, fabs(piece->lower.of[k] + piece->upper.of[k] - whole->of[k]) / s->scale[k]);
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Lowest and highest point of the circle in which spheres i and j meet, if they do. Returns their number.
static int32_t ends_of_circle(const spheres_integrator *s, int32_t i, int32_t j, double ends[2])
{
    const scree_sphere a = s->spheres[i], b = s->spheres[j];
    const double dx = (double)b.centre.x - (double)a.centre.x, dy = (double)b.centre.y - (double)a.centre.y;
    const double dz = (double)b.centre.z - (double)a.centre.z, squared = dx * dx + dy * dy + dz * dz;
    const double r = (double)a.radius, q = (double)b.radius;
    if (!(squared > 0)) return 0;
    const double share = 0.5 + (r * r - q * q) / (2 * squared); // of the way from a to b, where the circle's plane is
    const double height = r * r - share * share * squared;      // its radius squared
    if (!(height > 0)) return 0;
    const double z = (double)a.centre.z - s->origin[2] + share * dz;
    const double reach = sqrt(height * (dx * dx + dy * dy) / squared);
    ends[0] = z - reach;
    ends[1] = z + reach;
    return 2;
}

/// One piece between any two neighbouring ends of spheres and circles. `ends` is (2 num + MAX_ENDS).
static void make_pieces(spheres_integrator *s, double *ends)
{
    int32_t num_ends = 0;
    for (int32_t k = 0; k < s->num; ++k)
    {
        const double z = (double)s->spheres[k].centre.z - s->origin[2], r = (double)s->spheres[k].radius;
        ends[num_ends++] = z - r;
        ends[num_ends++] = z + r;
    }
    for (int32_t i = 0; i < s->num; ++i)
        for (int32_t j = 0; j < i && s->num <= MAX_WITH_CIRCLES; ++j)
            num_ends += ends_of_circle(s, i, j, ends + num_ends);
    qsort(ends, (size_t)num_ends, sizeof *ends, compare_numbers);
    const int32_t stride = s->num <= MAX_WITH_CIRCLES ? 1 : 1 + num_ends / 64;
    for (int32_t last = 0, k = 1; k < num_ends; ++k)
    {
        if ((k % stride != 0 && k + 1 < num_ends) || !(ends[k] > ends[last])) continue;
        z_piece *piece = s->pieces + s->num_pieces++;
        *piece = (z_piece){(ends[k] + ends[last]) / 2, (ends[k] - ends[last]) / 2, -1, 1, {{0}}, {{0}}, 0};
        last = k;
        const union_sums whole = integrate_part(s, piece, -1, 1);
        split(s, piece, &whole);
    }
}

/// Halves pieces until the sum of their errors is small, or the work large. Returns that sum.
static double refine(spheres_integrator *s)
{
    for (;;)
    {
        int32_t worst = 0;
        double error = 0;
        for (int32_t k = 0; k < s->num_pieces; ++k)
        {
            error += s->pieces[k].error;
            if (s->pieces[k].error > s->pieces[worst].error) worst = k;
        }
        if (error <= TOLERANCE || s->num_pieces == MAX_PIECES || s->work > MAX_WORK) return error;
        z_piece *lower = s->pieces + worst, *upper = s->pieces + s->num_pieces++;
        const union_sums of_lower = lower->lower, of_upper = lower->upper;
        *upper = *lower;
        lower->high = upper->low = (lower->low + lower->high) / 2;
        split(s, lower, &of_lower);
        split(s, upper, &of_upper);
    }
}

/// Largest distance over the spheres of a point of them from the centroid.
static double bounding_radius(const spheres_integrator *s, const double centroid[3])
{
    double largest = 0;
    for (int32_t k = 0; k < s->num; ++k)
    {
        const scree_vec3 c = s->spheres[k].centre;
        const double d[3] = {(double)c.x - centroid[0], (double)c.y - centroid[1], (double)c.z - centroid[2]};
        largest = fmax(largest, sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) + (double)s->spheres[k].radius);
    }
    return largest;
}

static void fill_properties(const spheres_integrator *s, scree_mass_properties *properties)
{
    union_sums sums = {{0}};
    for (int32_t k = 0; k < s->num_pieces; ++k)
        for (int i = 0; i < NUM_INTEGRALS; ++i) sums.of[i] += s->pieces[k].lower.of[i] + s->pieces[k].upper.of[i];
    const double *of = sums.of, volume = of[ONE];
    const double c[3] = {of[X] / volume, of[Y] / volume, of[Z] / volume};
    static const int square[3] = {XX, YY, ZZ}, product[3] = {YZ, XZ, XY};
    *properties = (scree_mass_properties){.volume = volume, .area = of[SURFACE], .principal_axes = {1, 0, 0, 0}};
    for (int i = 0; i < 3; ++i)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        properties->centroid[i] = s->origin[i] + c[i];
        properties->inertia[i][i] = of[square[j]] + of[square[k]] - volume * (c[j] * c[j] + c[k] * c[k]);
        properties->inertia[j][k] = properties->inertia[k][j] = volume * c[j] * c[k] - of[product[i]];
    }
    properties->bounding_radius = bounding_radius(s, properties->centroid);
    scree_mass_properties_find_principal(properties);
}

scree_status scree_union_of_spheres_properties(const scree_sphere *spheres, int32_t num,
                                               scree_mass_properties *properties, double *error)
{
    spheres_integrator s = {.spheres = spheres, .num = num};
    s.discs = malloc((size_t)num * sizeof *s.discs);
    s.sphere_radii = malloc((size_t)num * sizeof *s.sphere_radii);
    s.covered = malloc(2 * (size_t)num * sizeof *s.covered);
    s.pieces = malloc(MAX_PIECES * sizeof *s.pieces);
    double *ends = malloc((2 * (size_t)num + MAX_ENDS) * sizeof *ends);
    const bool is_complete =
        s.discs != NULL && s.sphere_radii != NULL && s.covered != NULL && s.pieces != NULL && ends != NULL;
    if (is_complete)
    {
        // from the middle of the centres; errors count relative to the sum of all spheres
        for (int32_t k = 0; k < num; ++k)
        {
            s.origin[0] += (double)spheres[k].centre.x / num;
            s.origin[1] += (double)spheres[k].centre.y / num;
            s.origin[2] += (double)spheres[k].centre.z / num;
        }
        const double spread = bounding_radius(&s, s.origin);
        double volume = 0;
        for (int32_t k = 0; k < num; ++k)
        {
            const double r = (double)spheres[k].radius;
            volume = fmax(volume, 4.0 / 3.0 * PI * r * r * r);
        }
        s.scale[ONE] = volume;
        for (int k = X; k <= Z; ++k) s.scale[k] = volume * spread;
        for (int k = XX; k <= YZ; ++k) s.scale[k] = volume * spread * spread;
        make_pieces(&s, ends);
        *error = refine(&s);
        fill_properties(&s, properties);
    }
    free(s.discs);
    free(s.sphere_radii);
    free(s.covered);
    free(s.pieces);
    free(ends);
    return is_complete ? SCREE_OK : SCREE_OUT_OF_MEMORY;
}
