// Large images: rows of bands, indices within 32 bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <climits>

#include "raster/vulkan/bands.h"

namespace burnish::test {
namespace {

TEST(bands, cover_every_row_once)
{
    for (int height : {1, 2, 7, 64, 8192})
        for (int rim : {0, kBandRim})
            for (int rows : {6, 8, 8192}) {
                int next = 0;
                for (const Band& band : bands_of(height, rows, rim)) {
                    EXPECT_EQ(band.first_row + band.own_begin, next);
                    EXPECT_GT(band.own_end, band.own_begin);
                    EXPECT_LE(band.rows, rows);
                    EXPECT_EQ(band.first_row % 2, 0) << "quads of a device must not be cut";
                    // All neighbours within the picture are drawn
                    EXPECT_LE(band.first_row, std::max(next - rim, 0));
                    next += band.own_end - band.own_begin;
                    EXPECT_GE(band.first_row + band.rows, std::min(next + rim, height));
                }
                EXPECT_EQ(next, height);
            }
}

TEST(bands, fit_whatever_the_picture)
{
    for (int width : {1, 3, 1920, 8192, 16384})
        for (std::size_t bytes : {std::size_t{12}, std::size_t{8 * 57 * 4}, kMostBytesAPixel}) {
            const int rows = band_rows(width, 16384, bytes, kBandBytes, 0);
            EXPECT_GE(rows, 2);
            EXPECT_EQ(rows % 2, 0) << "quads of a device must not be cut";
            const std::size_t used = static_cast<std::size_t>(width) * static_cast<std::size_t>(rows) * bytes;
            EXPECT_LE(used, kBandBytes);
            EXPECT_LE(used, static_cast<std::size_t>(INT_MAX)) << "indices of words";
        }
    EXPECT_EQ(band_rows(1920, 1080, 16, kBandBytes, 0), 1080) << "one band";
    EXPECT_EQ(band_rows(4, 1, 16, kBandBytes, 0), 2);
    EXPECT_EQ(band_rows(16384, 16384, kMostBytesAPixel, kBandBytes, kBandRim), 6) << "two rows beside both rims";
}

} // namespace
} // namespace burnish::test
