/// \file mass_properties.c
/// Integrals over a closed mesh as sums over the tetrahedra of its triangles and one point (Eberly 2002; Mirtich 1996),
/// exact for polynomials of second degree. The first sweep takes a vertex as that point and yields the centroid, the
/// second takes the centroid, so that nothing cancels wherever the mesh lies. Always in double.
#include "polyhedra/mass_properties.h"

#include <string.h>

/// Off-diagonal moment over the trace below which the axes of the mesh count as principal.
#define PRINCIPAL_TOLERANCE (1024.0 * (double)SCREE_REAL_EPSILON)

typedef struct volume_integrals
{
    double volume;
    double first[3];     ///< integral of r_i
    double second[3][3]; ///< integral of r_i r_j
    double area;
} volume_integrals;

/// Corner k of a triangle relative to the point origin + offset.
static void corner_from(const scree_mesh *mesh, int32_t v, scree_vec3 origin, const double offset[3], double r[3])
{
    const scree_vec3 p = mesh->vertices[v];
    r[0] = ((double)p.x - (double)origin.x) - offset[0];
    r[1] = ((double)p.y - (double)origin.y) - offset[1];
    r[2] = ((double)p.z - (double)origin.z) - offset[2];
}

static void add_triangle(volume_integrals *sum, double r[3][3])
{
    double ab[3];
    double ac[3];
    for (int i = 0; i < 3; ++i)
    {
        ab[i] = r[1][i] - r[0][i];
        ac[i] = r[2][i] - r[0][i];
    }
    // twice the area vector; its product with a corner is six times the volume of the tetrahedron
    const double n[3] = {ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2], ab[0] * ac[1] - ab[1] * ac[0]};
    const double six_volume = r[0][0] * n[0] + r[0][1] * n[1] + r[0][2] * n[2];
    sum->area += 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    sum->volume += six_volume / 6.0;
    for (int i = 0; i < 3; ++i)
    {
        const double si = r[0][i] + r[1][i] + r[2][i];
        sum->first[i] += six_volume / 24.0 * si;
        for (int j = 0; j <= i; ++j)
        {
            const double sj = r[0][j] + r[1][j] + r[2][j];
            const double products = si * sj + (r[0][i] * r[0][j] + r[1][i] * r[1][j] + r[2][i] * r[2][j]);
            sum->second[i][j] += six_volume / 120.0 * products;
        }
    }
}

static volume_integrals integrate(const scree_mesh *mesh, scree_vec3 origin, const double offset[3])
{
    volume_integrals sum = {0};
    for (int32_t t = 0; t < mesh->num_triangles; ++t)
    {
        double r[3][3];
        for (int k = 0; k < 3; ++k) corner_from(mesh, mesh->triangles[t].v[k], origin, offset, r[k]);
        add_triangle(&sum, r);
    }
    return sum;
}

/// One Jacobi rotation that makes a[p][q] zero; the columns of `axes` follow.
static void rotate(double a[3][3], double axes[3][3], int p, int q)
{
    if (a[p][q] == 0.0) return;
    const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    const double t = (theta >= 0.0 ? 1.0 : -1.0) / (fabs(theta) + sqrt(theta * theta + 1.0));
    const double c = 1.0 / sqrt(t * t + 1.0);
    const double s = t * c;
    const int r = 3 - p - q;
    const double apq = a[p][q];
    const double arp = a[r][p];
    const double arq = a[r][q];
    a[p][p] -= t * apq;
    a[q][q] += t * apq;
    a[p][q] = a[q][p] = 0.0;
    a[r][p] = a[p][r] = c * arp - s * arq;
    a[r][q] = a[q][r] = s * arp + c * arq;
    for (int i = 0; i < 3; ++i)
    {
        const double ip = axes[i][p];
        const double iq = axes[i][q];
        axes[i][p] = c * ip - s * iq;
        axes[i][q] = s * ip + c * iq;
    }
}

/// Unit quaternion of a rotation matrix, w >= 0, through its largest component (Shepperd 1978).
static void quaternion_of(double m[3][3], double q[4])
{
    const double squares[4] = {1.0 + m[0][0] + m[1][1] + m[2][2], 1.0 + m[0][0] - m[1][1] - m[2][2],
                               1.0 - m[0][0] + m[1][1] - m[2][2], 1.0 - m[0][0] - m[1][1] + m[2][2]};
    int largest = 0;
    for (int k = 1; k < 4; ++k)
        if (squares[k] > squares[largest]) largest = k;
    const double wx = m[2][1] - m[1][2], wy = m[0][2] - m[2][0], wz = m[1][0] - m[0][1];
    const double xy = m[1][0] + m[0][1], xz = m[0][2] + m[2][0], yz = m[2][1] + m[1][2];
    const double rows[4][4] = {
        {squares[0], wx, wy, wz}, {wx, squares[1], xy, xz}, {wy, xy, squares[2], yz}, {wz, xz, yz, squares[3]}};
    double length = 0.0;
    for (int k = 0; k < 4; ++k) length += rows[largest][k] * rows[largest][k];
    length = sqrt(length) * (rows[largest][0] < 0.0 ? -1.0 : 1.0);
    for (int k = 0; k < 4; ++k) q[k] = rows[largest][k] / length;
}

/// Orders the moments, gives the axes a fixed sign and a right hand.
static void arrange_axes(double a[3][3], double axes[3][3], double principal[3], double ordered[3][3])
{
    int order[3] = {0, 1, 2};
    for (int pass = 0; pass < 2; ++pass)
    {
        for (int k = 0; k < 2; ++k)
        {
            if (a[order[k]][order[k]] <= a[order[k + 1]][order[k + 1]]) continue;
            const int old = order[k];
            order[k] = order[k + 1];
            order[k + 1] = old;
        }
    }
    for (int k = 0; k < 3; ++k) principal[k] = a[order[k]][order[k]];
    for (int k = 0; k < 2; ++k)
    {
        int largest = 0;
        for (int i = 1; i < 3; ++i)
            if (fabs(axes[i][order[k]]) > fabs(axes[largest][order[k]])) largest = i;
        const double sign = axes[largest][order[k]] < 0.0 ? -1.0 : 1.0;
        for (int i = 0; i < 3; ++i) ordered[i][k] = sign * axes[i][order[k]];
    }
    for (int i = 0; i < 3; ++i)
    {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        ordered[i][2] = ordered[j][0] * ordered[k][1] - ordered[k][0] * ordered[j][1];
    }
}

void scree_mass_properties_find_principal(scree_mass_properties *properties)
{
    double a[3][3];
    double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double ordered[3][3];
    memcpy(a, properties->inertia, sizeof a);
    const double trace = a[0][0] + a[1][1] + a[2][2];
    const double tolerance = PRINCIPAL_TOLERANCE * fabs(trace);
    if (fabs(a[0][1]) <= tolerance && fabs(a[0][2]) <= tolerance && fabs(a[1][2]) <= tolerance)
    {
        for (int k = 0; k < 3; ++k) properties->principal[k] = a[k][k];
        properties->principal_axes[0] = 1.0;
        for (int k = 1; k < 4; ++k) properties->principal_axes[k] = 0.0;
        return;
    }
    // convergence is quadratic: 6 sweeps reach rounding from anywhere, and further ones change nothing
    for (int sweep = 0; sweep < 16; ++sweep)
    {
        rotate(a, axes, 0, 1);
        rotate(a, axes, 0, 2);
        rotate(a, axes, 1, 2);
    }
    arrange_axes(a, axes, properties->principal, ordered);
    quaternion_of(ordered, properties->principal_axes);
}

void scree_mass_properties_compute(const scree_mesh *mesh, scree_mass_properties *properties)
{
    const double none[3] = {0, 0, 0};
    double centroid[3] = {0, 0, 0};
    *properties = (scree_mass_properties){.principal_axes = {1, 0, 0, 0}};
    if (mesh->num_triangles == 0) return;

    // centroid relative to a vertex of the surface
    const scree_vec3 origin = mesh->vertices[mesh->triangles[0].v[0]];
    volume_integrals sum = integrate(mesh, origin, none);
    if (sum.volume == 0.0) return;
    for (int i = 0; i < 3; ++i) centroid[i] = sum.first[i] / sum.volume;

    // everything else relative to the centroid, whose own rounding is made good
    sum = integrate(mesh, origin, centroid);
    for (int i = 0; i < 3; ++i) centroid[i] += sum.first[i] / sum.volume;
    properties->volume = sum.volume;
    properties->area = sum.area;
    properties->centroid[0] = (double)origin.x + centroid[0];
    properties->centroid[1] = (double)origin.y + centroid[1];
    properties->centroid[2] = (double)origin.z + centroid[2];
    for (int i = 0; i < 3; ++i)
    {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        properties->inertia[i][i] = sum.second[j][j] + sum.second[k][k];
        for (int l = 0; l < i; ++l) properties->inertia[i][l] = properties->inertia[l][i] = -sum.second[i][l];
    }
    for (int32_t v = 0; v < mesh->num_vertices; ++v)
    {
        double r[3];
        corner_from(mesh, v, origin, centroid, r);
        const double radius = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
        if (radius > properties->bounding_radius) properties->bounding_radius = radius;
    }
    scree_mass_properties_find_principal(properties);
}
