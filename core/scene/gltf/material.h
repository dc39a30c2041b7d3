// Materials, textures and samplers.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

void load_materials(Document& doc);

// offset * rotation * scale of KHR_texture_transform, applied to (u, v, 1).
glm::mat3x2 texture_transform(const double offset[2], double rotation, const double scale[2]);

} // namespace burnish::gltf
