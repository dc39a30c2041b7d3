#include "core/scene/gltf/material.h"

#include <cmath>
#include <fmt/format.h>
#include <map>
#include <utility>

#include "core/math/scalar_math.h"
#include "core/scene/directional_roughness.h"
#include "core/scene/gltf/factors.h"
#include "core/scene/gltf/image.h"
#include "core/scene/gltf/textures.h"
#include "core/scene/surface_maps.h"

namespace burnish::gltf {

namespace {

// Sampler codes (glTF 2.0, 5.26).
constexpr std::uint64_t kRepeat = 10497, kClampToEdge = 33071, kMirroredRepeat = 33648;
constexpr std::uint64_t kNearest = 9728, kNearestMipmapNearest = 9984, kNearestMipmapLinear = 9986;

WrapMode wrap_mode(std::uint64_t code)
{
    return code == kClampToEdge ? WrapMode::clamp : code == kMirroredRepeat ? WrapMode::mirror : WrapMode::repeat;
}

bool is_nearest(const Json& sampler)
{
    const std::uint64_t min = get_uint(sampler, "minFilter", kNearest);
    return get_uint(sampler, "magFilter", 0) == kNearest &&
           (min == kNearest || min == kNearestMipmapNearest || min == kNearestMipmapLinear);
}

// Returns the texture's index in Scene::textures; kNone where the file offers no readable image. `extras`: a burnish
// extra, which also allows float images.
int scene_texture(Document& doc, int index, bool extras)
{
    // Reuse a texture already in the scene
    if (const auto known = doc.scene_textures.find(index); known != doc.scene_textures.end())
        return known->second;
    const Json& source = doc.json["textures"][static_cast<std::size_t>(index)];
    const int image = image_of_texture(source);
    int id = kNone;
    if (image < 0) {
        doc.warn(quoted(get_string(source, "name"), "texture", static_cast<std::size_t>(index)) +
                 " has no image that can be read; left out");
    } else {
        // Read the image and the sampler
        Texture texture;
        texture.name = get_string(source, "name");
        texture.image = scene_image(doc, image, extras);
        if (const int at = get_index(source, "sampler"); at >= 0) {
            const Json& sampler = doc.json["samplers"][static_cast<std::size_t>(at)];
            texture.wrap_s = wrap_mode(get_uint(sampler, "wrapS", kRepeat));
            texture.wrap_t = wrap_mode(get_uint(sampler, "wrapT", kRepeat));
            texture.nearest = is_nearest(sampler);
        }
        id = static_cast<int>(doc.scene.textures.size());
        doc.scene.textures.push_back(std::move(texture));
    }
    doc.scene_textures[index] = id;
    return id;
}

// Reads a textureInfo. `of` is its material's name in warnings.
TextureRef texture_ref(Document& doc, const Json& info, bool extras, const std::string& of)
{
    TextureRef ref;
    ref.texture = scene_texture(doc, get_index(info, "index"), extras);
    std::uint64_t tex_coord = get_uint(info, "texCoord", 0);
    if (const Json* transform = get_extension(info, "KHR_texture_transform")) {
        double offset[2] = {0.0, 0.0}, scale[2] = {1.0, 1.0};
        for (std::size_t i = 0; i < 2; ++i) {
            if (const Json* numbers = get_member(*transform, "offset"))
                offset[i] = (*numbers)[i].get<double>();
            if (const Json* numbers = get_member(*transform, "scale"))
                scale[i] = (*numbers)[i].get<double>();
        }
        ref.uv_transform = texture_transform(offset, get_number(*transform, "rotation", 0.0), scale);
        tex_coord = get_uint(*transform, "texCoord", tex_coord);
    }
    if (tex_coord > 1)
        doc.warn(fmt::format("{}: texture coordinates TEXCOORD_{} are not supported, TEXCOORD_0 is used", of, tex_coord));
    ref.uv_set = tex_coord == 1 ? 1 : 0;
    return ref;
}

Material load_material(Document& doc, const Json& source, std::size_t index)
{
    Material material;
    material.name = get_string(source, "name");
    const std::string of = quoted(material.name, "material", index);
#define BN_FACTOR(kind, name, fallback, path, least, most) read_factor(source, path, material.name);
#define BN_FLAG(kind, name, path) read_flag(source, path, material.name);
#define BN_CHOICE(type, name, words, path) read_choice(source, path, words, material.name);
#include "core/scene/material.def"
    for (const MaterialTexture& texture : kMaterialTextures)
        if (const Json::json_pointer at(texture.path); source.contains(at))
            material.*texture.to = texture_ref(doc, source[at], std::string_view(texture.path).starts_with("/extras/"), of);
    if (source.contains(Json::json_pointer("/extensions/KHR_materials_volume/thicknessTexture"))) {
        doc.warn(of + ": the thickness texture is left out; the mesh tells the thickness");
        material.thickness = 0.0f;
    }
    return material;
}

// Maps already converted from burnish's encodings: (file texture, encoding) to scene texture.
using Imported = std::map<std::pair<std::int32_t, int>, std::int32_t>;

// Converts a map once and stores its reference in `to`. `convert` returns the scene's encoding.
template <class Convert>
void import_map(Document& doc, Imported& known, TextureRef& from, int encoding, const std::string& place, TextureRef& to,
                const Convert& convert)
{
    if (!from.used())
        return;
    const auto [it, is_new] = known.try_emplace({from.texture, encoding}, static_cast<std::int32_t>(doc.scene.textures.size()));
    if (is_new) {
        Texture texture = doc.scene.textures[static_cast<std::size_t>(from.texture)];
        SurfaceMap map = convert(doc.scene.images[static_cast<std::size_t>(texture.image)]);
        if (map.repaired > 0)
            doc.warn(fmt::format("{}: {} texels hold nothing of their kind and are repaired", place, map.repaired));
        texture.image = static_cast<std::int32_t>(doc.scene.images.size());
        doc.texture_bytes += map.image.bytes.size();
        doc.scene.images.push_back(std::move(map.image));
        doc.scene.textures.push_back(std::move(texture));
    }
    to = from;
    to.texture = it->second;
    from = TextureRef();
}

void import_maps(Document& doc, Imported& known, const Json& source, std::size_t index, Material& m)
{
    const std::string place = fmt::format("/materials/{}/extras/burnish/", index);
    import_map(doc, known, m.quaternion_tex, -1, place + "quaternionTexture", m.normal_tex, normals_of_quaternions);
    if (m.directional_roughness_tex.used()) {
        constexpr int kFirstOfRoughness = 16; // beyond the rotation encodings
        RoughnessEncoding by = RoughnessEncoding::widths;
        const std::string_view ways = kRoughnessEncodings;
        read_choice(source, "/extras/burnish/directionalRoughnessTexture/encoding", ways, by);
        TextureRef from = std::exchange(m.directional_roughness_tex, TextureRef());
        import_map(doc, known, from, kFirstOfRoughness + static_cast<int>(by), place + "directionalRoughnessTexture",
                   m.directional_roughness_tex, [by](const Image& image) { return roughness_of(image, by); });
    }
    if (!m.rotation_tex.used())
        return;
    const std::string_view words = kRotationEncodings;
    RotationEncoding encoding = RotationEncoding::vector;
    read_choice(source, "/extras/burnish/rotationTexture/encoding", words, encoding);
    if (m.anisotropy_tex.used())
        doc.warn(place + "rotationTexture takes the place of the anisotropy texture");
    import_map(doc, known, m.rotation_tex, static_cast<int>(encoding), place + "rotationTexture", m.anisotropy_tex,
               [encoding](const Image& image) { return directions_of_rotations(image, encoding); });
    if (!(m.anisotropy_strength > 0.0f))
        m.anisotropy_strength = 1.0f;
}

} // namespace

// Returns the transform. Its rotation follows the extension's text (counter-clockwise in texture space, with v pointing
// down) and test model. The matrix printed in the extension rotates the other way.
glm::mat3x2 texture_transform(const double offset[2], double rotation, const double scale[2])
{
    constexpr double kTwoPi = 6.283185307179586;
    const double angle = std::fmod(rotation, kTwoPi); // exact; the functions need a bounded argument
    const double s = det_sin(angle), c = det_cos(angle);
    const auto f = [](double x) { return static_cast<float>(x); };
    return {f(c * scale[0]), f(-s * scale[0]), f(s * scale[1]), f(c * scale[1]), f(offset[0]), f(offset[1])};
}

int clamped_texture(Document& doc, int index)
{
    const int id = scene_texture(doc, index, true);
    if (id == kNone)
        return kNone;
    Texture texture = doc.scene.textures[static_cast<std::size_t>(id)];
    texture.wrap_s = texture.wrap_t = WrapMode::clamp, texture.nearest = false;
    for (std::size_t i = 0; i < doc.scene.textures.size(); ++i)
        if (const Texture& t = doc.scene.textures[i];
            t.image == texture.image && t.wrap_s == texture.wrap_s && t.wrap_t == texture.wrap_t && !t.nearest)
            return static_cast<int>(i);
    doc.scene.textures.push_back(std::move(texture));
    return static_cast<int>(doc.scene.textures.size()) - 1;
}

void load_materials(Document& doc)
{
    decode_images(doc);
    Imported known;
    for (std::size_t i = 0; i < table_size(doc.json, "materials"); ++i) {
        Material material = load_material(doc, doc.json["materials"][i], i);
        for (int k = 0; k < 3; ++k)
            if (!std::isfinite(material.emissive[k] * material.emissive_strength))
                fail(fmt::format("/materials/{}/extensions/KHR_materials_emissive_strength", i), "the emission overflows");
        import_maps(doc, known, doc.json["materials"][i], i, material);
        doc.scene.materials.push_back(std::move(material));
    }
    check_unused_images(doc);
}

} // namespace burnish::gltf
