/// Tree of eight children per node: every item that meets a query is found, once, and little that does not.
#include "bvh/lbvh.h"
#include "bvh/wide_tree.h"

#include "bvh_tools.h"
#include "harness.h"

/// direction . x <= reach
typedef struct brute_half_space
{
    scree_vec3 direction;
    double reach;
    double direction1; ///< sum of the components' magnitudes
} brute_half_space;

/// A query in full precision: boxes that overlap `box` and reach into all half-spaces, of which the first is no side.
typedef struct brute_query
{
    scree_box box;
    brute_half_space half_spaces[1 + SCREE_WIDE_SIDES];
    int32_t num_half_spaces;
    double size; ///< bounds every coordinate of the boxes
} brute_query;

/// The least of direction . x in a box.
static double least_along(scree_vec3 direction, scree_box box)
{
    return (double)(direction.x * (direction.x > 0 ? box.lower.x : box.upper.x)) +
           (double)(direction.y * (direction.y > 0 ? box.lower.y : box.upper.y)) +
           (double)(direction.z * (direction.z > 0 ? box.lower.z : box.upper.z));
}

/// How much deeper a half-space may be taken: by 8 eps on purpose, 1.5 eps for its bounds, 2 for direction, products
/// and sums, and 1.5 for its reach.
static double deepened(const brute_half_space *half_space, double size)
{
    const double epsilon = (double)FLT_EPSILON;
    return 12 * epsilon * half_space->direction1 * size + 2 * epsilon * fabs(half_space->reach) + 8 * (double)FLT_MIN;
}

/// Does a box meet the query, or the query with its box widened and its half-spaces deepened?
static bool meets(const brute_query *query, scree_box box, double widened, bool is_deepened)
{
    const double lower[3] = {box.lower.x, box.lower.y, box.lower.z}, upper[3] = {box.upper.x, box.upper.y, box.upper.z};
    const double from[3] = {query->box.lower.x, query->box.lower.y, query->box.lower.z};
    const double to[3] = {query->box.upper.x, query->box.upper.y, query->box.upper.z};
    for (int k = 0; k < 3; ++k)
        if (lower[k] > to[k] + widened || upper[k] < from[k] - widened) return false;
    for (int32_t k = 0; k < query->num_half_spaces; ++k)
    {
        const brute_half_space *half_space = query->half_spaces + k;
        const double more = is_deepened ? deepened(half_space, query->size) : 0;
        if (!(least_along(half_space->direction, box) <= half_space->reach + more)) return false;
    }
    return true;
}

static double size_of(const scree_box *boxes, int32_t num)
{
    double size = 0;
    for (int32_t i = 0; i < num; ++i)
    {
        const scree_vec3 corners[2] = {boxes[i].lower, boxes[i].upper};
        for (int k = 0; k < 2; ++k)
            size = fmax(size,
                        fmax(fabs((double)corners[k].x), fmax(fabs((double)corners[k].y), fabs((double)corners[k].z))));
    }
    return size;
}

/// About the middle of the boxes; some directions along an axis, some without length.
static brute_half_space random_half_space(double extent, uint64_t *state)
{
    brute_half_space half_space = {.direction1 = 0};
    double d[3];
    const int zeros = (int)(scree_test_random_bits(state) % 8);
    for (int k = 0; k < 3; ++k)
    {
        d[k] = zeros >> k & 1 ? 0 : 2 * scree_test_random(state) - 1;
        half_space.direction1 += fabs(d[k]);
    }
    half_space.direction = scree_vec3_make((scree_real)d[0], (scree_real)d[1], (scree_real)d[2]);
    half_space.reach = (2 * scree_test_random(state) - 1) * half_space.direction1 * extent / 2;
    return half_space;
}

/// A box and half-spaces, every third time with sides.
static brute_query random_query(const scree_test_boxes *kind, double size, uint64_t *state)
{
    brute_query query;
    const scree_test_boxes larger = {kind->extent, 0.05 * kind->extent, kind->extent, 5, kind->grid};
    query.box = scree_test_box(&larger, state);
    query.num_half_spaces = scree_test_random_bits(state) % 3 == 0 ? 1 + SCREE_WIDE_SIDES : 1;
    for (int32_t k = 0; k < query.num_half_spaces; ++k) query.half_spaces[k] = random_half_space(kind->extent, state);
    // sides that leave something between them
    for (int32_t k = 1; k < query.num_half_spaces; ++k) query.half_spaces[k].reach += kind->extent / 4;
    query.size = size;
    return query;
}

/// Moves a query until it only just meets an item: what is rounded the wrong way is missed.
static void touch(brute_query *query, scree_box item, int way)
{
    for (int32_t k = 0; k < query->num_half_spaces; ++k)
        query->half_spaces[k].reach = least_along(query->half_spaces[k].direction, item);
    query->box = item;
    if (way == 0) query->box.lower.x = item.upper.x;
    if (way == 1) query->box.upper.x = item.lower.x;
    if (way == 2) query->box.lower.y = item.upper.y;
    if (way == 3) query->box.upper.y = item.lower.y;
    if (way == 4) query->box.lower.z = item.upper.z;
    if (way == 5) query->box.upper.z = item.lower.z;
}

/// Counts how often each item is found; returns the sum.
static int32_t find(const scree_wide_tree_view *tree, const brute_query *query, int32_t *num_found)
{
    scree_wide_half_space half_spaces[1 + SCREE_WIDE_SIDES];
    for (int32_t k = 0; k < query->num_half_spaces; ++k)
        half_spaces[k] = scree_wide_half_space_make(query->half_spaces[k].direction,
                                                    (scree_real)query->half_spaces[k].reach, (scree_real)query->size);
    scree_wide_walk walk;
    scree_wide_query_set(&walk.query, query->box, half_spaces[0]);
    for (int32_t k = 1; k < query->num_half_spaces; ++k) scree_wide_query_add_side(&walk.query, half_spaces[k]);
    scree_wide_walk_start(tree, &walk);
    int32_t sum = 0;
    uint32_t found;
    for (int32_t node; (node = scree_wide_walk_next(tree, &walk, &found)) >= 0;)
    {
        for (int32_t child = 0; child < SCREE_WIDE_CHILDREN; ++child)
        {
            if ((found >> child & 1) == 0) continue;
            const int32_t place = SCREE_WIDE_CHILDREN * node + child;
            SCREE_CHECK(place < tree->num_items);
            if (place >= tree->num_items) continue;
            ++num_found[tree->items[place]];
            ++sum;
        }
    }
    return sum;
}

/// Queries against a walk over all boxes. Returns how many items met a query.
static int64_t check_queries(const scree_wide_tree_view *tree, const scree_box *boxes, const scree_test_boxes *kind,
                             int num_queries, uint64_t *state)
{
    const int32_t num = tree->num_items;
    const double size = size_of(boxes, num);
    int32_t *num_found = scree_test_alloc(num, sizeof *num_found);
    int64_t num_met = 0;
    for (int n = 0; n < num_queries; ++n)
    {
        const uint64_t seed = *state;
        brute_query query = random_query(kind, size, state);
        if (num > 0 && n % 2 == 0) touch(&query, boxes[scree_test_random_bits(state) % (uint64_t)num], n / 2 % 6);
        memset(num_found, 0, (size_t)num * sizeof *num_found);
        find(tree, &query, num_found);
        // bounds of tree and query are each moved by 1.5 eps at most
        const double to = fmax(size, size_of(&query.box, 1));
        const double widened = 3 * (double)FLT_EPSILON * to + 8 * (double)FLT_MIN;
        int num_missed = 0, num_twice = 0, num_far = 0;
        for (int32_t i = 0; i < num; ++i)
        {
            const bool does_meet = meets(&query, boxes[i], 0, false);
            num_met += does_meet;
            num_missed += does_meet && num_found[i] == 0;
            num_twice += num_found[i] > 1;
            num_far += num_found[i] > 0 && !meets(&query, boxes[i], widened, true);
        }
        SCREE_CHECK_INT(num_missed, 0);
        SCREE_CHECK_INT(num_twice, 0);
        SCREE_CHECK_INT(num_far, 0);
        if (num_missed + num_twice + num_far > 0)
            printf("%d items, extent %.17g, state of the random numbers %llu\n", num, kind->extent,
                   (unsigned long long)seed);
    }
    free(num_found);
    return num_met;
}

/// Builds the tree over random boxes of one kind and asks it.
static int64_t check_boxes(const scree_test_boxes *kind, int32_t num, int num_queries, uint64_t *state)
{
    scree_box *boxes = scree_test_make_boxes(kind, num, state);
    scree_lbvh lbvh = {0};
    scree_wide_tree tree = {0};
    SCREE_CHECK_INT(scree_lbvh_build(&lbvh, boxes, num), SCREE_OK);
    SCREE_CHECK_INT(scree_wide_tree_build(&tree, &lbvh, boxes, num), SCREE_OK);
    SCREE_CHECK_INT(tree.view.num_items, num);
    const int64_t num_met = check_queries(&tree.view, boxes, kind, num_queries, state);
    scree_wide_tree_destroy(&tree);
    scree_lbvh_destroy(&lbvh);
    free(boxes);
    return num_met;
}

static const int32_t counts[] = {0, 1, 2, 7, 8, 9, 63, 64, 65, 511, 512, 513, 1000};
enum
{
    NUM_COUNTS = (int)(sizeof counts / sizeof *counts)
};

static void check_kind(const scree_test_boxes *kind, uint64_t seed)
{
    uint64_t state = seed;
    int64_t num_met = 0;
    for (int k = 0; k < NUM_COUNTS; ++k) num_met += check_boxes(kind, counts[k], 100, &state);
    // a test of queries that find nothing would show nothing
    SCREE_CHECK(num_met > 1000);
}

static void test_ordinary(void)
{
    const scree_test_boxes kind = {.extent = 10, .smallest = 0.1, .largest = 1, .elongation = 5};
    check_kind(&kind, 1);
}

/// Coordinates on a coarse grid: boxes that touch, coincide, and are flat or points.
static void test_equal_and_flat(void)
{
    const scree_test_boxes kind = {.extent = 8, .smallest = 0.01, .largest = 2, .elongation = 3, .grid = 1};
    check_kind(&kind, 2);
}

static void test_sizes(void)
{
    const double extents[] = {1e-30, 1e-9, 1e-3, 1e6, 1e15};
    for (int k = 0; k < 5; ++k)
    {
        const double e = extents[k];
        const scree_test_boxes equal = {.extent = e, .smallest = 0.01 * e, .largest = 0.1 * e, .elongation = 5};
        check_kind(&equal, 3 + (uint64_t)k);
        const scree_test_boxes mixed = {.extent = e, .smallest = 1e-8 * e, .largest = e, .elongation = 1e3};
        check_kind(&mixed, 10 + (uint64_t)k);
    }
}

/// The half-space alone: the box of the query holds everything.
static void test_whole_space(void)
{
    const scree_test_boxes kind = {.extent = 10, .smallest = 0.1, .largest = 1, .elongation = 5};
    uint64_t state = 20;
    scree_box *boxes = scree_test_make_boxes(&kind, 1000, &state);
    scree_lbvh lbvh = {0};
    scree_wide_tree tree = {0};
    SCREE_CHECK_INT(scree_lbvh_build(&lbvh, boxes, 1000), SCREE_OK);
    SCREE_CHECK_INT(scree_wide_tree_build(&tree, &lbvh, boxes, 1000), SCREE_OK);
    brute_query query = random_query(&kind, size_of(boxes, 1000), &state);
    const scree_real far = (scree_real)1e3;
    query.box.lower = scree_vec3_make(-far, -far, -far);
    query.box.upper = scree_vec3_make(far, far, far);
    query.num_half_spaces = 1;
    query.half_spaces[0].direction = scree_vec3_make(0, 0, 1);
    int32_t num_found[1000] = {0};
    query.half_spaces[0].reach = 1e3;
    SCREE_CHECK_INT(find(&tree.view, &query, num_found), 1000);
    for (int i = 0; i < 1000; ++i) SCREE_CHECK_INT(num_found[i], 1);
    query.half_spaces[0].reach = -1e3;
    SCREE_CHECK_INT(find(&tree.view, &query, num_found), 0);

    // built again over fewer boxes, the tree forgets the old ones
    SCREE_CHECK_INT(scree_lbvh_build(&lbvh, boxes, 9), SCREE_OK);
    SCREE_CHECK_INT(scree_wide_tree_build(&tree, &lbvh, boxes, 9), SCREE_OK);
    query.half_spaces[0].reach = 1e3;
    SCREE_CHECK_INT(find(&tree.view, &query, num_found), 9);
    SCREE_CHECK_INT(scree_wide_tree_build(&tree, &lbvh, boxes, 0), SCREE_OK);
    SCREE_CHECK_INT(find(&tree.view, &query, num_found), 0);
    scree_wide_tree_destroy(&tree);
    scree_lbvh_destroy(&lbvh);
    free(boxes);
}

/// Triangles known by their corners: in the half-space the lowest level judges by these, not by the boxes.
static void test_corners(void)
{
    enum
    {
        NUM = 300
    };
    uint64_t state = 30;
    scree_vec3 corners[3 * NUM];
    scree_box boxes[NUM];
    const scree_test_boxes kind = {.extent = 10, .smallest = 0.1, .largest = 5, .elongation = 5};
    for (int i = 0; i < NUM; ++i)
    {
        const scree_box box = scree_test_box(&kind, &state);
        boxes[i] = scree_box_empty();
        for (int c = 0; c < 3; ++c)
        {
            const double t[3] = {scree_test_random(&state), scree_test_random(&state), scree_test_random(&state)};
            corners[3 * i + c] = scree_vec3_make(box.lower.x + (scree_real)t[0] * (box.upper.x - box.lower.x),
                                                 box.lower.y + (scree_real)t[1] * (box.upper.y - box.lower.y),
                                                 box.lower.z + (scree_real)t[2] * (box.upper.z - box.lower.z));
            boxes[i] = scree_box_with_point(boxes[i], corners[3 * i + c]);
        }
    }
    scree_lbvh lbvh = {0};
    scree_wide_tree tree = {0};
    SCREE_CHECK_INT(scree_lbvh_build(&lbvh, boxes, NUM), SCREE_OK);
    SCREE_CHECK_INT(scree_wide_tree_build(&tree, &lbvh, boxes, NUM), SCREE_OK);
    SCREE_CHECK_INT(scree_wide_tree_add_corners(&tree, corners), SCREE_OK);
    const double size = size_of(boxes, NUM);
    int num_by_box_only = 0, num_missed = 0, num_far = 0;
    for (int n = 0; n < 3000; ++n)
    {
        brute_query query = random_query(&kind, size, &state);
        const scree_vec3 touched = corners[scree_test_random_bits(&state) % (3 * NUM)];
        brute_half_space *half_space = query.half_spaces;
        if (n % 2 == 0) half_space->reach = (double)scree_vec3_dot(half_space->direction, touched);
        int32_t num_found[NUM] = {0};
        find(&tree.view, &query, num_found);
        for (int i = 0; i < NUM; ++i)
        {
            double least = 1e300;
            for (int c = 0; c < 3; ++c)
                least = fmin(least, (double)scree_vec3_dot(half_space->direction, corners[3 * i + c]));
            const bool does_meet = meets(&query, boxes[i], 0, false) && least <= half_space->reach;
            num_missed += does_meet && num_found[i] == 0;
            num_far += num_found[i] > 0 && least > half_space->reach + deepened(half_space, size);
            num_by_box_only += num_found[i] == 0 && meets(&query, boxes[i], 0, false);
        }
    }
    SCREE_CHECK_INT(num_missed, 0);
    SCREE_CHECK_INT(num_far, 0);
    SCREE_CHECK(num_by_box_only > 100);
    scree_wide_tree_destroy(&tree);
    scree_lbvh_destroy(&lbvh);
}

int main(void)
{
    SCREE_RUN(test_corners);
    SCREE_RUN(test_ordinary);
    SCREE_RUN(test_equal_and_flat);
    SCREE_RUN(test_sizes);
    SCREE_RUN(test_whole_space);
    return SCREE_TEST_END();
}
