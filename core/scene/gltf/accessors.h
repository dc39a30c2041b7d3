// A document's accessors as views. Sparse accessors become dense first.
#pragma once
#include "core/scene/gltf/document.h"
#include "core/scene/gltf/views.h"

namespace burnish::gltf {

// Checks that every accessor, used or not, and the parts of sparse accessors lie in their buffer views.
void check_accessors(Document& doc);

AccessorView accessor_view(Document& doc, int accessor);

// Fails where a component is NaN or infinite. Searches each accessor once.
void check_finite(Document& doc, int accessor, const AccessorView& view);
void check_finite(const AccessorView& view, const std::string& place);

} // namespace burnish::gltf
