#include "apps/bake/mip.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fmt/core.h>

#include "core/image/io/image_io.h"

namespace burnish {

namespace {

std::byte mip_code(float unit)
{
    return static_cast<std::byte>(static_cast<int>(std::clamp(unit, 0.0f, 1.0f) * 255.0f + 0.5f));
}

// What may stand in a file's name.
std::string plain_name(const std::string& name)
{
    std::string plain = name.empty() ? "material" : name;
    for (char& c : plain)
        if (!std::isalnum(static_cast<unsigned char>(c)))
            c = '_';
    return plain;
}

} // namespace

std::vector<MipPicture> mip_pictures(const std::string& material, const MipLevels& levels)
{
    std::vector<MipPicture> pictures;
    for (std::size_t l = 0; l < levels.levels.size(); ++l) {
        const MipLevel& level = levels.levels[l];
        Image normals = make_image(level.width, level.height, 3, PixelType::u8), lobes = normals;
        for (std::size_t i = 0; i < level.texels.size(); ++i) {
            const MipTexel& t = level.texels[i];
            const float z = std::sqrt(std::max(1.0f - (t.nx * t.nx + t.ny * t.ny), 0.0f));
            const float normal[3] = {0.5f + 0.5f * t.nx, 0.5f + 0.5f * t.ny, 0.5f + 0.5f * z};
            const float lobe[3] = {std::sqrt(t.b), std::sqrt(t.a), 0.5f - 0.5f * t.c / std::sqrt(t.a * t.b)}; // M_xx is b
            for (std::size_t c = 0; c < 3; ++c)
                normals.bytes[3 * i + c] = mip_code(normal[c]), lobes.bytes[3 * i + c] = mip_code(lobe[c]);
        }
        pictures.push_back({fmt::format("{}_normal_{:02}", plain_name(material), l + 1), std::move(normals)});
        pictures.push_back({fmt::format("{}_lobe_{:02}", plain_name(material), l + 1), std::move(lobes)});
    }
    return pictures;
}

Status write_mip_preview(const std::string& folder, const Scene& scene, const MaterialLevels& levels, Report& report)
{
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed)
        return Error{ExitCode::output_failed, folder, "", failed.message()};
    for (std::size_t i = 0; i < levels.size(); ++i) {
        if (!levels[i] || std::find(levels.begin(), levels.begin() + static_cast<std::ptrdiff_t>(i), levels[i]) !=
                              levels.begin() + static_cast<std::ptrdiff_t>(i))
            continue;
        for (const MipPicture& picture : mip_pictures(scene.materials[i].name, *levels[i])) {
            const std::string path = (std::filesystem::path(folder) / (picture.name + ".png")).string();
            if (Status written = write_image(path, picture.image); !written)
                return written;
            report.wrote(path);
        }
    }
    return {};
}

} // namespace burnish
