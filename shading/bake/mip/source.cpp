#include "shading/bake/mip/source.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "core/base/check.h"
#include "core/base/column.h"
#include "core/base/hash.h"
#include "core/math/scalar_math.h"
#include "core/simd/dispatch.h"
#include "shading/bake/mip/anisotropy.h"
#include "shading/bake/mip/mean_fns.h"

namespace burnish {

namespace {

float finite_or(float value, float other)
{
    return value - value == 0.0f ? value : other;
}

template <class Code> void put_codes(const Image& map, std::size_t first, std::size_t channel, float most, std::size_t count, float* to)
{
    const auto* from = reinterpret_cast<const Code*>(map.bytes.data()) + first * static_cast<std::size_t>(map.channels) + channel;
    const std::size_t apart = static_cast<std::size_t>(map.channels);
    for (std::size_t x = 0; x < count; ++x)
        to[x] = static_cast<float>(from[x * apart]) / most;
}

// Writes one channel of a map's row, as many values as the map is wide. other: replaces values that are not finite.
void put_channel(const Image& map, int y, std::size_t channel, float other, float* to)
{
    const std::size_t texels = static_cast<std::size_t>(map.width), first = static_cast<std::size_t>(y) * texels;
    const std::size_t channels = static_cast<std::size_t>(map.channels), of = channels >= 3 ? channel : 0;
    if (map.type == PixelType::u8)
        put_codes<std::uint8_t>(map, first, of, 255.0f, texels, to);
    else if (map.type == PixelType::u16)
        put_codes<std::uint16_t>(map, first, of, 65535.0f, texels, to);
    else
        for (std::size_t x = 0; x < texels; ++x)
            to[x] = finite_or(map.f32()[(first + x) * channels + of], other);
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
    const auto turn = static_cast<double>(maps.anisotropy_rotation);
    rotation_ = vec2_of(static_cast<float>(det_cos(turn)), static_cast<float>(det_sin(turn)));
    const float roughness = std::clamp(maps.roughness_factor, 0.0f, 1.0f);
    const real3 along = vec3_of(1.0f, 0.0f, 0.0f);
    only_ = covariance_from_tensors(roughness * roughness, maps.anisotropy_strength, rotation_, along, along);
    find_columns(maps.normal), find_columns(maps.roughness), find_columns(maps.direction);
}

void MipSource::find_columns(const Image* map)
{
    const auto has_width = [&](const Columns& columns) { return columns.map_width == map->width; };
    if (!map || (map->width == grid_.width && map->height == grid_.height) || std::any_of(columns_.begin(), columns_.end(), has_width))
        return;
    const std::size_t slots = mip::row_stride(static_cast<std::size_t>(grid_.width));
    Columns found{map->width, std::vector<std::int32_t>(slots), std::vector<std::int32_t>(slots), std::vector<float>(slots)};
    for (int x = 0; x < grid_.width; ++x) {
        const Neighbours u = neighbours(x, grid_.width, map->width, grid_.wrap_s, grid_.nearest);
        const std::size_t at = static_cast<std::size_t>(x);
        found.left[at] = u.low, found.right[at] = u.high, found.share[at] = u.share;
    }
    columns_.push_back(std::move(found));
}

// Writes channels `first` ... of a grid row, `count` of them. others[k] replaces values of the k-th that are not finite.
void MipSource::put_row(const Image& map, int y, int first, int count, const float* others, std::size_t stride, float* to) const
{
    const mip::Fns& fns = pick<mip::Fns>();
    const std::size_t texels = static_cast<std::size_t>(grid_.width), at = static_cast<std::size_t>(y) * texels;
    const bool same = map.width == grid_.width && map.height == grid_.height;
    if (same && map.type == PixelType::u8 && map.channels >= 3) {
        const auto* codes = reinterpret_cast<const std::uint8_t*>(map.bytes.data()) + at * static_cast<std::size_t>(map.channels);
        fns.codes({codes, map.channels, first, count, texels, stride, to});
        return;
    }
    if (same) {
        for (int k = 0; k < count; ++k, to += stride)
            put_channel(map, y, static_cast<std::size_t>(first + k), others[k], to);
        return;
    }
    // Interpolate between the map's two rows and columns
    const auto columns = std::find_if(columns_.begin(), columns_.end(), [&](const Columns& found) { return found.map_width == map.width; });
    const Neighbours v = neighbours(y, grid_.height, map.height, grid_.wrap_t, grid_.nearest);
    std::vector<float> low(static_cast<std::size_t>(map.width)), high(low.size());
    for (int k = 0; k < count; ++k, to += stride) {
        put_channel(map, v.low, static_cast<std::size_t>(first + k), others[k], low.data());
        put_channel(map, v.high, static_cast<std::size_t>(first + k), others[k], high.data());
        fns.blend({texels, low.data(), high.data(), columns->left.data(), columns->right.data(), columns->share.data(), v.share, to});
    }
}

namespace {

constexpr int kPowers[] = {2, 4};
constexpr std::size_t kTensorPlanes = 6;

// Writes the tensors of a map's row, as many as the map is wide.
void put_row_tensors(const Image& map, int y, std::size_t stride, float* to)
{
    const mip::Fns& fns = pick<mip::Fns>();
    const auto texels = static_cast<std::size_t>(map.width);
    Column<float> codes;
    codes.resize_for_overwrite(3 * stride);
    for (std::size_t k = 0; k < 3; ++k)
        std::fill(codes.data() + k * stride + texels, codes.data() + (k + 1) * stride, 0.0f);
    if (map.type == PixelType::u8 && map.channels >= 3) {
        const auto* from = reinterpret_cast<const std::uint8_t*>(map.bytes.data()) +
                           static_cast<std::size_t>(y) * texels * static_cast<std::size_t>(map.channels);
        fns.codes({from, map.channels, 0, 3, texels, stride, codes.data()});
    } else {
        for (std::size_t k = 0; k < 3; ++k)
            put_channel(map, y, k, std::numeric_limits<float>::quiet_NaN(), codes.data() + k * stride);
    }
    fns.directions({texels, stride, codes.data(), to});
}

} // namespace

void MipSource::put_tensors(int y, std::size_t stride, float* to) const
{
    const Image& map = *maps_.direction;
    if (map.width == grid_.width && map.height == grid_.height) {
        put_row_tensors(map, y, stride, to);
        return;
    }
    // Interpolate between the map's two rows and columns
    const auto columns = std::find_if(columns_.begin(), columns_.end(), [&](const Columns& found) { return found.map_width == map.width; });
    const Neighbours v = neighbours(y, grid_.height, map.height, grid_.wrap_t, grid_.nearest);
    const std::size_t of_map = mip::row_stride(static_cast<std::size_t>(map.width));
    std::vector<float> low(kTensorPlanes * of_map), high(low.size());
    put_row_tensors(map, v.low, of_map, low.data()), put_row_tensors(map, v.high, of_map, high.data());
    for (std::size_t k = 0; k < kTensorPlanes; ++k)
        pick<mip::Fns>().blend({static_cast<std::size_t>(grid_.width), low.data() + k * of_map, high.data() + k * of_map,
                                columns->left.data(), columns->right.data(), columns->share.data(), v.share, to + k * stride});
}

namespace {

MipPoint point_at(const float* planes, std::size_t stride, std::size_t x)
{
    const auto at = [&](std::size_t k) { return planes[k * stride + x]; };
    return {vec3_of(at(0), at(1), at(2)), {at(3), at(4), at(5)}};
}

} // namespace

template <class Read, class ReadTensors>
void MipSource::put(std::size_t count, const Read& read, const ReadTensors& read_tensors, float* to) const
{
    const mip::Fns& fns = pick<mip::Fns>();
    const std::size_t stride = mip::row_stride(count);
    const auto plane = [&](std::size_t k) { return to + k * stride; };
    constexpr float kLevel[3] = {0.5f, 0.5f, 1.0f}, kWhole = 1.0f;
    // Normals
    if (maps_.normal) {
        read(*maps_.normal, 0, 3, kLevel, stride, to);
        fns.normals({count, stride, maps_.normal_scale, to});
    } else {
        std::fill_n(plane(0), 2 * stride, 0.0f), std::fill_n(plane(2), stride, 1.0f);
    }
    // Lobes
    if (maps_.roughness || maps_.direction) {
        Column<float> own;
        own.resize_for_overwrite(7 * stride);
        for (std::size_t k = 0; k < 7; ++k)
            std::fill(own.data() + k * stride + count, own.data() + (k + 1) * stride, 0.0f);
        if (maps_.roughness)
            read(*maps_.roughness, 1, 1, &kWhole, stride, own.data());
        if (maps_.direction)
            read_tensors(stride, own.data() + stride);
        fns.covariances({count, stride, maps_.roughness ? own.data() : nullptr, maps_.direction ? own.data() + stride : nullptr,
                         maps_.roughness_factor, maps_.anisotropy_strength, rotation_.x, rotation_.y, plane(3)});
    } else {
        std::fill_n(plane(3), stride, only_.xx), std::fill_n(plane(4), stride, only_.yy), std::fill_n(plane(5), stride, only_.xy);
    }
    // Pad with zeros
    for (std::size_t k = 0; k < mip::kPointPlanes; ++k)
        std::fill(plane(k) + count, plane(k) + stride, 0.0f);
}

MipPoint MipSource::at(int x, int y) const
{
    float planes[mip::kPointPlanes * mip::kRowSlots] = {};
    points(1, &x, &y, planes);
    return point_at(planes, mip::kRowSlots, 0);
}

void MipSource::points(std::size_t count, const int* x, const int* y, float* to) const
{
    put(
        count,
        [&](const Image& map, int first, int channels, const float* others, std::size_t stride, float* out) {
            for (int k = 0; k < channels; ++k, out += stride)
                for (std::size_t i = 0; i < count; ++i)
                    out[i] = on_grid(map, grid_, x[i], y[i], [&](std::size_t texel) {
                        return finite_or(texel_channel(map, texel, static_cast<std::size_t>(first + k)), others[k]);
                    });
        },
        [&](std::size_t stride, float* out) {
            for (const int power : kPowers)
                for (float DirectionTensor::*part : {&DirectionTensor::xx, &DirectionTensor::yy, &DirectionTensor::xy}) {
                    for (std::size_t i = 0; i < count; ++i)
                        out[i] = on_grid(*maps_.direction, grid_, x[i], y[i],
                                         [&](std::size_t texel) { return direction_tensor(*maps_.direction, texel, power).*part; });
                    out += stride;
                }
        },
        to);
}

void MipSource::row(int y, MipPoint* to) const
{
    const std::size_t width = static_cast<std::size_t>(grid_.width), stride = mip::row_stride(width);
    std::vector<float> made(mip::kPointPlanes * stride);
    planes(y, made.data());
    for (std::size_t x = 0; x < width; ++x)
        to[x] = point_at(made.data(), stride, x);
}

void MipSource::planes(int y, float* to) const
{
    put(
        static_cast<std::size_t>(grid_.width),
        [&](const Image& map, int first, int channels, const float* others, std::size_t stride, float* out) {
            put_row(map, y, first, channels, others, stride, out);
        },
        [&](std::size_t stride, float* out) { put_tensors(y, stride, out); }, to);
}

std::uint64_t MipSource::hash(const Jobs& jobs) const
{
    std::vector<std::uint64_t> rows(static_cast<std::size_t>(grid_.height));
    jobs.parallel_for(rows.size(), [&](std::size_t y, int) {
        std::vector<float> made(mip::kPointPlanes * mip::row_stride(static_cast<std::size_t>(grid_.width)));
        planes(static_cast<int>(y), made.data());
        rows[y] = hash_of_planes(made.data());
    });
    return hash_of_rows(rows);
}

std::uint64_t MipSource::hash_of_planes(const float* planes) const
{
    std::uint32_t mixed[mip::kPointPlanes * mip::kRowSlots];
    pick<mip::Fns>().hash({mip::row_stride(static_cast<std::size_t>(grid_.width)), planes, mixed});
    return hash_bytes(mixed, sizeof mixed);
}

std::uint64_t MipSource::hash_of_rows(const std::vector<std::uint64_t>& rows) const
{
    const std::int32_t size[2] = {grid_.width, grid_.height};
    return hash_bytes(rows.data(), rows.size() * sizeof rows[0], hash_bytes(size, sizeof size));
}

} // namespace burnish
