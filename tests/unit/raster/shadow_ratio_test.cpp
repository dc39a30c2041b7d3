// The filter of stochastic shadows: exact properties, and edges that the filter does not cross.
#include <gtest/gtest.h>

#include <cmath>

#include "raster/frame/shadow_ratio.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

constexpr int kRatioSide = 24;

enum class Edge { none, step, ridge };

// Returns a plane whose right half lies nearer or faces another direction.
Column<PixelLayers> layers_of_plane(Edge edge)
{
    Column<PixelLayers> layers(kRatioSide * kRatioSide);
    for (std::size_t i = 0; i < kRatioSide * kRatioSide; ++i) {
        const bool right = i % kRatioSide >= kRatioSide / 2;
        layers.data()[i].depth = right && edge == Edge::step ? 1.0f : 2.0f;
        layers.data()[i].normal[right && edge == Edge::ridge ? 1 : 2] = 1.0f;
    }
    return layers;
}

Image filled_by(float (*value)(int x, int y))
{
    Image image = make_image(kRatioSide, kRatioSide, 3, PixelType::f32);
    for (int i = 0; i < kRatioSide * kRatioSide * 3; ++i)
        image.f32()[i] = value(i / 3 % kRatioSide, i / 3 / kRatioSide);
    return image;
}

float noise_at(int x, int y)
{
    Random random{static_cast<std::uint64_t>(1 + x + 100 * y)};
    return random.unit();
}

Image ratio_of(const Image& shadowed, const Image& open, Edge edge)
{
    FrameDesc desc;
    desc.width = desc.height = kRatioSide;
    desc.view = make_view(glm::vec3(0.0f), glm::vec3(0.0f, 0.0f, -1.0f), 0.6f, kRatioSide, kRatioSide);
    return shadow_ratio(shadowed, open, layers_of_plane(edge), desc, Jobs(2));
}

TEST(shadow_ratio, is_one_where_nothing_is_in_the_way_and_where_there_is_no_light)
{
    for (float (*light)(int, int) : {+[](int x, int y) { return 1e-3f + noise_at(x, y); }, +[](int, int) { return 0.0f; }}) {
        const Image open = filled_by(light), ratio = ratio_of(open, open, Edge::none);
        for (int i = 0; i < kRatioSide * kRatioSide * 3; ++i)
            ASSERT_EQ(ratio.f32()[i], 1.0f) << i;
        const Image lit = filled_by([](int x, int y) { return 0.1f * static_cast<float>(x) + 0.3f * static_cast<float>(y); });
        Image same = lit;
        darken(same, lit, filled_by(noise_at), ratio);
        for (int i = 0; i < kRatioSide * kRatioSide * 3; ++i)
            ASSERT_EQ(same.f32()[i], lit.f32()[i]) << i;
    }
}

TEST(shadow_ratio, of_noise_is_its_mean_and_light_without_area_lights_stays)
{
    const Image open = filled_by([](int, int) { return 2.0f; });
    const Image ratio = ratio_of(filled_by(noise_at), open, Edge::none);
    const Image lit = filled_by([](int, int) { return 5.0f; }), unlit = filled_by([](int, int) { return 1.0f; });
    Image shaded = lit;
    darken(shaded, lit, unlit, ratio);
    for (int y = 4; y < kRatioSide - 4; ++y)
        for (int x = 4; x < kRatioSide - 4; ++x) {
            const int i = 3 * (kRatioSide * y + x);
            EXPECT_NEAR(ratio.f32()[i], 0.25f, 0.22f); // standard deviation 0.14 a pixel
            EXPECT_NEAR(shaded.f32()[i], 1.0f + 4.0f * ratio.f32()[i], 1e-6f);
        }
}

TEST(shadow_ratio, does_not_look_past_an_edge)
{
    const Image open = filled_by([](int, int) { return 1.0f; });
    const Image half = filled_by([](int x, int) { return x < kRatioSide / 2 ? 0.0f : 1.0f; });
    const Image flat = ratio_of(half, open, Edge::none);
    for (const Edge edge : {Edge::step, Edge::ridge}) {
        const Image apart = ratio_of(half, open, edge);
        for (int x = 0; x < kRatioSide; ++x) {
            const int i = 3 * (kRatioSide * (kRatioSide / 2) + x);
            EXPECT_NEAR(apart.f32()[i], half.f32()[i], 1e-6f) << x;
        }
    }
    for (const int x : {kRatioSide / 2 - 1, kRatioSide / 2}) { // on one surface it does
        const int i = 3 * (kRatioSide * (kRatioSide / 2) + x);
        EXPECT_GT(std::abs(flat.f32()[i] - half.f32()[i]), 0.1f) << x;
    }
}

} // namespace
} // namespace burnish::test
