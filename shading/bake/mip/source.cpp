#include "shading/bake/mip/source.h"

#include <cmath>
#include <vector>

#include "core/base/check.h"
#include "core/base/hash.h"
#include "core/math/scalar_math.h"
#include "shading/bake/mip/anisotropy.h"

namespace burnish {

namespace {

constexpr float kWidestDisc = 0.999f; // of x and y of a unit normal

float finite_or(float value, float other)
{
    return std::isfinite(value) ? value : other;
}

} // namespace

Grid grid_of(const MipMaps& maps)
{
    Grid grid = {0, 0, maps.wrap_s, maps.wrap_t, maps.nearest};
    grid.cover(maps.normal), grid.cover(maps.roughness), grid.cover(maps.direction);
    return grid;
}

MipSource::MipSource(const MipMaps& maps) : maps_(maps), grid_(grid_of(maps))
{
    BN_CHECK(grid_.width > 0 && grid_.height > 0);
    if (maps.direction)
        tensors_[0] = anisotropy_tensor(*maps.direction, 2), tensors_[1] = anisotropy_tensor(*maps.direction, 4);
    const auto turn = static_cast<double>(maps.anisotropy_rotation);
    rotation_ = vec2_of(static_cast<float>(det_cos(turn)), static_cast<float>(det_sin(turn)));
    const float roughness = std::clamp(maps.roughness_factor, 0.0f, 1.0f);
    const real3 along = vec3_of(1.0f, 0.0f, 0.0f);
    only_ = covariance_from_tensors(roughness * roughness, maps.anisotropy_strength, rotation_, along, along);
}

real3 MipSource::normal_at(int x, int y) const
{
    if (!maps_.normal)
        return vec3_of(0.0f, 0.0f, 1.0f);
    const Image& map = *maps_.normal;
    const auto part = [&](std::size_t channel, float level) {
        return on_grid(map, grid_, x, y, [&](std::size_t texel) { return finite_or(texel_channel(map, texel, channel), level); });
    };
    const float nx = maps_.normal_scale * (2.0f * part(0, 0.5f) - 1.0f), ny = maps_.normal_scale * (2.0f * part(1, 0.5f) - 1.0f);
    const float nz = std::max(2.0f * part(2, 1.0f) - 1.0f, 0.0f);
    const float across = std::sqrt(nx * nx + ny * ny), length = std::sqrt((nx * nx + ny * ny) + nz * nz);
    if (!(length > 1e-6f) || !std::isfinite(length))
        return vec3_of(0.0f, 0.0f, 1.0f);
    if (across > kWidestDisc * length) { // onto the disc's edge
        const float scale = kWidestDisc / across;
        return vec3_of(nx * scale, ny * scale, std::sqrt(1.0f - kWidestDisc * kWidestDisc));
    }
    return vec3_of(nx / length, ny / length, nz / length);
}

slope_covariance MipSource::covariance_at(int x, int y) const
{
    if (!maps_.roughness && !maps_.direction)
        return only_;
    float roughness = maps_.roughness_factor;
    if (maps_.roughness)
        roughness *= on_grid(*maps_.roughness, grid_, x, y,
                             [&](std::size_t texel) { return finite_or(texel_channel(*maps_.roughness, texel, 1), 1.0f); });
    roughness = std::clamp(roughness, 0.0f, 1.0f);
    real3 power[2] = {vec3_of(1.0f, 0.0f, 0.0f), vec3_of(1.0f, 0.0f, 0.0f)};
    for (int i = 0; maps_.direction && i < 2; ++i) {
        const Image& tensors = tensors_[i];
        const auto entry = [&](std::size_t c) {
            return on_grid(tensors, grid_, x, y, [&](std::size_t texel) { return tensors.f32()[4 * texel + c]; });
        };
        power[i] = vec3_of(entry(0), entry(1), entry(2));
    }
    return covariance_from_tensors(roughness * roughness, maps_.anisotropy_strength, rotation_, power[0], power[1]);
}

void MipSource::row(int y, MipPoint* to) const
{
    for (int x = 0; x < grid_.width; ++x)
        to[x] = at(x, y);
}

std::uint64_t MipSource::hash(const Jobs& jobs) const
{
    static_assert(sizeof(MipPoint) == 6 * sizeof(float));
    std::vector<std::uint64_t> rows(static_cast<std::size_t>(grid_.height));
    jobs.parallel_for(rows.size(), [&](std::size_t y, int) {
        std::vector<MipPoint> points(static_cast<std::size_t>(grid_.width));
        row(static_cast<int>(y), points.data());
        rows[y] = hash_bytes(points.data(), points.size() * sizeof(MipPoint));
    });
    const std::int32_t size[2] = {grid_.width, grid_.height};
    return hash_bytes(rows.data(), rows.size() * sizeof rows[0], hash_bytes(size, sizeof size));
}

} // namespace burnish
