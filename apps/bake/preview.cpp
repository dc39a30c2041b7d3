#include "apps/bake/preview.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fmt/core.h>

#include "apps/cli/outputs.h"
#include "core/image/colour.h"
#include "core/image/io/image_io.h"
#include "core/image/magma.h"
#include "core/math/scalar_math.h"
#include "core/simd/half.h"

namespace burnish {
namespace {

constexpr int kPreviewSide = 256; // pixels: small tables are enlarged to about this side

std::string preview_path(const std::string& folder, const PreviewPicture& picture)
{
    return (std::filesystem::path(folder) / (picture.name + ".png")).string();
}

std::byte preview_code(double unit)
{
    return static_cast<std::byte>(static_cast<int>(std::clamp(unit, 0.0, 1.0) * 255.0 + 0.5));
}

std::size_t pixels_of(const Image& image)
{
    return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

Image in_8_bits(const Image& sixteen)
{
    Image out = make_image(sixteen.width, sixteen.height, sixteen.channels, PixelType::u8);
    const auto* from = reinterpret_cast<const std::uint16_t*>(sixteen.bytes.data());
    for (std::size_t i = 0; i < out.bytes.size(); ++i)
        out.bytes[i] = preview_code(from[i] / 65535.0);
    return out;
}

// Maps x, y, z from [-1,1] to colours. Texels have `channels` values.
Image colours_of_vectors(int width, int height, const float* from, std::size_t channels)
{
    Image out = make_image(width, height, 3, PixelType::u8);
    for (std::size_t i = 0; i < pixels_of(out); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            out.bytes[3 * i + c] = preview_code(0.5 + 0.5 * static_cast<double>(from[channels * i + c]));
    return out;
}

// turn: position on the colour circle, [0,1). Full saturation gives the pure colour, 0 gives white.
std::array<double, 3> colour_of_hue(double turn, double saturation)
{
    std::array<double, 3> rgb{};
    const double sixths[3] = {turn * 6.0, turn * 6.0 + 4.0, turn * 6.0 + 2.0};
    for (std::size_t c = 0; c < 3; ++c) {
        const double at = sixths[c] - 6.0 * std::floor(sixths[c] / 6.0); // red lies around 0
        rgb[c] = 1.0 - saturation * (1.0 - std::clamp(std::fabs(at - 3.0) - 1.0, 0.0, 1.0));
    }
    return rgb;
}

// Returns the radiance of a cube level in the direction (x, y, z), interpolated between texels.
std::array<float, 3> seen_in_cube(const CubeMap& cube, int level, double x, double y, double z)
{
    const double ax = std::fabs(x), ay = std::fabs(y), az = std::fabs(z), most = std::max({ax, ay, az});
    const int axis = ax == most ? 0 : ay == most ? 1 : 2;
    const double major = axis == 0 ? x : axis == 1 ? y : z;
    const double sign = major < 0.0 ? -1.0 : 1.0;
    const double u = (axis == 0 ? -z * sign : axis == 1 ? x : x * sign) / most;
    const double v = (axis == 1 ? z * sign : -y) / most;
    const int size = cube.size >> level, row = size + 2;
    const double px = (0.5 + 0.5 * u) * size + 0.5, py = (0.5 + 0.5 * v) * size + 0.5;
    const int ix = std::min(static_cast<int>(px), size), iy = std::min(static_cast<int>(py), size);
    const double fx = px - ix, fy = py - iy;
    const std::size_t face = static_cast<std::size_t>(2 * axis + (major < 0.0 ? 1 : 0));
    const std::size_t first =
        cube.offset[static_cast<std::size_t>(level)] + face * static_cast<std::size_t>(row) * static_cast<std::size_t>(row);
    std::array<float, 3> rgb{};
    for (std::size_t c = 0; c < 3; ++c) {
        const auto at = [&](int dx, int dy) {
            const std::size_t texel =
                first + static_cast<std::size_t>(iy + dy) * static_cast<std::size_t>(row) + static_cast<std::size_t>(ix + dx);
            return static_cast<double>(half_to_float(cube.texels[4 * texel + c]));
        };
        const double upper = at(0, 0) * (1.0 - fx) + at(1, 0) * fx, lower = at(0, 1) * (1.0 - fx) + at(1, 1) * fx;
        rgb[c] = static_cast<float>((upper * (1.0 - fy) + lower * fy) * static_cast<double>(cube.scale));
    }
    return rgb;
}

Image all_around(const CubeMap& cube, int level)
{
    Image out = make_image(2 * kPreviewSide, kPreviewSide, 3, PixelType::f32);
    float* to = out.f32();
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x, to += 3) {
            const double around = 2.0 * kPi * ((x + 0.5) / out.width - 0.5), down = kPi * (y + 0.5) / out.height;
            const std::array<float, 3> rgb =
                seen_in_cube(cube, level, det_cos(around) * det_sin(down), det_cos(down), det_sin(around) * det_sin(down));
            std::copy(rgb.begin(), rgb.end(), to);
        }
    return tonemap_to_srgb8(out, Tonemap::pbr_neutral, 0.0f);
}

} // namespace

Image enlarged(const Image& image)
{
    const int times = std::max(kPreviewSide / std::max(image.width, image.height), 1);
    Image out = make_image(image.width * times, image.height * times, image.channels, image.type);
    const std::size_t bytes = static_cast<std::size_t>(image.channels) * pixel_type_bytes(image.type);
    std::size_t at = 0;
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x, at += bytes) {
            const std::size_t texel =
                static_cast<std::size_t>(y / times) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x / times);
            std::copy_n(image.bytes.begin() + static_cast<std::ptrdiff_t>(texel * bytes), bytes,
                        out.bytes.begin() + static_cast<std::ptrdiff_t>(at));
        }
    return out;
}

Status check_preview(const std::string& folder, const Preview& pictures, const std::vector<std::string>& files)
{
    for (const PreviewPicture& picture : pictures)
        for (const std::string& file : files)
            if (!folder.empty() && !file.empty() && same_file(preview_path(folder, picture), file))
                return usage_error("--preview", fmt::format("'{}' would be written over", file));
    return {};
}

Status write_preview(const std::string& folder, const Preview& pictures, Report& report)
{
    if (folder.empty())
        return {};
    BN_TRY(make_output_folder(folder));
    for (const PreviewPicture& picture : pictures) {
        const std::string path = preview_path(folder, picture);
        BN_TRY(write_image(path, picture.image));
        report.wrote(path);
    }
    return {};
}

Preview preview_of_rotations(const Image& map, RotationEncoding encoding)
{
    const Image directions = directions_of_rotations(map, encoding).image; // decoded as the renderer decodes it
    const auto* from = reinterpret_cast<const std::uint16_t*>(directions.bytes.data());
    const std::size_t channels = static_cast<std::size_t>(directions.channels);
    Image out = make_image(map.width, map.height, 3, PixelType::u8);
    for (std::size_t i = 0; i < pixels_of(out); ++i) {
        const std::uint16_t* t = from + channels * i;
        const double angle = det_atan2(t[1] / 32767.5 - 1.0, t[0] / 32767.5 - 1.0);
        const std::array<double, 3> rgb = colour_of_hue(angle / kPi, t[2] / 65535.0);
        for (std::size_t c = 0; c < 3; ++c)
            out.bytes[3 * i + c] = preview_code(rgb[c]);
    }
    return {{"grain", enlarged(out)}};
}

Preview preview_of_quaternions(const Image& map)
{
    return {{"normals", enlarged(in_8_bits(normals_of_quaternions(map).image))}};
}

Preview preview_of_half_vectors(const Image& table)
{
    const std::size_t channels = static_cast<std::size_t>(table.channels), texels = pixels_of(table);
    std::vector<float> vectors(3 * texels);
    for (std::size_t i = 0; i < texels; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            vectors[3 * i + c] = table.type == PixelType::f32
                                     ? table.f32()[channels * i + c]
                                     : static_cast<float>(static_cast<int>(table.bytes[channels * i + c]) - 128) / 127.0f;
    Preview pictures = {{"half_vectors", enlarged(colours_of_vectors(table.width, table.height, vectors.data(), 3))}};
    if (channels < 4)
        return pictures;
    float most = 0.0f;
    for (std::size_t i = 0; i < texels; ++i)
        most = std::max(most, table.f32()[4 * i + 3]);
    Image density = make_image(table.width, table.height, 1, PixelType::f32);
    for (std::size_t i = 0; i < texels; ++i) {
        const double share = static_cast<double>(table.f32()[4 * i + 3]) / std::max(static_cast<double>(most), 1e-30);
        density.f32()[i] = static_cast<float>(1.0 + det_log(std::max(share, 1e-30)) / det_log(1000.0));
    }
    pictures.push_back({"density", enlarged(magma_map(density))});
    return pictures;
}

Preview preview_of_albedo(const Image& table)
{
    Image out = make_image(table.width, table.height, 3, PixelType::u8);
    for (std::size_t i = 0; i < out.bytes.size(); ++i)
        out.bytes[i] = preview_code(static_cast<double>(table.f32()[i]));
    return {{"albedo", enlarged(out)}};
}

Preview preview_of_environment(const Environment& environment)
{
    Preview pictures;
    for (int level = 0; level < environment.specular.levels; ++level)
        pictures.push_back({fmt::format("radiance_{:02}", level), all_around(environment.specular, level)});
    pictures.push_back({"irradiance", all_around(environment.irradiance, 0)});
    if (!environment.extracted_lights.empty())
        pictures.push_back({"whole", all_around(environment.whole, 0)});
    return pictures;
}

Preview preview_of_heights(const Image& heights, double depth)
{
    const auto channels = static_cast<std::size_t>(heights.channels);
    const auto at = [&](int x, int y) {
        const std::size_t column = static_cast<std::size_t>((x + heights.width) % heights.width);
        const std::size_t row = static_cast<std::size_t>((y + heights.height) % heights.height);
        const std::size_t i = channels * (row * static_cast<std::size_t>(heights.width) + column);
        if (heights.type == PixelType::u8)
            return static_cast<int>(heights.bytes[i]) / 255.0;
        if (heights.type == PixelType::u16)
            return reinterpret_cast<const std::uint16_t*>(heights.bytes.data())[i] / 65535.0;
        const double value = static_cast<double>(heights.f32()[i]);
        return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0.0;
    };
    Image grey = make_image(heights.width, heights.height, 1, PixelType::u8);
    std::vector<float> normals(3 * pixels_of(grey));
    std::size_t i = 0;
    for (int y = 0; y < heights.height; ++y)
        for (int x = 0; x < heights.width; ++x, ++i) {
            grey.bytes[i] = preview_code(at(x, y));
            const double rise_x = (at(x + 1, y) - at(x - 1, y)) * 0.5 * heights.width * depth;  // along the tangent
            const double rise_y = (at(x, y - 1) - at(x, y + 1)) * 0.5 * heights.height * depth; // green points up
            const double length = std::sqrt(rise_x * rise_x + rise_y * rise_y + 1.0);
            normals[3 * i] = static_cast<float>(-rise_x / length), normals[3 * i + 1] = static_cast<float>(-rise_y / length);
            normals[3 * i + 2] = static_cast<float>(1.0 / length);
        }
    return {{"heights", enlarged(grey)}, {"normals", enlarged(colours_of_vectors(heights.width, heights.height, normals.data(), 3))}};
}

} // namespace burnish
