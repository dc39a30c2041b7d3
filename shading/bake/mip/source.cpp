#include "shading/bake/mip/source.h"

#include <cmath>
#include <limits>
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
    return value - value == 0.0f ? value : other;
}

// Of a normal map's numbers, whatever their length. Selects, no branches: rows of it go through lanes.
real3 unit_normal(float scale, float red, float green, float blue)
{
    const float nx = scale * (2.0f * red - 1.0f), ny = scale * (2.0f * green - 1.0f), nz = std::max(2.0f * blue - 1.0f, 0.0f);
    const float across = std::sqrt(nx * nx + ny * ny), length = std::sqrt((nx * nx + ny * ny) + nz * nz);
    const bool any = length > 1e-6f && length <= std::numeric_limits<float>::max(), wide = across > kWidestDisc * length;
    const float to_edge = kWidestDisc / (wide ? across : 1.0f), whole = any ? length : 1.0f; // onto the disc's edge
    const float level_z = std::sqrt(1.0f - kWidestDisc * kWidestDisc);
    const float x = wide ? nx * to_edge : nx / whole, y = wide ? ny * to_edge : ny / whole, z = wide ? level_z : nz / whole;
    return vec3_of(any ? x : 0.0f, any ? y : 0.0f, any ? z : 1.0f);
}

template <class Code> void put_codes(const Image& map, std::size_t first, std::size_t channel, float most, std::size_t count, float* to)
{
    const auto* from = reinterpret_cast<const Code*>(map.bytes.data()) + first * static_cast<std::size_t>(map.channels) + channel;
    const std::size_t apart = static_cast<std::size_t>(map.channels);
    for (std::size_t x = 0; x < count; ++x)
        to[x] = static_cast<float>(from[x * apart]) / most;
}

struct Span { // of a row of the grid
    int x, y, count;
};

// A channel on the grid, `other` in place of what is not finite.
void put_span(const Image& map, const Grid& grid, const Span& span, std::size_t channel, float other, float* to)
{
    const std::size_t first = static_cast<std::size_t>(span.y) * static_cast<std::size_t>(grid.width) + static_cast<std::size_t>(span.x);
    const std::size_t count = static_cast<std::size_t>(span.count);
    const bool same = map.width == grid.width && map.height == grid.height;
    const std::size_t of = map.channels >= 3 ? channel : 0;
    if (same && map.type == PixelType::u8)
        put_codes<std::uint8_t>(map, first, of, 255.0f, count, to);
    else if (same && map.type == PixelType::u16)
        put_codes<std::uint16_t>(map, first, of, 65535.0f, count, to);
    else
        for (int x = 0; x < span.count; ++x)
            to[x] = on_grid(map, grid, span.x + x, span.y,
                            [&](std::size_t texel) { return finite_or(texel_channel(map, texel, channel), other); });
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

MipPoint MipSource::at(int x, int y) const
{
    MipPoint point;
    put(x, y, 1, &point);
    return point;
}

void MipSource::row(int y, MipPoint* to) const
{
    put(0, y, grid_.width, to);
}

void MipSource::put(int first, int y, int count, MipPoint* to) const
{
    const Span span = {first, y, count};
    const std::size_t width = static_cast<std::size_t>(count);
    std::vector<float> planes(16 * width);
    const auto plane = [&](std::size_t k) { return planes.data() + k * width; };
    float *const red = plane(0), *const green = plane(1), *const blue = plane(2), *const rough = plane(3), *const made = plane(10);
    if (maps_.normal) {
        put_span(*maps_.normal, grid_, span, 0, 0.5f, red), put_span(*maps_.normal, grid_, span, 1, 0.5f, green);
        put_span(*maps_.normal, grid_, span, 2, 1.0f, blue);
        const float scale = maps_.normal_scale;
        for (std::size_t x = 0; x < width; ++x) {
            const real3 n = unit_normal(scale, red[x], green[x], blue[x]);
            made[x] = n.x, made[width + x] = n.y, made[2 * width + x] = n.z;
        }
    }
    const bool varies = maps_.roughness || maps_.direction;
    if (varies) {
        if (maps_.roughness)
            put_span(*maps_.roughness, grid_, span, 1, 1.0f, rough);
        for (std::size_t k = 0; maps_.direction && k < 6; ++k)
            put_span(tensors_[k / 3], grid_, span, k % 3, 0.0f, plane(4 + k));
        for (std::size_t x = 0; x < width; ++x) {
            const float own = maps_.roughness ? maps_.roughness_factor * rough[x] : maps_.roughness_factor;
            const float roughness = std::min(std::max(own, 0.0f), 1.0f);
            const auto power = [&](std::size_t k) {
                return maps_.direction ? vec3_of(plane(k)[x], plane(k + 1)[x], plane(k + 2)[x]) : vec3_of(1.0f, 0.0f, 0.0f);
            };
            const slope_covariance s =
                covariance_from_tensors(roughness * roughness, maps_.anisotropy_strength, rotation_, power(4), power(7));
            made[3 * width + x] = s.xx, made[4 * width + x] = s.yy, made[5 * width + x] = s.xy;
        }
    }
    for (std::size_t x = 0; x < width; ++x) {
        const auto at = [&](std::size_t k) { return made[k * width + x]; };
        to[x] = {maps_.normal ? vec3_of(at(0), at(1), at(2)) : vec3_of(0.0f, 0.0f, 1.0f),
                 varies ? slope_covariance{at(3), at(4), at(5)} : only_};
    }
}

std::uint64_t MipSource::hash(const Jobs& jobs) const
{
    std::vector<std::uint64_t> rows(static_cast<std::size_t>(grid_.height));
    jobs.parallel_for(rows.size(), [&](std::size_t y, int) {
        std::vector<MipPoint> points(static_cast<std::size_t>(grid_.width));
        row(static_cast<int>(y), points.data());
        rows[y] = hash_of_row(points.data(), grid_.width);
    });
    return hash_of_rows(rows);
}

std::uint64_t MipSource::hash_of_row(const MipPoint* points, int count)
{
    static_assert(sizeof(MipPoint) == 6 * sizeof(float));
    return hash_bytes(points, static_cast<std::size_t>(count) * sizeof(MipPoint));
}

std::uint64_t MipSource::hash_of_rows(const std::vector<std::uint64_t>& rows) const
{
    const std::int32_t size[2] = {grid_.width, grid_.height};
    return hash_bytes(rows.data(), rows.size() * sizeof rows[0], hash_bytes(size, sizeof size));
}

} // namespace burnish
