#include "apps/lab/mip/real_maps.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>

#include "core/image/io/image_io.h"
#include "shading/bake/mip/anisotropy.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

struct Found {
    std::string normal, roughness, metallic;
    std::size_t roughness_channel = 0;
};

Found look_into(const fs::path& folder)
{
    Found found;
    std::vector<fs::path> files;
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
        files.push_back(at->path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
        std::string name = file.stem().string();
        std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        const auto has = [&name](const char* word) { return name.find(word) != std::string::npos; };
        if (has("rough"))
            found.roughness = file.string(), found.roughness_channel = 0;
        else if (has("_orm") || has("_arm"))
            found.roughness = file.string(), found.roughness_channel = 1;
        else if (has("metal"))
            found.metallic = file.string();
        else if (has("norm") || has("_nor_"))
            found.normal = file.string();
    }
    return found;
}

} // namespace

Result<std::vector<mipnet::TestMaterial>> real_materials(const std::string& folder, const Limits& limits)
{
    // List the folders
    std::vector<fs::path> folders;
    std::error_code failed, ignored;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
        if (at->is_directory(ignored))
            folders.push_back(at->path());
    if (failed)
        return Error{ExitCode::bad_input, folder, "", failed.message()};
    std::sort(folders.begin(), folders.end());
    std::vector<mipnet::TestMaterial> set;
    for (const fs::path& path : folders) {
        const Found found = look_into(path);
        if (found.normal.empty())
            continue;
        // Read the maps; those with another size than the normal map are skipped
        const Result<Image> normal = read_image(found.normal, limits);
        BN_TRY(normal);
        std::optional<Image> roughness, metallic;
        for (auto [file, image] : {std::pair{&found.roughness, &roughness}, {&found.metallic, &metallic}}) {
            if (file->empty())
                continue;
            Result<Image> read = read_image(*file, limits);
            BN_TRY(read);
            if (read->width == normal->width && read->height == normal->height)
                *image = std::move(*read);
        }
        // Choose the square in the middle
        int side = 256;
        while (side > std::min(normal->width, normal->height))
            side /= 2;
        if (side < 32 || normal->channels < 3)
            continue;
        mipnet::TestMaterial m = {{path.filename().string(), mipnet::make_texels(side, side), false}, "real"};
        const int x0 = (normal->width - side) / 2, y0 = (normal->height - side) / 2;
        double metal = 0.0;
        // Convert its texels
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const std::size_t at =
                    static_cast<std::size_t>(y0 + y) * static_cast<std::size_t>(normal->width) + static_cast<std::size_t>(x0 + x);
                const auto part = [&](int c) {
                    return 2.0 * static_cast<double>(texel_channel(*normal, at, static_cast<std::size_t>(c))) - 1.0;
                };
                const double nx = part(0), ny = part(1), nz = std::max(part(2), 0.05);
                const double inverse = 1.0 / std::sqrt(nx * nx + ny * ny + nz * nz);
                const double r = roughness ? static_cast<double>(texel_channel(*roughness, at, found.roughness_channel)) : 0.35;
                const std::size_t i = static_cast<std::size_t>(y * side + x);
                m.material.texels.channel[0][i] = static_cast<float>(nx * inverse);
                m.material.texels.channel[1][i] = static_cast<float>(ny * inverse);
                m.material.texels.channel[2][i] = m.material.texels.channel[3][i] = static_cast<float>(r * r);
                metal += metallic ? static_cast<double>(texel_channel(*metallic, at, 0)) / (side * side) : 0.0;
            }
        m.material.metal = metal > 0.5;
        mipnet::make_valid(m.material.texels);
        set.push_back(std::move(m));
    }
    if (set.empty())
        return Error{ExitCode::bad_input, folder, "", "has no folder with a normal map"};
    return set;
}

} // namespace burnish
