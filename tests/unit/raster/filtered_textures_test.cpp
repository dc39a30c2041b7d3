// Textures of filtered levels: the same bytes by threads, by instruction set, and whatever keys are made together. Levels by their hash.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "raster/frame/far_normals.h"
#include "raster/frame/pyramids.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

Image noise(int width, int height, int channels, std::uint32_t seed)
{
    Image map = make_image(width, height, channels, PixelType::u8);
    std::mt19937 random(seed);
    for (std::byte& code : map.bytes)
        code = static_cast<std::byte>(random() % 256);
    return map;
}

// Maps of a plate's material. normals: channels of the normal map, 4 with alpha.
Scene mapped_plate(int width, int height, int normals, bool direction)
{
    Scene s = plate(1.0f);
    Material& m = s.materials[0];
    m.roughness = 0.5f;
    const auto add = [&](TextureRef& ref, Image map) {
        Texture texture;
        texture.image = static_cast<std::int32_t>(s.images.size());
        texture.wrap_s = WrapMode::clamp;
        ref.texture = static_cast<std::int32_t>(s.textures.size());
        s.images.push_back(std::move(map)), s.textures.push_back(texture);
    };
    if (normals > 0)
        add(m.normal_tex, noise(width, height, normals, 1));
    add(m.metallic_roughness_tex, noise(std::max(1, width / 2), height, 3, 2));
    if (direction)
        add(m.anisotropy_tex, noise(width, height, 3, 3)), m.anisotropy_strength = 0.7f;
    return s;
}

SceneMips mips_by(MipFilter filter, const Scene& scene)
{
    MaterialMips of_material;
    of_material.filter = filter, of_material.kappa = takes_kappa(filter) ? 1.0f : 0.0f, of_material.gains = takes_gains(filter);
    SceneMips mips;
    mips.materials.assign(scene.materials.size(), of_material);
    mips.frames_override = false;
    return mips;
}

TEST(filtered_textures, are_the_same_bytes_by_threads_and_alone)
{
    const int sizes[][2] = {{1, 1}, {15, 1}, {16, 16}, {17, 33}, {65, 17}, {1, 40}};
    std::size_t filtered = 0;
    for (const auto& [width, height] : sizes)
        for (const int normals : {0, 3, 4})
            for (const bool direction : {false, true})
                for (const MipFilter filter : {kMipFilter_kappa, kMipFilter_leadr, kMipFilter_ssgt}) {
                    const Scene scene = mapped_plate(width, height, normals, direction);
                    const SceneMips mips = mips_by(filter, scene);
                    const std::vector<KeptWeights> kept = kept_weights_by_material(scene, mips, Jobs(1));
                    const std::vector<PyramidKey> keys = used_pyramids(scene, mips, kept);
                    const auto made = make_pyramids(scene, mips, kept, keys, Jobs(1), nullptr);
                    const auto expect_equal = [&, width = width, height = height](const auto& others, std::size_t first) {
                        for (std::size_t k = 0; k < others.size(); ++k) {
                            const TexturePyramid &a = *made[first + k], &b = *others[k];
                            ASSERT_EQ(a.texels.size(), b.texels.size());
                            EXPECT_TRUE(std::equal(a.texels.begin(), a.texels.end(), b.texels.begin()))
                                << width << "x" << height << ", normals " << normals << ", direction " << direction << ", key "
                                << first + k;
                        }
                    };
                    for (const int threads : {2, 3})
                        expect_equal(make_pyramids(scene, mips, kept, keys, Jobs(threads), nullptr), 0);
                    for (std::size_t k = 0; k < keys.size(); ++k) {
                        filtered += keys[k].filtered;
                        expect_equal(make_pyramids(scene, mips, kept, {keys[k]}, Jobs(1), nullptr), k);
                        // Every border repeats the texel beside it
                        const TexturePyramid& p = *made[k];
                        for (int l = 0; l < p.levels; ++l) {
                            const std::uint16_t* const row = texel_row(p, l, 0);
                            EXPECT_TRUE(std::equal(row, row + 4, row - 4)) << "level " << l;
                        }
                    }
                }
    EXPECT_GT(filtered, 100u);
}

TEST(filtered_textures, levels_are_found_by_a_hash_that_is_made_once)
{
    const Scene scene = mapped_plate(16, 16, 3, true);
    SceneMips mips = mips_by(kMipFilter_kappa, scene);
    const std::uint64_t hash = mip_source(scene, scene.materials[0]).hash(Jobs(1));
    EXPECT_EQ(source_hash(mip_source(scene, scene.materials[0]), mips.materials[0], Jobs(1)), hash);
    EXPECT_EQ(mips.materials[0].source, hash);
    MipFile file;
    file.materials.push_back(*filtered_levels(scene, mips, Jobs(1))[0]);
    file.materials[0].source = hash + 1; // of other maps
    mips.cached = std::make_shared<const MipFile>(std::move(file));
    const auto taken = [&] { return filtered_levels(scene, mips, Jobs(1))[0].get() == mips.cached->materials.data(); };
    EXPECT_FALSE(taken());
    mips.materials[0].source = hash + 1; // a known hash is not made again
    EXPECT_TRUE(taken());
    mips.materials[0].source = 0;
    EXPECT_FALSE(taken());
}

} // namespace
} // namespace burnish::test
