// Counting lanes against known work.
#include <gtest/gtest.h>

#include "tests/unit/simd/counted_ops.h"

namespace burnish {
namespace {

void expect(const CountedWork& work, unsigned operations, unsigned bytes, float value)
{
    EXPECT_EQ(work.operations, operations);
    EXPECT_EQ(work.bytes, bytes);
    EXPECT_EQ(work.value, value);
}

TEST(counted, dot_product_is_three_products_and_two_sums)
{
    expect(count_dot(), 5, 24, 32.0f);
}
TEST(counted, division_root_and_difference_are_one_each)
{
    expect(count_root(), 3, 0, 1.0f);
}
TEST(counted, what_is_not_arithmetic_is_not_counted)
{
    expect(count_uncounted(), 0, 0, -6.0f);
}
// One channel of the left and right texels: two products and their sum, added to the previous value.
TEST(counted, a_bilinear_footprint_is_its_products_and_sums)
{
    expect(count_texel_add(), 2 * 4 * 4, 32, 0.5f);
}

} // namespace
} // namespace burnish
