#include "raster/frame/coat_normals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/simd/half.h"
#include "shading/bake/mip/filter.h"

namespace burnish {

namespace {

float finite_or_0(float value)
{
    return value - value == 0.0f ? value : 0.0f;
}

// Returns the variance of the map's unit normals below each texel, by level from 1 on.
std::vector<std::vector<float>> variances(const Image& map, float scale)
{
    std::vector<std::vector<float>> levels;
    for (int l = 1; l <= levels_below(map.width, map.height); ++l)
        levels.emplace_back(static_cast<std::size_t>(std::max(1, map.width >> l)) * static_cast<std::size_t>(std::max(1, map.height >> l)));
    // Makes a row of unit normals: x, y, and x^2 + y^2
    const ImageRow texels_of = linear_rows(map, TextureEncoding::linear);
    const auto normals = [&](int y, float* row) {
        texels_of(y, row);
        for (float* t = row; t < row + 4 * map.width; t += 4) {
            const float nx = scale * (2.0f * t[0] - 1.0f), ny = scale * (2.0f * t[1] - 1.0f), nz = 2.0f * t[2] - 1.0f;
            const float over = 1.0f / std::max(std::sqrt(nx * nx + ny * ny + nz * nz), 1e-6f);
            const float x = finite_or_0(nx * over), y_part = finite_or_0(ny * over);
            t[0] = x, t[1] = y_part, t[2] = finite_or_0(x * x + y_part * y_part);
        }
    };
    each_box_row(map.width, map.height, normals, Jobs(1), [&](int level, int width, int y, const float* texels) {
        const std::size_t wide = static_cast<std::size_t>(width);
        float* const to = levels[static_cast<std::size_t>(level) - 1].data() + static_cast<std::size_t>(y) * wide;
        for (std::size_t x = 0; x < wide; ++x, texels += 4)
            to[x] = std::max(texels[2] - (texels[0] * texels[0] + texels[1] * texels[1]), 0.0f);
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
    TexturePyramid made = make_texture_pyramid(map, sampler, TextureEncoding::linear);
    const std::vector<std::vector<float>> spread = variances(map, m.clearcoat_normal_scale);
    for (int level = 0; level < made.levels; ++level) {
        const auto width = static_cast<std::size_t>(made.level_width[level]), height = static_cast<std::size_t>(made.level_height[level]);
        for (std::size_t y = 0; y < height; ++y) {
            std::uint16_t* to = texel_row(made, level, static_cast<int>(y));
            for (std::size_t x = 0; x < width; ++x, to += 4)
                to[3] = level == 0 ? 0 : float_to_half(gain * gain * spread[static_cast<std::size_t>(level) - 1][y * width + x]);
        }
    }
    fill_borders(made);
    return made;
}

} // namespace burnish
