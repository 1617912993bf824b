/// \file bench_overlap.c
/// Time of one overlap on one core, whole call, for touching pairs of equal shapes at random orientations, indented by
/// 1e-4 to 5e-2 of their size (log-uniform). Prints the median over repetitions, in CPU time, for both schemes.
/// Usage: bench_overlap [number of pairs, default 2000]
#define _POSIX_C_SOURCE 200809L
#include "contact/overlap_kernel.h"
#include "polyhedra/generate.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

typedef struct bench_pairs
{
    scree_pose *a, *b; ///< (num)
    int num;
} bench_pairs;

static bool use_convex;
static uint64_t random_state = 20240611;

static double uniform(void)
{
    uint64_t z = (random_state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/// Standard normal enough for directions: sum of twelve.
static double normal(void)
{
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static scree_quat random_orientation(void)
{
    return scree_quat_normalize(
        scree_quat_make((scree_real)normal(), (scree_real)normal(), (scree_real)normal(), (scree_real)normal()));
}

static int compute(const scree_shape *shape, const scree_pose *a, const scree_pose *b,
                   const scree_overlap_options *options, scree_overlap_workspace *workspace,
                   scree_overlap_result *result)
{
    for (;;)
    {
        scree_overlap_compute(&shape->view, a, &shape->view, b, options, workspace, result, 1);
        if (result->status != SCREE_OVERLAP_WORKSPACE_FULL) return result->status;
        if (scree_overlap_workspace_grow(workspace) != SCREE_OK) exit(1);
    }
}

/// Poses that touch: B comes along a random line until it touches, then goes on by the indentation.
static void make_pairs(const scree_shape *shape, scree_overlap_workspace *workspace, bench_pairs *pairs)
{
    const scree_overlap_options options = {SCREE_OVERLAP_FILTERED, false, use_convex};
    for (int i = 0; i < pairs->num;)
    {
        scree_pose a = {{0, 0, 0}, random_orientation(), 1};
        scree_pose b = {{0, 0, 0}, random_orientation(), 1};
        scree_vec3 u = scree_vec3_make((scree_real)normal(), (scree_real)normal(), (scree_real)normal());
        u = scree_vec3_scale(u, 1 / scree_vec3_length(u));
        double near = 0, far = 2.1 * (double)shape->view.bounding_radius;
        for (int step = 0; step < 45; ++step)
        {
            const double middle = (near + far) / 2;
            scree_overlap_result result;
            b.position = scree_vec3_scale(u, (scree_real)middle);
            if (compute(shape, &a, &b, &options, workspace, &result) == SCREE_OVERLAP_NONE) far = middle;
            else near = middle;
        }
        double depth = 1e-4;
        const double exponent = uniform();
        for (int k = 0; k < 27; ++k)
            if (exponent * 27 > k) depth *= 1.2589254117941673;
        b.position = scree_vec3_scale(u, (scree_real)(near - depth * 2 * (double)shape->view.bounding_radius));
        scree_overlap_result result;
        if (compute(shape, &a, &b, &options, workspace, &result) != SCREE_OVERLAP_TOUCHING) continue;
        pairs->a[i] = a;
        pairs->b[i] = b;
        ++i;
    }
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/// Median time of one call in microseconds.
static __attribute__((noinline)) double time_pairs(const scree_shape *shape, const bench_pairs *pairs,
                                                   const scree_overlap_options *options,
                                                   scree_overlap_workspace *workspace)
{
    double times[9];
    for (int repeat = 0; repeat < 9; ++repeat)
    {
        const double start = now();
        for (int i = 0; i < pairs->num; ++i)
        {
            scree_overlap_result result;
            compute(shape, pairs->a + i, pairs->b + i, options, workspace, &result);
        }
        times[repeat] = (now() - start) / pairs->num * 1e6;
    }
    qsort(times, 9, sizeof *times, compare);
    return times[4];
}

static void bench_shape(const char *name, const scree_shape *shape, int num)
{
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    bench_pairs pairs = {malloc((size_t)num * sizeof(scree_pose)), malloc((size_t)num * sizeof(scree_pose)), num};
    if (workspace == NULL || pairs.a == NULL || pairs.b == NULL) exit(1);
    make_pairs(shape, workspace, &pairs);
    scree_overlap_options options = {SCREE_OVERLAP_FILTERED, false, use_convex};
    const double filtered = time_pairs(shape, &pairs, &options, workspace);
    options.scheme = SCREE_OVERLAP_HIERARCHY;
    const double hierarchy = time_pairs(shape, &pairs, &options, workspace);
    printf("%-18s %5d triangles  filtered %7.2f us  hierarchy %7.2f us\n", name, shape->view.num_triangles, filtered,
           hierarchy);
    fflush(stdout);
    free(pairs.a);
    free(pairs.b);
    scree_overlap_workspace_destroy(workspace);
}

static void bench_mesh(const char *name, scree_mesh *mesh, int num)
{
    scree_shape shape = {0};
    if (scree_shape_create(&shape, mesh, SCREE_FRAME_PRINCIPAL) != SCREE_OK) exit(1);
    scree_mesh_destroy(mesh);
    bench_shape(name, &shape, num);
    scree_shape_destroy(&shape);
}

int main(int argc, char **argv)
{
    const int num = argc > 1 ? atoi(argv[1]) : 2000;
    const double cube[3] = {1, 1, 1};
    scree_mesh mesh = {0};
    if (scree_generate_tetrahedron(&mesh, 1) == SCREE_OK) bench_mesh("tetrahedron", &mesh, num);
    if (scree_generate_schoenhardt(&mesh, 1) == SCREE_OK) bench_mesh("Schoenhardt", &mesh, num);
    if (scree_generate_box(&mesh, cube) == SCREE_OK) bench_mesh("cube", &mesh, num);
    if (scree_generate_sphere(&mesh, 1, 40) == SCREE_OK) bench_mesh("sphere", &mesh, num);
    if (scree_generate_rock(&mesh, 1, 40, 0) == SCREE_OK) bench_mesh("rock", &mesh, num);
    if (scree_generate_rock(&mesh, 1, 100, 0) == SCREE_OK) bench_mesh("rock", &mesh, num);
    if (scree_generate_rock(&mesh, 1, 300, 0) == SCREE_OK) bench_mesh("rock", &mesh, num / 2);
    if (scree_generate_rock(&mesh, 1, 1000, 0) == SCREE_OK) bench_mesh("rock", &mesh, num / 4);
    return 0;
}
