// Bytes from outside the JSON: URIs, buffers, buffer views.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

// The bytes a "uri" member names: a base64 data URI, or a file below the scene's folder, also after all links. `own` keeps them where
// no buffer does. `place` is the JSON path of the uri.
Bytes read_uri(Document& doc, const std::string& uri, const std::string& place, std::vector<std::uint8_t>& own);

// Fills doc.buffers, then checks that every buffer view lies in its buffer.
void load_buffers(Document& doc);

// The bytes of a buffer view (decoded if it is compressed).
Bytes view_bytes(Document& doc, int view);

// The slice [offset, offset + length) of a buffer; checked, named by `place`.
Bytes buffer_slice(const Document& doc, int buffer, std::uint64_t offset, std::uint64_t length, const std::string& place);

} // namespace burnish::gltf
