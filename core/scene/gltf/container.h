// The container of a glTF file: file bytes, GLB chunks, and JSON text.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

// Reads a regular file of at most `limit` bytes. `place` is the place in errors.
std::vector<std::uint8_t> read_file_bytes(const std::string& path, std::uint64_t limit, const std::string& place);

// Fills json, bin and has_bin from bytes.
void parse_container(Document& doc);

} // namespace burnish::gltf
