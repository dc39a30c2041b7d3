#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "core/scene/gltf/accessors.h"
#include "core/scene/gltf/checks.h"

namespace burnish::gltf {

namespace {

// Returns the stored number: bounds apply before normalization.
double stored(const AccessorView& view, std::uint64_t i, int c)
{
    const double value = static_cast<double>(view.number(i, c));
    const double largest = view.type() == ComponentType::i8    ? 127.0
                           : view.type() == ComponentType::u8  ? 255.0
                           : view.type() == ComponentType::i16 ? 32767.0
                           : view.type() == ComponentType::u16 ? 65535.0
                                                               : 1.0;
    return view.normalized() ? std::round(value * largest) : value;
}

void check_bounds(Document& doc, std::size_t index, const Json& accessor)
{
    const AccessorView view = accessor_view(doc, static_cast<int>(index));
    if (view.type() == ComponentType::u32) // floats cannot hold them
        return;
    const std::size_t components = static_cast<std::size_t>(view.components());
    std::vector<double> low(components, std::numeric_limits<double>::infinity()), high(components, -low[0]);
    const std::uint64_t count = view.all_zero() ? 1 : view.count();
    for (std::uint64_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < components; ++c) {
            const double value = stored(view, i, static_cast<int>(c));
            low[c] = std::min(low[c], value), high[c] = std::max(high[c], value);
        }
    for (const auto& [key, actual] : {std::pair<const char*, const std::vector<double>&>{"min", low}, {"max", high}}) {
        if (!accessor.contains(key) || accessor[key].size() != components)
            continue;
        for (std::size_t c = 0; c < components; ++c)
            if (const float said = static_cast<float>(accessor[key][c].get<double>()); said != static_cast<float>(actual[c])) {
                doc.fault(fmt::format("/accessors/{}/{}/{}", index, key, c),
                          fmt::format("says {:g}, and it is {:g}; what is there is used", said, actual[c]));
                break;
            }
    }
}

void check_unit(Document& doc, int accessor, const std::string& name)
{
    const AccessorView view = accessor_view(doc, accessor);
    const bool tangent = name == "TANGENT";
    if (view.components() != (tangent ? 4 : 3) || view.all_zero())
        return;
    // Integers are rounded: allow a step of the coarsest type, 1 / 127, in each of three components.
    const float tolerance = static_cast<float>(view.type() == ComponentType::f32   ? kUnitTolerance
                                               : component_bytes(view.type()) == 1 ? 0.02
                                                                                   : 1e-3);
    for (std::uint64_t i = 0; i < view.count(); ++i) {
        const float x = view.number(i, 0), y = view.number(i, 1), z = view.number(i, 2), length2 = x * x + y * y + z * z;
        if (std::abs(std::sqrt(length2) - 1.0f) > tolerance) {
            doc.fault(fmt::format("/accessors/{}", accessor), fmt::format("{} {} has no unit length; normalized", name, i));
            return;
        }
        if (tangent && std::abs(view.number(i, 3)) != 1.0f) {
            doc.fault(fmt::format("/accessors/{}", accessor),
                      fmt::format("TANGENT {} has the sign {:g}, neither 1 nor -1; its sign is used", i, view.number(i, 3)));
            return;
        }
    }
}

} // namespace

void check_values(Document& doc)
{
    std::set<std::pair<int, std::string>> seen;
    for (std::size_t m = 0; m < table_size(doc.json, "meshes"); ++m)
        for (const Json& primitive : doc.json["meshes"][m]["primitives"]) {
            if (get_extension(primitive, "KHR_draco_mesh_compression"))
                continue;
            for (const char* name : {"NORMAL", "TANGENT"})
                if (const int accessor = get_index(primitive["attributes"], name); accessor >= 0 && seen.insert({accessor, name}).second)
                    check_unit(doc, accessor, name);
        }
    for (std::size_t i = 0; i < table_size(doc.json, "accessors"); ++i) {
        const Json& accessor = doc.json["accessors"][i];
        const bool stored_here = accessor.contains("bufferView") || accessor.contains("sparse");
        if (stored_here && (accessor.contains("min") || accessor.contains("max")))
            check_bounds(doc, i, accessor);
    }
}

} // namespace burnish::gltf
