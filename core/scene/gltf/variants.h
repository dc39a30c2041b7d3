// Variants of materials (KHR_materials_variants): a file names several, and each mesh lists its materials by variant.
#pragma once
#include <string>

#include "core/scene/gltf/document.h"

namespace burnish::gltf {

// Fills Scene::variants. Gives meshes their materials in the named variant; "" leaves their own. Meshes that do not list the variant keep
// their own too. Of two variants with one name the first counts. Fails if the file has no variant of this name.
void choose_variant(Document& doc, const std::string& name);

} // namespace burnish::gltf
