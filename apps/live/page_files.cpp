#include "apps/live/page_files.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/image/io/image_io.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;
using Bytes = std::span<const std::uint8_t>;

constexpr std::uint64_t kMostBytes = 1ull << 30; // of one file

bool is_builtin(const std::string& name)
{
    return name.rfind("builtin:", 0) == 0;
}

std::uint32_t word_at(Bytes bytes, std::size_t at)
{
    std::uint32_t word = 0;
    if (at + 4 <= bytes.size())
        std::memcpy(&word, bytes.data() + at, 4);
    return word;
}

// Returns the images of a .glb file that lie in its own binary chunk. The file has been read once without a fault.
std::vector<Bytes> images_within(Bytes glb)
{
    constexpr std::uint32_t kMagic = 0x46546c67; // "glTF"
    std::vector<Bytes> images;
    const std::size_t json_size = word_at(glb, 12), binary_at = 20 + json_size + 8;
    if (word_at(glb, 0) != kMagic || binary_at > glb.size())
        return images;
    const auto json = nlohmann::json::parse(glb.data() + 20, glb.data() + 20 + json_size, nullptr, false);
    const Bytes binary = glb.subspan(binary_at);
    const auto number = [](const nlohmann::json& of, const char* name, std::size_t otherwise) {
        const auto at = of.is_object() ? of.find(name) : of.end();
        return at != of.end() && at->is_number_unsigned() ? at->get<std::size_t>() : otherwise;
    };
    const auto list = [&](const char* name) { return json.is_object() && json.contains(name) ? json[name] : nlohmann::json::array(); };
    const nlohmann::json views = list("bufferViews");
    for (const auto& image : list("images")) {
        const std::size_t view = number(image, "bufferView", views.size());
        if (view >= views.size() || number(views[view], "buffer", 1) != 0)
            continue;
        const std::size_t offset = number(views[view], "byteOffset", 0), length = number(views[view], "byteLength", 0);
        if (offset <= binary.size() && length <= binary.size() - offset)
            images.push_back(binary.subspan(offset, length));
    }
    return images;
}

// Appends the picture of a JPEG file as PNG, unless it is there.
Status add_decoded(Bytes file, const std::string& label, const Limits& limits, std::vector<PageFile>& to)
{
    if (file.size() < 3 || file[0] != 0xff || file[1] != 0xd8 || file[2] != 0xff)
        return {};
    const std::string name = fmt::format("decoded/{:016x}.png", hash_bytes(file.data(), file.size(), 0));
    if (std::any_of(to.begin(), to.end(), [&](const PageFile& other) { return other.name == name; }))
        return {};
    const Result<Image> image = decode_image(file.data(), file.size(), label, limits, nullptr);
    BN_TRY(image);
    const Result<std::string> png = encode_png(*image);
    BN_TRY(png);
    to.push_back({name, {png->begin(), png->end()}});
    return {};
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
        Result<std::vector<std::uint8_t>> bytes = read_file(light.string(), kMostBytes);
        BN_TRY(bytes);
        out.environment = light.filename().string();
        out.files.push_back({out.environment, std::move(*bytes)});
    }
    std::vector<PageFile> decoded;
    for (const PageFile& file : out.files) {
        BN_TRY(add_decoded(file.bytes, file.name, limits, decoded));
        for (const Bytes image : images_within(file.bytes))
            BN_TRY(add_decoded(image, file.name, limits, decoded));
    }
    for (PageFile& file : decoded)
        out.files.push_back(std::move(file));
    return out;
}

} // namespace burnish
