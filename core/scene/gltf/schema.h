// Checks a glTF 2.0 tree before anything else reads it: types, ranges, indices, extensions.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

// Checks version and extensions. Unsupported required extensions fail, all in one line; unsupported used extensions
// warn.
void check_version_and_extensions(Document& doc);

// Applies every rule in schema.cpp; the first breach fails with its JSON path. Normalizes number types: integers
// written as 3.0 become integers, and factors written as 3 become floating point.
void check_schema(Json& json);

} // namespace burnish::gltf
