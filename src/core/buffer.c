#define _DEFAULT_SOURCE /* madvise */
#include "core/buffer.h"

#include <stdlib.h>
#ifdef __linux__
#include <sys/mman.h>
#endif

enum
{
    ALIGNMENT = 64,
    LARGE_PAGE = 1 << 21,
    MIN_LARGE_BYTES = 1 << 21
};

void *scree_buffer_alloc(int64_t num_items, size_t item_size)
{
    if (num_items < 0 || item_size == 0) return NULL;
    if ((uint64_t)num_items > (PTRDIFF_MAX - ALIGNMENT) / item_size) return NULL;
    const size_t num_bytes = (size_t)num_items * item_size;
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    // a step goes over dozens of arrays at once: with small pages their addresses are more than a processor remembers
    if (num_bytes >= MIN_LARGE_BYTES)
    {
        // a wish; it may be refused. What does not fill a large page lies in small ones, of which the rest stays
        // untouched
        void *memory = aligned_alloc(LARGE_PAGE, (num_bytes / LARGE_PAGE + 1) * LARGE_PAGE);
        if (memory != NULL) (void)madvise(memory, num_bytes / LARGE_PAGE * LARGE_PAGE, MADV_HUGEPAGE);
        return memory;
    }
#endif
    return aligned_alloc(ALIGNMENT, (num_bytes / ALIGNMENT + 1) * ALIGNMENT);
}

int64_t scree_buffer_grown(int64_t num_items)
{
    const int64_t extra = num_items / 4 + 16;
    return num_items > INT64_MAX - extra ? num_items : num_items + extra;
}
