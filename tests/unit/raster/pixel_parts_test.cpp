// Parts of pixels are in order whatever lists they come in.
#include "raster/frame/pixel_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace burnish {
namespace {

TEST(pixel_parts, are_ordered_by_pixel_and_first_sample)
{
    constexpr int kWidth = 37, kHeight = 23;
    std::mt19937 random(5);
    // Make up to four parts a pixel, in shuffled lists
    std::vector<PixelPart> all;
    for (std::uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
        for (std::uint32_t sample = 0, parts = static_cast<std::uint32_t>(random() % 5); sample < parts; ++sample)
            all.push_back(
                pixel_part(pixel, 1u << (2 * sample), sample == 1, {static_cast<float>(pixel), static_cast<float>(sample), 0.5f}));
    std::vector<PixelPart> shuffled = all;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    const std::span<const PixelPart> parts = shuffled;
    for (const std::size_t cut : {std::size_t{0}, parts.size() / 3, parts.size()}) {
        const std::span<const PixelPart> lists[] = {parts.first(cut), {}, parts.subspan(cut)};
        std::vector<PixelPart> merged(7); // of an earlier frame
        merge_parts(lists, kWidth, kHeight, Jobs(2), merged);
        ASSERT_EQ(merged.size(), all.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            EXPECT_EQ(merged[i].pixel, all[i].pixel) << i;
            EXPECT_EQ(merged[i].first, all[i].first) << i;
            EXPECT_EQ(merged[i].color, all[i].color) << i;
        }
    }
    std::vector<PixelPart> none(3);
    merge_parts({}, kWidth, kHeight, Jobs(1), none);
    EXPECT_TRUE(none.empty());
}

} // namespace
} // namespace burnish
