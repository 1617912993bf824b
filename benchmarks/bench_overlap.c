/// \file bench_overlap.c
/// Time of one overlap on one core for touching pairs of equal shapes at random orientations, indented by 1e-4 to 5e-2
/// of their size (log-uniform). One table: the whole call by the default scheme with and without the convex path and by
/// the hierarchy. Another: where the time of the general path goes, and how much work there is. Times are CPU times,
/// the least of several rounds over all pairs, which go on in turn so that each way meets the same state of the
/// machine. Usage: bench_overlap [number of pairs, default 2000] [depth over size, default at random as above]
#define _POSIX_C_SOURCE 200809L
#include "contact/overlap_kernel.h"
#include "polyhedra/generate.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/// Of the whole measurement, each over all pairs.
#define NUM_ROUNDS 9

typedef struct bench_pairs
{
    scree_pose *a, *b; ///< (num)
    int num;
} bench_pairs;

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
static void make_pairs(const scree_shape *shape, scree_overlap_workspace *workspace, double wanted_depth,
                       bench_pairs *pairs)
{
    const scree_overlap_options options = {SCREE_OVERLAP_FILTERED, false, false};
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
        if (wanted_depth > 0) depth = wanted_depth;
        b.position = scree_vec3_scale(u, (scree_real)(near - depth * 2 * (double)shape->view.bounding_radius));
        scree_overlap_result result;
        if (compute(shape, &a, &b, &options, workspace, &result) != SCREE_OVERLAP_TOUCHING) continue;
        pairs->a[i] = a;
        pairs->b[i] = b;
        ++i;
    }
}

/// Seconds of one call by each of several ways, in turn; the least of several rounds.
static void time_ways(const scree_shape *shape, const bench_pairs *pairs, const scree_overlap_options *ways,
                      int num_ways, scree_overlap_workspace *workspace, double *least)
{
    for (int w = 0; w < num_ways; ++w) least[w] = 1e300;
    for (int round = 0; round < NUM_ROUNDS; ++round)
    {
        for (int w = 0; w < num_ways; ++w)
        {
            const double start = now();
            for (int i = 0; i < pairs->num; ++i)
            {
                scree_overlap_result result;
                compute(shape, pairs->a + i, pairs->b + i, ways + w, workspace, &result);
            }
            const double time = (now() - start) / pairs->num;
            if (time < least[w]) least[w] = time;
        }
    }
}

/// Stages of the general path, each with all before it.
enum
{
    STAGE_FRAME,
    STAGE_FILTER,
    STAGE_CROSSINGS,
    STAGE_SUMS,
    STAGE_RESULT,
    NUM_STAGES
};

typedef struct bench_work
{
    double kept, pairs, segments, inside; ///< of both bodies, mean over the pairs
} bench_work;

/// One pair up to a stage, on the kernels themselves.
static void run_stages(const scree_overlap_pair *pair, int last, scree_overlap_slice *slice, bench_work *work)
{
    scree_overlap_setup setup;
    scree_overlap_sums sums;
    const scree_team team = scree_team_alone();
    slice->lack = SCREE_LACK_NOTHING;
    if (scree_overlap_spheres_apart(pair) || !scree_overlap_set_up(pair, &setup) || last == STAGE_FRAME) return;
    if (!scree_overlap_filter(&team, slice, &setup)) exit(1);
    work->kept += slice->body[0].num_triangles + slice->body[1].num_triangles;
    if (last == STAGE_FILTER) return;
    scree_overlap_prepare(&team, slice, SCREE_OVERLAP_FILTERED);
    if (!scree_overlap_collect(&team, slice, pair->shape)) exit(1);
    work->segments += slice->num_segments;
    work->inside += slice->body[0].num_inside + slice->body[1].num_inside;
    if (last == STAGE_CROSSINGS) return;
    slice->num_patches = 1;
    scree_overlap_sum(&team, slice, pair->shape, 0, &sums);
    if (last == STAGE_SUMS) return;
    const volatile scree_real volume = scree_overlap_to_world(slice, &setup, &sums, pair->pose[0]).volume;
    (void)volume;
}

/// Pairs of kept triangles whose boxes overlap: those that are tested against each other.
static double count_triangle_pairs(const scree_overlap_slice *slice)
{
    double num = 0;
    for (int f = 0; f < slice->body[0].num_triangles; ++f)
        for (int g = 0; g < slice->body[1].num_triangles; ++g)
            num += scree_box_overlaps(slice->body[0].triangle_boxes[f], slice->body[1].triangle_boxes[g]);
    return num;
}

static void time_stages(const scree_shape *shape, const bench_pairs *pairs, scree_overlap_workspace *workspace,
                        double *least, bench_work *work)
{
    // the workspace is its slice of buffers and nothing else
    scree_overlap_slice *slice = (scree_overlap_slice *)workspace;
    for (int stage = 0; stage < NUM_STAGES; ++stage) least[stage] = 1e300;
    for (int round = 0; round < NUM_ROUNDS; ++round)
    {
        for (int stage = 0; stage < NUM_STAGES; ++stage)
        {
            const bench_work none = {0, 0, 0, 0};
            *work = none;
            const double start = now();
            for (int i = 0; i < pairs->num; ++i)
            {
                const scree_overlap_pair pair = {{&shape->view, &shape->view}, {pairs->a + i, pairs->b + i}};
                run_stages(&pair, stage, slice, work);
            }
            const double time = (now() - start) / pairs->num;
            if (time < least[stage]) least[stage] = time;
        }
    }
    for (int i = 0; i < pairs->num; ++i)
    {
        const scree_overlap_pair pair = {{&shape->view, &shape->view}, {pairs->a + i, pairs->b + i}};
        bench_work ignored = {0, 0, 0, 0};
        run_stages(&pair, STAGE_FILTER, slice, &ignored);
        work->pairs += count_triangle_pairs(slice);
    }
}

static void bench_shape(const char *name, const scree_shape *shape, int num, double depth)
{
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    bench_pairs pairs = {malloc((size_t)num * sizeof(scree_pose)), malloc((size_t)num * sizeof(scree_pose)), num};
    if (workspace == NULL || pairs.a == NULL || pairs.b == NULL) exit(1);
    make_pairs(shape, workspace, depth, &pairs);
    static const scree_overlap_options ways[] = {{SCREE_OVERLAP_FILTERED, false, true},
                                                 {SCREE_OVERLAP_FILTERED, false, false},
                                                 {SCREE_OVERLAP_HIERARCHY, false, false}};
    double whole[3], stages[NUM_STAGES];
    bench_work work;
    time_ways(shape, &pairs, ways, 3, workspace, whole);
    time_stages(shape, &pairs, workspace, stages, &work);
    printf("%-12s %5d  %7.2f %7.2f %7.2f  |", name, shape->view.num_triangles, 1e6 * whole[0], 1e6 * whole[1],
           1e6 * whole[2]);
    for (int stage = 0; stage < NUM_STAGES; ++stage)
        printf(" %6.2f", 1e6 * (stages[stage] - (stage > 0 ? stages[stage - 1] : 0)));
    printf("  | %5.1f %6.1f %5.1f %5.1f\n", work.kept / num, work.pairs / num, work.segments / num, work.inside / num);
    fflush(stdout);
    free(pairs.a);
    free(pairs.b);
    scree_overlap_workspace_destroy(workspace);
}

static void bench_mesh(const char *name, scree_mesh *mesh, int num, double depth)
{
    scree_shape shape = {0};
    if (scree_shape_create(&shape, mesh, SCREE_FRAME_PRINCIPAL) != SCREE_OK) exit(1);
    scree_mesh_destroy(mesh);
    bench_shape(name, &shape, num, depth);
    scree_shape_destroy(&shape);
}

int main(int argc, char **argv)
{
    const int num = argc > 1 ? atoi(argv[1]) : 2000;
    const double depth = argc > 2 ? atof(argv[2]) : 0;
    const double cube[3] = {1, 1, 1};
    printf("%-12s %5s  %7s %7s %7s  | %6s %6s %6s %6s %6s  | %5s %6s %5s %5s\n", "[us]", "faces", "default", "general",
           "hierar.", "frame", "filter", "cross.", "sums", "result", "kept", "pairs", "segm.", "in");
    scree_mesh mesh = {0};
    if (scree_generate_tetrahedron(&mesh, 1) == SCREE_OK) bench_mesh("tetrahedron", &mesh, num, depth);
    if (scree_generate_schoenhardt(&mesh, 1) == SCREE_OK) bench_mesh("Schoenhardt", &mesh, num, depth);
    if (scree_generate_box(&mesh, cube) == SCREE_OK) bench_mesh("cube", &mesh, num, depth);
    if (scree_generate_sphere(&mesh, 1, 40) == SCREE_OK) bench_mesh("sphere", &mesh, num, depth);
    if (scree_generate_rock(&mesh, 1, 40, 0) == SCREE_OK) bench_mesh("rock", &mesh, num, depth);
    if (scree_generate_rock(&mesh, 1, 100, 0) == SCREE_OK) bench_mesh("rock", &mesh, num, depth);
    if (scree_generate_rock(&mesh, 1, 300, 0) == SCREE_OK) bench_mesh("rock", &mesh, num / 2, depth);
    if (scree_generate_sphere(&mesh, 1, 980) == SCREE_OK) bench_mesh("sphere", &mesh, num, depth);
    if (scree_generate_rock(&mesh, 1, 1000, 0) == SCREE_OK) bench_mesh("rock", &mesh, num / 4, depth);
    return 0;
}
