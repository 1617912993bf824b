/// \file gather_cpu.c
/// Forces on particles on the CPU: the sums of gather_kernel.h, in two steps for a block of particles. The first walks
/// over the rows, writes down the contacts and asks for their memory; which of the candidate pairs touch cannot be
/// foreseen, so it has no branch on that. The second adds up.
#include "forces/forces.h"

SCREE_DEFINE_LAUNCH_ON(scree_gather)

enum
{
    BLOCK_PARTICLES = 32,
    MAX_ENDS = 1024
};

/// The contacts of a block of particles.
typedef struct scree_gather_block
{
    int64_t contacts[MAX_ENDS + 1];
    int32_t end[BLOCK_PARTICLES]; ///< of the contacts of each particle
} scree_gather_block;

static void ask_for_contact(const scree_contact_list *list, int64_t c)
{
    __builtin_prefetch(list->normal_force + c);
    __builtin_prefetch(list->tangential_force + c);
    __builtin_prefetch(list->arm + c);
    __builtin_prefetch(list->bodies + c);
}

/// Contacts of particle i, from the place `num` on; returns the place after them, beyond MAX_ENDS if there is no room.
static int32_t collect(scree_gather_block *block, const scree_gather_args *a, int64_t i, int32_t num)
{
    const int64_t begin = a->row_begin[i], end = a->row_begin[i + 1];
    if (num + (end - begin) > MAX_ENDS) return MAX_ENDS + 1;
    for (int64_t k = begin; k < end; ++k)
    {
        const int32_t p = a->row_pairs[k];
        const int64_t first = a->contacts.first_of_pair[p], count = a->contacts.first_of_pair[p + 1] - first;
        block->contacts[num] = first;
        ask_for_contact(&a->contacts, first);
        num += count > 0;
        if (count < 2) continue;
        if (num + count + (end - k) > MAX_ENDS) return MAX_ENDS + 1;
        for (int64_t c = 1; c < count; ++c) block->contacts[num++] = first + c;
    }
    return num;
}

/// Particles first .. end - 1, as far as the block has room; returns the next one.
static int64_t gather_block(scree_gather_block *block, const scree_gather_args *a, int64_t first, int64_t end)
{
    int64_t i = first;
    for (int32_t num = 0; i < end; ++i)
    {
        num = collect(block, a, i, num);
        if (num > MAX_ENDS) break;
        block->end[i - first] = num;
    }
    int32_t n = 0;
    for (int64_t k = first; k < i; ++k)
    {
        scree_vec3 force = scree_vec3_scale(a->gravity, a->mass[k]);
        scree_vec3 torque = scree_vec3_zero();
        for (; n < block->end[k - first]; ++n) scree_gather_contact(a, block->contacts[n], k, &force, &torque);
        a->force[k] = force;
        a->torque[k] = torque;
    }
    if (i > first) return i;
    scree_gather_at(*a, first); // more contacts than a block holds
    return first + 1;
}

void scree_gather_launch(scree_gather_args args, int64_t num)
{
    const int64_t num_blocks = (num + BLOCK_PARTICLES - 1) / BLOCK_PARTICLES;
#pragma omp parallel for schedule(static) if (num >= SCREE_LAUNCH_MIN)
    for (int64_t b = 0; b < num_blocks; ++b)
    {
        scree_gather_block block;
        const int64_t end = (b + 1) * BLOCK_PARTICLES < num ? (b + 1) * BLOCK_PARTICLES : num;
        for (int64_t i = b * BLOCK_PARTICLES; i < end;) i = gather_block(&block, &args, i, end);
    }
}
