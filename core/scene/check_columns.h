// Linear passes of check_scene(): vertices, indices, and primitives.
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
Status fault_of_file(Status status, const std::string& file); // returns the status with the scene's file name

// Returns the index of the first NaN or infinite number, or `size` where there is none.
std::size_t first_not_finite(const float* numbers, std::size_t size);

Status check_columns(const Scene& scene);                   // checks sizes, finite numbers, normals' lengths
Status check_primitive(const Scene& scene, std::size_t at); // checks the primitive's ranges and material
Status check_indices(const Scene& scene);                   // expects primitives with valid ranges

} // namespace burnish
