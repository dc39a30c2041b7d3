// Accessors of a document as views; sparse ones are made dense first.
#pragma once
#include "core/scene/gltf/document.h"
#include "core/scene/gltf/views.h"

namespace burnish::gltf {

// Every accessor of the file, used or not: it lies in its buffer view, and so do the parts of a sparse one.
void check_accessors(Document& doc);

AccessorView accessor_view(Document& doc, int accessor);

// Fails where a component is NaN or infinite; each accessor is searched once.
void check_finite(Document& doc, int accessor, const AccessorView& view);
void check_finite(const AccessorView& view, const std::string& place);

} // namespace burnish::gltf
