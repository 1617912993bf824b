/// \file broad_phase_cpu.c
/// Launches of the broad phase, and the search for pairs of particles as it is done on the CPU: not leaf by leaf, but
/// for a cluster of up to 32 neighbouring leaves at once. The tree is walked once with the box of the cluster; its
/// members are then compared with the leaves found there, which stand in a row and need no branches. A walk through a
/// tree costs mainly mispredicted branches, so this takes about half the time (docs/theory/bvh.md).
#include "bvh/bvh_launch.h"

SCREE_DEFINE_LAUNCH(scree_particle_pairs)
SCREE_DEFINE_LAUNCH_DYNAMIC(scree_wall_pairs)
SCREE_DEFINE_LAUNCH(scree_pair_unpack)
SCREE_DEFINE_LAUNCH(scree_pair_own)
SCREE_DEFINE_LAUNCH(scree_pair_second_keys)
SCREE_DEFINE_LAUNCH(scree_pair_rows)

enum
{
    MAX_MEMBERS = 32,
    MAX_LEAVES = 512, ///< of a cluster's list; a cluster that meets more is compared in several rounds
    LANES = 8,        ///< leaves compared at once
    MAX_KEYS = 2048,  ///< collected before they go to the common list
    BLOCK_NODES = 1024
};

/// The members of a cluster, followed by leaves after it that meet its box.
typedef struct scree_cluster
{
    scree_real lower[3][MAX_LEAVES + LANES];
    scree_real upper[3][MAX_LEAVES + LANES];
    int32_t items[MAX_LEAVES + LANES];
    int32_t num_members;
    int32_t num_leaves;
    scree_box others; ///< box of all that are not members
    uint64_t keys[MAX_KEYS];
    int32_t num_keys;
} scree_cluster;

/// First node after the subtree of node k.
static int32_t end_of_subtree(scree_lbvh_view tree, int32_t k)
{
    return tree.nodes[k].escape == SCREE_LBVH_END ? 2 * tree.num_leaves - 1 : tree.nodes[k].escape;
}

/// True for subtrees of at most MAX_MEMBERS leaves.
static bool is_small(scree_lbvh_view tree, int32_t k) { return end_of_subtree(tree, k) - k <= 2 * MAX_MEMBERS - 1; }

static void set_leaf(scree_cluster *c, int32_t place, scree_box box, int32_t item)
{
    c->lower[0][place] = box.lower.x;
    c->lower[1][place] = box.lower.y;
    c->lower[2][place] = box.lower.z;
    c->upper[0][place] = box.upper.x;
    c->upper[1][place] = box.upper.y;
    c->upper[2][place] = box.upper.z;
    c->items[place] = item;
}

static scree_box member_box(const scree_cluster *c, int32_t m)
{
    scree_box box;
    box.lower = scree_vec3_make(c->lower[0][m], c->lower[1][m], c->lower[2][m]);
    box.upper = scree_vec3_make(c->upper[0][m], c->upper[1][m], c->upper[2][m]);
    return box;
}

/// Largest of the six gaps between the box and each of LANES leaves, not above 0 exactly if they overlap: with
/// denormals the difference of two numbers has the sign of their order. Written so that compilers vectorise it.
static void find_gaps(const scree_cluster *restrict c, int32_t first, scree_box box, scree_real *restrict gaps)
{
    for (int32_t l = 0; l < LANES; ++l)
    {
        const scree_real x = scree_max(c->lower[0][first + l] - box.upper.x, box.lower.x - c->upper[0][first + l]);
        const scree_real y = scree_max(c->lower[1][first + l] - box.upper.y, box.lower.y - c->upper[1][first + l]);
        const scree_real z = scree_max(c->lower[2][first + l] - box.upper.z, box.lower.z - c->upper[2][first + l]);
        gaps[l] = scree_max(scree_max(x, y), z);
    }
}

/// Pairs of member m with the leaves first .. end - 1 of the list. Those that follow up to a full row of lanes are
/// compared as well, so none of them may overlap it.
static void compare_member(scree_cluster *c, const scree_particle_pairs_args *args, int32_t m, int32_t first,
                           int32_t end)
{
    const scree_box box = member_box(c, m);
    int32_t hits[MAX_LEAVES + LANES];
    int32_t num_hits = 0;
    for (int32_t l = first; l < end; l += LANES)
    {
        scree_real gaps[LANES];
        find_gaps(c, l, box, gaps);
        for (int32_t k = 0; k < LANES; ++k)
        {
            hits[num_hits] = l + k;
            num_hits += gaps[k] <= 0;
        }
    }
    if (c->num_keys + num_hits > MAX_KEYS)
    {
        scree_pair_list_append(args->list, c->keys, c->num_keys);
        c->num_keys = 0;
    }
    for (int32_t h = 0; h < num_hits; ++h)
        if (scree_spheres_overlap(args->centres, args->radii, c->items[m], c->items[hits[h]]))
            c->keys[c->num_keys++] = scree_pair_key(args->list, c->items[m], c->items[hits[h]]);
}

/// Compares the members with the leaves in the list, and in the first round with each other; then drops those leaves.
static void compare_cluster(scree_cluster *c, const scree_particle_pairs_args *args, bool is_first_round)
{
    const scree_real infinity = (scree_real)INFINITY;
    const scree_box nowhere = {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (int32_t l = 0; l < LANES; ++l) set_leaf(c, c->num_leaves + l, nowhere, 0);
    for (int32_t m = 0; m < c->num_members; ++m)
    {
        // a member away from all others needs none of them
        const bool has_others = c->num_leaves > c->num_members && scree_box_overlaps(member_box(c, m), c->others);
        compare_member(c, args, m, is_first_round ? m + 1 : c->num_members,
                       has_others ? c->num_leaves : c->num_members);
    }
    c->num_leaves = c->num_members;
    c->others = scree_box_empty();
}

/// All pairs of a leaf below node k with a leaf below it or after it.
static void find_pairs_of_cluster(scree_cluster *c, scree_particle_pairs_args args, int32_t k)
{
    const scree_lbvh_node *nodes = args.tree.nodes;
    c->num_members = 0;
    for (int32_t n = k; n < end_of_subtree(args.tree, k); ++n)
        if (nodes[n].first_child < 0) set_leaf(c, c->num_members++, nodes[n].box, -1 - nodes[n].first_child);
    c->num_leaves = c->num_members;
    c->others = scree_box_empty();

    const scree_box box = nodes[k].box;
    bool is_first_round = true;
    int32_t next = nodes[k].escape;
    while (next != SCREE_LBVH_END)
    {
        const scree_lbvh_node *node = nodes + next;
        const bool is_hit = scree_box_overlaps(node->box, box);
        next = is_hit && node->first_child >= 0 ? next + 1 : node->escape;
        if (!is_hit || node->first_child >= 0) continue;
        if (c->num_leaves == MAX_LEAVES)
        {
            compare_cluster(c, &args, is_first_round);
            is_first_round = false;
        }
        c->others = scree_box_union(c->others, node->box);
        set_leaf(c, c->num_leaves++, node->box, -1 - node->first_child);
    }
    compare_cluster(c, &args, is_first_round);
}

/// First node from `begin` on that is not within a small subtree that begins before it.
static int32_t skip_begun_cluster(scree_lbvh_view tree, int32_t begin)
{
    const int32_t farthest = begin - (2 * MAX_MEMBERS - 2);
    for (int32_t k = farthest > 0 ? farthest : 0; k < begin; ++k)
        if (is_small(tree, k) && end_of_subtree(tree, k) > begin) return end_of_subtree(tree, k);
    return begin;
}

void scree_particle_pairs_find(scree_particle_pairs_args args)
{
    const int32_t num_nodes = args.tree.num_leaves > 0 ? 2 * args.tree.num_leaves - 1 : 0;
    const int32_t num_blocks = num_nodes / BLOCK_NODES + 1;
#pragma omp parallel for schedule(dynamic, 1)
    for (int32_t b = 0; b < num_blocks; ++b)
    {
        // a cluster is a small subtree that is not part of another one; it belongs to the block where it begins
        scree_cluster cluster;
        cluster.num_keys = 0;
        const int32_t end = b + 1 < num_blocks ? (b + 1) * BLOCK_NODES : num_nodes;
        for (int32_t k = skip_begun_cluster(args.tree, b * BLOCK_NODES); k < end;)
        {
            const bool is_cluster = is_small(args.tree, k);
            if (is_cluster) find_pairs_of_cluster(&cluster, args, k);
            k = is_cluster ? end_of_subtree(args.tree, k) : k + 1;
        }
        scree_pair_list_append(args.list, cluster.keys, cluster.num_keys);
    }
}
