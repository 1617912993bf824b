/// The state hash against the published test vectors of FNV-1a and by its own promises.
#include "core/hash.h"
#include "harness.h"

/// FNV-1a 64 as its authors publish it, from scree's value: the same but for the offset basis.
static uint64_t fnv_1a(const char *text) { return scree_hash_bytes(0, text, strlen(text)) ^ 0xcbf29ce484222325u; }

/// http://www.isthe.com/chongo/src/fnv/test_fnv.c, vectors without the final zero byte.
static void published_vectors(void)
{
    SCREE_CHECK(fnv_1a("") == 0xcbf29ce484222325u);
    SCREE_CHECK(fnv_1a("a") == 0xaf63dc4c8601ec8cu);
    SCREE_CHECK(fnv_1a("foobar") == 0x85944171f73967e8u);
}

static void parts_give_the_hash_of_the_whole(void)
{
    unsigned char bytes[257];
    uint64_t state = 1;
    for (size_t i = 0; i < sizeof bytes; ++i) bytes[i] = (unsigned char)scree_test_random_bits(&state);
    const uint64_t whole = scree_hash_bytes(0, bytes, sizeof bytes);
    for (size_t cut = 0; cut <= sizeof bytes; ++cut)
    {
        const uint64_t first = scree_hash_bytes(0, bytes, cut);
        SCREE_CHECK(scree_hash_bytes(first, bytes + cut, sizeof bytes - cut) == whole);
    }
    SCREE_CHECK(scree_hash_bytes(0, NULL, 0) == 0);
    SCREE_CHECK(scree_hash_bytes(whole, NULL, 0) == whole);
}

static void every_bit_and_the_length_count(void)
{
    unsigned char bytes[32] = {0};
    const uint64_t zeros = scree_hash_bytes(0, bytes, sizeof bytes);
    for (size_t bit = 0; bit < 8 * sizeof bytes; ++bit)
    {
        bytes[bit / 8] ^= (unsigned char)(1u << (bit % 8));
        SCREE_CHECK(scree_hash_bytes(0, bytes, sizeof bytes) != zeros);
        bytes[bit / 8] ^= (unsigned char)(1u << (bit % 8));
    }
    for (size_t length = 0; length < sizeof bytes; ++length)
        SCREE_CHECK(scree_hash_bytes(0, bytes, length) != scree_hash_bytes(0, bytes, length + 1));
    const double plus = 0.0, minus = -0.0;
    SCREE_CHECK(scree_hash_bytes(0, &plus, sizeof plus) != scree_hash_bytes(0, &minus, sizeof minus));
}

int main(void)
{
    SCREE_RUN(published_vectors);
    SCREE_RUN(parts_give_the_hash_of_the_whole);
    SCREE_RUN(every_bit_and_the_length_count);
    return SCREE_TEST_END();
}
