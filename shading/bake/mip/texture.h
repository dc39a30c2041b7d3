// Material textures as the renderers use them: whole mip pyramids in RGBA half, linear, bordered.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/column.h"
#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "core/scene/scene.h"

namespace burnish {

inline constexpr int kMaxTextureLevels = 16;

enum class TextureEncoding : std::uint8_t {
    linear,
    srgb,    // RGB decoded before filtering, alpha linear
    residual // what rounding to half took from `linear`: the sum of both holds about 22 bits
};

// Level l is (width_l + 2) x (height_l + 2) texels with a border of one texel filled by the wrap modes, so
// that the 2x2 footprint of a coordinate wrapped to [-1/2, size + 1/2) is always in memory, and a texel pair
// is one 16-byte load.
struct TexturePyramid {
    int width = 0, height = 0, levels = 0;
    WrapMode wrap_s = WrapMode::repeat, wrap_t = WrapMode::repeat;
    bool nearest = false;
    std::int32_t offset[kMaxTextureLevels] = {}; // in texels, of the bordered level
    float level_width[kMaxTextureLevels] = {}, level_height[kMaxTextureLevels] = {};
    Column<std::uint16_t> texels; // 4 halves a texel
};

// Each level is a box filter of level 0 with exact footprints, also for sides that are not powers of two.
TexturePyramid make_texture_pyramid(const Image& image, const Texture& sampler, TextureEncoding encoding);

// The same of levels that are made elsewhere. row: writes the texels of a row of a level, 4 floats each, as they are stored.
using TexelRow = std::function<void(int level, int width, int y, float* rgba)>;
TexturePyramid make_texture_pyramid(int width, int height, const Texture& sampler, TextureEncoding encoding, const TexelRow& row);

// Rows of an image as textures hold them: 4 linear floats a texel, finite. The image must stay.
using ImageRow = std::function<void(int y, float* rgba)>;
ImageRow linear_rows(const Image& image, TextureEncoding encoding);

// The box filter's levels from 1 on, row by row, 4 floats a texel, in no order: several rows at once.
using LevelRow = std::function<void(int level, int width, int y, const float* texels)>;
void each_box_row(const Image& image, TextureEncoding encoding, const Jobs& jobs, const LevelRow& use);

} // namespace burnish
