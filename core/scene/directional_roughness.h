// Directional roughness maps. Scenes hold them in the anisotropy texture and in metallicRoughnessTexture's roughness.
#pragma once
#include <cstdint>
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/scene.h"
#include "core/scene/surface_maps.h"

namespace burnish {

enum class RoughnessEncoding : std::uint8_t {
    widths,    // red and green: GGX widths alpha along and across the grain, [0,1]
    anisotropy // red: roughness, [0,1]; green: anisotropy a in [-1,1] (signed, surface_maps.h): alpha = roughness^2 (1 +- a)
};

// Converts to a 16-bit image: red is roughness, green is anisotropy. Repairs texels that are not numbers: isotropic,
// roughness 1.
SurfaceMap roughness_of(const Image& map, RoughnessEncoding encoding);

// Moves each directional_roughness_tex (output of roughness_of()) into its material's other maps. The anisotropy
// texture keeps its directions, and metallicRoughnessTexture gets a new green and keeps its blue. Both become as large
// as the largest of the three maps; the factors of roughness and strength become 1. Warns of maps whose coordinates
// differ from the other two, and ignores these maps. Errors: more bytes than the texture limit. `file` names the scene
// in errors.
Status lay_directional_roughness(Scene& scene, const Limits& limits, const std::string& file);

} // namespace burnish
