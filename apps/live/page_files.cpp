#include "apps/live/page_files.h"

#include <filesystem>
#include <fmt/core.h>
#include <set>
#include <string_view>

#include "apps/cli/outputs.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/image/io/image_io.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kMostBytes = 256ull << 20; // of a page's files

bool is_builtin(const std::string& name)
{
    return name.rfind("builtin:", 0) == 0;
}

// Returns an error for a model in a form that pages do not read.
Status check_model(const PageFile& file)
{
    const std::string_view text(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size());
    const std::size_t from = text.find("\"extensionsUsed\"");
    if (from == text.npos || file.name.ends_with(".bin"))
        return {};
    const std::string_view list = text.substr(from, text.find(']', from) - from);
    for (const char* extension : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_texture_webp"})
        if (list.find(extension) != list.npos)
            return Error{ExitCode::bad_input, file.name, "extensionsUsed", fmt::format("pages do not read {}", extension)};
    return {};
}

// Returns an environment as pages read it: Radiance files as they are, others as the floats of a .pfm file.
Result<PageFile> light_file(const fs::path& path, const Limits& limits)
{
    PageFile file{path.filename().string(), {}};
    const std::string ending = extension_of(path.string());
    if (ending == "hdr" || ending == "pfm") {
        Result<std::vector<std::uint8_t>> bytes = read_file(path.string(), kMostBytes);
        BN_TRY(bytes);
        file.bytes = std::move(*bytes);
        return file;
    }
    if (ending != "exr")
        return Error{ExitCode::bad_input, path.string(), "", "pages take .hdr, .exr and .pfm files as environments"};
    PictureNotes notes;
    const Result<Image> image = read_colours(path.string(), limits, notes);
    BN_TRY(image);
    if (notes.cube_faces || image->channels < 3 || image->type != PixelType::f32)
        return Error{ExitCode::bad_input, path.string(), "", "pages take equirectangular pictures of three channels as environments"};
    const std::string head = fmt::format("PF\n{} {}\n-1.0\n", image->width, image->height);
    file.name = path.stem().string() + ".pfm";
    file.bytes.assign(head.begin(), head.end());
    for (int y = image->height - 1; y >= 0; --y)
        for (int x = 0; x < image->width; ++x) {
            const float* const pixel =
                image->f32() + (std::size_t(y) * std::size_t(image->width) + std::size_t(x)) * std::size_t(image->channels);
            const auto* const bytes = reinterpret_cast<const std::uint8_t*>(pixel);
            file.bytes.insert(file.bytes.end(), bytes, bytes + 3 * sizeof(float));
        }
    return file;
}

} // namespace

Result<PageFiles> page_files(const std::string& scene, const std::string& environment, const std::vector<std::string>& read,
                             const Limits& limits)
{
    PageFiles out;
    out.scene = scene, out.environment = environment;
    const auto place_of = [](const std::string& path) { // absolute where the system tells its folder
        std::error_code failed;
        const fs::path absolute = fs::absolute(path, failed);
        return (failed ? fs::path(path) : absolute).lexically_normal();
    };
    std::set<fs::path> paths;
    for (const std::string& path : read)
        if (!is_builtin(path))
            paths.insert(place_of(path));
    const bool apart = !environment.empty() && !is_builtin(environment); // a file of its own
    const fs::path own = place_of(scene), light = apart ? place_of(environment) : fs::path();
    if (apart)
        paths.erase(light);
    if (!is_builtin(scene)) {
        paths.insert(own);
        const fs::path folder = own.parent_path(); // above all its files, unless --allow-outside-uris was given
        out.scene = own.filename().string();
        for (const fs::path& path : paths) {
            Result<std::vector<std::uint8_t>> bytes = read_file(path.string(), kMostBytes);
            BN_TRY(bytes);
            out.files.push_back({path.lexically_relative(folder).string(), std::move(*bytes)});
        }
    }
    if (apart) { // beside the scene, where the page looks for it
        Result<PageFile> file = light_file(light, limits);
        BN_TRY(file);
        out.environment = file->name;
        out.files.push_back(std::move(*file));
    }
    std::uint64_t all = 0;
    for (const PageFile& file : out.files) {
        BN_TRY(check_model(file));
        all += file.bytes.size();
    }
    if (all > kMostBytes)
        return Error{ExitCode::bad_input, scene, "", "the scene's files are too large for the memory of a page"};
    return out;
}

} // namespace burnish
