// Groups of normals that represent a map from afar.
#include <gtest/gtest.h>

#include <cmath>

#include "shading/bake/mip/facets.h"

namespace burnish::test {
namespace {

std::vector<Facet> facets_of_slopes(int side, float (*slope_x)(int x, int y), float (*slope_y)(int x, int y), double alike = 1e-4)
{
    Image map = make_image(side, side, 3, PixelType::f32);
    float* to = map.f32();
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const float u = slope_x(x, y), v = slope_y(x, y), length = std::sqrt(1.0f + u * u + v * v);
            *to++ = 0.5f - 0.5f * u / length, *to++ = 0.5f - 0.5f * v / length, *to++ = 0.5f + 0.5f / length;
        }
    MipMaps maps;
    maps.normal = &map;
    maps.nearest = true; // else normals between texels count, too
    return facets_of(MipSource(maps), alike);
}

TEST(facets, of_four_slopes_are_these_slopes)
{
    const std::vector<Facet> found = facets_of_slopes(
        64, [](int x, int) { return x % 4 < 2 ? 0.8f : -0.8f; }, [](int, int y) { return y % 4 < 2 ? 0.5f : -0.5f; });
    ASSERT_EQ(found.size(), 4u);
    const float length = std::sqrt(1.0f + 0.64f + 0.25f);
    for (const Facet& f : found) {
        EXPECT_NEAR(std::abs(f.x), 0.8f / length, 1e-4f);
        EXPECT_NEAR(std::abs(f.y), 0.5f / length, 1e-4f);
        EXPECT_NEAR(f.weight, 0.25f, 0.01f);
        EXPECT_LT(f.spread, 1e-6f);
    }
}

TEST(facets, of_a_flat_map_are_one)
{
    const std::vector<Facet> found = facets_of_slopes(
        16, [](int, int) { return 0.0f; }, [](int, int) { return 0.0f; });
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].weight, 1.0f);
    EXPECT_LT(found[0].spread, 1e-6f);
}

TEST(facets, are_fewer_where_normals_may_differ_more)
{
    std::size_t before = 0;
    for (double alike : {0.1, 0.01, 0.003, 0.001}) {
        const std::vector<Facet> found = facets_of_slopes(
            64, [](int x, int) { return 0.02f * static_cast<float>(x) - 0.63f; },
            [](int, int y) { return 0.02f * static_cast<float>(y) - 0.63f; }, alike);
        EXPECT_GT(found.size(), before) << alike;
        for (const Facet& f : found)
            EXPECT_LT(static_cast<double>(f.weight * f.spread), alike);
        before = found.size();
    }
}

TEST(facets, keep_mean_and_spread_of_all_normals)
{
    const std::vector<Facet> found = facets_of_slopes(
        64, [](int x, int) { return 0.03f * static_cast<float>(x % 40) - 0.6f; },
        [](int x, int y) { return 0.02f * static_cast<float>((x + y) % 32) - 0.3f; });
    ASSERT_EQ(found.size(), static_cast<std::size_t>(kMostFacets));
    float weight = 0.0f, x = 0.0f, square = 0.0f;
    for (const Facet& f : found)
        weight += f.weight, x += f.weight * f.x, square += f.weight * (f.x * f.x + f.y * f.y + f.spread);
    EXPECT_NEAR(weight, 1.0f, 1e-5f);
    double wanted = 0.0, mean = 0.0;
    for (int i = 0; i < 64 * 64; ++i) {
        const int at = i % 64, row = i / 64;
        const double u = 0.03 * (at % 40) - 0.6, v = 0.02 * ((at + row) % 32) - 0.3, length2 = 1.0 + u * u + v * v;
        mean += -u / std::sqrt(length2) / 4096.0, wanted += (u * u + v * v) / length2 / 4096.0;
    }
    EXPECT_NEAR(static_cast<double>(x), mean, 0.005);
    EXPECT_NEAR(static_cast<double>(square), wanted, 0.005);
}

} // namespace
} // namespace burnish::test
