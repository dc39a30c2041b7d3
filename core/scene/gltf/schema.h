// What a glTF 2.0 tree must look like before anything reads it: types, ranges, indices, extensions.
#pragma once
#include "core/scene/gltf/document.h"

namespace burnish::gltf {

// Version and extensions: unsupported required ones fail (all names in one line), used ones warn.
void check_version_and_extensions(Document& doc);

// Every rule of the table in gltf_schema.cpp; the first breach fails with its JSON path. Normalizes number
// types: integers written as 3.0 become integers and factors written as 3 become floating point.
void check_schema(Json& json);

} // namespace burnish::gltf
