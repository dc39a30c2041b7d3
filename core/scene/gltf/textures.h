// Texture members of materials (core/scene/material.def): their paths in a file, below a material, and their members in
// Material.
#pragma once
#include "core/scene/scene.h"

namespace burnish::gltf {

struct MaterialTexture {
    const char* path;
    TextureRef Material::*to;
};
inline constexpr MaterialTexture kMaterialTextures[] = {
#define BN_TEXTURE(name, path) {path, &Material::name},
#include "core/scene/material.def"
};

inline constexpr const char* kRotationEncodings = "vector doubleAngle direction"; // indexed by RotationEncoding
inline constexpr const char* kRoughnessEncodings = "widths anisotropy";           // indexed by RoughnessEncoding

} // namespace burnish::gltf
