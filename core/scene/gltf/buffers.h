// Bytes outside the JSON: URIs, buffers, buffer views.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

// Returns the bytes behind a "uri" member: a base64 data URI, or a file that lies below the scene's folder even after
// resolving links. `own` holds the bytes where no buffer does. `place` is the uri's JSON path.
Bytes read_uri(Document& doc, const std::string& uri, const std::string& place, std::vector<std::uint8_t>& own);

// Fills doc.buffers, then checks that every buffer view lies in its buffer.
void load_buffers(Document& doc);

// Returns a buffer view's bytes, decoded if compressed.
Bytes view_bytes(Document& doc, int view);

// Returns the slice [offset, offset + length) of a buffer, with bounds checks. Errors name `place`.
Bytes buffer_slice(const Document& doc, int buffer, std::uint64_t offset, std::uint64_t length, const std::string& place);

} // namespace burnish::gltf
