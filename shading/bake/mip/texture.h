// Material textures for renderers: full mip pyramids in RGBA half, linear, with borders.
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
    residual // remainder after rounding `linear` to half: the sum of both holds about 22 bits
};

// A mip pyramid. Level l is (width_l + 2) x (height_l + 2) texels. The wrap modes fill the one-texel border. So the 2x2 footprint of a
// coordinate wrapped to [-1/2, size + 1/2) is always in memory, and two adjacent texels are one 16-byte load.
struct TexturePyramid {
    int width = 0, height = 0, levels = 0;
    WrapMode wrap_s = WrapMode::repeat, wrap_t = WrapMode::repeat;
    bool nearest = false;
    std::int32_t offset[kMaxTextureLevels] = {}; // in texels, to the bordered level
    float level_width[kMaxTextureLevels] = {}, level_height[kMaxTextureLevels] = {};
    Column<std::uint16_t> texels; // 4 halves per texel
};

// Returns a pyramid whose texels are undefined. Write each level's rows, then fill the borders.
TexturePyramid make_empty_pyramid(int width, int height, const Texture& sampler);
// Returns the first texel inside the border of row y.
std::uint16_t* texel_row(TexturePyramid& pyramid, int level, int y);
const std::uint16_t* texel_row(const TexturePyramid& pyramid, int level, int y);
void fill_borders(TexturePyramid& pyramid);

// Makes a pyramid. Each level is level 0, box-filtered with exact footprints, also for sides that are not powers of two.
TexturePyramid make_texture_pyramid(const Image& image, const Texture& sampler, TextureEncoding encoding);

// Makes a pyramid from given levels. row: writes the texels in a row of a level, 4 floats each, as they are stored.
using TexelRow = std::function<void(int level, int width, int y, float* rgba)>;
TexturePyramid make_texture_pyramid(int width, int height, const Texture& sampler, TextureEncoding encoding, const TexelRow& row);

// Returns a reader of an image's rows as 4 linear, finite floats per texel. The image must outlive the reader.
using ImageRow = std::function<void(int y, float* rgba)>;
ImageRow linear_rows(const Image& image, TextureEncoding encoding);

// Calls `use` for each row of the box filter's levels from 1 on, 4 floats per texel, in any order and for several rows at once.
using LevelRow = std::function<void(int level, int width, int y, const float* texels)>;
void each_box_row(const Image& image, TextureEncoding encoding, const Jobs& jobs, const LevelRow& use);
// The same for rows of `width` texels that `level0` makes; finite floats.
void each_box_row(int width, int height, const ImageRow& level0, const Jobs& jobs, const LevelRow& use);

} // namespace burnish
