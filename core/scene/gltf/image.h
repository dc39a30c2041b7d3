// A document's images: found, recognised, decoded once.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

// Returns the image that a texture names, as WebP if the file offers it; -1 if none.
int image_of_texture(const Json& texture);

// Decodes the images of all textures on all threads, for scene_image(). Leaves out OpenEXR, images with faults, and images beyond the
// limits.
void decode_images(Document& doc);

// Returns the image's index in Scene::images; the first call decodes the image. `floats` also allows OpenEXR.
int scene_image(Document& doc, int image, bool floats);

// Decodes images that no material uses, one at a time, and drops them: a broken image is an error even if unused.
void check_unused_images(Document& doc);

} // namespace burnish::gltf
