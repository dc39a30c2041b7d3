#include "shading/bake/tables/phong_files.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

#include "core/image/io/image_io.h"
#include "core/math/scalar_math.h"
#include "shading/bake/environment/environment.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

const float* texel(const Image& image, int x, int y)
{
    return image.f32() + (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)) *
                             static_cast<std::size_t>(image.channels);
}

Error no_table(const std::string& path, const std::string& why)
{
    return {ExitCode::bad_input, path, "", why};
}

// Converts a picture's codes to numbers: half vectors to -1 to 1, where code 128 is 0; albedos to 0 to 1.
Image as_floats(const Image& from, int channels, bool is_signed)
{
    Image to = make_image(from.width, from.height, channels, PixelType::f32);
    const std::size_t texels = static_cast<std::size_t>(from.width) * static_cast<std::size_t>(from.height);
    const bool wide = from.type == PixelType::u16;
    const double zero = is_signed ? (wide ? 32768.0 : 128.0) : 0.0, one = wide ? 65535.0 : 255.0;
    for (std::size_t i = 0; i < texels; ++i)
        for (int c = 0; c < std::min(channels, from.channels); ++c) {
            const std::size_t at = i * static_cast<std::size_t>(from.channels) + static_cast<std::size_t>(c);
            float& value = to.f32()[i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)];
            if (from.type == PixelType::f32) {
                value = from.f32()[at];
                continue;
            }
            const double code = wide ? static_cast<double>(reinterpret_cast<const std::uint16_t*>(from.bytes.data())[at])
                                     : static_cast<double>(std::to_integer<int>(from.bytes[at]));
            value = static_cast<float>((code - zero) / (one - zero));
        }
    return to;
}

int texel_below(double xi, int texels)
{
    return std::clamp(static_cast<int>(std::floor(xi * texels)), 0, texels - 1);
}

} // namespace

Result<PhongFiles> PhongFiles::read(const std::vector<std::string>& paths, const Limits& limits)
{
    PhongFiles tables;
    for (const std::string& path : paths) {
        std::error_code failed;
        if (!fs::is_directory(path, failed)) {
            BN_TRY(tables.add(path, limits));
            continue;
        }
        std::vector<std::string> files;
        for (fs::directory_iterator at(path, failed), end; !failed && at != end; at.increment(failed))
            if (at->is_regular_file(failed))
                files.push_back(at->path().string());
        if (failed)
            return no_table(path, failed.message());
        std::sort(files.begin(), files.end());
        if (files.empty())
            return no_table(path, "the folder holds no table");
        for (const std::string& file : files)
            BN_TRY(tables.add(file, limits));
    }
    return tables;
}

Result<PhongFiles> PhongFiles::of(const Image& picture, const std::string& name)
{
    PhongFiles tables;
    BN_TRY(tables.add(picture, name));
    return tables;
}

Status PhongFiles::add(const std::string& path, const Limits& limits)
{
    const Result<Image> picture = read_image(path, limits);
    return picture ? add(*picture, path) : picture.error();
}

Status PhongFiles::add(const Image& picture, const std::string& path)
{
    if (picture.channels < 3)
        return no_table(path, "a table of half vectors or of albedo has red, green and blue");
    const bool eight = picture.type == PixelType::u8;
    // The first half vector is the normal. An albedo table has blue 0.
    const Image vectors = as_floats(picture, 4, true);
    const float* first = texel(vectors, 0, 0);
    if (std::fabs(first[0]) < 0.01f && std::fabs(first[1]) < 0.01f && std::fabs(first[2] - 1.0f) < 0.01f) {
        half_path_ = path, half_ = vectors, half_codes_ = 0;
        const std::size_t texels = vectors.bytes.size() / (4 * sizeof(float));
        std::bitset<256> codes;
        for (std::size_t i = 0; i < texels; ++i) {
            float* h = half_.f32() + 4 * i;
            if (picture.type != PixelType::f32 || picture.channels < 4)
                h[3] = 0.0f;
            const double x = static_cast<double>(h[0]), y = static_cast<double>(h[1]), z = static_cast<double>(h[2]);
            const double length = std::sqrt(x * x + y * y + z * z);
            if (!(std::fabs(length - 1.0) < (eight ? 0.02 : 1e-3)) || z < 0.0 || !std::isfinite(h[3]) || h[3] < 0.0f)
                return no_table(path, fmt::format("texel {},{} holds no half vector", i % static_cast<std::size_t>(half_.width),
                                                  i / static_cast<std::size_t>(half_.width)));
            if (eight) {
                codes.set(static_cast<std::size_t>(std::to_integer<int>(picture.bytes[i * static_cast<std::size_t>(picture.channels)])));
                for (int c = 0; c < 3; ++c)
                    h[c] = static_cast<float>(static_cast<double>(h[c]) / length);
            }
        }
        half_codes_ = eight ? static_cast<int>(codes.count()) : 0;
        return {};
    }
    // Other pictures are albedo tables
    albedo_path_ = path, albedo_ = as_floats(picture, 3, false), albedo_8_ = eight;
    if (albedo_.width < 2 || albedo_.height < 2)
        return no_table(path, "a table of albedo has two texels along each axis at least");
    const std::size_t values = albedo_.bytes.size() / sizeof(float);
    for (std::size_t i = 0; i < values; ++i)
        if (const float value = albedo_.f32()[i]; !(value >= 0.0f && value <= 1.01f))
            return no_table(path, "holds neither half vectors nor albedos");
    return {};
}

std::vector<std::string> PhongFiles::warnings(int samples) const
{
    std::vector<std::string> lines;
    if (has_half_vectors()) {
        const int side = phong_grid(samples);
        if (half_codes_ > 0)
            lines.push_back(fmt::format("{}: 8 bits leave {} values along the first axis, and no densities", half_path_, half_codes_));
        if (half_.width % side != 0 || half_.height % side != 0)
            lines.push_back(fmt::format("{}: {}x{} texels do not hold {} samples, which take the nearest ones below; {}x{} would",
                                        half_path_, half_.width, half_.height, samples, side, side));
    }
    if (albedo_8_)
        lines.push_back(fmt::format("{}: 8 bits leave albedos that are off by up to 0.002", albedo_path_));
    return lines;
}

std::vector<PhongHalfVector> PhongFiles::half_vectors(double nu, double nv, int samples) const
{
    const bool across = half_off_by(nv, nu) < half_off_by(nu, nv);
    std::vector<PhongHalfVector> found;
    for (int i = 0; i < kPhongSets * samples; ++i) {
        const PhongPoint xi = phong_point(i % samples, samples, i / samples);
        const double turned = 1.25 - xi.x, at = !across ? xi.x : turned < 1.0 ? turned : turned - 1.0;
        const float* held = texel(half_, texel_below(at, half_.width), texel_below(xi.y, half_.height));
        PhongHalfVector h = {static_cast<double>(held[0]), static_cast<double>(held[1]), static_cast<double>(held[2]),
                             static_cast<double>(held[3])};
        // Exchange axes, and compute a density that the file lacks
        if (across)
            std::swap(h.x, h.y);
        if (h.density == 0.0) {
            const double r2 = h.x * h.x + h.y * h.y, e = r2 > 0.0 ? (nu * h.x * h.x + nv * h.y * h.y) / r2 : 0.0;
            h.density = std::sqrt((nu + 1.0) * (nv + 1.0)) / (2.0 * kPi) * det_exp(e * det_log(std::max(h.z, 1e-20)));
        }
        found.push_back(h);
    }
    return found;
}

PhongAlbedo PhongFiles::albedo(Columns columns, double root_n_dot_v, double root_along) const
{
    double across = root_along;
    if (columns != Columns::root) {
        const double azimuth = 2.0 / kPi * det_acos(root_along * root_along);
        across = columns == Columns::linear ? azimuth : 1.0 - azimuth;
    }
    const double x = across * (albedo_.width - 1), y = root_n_dot_v * (albedo_.height - 1);
    const int ix = std::min(static_cast<int>(x), albedo_.width - 2), iy = std::min(static_cast<int>(y), albedo_.height - 2);
    const double fx = x - ix, fy = y - iy;
    PhongAlbedo sum = {0.0, 0.0};
    for (int corner = 0; corner < 4; ++corner) {
        const double part = (corner % 2 ? fx : 1.0 - fx) * (corner / 2 ? fy : 1.0 - fy);
        if (part == 0.0)
            continue;
        const float* t = texel(albedo_, ix + corner % 2, iy + corner / 2);
        sum.s += part * static_cast<double>(t[0]), sum.b += part * static_cast<double>(t[1]);
    }
    return sum;
}

double PhongFiles::albedo_off_by(double nu, double nv, Columns columns) const
{
    constexpr int kPlaces = 5; // texels to compare along each axis
    double most = 0.0;
    for (int j = 1; j <= kPlaces; ++j)
        for (int i = 0; i < kPlaces; ++i) {
            const int x = i * (albedo_.width - 1) / (kPlaces - 1), y = j * (albedo_.height - 1) / kPlaces;
            double root = static_cast<double>(x) / (albedo_.width - 1);
            if (columns != Columns::root) {
                const double azimuth = columns == Columns::linear ? root : 1.0 - root;
                root = std::sqrt(std::max(det_cos(0.5 * kPi * azimuth), 0.0));
            }
            const PhongAlbedo own = phong_albedo_at(nu, nv, static_cast<double>(y) / (albedo_.height - 1), root);
            const float* held = texel(albedo_, x, y);
            most = std::max({most, std::fabs(own.s - static_cast<double>(held[0])), std::fabs(own.b - static_cast<double>(held[1]))});
        }
    return most;
}

PhongFiles::Columns PhongFiles::nearest_columns(double nu, double nv) const
{
    Columns nearest = Columns::root;
    double least = albedo_off_by(nu, nv, nearest);
    for (const Columns other : {Columns::linear, Columns::linear_exchanged})
        if (const double off = albedo_off_by(nu, nv, other); off < least)
            nearest = other, least = off;
    return nearest;
}

void PhongFiles::slice(double nu, double nv, int size, float* pairs) const
{
    const Columns columns = nearest_columns(nu, nv);
    fill_phong_slice(
        size, [&](double eye, double root) { return albedo(columns, eye, root); }, pairs);
}

double PhongFiles::half_off_by(double nu, double nv) const
{
    double most = 0.0;
    const int step_x = std::max(half_.width / 16, 1), step_y = std::max(half_.height / 16, 1);
    for (int y = 0; y < half_.height; y += step_y)
        for (int x = 0; x < half_.width; x += step_x) {
            const PhongHalfVector own =
                phong_half_vector(nu, nv, static_cast<double>(x) / half_.width, static_cast<double>(y) / half_.height);
            const float* held = texel(half_, x, y);
            most = std::max({most, std::fabs(own.x - static_cast<double>(held[0])), std::fabs(own.y - static_cast<double>(held[1])),
                             std::fabs(own.z - static_cast<double>(held[2]))});
        }
    return most;
}

Status PhongFiles::check(double nu, double nv) const
{
    const double most_half = half_codes_ > 0 ? 0.012 : 1e-4, most_albedo = albedo_8_ ? 0.006 : 0.003;
    const auto other = [&](const std::string& path, double off) {
        return no_table(
            path, fmt::format("is off by {:.2g} from the lobe with nu {:.5g} along one axis and nv {:.5g} along the other", off, nu, nv));
    };
    if (has_half_vectors())
        if (const double off = std::min(half_off_by(nu, nv), half_off_by(nv, nu)); off > most_half)
            return other(half_path_, off);
    if (has_albedo())
        if (const double off = albedo_off_by(nu, nv, nearest_columns(nu, nv)); off > most_albedo)
            return other(albedo_path_, off);
    return {};
}

} // namespace burnish
