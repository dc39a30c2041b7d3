// EXT_lights_image_based: which light the scene has, and its faces.
#pragma once
#include "core/scene/gltf/document.h"
#include "core/scene/image_light.h"

namespace burnish::gltf {

// What the schema cannot say of image-based lights: nine coefficients, levels that halve. Notes in the scene whether it has one.
void check_image_lights(Document& doc);

// The light of the scene that is shown, its buffers loaded; fails where it has none.
ImageLight read_image_light(Document& doc);

} // namespace burnish::gltf
