/// Build, refit and traversal of the tree: the example of Karras (2012), a plain recursive build that must give the
/// same tree, and boxes that are few, equal, flat, huge and tiny.
#include "bvh/bvh_launch.h"
#include "bvh/lbvh.h"

#include <omp.h>
#include <stdlib.h>
#include <sys/resource.h>

#include "bvh_tools.h"
#include "harness.h"
#include "launch_any_order.h"

static const scree_test_boxes ordinary = {.extent = 10, .smallest = 0.1, .largest = 1, .elongation = 5};

/// Karras (2012), fig. 3: eight codes of five bits and the ranges of the seven inner nodes.
static void test_example_of_karras(void)
{
    uint64_t codes[8] = {1, 2, 4, 5, 19, 24, 25, 30};
    int32_t first[7], last[7];
    const int32_t expected_first[7] = {0, 0, 2, 0, 4, 5, 5}; // by split
    const int32_t expected_last[7] = {1, 3, 3, 7, 7, 6, 7};
    scree_lbvh_build_args args = {0};
    args.codes = codes;
    args.first_leaf = first;
    args.last_leaf = last;
    args.num_leaves = 8;
    for (int order = 0; order < SCREE_TEST_NUM_ORDERS; ++order)
    {
        memset(first, -1, sizeof first);
        memset(last, -1, sizeof last);
        SCREE_LAUNCH_IN_ORDER(scree_lbvh_hierarchy, args, 7, order);
        SCREE_CHECK(memcmp(first, expected_first, sizeof first) == 0);
        SCREE_CHECK(memcmp(last, expected_last, sizeof last) == 0);
    }
}

/// The tree over sorted leaves first .. last as its definition says, depth first; returns the number of the next node.
static int32_t build_recursively(const scree_lbvh_build_args *a, scree_lbvh_node *nodes, int32_t k, int64_t first,
                                 int64_t last)
{
    const int32_t num_nodes = (int32_t)(2 * a->num_leaves - 1), next = (int32_t)(k + 2 * (last - first) + 1);
    nodes[k].escape = next < num_nodes ? next : SCREE_LBVH_END;
    if (first == last)
    {
        nodes[k].first_child = -1 - a->items[first];
        nodes[k].box = a->boxes[a->items[first]];
        return k + 1;
    }
    // the highest bit in which the ends differ, of the code or, if the codes are equal, of the index
    uint64_t difference = a->codes[first] ^ a->codes[last];
    const bool is_equal = difference == 0;
    if (is_equal) difference = (uint64_t)(first ^ last);
    uint64_t bit = (uint64_t)1 << 63;
    while ((difference & bit) == 0) bit >>= 1;
    int64_t split = first;
    while (((is_equal ? (uint64_t)(split + 1) : a->codes[split + 1]) & bit) == 0) ++split;
    const int32_t right = build_recursively(a, nodes, k + 1, first, split);
    nodes[k].first_child = k + 1;
    build_recursively(a, nodes, right, split + 1, last);
    nodes[k].box = scree_box_union(nodes[k + 1].box, nodes[right].box);
    return next;
}

/// Arrays of a build of n leaves; free with destroy_args().
static scree_lbvh_build_args create_args(int64_t n)
{
    scree_lbvh_build_args args = {0};
    args.codes = scree_test_alloc(n, sizeof *args.codes);
    args.items = scree_test_alloc(n, sizeof *args.items);
    args.first_leaf = scree_test_alloc(n, sizeof *args.first_leaf);
    args.last_leaf = scree_test_alloc(n, sizeof *args.last_leaf);
    args.num_left_turns = scree_test_alloc(n, sizeof *args.num_left_turns);
    args.arrivals = scree_test_alloc(n, sizeof *args.arrivals);
    args.nodes = scree_test_alloc(2 * n, sizeof *args.nodes);
    args.num_leaves = n;
    return args;
}

static void destroy_args(scree_lbvh_build_args *args)
{
    free(args->codes);
    free(args->items);
    free(args->first_leaf);
    free(args->last_leaf);
    free(args->num_left_turns);
    free(args->arrivals);
    free(args->nodes);
}

/// Kernels in every order and with blocks of leaves of any size, against the recursive build, bit for bit.
static void check_hierarchy(scree_lbvh_build_args args)
{
    const int64_t n = args.num_leaves;
    const int64_t block_leaves[SCREE_TEST_NUM_ORDERS] = {1, 1, 3, 256, 7};
    scree_lbvh_node *expected = scree_test_alloc(2 * n, sizeof *expected);
    build_recursively(&args, expected, 0, 0, n - 1);
    for (int order = 0; order < SCREE_TEST_NUM_ORDERS; ++order)
    {
        args.block_leaves = block_leaves[order];
        memset(args.nodes, 0, (size_t)(2 * n - 1) * sizeof *args.nodes);
        SCREE_LAUNCH_IN_ORDER(scree_lbvh_hierarchy, args, n - 1, order);
        const int64_t num_blocks = (n + args.block_leaves - 1) / args.block_leaves;
        SCREE_LAUNCH_IN_ORDER(scree_lbvh_left_turns, args, num_blocks, order);
        SCREE_LAUNCH_IN_ORDER(scree_lbvh_nodes, args, num_blocks, order);
        SCREE_CHECK(memcmp(args.nodes, expected, (size_t)(2 * n - 1) * sizeof *expected) == 0);
        for (int64_t r = 0; r < n; ++r)
            if (args.arrivals[r] != 0) SCREE_CHECK_INT(args.arrivals[r], 0);
    }
    free(expected);
}

static int compare_codes(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

static void test_same_tree_as_recursive_build(void)
{
    const int64_t sizes[] = {1, 2, 3, 4, 5, 8, 31, 32, 33, 257, 700};
    const uint64_t masks[] = {UINT64_MAX >> 1, 0xf, 0, 0x7000000000000001u}; // few bits: many equal codes
    uint64_t state = 2;
    for (int s = 0; s < (int)(sizeof sizes / sizeof *sizes); ++s)
    {
        scree_lbvh_build_args args = create_args(sizes[s]);
        scree_box *boxes = scree_test_make_boxes(&ordinary, sizes[s], &state);
        args.boxes = boxes;
        for (int m = 0; m < (int)(sizeof masks / sizeof *masks); ++m)
        {
            for (int64_t i = 0; i < sizes[s]; ++i)
            {
                args.codes[i] = scree_test_random_bits(&state) & masks[m];
                args.items[i] = (int32_t)((i * 7919 + 3) % sizes[s]); // 7919 is prime and divides none of the sizes
            }
            qsort(args.codes, (size_t)sizes[s], sizeof *args.codes, compare_codes);
            check_hierarchy(args);
        }
        free(boxes);
        destroy_args(&args);
    }
}

/// The deepest tree there can be: every code has one more leading one than that before, then equal codes by index.
static void test_deepest_tree(void)
{
    const int64_t n = 63 + 40;
    scree_lbvh_build_args args = create_args(n);
    uint64_t state = 3;
    scree_box *boxes = scree_test_make_boxes(&ordinary, n, &state);
    args.boxes = boxes;
    for (int64_t i = 0; i < n; ++i)
    {
        const int64_t num_ones = i < 63 ? i : 63;
        args.codes[i] = (((uint64_t)1 << num_ones) - 1) << (63 - num_ones);
        args.items[i] = (int32_t)i;
    }
    check_hierarchy(args);
    free(boxes);
    destroy_args(&args);
}

static void check_valid(const scree_lbvh *tree, const scree_box *boxes, int64_t num)
{
    scree_report report = {0};
    SCREE_CHECK(scree_lbvh_validate(tree, boxes, num, &report));
    for (int m = 0; m < report.num_messages; ++m) printf("    %s\n", report.messages[m]);
    scree_report_clear(&report);
}

/// All overlaps of a query, against every box.
static void check_query(const scree_lbvh *tree, const scree_box *boxes, int64_t num, scree_box query)
{
    char *is_found = scree_test_alloc(num, 1);
    int64_t num_twice = 0, num_wrong = 0;
    int32_t next = tree->view.root;
    for (;;)
    {
        const int32_t item = scree_lbvh_next_overlap(tree->view, query, next, &next);
        if (item < 0) break;
        num_twice += is_found[item]++;
    }
    SCREE_CHECK_INT(next, SCREE_LBVH_END);
    for (int64_t i = 0; i < num; ++i) num_wrong += is_found[i] != scree_box_overlaps(boxes[i], query);
    SCREE_CHECK_INT(num_twice, 0);
    SCREE_CHECK_INT(num_wrong, 0);
    free(is_found);
}

static void test_few_leaves(void)
{
    uint64_t state = 4;
    scree_box *boxes = scree_test_make_boxes(&ordinary, 20, &state);
    scree_lbvh tree = {0};
    for (int64_t n = 20; n >= 0; --n)
    {
        SCREE_CHECK(scree_lbvh_build(&tree, boxes, n) == SCREE_OK);
        SCREE_CHECK_INT(tree.view.num_leaves, n);
        SCREE_CHECK_INT(tree.view.root, n > 0 ? 0 : SCREE_LBVH_END);
        SCREE_CHECK((tree.view.nodes != NULL) == (n > 0));
        check_valid(&tree, boxes, n);
        for (int64_t i = 0; i < 20; ++i) check_query(&tree, boxes, n, boxes[i]);
        SCREE_CHECK(!scree_lbvh_meets_sphere(tree.view, scree_vec3_make(100, 0, 0), 50));
        SCREE_CHECK(scree_lbvh_meets_sphere(tree.view, scree_vec3_make(100, 0, 0), 150) == (n > 0));
        scree_lbvh_refit(&tree, boxes);
        check_valid(&tree, boxes, n);
    }
    scree_lbvh_destroy(&tree);
    scree_lbvh_destroy(&tree); // a destroyed tree is an empty one
    SCREE_CHECK_INT(tree.view.root, SCREE_LBVH_END);
    free(boxes);
}

/// Boxes on which the code says little or nothing.
static void test_degenerate_boxes(void)
{
    const scree_test_boxes kinds[] = {
        {.extent = 0, .smallest = 1, .largest = 1, .elongation = 1},              // all equal
        {.extent = 8, .smallest = 0.5, .largest = 1, .elongation = 1, .grid = 4}, // flat, and many equal ones
        {.extent = 1e-300, .smallest = 1e-301, .largest = 1e-300, .elongation = 10},
        {.extent = 5e-324, .smallest = 5e-324, .largest = 1e-323, .elongation = 1},
        {.extent = 1e308, .smallest = 1e300, .largest = 5e307, .elongation = 100},
        {.extent = 1, .smallest = 1e-12, .largest = 1e6, .elongation = 1e6},
    };
    for (int kind = 0; kind < (int)(sizeof kinds / sizeof *kinds); ++kind)
    {
        uint64_t state = (uint64_t)kind + 5;
        scree_box *boxes = scree_test_make_boxes(kinds + kind, 600, &state);
        scree_lbvh tree = {0};
        SCREE_CHECK(scree_lbvh_build(&tree, boxes, 600) == SCREE_OK);
        check_valid(&tree, boxes, 600);
        for (int64_t i = 0; i < 50; ++i) check_query(&tree, boxes, 600, boxes[i]);
        scree_lbvh_destroy(&tree);
        free(boxes);
    }
}

/// Equal codes are split by index, so the tree of n equal boxes has the depth of a balanced one.
static void test_equal_boxes_are_balanced(void)
{
    enum
    {
        NUM = 1000,
        MAX_DEPTH = 11 // root at 1, and 2^10 >= 1000
    };
    scree_box *boxes = scree_test_alloc(NUM, sizeof *boxes);
    scree_lbvh tree = {0};
    SCREE_CHECK(scree_lbvh_build(&tree, boxes, NUM) == SCREE_OK);
    check_valid(&tree, boxes, NUM);
    int *depth = scree_test_alloc(2 * NUM, sizeof *depth);
    int deepest = 0;
    depth[0] = 1;
    for (int32_t k = 0; k < 2 * NUM - 1; ++k)
    {
        deepest = depth[k] > deepest ? depth[k] : deepest;
        if (tree.view.nodes[k].first_child < 0) continue;
        depth[k + 1] = depth[tree.view.nodes[k + 1].escape] = depth[k] + 1;
    }
    SCREE_CHECK(deepest <= MAX_DEPTH);
    free(depth);
    scree_lbvh_destroy(&tree);
    free(boxes);
}

static void test_refit(void)
{
    enum
    {
        NUM = 3000
    };
    uint64_t state = 6;
    scree_box *boxes = scree_test_make_boxes(&ordinary, NUM, &state);
    scree_box *moved = scree_test_make_boxes(&ordinary, NUM, &state);
    scree_lbvh tree = {0};
    SCREE_CHECK(scree_lbvh_build(&tree, boxes, NUM) == SCREE_OK);
    scree_lbvh_node *before = scree_test_alloc(2 * NUM, sizeof *before);
    memcpy(before, tree.view.nodes, (2 * NUM - 1) * sizeof *before);

    scree_lbvh_refit(&tree, moved);
    check_valid(&tree, moved, NUM);
    int64_t num_changed_links = 0;
    for (int32_t k = 0; k < 2 * NUM - 1; ++k)
        num_changed_links +=
            tree.view.nodes[k].first_child != before[k].first_child || tree.view.nodes[k].escape != before[k].escape;
    SCREE_CHECK_INT(num_changed_links, 0);
    scree_lbvh_refit(&tree, boxes);
    SCREE_CHECK(memcmp(before, tree.view.nodes, (2 * NUM - 1) * sizeof *before) == 0);
    free(before);
    scree_lbvh_destroy(&tree);
    free(boxes);
    free(moved);
}

/// Spheres against all boxes. The squares may be rounded: radii at which that could matter are left out.
static void test_spheres(void)
{
    enum
    {
        NUM = 300
    };
    uint64_t state = 7;
    scree_box *boxes = scree_test_make_boxes(&ordinary, NUM, &state);
    scree_lbvh tree = {0};
    SCREE_CHECK(scree_lbvh_build(&tree, boxes, NUM) == SCREE_OK);
    int num_met = 0, num_wrong = 0;
    for (int n = 0; n < 2000; ++n)
    {
        const scree_box at = scree_test_box(&ordinary, &state);
        const long double radius = scree_test_size(&state, 0.01, 1);
        long double nearest = INFINITY;
        for (int i = 0; i < NUM; ++i)
        {
            const scree_real p[3] = {at.lower.x, at.lower.y, at.lower.z};
            const scree_real a[3] = {boxes[i].lower.x, boxes[i].lower.y, boxes[i].lower.z};
            const scree_real b[3] = {boxes[i].upper.x, boxes[i].upper.y, boxes[i].upper.z};
            long double sum = 0;
            for (int k = 0; k < 3; ++k)
            {
                const long double gap = p[k] < a[k]   ? (long double)a[k] - p[k]
                                        : p[k] > b[k] ? (long double)p[k] - b[k]
                                                      : 0;
                sum += gap * gap;
            }
            nearest = sum < nearest ? sum : nearest;
        }
        if (fabsl(sqrtl(nearest) - radius) < 16 * SCREE_REAL_EPSILON) continue;
        num_met += sqrtl(nearest) < radius;
        num_wrong += scree_lbvh_meets_sphere(tree.view, at.lower, (scree_real)radius) != (sqrtl(nearest) < radius);
    }
    SCREE_CHECK_INT(num_wrong, 0);
    SCREE_CHECK(num_met > 200 && num_met < 1800); // both answers were asked for
    scree_lbvh_destroy(&tree);
    free(boxes);
}

static void test_same_bits_for_any_number_of_threads(void)
{
    enum
    {
        NUM = 50000
    };
    const scree_test_boxes kind = {.extent = 40, .smallest = 0.01, .largest = 10, .elongation = 50};
    uint64_t state = 8;
    scree_box *boxes = scree_test_make_boxes(&kind, NUM, &state);
    scree_lbvh trees[3] = {0};
    const int num_threads[3] = {1, 2, 7};
    for (int t = 0; t < 3; ++t)
    {
        omp_set_num_threads(num_threads[t]);
        SCREE_CHECK(scree_lbvh_build(trees + t, boxes, NUM) == SCREE_OK);
        SCREE_CHECK(memcmp(trees[0].view.nodes, trees[t].view.nodes, (2 * NUM - 1) * sizeof(scree_lbvh_node)) == 0);
        scree_lbvh_refit(trees + t, boxes);
        SCREE_CHECK(memcmp(trees[0].view.nodes, trees[t].view.nodes, (2 * NUM - 1) * sizeof(scree_lbvh_node)) == 0);
    }
    check_valid(trees, boxes, NUM);
    for (int t = 0; t < 3; ++t) scree_lbvh_destroy(trees + t);
    free(boxes);
}

/// Breaks one node after the other in every way and asks the check to see it.
static void test_validation_sees_faults(void)
{
    enum
    {
        NUM = 12
    };
    uint64_t state = 9;
    scree_box *boxes = scree_test_make_boxes(&ordinary, NUM, &state);
    scree_lbvh tree = {0};
    SCREE_CHECK(scree_lbvh_build(&tree, boxes, NUM) == SCREE_OK);
    scree_lbvh_node *nodes = scree_test_alloc(2 * NUM, sizeof *nodes);
    scree_lbvh broken = tree;
    broken.view.nodes = nodes;
    for (int32_t k = 0; k < 2 * NUM - 1; ++k)
    {
        for (int fault = 0; fault < 6; ++fault)
        {
            memcpy(nodes, tree.view.nodes, (2 * NUM - 1) * sizeof *nodes);
            if (fault == 0) nodes[k].box.lower.y -= 1;
            if (fault == 1) nodes[k].box.upper.z -= (scree_real)1e-3;
            if (fault == 2) nodes[k].escape = nodes[k].escape == SCREE_LBVH_END ? k : nodes[k].escape + 1;
            if (fault == 3) nodes[k].escape = nodes[k].escape == 1 ? SCREE_LBVH_END : 1;
            if (fault == 4) nodes[k].first_child = nodes[k].first_child < 0 ? -1 - NUM : k;
            if (fault == 5)
                nodes[k].first_child = nodes[k].first_child == -1 ? -2 : -1; // an item twice, or a lost child
            scree_report report = {0};
            SCREE_CHECK(!scree_lbvh_validate(&broken, boxes, NUM, &report));
            SCREE_CHECK_INT(report.num_messages, 1);
            scree_report_clear(&report);
        }
    }
    SCREE_CHECK(!scree_lbvh_validate(&tree, boxes, NUM - 1, NULL)); // not the tree of these boxes
    free(nodes);
    scree_lbvh_destroy(&tree);
    free(boxes);
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HAS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HAS_SANITIZER 1
#endif
#endif

/// A refused build leaves the tree as it was. Under a sanitizer, which needs the address space, only the first half.
static void test_refusals(void)
{
    uint64_t state = 10;
    scree_box *boxes = scree_test_make_boxes(&ordinary, 100, &state);
    scree_lbvh tree = {0};
    SCREE_CHECK(scree_lbvh_build(&tree, boxes, 100) == SCREE_OK);
    SCREE_CHECK(scree_lbvh_build(&tree, boxes, ((int64_t)1 << 30) + 1) == SCREE_TOO_MANY);
    check_valid(&tree, boxes, 100);
#ifndef HAS_SANITIZER
    struct rlimit kept, limit;
    SCREE_CHECK(getrlimit(RLIMIT_AS, &kept) == 0);
    limit = kept;
    limit.rlim_cur = (rlim_t)2 << 30;
    SCREE_CHECK(setrlimit(RLIMIT_AS, &limit) == 0);
    SCREE_CHECK(scree_lbvh_build(&tree, boxes, (int64_t)1 << 30) == SCREE_OUT_OF_MEMORY);
    const int64_t too_large = (int64_t)(limit.rlim_cur / (3 * sizeof(scree_lbvh_node)) + 1); // its nodes, with slack
    SCREE_CHECK(scree_lbvh_build(&tree, boxes, too_large) == SCREE_OUT_OF_MEMORY);           // other arrays fit
    SCREE_CHECK(setrlimit(RLIMIT_AS, &kept) == 0);
    check_valid(&tree, boxes, 100);
    scree_lbvh_refit(&tree, boxes);
    check_valid(&tree, boxes, 100);
#endif
    scree_lbvh_destroy(&tree);
    free(boxes);
}

int main(void)
{
    SCREE_RUN(test_example_of_karras);
    SCREE_RUN(test_same_tree_as_recursive_build);
    SCREE_RUN(test_deepest_tree);
    SCREE_RUN(test_few_leaves);
    SCREE_RUN(test_degenerate_boxes);
    SCREE_RUN(test_equal_boxes_are_balanced);
    SCREE_RUN(test_refit);
    SCREE_RUN(test_spheres);
    SCREE_RUN(test_same_bits_for_any_number_of_threads);
    SCREE_RUN(test_validation_sees_faults);
    SCREE_RUN(test_refusals);
    return SCREE_TEST_END();
}
