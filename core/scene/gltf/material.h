// Materials, textures and samplers.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

void load_materials(Document& doc);

// A texture of the file as area lights have it, where images of floats may be: it ends at its edges. Its index in Scene::textures; kNone
// where the file offers no image that can be read.
int clamped_texture(Document& doc, int index);

// offset * rotation * scale of KHR_texture_transform, applied to (u, v, 1).
glm::mat3x2 texture_transform(const double offset[2], double rotation, const double scale[2]);

} // namespace burnish::gltf
