// The textures of materials that are read: where a file names them, below a material, and where they go. A line a texture: what is checked,
// loaded and warned of follows.
#pragma once
#include "core/scene/scene.h"

namespace burnish::gltf {

struct MaterialTexture {
    const char* path;
    TextureRef Material::*to;
};
inline constexpr MaterialTexture kMaterialTextures[] = {
    {"/pbrMetallicRoughness/baseColorTexture", &Material::base_color_tex},
    {"/pbrMetallicRoughness/metallicRoughnessTexture", &Material::metallic_roughness_tex},
    {"/normalTexture", &Material::normal_tex},
    {"/occlusionTexture", &Material::occlusion_tex},
    {"/emissiveTexture", &Material::emissive_tex},
    {"/extensions/KHR_materials_specular/specularTexture", &Material::specular_tex},
    {"/extensions/KHR_materials_specular/specularColorTexture", &Material::specular_color_tex},
    {"/extensions/KHR_materials_anisotropy/anisotropyTexture", &Material::anisotropy_tex},
};

} // namespace burnish::gltf
