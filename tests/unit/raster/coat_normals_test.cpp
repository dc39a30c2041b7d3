// Mip levels of coats' normal maps.
#include <gtest/gtest.h>

#include <cmath>

#include "core/simd/half.h"
#include "raster/frame/coat_normals.h"
#include "shading/lang/records.h"

namespace burnish::test {
namespace {

// Returns a coated material whose normals lean alternately to both sides, by 0.6 in x.
Scene leaning(float scale)
{
    Scene scene;
    Image map = make_image(4, 4, 3, PixelType::f32);
    for (int i = 0; i < 16; ++i) {
        float* const texel = map.f32() + 3 * i;
        texel[0] = i % 2 ? 0.8f : 0.2f, texel[1] = 0.5f, texel[2] = 0.9f;
    }
    scene.images.push_back(std::move(map));
    Texture texture;
    texture.image = 0;
    scene.textures.push_back(texture);
    Material m;
    m.clearcoat = 1.0f, m.clearcoat_normal_tex.texture = 0, m.clearcoat_normal_scale = scale;
    scene.materials.push_back(m);
    return scene;
}

float texel(const TexturePyramid& p, int level, int channel)
{
    const int width = p.width >> level;
    return half_to_float(p.texels[4 * static_cast<std::size_t>(p.offset[level] + width + 3) + static_cast<std::size_t>(channel)]);
}

TEST(coat_normals, alpha_is_the_variance_of_unit_normals)
{
    for (const float scale : {1.0f, 2.0f}) {
        const Scene scene = leaning(scale);
        const TexturePyramid p = coat_pyramid(scene, scene.materials[0], 0.5f);
        const float x = 0.6f * scale, variance = x * x / (x * x + 0.64f);
        EXPECT_EQ(texel(p, 0, 3), 0.0f);
        EXPECT_NEAR(texel(p, 0, 0), 0.2f, 1e-3f);
        for (int level = 1; level < p.levels; ++level) {
            EXPECT_NEAR(texel(p, level, 0), 0.5f, 1e-3f);
            EXPECT_NEAR(texel(p, level, 3), 0.25f * variance, 1e-3f);
        }
    }
}

TEST(coat_normals, widen_by_the_filters_that_widen_lobes)
{
    const Scene scene = leaning(1.0f);
    Material m = scene.materials[0];
    MaterialMips mips;
    mips.kappa = 0.7f;
    const auto gain = [&](MipFilter filter) {
        mips.filter = filter;
        return coat_gain(m, mips);
    };
    EXPECT_EQ(gain(kMipFilter_box), 0.0f);
    EXPECT_EQ(gain(kMipFilter_covariance), 0.0f);
    EXPECT_EQ(gain(kMipFilter_lean), 1.0f);
    EXPECT_FLOAT_EQ(gain(kMipFilter_kappa), std::sqrt(0.35f));
    EXPECT_FLOAT_EQ(gain(kMipFilter_mipnet), std::sqrt(0.35f));
    m.lean = true;
    EXPECT_EQ(gain(kMipFilter_box), 1.0f);
    m.clearcoat = 0.0f;
    EXPECT_EQ(gain(kMipFilter_kappa), 0.0f);
}

} // namespace
} // namespace burnish::test
