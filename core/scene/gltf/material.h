// Materials, textures and samplers.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

void load_materials(Document& doc);

// Returns the index in Scene::textures of an area light's texture, clamped at its edges; float images are allowed.
// kNone where the file offers no readable image.
int clamped_texture(Document& doc, int index);

// Returns offset * rotation * scale of KHR_texture_transform, to apply to (u, v, 1).
glm::mat3x2 texture_transform(const double offset[2], double rotation, const double scale[2]);

} // namespace burnish::gltf
