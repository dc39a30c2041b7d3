// Large triangles of a tile that are drawn nearest first.
#include <gtest/gtest.h>

#include <array>

#include "raster/tile/draw_order.h"

namespace burnish {
namespace {

// Triangles of one tile of 64 x 64 pixels with its corner at (0, 0).
struct draw_order : ::testing::Test {
    static constexpr std::size_t kRoom = 64 * 64;
    std::array<float, kRoom> red;
    std::array<std::int32_t, kRoom> order, pixels;
    std::array<TriangleSetup, 64> triangles;
    std::array<std::uint32_t, 64> singly;
    std::array<MaterialRecord, 2> materials = {};
    std::uint32_t count = 0;

    // Adds half of the square at (x, y) with `side` pixels. Greater depths are nearer.
    void add(int x, int y, int side, float depth, int material = 0)
    {
        TriangleSetup& t = triangles[count];
        const int size = side * kSubpixel, x0 = x * kSubpixel, y0 = y * kSubpixel;
        t = {{x0, x0 + size, x0}, {y0, y0, y0 + size}, {1, 1, 1}, {depth, depth, depth}, {}, material << 2};
        singly[count] = count;
        ++count;
    }
    bool sorts()
    {
        materials[1].alpha_mode = kAlpha_mask;
        FrameParams f = {};
        f.tile_size = 64, f.materials = materials.data();
        TileScratch s = {};
        s.red = red.data(), s.order = order.data(), s.fragment_pixel = pixels.data();
        s.triangles = triangles.data(), s.drawn_singly = singly.data();
        return front_to_back(f, s, count, 0, 0);
    }
};

TEST_F(draw_order, what_hides_the_rest_comes_first)
{
    for (int layer = 0; layer < 6; ++layer)
        add(0, 0, 64, 0.1f * static_cast<float>(layer % 3 + 1));
    ASSERT_TRUE(sorts());
    for (std::uint32_t i = 0; i < count; ++i) // equal ones keep their order
        EXPECT_EQ(singly[i], (std::array<std::uint32_t, 6>{2, 5, 1, 4, 0, 3})[i]) << i;
}

TEST_F(draw_order, what_hides_little_stays_in_turn)
{
    for (int i = 0; i < 16; ++i)
        add(i % 4 * 16, i / 4 * 16, 16, 0.01f * static_cast<float>(i + 1));
    EXPECT_FALSE(sorts());
    for (std::uint32_t i = 0; i < count; ++i)
        EXPECT_EQ(singly[i], i);
}

TEST_F(draw_order, what_lies_beyond_the_tile_hides_nothing_in_it)
{
    for (int i = 0; i < 6; ++i)
        add(48, 48, 640, 0.01f * static_cast<float>(i + 1)); // a sixteenth of the tile each
    EXPECT_FALSE(sorts());
}

TEST_F(draw_order, tested_alpha_is_asked_for_last)
{
    for (int i = 0; i < 16; ++i)
        add(i % 4 * 16, i / 4 * 16, 16, 0.01f * static_cast<float>(i + 1), 1);
    EXPECT_TRUE(sorts());
    EXPECT_EQ(singly[0], 15u);
}

TEST_F(draw_order, what_is_in_order_stays)
{
    for (int layer = 0; layer < 6; ++layer)
        add(0, 0, 64, 1.0f - 0.1f * static_cast<float>(layer));
    EXPECT_FALSE(sorts());
}

} // namespace
} // namespace burnish
