#include "core/permute.h"

SCREE_DEFINE_LAUNCH(scree_permute)

void scree_permute(scree_device *device, void *items, size_t size, const int32_t *order, int64_t num, void *scratch)
{
    if (items == NULL || num == 0) return;
    const scree_permute_args args = {items, scratch, order, (int64_t)size};
    scree_permute_launch_on(device, args, num);
    scree_device_copy(device, items, scratch, (size_t)num * size);
}
