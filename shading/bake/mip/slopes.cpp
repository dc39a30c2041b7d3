#include "shading/bake/mip/slopes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/math/scalar_math.h"
#include "shading/bake/mip/anisotropy.h"
#include "shading/bake/mip/grid.h"
#include "shading/bake/mip/mean_fns.h"
#include "shading/lang/records.h"
#include "shading/surface/covariance.k.h"

namespace burnish {

namespace {

float slope(const Image& map, float scale, std::size_t texel, int axis)
{
    const std::size_t channels = static_cast<std::size_t>(map.channels);
    const std::size_t at = texel * channels + (channels >= 3 ? static_cast<std::size_t>(axis) : 0);
    float s = 0.0f;
    if (map.type == PixelType::u8)
        s = static_cast<float>(std::to_integer<int>(map.bytes[at]) - 128) / 127.0f;
    else if (map.type == PixelType::u16)
        s = static_cast<float>(reinterpret_cast<const std::uint16_t*>(map.bytes.data())[at] - 32768) / 32767.0f;
    else
        s = map.f32()[at];
    if (map.type != PixelType::f32)
        s = std::max(s, -1.0f);
    s *= scale;
    return std::isnan(s) ? 0.0f : std::clamp(s, -mip::kMostSlope, mip::kMostSlope);
}

// Returns the slope of a normal map's texel, decoded as in shading. A normal below the surface gets the largest slope.
float slope_of_normal(const Image& map, float scale, std::size_t texel, int axis)
{
    const float s = scale * (1.0f - 2.0f * texel_channel(map, texel, static_cast<std::size_t>(axis)));
    const float z = std::max(2.0f * texel_channel(map, texel, 2) - 1.0f, 1e-3f);
    return std::isfinite(s) && std::isfinite(z) ? std::clamp(s / z, -mip::kMostSlope, mip::kMostSlope) : 0.0f;
}

// Returns x or y of the texel's unit normal.
float part_of_normal(const Image& map, float scale, std::size_t texel, int axis)
{
    const float x = slope_of_normal(map, scale, texel, 0), y = slope_of_normal(map, scale, texel, 1);
    return (axis == 0 ? x : y) / std::sqrt(1.0f + (x * x + y * y));
}

real3 tensor_at(const Image* tensors, const Grid& grid, int x, int y)
{
    if (!tensors)
        return vec3_of(1.0f, 0.0f, 0.0f);
    const auto entry = [&](std::size_t c) {
        return on_grid(*tensors, grid, x, y, [&](std::size_t texel) { return tensors->f32()[4 * texel + c]; });
    };
    return vec3_of(entry(0), entry(1), entry(2));
}

} // namespace

Image slope_moments(const SlopeMaps& maps, const SlopeFactors& factors, int part)
{
    BN_CHECK(part == 2 || part == 4);
    Grid grid = {0, 0, maps.wrap_s, maps.wrap_t, maps.nearest};
    grid.cover(maps.tilt), grid.cover(maps.direction);
    Image tensors[2];
    if (maps.direction)
        tensors[0] = anisotropy_tensor(*maps.direction, 2), tensors[1] = anisotropy_tensor(*maps.direction, 4);
    const auto turn = static_cast<double>(factors.anisotropy_rotation);
    const real2 rotation = vec2_of(static_cast<float>(det_cos(turn)), static_cast<float>(det_sin(turn)));
    Image out = make_image(grid.width, grid.height, 4, PixelType::f32);
    float* to = out.f32();
    for (int y = 0; y < grid.height; ++y)
        // Filter the moments of each grid point, not the slopes
        for (int x = 0; x < grid.width; ++x, to += 4) {
            const auto moment = [&](auto value) { return maps.tilt ? on_grid(*maps.tilt, grid, x, y, value) : 0.0f; };
            const auto of = [&](std::size_t texel, int axis) {
                if (!maps.normals)
                    return slope(*maps.tilt, factors.tilt_scale, texel, axis);
                return factors.unit_gain > 0.0f ? factors.unit_gain * part_of_normal(*maps.tilt, factors.tilt_scale, texel, axis)
                                                : slope_of_normal(*maps.tilt, factors.tilt_scale, texel, axis);
            };
            const auto second = [&](int a, int b) { return moment([&](std::size_t i) { return of(i, a) * of(i, b); }); };
            const real3 power2 = tensor_at(maps.direction ? &tensors[0] : nullptr, grid, x, y);
            slope_covariance moments = {second(0, 0), second(1, 1), second(0, 1)};
            if (factors.with_lobe) {
                const float roughness = std::clamp(factors.roughness, 0.0f, 1.0f);
                const real3 power4 = tensor_at(maps.direction ? &tensors[1] : nullptr, grid, x, y);
                const slope_covariance lobe =
                    covariance_from_tensors(roughness * roughness, factors.anisotropy_strength, rotation, power2, power4);
                moments = sum_of_covariances(moments, lobe);
            }
            if (part == 2)
                to[0] = power2.x, to[1] = power2.y, to[2] = power2.z, to[3] = kMomentScale * moments.xx;
            else
                to[0] = kSlopeScale * moment([&](std::size_t i) { return of(i, 0); }),
                to[1] = kSlopeScale * moment([&](std::size_t i) { return of(i, 1); }), to[2] = kMomentScale * moments.yy,
                to[3] = kMomentScale * moments.xy;
        }
    return out;
}

} // namespace burnish
