#include "core/scene/obj/materials.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/file.h"
#include "core/base/text.h"
#include "core/image/io/image_io.h"
#include "core/image/io/stored_colour.h"
#include "core/math/scalar_math.h"
#include "core/scene/obj/lines.h"
#include "core/scene/obj/mtl.h"
#include "core/scene/picture_beside.h"
#include "core/scene/pictures_ahead.h"
#include "core/scene/surface_maps.h"
#include "core/scene/texture.h"

namespace burnish::obj {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostMissing = 20; // libraries named in warnings

std::size_t values_not_finite(const Image& image)
{
    const std::size_t count = image.bytes.size() / sizeof(float);
    return static_cast<std::size_t>(std::count_if(image.f32(), image.f32() + count, [](float v) { return !std::isfinite(v); }));
}

// Returns the red channel as linear colours, f32: u8 and u16 colours would be sRGB.
Image grey_of(const Image& amounts)
{
    Image out = make_image(amounts.width, amounts.height, 3, PixelType::f32);
    float* to = out.f32();
    for (int y = 0; y < amounts.height; ++y)
        for (int x = 0; x < amounts.width; ++x, to += 3)
            to[0] = to[1] = to[2] = static_cast<float>(red_at(amounts, x, y, amounts.width, amounts.height)) / 65535.0f;
    return out;
}

// Returns true for a picture of normals: most texels are unit vectors that point up, with more blue than red and green. Heights are grey.
bool holds_normals(const Image& image)
{
    if (image.channels < 3)
        return false;
    const auto unit = [&](std::size_t i, std::size_t c) {
        const std::size_t at = i * static_cast<std::size_t>(image.channels) + c;
        if (image.type == PixelType::u8)
            return static_cast<float>(std::to_integer<int>(image.bytes[at])) / 255.0f;
        return image.type == PixelType::u16 ? static_cast<float>(reinterpret_cast<const std::uint16_t*>(image.bytes.data())[at]) / 65535.0f
                                            : image.f32()[at];
    };
    const std::size_t texels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::size_t normals = 0;
    for (std::size_t i = 0; i < texels; ++i) {
        const glm::vec3 n = 2.0f * glm::vec3(unit(i, 0), unit(i, 1), unit(i, 2)) - 1.0f;
        constexpr float kLeast = 0.05f; // pictures by JPEG are not quite grey
        normals += n.z > std::max(0.0f, std::max(n.x, n.y) + kLeast) && std::fabs(glm::length(n) - 1.0f) < 0.2f;
    }
    return normals * 10 >= texels * 9;
}

struct Picture {
    std::string path; // without links; empty: not found
    Image image;
};

class MaterialMaker {
  public:
    MaterialMaker(Scene& scene, fs::path folder, const Limits& limits, const Jobs* jobs)
        : scene_(scene), folder_(std::move(folder)), limits_(limits), jobs_(jobs)
    {
    }

    // Decodes the pictures of materials on all threads, for add().
    void look_ahead(const std::vector<const MtlMaterial*>& materials)
    {
        if (!jobs_)
            return;
        std::set<std::pair<std::string, bool>> names;
        for (const MtlMaterial* material : materials)
            for (const auto& [map, colours] : maps_read(*material))
                if (!map->file.empty())
                    names.emplace(map->file, colours);
        std::vector<PicturesAhead::Wanted> wanted;
        for (const auto& [name, colours] : names)
            if (const auto path = picture_beside(folder_, name, limits_); path && !pictures_.count({*path, colours}))
                wanted.push_back({*path, colours});
        ahead_ = PicturesAhead(wanted, limits_left(scene_, limits_), jobs_);
    }

    Status add(const MtlMaterial& from)
    {
        Material m;
        m.name = from.name;
        m.base_color = glm::vec4(from.diffuse.value_or(glm::vec3(1.0f)), 1.0f);
        m.metallic = from.metallic.value_or(0.0f);
        m.roughness = from.roughness.value_or(roughness_of(from.exponent.value_or(0.0f)));
        if (from.specular)
            m.specular_color = 2.0f * *from.specular;
        if (from.emission)
            emit(*from.emission, m);
        if (from.ior.value_or(0.0f) > 1.0f)
            m.ior = *from.ior;
        if (from.opacity.value_or(1.0f) < 1.0f)
            m.base_color.a = *from.opacity, m.alpha_mode = AlphaMode::blend;
        m.clearcoat = from.clearcoat.value_or(0.0f), m.clearcoat_roughness = from.clearcoat_roughness.value_or(0.0f);
        if (from.sheen)
            m.sheen_color = glm::vec3(*from.sheen), m.sheen_roughness = 0.5f;
        const float anisotropy = from.anisotropy.value_or(0.0f);
        const double turns = std::fmod(static_cast<double>(from.rotation.value_or(0.0f)), 1.0) + (anisotropy < 0.0f ? 0.25 : 0.0);
        m.anisotropy_strength = std::fabs(anisotropy); // below 0: across
        m.anisotropy_rotation = static_cast<float>(2.0 * kPi * turns);
        BN_TRY(put_maps(from, m));
        scene_.materials.push_back(std::move(m));
        return {};
    }

  private:
    using Key = std::tuple<std::string, std::string, bool, bool>; // paths, whether they hold colours, whether they clamp

    // GGX is as wide as a Phong lobe where alpha^2 is 2 / (n + 2): Walter et al. 2007, "Microfacet Models for Refraction through Rough
    // Surfaces".
    static float roughness_of(float exponent)
    {
        return static_cast<float>(std::sqrt(std::sqrt(2.0 / (static_cast<double>(exponent) + 2.0))));
    }

    // Returns roughness, u16, of a picture whose red scales an exponent.
    static Image roughness_of_exponents(const Image& scale, float exponent)
    {
        Image out = make_image(scale.width, scale.height, 1, PixelType::u16);
        auto* to = reinterpret_cast<std::uint16_t*>(out.bytes.data());
        for (int y = 0; y < scale.height; ++y)
            for (int x = 0; x < scale.width; ++x)
                *to++ = static_cast<std::uint16_t>(
                    roughness_of(exponent * static_cast<float>(red_at(scale, x, y, scale.width, scale.height)) / 65535.0f) * 65535.0f +
                    0.5f);
        return out;
    }

    // Returns true where roughness comes from a picture of exponents.
    static bool is_by_exponents(const MtlMaterial& m)
    {
        return m.roughness_map.file.empty() && !m.roughness && !m.exponent_map.file.empty();
    }

    // Returns the maps whose pictures put_maps() reads, and whether as colours. A bump map is read, whatever it holds.
    static std::vector<std::pair<const MtlMap*, bool>> maps_read(const MtlMaterial& m)
    {
        const MtlMap& normals = m.normal_map.file.empty() ? m.bump_map : m.normal_map;
        return {{&m.diffuse_map, true},
                {&m.emission_map, true},
                {&m.specular_map, true},
                {&normals, false},
                {&m.sheen_map, false},
                {&m.metallic_map, false},
                {is_by_exponents(m) ? &m.exponent_map : &m.roughness_map, false}};
    }

    static void emit(const glm::vec3& light, Material& m)
    {
        const float most = std::max({light.r, light.g, light.b, 1.0f});
        m.emissive = light / most, m.emissive_strength = most;
    }

    void warn(const std::string& text)
    {
        if (++warnings_ <= kMostWarnings)
            scene_.warnings.push_back(text);
    }

    // Reads a picture once. Its path is empty where it is not found, which is warned of.
    Result<const Picture*> picture(const std::string& name, bool colours)
    {
        const std::optional<std::string> path = picture_beside(folder_, name, limits_);
        if (!path) {
            warn(fmt::format("picture {} is not found in the folder of the OBJ file, and left out", printable(name)));
            return &none_;
        }
        const auto key = std::pair(*path, colours);
        if (const auto known = pictures_.find(key); known != pictures_.end())
            return &known->second;
        const Limits rest = limits_left(scene_, limits_);
        PictureNotes notes;
        Result<Image> image = ahead_.read(*path, colours, rest, notes);
        BN_TRY(image);
        for (const std::string& warning : notes.warnings)
            warn(*path + ": " + warning);
        if (const std::size_t clipped = colours ? clip_negative_colours(*image) : 0)
            warn(fmt::format("{}: {} texels of negative colour are set to 0", *path, clipped));
        if (const std::size_t bad = image->type == PixelType::f32 ? values_not_finite(*image) : 0)
            warn(fmt::format("{}: {} values are no numbers and are repaired", *path, bad));
        if (image->bytes.size() > rest.texture_bytes)
            return textures_too_large(*path, limits_);
        if (std::find(scene_.files.begin(), scene_.files.end(), *path) == scene_.files.end())
            scene_.files.push_back(*path);
        return &pictures_.emplace(key, Picture{*path, std::move(*image)}).first->second;
    }

    // Returns a reference to the key's texture. `make` makes the texture's image where the key is new.
    template <class Make> Result<TextureRef> textured(const Key& key, const MtlMap& map, const Make& make)
    {
        auto known = textures_.find(key);
        if (known == textures_.end()) {
            Result<Image> image = make();
            BN_TRY(image);
            if (image->bytes.size() > texture_bytes_left(scene_, limits_))
                return textures_too_large(std::get<0>(key), limits_);
            Texture like;
            if (map.clamps)
                like.wrap_s = like.wrap_t = WrapMode::clamp;
            known = textures_.emplace(key, add_texture(scene_, std::get<0>(key).c_str(), std::move(*image), like)).first;
        }
        TextureRef ref;
        ref.texture = known->second;
        const glm::vec2 s = map.scale, o = map.offset; // v runs up in the file, down in the scene
        ref.uv_transform = glm::mat3x2(glm::vec2(s.x, 0.0f), glm::vec2(0.0f, s.y), glm::vec2(o.x, 1.0f - s.y - o.y));
        return ref;
    }

    enum class Content { colours, normals, amounts };

    Status put_map(const MtlMap& map, Content content, TextureRef& to)
    {
        if (map.file.empty())
            return {};
        const bool colours = content == Content::colours;
        const Result<const Picture*> read = picture(map.file, colours);
        BN_TRY(read);
        const Picture& found = **read;
        if (found.path.empty())
            return {};
        const Result<TextureRef> ref =
            textured({found.path, content == Content::amounts ? "amounts" : "", colours, map.clamps}, map, [&]() -> Result<Image> {
                if (colours)
                    return Image(found.image);
                if (content == Content::amounts) {
                    const std::uint64_t texels =
                        static_cast<std::uint64_t>(found.image.width) * static_cast<std::uint64_t>(found.image.height);
                    if (3 * sizeof(float) * texels > texture_bytes_left(scene_, limits_))
                        return textures_too_large(found.path, limits_);
                    return grey_of(found.image);
                }
                if (found.image.channels < 3)
                    return Error{ExitCode::bad_input, found.path, "", "a map of normals has red, green and blue"};
                return whole_normals(found.image).image;
            });
        BN_TRY(ref);
        to = *ref;
        return {};
    }

    // Returns the map of normals: `norm`, or a bump map that holds normals.
    Result<const MtlMap*> normals_of(const MtlMaterial& from)
    {
        if (from.bump_map.file.empty())
            return &from.normal_map;
        if (!from.normal_map.file.empty()) {
            warn(fmt::format("material \"{}\": its bump map is not read beside norm", printable(from.name)));
            return &from.normal_map;
        }
        const Result<const Picture*> read = picture(from.bump_map.file, false);
        if (!read && read.error().code == ExitCode::stopped)
            return read.error();
        if (!read) // it may hold heights, which need not be read
            warn(fmt::format("material \"{}\": its bump map is left out: {}", printable(from.name), read.error().line()));
        else if (holds_normals((*read)->image))
            return &from.bump_map;
        else if (!(*read)->path.empty())
            warn(fmt::format("material \"{}\": its bump map holds heights of unknown unit, and is not read; norm takes normals",
                             printable(from.name)));
        return &from.normal_map;
    }

    Status put_maps(const MtlMaterial& from, Material& m)
    {
        BN_TRY(put_map(from.diffuse_map, Content::colours, m.base_color_tex));
        BN_TRY(put_map(from.emission_map, Content::colours, m.emissive_tex));
        if (m.emissive_tex.used() && !from.emission)
            m.emissive = glm::vec3(1.0f);
        BN_TRY(put_map(from.specular_map, Content::colours, m.specular_color_tex));
        if (m.specular_color_tex.used() && !from.specular)
            m.specular_color = glm::vec3(2.0f); // Ks 1
        const Result<const MtlMap*> normals = normals_of(from);
        BN_TRY(normals);
        BN_TRY(put_map(**normals, Content::normals, m.normal_tex));
        m.normal_scale = (*normals)->strength;
        BN_TRY(put_map(from.sheen_map, Content::amounts, m.sheen_color_tex));
        if (m.sheen_color_tex.used() && !from.sheen)
            m.sheen_color = glm::vec3(1.0f), m.sheen_roughness = 0.5f;
        if (from.opacity_map.file.empty())
            return put_metal_rough(from, m);
        if (from.opacity_map.file != from.diffuse_map.file)
            warn(fmt::format("material \"{}\": map_d is read only where it is map_Kd", printable(from.name)));
        else if (m.base_color_tex.used())
            m.alpha_mode = AlphaMode::mask, m.base_color.a = 1.0f;
        return put_metal_rough(from, m);
    }

    Status put_metal_rough(const MtlMaterial& from, Material& m)
    {
        const Picture* parts[2] = {&none_, &none_};
        const bool by_exponents = is_by_exponents(from);
        if (!by_exponents && !from.exponent_map.file.empty())
            warn(fmt::format("material \"{}\": map_Ns is not read beside Pr or map_Pr", printable(from.name)));
        const MtlMap* const maps[2] = {&from.metallic_map, by_exponents ? &from.exponent_map : &from.roughness_map};
        for (int i = 0; i < 2; ++i)
            if (!maps[i]->file.empty()) {
                const Result<const Picture*> read = picture(maps[i]->file, false);
                BN_TRY(read);
                parts[i] = *read;
            }
        Picture of_exponents;
        if (by_exponents && !parts[1]->image.empty()) {
            const float most = from.exponent.value_or(1000.0f);
            of_exponents = {fmt::format("{} times {}", parts[1]->path, most), roughness_of_exponents(parts[1]->image, most)};
            parts[1] = &of_exponents;
        }
        const Image &metallic = parts[0]->image, &roughness = parts[1]->image;
        if (metallic.empty() && roughness.empty())
            return {};
        m.metallic = from.metallic.value_or(metallic.empty() ? m.metallic : 1.0f);
        m.roughness = from.roughness.value_or(roughness.empty() ? m.roughness : 1.0f);
        const MtlMap &map = *maps[roughness.empty() ? 0 : 1], &other = *maps[0];
        if (!metallic.empty() && (map.scale != other.scale || map.offset != other.offset || map.clamps != other.clamps))
            warn(fmt::format("material \"{}\": map_Pm lies as map_Pr does", printable(from.name)));
        const Result<TextureRef> ref = textured({parts[0]->path, parts[1]->path, false, map.clamps}, map, [&]() -> Result<Image> {
            if (metal_rough_bytes(metallic, roughness) > texture_bytes_left(scene_, limits_))
                return textures_too_large(parts[roughness.empty() ? 0 : 1]->path, limits_);
            return metal_rough_of(metallic, roughness);
        });
        BN_TRY(ref);
        m.metallic_roughness_tex = *ref;
        return {};
    }

    static constexpr int kMostWarnings = 20;

    Scene& scene_;
    fs::path folder_;
    const Limits& limits_;
    const Jobs* jobs_;
    PicturesAhead ahead_;
    const Picture none_;
    std::map<std::pair<std::string, bool>, Picture> pictures_; // by path, and whether colours were read
    std::map<Key, std::int32_t> textures_;
    int warnings_ = 0;
};

// Returns the files that an mtllib statement names: its words, or all of it as one name with blanks.
std::vector<std::string> files_of(std::string_view statement, const fs::path& folder, const Limits& limits)
{
    if (picture_beside(folder, std::string(statement), limits))
        return {std::string(statement)};
    std::vector<std::string> names;
    for (std::string_view word = take_word(statement); !word.empty(); word = take_word(statement))
        names.emplace_back(word);
    return names;
}

} // namespace

Result<std::map<std::string, std::int32_t>> read_materials(Scene& scene, const std::string& obj, const std::vector<std::string>& libraries,
                                                           const Limits& limits, const Jobs* jobs)
{
    const fs::path folder = fs::path(obj).parent_path();
    std::map<std::string, std::int32_t> indices;
    std::set<std::string> seen;
    MaterialMaker maker(scene, folder, limits, jobs);
    for (const std::string& statement : libraries)
        for (const std::string& name : files_of(statement, folder, limits)) {
            const std::optional<std::string> path = picture_beside(folder, name, limits);
            if (!seen.insert(path.value_or(name)).second)
                continue;
            if (!path) {
                if (seen.size() <= kMostMissing)
                    scene.warnings.push_back(
                        fmt::format("material library {} is not found in the folder of the OBJ file", printable(name)));
                continue;
            }
            const Result<std::vector<std::uint8_t>> bytes = read_file(*path, limits.file_bytes);
            BN_TRY(bytes);
            scene.files.push_back(*path);
            const MtlLibrary library = parse_mtl(*path, std::string(bytes->begin(), bytes->end()));
            if (library.wrong)
                return *library.wrong;
            scene.warnings.insert(scene.warnings.end(), library.warnings.begin(), library.warnings.end());
            std::vector<const MtlMaterial*> added;
            for (const MtlMaterial& material : library.materials)
                if (indices.emplace(material.name, static_cast<std::int32_t>(scene.materials.size() + added.size())).second)
                    added.push_back(&material);
            maker.look_ahead(added);
            for (const MtlMaterial* material : added)
                BN_TRY(maker.add(*material));
        }
    return indices;
}

} // namespace burnish::obj
