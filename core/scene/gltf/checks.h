// What glTF 2.0 asks of a file beyond types and ranges. A breach is repaired with a warning that names its place, or, with --strict,
// refused; nothing passes in silence. The JSON has passed check_schema().
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

void check_structure(Document& doc);      // objects by themselves and together: nodes, meshes, materials, images, extensions
void check_accessor_rules(Document& doc); // alignment, strides, formats, what an accessor and a buffer view are used for
void check_unread(Document& doc);         // animations, skins, morph targets: nothing of them is drawn
void check_values(Document& doc);         // what the buffers hold, once they are loaded: bounds, unit vectors

} // namespace burnish::gltf
