#include "core/scene/height_map.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <tuple>
#include <utility>

#include "core/scene/texture.h"

namespace burnish {
namespace {

// Returns a channel in [0,1], or NaN where a float image holds NaN.
double channel_at(const Image& image, int x, int y, int channel)
{
    const std::size_t texel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
    const std::size_t at = texel * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(image.channels >= 3 ? channel : 0);
    if (image.type == PixelType::u8)
        return std::to_integer<int>(image.bytes[at]) / 255.0;
    if (image.type == PixelType::u16)
        return reinterpret_cast<const std::uint16_t*>(image.bytes.data())[at] / 65535.0;
    const double value = static_cast<double>(image.f32()[at]);
    return std::isnan(value) ? value : std::clamp(value, 0.0, 1.0);
}

std::uint16_t height_code(double unit)
{
    return static_cast<std::uint16_t>(std::clamp(unit, 0.0, 1.0) * 65535.0 + 0.5);
}

// Interpolates between texel centres, or returns the nearest texel where the sampler is nearest. x, y: in texels from
// the corner. `value` converts a texel's number before blending.
template <class Value> double between(const Image& image, const Texture& sampler, double x, double y, int channel, const Value& value)
{
    if (sampler.nearest)
        return value(channel_at(image, wrapped_at(static_cast<std::int64_t>(std::floor(x)), image.width, sampler.wrap_s),
                                wrapped_at(static_cast<std::int64_t>(std::floor(y)), image.height, sampler.wrap_t), channel));
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5), fx = x - 0.5 - left, fy = y - 0.5 - top;
    double sum = 0.0;
    for (const int j : {0, 1})
        for (const int i : {0, 1}) {
            const double weight = (i ? fx : 1.0 - fx) * (j ? fy : 1.0 - fy);
            if (weight > 0.0)
                sum += weight * value(channel_at(image, wrapped_at(static_cast<std::int64_t>(left) + i, image.width, sampler.wrap_s),
                                                 wrapped_at(static_cast<std::int64_t>(top) + j, image.height, sampler.wrap_t), channel));
        }
    return sum;
}

Image normals_with_heights(const Image& normals, const Image& heights, const Texture& sampler)
{
    const int width = std::max(normals.width, heights.width), height = std::max(normals.height, heights.height);
    Image out = make_image(width, height, 4, PixelType::u16);
    auto* to = reinterpret_cast<std::uint16_t*>(out.bytes.data());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x, to += 4) {
            const auto at = [&](const Image& image, int channel, double repaired) {
                return height_code(between(image, sampler, (x + 0.5) * image.width / width, (y + 0.5) * image.height / height, channel,
                                           [repaired](double unit) { return std::isnan(unit) ? repaired : unit; }));
            };
            for (int c = 0; c < 3; ++c)
                to[c] = normals.empty() ? (c == 2 ? 65535 : 32768) : at(normals, c, c == 2 ? 1.0 : 0.5);
            to[3] = at(heights, 0, 1.0);
        }
    return out;
}

} // namespace

bool lie_alike(const Scene& scene, const TextureRef& a, const TextureRef& b)
{
    const Texture &s = scene.textures[static_cast<std::size_t>(a.texture)], &t = scene.textures[static_cast<std::size_t>(b.texture)];
    return a.uv_set == b.uv_set && a.uv_transform == b.uv_transform && s.wrap_s == t.wrap_s && s.wrap_t == t.wrap_t &&
           s.nearest == t.nearest;
}

float height_at(const Image& heights, const Texture& sampler, double u, double v)
{
    return static_cast<float>(
        between(heights, sampler, u * heights.width, v * heights.height, 0, [](double unit) { return std::isnan(unit) ? 1.0 : unit; }));
}

SurfaceMap heights_of_depths(const Image& depths)
{
    SurfaceMap map = {make_image(depths.width, depths.height, 1, PixelType::u16)};
    auto* to = reinterpret_cast<std::uint16_t*>(map.image.bytes.data());
    for (int y = 0; y < depths.height; ++y)
        for (int x = 0; x < depths.width; ++x) {
            const double depth = channel_at(depths, x, y, 0);
            map.repaired += std::isnan(depth);
            *to++ = height_code(std::isnan(depth) ? 1.0 : 1.0 - depth);
        }
    return map;
}

Status pack_height_maps(Scene& scene, const Limits& limits, const std::string& file)
{
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> known; // key: normal and height textures
    for (Material& m : scene.materials) {
        // Skip materials whose height map does not match their normal map
        const TextureRef heights = std::exchange(m.height_tex, TextureRef());
        if (!heights.used())
            continue;
        if (m.normal_tex.used() && !lie_alike(scene, heights, m.normal_tex)) {
            scene.warnings.push_back(
                fmt::format("{}: its heights lie otherwise than its normal map and are not looked at", material_text(scene, m)));
            continue;
        }
        const auto [it, is_new] =
            known.try_emplace({m.normal_tex.texture, heights.texture}, static_cast<std::int32_t>(scene.textures.size()));
        // Check the memory limit, and combine the two maps
        if (is_new) {
            Texture texture = scene.textures[static_cast<std::size_t>(heights.texture)];
            const Image& from = scene.images[static_cast<std::size_t>(texture.image)];
            const Image none;
            const Texture* const map = m.normal_tex.used() ? &scene.textures[static_cast<std::size_t>(m.normal_tex.texture)] : nullptr;
            const Image& normals = map ? scene.images[static_cast<std::size_t>(map->image)] : none;
            std::uint64_t bytes = 8 * static_cast<std::uint64_t>(std::max(from.width, normals.width)) *
                                  static_cast<std::uint64_t>(std::max(from.height, normals.height));
            for (const Image& image : scene.images)
                bytes += image.bytes.size();
            if (bytes > limits.texture_bytes)
                return Error{ExitCode::bad_input, file, "",
                             fmt::format("the scene's textures need more than {} bytes (Limits::texture_bytes)", limits.texture_bytes)};
            Image image = normals_with_heights(normals, from, texture);
            add_texture(scene, "heights", std::move(image), std::move(texture));
        }
        // Use the combined map as the normal map
        m.normal_tex = heights;
        m.normal_tex.texture = it->second;
        m.has_height_map = true;
    }
    return {};
}

} // namespace burnish
