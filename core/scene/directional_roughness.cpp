#include "core/scene/directional_roughness.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <tuple>
#include <utility>

#include "core/scene/height_map.h"
#include "core/scene/texture.h"

namespace burnish {
namespace {

double channel_of(const Image& image, std::size_t texel, int channel, bool is_signed)
{
    const std::size_t at = texel * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(image.channels >= 3 ? channel : 0);
    const double zero = image.type == PixelType::u8 ? 128.0 : 32768.0, one = image.type == PixelType::u8 ? 255.0 : 65535.0;
    if (image.type == PixelType::f32)
        return static_cast<double>(image.f32()[at]);
    const double code = image.type == PixelType::u8 ? std::to_integer<int>(image.bytes[at])
                                                    : static_cast<double>(reinterpret_cast<const std::uint16_t*>(image.bytes.data())[at]);
    return is_signed ? std::max((code - zero) / (one - zero), -1.0) : code / one;
}

std::uint16_t code16(double unit)
{
    return static_cast<std::uint16_t>(std::clamp(unit, 0.0, 1.0) * 65535.0 + 0.5);
}

std::size_t texel_at(const Image& image, int x, int y, int width, int height)
{
    const auto along = [](int at, int count, int texels) {
        return static_cast<std::size_t>((2 * static_cast<std::int64_t>(at) + 1) * texels / (2 * count));
    };
    return along(y, height, image.height) * static_cast<std::size_t>(image.width) + along(x, width, image.width);
}

struct Khr {
    double roughness, strength;
};

// Converts to KHR_materials_anisotropy: the smaller width is roughness^2; the larger width mixes this with 1 by
// strength^2.
Khr khr_of(double roughness, double anisotropy)
{
    const double mean = roughness * roughness, across = mean * (1.0 - anisotropy), along = std::min(mean * (1.0 + anisotropy), 1.0);
    return {std::sqrt(across), across < along ? std::sqrt((along - across) / (1.0 - across)) : 0.0};
}

struct LaidImages {
    Image directions, metal_rough;
};

// Combines the maps. `directions` and `metal_rough` belong to the material and may be empty.
LaidImages laid(const Image& roughness, const Image& directions, const Image& metal_rough)
{
    const int width = std::max({roughness.width, directions.width, metal_rough.width}),
              height = std::max({roughness.height, directions.height, metal_rough.height});
    LaidImages out = {make_image(width, height, 3, PixelType::u16), make_image(width, height, 3, PixelType::u16)};
    auto *axis = reinterpret_cast<std::uint16_t*>(out.directions.bytes.data()),
         *rough = reinterpret_cast<std::uint16_t*>(out.metal_rough.bytes.data());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x, axis += 3, rough += 3) {
            // Read the anisotropy and the direction along the grain
            const std::size_t own = texel_at(roughness, x, y, width, height);
            const double anisotropy = channel_of(roughness, own, 1, true);
            double along = 1.0, across = 0.0;
            if (!directions.empty()) {
                const std::size_t at = texel_at(directions, x, y, width, height);
                along = 2.0 * channel_of(directions, at, 0, false) - 1.0, across = 2.0 * channel_of(directions, at, 1, false) - 1.0;
            }
            if (anisotropy < 0.0) // wider across the grain
                std::tie(along, across) = std::pair(-across, along);
            // Write the direction, the strength and the roughness
            const Khr khr = khr_of(channel_of(roughness, own, 0, false), std::abs(anisotropy));
            axis[0] = code16(0.5 + 0.5 * along), axis[1] = code16(0.5 + 0.5 * across), axis[2] = code16(khr.strength);
            rough[0] = 65535, rough[1] = code16(khr.roughness);
            rough[2] = metal_rough.empty() ? 65535 : code16(channel_of(metal_rough, texel_at(metal_rough, x, y, width, height), 2, false));
        }
    return out;
}

const Image& image_of(const Scene& scene, const TextureRef& from)
{
    static const Image none;
    return from.used() ? scene.images[static_cast<std::size_t>(scene.textures[static_cast<std::size_t>(from.texture)].image)] : none;
}

} // namespace

SurfaceMap roughness_of(const Image& map, RoughnessEncoding encoding)
{
    SurfaceMap out = {make_image(map.width, map.height, 3, PixelType::u16)};
    auto* to = reinterpret_cast<std::uint16_t*>(out.image.bytes.data());
    const std::size_t texels = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    for (std::size_t i = 0; i < texels; ++i, to += 3) {
        double roughness = channel_of(map, i, 0, false), anisotropy = channel_of(map, i, 1, encoding == RoughnessEncoding::anisotropy);
        if (!std::isfinite(roughness) || !std::isfinite(anisotropy)) {
            roughness = 1.0, anisotropy = 0.0, ++out.repaired;
        } else if (encoding == RoughnessEncoding::widths) {
            const double along = std::clamp(roughness, 0.0, 1.0), across = std::clamp(anisotropy, 0.0, 1.0), sum = along + across;
            roughness = std::sqrt(0.5 * sum), anisotropy = sum > 0.0 ? (along - across) / sum : 0.0;
        }
        to[0] = code16(roughness);
        to[1] = static_cast<std::uint16_t>(32768 + std::lround(32767.0 * std::clamp(anisotropy, -1.0, 1.0)));
        to[2] = 0;
    }
    return out;
}

Status lay_directional_roughness(Scene& scene, const Limits& limits, const std::string& file)
{
    std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t>, std::int32_t> known; // value: first of two new ones
    for (Material& m : scene.materials) {
        const TextureRef own = std::exchange(m.directional_roughness_tex, TextureRef());
        if (!own.used())
            continue;
        if ((m.anisotropy_tex.used() && !lie_alike(scene, own, m.anisotropy_tex)) ||
            (m.metallic_roughness_tex.used() && !lie_alike(scene, own, m.metallic_roughness_tex))) {
            scene.warnings.push_back(
                fmt::format("{}: its directional roughness lies otherwise than its other textures of the lobe and is not looked at",
                            material_text(scene, m)));
            continue;
        }
        const auto [it, is_new] = known.try_emplace({own.texture, m.anisotropy_tex.texture, m.metallic_roughness_tex.texture},
                                                    static_cast<std::int32_t>(scene.textures.size()));
        if (is_new) {
            const Image &rough = image_of(scene, own), &axes = image_of(scene, m.anisotropy_tex),
                        &metal = image_of(scene, m.metallic_roughness_tex);
            std::uint64_t bytes = 12 * static_cast<std::uint64_t>(std::max({rough.width, axes.width, metal.width})) *
                                  static_cast<std::uint64_t>(std::max({rough.height, axes.height, metal.height}));
            for (const Image& image : scene.images)
                bytes += image.bytes.size();
            if (bytes > limits.texture_bytes)
                return Error{ExitCode::bad_input, file, "",
                             fmt::format("the scene's textures need more than {} bytes (Limits::texture_bytes)", limits.texture_bytes)};
            LaidImages images = laid(rough, axes, metal);
            const Texture like = scene.textures[static_cast<std::size_t>(own.texture)];
            add_texture(scene, "directions of roughness", std::move(images.directions), like);
            add_texture(scene, "metalness and roughness", std::move(images.metal_rough), like);
        }
        m.anisotropy_tex = m.metallic_roughness_tex = own;
        m.anisotropy_tex.texture = it->second, m.metallic_roughness_tex.texture = it->second + 1;
        m.roughness = m.anisotropy_strength = 1.0f;
    }
    return {};
}

} // namespace burnish
