// The textures of materials that are read (core/scene/material.def): where a file names them, below a material, and where they go.
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

inline constexpr const char* kRotationEncodings = "vector doubleAngle direction"; // by RotationEncoding
inline constexpr const char* kRoughnessEncodings = "widths anisotropy";           // by RoughnessEncoding

} // namespace burnish::gltf
