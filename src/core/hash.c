#include "core/hash.h"

#define FNV_OFFSET_BASIS 0xcbf29ce484222325u
#define FNV_PRIME 0x100000001b3u

uint64_t scree_hash_bytes(uint64_t hash, const void *bytes, size_t num_bytes)
{
    const unsigned char *byte = bytes;
    hash ^= FNV_OFFSET_BASIS;
    for (size_t i = 0; i < num_bytes; ++i) hash = (hash ^ byte[i]) * FNV_PRIME;
    return hash ^ FNV_OFFSET_BASIS;
}
