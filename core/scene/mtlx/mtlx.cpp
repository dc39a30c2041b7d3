#include "core/scene/mtlx/mtlx.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <tuple>

#include "core/base/file.h"
#include "core/base/text.h"
#include "core/image/colour.h"
#include "core/image/io/image_io.h"
#include "core/image/io/stored_colour.h"
#include "core/scene/directional_roughness.h"
#include "core/scene/mtlx/surfaces.h"
#include "core/scene/picture_beside.h"
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

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 26; // of a document

// Returns a stored value: codes of 8 and 16 bits as [0,1].
float value_at(const Image& image, std::size_t at)
{
    if (image.type == PixelType::f32)
        return image.f32()[at];
    if (image.type == PixelType::u8)
        return static_cast<float>(std::to_integer<int>(image.bytes[at])) / 255.0f;
    std::uint16_t code;
    std::memcpy(&code, image.bytes.data() + 2 * at, sizeof code);
    return static_cast<float>(code) / 65535.0f;
}

// Returns one channel of an image times the factor, as floats where the factor is not 1. Gray has one channel for all.
Image channel_of(const Image& image, int channel, float factor)
{
    const std::size_t from = static_cast<std::size_t>(image.channels >= 3 ? std::min(channel, image.channels - 1) : 0),
                      each = static_cast<std::size_t>(image.channels), size = pixel_type_bytes(image.type);
    Image r = make_image(image.width, image.height, 1, factor == 1.0f ? image.type : PixelType::f32);
    const std::size_t count = static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height);
    for (std::size_t i = 0; i < count; ++i)
        if (factor == 1.0f)
            std::memcpy(r.bytes.data() + i * size, image.bytes.data() + (i * each + from) * size, size);
        else
            r.f32()[i] = value_at(image, i * each + from) * factor;
    return r;
}

class Wardrobe {
  public:
    Wardrobe(Scene& scene, std::string path, const Limits& limits) : scene_(scene), path_(std::move(path)), limits_(limits) {}

    Result<Material> make(const SurfaceMaterial& surface)
    {
        std::vector<std::string> unread;
        const Parts parts = mtlx::parts_of(surface, unread);
        std::vector<std::string> wanting;
        Material m = mtlx::material_of(surface, parts, wanting);
        BN_TRY(check_pictures(surface, parts));
        BN_TRY(put_pictures(surface, parts, m));
        warn_of(surface, "nothing is made of", unread);
        warn_of(surface, "not drawn as the file has it:", wanting);
        return m;
    }

    bool has_pictures() const { return !textures_.empty(); }

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

    Result<Image> read(const SurfaceMaterial& surface, const Input& input, bool colours)
    {
        const std::optional<std::string> path = picture_beside(fs::path(path_).parent_path(), input.picture->file, limits_);
        if (!path)
            return fault(surface, input, fmt::format("picture {} is not found in the folder of the file", printable(input.picture->file)));
        Limits rest = limits_;
        rest.texture_bytes = texture_bytes_left(scene_, limits_);
        PictureNotes notes;
        Result<Image> image = colours ? read_colours(*path, rest, notes) : read_image(*path, rest, &notes);
        BN_TRY(image);
        for (const std::string& warning : notes.warnings)
            scene_.warnings.push_back(*path + ": " + warning);
        if (std::find(scene_.files.begin(), scene_.files.end(), *path) == scene_.files.end())
            scene_.files.push_back(*path);
        return image;
    }

    // Returns a reference to a texture of the image, at the picture's place.
    Result<TextureRef> place(const PictureInput& picture, const std::string& kind, Image image)
    {
        if (image.bytes.size() > texture_bytes_left(scene_, limits_))
            return textures_too_large(path_, limits_);
        const auto key = std::tuple(picture.file, kind, picture.wrap_s, picture.wrap_t, picture.nearest);
        auto known = textures_.find(key);
        if (known == textures_.end()) {
            Texture like;
            like.wrap_s = picture.wrap_s, like.wrap_t = picture.wrap_t, like.nearest = picture.nearest;
            known = textures_.emplace(key, add_texture(scene_, picture.file.c_str(), std::move(image), like)).first;
        }
        TextureRef ref;
        ref.texture = known->second;
        const glm::vec2 s = picture.tiling, o = -picture.offset; // v runs up in the file, down in the scene
        ref.uv_transform = glm::mat3x2(glm::vec2(s.x, 0.0f), glm::vec2(0.0f, s.y), glm::vec2(o.x, 1.0f - s.y - o.y));
        return ref;
    }

    // Puts a picture of colours; the picture's factor becomes the material's.
    Status put_colours(const SurfaceMaterial& surface, const Input& input, TextureRef& to)
    {
        Result<Image> image = read(surface, input, true);
        BN_TRY(image);
        if (!input.picture->encoded && image->type != PixelType::f32) // the slot decodes 8 and 16 bits
            image = linear_as_floats(*image);
        clip_negative_colours(*image);
        const Result<TextureRef> ref = place(*input.picture, input.picture->encoded ? "colours" : "linear colours", std::move(*image));
        BN_TRY(ref);
        to = *ref;
        return {};
    }

    static Image linear_as_floats(const Image& image)
    {
        Image r = make_image(image.width, image.height, image.channels, PixelType::f32);
        const std::size_t count = r.bytes.size() / sizeof(float);
        for (std::size_t i = 0; i < count; ++i)
            r.f32()[i] = value_at(image, i);
        return r;
    }

    Status put_number(const SurfaceMaterial& surface, const Input& input, TextureRef& to)
    {
        const Result<Image> image = read(surface, input, false);
        BN_TRY(image);
        const PictureInput& p = *input.picture;
        const Result<TextureRef> ref =
            place(p, fmt::format("channel {} times {}", p.channel, p.factor.x), channel_of(*image, p.channel, p.factor.x));
        BN_TRY(ref);
        to = *ref;
        return {};
    }

    Status put_normals(const SurfaceMaterial& surface, const Input& input, TextureRef& to, float& scale)
    {
        Result<Image> image = read(surface, input, false);
        BN_TRY(image);
        if (image->channels < 3)
            return fault(surface, input, "a map of normals has red, green and blue");
        const Result<TextureRef> ref = place(*input.picture, "normals", whole_normals(std::move(*image)).image);
        BN_TRY(ref);
        to = *ref, scale = *input.picture->normal_scale;
        return {};
    }

    Status put_pictures(const SurfaceMaterial& surface, const Parts& parts, Material& m)
    {
        if (const Input& base = at(parts, Part::base_color); base.picture) {
            BN_TRY(put_colours(surface, base, m.base_color_tex));
            m.base_color = glm::vec4(glm::clamp(base.picture->factor * mtlx::number(parts, Part::base), 0.0f, 1.0f), m.base_color.a);
        }
        if (const Input& light = at(parts, Part::emission_color); light.picture) {
            BN_TRY(put_colours(surface, light, m.emissive_tex));
            m.emissive = glm::vec3(1.0f),
            m.emissive_strength = std::max(mtlx::number(parts, Part::emission) * light.picture->factor.x, 0.0f);
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
            BN_TRY(put_number(surface, input, m.iridescence_thickness_tex));
            m.iridescence_thickness_least = 0.0f, m.iridescence_thickness = surface.kind == "open_pbr_surface" ? 1000.0f : 1.0f;
        }
        if (at(parts, Part::normal).picture)
            BN_TRY(put_normals(surface, at(parts, Part::normal), m.normal_tex, m.normal_scale));
        if (at(parts, Part::coat_normal).picture)
            BN_TRY(put_normals(surface, at(parts, Part::coat_normal), m.clearcoat_normal_tex, m.clearcoat_normal_scale));
        return put_lobe(surface, parts, m);
    }

    // Puts metalness and roughness. Roughness of a stretched lobe becomes two widths a texel.
    Status put_lobe(const SurfaceMaterial& surface, const Parts& parts, Material& m)
    {
        const Input &metal = at(parts, Part::metalness), &rough = at(parts, Part::roughness);
        if (!metal.picture && !rough.picture)
            return {};
        Image maps[2];
        for (const Input* const input : {&metal, &rough})
            if (input->picture) {
                const Result<Image> image = read(surface, *input, false);
                BN_TRY(image);
                maps[input == &rough] = channel_of(*image, input->picture->channel, input->picture->factor.x);
            }
        const float anisotropy = mtlx::number(parts, Part::anisotropy);
        const PictureInput& picture = *(rough.picture ? rough : metal).picture;
        if (metal.picture && rough.picture && (metal.picture->tiling != picture.tiling || metal.picture->offset != picture.offset))
            return fault(surface, metal, "lies otherwise than the roughness");
        const std::string kind = fmt::format("metalness {} {} and roughness {} {}", metal.picture ? metal.picture->file : "",
                                             metal.picture ? metal.picture->channel : 0, picture.channel, anisotropy);
        if (rough.picture && anisotropy > 0.0f) {
            Image widths = make_image(maps[1].width, maps[1].height, 3, PixelType::f32);
            const std::size_t count = static_cast<std::size_t>(maps[1].width) * static_cast<std::size_t>(maps[1].height);
            for (std::size_t i = 0; i < count; ++i) {
                const mtlx::Widths w = mtlx::widths_of(surface.kind, static_cast<double>(std::clamp(value_at(maps[1], i), 0.0f, 1.0f)),
                                                       static_cast<double>(anisotropy));
                widths.f32()[3 * i] = static_cast<float>(std::min(w.along, 1.0)), widths.f32()[3 * i + 1] = static_cast<float>(w.across);
            }
            const Result<TextureRef> ref = place(picture, kind + " widths", roughness_of(widths, RoughnessEncoding::widths).image);
            BN_TRY(ref);
            m.directional_roughness_tex = *ref;
        }
        if (metal_rough_bytes(maps[0], maps[1]) > texture_bytes_left(scene_, limits_))
            return textures_too_large(path_, limits_);
        const Result<TextureRef> ref = place(picture, kind, metal_rough_of(maps[0], maps[1]));
        BN_TRY(ref);
        m.metallic_roughness_tex = *ref;
        m.metallic = metal.picture ? 1.0f : m.metallic, m.roughness = rough.picture ? 1.0f : m.roughness;
        return {};
    }

    Scene& scene_;
    const std::string path_;
    const Limits& limits_;
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
    for (const SurfaceMaterial& each : all)
        names += (names.empty() ? "" : ", ") + printable(each.name);
    return {ExitCode::usage, path, "", fmt::format("no material of the scene has the name of one of these: {}", names),
            "MaterialOverrides::material"};
}

} // namespace

Status apply_mtlx(Scene& scene, const std::string& path, const Limits& limits)
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
    for (std::size_t i = 0; i < wears.size(); ++i)
        for (const SurfaceMaterial& each : *all)
            if (each.name == scene.materials[i].name)
                wears[i] = &each, named = true;
    if (!named && all->size() > 1)
        return nothing_named(path, *all);
    if (!named)
        std::fill(wears.begin(), wears.end(), &all->front());
    // Put it on
    Wardrobe wardrobe(scene, path, limits);
    std::map<const SurfaceMaterial*, Material> made;
    const std::vector<bool> worn = worn_with_coordinates(scene);
    for (std::size_t i = 0; i < wears.size(); ++i) {
        Material& m = scene.materials[i];
        if (!wears[i] || m.emitter != kNoEmitter)
            continue;
        auto known = made.find(wears[i]);
        if (known == made.end()) {
            Result<Material> one = wardrobe.make(*wears[i]);
            BN_TRY(one);
            known = made.emplace(wears[i], std::move(*one)).first;
        }
        if (wardrobe.has_pictures() && !worn[i] && std::none_of(worn.begin(), worn.end(), [](bool w) { return w; }))
            return Error{ExitCode::bad_input, path, "", "nothing in the scene has texture coordinates for its pictures"};
        const std::string name = m.name;
        m = known->second;
        m.name = name;
    }
    return {};
}

} // namespace burnish
