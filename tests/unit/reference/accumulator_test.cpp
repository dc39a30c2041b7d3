#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "raster/reference/accumulator.h"

namespace burnish::test {
namespace {

TEST(accumulator, student_t_is_the_table_s)
{
    // Abramowitz and Stegun, table 26.10
    const std::pair<std::uint32_t, double> table[] = {{1, 12.706}, {4, 2.776},  {5, 2.571},  {7, 2.365},
                                                      {10, 2.228}, {30, 2.042}, {120, 1.980}};
    for (const auto& [degrees, t] : table)
        EXPECT_NEAR(student_t_975(degrees), t, 1.2e-3 * t) << degrees;
    EXPECT_TRUE(std::isinf(student_t_975(0)));
}

TEST(accumulator, blocks_cover_every_pixel_once)
{
    const Accumulator a(37, 21);
    std::vector<int> seen(37 * 21);
    for (std::size_t i = 0; i < a.passes.size(); ++i) {
        const PixelBlock b = block_of(a, i, 3);
        EXPECT_EQ(b.passes, 3u);
        for (int y = b.y0; y < b.y0 + b.height; ++y)
            for (int x = b.x0; x < b.x0 + b.width; ++x)
                ++seen[static_cast<std::size_t>(y * 37 + x)];
    }
    for (int n : seen)
        EXPECT_EQ(n, 1);
}

TEST(accumulator, columns_of_a_part_have_its_rows)
{
    // 37x21 pixels are 5x3 blocks; the last rows are 5 pixels high
    const struct {
        std::size_t first, count, first_pixel, pixels;
    } parts[] = {{0, 15, 0, 37 * 21}, {0, 5, 0, 37 * 8}, {4, 2, 0, 37 * 16}, {5, 1, 37 * 8, 37 * 8}, {14, 1, 37 * 16, 37 * 5}};
    for (const auto& part : parts) {
        Accumulator a(37, 21);
        hold_blocks(a, part.first, part.count);
        EXPECT_EQ(a.first_pixel, part.first_pixel) << part.first;
        EXPECT_EQ(a.pixels, part.pixels) << part.first;
        reserve_sums(a, 5);
        EXPECT_EQ(a.sums[2].size(), part.pixels) << part.first;
        EXPECT_EQ(block_of(a, part.first, 1).first_pixel, part.first_pixel);
    }
}

TEST(accumulator, variance_is_that_of_the_mean_and_its_interval_student_s)
{
    Accumulator a(1, 1);
    a.passes[0] = 5; // values 1 2 3 4 5: mean 3, squared differences 10
    reserve_sums(a, 5);
    for (int c = 0; c < 3; ++c) {
        a.sums[2][0].mean[c] = 2.5, a.sums[2][0].m2[c] = 5.0;
        a.sums[0][0].mean[c] = 5.0;
    }
    EXPECT_FLOAT_EQ(variance_image(a).f32()[1], 0.5f); // 10 / 4 / 5
    EXPECT_NEAR(mean_relative_error(a), 2.7764 * std::sqrt(0.5) / 3.0, 1e-4);
    a.passes[0] = 1;
    EXPECT_TRUE(std::isinf(mean_relative_error(a)));
    EXPECT_TRUE(std::isinf(variance_image(a).f32()[0]));
    a.sums[0][0] = {};
    EXPECT_EQ(mean_relative_error(a), 0.0); // black pixels have no relative error
}

// Returns a value of a pass: far from zero, with a small spread, as pixels have it.
double value_of(std::uint32_t pass)
{
    return 1e3 + std::sin(static_cast<double>(pass) * 12.9898) * 1e-3;
}

void add_values(PixelState* sums, std::uint32_t& passes, std::uint32_t until)
{
    for (; passes < until; ++passes) {
        PixelState next = {};
        for (double& mean : next.mean)
            mean = value_of(passes);
        add_sum(sums, passes, 0, next);
    }
}

TEST(accumulator, a_tree_of_sums_keeps_mean_and_spread_of_a_million_passes)
{
    constexpr std::uint32_t kPasses = 1000003;
    Accumulator a(1, 1);
    reserve_sums(a, kPasses);
    PixelState sums[kMostSums];
    std::uint32_t passes = 0;
    add_values(sums, passes, kPasses);
    for (int k = 0; k < kMostSums; ++k)
        if (kPasses >> k & 1u)
            a.sums[static_cast<std::size_t>(k)][0] = sums[k];
    a.passes[0] = kPasses;
    long double mean = 0.0L, m2 = 0.0L;
    for (std::uint32_t pass = 0; pass < kPasses; ++pass)
        mean += static_cast<long double>(value_of(pass)) / kPasses;
    for (std::uint32_t pass = 0; pass < kPasses; ++pass)
        m2 += (static_cast<long double>(value_of(pass)) - mean) * (static_cast<long double>(value_of(pass)) - mean);
    const PixelState state = state_of_pixel(a, 0);
    EXPECT_NEAR(state.mean[0], static_cast<double>(mean), 1e-11);
    EXPECT_NEAR(state.m2[0] / static_cast<double>(m2), 1.0, 1e-9);
}

TEST(accumulator, sums_of_any_aligned_shares_have_the_bits_of_one_run)
{
    constexpr std::uint32_t kPasses = 16 + 8 + 3;
    PixelState whole[kMostSums] = {}, shared[kMostSums] = {};
    std::uint32_t passes = 0;
    add_values(whole, passes, kPasses);
    for (const auto& [first, k] : {std::pair{0u, 4}, {16u, 2}, {20u, 1}, {22u, 1}, {24u, 1}, {26u, 0}}) {
        PixelState own[kMostSums] = {};
        for (std::uint32_t pass = 0; pass < 1u << k; ++pass) {
            PixelState next = {};
            for (double& mean : next.mean)
                mean = value_of(first + pass);
            add_sum(own, pass, 0, next);
        }
        add_sum(shared, first, k, own[k]);
    }
    for (int k = 0; k < kMostSums; ++k)
        if (kPasses >> k & 1u) {
            EXPECT_EQ(shared[k].mean[0], whole[k].mean[0]) << k;
            EXPECT_EQ(shared[k].m2[0], whole[k].m2[0]) << k;
        }
}

} // namespace
} // namespace burnish::test
