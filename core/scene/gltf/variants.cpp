#include "core/scene/gltf/variants.h"

#include <algorithm>
#include <fmt/format.h>

namespace burnish::gltf {
namespace {

constexpr const char* kExtension = "KHR_materials_variants";

// Returns the primitive's material in a variant, or -1 where the primitive does not list the variant.
int material_in(Document& doc, const Json& primitive, int variant, const std::string& place)
{
    int material = -1;
    if (const Json* listed = get_extension(primitive, kExtension))
        for (const Json& mapping : (*listed)["mappings"])
            for (const Json& index : mapping["variants"]) {
                if (index.get<int>() != variant)
                    continue;
                if (material >= 0)
                    doc.fault(place, fmt::format("lists variant {} twice; the first material is used", variant));
                else
                    material = get_index(mapping, "material");
            }
    return material;
}

} // namespace

void choose_variant(Document& doc, const std::string& name)
{
    const std::string place = fmt::format("/extensions/{}/variants", kExtension);
    if (const Json* listed = get_extension(doc.json, kExtension))
        for (const Json& variant : (*listed)["variants"])
            doc.scene.variants.push_back(get_string(variant, "name"));
    if (name.empty())
        return;
    const auto found = std::find(doc.scene.variants.begin(), doc.scene.variants.end(), name);
    if (found == doc.scene.variants.end()) {
        std::string names;
        for (const std::string& known : doc.scene.variants)
            names += (names.empty() ? "" : ", ") + printable(known);
        fail(place, names.empty() ? "the file has no variants (Moment::variant)"
                                  : fmt::format("has no '{}' (Moment::variant); the file has {}", printable(name), names));
    }
    const int variant = static_cast<int>(found - doc.scene.variants.begin());
    Json& meshes = doc.json["meshes"];
    for (std::size_t m = 0; m < meshes.size(); ++m)
        for (std::size_t p = 0; p < meshes[m]["primitives"].size(); ++p) {
            Json& primitive = meshes[m]["primitives"][p];
            const std::string here = fmt::format("/meshes/{}/primitives/{}/extensions/{}", m, p, kExtension);
            if (const int material = material_in(doc, primitive, variant, here); material >= 0)
                primitive["material"] = material;
        }
}

} // namespace burnish::gltf
