#include "core/scene/gltf/material.h"

#include <cmath>
#include <fmt/format.h>

#include "core/math/scalar_math.h"
#include "core/scene/gltf/image.h"
#include "core/scene/gltf/textures.h"

namespace burnish::gltf {

namespace {

const Json& member_or_nothing(const Json& object, const char* key)
{
    static const Json kNothing = Json::object(); // made when it is needed: an allocation before main() could not fail cleanly
    const Json* member = get_member(object, key);
    return member ? *member : kNothing;
}

float number(const Json& object, const char* key, double fallback)
{
    return static_cast<float>(get_number(object, key, fallback));
}

// What an array holds at i.
float number_at(const Json& object, const char* key, int i, double fallback)
{
    const Json* numbers = get_member(object, key);
    return static_cast<float>(numbers ? (*numbers)[static_cast<std::size_t>(i)].get<double>() : fallback);
}

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

void load_extensions(const Json& source, Material& material)
{
    material.unlit = get_extension(source, "KHR_materials_unlit") != nullptr;
    if (const Json* strength = get_extension(source, "KHR_materials_emissive_strength"))
        material.emissive *= number(*strength, "emissiveStrength", 1.0);
    if (const Json* ior = get_extension(source, "KHR_materials_ior"))
        material.ior = number(*ior, "ior", 1.5);
    if (const Json* specular = get_extension(source, "KHR_materials_specular")) {
        material.specular = number(*specular, "specularFactor", 1.0);
        for (int i = 0; i < 3; ++i)
            material.specular_color[i] = number_at(*specular, "specularColorFactor", i, 1.0);
    }
    if (const Json* anisotropy = get_extension(source, "KHR_materials_anisotropy")) {
        material.anisotropy_strength = number(*anisotropy, "anisotropyStrength", 0.0);
        material.anisotropy_rotation = number(*anisotropy, "anisotropyRotation", 0.0);
    }
}

Material load_material(Document& doc, const Json& source)
{
    Material material;
    material.name = get_string(source, "name");
    const Json& pbr = member_or_nothing(source, "pbrMetallicRoughness");
    for (int i = 0; i < 4; ++i)
        material.base_color[i] = number_at(pbr, "baseColorFactor", i, 1.0);
    for (int i = 0; i < 3; ++i)
        material.emissive[i] = number_at(source, "emissiveFactor", i, 0.0);
    material.metallic = number(pbr, "metallicFactor", 1.0);
    material.roughness = number(pbr, "roughnessFactor", 1.0);
    material.normal_scale = number(member_or_nothing(source, "normalTexture"), "scale", 1.0);
    material.occlusion_strength = number(member_or_nothing(source, "occlusionTexture"), "strength", 1.0);
    const std::string mode = get_string(source, "alphaMode");
    material.alpha_mode = mode == "MASK" ? AlphaMode::mask : mode == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
    material.alpha_cutoff = number(source, "alphaCutoff", 0.5);
    material.double_sided = source.value("doubleSided", false);
    load_extensions(source, material);
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
            if (!std::isfinite(material.emissive[k]))
                fail(fmt::format("/materials/{}/extensions/KHR_materials_emissive_strength", i), "the emission overflows");
        doc.scene.materials.push_back(std::move(material));
    }
    check_unused_images(doc);
}

} // namespace burnish::gltf
