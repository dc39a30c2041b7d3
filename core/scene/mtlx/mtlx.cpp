#include "core/scene/mtlx/mtlx.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <set>
#include <tuple>

#include "core/base/file.h"
#include "core/base/text.h"
#include "core/image/io/image_io.h"
#include "core/image/io/stored_colour.h"
#include "core/scene/directional_roughness.h"
#include "core/scene/mtlx/channels.h"
#include "core/scene/mtlx/surfaces.h"
#include "core/scene/picture_beside.h"
#include "core/scene/pictures_ahead.h"
#include "core/scene/surface_maps.h"
#include "core/scene/texture.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;
using mtlx::at;
using mtlx::Input;
using mtlx::Part;
using mtlx::Parts;
using mtlx::PictureInput;
using mtlx::SurfaceMaterial;

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 23; // of a document
constexpr std::size_t kMostNames = 10;                       // in an error

bool uses_textures(const Material& m)
{
    bool used = false;
#define BN_TEXTURE(name, path) used |= m.name.used();
#include "core/scene/material.def"
    return used;
}

bool is_finite(const Material& m)
{
    for (const float value : {m.emissive.r, m.emissive.g, m.emissive.b, m.emissive_strength, m.specular_color.r, m.specular_color.g,
                              m.specular_color.b, m.ior, m.dispersion, m.thickness, m.attenuation_distance, m.iridescence_thickness,
                              m.iridescence_ior, m.anisotropy_rotation, m.normal_scale, m.clearcoat_normal_scale})
        if (!std::isfinite(value))
            return false;
    return true;
}

class Wardrobe {
  public:
    Wardrobe(Scene& scene, std::string path, const Limits& limits) : scene_(scene), path_(std::move(path)), limits_(limits) {}

    // Decodes the pictures of surfaces on all threads, for make().
    void look_ahead(const std::set<const SurfaceMaterial*>& surfaces, const Jobs* jobs)
    {
        if (!jobs)
            return;
        std::set<std::pair<std::string, bool>> names;
        for (const SurfaceMaterial* surface : surfaces) {
            std::vector<std::string> unread;
            const Parts parts = mtlx::parts_of(*surface, unread);
            if (!check_pictures(*surface, parts))
                continue;
            for (std::size_t i = 0; i < parts.size(); ++i) {
                const Part part = static_cast<Part>(i);
                if (parts[i].picture && part != Part::opacity) // which comes with the base colour
                    names.emplace(parts[i].picture->file, part == Part::base_color || part == Part::emission_color);
            }
        }
        std::vector<PicturesAhead::Wanted> wanted;
        for (const auto& [name, colours] : names)
            if (const auto path = picture_beside(fs::path(path_).parent_path(), name, limits_))
                wanted.push_back({*path, colours});
        ahead_ = PicturesAhead(wanted, limits_left(scene_, limits_), jobs);
    }

    Result<Material> make(const SurfaceMaterial& surface)
    {
        std::vector<std::string> unread;
        const Parts parts = mtlx::parts_of(surface, unread);
        std::vector<std::string> wanting;
        Material m = mtlx::material_of(surface, parts, wanting);
        BN_TRY(check_pictures(surface, parts));
        BN_TRY(put_pictures(surface, parts, m, wanting));
        if (!is_finite(m))
            return Error{ExitCode::bad_input, path_, fmt::format("{} {}", surface.kind, printable(surface.name)),
                         "its numbers are too large"};
        warn_of(surface, "nothing is made of", unread);
        warn_of(surface, "not drawn as the file has it:", wanting);
        return m;
    }

  private:
    void warn_of(const SurfaceMaterial& surface, const char* words, const std::vector<std::string>& names)
    {
        std::string list;
        for (const std::string& name : names)
            list += (list.empty() ? "" : ", ") + printable(name);
        if (!list.empty())
            scene_.warnings.push_back(fmt::format("{}: material \"{}\": {} {}", path_, printable(surface.name), words, list));
    }

    Error fault(const SurfaceMaterial& surface, const Input& input, std::string reason) const
    {
        return {ExitCode::bad_input, path_, fmt::format("{} {}: {}", surface.kind, printable(surface.name), printable(input.name)),
                std::move(reason)};
    }

    // Checks that pictures stand only where they are read.
    Status check_pictures(const SurfaceMaterial& surface, const Parts& parts) const
    {
        enum { none, colour, number, normal };
        constexpr int kTexts[] = {
#define BN_PART(part, text, standard, standard_value, open, open_value, gltf, gltf_value) text,
#include "core/scene/mtlx/parts.def"
        };
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (!parts[i].picture)
                continue;
            if (kTexts[i] == none)
                return fault(surface, parts[i], "pictures are not read here");
            if ((kTexts[i] == normal) != parts[i].picture->normal_scale.has_value())
                return fault(surface, parts[i], kTexts[i] == normal ? "a picture needs a node normalmap here" : "takes no normals");
        }
        return {};
    }

    // Reads a picture once.
    Result<const Image*> read(const SurfaceMaterial& surface, const Input& input, bool colours)
    {
        const std::optional<std::string> path = picture_beside(fs::path(path_).parent_path(), input.picture->file, limits_);
        if (!path)
            return fault(surface, input, fmt::format("picture {} is not found in the folder of the file", printable(input.picture->file)));
        const auto key = std::pair(*path, colours);
        if (const auto known = pictures_.find(key); known != pictures_.end())
            return &known->second;
        PictureNotes notes;
        Result<Image> image = ahead_.read(*path, colours, limits_left(scene_, limits_), notes);
        BN_TRY(image);
        for (const std::string& warning : notes.warnings)
            scene_.warnings.push_back(*path + ": " + warning);
        if (const std::size_t clipped = colours ? clip_negative_colours(*image) : 0)
            scene_.warnings.push_back(fmt::format("{}: {} texels of negative colour are set to 0", *path, clipped));
        if (std::find(scene_.files.begin(), scene_.files.end(), *path) == scene_.files.end())
            scene_.files.push_back(*path);
        return &pictures_.emplace(key, std::move(*image)).first->second;
    }

    // Returns a reference to a texture at the picture's place. kind: tells textures of one file apart. make: makes the image of a new one.
    template <class Make> Result<TextureRef> place(const PictureInput& picture, const std::string& kind, const Make& make)
    {
        const auto key = std::tuple(picture.file, kind, picture.wrap_s, picture.wrap_t, picture.nearest);
        auto known = textures_.find(key);
        if (known == textures_.end()) {
            Image image = make();
            if (image.bytes.size() > texture_bytes_left(scene_, limits_))
                return textures_too_large(path_, limits_);
            Texture like;
            like.wrap_s = picture.wrap_s, like.wrap_t = picture.wrap_t, like.nearest = picture.nearest;
            known = textures_.emplace(key, add_texture(scene_, picture.file.c_str(), std::move(image), like)).first;
        }
        TextureRef ref;
        ref.texture = known->second;
        const glm::vec2 s = picture.scale;
        ref.uv_transform = glm::mat3x2(glm::vec2(s.x, 0.0f), glm::vec2(0.0f, s.y), picture.offset);
        return ref;
    }

    static std::string key_of(const PictureInput& p)
    {
        return fmt::format("{} {} {} {}", p.file, p.channel, p.factor[0], p.encoded);
    }

    // Puts a picture of colours; its factor becomes the material's.
    Status put_colours(const SurfaceMaterial& surface, const Input& input, bool with_alpha, TextureRef& to)
    {
        if (input.picture->one_channel)
            return fault(surface, input, "one channel of a picture is not read as a colour");
        const Result<const Image*> image = read(surface, input, true);
        BN_TRY(image);
        const Result<TextureRef> ref = place(*input.picture, fmt::format("colours {} {}", input.picture->encoded, with_alpha),
                                             [&] { return mtlx::colours_of(**image, *input.picture, with_alpha); });
        BN_TRY(ref);
        to = *ref;
        return {};
    }

    Status put_number(const SurfaceMaterial& surface, const Input& input, TextureRef& to, float most = 1.0f)
    {
        const Result<const Image*> image = read(surface, input, false);
        BN_TRY(image);
        const Result<TextureRef> ref = place(*input.picture, fmt::format("{} to {}", key_of(*input.picture), most),
                                             [&] { return mtlx::channel_of(**image, *input.picture, most); });
        BN_TRY(ref);
        to = *ref;
        return {};
    }

    Status put_normals(const SurfaceMaterial& surface, const Input& input, TextureRef& to, float& scale)
    {
        const Result<const Image*> image = read(surface, input, false);
        BN_TRY(image);
        if ((*image)->channels < 3)
            return fault(surface, input, "a map of normals has red, green and blue");
        if (input.picture->one_channel || input.picture->factor != glm::vec4(1.0f))
            return fault(surface, input, "a map of normals takes no factor and no channel");
        const Result<TextureRef> ref = place(*input.picture, "normals", [&] { return whole_normals(Image(**image)).image; });
        BN_TRY(ref);
        to = *ref, scale = *input.picture->normal_scale;
        return {};
    }

    static bool lies_as(const PictureInput& a, const PictureInput& b)
    {
        return a.file == b.file && is_placed_as(a, b);
    }
    static bool is_placed_as(const PictureInput& a, const PictureInput& b)
    {
        return a.scale == b.scale && a.offset == b.offset && a.wrap_s == b.wrap_s && a.wrap_t == b.wrap_t && a.nearest == b.nearest;
    }

    // Puts the base colour, with alpha where the opacity is the picture's own.
    Status put_base(const SurfaceMaterial& surface, const Parts& parts, Material& m)
    {
        const Input &base = at(parts, Part::base_color), &opacity = at(parts, Part::opacity);
        if (opacity.picture && (!base.picture || !lies_as(*opacity.picture, *base.picture) || opacity.picture->channel != 3))
            return fault(surface, opacity, "pictures are read here only as the alpha of the base colour's picture");
        if (!base.picture)
            return {};
        BN_TRY(put_colours(surface, base, opacity.picture.has_value(), m.base_color_tex));
        m.base_color = glm::vec4(glm::clamp(glm::vec3(base.picture->factor) * mtlx::number(parts, Part::base), 0.0f, 1.0f), m.base_color.a);
        if (opacity.picture) {
            m.base_color.a = std::clamp(opacity.picture->factor[3], 0.0f, 1.0f);
            const float mode = mtlx::number(parts, Part::alpha_mode);
            m.alpha_mode = mode < 0.5f ? AlphaMode::opaque : mode < 1.5f ? AlphaMode::mask : AlphaMode::blend;
        }
        return {};
    }

    Status put_pictures(const SurfaceMaterial& surface, const Parts& parts, Material& m, std::vector<std::string>& wanting)
    {
        BN_TRY(put_base(surface, parts, m));
        if (const Input& light = at(parts, Part::emission_color); light.picture) {
            BN_TRY(put_colours(surface, light, false, m.emissive_tex));
            mtlx::put_emission(glm::vec3(light.picture->factor) * mtlx::number(parts, Part::emission), m);
        }
        struct Number {
            Part part;
            TextureRef Material::*to;
            float Material::*factor;
        };
        constexpr Number kNumbers[] = {
            {Part::occlusion, &Material::occlusion_tex, &Material::occlusion_strength},
            {Part::transmission, &Material::transmission_tex, &Material::transmission},
            {Part::coat, &Material::clearcoat_tex, &Material::clearcoat},
            {Part::coat_roughness, &Material::clearcoat_roughness_tex, &Material::clearcoat_roughness},
            {Part::film, &Material::iridescence_tex, &Material::iridescence},
        };
        for (const Number& number : kNumbers)
            if (const Input& input = at(parts, number.part); input.picture) {
                BN_TRY(put_number(surface, input, m.*number.to));
                m.*number.factor = 1.0f;
            }
        if (const Input& input = at(parts, Part::film_thickness); input.picture) {
            BN_TRY(put_number(surface, input, m.iridescence_thickness_tex, 1e6f));
            m.iridescence_thickness_least = 0.0f, m.iridescence_thickness = surface.kind == "open_pbr_surface" ? 1000.0f : 1.0f;
        }
        if (at(parts, Part::normal).picture)
            BN_TRY(put_normals(surface, at(parts, Part::normal), m.normal_tex, m.normal_scale));
        if (at(parts, Part::coat_normal).picture)
            BN_TRY(put_normals(surface, at(parts, Part::coat_normal), m.clearcoat_normal_tex, m.clearcoat_normal_scale));
        if (surface.kind != "gltf_pbr" && m.transmission > 0.0f &&
            (at(parts, Part::base_color).picture || at(parts, Part::transmission).picture))
            wanting.push_back("transmission beside a picture (the base colour tints what passes)");
        if (surface.kind == "open_pbr_surface" && (at(parts, Part::coat).picture || at(parts, Part::coat_roughness).picture))
            wanting.push_back("a coat with a picture (it roughens nothing below)");
        return put_lobe(surface, parts, m);
    }

    // Puts metalness and roughness. Roughness of a stretched lobe becomes two widths a texel.
    Status put_lobe(const SurfaceMaterial& surface, const Parts& parts, Material& m)
    {
        const Input &metal = at(parts, Part::metalness), &rough = at(parts, Part::roughness);
        if (!metal.picture && !rough.picture)
            return {};
        const PictureInput& picture = *(rough.picture ? rough : metal).picture;
        Image maps[2];
        std::string kind = surface.kind;
        for (const Input* const input : {&metal, &rough}) {
            kind += input->picture ? ", " + key_of(*input->picture) : ", none";
            if (!input->picture)
                continue;
            const PictureInput& p = *input->picture;
            if (!is_placed_as(p, picture))
                return fault(surface, metal, "lies otherwise than the roughness");
            const Result<const Image*> image = read(surface, *input, false);
            BN_TRY(image);
            maps[input == &rough] = mtlx::channel_of(**image, p, 1.0f);
        }
        const mtlx::LobeOfRoughness lobe = mtlx::lobe_of(surface, parts);
        const auto roughness_at = [&](std::size_t i) { return static_cast<double>(std::clamp(mtlx::value_at(maps[1], i), 0.0f, 1.0f)); };
        const std::size_t count = static_cast<std::size_t>(maps[1].width) * static_cast<std::size_t>(maps[1].height);
        kind += fmt::format(", {} {} {}", lobe.anisotropy, lobe.coat, lobe.coat_roughness);
        if (rough.picture && lobe.anisotropy > 0.0) {
            const Result<TextureRef> ref = place(picture, kind + ", widths", [&] {
                Image widths = make_image(maps[1].width, maps[1].height, 3, PixelType::f32);
                for (std::size_t i = 0; i < count; ++i) {
                    const mtlx::Widths w = lobe.widths(roughness_at(i));
                    widths.f32()[3 * i] = static_cast<float>(std::min(w.along, 1.0)),
                                     widths.f32()[3 * i + 1] = static_cast<float>(w.across);
                }
                return roughness_of(widths, RoughnessEncoding::widths).image;
            });
            BN_TRY(ref);
            m.directional_roughness_tex = *ref;
        }
        if (metal_rough_bytes(maps[0], maps[1]) > texture_bytes_left(scene_, limits_))
            return textures_too_large(path_, limits_);
        const Result<TextureRef> ref = place(picture, kind, [&] {
            if (rough.picture && lobe.coat > 0.0 && lobe.coat_roughness > 0.0) {
                Image coated = make_image(maps[1].width, maps[1].height, 1, PixelType::f32);
                for (std::size_t i = 0; i < count; ++i)
                    coated.f32()[i] = static_cast<float>(lobe.below_coat(roughness_at(i)));
                maps[1] = std::move(coated);
            }
            return metal_rough_of(maps[0], maps[1]);
        });
        BN_TRY(ref);
        m.metallic_roughness_tex = *ref;
        m.metallic = metal.picture ? 1.0f : m.metallic, m.roughness = rough.picture ? 1.0f : m.roughness;
        return {};
    }

    Scene& scene_;
    const std::string path_;
    const Limits& limits_;
    PicturesAhead ahead_;
    std::map<std::pair<std::string, bool>, Image> pictures_; // by path, and whether colours were read
    std::map<std::tuple<std::string, std::string, WrapMode, WrapMode, bool>, std::int32_t> textures_;
};

// Returns whether each material of the scene is worn by something with texture coordinates.
std::vector<bool> worn_with_coordinates(const Scene& scene)
{
    std::vector<bool> worn(scene.materials.size(), false);
    for (const Primitive& primitive : scene.primitives)
        if (primitive.has_uv0)
            worn[static_cast<std::size_t>(primitive.material)] = true;
    return worn;
}

Error nothing_named(const std::string& path, const std::vector<SurfaceMaterial>& all)
{
    std::string names;
    for (std::size_t i = 0; i < std::min(all.size(), kMostNames); ++i)
        names += (i ? ", " : "") + printable(all[i].name);
    if (all.size() > kMostNames)
        names += fmt::format(" and {} more", all.size() - kMostNames);
    return {ExitCode::usage, path, "", fmt::format("no material of the scene has the name of one of these: {}", names),
            "MaterialOverrides::material"};
}

} // namespace

Status apply_mtlx(Scene& scene, const std::string& path, const Limits& limits, const Jobs* jobs)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, std::min(kMostBytes, limits.file_bytes));
    BN_TRY(bytes);
    const Result<std::vector<SurfaceMaterial>> all =
        mtlx::read_document({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, path);
    BN_TRY(all);
    scene.files.push_back(path);
    // Find each material's own
    std::vector<const SurfaceMaterial*> wears(scene.materials.size(), nullptr);
    bool named = false;
    std::map<std::string, const SurfaceMaterial*> by_name;
    for (const SurfaceMaterial& each : *all)
        by_name.emplace(each.name, &each);
    for (std::size_t i = 0; i < wears.size(); ++i)
        if (const auto own = by_name.find(scene.materials[i].name); own != by_name.end())
            wears[i] = own->second, named = true;
    if (!named && all->size() > 1)
        return nothing_named(path, *all);
    if (!named)
        std::fill(wears.begin(), wears.end(), &all->front());
    for (std::size_t i = 0; i < wears.size(); ++i)
        if (scene.materials[i].emitter != kNoEmitter)
            wears[i] = nullptr;
    // Put it on
    Wardrobe wardrobe(scene, path, limits);
    std::set<const SurfaceMaterial*> surfaces(wears.begin(), wears.end());
    surfaces.erase(nullptr);
    wardrobe.look_ahead(surfaces, jobs);
    std::map<const SurfaceMaterial*, Material> made;
    const std::vector<bool> worn = worn_with_coordinates(scene);
    for (std::size_t i = 0; i < wears.size(); ++i) {
        Material& m = scene.materials[i];
        if (!wears[i])
            continue;
        auto known = made.find(wears[i]);
        if (known == made.end()) {
            Result<Material> one = wardrobe.make(*wears[i]);
            BN_TRY(one);
            known = made.emplace(wears[i], std::move(*one)).first;
        }
        if (uses_textures(known->second) && !worn[i])
            return Error{ExitCode::bad_input, path, "",
                         fmt::format("material \"{}\" is worn by nothing with texture coordinates for its pictures", printable(m.name))};
        const std::string name = m.name;
        const bool double_sided = m.double_sided; // MaterialX tells nothing of sides
        m = known->second;
        m.name = name, m.double_sided = double_sided;
    }
    return {};
}

} // namespace burnish
