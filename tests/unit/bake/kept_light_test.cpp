// Light that facets keep above a surface's horizon: closed forms of mirrors, and means over levels.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "shading/bake/mip/kept_light.h"

namespace burnish::test {
namespace {

// Returns the part of azimuths where a tilted mirror shows an eye directions above the horizon: l.z = 2 (n.v) n.z - v.z > 0.
double mirror_share(double tilt, double cosine)
{
    const double sine = std::sqrt(1.0 - cosine * cosine), bound = -cosine * std::cos(2.0 * tilt) / (sine * std::sin(2.0 * tilt));
    return std::acos(std::fmin(std::fmax(bound, -1.0), 1.0)) / 3.14159265358979;
}

TEST(kept_light, of_narrow_lobes_is_that_of_mirrors)
{
    const KeptShares& narrow = kept_shares(0.02f);
    for (int knot = 0; knot < 3; ++knot)
        for (double degrees = 5.0; degrees < 80.0; degrees += 5.0) {
            const double tilt = degrees * 3.14159265358979 / 180.0, wanted = mirror_share(tilt, 0.1 + 0.3 * knot);
            EXPECT_NEAR(static_cast<double>(narrow.at(knot, static_cast<float>(std::cos(tilt)))), wanted, 0.06) << knot << " " << degrees;
        }
    EXPECT_GT(narrow.at(3, 0.80f), 0.99f); // the eye above a facet: up to 45 degrees
    EXPECT_LT(narrow.at(3, 0.60f), 0.01f);
    for (const float roughness : {0.1f, 0.5f, 1.0f})
        for (int knot = 0; knot < kKeptKnots; ++knot)
            EXPECT_EQ(kept_shares(roughness).at(knot, 1.0f), 1.0f);
}

Image normals(int width, int height, float (*slope)(int x, int y))
{
    Image map = make_image(width, height, 3, PixelType::f32);
    float* to = map.f32();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float s = slope(x, y), length = std::sqrt(1.0f + s * s);
            *to++ = 0.5f - 0.5f * s / length, *to++ = 0.5f, *to++ = 0.5f + 0.5f / length;
        }
    return map;
}

KeptWeights weights_of(const Image& map)
{
    MipMaps maps;
    maps.normal = &map;
    maps.nearest = true; // else normals between texels count, too
    return kept_weights(MipSource(maps), kept_shares(0.3f));
}

TEST(kept_light, is_all_of_it_where_normals_are_alike)
{
    EXPECT_FALSE(weights_of(normals(32, 32, [](int, int) { return 0.0f; })).any);
    EXPECT_FALSE(weights_of(normals(32, 32, [](int, int) { return 0.4f; })).any);
    const KeptWeights steep = weights_of(normals(32, 32, [](int x, int) { return x % 2 ? 1.0f : -1.0f; }));
    ASSERT_TRUE(steep.any);
    EXPECT_EQ(steep.of[kKeptKnot], 1.0f);
    EXPECT_GT(steep.loss, 0.3f);
    EXPECT_GT(steep.of[3], 1.0f); // from straight above both slopes show the horizon
}

TEST(kept_light, levels_hold_exact_means)
{
    const Image map = normals(5, 3, [](int x, int y) { return 0.1f * static_cast<float>(x + 5 * y); });
    MipMaps maps;
    maps.normal = &map;
    const MipSource source(maps);
    double sum = 0.0;
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 5; ++x)
            sum += static_cast<double>(source.at(x, y).n.z) / 15.0;
    const auto levels = mean_levels(source, [](const MipPoint& p) { return p.n.z; });
    ASSERT_EQ(levels.size(), 2u);
    ASSERT_EQ(levels[0].size(), 2u);
    ASSERT_EQ(levels[1].size(), 1u);
    EXPECT_NEAR(static_cast<double>(levels[1][0]), sum, 1e-6);
    EXPECT_NEAR(0.5 * static_cast<double>(levels[0][0] + levels[0][1]), sum, 1e-6);
}

} // namespace
} // namespace burnish::test
