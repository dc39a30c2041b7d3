// EXT_lights_image_based: the scene's light and its faces.
#pragma once
#include "core/scene/gltf/document.h"
#include "core/scene/image_light.h"

namespace burnish::gltf {

// Checks rules beyond the schema: nine coefficients, levels that halve. Notes in the scene that the file has a light.
void check_image_lights(Document& doc);

// Reads the shown scene's light and loads its buffers. Fails where the scene has none.
ImageLight read_image_light(Document& doc);

} // namespace burnish::gltf
