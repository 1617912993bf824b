/// Morton codes against bits taken one by one, and frames of extreme size.
#include "bvh/morton_kernel.h"
#include "harness.h"

static uint64_t encode_bit_by_bit(uint64_t x, uint64_t y, uint64_t z)
{
    uint64_t code = 0;
    for (int bit = SCREE_MORTON_BITS - 1; bit >= 0; --bit)
        code = code << 3 | (x >> bit & 1) << 2 | (y >> bit & 1) << 1 | (z >> bit & 1);
    return code;
}

static void test_interleaving(void)
{
    uint64_t state = 1, num_wrong = 0;
    for (int n = 0; n < 20000; ++n)
    {
        const uint64_t x = scree_test_random_bits(&state) >> 43, y = scree_test_random_bits(&state) >> 43;
        const uint64_t z = scree_test_random_bits(&state) >> 43;
        num_wrong += scree_morton_encode(x, y, z) != encode_bit_by_bit(x, y, z);
    }
    SCREE_CHECK_INT(num_wrong, 0);
    SCREE_CHECK_INT(scree_morton_encode(0, 0, 1), 1);
    SCREE_CHECK_INT(scree_morton_encode(0, 1, 0), 2);
    SCREE_CHECK_INT(scree_morton_encode(1, 0, 0), 4);
    SCREE_CHECK_INT(scree_morton_encode(0x1fffff, 0x1fffff, 0x1fffff), 0x7fffffffffffffff);
    SCREE_CHECK_INT(scree_morton_encode(0x200000, 0x200000, 0x200000), 0); // bits above the 21st do not spill over
}

static void test_leading_zeros(void)
{
    for (int bit = 0; bit < 64; ++bit)
    {
        SCREE_CHECK_INT(scree_count_leading_zeros((uint64_t)1 << bit), 63 - bit);
        SCREE_CHECK_INT(scree_count_leading_zeros(((uint64_t)1 << bit) * 2 - 1), 63 - bit);
    }
}

static scree_box make_box(double ax, double ay, double az, double bx, double by, double bz)
{
    scree_box box;
    box.lower = scree_vec3_make((scree_real)ax, (scree_real)ay, (scree_real)az);
    box.upper = scree_vec3_make((scree_real)bx, (scree_real)by, (scree_real)bz);
    return box;
}

/// Cells are cubes of the longest side over 2^21: in bounds of 8 x 2 x 1 the code of a point is known.
static void test_cells_are_cubes(void)
{
    const scree_morton_frame frame = scree_morton_frame_make(make_box(-4, 0, 1, 4, 2, 2));
    const uint64_t unit = 1 << 18; // cells per unit of length
    SCREE_CHECK(scree_morton_code(scree_vec3_make(-4, 0, 1), frame) == 0);
    SCREE_CHECK(scree_morton_code(scree_vec3_make(-3, 1, 2), frame) == scree_morton_encode(unit, unit, unit));
    SCREE_CHECK(scree_morton_code(scree_vec3_make(0, 0, 1), frame) == scree_morton_encode(4 * unit, 0, 0));
    SCREE_CHECK(scree_morton_code(scree_vec3_make(4, 2, 1), frame) == // the far end belongs to the last cell
                scree_morton_encode(8 * unit - 1, 2 * unit, 0));
}

/// Along a line the cell never goes back, and takes all values from first to last.
static void check_line(scree_real from, scree_real to)
{
    const scree_morton_frame frame = scree_morton_frame_make(make_box(from, 0, 0, to, 0, 0));
    uint64_t before = 0, num_wrong = 0;
    for (int k = 0; k <= 1000; ++k)
    {
        const scree_real t = (scree_real)k / 1000;
        const uint64_t cell = scree_morton_cell(from * (1 - t) + to * t, frame.half_lower.x, frame.scale);
        num_wrong += cell < before || cell > 0x1fffff;
        before = cell;
    }
    SCREE_CHECK_INT(num_wrong, 0);
    SCREE_CHECK_INT(scree_morton_cell(from, frame.half_lower.x, frame.scale), 0);
    SCREE_CHECK_INT(scree_morton_cell(to, frame.half_lower.x, frame.scale), 0x1fffff);
}

static void test_sizes_of_frames(void)
{
    check_line(0, 1);
    check_line(-SCREE_REAL_MAX, SCREE_REAL_MAX); // to - from would overflow
    check_line((scree_real)1e30, (scree_real)1.1e30);
    check_line((scree_real)-1e-30, (scree_real)1e-30);
    check_line(0, SCREE_REAL_MAX);
#ifndef SCREE_SINGLE
    check_line(0, 1e-307); // 2^21 cells of this are below the smallest normal number
#endif
}

/// No extent, not a number, outside: some cell, and no undefined conversion (which the sanitizer would report).
static void test_degenerate_frames(void)
{
    const scree_morton_frame point = scree_morton_frame_make(make_box(1, 2, 3, 1, 2, 3));
    SCREE_CHECK_INT(scree_morton_code(scree_vec3_make(1, 2, 3), point), 0);
    const scree_morton_frame frame = scree_morton_frame_make(make_box(0, 0, 0, 1, 1, 1));
    SCREE_CHECK_INT(scree_morton_code(scree_vec3_make((scree_real)NAN, -5, 0), frame), 0);
    SCREE_CHECK(scree_morton_code(scree_vec3_make((scree_real)INFINITY, 2, SCREE_REAL_MAX), frame) ==
                0x7fffffffffffffffu);
    const scree_morton_frame broken = scree_morton_frame_make(make_box(0, 0, 0, INFINITY, NAN, 1));
    SCREE_CHECK_INT(scree_morton_code(scree_vec3_make(1, 1, 1), broken), 0);
}

static void test_middle(void)
{
    const scree_vec3 middle = scree_morton_middle(make_box(-1, 2, 5, 3, 2, 6));
    SCREE_CHECK_CLOSE(middle.x, 1, 0);
    SCREE_CHECK_CLOSE(middle.y, 2, 0);
    SCREE_CHECK_CLOSE(middle.z, 5.5, 0);
    const scree_real large = SCREE_REAL_MAX;
    SCREE_CHECK(scree_morton_middle(make_box(large, 0, 0, large, 0, 0)).x == large);
}

int main(void)
{
    SCREE_RUN(test_interleaving);
    SCREE_RUN(test_leading_zeros);
    SCREE_RUN(test_cells_are_cubes);
    SCREE_RUN(test_sizes_of_frames);
    SCREE_RUN(test_degenerate_frames);
    SCREE_RUN(test_middle);
    return SCREE_TEST_END();
}
