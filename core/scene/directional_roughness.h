// Maps of roughness by direction, as scenes hold them: in the anisotropy texture and the roughness of metallicRoughnessTexture.
#pragma once
#include <cstdint>
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/scene.h"
#include "core/scene/surface_maps.h"

namespace burnish {

enum class RoughnessEncoding : std::uint8_t {
    widths,    // red and green: GGX widths alpha along the grain and across it, [0,1]
    anisotropy // red: roughness, [0,1]; green: anisotropy, -1 to 1 (a signed value of surface_maps.h): alpha = roughness^2 (1 +- it)
};

// As pictures of 16 bits with red the roughness and green the anisotropy. Repaired: what is no number, round and of roughness 1.
SurfaceMap roughness_of(const Image& map, RoughnessEncoding encoding);

// Puts every directional_roughness_tex, as roughness_of() gives it, into its material's anisotropy texture, whose directions stay, and into
// the green of its metallicRoughnessTexture, whose blue stays, both as large as the largest of the three; factors of roughness and strength
// then are 1. Maps that lie otherwise than those are not looked at, with a warning. Errors: more bytes than textures may have. file: for
// errors.
Status lay_directional_roughness(Scene& scene, const Limits& limits, const std::string& file);

} // namespace burnish
