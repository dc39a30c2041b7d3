// Meshes: reads primitives of any triangle mode into the scene's vertex and index tables.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

void load_meshes(Document& doc); // expects loaded materials

} // namespace burnish::gltf
