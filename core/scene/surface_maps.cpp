#include "core/scene/surface_maps.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace burnish {
namespace {

std::size_t texels_of(const Image& image)
{
    return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

// Returns a channel's index; gray stands for all colours.
std::size_t place_of(const Image& image, std::size_t texel, std::size_t channel)
{
    return texel * static_cast<std::size_t>(image.channels) + (image.channels >= 3 ? channel : 0);
}

const std::uint16_t* u16(const Image& image)
{
    return reinterpret_cast<const std::uint16_t*>(image.bytes.data());
}

double signed_value(const Image& image, std::size_t texel, std::size_t channel)
{
    const std::size_t at = place_of(image, texel, channel);
    if (image.type == PixelType::u8)
        return std::max((std::to_integer<int>(image.bytes[at]) - 128) / 127.0, -1.0);
    if (image.type == PixelType::u16)
        return std::max((u16(image)[at] - 32768) / 32767.0, -1.0);
    return static_cast<double>(image.f32()[at]);
}

double unit_value(const Image& image, std::size_t texel, std::size_t channel)
{
    const std::size_t at = place_of(image, texel, channel);
    if (image.type == PixelType::u8)
        return std::to_integer<int>(image.bytes[at]) / 255.0;
    return image.type == PixelType::u16 ? u16(image)[at] / 65535.0 : static_cast<double>(image.f32()[at]);
}

std::uint16_t code16(double unit)
{
    return static_cast<std::uint16_t>(std::clamp(unit, 0.0, 1.0) * 65535.0 + 0.5);
}

// Scales (x, y, z) to unit length. Returns false where the vector has no usable length.
bool normalize(double& x, double& y, double& z)
{
    const double length = std::sqrt(x * x + y * y + z * z);
    if (!(length > 1e-4 && length < 1e30))
        return false;
    x /= length, y /= length, z /= length;
    return true;
}

PixelType metal_rough_type(const Image& metallic, const Image& roughness)
{
    const auto is_short = [](const Image& image) { return image.empty() || image.type == PixelType::u8; };
    return is_short(metallic) && is_short(roughness) ? PixelType::u8 : PixelType::u16;
}

} // namespace

SurfaceMap normals_of_quaternions(const Image& quaternions)
{
    SurfaceMap map = {make_image(quaternions.width, quaternions.height, 3, PixelType::u16)};
    auto* to = reinterpret_cast<std::uint16_t*>(map.image.bytes.data());
    for (std::size_t i = 0; i < texels_of(quaternions); ++i, to += 3) {
        double a = signed_value(quaternions, i, 0), b = signed_value(quaternions, i, 1), c = signed_value(quaternions, i, 2);
        if (!normalize(a, b, c))
            a = 1.0, b = c = 0.0, ++map.repaired;
        to[0] = code16(0.5 - a * c), to[1] = code16(0.5 + a * b), to[2] = code16(0.5 + 0.5 * (a * a - b * b - c * c));
    }
    return map;
}

SurfaceMap quaternions_of_normals(const Image& normals, PixelType type)
{
    SurfaceMap map = {make_image(normals.width, normals.height, 3, type)};
    for (std::size_t i = 0; i < texels_of(normals); ++i) {
        double x = 2.0 * unit_value(normals, i, 0) - 1.0, y = 2.0 * unit_value(normals, i, 1) - 1.0;
        double z = 2.0 * unit_value(normals, i, 2) - 1.0;
        if (!normalize(x, y, z))
            x = y = 0.0, z = 1.0, ++map.repaired;
        double q[3] = {0.0, 1.0, 0.0}; // half a turn about x
        const double a = std::sqrt(z < 0.0 ? (x * x + y * y) / (2.0 * (1.0 - z)) : 0.5 * (1.0 + z));
        if (a >= 1e-6)
            q[0] = a, q[1] = y / (2.0 * a), q[2] = -x / (2.0 * a);
        for (std::size_t c = 0; c < 3; ++c)
            if (type == PixelType::u8)
                map.image.bytes[3 * i + c] = static_cast<std::byte>(128 + static_cast<int>(std::lround(127.0 * q[c])));
            else if (type == PixelType::u16)
                reinterpret_cast<std::uint16_t*>(map.image.bytes.data())[3 * i + c] =
                    static_cast<std::uint16_t>(32768 + std::lround(32767.0 * q[c]));
            else
                map.image.f32()[3 * i + c] = static_cast<float>(q[c]);
    }
    return map;
}

SurfaceMap directions_of_rotations(const Image& rotations, RotationEncoding encoding)
{
    SurfaceMap map = {make_image(rotations.width, rotations.height, 3, PixelType::u16)};
    auto* to = reinterpret_cast<std::uint16_t*>(map.image.bytes.data());
    const bool khr = encoding == RotationEncoding::direction;
    for (std::size_t i = 0; i < texels_of(rotations); ++i, to += 3) {
        double x = khr ? 2.0 * unit_value(rotations, i, 0) - 1.0 : signed_value(rotations, i, 0);
        double y = khr ? 2.0 * unit_value(rotations, i, 1) - 1.0 : signed_value(rotations, i, 1), none = 0.0;
        double strength = khr ? unit_value(rotations, i, 2) : 1.0;
        if (khr && (x * x + y * y < 1e-4 || !std::isfinite(strength)))
            x = 1.0, y = 0.0, strength = 0.0; // the value of a texture without direction
        if (!normalize(x, y, none))
            x = 1.0, y = 0.0, ++map.repaired;
        if (encoding == RotationEncoding::double_angle) { // halves an angle from -180 to 180 degrees
            const double cosine = std::sqrt(std::max(0.5 + 0.5 * x, 0.0)), sine = std::sqrt(std::max(0.5 - 0.5 * x, 0.0));
            x = cosine, y = y < 0.0 ? -sine : sine;
        }
        if (code16(0.5 + 0.5 * y) < code16(0.5)) // picks the upper of two opposite directions, or the one along the tangent
            x = -x, y = -y;
        if (code16(0.5 + 0.5 * y) == code16(0.5))
            x = std::abs(x);
        to[0] = code16(0.5 + 0.5 * x), to[1] = code16(0.5 + 0.5 * y), to[2] = code16(strength);
    }
    return map;
}

SurfaceMap whole_normals(Image normals)
{
    SurfaceMap map = {std::move(normals)};
    if (map.image.type != PixelType::f32)
        return map;
    for (std::size_t i = 0; i < texels_of(map.image); ++i) {
        double n[3];
        for (std::size_t c = 0; c < 3; ++c)
            n[c] = 2.0 * unit_value(map.image, i, c) - 1.0;
        if (normalize(n[0], n[1], n[2]))
            continue;
        for (std::size_t c = 0; c < 3; ++c)
            map.image.f32()[place_of(map.image, i, c)] = c == 2 ? 1.0f : 0.5f;
        ++map.repaired;
    }
    return map;
}

void flip_green(Image& normals)
{
    if (normals.channels < 3)
        return;
    for (std::size_t i = 0; i < texels_of(normals); ++i) {
        const std::size_t at = place_of(normals, i, 1);
        if (normals.type == PixelType::u8)
            normals.bytes[at] = static_cast<std::byte>(255 - std::to_integer<int>(normals.bytes[at]));
        else if (normals.type == PixelType::u16)
            reinterpret_cast<std::uint16_t*>(normals.bytes.data())[at] = static_cast<std::uint16_t>(65535 - u16(normals)[at]);
        else
            normals.f32()[at] = 1.0f - normals.f32()[at];
    }
}

std::uint64_t metal_rough_bytes(const Image& metallic, const Image& roughness)
{
    const auto most = [](int a, int b) { return static_cast<std::uint64_t>(std::max(a, b)); };
    const std::uint64_t texel = metal_rough_type(metallic, roughness) == PixelType::u8 ? 3 : 6;
    return most(metallic.width, roughness.width) * most(metallic.height, roughness.height) * texel;
}

std::uint16_t red_at(const Image& image, int x, int y, int width, int height)
{
    if (image.empty())
        return 65535;
    const auto along = [](int at, int count, int texels) {
        return static_cast<std::size_t>((2 * static_cast<std::int64_t>(at) + 1) * texels / (2 * count));
    };
    const std::size_t texel = along(y, height, image.height) * static_cast<std::size_t>(image.width) + along(x, width, image.width);
    const std::size_t at = texel * static_cast<std::size_t>(image.channels);
    if (image.type == PixelType::u8)
        return static_cast<std::uint16_t>(257 * std::to_integer<int>(image.bytes[at]));
    if (image.type == PixelType::u16)
        return reinterpret_cast<const std::uint16_t*>(image.bytes.data())[at];
    const float value = image.f32()[at];
    return static_cast<std::uint16_t>((value > 0.0f ? std::min(value, 1.0f) : 0.0f) * 65535.0f + 0.5f);
}

Image metal_rough_of(const Image& metallic, const Image& roughness)
{
    const int width = std::max(metallic.width, roughness.width), height = std::max(metallic.height, roughness.height);
    const auto put = [&](auto* to, int unit) { // codes of 16 bits an own one
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x, to += 3)
                for (int c = 0; c < 3; ++c)
                    to[c] = static_cast<std::remove_reference_t<decltype(*to)>>(
                        c == 0 ? 65535 / unit : red_at(c == 1 ? roughness : metallic, x, y, width, height) / unit);
    };
    Image out = make_image(width, height, 3, metal_rough_type(metallic, roughness));
    if (out.type == PixelType::u8)
        put(reinterpret_cast<std::uint8_t*>(out.bytes.data()), 257);
    else
        put(reinterpret_cast<std::uint16_t*>(out.bytes.data()), 1);
    return out;
}

} // namespace burnish
