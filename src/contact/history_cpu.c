#include "contact/history.h"
#include "contact/touching_pairs.h"

SCREE_DEFINE_LAUNCH_ON(scree_history_match)

void scree_history_match_launch(scree_history_match_args args, int64_t num)
{
    const int64_t num_blocks = (num + SCREE_BLOCK_PAIRS - 1) / SCREE_BLOCK_PAIRS;
#pragma omp parallel for schedule(static) if (num >= SCREE_LAUNCH_MIN)
    for (int64_t k = 0; k < num_blocks; ++k)
    {
        const int64_t begin = k * SCREE_BLOCK_PAIRS, end = begin + SCREE_BLOCK_PAIRS;
        int32_t touching[SCREE_BLOCK_PAIRS + 1];
        const int32_t num_touching =
            scree_pick_touching(args.first_of_pair, NULL, begin, end < num ? end : num, touching);
        for (int32_t n = 0; n < num_touching; ++n) scree_history_match_at(args, touching[n]);
    }
}
