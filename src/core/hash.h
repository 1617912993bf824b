/// \file hash.h
/// 64-bit hash of bytes, to compare states: equal bytes have equal hashes, different ones practically never.
/// FNV-1a (Fowler, Noll & Vo), one exclusive or and one multiplication per byte. Not for keys that others can choose.
#ifndef SCREE_HASH_H
#define SCREE_HASH_H

#include <stddef.h>
#include <stdint.h>

/// Hash of everything hashed so far and these bytes; start from hash = 0. In parts or at once gives the same:
/// hash(hash(0, a), b) = hash(0, ab). The value is FNV-1a's, exclusive-or its offset basis, so that 0 means "no bytes".
uint64_t scree_hash_bytes(uint64_t hash, const void *bytes, size_t num_bytes);

#endif
