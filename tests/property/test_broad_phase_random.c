/// Random boxes and walls of many kinds, sizes 1:1000 and elongations 1:50 among them, against all pairs by brute
/// force, with 1, 2 and 7 threads. Also ids in another order: the same bodies must be found under their new names.
#include "bvh/broad_phase.h"
#include "bvh/morton_kernel.h"

#include <omp.h>
#include <stdlib.h>

#include "bvh_tools.h"
#include "harness.h"

enum
{
    NUM_ROUNDS = 400,
    MAX_PARTICLES = 900,
    MAX_WALLS = 3
};

static const scree_test_boxes kinds[] = {
    {.extent = 10, .smallest = 0.3, .largest = 0.6, .elongation = 2},
    {.extent = 10, .smallest = 0.005, .largest = 5, .elongation = 1},            // size 1:1000
    {.extent = 10, .smallest = 0.2, .largest = 2, .elongation = 50},             // plates and needles
    {.extent = 10, .smallest = 0.005, .largest = 5, .elongation = 50},           // both
    {.extent = 10, .smallest = 0.5, .largest = 1, .elongation = 1, .grid = 0.5}, // many that just touch
    {.extent = 3, .smallest = 0.5, .largest = 1, .elongation = 1, .grid = 1},    // many that coincide
    {.extent = 1e-6, .smallest = 1e-9, .largest = 1e-7, .elongation = 10},       // small
    {.extent = 1e8, .smallest = 1e5, .largest = 1e7, .elongation = 10},          // large
    {.extent = 0, .smallest = 0.005, .largest = 5, .elongation = 50},            // around one point
    {.extent = 1000, .smallest = 0.3, .largest = 0.6, .elongation = 2},          // hardly any pairs
};

typedef struct scene
{
    const scree_test_boxes *kind;
    scree_box *boxes;
    scree_vec3 *centres;
    scree_real *radii;
    scree_box *triangles[MAX_WALLS]; ///< boxes of a wall's triangles
    int64_t num_triangles[MAX_WALLS];
    scree_lbvh trees[MAX_WALLS];
    scree_broad_phase_wall walls[MAX_WALLS];
    scree_broad_phase_input input;
} scene;

static scree_pose random_pose(double extent, uint64_t *state)
{
    double v[7];
    for (int k = 0; k < 7; ++k) v[k] = scree_test_random(state) - 0.5;
    scree_pose pose;
    pose.position =
        scree_vec3_make((scree_real)(v[0] * extent), (scree_real)(v[1] * extent), (scree_real)(v[2] * extent));
    pose.orientation =
        scree_quat_normalize(scree_quat_make((scree_real)v[3], (scree_real)v[4], (scree_real)v[5], (scree_real)v[6]));
    pose.scale = (scree_real)scree_test_size(state, 0.1, 10);
    return pose;
}

static void make_scene(scene *s, int round, uint64_t *state)
{
    memset(s, 0, sizeof *s);
    s->kind = kinds + round % (int)(sizeof kinds / sizeof *kinds);
    const int64_t num = (int64_t)(scree_test_random(state) * scree_test_random(state) * MAX_PARTICLES);
    s->boxes = scree_test_make_boxes(s->kind, num, state);
    s->centres = scree_test_alloc(num, sizeof *s->centres);
    s->radii = scree_test_alloc(num, sizeof *s->radii);
    // a clump: a part of the boxes once more at a hundredth of the size
    if (round % 3 == 0)
    {
        for (int64_t i = num / 2; i < num; ++i)
        {
            s->boxes[i].lower = scree_vec3_scale(s->boxes[i].lower, (scree_real)0.01);
            s->boxes[i].upper = scree_vec3_scale(s->boxes[i].upper, (scree_real)0.01);
        }
    }
    // spheres around the boxes, or smaller ones, which then decide as well
    const bool compares_spheres = scree_test_random(state) < 0.5;
    const scree_real share = compares_spheres ? (scree_real)(0.5 + 0.5 * scree_test_random(state)) : 1;
    for (int64_t i = 0; i < num; ++i)
    {
        s->centres[i] = scree_morton_middle(s->boxes[i]);
        s->radii[i] = share * scree_vec3_length(scree_vec3_sub(s->boxes[i].upper, s->centres[i]));
    }
    const int64_t num_walls = (int64_t)(scree_test_random(state) * (MAX_WALLS + 1));
    for (int64_t w = 0; w < num_walls; ++w)
    {
        s->num_triangles[w] = (int64_t)(scree_test_random(state) * 30);
        s->triangles[w] = scree_test_make_boxes(s->kind, s->num_triangles[w], state);
        SCREE_CHECK(scree_lbvh_build(s->trees + w, s->triangles[w], s->num_triangles[w]) == SCREE_OK);
        s->walls[w] = (scree_broad_phase_wall){s->trees[w].view, random_pose(s->kind->extent, state),
                                               scree_test_random(state) < 0.8};
    }
    s->input = (scree_broad_phase_input){.boxes = s->boxes,
                                         .centres = s->centres,
                                         .radii = s->radii,
                                         .walls = s->walls,
                                         .num_particles = num,
                                         .num_walls = num_walls,
                                         .compares_spheres = compares_spheres};
}

static void destroy_scene(scene *s)
{
    free(s->boxes);
    free(s->centres);
    free(s->radii);
    for (int w = 0; w < MAX_WALLS; ++w)
    {
        scree_lbvh_destroy(s->trees + w);
        free(s->triangles[w]);
    }
}

static bool boxes_meet(const scree_box *a, const scree_box *b)
{
    return !(a->upper.x < b->lower.x || b->upper.x < a->lower.x || a->upper.y < b->lower.y || b->upper.y < a->lower.y ||
             a->upper.z < b->lower.z || b->upper.z < a->lower.z);
}

/// In the same roundings as the search: the sums have no others.
static bool spheres_meet(const scene *s, int64_t i, int64_t j)
{
    const scree_real x = s->centres[i].x - s->centres[j].x, y = s->centres[i].y - s->centres[j].y;
    const scree_real z = s->centres[i].z - s->centres[j].z, sum = s->radii[i] + s->radii[j];
    return x * x + y * y + z * z <= sum * sum;
}

/// How far sphere i is from the nearest box of wall w, in the world, over its coordinates' size: negative if it reaches
/// it. Quaternion as a rotation matrix in long double.
static double relative_gap(const scene *s, int64_t i, int64_t w)
{
    const scree_pose *pose = &s->walls[w].pose;
    const long double q[4] = {pose->orientation.w, pose->orientation.x, pose->orientation.y, pose->orientation.z};
    const long double t[3] = {(long double)s->centres[i].x - pose->position.x,
                              (long double)s->centres[i].y - pose->position.y,
                              (long double)s->centres[i].z - pose->position.z};
    const long double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    long double local[3], nearest = INFINITY;
    for (int k = 0; k < 3; ++k)
    {
        local[k] = 0;
        for (int l = 0; l < 3; ++l) // column k of the matrix: q_k q_l terms, the diagonal and the antisymmetric part
        {
            const int m = 3 - k - l; // the third axis, if k and l differ
            const long double sign = (l - k + 3) % 3 == 1 ? 1 : -1;
            const long double entry =
                k == l ? q[0] * q[0] + q[k + 1] * q[k + 1] - n / 2 : q[k + 1] * q[l + 1] + sign * q[0] * q[m + 1];
            local[k] += 2 / n * entry * t[l];
        }
        local[k] /= pose->scale;
    }
    for (int64_t b = 0; b < s->num_triangles[w]; ++b)
    {
        const scree_box *box = s->triangles[w] + b;
        const long double x = fmaxl(0, fmaxl(box->lower.x - local[0], local[0] - box->upper.x));
        const long double y = fmaxl(0, fmaxl(box->lower.y - local[1], local[1] - box->upper.y));
        const long double z = fmaxl(0, fmaxl(box->lower.z - local[2], local[2] - box->upper.z));
        nearest = fminl(nearest, sqrtl(x * x + y * y + z * z) * pose->scale);
    }
    const long double size = fabsl(t[0]) + fabsl(t[1]) + fabsl(t[2]) + s->radii[i];
    return (double)((nearest - s->radii[i]) / size);
}

/// 1: must be found, 0: must not, -1: within the rounding that the search adds to spheres, 48 eps.
static int are_candidates(const scene *s, int64_t i, int64_t j)
{
    if (j < s->input.num_particles)
        return boxes_meet(s->boxes + i, s->boxes + j) && (!s->input.compares_spheres || spheres_meet(s, i, j));
    const int64_t w = j - s->input.num_particles;
    if (!s->walls[w].is_present) return 0;
    const double gap = relative_gap(s, i, w);
    if (gap <= 0) return 1;
    return gap > 64 * SCREE_REAL_EPSILON ? 0 : -1;
}

/// Number of pairs that are missing or too many.
static int64_t count_wrong(const scene *s, const scree_broad_phase *broad_phase)
{
    int64_t p = 0, num_wrong = 0;
    for (int64_t i = 0; i < s->input.num_particles; ++i)
    {
        for (int64_t j = i + 1; j < s->input.num_particles + s->input.num_walls; ++j)
        {
            const bool is_listed =
                p < broad_phase->num_pairs && broad_phase->pairs[p].i == i && broad_phase->pairs[p].j == j;
            p += is_listed;
            const int expected = are_candidates(s, i, j);
            num_wrong += expected >= 0 && expected != is_listed;
        }
    }
    return num_wrong + broad_phase->num_pairs - p; // those left over are out of order or no pairs at all
}

/// Each pair stands in the row of its second body and among the own ones of its first, once each.
static int64_t count_wrong_rows(const scree_broad_phase *broad_phase, int64_t num_bodies)
{
    int64_t num_wrong = broad_phase->row_begin[num_bodies] != broad_phase->num_pairs ||
                        broad_phase->own_begin[num_bodies] != broad_phase->num_pairs;
    char *count = scree_test_alloc(broad_phase->num_pairs, 1);
    for (int64_t body = 0; body < num_bodies && num_wrong == 0; ++body)
    {
        for (int64_t k = broad_phase->row_begin[body]; k < broad_phase->row_begin[body + 1]; ++k)
        {
            const int32_t p = broad_phase->row_pairs[k];
            num_wrong += k > broad_phase->row_begin[body] && p <= broad_phase->row_pairs[k - 1];
            num_wrong += broad_phase->pairs[p].j != body;
            ++count[p];
        }
        for (int64_t p = broad_phase->own_begin[body]; p < broad_phase->own_begin[body + 1]; ++p)
        {
            num_wrong += broad_phase->pairs[p].i != body;
            ++count[p];
        }
    }
    for (int64_t p = 0; p < broad_phase->num_pairs; ++p) num_wrong += count[p] != 2;
    free(count);
    return num_wrong;
}

static void print_scene(const scene *s, int round, uint64_t seed)
{
    printf("    round %d, seed %llu, %lld particles, %lld walls, kind: extent %.17g, half edges %.17g to %.17g, "
           "elongation %.17g, grid %.17g\n",
           round, (unsigned long long)seed, (long long)s->input.num_particles, (long long)s->input.num_walls,
           s->kind->extent, s->kind->smallest, s->kind->largest, s->kind->elongation, s->kind->grid);
}

static void test_all_pairs_by_brute_force(void)
{
    scree_broad_phase broad_phase = {0}, again = {0}; // kept over the rounds: nothing of the last search may show
    int64_t num_pairs = 0;
    for (int round = 0; round < NUM_ROUNDS; ++round)
    {
        const uint64_t seed = 1000 + (uint64_t)round;
        uint64_t state = seed;
        scene s;
        make_scene(&s, round, &state);
        const int64_t num_bodies = s.input.num_particles + s.input.num_walls;
        omp_set_num_threads(round % 3 == 0 ? 1 : round % 3 == 1 ? 2 : 7);
        SCREE_CHECK(scree_broad_phase_find(&broad_phase, &s.input) == SCREE_OK);
        omp_set_num_threads(1);
        SCREE_CHECK(scree_broad_phase_find(&again, &s.input) == SCREE_OK);
        const int64_t num_wrong = count_wrong(&s, &broad_phase);
        const int64_t num_wrong_rows = num_wrong == 0 ? count_wrong_rows(&broad_phase, num_bodies) : 0;
        const bool is_same =
            broad_phase.num_pairs == again.num_pairs &&
            memcmp(broad_phase.pairs, again.pairs, (size_t)again.num_pairs * sizeof *again.pairs) == 0 &&
            memcmp(broad_phase.row_pairs, again.row_pairs, (size_t)again.num_pairs * sizeof(int32_t)) == 0;
        SCREE_CHECK_INT(num_wrong, 0);
        SCREE_CHECK_INT(num_wrong_rows, 0);
        SCREE_CHECK(is_same);
        if (num_wrong != 0 || num_wrong_rows != 0 || !is_same) print_scene(&s, round, seed);
        num_pairs += broad_phase.num_pairs;
        destroy_scene(&s);
    }
    SCREE_CHECK(num_pairs > 100000); // there was something to find
    scree_broad_phase_destroy(&broad_phase);
    scree_broad_phase_destroy(&again);
}

/// The same boxes under other ids: pair (i, j) becomes pair (new_id[i], new_id[j]).
static void test_renamed_particles(void)
{
    enum
    {
        NUM = 700
    };
    for (int kind = 0; kind < (int)(sizeof kinds / sizeof *kinds); ++kind)
    {
        uint64_t state = 77 + (uint64_t)kind;
        scree_box *boxes = scree_test_make_boxes(kinds + kind, NUM, &state);
        scree_box *renamed = scree_test_alloc(NUM, sizeof *renamed);
        int32_t *new_id = scree_test_alloc(NUM, sizeof *new_id);
        for (int32_t i = 0; i < NUM; ++i) // 1009 is prime and does not divide 700
        {
            new_id[i] = (int32_t)((i * 1009LL + 17) % NUM);
            renamed[new_id[i]] = boxes[i];
        }
        const scree_broad_phase_input input_a = {.boxes = boxes, .num_particles = NUM};
        const scree_broad_phase_input input_b = {.boxes = renamed, .num_particles = NUM};
        scree_broad_phase a = {0}, b = {0};
        SCREE_CHECK(scree_broad_phase_find(&a, &input_a) == SCREE_OK);
        SCREE_CHECK(scree_broad_phase_find(&b, &input_b) == SCREE_OK);
        SCREE_CHECK_INT(a.num_pairs, b.num_pairs);
        int64_t num_missing = 0;
        for (int64_t p = 0; p < a.num_pairs; ++p)
        {
            const int32_t i = new_id[a.pairs[p].i], j = new_id[a.pairs[p].j], other = i < j ? j : i;
            const int32_t body = i < j ? i : j;
            bool is_there = false;
            for (int32_t own = b.own_begin[body]; own < b.own_begin[body + 1] && !is_there; ++own)
                is_there = b.pairs[own].i == body && b.pairs[own].j == other;
            num_missing += !is_there;
        }
        SCREE_CHECK_INT(num_missing, 0);
        if (num_missing != 0) printf("    kind %d\n", kind);
        scree_broad_phase_destroy(&a);
        scree_broad_phase_destroy(&b);
        free(boxes);
        free(renamed);
        free(new_id);
    }
}

int main(void)
{
    SCREE_RUN(test_all_pairs_by_brute_force);
    SCREE_RUN(test_renamed_particles);
    return SCREE_TEST_END();
}
