// The linear passes of check_scene(): vertices, indices, and the tables that draws are made of.
#pragma once
#include <cstddef>
#include <string>

#include "core/base/result.h"
#include "core/scene/scene.h"

namespace burnish {

inline Error scene_fault(std::string place, std::string reason)
{
    return {ExitCode::bad_input, "", std::move(place), std::move(reason)};
}
Status fault_of_file(Status status, const std::string& file); // the same of a named scene

// Returns where the first number stands that is NaN or infinite; `size` where there is none.
std::size_t first_not_finite(const float* numbers, std::size_t size);

Status check_columns(const Scene& scene);                   // sizes, finite numbers, normals with a length
Status check_primitive(const Scene& scene, std::size_t at); // its ranges and its material
Status check_indices(const Scene& scene);                   // of primitives whose ranges are right

} // namespace burnish
