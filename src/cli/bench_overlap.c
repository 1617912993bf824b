/// \file bench_overlap.c
/// scree bench overlap: time of one overlap on one core for touching pairs of equal shapes at random orientations,
/// indented by 1e-4 to 5e-2 of their size (log-uniform), or by one depth. The whole call by the default scheme with and
/// without the convex path and by the hierarchy; where the time of the general path goes, and how much work there is.
/// Medians of several rounds over all pairs, which go on in turn so that each way meets the same state of the machine.
#include "cli/bench.h"
#include "cli/mesh_argument.h"
#include "contact/overlap_kernel.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum
{
    NUM_WAYS = 3 ///< default, without the convex path, hierarchy
};

typedef struct bench_pairs
{
    scree_pose *a, *b; ///< (num)
    int num;
} bench_pairs;

static void stop_unless(bool is_well)
{
    if (is_well) return;
    fprintf(stderr, "scree bench: not enough memory\n");
    exit(1);
}

static uint64_t random_state = 20240611;

static double uniform(void) { return scree_bench_uniform(&random_state); }

/// Standard normal enough for directions: sum of twelve.
static double normal(void)
{
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
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
        stop_unless(scree_overlap_workspace_grow(workspace) == SCREE_OK);
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

/// Seconds of one call by each of several ways, in turn, to times[way * num_rounds + round].
static void time_ways(const scree_shape *shape, const bench_pairs *pairs, const scree_overlap_options *ways,
                      int num_rounds, scree_overlap_workspace *workspace, double *times)
{
    for (int round = 0; round < num_rounds; ++round)
    {
        for (int w = 0; w < NUM_WAYS; ++w)
        {
            const double start = scree_bench_core_seconds();
            for (int i = 0; i < pairs->num; ++i)
            {
                scree_overlap_result result;
                compute(shape, pairs->a + i, pairs->b + i, ways + w, workspace, &result);
            }
            times[w * num_rounds + round] = (scree_bench_core_seconds() - start) / pairs->num;
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
    const scree_team team = scree_team_alone();
    slice->lack = SCREE_LACK_NOTHING;
    if (scree_overlap_spheres_apart(pair) || !scree_overlap_set_up(pair, &slice->setup) || last == STAGE_FRAME) return;
    stop_unless(scree_overlap_filter(&team, slice));
    work->kept += slice->body[0].num_triangles + slice->body[1].num_triangles;
    if (last == STAGE_FILTER) return;
    scree_overlap_prepare(&team, slice, SCREE_OVERLAP_FILTERED);
    stop_unless(scree_overlap_collect(&team, slice, pair->shape));
    work->segments += slice->num_segments;
    work->inside += slice->body[0].num_inside + slice->body[1].num_inside;
    if (last == STAGE_CROSSINGS) return;
    slice->num_patches = 1;
    scree_overlap_sum(&team, slice, pair->shape, 0, &slice->sums);
    if (last == STAGE_SUMS) return;
    const volatile scree_real volume = scree_overlap_to_world(slice, pair->pose[0]).volume;
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

/// Seconds of one pair up to each stage to times[stage * num_rounds + round], and the work of all pairs.
static void time_stages(const scree_shape *shape, const bench_pairs *pairs, int num_rounds,
                        scree_overlap_workspace *workspace, double *times, bench_work *work)
{
    // the workspace is its slice of buffers and nothing else
    scree_overlap_slice *slice = (scree_overlap_slice *)workspace;
    for (int round = 0; round < num_rounds; ++round)
    {
        for (int stage = 0; stage < NUM_STAGES; ++stage)
        {
            const bench_work none = {0, 0, 0, 0};
            *work = none;
            const double start = scree_bench_core_seconds();
            for (int i = 0; i < pairs->num; ++i)
            {
                const scree_overlap_pair pair = {{&shape->view, &shape->view}, {pairs->a + i, pairs->b + i}};
                run_stages(&pair, stage, slice, work);
            }
            times[stage * num_rounds + round] = (scree_bench_core_seconds() - start) / pairs->num;
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

/// Medians of num rows of num_rounds times each, which are sorted.
static void take_medians(double *times, int num, int num_rounds, double *medians)
{
    for (int k = 0; k < num; ++k)
    {
        const scree_bench_samples samples = {times + k * num_rounds, num_rounds};
        scree_bench_sort(samples);
        medians[k] = scree_bench_median(samples);
    }
}

/// Times of a shape as a case.
static json_t *measure_shape(const scree_bench *bench, const char *name, const scree_shape *shape, int num)
{
    const int num_rounds = (int)bench->request->repetitions;
    scree_overlap_workspace *workspace = scree_overlap_workspace_create();
    bench_pairs pairs = {malloc((size_t)num * sizeof(scree_pose)), malloc((size_t)num * sizeof(scree_pose)), num};
    double *times = malloc((size_t)((NUM_WAYS + NUM_STAGES) * num_rounds) * sizeof *times);
    stop_unless(workspace != NULL && pairs.a != NULL && pairs.b != NULL && times != NULL);
    make_pairs(shape, workspace, bench->request->depth, &pairs);
    static const scree_overlap_options ways[NUM_WAYS] = {{SCREE_OVERLAP_FILTERED, false, true},
                                                         {SCREE_OVERLAP_FILTERED, false, false},
                                                         {SCREE_OVERLAP_HIERARCHY, false, false}};
    double whole[NUM_WAYS], stages[NUM_STAGES], *stage_times = times + NUM_WAYS * num_rounds;
    bench_work work;
    time_ways(shape, &pairs, ways, num_rounds, workspace, times);
    time_stages(shape, &pairs, num_rounds, workspace, stage_times, &work);
    take_medians(times, NUM_WAYS, num_rounds, whole);
    take_medians(stage_times, NUM_STAGES, num_rounds, stages);
    for (int stage = NUM_STAGES - 1; stage > 0; --stage) stages[stage] -= stages[stage - 1];
    char text[64];
    snprintf(text, sizeof text, "%s %d", name, shape->view.num_triangles);
    json_t *measured = json_pack(
        "{s:s, s:i, s:i, s:i, s:f, s:i, s:f, s:f, s:f, s:{s:f, s:f, s:f, s:f, s:f}, s:{s:f, s:f, s:f, s:f}}", "name",
        text, "threads", 1, "particles", num, "triangles", shape->view.num_triangles, "depth", bench->request->depth,
        "repetitions", num_rounds, "core_seconds", whole[0], "general", whole[1], "hierarchy", whole[2], "stages",
        "frame", stages[STAGE_FRAME], "filter", stages[STAGE_FILTER], "crossings", stages[STAGE_CROSSINGS], "sums",
        stages[STAGE_SUMS], "result", stages[STAGE_RESULT], "work", "kept", work.kept / num, "pairs", work.pairs / num,
        "segments", work.segments / num, "inside", work.inside / num);
    scree_bench_set_noise(measured, "spread", (scree_bench_samples){times, num_rounds});
    free(times);
    free(pairs.a);
    free(pairs.b);
    scree_overlap_workspace_destroy(workspace);
    return measured;
}

static const scree_bench_column columns[] = {
    {"name", "[us]            ", 0, 0},
    {"core_seconds", "default", 1e6, 2},
    {"general", "general", 1e6, 2},
    {"hierarchy", "hierarchy", 1e6, 2},
    {"stages.frame", "frame", 1e6, 2},
    {"stages.filter", "filter", 1e6, 2},
    {"stages.crossings", "crossings", 1e6, 2},
    {"stages.sums", " sums", 1e6, 2},
    {"stages.result", "result", 1e6, 2},
    {"work.kept", " kept", 1, 1},
    {"work.pairs", "pairs", 1, 1},
    {"work.segments", "segments", 1, 1},
    {"work.inside", "inside", 1, 1},
    {"spread", "spread %", 100, 0},
};

/// A shape to measure, in the words of a command line; its pairs are a share of those asked for.
typedef struct bench_mesh
{
    const char *name, *generator;
    int share;
} bench_mesh;

static const bench_mesh meshes[] = {
    {"tetrahedron", "tetrahedron:1", 1},
    {"Schoenhardt", "schoenhardt:1", 1},
    {"cube", "box:1:1:1", 1},
    {"sphere", "sphere:1:40", 1},
    {"rock", "rock:1:40", 1},
    {"rock", "rock:1:100", 1},
    {"rock", "rock:1:300", 2},
    {"sphere", "sphere:1:980", 1},
    {"rock", "rock:1:1000", 4},
};

scree_status scree_bench_overlap(scree_bench *bench)
{
    scree_bench_set_columns(bench, columns, (int)(sizeof columns / sizeof *columns));
    scree_status status = SCREE_OK;
    for (size_t k = 0; k < sizeof meshes / sizeof *meshes && status == SCREE_OK; ++k)
    {
        scree_mesh mesh = {0};
        scree_shape shape = {0};
        status = scree_mesh_generate(&mesh, meshes[k].generator, bench->report);
        if (status == SCREE_OK) status = scree_shape_create(&shape, &mesh, SCREE_FRAME_PRINCIPAL);
        scree_mesh_destroy(&mesh);
        const int64_t num = bench->request->particles / meshes[k].share;
        if (status == SCREE_OK) status = scree_bench_add(bench, measure_shape(bench, meshes[k].name, &shape, (int)num));
        scree_shape_destroy(&shape);
    }
    return status;
}
