#include "shading/bake/mip/map_levels.h"

#include <algorithm>
#include <vector>

#include "core/base/check.h"
#include "core/base/hash.h"
#include "core/simd/half.h"
#include "shading/bake/mip/colour_levels.h"
#include "shading/bake/mip/grid.h"

namespace burnish {

namespace {

// Stored channels of four floats per texel: `count` from `first` on.
struct HeldChannels {
    std::size_t first, count;
};
HeldChannels held_channels(const Image& image, MapPart part)
{
    if (part == MapPart::height)
        return {3, 1};
    return {0, image.channels == 1 ? 1u : image.channels == 3 ? 3u : 4u};
}

} // namespace

TextureEncoding encoding_of(MapPart part)
{
    return part == MapPart::base_color ? TextureEncoding::srgb : TextureEncoding::linear;
}

std::uint64_t map_hash(const Image& image, const Texture& sampler, MapPart part)
{
    const std::int32_t of[] = {static_cast<std::int32_t>(part),
                               image.width,
                               image.height,
                               image.channels,
                               static_cast<std::int32_t>(image.type),
                               static_cast<std::int32_t>(sampler.wrap_s),
                               static_cast<std::int32_t>(sampler.wrap_t),
                               sampler.nearest ? 1 : 0};
    return hash_bytes(image.bytes.data(), image.bytes.size(), hash_bytes(of, sizeof of));
}

MapLevels make_map_levels(const Image& image, const Texture& sampler, const MapId& id, const Image* facing, const Jobs& jobs)
{
    const HeldChannels held = held_channels(image, id.part);
    MapLevels made = {id, image.width, image.height, static_cast<int>(held.count), {}};
    for (int l = 1; l <= levels_below(image.width, image.height); ++l)
        made.levels.emplace_back(static_cast<std::size_t>(std::max(1, image.width >> l)) *
                                 static_cast<std::size_t>(std::max(1, image.height >> l)) * held.count);
    // Stores a row as halves. from: floats of the row, texels `apart` floats apart.
    const auto keep = [&](int level, int width, int y, std::size_t apart, const float* from) {
        std::uint16_t* to = made.levels[static_cast<std::size_t>(level) - 1].data() +
                            static_cast<std::size_t>(y) * static_cast<std::size_t>(width) * held.count;
        for (int x = 0; x < width; ++x, from += apart)
            for (std::size_t c = 0; c < held.count; ++c)
                *to++ = float_to_half(from[c]);
    };
    if (id.kernel == ColourKernel::box && !facing) {
        each_box_row(image, encoding_of(id.part), jobs,
                     [&](int level, int width, int y, const float* rgba) { keep(level, width, y, 4, rgba + held.first); });
        return made;
    }
    const ImageRow decode = linear_rows(image, encoding_of(id.part));
    const ColourRows rows = {image.width, image.height, made.channels, [&](int y, float* to) {
                                 std::vector<float> rgba(static_cast<std::size_t>(image.width) * 4);
                                 decode(y, rgba.data());
                                 for (std::size_t x = 0; x < rgba.size(); x += 4)
                                     to = std::copy_n(rgba.data() + x + held.first, held.count, to);
                             }};
    each_colour_row(rows, {id.kernel, sampler.wrap_s, sampler.wrap_t, facing}, jobs,
                    [&](int level, int width, int y, const float* texels) { keep(level, width, y, held.count, texels); });
    return made;
}

bool are_of(const MapLevels& levels, const Image& image)
{
    constexpr std::uint16_t kOne = 0x3c00;
    const auto in_unit = [](const std::vector<std::uint16_t>& level) {
        return std::all_of(level.begin(), level.end(), [](std::uint16_t half) { return half <= kOne || half == 0x8000; });
    };
    return levels.width == image.width && levels.height == image.height &&
           levels.channels == static_cast<int>(held_channels(image, levels.id.part).count) &&
           (image.type == PixelType::f32 || std::all_of(levels.levels.begin(), levels.levels.end(), in_unit));
}

TexturePyramid pyramid_of_map(const Image& image, const Texture& sampler, const MapLevels& levels)
{
    const TextureEncoding encoding = encoding_of(levels.id.part);
    const HeldChannels held = held_channels(image, levels.id.part);
    BN_CHECK(are_of(levels, image));
    const ImageRow decode = linear_rows(image, encoding);
    return make_texture_pyramid(image.width, image.height, sampler, encoding, [&](int level, int width, int y, float* rgba) {
        if (level == 0) {
            decode(y, rgba);
            return;
        }
        const std::uint16_t* from = levels.levels[static_cast<std::size_t>(level) - 1].data() +
                                    static_cast<std::size_t>(y) * static_cast<std::size_t>(width) * held.count;
        for (int x = 0; x < width; ++x, from += held.count, rgba += 4) {
            rgba[3] = 1.0f;
            for (std::size_t c = 0; c < held.count; ++c)
                rgba[held.first + c] = half_to_float(from[c]);
            if (held.count == 1)
                std::fill_n(rgba, held.first == 0 ? 3 : 4, half_to_float(from[0]));
        }
    });
}

} // namespace burnish
