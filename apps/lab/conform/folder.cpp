#include "apps/lab/conform/folder.h"

#include <filesystem>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/outputs.h"
#include "apps/lab/conform/assets.h"
#include "apps/lab/conform/scenes.h"
#include "apps/report/json.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/image/io/image_io.h"

namespace burnish {
namespace {

constexpr std::uint64_t kMostSceneBytes = 1u << 28;

Json numbers(const glm::vec3& v)
{
    return {shortest_decimal(v.x), shortest_decimal(v.y), shortest_decimal(v.z)};
}

Json area_light_json()
{
    const AreaLight light = conform_area_light();
    Json corners = Json::array();
    for (const glm::vec3& p : light.points)
        corners.push_back(numbers(p));
    return {{"corners", corners}, {"radiance", numbers(light.radiance)}};
}

// Returns a hash of the files that references belong to: scenes and environments.
Result<std::string> content_of(const std::string& path)
{
    std::vector<std::string> names = {"environment.exr", "environment.hdr"};
    for (const ConformScene& scene : conform_scenes())
        names.push_back("scenes/" + scene.name + ".gltf");
    std::uint64_t hash = 0;
    for (const std::string& name : names) {
        const Result<std::vector<std::uint8_t>> bytes = read_file(path + "/" + name, kMostSceneBytes);
        BN_TRY(bytes);
        hash = hash_bytes(bytes->data(), bytes->size(), hash);
    }
    return fmt::format("{:016x}", hash);
}

Json folder_json(const std::string& content)
{
    Json scenes = Json::array();
    for (const ConformScene& scene : conform_scenes())
        scenes.push_back({{"name", scene.name},
                          {"about", scene.about},
                          {"file", "scenes/" + scene.name + ".gltf"},
                          {"environment", scene.environment},
                          {"area_light", scene.area_light ? area_light_json() : Json(nullptr)}});
    return {{"burnish_conform", kConformVersion}, {"width", kConformWidth}, {"height", kConformHeight}, {"exposure_ev", kConformEv},
            {"environment", "environment.hdr"},   {"content", content},     {"scenes", scenes}};
}

Error bad_folder(const std::string& file, const std::string& place, const std::string& reason)
{
    return Error{ExitCode::bad_input, file, place, reason};
}

} // namespace

ConformFolder conform_folder(const std::string& path)
{
    ConformFolder folder;
    folder.path = path;
    for (const ConformScene& known : conform_scenes())
        folder.scenes.push_back({known.name, known.about, "scenes/" + known.name + ".gltf", known.environment, known.area_light});
    return folder;
}

Result<ConformFolder> read_conform_folder(const std::string& path)
{
    constexpr std::uint64_t kMostBytes = 1u << 20;
    const std::string file = path + "/conform.json";
    const Result<std::vector<std::uint8_t>> bytes = read_file(file, kMostBytes);
    if (!bytes)
        return Error{bytes.error().code, bytes.error().file, bytes.error().place,
                     bytes.error().reason + "; `burnish conform --write` makes a conformance folder"};
    const Json json = Json::parse(bytes->begin(), bytes->end(), nullptr, false);
    if (json.is_discarded() || !json.is_object() || !json.contains("burnish_conform"))
        return bad_folder(file, "", "describes no conformance folder");
    const Json& version = json["burnish_conform"];
    if (!version.is_number_integer())
        return bad_folder(file, "/burnish_conform", "is no version");
    if (version != kConformVersion)
        return bad_folder(file, "/burnish_conform",
                          fmt::format("version {} of conformance folders; this program reads version {}: write the folder anew",
                                      version.get<std::int64_t>(), kConformVersion));
    if (json.value("width", Json()) != kConformWidth || json.value("height", Json()) != kConformHeight)
        return bad_folder(file, "/width", fmt::format("pictures are not {}x{}: write the folder anew", kConformWidth, kConformHeight));
    Json names = Json::array();
    for (const Json& scene : json.value("scenes", Json::array()))
        names.push_back(scene.is_object() ? scene.value("name", Json()) : Json());
    if (names != Json(scene_names()))
        return bad_folder(file, "/scenes", "are others than this program's: write the folder anew");
    if (json.value("exposure_ev", Json()) != kConformEv)
        return bad_folder(file, "/exposure_ev", fmt::format("is not {}: write the folder anew", kConformEv));
    const Result<std::string> content = content_of(path);
    if (!content)
        return bad_folder(content.error().file, "", content.error().reason + ": write the folder anew");
    if (json.value("content", Json()) != *content)
        return bad_folder(file, "/content", "a scene or the environment has changed since its reference was made: write the folder anew");
    ConformFolder folder = conform_folder(path);
    std::error_code ignored;
    const auto there = [&](const char* name) { return std::filesystem::is_directory(path + "/" + name, ignored); };
    if (!there(kReferenceFolders[0]) && there(kReferenceFolders[1]))
        folder.references = kReferenceFolders[1];
    return folder;
}

Status write_conform_files(const std::string& path)
{
    // Take an empty folder, or one of ours
    std::error_code failed;
    const std::string list = path + "/conform.json";
    if (std::filesystem::exists(path, failed) && !std::filesystem::is_empty(path, failed) && !std::filesystem::exists(list, failed))
        return Error{ExitCode::usage, path, "", "holds other files, and no conformance folder: name a new folder"};
    for (const char* part : {"", "/scenes", "/reference", "/pages"})
        BN_TRY(make_output_folder(path + part));
    std::filesystem::remove(list, failed); // it comes last: a folder without it is not whole
    for (const ConformScene& scene : conform_scenes()) {
        const Result<std::string> text = scene_file_text(scene.name, scene.make());
        BN_TRY(text);
        BN_TRY(write_text(path + "/scenes/" + scene.name + ".gltf", *text));
    }
    const Image environment = conform_environment();
    BN_TRY(write_image(path + "/environment.hdr", environment));
    BN_TRY(write_image(path + "/environment.exr", environment));
    const auto text_of = [](const EmbeddedFile& e) { return std::string(e.bytes, e.size); };
    BN_TRY(write_text(path + "/README.md", text_of(kConformReadme)));
    BN_TRY(write_text(path + "/pages/three.html", text_of(kConformThree)));
    BN_TRY(write_text(path + "/pages/babylon.html", text_of(kConformBabylon)));
    return write_text(path + "/pages/pictures.js", text_of(kConformPictures));
}

Status write_conform_list(const std::string& path)
{
    const Result<std::string> content = content_of(path);
    BN_TRY(content);
    return write_text(path + "/conform.json", json_text(folder_json(*content), 1) + "\n");
}

} // namespace burnish
