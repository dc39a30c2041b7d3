#include "apps/bake/mip_textures.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/core.h>

#include "apps/cli/outputs.h"
#include "core/base/file.h"
#include "core/image/colour.h"
#include "core/image/io/image_io.h"
#include "core/image/io/png_write.h"
#include "raster/frame/colours.h"
#include "raster/frame/mip_files.h"
#include "shading/bake/mip/anisotropy.h"
#include "shading/bake/mip/grid.h"
#include "shading/bake/mip/mip_error.h"
#include "shading/bake/mip/source.h"
#include "shading/bake/mip/standard_textures.h"

namespace burnish {

namespace {

namespace fs = std::filesystem;

std::vector<Image> metallic_levels(const Scene& scene, const Material& m, const MipSource& source, const MipArguments& a, const Jobs& jobs)
{
    if (!m.metallic_roughness_tex.used())
        return {};
    const Image& image =
        scene.images[static_cast<std::size_t>(scene.textures[static_cast<std::size_t>(m.metallic_roughness_tex.texture)].image)];
    const Grid grid = grid_of(source.maps());
    const Image metallic = linear_map(image, grid, false, 2, 1, &m.metallic);
    const Image facing = a.couple_albedo ? facing_of(source, jobs) : Image();
    return colour_levels(metallic, {a.color_kernel, grid.wrap_s, grid.wrap_t, a.couple_albedo ? &facing : nullptr});
}

std::vector<Image> base_color_levels(const Scene& scene, const Material& m, const MaterialMips& mips, const MipSource& source,
                                     const MipArguments& a, const Jobs& jobs)
{
    const float factor[4] = {m.base_color.x, m.base_color.y, m.base_color.z, m.base_color.w};
    if (!m.base_color_tex.used()) {
        Image one = make_image(1, 1, 3, PixelType::f32);
        std::copy_n(factor, 3, one.f32());
        return {one};
    }
    const Texture& texture = scene.textures[static_cast<std::size_t>(m.base_color_tex.texture)];
    const Image& image = scene.images[static_cast<std::size_t>(texture.image)];
    const Grid grid = {image.width, image.height, texture.wrap_s, texture.wrap_t, texture.nearest};
    const Image linear = linear_map(image, grid, true, 0, image.channels == 4 ? 4 : 3, factor);
    const bool coupled = is_coupled(scene, m, mips, m.base_color_tex);
    Image facing;
    const float one = 1.0f;
    if (coupled)
        facing = linear_map(facing_of(source, jobs), grid, false, 0, 1, &one);
    return colour_levels(linear, {a.color_kernel, texture.wrap_s, texture.wrap_t, coupled ? &facing : nullptr});
}

Image one_colour(int width, int height, const Image& of)
{
    Image to = make_image(width, height, of.channels, PixelType::f32);
    for (std::size_t i = 0; i < to.bytes.size() / sizeof(float); ++i)
        to.f32()[i] = of.f32()[i % static_cast<std::size_t>(of.channels)];
    return to;
}

// Multiplies base-colour levels by the gains of the levels nearest in size. Results stay at most 1, or the base colour if larger. A
// uniform colour gets levels in the maps' sizes.
std::vector<Image> with_gains(std::vector<Image> colours, const MipLevels& levels)
{
    if (levels.gained == 0)
        return colours;
    if (colours.size() == 1) {
        const Image of = std::move(colours[0]);
        colours[0] = one_colour(levels.width, levels.height, of);
        for (const MipLevel& level : levels.levels)
            colours.push_back(one_colour(level.width, level.height, of));
    }
    for (Image& colour : colours) {
        const auto off = [&](int width, int height) { return std::abs(std::max(colour.width, colour.height) - std::max(width, height)); };
        float gain = 1.0f; // level 0
        int least = off(levels.width, levels.height);
        for (const MipLevel& level : levels.levels)
            if (off(level.width, level.height) < least)
                least = off(level.width, level.height), gain = level.gain;
        for (std::size_t i = 0; i < colour.bytes.size() / sizeof(float); ++i)
            if (float& c = colour.f32()[i]; colour.channels != 4 || i % 4 != 3)
                c = std::min(c * gain, std::max(c, 1.0f));
    }
    return colours;
}

Image coded(const Image& unit, bool srgb)
{
    Image to = make_image(unit.width, unit.height, unit.channels, PixelType::u8);
    for (std::size_t i = 0; i < to.bytes.size(); ++i) {
        const bool alpha = unit.channels == 4 && i % 4 == 3;
        const float x = std::clamp(unit.f32()[i], 0.0f, 1.0f);
        to.bytes[i] = static_cast<std::byte>(static_cast<int>((srgb && !alpha ? linear_to_srgb(x) : x) * 255.0f + 0.5f));
    }
    return to;
}

// inputs: must not be overwritten
Status add_file(FileSet& files, const std::string& name, const std::vector<std::uint8_t>& bytes, const std::vector<std::string>& inputs)
{
    for (const std::string& input : inputs)
        if (same_file(name, input))
            return Error{ExitCode::usage, "-o", "", fmt::format("'{}' would be written over", input)};
    return files.add(fs::path(name).filename().string(), bytes.data(), bytes.size());
}

Status add_levels(FileSet& files, const std::vector<std::string>& inputs, const std::string& stem, const std::vector<Image>& levels,
                  bool srgb, MipFormat format, std::vector<std::string>& names)
{
    if (format == MipFormat::exr_mip) {
        names.push_back(stem + ".exr");
        const Result<std::vector<std::uint8_t>> bytes = encode_exr_levels(names.back(), levels);
        return bytes ? add_file(files, names.back(), *bytes, inputs) : Status(bytes.error());
    }
    for (std::size_t l = 0; l < levels.size(); ++l) {
        names.push_back(fmt::format("{}_{:02}.png", stem, l));
        const Result<std::vector<std::uint8_t>> bytes = png_bytes(names.back(), coded(levels[l], srgb));
        BN_TRY(bytes);
        BN_TRY(add_file(files, names.back(), *bytes, inputs));
    }
    return {};
}

struct Off {
    double at = 0.0, between = 0.0; // at texel centres, between texels
};

// Formats mean errors, each level weighted equally, and the level with the worst error between texels. Skips levels above kMostShown
// texels.
constexpr std::size_t kMostShown = 1u << 14;

std::string figures_of(const std::string& name, const StandardLevels& held, const MipSource& source, const MipLevels& levels,
                       const MipErrorSurface& surface, const Jobs& jobs)
{
    const auto texels = [&](std::size_t l) { return held.normal[l].bytes.size() / (3 * sizeof(float)); };
    std::size_t first = 0;
    while (texels(first) > kMostShown)
        ++first;
    std::vector<Off> off(held.normal.size() - first);
    jobs.parallel_for(off.size(), [&](std::size_t l, int) {
        const auto by = [&](bool between) {
            return mip_difference(standard_texels(held, first + l, between), filtered_texels(source, levels, first + l, between), surface)
                .l1;
        };
        off[l] = {by(false), by(true)};
    });
    Off mean;
    std::size_t worst = 0;
    for (std::size_t l = 0; l < off.size(); ++l) {
        mean.at += off[l].at / static_cast<double>(off.size()), mean.between += off[l].between / static_cast<double>(off.size());
        worst = off[l].between > off[worst].between ? l : worst;
    }
    const Image& at = held.normal[first + worst];
    return fmt::format("{}: L1 {:.5f} at texels, {:.5f} between them; most at level {}, {}x{}: {:.5f}\n", name, mean.at, mean.between,
                       first + worst, at.width, at.height, off[worst].between);
}

} // namespace

Result<WrittenTextures> write_mip_textures(const std::string& folder, const SceneData& data, const MaterialLevels& levels,
                                           const MipArguments& a, const Jobs& jobs)
{
    const Scene& scene = data.scene;
    WrittenTextures written;
    const auto write = [&]() -> Status {
        FileSet files(folder);
        std::vector<std::string> materials;
        for (const Material& m : scene.materials)
            materials.push_back(m.name);
        const std::vector<std::string> names = plain_names(materials);
        for (std::size_t i = 0; i < levels.size(); ++i) {
            if (!levels[i])
                continue;
            // Make the levels, rounded as the files will hold them
            const Material& m = scene.materials[i];
            const MipSource source = mip_source(scene, m);
            StandardLevels made = standard_levels(source, *levels[i], metallic_levels(scene, m, source, a, jobs), m.metallic);
            for (auto* maps : {&made.normal, &made.roughness, &made.anisotropy})
                for (Image& map : *maps)
                    map = a.format == MipFormat::png_levels ? rounded_to_codes(map) : rounded_to_halves(map);
            const auto any = [](const Image& map) {
                for (std::size_t t = 2; t < map.bytes.size() / sizeof(float); t += 3)
                    if (map.f32()[t] > 0.0f)
                        return true;
                return false;
            };
            const std::string stem = (fs::path(folder) / names[i]).string();
            struct Part {
                const char* name;
                std::vector<Image> levels;
                bool srgb;
            };
            const std::vector<Image> colours = with_gains(base_color_levels(scene, m, data.mips.of(i), source, a, jobs), *levels[i]);
            std::vector<Part> parts = {
                {"_normal", made.normal, false}, {"_metallic_roughness", made.roughness, false}, {"_base_color", colours, true}};
            if (std::any_of(made.anisotropy.begin(), made.anisotropy.end(), any))
                parts.push_back({"_anisotropy", made.anisotropy, false});
            // Write them, and measure their errors
            for (const Part& part : parts)
                BN_TRY(add_levels(files, scene.files, stem + part.name, part.levels, part.srgb, a.format, written.files));
            written.figures +=
                figures_of(names[i], made, source, *levels[i], mip_error_surface(lobe_of_model(a.brdf), m.metallic > 0.5f), jobs);
        }
        return files.name_all();
    };
    BN_TRY(write());
    return written;
}

} // namespace burnish
