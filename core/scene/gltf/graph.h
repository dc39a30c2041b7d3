// Nodes, cameras and lights.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

void load_cameras_and_lights(Document& doc);

bool is_rotation(const double* q); // four numbers with a direction; trs_matrix() makes them a unit quaternion

// Returns the matrix of a node's translation, rotation and scale.
glm::mat4 trs_matrix(const Json& node, const std::string& place);

// Checks the whole node table (one parent each, no cycle, bounded depth). Keeps the default scene's nodes, with a node
// for each instance of EXT_mesh_gpu_instancing.
void load_nodes(Document& doc);

} // namespace burnish::gltf
