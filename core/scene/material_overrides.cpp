#include "core/scene/material_overrides.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>
#include <set>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/image/io/image_io.h"
#include "core/image/io/stored_colour.h"
#include "core/math/scalar_math.h"
#include "core/scene/height_map.h"
#include "core/scene/pictures_ahead.h"
#include "core/scene/texture.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

enum Role { kAlbedo, kOcclusion, kDepth, kHeight, kMetallic, kRoughness, kNormal, kQuaternion, kRotation, kRoles };
struct RoleName {
    const char* ending;
    Role role;
};
constexpr RoleName kRoleNames[] = {
    {"albedo", kAlbedo},         {"basecolor", kAlbedo},  {"ao", kOcclusion},      {"ambient_occlusion", kOcclusion},
    {"depth", kDepth},           {"height", kHeight},     {"metallic", kMetallic}, {"metal", kMetallic},
    {"normal", kNormal},         {"rotation", kRotation}, {"flow", kRotation},     {"roughness", kRoughness},
    {"quaternion", kQuaternion},
};

// A file's name without extension ends in a role's: after a character that is no letter, or as a whole.
std::optional<Role> role_of(std::string stem)
{
    std::transform(stem.begin(), stem.end(), stem.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const RoleName& name : kRoleNames) {
        const std::string ending = name.ending;
        if (stem.size() < ending.size() || stem.compare(stem.size() - ending.size(), ending.size(), ending) != 0)
            continue;
        if (stem.size() == ending.size() || !std::isalpha(static_cast<unsigned char>(stem[stem.size() - ending.size() - 1])))
            return name.role;
    }
    return std::nullopt;
}

bool is_picture(const fs::path& path)
{
    static const std::set<std::string> kExtensions = {".png", ".jpg", ".jpeg", ".webp", ".tif", ".tiff", ".exr", ".hdr", ".pfm"};
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return kExtensions.count(extension) > 0;
}

class MapWriter {
  public:
    MapWriter(Scene& scene, const Limits& limits) : scene_(scene), limits_(limits), worn_(scene.materials.size(), false)
    {
        for (const Primitive& primitive : scene.primitives)
            if (primitive.has_uv0)
                worn_[static_cast<std::size_t>(primitive.material)] = true;
    }

    Status check_coordinates(const std::string& path) const
    {
        if (std::find(worn_.begin(), worn_.end(), true) == worn_.end())
            return Error{ExitCode::bad_input, path, "", "nothing in the scene has texture coordinates for a map"};
        return {};
    }

    // Decodes pictures on all threads, for read().
    void look_ahead(const std::vector<PicturesAhead::Wanted>& pictures, const Jobs* jobs)
    {
        if (check_coordinates(""))
            ahead_ = PicturesAhead(pictures, limits_left(scene_, limits_), jobs);
    }

    // colours: of the material; other maps hold data, whatever primaries their files name.
    // needs: says what a map with too few channels lacks.
    Result<Image> read(const std::string& path, int channels, const char* needs, bool colours = false)
    {
        BN_TRY(check_coordinates(path));
        const Limits rest = limits_left(scene_, limits_);
        PictureNotes notes;
        Result<Image> image = ahead_.read(path, colours, rest, notes);
        BN_TRY(image);
        for (const std::string& warning : notes.warnings)
            scene_.warnings.push_back(path + ": " + warning);
        if (const std::size_t clipped = colours ? clip_negative_colours(*image) : 0)
            scene_.warnings.push_back(fmt::format("{}: {} texels of negative colour are set to 0", path, clipped));
        if (image->channels < channels)
            return Error{ExitCode::bad_input, path, "", needs};
        if (image->bytes.size() > rest.texture_bytes)
            return textures_too_large(path, limits_);
        scene_.files.push_back(path);
        return image;
    }

    std::int32_t add(Image image, const char* name) { return add_texture(scene_, name, std::move(image)); }

    // A picture that becomes a texture as it is; what is no number in it is repaired where levels are made.
    Result<Image> read_as_is(const std::string& path, int channels, const char* name, bool colours = false)
    {
        Result<Image> image = read(path, channels, "a map of directions has red, green and blue", colours);
        if (!image || image->type != PixelType::f32)
            return image;
        std::size_t bad = 0;
        const std::size_t each = static_cast<std::size_t>(image->channels), count = image->bytes.size() / sizeof(float);
        for (std::size_t i = 0; i < count; i += each)
            bad += !std::all_of(image->f32() + i, image->f32() + i + each, [](float x) { return std::isfinite(x); });
        if (bad > 0)
            scene_.warnings.push_back(fmt::format("{}: {} texels of {} are no numbers and are repaired", path, bad, name));
        return image;
    }

    std::int32_t add(SurfaceMap map, const std::string& path, const char* name)
    {
        if (map.repaired > 0)
            scene_.warnings.push_back(fmt::format("{}: {} texels of {} hold none and are repaired", path, map.repaired, name));
        return add(std::move(map.image), name);
    }

    template <class Change> void each(const Change& change)
    {
        for (std::size_t i = 0; i < worn_.size(); ++i)
            if (worn_[i])
                change(scene_.materials[i]);
    }

    void put(std::int32_t texture, TextureRef Material::*to)
    {
        each([&](Material& m) {
            m.*to = TextureRef();
            (m.*to).texture = texture;
        });
    }

    void put_directions(std::int32_t texture)
    {
        put(texture, &Material::anisotropy_tex);
        each([](Material& m) { m.anisotropy_strength = m.anisotropy_strength > 0.0f ? m.anisotropy_strength : 1.0f; });
    }

  private:
    Scene& scene_;
    const Limits& limits_;
    PicturesAhead ahead_;
    std::vector<bool> worn_; // by something with texture coordinates
};

// Checks that grooves are given by a map that does not say the contrary.
Status check_strokes(const MaterialOverrides& with)
{
    if (with.strokes == Strokes::highlights)
        return {};
    const auto refuse = [](std::string reason) { return Error{ExitCode::usage, "", "", std::move(reason), "MaterialOverrides::strokes"}; };
    if (!with.direction.empty())
        return refuse(
            fmt::format("{}: a texture of KHR_materials_anisotropy holds directions of highlights, not of grooves", with.direction));
    if (with.rotation.empty())
        return refuse("there is no map of rotations that could hold grooves");
    if (with.rotation_encoding == RotationEncoding::direction)
        return refuse(
            fmt::format("{}: the encoding of KHR_materials_anisotropy holds directions of highlights, not of grooves", with.rotation));
    return {};
}

// Checks that an encoding of rotations has a map to describe.
Status check_rotation_encoding(const MaterialOverrides& with)
{
    if (with.rotation_encoding == RotationEncoding::vector || !with.rotation.empty())
        return {};
    return Error{ExitCode::usage, "", "", "there is no map of rotations that it could describe", "MaterialOverrides::rotation_encoding"};
}

// Makes all normal maps' green point up.
Status flip_normals(Scene& scene)
{
    std::set<std::int32_t> flipped;
    for (const Material& m : scene.materials)
        if (m.normal_tex.used())
            flipped.insert(scene.textures[static_cast<std::size_t>(m.normal_tex.texture)].image);
    if (flipped.empty())
        return Error{ExitCode::usage, "", "", "down: there is no normal map that it could describe", "MaterialOverrides::normal_y_down"};
    for (const std::int32_t image : flipped)
        flip_green(scene.images[static_cast<std::size_t>(image)]);
    return {};
}

Status put_maps(MapWriter& on, const MaterialOverrides& with)
{
    if (!with.direction.empty()) {
        Result<Image> image = on.read_as_is(with.direction, 3, "directions");
        BN_TRY(image);
        on.put_directions(on.add(std::move(*image), "direction map"));
    }
    if (!with.rotation.empty()) {
        const Result<Image> image = on.read(with.rotation, 3, "a map of rotations has red, green and blue, and reads red and green");
        BN_TRY(image);
        on.put_directions(on.add(directions_of_rotations(*image, with.rotation_encoding), with.rotation, "rotations"));
        if (with.strokes == Strokes::grooves)
            on.each([](Material& m) { m.anisotropy_rotation += 0.5f * static_cast<float>(kPi); });
    }
    if (!with.roughness.empty()) {
        const Result<Image> image =
            on.read(with.roughness, 3, "a roughness map by direction has red, green and blue, and reads red and green");
        BN_TRY(image);
        on.put(on.add(roughness_of(*image, with.roughness_encoding), with.roughness, "roughness by direction"),
               &Material::directional_roughness_tex);
    }
    if (!with.normal.empty()) {
        Result<Image> image = on.read(with.normal, 3, "a normal map has red, green and blue");
        BN_TRY(image);
        on.put(on.add(whole_normals(std::move(*image)), with.normal, "normals"), &Material::normal_tex);
    }
    if (!with.quaternion.empty()) {
        const Result<Image> image = on.read(with.quaternion, 3, "a quaternion map has red, green and blue");
        BN_TRY(image);
        on.put(on.add(normals_of_quaternions(*image), with.quaternion, "quaternions"), &Material::normal_tex);
    }
    if (!with.height.empty()) {
        Result<Image> image = on.read_as_is(with.height, 1, "heights");
        BN_TRY(image);
        on.put(on.add(std::move(*image), "height map"), &Material::height_tex);
    }
    return {};
}

Error two_for_one(const std::string& a, const std::string& b)
{
    return {ExitCode::usage, "", "", fmt::format("{} and {} are both for one part of the material", a, b), "MaterialOverrides::material"};
}

// The pictures of a folder by role.
Status find_pictures(const std::string& folder, std::string (&found)[kRoles], std::vector<std::string>& warnings)
{
    std::error_code failed;
    std::vector<fs::path> files;
    for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed))
        if (is_picture(it->path()))
            files.push_back(it->path());
    if (failed)
        return Error{ExitCode::bad_input, folder, "", failed.message()};
    if (files.empty())
        return Error{ExitCode::bad_input, folder, "", "holds no pictures"};
    std::sort(files.begin(), files.end());
    std::string unknown;
    for (const fs::path& file : files) {
        const std::optional<Role> role = role_of(file.stem().string());
        if (!role) {
            unknown += (unknown.empty() ? "" : ", ") + file.filename().string();
            continue;
        }
        if (!found[*role].empty())
            return two_for_one(found[*role], file.string());
        found[*role] = file.string();
    }
    if (!unknown.empty())
        warnings.push_back(fmt::format("{}: nothing is made of {}", folder, unknown));
    for (const auto& [a, b] : {std::pair(kNormal, kQuaternion), std::pair(kDepth, kHeight)})
        if (!found[a].empty() && !found[b].empty())
            return two_for_one(found[a], found[b]);
    return {};
}

// Returns the pictures that put_material() and put_maps() read.
std::vector<PicturesAhead::Wanted> pictures_read(const std::string (&found)[kRoles], const MaterialOverrides& with)
{
    std::vector<PicturesAhead::Wanted> pictures;
    for (int role = 0; role < kRoles; ++role)
        pictures.push_back({found[role], role == kAlbedo});
    for (const std::string* path : {&with.direction, &with.rotation, &with.roughness, &with.normal, &with.quaternion, &with.height})
        pictures.push_back({*path, false});
    std::erase_if(pictures, [](const PicturesAhead::Wanted& picture) { return picture.path.empty(); });
    return pictures;
}

// Puts the folder's pictures. found: by role.
Status put_material(MapWriter& on, Scene& scene, const MaterialOverrides& with, const std::string (&found)[kRoles], const Limits& limits)
{
    BN_TRY(on.check_coordinates(with.material));
    on.each([](Material& m) {
        const std::string name = m.name;
        m = Material();
        m.name = name;
    });
    if (!found[kAlbedo].empty()) {
        Result<Image> image = on.read_as_is(found[kAlbedo], 1, "albedo", true);
        BN_TRY(image);
        on.put(on.add(std::move(*image), "albedo"), &Material::base_color_tex);
    }
    if (!found[kOcclusion].empty()) {
        Result<Image> image = on.read_as_is(found[kOcclusion], 1, "occlusion");
        BN_TRY(image);
        on.put(on.add(std::move(*image), "occlusion"), &Material::occlusion_tex);
    }
    Image parts[2];
    for (const int i : {0, 1})
        if (const std::string& path = found[i ? kRoughness : kMetallic]; !path.empty()) {
            Result<Image> image = on.read_as_is(path, 1, i ? "roughness" : "metalness");
            BN_TRY(image);
            parts[i] = std::move(*image);
        }
    if (parts[0].empty())
        on.each([](Material& m) { m.metallic = 0.0f; });
    if (metal_rough_bytes(parts[0], parts[1]) > texture_bytes_left(scene, limits))
        return textures_too_large(found[parts[1].empty() ? kMetallic : kRoughness], limits);
    if (!parts[0].empty() || !parts[1].empty())
        on.put(on.add(metal_rough_of(parts[0], parts[1]), "metalness and roughness"), &Material::metallic_roughness_tex);
    if (!found[kDepth].empty()) {
        const Result<Image> image = on.read(found[kDepth], 1, "a map of depths has red");
        BN_TRY(image);
        on.put(on.add(heights_of_depths(*image), found[kDepth], "depths"), &Material::height_tex);
    }
    MaterialOverrides maps;
    maps.height = found[kHeight];
    maps.normal = found[kNormal], maps.quaternion = found[kQuaternion], maps.rotation = found[kRotation];
    maps.rotation_encoding = with.rotation_encoding;
    if (with.rotation.empty()) { // else the other picture replaces the folder's, and turns once
        maps.strokes = with.strokes;
        BN_TRY(check_strokes(maps));
        BN_TRY(check_rotation_encoding(maps));
    }
    return put_maps(on, maps);
}

void put_f0(Material& m, const glm::vec3& f0)
{
    for (int i = 0; i < 3; ++i)
        m.base_color[i] *= 1.0f - m.metallic; // a metal has no diffuse part
    m.metallic = 0.0f;
    m.ior = 1.5f, m.specular = 1.0f;
    m.specular_color = f0 / 0.04f;
    m.specular_tex = m.specular_color_tex = TextureRef();
}

} // namespace

bool MaterialOverrides::material_is_document() const
{
    std::string ending = fs::path(material).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    std::error_code failed;
    return ending == ".mtlx" && !fs::is_directory(material, failed);
}

bool MaterialOverrides::names(const std::string& path) const
{
    return !path.empty() && (path == direction || path == rotation || path == normal || path == quaternion || path == height ||
                             path == roughness || path == material || (!material.empty() && path.starts_with(material)));
}

Status apply_material_overrides(Scene& scene, const MaterialOverrides& with, const Limits& limits, const Jobs* jobs)
{
    if (!with.direction.empty() && !with.rotation.empty())
        return Error{ExitCode::usage, "", "",
                     fmt::format("{} and {} are both for the directions of the material", with.direction, with.rotation),
                     "MaterialOverrides::rotation"};
    if (with.material.empty() || with.material_is_document() || !with.rotation.empty() ||
        !with.direction.empty()) // else the folder says it
        BN_TRY(check_strokes(with));
    const bool has_folder = !with.material.empty() && !with.material_is_document();
    if (!has_folder) // else the folder may have the map
        BN_TRY(check_rotation_encoding(with));
    if (with.roughness_encoding != RoughnessEncoding::widths && with.roughness.empty())
        return Error{ExitCode::usage, "", "", "there is no roughness map that it could describe", "MaterialOverrides::roughness_encoding"};
    MapWriter on(scene, limits);
    std::string found[kRoles];
    if (has_folder)
        BN_TRY(find_pictures(with.material, found, scene.warnings));
    on.look_ahead(pictures_read(found, with), jobs);
    if (has_folder)
        BN_TRY(put_material(on, scene, with, found, limits));
    BN_TRY(put_maps(on, with));
    if (with.normal_y_down)
        BN_TRY(flip_normals(scene));
    if (with.f0)
        for (Material& m : scene.materials)
            put_f0(m, *with.f0);
    return {};
}

} // namespace burnish
