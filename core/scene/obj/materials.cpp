#include "core/scene/obj/materials.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <optional>

#include "core/base/file.h"
#include "core/base/text.h"
#include "core/image/io/image_io.h"
#include "core/image/io/stored_colour.h"
#include "core/math/scalar_math.h"
#include "core/scene/obj/lines.h"
#include "core/scene/obj/mtl.h"
#include "core/scene/surface_maps.h"
#include "core/scene/texture.h"

namespace burnish::obj {
namespace {

namespace fs = std::filesystem;

// Returns the file that a name means, or nothing.
std::optional<std::string> find_file(const fs::path& folder, std::string name, const Limits& limits)
{
    std::replace(name.begin(), name.end(), '\\', '/'); // as Windows writes it
    std::error_code failed;
    const fs::path root = fs::weakly_canonical(folder.empty() ? "." : folder, failed);
    for (const fs::path& path : {fs::path(name), fs::path(name).filename()}) {
        const fs::path whole = path.is_absolute() ? path : folder / path;
        const fs::path file = fs::canonical(whole, failed);
        if (failed || !fs::is_regular_file(file, failed))
            continue;
        if (limits.uris_outside || std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end())
            return whole.string();
    }
    return std::nullopt;
}

class MaterialMaker {
    using Picture = std::pair<const std::pair<std::string, bool>, Image>; // by path, and whether its colours were read
  public:
    MaterialMaker(Scene& scene, fs::path folder, const Limits& limits) : scene_(scene), folder_(std::move(folder)), limits_(limits) {}

    Status add(const MtlMaterial& from)
    {
        Material m;
        m.name = from.name;
        const bool has_map = !from.metallic_map.file.empty() || !from.roughness_map.file.empty();
        m.base_color = glm::vec4(from.diffuse.value_or(glm::vec3(1.0f)), 1.0f);
        m.metallic = from.metallic.value_or(from.metallic_map.file.empty() ? 0.0f : 1.0f);
        m.roughness =
            from.roughness.value_or(has_map && !from.roughness_map.file.empty() ? 1.0f : roughness_of(from.exponent.value_or(0.0f)));
        if (from.specular)
            m.specular_color = 2.0f * *from.specular;
        if (from.emission)
            emit(*from.emission, m);
        if (from.ior.value_or(0.0f) > 1.0f)
            m.ior = *from.ior;
        if (from.opacity.value_or(1.0f) < 1.0f)
            m.base_color.a = *from.opacity, m.alpha_mode = AlphaMode::blend;
        m.clearcoat = from.clearcoat.value_or(0.0f), m.clearcoat_roughness = from.clearcoat_roughness.value_or(0.0f);
        const float anisotropy = from.anisotropy.value_or(0.0f);
        m.anisotropy_strength = std::fabs(anisotropy); // below 0: across
        m.anisotropy_rotation =
            static_cast<float>(2.0 * kPi * static_cast<double>(from.rotation.value_or(0.0f)) + (anisotropy < 0.0f ? 0.5 * kPi : 0.0));
        BN_TRY(put_maps(from, m));
        scene_.materials.push_back(std::move(m));
        return {};
    }

  private:
    // GGX is as wide as a Phong lobe where alpha^2 is 2 / (n + 2): Walter et al. 2007, "Microfacet Models for Refraction through Rough
    // Surfaces".
    static float roughness_of(float exponent)
    {
        return static_cast<float>(std::sqrt(std::sqrt(2.0 / (static_cast<double>(exponent) + 2.0))));
    }

    static void emit(const glm::vec3& light, Material& m)
    {
        const float most = std::max({light.r, light.g, light.b, 1.0f});
        m.emissive = light / most, m.emissive_strength = most;
    }

    // Reads a picture once. An empty picture stands for a missing one, which was warned of.
    Result<const Picture*> picture(const std::string& name, bool colours)
    {
        const std::optional<std::string> path = find_file(folder_, name, limits_);
        const auto key = std::pair(path.value_or(name), colours);
        if (const auto known = pictures_.find(key); known != pictures_.end())
            return &*known;
        if (!path) {
            scene_.warnings.push_back(fmt::format("picture {} is not found in the folder of the OBJ file, and left out", printable(name)));
            return &*pictures_.emplace(key, Image()).first;
        }
        Limits rest = limits_;
        for (const Image& image : scene_.images)
            rest.texture_bytes -= std::min<std::uint64_t>(rest.texture_bytes, image.bytes.size());
        PictureNotes notes;
        Result<Image> image = colours ? read_colours(*path, rest, notes) : read_image(*path, rest, &notes);
        BN_TRY(image);
        for (const std::string& warning : notes.warnings)
            scene_.warnings.push_back(*path + ": " + warning);
        if (colours)
            clip_negative_colours(*image);
        if (image->bytes.size() > rest.texture_bytes)
            return Error{ExitCode::bad_input, *path, "",
                         fmt::format("the scene's textures need more than {} bytes (Limits::texture_bytes)", limits_.texture_bytes)};
        scene_.files.push_back(*path);
        return &*pictures_.emplace(key, std::move(*image)).first;
    }

    TextureRef placed(std::int32_t texture, const MtlMap& map)
    {
        TextureRef ref;
        ref.texture = texture;
        const glm::vec2 s = map.scale, o = map.offset; // v runs up in the file, down in the scene
        ref.uv_transform = glm::mat3x2(glm::vec2(s.x, 0.0f), glm::vec2(0.0f, s.y), glm::vec2(o.x, 1.0f - s.y - o.y));
        return ref;
    }

    TextureRef textured(const std::string& key, const Image& image, const MtlMap& map)
    {
        const std::string whole = key + (map.clamps ? " clamps" : "");
        const auto known = textures_.find(whole);
        Texture like;
        if (map.clamps)
            like.wrap_s = like.wrap_t = WrapMode::clamp;
        const std::int32_t texture = known != textures_.end() ? known->second : add_texture(scene_, key.c_str(), image, like);
        textures_[whole] = texture;
        return placed(texture, map);
    }

    Status put_map(const MtlMap& map, bool colours, TextureRef& to)
    {
        if (map.file.empty())
            return {};
        const Result<const Picture*> read = picture(map.file, colours);
        BN_TRY(read);
        if (const auto& [key, image] = **read; !image.empty())
            to = textured(key.first + (colours ? "" : " as data"), image, map);
        return {};
    }

    Status put_maps(const MtlMaterial& from, Material& m)
    {
        BN_TRY(put_map(from.diffuse_map, true, m.base_color_tex));
        BN_TRY(put_map(from.emission_map, true, m.emissive_tex));
        if (m.emissive_tex.used() && !from.emission)
            m.emissive = glm::vec3(1.0f);
        BN_TRY(put_map(from.normal_map, false, m.normal_tex));
        m.normal_scale = from.normal_map.strength;
        if (m.normal_tex.used() &&
            scene_.images[static_cast<std::size_t>(scene_.textures[static_cast<std::size_t>(m.normal_tex.texture)].image)].channels < 3)
            return Error{ExitCode::bad_input, from.normal_map.file, "", "a map of normals has red, green and blue"};
        if (!from.opacity_map.file.empty() && from.opacity_map.file == from.diffuse_map.file)
            m.alpha_mode = AlphaMode::mask;
        else if (!from.opacity_map.file.empty())
            scene_.warnings.push_back(fmt::format("material \"{}\": map_d is read only where it is map_Kd", printable(from.name)));
        return put_metal_rough(from, m);
    }

    Status put_metal_rough(const MtlMaterial& from, Material& m)
    {
        Image none;
        const Image* parts[2] = {&none, &none};
        const MtlMap* const maps[2] = {&from.metallic_map, &from.roughness_map};
        for (int i = 0; i < 2; ++i)
            if (!maps[i]->file.empty()) {
                const Result<const Picture*> read = picture(maps[i]->file, false);
                BN_TRY(read);
                parts[i] = &(*read)->second;
            }
        if (parts[0]->empty() && parts[1]->empty())
            return {};
        const MtlMap& map = *maps[parts[1]->empty() ? 0 : 1];
        const std::string key = maps[0]->file + " and " + maps[1]->file;
        m.metallic_roughness_tex = textured(key, metal_rough_of(*parts[0], *parts[1]), map);
        return {};
    }

    Scene& scene_;
    fs::path folder_;
    const Limits& limits_;
    std::map<std::pair<std::string, bool>, Image> pictures_;
    std::map<std::string, std::int32_t> textures_;
};

// Returns the files that an mtllib statement names: its words, or all of it as one name with blanks.
std::vector<std::string> files_of(std::string_view statement, const fs::path& folder, const Limits& limits)
{
    if (find_file(folder, std::string(statement), limits))
        return {std::string(statement)};
    std::vector<std::string> names;
    for (std::string_view word = take_word(statement); !word.empty(); word = take_word(statement))
        names.emplace_back(word);
    return names;
}

} // namespace

Result<std::vector<std::string>> read_materials(Scene& scene, const std::string& obj, const std::vector<std::string>& libraries,
                                                const Limits& limits)
{
    const fs::path folder = fs::path(obj).parent_path();
    std::vector<std::string> names;
    MaterialMaker maker(scene, folder, limits);
    for (const std::string& statement : libraries)
        for (const std::string& name : files_of(statement, folder, limits)) {
            const std::optional<std::string> path = find_file(folder, name, limits);
            if (!path) {
                scene.warnings.push_back(fmt::format("material library {} is not found in the folder of the OBJ file", printable(name)));
                continue;
            }
            if (std::find(scene.files.begin(), scene.files.end(), *path) != scene.files.end())
                continue;
            const Result<std::vector<std::uint8_t>> bytes = read_file(*path, limits.file_bytes);
            BN_TRY(bytes);
            scene.files.push_back(*path);
            const MtlLibrary library = parse_mtl(*path, std::string(bytes->begin(), bytes->end()));
            if (library.wrong)
                return *library.wrong;
            scene.warnings.insert(scene.warnings.end(), library.warnings.begin(), library.warnings.end());
            for (const MtlMaterial& material : library.materials)
                if (std::find(names.begin(), names.end(), material.name) == names.end()) {
                    BN_TRY(maker.add(material));
                    names.push_back(material.name);
                }
        }
    return names;
}

} // namespace burnish::obj
