// Rules of glTF 2.0 beyond types and ranges. A breach is repaired with a warning that names its place, or refused with
// Limits::strict; none goes unreported. The JSON has passed check_schema().
#pragma once
#include <string_view>

#include "core/scene/gltf/document.h"

namespace burnish::gltf {

void check_structure(Document& doc);      // objects alone and together: nodes, meshes, materials, images
void check_extensions(Document& doc);     // declared where used, and in allowed places
void check_accessor_rules(Document& doc); // alignment, strides, formats, uses of accessors and buffer views
void check_moving(Document& doc);         // animations, skins, morph targets
void check_values(Document& doc);         // contents of loaded buffers: bounds, unit vectors
void check_moving_values(Document& doc);  // contents for animations, skins, joints and weights; NaN anywhere

constexpr double kUnitTolerance = 5e-4; // for float unit vectors and quaternions; the validator's tolerance

// Calls visit(value, place) for every value that `path` matches; '*' matches any element.
template <class F> void for_each(const Json& node, std::string_view path, const std::string& place, const F& visit)
{
    if (path.empty())
        return visit(node, place);
    const std::size_t slash = std::min(path.find('/'), path.size());
    const std::string step(path.substr(0, slash));
    const std::string_view rest = path.substr(std::min(slash + 1, path.size()));
    if (step == "*" && node.is_array())
        for (std::size_t i = 0; i < node.size(); ++i)
            for_each(node[i], rest, place + "/" + std::to_string(i), visit);
    else if (const auto it = node.is_object() ? node.find(step) : node.end(); it != node.end())
        for_each(*it, rest, place + "/" + step, visit);
}

} // namespace burnish::gltf
