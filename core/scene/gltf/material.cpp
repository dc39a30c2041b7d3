#include "core/scene/gltf/material.h"

#include <cmath>
#include <fmt/format.h>

#include "core/math/scalar_math.h"
#include "core/scene/gltf/factors.h"
#include "core/scene/gltf/image.h"
#include "core/scene/gltf/textures.h"

namespace burnish::gltf {

namespace {

// Codes of samplers (glTF 2.0, 5.26).
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

// Its index in Scene::textures; none where the file offers no image that can be read.
int scene_texture(Document& doc, int index)
{
    if (const auto known = doc.scene_textures.find(index); known != doc.scene_textures.end())
        return known->second;
    const Json& source = doc.json["textures"][static_cast<std::size_t>(index)];
    int image = get_index(source, "source");
    if (const Json* webp = get_extension(source, "EXT_texture_webp"); webp && webp->contains("source"))
        image = get_index(*webp, "source");
    int id = kNone;
    if (image < 0) {
        doc.warn(quoted(get_string(source, "name"), "texture", static_cast<std::size_t>(index)) +
                 " has no image that can be read; left out");
    } else {
        Texture texture;
        texture.name = get_string(source, "name");
        texture.image = scene_image(doc, image);
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

// What a textureInfo refers to.
TextureRef texture_ref(Document& doc, const Json& info)
{
    TextureRef ref;
    ref.texture = scene_texture(doc, get_index(info, "index"));
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
        doc.warn(fmt::format("texture coordinates TEXCOORD_{} are not supported, TEXCOORD_0 is used", tex_coord));
    ref.uv_set = tex_coord == 1 ? 1 : 0;
    return ref;
}

Material load_material(Document& doc, const Json& source)
{
    Material material;
    material.name = get_string(source, "name");
#define BN_FACTOR(kind, name, fallback, path, least, most) read_factor(source, path, material.name);
#define BN_FLAG(kind, name, path) read_flag(source, path, material.name);
#define BN_CHOICE(type, name, words, path) read_choice(source, path, words, material.name);
#include "core/scene/material.def"
    for (const MaterialTexture& texture : kMaterialTextures)
        if (const Json::json_pointer at(texture.path); source.contains(at))
            material.*texture.to = texture_ref(doc, source[at]);
    return material;
}

} // namespace

// The sign of the rotation follows the extension's words (counter-clockwise in texture space, whose v axis
// points down) and its test model; the matrix printed in the extension's text turns the other way.
glm::mat3x2 texture_transform(const double offset[2], double rotation, const double scale[2])
{
    constexpr double kTwoPi = 6.283185307179586;
    const double angle = std::fmod(rotation, kTwoPi); // exact; the functions want a bounded argument
    const double s = det_sin(angle), c = det_cos(angle);
    const auto f = [](double x) { return static_cast<float>(x); };
    return {f(c * scale[0]), f(-s * scale[0]), f(s * scale[1]), f(c * scale[1]), f(offset[0]), f(offset[1])};
}

void load_materials(Document& doc)
{
    for (std::size_t i = 0; i < table_size(doc.json, "materials"); ++i) {
        Material material = load_material(doc, doc.json["materials"][i]);
        for (int k = 0; k < 3; ++k)
            if (!std::isfinite(material.emissive[k] * material.emissive_strength))
                fail(fmt::format("/materials/{}/extensions/KHR_materials_emissive_strength", i), "the emission overflows");
        doc.scene.materials.push_back(std::move(material));
    }
    check_unused_images(doc);
}

} // namespace burnish::gltf
