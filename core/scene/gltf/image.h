// Images of a document: found, recognised, decoded once.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

// Its index in Scene::images, decoded at the first call. floats: it may be OpenEXR.
int scene_image(Document& doc, int image, bool floats);

// Images that no material uses are decoded too, one at a time, and dropped: a broken one is an error all the
// same.
void check_unused_images(Document& doc);

} // namespace burnish::gltf
