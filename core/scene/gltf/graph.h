// Nodes, cameras and lights.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

void load_cameras_and_lights(Document& doc);

// Checks the whole node table (one parent each, no cycle, bounded depth) and keeps the nodes of the default
// scene.
void load_nodes(Document& doc);

} // namespace burnish::gltf
