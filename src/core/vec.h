/// \file vec.h
/// Real type, vectors, quaternions and boxes of the kernels: inline, in the common subset of C17 and CUDA C++17.
/// Only + - * / sqrt and comparisons are used, so the results do not depend on the compiler or the device.
#ifndef SCREE_VEC_H
#define SCREE_VEC_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#ifdef __CUDACC__
#define SCREE_FN static __host__ __device__ __forceinline__
#define SCREE_RESTRICT __restrict__
#elif defined(__cplusplus)
#define SCREE_FN static inline
#define SCREE_RESTRICT __restrict__
#else
#define SCREE_FN static inline
#define SCREE_RESTRICT restrict
#endif

/// Number type of state and kernels: double, or float in the single-precision build.
#ifdef SCREE_SINGLE
typedef float scree_real;
#define SCREE_REAL_EPSILON FLT_EPSILON
#define SCREE_REAL_MAX FLT_MAX
#else
typedef double scree_real;
#define SCREE_REAL_EPSILON DBL_EPSILON
#define SCREE_REAL_MAX DBL_MAX
#endif

SCREE_FN scree_real scree_sqrt(scree_real x)
{
#ifdef SCREE_SINGLE
    return sqrtf(x);
#else
    return sqrt(x);
#endif
}

SCREE_FN scree_real scree_abs(scree_real x)
{
#ifdef SCREE_SINGLE
    return fabsf(x);
#else
    return fabs(x);
#endif
}

/// Smaller and larger of two numbers; the first if they are equal (fmin leaves the sign of zero open).
SCREE_FN scree_real scree_min(scree_real a, scree_real b) { return b < a ? b : a; }
SCREE_FN scree_real scree_max(scree_real a, scree_real b) { return b > a ? b : a; }

/// The smaller one of two counts.
SCREE_FN int64_t scree_min_count(int64_t a, int64_t b) { return b < a ? b : a; }

typedef struct scree_vec3
{
    scree_real x, y, z;
} scree_vec3;

SCREE_FN scree_vec3 scree_vec3_make(scree_real x, scree_real y, scree_real z)
{
    scree_vec3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}
SCREE_FN scree_vec3 scree_vec3_zero(void) { return scree_vec3_make(0, 0, 0); }
SCREE_FN scree_vec3 scree_vec3_add(scree_vec3 a, scree_vec3 b)
{
    return scree_vec3_make(a.x + b.x, a.y + b.y, a.z + b.z);
}
SCREE_FN scree_vec3 scree_vec3_sub(scree_vec3 a, scree_vec3 b)
{
    return scree_vec3_make(a.x - b.x, a.y - b.y, a.z - b.z);
}
SCREE_FN scree_vec3 scree_vec3_scale(scree_vec3 a, scree_real s) { return scree_vec3_make(a.x * s, a.y * s, a.z * s); }
/// a + s b
SCREE_FN scree_vec3 scree_vec3_add_scaled(scree_vec3 a, scree_vec3 b, scree_real s)
{
    return scree_vec3_make(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}
SCREE_FN scree_vec3 scree_vec3_negate(scree_vec3 a) { return scree_vec3_make(-a.x, -a.y, -a.z); }
SCREE_FN scree_real scree_vec3_dot(scree_vec3 a, scree_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
SCREE_FN scree_vec3 scree_vec3_cross(scree_vec3 a, scree_vec3 b)
{
    return scree_vec3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
SCREE_FN scree_real scree_vec3_length(scree_vec3 a) { return scree_sqrt(scree_vec3_dot(a, a)); }
/// One of two vectors that are there already: no branch.
SCREE_FN scree_vec3 scree_vec3_select(bool is_a, scree_vec3 a, scree_vec3 b)
{
    return scree_vec3_make(is_a ? a.x : b.x, is_a ? a.y : b.y, is_a ? a.z : b.z);
}
SCREE_FN scree_vec3 scree_vec3_min(scree_vec3 a, scree_vec3 b)
{
    return scree_vec3_make(scree_min(a.x, b.x), scree_min(a.y, b.y), scree_min(a.z, b.z));
}
SCREE_FN scree_vec3 scree_vec3_max(scree_vec3 a, scree_vec3 b)
{
    return scree_vec3_make(scree_max(a.x, b.x), scree_max(a.y, b.y), scree_max(a.z, b.z));
}

/// Axis-aligned box; empty while lower > upper.
typedef struct scree_box
{
    scree_vec3 lower, upper;
} scree_box;

SCREE_FN scree_box scree_box_empty(void)
{
    scree_box box;
    box.lower = scree_vec3_make(SCREE_REAL_MAX, SCREE_REAL_MAX, SCREE_REAL_MAX);
    box.upper = scree_vec3_make(-SCREE_REAL_MAX, -SCREE_REAL_MAX, -SCREE_REAL_MAX);
    return box;
}
SCREE_FN scree_box scree_box_with_point(scree_box box, scree_vec3 p)
{
    box.lower = scree_vec3_min(box.lower, p);
    box.upper = scree_vec3_max(box.upper, p);
    return box;
}
SCREE_FN scree_box scree_box_union(scree_box a, scree_box b)
{
    a.lower = scree_vec3_min(a.lower, b.lower);
    a.upper = scree_vec3_max(a.upper, b.upper);
    return a;
}
/// Closed boxes: a shared face, edge or corner counts as overlap.
SCREE_FN bool scree_box_overlaps(scree_box a, scree_box b)
{
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
           a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

/// Rotation w + x i + y j + z k from the body frame to the world.
typedef struct scree_quat
{
    scree_real w, x, y, z;
} scree_quat;

SCREE_FN scree_quat scree_quat_make(scree_real w, scree_real x, scree_real y, scree_real z)
{
    scree_quat q;
    q.w = w;
    q.x = x;
    q.y = y;
    q.z = z;
    return q;
}
SCREE_FN scree_quat scree_quat_identity(void) { return scree_quat_make(1, 0, 0, 0); }
SCREE_FN scree_quat scree_quat_conjugate(scree_quat q) { return scree_quat_make(q.w, -q.x, -q.y, -q.z); }
/// Rotation b first, then a.
SCREE_FN scree_quat scree_quat_multiply(scree_quat a, scree_quat b)
{
    return scree_quat_make(a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                           a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                           a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w);
}
SCREE_FN scree_quat scree_quat_normalize(scree_quat q)
{
    const scree_real length = scree_sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return scree_quat_make(q.w / length, q.x / length, q.y / length, q.z / length);
}

/// 3 x 3 matrix by rows.
typedef struct scree_mat3
{
    scree_vec3 row[3];
} scree_mat3;

/// Rotation matrix of a quaternion used as given (not normalised here): diagonal 1 - 2(y^2 + z^2), and so on.
SCREE_FN scree_mat3 scree_mat3_from_quat(scree_quat q)
{
    scree_mat3 m;
    m.row[0] =
        scree_vec3_make(1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.w * q.z), 2 * (q.x * q.z + q.w * q.y));
    m.row[1] =
        scree_vec3_make(2 * (q.x * q.y + q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.w * q.x));
    m.row[2] =
        scree_vec3_make(2 * (q.x * q.z - q.w * q.y), 2 * (q.y * q.z + q.w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y));
    return m;
}
/// m v, each component ((m0 x + m1 y) + m2 z).
SCREE_FN scree_vec3 scree_mat3_apply(scree_mat3 m, scree_vec3 v)
{
    return scree_vec3_make(m.row[0].x * v.x + m.row[0].y * v.y + m.row[0].z * v.z,
                           m.row[1].x * v.x + m.row[1].y * v.y + m.row[1].z * v.z,
                           m.row[2].x * v.x + m.row[2].y * v.y + m.row[2].z * v.z);
}
/// m^T v
SCREE_FN scree_vec3 scree_mat3_apply_transposed(scree_mat3 m, scree_vec3 v)
{
    return scree_vec3_make(m.row[0].x * v.x + m.row[1].x * v.y + m.row[2].x * v.z,
                           m.row[0].y * v.x + m.row[1].y * v.y + m.row[2].y * v.z,
                           m.row[0].z * v.x + m.row[1].z * v.y + m.row[2].z * v.z);
}

/// Where a body is: world = position + R(orientation) (scale * body).
typedef struct scree_pose
{
    scree_vec3 position;    ///< [m]
    scree_quat orientation; ///< unit, body to world
    scree_real scale;       ///< [1], > 0; size of this body over the size of its shape
} scree_pose;

#endif
