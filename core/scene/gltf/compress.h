// Compressed geometry: EXT_meshopt_compression and KHR_draco_mesh_compression.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

// Checks a buffer view's extension object: its sizes agree, and its compressed bytes exist.
void check_meshopt(const Document& doc, const Json& view, const Json& extension, const std::string& place);
std::vector<std::uint8_t> decode_meshopt(Document& doc, const Json& extension, const std::string& place);

// A primitive decoded by Draco: indices, and for each attribute name tightly packed elements of the accessor's type.
struct DracoPrimitive {
    std::vector<std::uint32_t> indices;
    std::uint64_t vertex_count = 0;
    std::map<std::string, std::vector<std::uint8_t>> attributes;
};
DracoPrimitive decode_draco(Document& doc, const Json& primitive, const Json& extension, const std::string& place);

} // namespace burnish::gltf
