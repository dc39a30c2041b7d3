#include "shading/bake/mip/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include "core/base/check.h"
#include "core/image/colour.h"
#include "core/simd/dispatch.h"
#include "core/simd/half.h"
#include "shading/bake/mip/grid.h"
#include "shading/bake/mip/texture_rows.h"

namespace burnish {
namespace {

struct Size {
    int w, h;
};

// Decodes rows of an image to linear RGBA float. Replicates gray. Alpha is 1 if there is none. NaN becomes 0, and values outside half's
// range saturate, so that no filter spreads an Inf.
class Decoder {
  public:
    Decoder(const Image& image, TextureEncoding encoding) : image_(image)
    {
        if (image.type == PixelType::f32)
            return;
        const int codes = image.type == PixelType::u8 ? 256 : 65536;
        const float top = static_cast<float>(codes - 1);
        linear_.resize(static_cast<std::size_t>(codes));
        for (int i = 0; i < codes; ++i)
            linear_[static_cast<std::size_t>(i)] = static_cast<float>(i) / top;
        color_ = linear_;
        if (encoding == TextureEncoding::srgb)
            for (float& c : color_)
                c = srgb_to_linear(c);
    }

    void row(int y, float* rgba) const
    {
        const std::size_t stride =
            static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.channels) * pixel_type_bytes(image_.type);
        const std::byte* from = image_.bytes.data() + stride * static_cast<std::size_t>(y);
        if (image_.type == PixelType::u8)
            expand(reinterpret_cast<const std::uint8_t*>(from), rgba);
        else if (image_.type == PixelType::u16)
            expand(reinterpret_cast<const std::uint16_t*>(from), rgba);
        else
            expand(reinterpret_cast<const float*>(from), rgba);
    }

  private:
    template <class Code> float color(Code c) const { return color_[c]; }
    template <class Code> float linear(Code c) const { return linear_[c]; }
    static float sane(float x) { return x > -kHalfMax ? std::min(x, kHalfMax) : x <= -kHalfMax ? -kHalfMax : 0.0f; }
    float color(float x) const { return sane(x); }
    float linear(float x) const { return sane(x); }

    template <class Code> void expand(const Code* from, float* rgba) const
    {
        const bool rgb = image_.channels >= 3, alpha = image_.channels == 2 || image_.channels == 4;
        for (int x = 0; x < image_.width; ++x, from += image_.channels, rgba += 4) {
            rgba[0] = color(from[0]);
            rgba[1] = rgb ? color(from[1]) : rgba[0];
            rgba[2] = rgb ? color(from[2]) : rgba[0];
            rgba[3] = alpha ? linear(from[image_.channels - 1]) : 1.0f;
        }
    }

    const Image& image_;
    std::vector<float> color_, linear_; // by code

    friend class HalfDecoder;
};

std::uint16_t stored_half(TextureEncoding encoding, float value)
{
    return float_to_half(encoding == TextureEncoding::residual ? value - half_to_float(float_to_half(value)) : value);
}

// Decodes rows of an 8-bit image to the halves that store_row() stores, by tables.
class HalfDecoder {
  public:
    HalfDecoder(const Image& image, TextureEncoding encoding) : image_(image)
    {
        const Decoder decoder(image, encoding);
        for (std::size_t code = 0; code < 256; ++code)
            color_[code] = stored_half(encoding, decoder.color_[code]), linear_[code] = stored_half(encoding, decoder.linear_[code]);
        opaque_ = stored_half(encoding, 1.0f);
    }
    void row(int y, std::uint16_t* rgba) const
    {
        const std::size_t channels = static_cast<std::size_t>(image_.channels), width = static_cast<std::size_t>(image_.width);
        const auto* from = reinterpret_cast<const std::uint8_t*>(image_.bytes.data()) + static_cast<std::size_t>(y) * width * channels;
        const std::size_t green = channels >= 3 ? 1 : 0, blue = channels >= 3 ? 2 : 0;
        const bool alpha = channels == 2 || channels == 4;
        for (std::size_t x = 0; x < width; ++x, from += channels, rgba += 4) {
            rgba[0] = color_[from[0]], rgba[1] = color_[from[green]], rgba[2] = color_[from[blue]];
            rgba[3] = alpha ? linear_[from[channels - 1]] : opaque_;
        }
    }

  private:
    const Image& image_;
    std::array<std::uint16_t, 256> color_, linear_; // by code
    std::uint16_t opaque_;
};

// One axis of an exact box filter. Target texel i covers source texels first[i]..., with weights that sum to 1.
struct AxisWeights {
    std::vector<int> first;
    std::vector<int> begin;    // by texel: index into weight; one entry more than texels
    std::vector<float> weight; // overlap / footprint
};

AxisWeights box_weights(int source, int target)
{
    AxisWeights a;
    const std::int64_t s = source, t = target;
    for (std::int64_t i = 0; i < t; ++i) {
        // In units of 1/target source texels, the footprint is [i s, (i+1) s) and texel k is [k t, (k+1) t).
        const std::int64_t k0 = i * s / t, k1 = ((i + 1) * s + t - 1) / t;
        a.first.push_back(static_cast<int>(k0));
        a.begin.push_back(static_cast<int>(a.weight.size()));
        for (std::int64_t k = k0; k < k1; ++k) {
            const std::int64_t overlap = std::min((k + 1) * t, (i + 1) * s) - std::max(k * t, i * s);
            a.weight.push_back(static_cast<float>(static_cast<double>(overlap) / static_cast<double>(s)));
        }
    }
    a.begin.push_back(static_cast<int>(a.weight.size()));
    return a;
}

// Returns box_filter() of a level with twice the sides.
template <class Row> std::vector<float> halved(Size from, Size to, const Row& source_row)
{
    const mip::TextureFns& fns = pick<mip::TextureFns>();
    const std::size_t numbers = static_cast<std::size_t>(from.w) * 4, made = static_cast<std::size_t>(to.w) * 4;
    std::vector<float> result(static_cast<std::size_t>(to.h) * made), top(numbers);
    for (int y = 0; y < to.h; ++y) {
        std::copy_n(source_row(2 * y), numbers, top.begin()); // the next row may be written over it
        fns.halve({top.data(), source_row(2 * y + 1), static_cast<std::size_t>(to.w), result.data() + static_cast<std::size_t>(y) * made});
    }
    return result;
}

// Applies a box filter to source rows (float RGBA): rows first, then columns. Sums are doubles, in index order.
template <class Row> std::vector<float> box_filter(Size from, Size to, const Row& source_row)
{
    if (from.w == 2 * to.w && from.h == 2 * to.h)
        return halved(from, to, source_row);
    const AxisWeights ax = box_weights(from.w, to.w), ay = box_weights(from.h, to.h);
    std::vector<float> result(static_cast<std::size_t>(to.w) * static_cast<std::size_t>(to.h) * 4);
    std::vector<double> column(static_cast<std::size_t>(from.w) * 4);
    float* out = result.data();
    for (std::size_t y = 0; y < static_cast<std::size_t>(to.h); ++y) {
        std::fill(column.begin(), column.end(), 0.0);
        for (int k = ay.begin[y]; k < ay.begin[y + 1]; ++k) {
            const float* row = source_row(ay.first[y] + k - ay.begin[y]);
            const double w = static_cast<double>(ay.weight[static_cast<std::size_t>(k)]);
            for (std::size_t i = 0; i < column.size(); ++i)
                column[i] += w * static_cast<double>(row[i]);
        }
        for (std::size_t x = 0; x < static_cast<std::size_t>(to.w); ++x, out += 4) {
            const double* c = column.data() + 4 * static_cast<std::size_t>(ax.first[x]);
            double sum[4] = {};
            for (int k = ax.begin[x]; k < ax.begin[x + 1]; ++k, c += 4)
                for (int i = 0; i < 4; ++i)
                    sum[i] += static_cast<double>(ax.weight[static_cast<std::size_t>(k)]) * c[i];
            for (int i = 0; i < 4; ++i)
                out[i] = static_cast<float>(sum[i]);
        }
    }
    return result;
}

// Stores row y of a level's interior as halves.
void store_row(TexturePyramid& p, TextureEncoding encoding, int level, Size size, int y, const float* rgba)
{
    pick<mip::TextureFns>().halves(
        {rgba, static_cast<std::size_t>(size.w) * 4, encoding == TextureEncoding::residual, texel_row(p, level, y)});
}

// Returns the texel that border texel -1 (`high` false) or n (`high` true) repeats. Mirroring reflects at the outer edge of the last
// texel.
int border_source(WrapMode mode, int n, bool high)
{
    if (mode == WrapMode::repeat)
        return high ? 0 : n - 1;
    return high ? n - 1 : 0;
}

void fill_border(TexturePyramid& p, int level, Size size)
{
    const std::size_t stride = static_cast<std::size_t>(size.w) + 2;
    std::uint16_t* base = p.texels.data() + 4 * static_cast<std::size_t>(p.offset[level]);
    const auto texel = [&](int x, int y) { // x, y: -1 is the border
        return base + 4 * (static_cast<std::size_t>(y + 1) * stride + static_cast<std::size_t>(x + 1));
    };
    const int left = border_source(p.wrap_s, size.w, false), right = border_source(p.wrap_s, size.w, true);
    for (int y = 0; y < size.h; ++y) {
        std::memcpy(texel(-1, y), texel(left, y), 8);
        std::memcpy(texel(size.w, y), texel(right, y), 8);
    }
    const std::size_t row_bytes = stride * 8;
    std::memcpy(texel(-1, -1), texel(-1, border_source(p.wrap_t, size.h, false)), row_bytes);
    std::memcpy(texel(-1, size.h), texel(-1, border_source(p.wrap_t, size.h, true)), row_bytes);
}

// Computes offsets and sizes of all levels, and allocates them.
void lay_out(TexturePyramid& p)
{
    const int side = std::max(p.width, p.height);
    p.levels = 1;
    while (p.levels < kMaxTextureLevels && (side >> p.levels) > 0)
        ++p.levels;
    std::int64_t texels = 0;
    for (int l = 0; l < kMaxTextureLevels; ++l) {
        const int level = std::min(l, p.levels - 1); // the tables repeat their last entry
        const int w = std::max(1, p.width >> level), h = std::max(1, p.height >> level);
        p.level_width[l] = static_cast<float>(w);
        p.level_height[l] = static_cast<float>(h);
        p.offset[l] = l < p.levels ? static_cast<std::int32_t>(texels) : p.offset[p.levels - 1];
        if (l < p.levels)
            texels += static_cast<std::int64_t>(w + 2) * (h + 2);
        BN_CHECK_OP(texels, <, std::int64_t{1} << 31);
    }
    p.texels.resize_for_overwrite(static_cast<std::size_t>(texels) * 4);
}

} // namespace

TexturePyramid make_empty_pyramid(int width, int height, const Texture& sampler)
{
    TexturePyramid p;
    p.width = width, p.height = height;
    p.wrap_s = sampler.wrap_s, p.wrap_t = sampler.wrap_t, p.nearest = sampler.nearest;
    lay_out(p);
    return p;
}

const std::uint16_t* texel_row(const TexturePyramid& p, int level, int y)
{
    const std::size_t stride = static_cast<std::size_t>(p.level_width[level]) + 2;
    return p.texels.data() + 4 * (static_cast<std::size_t>(p.offset[level]) + (static_cast<std::size_t>(y) + 1) * stride + 1);
}

std::uint16_t* texel_row(TexturePyramid& p, int level, int y)
{
    return const_cast<std::uint16_t*>(texel_row(std::as_const(p), level, y));
}

void fill_borders(TexturePyramid& p)
{
    for (int l = 0; l < p.levels; ++l)
        fill_border(p, l, {static_cast<int>(p.level_width[l]), static_cast<int>(p.level_height[l])});
}

ImageRow linear_rows(const Image& image, TextureEncoding encoding)
{
    BN_CHECK(image.width > 0 && image.height > 0 && image.channels >= 1 && image.channels <= 4);
    return [decoder = std::make_shared<const Decoder>(image, encoding)](int y, float* rgba) { decoder->row(y, rgba); };
}

namespace {

Size level_size(Size level0, int l)
{
    return {std::max(1, level0.w >> l), std::max(1, level0.h >> l)};
}

using FloatRow = std::function<const float*(int y)>;

// Filters a band of level 0 to its rows on levels 1 to `levels`. Returns the last level's rows.
std::vector<float> filter_band(int width, const ImageRow& decode, int levels, int band, const LevelRow& use)
{
    const int first = band << levels;
    std::vector<float> row(static_cast<std::size_t>(width) * 4), finer;
    for (int l = 1; l <= levels; ++l) {
        const Size from = {width >> (l - 1), 1 << (levels - l + 1)}, to = {width >> l, 1 << (levels - l)};
        const FloatRow rows = [&](int y) -> const float* {
            if (l > 1)
                return finer.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(from.w) * 4;
            decode(first + y, row.data());
            return row.data();
        };
        std::vector<float> made = box_filter(from, to, rows);
        for (int y = 0; y < to.h; ++y)
            use(l, to.w, band * to.h + y, made.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(to.w) * 4);
        finer = std::move(made);
    }
    return finer;
}

} // namespace

// Each level comes from the smallest earlier level whose texels tile its footprints, else from level 0. Both are exact.
void each_box_row(int width, int height, const ImageRow& decode, const Jobs& jobs, const LevelRow& use)
{
    const Size level0 = {width, height};
    const int banded = banded_levels(width, height);
    std::array<std::vector<float>, kMaxTextureLevels> levels;
    // Make the first levels in bands of rows
    if (banded > 0) {
        const Size last = level_size(level0, banded);
        const std::size_t texels = static_cast<std::size_t>(last.w) * 4;
        std::vector<float>& whole = levels[static_cast<std::size_t>(banded)];
        whole.resize(static_cast<std::size_t>(last.h) * texels);
        jobs.parallel_for(static_cast<std::size_t>(last.h), [&](std::size_t band, int) {
            const std::vector<float> row = filter_band(width, decode, banded, static_cast<int>(band), use);
            std::copy(row.begin(), row.end(), whole.begin() + static_cast<std::ptrdiff_t>(band * texels));
        });
    }
    // Make the other levels one by one
    std::vector<float> row(static_cast<std::size_t>(width) * 4);
    for (int l = banded + 1; l <= levels_below(width, height); ++l) {
        const Size size = level_size(level0, l);
        const int finer = finer_level(width, height, l);
        const std::size_t stride = static_cast<std::size_t>(level_size(level0, finer).w) * 4, texels = static_cast<std::size_t>(size.w) * 4;
        const FloatRow rows = [&](int y) -> const float* {
            if (finer > 0)
                return levels[static_cast<std::size_t>(finer)].data() + static_cast<std::size_t>(y) * stride;
            decode(y, row.data());
            return row.data();
        };
        std::vector<float>& to = levels[static_cast<std::size_t>(l)];
        to = box_filter(level_size(level0, finer), size, rows);
        for (int y = 0; y < size.h; ++y)
            use(l, size.w, y, to.data() + static_cast<std::size_t>(y) * texels);
    }
}

void each_box_row(const Image& image, TextureEncoding encoding, const Jobs& jobs, const LevelRow& use)
{
    each_box_row(image.width, image.height, linear_rows(image, encoding), jobs, use);
}

TexturePyramid make_texture_pyramid(const Image& image, const Texture& sampler, TextureEncoding encoding)
{
    TexturePyramid p = make_empty_pyramid(image.width, image.height, sampler);
    const Size full = {p.width, p.height};
    if (image.type == PixelType::u8) {
        const HalfDecoder decoder(image, encoding);
        for (int y = 0; y < p.height; ++y)
            decoder.row(y, texel_row(p, 0, y));
    } else {
        const ImageRow decode = linear_rows(image, encoding);
        std::vector<float> row(static_cast<std::size_t>(p.width) * 4);
        for (int y = 0; y < p.height; ++y) {
            decode(y, row.data());
            store_row(p, encoding, 0, full, y, row.data());
        }
    }
    each_box_row(image, encoding, Jobs(1), [&](int l, int width, int y, const float* rgba) {
        store_row(p, encoding, l, {width, std::max(1, p.height >> l)}, y, rgba);
    });
    fill_borders(p);
    return p;
}

TexturePyramid make_texture_pyramid(int width, int height, const Texture& sampler, TextureEncoding encoding, const TexelRow& row)
{
    TexturePyramid p = make_empty_pyramid(width, height, sampler);
    std::vector<float> texels(static_cast<std::size_t>(width) * 4);
    for (int l = 0; l < p.levels; ++l) {
        const Size size = {std::max(1, width >> l), std::max(1, height >> l)};
        for (int y = 0; y < size.h; ++y) {
            row(l, size.w, y, texels.data());
            store_row(p, encoding, l, size, y, texels.data());
        }
    }
    fill_borders(p);
    return p;
}

} // namespace burnish
