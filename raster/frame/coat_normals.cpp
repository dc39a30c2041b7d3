#include "raster/frame/coat_normals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/simd/half.h"
#include "shading/bake/mip/filter.h"

namespace burnish {

namespace {

// Returns unit normals of the map in x and y, and x^2 + y^2, as an f32 image.
Image unit_normals(const Image& map, float scale)
{
    Image normals = make_image(map.width, map.height, 3, PixelType::f32);
    const ImageRow row = linear_rows(map, TextureEncoding::linear);
    std::vector<float> texels(4 * static_cast<std::size_t>(map.width));
    float* to = normals.f32();
    for (int y = 0; y < map.height; ++y) {
        row(y, texels.data());
        for (const float* t = texels.data(); t < texels.data() + texels.size(); t += 4, to += 3) {
            const float nx = scale * (2.0f * t[0] - 1.0f), ny = scale * (2.0f * t[1] - 1.0f), nz = 2.0f * t[2] - 1.0f;
            const float over = 1.0f / std::max(std::sqrt(nx * nx + ny * ny + nz * nz), 1e-6f);
            to[0] = nx * over, to[1] = ny * over, to[2] = to[0] * to[0] + to[1] * to[1];
        }
    }
    return normals;
}

// Returns the variance of the normals below each texel, by level from 1 on.
std::vector<std::vector<float>> variances(const Image& normals)
{
    std::vector<std::vector<float>> levels;
    each_box_row(normals, TextureEncoding::linear, Jobs(1), [&](int level, int width, int y, const float* texels) {
        const auto at = static_cast<std::size_t>(level) - 1, wide = static_cast<std::size_t>(width),
                   first = static_cast<std::size_t>(y) * wide;
        levels.resize(std::max(levels.size(), at + 1));
        levels[at].resize(std::max(levels[at].size(), first + wide));
        for (std::size_t x = 0; x < wide; ++x, texels += 4)
            levels[at][first + x] = std::max(texels[2] - (texels[0] * texels[0] + texels[1] * texels[1]), 0.0f);
    });
    return levels;
}

} // namespace

float coat_gain(const Material& m, const MaterialMips& mips)
{
    if (!m.clearcoat_normal_tex.used() || m.clearcoat <= 0.0f || m.unlit)
        return 0.0f;
    return m.lean || mips.filter == kMipFilter_lean ? 1.0f : gain_of_taps(mips.filter, mips.kappa);
}

TexturePyramid coat_pyramid(const Scene& scene, const Material& m, float gain)
{
    const Texture& sampler = scene.textures[static_cast<std::size_t>(m.clearcoat_normal_tex.texture)];
    const Image& map = scene.images[static_cast<std::size_t>(sampler.image)];
    const TexturePyramid own = make_texture_pyramid(map, sampler, TextureEncoding::linear);
    const std::vector<std::vector<float>> spread = variances(unit_normals(map, m.clearcoat_normal_scale));
    return make_texture_pyramid(own.width, own.height, sampler, TextureEncoding::linear, [&](int level, int width, int y, float* rgba) {
        const auto wide = static_cast<std::size_t>(width), row = static_cast<std::size_t>(y);
        const std::uint16_t* from = own.texels.data() + 4 * (static_cast<std::size_t>(own.offset[level]) + (row + 1) * (wide + 2) + 1);
        for (std::size_t x = 0; x < wide; ++x, rgba += 4, from += 4) {
            for (int c = 0; c < 3; ++c)
                rgba[c] = half_to_float(from[c]);
            rgba[3] = level == 0 ? 0.0f : gain * gain * spread[static_cast<std::size_t>(level) - 1][row * wide + x];
        }
    });
}

} // namespace burnish
