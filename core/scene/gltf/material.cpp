#include "core/scene/gltf/material.h"

#include <cmath>
#include <fmt/format.h>

#include "core/math/scalar_math.h"
#include "core/scene/gltf/image.h"

namespace burnish::gltf {

namespace {

using ExtensionMap = tinygltf::ExtensionMap;

const tinygltf::Value* find(const ExtensionMap& extensions, const char* name)
{
    const auto it = extensions.find(name);
    return it == extensions.end() || !it->second.IsObject() ? nullptr : &it->second;
}

double number(const tinygltf::Value& object, const char* key, double fallback)
{
    return object.Has(key) ? object.Get(key).GetNumberAsDouble() : fallback;
}

WrapMode wrap_mode(int code)
{
    return code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? WrapMode::clamp
           : code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? WrapMode::mirror
                                                           : WrapMode::repeat;
}

bool is_nearest(const tinygltf::Sampler& sampler)
{
    const int min = sampler.minFilter;
    return sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST &&
           (min == -1 || min == TINYGLTF_TEXTURE_FILTER_NEAREST || min == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
            min == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR);
}

// Its index in Scene::textures; none where the file offers no image that can be read.
int scene_texture(Document& doc, int index)
{
    if (const auto known = doc.scene_textures.find(index); known != doc.scene_textures.end())
        return known->second;
    const tinygltf::Texture& source = doc.model.textures[static_cast<std::size_t>(index)];
    int image = source.source;
    if (const tinygltf::Value* webp = find(source.extensions, "EXT_texture_webp"); webp && webp->Has("source"))
        image = webp->Get("source").GetNumberAsInt();
    int id = kNone;
    if (image < 0) {
        doc.warn(quoted(source.name, "texture", static_cast<std::size_t>(index)) + " has no image that can be read; left out");
    } else {
        Texture texture;
        texture.name = source.name;
        texture.image = scene_image(doc, image);
        if (source.sampler >= 0) {
            const tinygltf::Sampler& sampler = doc.model.samplers[static_cast<std::size_t>(source.sampler)];
            texture.wrap_s = wrap_mode(sampler.wrapS);
            texture.wrap_t = wrap_mode(sampler.wrapT);
            texture.nearest = is_nearest(sampler);
        }
        id = static_cast<int>(doc.scene.textures.size());
        doc.scene.textures.push_back(std::move(texture));
    }
    doc.scene_textures[index] = id;
    return id;
}

TextureRef texture_ref(Document& doc, int index, int tex_coord, const ExtensionMap& extensions)
{
    TextureRef ref;
    if (index < 0)
        return ref;
    ref.texture = scene_texture(doc, index);
    if (const tinygltf::Value* transform = find(extensions, "KHR_texture_transform")) {
        double offset[2] = {0.0, 0.0}, scale[2] = {1.0, 1.0};
        for (int i = 0; i < 2; ++i) {
            if (transform->Has("offset"))
                offset[i] = transform->Get("offset").Get(i).GetNumberAsDouble();
            if (transform->Has("scale"))
                scale[i] = transform->Get("scale").Get(i).GetNumberAsDouble();
        }
        ref.uv_transform = texture_transform(offset, number(*transform, "rotation", 0.0), scale);
        if (transform->Has("texCoord"))
            tex_coord = transform->Get("texCoord").GetNumberAsInt();
    }
    if (tex_coord > 1)
        doc.warn(fmt::format("texture coordinates TEXCOORD_{} are not supported, TEXCOORD_0 is used", tex_coord));
    ref.uv_set = tex_coord == 1 ? 1 : 0;
    return ref;
}

template <class Info> TextureRef texture_ref(Document& doc, const Info& info)
{
    return texture_ref(doc, info.index, info.texCoord, info.extensions);
}

TextureRef texture_ref(Document& doc, const tinygltf::Value& extension, const char* key)
{
    if (!extension.Has(key))
        return {};
    const tinygltf::Value& info = extension.Get(key);
    const bool extended = info.Has("extensions") && info.Get("extensions").IsObject();
    return texture_ref(doc, info.Get("index").GetNumberAsInt(), info.Has("texCoord") ? info.Get("texCoord").GetNumberAsInt() : 0,
                       extended ? info.Get("extensions").Get<tinygltf::Value::Object>() : ExtensionMap());
}

void load_extensions(Document& doc, const ExtensionMap& extensions, Material& material)
{
    material.unlit = find(extensions, "KHR_materials_unlit") != nullptr;
    if (const tinygltf::Value* strength = find(extensions, "KHR_materials_emissive_strength"))
        material.emissive *= static_cast<float>(number(*strength, "emissiveStrength", 1.0));
    if (const tinygltf::Value* ior = find(extensions, "KHR_materials_ior"))
        material.ior = static_cast<float>(number(*ior, "ior", 1.5));
    if (const tinygltf::Value* specular = find(extensions, "KHR_materials_specular")) {
        material.specular = static_cast<float>(number(*specular, "specularFactor", 1.0));
        if (specular->Has("specularColorFactor"))
            for (int i = 0; i < 3; ++i)
                material.specular_color[i] = static_cast<float>(specular->Get("specularColorFactor").Get(i).GetNumberAsDouble());
        material.specular_tex = texture_ref(doc, *specular, "specularTexture");
        material.specular_color_tex = texture_ref(doc, *specular, "specularColorTexture");
    }
    if (const tinygltf::Value* anisotropy = find(extensions, "KHR_materials_anisotropy")) {
        material.anisotropy_strength = static_cast<float>(number(*anisotropy, "anisotropyStrength", 0.0));
        material.anisotropy_rotation = static_cast<float>(number(*anisotropy, "anisotropyRotation", 0.0));
        material.anisotropy_tex = texture_ref(doc, *anisotropy, "anisotropyTexture");
    }
}

Material load_material(Document& doc, const tinygltf::Material& source)
{
    Material material;
    material.name = source.name;
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    for (int i = 0; i < 4; ++i)
        material.base_color[i] = static_cast<float>(pbr.baseColorFactor[static_cast<std::size_t>(i)]);
    for (int i = 0; i < 3; ++i)
        material.emissive[i] = static_cast<float>(source.emissiveFactor[static_cast<std::size_t>(i)]);
    material.metallic = static_cast<float>(pbr.metallicFactor);
    material.roughness = static_cast<float>(pbr.roughnessFactor);
    material.normal_scale = static_cast<float>(source.normalTexture.scale);
    material.occlusion_strength = static_cast<float>(source.occlusionTexture.strength);
    material.alpha_mode = source.alphaMode == "MASK" ? AlphaMode::mask : source.alphaMode == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
    material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
    material.double_sided = source.doubleSided;
    material.base_color_tex = texture_ref(doc, pbr.baseColorTexture);
    material.metallic_roughness_tex = texture_ref(doc, pbr.metallicRoughnessTexture);
    material.normal_tex = texture_ref(doc, source.normalTexture);
    material.occlusion_tex = texture_ref(doc, source.occlusionTexture);
    material.emissive_tex = texture_ref(doc, source.emissiveTexture);
    load_extensions(doc, source.extensions, material);
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
    for (std::size_t i = 0; i < doc.model.materials.size(); ++i) {
        const tinygltf::Material& source = doc.model.materials[i];
        Material material = load_material(doc, source);
        for (int k = 0; k < 3; ++k)
            if (!std::isfinite(material.emissive[k]))
                fail(fmt::format("/materials/{}/extensions/KHR_materials_emissive_strength", i), "the emission overflows");
        doc.scene.materials.push_back(std::move(material));
    }
    check_unused_images(doc);
}

} // namespace burnish::gltf
